//! Common parts of glTF assets and 3MF packages: several meshes that are refined at the scale of their largest appearance.

use std::path::Path;

use limitmesh::mesh::{BuildOptions, Diagnosis, MeshError};
use limitmesh::{Mesh, PolygonSoup, QuadOptions};
use limitmesh_io::channels::NORMALS;

use crate::arguments::{Extent, Length, RefineArguments};
use crate::commands::{picture, shading};
use crate::failure::usage;
use crate::input::{self, ControlMesh};
use crate::progress::Progress;

/// Refuses viewers, which look at one mesh.
///
/// # Errors
/// There is one.
pub(super) fn check_viewers(arguments: &RefineArguments) -> anyhow::Result<()> {
    match !arguments.view.is_empty() {
        true => usage(
            "cameras and views look at one mesh; those of an asset or a package may appear many times, in many places",
        ),
        false => Ok(()),
    }
}

/// The diagonal of a box.
pub(super) fn diagonal([low, high]: [[f64; 3]; 2]) -> f64 {
    let squares = low.iter().zip(high).map(|(a, b)| (b - a).powi(2));
    squares.sum::<f64>().sqrt()
}

/// Makes lengths in per cent that hold for all meshes lengths, of this diagonal.
///
/// # Errors
/// A length has a unit, and the mesh's is not known.
pub(super) fn set_lengths(arguments: &mut RefineArguments, diagonal: f64) -> anyhow::Result<()> {
    let unit = arguments.build.unit;
    if let Some(value) = arguments.interpolation.within(diagonal, unit)? {
        let length = Length { value, unit: None };
        arguments.interpolation.interpolate = Some(Extent::Length(length));
    }
    Ok(())
}

/// Makes a soup as large as it is shown.
pub(super) fn enlarge(soup: &mut PolygonSoup, scale: f64) {
    let coordinates = soup.positions.iter_mut().flatten();
    coordinates.for_each(|x| *x *= scale);
}

/// The mesh of a soup, whose polygons become quads by these rules, if there are any; a note says what was repaired, or why there is none and all stays as it is.
///
/// # Errors
/// It needs a repair that is forbidden, or none helps.
pub(super) fn built(
    name: &str,
    soup: &PolygonSoup,
    options: &BuildOptions,
    quads: Option<&QuadOptions>,
    progress: &Progress,
) -> anyhow::Result<Option<(ControlMesh, Diagnosis)>> {
    match ControlMesh::of(soup, options, quads) {
        Err(MeshError::NoFaces { reason }) => {
            progress.note(format!("{name}: kept as it is: {reason}"));
            Ok(None)
        }
        Err(error) => Err(input::describe(name, error)),
        Ok(built) => {
            let repairs = built.1.repairs();
            progress.notes(repairs.iter().map(|line| format!("{name}: {line}")));
            Ok(Some(built))
        }
    }
}

/// Draws all that was written.
///
/// # Errors
/// It cannot be drawn, or not written.
pub(super) fn draw(path: &Path, scene: &PolygonSoup, progress: &Progress) -> anyhow::Result<()> {
    let (mesh, _, trace) = Mesh::from_soup_traced(scene, &Default::default())?;
    let is_normals = |channel: &&limitmesh::mesh::Channel| channel.name == NORMALS;
    let split = match scene.channels.iter().find(is_normals) {
        Some(normals) => shading::by_normals(&mesh, &normals.on_mesh(scene, &mesh, &trace)?),
        None => shading::without_normals(&mesh)?,
    };
    picture::draw_edges(path, split.as_triangles(), &split.normals, None, progress)
}
