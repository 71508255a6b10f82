//! Vertices inside regions that lie in one plane and that sharp lines close off.
//!
//! The surface over such a region is that part of the plane, wherever the control points inside
//! are. So a vertex inside need not be the limit of its own: the surface passes through it anyway.
//! Where its edges are of very different lengths, as programs that cut solids leave them, its
//! control point stays at the vertex. With its limit at the vertex, the control point would lie far
//! away, perhaps beyond the region's rim, and the region would fold.

use std::collections::{HashMap, HashSet};

use super::POLLED;
use super::spacing::is_uneven;
use super::sparse::Sparse;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::parallel::Poll;
use crate::progress::Cancelled;
use crate::vector::{DVec3, unit_or_zero, vector};

/// How far vertices may be off a plane, as a part of the greatest coordinate: files in single precision round to half of this.
const IN_PLANE: f64 = 2e-7;

/// The vertices that keep their control points, with the unit normals of their planes.
pub(crate) fn kept_in_planes(
    matrix: &Sparse,
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    poll: &mut Poll<'_>,
) -> Result<HashMap<u32, DVec3>, Cancelled> {
    let planes = Planes::of(matrix, mesh, sharpness);
    let (mut kept, mut seen) = (HashMap::new(), HashSet::new());
    // Without lines nothing closes a region off.
    if sharpness.is_empty() && mesh.topology().boundary_edge_count() == 0 {
        return Ok(kept);
    }
    for v in 0..matrix.rows() as u32 {
        if v.is_multiple_of(POLLED) {
            poll(v as usize)?;
        }
        let is_candidate = planes.is_inside(v) && is_uneven(matrix, mesh, v) && !seen.contains(&v);
        if !is_candidate || planes.of_vertex(v).is_none() {
            continue;
        }
        let (mut region, mut is_flat) = (vec![v], true);
        seen.insert(v);
        let mut next = 0;
        while let Some(&at) = region.get(next) {
            next += 1;
            if next.is_multiple_of(POLLED as usize) {
                poll(v as usize)?;
            }
            for &u in matrix
                .columns(at as usize)
                .iter()
                .filter(|&&u| planes.is_inside(u))
            {
                // A smooth continuation is in the plane, too, or its neighbours are not.
                if planes.of_vertex(u).is_none() {
                    is_flat = false;
                } else if seen.insert(u) {
                    region.push(u);
                }
            }
        }
        let uneven = region
            .into_iter()
            .filter(|&u| is_flat && is_uneven(matrix, mesh, u));
        kept.extend(uneven.filter_map(|u| Some((u, planes.of_vertex(u)?))));
    }
    Ok(kept)
}

/// The planes of the vertices of a mesh.
struct Planes<'a> {
    matrix: &'a Sparse,
    mesh: &'a Mesh,
    sharpness: &'a Sharpness<'a>,
    /// How far vertices may be off a plane.
    most: f64,
}

impl<'a> Planes<'a> {
    fn of(matrix: &'a Sparse, mesh: &'a Mesh, sharpness: &'a Sharpness<'a>) -> Self {
        let greatest = mesh
            .positions()
            .as_flattened()
            .iter()
            .fold(0.0f64, |most, x| most.max(x.abs()));
        Self {
            matrix,
            mesh,
            sharpness,
            most: IN_PLANE * greatest,
        }
    }

    /// Whether a vertex is on no line that could close a region off.
    fn is_inside(&self, v: u32) -> bool {
        let (vertex, topology) = (VertexId(v), self.mesh.topology());
        let depends = self.matrix.columns(v as usize).len() > 1;
        depends && !topology.is_boundary(vertex) && !self.sharpness.is_tagged(vertex)
    }

    /// The unit normal of the plane in which a vertex lies with all that its limit depends on, if there is one over which nothing folds.
    fn of_vertex(&self, v: u32) -> Option<DVec3> {
        let ring = || self.mesh.topology().outgoing_ring(VertexId(v));
        let normal_of = |h: HalfEdgeId| self.mesh.face_normal_vector(h.face().index());
        let normal = unit_or_zero(ring().map(normal_of).sum());
        let at = |v: u32| vector(self.mesh.positions()[v as usize]);
        let is_near = |&u: &u32| (at(u) - at(v)).dot(normal).abs() <= self.most;
        let is_flat = ring().all(|h| normal_of(h).dot(normal) > 0.0)
            && self.matrix.columns(v as usize).iter().all(is_near);
        is_flat.then_some(normal)
    }
}
