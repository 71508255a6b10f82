//! Parts of a regular piece that wait to be looked at together.

use core::array::from_fn;

use super::super::emit::Emission;
use super::super::emitted::Emitted;
use super::super::surface::QuarticPiece;
use super::Bulge;
use crate::certificate::{Bender, Bent, Cell, FOUR, QuarticJet, SubTriangle, normals};
use crate::patch::ParamTriangle;
use crate::vector::{unit_or_zero, vector};
use wide::f64x4;

/// Parts of third and fourth degree below this part of the range are not worth a closer look.
const SMOOTH: f64 = 0.05;

/// Parts of each kind that wait at most.
const MOST: usize = 32;

/// Parts of a piece that wait.
#[derive(Default)]
pub(super) struct Waiting {
    /// The piece, by its place in memory: it stays there while somebody walks over its control face.
    quartic: Option<*const QuarticPiece>,
    jet: Option<QuarticJet>,
    /// Whole leaves.
    even: Vec<Part<ParamTriangle>>,
    /// Parts of leaves with split edges.
    other: Vec<Part<Cell>>,
}

/// A part and the triangle over it: its number, and that of its corner where the part begins.
#[derive(Clone, Copy)]
struct Part<T> {
    at: T,
    number: u32,
    turn: u32,
}

impl Waiting {
    /// Whether others have to be looked at before another part of a piece can wait.
    pub(super) fn is_full(&self, quartic: &QuarticPiece) -> bool {
        let is_other = self
            .quartic
            .is_some_and(|known| !core::ptr::eq(known, quartic));
        is_other || self.even.len() == MOST || self.other.len() == MOST
    }

    /// Lets another part wait, where there is room.
    pub(super) fn push(
        &mut self,
        quartic: &QuarticPiece,
        emitted: &Emitted,
        turn: u32,
        cell: Cell,
        domain: ParamTriangle,
    ) {
        if self.quartic.is_none() {
            self.quartic = Some(core::ptr::from_ref(quartic));
            self.jet = Some(quartic.jet().clone());
        }
        let number = emitted.number;
        if emitted.part == SubTriangle::Whole {
            self.even.push(Part {
                at: domain,
                number,
                turn,
            });
        } else {
            self.other.push(Part {
                at: cell,
                number,
                turn,
            });
        }
    }

    /// Looks at all that wait.
    pub(super) fn look(&mut self, emission: &Emission, first: u32, found: &mut Bulge) {
        self.quartic = None;
        let Some(jet) = self.jet.take() else { return };
        let bender = Bender::of(&jet);
        let mut look = Look {
            jet: &jet,
            emission,
            first,
            found,
        };
        look.each(&self.even, |four| {
            let at = [from_fn(|l| four[l].u), from_fn(|l| four[l].v)].map(f64x4::new);
            bender.even(at, f64x4::new(from_fn(|l| four[l].size)))
        });
        look.each(&self.other, |four| {
            let place =
                |corner: usize, axis: usize| f64x4::new(from_fn(|l| four[l].0[corner][axis]));
            bender.any([0, 1, 2].map(|corner| [place(corner, 0), place(corner, 1)]))
        });
        self.even.clear();
        self.other.clear();
    }
}

/// Parts of a piece being looked at.
struct Look<'a> {
    jet: &'a QuarticJet,
    emission: &'a Emission,
    first: u32,
    found: &'a mut Bulge,
}

/// A part as a cell of its piece's domain.
trait AsCell: Copy {
    fn cell(self) -> Cell;
}

impl AsCell for ParamTriangle {
    fn cell(self) -> Cell {
        Cell(self.corners())
    }
}

impl AsCell for Cell {
    fn cell(self) -> Cell {
        self
    }
}

impl Look<'_> {
    /// Looks at some parts, four at a time.
    #[inline]
    fn each<T: AsCell>(&mut self, parts: &[Part<T>], bend: impl Fn([T; FOUR]) -> Bent) {
        for some in parts.chunks(FOUR) {
            let four: [&Part<T>; FOUR] = from_fn(|l| &some[l.min(some.len() - 1)]);
            let [mut a, mut b] = [[[0.0; FOUR]; 3]; 2];
            for (l, part) in four.iter().enumerate() {
                let [from, second, third] = self.corners(part.number);
                for axis in 0..3 {
                    a[axis][l] = (second[axis] - from[axis]) * self.found.scale;
                    b[axis][l] = (third[axis] - from[axis]) * self.found.scale;
                }
            }
            let bent = bend(four.map(|part| part.at));
            let (low, high, rest) = bent.heights(&normals(&a.map(f64x4::new), &b.map(f64x4::new)));
            let (low, high, rest) = (low.to_array(), high.to_array(), rest.to_array());
            let kept = bent.kept(self.found.scale);
            for (l, part) in some.iter().enumerate() {
                let number = (part.number - self.first) as usize;
                let is_smooth = rest[l] < SMOOTH * (high[l] - low[l]);
                self.found.ranges[number] = if is_smooth {
                    [low[l], high[l]]
                } else {
                    self.range(part)
                };
                self.found.parts[number / FOUR].take(number % FOUR, &kept, l, part.turn as usize);
            }
        }
    }

    fn corners(&self, number: u32) -> [[f64; 3]; 3] {
        self.emission.triangles[number as usize]
            .map(|vertex| self.emission.positions[vertex as usize])
    }

    /// The least and the greatest height over a triangle, by the quadratic part or in a few places.
    #[cold]
    fn range<T: AsCell>(&self, part: &Part<T>) -> [f64; 2] {
        let [a, b, c] = self.corners(part.number).map(vector);
        let heights = self
            .jet
            .heights(&part.at.cell(), unit_or_zero((b - a).cross(c - a)));
        let (low, high, rest) = heights.about();
        let (low, high) = if rest < SMOOTH * (high - low) {
            (low, high)
        } else {
            heights.sampled()
        };
        [low, high]
    }
}
