//! A front's mesh in an order that the forest alone decides, and where its vertices and triangles came from on the control mesh.
//!
//! Vertices of the control mesh come first, the others in the order of a walk over the control
//! faces.

use super::buffers::covering;
use super::forest::{Forest, NONE};
use crate::index::HalfEdgeId;
use crate::mesh::{CornerTag, CreaseTag, INFINITELY_SHARP, Mesh, MeshError, Tags};
use crate::patch::child_corners;
use crate::refine::{Origin, Traced};

/// A front's mesh, and where it came from.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Snapshot {
    /// The mesh, with the infinitely sharp tags.
    pub mesh: Mesh,
    /// Where each vertex came from, in the control face of the first triangle that has it.
    pub origins: Vec<Origin>,
    /// The control face of each triangle.
    pub parents: Vec<u32>,
}

impl Traced for Snapshot {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn origins(&self) -> &[Origin] {
        &self.origins
    }

    fn parents(&self) -> &[u32] {
        &self.parents
    }
}

impl Snapshot {
    pub(super) fn of(forest: &Forest<'_>) -> Result<Self, MeshError> {
        let control = forest.surface().control();
        let Numbered {
            positions,
            triangles,
            origins,
            parents,
        } = numbered(forest);
        let mut found = Self {
            mesh: Mesh::from_triangles(positions, triangles)?,
            origins,
            parents,
        };
        let tags = found.infinitely_sharp_tags(control);
        found.mesh = found.mesh.with_tags(tags)?;
        Ok(found)
    }

    /// The tags of edges that lie on infinitely sharp edges of the control mesh.
    fn infinitely_sharp_tags(&self, control: &Mesh) -> Tags {
        let lasts = |sharpness: f64| sharpness >= INFINITELY_SHARP;
        let tags = control.tags();
        let mut sharp: Vec<[u32; 2]> = tags
            .creases
            .iter()
            .filter(|tag| lasts(tag.sharpness))
            .map(|tag| {
                [
                    tag.vertices[0].min(tag.vertices[1]),
                    tag.vertices[0].max(tag.vertices[1]),
                ]
            })
            .collect();
        sharp.sort_unstable();
        let corners: Vec<CornerTag> = tags
            .corners
            .iter()
            .filter(|tag| lasts(tag.sharpness))
            .copied()
            .collect();
        let topology = self.mesh.topology();
        let is_along = |h: &HalfEdgeId| {
            let ends = [*h, h.next()].map(|corner| self.corner_origin(control.triangles(), corner));
            let [Some(from), Some(to)] = ends else {
                return false;
            };
            let corners = control.triangles()[from.face as usize];
            (0..3).any(|opposite| {
                let [a, b] = [1, 2].map(|i| corners[(opposite + i) % 3]);
                from.barycentric[opposite] == 0.0
                    && to.barycentric[opposite] == 0.0
                    && sharp.binary_search(&[a.min(b), a.max(b)]).is_ok()
            })
        };
        // Each edge once.
        let all = (0..3 * self.mesh.face_count() as u32).map(HalfEdgeId);
        let once = all.filter(|&h| topology.twin(h).is_none_or(|twin| h < twin));
        let creases = if sharp.is_empty() {
            Vec::new()
        } else {
            let tag = |h: HalfEdgeId| CreaseTag {
                vertices: topology.ends(h).map(|v| v.0),
                sharpness: INFINITELY_SHARP,
            };
            once.filter(is_along).map(tag).collect()
        };
        Tags { creases, corners }
    }
}

/// The triangles of a forest and their vertices, in order.
pub(super) struct Numbered {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    origins: Vec<Origin>,
    parents: Vec<u32>,
}

/// The elements of the forest, numbered.
pub(super) fn numbered(forest: &Forest<'_>) -> Numbered {
    let control = forest.surface().control();
    let (vertices, faces) = (control.vertex_count(), control.face_count());
    let nowhere = Origin {
        face: NONE,
        barycentric: [0.0; 3],
    };
    let mut walk = Walk {
        forest,
        numbers: vec![NONE; forest.vertices.positions.len()],
        found: Numbered {
            positions: forest.vertices.positions[..vertices].to_vec(),
            triangles: limitmesh_pages::with_capacity(forest.triangles),
            origins: limitmesh_pages::filled(nowhere, vertices),
            parents: limitmesh_pages::with_capacity(forest.triangles),
        },
    };
    (0..vertices).for_each(|vertex| walk.numbers[vertex] = vertex as u32);
    let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    (0..faces as u32).for_each(|face| walk.node(face, face, corners));
    walk.found
}

struct Walk<'f, 'a> {
    forest: &'f Forest<'a>,
    numbers: Vec<u32>,
    found: Numbered,
}

impl Walk<'_, '_> {
    /// A node of a control face, whose corners have these coordinates there.
    fn node(&mut self, face: u32, node: u32, corners: [[f64; 3]; 3]) {
        let middles = [0, 1, 2].map(|edge| {
            let (a, b) = (corners[edge], corners[(edge + 1) % 3]);
            [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]))
        });
        let own = self.forest.node(node);
        if own.children != NONE {
            let first = own.children;
            for child in 0..4 {
                self.node(
                    face,
                    first + child as u32,
                    child_corners(corners, middles, child),
                );
            }
            return;
        }
        let (found, count) = covering(self.forest, node);
        for triangle in &found[..count] {
            let numbered = triangle.map(|vertex| self.number(vertex));
            self.found.triangles.push(numbered);
            self.found.parents.push(face);
        }
        for (&vertex, barycentric) in own.corners.iter().zip(corners) {
            self.tell(vertex, face, barycentric);
        }
        for (edge, &middle) in (0u8..).zip(&middles) {
            if let Some(vertex) = self.forest.split_of(node, edge) {
                self.tell(vertex, face, middle);
            }
        }
    }

    fn number(&mut self, vertex: u32) -> u32 {
        let number = &mut self.numbers[vertex as usize];
        if *number == NONE {
            *number = self.found.positions.len() as u32;
            self.found
                .positions
                .push(self.forest.vertices.positions[vertex as usize]);
            self.found.origins.push(Origin {
                face: NONE,
                barycentric: [0.0; 3],
            });
        }
        *number
    }

    /// Puts down where a vertex is, unless that is known.
    fn tell(&mut self, vertex: u32, face: u32, barycentric: [f64; 3]) {
        let number = self.numbers[vertex as usize];
        if number != NONE && self.found.origins[number as usize].face == NONE {
            self.found.origins[number as usize] = Origin { face, barycentric };
        }
    }
}
