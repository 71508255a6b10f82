//! Writes the leaves of control faces: the vertices inside and along chains, the triangles row by row, and which half-edges are
//! twins.

use super::super::rim::{Rim, bits};
use super::super::surface::Surface;
use super::super::walk::{EdgeVertex, Node, Visitor};
use super::emission::fraction;
use super::job::Vertices;
use crate::closure::{Diagonal, closure};
use crate::mesh::NONE;
use crate::parallel::IsStopped;
use crate::patch::ParamTriangle;
use crate::refine::exact_result::Origin;

/// Rows that are written between two questions whether that is still of use.
const ROWS: usize = 64;

/// Writes the leaves of control faces.
pub(super) struct Writer<'a> {
    pub(super) face: u32,
    /// Those of the face that have not come yet.
    pub(super) diagonals: &'a [bool],
    pub(super) next_triangle: u32,
    pub(super) inside: Vertices<'a>,
    pub(super) first_triangle: u32,
    pub(super) triangles: &'a mut [[u32; 3]],
    pub(super) twins: &'a mut [u32],
    pub(super) rim: Rim,
    /// By column, the half-edge that waits for the row above.
    pub(super) below: Vec<u32>,
    pub(super) places: Vec<f64>,
    /// Vertices of a row and of the one above.
    pub(super) rows: [Vec<u32>; 2],
    pub(super) is_stopped: &'a IsStopped<'a>,
}

impl Visitor for Writer<'_> {
    fn chain(
        &mut self,
        edge_vertices: &[EdgeVertex],
        edge: usize,
        domain: ParamTriangle,
        middle: Surface<'_>,
    ) {
        let last = edge_vertices.len() - 1;
        if last < 2 {
            return;
        }
        let mut places = core::mem::take(&mut self.places);
        places.clear();
        // The middle child's edge runs the other way.
        places.extend(
            edge_vertices[1..last]
                .iter()
                .rev()
                .map(|edge_vertex| 1.0 - fraction(edge_vertex.at)),
        );
        middle.along(edge, &places, &mut |i, point| {
            let origin = self.origin(domain.along(edge, places[i]));
            self.inside
                .set(edge_vertices[last - 1 - i].vertex, point, origin);
        });
        self.places = places;
    }

    fn leaves(&mut self, node: &Node<'_>, edge_vertices: &mut [EdgeVertex]) {
        self.interior(node);
        if node.is_plain() {
            return self.cover_plain(node, edge_vertices);
        }
        self.rim.set(node, edge_vertices);
        self.cover(node, edge_vertices);
    }
}

impl Writer<'_> {
    fn origin(&self, [u, v]: [f64; 2]) -> Origin {
        Origin {
            face: self.face,
            barycentric: [1.0 - u - v, u, v],
        }
    }

    /// The vertices inside a node, row by row.
    fn interior(&mut self, node: &Node<'_>) {
        let n = 1usize << node.depth;
        let Surface::Regular(piece, domain) = node.surface else {
            return;
        };
        let mut at = (node.interior - self.inside.first) as usize;
        let (step, own) = (domain.size / n as f64, node.domain);
        for j in 1..n.max(2) - 1 {
            let count = n - 1 - j;
            let row = at..at + count;
            piece.quartic().piece.points_and_normals_along(
                domain.v + step * j as f64,
                domain.u + step,
                step,
                &mut self.inside.positions[row.clone()],
                &mut self.inside.normals[row],
            );
            if !self.inside.origins.is_empty() {
                for i in 1..=count {
                    let leaf = own.leaf(node.depth, i, j);
                    self.inside.origins[at + i - 1] = self.origin([leaf.u, leaf.v]);
                }
            }
            at += count;
            if self.is_over(j) {
                return;
            }
        }
    }

    /// Whether what is written is of no use any more; asked after some of the rows.
    #[inline]
    fn is_over(&self, row: usize) -> bool {
        row % ROWS == ROWS - 1 && (self.is_stopped)()
    }

    /// The vertex at a corner of the leaves.
    fn vertex(&self, node: &Node<'_>, edge_vertices: &[EdgeVertex], i: usize, j: usize) -> u32 {
        let n = 1usize << node.depth;
        if j == 0 {
            edge_vertices[self.rim.corner(0, i)].vertex
        } else if i == 0 {
            edge_vertices[self.rim.corner(2, n - j)].vertex
        } else if i + j == n {
            edge_vertices[self.rim.corner(1, j)].vertex
        } else {
            node.inside(i, j)
        }
    }

    /// [`Self::cover`] where no leaf has split edges: what stands where, and what is beyond inner edges, follows from the numbers
    /// of rows and columns.
    fn cover_plain(&mut self, node: &Node<'_>, edge_vertices: &mut [EdgeVertex]) {
        let n = 1usize << node.depth;
        let [bottom, right, left] = &node.sides;
        let mut at = (self.next_triangle - self.first_triangle) as usize;
        let [mut lower, mut upper] = core::mem::take(&mut self.rows);
        lower.clear();
        lower.extend((0..=n).map(|i| edge_vertices[bottom.edge_vertex(i)].vertex));
        for j in 0..n {
            let count = n - j;
            upper.clear();
            upper.push(edge_vertices[left.edge_vertex(count - 1)].vertex);
            if count > 2 {
                let inside = node.inside(1, j + 1);
                upper.extend(inside..inside + count as u32 - 2);
            }
            if count > 1 {
                upper.push(edge_vertices[right.edge_vertex(j + 1)].vertex);
            }
            let own = 3 * self.next_triangle;
            self.write_row(&lower, &upper, own, at);
            if j == 0 {
                (0..count)
                    .for_each(|i| self.meet(edge_vertices, bottom.segment(i), own + 6 * i as u32));
            } else {
                // The row below has two triangles more.
                let beneath = own - 3 * (2 * count as u32 + 1);
                (0..count as u32).for_each(|i| self.pair(own + 6 * i, beneath + 6 * i + 4));
            }
            self.meet(edge_vertices, left.segment(count - 1), own + 2);
            self.meet(
                edge_vertices,
                right.segment(j),
                own + 6 * (count as u32 - 1) + 1,
            );
            at += 2 * count - 1;
            self.next_triangle += 2 * count as u32 - 1;
            core::mem::swap(&mut lower, &mut upper);
            if self.is_over(j) {
                break;
            }
        }
        self.rows = [lower, upper];
    }

    /// A row of triangles between two rows of vertices, and what is beyond the edges between two of them; from a half-edge and a place on.
    fn write_row(&mut self, lower: &[u32], upper: &[u32], own: u32, at: usize) {
        let count = upper.len();
        let triangles = &mut self.triangles[at..at + 2 * count - 1];
        let twins = &mut self.twins[3 * at..3 * (at + 2 * count - 1)];
        let (pairs, last) = triangles.as_chunks_mut::<2>();
        let corners = lower.windows(2).zip(upper.windows(2));
        for (pair, (below, above)) in pairs.iter_mut().zip(corners) {
            let ([a, b], [c, d]) = ([below[0], below[1]], [above[0], above[1]]);
            *pair = [[a, b, c], [b, d, c]];
        }
        if let [last] = last {
            *last = [lower[count - 1], lower[count], upper[count - 1]];
        }
        let (pairs, _) = twins.as_chunks_mut::<6>();
        for (h, pair) in (own..).step_by(6).zip(pairs) {
            // The upright one's edge to the right, and that one's first, which the next upright one's left edge meets.
            (pair[1], pair[5], pair[3]) = (h + 5, h + 1, h + 8);
        }
        for i in 1..count {
            twins[6 * i + 2] = own + 6 * i as u32 - 3;
        }
    }

    /// The triangles of all leaves below a node, row by row: each leaf that stands upright is followed by the one to its right
    /// that is inverted.
    fn cover(&mut self, node: &Node<'_>, edge_vertices: &mut [EdgeVertex]) {
        let n = 1usize << node.depth;
        self.below.clear();
        self.below.resize(n, NONE);
        for j in 0..n {
            let (mut i, mut left) = (0, NONE);
            while i < n - j {
                if i == 1 && j > 0 {
                    (i, left) = self.inner(node, j, left);
                }
                let corners = [(i, j), (i + 1, j), (i, j + 1)]
                    .map(|(i, j)| self.vertex(node, edge_vertices, i, j));
                let right = self.upright(node, edge_vertices, (i, j), corners, left);
                if i + j + 1 < n {
                    let far = self.vertex(node, edge_vertices, i + 1, j + 1);
                    let first = self.push([corners[1], far, corners[2]]);
                    self.pair(first + 2, right);
                    left = first;
                    self.below[i] = first + 1;
                }
                i += 1;
            }
            if self.is_over(j) {
                return;
            }
        }
    }

    /// The leaves of a row from column 1 on, as long as their vertices and those of the ones to their right are inside the node: none is
    /// on a side. `left` is the half-edge beyond the first one's left edge; gives the column of the next, and that for it.
    fn inner(&mut self, node: &Node<'_>, j: usize, mut left: u32) -> (usize, u32) {
        let n = 1usize << node.depth;
        let end = (n - j).saturating_sub(2).max(1);
        let base = 3 * self.first_triangle;
        let at = (self.next_triangle - self.first_triangle) as usize;
        let (lower, upper) = (node.inside(1, j), node.inside(1, j + 1));
        let pairs = self.triangles[at..]
            .as_chunks_mut::<2>()
            .0
            .iter_mut()
            .take(end - 1);
        for (i, pair) in (0u32..).zip(pairs) {
            let [a, b] = [lower + i, upper + i];
            *pair = [[a, a + 1, b], [a + 1, b + 1, b]];
        }
        for i in 1..end {
            let first = 3 * self.next_triangle;
            let beneath = core::mem::replace(&mut self.below[i], first + 4);
            let own = (first - base) as usize;
            self.twins[own..own + 6].copy_from_slice(&[
                beneath,
                first + 5,
                left,
                first + 8,
                NONE,
                first + 1,
            ]);
            self.twins[(beneath - base) as usize] = first;
            if i == 1 {
                self.twins[(left - base) as usize] = first + 2;
            }
            left = first + 3;
            self.next_triangle += 2;
        }
        (end, left)
    }

    /// The triangles of an upright leaf, whose left edge has the given half-edge beyond it. Gives the half-edge along its
    /// edge to the right.
    fn upright(
        &mut self,
        node: &Node<'_>,
        edge_vertices: &mut [EdgeVertex],
        (i, j): (usize, usize),
        [a, b, c]: [u32; 3],
        left: u32,
    ) -> u32 {
        let n = 1usize << node.depth;
        let on_side = [j == 0, i + j + 1 == n, i == 0];
        let split = if on_side == [false; 3] {
            [None; 3]
        } else {
            self.rim.split(n, i, j)
        };
        let bits = bits(&split);
        let mut diagonal = Diagonal::FromStart;
        if bits.count_ones() == 2
            && let [from_end, rest @ ..] = self.diagonals
        {
            self.diagonals = rest;
            diagonal = if *from_end {
                Diagonal::FromEnd
            } else {
                Diagonal::FromStart
            };
        }
        let pattern = closure(bits, diagonal);
        let [d, e, f] = split.map(|edge_vertex| {
            edge_vertex.map_or(NONE, |edge_vertex| edge_vertices[edge_vertex].vertex)
        });
        let labels = [a, b, c, d, e, f];
        let first = 3 * self.next_triangle;
        for triangle in pattern.triangles() {
            self.push(triangle.map(|label| labels[label as usize]));
        }
        for h in 0..3 * pattern.triangles().len() {
            if let Some(twin) = pattern.twin(h) {
                self.twins[(first + h as u32 - 3 * self.first_triangle) as usize] =
                    first + twin as u32;
            }
        }
        let place = [i, j, n - 1 - j];
        for edge in 0..3 {
            let border = pattern.border(edge).map(|h| first + h as u32);
            if on_side[edge] {
                let [start, end] = [0, 1].map(|step| self.rim.corner(edge, place[edge] + step));
                match split[edge] {
                    None => self.meet(edge_vertices, start.min(end), border[0]),
                    Some(middle) => {
                        self.meet(edge_vertices, start.min(middle), border[0]);
                        self.meet(edge_vertices, middle.min(end), border[1]);
                    }
                }
            } else if edge == 0 {
                self.pair(border[0], self.below[i]);
            } else if edge == 2 {
                self.pair(border[0], left);
            }
        }
        first + pattern.border(1)[0] as u32
    }

    /// Adds a triangle; gives its first half-edge.
    #[inline]
    pub(super) fn push(&mut self, triangle: [u32; 3]) -> u32 {
        self.triangles[(self.next_triangle - self.first_triangle) as usize] = triangle;
        self.next_triangle += 1;
        3 * (self.next_triangle - 1)
    }

    #[inline]
    fn pair(&mut self, a: u32, b: u32) {
        let first = 3 * self.first_triangle;
        self.twins[(a - first) as usize] = b;
        self.twins[(b - first) as usize] = a;
    }

    /// A half-edge along a segment of a chain: the twin of the one that was there before, if there was.
    #[inline]
    fn meet(&mut self, edge_vertices: &mut [EdgeVertex], segment: usize, half_edge: u32) {
        let other = edge_vertices[segment].half_edge;
        if other == NONE {
            edge_vertices[segment].half_edge = half_edge;
        } else {
            self.pair(half_edge, other);
        }
    }
}
