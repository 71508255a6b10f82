//! Results of triangles that are there again after others were divided: they are known by their leaves and by which part of these they
//! cover.

use super::super::measured::FoundLast;
use super::{Bulge, ENDS};
use crate::certificate::{FOUR, SubTriangle};
use crate::refine::adaptive::emitted::Emitted;

/// Numbers that parts of leaves and the corners at which triangles begin need.
const PARTS: u8 = 17;

/// Which triangle of a control face it is: its leaf, the part of that, and with which of the part's corners it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key {
    /// The leaf's path behind a leading 1.
    pub(super) leaf: u64,
    part: u8,
}

impl Key {
    pub(super) fn of(emitted: &Emitted) -> Self {
        let leaf = 1 << (2 * emitted.place.level) | emitted.place.path;
        let part = match emitted.part {
            SubTriangle::Whole => 0,
            SubTriangle::Child(child) => 1 + child as u8,
            SubTriangle::Half { edge, second } => 5 + 2 * edge as u8 + u8::from(second),
            SubTriangle::Quarter { edge, at_end } => 11 + 2 * edge as u8 + u8::from(at_end),
        };
        Self {
            leaf,
            part: part + PARTS * emitted.turn as u8,
        }
    }

    /// The number of the triangle's corner with which its part begins.
    pub(super) fn turn(self) -> usize {
        (self.part / PARTS) as usize
    }
}

/// The triangles of a control face before, as they are looked for one after the other.
pub(super) struct Known<'a> {
    before: Option<&'a Bulge>,
    /// Triangles with a greater bound than this failed.
    allowed: f64,
    /// Walks mostly go on where they were.
    next: usize,
    /// The numbers of all in the order of their keys, once one was not there.
    in_order: Vec<u32>,
}

impl<'a> Known<'a> {
    pub(super) fn of(before: Option<&'a Bulge>, allowed: f64) -> Self {
        Self {
            before,
            allowed,
            next: 0,
            in_order: Vec::new(),
        }
    }

    /// Takes over what is known of a triangle, whose number now is given; says whether anything is.
    pub(super) fn take_over(&mut self, key: Key, number: usize, found: &mut Bulge) -> bool {
        let Some((before, at)) = self
            .before
            .and_then(|before| Some((before, self.find(before, key)?)))
        else {
            return false;
        };
        self.next = at + 1;
        // A triangle that failed is there again where its face was divided anew.
        let known = before.found.get(at);
        if before.ranges[at] == ENDS || known.is_some_and(|known| known.value > self.allowed) {
            return false;
        }
        found.ranges[number] = before.ranges[at];
        if let Some(known) = known {
            found.found.resize(found.keys.len(), FoundLast::NOTHING);
            found.found[number] = *known;
        }
        found.parts[number / FOUR].take(number % FOUR, &before.parts[at / FOUR], at % FOUR, 0);
        true
    }

    fn find(&mut self, before: &Bulge, key: Key) -> Option<usize> {
        let keys = &before.keys;
        if keys.get(self.next) == Some(&key) {
            return Some(self.next);
        }
        if self.in_order.is_empty() {
            self.in_order.extend(0..keys.len() as u32);
            self.in_order.sort_unstable_by_key(|&at| keys[at as usize]);
        }
        let found = self
            .in_order
            .binary_search_by_key(&key, |&at| keys[at as usize]);
        found.ok().map(|at| self.in_order[at] as usize)
    }
}
