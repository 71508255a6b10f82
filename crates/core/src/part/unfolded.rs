//! Control meshes that lead a surface through the vertices of a mesh, but not where it would fold.
//!
//! Between slivers, as programs that cut solids leave them, control points for a surface through all vertices lie far away, and
//! the surface turns over. So the surface is refined, and where a piece of it is turned over against the face that it is over, or
//! against its own limit normals, the vertices of that face are taken for control points as they are: the surface passes by them. With
//! what is around them solved anew that is looked at again, and more vertices follow until nothing folds.

use crate::error_messages;
use crate::geometry::DisjointSets;
use crate::index::VertexId;
use crate::interpolate::{InterpolateError, InterpolateOptions, Interpolated, interpolate_but};
use crate::mesh::{Mesh, Sharpness};
use crate::parallel;
use crate::progress::{Observer, unobserved};
use crate::refine::{
    ExactOptions, RefineError, UniformOptions, UniformTriangles, exact_observed,
    uniform_triangles_observed,
};
use crate::scheme::Scheme;
use crate::vector::{DVec3, vector};

/// After so many attempts the components that still fold are not led through any vertex.
const MOST_ATTEMPTS: usize = 10;

/// Levels by which faces are divided to see whether they fold, of meshes that get this many triangles at most.
const LEVELS: usize = 3;
const MOST_TRIANGLES: usize = 4_000_000;

/// How near to the surface, as a share of the diagonal, the triangles are that are looked at last.
const TOLERANCE: f64 = 1e-3;

/// Normals of faces in one plane differ by no more, slivers between rounded vertices included; and these are off it by no more than this
/// part of the greatest coordinate.
const ALIKE: f64 = 1e-3;
const IN_PLANE: f64 = 2e-7;

/// A triangle whose area against the normal is no more than this part of its share of the face is flat to rounding.
const ROUNDING: f64 = 1e-7;

/// Why there are no control points.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum UnfoldedError {
    /// There are none for any vertices.
    Interpolate(InterpolateError),
    /// The surface could not be looked at.
    Refine(RefineError),
}

error_messages! {
    UnfoldedError {}
    from { Interpolate(InterpolateError), Refine(RefineError) }
}

/// A control mesh, and where its surface passes by vertices so that it does not fold.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Unfolded {
    /// The control mesh; vertices that keep their place are among those [passed by](Interpolated::relaxed).
    pub interpolated: Interpolated,
    /// Regions that would fold if the surface passed through all vertices, the one with most faces first.
    pub folded: Vec<FoldedRegion>,
}

/// Adjacent faces over which a surface would fold.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FoldedRegion {
    /// The faces, ascending.
    pub faces: Vec<u32>,
    /// The bounding box of their vertices: the least coordinates and the greatest.
    pub bounding_box: [[f64; 3]; 2],
}

/// The control mesh whose limit surface passes through the vertices of `mesh`, but for those around which it would fold.
///
/// Faces that fold as well if all vertices are control points are left as they are.
///
/// # Errors
/// A vertex has no limit, or a control point would not be finite.
pub fn interpolate_unfolded(mesh: &Mesh, scheme: &dyn Scheme) -> Result<Unfolded, UnfoldedError> {
    interpolate_unfolded_observed(mesh, scheme, &mut unobserved)
}

/// [`interpolate_unfolded`], telling an observer how it goes on.
///
/// # Errors
/// [`interpolate_unfolded`] that can be cancelled.
pub fn interpolate_unfolded_observed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    observer: &mut Observer<'_>,
) -> Result<Unfolded, UnfoldedError> {
    let options = InterpolateOptions::default();
    let mut kept = Kept {
        mesh,
        is_kept: vec![false; mesh.vertex_count()],
    };
    let is_flat = flat_within_rims(mesh);
    let mut folded = vec![false; mesh.face_count()];
    let mut anyway = None;
    let mut attempt = 0;
    loop {
        let interpolated = interpolate_but(mesh, scheme, &options, &kept.vertices(), observer)?;
        let mut folding = folding(mesh, &interpolated, scheme, observer)?;
        if anyway.is_none() && !folding.is_empty() {
            anyway = Some(faces_folding(mesh, mesh, scheme, observer)?);
        }
        if let Some(anyway) = &anyway {
            folding.retain(|face| !is_flat[*face as usize] && anyway.binary_search(face).is_err());
        }
        if folding.is_empty() && anyway.is_some() {
            folding = turned_over(&interpolated.mesh, scheme, observer)?;
        }
        if folding.is_empty() || attempt == MOST_ATTEMPTS {
            return Ok(Unfolded {
                interpolated,
                folded: regions(mesh, &folded),
            });
        }
        folding
            .iter()
            .for_each(|&face| folded[face as usize] = true);
        attempt += 1;
        match attempt {
            MOST_ATTEMPTS => kept.add_components(&folding),
            _ => kept.add(&folding),
        }
    }
}

/// By face, whether it is part of a plane region between sharp edges or boundaries. There the surface is what these enclose, which exact
/// refinement sees to, whatever becomes of the faces inside.
fn flat_within_rims(mesh: &Mesh) -> Vec<bool> {
    let (topology, sharpness) = (mesh.topology(), Sharpness::of(mesh));
    let normals = parallel::map(mesh.face_count(), |face| mesh.unit_face_normal(face));
    let mut regions = DisjointSets::new(mesh.face_count());
    // Smooth edges at which faces meet at an angle are no rims.
    let mut bent = Vec::new();
    for h in topology
        .half_edges()
        .filter(|&h| sharpness.edge(h) < f64::INFINITY)
    {
        let Some(twin) = topology.twin(h) else {
            continue;
        };
        let [m, n] = [h, twin].map(|h| normals[h.face().index()]);
        match m.cross(n).length() <= ALIKE && m.dot(n) > 0.0 {
            true => _ = regions.unite(h.face().0, twin.face().0),
            false => bent.push(h.face().0),
        }
    }
    let regions = regions.into_roots();
    let area = |face: usize| mesh.face_normal_vector(face).length();
    let mut largest = regions.clone();
    for (face, &region) in regions.iter().enumerate() {
        let known = &mut largest[region as usize];
        *known = if area(face) > area(*known as usize) {
            face as u32
        } else {
            *known
        };
    }
    let size = mesh
        .positions()
        .as_flattened()
        .iter()
        .fold(0.0f64, |size, x| size.max(x.abs()));
    let mut is_flat = vec![true; mesh.face_count()];
    bent.into_iter()
        .for_each(|face| is_flat[regions[face as usize] as usize] = false);
    for (face, &region) in regions.iter().enumerate() {
        let plane = largest[region as usize] as usize;
        let [from, ..] = mesh.as_triangles().corners(plane).map(vector);
        let off = mesh
            .as_triangles()
            .corners(face)
            .map(|p| normals[plane].dot(vector(p) - from).abs());
        is_flat[region as usize] &= off.into_iter().all(|off| off <= IN_PLANE * size);
    }
    regions
        .iter()
        .map(|&region| is_flat[region as usize])
        .collect()
}

/// The control faces of triangles that are turned over after all in a finely refined surface, where flat regions are what their rims enclose.
fn turned_over(
    control: &Mesh,
    scheme: &dyn Scheme,
    observer: &mut Observer<'_>,
) -> Result<Vec<u32>, RefineError> {
    let options = ExactOptions::default()
        .tolerance(TOLERANCE * control.diagonal())
        .unfold(true);
    let refined = exact_observed(control, scheme, &options, observer)?;
    let mut faces: Vec<u32> = refined
        .turned_over()
        .iter()
        .filter_map(|&face| refined.parents.get(face as usize).copied())
        .collect();
    faces.sort_unstable();
    faces.dedup();
    Ok(faces)
}

/// The faces over which the surface of control points folds, ascending.
fn folding(
    mesh: &Mesh,
    interpolated: &Interpolated,
    scheme: &dyn Scheme,
    observer: &mut Observer<'_>,
) -> Result<Vec<u32>, RefineError> {
    if interpolated.displacement == 0.0 {
        return Ok(Vec::new());
    }
    faces_folding(mesh, &interpolated.mesh, scheme, observer)
}

fn faces_folding(
    mesh: &Mesh,
    control: &Mesh,
    scheme: &dyn Scheme,
    observer: &mut Observer<'_>,
) -> Result<Vec<u32>, RefineError> {
    let levels = (1..=LEVELS)
        .rev()
        .find(|levels| mesh.face_count() << (2 * levels) <= MOST_TRIANGLES);
    let levels = levels.unwrap_or(1);
    let options = UniformOptions::default()
        .levels(levels)
        .limit(true)
        .normals(true);
    let surface = uniform_triangles_observed(control, scheme, &options, observer)?;
    let parts = 1 << (2 * surface.levels);
    let turns_over = |face: usize| {
        let outwards = mesh.face_normal_vector(face) / parts as f64;
        (parts * face..parts * (face + 1)).any(|part| is_turned_over(&surface, part, outwards))
    };
    let found = parallel::map(mesh.face_count(), turns_over);
    Ok((0..)
        .zip(found)
        .filter(|&(_, folds)| folds)
        .map(|(face, _)| face)
        .collect())
}

/// Whether a triangle looks away from its share of the normal of the face that it is over, or from its own limit normals.
fn is_turned_over(surface: &UniformTriangles, triangle: usize, outwards: DVec3) -> bool {
    let [a, b, c] = surface.as_triangles().corners(triangle).map(vector);
    let own = (b - a).cross(c - a);
    let least = -ROUNDING * outwards.length();
    let normal = |corner: usize| {
        let sides = &surface.sides;
        let side =
            sides.binary_search_by_key(&((3 * triangle + corner) as u32), |&(corner, _)| corner);
        let vertex = surface.triangles[triangle][corner] as usize;
        vector(side.map_or(surface.normals[vertex], |place| sides[place].1))
    };
    own.dot(outwards) < least * outwards.length()
        || (0..3).any(|corner| own.dot(normal(corner)) < least)
}

/// Vertices that keep their place.
struct Kept<'m> {
    mesh: &'m Mesh,
    is_kept: Vec<bool>,
}

impl Kept<'_> {
    fn vertices(&self) -> Vec<VertexId> {
        (0..)
            .zip(&self.is_kept)
            .filter(|&(_, &is_kept)| is_kept)
            .map(|(v, _)| VertexId(v))
            .collect()
    }

    /// The vertices of faces; of faces that had no others before, all around these, too.
    fn add(&mut self, faces: &[u32]) {
        let corners = |face: &u32| self.mesh.triangles()[*face as usize].map(VertexId);
        let is_kept = |v: &VertexId| self.is_kept[v.index()];
        let settled = faces
            .iter()
            .filter(|face| corners(face).iter().all(is_kept))
            .flat_map(corners);
        let around = settled.flat_map(|v| self.mesh.topology().ring(v));
        let added: Vec<VertexId> = faces.iter().flat_map(corners).chain(around).collect();
        added
            .into_iter()
            .for_each(|v| self.is_kept[v.index()] = true);
    }

    /// All vertices of the components that faces belong to.
    fn add_components(&mut self, faces: &[u32]) {
        let mut components = DisjointSets::new(self.mesh.vertex_count());
        for &[a, b, c] in self.mesh.triangles() {
            components.unite(a, b);
            components.unite(b, c);
        }
        let roots = components.into_roots();
        let mut is_own = vec![false; roots.len()];
        for &face in faces {
            is_own[roots[self.mesh.triangles()[face as usize][0] as usize] as usize] = true;
        }
        self.is_kept
            .iter_mut()
            .zip(&roots)
            .for_each(|(kept, &root)| *kept |= is_own[root as usize]);
    }
}

/// Faces that share vertices, together.
fn regions(mesh: &Mesh, is_own: &[bool]) -> Vec<FoldedRegion> {
    let triangles = mesh.triangles();
    let faces = || (0..mesh.face_count() as u32).filter(|&face| is_own[face as usize]);
    let mut vertices = DisjointSets::new(mesh.vertex_count());
    for face in faces() {
        let [a, b, c] = triangles[face as usize];
        vertices.unite(a, b);
        vertices.unite(b, c);
    }
    let mut by_root = std::collections::BTreeMap::<u32, Vec<u32>>::new();
    faces().for_each(|face| {
        by_root
            .entry(vertices.root(triangles[face as usize][0]))
            .or_default()
            .push(face);
    });
    let region = |faces: Vec<u32>| {
        let corners = faces.iter().flat_map(|&face| triangles[face as usize]);
        let points = corners.map(|v| vector(mesh.positions()[v as usize]));
        let (low, high) = points.fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), point| (low.min(point), high.max(point)),
        );
        FoldedRegion {
            faces,
            bounding_box: [low.to_array(), high.to_array()],
        }
    };
    let mut all: Vec<FoldedRegion> = by_root.into_values().map(region).collect();
    all.sort_by_key(|region| std::cmp::Reverse(region.faces.len()));
    all
}
