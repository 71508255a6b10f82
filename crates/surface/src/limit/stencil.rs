//! The limit stencil of a ring: weights of the limit position and of two limit tangents, with their
//! eigenvalues.
//!
//! Computed by the analysis of closed and open rings; used by the evaluation on meshes.

use core::f64::consts::{FRAC_PI_3, PI, TAU};

use super::complex::Complex;
use crate::math;
use crate::ring::RingShape;
use crate::scheme::Support;
use crate::vector::DVec3;

/// The plane that the tangents of a stencil span.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum TangentPlane {
    /// The tangent plane of the limit surface: the normals of all faces at the vertex tend to its normal.
    Surface,
    /// The plane that the surface approaches along the boundary curve. The normals of the two faces on the
    /// boundary tend to its normal, those of other faces need not: the surface is not smooth at this vertex.
    ///
    /// Loop's rules have it at boundary vertices with seven or more edges, where two patterns of
    /// the interior neighbours shrink no faster than the boundary curve.
    BoundaryRibbon,
    /// None: no two patterns of differences dominate all the others.
    None,
}

/// Limit weights of a vertex by the shape of its ring.
///
/// Points are ordered as in the rows of [`super::ring_matrix`]: the vertex, its ring counter-clockwise, and for
/// a scheme with [`Support::TwoRing`] the points beyond and across (of the once refined neighbourhood).
#[derive(Clone, Debug, PartialEq)]
pub struct LimitStencil {
    pub(super) shape: RingShape,
    pub(super) support: Support,
    pub(super) position: Vec<f64>,
    /// Weights of both tangents on the differences to the vertex; empty without a tangent plane.
    pub(super) tangents: Vec<[f64; 2]>,
    pub(super) plane: TangentPlane,
    pub(super) eigenvalues: [f64; 2],
    pub(super) next_eigenvalue: f64,
}

impl LimitStencil {
    /// The ring of the weights.
    pub fn shape(&self) -> RingShape {
        self.shape
    }

    /// Whether the weights are for the one-ring or the two-ring.
    pub fn support(&self) -> Support {
        self.support
    }

    /// Weights of the limit position, the vertex's first; they sum to 1. They are the left
    /// eigenvector of the ring matrix for the eigenvalue 1.
    pub fn position_weights(&self) -> &[f64] {
        &self.position
    }

    /// Weights `[u_i, w_i]` of two tangents, on the differences `d_i = v_i − v` of all points but the vertex: the
    /// normal is `(Σ u_i d_i) × (Σ w_i d_i)`, outward for counter-clockwise rings. `None` without a tangent plane.
    ///
    /// They are left eigenvectors of the difference matrix. In a closed ring they are scaled so that
    /// `u_j + i·w_j = e^{2πij/k}` on the ring of a scheme with one-ring support and real eigenvalues, in an open
    /// ring so that the first has 1 and −1 at the boundary neighbours and the second the length √((k−1)/2) on
    /// the other neighbours.
    pub fn tangent_weights(&self) -> Option<&[[f64; 2]]> {
        (!self.tangents.is_empty()).then_some(&self.tangents[..])
    }

    /// The plane or line that the tangents span.
    pub fn tangent_plane(&self) -> TangentPlane {
        self.plane
    }

    /// Moduli of the eigenvalues of the two tangents: their factors in each refinement. 0 without a
    /// tangent plane.
    pub fn tangent_eigenvalues(&self) -> [f64; 2] {
        self.eigenvalues
    }

    /// The greatest modulus among the other eigenvalues of the difference matrix; the normals of the faces
    /// converge like powers of its ratio to the smaller tangent eigenvalue. 0 without a tangent plane.
    pub fn next_eigenvalue(&self) -> f64 {
        self.next_eigenvalue
    }

    /// Weights of all pairs of differences, as in the paper's equation (10) with the left eigenvector: the normal
    /// is `Σ_{i<j} W_l d_i × d_j` with `l` counting the pairs (1,2), (1,3), …, (2,3), … . `None` without a
    /// tangent plane.
    ///
    /// `W = u_i w_j − u_j w_i`; for Loop's scheme that is sin(2π(j−i)/k).
    pub fn normal_weights(&self) -> Option<Vec<f64>> {
        let tangents = self.tangent_weights()?;
        let pair =
            |i: usize, j: usize| tangents[i][0] * tangents[j][1] - tangents[j][0] * tangents[i][1];
        let n = tangents.len();
        Some(
            (0..n)
                .flat_map(|i| (i + 1..n).map(move |j| pair(i, j)))
                .collect(),
        )
    }

    /// A stencil that has a limit position only.
    pub(super) fn without_tangents(shape: RingShape, support: Support, position: Vec<f64>) -> Self {
        Self {
            shape,
            support,
            position,
            tangents: Vec::new(),
            plane: TangentPlane::None,
            eigenvalues: [0.0; 2],
            next_eigenvalue: 0.0,
        }
    }

    /// Turns the tangents so that their cross product points outwards on a convex fan; without a clear answer
    /// there (a fold, a double winding) they span no plane that has an outside, and are dropped.
    pub(super) fn oriented(mut self) -> Self {
        let (mut tangents, mut scale) = ([DVec3::ZERO; 2], [0.0; 2]);
        for (point, weights) in convex_fan(self.shape, self.support)
            .into_iter()
            .zip(&self.tangents)
        {
            for (axis, &weight) in weights.iter().enumerate() {
                tangents[axis] += weight * point;
                scale[axis] += weight.abs();
            }
        }
        let area = tangents[0].cross(tangents[1]).z;
        // Symmetric rings that fold cancel to rounding; the fans of all usual schemes give some tenths.
        if area.abs() <= 1e-9 * scale[0] * scale[1] {
            return Self::without_tangents(self.shape, self.support, self.position);
        }
        if area < 0.0 {
            self.tangents.iter_mut().for_each(|pair| pair[1] = -pair[1]);
        }
        self
    }
}

/// A planar, convex, counter-clockwise neighbourhood of the origin, without the origin: 60° a face, at most the
/// full circle, half of it at a boundary and a third at a corner of it (where a half would be degenerate).
fn convex_fan(shape: RingShape, support: Support) -> Vec<DVec3> {
    let (k, faces) = (shape.valence as usize, shape.faces() as usize);
    let whole = match (shape.open, shape.corner) {
        (false, _) => TAU,
        (true, false) => (FRAC_PI_3 * faces as f64).min(PI),
        (true, true) => (FRAC_PI_3 * faces as f64).min(2.0 * FRAC_PI_3),
    };
    let spoke = |j: usize| {
        let (sine, cosine) = math::sin_cos(whole * (j % k) as f64 / faces as f64);
        DVec3::new(cosine, sine, 0.0)
    };
    let mut points: Vec<DVec3> = (0..k).map(spoke).collect();
    if support == Support::TwoRing {
        points.extend((0..k).map(|j| 2.0 * spoke(j)));
        points.extend((0..faces).map(|j| spoke(j) + spoke(j + 1)));
    }
    points
}

/// Whether two moduli are the same up to rounding, relative to the greater. The least gap that a smooth scheme
/// shows is about 15/k² (Loop), so that valences up to a million keep their tangents.
pub(super) fn same_modulus(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.max(b)
}

/// Whether an eigenvalue is real up to rounding.
pub(super) fn is_real(value: Complex) -> bool {
    value.im.abs() <= 1e-12 * value.modulus()
}
