//! Triangles over regular pieces, four at a time: most pass so, and the others are left to be looked at one by one.

use core::array::from_fn;

use super::super::bulges::scale;
use super::super::control::Control;
use super::super::emitted::{Emitted, Over, Sources, TriangleVisitor};
use super::super::measured::Value;
use super::super::quadtree::NodeAddress;
use super::super::surface::QuarticPiece;
use super::Measuring;
use crate::certificate::{Bender, BentFour, Cell, FOUR, MovedFour, QuarticJet};
use crate::index::VertexId;
use crate::parallel::IsStopped;
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

impl Measuring<'_> {
    /// Measures the triangles of a control face as far as that is done four at a time; says whether none is left.
    pub(super) fn by_fours(
        &mut self,
        sources: &Sources<'_>,
        face: u32,
        is_stopped: &IsStopped<'_>,
    ) -> bool {
        if !self.may_be_at_once(sources.control, face) {
            return false;
        }
        let mut fours = Fours {
            is_left: vec![false; sources.emission.triangles_of(face).len()],
            measuring: self,
            scale: scale(sources.control, face),
            quartic: None,
            jet: None,
            waiting: Vec::with_capacity(MOST),
        };
        sources.show(face, is_stopped, &mut fours);
        fours.look();
        let is_left = fours.is_left;
        let is_done = !is_left.contains(&true);
        self.is_left = Some(is_left);
        is_done
    }

    /// Whether nothing counts but distances, and vertices have one normal each.
    fn may_be_at_once(&self, control: &Control<'_>, face: u32) -> bool {
        let is_smooth = |vertex: u32| {
            let vertex = VertexId(vertex);
            !control.sharpness.is_tagged(vertex) && !control.mesh.topology().is_boundary(vertex)
        };
        let corners = control.mesh.triangles()[face as usize];
        self.criteria.is_none() && !self.rim_alone && corners.into_iter().all(is_smooth)
    }
}

/// The triangles of a control face on their way.
struct Fours<'m, 'a> {
    measuring: &'m mut Measuring<'a>,
    /// Makes the control face's edges about 1.
    scale: f64,
    /// The piece, by its place in memory: it stays there while somebody walks over its control face.
    quartic: Option<*const QuarticPiece>,
    jet: Option<QuarticJet>,
    waiting: Vec<Part>,
    is_left: Vec<bool>,
}

impl Fours<'_, '_> {
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
                let passes = bound <= measuring.limit && bound <= measuring.length;
                let fails = measuring.fails_for_sure(least);
                if !is_gathered[l] || !passes && !fails {
                    self.is_left[(part.number - measuring.first) as usize] = true;
                    continue;
                }
                if fails {
                    measuring.take(part.number, part.place, Value::failing(least), 0.0);
                } else {
                    measuring.take(part.number, part.place, Value::of(bound), found.height[l]);
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
