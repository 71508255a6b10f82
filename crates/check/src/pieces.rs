//! The limit surface over a control face: Loop's rules on the rings of three corners, and polynomials of degree 4 where
//! these are regular (docs/certificate.md, section 5).

use std::rc::Rc;

use crate::quartic::{self, Net};
use crate::vector::{Vector, add, middle, scale, sub};

/// From here on sharpness never fades.
const LASTING: f64 = 10.0;

/// The weights of smooth vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Scheme {
    Loop,
    LoopWarren,
}

impl Scheme {
    /// As proofs and command lines call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Loop => "loop",
            Self::LoopWarren => "loop-warren",
        }
    }

    /// kβ, the weight of all neighbours together.
    fn of_ring(self, valence: usize) -> f64 {
        match self {
            Self::Loop => {
                0.625 - (0.375 + 0.25 * (std::f64::consts::TAU / valence as f64).cos()).powi(2)
            }
            Self::LoopWarren if valence == 3 => 0.5625,
            Self::LoopWarren => 0.375,
        }
    }
}

/// A vertex with its neighbours, counter-clockwise.
pub struct Ring {
    pub at: Vector,
    pub around: Vec<Vector>,
    /// How sharp the edges to the neighbours are; those of a border for ever.
    pub sharp: Vec<f64>,
    /// How sharp the vertex itself is.
    pub own: f64,
    /// Whether it ends at two edges of a border.
    pub is_open: bool,
}

/// What is left of a sharpness after one step.
fn faded(sharpness: f64) -> f64 {
    if sharpness >= LASTING {
        sharpness
    } else {
        (sharpness - 1.0).max(0.0)
    }
}

/// The point between two with the weight `share` of the first.
fn between(a: Vector, b: Vector, share: f64) -> Vector {
    add(scale(a, share), scale(b, 1.0 - share))
}

impl Ring {
    /// The weighted mean of the vertex and of what its rule looks at: all neighbours with the first weight where it is smooth, the ends of a crease
    /// with the second; nothing at a corner. `left` is what is left of each sharpness.
    fn by_rule(&self, left: impl Fn(f64) -> f64, [smooth, crease]: [f64; 2]) -> Vector {
        let ends: Vec<usize> = (0..self.sharp.len())
            .filter(|&i| left(self.sharp[i]) > 0.0)
            .collect();
        match ends[..] {
            [] | [_] if left(self.own) == 0.0 => {
                let sum = self.around.iter().fold([0.0; 3], |sum, &p| add(sum, p));
                between(scale(sum, 1.0 / self.around.len() as f64), self.at, smooth)
            }
            [a, b] if left(self.own) == 0.0 => {
                between(middle(self.around[a], self.around[b]), self.at, crease)
            }
            _ => self.at,
        }
    }

    /// Where the vertex moves in one step.
    fn moved(&self, scheme: Scheme) -> Vector {
        let weights = [scheme.of_ring(self.around.len()), 0.25];
        let now = self.by_rule(|s| s, weights);
        let fading = self
            .sharp
            .iter()
            .chain([&self.own])
            .filter(|&&s| s > 0.0 && s <= 1.0);
        match fading.clone().count() {
            0 => now,
            count => between(
                now,
                self.by_rule(faded, weights),
                fading.sum::<f64>() / count as f64,
            ),
        }
    }

    /// The new vertex on the edge to a neighbour.
    fn on_edge(&self, i: usize) -> Vector {
        let (k, sharp) = (self.around.len(), middle(self.at, self.around[i]));
        if self.sharp[i] >= 1.0 {
            return sharp;
        }
        let beside = middle(self.around[(i + 1) % k], self.around[(i + k - 1) % k]);
        between(sharp, between(sharp, beside, 0.75), self.sharp[i])
    }

    fn refined(&self, scheme: Scheme) -> Self {
        Self {
            at: self.moved(scheme),
            around: (0..self.around.len()).map(|i| self.on_edge(i)).collect(),
            sharp: self.sharp.iter().map(|&s| faded(s)).collect(),
            own: faded(self.own),
            is_open: self.is_open,
        }
    }
}

/// A corner of a piece: the neighbour in the slot is the piece's next corner, the one after it the corner after that.
pub struct Corner {
    pub ring: Rc<Ring>,
    pub slot: usize,
}

impl Corner {
    /// The slot of a neighbour counted from the next corner.
    fn slot(&self, offset: usize) -> usize {
        (self.slot + offset) % self.ring.around.len()
    }

    /// The six neighbours of a regular corner from the next corner on, mirrored beyond a crease.
    fn six(&self) -> Option<[Vector; 6]> {
        let Ring {
            at,
            around,
            sharp,
            own,
            is_open,
        } = &*self.ring;
        let k = around.len();
        let ends: Vec<usize> = (0..k).filter(|&i| sharp[i] > 0.0).collect();
        match ends[..] {
            [] if *own == 0.0 && k == 6 && !is_open => {
                Some([0, 1, 2, 3, 4, 5].map(|i| around[self.slot(i)]))
            }
            [a, b] if *own == 0.0 && sharp[a].min(sharp[b]) >= LASTING => {
                // The side that the piece is on: from a to b, or, in a closed ring, from b on to a.
                let (first, last) = if a <= self.slot && self.slot < b {
                    (a, b)
                } else {
                    (b, a + k)
                };
                let s = [0, 1, 2, 3].map(|i| around[(first + i) % k]);
                let six = [
                    s[0],
                    s[1],
                    s[2],
                    s[3],
                    sub(add(s[3], *at), s[2]),
                    sub(add(s[0], *at), s[1]),
                ];
                let turn = (self.slot + k - first) % k;
                (last == first + 3).then(|| [0, 1, 2, 3, 4, 5].map(|i| six[(i + turn) % 6]))
            }
            _ => None,
        }
    }
}

/// A part of the surface.
pub enum Piece {
    Net(Box<Net>),
    /// With its quarters, once somebody asked for them.
    Corners([Corner; 3], Option<Box<[Piece; 4]>>),
}

impl Piece {
    /// The piece over a face with such corners.
    pub fn new(corners: [Corner; 3]) -> Self {
        let [a, b, c] = &corners;
        match (a.six(), b.six(), c.six()) {
            (Some(of_a), Some(of_b), Some(of_c)) => Self::Net(Box::new(quartic::regular(
                [a, b, c].map(|v| v.ring.at),
                &[of_a, of_b, of_c],
            ))),
            _ => Self::Corners(corners, None),
        }
    }
}

/// The quarters of a piece: at its corners, with these as their corners 0, 1 and 2, and between the middles of the sides, where corner i is
/// across from the piece's corner i.
pub fn quarters(corners: &[Corner; 3], scheme: Scheme) -> [Piece; 4] {
    let new = corners
        .each_ref()
        .map(|corner| Rc::new(corner.ring.refined(scheme)));
    // The new vertex on the edge from corner a to the next, b, with its ring from b on; c is the third corner.
    let middles = [0, 1, 2].map(|a| {
        let (from, to, new_b) = (&corners[a], &corners[(a + 1) % 3], &new[(a + 1) % 3]);
        let of_a = |offset| new[a].around[from.slot(offset)];
        let mut around = vec![new_b.at, new_b.around[to.slot], of_a(1), new[a].at];
        let is_open = from.ring.is_open && from.slot == 0;
        if !is_open {
            around.extend([of_a(from.ring.around.len() - 1), new_b.around[to.slot(2)]]);
        }
        let own = new[a].sharp[from.slot];
        let sharp = [own, 0.0, 0.0, own, 0.0, 0.0][..around.len()].to_vec();
        Rc::new(Ring {
            at: of_a(0),
            around,
            sharp,
            own: 0.0,
            is_open,
        })
    });
    let old = |i: usize| Corner {
        ring: Rc::clone(&new[i]),
        slot: corners[i].slot,
    };
    let edge = |i: usize, slot| Corner {
        ring: Rc::clone(&middles[i]),
        slot,
    };
    [
        Piece::new([old(0), edge(0, 2), edge(2, 0)]),
        Piece::new([edge(0, 0), old(1), edge(1, 2)]),
        Piece::new([edge(2, 2), edge(1, 0), old(2)]),
        Piece::new([edge(1, 1), edge(2, 1), edge(0, 1)]),
    ]
}
