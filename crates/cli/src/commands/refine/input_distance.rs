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

use std::borrow::Cow;

use limitmesh::measure::{Bvh, CertifiedOptions, MeasureError, certified_hausdorff_between_observed};
use limitmesh::mesh::FaceParts;
use limitmesh::part::Look;
use limitmesh::progress::Observer;
use limitmesh::refine::{Exact, ExactOptions, Origin, exact_observed};
use limitmesh::{FaceId, Mesh, Triangles};

use super::INTERPOLATE;
use super::control::{Before, BeforeSurface};
use super::goals::{Goals, unit_in_words};
use crate::arguments::{MOST_EXACT, RefineArguments};
use crate::format::{counted, number};
use crate::pieces::pieces;
use crate::progress::Progress;
use crate::report::{ErrorReport, InputDistanceReport};
use crate::vector::{cross, distance, dot, length, minus};

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
        let moved = Moves::of(input, found, origins);
        let rounding = ROUNDING * greatest(input);
        let lower = lower(input, (found, origins), &moved)? - rounding;
        let off_planes = if found.off_planes > 0.0 { 2.0 * found.off_planes + residual } else { 0.0 };
        Ok(Some(Self { lower: lower.max(0.0), upper: moved.greatest + off_planes + rounding }))
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
        let lower = lower(input, (found, origins), &Moves::of(input, found, origins))?;
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
    let origins = on_whole(parts, found);
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
    let moved = InputDistance::new(input, (&between, &on_whole(parts, &between)), residual)?;
    Ok(moved.map(|moved| narrowed(moved.of_other(input, (found, &origins), apart)?)).transpose()?)
}

/// Where vertices came from, on faces that were divided where they are whole.
fn on_whole<'a>(parts: &FaceParts, found: &'a Exact) -> Cow<'a, [Origin]> {
    if parts.is_empty() {
        return Cow::Borrowed(&found.origins);
    }
    let origins = found.origins.iter().map(|origin| parts.on_whole(origin.face, origin.barycentric));
    origins.map(|(face, barycentric)| Origin { face, barycentric }).collect()
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
    if lies_in_a_plane(control) {
        // All that can move is the outline.
        let is_open = arguments.features.boundary.is_none() && control.topology().boundary_edge_count() > 0;
        lines.extend(is_open.then(|| "(--boundary fixed would keep the outline)".to_owned()));
        return lines;
    }
    let is_decided = arguments.features.angle().is_some() || !control.tags().creases.is_empty();
    if let Some(Look::Part(part)) = (!is_decided).then(|| Look::of(control, &[])) {
        let edges = counted(part.creases.edges.len(), "edge that looks", "edges that look");
        lines.push(format!("(--crease-angle {} would keep {edges} sharp)", number(part.degrees)));
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

/// How far the normals of faces in one plane may differ, as a sine: single precision leaves less.
const IN_PLANE: f64 = 1e-5;

/// Whether all faces are in one plane, or in parallel ones, whichever side of them is up.
fn lies_in_a_plane(mesh: &Mesh) -> bool {
    let normals = || (0..mesh.face_count() as u32).map(|face| mesh.face_normal(FaceId(face)));
    let largest = normals().max_by(|a, b| dot(*a, *a).total_cmp(&dot(*b, *b)));
    let Some(plane) = largest else { return false };
    normals().all(|normal| length(cross(normal, plane)) <= IN_PLANE * length(normal) * length(plane))
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

/// How far vertices are from where they came from.
struct Moves {
    /// The greatest.
    greatest: f64,
    /// Those that were moved most along normals, in their order.
    most: Vec<usize>,
}

impl Moves {
    fn of(input: Triangles<'_>, found: &Exact, origins: &[Origin]) -> Self {
        let positions = found.mesh.positions();
        let parts = pieces(origins.len(), |vertices| {
            let (mut greatest, mut most) = (0.0f64, Vec::with_capacity(MEASURED + 1));
            for vertex in vertices {
                let step = minus(positions[vertex], place(input, &origins[vertex]));
                greatest = greatest.max(length(step));
                insert(&mut most, (dot(step, found.normals[vertex]).abs(), vertex));
            }
            (greatest, most)
        });
        let mut all = Self { greatest: 0.0, most: Vec::new() };
        let mut most = Vec::new();
        for (greatest, of_part) in parts {
            all.greatest = all.greatest.max(greatest);
            of_part.into_iter().for_each(|one| insert(&mut most, one));
        }
        all.most.extend(most.into_iter().map(|(_, vertex)| vertex));
        all.most.sort_unstable();
        all
    }
}

/// Puts a number and its vertex into a short list of the greatest, of equal ones behind those that are there.
fn insert(most: &mut Vec<(f64, usize)>, one: (f64, usize)) {
    let at = most.partition_point(|known| known.0 >= one.0);
    if at < MEASURED {
        most.insert(at, one);
        most.truncate(MEASURED);
    }
}

/// The greatest true distance among the vertices that were moved most along normals, to the input, and of where they came from,
/// to the result.
fn lower(
    input: Triangles<'_>,
    (found, origins): (&Exact, &[Origin]),
    moved: &Moves,
) -> Result<f64, MeasureError> {
    let result = found.mesh.as_triangles();
    let (here, there): (Vec<_>, Vec<_>) = moved
        .most
        .iter()
        .map(|&vertex| {
            let (here, there) = (found.mesh.positions()[vertex], place(input, &origins[vertex]));
            let far = distance(here, there);
            ((here, far), (there, far))
        })
        .unzip();
    Ok(greatest_distance(&here, input)?.max(greatest_distance(&there, result)?))
}

/// The greatest distance of some points from a surface that comes within a reach of each.
fn greatest_distance(points: &[([f64; 3], f64)], surface: Triangles<'_>) -> Result<f64, MeasureError> {
    // Only triangles that come so near can be the closest.
    let reached = points.iter().map(|&(point, reach)| {
        let reach = reach * (1.0 + ROUNDING) + f64::MIN_POSITIVE;
        (point.map(|x| x - reach), point.map(|x| x + reach))
    });
    let reached: Vec<([f64; 3], [f64; 3])> = reached.collect();
    let is_near = |corners: &[[f64; 3]; 3], (from, to): &([f64; 3], [f64; 3])| {
        (0..3).all(|axis| {
            corners.iter().any(|p| p[axis] <= to[axis]) && corners.iter().any(|p| from[axis] <= p[axis])
        })
    };
    let near = pieces(surface.triangles.len(), |faces| {
        let mut near = vec![Vec::new(); points.len()];
        for corners in faces.map(|face| surface.corners(face)) {
            for (near, reached) in near.iter_mut().zip(&reached) {
                if is_near(&corners, reached) {
                    near.push(corners);
                }
            }
        }
        near
    });
    let mut greatest = 0.0f64;
    for (at, &(point, _)) in points.iter().enumerate() {
        let near: Vec<[f64; 3]> = near.iter().flat_map(|near| near[at].as_flattened()).copied().collect();
        if near.is_empty() {
            continue;
        }
        let triangles: Vec<_> = (0..near.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let near = Bvh::new(Triangles { positions: &near, triangles: &triangles })?;
        greatest = greatest.max(near.closest(point).distance);
    }
    Ok(greatest)
}
