//! The hierarchy over the control mesh: each control face a quadtree, neighbouring leaves at most one level apart.
//!
//! Nodes know their corners and their neighbours of the same level, no positions. Splitting a node splits what must
//! be split before, so that the restriction holds at any moment, and all copies of an edge of cut sheets alike. Parts
//! 0 to 2 of a node keep the corner of their number at its place; corner `i` of part 3, the middle one, is the new
//! vertex opposite corner `i`.

use crate::index::HalfEdgeId;
use crate::mesh::{Mesh, MeshError, NONE, Sharpness};

/// Nodes that half-edge indices can number.
const MAX_NODES: usize = crate::mesh::MAX_FACES;

/// The quadtrees of all control faces.
#[derive(Clone, Debug)]
pub(super) struct Forest {
    roots: usize,
    vertices: usize,
    /// Corner vertices of each node.
    corners: Vec<[u32; 3]>,
    /// By node and edge, the half-edge (3 · node + edge) of the neighbour of the same level, or [`NONE`].
    twins: Vec<[u32; 3]>,
    /// The first of four consecutive children, or [`NONE`] for a leaf.
    children: Vec<u32>,
    /// The parent of each four children.
    parents: Vec<u32>,
    levels: Vec<u8>,
    /// Bits of the edges on the boundary of the mesh or on a sharp edge.
    open: Vec<u8>,
    /// Triangles that the leaves would be emitted as.
    triangles: usize,
    copies: Copies,
}

/// What splitting a node changed.
#[derive(Default)]
pub(super) struct Changes {
    /// Nodes that were split, in order.
    pub(super) split: Vec<u32>,
    /// Leaves with another split edge than before; some may have been split since.
    pub(super) touched: Vec<u32>,
}

impl Forest {
    /// The control faces as leaves.
    pub(super) fn new(mesh: &Mesh, sharpness: &Sharpness<'_>) -> Self {
        let topology = mesh.topology();
        let roots = mesh.face_count();
        let open = |h: usize| u8::from(sharpness.edge(HalfEdgeId(h as u32)) > 0.0);
        let twin = |h: usize| topology.twin(HalfEdgeId(h as u32)).map_or(NONE, |twin| twin.0);
        Self {
            roots,
            vertices: mesh.vertex_count(),
            corners: mesh.triangles().to_vec(),
            twins: (0..roots).map(|node| [0, 1, 2].map(|edge| twin(3 * node + edge))).collect(),
            children: vec![NONE; roots],
            parents: Vec::new(),
            levels: vec![0; roots],
            open: (0..roots)
                .map(|node| (0..3).fold(0, |bits, edge| bits | open(3 * node + edge) << edge))
                .collect(),
            triangles: roots,
            copies: Copies::of(mesh),
        }
    }

    pub(super) fn roots(&self) -> usize {
        self.roots
    }

    pub(super) fn node_count(&self) -> usize {
        self.corners.len()
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.vertices
    }

    /// Triangles that the leaves are emitted as.
    pub(super) fn triangle_count(&self) -> usize {
        self.triangles
    }

    #[inline]
    pub(super) fn corners(&self, node: u32) -> [u32; 3] {
        self.corners[node as usize]
    }

    pub(super) fn level(&self, node: u32) -> usize {
        self.levels[node as usize].into()
    }

    /// The first of a node's four children; `None` for a leaf.
    #[inline]
    pub(super) fn children(&self, node: u32) -> Option<u32> {
        let first = self.children[node as usize];
        (first != NONE).then_some(first)
    }

    /// The parent of a node and the node's place among its children; `None` for a control face.
    #[inline]
    pub(super) fn parent(&self, node: u32) -> Option<(u32, usize)> {
        let place = (node as usize).checked_sub(self.roots)?;
        Some((self.parents[place / 4], place % 4))
    }

    /// The half-edge of the neighbour of the same level.
    #[inline]
    pub(super) fn twin(&self, node: u32, edge: usize) -> Option<u32> {
        let twin = self.twins[node as usize][edge];
        (twin != NONE).then_some(twin)
    }

    /// The vertex in the middle of an edge of a leaf, if the neighbour put one there.
    #[inline]
    pub(super) fn middle(&self, node: u32, edge: usize) -> Option<u32> {
        let twin = self.twin(node, edge)?;
        let child = self.children(twin / 3)?;
        let side = (twin % 3) as usize;
        Some(self.corners[child as usize + side][(side + 1) % 3])
    }

    /// Which edges of a leaf the neighbours have split, as bits.
    #[inline]
    pub(super) fn split_edges(&self, node: u32) -> u8 {
        let is_split =
            |edge| self.twin(node, edge).is_some_and(|twin| self.children[twin as usize / 3] != NONE);
        (0..3).fold(0, |bits, edge| bits | u8::from(is_split(edge)) << edge)
    }

    /// Which edges of a node lie on the boundary of the mesh or on a sharp edge.
    pub(super) fn open_edges(&self, node: u32) -> [bool; 3] {
        [0, 1, 2].map(|edge| self.open[node as usize] & 1 << edge != 0)
    }

    /// The nodes that splitting `node` splits: those that must be split before, first.
    pub(super) fn needed(&self, node: u32) -> Vec<u32> {
        let (mut needed, mut seen, mut stack) = (Vec::new(), Vec::new(), vec![(node, false)]);
        while let Some((node, ready)) = stack.pop() {
            if ready {
                needed.push(node);
            } else if self.children(node).is_none() && !seen.contains(&node) {
                seen.push(node);
                stack.push((node, true));
                stack.extend(self.blocking(node).into_iter().map(|other| (other, false)));
            }
        }
        needed
    }

    /// Whether a node can be split as it is.
    fn is_free(&self, node: u32) -> bool {
        let Some((_, place)) = self.parent(node) else { return self.copies.is_empty() };
        self.copies.is_empty()
            && (place == 3 || (0..3).all(|edge| edge == (place + 1) % 3 || self.twin(node, edge).is_some()))
    }

    /// The leaves that must be split before or together with a node: those of one level less where the node
    /// needs neighbours, and those at copies of its edges.
    fn blocking(&self, node: u32) -> Vec<u32> {
        let mut blocking = Vec::new();
        if let Some((parent, place)) = self.parent(node)
            && place < 3
        {
            for edge in [place, (place + 2) % 3] {
                if self.twin(node, edge).is_none()
                    && let Some(twin) = self.twin(parent, edge)
                {
                    blocking.push(twin / 3);
                }
            }
        }
        if !self.copies.is_empty() {
            for edge in (0..3).filter(|&edge| self.twin(node, edge).is_none()) {
                self.copies_of(node, edge, &mut blocking);
            }
        }
        blocking
    }

    /// The leaves at copies of a node's boundary edge, of its level or above.
    fn copies_of(&self, node: u32, edge: usize, found: &mut Vec<u32>) {
        // The edge's number among the parts of the control face's edge, as bits from the finest level on.
        let (mut at, mut number, mut level) = (node, 0u64, 0);
        while let Some((parent, place)) = self.parent(at) {
            if place == 3 || place == (edge + 2) % 3 {
                return;
            }
            number |= u64::from(place != edge) << level;
            level += 1;
            at = parent;
        }
        for (copy, turned) in self.copies.of_edge(3 * at + edge as u32) {
            let (mut other, side) = (copy / 3, (copy % 3) as usize);
            for bit in (0..level).rev() {
                let Some(first) = self.children(other) else { break };
                let second = (number >> bit & 1 == 1) != turned;
                other = first + if second { (side as u32 + 1) % 3 } else { side as u32 };
            }
            if self.children(other).is_none() {
                found.push(other);
            }
        }
    }

    /// Splits a leaf, and before it what must be.
    ///
    /// # Errors
    /// There would be more nodes than can be numbered.
    pub(super) fn split(&mut self, node: u32, changes: &mut Changes) -> Result<(), MeshError> {
        if self.is_free(node) {
            return self.split_one(node, changes);
        }
        self.needed(node).into_iter().try_for_each(|node| self.split_one(node, changes))
    }

    /// Splits a leaf whose neighbours of the same level are all there.
    fn split_one(&mut self, node: u32, changes: &mut Changes) -> Result<(), MeshError> {
        let first = self.corners.len();
        if first + 4 > MAX_NODES || self.vertices + 3 >= NONE as usize {
            return Err(MeshError::TooMany { what: "nodes", count: first + 4, limit: MAX_NODES });
        }
        let first = first as u32;
        let corners = self.corners(node);
        let mut middles = [0; 3];
        let mut shared = 0;
        for (edge, middle) in middles.iter_mut().enumerate() {
            *middle = match self.middle(node, edge) {
                Some(middle) => {
                    shared += 1;
                    middle
                }
                None => {
                    self.vertices += 1;
                    self.vertices as u32 - 1
                }
            };
        }
        let level = self.levels[node as usize] + 1;
        for part in 0..3 {
            let mut own = [0; 3];
            own[part] = corners[part];
            own[(part + 1) % 3] = middles[part];
            own[(part + 2) % 3] = middles[(part + 2) % 3];
            self.corners.push(own);
        }
        self.corners.push([middles[1], middles[2], middles[0]]);
        self.twins.extend([[NONE; 3]; 4]);
        self.children.extend([NONE; 4]);
        self.levels.extend([level; 4]);
        // A part lies along both edges at its corner.
        let open = self.open[node as usize];
        self.open.extend([0, 1, 2].map(|part| open & (1 << part | 1 << ((part + 2) % 3))));
        self.open.push(0);
        self.parents.push(node);
        self.children[node as usize] = first;
        let mut grown = 3 - shared;
        for edge in 0..3 {
            let inner = (edge + 1) % 3;
            self.join(3 * (first + edge as u32) + inner as u32, 3 * (first + 3) + inner as u32);
            let Some(twin) = self.twin(node, edge) else { continue };
            let (other, side) = (twin / 3, twin % 3);
            let Some(theirs) = self.children(other) else {
                changes.touched.push(other);
                grown += 1;
                continue;
            };
            let start = 3 * (first + edge as u32) + edge as u32;
            let end = 3 * (first + (edge as u32 + 1) % 3) + edge as u32;
            self.join(start, 3 * (theirs + (side + 1) % 3) + side);
            self.join(end, 3 * (theirs + side) + side);
        }
        self.triangles += grown;
        changes.split.push(node);
        Ok(())
    }

    fn join(&mut self, a: u32, b: u32) {
        self.twins[a as usize / 3][a as usize % 3] = b;
        self.twins[b as usize / 3][b as usize % 3] = a;
    }
}

/// Which boundary half-edges of control faces run along one edge, in sheets that were cut apart.
#[derive(Clone, Debug, Default)]
struct Copies {
    /// By half-edge, ascending, its group.
    groups: Vec<(u32, u32)>,
    /// By group, the half-edges and whether each runs against the group's first.
    members: Vec<Vec<(u32, bool)>>,
}

impl Copies {
    fn of(mesh: &Mesh) -> Self {
        let start = |h: u32| mesh.positions()[mesh.topology().origin(HalfEdgeId(h)).index()];
        let members: Vec<Vec<(u32, bool)>> = mesh
            .junctions()
            .edges
            .iter()
            .map(|group| group.iter().map(|&h| (h, start(h) != start(group[0]))).collect())
            .collect();
        let mut groups: Vec<(u32, u32)> = (0..)
            .zip(&members)
            .flat_map(|(group, members)| members.iter().map(move |&(h, _)| (h, group)))
            .collect();
        groups.sort_unstable();
        Self { groups, members }
    }

    fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// The other copies of the edge of `h`, and whether they run against it.
    fn of_edge(&self, h: u32) -> impl Iterator<Item = (u32, bool)> + '_ {
        let group = self.groups.binary_search_by_key(&h, |&(member, _)| member);
        let members = group.map_or(&[][..], |at| &self.members[self.groups[at].1 as usize]);
        let own = members.iter().find(|&&(member, _)| member == h).is_some_and(|&(_, turned)| turned);
        members
            .iter()
            .filter(move |&&(member, _)| member != h)
            .map(move |&(member, turned)| (member, turned != own))
    }
}
