//! What names and numbers of options are for the library.

use limitmesh::PolygonSoup;
use limitmesh::mesh::{BoundaryRule, BuildOptions, Weld};
use limitmesh::refine::{ExactOptions, Finish, with_room};
use limitmesh::scheme::{CatmullClark, Loop, LoopWarren, ModifiedButterfly, Scheme};

use crate::failure::Failure;
use crate::inputs::{ControlIn, GoalsIn};

const BOUNDARIES: [(&str, BoundaryRule); 3] = [
    ("smooth", BoundaryRule::Smooth),
    ("corners", BoundaryRule::Corners),
    ("fixed", BoundaryRule::Fixed),
];

const SCHEMES: [(&str, &dyn Scheme); 4] = [
    ("loop", &Loop),
    ("loop-warren", &LoopWarren),
    ("butterfly", &ModifiedButterfly),
    ("catmull-clark", &CatmullClark),
];

/// What a name stands for.
///
/// # Errors
/// Nothing.
pub(crate) fn named<T: Copy>(all: &[(&str, T)], name: &str, place: String) -> Result<T, Failure> {
    let found = all.iter().find(|(own, _)| *own == name);
    found.map(|&(_, value)| value).ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|&(name, _)| name).collect();
        let message = format!("{place} is '{name}', expected one of {}", names.join(", "));
        Failure::option(place, message)
    })
}

/// The rule of boundaries.
///
/// # Errors
/// There is none of that name.
pub(crate) fn boundary(told: &ControlIn) -> Result<BoundaryRule, Failure> {
    named(&BOUNDARIES, &told.boundary(), "boundary".to_owned())
}

/// The scheme; that of the soup's faces where none was asked for: a soup most of whose faces are quads is a cage for Catmull and Clark.
///
/// # Errors
/// There is none of that name.
pub(crate) fn scheme(told: &ControlIn, soup: &PolygonSoup) -> Result<&'static dyn Scheme, Failure> {
    if let Some(name) = told.scheme() {
        return named(&SCHEMES, &name, "scheme".to_owned());
    }
    let quads = soup.faces.iter().filter(|face| face.len() == 4).count();
    match told.smooth_triangles() || 2 * quads > soup.faces.len() {
        true => Ok(&CatmullClark),
        false => Ok(&Loop),
    }
}

/// How a mesh is made of a soup.
pub(crate) fn build(told: &ControlIn) -> BuildOptions {
    let weld = match told.weld() {
        none if none < 0.0 => Weld::Never,
        0.0 => Weld::Exact,
        distance => Weld::Within(distance),
    };
    BuildOptions::default().weld(weld).strict(!told.repair())
}

/// Goals and caps for a mesh with this diagonal, whose result is rounded by so much at most. Triangles stay within one face where faces are
/// to be told apart.
pub(crate) fn exact(
    told: &GoalsIn,
    diagonal: f64,
    rounding: f64,
    tells_faces_apart: bool,
    unfolds: bool,
) -> ExactOptions {
    let finish = match (told.optimize(), told.balance()) {
        (true, _) => Finish::Collapsed,
        (false, true) => Finish::Balanced,
        (false, false) => Finish::OnSurface,
    };
    let count = |number: f64| number as usize;
    let mut options = ExactOptions::default()
        .max_memory(told.max_memory().map(count))
        .finish(finish)
        .flat_regions(told.flat_regions() && !tells_faces_apart)
        .unfold(unfolds)
        .origins(tells_faces_apart);
    if let Some(cap) = told.max_triangles() {
        options = options.max_triangles(Some(count(cap)));
    }
    if let Some(levels) = told.max_levels() {
        options = options.max_levels(count(levels));
    }
    if let Some(tolerance) = told.tolerance() {
        options = options.tolerance(with_room(tolerance.of(diagonal), rounding));
    }
    if let Some(degrees) = told.angle() {
        options = options.angle(degrees.to_radians());
    }
    if let Some(triangles) = told.triangles() {
        options = options.triangles(count(triangles));
    }
    options
}
