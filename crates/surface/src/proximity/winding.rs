//! How often a closed surface winds around a point.
//!
//! The solid angle of triangles that approximate the surface (van Oosterom and Strackee, "The Solid
//! Angle of a Plane Triangle", 1983) is that of the surface itself if the straight way of each
//! point of the surface to that of the triangle with the same weights does not meet the point q:
//! where q is farther from the triangle than the parametric deviation, or not in the box around
//! both. Other pieces are quartered, and triangles between an edge and its halves keep the whole
//! closed. Seen from outside of a box, its contents may be replaced by anything with the same
//! boundary, such as a cone over it, so that far faces count by the rims of nodes of the tree
//! (Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized
//! Winding Numbers", 2013).

use core::f64::consts::PI;

use super::pieces::{Piece, closing};
use super::{NEAR, Proximity, ProximityError};
use crate::geometry::box_tree::{BoxTree, distance_to};
use crate::geometry::{SurfaceFrame, closest_to_origin, solid_angle};
use crate::index::{FaceId, HalfEdgeId};
use crate::limit_surface::LimitSurface;
use crate::vector::{DVec3, vector};

/// Points this near to a triangle that closes a gap are moved: on which side of it they are is not certain.
const ON_CLOSING: f64 = 1e-12;

/// The displacements to try, one after the other: far less than the distance that counts as near.
const MOVES: [[f64; 3]; 3] = [
    [0.0; 3],
    [3.1e-11, 5.3e-11, 7.9e-11],
    [-6.7e-11, 2.3e-11, -4.1e-11],
];

/// The rims of the tree's nodes.
#[derive(Clone, Debug)]
pub(crate) struct Chains {
    /// Limits of the control vertices.
    corners: Vec<DVec3>,
    /// Edges of faces in a node whose other face is not in it, from node to node.
    edges: Vec<[u32; 2]>,
    /// Where those of each node start.
    starts: Vec<usize>,
}

/// Why a solid angle is not known.
enum Doubt {
    /// The point is on the surface, or nearly.
    Near,
    /// It is on a triangle that closes a gap.
    OnClosing,
}

impl Chains {
    pub(crate) fn of(
        surface: &LimitSurface<'_>,
        frame: &SurfaceFrame,
        tree: &BoxTree,
    ) -> Result<Self, ProximityError> {
        let topology = surface.control().topology();
        if let Some(h) = topology.half_edges().find(|&h| topology.twin(h).is_none()) {
            let [from, to] = topology.ends(h).map(|v| v.0);
            return Err(ProximityError::Open { from, to });
        }
        let mut places = vec![0; tree.items().len()];
        tree.items()
            .iter()
            .zip(0..)
            .for_each(|(&face, place)| places[face as usize] = place);
        let (mut edges, mut starts) = (Vec::new(), vec![0]);
        for node in tree.nodes() {
            let range = node.range();
            for &face in &tree.items()[range.clone()] {
                for h in [0, 1, 2].map(|corner| HalfEdgeId::of(FaceId(face), corner)) {
                    let is_inside = |twin: HalfEdgeId| range.contains(&places[twin.face().index()]);
                    if !topology.twin(h).is_some_and(is_inside) {
                        edges.push(topology.ends(h).map(|v| v.0));
                    }
                }
            }
            starts.push(edges.len());
        }
        let corners = surface
            .corner_limits()
            .iter()
            .map(|&corner| frame.inside(vector(corner)))
            .collect();
        Ok(Self {
            corners,
            edges,
            starts,
        })
    }

    /// `None` where a point of the frame is too near to the surface to say.
    pub(crate) fn winding_number(&self, proximity: &Proximity<'_>, point: DVec3) -> Option<i32> {
        for way in MOVES {
            match self.solid_angle(proximity, point + vector(way)) {
                Ok(angle) => {
                    let turns = angle / (4.0 * PI);
                    // Anything else than a whole number is rounding: the chain is closed.
                    return (turns - turns.round())
                        .abs()
                        .le(&0.1)
                        .then_some(turns.round() as i32);
                }
                Err(Doubt::Near) => return None,
                Err(Doubt::OnClosing) => {}
            }
        }
        None
    }

    fn solid_angle(&self, proximity: &Proximity<'_>, from: DVec3) -> Result<f64, Doubt> {
        let tree = &proximity.tree;
        let (mut sum, mut waiting) = (0.0, vec![0]);
        while let Some(number) = waiting.pop() {
            let node = &tree.nodes()[number];
            if distance_to(&node.bounds, from) > 0.0 {
                sum += self.of_cone(number, 0.5 * (node.bounds[0] + node.bounds[1]), from);
            } else if let Some(children) = tree.children(number) {
                waiting.extend(children);
            } else {
                let face = tree.items()[node.range().start];
                sum += proximity.with_pieces(face, |found| {
                    let of_pieces = found
                        .pieces
                        .iter()
                        .map(|piece| of_piece(proximity, piece, from));
                    of_pieces
                        .chain(found.closing.iter().map(|gap| of_closing(*gap, from)))
                        .sum::<Result<f64, _>>()
                })?;
            }
        }
        Ok(sum)
    }

    /// The solid angle of a cone over the rim of a node.
    fn of_cone(&self, node: usize, tip: DVec3, from: DVec3) -> f64 {
        let edges = &self.edges[self.starts[node]..self.starts[node + 1]];
        let of_edge = |&[a, b]: &[u32; 2]| {
            solid_angle(
                [tip, self.corners[a as usize], self.corners[b as usize]],
                from,
            )
        };
        edges.iter().map(of_edge).sum()
    }
}

fn of_piece(proximity: &Proximity<'_>, piece: &Piece, from: DVec3) -> Result<f64, Doubt> {
    let [a, b, c] = piece.corners.map(|corner| corner - from);
    if distance_to(&piece.bounds, from) > 0.0
        || closest_to_origin(a, b, c).squared > piece.deviation * piece.deviation
    {
        return Ok(solid_angle(piece.corners, from));
    }
    if piece.deviation <= NEAR {
        return Err(Doubt::Near);
    }
    let parts = piece.parts(&proximity.frame, proximity.surface.rules());
    let gaps = closing(piece, &parts).map(|gap| of_closing(gap, from));
    parts
        .iter()
        .map(|part| of_piece(proximity, part, from))
        .chain(gaps)
        .sum()
}

fn of_closing(corners: [DVec3; 3], from: DVec3) -> Result<f64, Doubt> {
    let [a, b, c] = corners.map(|corner| corner - from);
    let is_on = closest_to_origin(a, b, c).squared <= ON_CLOSING * ON_CLOSING;
    if is_on {
        Err(Doubt::OnClosing)
    } else {
        Ok(solid_angle(corners, from))
    }
}
