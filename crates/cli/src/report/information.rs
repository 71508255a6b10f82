//! The report of `limitmesh info`.

use std::collections::BTreeMap;

use limitmesh_io::gltf::{Contents, MeshContents, PrimitiveContents};
use limitmesh_io::threemf::{ObjectContents, PackageContents};
use serde::Serialize;

use super::diagnosis::DiagnosisReport;
use super::input::InputReport;
use crate::arguments::Unit;
use crate::bulk::Bulk;
use crate::dihedral::Dihedrals;

/// What is in a file, and what would be repaired.
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
    /// What a glTF document holds; null for other formats.
    pub(crate) asset: Option<AssetInformation>,
    /// What a 3MF package holds; null for other formats.
    pub(crate) package: Option<PackageInformation>,
    /// What was found and would be repaired.
    pub(crate) diagnosis: DiagnosisReport,
    /// The control mesh.
    pub(crate) mesh: MeshInformation,
    /// The limit surface; null unless it was asked for.
    pub(crate) limit: Option<Bulk>,
}

/// What a glTF document holds.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct AssetInformation {
    /// The document's meshes.
    pub(crate) meshes: Vec<AssetMesh>,
    /// Nodes, materials and so on, by the document's names for them.
    pub(crate) counts: BTreeMap<String, usize>,
    /// Extensions that the document uses.
    pub(crate) extensions: Vec<String>,
}

/// A mesh of a glTF document.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct AssetMesh {
    /// Its name in the document.
    pub(crate) name: Option<String>,
    /// How often the scene has it.
    pub(crate) shown: usize,
    /// Its primitives.
    pub(crate) primitives: Vec<AssetPrimitive>,
}

/// A primitive of a mesh.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct AssetPrimitive {
    /// Such as `triangles` or `triangle strip`.
    pub(crate) mode: &'static str,
    /// Vertices that it has.
    pub(crate) vertices: usize,
    /// Corners of its triangles.
    pub(crate) indices: usize,
    /// Names of its attributes.
    pub(crate) attributes: Vec<String>,
    /// Morph targets that it has.
    pub(crate) morph_targets: usize,
    /// The name of its material.
    pub(crate) material: Option<String>,
    /// Extensions that it uses.
    pub(crate) extensions: Vec<String>,
}

/// What a 3MF package holds.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PackageInformation {
    /// What numbers are measured in, as `--unit` has it.
    pub(crate) unit: &'static str,
    /// Items that are built.
    pub(crate) items: usize,
    /// Objects that are put together from others.
    pub(crate) assemblies: usize,
    /// Objects that have a mesh.
    pub(crate) objects: Vec<PackageObject>,
}

/// An object of a 3MF package.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PackageObject {
    /// As messages call it.
    pub(crate) name: String,
    /// Vertices of its mesh.
    pub(crate) vertices: usize,
    /// Triangles of its mesh.
    pub(crate) triangles: usize,
    /// How often the build has it.
    pub(crate) built: usize,
    /// What its triangles have apart from corners, by name.
    pub(crate) attributes: Vec<String>,
    /// What else its mesh has, by name.
    pub(crate) others: Vec<String>,
}

impl PackageInformation {
    /// Of a package in this unit.
    pub(crate) fn new(contents: PackageContents, unit: Unit) -> Self {
        let object = |found: ObjectContents| PackageObject {
            name: found.name,
            vertices: found.vertices,
            triangles: found.triangles,
            built: found.built,
            attributes: found.attributes,
            others: found.others,
        };
        Self {
            unit: unit.name(),
            items: contents.items,
            assemblies: contents.assemblies,
            objects: contents.objects.into_iter().map(object).collect(),
        }
    }
}

impl From<Contents> for AssetInformation {
    fn from(contents: Contents) -> Self {
        let primitive = |found: PrimitiveContents| AssetPrimitive {
            mode: found.mode,
            vertices: found.vertices,
            indices: found.corners,
            attributes: found.attributes,
            morph_targets: found.targets,
            material: found.material,
            extensions: found.extensions,
        };
        let mesh = |found: MeshContents| AssetMesh {
            name: found.name,
            shown: found.shown,
            primitives: found.primitives.into_iter().map(primitive).collect(),
        };
        Self {
            meshes: contents.meshes.into_iter().map(mesh).collect(),
            counts: contents.counts.into_iter().collect(),
            extensions: contents.extensions,
        }
    }
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
    /// The least angle of a triangle.
    pub(crate) min_angle_degrees: f64,
    /// The mean of the triangles' least angles.
    pub(crate) mean_min_angle_degrees: f64,
    /// Triangles with a least angle in [0°, 5°), [5°, 10°) … [55°, 60°].
    pub(crate) angle_histogram: [usize; 12],
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
