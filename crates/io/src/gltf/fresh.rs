//! A document of one mesh, for triangles that come from no document.

use super::changes::Changes;
use super::source::Source;
use super::{Asset, Geometry};
use crate::error::WriteError;
use crate::format::Format;
use crate::write::Output;
use limitmesh::mesh::Triangles;
use std::path::Path;

macro_rules! document {
    ($rest:literal) => {
        concat!(
            r#"{"asset":{"version":"2.0","generator":"limitmesh "#,
            env!("CARGO_PKG_VERSION"),
            r#""}"#,
            $rest
        )
    };
}

/// What there is to say of no triangles: a mesh needs some.
const NOTHING: &str = document!("}");

/// What geometry is put into.
const EMPTY: &str = document!(
    r#","scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{}}]}]}"#
);

/// Writes triangles with their normals to a file, or to one byte vector without a path.
pub(crate) fn write_fresh(
    path: Option<&Path>,
    format: Format,
    output: &Output<'_>,
) -> Result<Vec<u8>, WriteError> {
    let flawed = |flaw| WriteError::Gltf { flaw };
    let text = if output.surface.triangles.is_empty() { NOTHING } else { EMPTY };
    let source = Source::parse(text.as_bytes(), None).map_err(flawed)?;
    let scene = source.scene().map_err(flawed)?;
    let mut asset = Asset { path: None, source, scene, changes: Changes::default() };
    // Where vertices have several normals, the writer is given a vertex for each.
    let normals = output.normals.filter(|_| output.corner_normals.is_none());
    let Triangles { positions, triangles } = output.surface;
    let geometry = Geometry { positions, normals, triangles, attributes: &[], targets: &[] };
    if !geometry.triangles.is_empty() {
        asset.replace(0, 0, &geometry).map_err(flawed)?;
    }
    match path {
        Some(path) => asset.write(path, format).map(|_| Vec::new()),
        None => asset.to_bytes(format),
    }
}
