//! Quadtrees over the control faces with their neighbours and vertices, divided and merged node by node. Knows no demands.
//!
//! A node may be divided when the nodes of its own level beyond its edges exist, and merged when
//! its children are not divided. Edges along which sheets were cut apart have copies: their nodes
//! count as neighbours, and where one of them is divided, the neighbours that are not divided have
//! *hanging* vertices of their own at one position.

use std::collections::HashMap;

use smallvec::SmallVec;

use super::halt::Halt;
use super::measure::Measure;
use super::pieces::{PieceRef, Pieces};
use crate::criterion::Region;
use crate::limit_surface::LimitSurface;
use crate::node::{Along, Beyond, Edges, NodeAddress, beyond};
use crate::parallel::{self, Cancelled};
use crate::patch::child_corners;
use crate::vector::{DVec3, vector};

/// No node.
pub(super) const NONE: u32 = u32::MAX;

/// The region beyond an edge of a node, on its level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Across {
    /// Nothing, or copies of the edge.
    Border,
    /// A node that does not exist.
    Missing,
    /// A node, and which of its edges it is.
    Node(u32, u8),
}

/// A triangle over a part of a control face.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) place: NodeAddress,
    pub(super) corners: [u32; 3],
    pub(super) across: [Across; 3],
    pub(super) parent: u32,
    /// The first of four, if it is divided.
    pub(super) children: u32,
    /// Its triangles' slots, or the vertices in the middles of its edges if it is divided.
    pub(super) own: [u32; 4],
    pub(super) triangles: u8,
    pub(super) is_suspect: bool,
    is_touched: bool,
    piece: Option<PieceRef>,
}

/// The values that a demand reads, in one line of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Extent {
    /// A ball that holds the node's triangle and its piece of the surface.
    pub(super) centre: DVec3,
    pub(super) radius: f64,
    /// How far these are from each other at most, place by place; also where neighbours split its edges.
    pub(super) value: f64,
    /// Changed whenever the node's number is given to another.
    pub(super) stamp: u32,
    pub(super) level: u8,
    /// Whether the node is to be divided for its own sake.
    pub(super) wants: bool,
}

/// Positions by slot.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<[f64; 3]>,
    free: Vec<u32>,
    /// Slots that were written since the last query.
    pub(super) written: Vec<u32>,
}

impl Vertices {
    fn put(&mut self, position: DVec3) -> u32 {
        let slot = self.free.pop().unwrap_or(self.positions.len() as u32);
        if slot as usize == self.positions.len() {
            self.positions.push([0.0; 3]);
        }
        self.positions[slot as usize] = position.to_array();
        self.written.push(slot);
        slot
    }

    pub(super) fn at(&self, slot: u32) -> DVec3 {
        vector(self.positions[slot as usize])
    }
}

/// Copies of a part of an edge: nodes, and which of their edges it is.
type Copies = SmallVec<[(u32, u8); 4]>;

/// The trees of all control faces; a face's root has its number.
pub(super) struct Forest<'a> {
    pub(super) nodes: Vec<Node>,
    pub(super) extents: Vec<Extent>,
    free: Vec<u32>,
    pub(super) vertices: Vertices,
    pieces: Pieces<'a>,
    edges: Edges<'a>,
    has_copies: bool,
    hanging: HashMap<(u32, u8), u32>,
    /// Nodes that were removed, or whose triangles may have changed.
    pub(super) touched: Vec<u32>,
    /// Slots of the triangles of removed nodes.
    pub(super) released: Vec<u32>,
    /// Triangles that are emitted, by Euler's formula.
    pub(super) triangles: usize,
}

impl<'a> Forest<'a> {
    /// The control faces alone.
    pub(super) fn of(
        surface: LimitSurface<'a>,
        measure: Measure,
        halt: &mut Halt<'_>,
    ) -> Result<Self, Cancelled> {
        let control = surface.control();
        let (topology, faces) = (control.topology(), control.face_count());
        let edges = Edges::of(control);
        let pieces = Pieces::of(surface, measure);
        let share = parallel::share(faces);
        let values =
            parallel::pieces_polled(faces, share, &mut |_| halt.watch().poll(), |block| {
                block
                    .map(|face| pieces.control_value(face as u32))
                    .collect::<Vec<_>>()
            })?
            .concat();
        let mut vertices = Vertices {
            positions: control.positions().to_vec(),
            ..Vertices::default()
        };
        let mut nodes = Vec::with_capacity(faces);
        let mut extents = Vec::with_capacity(faces);
        for (face, &value) in (0u32..).zip(&values) {
            let corners = control.triangles()[face as usize];
            let places = pieces.control_corners(face);
            for (&vertex, place) in corners.iter().zip(places) {
                vertices.positions[vertex as usize] = place.to_array();
            }
            let across = [0, 1, 2].map(|edge| match edges.twin(3 * face + edge) {
                Some(twin) => Across::Node(twin / 3, (twin % 3) as u8),
                None => Across::Border,
            });
            nodes.push(Node::new(
                NodeAddress::root(face),
                corners,
                across,
                NONE,
                None,
            ));
            extents.push(Extent::of(places, value, 0));
        }
        let has_copies = edges.group_count() > 0;
        let touched = (0..faces as u32).collect();
        nodes
            .iter_mut()
            .for_each(|node: &mut Node| node.is_touched = true);
        debug_assert_eq!(topology.face_count(), faces);
        Ok(Self {
            triangles: faces,
            nodes,
            extents,
            free: Vec::new(),
            vertices,
            pieces,
            edges,
            has_copies,
            hanging: HashMap::new(),
            touched,
            released: Vec::new(),
        })
    }

    pub(super) fn surface(&self) -> &LimitSurface<'a> {
        self.pieces.surface()
    }

    /// The measure of the values.
    pub(super) fn measure(&self) -> Measure {
        self.pieces.measure()
    }

    pub(super) fn node(&self, node: u32) -> &Node {
        &self.nodes[node as usize]
    }

    pub(super) fn node_mut(&mut self, node: u32) -> &mut Node {
        &mut self.nodes[node as usize]
    }

    /// Whether a node is to be divided for its own sake.
    pub(super) fn wants(&self, node: u32) -> bool {
        self.extents[node as usize].wants
    }

    /// Whether a number is that of a node.
    pub(super) fn exists(&self, node: u32) -> bool {
        self.node(node).place.level == 0 || self.node(node).parent != NONE
    }

    /// The greatest measure of a leaf.
    pub(super) fn worst(&self, measure: impl Fn(&Extent) -> f64) -> f64 {
        let leaves = (0u32..)
            .zip(&self.extents)
            .filter(|&(node, _)| self.exists(node) && !self.is_divided(node));
        leaves
            .map(|(_, extent)| measure(extent))
            .fold(0.0, f64::max)
    }

    /// The greatest measure of a control face.
    pub(super) fn greatest(&self, measure: impl Fn(&Extent) -> f64) -> f64 {
        let faces = self.surface().control().face_count();
        self.extents[..faces]
            .iter()
            .map(measure)
            .fold(0.0, f64::max)
    }

    pub(super) fn is_divided(&self, node: u32) -> bool {
        self.node(node).children != NONE
    }

    /// The nodes of the same level that share an edge.
    pub(super) fn adjacent(&self, node: u32, edge: u8) -> Copies {
        match self.node(node).across[usize::from(edge)] {
            Across::Node(other, side) => SmallVec::from_slice(&[(other, side)]),
            Across::Border if self.has_copies => self.copies(node, edge),
            _ => Copies::new(),
        }
    }

    /// Whether and by which vertex an edge of a node that is not divided is split.
    pub(super) fn split_of(&self, node: u32, edge: u8) -> Option<u32> {
        match self.node(node).across[usize::from(edge)] {
            Across::Node(other, side) if self.is_divided(other) => {
                Some(self.node(other).own[usize::from(side)])
            }
            Across::Border if self.has_copies => self.hanging.get(&(node, edge)).copied(),
            _ => None,
        }
    }

    /// The node at a place, if it exists, or where the way there ends.
    fn find(&self, place: NodeAddress) -> Result<u32, u32> {
        let mut node = place.face;
        for level in 0..place.level {
            match self.node(node).children {
                NONE => return Err(node),
                first => node = first + place.digit(level) as u32,
            }
        }
        Ok(node)
    }

    /// The places of all other nodes along a cut edge, in the order of the group; the first says whose point counts.
    fn copies_of(&self, place: NodeAddress, edge: u8) -> SmallVec<[(NodeAddress, u8); 4]> {
        let Beyond::Control(along) = beyond(place, usize::from(edge)) else {
            return SmallVec::new();
        };
        let Some(group) = self.edges.group(along.half_edge) else {
            return SmallVec::new();
        };
        let members = self.edges.members(group);
        let turned = members
            .iter()
            .any(|&(member, turned)| member == along.half_edge && turned);
        let index = if turned {
            (1 << along.level) - 1 - along.index
        } else {
            along.index
        };
        let first = Along { index, ..along };
        let places = members
            .iter()
            .map(|&(member, turned)| first.node_at(member, turned));
        places.map(|(place, edge)| (place, edge as u8)).collect()
    }

    fn copies(&self, node: u32, edge: u8) -> Copies {
        let places = self.copies_of(self.node(node).place, edge);
        let found = places
            .iter()
            .filter_map(|&(place, edge)| Some((self.find(place).ok()?, edge)));
        found.filter(|&(other, _)| other != node).collect()
    }

    /// A node that must be divided before one may be: the way to a neighbour ends there.
    pub(super) fn missing(&self, node: u32) -> Option<u32> {
        let own = self.node(node);
        for edge in 0..3u8 {
            match own.across[usize::from(edge)] {
                Across::Node(..) => {}
                Across::Missing => match self.node(own.parent).across[usize::from(edge)] {
                    Across::Node(above, _) => return Some(above),
                    // Balanced: the parent's neighbour exists.
                    _ => return Some(own.parent),
                },
                Across::Border if self.has_copies => {
                    let places = self.copies_of(own.place, edge);
                    let ends = places.iter().find_map(|&(place, _)| self.find(place).err());
                    if ends.is_some() {
                        return ends;
                    }
                }
                Across::Border => {}
            }
        }
        None
    }

    fn touch(&mut self, node: u32) {
        if !self.node(node).is_touched {
            self.node_mut(node).is_touched = true;
            self.touched.push(node);
        }
    }

    /// The nodes whose triangles may be others than before; they are untouched then.
    pub(super) fn take_touched(&mut self) -> Vec<u32> {
        let touched = core::mem::take(&mut self.touched);
        touched
            .iter()
            .for_each(|&node| self.node_mut(node).is_touched = false);
        touched
    }

    /// Divides a node; the nodes beyond its edges exist.
    pub(super) fn divide(&mut self, node: u32) {
        let Node { piece, place, .. } = *self.node(node);
        let piece = piece.unwrap_or_else(|| self.pieces.control(place.face));
        self.node_mut(node).piece = Some(piece);
        let parts = self.pieces.parts(piece);
        let middles = [0u8, 1, 2].map(|edge| self.middle_vertex(node, edge));
        let own = self.node_mut(node);
        let slots = core::mem::take(&mut own.triangles);
        let (triangles, place, corners, across) = (own.own, own.place, own.corners, own.across);
        own.own = [middles[0], middles[1], middles[2], NONE];
        self.released.extend(&triangles[..usize::from(slots)]);
        let first = self.take_four();
        self.node_mut(node).children = first;
        for (child, (piece, value)) in parts.into_iter().enumerate() {
            let mut sides = [Across::Missing; 3];
            for (edge, side) in sides.iter_mut().enumerate() {
                *side = match child {
                    3 => Across::Node(first + (edge as u32 + 2) % 3, edge as u8),
                    _ if edge == (child + 1) % 3 => Across::Node(first + 3, edge as u8),
                    _ if across[edge] == Across::Border => Across::Border,
                    _ => Across::Missing,
                };
            }
            let at = child_corners(corners, middles, child);
            let at_places = at.map(|vertex| self.vertices.at(vertex));
            let index = (first as usize) + child;
            self.nodes[index] = Node::new(place.child(child), at, sides, node, Some(piece));
            let stamp = self.extents[index].stamp;
            self.extents[index] = Extent {
                stamp,
                ..Extent::of(at_places, value, place.level + 1)
            };
        }
        for (edge, side) in (0u32..).zip(across) {
            if let Across::Node(other, side) = side {
                let theirs = self.node(other).children;
                if theirs == NONE {
                    self.touch(other);
                } else {
                    let side = u32::from(side);
                    self.join(first + edge, edge, theirs + (side + 1) % 3, side);
                    self.join(first + (edge + 1) % 3, edge, theirs + side, side);
                }
            }
        }
        (0..4).for_each(|child| self.touch(first + child));
    }

    fn join(&mut self, a: u32, edge: u32, b: u32, side: u32) {
        self.node_mut(a).across[edge as usize] = Across::Node(b, side as u8);
        self.node_mut(b).across[side as usize] = Across::Node(a, edge as u8);
    }

    fn take_four(&mut self) -> u32 {
        if let Some(first) = self.free.pop() {
            return first;
        }
        let first = self.nodes.len();
        let blank = Node::new(
            NodeAddress::root(0),
            [0; 3],
            [Across::Border; 3],
            NONE,
            None,
        );
        self.nodes.resize(first + 4, blank);
        self.extents
            .resize(first + 4, Extent::of([DVec3::ZERO; 3], 0.0, 0));
        first as u32
    }

    /// The vertex in the middle of an edge of a node that is to be divided.
    fn middle_vertex(&mut self, node: u32, edge: u8) -> u32 {
        let across = self.node(node).across[usize::from(edge)];
        let copies = match across {
            Across::Node(other, side) if self.is_divided(other) => {
                return self.node(other).own[usize::from(side)];
            }
            Across::Border if self.has_copies => {
                if let Some(vertex) = self.hanging.remove(&(node, edge)) {
                    return vertex;
                }
                self.copies(node, edge)
            }
            _ => Copies::new(),
        };
        let position = self.middle_position(node, edge);
        self.triangles += if matches!(across, Across::Border) {
            1
        } else {
            2
        };
        let vertex = self.vertices.put(position);
        for (other, side) in copies {
            let theirs = self.vertices.put(position);
            self.triangles += 1;
            self.hanging.insert((other, side), theirs);
            self.touch(other);
        }
        vertex
    }

    /// The point in the middle of an edge. The first side in order of control faces and paths
    /// computes it, so that it has the same bits on all sides.
    fn middle_position(&self, node: u32, edge: u8) -> DVec3 {
        let key = |node: u32| (self.node(node).place.face, self.node(node).place.path);
        let adjacent = self.adjacent(node, edge);
        let all = adjacent.iter().copied().chain([(node, edge)]);
        let (teller, side) = all
            .min_by_key(|&(node, edge)| (key(node), edge))
            .unwrap_or((node, edge));
        let Node { piece, place, .. } = self.node(teller);
        self.pieces.middle(*piece, place.face, usize::from(side))
    }

    /// Undoes a division; the children are not divided.
    pub(super) fn merge(&mut self, node: u32) {
        let own = self.node_mut(node);
        let first = core::mem::replace(&mut own.children, NONE);
        let (middles, across, piece) = (own.own, own.across, own.piece);
        let is_root = own.parent == NONE;
        for child in first..first + 4 {
            let own = self.node_mut(child);
            let (slots, count) = (own.own, core::mem::take(&mut own.triangles));
            let theirs = own.piece;
            self.released.extend(&slots[..usize::from(count)]);
            if let (Some(PieceRef::General(_) | PieceRef::Sampled(_)), Some(theirs)) =
                (piece, theirs)
            {
                self.pieces.give_back(theirs);
            }
            self.node_mut(child).parent = NONE;
            let extent = &mut self.extents[child as usize];
            extent.stamp = extent.stamp.wrapping_add(1);
        }
        if is_root && let Some(piece) = self.node_mut(node).piece.take() {
            self.pieces.give_back(piece);
        }
        self.free.push(first);
        for edge in 0..3u8 {
            let vertex = middles[usize::from(edge)];
            match across[usize::from(edge)] {
                Across::Node(other, side) if self.is_divided(other) => {
                    let theirs = self.node(other).children;
                    for child in [u32::from(side), (u32::from(side) + 1) % 3] {
                        self.node_mut(theirs + child).across[usize::from(side)] = Across::Missing;
                    }
                }
                Across::Node(other, _) => {
                    self.drop_vertex(vertex, 2);
                    self.touch(other);
                }
                _ => self.merge_copies(node, edge, vertex),
            }
        }
        self.touch(node);
    }

    fn merge_copies(&mut self, node: u32, edge: u8, vertex: u32) {
        let copies = if self.has_copies {
            self.copies(node, edge)
        } else {
            Copies::new()
        };
        if copies.iter().any(|&(other, _)| self.is_divided(other)) {
            self.hanging.insert((node, edge), vertex);
            return;
        }
        self.drop_vertex(vertex, 1);
        for (other, side) in copies {
            if let Some(theirs) = self.hanging.remove(&(other, side)) {
                self.drop_vertex(theirs, 1);
                self.touch(other);
            }
        }
    }

    fn drop_vertex(&mut self, vertex: u32, triangles: usize) {
        self.vertices.free.push(vertex);
        self.triangles -= triangles;
    }
}

impl Node {
    fn new(
        place: NodeAddress,
        corners: [u32; 3],
        across: [Across; 3],
        parent: u32,
        piece: Option<PieceRef>,
    ) -> Self {
        Self {
            place,
            corners,
            across,
            parent,
            children: NONE,
            own: [NONE; 4],
            triangles: 0,
            is_suspect: false,
            is_touched: false,
            piece,
        }
    }
}

impl Extent {
    fn of(corners: [DVec3; 3], value: f64, level: u32) -> Self {
        let Region { centre, radius, .. } = Region::around(corners, DVec3::ZERO).grown(value);
        Self {
            centre,
            radius,
            value,
            stamp: 0,
            level: level as u8,
            wants: false,
        }
    }
}
