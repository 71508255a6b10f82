//! Whether edges of 31° to 52° are those between the facets of something round, as on a peg of eight, or edges that are meant, as where a
//! roof lies on a wall.
//!
//! Facets of round things come in rows: a facet meets the next at about the angle at which it meets the one before, on the same side, and
//! all are about as large. A chamfer is narrower than the faces that it is between, and a roof meets one wall only.

use std::ops::RangeInclusive;

use super::bends::Bend;
use crate::geometry::DisjointSets;
use crate::mesh::Mesh;

/// Edges between faces in one plane, to rounding, in degrees.
const FLAT: f64 = 1.0;

/// Facets of one row meet at the same angle to this part of it, and none is so many times as large as the next.
const SAME_ANGLE: f64 = 0.2;
const SAME_AREA: f64 = 2.5;

/// Where the length of edges between finer facets is this part (one in so many) of that of coarse ones, there are finer facets.
const FINER: f64 = 4.0;

/// An edge between two facets, seen from one of them.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    facet: u32,
    is_concave: bool,
    /// Whole degrees.
    degrees: u32,
    other: u32,
}

/// Whether most of the length of edges whose degrees are within some `degrees` is between facets of round things. Where other facets
/// are finer, those were meant to be seen.
pub(super) fn are_of_round_things(
    mesh: &Mesh,
    bends: &[Bend],
    degrees: RangeInclusive<usize>,
) -> bool {
    let facets = Facets::of(mesh, bends);
    let (coarse, others): (Vec<&Bend>, Vec<&Bend>) = bends
        .iter()
        .partition(|bend| degrees.contains(&(bend.degrees as usize)));
    let rows = facets.rows(&coarse);
    let mut is_coarse = vec![false; mesh.face_count()];
    coarse
        .iter()
        .flat_map(|bend| facets.adjacent(bend))
        .for_each(|facet| is_coarse[facet as usize] = true);
    let is_finer = |bend: &Bend| {
        (FLAT..*degrees.start() as f64).contains(&bend.degrees)
            && !facets
                .adjacent(bend)
                .iter()
                .any(|&facet| is_coarse[facet as usize])
    };
    let all = length(&coarse, |_| true);
    2.0 * length(&coarse, |bend| facets.is_of_row(bend, &rows)) > all
        && FINER * length(&others, is_finer) < all
}

/// The length of those edges that are as asked.
fn length(bends: &[&Bend], is_own: impl Fn(&Bend) -> bool) -> f64 {
    bends
        .iter()
        .filter(|bend| is_own(bend))
        .map(|bend| bend.length)
        .sum()
}

/// Faces in one plane that hang together.
struct Facets {
    /// By face, the first of its facet.
    first: Vec<u32>,
    /// By that face.
    areas: Vec<f64>,
}

impl Facets {
    fn of(mesh: &Mesh, bends: &[Bend]) -> Self {
        let mut sets = DisjointSets::new(mesh.face_count());
        for bend in bends.iter().filter(|bend| bend.degrees < FLAT) {
            sets.unite(bend.edge.face().0, bend.twin.face().0);
        }
        let first = sets.into_roots();
        let mut areas = vec![0.0; mesh.face_count()];
        for (face, &first) in first.iter().enumerate() {
            areas[first as usize] += mesh.face_normal_vector(face).length();
        }
        Self { first, areas }
    }

    /// The facets at an edge.
    fn adjacent(&self, bend: &Bend) -> [u32; 2] {
        [bend.edge, bend.twin].map(|h| self.first[h.face().index()])
    }

    /// An edge from both sides, if the facets are about as large.
    fn sides(&self, bend: &Bend) -> Option<[Side; 2]> {
        let [a, b] = self.adjacent(bend);
        let [own, other] = [a, b].map(|facet| self.areas[facet as usize]);
        let side = |facet, other| Side {
            facet,
            is_concave: bend.is_concave,
            degrees: bend.degrees as u32,
            other,
        };
        (own <= SAME_AREA * other && other <= SAME_AREA * own).then(|| [side(a, b), side(b, a)])
    }

    /// All sides of some edges, in order.
    fn rows(&self, bends: &[&Bend]) -> Vec<Side> {
        let mut rows: Vec<Side> = bends
            .iter()
            .filter_map(|bend| self.sides(bend))
            .flatten()
            .collect();
        rows.sort_unstable();
        rows.dedup();
        rows
    }

    /// Whether the facets at an edge each meet a third one alike.
    fn is_of_row(&self, bend: &Bend, rows: &[Side]) -> bool {
        self.sides(bend)
            .is_some_and(|sides| sides.into_iter().all(|side| side.goes_on(rows)))
    }
}

impl Side {
    /// Whether the facet meets another one at about the same angle.
    fn goes_on(self, rows: &[Side]) -> bool {
        let off = (SAME_ANGLE * f64::from(self.degrees)).round() as u32;
        let least = Self {
            degrees: self.degrees.saturating_sub(off),
            other: 0,
            ..self
        };
        let is_alike = |side: &&Self| {
            (side.facet, side.is_concave) == (self.facet, self.is_concave)
                && side.degrees <= self.degrees + off
        };
        let mut alike = rows[rows.partition_point(|side| *side < least)..]
            .iter()
            .take_while(is_alike);
        alike.any(|side| side.other != self.other)
    }
}
