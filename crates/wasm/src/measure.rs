//! Distances between meshes, and from a mesh to a limit surface.

use js_sys::Object;
use limitmesh::Triangles;
use limitmesh::measure::{
    Bounds, CertifiedHausdorff, CertifiedOptions, Hausdorff, OneSided, SamplingOptions,
    certified_hausdorff_observed, hausdorff_observed,
};
use limitmesh::progress::Observer;
use limitmesh::refine::{LimitDistanceOptions, is_certified, limit_distance_observed};
use limitmesh::refine::{UniformOptions, reference_levels, uniform_triangles_observed};
use wasm_bindgen::prelude::*;

use crate::control::Control;
use crate::failure::Failure;
use crate::inputs::{ControlIn, HowIn, Listener, MeshIn};
use crate::options;
use crate::soup::{as_triangles, soup};
use crate::told::{self, observer, set};

/// A distance that was found.
enum Distance {
    Sampled(Hausdorff),
    Certified(CertifiedHausdorff),
}

/// The distance between two meshes as they are.
///
/// # Errors
/// A mesh is none, or the listener said stop.
#[wasm_bindgen]
pub fn measure(
    surface: &MeshIn,
    reference: &MeshIn,
    how: &HowIn,
    listener: Option<Listener>,
) -> Result<Object, JsValue> {
    let measured = || {
        let a = soup(surface).map_err(|failure| failure.of("a"))?;
        let b = soup(reference).map_err(|failure| failure.of("b"))?;
        let (of_a, of_b) = (as_triangles(&a), as_triangles(&b));
        let a = Triangles {
            positions: &a.positions,
            triangles: &of_a,
        };
        let b = Triangles {
            positions: &b.positions,
            triangles: &of_b,
        };
        between(a, b, how, &mut observer(listener.as_ref()))
    };
    Ok(measured()?.told())
}

/// The distance between a mesh as it is and the limit surface of another. That stands uniformly refined where the distance is sampled.
///
/// # Errors
/// A mesh is none, an option has no meaning, or the listener said stop.
#[wasm_bindgen]
pub fn measure_limit(
    surface: &MeshIn,
    reference: &MeshIn,
    control: &ControlIn,
    how: &HowIn,
    listener: Option<Listener>,
) -> Result<Object, JsValue> {
    let measured = || {
        let observer = &mut observer(listener.as_ref());
        let surface = soup(surface).map_err(|failure| failure.of("a"))?;
        let triangles = as_triangles(&surface);
        let a = Triangles {
            positions: &surface.positions,
            triangles: &triangles,
        };
        let unfolds = control.divides_concave_corners();
        let built = soup(reference)
            .and_then(|soup| Control::new(soup, &options::build(control), control, observer));
        let control = built.map_err(|failure| failure.of("limitOf"))?;
        match how.certified() {
            true => certified(a, &control, unfolds, how, observer),
            false => sampled(a, control, how, observer),
        }
    };
    Ok(measured()?.told())
}

fn certified(
    surface: Triangles<'_>,
    control: &Control,
    unfolds: bool,
    how: &HowIn,
    observer: &mut Observer<'_>,
) -> Result<Distance, Failure> {
    if !is_certified(control.scheme) {
        let name = control.scheme.name();
        let message = format!("nothing is certain about limit surfaces of the scheme {name}");
        return Err(Failure::option("certified", message));
    }
    let mut options = LimitDistanceOptions::default().unfold(unfolds);
    if let Some(gap) = how.gap() {
        options = options.gap(Some(gap.of(control.diagonal)));
    }
    if let Some(work) = how.max_work() {
        options = options.max_work(work as u64);
    }
    let found =
        limit_distance_observed(surface, &control.mesh, control.scheme, &options, observer)?;
    Ok(Distance::Certified(found.distance))
}

fn sampled(
    surface: Triangles<'_>,
    control: Control,
    how: &HowIn,
    observer: &mut Observer<'_>,
) -> Result<Distance, Failure> {
    let suiting = || reference_levels(control.mesh.face_count(), surface.triangles.len());
    let levels = how.levels().map(|levels| levels as usize);
    let Some(levels) = levels.or_else(suiting) else {
        return Err(Failure::option("levels", TOO_LARGE));
    };
    let limit = UniformOptions::default().levels(levels).limit(true);
    let limit = uniform_triangles_observed(&control.mesh, control.scheme, &limit, observer)?;
    drop(control);
    between(surface, limit.as_triangles(), how, observer)
}

/// Why meshes are not compared with references as fine as themselves.
const TOO_LARGE: &str = "a reference for the limit surface two levels finer than the mesh is too large; certified: true measures \
     against the limit surface itself, levels against a coarser reference";

fn between(
    a: Triangles<'_>,
    b: Triangles<'_>,
    how: &HowIn,
    observer: &mut Observer<'_>,
) -> Result<Distance, Failure> {
    if !how.certified() {
        let options = SamplingOptions::default().samples(how.samples() as usize);
        let found = hausdorff_observed(a, b, &options, observer)?;
        return Ok(Distance::Sampled(found));
    }
    let mut options = CertifiedOptions::default();
    if let Some(gap) = how.gap() {
        options = options.gap(Some(gap.of(b.diagonal()))).relative_gap(0.0);
    }
    if let Some(work) = how.max_work() {
        options = options.max_work(work as u64);
    }
    let found = certified_hausdorff_observed(a, b, &options, observer)?;
    Ok(Distance::Certified(found))
}

impl Distance {
    /// By the names of TypeScript's result.
    fn told(&self) -> Object {
        let object = Object::new();
        match self {
            Self::Sampled(found) => {
                set(&object, "lower", found.symmetric());
                set(&object, "upper", f64::INFINITY);
                set(&object, "certified", false);
                set(&object, "converged", true);
                set(&object, "forward", of_samples(&found.forward));
                set(&object, "backward", of_samples(&found.backward));
                set(&object, "diagonal", found.reference_diagonal);
            }
            Self::Certified(found) => {
                set(&object, "lower", found.lower());
                set(&object, "upper", found.upper());
                set(&object, "certified", true);
                set(&object, "converged", found.converged());
                set(&object, "forward", bounded(&found.forward));
                set(&object, "backward", bounded(&found.backward));
                set(&object, "diagonal", found.reference_diagonal);
            }
        }
        object
    }
}

fn of_samples(found: &OneSided) -> Object {
    let object = Object::new();
    set(&object, "lower", found.max);
    set(&object, "upper", f64::INFINITY);
    set(&object, "mean", found.mean);
    set(&object, "rms", found.rms);
    set(&object, "percentile95", found.percentile_95);
    set(&object, "samples", found.samples as f64);
    set(&object, "at", told::point(found.at));
    set(&object, "to", told::point(found.to));
    object
}

fn bounded(found: &Bounds) -> Object {
    let object = Object::new();
    set(&object, "lower", found.lower);
    set(&object, "upper", found.upper);
    set(&object, "at", told::point(found.at));
    set(&object, "to", told::point(found.to));
    object
}
