//! The leaves of a refined mesh, found again from where its triangles' corners are in their control faces.
//!
//! Takes a control mesh and what it was refined to; goes down from a control face to its leaves and shows each with the triangles
//! that are it, or that close it. What else is wanted on the way, such as the surface over a node, goes down along ([`Descent`]).

use core::ops::Range;

use super::quadtree::{MOST_LEVELS, NodeAddress};
use crate::certificate::SubTriangle;
use crate::mesh::Mesh;
use crate::refine::exact_result::Exact;

/// Barycentric coordinates of a node's corners and of the middles of its edges.
const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const MIDDLES: [[f64; 3]; 3] = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];

/// A triangle that is a leaf, or one of those that close it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Covering {
    /// Of the mesh.
    pub(super) triangle: u32,
    /// The part of the leaf that it is.
    pub(super) part: SubTriangle,
    /// Corner i of the triangle is that of the part with number i + `turn`.
    turn: usize,
}

impl Covering {
    /// The corner of the triangle that is a corner of the part.
    pub(super) fn corner(&self, of_part: usize) -> usize {
        (of_part + 3 - self.turn) % 3
    }

    /// Where a place of the leaf is in the triangle, by the triangle's corners; `None` if that is outside. No rounding is done: these are
    /// halves of halves.
    pub(super) fn within(&self, place: [f64; 3]) -> Option<[f64; 3]> {
        let corners = self.part.corners(CORNERS, MIDDLES);
        let cross = |p: [f64; 3], q: [f64; 3], r: [f64; 3]| {
            (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1])
        };
        let area = cross(corners[0], corners[1], corners[2]);
        let own = |i: usize| cross(place, corners[(i + 1) % 3], corners[(i + 2) % 3]) / area;
        let weights = [own(0), own(1), own(2)];
        let is_inside = weights.iter().all(|&weight| weight >= 0.0);
        is_inside.then(|| [0, 1, 2].map(|corner| weights[(corner + self.turn) % 3]))
    }
}

/// Values that a descent computes for nodes.
pub(super) trait Descent {
    /// The value of a node.
    type Node;

    /// The values of a node's children.
    fn children(&mut self, node: Self::Node) -> [Self::Node; 4];

    /// A leaf and the triangles that cover it.
    fn leaf(&mut self, place: NodeAddress, node: Self::Node, covering: &[Covering]);

    /// Whether the rest is not wanted.
    fn is_over(&self) -> bool;
}

/// The triangles of a refined mesh by control face.
pub(super) struct Leaves<'a> {
    control: &'a Mesh,
    found: &'a Exact,
    /// By control face.
    triangles: Vec<Range<usize>>,
}

impl<'a> Leaves<'a> {
    /// Those of one face stand together.
    pub(super) fn of(control: &'a Mesh, found: &'a Exact) -> Self {
        let mut triangles = vec![0..0; control.face_count()];
        let mut next = 0;
        for own in found.parents.chunk_by(|a, b| a == b) {
            triangles[own[0] as usize] = next..next + own.len();
            next += own.len();
        }
        Self {
            control,
            found,
            triangles,
        }
    }

    /// The triangles of a control face.
    pub(super) fn triangles(&self, face: u32) -> Range<usize> {
        self.triangles[face as usize].clone()
    }

    /// Goes down a face to its leaves; `false` if a triangle is no part of one.
    pub(super) fn descend<D: Descent>(&self, face: u32, node: D::Node, descent: &mut D) -> bool {
        let corners = |triangle: usize| {
            let mut corners = [[0.0; 3]; 3];
            for (corner, at) in corners.iter_mut().enumerate() {
                *at = self.place(triangle, corner)?;
            }
            Some(Standing {
                triangle: triangle as u32,
                corners,
            })
        };
        let standing: Option<Vec<Standing>> = self.triangles(face).map(corners).collect();
        standing.is_some_and(|standing| down(NodeAddress::root(face), standing, node, descent))
    }

    /// Where a corner of a triangle is in the triangle's control face; `None` if that is not known.
    pub(super) fn place(&self, triangle: usize, corner: usize) -> Option<[f64; 3]> {
        let face = *self.found.parents.get(triangle)?;
        let vertex = self.found.mesh.triangles()[triangle][corner];
        Some(
            self.found
                .origins
                .get(vertex as usize)?
                .in_face(self.control.triangles(), face)?
                .barycentric,
        )
    }
}

fn down<D: Descent>(
    place: NodeAddress,
    standing: Vec<Standing>,
    node: D::Node,
    descent: &mut D,
) -> bool {
    if standing.is_empty() || descent.is_over() {
        return true;
    }
    if standing.iter().any(Standing::is_of_leaf) {
        let covering: Option<Vec<Covering>> = standing.iter().map(Standing::covering).collect();
        let is_known = covering.is_some();
        descent.leaf(place, node, &covering.unwrap_or_default());
        return is_known;
    }
    if place.level >= MOST_LEVELS {
        return false;
    }
    let mut below: [Vec<Standing>; 4] = Default::default();
    for own in standing {
        let Some(child) = child_with(&own.corners) else {
            return false;
        };
        below[child].push(Standing {
            corners: own.corners.map(|at| in_child(at, child)),
            ..own
        });
    }
    let children = descent.children(node).into_iter().zip(below).enumerate();
    children.fold(true, |all, (child, (node, standing))| {
        down(place.child(child), standing, node, descent) && all
    })
}

/// The child of a node that holds all of these places.
pub(super) fn child_with(places: &[[f64; 3]]) -> Option<usize> {
    let near = (0..3).find(|&child| places.iter().all(|weights| weights[child] >= 0.5));
    let is_inner = || places.iter().flatten().all(|&weight| weight <= 0.5);
    near.or_else(|| is_inner().then_some(3))
}

/// Where a place of a node is in its child.
pub(super) fn in_child(weights: [f64; 3], child: usize) -> [f64; 3] {
    match child {
        3 => weights.map(|weight| 1.0 - 2.0 * weight),
        _ => core::array::from_fn(|i| 2.0 * weights[i] - f64::from(i == child)),
    }
}

/// A triangle, and the places of its corners in the node at hand.
#[derive(Clone, Copy)]
struct Standing {
    triangle: u32,
    corners: [[f64; 3]; 3],
}

impl Standing {
    /// How the triangle is turned against a part, if it is that.
    fn turn(&self, part: SubTriangle) -> Option<usize> {
        let corners = part.corners(CORNERS, MIDDLES);
        (0..3).find(|turn| (0..3).all(|i| self.corners[i] == corners[(i + turn) % 3]))
    }

    /// Whether it is the node itself, or closes it. The part of a leaf that is a child might as well be a leaf of its own.
    fn is_of_leaf(&self) -> bool {
        let is_own = |part: &SubTriangle| !matches!(part, SubTriangle::Child(_));
        SubTriangle::all()
            .filter(is_own)
            .any(|part| self.turn(part).is_some())
    }

    fn covering(&self) -> Option<Covering> {
        let as_part = |part| {
            let turn = self.turn(part)?;
            Some(Covering {
                triangle: self.triangle,
                part,
                turn,
            })
        };
        SubTriangle::all().find_map(as_part)
    }
}
