//! A control mesh on its way through a method.

use limitmesh::Mesh;
use limitmesh::scheme::Scheme;
use limitmesh_io::Format;

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::control::Control;
use super::provenance::Provenance;
use crate::arguments::RefineArguments;
use crate::format::counted;
use crate::progress::Progress;
use limitmesh::refine::Origin;

/// A control mesh, its values, and the options for its refinement.
#[derive(Clone, Copy)]
pub(super) struct Task<'a> {
    pub(super) control: &'a Control,
    pub(super) channels: &'a Channels,
    /// With lengths in the mesh's unit, and with what was decided by looking at the mesh.
    pub(super) arguments: &'a RefineArguments,
    /// The format to write; none for a dry run without a name.
    pub(super) format: Option<Format>,
    /// Whether the source asks where vertices and triangles came from.
    pub(super) is_traced: bool,
    pub(super) progress: &'a Progress<'a>,
}

impl<'a> Task<'a> {
    pub(super) fn mesh(&self) -> &'a Mesh {
        &self.control.mesh
    }

    /// The scheme, where it is one that splits triangles in four.
    pub(super) fn scheme(&self) -> anyhow::Result<&'static dyn Scheme> {
        self.arguments.scheme()
    }

    /// Whether the file or the picture shows normals.
    pub(super) fn wants_normals(&self) -> bool {
        self.format.is_some_and(Normals::are_held) || self.arguments.picture.is_some()
    }

    /// Whether the file has quads.
    pub(super) fn has_quads_out(&self) -> bool {
        self.arguments.has_quads_out(self.format)
    }

    /// ` mm`, or nothing where no unit is known.
    pub(super) fn unit(&self) -> String {
        self.arguments.build.unit_in_words()
    }

    /// Shows that refinement begins.
    pub(super) fn begin(&self) {
        let triangles = counted(self.mesh().face_count(), "triangle", "triangles");
        self.progress.stage(format!("refining {triangles}"));
    }

    /// The properties that trace vertices and triangles to the input, if they are asked for.
    pub(super) fn provenance(&self, origins: &[Origin], parents: &[u32]) -> Option<Provenance> {
        let is_asked = self.arguments.exact.provenance;
        is_asked.then(|| {
            Provenance::new(
                origins,
                parents,
                &self.control.faces,
                &self.control.concave.parts,
            )
        })
    }
}
