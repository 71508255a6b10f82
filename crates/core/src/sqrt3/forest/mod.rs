//! The forest of adaptive √3-subdivision: triangles of all levels that are needed, and how they neighbour each other.
//!
//! A node of level L+1 comes from a half-edge of level L: for h from A to B in t, with u across it, `T(t, h) = (A, apex of u, apex
//! of t)`. So a node has three children, one for each half-edge, and **a node exists as soon as both of its parents are
//! split; to split a node needs nothing else**. That is the whole balance rule (Kobbelt's, by half-edges). Sharp edges, which have
//! nothing across them, are as in [`super::step`]; there both sides are cut together ([`rims`]).
//!
//! Nodes are *grown* before they are split: growing gives apex and children, so that limits, which depend on the level's
//! neighbourhood, are computed once and from the same points, whatever is split when; only split nodes count for the result.

mod build;
mod emit;
mod places;
mod rims;
mod samples;
mod split;

use std::collections::{BTreeMap, HashMap};

use crate::geometry::NONE;
use crate::limit::SidedNormals;
use crate::mesh::Mesh;
use crate::refine::Origin;
use crate::vector::DVec3;

pub(super) use emit::Emitted;
pub(super) use split::Triangle;

/// A half-edge of a node: three times the node and the corner that it leaves.
type Side = u32;

const fn node_of(side: Side) -> usize {
    (side / 3) as usize
}

const fn edge_of(side: Side) -> usize {
    (side % 3) as usize
}

/// The half-edge of a node that leaves its corner `edge`, counted round.
const fn side(node: usize, edge: usize) -> Side {
    (3 * node + edge % 3) as u32
}

/// A triangle of a level.
#[derive(Clone, Debug)]
struct Node {
    corners: [u32; 3],
    /// Half-edges across, of nodes of the same level; [`NONE`] where there is none yet, or never.
    across: [Side; 3],
    children: [u32; 3],
    /// The half-edge that gave it; [`NONE`] at the control mesh.
    parent: Side,
    /// The centre twice, or the points on the edge that is cut; [`NONE`] before it is grown.
    apexes: [u32; 2],
    /// The control face that it is counted to.
    root: u32,
    level: u8,
    /// A bit for each sharp edge.
    sharp: u8,
    is_split: bool,
}

/// How positions and limits of a vertex go.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Inside, with the factor by which the distance to the limit shrinks in a step.
    Smooth(f64),
    /// The centre of a control face, or of one of a later even level, with sharp edges: regular after one more step.
    BesideSharp,
    /// On a sharp curve.
    Curve,
    /// Keeps its place.
    Corner,
    /// Where a crease ends; its number among these.
    Dart(u32),
}

#[derive(Clone, Debug)]
struct Vertex {
    kind: Kind,
    /// The level of its creation, and its position there.
    level: u8,
    at: DVec3,
    /// The node that it is the centre of, or the half-edge that it lies on.
    maker: Side,
    limit: Option<DVec3>,
    /// Zero where there is no tangent plane.
    normal: Option<DVec3>,
    /// The first of the vertices at its place, on other sides of sharp edges.
    first: u32,
}

/// All nodes, vertices and sharp edges.
pub(super) struct Forest<'m> {
    control: &'m Mesh,
    nodes: Vec<Node>,
    vertices: Vec<Vertex>,
    rims: rims::Rims,
    /// By half-edge with a sharp edge, which that is and on which side of it.
    rim_of: HashMap<Side, (u32, u32)>,
    /// Positions after one step of vertices that [`Kind::BesideSharp`] names.
    smoothed: BTreeMap<u32, DVec3>,
    darts: Vec<places::Dart>,
    /// By vertex, if they are wanted.
    origins: Option<Vec<Origin>>,
    /// Of the control mesh.
    normals: SidedNormals,
    /// Triangles of the result.
    triangles: usize,
    max_triangles: usize,
    /// Triangles of the result that arose since the last query.
    fresh: Vec<Triangle>,
}

impl Node {
    fn is_odd(&self) -> bool {
        self.level % 2 == 1
    }

    fn is_sharp(&self, edge: usize) -> bool {
        self.sharp >> (edge % 3) & 1 != 0
    }

    fn is_grown(&self) -> bool {
        self.apexes[0] != NONE
    }

    /// The edge that is cut when it is split.
    fn cut_edge(&self) -> Option<usize> {
        (self.is_odd() && self.sharp != 0).then(|| self.sharp.trailing_zeros() as usize)
    }

    /// The apex seen from across an edge.
    fn apex(&self, edge: usize) -> u32 {
        self.apexes[usize::from(self.cut_edge().is_some_and(|cut| (cut + 1) % 3 == edge % 3))]
    }
}

impl Forest<'_> {
    fn node(&self, side: Side) -> &Node {
        &self.nodes[node_of(side)]
    }

    /// The half-edge across, if its node is there.
    fn across(&self, side: Side) -> Option<Side> {
        Some(self.node(side).across[edge_of(side)]).filter(|&across| across != NONE)
    }

    /// The child of a half-edge.
    fn child(&self, side: Side) -> Option<usize> {
        Some(self.node(side).children[edge_of(side)])
            .filter(|&child| child != NONE)
            .map(|child| child as usize)
    }

    /// Origin and target of a half-edge.
    fn ends(&self, at: Side) -> [u32; 2] {
        let corners = &self.node(at).corners;
        [corners[edge_of(at)], corners[(edge_of(at) + 1) % 3]]
    }

    /// Gives a node its apex, and all children whose other parents have theirs.
    fn grow(&mut self, t: usize) {
        if self.nodes[t].is_grown() {
            return;
        }
        let made = match self.nodes[t].cut_edge() {
            Some(edge) => self.cut(side(t, edge)),
            None => [self.make_centre(t); 2],
        };
        // A split of a neighbour may have grown it.
        if self.nodes[t].is_grown() {
            return;
        }
        self.nodes[t].apexes = made;
        let mut new = Vec::with_capacity(6);
        for edge in 0..3 {
            let own = side(t, edge);
            if self.nodes[t].is_sharp(edge) {
                new.push(self.make_next_to_sharp(own));
            } else if let Some(other) = self
                .across(own)
                .filter(|&other| self.node(other).is_grown())
            {
                new.extend([self.make_child(own, other), self.make_child(other, own)]);
            }
        }
        for node in new {
            self.link(node);
        }
    }

    /// The control face of the children of a half-edge.
    fn root(&self, own: Side) -> u32 {
        let node = self.node(own);
        // (A, apex, apex): the second is in the face across the edge, and so are the children of
        // its edges.
        let across = (node.is_odd() && node.cut_edge().is_none() && edge_of(own) < 2)
            .then(|| self.across(side(node_of(own), 1)))
            .flatten();
        across.map_or(node.root, |across| self.node(across).root)
    }

    fn push_node(&mut self, corners: [u32; 3], parent: Side, sharp: u8) -> usize {
        let (root, level) = (self.root(parent), self.node(parent).level + 1);
        let number = self.nodes.len();
        self.nodes[node_of(parent)].children[edge_of(parent)] = number as u32;
        let (across, children, apexes) = ([NONE; 3], [NONE; 3], [NONE; 2]);
        self.nodes.push(Node {
            corners,
            across,
            children,
            parent,
            apexes,
            root,
            level,
            sharp,
            is_split: false,
        });
        number
    }

    /// The child of a half-edge with a neighbour across it.
    fn make_child(&mut self, own: Side, other: Side) -> usize {
        let apexes = [
            self.node(other).apex(edge_of(other)),
            self.node(own).apex(edge_of(own)),
        ];
        let corners = [self.ends(own)[0], apexes[0], apexes[1]];
        // Next to a cut edge, it has one of the outer parts.
        let first = self
            .node(other)
            .cut_edge()
            .filter(|cut| (cut + 2) % 3 == edge_of(other));
        let last = self
            .node(own)
            .cut_edge()
            .filter(|cut| (cut + 1) % 3 == edge_of(own));
        let sharp = u8::from(first.is_some()) | u8::from(last.is_some()) << 2;
        let child = self.push_node(corners, own, sharp);
        if let Some(cut) = first {
            self.note_part(side(node_of(other), cut), 0, side(child, 0));
        }
        if let Some(cut) = last {
            self.note_part(side(node_of(own), cut), 2, side(child, 2));
        }
        child
    }

    /// The child of a half-edge with a sharp edge.
    fn make_next_to_sharp(&mut self, own: Side) -> usize {
        let node = self.node(own);
        let ([a, b], third) = (self.ends(own), node.corners[(edge_of(own) + 2) % 3]);
        if node.is_odd() {
            let [l, r] = node.apexes;
            let child = self.push_node([l, r, third], own, 1);
            self.note_part(own, 1, side(child, 0));
            return child;
        }
        let apex = node.apexes[0];
        let child = self.push_node([a, b, apex], own, 1);
        if let Some(&rim) = self.rim_of.get(&own) {
            self.rim_of.insert(side(child, 0), rim);
        }
        child
    }

    /// Connects a node with its neighbours, as far as they exist.
    fn link(&mut self, node: usize) {
        for edge in 0..3 {
            let across = match self.neighbour(node, edge) {
                Neighbour::Child(of, edge) => self.child(of).map(|child| side(child, edge)),
                Neighbour::ChildAcross(of) => self
                    .across(of)
                    .and_then(|other| self.child(other))
                    .map(|child| side(child, 0)),
                Neighbour::None => None,
            };
            if let Some(across) = across {
                self.nodes[node].across[edge] = across;
                self.nodes[node_of(across)].across[edge_of(across)] = side(node, edge);
            }
        }
    }

    /// The neighbour across an edge of a node, by its parents.
    fn neighbour(&self, node: usize, edge: usize) -> Neighbour {
        let Node { parent, sharp, .. } = self.nodes[node];
        if parent == NONE || sharp >> edge & 1 != 0 {
            return Neighbour::None;
        }
        let (t, h) = (node_of(parent), edge_of(parent));
        let own = &self.nodes[t];
        let Some(across) = self.across(parent) else {
            // The child of a sharp edge.
            return match (own.is_odd(), edge) {
                (true, 1) => Neighbour::ChildAcross(side(t, h + 1)),
                (true, _) => Neighbour::Child(side(t, h + 2), 2),
                (false, 1) => Neighbour::Child(side(t, h + 1), 2),
                (false, _) if own.is_sharp(h + 2) => Neighbour::Child(side(t, h + 2), 1),
                (false, _) => Neighbour::ChildAcross(side(t, h + 2)),
            };
        };
        let (u, j) = (node_of(across), edge_of(across));
        match edge {
            0 => match self.nodes[u].cut_edge() {
                Some(cut) if (cut + 1) % 3 == j => Neighbour::Child(side(u, cut), 1),
                _ => Neighbour::Child(side(u, j + 1), 2),
            },
            1 => Neighbour::Child(across, 1),
            _ => match own.cut_edge() {
                Some(cut) if (cut + 2) % 3 == h => Neighbour::Child(side(t, cut), 2),
                _ if own.is_sharp(h + 2) => Neighbour::Child(side(t, h + 2), 1),
                _ => Neighbour::ChildAcross(side(t, h + 2)),
            },
        }
    }

    /// The half-edge across a smooth one, grown for if it isn't there.
    fn require(&mut self, at: Side) -> Option<Side> {
        if let Some(across) = self.across(at) {
            return Some(across);
        }
        // Levels fall, so this ends.
        let missing = match self.neighbour(node_of(at), edge_of(at)) {
            Neighbour::Child(of, _) => {
                self.grow(node_of(of));
                if self.node(of).is_sharp(edge_of(of)) {
                    None
                } else {
                    Some(of)
                }
            }
            Neighbour::ChildAcross(of) => Some(of),
            Neighbour::None => return None,
        };
        if let Some(of) = missing {
            self.grow(node_of(of));
            let other = self.require(of)?;
            self.grow(node_of(other));
        }
        self.across(at)
    }
}

/// Where a node's neighbour comes from.
#[derive(Clone, Copy, Debug)]
enum Neighbour {
    /// The child of a half-edge; this edge of it.
    Child(Side, usize),
    /// The child of the half-edge across this one; its first edge.
    ChildAcross(Side),
    /// There is none.
    None,
}
