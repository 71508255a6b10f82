//! The infinitely sharp twin of a semi-sharp piece: equal points, but all sharp edges stay sharp. It is of a simpler form, and near.
//!
//! Takes the rings of the corners at which something is semi-sharp; says how far the surfaces are apart at most, over the same
//! parameter.
//!
//! Let f be the least semi-sharp sharpness, n = ⌊f⌋. Until level n both pieces have the same points. From then on a new point of
//! the piece lies between those of the twin's rules and of the rules that are left when some or all edges are smooth; on the first step no
//! farther from the twin's than 1 − f + n of the way, the weight of the sharp rules being at least f − n. Averages never add to
//! a difference, so the surfaces are no farther apart than the sum, over all levels from n on, of the greatest distance between the
//! new points by either rules from the twin's points of that level. That is, for κ = v + w − a − b, v w being a sharp edge and a, b the
//! points opposite,
//!
//! * on an edge (1 − 3/4) κ/2 = κ/8;
//! * at v in the middle of an edge, with six neighbours, two of them along the edge, (κ + κ′)/16, of both halves;
//! * at an old vertex what its ring says.
//!
//! **Edges.** The twin's rules take κ at v to (3κ + κ′)/8, where v is the middle of an edge, and κ′ belongs to the other half: v w becomes
//! (6v + w + l)/8, (4v + 4w)/8 with (3v + 3a + w + c)/8 and (3v + 3b + w + d)/8 opposite. So the greatest κ of a level is half that
//! of the level before or one at an old vertex.
//!
//! **Old vertices** ([`Ring`]). What the rules make of a ring follows from the ring alone, so it is refined some levels. Let D be the greatest distance
//! of a neighbour from v, and E = |l + r − 2v| for the ends l, r of a crease, 0 for a corner. D becomes 5/8 D + 1/8 E at most
//! (a neighbour w between a and b becomes (3v + 3w + a + b)/8), E becomes E/4, so N = D + E/3 becomes 5/8 N. All differences above are at most 5/8 N,
//! which bounds the rest of the sum by 5/3 N and what is left of κ.

use super::SemiSharpVertex;
use crate::patch::Rules;
use crate::ring::VertexRule;
use crate::vector::DVec3;

/// Levels below that of the first difference that are looked at one by one.
const LEVELS: usize = 6;

/// Levels of which something is known.
const MOST: usize = crate::ring::INFINITELY_SHARP as usize + LEVELS;

/// Sharp edges at a vertex up to which all pairs of them are looked at, as curves that may be left when others are smooth.
const FEW: usize = 8;

/// The differences, level by level.
pub(super) struct Gaps {
    /// The level of the first difference.
    first: usize,
    /// How much of it there is.
    share: f64,
    /// The greatest kink at old vertices.
    kinks: [f64; MOST],
    /// The greatest distance between the new points for old vertices.
    moves: [f64; MOST],
    /// The bound of all that is below.
    rest: f64,
}

impl Gaps {
    /// None yet, between a piece with this least semi-sharp sharpness and its twin.
    pub(crate) fn new(least: f64) -> Self {
        let first = (least as usize).min(MOST - LEVELS);
        let share = 1.0 - (least - first as f64);
        Self {
            first,
            share,
            kinks: [0.0; MOST],
            moves: [0.0; MOST],
            rest: 0.0,
        }
    }

    /// Adds the ring of a corner where something is semi-sharp; `None` if nothing is known of such.
    pub(super) fn add(&mut self, corner: &SemiSharpVertex, rules: &Rules<'_>) -> Option<()> {
        if let Some(whole) = &corner.whole {
            return whole.gaps().map(|gaps| self.add_known(gaps));
        }
        let mut ring = Ring::of(corner, rules)?;
        let last = self.first + LEVELS;
        for level in 0..last {
            self.kinks[level] = self.kinks[level].max(ring.kink());
            if level >= self.first {
                self.moves[level] = self.moves[level].max(ring.moves());
            }
            ring.refine();
        }
        self.rest = self.rest.max(5.0 / 3.0 * ring.size());
        Some(())
    }

    /// Meets a ring whose gaps are known.
    fn add_known(&mut self, gaps: &RingGaps) {
        let last = self.first + LEVELS;
        for level in 0..last {
            self.kinks[level] = self.kinks[level].max(gaps.kinks[level]);
            if level >= self.first {
                self.moves[level] = self.moves[level].max(gaps.moves[level]);
            }
        }
        self.rest = self.rest.max(5.0 / 3.0 * gaps.sizes[last]);
    }

    /// Meets a kink at the middle of an edge.
    pub(super) fn add_kink(&mut self, kink: f64) {
        self.kinks[0] = self.kinks[0].max(kink);
    }

    /// How far the surfaces are apart at most.
    pub(super) fn apart(&self) -> f64 {
        let (mut kink, mut sum) = (0.0f64, 0.0);
        for level in 0..self.first + LEVELS {
            kink = self.kinks[level].max(0.5 * kink);
            let gap = self.moves[level].max(0.125 * kink);
            sum += match level {
                _ if level < self.first => 0.0,
                _ if level == self.first => self.share * gap,
                _ => gap,
            };
        }
        sum + self.rest + 0.125 * kink
    }
}

/// The values that [`Gaps`] take from the ring of one vertex, whichever sharpness is least at the others.
#[derive(Debug)]
pub(super) struct RingGaps {
    kinks: [f64; MOST],
    moves: [f64; MOST],
    sizes: [f64; MOST + 1],
}

impl RingGaps {
    /// Those of a vertex at which something is semi-sharp; `None` if nothing is known of such.
    pub(crate) fn of(vertex: &SemiSharpVertex, rules: &Rules<'_>) -> Option<Self> {
        let mut ring = Ring::of(vertex, rules)?;
        let mut gaps = Self {
            kinks: [0.0; MOST],
            moves: [0.0; MOST],
            sizes: [0.0; MOST + 1],
        };
        for level in 0..MOST {
            (gaps.kinks[level], gaps.moves[level], gaps.sizes[level]) =
                (ring.kink(), ring.moves(), ring.size());
            ring.refine();
        }
        gaps.sizes[MOST] = ring.size();
        Some(gaps)
    }
}

/// The neighbours of an old vertex as it is refined by the twin's rules, seen from it.
struct Ring {
    neighbours: Vec<DVec3>,
    before: Vec<DVec3>,
    /// Which edges are sharp.
    sharp: Vec<usize>,
    is_open: bool,
    is_corner: bool,
    /// The weight of each neighbour where the vertex is smooth.
    beta: f64,
}

impl Ring {
    fn of(corner: &SemiSharpVertex, rules: &Rules<'_>) -> Option<Self> {
        let is_corner = match corner.sharp.rule() {
            VertexRule::Corner => true,
            VertexRule::Crease => false,
            VertexRule::Smooth | VertexRule::Dart => return None,
        };
        let neighbours: Vec<DVec3> = corner
            .neighbours
            .iter()
            .map(|&point| point - corner.at)
            .collect();
        let count = neighbours.len();
        Some(Self {
            before: neighbours.clone(),
            neighbours,
            sharp: (0..count)
                .filter(|&slot| corner.sharp.is_sharp(slot))
                .collect(),
            is_open: corner.sharp.open,
            is_corner,
            beta: rules.beta(count),
        })
    }

    /// The neighbours on either side of one; at an open ring's ends there is but one.
    fn beside(&self, slot: usize) -> [usize; 2] {
        let count = self.neighbours.len();
        [
            if slot == 0 { count - 1 } else { slot - 1 },
            if slot + 1 == count { 0 } else { slot + 1 },
        ]
    }

    /// The greatest kink at a sharp edge inside the surface.
    fn kink(&self) -> f64 {
        let count = self.neighbours.len();
        let inner = self
            .sharp
            .iter()
            .filter(|&&slot| !self.is_open || (slot > 0 && slot + 1 < count));
        let kink = |&slot: &usize| {
            let [a, b] = self.beside(slot);
            (self.neighbours[slot] - self.neighbours[a] - self.neighbours[b]).length_squared()
        };
        inner.map(kink).fold(0.0, f64::max).sqrt()
    }

    /// Where the vertex goes as the curve between two neighbours has it.
    fn along(&self, a: usize, b: usize) -> DVec3 {
        0.125 * (self.neighbours[a] + self.neighbours[b])
    }

    /// Where the vertex goes.
    fn moved(&self) -> DVec3 {
        match self.sharp[..] {
            [a, b] if !self.is_corner => self.along(a, b),
            _ => DVec3::ZERO,
        }
    }

    /// The greatest distance between where the vertex goes and where it may go when edges are smooth.
    fn moves(&self) -> f64 {
        let own = self.moved();
        let mut greatest = if self.is_open {
            own.length_squared()
        } else {
            (self.beta * self.neighbours.iter().sum::<DVec3>()).distance_squared(own)
        };
        if self.sharp.len() > FEW {
            // A point along two of them lies in the middle between those along either one twice.
            let twice = self
                .sharp
                .iter()
                .map(|&a| self.along(a, a).distance_squared(own));
            return twice.fold(greatest, f64::max).sqrt();
        }
        for (i, &a) in self.sharp.iter().enumerate() {
            for &b in &self.sharp[..i] {
                greatest = greatest.max(self.along(a, b).distance_squared(own));
            }
        }
        greatest.sqrt()
    }

    fn refine(&mut self) {
        let moved = self.moved();
        core::mem::swap(&mut self.neighbours, &mut self.before);
        let mut sharp = self.sharp.iter().copied().peekable();
        for slot in 0..self.before.len() {
            let end = self.before[slot];
            let to = if sharp.next_if_eq(&slot).is_some() {
                0.5 * end
            } else {
                let [a, b] = self.beside(slot);
                0.375 * end + 0.125 * (self.before[a] + self.before[b])
            };
            self.neighbours[slot] = to - moved;
        }
    }

    /// The size N of the ring.
    fn size(&self) -> f64 {
        let greatest = self
            .neighbours
            .iter()
            .map(|point| point.length_squared())
            .fold(0.0, f64::max)
            .sqrt();
        greatest + 8.0 / 3.0 * self.moved().length()
    }
}
