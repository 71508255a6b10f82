//! First and second derivatives of the limit surface, and its curvature.
//!
//! Pieces are refined towards a place until its part is a polynomial, as in [`super`], whose
//! derivatives are those of the control face's barycentric coordinates times a factor of 2 a level,
//! −2 in middle parts, which are inverted. Near an irregular vertex the differences are far smaller
//! than the coordinates themselves: so at each level the piece is moved to the origin, and the
//! weights that are small are kept, not those near 1.
//!
//! Curvature follows from the first and second fundamental forms (do Carmo, Differential Geometry of Curves and Surfaces, 3-3).

use super::LimitSurface;
use crate::index::{FaceId, HalfEdgeId};
use crate::math;
use crate::parallel;
use crate::patch::polynomial::Polynomial;
use crate::patch::{Patch, root_patch};
use crate::vector::{DVec3, unit_or_zero, vector};

/// Levels after which a place counts as the irregular vertex that it is next to.
const DEEPEST: u32 = 200;

/// Places that are evaluated together.
const BLOCK: usize = 256;

/// A point of a limit surface with its derivatives by the weights of its control face's second and third corner, where that of the first
/// is 1 minus both; on the face's own side of sharp edges.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derivatives {
    /// The position, in the control mesh's units.
    pub position: [f64; 3],
    /// The derivatives by the second corner's weight and by the third's.
    pub first: [[f64; 3]; 2],
    /// The derivatives by the second corner's weight twice, by both, and by the third's twice.
    pub second: [[f64; 3]; 3],
}

/// How a surface bends at a point. Where normals point outwards, curvatures of convex places are below 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Curvature {
    /// The product of the principal curvatures, in 1 / unit².
    pub gaussian: f64,
    /// Their mean, in 1 / unit.
    pub mean: f64,
    /// The greatest and the least curvature of curves through the point that the normal's planes cut out, in 1 / unit.
    pub principal: [f64; 2],
    /// The unit directions of these curves; any two at right angles where the surface bends alike in all.
    pub directions: [[f64; 3]; 2],
}

impl Derivatives {
    /// The unit normal, on the side from which the face's corners run counter-clockwise; `None` where the derivatives span no plane.
    pub fn normal(&self) -> Option<[f64; 3]> {
        // Both lengths may be close to zero near an irregular vertex.
        let [along, across] = self.first.map(|first| unit_or_zero(vector(first)));
        let normal = unit_or_zero(along.cross(across));
        (normal != DVec3::ZERO).then(|| normal.to_array())
    }

    /// The unit directions of both first derivatives; `None` where they span no plane.
    pub fn tangents(&self) -> Option<[[f64; 3]; 2]> {
        self.normal().map(|_| {
            self.first
                .map(|first| unit_or_zero(vector(first)).to_array())
        })
    }

    /// How the surface bends; `None` where the derivatives span no plane.
    pub fn curvature(&self) -> Option<Curvature> {
        let normal = vector(self.normal()?);
        let [by_u, by_v] = self.first.map(vector);
        // In orthonormal directions of the tangent plane the shape operator is symmetric, and the
        // products are of similar size.
        let along = unit_or_zero(by_u);
        let across = normal.cross(along);
        let [uu, uv, vv] = self.second.map(|second| vector(second).dot(normal));
        // (along, across) in terms of the parameters: along = by_u / |by_u|, across = (by_v − shear · by_u) / height.
        let (length, height) = (by_u.length(), by_v.dot(across));
        let shear = by_v.dot(along) / length;
        let a = uu / (length * length);
        let b = (uv - shear * uu) / (length * height);
        let d = (vv - 2.0 * shear * uv + shear * shear * uu) / (height * height);
        let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
        let radius = math::hypot(half, b);
        let gaussian = a * d - b * b;
        if !(mean.is_finite() && gaussian.is_finite() && radius.is_finite()) {
            return None;
        }
        let angle = 0.5 * math::atan2(b, half);
        let first = math::cos(angle) * along + math::sin(angle) * across;
        let directions = [first, normal.cross(first)].map(|direction| direction.to_array());
        Some(Curvature {
            gaussian,
            mean,
            principal: [mean + radius, mean - radius],
            directions,
        })
    }
}

impl LimitSurface<'_> {
    /// The derivatives at a place of a control face, given by barycentric coordinates: weights of
    /// its corners that add up to 1, of which the two least are used. `None` where there are none:
    /// at irregular vertices, for schemes but the Loop family and Catmull–Clark, where a weight is below 0 or
    /// NaN, and on faces that do not exist.
    ///
    /// Near an irregular vertex of valence 3 or above 6 curvature grows without bound, near one of 4 or 5 it depends on the direction
    /// from there; half of a curvature's digits are lost 2⁻¹³ of a face away from one of valence 3, 2⁻²³ from 5, and 2⁻³⁴ from 12.
    ///
    /// ```
    /// use limitmesh_surface::{FaceId, LimitSurface, Mesh, scheme::Loop};
    ///
    /// let mesh = Mesh::from_triangles(
    ///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
    ///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
    /// )?;
    /// let surface = LimitSurface::new(&mesh, &Loop)?;
    /// let middle = surface.derivatives(FaceId(0), [0.5, 0.5, 0.0]).ok_or("no vertex")?;
    /// let bend = middle.curvature().ok_or("a plane")?;
    /// assert!((bend.gaussian - 15.75).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn derivatives(&self, face: FaceId, barycentric: [f64; 3]) -> Option<Derivatives> {
        (face.index() < self.mesh.face_count())
            .then(|| self.derivatives_on(face, &[barycentric]).pop())??
    }

    /// Two unit vectors that span the tangent plane at a corner of a control face, by the scheme's
    /// limit masks: also at irregular vertices, where there are no derivatives, and for any
    /// scheme. Their cross product points to the side from which the face's
    /// corners run counter-clockwise. Away from boundaries and sharp edges the first is the
    /// direction in which the surface leaves the vertex over the face's edge to the next corner.
    ///
    /// `None` where there is no tangent plane, where the place, given by barycentric coordinates,
    /// is no corner, and on faces that do not exist.
    pub fn tangents_at_corner(&self, face: FaceId, barycentric: [f64; 3]) -> Option<[[f64; 3]; 2]> {
        let corner = nearest(barycentric);
        let is_corner = (1..3).all(|step| barycentric[(corner + step) % 3] == 0.0);
        if !is_corner || face.index() >= self.mesh.face_count() {
            return None;
        }
        let (table, corner) = (self.rules.table(), HalfEdgeId::of(face, corner));
        let found = table.tangents_at(self.mesh, &self.sharpness, corner);
        found.map_err(|why| self.rules.fail(why)).ok().flatten()
    }

    /// The derivatives at places of many faces, in order, on all threads. Consecutive places of one
    /// face share its work.
    pub fn derivatives_at(&self, places: &[(FaceId, [f64; 3])]) -> Vec<Option<Derivatives>> {
        let blocks = parallel::pieces_of(places.len(), BLOCK, |block| {
            let mut found = Vec::with_capacity(block.len());
            for own in places[block].chunk_by(|a, b| a.0 == b.0) {
                let at: Vec<[f64; 3]> = own.iter().map(|&(_, at)| at).collect();
                match own[0].0 {
                    face if face.index() < self.mesh.face_count() => {
                        found.extend(self.derivatives_on(face, &at));
                    }
                    _ => found.extend(at.iter().map(|_| None)),
                }
            }
            found
        });
        blocks.concat()
    }

    fn derivatives_on(&self, face: FaceId, places: &[[f64; 3]]) -> Vec<Option<Derivatives>> {
        if !self.is_certified() {
            return vec![None; places.len()];
        }
        let patch = root_patch(self.mesh, &self.sharpness, &self.large, face, &self.rules);
        places
            .iter()
            .map(|&place| self.derivatives_over(&patch, weights_in_order(place)?))
            .collect()
    }

    fn derivatives_over(&self, patch: &Patch, mut weights: [f64; 3]) -> Option<Derivatives> {
        let (mut scale, mut origin) = (1.0, DVec3::ZERO);
        let mut own: Option<Patch> = None;
        for _ in 0..DEEPEST {
            let patch = own.as_ref().unwrap_or(patch);
            if matches!(patch, Patch::Regular(_) | Patch::Bicubic(_)) {
                let mut patch = patch.clone();
                let moved = patch.moved_to_origin();
                let (piece, [_, u, v]) = (Polynomial::of(&patch)?, weights);
                return Some(Derivatives {
                    position: (origin + moved + piece.point(u, v)).to_array(),
                    first: piece.tangents(u, v).map(|by| (scale * by).to_array()),
                    second: piece
                        .second_derivatives(u, v)
                        .map(|by| (scale * scale * by).to_array()),
                });
            }
            let nearest = nearest(weights);
            // A weight of 1 may be rounded, those of 0 are not.
            let is_corner = weights[(nearest + 1) % 3] == 0.0 && weights[(nearest + 2) % 3] == 0.0;
            if is_corner && patch.is_irregular_at(nearest) {
                return None;
            }
            let part = if weights[nearest] >= 0.5 { nearest } else { 3 };
            (weights, scale) = in_part(weights, part, scale);
            let mut next = patch.refined(&self.rules).part(part);
            origin += next.moved_to_origin();
            own = Some(next);
        }
        None
    }
}

/// The corner with the greatest weight.
fn nearest(weights: [f64; 3]) -> usize {
    (1..3).fold(0, |most, corner| {
        if weights[corner] > weights[most] {
            corner
        } else {
            most
        }
    })
}

/// Weights of which the greatest is 1 minus the others; `None` where one is below 0 or NaN.
fn weights_in_order(mut weights: [f64; 3]) -> Option<[f64; 3]> {
    if !weights
        .iter()
        .all(|&weight| weight >= 0.0 && weight.is_finite())
    {
        return None;
    }
    let most = nearest(weights);
    let rest = weights[(most + 1) % 3] + weights[(most + 2) % 3];
    weights[most] = 1.0 - rest;
    (rest <= 1.0).then_some(weights)
}

/// Where a place is in a part that holds it, and the factor of first derivatives there.
fn in_part(weights: [f64; 3], part: usize, scale: f64) -> ([f64; 3], f64) {
    match part {
        3 => (weights.map(|weight| 1.0 - 2.0 * weight), -2.0 * scale),
        _ => {
            let mut own = weights.map(|weight| 2.0 * weight);
            own[part] = 1.0 - own[(part + 1) % 3] - own[(part + 2) % 3];
            (own, 2.0 * scale)
        }
    }
}
