//! Triangles over regular pieces, four at a time: most pass so, and the others are left to be looked at one by one.

use core::array::from_fn;

use super::super::emitted::{Emitted, Over, TriangleVisitor};
use super::super::measured::Value;
use super::super::quadtree::NodeAddress;
use super::super::surface::QuarticPiece;
use super::Measuring;
use crate::certificate::{Bender, BentFour, Cell, FOUR, MovedFour, QuarticJet};
use crate::patch::Rules;
use wide::f64x4;

/// Parts of a piece that wait at most.
const MOST: usize = 32;

/// A part and the triangle over it.
#[derive(Clone, Copy)]
struct Part {
    cell: Cell,
    number: u32,
    /// Which of the triangle's corners is the part's first.
    turn: usize,
    place: NodeAddress,
}

/// Measures the triangles of a control face as far as that is done four at a time.
pub(super) struct Fours<'m, 'a> {
    measuring: &'m mut Measuring<'a>,
    scale: f64,
    /// The piece, by its place in memory: it stays there while somebody walks over its control face.
    quartic: Option<*const QuarticPiece>,
    jet: Option<QuarticJet>,
    waiting: Vec<Part>,
    is_left: Vec<bool>,
}

impl<'m, 'a> Fours<'m, 'a> {
    /// For a control face's triangles; `scale` makes its edges about 1.
    pub(super) fn of(measuring: &'m mut Measuring<'a>, triangles: usize, scale: f64) -> Self {
        Self {
            measuring,
            scale,
            quartic: None,
            jet: None,
            waiting: Vec::with_capacity(MOST),
            is_left: vec![false; triangles],
        }
    }

    /// Leaves the others; says whether there are any.
    pub(super) fn end(mut self) -> bool {
        self.look();
        let has_left = self.is_left.contains(&true);
        self.measuring.is_left = Some(self.is_left);
        has_left
    }

    /// Looks at all that wait.
    fn look(&mut self) {
        self.quartic = None;
        let Some(jet) = self.jet.take() else { return };
        let bender = Bender::of(&jet);
        let waiting = core::mem::take(&mut self.waiting);
        let mut four = MovedFour::default();
        for some in waiting.chunks(FOUR) {
            let part = |l: usize| &some[l.min(some.len() - 1)];
            let place =
                |corner: usize, axis: usize| f64x4::new(from_fn(|l| part(l).cell.0[corner][axis]));
            let bent = bender.any([0, 1, 2].map(|corner| [place(corner, 0), place(corner, 1)]));
            let (kept, mut parts) = (bent.kept(self.scale), BentFour::UNKNOWN);
            let (mut normals, mut is_gathered) = ([[[0.0; FOUR]; 3]; 3], [false; FOUR]);
            for (l, part) in (0..FOUR).map(|l| (l, part(l))) {
                let (number, emission) = (part.number as usize, self.measuring.emission);
                parts.take(l, &kept, l, part.turn);
                is_gathered[l] = self.measuring.gather(number, l, &mut four);
                for (corner, vertex) in emission.triangles[number].into_iter().enumerate() {
                    let normal = emission.normals[vertex as usize];
                    (0..3).for_each(|axis| normals[corner][axis][l] = normal[axis]);
                }
            }
            let found = four.bounds(&parts, self.scale);
            let seen = four.seen(&normals, self.scale);
            for (l, part) in some.iter().enumerate() {
                let (bound, least) = (found.bound[l], found.least[l]);
                let measuring = &mut *self.measuring;
                if !is_gathered[l] {
                    self.is_left[(part.number - measuring.first) as usize] = true;
                    continue;
                }
                if measuring.fails_for_sure(least) {
                    measuring.take(part.number, part.place, Value::failing(least), 0.0);
                } else if bound <= measuring.limit && bound <= measuring.length {
                    measuring.take(part.number, part.place, Value::of(bound), found.height[l]);
                } else {
                    self.is_left[(part.number - measuring.first) as usize] = true;
                    continue;
                }
                measuring.see(seen.normal_deviation[l], seen.slope[l]);
            }
        }
        self.waiting = waiting;
        self.waiting.clear();
    }
}

impl TriangleVisitor for Fours<'_, '_> {
    fn skips_proven(&self) -> bool {
        self.measuring.skips_proven()
    }

    fn wants_triangle(&mut self, emitted: &Emitted) -> bool {
        self.measuring.wants_triangle(emitted)
    }

    fn triangle<'p>(&mut self, emitted: &Emitted, over: Over<'_, 'p>, rules: &'p Rules<'p>) {
        let Over::Regular(quartic, cell, _) = over else {
            return self.measuring.triangle(emitted, over, rules);
        };
        let is_other = self
            .quartic
            .is_some_and(|known| !core::ptr::eq(known, quartic));
        if is_other || self.waiting.len() == MOST {
            self.look();
        }
        if self.quartic.is_none() {
            self.quartic = Some(core::ptr::from_ref(quartic));
            self.jet = Some(quartic.jet().clone());
        }
        let Emitted {
            number,
            turn,
            place,
            ..
        } = *emitted;
        self.waiting.push(Part {
            cell,
            number,
            turn,
            place,
        });
    }
}
