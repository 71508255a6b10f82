//! Exact refinement followed by edge collapse: the fewest triangles for a tolerance.
//!
//! A mesh finer than asked for, certified against the limit surface, is collapsed with proof of how far the result is from
//! it; both distances add up.

use super::adaptive::adaptive;
use super::corner_sources::{SharpLines, corner_sources, features};
use super::kept_faces::KeptFaces;
use super::{ErrorBounds, Exact, ExactOptions, ExactStop, Origin, RefineError, Traced};
use crate::index::{HalfEdgeId, VertexId};
use crate::measure::{MeasureError, distances_to_observed};
use crate::mesh::{Mesh, MeshError};
use crate::progress::{Cancelled, Observer};
use crate::scheme::Scheme;
use crate::simplify::{Features, Simplified, SimplifyOptions, simplify_observed};

/// The part of the tolerance that the fine mesh takes: less leaves more to the collapse and costs more triangles to
/// collapse, eight times those of refinement alone where the surface is curved both ways.
const FINE_SHARE: f64 = 1.0 / 8.0;

/// Where the surface is curved one way, or along sharp edges alone, that is less than three times as many. Vertices of the fine mesh go one by
/// one there, so that edges only have so many lengths: with this much of the tolerance these lie close together.
const FINER_SHARE: f64 = FINE_SHARE * FINE_SHARE;

/// Triangles of the fine mesh for each triangle of refinement alone at most.
const MOST_TIMES: f64 = 10.0;

/// Triangles of the fine mesh for each triangle asked for: with half as many its own error is felt.
const FINE_TIMES: usize = 16;

/// Triangles of a fine mesh that nobody asked about: some gigabytes. A greater cap on the result is the fine mesh's too.
const AFFORDABLE: usize = 8_000_000;

/// Refines and collapses.
pub(super) fn simplified(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Exact, RefineError> {
    let times = |count: Option<usize>| count.map(|count| count.saturating_mul(FINE_TIMES));
    let fine_options = ExactOptions {
        optimize: false,
        // Edges that are kept are edges of the fine mesh.
        flat_regions: options.flat_regions && options.kept_edges.is_empty(),
        triangles: times(options.triangles),
        // What is capped is the result.
        max_triangles: options
            .max_triangles
            .map(|cap| cap.saturating_mul(FINE_TIMES).min(AFFORDABLE).max(cap)),
        ..options.clone()
    };
    let kept = KeptFaces::of(control, &options.kept_edges)?;
    let unoptimised = ExactOptions { optimize: false, ..options.clone() };
    let alone = |observer: &mut Observer<'_>| adaptive(control, scheme, &unoptimised, observer);
    let mut plain = options.tolerance.map(|_| alone(observer)).transpose()?;
    let refined =
        |options: &ExactOptions, observer: &mut Observer<'_>| adaptive(control, scheme, options, observer);
    let fine = fine_mesh(&fine_options, plain.as_ref(), refined, observer)?;
    let features = features(kept.edges(&fine));
    let allowance =
        options.tolerance.map(|tolerance| tolerance - fine.error.upper).filter(|&left| left > 0.0);
    let fewest = [options.triangles, options.max_triangles].into_iter().flatten().min();
    let mut collapsed = match (allowance, options.tolerance, fewest) {
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
    // Where no more edges can go, refinement alone keeps the number of triangles; where nothing is proven, it proves.
    let is_over = collapsed.mesh.face_count() > most;
    if is_over || collapsed.bound.is_none() {
        let found = match plain.take() {
            Some(found) => found,
            None => alone(observer)?,
        };
        if !is_over || found.mesh.face_count() < collapsed.mesh.face_count() {
            return Ok(found);
        }
    }
    let error = error_bounds(&fine, &collapsed, observer)?;
    let is_met = options.tolerance.is_some_and(|tolerance| error.upper <= tolerance);
    // Refinement alone may need fewer, as beside edges that are sharp for a while.
    let is_better = |plain: &Exact| {
        plain.stop == ExactStop::Met && (!is_met || plain.mesh.face_count() <= collapsed.mesh.face_count())
    };
    if let Some(plain) = plain.filter(is_better) {
        return Ok(plain);
    }
    let Inherited { sides, side_origins, parents } = Inherited::new(control, &fine, &features, &collapsed);
    let count = collapsed.mesh.face_count();
    let stop = match options.triangles {
        _ if is_met => ExactStop::Met,
        Some(goal) if options.max_triangles.is_some_and(|cap| cap < goal) => ExactStop::TriangleCap,
        Some(goal) if count <= goal => ExactStop::Triangles,
        _ if fine.stop == ExactStop::Met => ExactStop::TriangleCap,
        _ => fine.stop,
    };
    Ok(Exact {
        normals: collapsed.vertices.iter().map(|&v| fine.normals[v as usize]).collect(),
        origins: match &fine.origins[..] {
            [] => Vec::new(),
            origins => collapsed.vertices.iter().map(|&v| origins[v as usize]).collect(),
        },
        sides,
        off_planes: fine.off_planes,
        unfolded: fine.unfolded,
        within_rims: fine.within_rims,
        parents,
        is_optimized: true,
        side_origins,
        error,
        pixels: None,
        attribute_bounds: Vec::new(),
        open_cones: 0,
        worst: options.tolerance.map_or(0.0, |tolerance| error.upper / tolerance),
        stop,
        levels: fine.levels,
        refused: collapsed.refused,
        mesh: collapsed.mesh,
    })
}

/// The mesh that is collapsed: nearer than the tolerance by a part of it that leaves a number of triangles for each one of refinement alone.
fn fine_mesh(
    options: &ExactOptions,
    plain: Option<&Exact>,
    refined: impl Fn(&ExactOptions, &mut Observer<'_>) -> Result<Exact, RefineError>,
    observer: &mut Observer<'_>,
) -> Result<Exact, RefineError> {
    let within = |share: f64| ExactOptions {
        tolerance: options.tolerance.map(|most| share * most),
        ..options.clone()
    };
    let fine = refined(&within(FINE_SHARE), observer)?;
    let Some(plain) = plain.filter(|_| fine.stop == ExactStop::Met) else { return Ok(fine) };
    let [alone, count] = [plain, &fine].map(|found| found.mesh.face_count() as f64);
    // As many times as many as the first part took.
    let finer = count * count / alone;
    if count == alone || finer > MOST_TIMES * alone {
        return Ok(fine);
    }
    let finer = refined(&within(FINER_SHARE), observer)?;
    Ok(if finer.stop == ExactStop::Met { finer } else { fine })
}

/// Collapses edges of the fine mesh.
fn collapse(
    (fine, features): (&Mesh, &Features),
    tolerance: Option<f64>,
    triangles: Option<usize>,
    observer: &mut Observer<'_>,
) -> Result<Simplified, RefineError> {
    let goals = SimplifyOptions::default().tolerance(tolerance).triangles(triangles);
    Ok(simplify_observed(fine, features, &goals, observer)?)
}

/// What the corners and triangles of the collapsed mesh have of the fine one's, each on its side of sharp edges.
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
        let sides = if fine.sides.is_empty() { Vec::new() } else { sources.iter().map(normal).collect() };
        let origin = |&(corner, own): &(u32, u32)| {
            Some((corner, fine.corner_origin(control.triangles(), HalfEdgeId(own))?))
        };
        let side_origins: Vec<(u32, Origin)> = sources.iter().filter_map(origin).collect();
        // Where no side is to be told, any triangle around a corner will do.
        let topology = fine.mesh.topology();
        let any =
            |triangle: &[u32; 3]| topology.outgoing(VertexId(collapsed.vertices[triangle[0] as usize])).0;
        let mut own: Vec<u32> = collapsed.mesh.triangles().iter().map(any).collect();
        for &(corner, source) in &sources {
            own[corner as usize / 3] = source;
        }
        let parents = own.into_iter().map(|h| fine.parents[HalfEdgeId(h).face().index()]).collect();
        Self { sides, side_origins, parents }
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
    Ok(ErrorBounds { lower, upper, at, certified: fine.error.certified })
}

/// The greatest distance of a fine mesh's vertices, which are points of the surface, to another mesh, and where.
fn farthest(fine: &Mesh, coarse: &Mesh, observer: &mut Observer<'_>) -> Result<(f64, [f64; 3]), RefineError> {
    let broken = |why: MeasureError| match why {
        MeasureError::Cancelled(_) => RefineError::Cancelled(Cancelled),
        why => MeshError::Broken { place: why.to_string(), what: "an optimised mesh can be measured" }.into(),
    };
    let distances =
        distances_to_observed(fine.positions(), coarse.as_triangles(), observer).map_err(broken)?;
    let farthest = distances.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    Ok(farthest.map_or((0.0, [0.0; 3]), |(v, &distance)| (distance, fine.positions()[v])))
}
