//! Whether a mesh looks like a part, by the angles at which its faces meet.
//!
//! A part has flat or nearly flat edges inside its faces, sharp edges between these, and little in between: in lengths of edges by
//! angle there is a gap. The sharp edges form lines, whereas those of organic shapes that happen to be sharp end here and there. A
//! coarse cage is sharp everywhere, and a file of quadrilaterals is one whatever its angles. Voxels have a gap, too; they are recognised by
//! that their flat regions are all small, and that more than three sharp edges, up and down, meet at many of their corners.

use std::ops::RangeInclusive;

use super::bends::{Bend, bends, is_concave};
use super::facets::are_of_round_things;
use super::sharp::Part;
use crate::geometry::DisjointSets;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;

/// The look of a mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Look {
    /// A part: flat and round faces that meet at sharp edges.
    Part(Part),
    /// A shape without edges that stand out, or where these form no lines.
    Smooth,
    /// A coarse cage that is meant to become round: of quadrilaterals and larger polygons, or sharp everywhere.
    Cage,
    /// Stairs, as voxels leave them where a smooth shape is meant.
    Stairs,
}

/// Facets of round parts meet at less than this; more is seen as an edge.
const SEEN: usize = 20;

/// Facets of round parts meet at no more than this in any case: 360° by 7 and a little.
const ROUND: usize = 52;

/// Faces that meet at these are either facets of round parts or meant as they are.
const COARSE: RangeInclusive<usize> = USUAL + 1..=ROUND;

/// Edges beyond this are nearly square.
const NEARLY_SQUARE: usize = 60;

/// Edges beyond this are sharp by any standard: the gap must end before.
const SHARP: usize = 80;

/// Degrees that a gap between smooth edges and nearly square ones is wide at least, and one below sharp edges that are not.
const GAP: usize = 15;
const WIDE_GAP: usize = 30;

/// Degrees that a gap below edges is wide at least at which coarse facets might meet.
const LOWER_GAP: usize = 8;

/// A part of the length of sharp edges (one in so many) that may lie within the gap: chamfers and the like.
const WITHIN: f64 = 50.0;

/// [`WITHIN`] where much is flat and much is sharp, and for the usual angle to be within the gap.
const WITHIN_PLAIN_PARTS: f64 = 10.0;

/// The length of all edges is so many times that of flat ones (below 1°), and of sharp ones, where much is flat and sharp.
const MUCH_FLAT: f64 = 4.0;
const MUCH_SHARP: f64 = 8.0;

/// Sharp edges are this part of the length of all edges at least (one in so many): a few folds of a scan are none.
const FEW: f64 = 200.0;

/// Smooth edges are this part of it at least, or all is sharp.
const LEAST_SMOOTH: f64 = 10.0;

/// The angle where it lies within the gap: as many programs have it.
const USUAL: usize = 30;

/// One sharp edge in so many may end where no other goes on.
const LOOSE_ENDS: usize = 10;

/// Flat regions smaller than one in so many of the whole are small, and one corner in so many of stairs is a saddle at least.
const SMALL: f64 = 12.0;
const SADDLES: usize = 100;

impl Look {
    /// The look of `mesh`. `faces` are the input's faces that those of the mesh are from ([`Trace::faces`](crate::mesh::Trace)), by which
    /// polygons are known; empty where all are triangles. Tags are not looked at.
    pub fn of(mesh: &Mesh, faces: &[u32]) -> Self {
        match Self::by_angles(mesh) {
            Self::Part(_) if is_of_polygons(faces) => Self::Cage,
            look => look,
        }
    }

    fn by_angles(mesh: &Mesh) -> Self {
        let bends = bends(mesh);
        let lengths = Lengths::of(&bends);
        if !lengths.is_in_space() {
            return Self::Smooth;
        }
        let gap = lengths.gap(SEEN);
        if gap.is_some_and(|gap| {
            lengths.all >= LEAST_SMOOTH * (lengths.all - lengths.beyond(gap.begin))
        }) {
            return Self::Cage;
        }
        let is_round = || are_of_round_things(mesh, &bends, COARSE);
        let degrees = match (gap, lengths.lower_gap()) {
            (Some(found), Some(lower)) if lower.end < found.begin && !is_round() => {
                Some(lower.begin.max(USUAL) as f64)
            }
            (Some(found), _) if found.end <= ROUND && is_round() => {
                lengths.gap(ROUND + 1).map(|gap| lengths.angle(gap))
            }
            _ => gap.map(|gap| lengths.angle(gap)),
        };
        let is_rough = gap.is_none_or(|gap| gap.end < NEARLY_SQUARE);
        degrees.map_or(Self::Smooth, |degrees| {
            Self::of_edges_beyond(degrees, is_rough, mesh)
        })
    }

    /// A part with the edges beyond an angle, unless these are no lines or lead up and down stairs: of voxels, or of the facets at 35° and
    /// more that marching cubes make of these, where edges that are not nearly square look sharp.
    fn of_edges_beyond(degrees: f64, is_rough: bool, mesh: &Mesh) -> Self {
        let Ok(part) = Part::at_angle(degrees, mesh) else {
            return Self::Smooth;
        };
        let edges = &part.creases.edges;
        let lines = Lines::of(mesh, edges);
        if LOOSE_ENDS * lines.loose_ends() > edges.len() || edges.is_empty() {
            return Self::Smooth;
        }
        if (is_rough || lines.have_saddles()) && has_small_regions(mesh, edges) {
            return Self::Stairs;
        }
        Self::Part(part)
    }
}

/// Whether most of the input's faces became more than one triangle.
fn is_of_polygons(faces: &[u32]) -> bool {
    let mut faces = faces.to_vec();
    faces.sort_unstable();
    let (mut polygons, mut all) = (0, 0);
    for triangles in faces.chunk_by(|a, b| a == b) {
        all += 1;
        polygons += usize::from(triangles.len() > 1);
    }
    2 * polygons > all
}

/// Whole degrees between which there are hardly any edges.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gap {
    begin: usize,
    end: usize,
}

/// Lengths of the edges between faces, by whole degrees.
struct Lengths {
    by_degree: [f64; 181],
    all: f64,
}

impl Lengths {
    fn of(bends: &[Bend]) -> Self {
        let mut by_degree = [0.0; 181];
        bends
            .iter()
            .for_each(|bend| by_degree[(bend.degrees as usize).min(180)] += bend.length);
        Self::new(by_degree)
    }

    fn new(by_degree: [f64; 181]) -> Self {
        Self {
            all: by_degree.iter().sum(),
            by_degree,
        }
    }

    fn beyond(&self, degrees: usize) -> f64 {
        self.by_degree[degrees..].iter().sum()
    }

    /// Whether faces lie in more planes than one: those of a flat mesh that is folded onto itself do not.
    fn is_in_space(&self) -> bool {
        self.by_degree[1..179].iter().sum::<f64>() * FEW > self.all
    }

    /// How far down a gap reaches that ends here, with one in so many of the length beyond it in it.
    fn begin(&self, end: usize, one_in: f64) -> usize {
        let (sharp, mut within) = (self.beyond(end), 0.0);
        let begin = (0..end).rev().find(|&degrees| {
            within += self.by_degree[degrees];
            within * one_in > sharp
        });
        begin.map_or(0, |degrees| degrees + 1)
    }

    /// The widest gap between smooth edges and sharp ones, which are at one of some angles and beyond.
    fn widest(&self, sharp: RangeInclusive<usize>, least: usize, one_in: f64) -> Option<Gap> {
        let gaps = sharp.filter(|&end| self.beyond(end) * FEW > self.all);
        let gaps = gaps.map(|end| Gap {
            begin: self.begin(end, one_in),
            end,
        });
        gaps.filter(|gap| gap.begin <= ROUND && gap.end >= gap.begin + least)
            .max_by_key(|gap| (gap.end - gap.begin, gap.end))
    }

    /// The widest gap between smooth and sharp edges, which begin at so many degrees at least.
    fn gap(&self, least_sharp: usize) -> Option<Gap> {
        // Edges that are nearly square are sharp before all others: the facets of a coarse cylinder may be taken for edges as well.
        let by = |one_in: f64| {
            self.widest(NEARLY_SQUARE..=SHARP, GAP, one_in)
                .or_else(|| self.widest(least_sharp..=NEARLY_SQUARE, WIDE_GAP, one_in))
        };
        by(WITHIN).or_else(|| by(WITHIN_PLAIN_PARTS).filter(|&gap| self.is_plain(gap)))
    }

    /// The gap between the edges of fine facets and those at which coarse ones might meet.
    fn lower_gap(&self) -> Option<Gap> {
        self.widest(COARSE, LOWER_GAP, WITHIN)
            .filter(|gap| gap.begin <= *COARSE.start())
    }

    /// Whether much is flat and much is sharp.
    fn is_plain(&self, gap: Gap) -> bool {
        self.by_degree[0] * MUCH_FLAT >= self.all && self.beyond(gap.end) * MUCH_SHARP >= self.all
    }

    /// The usual angle if there is little around it, else the middle of the gap.
    fn angle(&self, gap: Gap) -> f64 {
        if (self.begin(gap.end, WITHIN_PLAIN_PARTS)..gap.end).contains(&USUAL) {
            return USUAL as f64;
        }
        // To five degrees, as a person would say it.
        let middle = (gap.begin + gap.end) as f64 / 2.0;
        let round = 5.0 * (middle / 5.0).round();
        if (gap.begin as f64..gap.end as f64).contains(&round) {
            round
        } else {
            middle
        }
    }
}

/// How sharp edges meet.
struct Lines<'m> {
    mesh: &'m Mesh,
    /// By vertex, its sharp edges that are convex, and those that are concave.
    counts: Vec<[u32; 2]>,
}

impl<'m> Lines<'m> {
    fn of(mesh: &'m Mesh, edges: &[HalfEdgeId]) -> Self {
        let mut counts = vec![[0; 2]; mesh.vertex_count()];
        for &h in edges {
            let is_concave = usize::from(is_concave(mesh, h));
            mesh.topology()
                .ends(h)
                .iter()
                .for_each(|v| counts[v.index()][is_concave] += 1);
        }
        Self { mesh, counts }
    }

    /// Ends of sharp edges inside the mesh where no other goes on.
    fn loose_ends(&self) -> usize {
        let is_inside = |v: usize| !self.mesh.topology().is_boundary(VertexId(v as u32));
        let alone = self
            .counts
            .iter()
            .enumerate()
            .filter(|&(_, [up, down])| up + down == 1);
        alone.filter(|&(v, _)| is_inside(v)).count()
    }

    /// Whether there are more than a few corners at which at least four sharp edges meet, both convex and concave ones.
    fn have_saddles(&self) -> bool {
        let corners = self
            .counts
            .iter()
            .filter(|[up, down]| up + down > 2)
            .count();
        let saddles = self
            .counts
            .iter()
            .filter(|&&[up, down]| up + down > 3 && up > 0 && down > 0)
            .count();
        saddles > 0 && saddles * SADDLES >= corners
    }
}

/// Whether half of the area at least is in small regions between sharp edges.
fn has_small_regions(mesh: &Mesh, edges: &[HalfEdgeId]) -> bool {
    let topology = mesh.topology();
    let mut is_sharp = vec![false; 3 * mesh.face_count()];
    edges.iter().for_each(|h| is_sharp[h.index()] = true);
    let mut regions = DisjointSets::new(mesh.face_count());
    for h in topology.half_edges() {
        if let Some(twin) = topology.twin(h).filter(|twin| h < *twin)
            && !is_sharp[h.index()]
            && !is_sharp[twin.index()]
        {
            regions.unite(h.face().0, twin.face().0);
        }
    }
    let mut areas = vec![0.0; mesh.face_count()];
    for (face, root) in regions.into_roots().into_iter().enumerate() {
        areas[root as usize] += mesh.face_normal_vector(face).length();
    }
    let all: f64 = areas.iter().sum();
    2.0 * areas.iter().filter(|&area| area * SMALL < all).sum::<f64>() >= all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The angle for lengths of 1 at some angles.
    fn of(angles: &[usize]) -> Option<f64> {
        let mut lengths = [0.0; 181];
        angles.iter().for_each(|&degrees| lengths[degrees] += 1.0);
        let lengths = Lengths::new(lengths);
        lengths.gap(SEEN).map(|gap| lengths.angle(gap))
    }

    #[test]
    fn gaps_between_smooth_and_sharp_edges_are_found() {
        // A box, a cylinder of 16 facets, one of 8, one whose facets meet at 50°.
        assert_eq!(of(&[0, 90, 90]), Some(30.0));
        assert_eq!(of(&[22, 22, 22, 90, 90]), Some(30.0));
        assert_eq!(of(&[45, 45, 90, 90]), Some(65.0));
        assert_eq!(of(&[50, 90]), Some(65.0));
        // A hexagonal nut: six facets are no cylinder.
        assert_eq!(of(&[0, 0, 60, 90, 90]), Some(30.0));
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

    #[test]
    fn most_faces_decide_whether_a_file_is_one_of_polygons() {
        assert!(!is_of_polygons(&[]));
        assert!(!is_of_polygons(&[0, 1, 2, 2]));
        assert!(is_of_polygons(&[0, 1, 1, 2, 2]));
    }
}
