//! Vertices inside regions that lie in one plane and that sharp lines close off.
//!
//! The surface over such a region is that part of the plane, wherever the control points inside are. So a vertex inside need not be the
//! limit of its own: the surface passes through it all the same. Where its edges are of very different lengths, as programs that cut solids
//! leave them, it keeps its place as a control point. Led through it, that came to lie far away, perhaps beyond the region's rim, and the
//! region folded.

use super::spacing::MOST_UNEVEN;
use super::sparse::Sparse;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::vector::{DVec3, diagonal, unit_or_zero, vector};

/// How far vertices may be off a plane, as a part of the greatest coordinate: files in single precision round to half of this.
const IN_PLANE: f64 = 2e-7;

/// By vertex whose own place is as good as its limit's, the unit normal of its plane.
pub(super) fn kept_in_planes(matrix: &Sparse, mesh: &Mesh) -> Vec<Option<DVec3>> {
    let (topology, sharpness) = (mesh.topology(), Sharpness::of(mesh));
    let at = |v: u32| vector(mesh.positions()[v as usize]);
    let most = IN_PLANE * mesh.positions().as_flattened().iter().fold(0.0f64, |most, x| most.max(x.abs()));
    // Whoever is on a boundary or a sharp edge, or tagged, closes a region off.
    let is_inside = |v: u32| {
        let vertex = VertexId(v);
        matrix.columns(v as usize).len() > 1 && !topology.is_boundary(vertex) && !sharpness.is_tagged(vertex)
    };
    let plane = |v: u32| {
        let normals = topology
            .outgoing_ring(VertexId(v))
            .map(|h: HalfEdgeId| mesh.face_normal_vector(h.face().index()));
        let normals: Vec<DVec3> = normals.collect();
        let normal = unit_or_zero(normals.iter().sum());
        let is_flat = matrix.columns(v as usize).iter().all(|&u| (at(u) - at(v)).dot(normal).abs() <= most);
        (is_flat && normals.iter().all(|other| other.dot(normal) > 0.0)).then_some(normal)
    };
    let mut planes: Vec<Option<DVec3>> =
        (0..matrix.rows() as u32).map(|v| if is_inside(v) { plane(v) } else { None }).collect();
    // What is smooth all around is in the plane, too, or what is beside it is not.
    let mut left: Vec<u32> =
        (0..matrix.rows() as u32).filter(|&v| is_inside(v) && planes[v as usize].is_none()).collect();
    while let Some(v) = left.pop() {
        for &u in matrix.columns(v as usize) {
            if planes[u as usize].take().is_some() {
                left.push(u);
            }
        }
    }
    for v in 0..matrix.rows() as u32 {
        let lengths = matrix.columns(v as usize).iter().filter(|&&u| u != v);
        let lengths = lengths.map(|&u| diagonal(at(v).min(at(u)), at(v).max(at(u))));
        let [least, greatest] = lengths.fold([f64::INFINITY, 0.0], |[a, b], x| [x.min(a), x.max(b)]);
        if greatest <= MOST_UNEVEN * least {
            planes[v as usize] = None;
        }
    }
    planes
}
