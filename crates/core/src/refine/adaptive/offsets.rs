//! Moves vertices off the limit surface by half of what the triangles miss, so that the error lies on both sides.
//!
//! Triangles with their corners on a convex surface lie inside it by up to e; with the corners moved out by e/2 both
//! sides have e/2. Let heights over a triangle lie between l ≤ 0 ≤ h while its corners are on the surface. With all three moved by
//! x they lie between l − x and h − x, so for errors of at most e each corner's x has to be between h − e and l + e. A vertex that is
//! between these for all triangles around it stays so when some of them are divided: then the ranges shrink. Else a division would
//! make the adjacent triangles fail, these their adjacent ones, and so on, one a round. For the same reason it stays where it was put, as
//! long as that is good enough: then triangles that were measured need not be measured again.
//!
//! Where a surface bends both ways in the same way, and on boundaries and sharp edges, vertices stay. Triangles that no camera sees have no
//! say: they may be much coarser than adjacent ones, which would fail where these pass.

use super::bulges::Bulges;
use super::control::Control;
use super::emit::Emission;
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::Extremes;

impl Bulges {
    /// How far each vertex is to be moved along its normal: by the mean of the middles around, or as near to that as leaves all
    /// heights around well within `allowed`; where nothing does, to the middle of them all; or as far as before. With the control faces
    /// whose vertices may be moved otherwise than when those of the emission before were.
    pub(super) fn offsets(
        &self,
        control: &Control<'_>,
        emission: &mut Emission,
        allowed: f64,
        watch: &SharedWatch<'_>,
    ) -> Result<(Vec<f64>, Vec<u32>), Cancelled> {
        let last = emission.offsets_before();
        let faces = self.0.len() as u32;
        let may_change =
            |face: &u32| last.is_none() || emission.is_new(*face) || self.0[*face as usize].waits;
        let changing: Vec<u32> = (0..faces).filter(may_change).collect();
        let mut offsets =
            last.unwrap_or_else(|| limitmesh_pages::defaults(emission.positions.len()));
        let around = self.around(control, emission, &changing, &mut offsets, watch)?;
        watch.each(&changing, |&face| {
            for vertex in emission.vertices_of(face) {
                if let Some(around) = around.of(vertex) {
                    offsets[vertex as usize] = around.offset(allowed);
                }
            }
        })?;
        watch.each(&changing, |&face| {
            let open = control.open(face);
            for edge in (0..3).filter(|&edge| open[edge as usize]) {
                for &h in emission.borders.along(3 * face + edge) {
                    let triangle = emission.triangles[h as usize / 3];
                    (0..2).for_each(|end| offsets[triangle[(h as usize + end) % 3] as usize] = 0.0);
                }
            }
        })?;
        // Corners and darts inside a face's reach; and copies, which would part.
        control
            .infinitely_sharp
            .tagged_vertices()
            .for_each(|vertex| offsets[vertex.index()] = 0.0);
        let copies = emission.junctions.vertices.iter().flatten();
        copies.for_each(|&vertex| offsets[vertex as usize] = 0.0);
        Ok((offsets, changing))
    }

    /// The heights around the vertices of some control faces where not all triangles were there before; other vertices there are moved as
    /// far as they were with these.
    fn around(
        &self,
        control: &Control<'_>,
        emission: &Emission,
        faces: &[u32],
        offsets: &mut [f64],
        watch: &SharedWatch<'_>,
    ) -> Result<AllAround, Cancelled> {
        let mut around = AllAround::none(emission.positions.len());
        let triangles_of = |face: u32| {
            (
                &emission.triangles[emission.triangles_of(face)],
                &self.0[face as usize],
            )
        };
        watch.each(faces, |&face| {
            let (triangles, bulge) = triangles_of(face);
            if bulge.waits {
                let all = triangles.iter().zip(bulge.offsets_last());
                all.filter(|(_, last)| last[0].is_nan())
                    .for_each(|(triangle, _)| {
                        triangle
                            .iter()
                            .for_each(|&vertex| around.add_vertex(vertex))
                    });
            }
        })?;
        let mut is_corner = vec![false; control.mesh.vertex_count()];
        let corners =
            |face: u32| control.mesh.triangles()[face as usize].map(|vertex| vertex as usize);
        watch.each(faces, |&face| {
            corners(face)
                .into_iter()
                .for_each(|corner| is_corner[corner] = true)
        })?;
        watch.each(0..self.0.len() as u32, |face| {
            if !corners(face).into_iter().any(|corner| is_corner[corner]) {
                return;
            }
            let (triangles, bulge) = triangles_of(face);
            for ((triangle, last), range) in triangles
                .iter()
                .zip(bulge.offsets_last())
                .zip(&bulge.ranges)
            {
                for (&vertex, offset) in triangle.iter().zip(last) {
                    match around.of_mut(vertex) {
                        Some(around) => around.add(*range, offset),
                        None => offsets[vertex as usize] = offset,
                    }
                }
            }
        })?;
        Ok(around)
    }
}

/// The heights around some vertices.
struct AllAround {
    /// By vertex its number among them, counted from 1; 0 for others.
    numbers: Vec<u32>,
    around: Vec<Around>,
}

impl AllAround {
    /// None of so many.
    fn none(vertices: usize) -> Self {
        Self {
            numbers: limitmesh_pages::defaults(vertices),
            around: Vec::new(),
        }
    }

    fn add_vertex(&mut self, vertex: u32) {
        let number = &mut self.numbers[vertex as usize];
        if *number == 0 {
            self.around.push(Around::NOTHING);
            *number = self.around.len() as u32;
        }
    }

    fn of_mut(&mut self, vertex: u32) -> Option<&mut Around> {
        self.around
            .get_mut((self.numbers[vertex as usize] as usize).wrapping_sub(1))
    }

    fn of(&self, vertex: u32) -> Option<&Around> {
        self.around
            .get((self.numbers[vertex as usize] as usize).wrapping_sub(1))
    }
}

/// The heights over the triangles around a vertex.
#[derive(Clone, Copy)]
struct Around {
    low: f64,
    high: f64,
    /// Of twice the middles.
    sum: f64,
    triangles: u32,
    /// How far the vertex was moved before; not a number if it was not.
    before: f64,
}

impl Around {
    const NOTHING: Self = Self {
        low: 0.0,
        high: 0.0,
        sum: 0.0,
        triangles: 0,
        before: f64::NAN,
    };

    /// Adds the heights over a triangle, where it has a say, and how far the vertex was moved with it.
    fn add(&mut self, [low, high]: [f64; 2], before: f64) {
        if !before.is_nan() {
            self.before = before;
        }
        if !low.is_finite() {
            return;
        }
        (self.low, self.high) = (self.low.smaller(low), self.high.larger(high));
        self.sum += low + high;
        self.triangles += 1;
    }

    /// How far to move the vertex.
    fn offset(&self, allowed: f64) -> f64 {
        // They stay where they were moved before where all heights around are within three quarters.
        let (stays, before) = (0.75 * allowed, self.before);
        if self.high - stays <= before && before <= self.low + stays {
            return before;
        }
        // Vertices move no farther than they have to where all heights around can be within half of what is allowed.
        let easy = 0.5 * allowed;
        let (least, most) = (self.high - easy, self.low + easy);
        if least <= most {
            (0.5 * self.sum / f64::from(self.triangles.max(1)))
                .max(least)
                .min(most)
        } else {
            0.5 * (self.low + self.high)
        }
    }
}
