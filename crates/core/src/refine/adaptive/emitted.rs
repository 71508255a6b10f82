//! The emitted triangles, each with its vertices and the part of the surface that it approximates.

use core::cell::OnceCell;
use core::ops::Range;

use super::chains::Chains;
use super::control::Control;
use super::cover::Cover;
use super::emit::Emission;
use super::leaf::LeafTriangle;
use super::quadtree::{NodeAddress, Trees, is_proven, is_split};
use super::rim::{Rim, bits};
use super::surface::{QuarticPiece, Surface};
use super::walk::{EdgeVertex, Node, Visitor, Walk};
use crate::certificate::{Cell, Pieces, SubTriangle};
use crate::closure::{Diagonal, closure};
use crate::parallel::IsStopped;
use crate::patch::{LimitPoint, ParamTriangle, Rules};

/// Rows of triangles that are shown between two questions whether that is still of use.
const ROWS: usize = 8;

/// An emitted triangle.
pub(super) struct Emitted {
    /// Its number.
    pub(super) number: u32,
    /// Its vertices, in the order of the part's corners, which may begin elsewhere.
    pub(super) vertices: [u32; 3],
    /// Which of the emitted triangle's corners is the first of those.
    pub(super) turn: usize,
    /// The leaf that it covers, or a part of which.
    pub(super) place: NodeAddress,
    /// That part.
    pub(super) part: SubTriangle,
    /// Which of its edges have no neighbour that counts.
    pub(super) open: [bool; 3],
}

/// The surface over an emitted triangle.
pub(super) enum Over<'e, 'p> {
    /// A part of a regular piece, and the place of the leaf.
    Regular(&'e QuarticPiece, Cell, ParamTriangle),
    /// Any other, with the limits at the triangle's corners, and the surface over the leaf.
    General(&'e mut Pieces<'p>, [LimitPoint; 3], Surface<'e>),
}

impl Over<'_, '_> {
    /// The limits at the triangle's corners, normals on this side.
    pub(super) fn corners(&self) -> [LimitPoint; 3] {
        match self {
            Self::Regular(quartic, cell, _) => quartic.at(cell.0),
            Self::General(_, corners, _) => *corners,
        }
    }
}

/// Who looks at the triangles.
pub(super) trait TriangleVisitor {
    /// Whether any of the triangles with these numbers, which cover leaves below a node, is to be shown.
    fn wants(&self, _node: NodeAddress, _triangles: Range<u32>) -> bool {
        true
    }

    /// Whether triangles that are whole leaves which are marked as proven are not to be shown.
    fn skips_proven(&self) -> bool {
        false
    }

    /// Whether one is to be shown.
    fn wants_triangle(&mut self, _emitted: &Emitted) -> bool {
        true
    }

    /// Looks at one.
    fn triangle<'p>(&mut self, emitted: &Emitted, over: Over<'_, 'p>, rules: &'p Rules<'p>);
}

/// The trees, covers and emission from which the triangles are listed.
#[derive(Clone, Copy)]
pub(super) struct Sources<'a> {
    pub(super) control: &'a Control<'a>,
    pub(super) trees: &'a Trees,
    pub(super) chains: &'a Chains,
    pub(super) covers: &'a [Cover],
    pub(super) emission: &'a Emission,
}

impl Sources<'_> {
    /// Whether a control face is one triangle that is marked as proven.
    pub(super) fn is_whole(&self, face: u32) -> bool {
        let word = self.trees.root(face);
        !is_split(word) && is_proven(word) && self.chains.are_none(&self.control.edges, face)
    }

    /// Shows the triangles of a control face, in the order in which they stand.
    pub(super) fn show(
        &self,
        face: u32,
        is_stopped: &IsStopped<'_>,
        visitor: &mut impl TriangleVisitor,
    ) {
        let Self {
            control,
            trees,
            chains,
            covers,
            emission,
        } = *self;
        let mut walk = Walk::new(trees, Vec::new(), 0, is_stopped);
        let sides = chains.sides(control.mesh, &control.edges, face, &mut walk.edge_vertices);
        let mut leaves = Leaves {
            rules: control.rules,
            triangles: &emission.triangles,
            next: emission.triangles_of(face).start as u32,
            open: control.flat.counting(control, face, control.open(face)),
            diagonals: &covers[face as usize].diagonals,
            rim: Rim::default(),
            is_stopped,
            visitor,
        };
        let piece = control.piece(face);
        walk.face(face, sides, piece.surface(control.rules), &mut leaves);
    }
}

/// Finds the triangles of the leaves again.
struct Leaves<'a, B> {
    rules: &'a Rules<'a>,
    triangles: &'a [[u32; 3]],
    next: u32,
    /// The control face's own edges.
    open: [bool; 3],
    /// Those that have not come yet.
    diagonals: &'a [bool],
    rim: Rim,
    is_stopped: &'a IsStopped<'a>,
    visitor: &'a mut B,
}

impl<B: TriangleVisitor> Visitor for Leaves<'_, B> {
    fn chain(&mut self, _: &[EdgeVertex], _: usize, _: ParamTriangle, _: Surface<'_>) {}

    fn leaves(&mut self, node: &Node<'_>, edge_vertices: &mut [EdgeVertex]) {
        let n = 1usize << node.depth;
        let end = self.next + node.triangles() as u32;
        let skips = self.skips(node) && node.is_plain();
        if skips || !self.visitor.wants(node.place, self.next..end) {
            self.diagonals = &self.diagonals[self.rim.diagonals(node, edge_vertices)..];
            self.next = end;
            return;
        }
        self.rim.set(node, edge_vertices);
        let is_plain = node.is_plain();
        for j in 0..n {
            let end = self.next + 2 * (n - j) as u32 - 1;
            if is_plain && !self.visitor.wants(node.place, self.next..end) {
                self.next = end;
                continue;
            }
            for i in 0..n - j {
                self.upright(node, (i, j));
                if i + j + 1 < n {
                    self.inverted(node, (i, j));
                }
            }
            if j % ROWS == ROWS - 1 && (self.is_stopped)() {
                return;
            }
        }
    }
}

impl<B: TriangleVisitor> Leaves<'_, B> {
    /// Whether the leaves of a node that have no split edges are not shown.
    #[inline]
    fn skips(&self, node: &Node<'_>) -> bool {
        node.is_proven && self.visitor.skips_proven()
    }

    fn upright(&mut self, node: &Node<'_>, (i, j): (usize, usize)) {
        let n = 1usize << node.depth;
        let place = node.place.leaf(node.depth, (i, j), false);
        let on_side = [j == 0, i + j + 1 == n, i == 0];
        let open =
            [0, 1, 2].map(|edge| self.open[edge] && on_side[edge] && node.place.lies_along(edge));
        let split = if on_side == [false; 3] {
            [None; 3]
        } else {
            self.rim.split(n, i, j)
        };
        let bits = bits(&split);
        if bits == 0 && self.skips(node) {
            self.next += 1;
            return;
        }
        if bits == 0 {
            return self.whole(node, i, j, place, open);
        }
        let mut from_end = false;
        if bits.count_ones() == 2
            && let [first, rest @ ..] = self.diagonals
        {
            (from_end, self.diagonals) = (*first, rest);
        }
        let pattern = closure(
            bits,
            if from_end {
                Diagonal::FromEnd
            } else {
                Diagonal::FromStart
            },
        )
        .triangles();
        let first = self.next;
        self.next += pattern.len() as u32;
        let mut vertices = [0; 6];
        for (labels, triangle) in pattern.iter().zip(&self.triangles[first as usize..]) {
            labels
                .iter()
                .zip(triangle)
                .for_each(|(&label, &vertex)| vertices[label as usize] = vertex);
        }
        let triangles = (first..).zip(pattern).map(|(number, &labels)| {
            let triangle = LeafTriangle::of(labels);
            let emitted = Emitted {
                number,
                vertices: triangle.corners.map(|label| vertices[label]),
                turn: triangle.turn(labels),
                place,
                part: triangle.part,
                open: triangle
                    .borders
                    .map(|border| border.is_some_and(|edge| open[edge])),
            };
            (emitted, triangle.corners)
        });
        match node.surface {
            Surface::Unknown => {}
            Surface::Regular(piece, domain) => {
                let domain = domain.leaf(node.depth, i, j);
                let [a, b, c] = domain.corners();
                let places = [
                    a,
                    b,
                    c,
                    domain.along(0, 0.5),
                    domain.along(1, 0.5),
                    domain.along(2, 0.5),
                ];
                for (emitted, corners) in triangles {
                    if !self.visitor.wants_triangle(&emitted) {
                        continue;
                    }
                    let cell = Cell(corners.map(|label| places[label]));
                    self.visitor.triangle(
                        &emitted,
                        Over::Regular(piece.quartic(), cell, domain),
                        self.rules,
                    );
                }
            }
            surface @ (Surface::Bicubic(..) | Surface::General(..)) => {
                let Some(patch) = surface.patch() else {
                    return;
                };
                let mut pieces = Pieces::of(&patch);
                let points = OnceCell::new();
                for (emitted, corners) in triangles {
                    if !self.visitor.wants_triangle(&emitted) {
                        continue;
                    }
                    let points = points.get_or_init(|| {
                        let ([a, b, c], [d, e, f]) = (surface.corners(), surface.middles());
                        [a, b, c, d, e, f]
                    });
                    let limits = corners.map(|label| points[label]);
                    let over = Over::General(&mut pieces, limits, surface);
                    self.visitor.triangle(&emitted, over, self.rules);
                }
            }
        }
    }

    /// An upright leaf none of whose edges is split.
    fn whole(&mut self, node: &Node<'_>, i: usize, j: usize, place: NodeAddress, open: [bool; 3]) {
        let number = self.next;
        self.next += 1;
        let vertices = self.triangles[number as usize];
        let emitted = Emitted {
            number,
            vertices,
            turn: 0,
            place,
            part: SubTriangle::Whole,
            open,
        };
        if !self.visitor.wants_triangle(&emitted) {
            return;
        }
        match node.surface {
            Surface::Unknown => {}
            Surface::Regular(piece, domain) => {
                let domain = domain.leaf(node.depth, i, j);
                let over = Over::Regular(piece.quartic(), Cell(domain.corners()), domain);
                self.visitor.triangle(&emitted, over, self.rules);
            }
            surface @ (Surface::Bicubic(..) | Surface::General(..)) => {
                if let Some(patch) = surface.patch() {
                    let mut pieces = Pieces::of(&patch);
                    let over = Over::General(&mut pieces, surface.corners(), surface);
                    self.visitor.triangle(&emitted, over, self.rules);
                }
            }
        }
    }

    /// The inverted leaf to the right of an upright one: its first corner is the second one emitted.
    fn inverted(&mut self, node: &Node<'_>, (i, j): (usize, usize)) {
        let number = self.next;
        self.next += 1;
        if self.skips(node) {
            return;
        }
        let Surface::Regular(piece, domain) = node.surface else {
            return;
        };
        let [a, b, c] = self.triangles[number as usize];
        let place = node.place.leaf(node.depth, (i, j), true);
        let emitted = Emitted {
            number,
            vertices: [b, c, a],
            turn: 1,
            place,
            part: SubTriangle::Whole,
            open: [false; 3],
        };
        if !self.visitor.wants_triangle(&emitted) {
            return;
        }
        let domain = domain.row(node.depth, i, j, true);
        let cell = Cell(domain.corners());
        self.visitor.triangle(
            &emitted,
            Over::Regular(piece.quartic(), cell, domain),
            self.rules,
        );
    }
}
