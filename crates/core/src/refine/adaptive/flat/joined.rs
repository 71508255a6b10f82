//! Regions in one plane side by side, such as the parts of a face that sharp edges divide at its concave corners.
//!
//! Where both are what their rims enclose, and so are the triangles that approximate them, what counts is what encloses them
//! together: a point of the surface and not of the triangles, or the other way round, is one round which their rims, taken together, wind
//! but not the chords of these, or the other way round. What two regions share runs the one way for the one and the other way for the
//! other, so it winds round nothing. That takes regions round whose points rims wind forwards alone, or one could undo what the other does: those
//! that are proven not to fold, also where what rims enclose is asked for.

use super::regions::{FlatRegions, Plane};
use super::unfolded::{HEIGHT_ROUNDING, MOST_UNFOLDED, height_over, is_unfolded};
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::adaptive::control::Control;
use std::collections::HashSet;

impl FlatRegions {
    /// By region that is judged by its rim, the first of those that lie in one plane, within `most`, and hang together; others are their own.
    /// How far that takes them off the planes is counted. `size` is the greatest coordinate.
    pub(super) fn join(
        &mut self,
        control: &Control<'_>,
        most: f64,
        size: f64,
        watch: &SharedWatch<'_>,
    ) -> Result<(), Cancelled> {
        let count = self.regions.len() as u32;
        let mut joined: Vec<u32> = (0..count).collect();
        let mut is_done: Vec<bool> = self.by_rim.iter().map(|by_rim| !by_rim).collect();
        // Faces that may still be proven not to fold.
        let mut left = MOST_UNFOLDED;
        for first in 0..count {
            if core::mem::replace(&mut is_done[first as usize], true) {
                continue;
            }
            let (mut waiting, plane) = (vec![first], self.regions[first as usize].1);
            // Whether the first one folds is asked once there is another one in its plane.
            let (mut is_proven, mut rejected) = (None, HashSet::new());
            while let Some(region) = waiting.pop() {
                for other in self.beyond(control, region, watch)? {
                    if is_done[other as usize] || rejected.contains(&other) {
                        continue;
                    }
                    let off = self.height_over(control, other, &plane, most);
                    let mut is_sound = |region: u32| {
                        self.is_sound(control, region, &plane, most, &mut left, watch)
                    };
                    let may_join = off.is_some() && {
                        let is_first_sound = match is_proven {
                            Some(is_proven) => is_proven,
                            None => *is_proven.insert(is_sound(first)?),
                        };
                        is_first_sound && is_sound(other)?
                    };
                    let Some(off) = off.filter(|_| may_join) else {
                        rejected.insert(other);
                        continue;
                    };
                    self.beyond_rims = self.beyond_rims.max(most);
                    self.off_planes = self.off_planes.max(off + HEIGHT_ROUNDING * size);
                    (is_done[other as usize], joined[other as usize]) = (true, first);
                    waiting.push(other);
                }
            }
        }
        self.joined = joined;
        Ok(())
    }

    /// The regions beyond the edges of one, each as often as there are such edges.
    fn beyond(
        &self,
        control: &Control<'_>,
        region: u32,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<u32>, Cancelled> {
        let mut beyond = Vec::new();
        watch.each(&self.regions[region as usize].0, |&face| {
            let twins = (3 * face..3 * face + 3).filter_map(|h| control.edges.twin(h));
            let others = twins
                .filter_map(|twin| self.region(twin / 3))
                .filter(|&other| other != region);
            beyond.extend(others);
        })?;
        Ok(beyond)
    }

    /// How far the surface over a region is off a plane at most, if that is no more than `most` and it looks the same way.
    fn height_over(
        &self,
        control: &Control<'_>,
        region: u32,
        plane: &Plane,
        most: f64,
    ) -> Option<f64> {
        let (faces, own) = &self.regions[region as usize];
        if own.normal.dot(plane.normal) <= 0.0 {
            return None;
        }
        let mut heights = faces
            .iter()
            .map(|&face| height_over(control, face, plane, most));
        heights.try_fold(0.0, |greatest: f64, height| Some(greatest.max(height?)))
    }

    /// Whether a region is proven not to fold. Where rims are not taken for what they enclose, those that are judged by them are.
    fn is_sound(
        &self,
        control: &Control<'_>,
        region: u32,
        plane: &Plane,
        most: f64,
        left: &mut usize,
        watch: &SharedWatch<'_>,
    ) -> Result<bool, Cancelled> {
        if !self.unfolds {
            return Ok(true);
        }
        let faces = &self.regions[region as usize].0;
        let Some(rest) = left.checked_sub(faces.len()) else {
            return Ok(false);
        };
        *left = rest;
        for &face in faces {
            watch.poll()?;
            if !is_unfolded(control, face, plane, most) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Which edges of a face of a region that is judged by its rim count, given those that are sharp or boundaries: all that have no
    /// part of the same plane beyond.
    pub(in super::super) fn counting(
        &self,
        control: &Control<'_>,
        face: u32,
        open: [bool; 3],
    ) -> [bool; 3] {
        let joined = |face: u32| {
            let region = self
                .region(face)
                .filter(|&region| self.by_rim[region as usize])?;
            Some(self.joined[region as usize])
        };
        let Some(own) = joined(face) else { return open };
        [0, 1, 2].map(|edge| {
            let beyond = control
                .edges
                .twin(3 * face + edge as u32)
                .and_then(|twin| joined(twin / 3));
            open[edge] && beyond != Some(own)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::judge::Goal;
    use super::super::super::measure::{Look, measure};
    use super::super::super::with_engine;
    use crate::index::VertexId;
    use crate::mesh::{CornerTag, CreaseTag, INFINITELY_SHARP, Mesh, Tags};
    use crate::refine::ExactOptions;

    const SIDE: u32 = 8;

    fn at(i: u32, j: u32) -> u32 {
        (SIDE + 1) * j + i
    }

    /// A square that a zigzag of sharp edges divides, lifted by a parabola beyond it.
    fn divided_square(bend: f64) -> Mesh {
        let inside = |i: u32, j: u32| i == SIDE / 2 && 0 < j && j < SIDE;
        let shift = |i: u32, j: u32| {
            if inside(i, j) {
                0.3 * f64::from(j % 2)
            } else {
                0.0
            }
        };
        let lift = |i: u32| bend * f64::from(i.saturating_sub(SIDE / 2)).powi(2);
        let point = |i: u32, j: u32| [f64::from(i) + shift(i, j), f64::from(j), lift(i)];
        let positions = (0..=SIDE)
            .flat_map(|j| (0..=SIDE).map(move |i| point(i, j)))
            .collect();
        let squares = (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j)));
        let halves = |(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        let mesh = Mesh::from_triangles(positions, squares.flat_map(halves).collect()).unwrap();
        let corners = [at(0, 0), at(SIDE, 0), at(0, SIDE), at(SIDE, SIDE)];
        let corners = corners.map(|vertex| CornerTag {
            vertex,
            sharpness: INFINITELY_SHARP,
        });
        let crease = |j| CreaseTag {
            vertices: [at(SIDE / 2, j), at(SIDE / 2, j + 1)],
            sharpness: INFINITELY_SHARP,
        };
        let tags = Tags {
            creases: (0..SIDE).map(crease).collect(),
            corners: corners.to_vec(),
        };
        mesh.with_tags(tags).unwrap()
    }

    /// The zigzag is far from its chords, but not from the square that is on both sides of it; where one of them is bent it counts.
    #[test]
    fn what_divides_a_plane_is_no_rim() {
        for bend in [0.0, 1e-3] {
            let mesh = divided_square(bend);
            let options = ExactOptions::default().tolerance(0.3);
            with_engine(&mesh, &options, |engine| {
                let flat = &engine.control.flat;
                assert_eq!(flat.regions.len(), if bend == 0.0 { 2 } else { 1 });
                assert!(flat.by_rim.iter().all(|&by_rim| by_rim));
                let found = engine.refined(Goal::Within(0.3), usize::MAX)?.unwrap();
                let sources = engine.sources(&found.state, &found.emission);
                let faces: Vec<u32> = (0..mesh.face_count() as u32).collect();
                let nothing = Goal::Within(f64::INFINITY);
                let look = Look {
                    goal: &nothing,
                    divided_above: 0,
                    length: 1e-12,
                    changes: None,
                    bulges: None,
                    trusted: &[],
                };
                let planned = |face: u32| found.state.proven[face as usize].extent.bound;
                let measured = measure(&sources, engine.watch, &faces, &look)?;
                let topology = mesh.topology();
                let is_adjacent = |face: &u32| {
                    let corners = topology.triangles()[*face as usize].map(VertexId);
                    corners
                        .iter()
                        .filter(|corner| corner.0 % (SIDE + 1) == SIDE / 2)
                        .count()
                        == 2
                };
                let worst = |face: u32| measured[face as usize].worst.0;
                let rims = faces
                    .iter()
                    .copied()
                    .filter(|&face| flat.region(face).is_some())
                    .filter(is_adjacent);
                let (mut counted, mut assumed) = (0.0f64, 0.0f64);
                for face in rims {
                    (counted, assumed) = (counted.max(worst(face)), assumed.max(planned(face)));
                }
                assert!(assumed > 0.02, "{assumed}");
                match bend == 0.0 {
                    true => assert!(counted < 1e-9, "{counted}"),
                    false => assert!(counted > 0.02, "{counted}"),
                }
                Ok(())
            })
            .unwrap();
        }
    }
}
