//! How the leaves of a control face are covered with triangles (the paper's Figure 5): how many there are, and the diagonals of leaves with two split
//! edges.

use super::chains::Chains;
use super::control::Control;
use super::quadtree::{NodeAddress, Trees, is_split};
use super::rim::{Rim, bits};
use super::surface::Surface;
use super::touched::{Fresh, Touched};
use super::walk::{EdgeVertex, Node, Visitor, Walk};
use crate::parallel::IsStopped;
use crate::patch::ParamTriangle;

/// The triangles over a control face.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Cover {
    /// Vertices inside the face.
    pub(super) vertices: u32,
    pub(super) triangles: u32,
    /// For each leaf with two split edges, in the order of the walk, whether its diagonal starts at the unsplit edge's end.
    pub(super) diagonals: Box<[bool]>,
}

/// A cover, and which of its triangles were not there before.
pub(super) struct Covered {
    pub(super) cover: Cover,
    pub(super) fresh: Fresh,
}

/// The trees of all control faces, with the vertices on their edges.
#[derive(Clone, Copy)]
pub(super) struct Covering<'a> {
    pub(super) control: &'a Control<'a>,
    pub(super) trees: &'a Trees,
    pub(super) chains: &'a Chains,
    /// Whether all diagonals start at the unsplit edge's start.
    pub(super) has_fixed_diagonals: bool,
    /// The leaves with other triangles than before, where only some are.
    pub(super) touched: Option<&'a Touched>,
}

impl Covering<'_> {
    /// Walks over a face. The edge vertices are room to be used again.
    pub(super) fn cover(
        &self,
        face: u32,
        edge_vertices: &mut Vec<EdgeVertex>,
        is_stopped: &IsStopped<'_>,
    ) -> Covered {
        let Self {
            control,
            trees,
            chains,
            has_fixed_diagonals,
            touched,
        } = *self;
        let word = trees.root(face);
        if !is_split(word) && chains.are_none(&control.edges, face) {
            let cover = Cover {
                triangles: 1,
                ..Cover::default()
            };
            return Covered {
                cover,
                fresh: Fresh::All,
            };
        }
        let mut walk = Walk::new(trees, core::mem::take(edge_vertices), 0, is_stopped);
        walk.edge_vertices.clear();
        let sides = chains.sides(control.mesh, &control.edges, face, &mut walk.edge_vertices);
        let mut count = Count {
            triangles: 0,
            rim: Rim::default(),
            halved: Vec::new(),
            touched,
            fresh: Vec::new(),
        };
        walk.face(face, sides, Surface::Unknown, &mut count);
        *edge_vertices = walk.edge_vertices;
        let mut piece = None;
        let diagonals = count.halved.iter().map(|&(place, unsplit)| {
            if has_fixed_diagonals {
                return false;
            }
            let piece = piece.get_or_insert_with(|| control.piece(face));
            is_nearer_from_end(piece.over(place, control.rules), unsplit)
        });
        let cover = Cover {
            vertices: walk.next,
            triangles: count.triangles as u32,
            diagonals: diagonals.collect(),
        };
        Covered {
            cover,
            fresh: touched.map_or(Fresh::All, |_| Fresh::Some(count.fresh)),
        }
    }
}

/// Whether of the two diagonals of a leaf that has one unsplit edge the surface is nearer to the one from that edge's end, in its middle.
pub(super) fn is_nearer_from_end(surface: Surface<'_>, unsplit: usize) -> bool {
    let (corners, middles) = (surface.corners(), surface.middles());
    let (end, tip) = ((unsplit + 1) % 3, (unsplit + 2) % 3);
    let off = |corner: usize, middle: usize| {
        let over = surface.child(corner).middles()[(corner + 1) % 3].position;
        (2.0 * over).distance_squared(corners[corner].position + middles[middle].position)
    };
    off(end, tip) < off(unsplit, end)
}

/// Counts the triangles over a face, lists the leaves with two split edges, and marks the triangles of leaves that were touched.
struct Count<'a> {
    triangles: usize,
    rim: Rim,
    /// The leaves, with their unsplit edges.
    halved: Vec<(NodeAddress, usize)>,
    touched: Option<&'a Touched>,
    fresh: Vec<bool>,
}

impl Visitor for Count<'_> {
    fn chain(&mut self, _: &[EdgeVertex], _: usize, _: ParamTriangle, _: Surface<'_>) {}

    fn leaves(&mut self, node: &Node<'_>, edge_vertices: &mut [EdgeVertex]) {
        let first = self.triangles;
        self.triangles += node.triangles();
        let touched = self.touched;
        if let Some(touched) = touched {
            self.fresh.resize(self.triangles, touched.holds(node.place));
        }
        if node.is_plain() {
            return;
        }
        self.rim.set(node, edge_vertices);
        let n = 1 << node.depth;
        // Triangles that closed leaves before have more than those.
        let mut more = 0;
        for (i, j) in Rim::leaves(n) {
            let split = self.rim.split(n, i, j);
            let middles = bits(&split).count_ones() as usize;
            if middles == 0 {
                continue;
            }
            let place = node.place.leaf(node.depth, (i, j), false);
            if let Some(unsplit) = unsplit_edge(split) {
                self.halved.push((place, unsplit));
            }
            if touched.is_some_and(|touched| touched.holds(place)) {
                // The rows before it, and the leaves of its own.
                let own = first + j * (2 * n - j) + 2 * i + more;
                self.fresh[own..=own + middles].fill(true);
            }
            more += middles;
        }
    }
}

/// The one edge without a vertex in its middle, if the two others have one.
fn unsplit_edge(split: [Option<usize>; 3]) -> Option<usize> {
    match split {
        [None, Some(_), Some(_)] => Some(0),
        [Some(_), None, Some(_)] => Some(1),
        [Some(_), Some(_), None] => Some(2),
        _ => None,
    }
}
