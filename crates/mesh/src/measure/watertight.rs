//! Watertightness: boundary edges, non-manifold edges, T-junctions, Euler characteristic.
//!
//! Takes any triangles, manifold or not, at most 2^32 / 3 of them, and reads their connections off the vertex indices.
//! Positions matter only to T-junctions.

mod t_junctions;
#[cfg(test)]
mod tests;

use std::borrow::Cow;

use crate::geometry::{DisjointSets, for_each_edge};
use crate::mesh::Triangles;
use crate::progress::{Cancelled, Observer, Stage, Watch, uncancelled};

/// The defects that keep a surface from being a closed, conforming manifold.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Watertightness {
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Edges with more than two faces.
    pub non_manifold_edges: usize,
    /// Edges with two faces that run along it in one direction.
    pub inconsistent_edges: usize,
    /// Vertices on the inside of a boundary edge of others: within 1e-5 of its length from it and
    /// farther than that from its ends. Vertices of different index at one position alone are no
    /// T-junction.
    pub t_junctions: usize,
    /// Triangles that name a vertex twice. The other counts ignore them.
    pub degenerate_faces: usize,
    /// Number of connected components, joined through edges.
    pub components: usize,
    /// Vertices in use − edges + faces.
    pub euler_characteristic: i64,
}

impl Watertightness {
    /// Whether the surface encloses a volume: no boundary, no non-manifold and no inconsistent edge.
    pub fn is_watertight(&self) -> bool {
        self.boundary_edges == 0 && self.non_manifold_edges == 0 && self.inconsistent_edges == 0
    }
}

/// Examines a surface by its indices and, for T-junctions, its positions.
///
/// Indices that name no position are counted like any other, but lie on no edge.
pub fn watertightness(surface: Triangles<'_>) -> Watertightness {
    uncancelled(|observer| watertightness_observed(surface, observer))
}

/// [`watertightness`] with an observer.
///
/// # Errors
/// The observer asked to stop.
pub fn watertightness_observed(
    surface: Triangles<'_>,
    observer: &mut Observer<'_>,
) -> Result<Watertightness, Cancelled> {
    let mut watch = Watch::new(observer, Stage::Matching);
    watch.triangles(surface.triangles.len());
    watch.stage(Stage::Matching, Some(surface.triangles.len()))?;
    let vertices = used_vertices(surface.triangles);
    let greatest = vertices.last().map_or(0, |&v| v as usize + 1);
    // Indices far beyond the number of corners must not make lists as long as the greatest of them.
    let (triangles, names) = if greatest / 8 > 3 * surface.triangles.len() {
        let place = |v: &u32| vertices.partition_point(|other| other < v) as u32;
        (
            surface
                .triangles
                .iter()
                .map(|t| t.each_ref().map(place))
                .collect(),
            Some(&vertices),
        )
    } else {
        (Cow::Borrowed(surface.triangles), None)
    };
    let name = |v: u32| names.map_or(v, |names| names[v as usize]);
    let mut sets = DisjointSets::new(triangles.len());
    let degenerate_faces = triangles.iter().filter(|t| is_degenerate(t)).count();
    let faces = triangles.len() - degenerate_faces;
    let [
        mut non_manifold_edges,
        mut inconsistent_edges,
        mut edges,
        mut components,
    ] = [0, 0, 0, faces];
    let mut boundary = Vec::new();
    let origins = triangles.as_flattened();
    let vertex_count = names.map_or(greatest, Vec::len);
    for_each_edge(
        &triangles,
        vertex_count,
        &mut |done| watch.done(done),
        |lower, edge| {
            edges += 1;
            for pair in edge.windows(2) {
                components -= usize::from(sets.unite(pair[0].side / 3, pair[1].side / 3));
            }
            match edge {
                [side] => boundary.push([name(lower), name(side.higher)]),
                [a, b] => {
                    inconsistent_edges +=
                        usize::from(origins[a.side as usize] == origins[b.side as usize])
                }
                _ => non_manifold_edges += 1,
            }
        },
    )?;
    Ok(Watertightness {
        boundary_edges: boundary.len(),
        non_manifold_edges,
        inconsistent_edges,
        degenerate_faces,
        components,
        euler_characteristic: vertices.len() as i64 - edges as i64 + faces as i64,
        t_junctions: t_junctions::count(surface.positions, vertices, &boundary, &mut watch)?,
    })
}

/// Whether a triangle names a vertex twice.
fn is_degenerate([a, b, c]: &[u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// The vertices of faces, each once, ascending.
fn used_vertices(triangles: &[[u32; 3]]) -> Vec<u32> {
    let faces = || {
        triangles
            .iter()
            .filter(|corners| !is_degenerate(corners))
            .flatten()
            .copied()
    };
    let greatest = faces().max().map_or(0, |v| v as usize + 1);
    // Indices far beyond the number of corners must not make the list of flags as long as the greatest of them.
    if greatest / 8 > 3 * triangles.len() {
        let mut vertices: Vec<u32> = faces().collect();
        vertices.sort_unstable();
        vertices.dedup();
        return vertices;
    }
    let mut used = vec![false; greatest];
    for v in faces() {
        used[v as usize] = true;
    }
    (0..greatest as u32).filter(|&v| used[v as usize]).collect()
}
