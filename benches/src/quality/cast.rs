//! The control meshes that the methods are compared on.

use std::path::Path;

use anyhow::{Context, Result};
use limitmesh::Mesh;

/// Built-in models: the paper's subjects, and a sphere.
const BUILT_IN: [&str; 6] = ["head", "shoe", "cup", "bunny", "teddy", "sphere"];

/// Files: the paper's models where they are free, and others; coarse enough that four levels or three are still a
/// comparison.
const FILES: [&str; 11] = [
    "mannequin_142.off",
    "mannequin.off",
    "boot_684.off",
    "bunny_1k.off",
    "bunny_3674.obj",
    "teddy.obj",
    "cup_standin.obj",
    "radish_standin.obj",
    "cusp_standin.obj",
    "goathead_be.ply",
    "skull_low.obj",
];

/// A control mesh with a name.
pub(crate) struct Model {
    pub(crate) name: String,
    pub(crate) mesh: Mesh,
}

impl Model {
    pub(crate) fn is_closed(&self) -> bool {
        self.mesh.topology().boundary_edge_count() == 0
    }
}

/// A built-in control mesh.
pub(crate) fn builtin(name: &str) -> Result<Mesh> {
    let model = limitmesh_models::find(name)
        .with_context(|| format!("no built-in model is called {name}"))?;
    Ok(Mesh::from_soup(&model.soup(), &Default::default())?.0)
}

/// The models with at most `most_faces` faces; files that are not in `folder` are left out, and that is said.
pub(crate) fn gather(folder: &Path, most_faces: usize) -> Result<Vec<Model>> {
    let mut models = Vec::new();
    for name in BUILT_IN {
        models.push(Model {
            name: format!("{name} (built in)"),
            mesh: builtin(name)?,
        });
    }
    for name in FILES {
        let path = folder.join(name);
        if path.exists() {
            models.push(Model {
                name: name.to_owned(),
                mesh: crate::mesh(&path)?,
            });
        } else {
            eprintln!("{name} is not in {}: left out", folder.display());
        }
    }
    models.retain(|model| model.mesh.face_count() <= most_faces);
    Ok(models)
}
