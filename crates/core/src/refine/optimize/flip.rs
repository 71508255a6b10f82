//! Edge flips that bring the mesh nearer to the surface.

use super::ground::{Ground, LEAST_TURN, Worst, bulge};
use super::plane::Plane;
use super::region::Region;
use super::samples::Samples;
use super::surface::{Surface, previous};
use crate::mesh::NONE;
use crate::vector::DVec3;

/// A flip must lower the error to this share at most: less is not worth the time, nor sure to be a gain.
const GAIN: f64 = 0.95;

/// The two faces at an edge, and the other diagonal of their quadrilateral.
#[derive(Default)]
pub(super) struct Flipper {
    region: Region,
}

/// One of the two ways to cut a quadrilateral.
struct Cut {
    error: f64,
    shape: f64,
}

impl Flipper {
    /// Flips the edge of `h` if that lowers the error, or leaves it below `flat` and gives better shaped triangles. `None`
    /// if it does not.
    pub(super) fn flip(
        &mut self,
        h: u32,
        flat: f64,
        surface: &mut Surface,
        samples: &mut Samples,
        ground: &Ground<'_>,
    ) -> Option<[u32; 4]> {
        let t = surface.twin(h);
        if surface.is_sharp(h) || t == NONE {
            return None;
        }
        let corners =
            [surface.origin(h), surface.origin(previous(t)), surface.target(h), surface.origin(previous(h))];
        let positions = corners.map(|v| samples.position(v));
        self.region.clear();
        let faces = [h / 3, t / 3];
        for face in faces {
            self.region.add_face(face, samples);
        }
        for v in corners {
            self.region.add_corner(v, samples);
        }
        // Where estimates have proved wrong they are no reason to change what is there.
        if self.region.reserve() > 0.0 {
            return None;
        }
        let mut worst = Worst::NONE;
        for [i, j, k] in BEFORE {
            let plane = Plane::new([positions[i], positions[j], positions[k]]);
            worst.add(plane.as_ref(), [corners[i], corners[j], corners[k]], ground);
        }
        let before = self.cut(BEFORE, corners, positions, faces, f64::INFINITY, None, ground);
        let error = before.as_ref().map_or(f64::INFINITY, |cut| cut.error);
        let bound = if error <= flat { flat.next_up() } else { error * GAIN };
        let after = self.cut(AFTER, corners, positions, faces, bound, Some(worst), ground)?;
        let better = error > flat || before.is_none_or(|before| after.shape > before.shape / GAIN);
        if !better || surface.are_neighbours(corners[1], corners[3]) {
            return None;
        }
        surface.flip(h);
        // The flip puts the triangle behind the edge's target into the face of `h`.
        self.region.hand_over(samples, faces.into_iter());
        Some(corners)
    }

    /// Looks at two triangles of the quadrilateral; `None` if their error is not below `bound`, or, where `worst` says
    /// what is allowed, if they do not stand well.
    #[allow(clippy::too_many_arguments)]
    fn cut(
        &mut self,
        triangles: [[usize; 3]; 2],
        corners: [u32; 4],
        positions: [DVec3; 4],
        faces: [u32; 2],
        bound: f64,
        worst: Option<Worst>,
        ground: &Ground<'_>,
    ) -> Option<Cut> {
        self.region.clear_triangles();
        let mut estimate = 0.0f64;
        let mut shape = 1.0f64;
        for ([i, j, k], face) in triangles.into_iter().zip(faces) {
            let plane = Plane::new([positions[i], positions[j], positions[k]])?;
            if let Some(worst) = worst
                && !ground.fits(&plane, [corners[i], corners[j], corners[k]], worst)
            {
                return None;
            }
            let sagitta =
                |i: usize, j: usize| ground.sagitta([corners[i], corners[j]], [positions[i], positions[j]]);
            estimate = estimate.max(bulge([sagitta(i, j), sagitta(j, k), sagitta(k, i)]));
            shape = shape.min(plane.shape);
            self.region.add_triangle(plane, face);
        }
        if let (Some(_), [a, b]) = (worst, self.region.planes())
            && a.normal.dot(b.normal) < LEAST_TURN
        {
            return None;
        }
        let error = self.region.forward_error(estimate, bound)?;
        let [[a, b, ..], _] = triangles;
        self.region.probe_edge(positions[a], positions[b]);
        let error = error.max(self.region.backward_error(ground));
        (error < bound).then_some(Cut { error, shape })
    }
}

/// The triangles of the quadrilateral (counter-clockwise 0, 1, 2, 3) as they are, cut from 0 to 2, first the face of the
/// half-edge from 0 to 2; and as the flip leaves them in the same faces. Each begins with the diagonal.
const BEFORE: [[usize; 3]; 2] = [[0, 2, 3], [2, 0, 1]];
const AFTER: [[usize; 3]; 2] = [[3, 1, 2], [1, 3, 0]];

/// All edges of a mesh once, by a half-edge of each.
pub(super) fn edges(surface: &Surface) -> Vec<u32> {
    let lower_half =
        |h: &u32| surface.origin(*h) != NONE && surface.twin(*h) != NONE && *h < surface.twin(*h);
    (0..surface.half_edge_places()).filter(lower_half).collect()
}
