//! The distance within which a number of triangles is expected, told by undivided faces and by some that are divided: where the search
//! for a budget's begins.

use super::super::Engine;
use super::super::decide::leaves_of;
use super::super::judge::Goal;
use crate::certificate::TriangleFrame;
use crate::parallel;
use crate::progress::Cancelled;
use crate::refine::RefineError;
use crate::vector::hypotenuse;

/// Triangles that a face takes for each time that it is too high, about: some are less high than need be, others close gaps.
const FOR_ONE: f64 = 2.9;

/// How much more or less that may turn out to be.
const TIMES: (f64, f64) = (0.4, 2.5);

/// So many faces, or one in so many if that is less, are divided to tell how much it is.
const SAMPLED: usize = 96;
const SAMPLED_OF: usize = 8;

/// Leaves of a face are counted up to so many and so many times what is expected: beyond that they make no difference.
const COUNTED_FEWEST: usize = 64;
const COUNTED_TIMES: f64 = 8.0;

/// Distances that near to each other, as a logarithm, have the same faces divided.
const SAME: f64 = 0.05;

/// How often that is done, each time within the distance that the last one let expect.
const ROUNDS: usize = 2;

/// Below so many triangles a face few faces are divided, ...
const LITTLE: f64 = 1.5;

/// ... and distances fall with this power of what is expected: measured 0.45 to 0.5.
const SUDDEN: f64 = 0.6;

/// Triangles for each leaf: what closes gaps.
const CLOSED: f64 = 1.17;

/// Triangles by distance: their heights fall with the square of their size, so a face of height h takes about c h/d triangles within d, and
/// at least one.
pub(super) struct Profile {
    /// Of all faces, the highest first.
    heights: Vec<(f64, u32)>,
    /// c
    for_one: f64,
}

impl Profile {
    pub(super) fn of(engine: &Engine<'_>) -> Result<Self, RefineError> {
        let mut heights: Vec<(f64, u32)> = heights(engine)?.into_iter().zip(0..).collect();
        let highest_first =
            |a: &(f64, u32), b: &(f64, u32)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
        parallel::sort_polled(&mut heights, &mut |_| engine.watch.poll(), highest_first)?;
        Ok(Self {
            heights,
            for_one: FOR_ONE,
        })
    }

    /// The distance within which so many triangles are expected; `None` where all is flat, or where there are as many faces.
    pub(super) fn expected(
        &mut self,
        engine: &Engine<'_>,
        wanted: f64,
    ) -> Result<Option<f64>, RefineError> {
        let mut distance = self.distance(wanted);
        let count = SAMPLED.min(self.heights.len() / SAMPLED_OF);
        for _ in 0..if count > 0 { ROUNDS } else { 0 } {
            let Some(within) = distance else { break };
            self.sample(engine, count, within)?;
            let known = distance.replace(self.distance(wanted).unwrap_or(within));
            if known
                .zip(distance)
                .is_some_and(|(known, now)| (known / now).ln().abs() < SAME)
            {
                break;
            }
        }
        Ok(distance)
    }

    /// The distance within which so many are expected where there are some at another.
    pub(super) fn from(&self, (distance, triangles): (f64, usize), wanted: f64) -> Option<f64> {
        let times = self.distance(wanted)? / self.distance(triangles as f64)?;
        // More and more of those that are not begin to be.
        let is_little = wanted < LITTLE * self.heights.len() as f64;
        Some(distance * if is_little { times.powf(SUDDEN) } else { times })
    }

    /// The distance within which there are so many triangles: with the k highest faces divided d = c Σh/(wanted − others).
    fn distance(&self, wanted: f64) -> Option<f64> {
        let (mut sum, mut others) = (0.0, self.heights.len() as f64);
        for (at, &(height, _)) in self.heights.iter().enumerate() {
            (sum, others) = (sum + self.for_one * height, others - 1.0);
            let distance = sum / (wanted - others);
            let next = self
                .heights
                .get(at + 1)
                .map_or(0.0, |next| self.for_one * next.0);
            if wanted > others && distance >= next {
                return Some(distance).filter(|distance| *distance > 0.0 && distance.is_finite());
            }
        }
        None
    }

    /// Divides so many faces within a distance, more of those that have more triangles, to learn what they take.
    fn sample(
        &mut self,
        engine: &Engine<'_>,
        count: usize,
        distance: f64,
    ) -> Result<(), RefineError> {
        let divided = self
            .heights
            .partition_point(|&(height, _)| self.for_one * height > distance);
        let expected = |&(height, _): &(f64, u32)| self.for_one * height / distance;
        let all: f64 = self.heights[..divided].iter().map(expected).sum();
        let (mut faces, mut shares, mut before) = (Vec::new(), Vec::new(), 0.0);
        for face in &self.heights[..divided] {
            // Each time that a part of all is full.
            let part = |sum: f64| (sum / all * count as f64 + 0.5).floor();
            let after = before + expected(face);
            let share = part(after) - part(before);
            if share > 0.0 {
                faces.push((
                    face.1,
                    COUNTED_FEWEST + (COUNTED_TIMES * expected(face)) as usize,
                ));
                shares.push((share, expected(face)));
            }
            before = after;
        }
        let found = leaves_of(engine, &Goal::Within(distance), &faces)?;
        let ratios = found
            .iter()
            .zip(&shares)
            .map(|(&leaves, (share, expected))| share * leaves as f64 / expected);
        let times =
            CLOSED * ratios.sum::<f64>() / shares.iter().map(|(share, _)| share).sum::<f64>();
        if times > 0.0 {
            self.for_one = (self.for_one * times).clamp(TIMES.0 * FOR_ONE, TIMES.1 * FOR_ONE);
        }
        Ok(())
    }
}

/// How high the surface stands over the triangles of the control faces' corners, in the middles of their edges, and how far it is off the edges
/// that are open; 0 where that is no more than rounding.
pub(super) fn heights(engine: &Engine<'_>) -> Result<Vec<f64>, Cancelled> {
    let (control, rounding) = (engine.control, engine.rounding);
    let faces = control.mesh.face_count();
    let height = |face: usize| {
        let piece = control.piece(face as u32);
        let corners = control.corners(face as u32).map(|corner| corner.position);
        let (frame, open) = (TriangleFrame::new(corners), control.open(face as u32));
        let middles = piece.surface(control.rules).middles();
        let off = |edge: usize| {
            let middle = middles[edge].position;
            let aside = if open[edge] {
                frame.outward(edge).dot(middle - corners[edge])
            } else {
                0.0
            };
            hypotenuse(frame.height(middle), aside)
        };
        let height = off(0).max(off(1)).max(off(2));
        if height > rounding { height } else { 0.0 }
    };
    engine.watch.map(faces, parallel::share(faces), height)
}

#[cfg(test)]
mod tests {
    use super::super::super::demands::Demands;
    use super::super::super::judge::Goal;
    use super::super::super::with_engine;
    use super::*;
    use crate::mesh::Mesh;
    use crate::models;
    use crate::progress::unobserved;
    use crate::refine::ExactOptions;
    use crate::scheme::Loop;

    fn model(name: &str) -> Mesh {
        Mesh::from_soup(&models::find(name).unwrap().soup(), &Default::default())
            .unwrap()
            .0
    }

    /// Counts that are expected are near those that come about.
    #[test]
    fn what_is_expected_is_of_the_right_size() {
        for name in ["torus", "sphere", "cup", "bunny", "teddy", "shoe"] {
            let mesh = model(name);
            let options = (&ExactOptions::default().triangles(1), &Demands::default());
            with_engine(&mesh, &Loop, options, &mut unobserved, |engine| {
                for wanted in [10_000.0, 40_000.0] {
                    let distance = Profile::of(engine)?.expected(engine, wanted)?.unwrap();
                    let triangles = engine
                        .plan(Goal::Within(distance), usize::MAX)?
                        .unwrap()
                        .triangles as f64;
                    assert!(
                        (0.6..1.5).contains(&(triangles / wanted)),
                        "{name}, {wanted}: {triangles}"
                    );
                }
                Ok(())
            })
            .unwrap();
        }
    }

    /// A plan closes the gaps beside these leaves, which adds triangles, and divides some faces further for their neighbours' sake.
    #[test]
    fn leaves_that_are_told_are_those_of_plans() {
        for name in ["torus", "sphere", "cup", "bunny", "teddy", "shoe"] {
            let mesh = model(name);
            let options = (&ExactOptions::default().triangles(1), &Demands::default());
            with_engine(&mesh, &Loop, options, &mut unobserved, |engine| {
                let goal = Goal::Within(1e-3 * mesh.diagonal());
                let faces: Vec<(u32, usize)> = (0..mesh.face_count() as u32)
                    .map(|face| (face, usize::MAX))
                    .collect();
                let leaves: usize = leaves_of(engine, &goal, &faces)?.iter().sum();
                let triangles = engine.divided(goal, usize::MAX)?.unwrap().triangles;
                assert!(
                    (leaves..leaves * 3 / 2).contains(&triangles),
                    "{name}: {leaves}, {triangles}"
                );
                Ok(())
            })
            .unwrap();
        }
    }
}
