//! Pieces at irregular vertices without refinement: by an affine image of the characteristic map,
//! by the hull of their control points, or by their twins at semi-sharp tags (see
//! [`super::super::bounds`]).

use super::super::hull_points::HullPoint;
use super::super::{exceeds, greater};
use super::{Borders, Deviation, Effort, INSIDE, Search, SubTriangle};
use crate::patch::Patch;
use crate::patch::characteristic::{Characteristic, MapSector};
use crate::patch::extraordinary::ExtraordinaryPatch;
use crate::vector::DVec3;
use smallvec::SmallVec;

/// Levels that a piece at an irregular vertex is split at most: it has shrunk by 2⁻⁴⁰ then, below rounding.
const DEEPEST: usize = 40;

/// Where the infinitely sharp twin of a piece is farther away than the target by this many times
/// the distance between the two, the piece is taken to be too far as well.
const CERTAIN: f64 = 3.0;

/// Down to this level pieces must be good enough together with others.
const TOGETHER: usize = 3;

/// Lengths and squares this many times too great are too great, whatever the rounding.
const CLEARLY: f64 = 1.0 + 1e-9;

impl<P: HullPoint> Search<'_, P> {
    /// Replaces a semi-sharp piece by its infinitely sharp twin if that decides; returns whether it
    /// did.
    fn by_twin(
        &mut self,
        patch: &Patch,
        part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) -> bool {
        let Patch::SemiSharp(piece) = patch else {
            return false;
        };
        let aim = self.aim();
        let Some((near, rest)) = piece
            .infinitely_sharp_twin(self.rules)
            .filter(|&(_, rest)| rest <= aim)
        else {
            return false;
        };
        // At corners of the triangle the twin is off by up to the rest: no division gets below that.
        let target = (aim - 2.0 * rest).max(1.5 * rest);
        let effort = Effort {
            target,
            least_chord: None,
            ..self.effort
        };
        let mut twin = Search {
            effort,
            found: Deviation::default(),
            ..*self
        };
        twin.part(&near, part, borders, depth);
        let found = twin.found.off(rest, rest).grown(rest);
        let fails = exceeds(self.value(&twin.found) - CERTAIN * rest, aim);
        if fails || self.value(&found) <= aim {
            self.add(found);
            return true;
        }
        false
    }

    /// Bounds a piece at an irregular vertex, other than those of [`Self::extraordinary`], without
    /// refinement if that is enough or if refinement cannot help; returns whether it did.
    pub(in super::super) fn is_settled(
        &mut self,
        patch: &Patch,
        part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) -> bool {
        if self.found.own == f64::INFINITY || self.by_twin(patch, part, borders, depth) {
            return true;
        }
        let frame = self.bound.frame;
        let each_point = |visit: &mut dyn FnMut(P) -> bool| {
            let mut goes_on = true;
            patch.for_each_hull_point(|point| goes_on = goes_on && visit(P::of(frame, point)));
        };
        let held = self.hull(each_point, borders, depth);
        self.is_enough(held, depth)
    }

    /// A piece at an irregular vertex inside the surface, with a complete ring: without refinement
    /// if that is enough, else refined.
    pub(super) fn extraordinary(
        &mut self,
        piece: &ExtraordinaryPatch<P>,
        part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) {
        if !self.is_settled_at(piece, part, borders, depth) {
            self.divided(
                &piece.refined(self.rules.beta(piece.ring.len())),
                part,
                borders,
                depth,
            );
        }
    }

    /// Bounds such a piece without refinement if that is enough or if refinement cannot help;
    /// returns whether it did.
    fn is_settled_at(
        &mut self,
        piece: &ExtraordinaryPatch<P>,
        part: SubTriangle,
        borders: Borders,
        depth: usize,
    ) -> bool {
        if self.found.own == f64::INFINITY {
            return true;
        }
        let held = match self
            .rules
            .characteristic(piece.ring.len())
            .filter(|_| depth < DEEPEST)
        {
            Some(map) => {
                let sector = match part {
                    SubTriangle::Whole => Some(&map.sectors[0]),
                    SubTriangle::Half { edge, second } if edge == (piece.corner + 1) % 3 => {
                        Some(&map.sectors[1 + usize::from(second)])
                    }
                    _ => None,
                };
                sector.and_then(|sector| self.affine(piece, map, sector, borders))
            }
            None => self.hull(|visit| _ = piece.points().all(visit), borders, depth),
        };
        self.is_enough(held, depth)
    }

    /// Takes the bound of a piece as it is, if that is enough; returns whether it did.
    fn is_enough(&mut self, held: Option<Deviation>, depth: usize) -> bool {
        let held = held.filter(|held| depth >= DEEPEST || self.is_good(held, depth));
        held.inspect(|&held| self.add(held)).is_some()
    }

    /// Whether the bound of a piece is enough: at first also together with bounds found elsewhere,
    /// as heights here and tangential displacements there may be too much though neither is.
    fn is_good(&self, held: &Deviation, depth: usize) -> bool {
        let target = self.effort.target;
        let is_enough = self.value(held) <= self.aim();
        let is_alone = depth >= TOGETHER || exceeds(self.value(&self.found), target);
        is_enough && (is_alone || self.value(&self.with(*held)) <= target)
    }

    /// The bound by an affine image of the characteristic map's sector, if the piece differs little
    /// from it.
    fn affine(
        &self,
        piece: &ExtraordinaryPatch<P>,
        map: &Characteristic,
        sector: &MapSector,
        borders: Borders,
    ) -> Option<Deviation> {
        let valence = piece.ring.len();
        let sums = piece.ring.iter().zip(&map.control.ring).fold(
            [P::default(); 3],
            |sums, (&point, at)| {
                [
                    sums[0] + point,
                    sums[1] + point * at.x,
                    sums[2] + point * at.y,
                ]
            },
        );
        let weight = 0.375 / self.rules.beta(valence);
        let limit = (piece.at * weight + sums[0]) / (weight + valence as f64);
        let tangents = [1, 2].map(|i| sums[i] * (2.0 / valence as f64));
        let image = |at: DVec3| limit + tangents[0] * at.x + tangents[1] * at.y;
        let aim = self.aim();
        // The greatest square of the points' differences, as long as that helps.
        let farthest = |points: &mut dyn Iterator<Item = (&P, &DVec3)>, most: f64| {
            let (mut farthest, most) = (0.0, CLEARLY * most * most);
            for (&point, &at) in points {
                farthest = greater(
                    farthest,
                    (point - image(at)).length_squared(self.bound.frame),
                );
                if exceeds(farthest, most) {
                    return None;
                }
            }
            Some(CLEARLY * farthest.sqrt())
        };
        // Those beyond the ring first: they are farthest away, and most pieces are refined because of them.
        let share = map.outer_share;
        let outer = farthest(&mut piece.outer.iter().zip(&map.control.outer), aim / share)?;
        let near = piece
            .ring
            .iter()
            .zip(&map.control.ring)
            .chain([(&piece.at, &map.control.at)]);
        let near = farthest(&mut { near }, aim)?;
        let rest = near + share * (outer - near).max(0.0);
        if exceeds(rest, aim) {
            return None;
        }
        let mut curves = SmallVec::<[(usize, P); 13]>::new();
        let mut curve = |border: u8, at: DVec3| {
            if border != INSIDE {
                curves.push((border as usize, image(at)));
            }
        };
        let [starts, rim, ends] = [0, 1, 2].map(|edge| borders[(piece.corner + edge) % 3]);
        curve(starts, sector.start);
        curve(ends, sector.end);
        // Where only one of the edges at the vertex is the triangle's, the vertex lies on that edge.
        match (starts, ends) {
            (INSIDE, on) | (on, INSIDE) => curve(on, DVec3::ZERO),
            (first, second) if first == second => curve(first, DVec3::ZERO),
            _ => {}
        }
        sector.rim.iter().for_each(|&at| curve(rim, at));
        let is_inside = starts == INSIDE && ends == INSIDE;
        let vertex = is_inside.then_some(DVec3::ZERO);
        let inner: SmallVec<[P; 16]> = sector
            .hull
            .iter()
            .copied()
            .chain(vertex)
            .map(image)
            .collect();
        Some(self.bound.points(&inner, &curves).grown(rest))
    }

    /// The greatest distance of the control points from the triangle, and from the edges in `borders`; `None` as soon as
    /// one is farther away than helps. Points are given as long as the answer to the last one is yes.
    fn hull(
        &self,
        each_point: impl FnOnce(&mut dyn FnMut(P) -> bool),
        borders: Borders,
        depth: usize,
    ) -> Option<Deviation> {
        let frame = self.bound.frame;
        let limit = if depth < DEEPEST {
            self.aim()
        } else {
            f64::INFINITY
        };
        let (mut greatest, limit) = (0.0f64, limit * limit);
        each_point(&mut |point| {
            if !self.effort.rim_alone {
                greatest = greater(greatest, point.squared(frame));
            }
            let open = self.effort.open;
            let counts = |&border: &u8| {
                border != INSIDE && (!self.effort.rim_alone || open[border as usize])
            };
            for border in borders.into_iter().filter(counts) {
                greatest = greater(greatest, point.squared_to_edge(frame, border as usize));
            }
            !exceeds(greatest, limit)
        });
        (!exceeds(greatest, limit)).then(|| Deviation::alone(greatest.sqrt()))
    }
}
