//! Moves vertices off the limit surface by half of what the triangles miss, so that the error lies on both sides.
//!
//! Triangles with their corners on a convex surface lie inside it by up to e; with the corners moved out by e/2 both
//! sides have e/2 (mathematically: the midpoint of the heights' range is moved to 0). Where a surface bends both ways, and on
//! boundaries and sharp edges, vertices stay.

use super::decide::Control;
use super::emit::Emission;
use super::emitted::{Beholder, Emitted, Over, Sources};
use crate::certificate::TriangleFrame;
use crate::patch::Rules;
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::vector;

/// Levels below a leaf whose vertices are sampled where a piece is not regular.
const SAMPLED_LEVELS: usize = 2;

/// Control faces that one call takes together.
const BLOCK: usize = 64;

/// The middles of the heights of the surface over the triangles, whose corners lie on it, by control face.
#[derive(Default)]
pub(super) struct Bulges(Vec<Vec<f64>>);

impl Bulges {
    /// Looks at the triangles of some control faces.
    pub(super) fn look(
        &mut self,
        sources: &Sources<'_>,
        watch: &SharedWatch<'_>,
        faces: &[u32],
    ) -> Result<(), Cancelled> {
        let emission = sources.emission;
        self.0.resize_with(emission.starts.len() - 1, Vec::new);
        let found = watch.long_pieces(faces.len(), BLOCK, |block, is_stopped| {
            let found = faces[block].iter().map(|&face| {
                let triangles = emission.triangles_of(face);
                let found = vec![0.0; triangles.len()];
                let mut looking = Looking { emission, first: triangles.start as u32, found };
                sources.show(face, is_stopped, &mut looking);
                looking.found
            });
            found.collect::<Vec<_>>()
        })?;
        watch.each(faces.iter().zip(found.into_iter().flatten()), |(&face, found)| {
            self.0[face as usize] = found;
        })
    }

    /// How far each vertex is to be moved along its normal: the average over the triangles around.
    pub(super) fn offsets(
        &self,
        control: &Control<'_>,
        emission: &Emission,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<f64>, Cancelled> {
        let mut sums = vec![(0.0f64, 0u32); emission.positions.len()];
        watch.each(emission.triangles.iter().zip(self.0.iter().flatten()), |(triangle, bulge)| {
            for &vertex in triangle {
                let sum = &mut sums[vertex as usize];
                *sum = (sum.0 + bulge, sum.1 + 1);
            }
        })?;
        let mut offsets = Vec::with_capacity(sums.len());
        watch.each(sums, |(sum, triangles)| offsets.push(sum / f64::from(triangles.max(1))))?;
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

/// Looks at the triangles of a control face.
struct Looking<'a> {
    emission: &'a Emission,
    first: u32,
    found: Vec<f64>,
}

impl Beholder for Looking<'_> {
    fn triangle<'p>(&mut self, emitted: &Emitted, over: Over<'_, 'p>, rules: &'p Rules<'p>) {
        let corners = emitted.vertices.map(|vertex| vector(self.emission.positions[vertex as usize]));
        let frame = TriangleFrame::new(corners);
        let (low, high) = match over {
            Over::Regular(ground, cell, _) => ground.jet().heights(&cell, frame.normal()).sampled([0.0; 3]),
            Over::General(pieces, _) => {
                let points = pieces.points(SAMPLED_LEVELS, rules).into_iter();
                let inside =
                    points.filter(|&point| (0..3).all(|edge| frame.beside(edge, point).outside <= 0.0));
                let heights = inside.map(|point| frame.height(point));
                heights.fold((0.0f64, 0.0f64), |(low, high), height| (low.min(height), high.max(height)))
            }
        };
        self.found[(emitted.number - self.first) as usize] = 0.5 * (low + high);
    }
}
