//! Sharp edges of all levels: boundaries, creases, and edges along which sheets were cut apart.
//!
//! The forest is cut open along sharp edges, so that each side has vertices of its own. One edge is
//! one *rim* with several sides, which are cut together in three; sides of a crease become one
//! again in the result.

use super::{Forest, Side, edge_of, node_of, side};
use crate::geometry::NONE;

/// A sharp edge of an even level.
#[derive(Clone, Debug)]
pub(super) struct Rim {
    /// The sharp edge of the control mesh that it is a part of.
    pub(super) group: u32,
    /// The rim that it is a part of, and which: 0, 1 or 2 in the group's direction.
    pub(super) parent: Option<(u32, u8)>,
    /// Its own parts, in the group's direction; [`NONE`] if there are none.
    pub(super) parts: [u32; 3],
    /// For each side its ends, in the group's direction; [`NONE`] if they are not there.
    pub(super) ends: Vec<[u32; 2]>,
    /// Whether it is cut in the result.
    pub(super) is_cut: bool,
}

/// A sharp edge of the control mesh.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// The half-edges on its sides, and whether they run against the first.
    pub(super) sides: Vec<(Side, bool)>,
    /// Whether its sides are one in the result, as those of a crease are.
    pub(super) is_crease: bool,
}

/// All sharp edges.
#[derive(Clone, Debug, Default)]
pub(super) struct Rims {
    pub(super) groups: Vec<Group>,
    pub(super) rims: Vec<Rim>,
}

impl Rims {
    /// Adds a sharp edge of the control mesh with the ends of its sides.
    pub(super) fn add(&mut self, group: Group, ends: Vec<[u32; 2]>) -> u32 {
        let number = self.groups.len() as u32;
        self.groups.push(group);
        self.rims.push(Rim {
            group: number,
            parent: None,
            parts: [NONE; 3],
            ends,
            is_cut: false,
        });
        self.rims.len() as u32 - 1
    }

    /// The parts of a rim, made if there are none.
    fn parts(&mut self, rim: u32) -> [u32; 3] {
        let own = &self.rims[rim as usize];
        if own.parts[0] == NONE {
            let (group, sides, first) = (own.group, own.ends.len(), self.rims.len() as u32);
            for part in 0..3 {
                let (parts, ends) = ([NONE; 3], vec![[NONE; 2]; sides]);
                self.rims.push(Rim {
                    group,
                    parent: Some((rim, part)),
                    parts,
                    ends,
                    is_cut: false,
                });
            }
            self.rims[rim as usize].parts = [first, first + 1, first + 2];
        }
        self.rims[rim as usize].parts
    }

    /// The rims that are edges of the result.
    pub(super) fn result(&self) -> impl Iterator<Item = &Rim> {
        let is_there = |rim: &Rim| {
            rim.parent
                .is_none_or(|(parent, _)| self.rims[parent as usize].is_cut)
        };
        self.rims
            .iter()
            .filter(move |rim| !rim.is_cut && is_there(rim))
    }

    /// The rims that are cut in the result.
    pub(super) fn cut(&self) -> impl Iterator<Item = &Rim> {
        self.rims.iter().filter(|rim| rim.is_cut)
    }

    pub(super) fn is_turned(&self, rim: u32, number: u32) -> bool {
        self.groups[self.rims[rim as usize].group as usize].sides[number as usize].1
    }
}

impl Forest<'_> {
    /// The points on a sharp edge of an odd level, on the side of a half-edge: near its origin, and near its target.
    pub(super) fn cut(&mut self, at: Side) -> [u32; 2] {
        let ends = self.ends(at);
        let points = self.make_points(at, ends);
        let Some(&(rim, number)) = self.rim_of.get(&at) else {
            return points;
        };
        let parts = self.rims.parts(rim);
        let turned = self.rims.is_turned(rim, number);
        let along = |[a, b]: [u32; 2]| if turned { [b, a] } else { [a, b] };
        let ([a, b], [l, r]) = (along(ends), along(points));
        let number = number as usize;
        for (part, ends) in parts.into_iter().zip([[a, l], [l, r], [r, b]]) {
            self.rims.rims[part as usize].ends[number] = ends;
        }
        // Both sides of a crease are one in the result.
        if !self.rims.groups[self.rims.rims[rim as usize].group as usize].is_crease {
            return points;
        }
        let middle = &self.rims.rims[parts[1] as usize].ends;
        if let Some(&first) = middle
            .iter()
            .find(|ends| ends[0] != NONE && **ends != [l, r])
        {
            for (own, first) in [l, r].into_iter().zip(first) {
                self.vertices[own as usize].first = self.vertices[first as usize].first;
            }
        }
        points
    }

    /// Notes which part of a sharp edge that was cut a half-edge lies on: `part` in the direction of the edge `cut`.
    pub(super) fn note_part(&mut self, cut: Side, part: usize, own: Side) {
        let Some(&(rim, number)) = self.rim_of.get(&cut) else {
            return;
        };
        let part = if self.rims.is_turned(rim, number) {
            2 - part
        } else {
            part
        };
        self.rim_of
            .insert(own, (self.rims.parts(rim)[part], number));
    }

    /// The half-edge of an even level on a side of a rim, grown for if it isn't there.
    pub(super) fn owner(&mut self, rim: u32, number: u32) -> Option<Side> {
        let Some((parent, part)) = self.rims.rims[rim as usize].parent else {
            let group = self.rims.rims[rim as usize].group;
            return Some(self.rims.groups[group as usize].sides[number as usize].0);
        };
        let cut = self.odd_owner(parent, number)?;
        let (t, edge) = (node_of(cut), edge_of(cut));
        self.grow(t);
        let part = if self.rims.is_turned(rim, number) {
            2 - part
        } else {
            part
        };
        match part {
            0 => {
                let other = self.require(side(t, edge + 2))?;
                self.grow(node_of(other));
                self.child(other).map(|child| side(child, 0))
            }
            1 => self.child(cut).map(|child| side(child, 0)),
            _ => {
                let other = self.require(side(t, edge + 1))?;
                self.grow(node_of(other));
                self.child(side(t, edge + 1)).map(|child| side(child, 2))
            }
        }
    }

    /// The half-edge of the odd level after it, whose node is cut there.
    pub(super) fn odd_owner(&mut self, rim: u32, number: u32) -> Option<Side> {
        let even = self.owner(rim, number)?;
        self.grow(node_of(even));
        self.child(even).map(|child| side(child, 0))
    }
}
