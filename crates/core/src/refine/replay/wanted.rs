//! The places on the limit surface of a refined mesh's vertices and of its normals on sides of
//! sharp edges: at control vertices, or at places over control faces.

use std::collections::HashMap;

use super::ReplayError;
use super::weights::ParamPoint;
use crate::index::{FaceId, HalfEdgeId};
use crate::limit::VertexStencils;
use crate::mesh::Mesh;
use crate::refine::Traced;
use crate::refine::exact_result::{Exact, Origin};

/// A point on the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum EvalPoint {
    /// At a control vertex, on the side of that number.
    Corner(u32, u32),
    /// Over a control face, by the bits of both weights.
    Over(u32, [u64; 2]),
}

/// All requested points.
#[derive(Debug, Default)]
pub(super) struct Wants {
    /// The places of the vertices, by their numbers, then others.
    pub(super) points: Vec<EvalPoint>,
    /// The half-edges of [`Exact::sides`], and the points of their normals.
    pub(super) sides: Vec<(u32, u32)>,
    /// Vertices with several sides, and the points of these.
    pub(super) averages: Vec<(u32, Vec<u32>)>,
}

impl EvalPoint {
    /// The weights of the second and the third corner.
    pub(super) fn place(bits: [u64; 2]) -> ParamPoint {
        bits.map(f64::from_bits)
    }

    /// The place of a point of the control mesh.
    fn of(control: &Mesh, stencils: &VertexStencils<'_>, origin: &Origin) -> Option<Self> {
        let corners = control.triangles().get(origin.face as usize)?;
        let [_, u, v] = origin.barycentric;
        match origin.barycentric.iter().position(|&weight| weight == 1.0) {
            Some(corner) => {
                let h = HalfEdgeId::of(FaceId(origin.face), corner);
                Some(Self::Corner(corners[corner], stencils.side_of(h)))
            }
            None if u >= 0.0 && v >= 0.0 && u + v <= 1.0 => {
                Some(Self::Over(origin.face, [u, v].map(f64::to_bits)))
            }
            None => None,
        }
    }
}

impl Wants {
    /// The values needed by the vertices and sides of `refined`, a refinement of `control`.
    pub(super) fn of(
        control: &Mesh,
        stencils: &VertexStencils<'_>,
        refined: &Exact,
    ) -> Result<Self, ReplayError> {
        let count = refined.mesh.vertex_count();
        if refined.origins.len() != count {
            return Err(ReplayError::NoOrigins {
                origins: refined.origins.len(),
                vertices: count,
            });
        }
        let point = |(vertex, origin): (u32, &Origin)| {
            EvalPoint::of(control, stencils, origin).ok_or(ReplayError::Elsewhere { vertex })
        };
        let points = (0..)
            .zip(&refined.origins)
            .map(point)
            .collect::<Result<Vec<_>, _>>()?;
        let mut wants = Self {
            points,
            ..Self::default()
        };
        wants.add_sides(control, stencils, refined)?;
        Ok(wants)
    }

    fn add_sides(
        &mut self,
        control: &Mesh,
        stencils: &VertexStencils<'_>,
        refined: &Exact,
    ) -> Result<(), ReplayError> {
        let topology = refined.mesh.topology();
        let mut known: HashMap<(u32, EvalPoint), u32> = HashMap::new();
        // By vertex with sides, the points on its sides.
        let mut around: Vec<(u32, u32)> = Vec::new();
        for &(h, _) in &refined.sides {
            let vertex = topology.origin(HalfEdgeId(h)).0;
            let origin = refined.corner_origin(control.triangles(), HalfEdgeId(h));
            let point = origin.and_then(|origin| EvalPoint::of(control, stencils, &origin));
            let point = point.ok_or(ReplayError::Elsewhere { vertex })?;
            let own = self.points[vertex as usize];
            let points = &mut self.points;
            let number = *known.entry((vertex, point)).or_insert_with(|| {
                if own == point {
                    return vertex;
                }
                points.push(point);
                points.len() as u32 - 1
            });
            self.sides.push((h, number));
            around.push((vertex, number));
        }
        around.sort_unstable();
        around.dedup();
        let several = around
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|own| own.len() > 1);
        let points = |own: &[(u32, u32)]| own.iter().map(|&(_, point)| point).collect();
        self.averages = several.map(|own| (own[0].0, points(own))).collect();
        Ok(())
    }
}
