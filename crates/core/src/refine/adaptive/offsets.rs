//! Moves vertices off the limit surface by half of what the triangles miss, so that the error lies on both sides.
//!
//! Triangles with their corners on a convex surface lie inside it by up to e; with the corners moved out by e/2 both
//! sides have e/2. Let heights over a triangle lie between l ≤ 0 ≤ h while its corners are on the surface. With all three moved by
//! x they lie between l − x and h − x, so for errors of at most e each corner's x has to be between h − e and l + e. A vertex that is
//! between these for all triangles around it stays so when some of them are divided: then the ranges shrink. Else a division would
//! make the triangles beside fail, these those beside them, and so on, one a round.
//!
//! Where a surface bends both ways in the same way, and on boundaries and sharp edges, vertices stay. Triangles that no camera sees have no
//! say: they may be much coarser than those beside them, which would not stand what these want.

use super::backs::{Behind, looks_away};
use super::control::Control;
use super::emit::Emission;
use super::emitted::{Beholder, Emitted, Over, Sources};
use super::measure::fail;
use super::quadtree::Place;
use crate::certificate::TriangleFrame;
use crate::criterion::Region;
use crate::patch::Rules;
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::{DVec3, unit_or_zero, vector};

/// Levels below a leaf whose vertices are sampled where a piece is not regular.
const SAMPLED_LEVELS: usize = 2;

/// Control faces that one call takes together.
const BLOCK: usize = 64;

/// Where all heights around can be within this part of what is allowed, vertices move no farther than they have to for that.
const EASY: f64 = 0.5;

/// Parts of third and fourth degree below this part of the range are not worth a closer look.
const SMOOTH: f64 = 0.05;

/// Heights in a range of so many times what is allowed on either side are too much, wherever the corners are.
const HOPELESS: f64 = 2.0;

/// The least and the greatest height of the surface over the triangles, whose corners lie on it, by control face.
#[derive(Default)]
pub(super) struct Bulges(Vec<Bulge>);

/// Those of a control face.
#[derive(Clone, Default)]
struct Bulge {
    /// Nothing where nobody looks.
    ranges: Vec<Option<(f64, f64)>>,
    /// Leaves whose triangles bulge too far, and half of that.
    failing: Vec<(Place, f64)>,
}

impl Bulges {
    /// Looks at the triangles of some control faces; heights of `allowed` on either side are good enough.
    pub(super) fn look(
        &mut self,
        sources: &Sources<'_>,
        watch: &SharedWatch<'_>,
        faces: &[u32],
        allowed: f64,
    ) -> Result<(), Cancelled> {
        let hopeless = HOPELESS * allowed;
        let emission = sources.emission;
        self.0.resize_with(emission.starts.len() - 1, Bulge::default);
        let found = watch.long_pieces(faces.len(), BLOCK, |block, is_stopped| {
            let found = faces[block].iter().map(|&face| {
                let triangles = emission.triangles_of(face);
                let ranges = vec![None; triangles.len()];
                let found = Bulge { ranges, failing: Vec::new() };
                let (control, first) = (sources.control, triangles.start as u32);
                let mut looking = Looking { control, emission, first, hopeless, found };
                sources.show(face, is_stopped, &mut looking);
                looking.found
            });
            found.collect::<Vec<_>>()
        })?;
        watch.each(faces.iter().zip(found.into_iter().flatten()), |(&face, found)| {
            self.0[face as usize] = found;
        })
    }

    /// The leaves that fail wherever their corners are moved, and what they come to at best.
    pub(super) fn failing(&self) -> Vec<(Place, f64)> {
        self.0.iter().flat_map(|face| &face.failing).copied().collect()
    }

    /// How far each vertex is to be moved along its normal: by the mean of the middles around, or as near to that as leaves all
    /// heights around well within `allowed`; where nothing does, to the middle of them all.
    pub(super) fn offsets(
        &self,
        control: &Control<'_>,
        emission: &Emission,
        allowed: f64,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<f64>, Cancelled> {
        let mut around = vec![Around::default(); emission.positions.len()];
        let ranges = self.0.iter().flat_map(|face| &face.ranges);
        watch.each(emission.triangles.iter().zip(ranges), |(triangle, range)| {
            for (&vertex, range) in triangle.iter().zip([range; 3]) {
                range.iter().for_each(|range| around[vertex as usize].add(range));
            }
        })?;
        let mut offsets = Vec::with_capacity(around.len());
        watch.each(around, |around| offsets.push(around.offset(EASY * allowed)))?;
        watch.each(0..control.mesh.face_count() as u32, |face| {
            let open = control.open(face);
            for edge in (0..3).filter(|&edge| open[edge as usize]) {
                for &h in emission.borders.along(3 * face + edge) {
                    let triangle = emission.triangles[h as usize / 3];
                    (0..2).for_each(|end| offsets[triangle[(h as usize + end) % 3] as usize] = 0.0);
                }
            }
        })?;
        // Corners and darts inside a face's reach; and copies, which would part.
        control.lasting.tagged_vertices().for_each(|vertex| offsets[vertex.index()] = 0.0);
        let copies = emission.junctions.vertices.iter().flatten();
        copies.for_each(|&vertex| offsets[vertex as usize] = 0.0);
        Ok(offsets)
    }
}

/// The heights over the triangles around a vertex.
#[derive(Clone, Copy, Default)]
struct Around {
    low: f64,
    high: f64,
    /// Of twice the middles.
    sum: f64,
    triangles: u32,
}

impl Around {
    fn add(&mut self, &(low, high): &(f64, f64)) {
        (self.low, self.high) = (self.low.min(low), self.high.max(high));
        self.sum += low + high;
        self.triangles += 1;
    }

    /// How far to move the vertex.
    fn offset(&self, easy: f64) -> f64 {
        let (least, most) = (self.high - easy, self.low + easy);
        if least <= most {
            (0.5 * self.sum / f64::from(self.triangles.max(1))).max(least).min(most)
        } else {
            0.5 * (self.low + self.high)
        }
    }
}

/// Looks at the triangles of a control face.
struct Looking<'a> {
    control: &'a Control<'a>,
    emission: &'a Emission,
    first: u32,
    hopeless: f64,
    found: Bulge,
}

impl Beholder for Looking<'_> {
    fn triangle<'p>(&mut self, emitted: &Emitted, over: Over<'_, 'p>, rules: &'p Rules<'p>) {
        let corners = emitted.vertices.map(|vertex| vector(self.emission.positions[vertex as usize]));
        if self.is_unseen(emitted, corners, &over, rules) {
            return;
        }
        let (low, high) = match over {
            Over::Regular(ground, cell, _) => {
                let [a, b, c] = corners;
                let heights = ground.jet().heights(&cell, unit_or_zero((b - a).cross(c - a)));
                let (low, high, rest) = heights.about();
                if rest < SMOOTH * (high - low) { (low, high) } else { heights.sampled() }
            }
            Over::General(pieces, _) => {
                let frame = TriangleFrame::new(corners);
                let points = pieces.points(SAMPLED_LEVELS, rules).into_iter();
                let inside =
                    points.filter(|&point| (0..3).all(|edge| frame.beside(edge, point).outside <= 0.0));
                let heights = inside.map(|point| frame.height(point));
                heights.fold((0.0f64, 0.0f64), |(low, high), height| (low.min(height), high.max(height)))
            }
        };
        self.found.ranges[(emitted.number - self.first) as usize] = Some((low, high));
        if high - low > self.hopeless {
            fail(&mut self.found.failing, emitted.place, 0.5 * (high - low));
        }
    }
}

impl Looking<'_> {
    /// Whether no camera sees more of a triangle than its back, as far as the triangle and its piece tell.
    fn is_unseen(
        &self,
        emitted: &Emitted,
        corners: [DVec3; 3],
        over: &Over<'_, '_>,
        rules: &Rules<'_>,
    ) -> bool {
        let Control { criteria: Some(criteria), back_faces, .. } = self.control else { return false };
        let region = Region::around(corners, DVec3::ZERO);
        let backs = looks_away(criteria, &region, (&[corners], 0.0), |viewer, rest| {
            Behind::of(back_faces, emitted, over, rules).is_back(&over.corners(), viewer, rest)
        });
        criteria.is_unseen(&region, &backs)
    }
}
