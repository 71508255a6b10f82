//! The cameras of a refinement in pixels: those of the options and of the files, checked against the mesh.

use limitmesh::Mesh;
use limitmesh::criterion::Camera;
use limitmesh::limit::LimitTable;

use crate::arguments::{RefineArguments, cameras_in};
use crate::failure::usage;

/// All cameras, those of the options first.
pub(super) fn all(arguments: &RefineArguments) -> anyhow::Result<Vec<Camera>> {
    let mut cameras = arguments.exact.camera.clone();
    for path in &arguments.exact.camera_path {
        cameras.extend(cameras_in(path)?);
    }
    Ok(cameras)
}

/// Refuses a camera inside a closed mesh: all that it could see are back faces, which are left coarse.
pub(super) fn check(cameras: &[Camera], control: &Mesh, arguments: &RefineArguments) -> anyhow::Result<()> {
    if cameras.is_empty() || control.topology().boundary_edge_count() > 0 {
        return Ok(());
    }
    // Where there is no limit, refinement says so itself.
    let Ok(limits) = LimitTable::new(arguments.scheme.scheme()).positions(control) else { return Ok(()) };
    let inside = |camera: &Camera| winding(camera.eye, &limits, control.triangles()) > 0.5;
    match cameras.iter().position(inside) {
        Some(i) => usage(format!(
            "camera {} of {} stands inside the mesh, at {:?}, where it sees nothing but back faces",
            i + 1,
            cameras.len(),
            cameras[i].eye
        )),
        None => Ok(()),
    }
}

/// How often a closed surface runs around a point: the solid angles of its triangles (Van Oosterom and Strackee 1983)
/// by that of a sphere.
fn winding(point: [f64; 3], positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let angles = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|v| [0, 1, 2].map(|axis| positions[v as usize][axis] - point[axis]));
        let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
        let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        2.0 * dot(a, cross(b, c)).atan2(below)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_surface_runs_once_around_what_is_inside() {
        let soup = limitmesh_models::find("torus").expect("a model").soup();
        let (mesh, _) = Mesh::from_soup(&soup, &Default::default()).expect("a mesh");
        let around = |point| winding(point, mesh.positions(), mesh.triangles());
        // A vertex pushed inwards along the normal is inside; the middle of the hole is not.
        let normals = LimitTable::new(&limitmesh::scheme::Loop).normals(&mesh).expect("normals");
        let (p, n) = (mesh.positions()[5], normals[5]);
        let inside = [0, 1, 2].map(|axis| p[axis] - 0.1 * n[axis]);
        let outside = [0, 1, 2].map(|axis| p[axis] + 0.1 * n[axis]);
        assert!((around(inside) - 1.0).abs() < 1e-9, "{}", around(inside));
        for point in [outside, [0.0; 3], [9.0, 9.0, 9.0]] {
            assert!(around(point).abs() < 1e-9, "{point:?}: {}", around(point));
        }
    }
}
