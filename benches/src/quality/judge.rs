//! The judge of all methods: sampled symmetric Hausdorff distance to the limit surface.

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::measure::{Bvh, SamplingOptions, hausdorff_between};
use limitmesh::refine::limit_reference;
use limitmesh::scheme::Loop;

/// The limit surface is stood for by at most so many triangles. All its vertices are samples: enough, and still seconds.
const MOST_TRIANGLES: usize = 3_000_000;

/// The finest uniform level that still has at most [`MOST_TRIANGLES`] triangles.
pub(crate) fn reference_level(control_faces: usize) -> usize {
    let mut level = 0;
    while control_faces << (2 * (level + 1)) <= MOST_TRIANGLES {
        level += 1;
    }
    level
}

/// A limit surface, as a fine mesh with all vertices on it.
pub(crate) struct Reference {
    pub(crate) mesh: Mesh,
    pub(crate) level: usize,
    /// Of the control mesh's bounding box.
    diagonal: f64,
}

impl Reference {
    pub(crate) fn new(control: &Mesh) -> Result<Self> {
        let level = reference_level(control.face_count());
        Ok(Self {
            mesh: limit_reference(control, &Loop, level)?,
            level,
            diagonal: control.diagonal(),
        })
    }
}

/// Measures meshes against one limit surface.
pub(crate) struct Judge<'a> {
    pub(crate) reference: &'a Reference,
    tree: Bvh<'a>,
}

impl<'a> Judge<'a> {
    pub(crate) fn new(reference: &'a Reference) -> Result<Self> {
        let tree = Bvh::new(reference.mesh.as_triangles())?;
        Ok(Self { reference, tree })
    }

    /// The symmetric Hausdorff distance found, as a length.
    pub(crate) fn distance(&self, mesh: &Mesh) -> Result<f64> {
        let tree = Bvh::new(mesh.as_triangles())?;
        Ok(hausdorff_between(&tree, &self.tree, &SamplingOptions::default()).symmetric())
    }

    /// The same length in per cent of the diagonal of the control mesh's bounding box.
    pub(crate) fn percent(&self, length: f64) -> f64 {
        100.0 * length / self.reference.diagonal
    }
}
