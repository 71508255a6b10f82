//! The report of `limitmesh info`.

use limitmesh_io::gltf::AssetContents;
use limitmesh_io::threemf::PackageContents;
use serde::Serialize;

use super::diagnosis::DiagnosisReport;
use super::input::InputReport;
use super::quality::QualityReport;
use crate::bulk::Bulk;
use crate::dihedral::Dihedrals;

/// The contents of a file, and the repairs that it needs.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct InformationReport {
    /// The program's version.
    pub(crate) version: &'static str,
    /// The file.
    pub(crate) input: InputReport,
    /// Polygons in the file by their number of corners, ascending.
    pub(crate) polygons: Vec<PolygonCount>,
    /// Tags of sharp edges and corners.
    pub(crate) tags: TagCounts,
    /// The contents of a glTF document; null for other formats.
    pub(crate) asset: Option<AssetContents>,
    /// The contents of a 3MF package; null for other formats.
    pub(crate) package: Option<PackageInformation>,
    /// Findings, and the repairs that they need.
    pub(crate) diagnosis: DiagnosisReport,
    /// The control mesh.
    pub(crate) mesh: MeshInformation,
}

/// The contents of a 3MF package.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PackageInformation {
    /// The unit of its numbers, as `--unit` has it.
    pub(crate) unit: &'static str,
    #[serde(flatten)]
    pub(crate) contents: PackageContents,
}

/// How many polygons have so many corners.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PolygonCount {
    /// Corners of a polygon.
    pub(crate) corners: usize,
    /// Polygons with so many.
    pub(crate) count: usize,
}

/// Tags in the file.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct TagCounts {
    /// Edges with a tag.
    pub(crate) creases: usize,
    /// Vertices with a tag.
    pub(crate) corners: usize,
}

/// The control mesh that refinement would start from.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct MeshInformation {
    /// Its vertices.
    pub(crate) vertices: usize,
    /// Its edges.
    pub(crate) edges: usize,
    /// Its triangles.
    pub(crate) triangles: usize,
    /// Connected parts.
    pub(crate) components: usize,
    /// All components' together.
    pub(crate) genus: i64,
    /// Vertices less edges plus triangles.
    pub(crate) euler_characteristic: i64,
    /// Holes and rims.
    pub(crate) boundary_loops: usize,
    /// Edges with one face.
    pub(crate) boundary_edges: usize,
    /// Whether every edge has two faces.
    pub(crate) watertight: bool,
    /// The fewest edges at a vertex.
    pub(crate) min_valence: u32,
    /// The most edges at a vertex.
    pub(crate) max_valence: u32,
    /// Vertices with another valence than 6, or 4 on a boundary.
    pub(crate) irregular_vertices: usize,
    /// Its extent.
    pub(crate) bounding_box: BoundingBox,
    #[serde(flatten)]
    pub(crate) bulk: Bulk,
    /// Edges by the angle between their faces.
    pub(crate) dihedrals: Dihedrals,
    #[serde(flatten)]
    pub(crate) quality: QualityReport,
}

/// Extent along the axes, in the mesh's units.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct BoundingBox {
    /// The least coordinates.
    pub(crate) low: [f64; 3],
    /// The greatest coordinates.
    pub(crate) high: [f64; 3],
    /// The distance between these two.
    pub(crate) diagonal: f64,
}
