//! How far a refined mesh is from the mesh that was read, proven.
//!
//! Exact refinement knows where on the control mesh each vertex comes from, and its triangles come from pieces that
//! tile the control faces. So each triangle has a piece of the control mesh's surface as its partner, point by point; as both are
//! flat, no two partners are farther apart than those at the corners. The greatest distance between a vertex and where it came
//! from bounds the Hausdorff distance, in both directions.
//!
//! Regions that lie in a plane are triangulated from their rims alone, which have partners as all edges have. A point of one region that
//! is not in the other lies on a segment between partners of the rims: moved along these, the one rim must pass it to become the
//! other. So the rims bound the distance, but for what both are off the plane.
//!
//! Below stand true distances of the points that were moved most along
//! normals: along the surface, vertices drift where triangles are of different sizes, and the interval is wide there. Of a mesh that is not
//! too large the two are measured then, by the certified search.

use limitmesh::measure::{Bvh, CertifiedOptions, MeasureError, certified_hausdorff_between_observed};
use limitmesh::mesh::FaceParts;
use limitmesh::progress::Observer;
use limitmesh::refine::{Exact, ExactOptions, Origin, exact_observed};
use limitmesh::{Mesh, Triangles};

use super::INTERPOLATE;
use super::control::{Before, BeforeSurface};
use super::goals::{Goals, unit_in_words};
use crate::arguments::{MOST_EXACT, RefineArguments};
use crate::dihedral::Dihedrals;
use crate::format::{counted, number};
use crate::progress::Progress;
use crate::report::{ErrorReport, InputDistanceReport};
use crate::vector::{distance, dot, minus};

/// Points whose distance is measured.
const MEASURED: usize = 4;

/// An interval is wide where its upper end is more than so many times the lower one.
const WIDE: f64 = 1.25;

/// How narrow it is to be then, the work for that, about a second, and the triangles of both meshes at most.
const NARROW: f64 = 0.1;
const MOST_WORK: u64 = 20_000_000;
const MOST_TRIANGLES: usize = 200_000;

/// What rounding may do to a computed point or distance, as a share of the greatest coordinate: some hundred units in the last place.
const ROUNDING: f64 = 2e-14;

/// Share of the diagonal that a mesh may be off by that stands for the limit surface, where triangles reach over several control
/// faces.
const STAND_IN: f64 = 5e-4;

/// The distance between the mesh that was read and the refined one lies between these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct InputDistance {
    pub(super) lower: f64,
    pub(super) upper: f64,
}

impl InputDistance {
    /// Of a refined mesh whose triangles each come from one control face, and where on the input its vertices came from; `None` where
    /// triangles reach over several.
    ///
    /// Where the surface lies in a plane, the input's vertices are within `residual` of it.
    ///
    /// # Errors
    /// Coordinates too large to be measured.
    pub(super) fn new(
        input: Triangles<'_>,
        (found, origins): (&Exact, &[Origin]),
        residual: f64,
    ) -> Result<Option<Self>, MeasureError> {
        let is_known = origins.len() == found.mesh.vertex_count();
        if !is_known || found.is_optimized {
            return Ok(None);
        }
        let moved = moves(input, found, origins);
        let upper = moved.iter().copied().fold(0.0, f64::max);
        let rounding = ROUNDING * greatest(input);
        let lower = lower(input, (found, origins), &moved)? - rounding;
        let off_planes = if found.off_planes > 0.0 { 2.0 * found.off_planes + residual } else { 0.0 };
        Ok(Some(Self { lower: lower.max(0.0), upper: upper + off_planes + rounding }))
    }

    /// Of another mesh that stands for the same limit surface, where these are within `apart` of each other.
    ///
    /// # Errors
    /// Coordinates too large to be measured.
    pub(super) fn of_other(
        self,
        input: Triangles<'_>,
        (found, origins): (&Exact, &[Origin]),
        apart: f64,
    ) -> Result<Self, MeasureError> {
        let lower = lower(input, (found, origins), &moves(input, found, origins))?;
        Ok(Self {
            lower: (lower - ROUNDING * greatest(input)).max(0.0),
            upper: (self.upper + apart).next_up(),
        })
    }

    /// The same, measured anew where it is wide and more than `expected`.
    ///
    /// # Errors
    /// Coordinates too large to be measured, or the observer asked to stop.
    pub(super) fn narrowed(
        self,
        [input, found]: [Triangles<'_>; 2],
        expected: f64,
        observer: &mut Observer<'_>,
    ) -> Result<Self, MeasureError> {
        let is_wide = self.upper > expected && self.upper > WIDE * self.lower;
        if !is_wide || input.triangles.len() + found.triangles.len() > MOST_TRIANGLES {
            return Ok(self);
        }
        let (from, to) = (Bvh::new_observed(found, observer)?, Bvh::new_observed(input, observer)?);
        let options = CertifiedOptions::default().relative_gap(NARROW).max_work(MOST_WORK);
        let measured = certified_hausdorff_between_observed(&from, &to, &options, observer)?;
        Ok(Self { lower: self.lower.max(measured.lower()), upper: self.upper.min(measured.upper()) })
    }

    /// The same after vertices were rounded by so much at most.
    pub(super) fn rounded(self, rounding: f64) -> Self {
        Self { lower: (self.lower - rounding).max(0.0), upper: self.upper + rounding }
    }
}

/// How far the result is from the mesh that was read; `None` where nobody asks, or nothing is proven.
///
/// # Errors
/// Coordinates too large to be measured, or somebody asked to stop.
pub(super) fn measured(
    (control, before, parts): (&Mesh, &Before, &FaceParts),
    found: &Exact,
    goals: &Goals,
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<Option<InputDistance>> {
    let Some(BeforeSurface { positions, triangles }) = &before.surface else { return Ok(None) };
    let input = Triangles { positions, triangles };
    let residual = before.residual.unwrap_or(0.0);
    let on_whole = |found: &Exact| -> Vec<Origin> {
        let origins = found.origins.iter().map(|origin| parts.on_whole(origin.face, origin.barycentric));
        origins.map(|(face, barycentric)| Origin { face, barycentric }).collect()
    };
    let origins = on_whole(found);
    let narrowed = |moved: InputDistance| {
        let expected = goals.expected(Some(found.error.upper));
        moved.narrowed([input, found.mesh.as_triangles()], expected, &mut progress.observer())
    };
    if let Some(moved) = InputDistance::new(input, (found, &origins), residual)? {
        return Ok(Some(narrowed(moved)?));
    }
    if !found.error.certified {
        return Ok(None);
    }
    // Triangles that reach over several control faces: the limit surface lies between, with another mesh near it.
    let options =
        ExactOptions::default().tolerance(STAND_IN * goals.diagonal).max_triangles(Some(MOST_EXACT));
    let between = exact_observed(control, arguments.scheme()?, &options, &mut progress.observer())?;
    let apart = between.error.upper + found.error.upper;
    let moved = InputDistance::new(input, (&between, &on_whole(&between)), residual)?;
    Ok(moved.map(|moved| narrowed(moved.of_other(input, (found, &origins), apart)?)).transpose()?)
}

/// How far the result is from the mesh that was read, if that is farther than it is from the limit surface, and what would
/// keep it nearer.
pub(super) fn in_words(
    moved: &InputDistanceReport,
    error: &ErrorReport,
    control: &Mesh,
    goals: &Goals,
    arguments: &RefineArguments,
) -> Vec<String> {
    if moved.upper <= goals.expected(error.upper) {
        return Vec::new();
    }
    let mut lines = vec![moved.in_words(&unit_in_words(arguments.build.unit))];
    let is_tagged = arguments.features.crease_angle.is_some() || !control.tags().creases.is_empty();
    let dihedrals = (!is_tagged).then(|| Dihedrals::of(control));
    if let Some(Dihedrals { suggested_crease_angle_degrees: Some(angle), sharp_edges, .. }) = dihedrals {
        let edges = counted(sharp_edges, "edge that looks", "edges that look");
        lines.push(format!("(--crease-angle {} would keep {edges} sharp)", number(angle)));
    }
    if arguments
        .interpolation
        .within(goals.diagonal, arguments.build.unit)
        .is_ok_and(|within| within.is_none())
    {
        lines.push(INTERPOLATE.to_owned());
    }
    lines
}

fn greatest(mesh: Triangles<'_>) -> f64 {
    mesh.positions.as_flattened().iter().fold(0.0, |greatest, x| greatest.max(x.abs()))
}

/// Where a vertex came from.
fn place(input: Triangles<'_>, origin: &Origin) -> [f64; 3] {
    let corners = input.corners(origin.face as usize);
    let weights = origin.barycentric;
    [0, 1, 2].map(|axis| (0..3).map(|corner| weights[corner] * corners[corner][axis]).sum())
}

/// How far each vertex is from where it came from.
fn moves(input: Triangles<'_>, found: &Exact, origins: &[Origin]) -> Vec<f64> {
    let pairs = found.mesh.positions().iter().zip(origins);
    pairs.map(|(&vertex, origin)| distance(vertex, place(input, origin))).collect()
}

/// The greatest true distance among the vertices that were moved most along normals, to the input, and of where they came from,
/// to the result.
fn lower(
    input: Triangles<'_>,
    (found, origins): (&Exact, &[Origin]),
    moved: &[f64],
) -> Result<f64, MeasureError> {
    let places = origins.iter().map(|origin| place(input, origin));
    let along = places.zip(found.mesh.positions()).zip(&found.normals);
    let along: Vec<f64> =
        along.map(|((there, &here), &normal)| dot(minus(here, there), normal).abs()).collect();
    let mut order: Vec<usize> = (0..moved.len()).collect();
    let count = MEASURED.min(order.len());
    if count < order.len() {
        order.select_nth_unstable_by(count, |&a, &b| along[b].total_cmp(&along[a]).then(a.cmp(&b)));
    }
    order.truncate(count);
    order.sort_unstable();
    let mut lower = 0.0f64;
    for vertex in order {
        let (there, here) = (place(input, &origins[vertex]), found.mesh.positions()[vertex]);
        let far = moved[vertex];
        for (point, surface) in [(here, input), (there, found.mesh.as_triangles())] {
            lower = lower.max(closest(point, surface, far)?);
        }
    }
    Ok(lower)
}

/// The distance of a point from a surface that comes within `reach` of it.
fn closest(point: [f64; 3], surface: Triangles<'_>, reach: f64) -> Result<f64, MeasureError> {
    // Only triangles that come so near can be the closest.
    let reach = reach * (1.0 + ROUNDING) + f64::MIN_POSITIVE;
    let is_near = |corners: &[[f64; 3]; 3]| {
        (0..3).all(|axis| {
            let low = corners.iter().fold(f64::INFINITY, |low, p| low.min(p[axis]));
            let high = corners.iter().fold(f64::NEG_INFINITY, |high, p| high.max(p[axis]));
            low - reach <= point[axis] && point[axis] <= high + reach
        })
    };
    let faces = 0..surface.triangles.len();
    let near: Vec<[[f64; 3]; 3]> = faces.map(|face| surface.corners(face)).filter(is_near).collect();
    if near.is_empty() {
        return Ok(0.0);
    }
    let triangles: Vec<[u32; 3]> = (0..near.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let near = Bvh::new(Triangles { positions: near.as_flattened(), triangles: &triangles })?;
    Ok(near.closest(point).distance)
}
