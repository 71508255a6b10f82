//! Angles between the faces at edges, and whether some edges stand out as sharp.

use limitmesh::{FaceId, Mesh};
use serde::Serialize;

use crate::vector::{cross, distance, dot, length};

/// Steps of the histogram, of ten degrees each.
const STEPS: usize = 18;

/// Edges between faces, by the angle between these faces' normals.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct Dihedrals {
    /// Edges with an angle in [0°, 10°), [10°, 20°) … [170°, 180°].
    pub(crate) histogram: [usize; STEPS],
    /// The angle that parts sharp edges from smooth ones; null where none stand out.
    pub(crate) suggested_crease_angle_degrees: Option<f64>,
    /// Edges beyond that angle.
    pub(crate) sharp_edges: usize,
}

/// Facets of round parts meet at less than this; more is seen as an edge.
const SEEN: usize = 20;

/// Edges beyond this are nearly square.
const NEARLY_SQUARE: usize = 60;

/// Edges beyond this are sharp by any standard: the gap must end before.
const SHARP: usize = 80;

/// Degrees that a gap between smooth edges and nearly square ones is wide at least, and one below sharp edges that are not.
const GAP: usize = 15;
const WIDE_GAP: usize = 30;

/// A part of the length of sharp edges (one in so many) that may lie within the gap: chamfers and the like.
const WITHIN: f64 = 50.0;

/// Sharp edges are this part of the length of all edges at least (one in so many): a few folds of a scan are none.
const FEW: f64 = 200.0;

/// The angle where it lies within the gap: as many programs have it.
const USUAL: usize = 30;

impl Dihedrals {
    /// Of a mesh.
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let mut histogram = [0; STEPS];
        // Lengths of the edges by whole degrees.
        let mut lengths = [0.0; 181];
        let topology = mesh.topology();
        let mut angles = Vec::with_capacity(topology.edge_count());
        for h in topology.half_edges() {
            let Some(twin) = topology.twin(h).filter(|twin| h.0 < twin.0) else { continue };
            let Some(degrees) = angle(mesh, h.face(), twin.face()) else { continue };
            histogram[(degrees / 10.0) as usize] += 1;
            let [a, b] = topology.ends(h).map(|v| mesh.positions()[v.index()]);
            lengths[degrees as usize] += distance(a, b);
            angles.push(degrees);
        }
        let suggested = suggested(&lengths);
        let sharp_edges = suggested.map_or(0, |limit| angles.iter().filter(|&&angle| angle > limit).count());
        Self { histogram, suggested_crease_angle_degrees: suggested, sharp_edges }
    }
}

/// The angle between the normals of two faces in degrees, below 180; `None` where one has none.
fn angle(mesh: &Mesh, a: FaceId, b: FaceId) -> Option<f64> {
    let [m, n] = [a, b].map(|face| mesh.face_normal(face));
    let degrees = length(cross(m, n)).atan2(dot(m, n)).to_degrees();
    (dot(m, m) > 0.0 && dot(n, n) > 0.0).then_some(degrees.min(180f64.next_down()))
}

/// In the middle of the widest gap between smooth and sharp edges, or at the usual angle if that is in the gap.
fn suggested(lengths: &[f64; 181]) -> Option<f64> {
    let all: f64 = lengths.iter().sum();
    let beyond = |degrees: usize| lengths[degrees..].iter().sum::<f64>();
    // For each end of a gap, how far down it reaches.
    let gap = |end: usize| {
        let sharp = beyond(end);
        let mut within = 0.0;
        let begin = (0..end).rev().find(|&degrees| {
            within += lengths[degrees];
            within * WITHIN > sharp
        });
        let begin = begin.map_or(0, |degrees| degrees + 1);
        (sharp * FEW > all).then_some((begin, end))
    };
    // What is nearly square is sharp before all else: the facets of a coarse cylinder may be taken for edges as well.
    let widest = |ends: std::ops::RangeInclusive<usize>, least: usize| {
        let gaps = ends.filter_map(gap).filter(|&(begin, end)| end >= begin + least);
        gaps.max_by_key(|&(begin, end)| (end - begin, end))
    };
    let (begin, end) =
        widest(NEARLY_SQUARE..=SHARP, GAP).or_else(|| widest(SEEN..=NEARLY_SQUARE, WIDE_GAP))?;
    if (begin..end).contains(&USUAL) {
        return Some(USUAL as f64);
    }
    // To five degrees, as a person would say it.
    let middle = (begin + end) as f64 / 2.0;
    let round = 5.0 * (middle / 5.0).round();
    Some(if (begin as f64..end as f64).contains(&round) { round } else { middle })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lengths of 1 at some angles.
    fn of(angles: &[usize]) -> Option<f64> {
        let mut lengths = [0.0; 181];
        angles.iter().for_each(|&degrees| lengths[degrees] += 1.0);
        suggested(&lengths)
    }

    #[test]
    fn gaps_between_smooth_and_sharp_edges_are_found() {
        // A box, a cylinder of 16 facets, one of 8, one whose facets meet at 50°.
        assert_eq!(of(&[0, 90, 90]), Some(30.0));
        assert_eq!(of(&[22, 22, 22, 90, 90]), Some(30.0));
        assert_eq!(of(&[45, 45, 90, 90]), Some(65.0));
        assert_eq!(of(&[50, 90]), Some(65.0));
    }

    #[test]
    fn what_is_smooth_or_rough_all_over_has_no_sharp_edges() {
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[1, 2, 3, 4, 5, 9, 12]), None);
        assert_eq!(of(&(0..90).collect::<Vec<_>>()), None);
        // A coarse torus: round both ways.
        assert_eq!(of(&[0, 8, 29, 45, 45]), None);
        // One fold among a thousand edges.
        let mut scan: Vec<usize> = (0..1000).map(|i| i % 12).collect();
        scan.push(100);
        assert_eq!(of(&scan), None);
    }
}
