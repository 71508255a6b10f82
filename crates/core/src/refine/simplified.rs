//! Exact refinement followed by edge collapse: the fewest triangles for a tolerance.
//!
//! A mesh finer than requested, certified against the limit surface, is collapsed with a proven
//! distance of the result from it; both distances add up.

use super::adaptive::adaptive;
use super::corner_sources::{SharpLines, corner_sources, features};
use super::kept_faces::KeptFaces;
use super::{
    Caps, ErrorBounds, Exact, ExactOptions, ExactStop, Finish, Goals, Origin, RefineError,
    Statistics, Traced,
};
use crate::index::{HalfEdgeId, VertexId};
use crate::measure::{MeasureError, distances_to_observed};
use crate::mesh::{Mesh, MeshError};
use crate::progress::{Cancelled, Observer};
use crate::scheme::Scheme;
use crate::simplify::{Features, Simplified, SimplifyOptions, simplify_observed};

/// The part of the tolerance that the fine mesh takes: less leaves more to the collapse and costs more triangles to
/// collapse, eight times those of refinement alone where the surface is curved both ways.
const FINE_SHARE: f64 = 1.0 / 8.0;

/// Triangles of the fine mesh for each requested triangle: with half as many its own error matters.
const FINE_TIMES: usize = 16;

/// The most triangles of a fine mesh without a cap: some gigabytes. A greater cap on the result is
/// the fine mesh's too.
const AFFORDABLE: usize = 8_000_000;

/// Refines and collapses.
pub(super) fn simplified(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Exact, RefineError> {
    let times = |count: Option<usize>| count.map(|count| count.saturating_mul(FINE_TIMES));
    let ExactOptions { goals, caps, .. } = options;
    let fine_options = ExactOptions {
        finish: Finish::OnSurface,
        // Edges that are kept are edges of the fine mesh.
        flat_regions: options.flat_regions && options.kept_edges.is_empty(),
        goals: Goals {
            tolerance: goals.tolerance.map(|tolerance| FINE_SHARE * tolerance),
            triangles: times(goals.triangles),
            ..Goals::default()
        },
        caps: Caps {
            // The cap is on the result.
            triangles: caps
                .triangles
                .map(|cap| cap.saturating_mul(FINE_TIMES).min(AFFORDABLE).max(cap)),
            ..*caps
        },
        ..options.clone()
    };
    let kept = KeptFaces::of(control, &options.kept_edges)?;
    let fine = adaptive(control, scheme, &fine_options, observer)?;
    let features = features(kept.edges(&fine));
    let allowance = goals
        .tolerance
        .map(|tolerance| tolerance - fine.error.upper)
        .filter(|&left| left > 0.0);
    let fewest = [goals.triangles, caps.triangles]
        .into_iter()
        .flatten()
        .min();
    let mut collapsed = match (allowance, goals.tolerance, fewest) {
        (Some(_), ..) => collapse((&fine.mesh, &features), allowance, None, observer)?,
        // A cap ended the refinement before the tolerance left anything to collapse.
        (None, Some(_), None) => return Ok(fine),
        (None, ..) => collapse((&fine.mesh, &features), None, fewest, observer)?,
    };
    // More than there may be within the tolerance, so as many as there may be.
    let most = fewest.unwrap_or(usize::MAX);
    if allowance.is_some() && collapsed.mesh.face_count() > most {
        collapsed = collapse((&fine.mesh, &features), None, fewest, observer)?;
    }
    let unoptimised = ExactOptions {
        finish: Finish::OnSurface,
        ..options.clone()
    };
    // Where no more edges can go, refinement alone keeps the number of triangles; where there is no
    // proof, it proves.
    let is_over = collapsed.mesh.face_count() > most;
    if is_over || collapsed.bound.is_none() {
        let plain = adaptive(control, scheme, &unoptimised, observer)?;
        if !is_over || plain.mesh.face_count() < collapsed.mesh.face_count() {
            return Ok(plain);
        }
    }
    let error = error_bounds(&fine, &collapsed, observer)?;
    let is_met = goals
        .tolerance
        .is_some_and(|tolerance| error.upper <= tolerance);
    // Refinement alone may need fewer, as at semi-sharp edges, and takes little time compared with
    // this.
    if goals.tolerance.is_some() {
        let plain = adaptive(control, scheme, &unoptimised, observer)?;
        if plain.stop == ExactStop::Met
            && (!is_met || plain.mesh.face_count() <= collapsed.mesh.face_count())
        {
            return Ok(plain);
        }
    }
    let Inherited {
        sides,
        side_origins,
        parents,
    } = Inherited::new(control, &fine, &features, &collapsed);
    let count = collapsed.mesh.face_count();
    let stop = match goals.triangles {
        _ if is_met => ExactStop::Met,
        Some(goal) if caps.triangles.is_some_and(|cap| cap < goal) => ExactStop::TriangleCap,
        Some(goal) if count <= goal => ExactStop::Triangles,
        _ if fine.stop == ExactStop::Met => ExactStop::TriangleCap,
        _ => fine.stop,
    };
    Ok(Exact {
        normals: collapsed
            .vertices
            .iter()
            .map(|&v| fine.normals[v as usize])
            .collect(),
        origins: match &fine.origins[..] {
            [] => Vec::new(),
            origins => collapsed
                .vertices
                .iter()
                .map(|&v| origins[v as usize])
                .collect(),
        },
        sides,
        within_rims: fine.within_rims,
        parents,
        side_origins: Some(side_origins),
        error,
        pixels: None,
        attribute_bounds: Vec::new(),
        stop,
        statistics: Statistics {
            worst: goals
                .tolerance
                .map_or(0.0, |tolerance| error.upper / tolerance),
            refused: collapsed.refused,
            ..fine.statistics
        },
        mesh: collapsed.mesh,
    })
}

/// Collapses edges of the fine mesh.
fn collapse(
    (fine, features): (&Mesh, &Features),
    tolerance: Option<f64>,
    triangles: Option<usize>,
    observer: &mut Observer<'_>,
) -> Result<Simplified, RefineError> {
    let goals = SimplifyOptions::default()
        .tolerance(tolerance)
        .triangles(triangles);
    Ok(simplify_observed(fine, features, &goals, observer)?)
}

/// The data that the corners and triangles of the collapsed mesh have from the fine one, each on
/// its side of sharp edges.
struct Inherited {
    sides: Vec<(u32, [f64; 3])>,
    side_origins: Vec<(u32, Origin)>,
    parents: Vec<u32>,
}

impl Inherited {
    fn new(control: &Mesh, fine: &Exact, features: &Features, collapsed: &Simplified) -> Self {
        let lines = SharpLines::new(&fine.mesh, &features.edges);
        let sources = corner_sources(&fine.mesh, &lines, &collapsed.mesh, &collapsed.vertices);
        let normal = |&(corner, own): &(u32, u32)| (corner, fine.corner_normal(HalfEdgeId(own)));
        let sides = if fine.sides.is_empty() {
            Vec::new()
        } else {
            sources.iter().map(normal).collect()
        };
        let origin = |&(corner, own): &(u32, u32)| {
            Some((
                corner,
                fine.corner_origin(control.triangles(), HalfEdgeId(own))?,
            ))
        };
        let side_origins = sources.iter().filter_map(origin).collect();
        // Where sides need not be distinguished, any triangle around a corner will do.
        let topology = fine.mesh.topology();
        let any = |triangle: &[u32; 3]| {
            topology
                .outgoing(VertexId(collapsed.vertices[triangle[0] as usize]))
                .0
        };
        let mut own: Vec<u32> = collapsed.mesh.triangles().iter().map(any).collect();
        for &(corner, source) in &sources {
            own[corner as usize / 3] = source;
        }
        let parents = own
            .into_iter()
            .map(|h| fine.parents[HalfEdgeId(h).face().index()])
            .collect();
        Self {
            sides,
            side_origins,
            parents,
        }
    }
}

/// How far the collapsed mesh can be from the limit surface, on which the fine mesh's vertices lie.
fn error_bounds(
    fine: &Exact,
    collapsed: &Simplified,
    observer: &mut Observer<'_>,
) -> Result<ErrorBounds, RefineError> {
    let (lower, at) = farthest(&fine.mesh, &collapsed.mesh, observer)?;
    let upper = collapsed.bound.unwrap_or(f64::INFINITY) + fine.error.upper;
    Ok(ErrorBounds {
        lower,
        upper,
        at,
        certified: fine.error.certified,
    })
}

/// The greatest distance of a fine mesh's vertices, which are points of the surface, to another mesh, and where.
fn farthest(
    fine: &Mesh,
    coarse: &Mesh,
    observer: &mut Observer<'_>,
) -> Result<(f64, [f64; 3]), RefineError> {
    let broken = |why: MeasureError| match why {
        MeasureError::Cancelled(_) => RefineError::Cancelled(Cancelled),
        why => MeshError::Broken {
            place: why.to_string(),
            what: "an optimised mesh can be measured",
        }
        .into(),
    };
    let distances =
        distances_to_observed(fine.positions(), coarse.as_triangles(), observer).map_err(broken)?;
    let farthest = distances
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(b.1));
    Ok(farthest.map_or((0.0, [0.0; 3]), |(v, &distance)| {
        (distance, fine.positions()[v])
    }))
}
