//! The control faces whose leaves that pass on conditions do so, and what these leaves come to. Most faces have no such leaves, and four
//! bytes each.

use super::super::quadtree::Place;

/// A face with conditions that nobody has looked at.
const OPEN: u32 = 0;

/// A face whose conditions hold and come to nothing; others have their place in the list after it.
const NOTHING: u32 = 1;

/// The control faces whose conditions are known to hold.
#[derive(Clone)]
pub(in super::super) struct SettledFaces {
    /// By control face.
    numbers: Vec<u32>,
    /// The greatest bound of a leaf of a face, and the leaf; [`OPEN`] and [`NOTHING`] come before it.
    worst: Vec<(f64, Place)>,
}

impl SettledFaces {
    /// No face has been looked at.
    pub(in super::super) fn none(faces: usize) -> Self {
        Self {
            numbers: limitmesh_pages::defaults(faces),
            worst: Vec::new(),
        }
    }

    /// How many control faces there are.
    pub(super) fn faces(&self) -> u32 {
        self.numbers.len() as u32
    }

    /// Whether there is nothing to look at in a face.
    pub(in super::super) fn has(&self, face: u32) -> bool {
        self.numbers[face as usize] != OPEN
    }

    /// The greatest bound of a leaf that passes on a condition, and the leaf.
    pub(in super::super) fn worst(&self, face: u32) -> Option<(f64, Place)> {
        match self.numbers[face as usize] {
            OPEN | NOTHING => None,
            number => Some(self.worst[(number - 1 - NOTHING) as usize]),
        }
    }

    /// The same, 0 if there is none.
    pub(in super::super) fn bound(&self, face: u32) -> f64 {
        self.worst(face).map_or(0.0, |(bound, _)| bound)
    }

    /// A face's conditions have to be looked at again.
    pub(in super::super) fn forget(&mut self, face: u32) {
        self.numbers[face as usize] = OPEN;
    }

    /// There is nothing left to look at in a face.
    pub(in super::super) fn settle(&mut self, face: u32) {
        let number = &mut self.numbers[face as usize];
        if *number == OPEN {
            *number = NOTHING;
        }
    }

    /// A leaf passes on a condition, or must not be divided, and comes to a bound.
    pub(super) fn add(&mut self, leaf: Place, bound: f64) {
        let face = leaf.face;
        match self.numbers[face as usize] {
            OPEN | NOTHING => {
                self.worst.push((bound, leaf));
                self.numbers[face as usize] = self.worst.len() as u32 + NOTHING;
            }
            number => {
                let known = &mut self.worst[(number - 1 - NOTHING) as usize];
                if bound > known.0 {
                    *known = (bound, leaf);
                }
            }
        }
    }
}
