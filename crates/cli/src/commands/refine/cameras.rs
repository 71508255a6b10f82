//! The cameras of a refinement in pixels: those of the options and of the files, checked against the mesh.

use limitmesh::Mesh;
use limitmesh::criterion::Camera;
use limitmesh::limit::LimitTable;

use crate::arguments::{RefineArguments, cameras_in};
use crate::bulk::winding;
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
pub(super) fn check(
    cameras: &[Camera],
    control: &Mesh,
    arguments: &RefineArguments,
) -> anyhow::Result<()> {
    if cameras.is_empty() || control.topology().boundary_edge_count() > 0 {
        return Ok(());
    }
    // Where there is no limit, refinement says so itself.
    let Ok(limits) = LimitTable::new(arguments.scheme()?).positions(control) else {
        return Ok(());
    };
    let triangles = || control.triangles().iter().copied();
    let inside = |camera: &Camera| winding(camera.eye, &limits, triangles()) > 0.5;
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
