//! Which meshes and primitives of an asset are refined: those whose names were given.

use limitmesh_io::Asset;
use limitmesh_io::gltf::AssetContents;

use crate::arguments::AssetArguments;

/// Names at most that a message lists.
const MOST_NAMES: usize = 20;

/// The primitives that are refined, by mesh.
pub(super) struct Selection(Vec<Vec<bool>>);

impl Selection {
    /// Without names all of them; with names of meshes and of materials those that have one of either.
    ///
    /// # Errors
    /// Nothing has a name that was given, or no mesh of these names has a primitive of these materials; the message says what there is.
    pub(super) fn new(asset: &Asset, arguments: &AssetArguments) -> anyhow::Result<Self> {
        let AssetContents { meshes, .. } = asset.contents()?;
        let mesh_names: Vec<String> = meshes
            .iter()
            .enumerate()
            .map(|(i, mesh)| mesh.name.clone().unwrap_or_else(|| format!("meshes[{i}]")))
            .collect();
        let materials = meshes
            .iter()
            .flat_map(|mesh| &mesh.primitives)
            .filter_map(|own| own.material.clone());
        let materials: Vec<String> = materials.collect();
        check(&arguments.mesh, "mesh", &mesh_names)?;
        check(&arguments.material, "material", &materials)?;
        let is_named = |names: &[String], own: Option<&String>| {
            names.is_empty() || own.is_some_and(|own| names.contains(own))
        };
        let of_mesh = |(mesh, name)| {
            let mesh: &limitmesh_io::gltf::MeshContents = mesh;
            let of_primitives = mesh.primitives.iter().map(|own| {
                is_named(&arguments.mesh, Some(name))
                    && is_named(&arguments.material, own.material.as_ref())
            });
            of_primitives.collect()
        };
        let selection: Vec<Vec<bool>> = meshes.iter().zip(&mesh_names).map(of_mesh).collect();
        anyhow::ensure!(
            selection.iter().flatten().any(|&is_wanted| is_wanted) || arguments.material.is_empty(),
            "no mesh that was named has a primitive of a material that was"
        );
        Ok(Self(selection))
    }

    /// Whether a primitive is refined.
    pub(super) fn has(&self, mesh: usize, primitive: usize) -> bool {
        self.0[mesh][primitive]
    }
}

fn check(names: &[String], what: &str, known: &[String]) -> anyhow::Result<()> {
    let Some(name) = names.iter().find(|name| !known.contains(name)) else {
        return Ok(());
    };
    let mut unique: Vec<&String> = Vec::new();
    known.iter().for_each(|name| {
        if !unique.contains(&name) {
            unique.push(name);
        }
    });
    let listed: Vec<String> = unique
        .iter()
        .take(MOST_NAMES)
        .map(|name| format!("'{name}'"))
        .collect();
    let more = match unique.len().saturating_sub(MOST_NAMES) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let there = if listed.is_empty() {
        "none with a name".to_owned()
    } else {
        listed.join(", ")
    };
    anyhow::bail!("no {what} is called '{name}'; there is {there}{more}")
}
