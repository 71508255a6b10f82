//! Where the vertices of a level of detail are on the coarser level.
//!
//! A vertex knows its place in a control face. Of the coarser level the triangle that holds the place, one that closes a leaf as well as
//! any other, is found going down the face; the vertex stands on it, and no rounding decides where.

use super::leaves::{Covering, Descent, Leaves, child_with, in_child};
use super::quadtree::NodeAddress;
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::Mesh;
use crate::parallel::IsStopped;
use crate::progress::SharedWatch;
use crate::refine::RefineError;
use crate::refine::exact_result::Exact;
use crate::refine::level::{Geomorph, combined};

/// Who asks for a place.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Asker {
    Vertex(u32),
    /// A corner at a sharp edge, by its place in the list of those.
    Side(usize),
}

/// A place of the node at hand.
#[derive(Clone, Copy)]
struct Asked {
    by: Asker,
    at: [f64; 3],
}

/// A point of the coarser mesh, and the normal that it is shaded with.
struct Stand {
    by: Asker,
    position: [f64; 3],
    normal: [f64; 3],
}

/// Where the vertices of `level` are on `coarser`, in which it is nested; what is not there stays where it is. The bound at the start is
/// not known yet.
pub(super) fn on_coarser(
    control: &Mesh,
    coarser: &Exact,
    level: &Exact,
    watch: &SharedWatch<'_>,
) -> Result<Geomorph, RefineError> {
    let (below, own) = (Leaves::of(control, coarser), Leaves::of(control, level));
    let blocks = watch.long_shares(control.face_count(), |block, is_stopped| {
        let mut finding = Finding {
            coarser,
            found: Vec::new(),
            is_stopped,
        };
        for face in block {
            below.descend(face as u32, asked(level, &own, face as u32), &mut finding);
        }
        finding.found
    })?;
    let mut morph = Geomorph {
        positions: level.mesh.positions().to_vec(),
        normals: level.normals.clone(),
        sides: level.sides.clone(),
        start: f64::INFINITY,
    };
    // Vertices of several faces have one place, up to rounding: the first face's.
    let mut is_known = vec![false; level.mesh.vertex_count()];
    watch.each(blocks.into_iter().flatten(), |stand| match stand.by {
        Asker::Vertex(v) if core::mem::replace(&mut is_known[v as usize], true) => {}
        Asker::Vertex(v) => {
            (morph.positions[v as usize], morph.normals[v as usize]) =
                (stand.position, stand.normal)
        }
        Asker::Side(at) => morph.sides[at].1 = stand.normal,
    })?;
    Ok(morph)
}

/// The places of a level's vertices and sharp corners in a control face.
fn asked(level: &Exact, leaves: &Leaves<'_>, face: u32) -> Vec<Asked> {
    let triangles = leaves.triangles(face);
    let mut asked = Vec::with_capacity(3 * triangles.len());
    for triangle in triangles.clone() {
        let corners = level.mesh.triangles()[triangle];
        let places = (0..3).filter_map(|corner| Some((corner, leaves.place(triangle, corner)?)));
        asked.extend(places.map(|(corner, at)| Asked {
            by: Asker::Vertex(corners[corner]),
            at,
        }));
    }
    asked.sort_unstable_by_key(|asked| asked.by);
    asked.dedup_by_key(|asked| asked.by);
    let first = level
        .sides
        .partition_point(|&(h, _)| (h as usize) < 3 * triangles.start);
    for (at, &(h, _)) in level.sides.iter().enumerate().skip(first) {
        if h as usize >= 3 * triangles.end {
            break;
        }
        let place = leaves.place(h as usize / 3, h as usize % 3);
        asked.extend(place.map(|place| Asked {
            by: Asker::Side(at),
            at: place,
        }));
    }
    asked
}

/// Looks for the triangles that hold places.
struct Finding<'a> {
    coarser: &'a Exact,
    found: Vec<Stand>,
    is_stopped: &'a IsStopped<'a>,
}

impl Descent for Finding<'_> {
    type Node = Vec<Asked>;

    fn children(&mut self, node: Self::Node) -> [Self::Node; 4] {
        let mut below: [Vec<Asked>; 4] = Default::default();
        for Asked { by, at } in node {
            let child = child_with(&[at]).unwrap_or(3);
            below[child].push(Asked {
                by,
                at: in_child(at, child),
            });
        }
        below
    }

    fn leaf(&mut self, _: NodeAddress, node: Self::Node, covering: &[Covering]) {
        for Asked { by, at } in node {
            let holds = |covering: &Covering| Some((covering.triangle, covering.within(at)?));
            if let Some((triangle, weights)) = covering.iter().find_map(holds) {
                let corners = self.coarser.mesh.triangles()[triangle as usize];
                let positions = corners.map(|v| self.coarser.mesh.positions()[v as usize]);
                let corner = |i| {
                    self.coarser
                        .corner_normal(HalfEdgeId::of(FaceId(triangle), i))
                };
                let normal = combined([0, 1, 2].map(corner), weights);
                self.found.push(Stand {
                    by,
                    position: combined(positions, weights),
                    normal,
                });
            }
        }
    }

    fn is_over(&self) -> bool {
        (self.is_stopped)()
    }
}
