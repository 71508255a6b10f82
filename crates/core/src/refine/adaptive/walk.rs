//! A walk over the leaves of a control face, each with what its neighbours put on its edges.
//!
//! Along every edge of a node runs a chain of edge vertices: its ends and the vertices that the nodes on either side have put
//! between them. The chains of the control face's edges are given; those inside are the union of both sides' and are
//! made on the way down, so vertices are numbered in the order of the walk. Each segment between two edge vertices also keeps the
//! half-edge that was met there first, so that half-edges find their twins.

use super::quadtree::{
    FULL, LEAF, NodeAddress, Trees, along_edge, asks, even_depth, even_depth_along, is_proven,
    is_split,
};
use super::surface::Surface;
use crate::mesh::NONE;
use crate::parallel::IsStopped;
use crate::patch::ParamTriangle;

/// A vertex on a chain, and the half-edge that was met first between it and the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeVertex {
    /// NodeAddress along the chain, from 0 to [`FULL`].
    pub(super) at: u32,
    pub(super) vertex: u32,
    pub(super) half_edge: u32,
}

impl EdgeVertex {
    pub(super) fn new(at: u32, vertex: u32) -> Self {
        Self {
            at,
            vertex,
            half_edge: NONE,
        }
    }
}

/// A segment of a chain as an edge of a node: the numbers of its first and last edge vertex, and whether the edge runs against
/// the chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub(super) first: usize,
    pub(super) last: usize,
    pub(super) reversed: bool,
}

impl Side {
    /// Segments between edge vertices.
    #[inline]
    pub(super) fn segments(&self) -> usize {
        self.last - self.first
    }

    /// Number of the `i`-th edge vertex from the edge's start.
    #[inline]
    pub(super) fn edge_vertex(&self, i: usize) -> usize {
        if self.reversed {
            self.last - i
        } else {
            self.first + i
        }
    }

    /// Number of the edge vertex that keeps the `i`-th segment from the edge's start.
    #[inline]
    pub(super) fn segment(&self, i: usize) -> usize {
        if self.reversed {
            self.last - 1 - i
        } else {
            self.first + i
        }
    }

    /// Both halves, given the number of the edge vertex in the middle.
    #[inline]
    fn halves(&self, middle: usize) -> [Self; 2] {
        let (lower, upper) = (
            Self {
                last: middle,
                ..*self
            },
            Self {
                first: middle,
                ..*self
            },
        );
        if self.reversed {
            [upper, lower]
        } else {
            [lower, upper]
        }
    }

    /// The number of the edge vertex in the middle of a side that is split.
    #[inline]
    pub(super) fn middle(&self, edge_vertices: &[EdgeVertex]) -> usize {
        if self.last - self.first == 2 {
            return self.first + 1;
        }
        let at = edge_vertices[self.first].at
            + (edge_vertices[self.last].at - edge_vertices[self.first].at) / 2;
        self.first
            + edge_vertices[self.first..self.last]
                .partition_point(|edge_vertex| edge_vertex.at < at)
    }
}

/// The visitor of a walk.
pub(super) trait Visitor {
    /// A chain inside the face was made; `edge vertices` runs from its first to its last, `edge` is the edge of the middle child
    /// that it runs against, whose place in the face and surface are given.
    fn chain(
        &mut self,
        edge_vertices: &[EdgeVertex],
        edge: usize,
        domain: ParamTriangle,
        middle: Surface<'_>,
    );

    /// A node whose leaves lie `depth` levels below it. `interior` is the first of the numbers kept for the vertices inside, in
    /// rows from edge 0 on. Surfaces that are not regular have depth 0.
    fn leaves(&mut self, node: &Node<'_>, edge_vertices: &mut [EdgeVertex]);
}

/// A node whose leaves are equally deep.
pub(super) struct Node<'a> {
    pub(super) place: NodeAddress,
    /// The place in the control face's domain.
    pub(super) domain: ParamTriangle,
    /// Levels from the node down to its leaves.
    pub(super) depth: u32,
    /// Whether its leaves are proven as long as none of their edges is split.
    pub(super) is_proven: bool,
    pub(super) sides: [Side; 3],
    pub(super) interior: u32,
    pub(super) surface: Surface<'a>,
}

impl Node<'_> {
    /// Whether no neighbour has split an edge of a leaf.
    pub(super) fn is_plain(&self) -> bool {
        self.sides
            .iter()
            .all(|side| side.segments() == 1 << self.depth)
    }

    /// The vertex inside it in column i and row j, both from 1 on.
    #[inline]
    pub(super) fn inside(&self, i: usize, j: usize) -> u32 {
        let n = 1usize << self.depth;
        self.interior + ((j - 1) * (n - 1) - (j - 1) * j / 2 + i - 1) as u32
    }

    /// Triangles that its leaves are covered with.
    pub(super) fn triangles(&self) -> usize {
        let split: usize = self
            .sides
            .iter()
            .map(|side| side.segments() - (1 << self.depth))
            .sum();
        (1 << (2 * self.depth)) + split
    }
}

/// A walk and what it keeps.
pub(super) struct Walk<'a> {
    pub(super) trees: &'a Trees,
    pub(super) edge_vertices: Vec<EdgeVertex>,
    /// The next vertex's number.
    pub(super) next: u32,
    is_stopped: &'a IsStopped<'a>,
    /// Nodes until that is asked again; none once it was so.
    until_asked: u32,
}

/// Nodes between two questions whether the walk is still of use.
const ASKED: u32 = 32;

impl<'a> Walk<'a> {
    pub(super) fn new(
        trees: &'a Trees,
        edge_vertices: Vec<EdgeVertex>,
        next: u32,
        is_stopped: &'a IsStopped<'a>,
    ) -> Self {
        Self {
            trees,
            edge_vertices,
            next,
            is_stopped,
            until_asked: ASKED,
        }
    }

    /// Whether nothing is visited any more.
    fn is_over(&mut self) -> bool {
        if self.until_asked > 1 {
            self.until_asked -= 1;
        } else if self.until_asked == 1 {
            self.until_asked = if (self.is_stopped)() { 0 } else { ASKED };
        }
        self.until_asked == 0
    }

    /// Walks over a control face's leaves. A walk that is stopped leaves some out.
    pub(super) fn face<V: Visitor>(
        &mut self,
        face: u32,
        sides: [Side; 3],
        surface: Surface<'_>,
        visitor: &mut V,
    ) {
        let (word, place) = (self.trees.root(face), NodeAddress::root(face));
        self.node(word, place, ParamTriangle::WHOLE, sides, surface, visitor);
    }

    fn node<V: Visitor>(
        &mut self,
        word: u32,
        place: NodeAddress,
        domain: ParamTriangle,
        sides: [Side; 3],
        surface: Surface<'_>,
        visitor: &mut V,
    ) {
        if self.is_over() {
            return;
        }
        if let Some(depth) = even_depth(word) {
            let interior = self.next;
            let n = 1u32 << depth;
            self.next += if n > 2 { (n - 1) * (n - 2) / 2 } else { 0 };
            let node = Node {
                place,
                domain,
                depth,
                is_proven: is_proven(word),
                sides,
                interior,
                surface,
            };
            visitor.leaves(&node, &mut self.edge_vertices);
            return;
        }
        let children = [0, 1, 2, 3].map(|child| self.trees.child(word, child));
        let middles = sides.map(|side| side.middle(&self.edge_vertices));
        let floor = self.edge_vertices.len();
        // Chain e runs from the middle of edge e + 2 to that of edge e + 1.
        let chains = [0, 1, 2].map(|edge| {
            let [from, to] = [2, 1].map(|i| self.edge_vertices[middles[(edge + i) % 3]].vertex);
            let first = self.edge_vertices.len();
            self.edge_vertices.push(EdgeVertex::new(0, from));
            let pair = [(children[(edge + 2) % 3], false), (children[3], true)];
            self.next = merge(self.trees, edge, &pair, self.next, &mut self.edge_vertices);
            self.edge_vertices.push(EdgeVertex::new(FULL, to));
            Side {
                first,
                last: self.edge_vertices.len() - 1,
                reversed: false,
            }
        });
        let halves = [0, 1, 2].map(|edge| sides[edge].halves(middles[edge]));
        // The middle one knows the chains' points.
        for (edge, chain) in chains.iter().enumerate() {
            let edge_vertices = &self.edge_vertices[chain.first..=chain.last];
            visitor.chain(edge_vertices, edge, domain.child(3), surface.child(3));
        }
        for child in 0..4 {
            let own = if child == 3 {
                chains.map(|chain| Side {
                    reversed: true,
                    ..chain
                })
            } else {
                let mut own = chains;
                own[child] = halves[child][0];
                own[(child + 2) % 3] = halves[(child + 2) % 3][1];
                own
            };
            let (place, domain) = (place.child(child), domain.child(child));
            let surface = surface.child(child);
            self.node(children[child], place, domain, own, surface, visitor);
        }
        self.edge_vertices.truncate(floor);
    }
}

/// Appends the edge vertices strictly inside an edge: the union of what the nodes along it have split. Each node comes with whether
/// the edge, which has this number in all of them, runs the other way there. Gives the next free vertex number.
fn merge(
    trees: &Trees,
    edge: usize,
    pair: &[(u32, bool); 2],
    next: u32,
    edge_vertices: &mut Vec<EdgeVertex>,
) -> u32 {
    let members = pair.map(|(word, turned)| (word, edge, turned));
    let mut next = next;
    merged(trees, &members, 0, FULL, &mut |at| {
        edge_vertices.push(EdgeVertex::new(at, next));
        next += 1;
    });
    next
}

/// Tells the places strictly inside a part of an edge that nodes along it have split, in order. A member is a node, the
/// number of its edge, and whether that runs the other way.
pub(super) fn merged<const N: usize>(
    trees: &Trees,
    members: &[(u32, usize, bool); N],
    from: u32,
    length: u32,
    found: &mut impl FnMut(u32),
) {
    let deepest = members
        .iter()
        .try_fold(0, |deepest: u32, &(word, edge, _)| {
            Some(deepest.max(even_depth_along(word, edge)?))
        });
    if let Some(depth) = deepest {
        (1..1 << depth).for_each(|i| found(from + i * (length >> depth)));
        return;
    }
    let half = |second: bool| members.map(|member| half_of(trees, member, second));
    merged(trees, &half(false), from, length / 2, found);
    found(from + length / 2);
    merged(trees, &half(true), from + length / 2, length / 2, found);
}

/// The node along half of a member's edge. Beyond a leaf's own edge nothing is split.
fn half_of(
    trees: &Trees,
    (word, edge, turned): (u32, usize, bool),
    second: bool,
) -> (u32, usize, bool) {
    let below = if is_split(word) {
        trees.child(word, along_edge(edge, second != turned))
    } else {
        LEAF
    };
    (below, edge, turned)
}

/// [`merged`] for any number of members.
pub(super) fn merged_all(
    trees: &Trees,
    members: &[(u32, usize, bool)],
    from: u32,
    length: u32,
    found: &mut impl FnMut(u32),
) {
    let split: Vec<_> = members
        .iter()
        .copied()
        .filter(|&(word, edge, _)| is_split(word) || asks(word, edge))
        .collect();
    if split.is_empty() {
        return;
    }
    let half = |second: bool| -> Vec<_> {
        split
            .iter()
            .map(|&member| half_of(trees, member, second))
            .collect()
    };
    merged_all(trees, &half(false), from, length / 2, found);
    found(from + length / 2);
    merged_all(trees, &half(true), from + length / 2, length / 2, found);
}
