//! A surface whose vertices on sharp edges are repeated for each side, so that every vertex has one
//! normal, as graphics cards and most files need.
//!
//! Takes a mesh and a normal for each of its corners; gives positions, normals and triangles, and
//! the vertex of the mesh for each.

use std::collections::HashMap;

use super::{Mesh, Sharpness, Triangles};
use crate::index::{FaceId, HalfEdgeId};
use crate::vector::{DVec3, unit_or_zero, vector};

/// Unit normals that differ by no more than this are one.
const ALIKE: f64 = 1e-6;

/// A surface with a normal for each vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitSurface {
    /// The positions of the mesh, then further copies of vertices with several sides.
    pub positions: Vec<[f64; 3]>,
    /// The normal of each position.
    pub normals: Vec<[f64; 3]>,
    /// The triangles of the mesh, in its order.
    pub triangles: Vec<[u32; 3]>,
    /// By position, the vertex of the mesh: itself, except for copies.
    pub sources: Vec<u32>,
}

impl SplitSurface {
    /// The mesh with the normals that `normal` gives for the corners that half-edges leave. A
    /// vertex is repeated for each different normal of its corners; the first keeps its number.
    pub fn new(mesh: &Mesh, normal: impl Fn(HalfEdgeId) -> [f64; 3]) -> Self {
        let count = mesh.vertex_count();
        let mut split = Self {
            positions: mesh.positions().to_vec(),
            normals: vec![[0.0; 3]; count],
            triangles: mesh.triangles().to_vec(),
            sources: (0..count as u32).collect(),
        };
        let mut is_met = vec![false; count];
        let mut copies: HashMap<u32, Vec<u32>> = HashMap::new();
        for face in 0..mesh.face_count() {
            for corner in 0..3 {
                let own = normal(HalfEdgeId::of(FaceId(face as u32), corner));
                let vertex = split.triangles[face][corner];
                if !core::mem::replace(&mut is_met[vertex as usize], true) {
                    split.normals[vertex as usize] = own;
                    continue;
                }
                let is_own = |&copy: &u32| {
                    vector(split.normals[copy as usize]).distance_squared(vector(own))
                        <= ALIKE * ALIKE
                };
                if is_own(&vertex) {
                    continue;
                }
                let known = copies
                    .get(&vertex)
                    .and_then(|copies| copies.iter().copied().find(is_own));
                let copy = known.unwrap_or_else(|| {
                    let copy = split.positions.len() as u32;
                    split.positions.push(mesh.positions()[vertex as usize]);
                    split.normals.push(own);
                    split.sources.push(vertex);
                    copies.entry(vertex).or_default().push(copy);
                    copy
                });
                split.triangles[face][corner] = copy;
            }
        }
        split
    }

    /// The mesh with the mean normals of the faces around each vertex, weighted by area, on each
    /// side of its infinitely sharp edges: the shading of a mesh without other data.
    pub fn by_faces(mesh: &Mesh) -> Self {
        let sharpness = Sharpness::of(mesh).infinitely_sharp();
        let topology = mesh.topology();
        let mut at_corners = vec![[0.0; 3]; topology.half_edge_count()];
        let mut fill = |corners: &mut dyn Iterator<Item = HalfEdgeId>| {
            let corners: Vec<HalfEdgeId> = corners.collect();
            let sum: DVec3 = corners
                .iter()
                .map(|h| mesh.face_normal_vector(h.face().index()))
                .sum();
            let normal = unit_or_zero(sum).to_array();
            corners.iter().for_each(|h| at_corners[h.index()] = normal);
        };
        for vertex in topology.vertices() {
            if sharpness.is_tagged(vertex) {
                for sector in sharpness.sectors(vertex) {
                    fill(&mut sector.outgoing(topology));
                }
            } else {
                fill(&mut topology.outgoing_ring(vertex));
            }
        }
        Self::new(mesh, |h| at_corners[h.index()])
    }

    /// Positions and triangles alone.
    pub fn as_triangles(&self) -> Triangles<'_> {
        Triangles {
            positions: &self.positions,
            triangles: &self.triangles,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{PolygonFaces, PolygonSoup};

    fn cube() -> Mesh {
        let positions: Vec<[f64; 3]> = (0..8u32)
            .map(|i| [0, 1, 2].map(|axis| f64::from(i >> axis & 1)))
            .collect();
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let mut polygons = PolygonFaces::default();
        faces.iter().for_each(|face| polygons.push(face));
        let soup = PolygonSoup {
            positions,
            faces: polygons,
            ..PolygonSoup::default()
        };
        Mesh::from_soup(&soup, &Default::default()).unwrap().0
    }

    /// A cube with sharp edges has three copies of each vertex, each with the normal of its side; a smooth one has its own.
    #[test]
    fn each_side_of_a_cube_has_its_normal() {
        let smooth = SplitSurface::by_faces(&cube());
        assert_eq!(smooth.positions, cube().positions());
        assert_eq!(smooth.triangles, cube().triangles());
        for (position, normal) in smooth.positions.iter().zip(&smooth.normals) {
            let outwards = vector(*position) - DVec3::splat(0.5);
            assert!(vector(*normal).dot(outwards.normalize()) > 0.8);
        }
        let creased = cube().with_creases_above(0.5).unwrap();
        let split = SplitSurface::by_faces(&creased);
        assert_eq!(split.positions.len(), 24);
        for (face, triangle) in split.triangles.iter().enumerate() {
            let own = creased.unit_face_normal(face);
            for (corner, &copy) in triangle.iter().enumerate() {
                assert!(vector(split.normals[copy as usize]).distance(own) < 1e-12);
                let source = split.sources[copy as usize];
                assert_eq!(source, creased.triangles()[face][corner]);
                assert_eq!(
                    split.positions[copy as usize],
                    creased.positions()[source as usize]
                );
            }
        }
        assert!((0..8).all(|vertex| split.sources[vertex] == vertex as u32));
    }

    /// Where an edge ends inside the surface the vertex has one side, and one normal.
    #[test]
    fn darts_have_one_normal() {
        let mut tags = crate::mesh::Tags::default();
        tags.creases.push(crate::mesh::CreaseTag {
            vertices: [0, 1],
            sharpness: f64::INFINITY,
        });
        let mesh = cube().with_tags(tags).unwrap();
        assert_eq!(SplitSurface::by_faces(&mesh).positions.len(), 8);
    }
}
