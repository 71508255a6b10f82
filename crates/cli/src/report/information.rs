//! The report of `limitmesh info`.

use std::collections::BTreeMap;

use limitmesh_io::gltf::{Contents, MeshContents, PrimitiveContents};
use limitmesh_io::threemf::{ObjectContents, PackageContents};
use serde::Serialize;

use super::InputReport;
use super::diagnosis::DiagnosisReport;
use crate::arguments::Unit;
use crate::bulk::Bulk;
use crate::dihedral::Dihedrals;

/// All of it.
#[derive(Debug, Serialize)]
pub(crate) struct InformationReport {
    pub(crate) version: &'static str,
    pub(crate) input: InputReport,
    /// Polygons in the file by their number of corners, ascending.
    pub(crate) polygons: Vec<PolygonCount>,
    pub(crate) tags: TagCounts,
    /// What a glTF document holds; null for other formats.
    pub(crate) asset: Option<AssetInformation>,
    /// What a 3MF package holds; null for other formats.
    pub(crate) package: Option<PackageInformation>,
    pub(crate) diagnosis: DiagnosisReport,
    pub(crate) mesh: MeshInformation,
    /// The limit surface; null unless it was asked for.
    pub(crate) limit: Option<Bulk>,
}

/// What a glTF document holds.
#[derive(Debug, Serialize)]
pub(crate) struct AssetInformation {
    pub(crate) meshes: Vec<AssetMesh>,
    /// Nodes, materials and so on, by the document's names for them.
    pub(crate) counts: BTreeMap<String, usize>,
    pub(crate) extensions: Vec<String>,
}

/// A mesh of a glTF document.
#[derive(Debug, Serialize)]
pub(crate) struct AssetMesh {
    pub(crate) name: Option<String>,
    /// How often the scene has it.
    pub(crate) shown: usize,
    pub(crate) primitives: Vec<AssetPrimitive>,
}

/// A primitive of a mesh.
#[derive(Debug, Serialize)]
pub(crate) struct AssetPrimitive {
    /// Such as `triangles` or `triangle strip`.
    pub(crate) mode: &'static str,
    pub(crate) vertices: usize,
    pub(crate) indices: usize,
    pub(crate) attributes: Vec<String>,
    pub(crate) morph_targets: usize,
    pub(crate) material: Option<String>,
    pub(crate) extensions: Vec<String>,
}

/// What a 3MF package holds.
#[derive(Debug, Serialize)]
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
pub(crate) struct PackageObject {
    /// As messages call it.
    pub(crate) name: String,
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    /// How often the build has it.
    pub(crate) built: usize,
    /// What its triangles have beside corners, by name.
    pub(crate) attributes: Vec<String>,
    /// What else its mesh has, by name.
    pub(crate) others: Vec<String>,
}

impl From<PackageContents> for PackageInformation {
    fn from(contents: PackageContents) -> Self {
        let PackageContents { objects, assemblies, items, unit, .. } = contents;
        let object = |found: ObjectContents| PackageObject {
            name: found.name,
            vertices: found.vertices,
            triangles: found.triangles,
            built: found.built,
            attributes: found.attributes,
            others: found.others,
        };
        let objects = objects.into_iter().map(object).collect();
        Self { unit: Unit::of_package(unit).name(), items, assemblies, objects }
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
pub(crate) struct PolygonCount {
    pub(crate) corners: usize,
    pub(crate) count: usize,
}

/// Tags in the file.
#[derive(Debug, Serialize)]
pub(crate) struct TagCounts {
    pub(crate) creases: usize,
    pub(crate) corners: usize,
}

/// The control mesh that refinement would start from.
#[derive(Debug, Serialize)]
pub(crate) struct MeshInformation {
    pub(crate) vertices: usize,
    pub(crate) edges: usize,
    pub(crate) triangles: usize,
    pub(crate) components: usize,
    /// All components' together.
    pub(crate) genus: i64,
    pub(crate) euler_characteristic: i64,
    pub(crate) boundary_loops: usize,
    pub(crate) boundary_edges: usize,
    pub(crate) watertight: bool,
    pub(crate) min_valence: u32,
    pub(crate) max_valence: u32,
    /// Vertices with another valence than 6, or 4 on a boundary.
    pub(crate) irregular_vertices: usize,
    pub(crate) bounding_box: BoundingBox,
    #[serde(flatten)]
    pub(crate) bulk: Bulk,
    /// Closed components whose normals point inwards, but for cavities of others.
    pub(crate) inside_out_components: usize,
    pub(crate) dihedrals: Dihedrals,
    pub(crate) min_angle_degrees: f64,
    pub(crate) mean_min_angle_degrees: f64,
    /// Triangles with a least angle in [0°, 5°), [5°, 10°) … [55°, 60°].
    pub(crate) angle_histogram: [usize; 12],
}

/// Extent along the axes, in the mesh's units.
#[derive(Debug, Serialize)]
pub(crate) struct BoundingBox {
    pub(crate) low: [f64; 3],
    pub(crate) high: [f64; 3],
    pub(crate) diagonal: f64,
}
