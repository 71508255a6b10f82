//! Edge flips that bring the mesh nearer to the surface.

use super::editable_mesh::{EditableMesh, next, previous};
use super::fine_samples::FineSamples;
use super::history::History;
use super::proof::{Change, Prover};
use super::reference::{LEAST_TURN, Reference, Worst, bulge};
use super::star_region::StarRegion;
use super::triangle_plane::Plane;
use crate::mesh::NONE;
use crate::vector::DVec3;

/// A flip must lower the error to this share at most: less is not worth the time, nor sure to be a gain.
const GAIN: f64 = 0.95;

/// Tests edges one after the other.
#[derive(Default)]
pub(super) struct Flipper {
    region: StarRegion,
}

/// The prover of the new faces' distance, that distance, and the record of changes if there is one.
pub(super) type Proof<'p, 't, 's, 'a> = (&'p mut Prover<'t, 's, 'a>, f64, Option<&'p mut History>);

/// The two faces at an edge: their corners counter-clockwise, the edge running from the first to the third.
struct Quadrilateral {
    corners: [u32; 4],
    positions: [DVec3; 4],
    faces: [u32; 2],
}

/// The standard for two new triangles: the existing ones.
#[derive(Clone, Copy)]
struct Standard {
    worst: Worst,
    /// Sum of their unit normals.
    facing: DVec3,
}

/// How well one of the two ways to cut a quadrilateral does.
struct Cut {
    error: f64,
    shape: f64,
}

impl Quadrilateral {
    fn at(h: u32, surface: &EditableMesh, samples: &FineSamples) -> Self {
        let t = surface.twin(h);
        let corners = [
            surface.origin(h),
            surface.origin(previous(t)),
            surface.target(h),
            surface.origin(previous(h)),
        ];
        Self {
            corners,
            positions: corners.map(|v| samples.position(v)),
            faces: [h / 3, t / 3],
        }
    }

    /// The faces across its sides.
    fn around(&self, h: u32, surface: &EditableMesh) -> Vec<u32> {
        let t = surface.twin(h);
        let across = [next(h), previous(h), next(t), previous(t)].map(|side| surface.twin(side));
        across
            .into_iter()
            .filter(|&twin| twin != NONE)
            .map(|twin| twin / 3)
            .collect()
    }

    fn plane(&self, triangle: [usize; 3]) -> Option<Plane> {
        Plane::new(triangle.map(|i| self.positions[i]))
    }

    /// How far the surface bulges over a triangle, by the normals at its corners.
    fn bulge(&self, [i, j, k]: [usize; 3], reference: &Reference<'_>) -> f64 {
        let sagitta = |i: usize, j: usize| {
            reference.sagitta(
                [self.corners[i], self.corners[j]],
                [self.positions[i], self.positions[j]],
            )
        };
        bulge([sagitta(i, j), sagitta(j, k), sagitta(k, i)])
    }

    fn standard(&self, reference: &Reference<'_>) -> Standard {
        let mut standard = Standard {
            worst: Worst::NONE,
            facing: DVec3::ZERO,
        };
        for triangle in BEFORE {
            let plane = self.plane(triangle);
            standard
                .worst
                .add(plane.as_ref(), triangle.map(|i| self.corners[i]), reference);
            standard.facing += plane.map_or(DVec3::ZERO, |plane| plane.normal);
        }
        standard
    }
}

impl Flipper {
    /// Flips the edge of `h` if that lowers the error, or leaves it below `flat` and gives better shaped triangles, and
    /// gives the corners of the faces; `None` if it does not, or if the new faces are not proven to keep the distance that comes
    /// with `proof`.
    pub(super) fn flip(
        &mut self,
        h: u32,
        flat: f64,
        surface: &mut EditableMesh,
        samples: &mut FineSamples,
        reference: &Reference<'_>,
        proof: Option<Proof<'_, '_, '_, '_>>,
    ) -> Option<[u32; 4]> {
        if surface.is_sharp(h) || surface.twin(h) == NONE {
            return None;
        }
        let quadrilateral = Quadrilateral::at(h, surface, samples);
        self.region.clear();
        quadrilateral
            .faces
            .iter()
            .for_each(|&face| self.region.add_face(face, samples));
        quadrilateral
            .corners
            .iter()
            .for_each(|&v| self.region.add_corner(v, samples));
        let before = self.cut(&quadrilateral, BEFORE, f64::INFINITY, None, reference);
        let error = before.as_ref().map_or(f64::INFINITY, |cut| cut.error);
        let bound = if error <= flat {
            flat.next_up()
        } else {
            error * GAIN
        };
        let standard = quadrilateral.standard(reference);
        let after = self.cut(&quadrilateral, AFTER, bound, Some(standard), reference)?;
        let better = error > flat || before.is_none_or(|before| after.shape > before.shape / GAIN);
        if !better || surface.are_neighbours(quadrilateral.corners[1], quadrilateral.corners[3]) {
            return None;
        }
        self.region.assign();
        if let Some((prover, goal, history)) = proof {
            let around = quadrilateral.around(h, surface);
            let around = around.as_slice();
            let change = Change {
                old: &quadrilateral.faces,
                around,
                gone: NONE,
                region: &self.region,
            };
            if !prover.prove(&change, surface, samples, goal) {
                return None;
            }
            prover.commit(&change);
            if let Some(history) = history {
                history.record(
                    &quadrilateral.faces,
                    NONE,
                    self.region.samples(),
                    surface,
                    samples,
                );
            }
        }
        surface.flip(h);
        self.region
            .hand_over(samples, quadrilateral.faces.into_iter());
        Some(quadrilateral.corners)
    }

    /// Measures two triangles of the quadrilateral; `None` if their error is not below `bound`, or
    /// if they do not meet the standard.
    fn cut(
        &mut self,
        quadrilateral: &Quadrilateral,
        triangles: [[usize; 3]; 2],
        bound: f64,
        standard: Option<Standard>,
        reference: &Reference<'_>,
    ) -> Option<Cut> {
        self.region.clear_triangles();
        let (mut estimate, mut shape) = (0.0f64, 1.0f64);
        for (triangle, face) in triangles.into_iter().zip(quadrilateral.faces) {
            let plane = quadrilateral.plane(triangle)?;
            if let Some(Standard { worst, facing }) = standard
                && (plane.normal.dot(facing) < LEAST_TURN
                    || !reference.fits(&plane, triangle.map(|i| quadrilateral.corners[i]), worst))
            {
                return None;
            }
            estimate = estimate.max(quadrilateral.bulge(triangle, reference));
            shape = shape.min(plane.shape);
            self.region
                .add_triangle(plane, triangle.map(|i| quadrilateral.corners[i]), face);
        }
        let error = self.region.forward_error(estimate, bound)?;
        let [a, b] = [0, 1].map(|end| quadrilateral.positions[triangles[0][end]]);
        self.region.probe_edge(a, b);
        let error = error.max(self.region.backward_error(reference));
        (error < bound).then_some(Cut { error, shape })
    }
}

/// The triangles of the quadrilateral (counter-clockwise 0, 1, 2, 3) before the flip, cut from 0 to
/// 2, first the face of the half-edge from 0 to 2; and after it in the same faces. Each begins with
/// the diagonal.
const BEFORE: [[usize; 3]; 2] = [[0, 2, 3], [2, 0, 1]];
const AFTER: [[usize; 3]; 2] = [[3, 1, 2], [1, 3, 0]];

/// All edges of a mesh once, by a half-edge of each.
pub(super) fn edges(surface: &EditableMesh) -> Vec<u32> {
    let lower_half =
        |h: &u32| surface.origin(*h) != NONE && surface.twin(*h) != NONE && *h < surface.twin(*h);
    (0..surface.half_edge_places()).filter(lower_half).collect()
}
