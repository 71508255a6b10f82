//! The report of `limitmesh evaluate` on a place.

use limitmesh::Derivatives;
use serde::Serialize;

use crate::arguments::Place;

/// A place of a limit surface.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct EvaluationReport {
    /// The control mesh's triangle, from 0.
    pub(crate) face: u32,
    /// The file's face that this is, or is a part of.
    pub(crate) input_face: u32,
    /// The weights of the triangle's corners.
    pub(crate) barycentric: [f64; 3],
    /// The point of the limit surface.
    pub(crate) point: [f64; 3],
    /// The unit normal on the face's side; null where there is none.
    pub(crate) normal: Option<[f64; 3]>,
    /// Two unit vectors that span the tangent plane: the directions of the derivatives u and v, and at corners of faces where there are
    /// none the limit tangents of the scheme; null where there is no tangent plane.
    pub(crate) tangents: Option<[[f64; 3]; 2]>,
    /// By the weights of the second and third corner; null where there are none.
    pub(crate) derivatives: Option<DerivativesReport>,
    /// How the surface bends; null where it has no curvature.
    pub(crate) curvature: Option<CurvatureReport>,
}

/// Derivatives by the weights of the second (u) and third corner (v).
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct DerivativesReport {
    /// The first derivative by u.
    pub(crate) u: [f64; 3],
    /// The first derivative by v.
    pub(crate) v: [f64; 3],
    /// The second derivative by u.
    pub(crate) uu: [f64; 3],
    /// The mixed second derivative.
    pub(crate) uv: [f64; 3],
    /// The second derivative by v.
    pub(crate) vv: [f64; 3],
}

/// How the surface bends.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct CurvatureReport {
    /// The product of the principal curvatures.
    pub(crate) gaussian: f64,
    /// Half the sum of the principal curvatures.
    pub(crate) mean: f64,
    /// The greatest and the least curvature.
    pub(crate) principal: [f64; 2],
    /// Their unit directions.
    pub(crate) directions: [[f64; 3]; 2],
}

impl EvaluationReport {
    /// `limits` are the point and the normal, `corner` the tangents, that hold where there are no derivatives.
    pub(crate) fn new(
        Place { face, weights }: Place,
        input_face: u32,
        limits: limitmesh::SurfacePoint,
        corner: Option<[[f64; 3]; 2]>,
        derivatives: Option<Derivatives>,
    ) -> Self {
        let limit_normal = (limits.normal != [0.0; 3]).then_some(limits.normal);
        Self {
            face,
            input_face,
            barycentric: weights,
            point: derivatives.map_or(limits.position, |derivatives| derivatives.position),
            normal: derivatives
                .and_then(|derivatives| derivatives.normal())
                .or(limit_normal),
            tangents: derivatives
                .and_then(|derivatives| derivatives.tangents())
                .or(corner),
            derivatives: derivatives.map(
                |Derivatives {
                     first: [u, v],
                     second: [uu, uv, vv],
                     ..
                 }| { DerivativesReport { u, v, uu, uv, vv } },
            ),
            curvature: derivatives
                .and_then(|derivatives| derivatives.curvature())
                .map(|own| CurvatureReport {
                    gaussian: own.gaussian,
                    mean: own.mean,
                    principal: own.principal,
                    directions: own.directions,
                }),
        }
    }
}
