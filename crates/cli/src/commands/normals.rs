//! The limit normals of a refined mesh, for files and pictures: one for each vertex, or, where edges are sharp, one for each side.

use limitmesh::limit::SidedNormals;
use limitmesh::mesh::SplitSurface;
use limitmesh::refine::Exact;
use limitmesh::{Mesh, Triangles};
use limitmesh_io::{Format, Output};

/// Normals of a mesh.
pub(super) enum Normals {
    /// One for each vertex.
    ByVertex(Vec<[f64; 3]>),
    /// Vertices on sharp edges have one for each side.
    BySide(SplitSurface),
}

impl Normals {
    /// Those of an exact refinement.
    pub(super) fn of_exact(found: &mut Exact) -> Self {
        if !found.sides.is_empty() {
            return Self::BySide(found.split_surface());
        }
        Self::ByVertex(std::mem::take(&mut found.normals))
    }

    /// The limit normals of a mesh by side.
    pub(super) fn of_sides(mesh: &Mesh, sided: SidedNormals) -> Self {
        if mesh.tags().creases.is_empty() {
            return Self::ByVertex(sided.into_by_vertex());
        }
        Self::BySide(SplitSurface::new(mesh, |h| sided.at(mesh.topology(), h)))
    }

    /// Whether files of a format hold any.
    pub(super) fn are_held(format: Format) -> bool {
        matches!(
            format,
            Format::Ply | Format::Obj | Format::Gltf | Format::Glb
        )
    }

    /// Items that a soup leaves out and an output has from another source.
    pub(super) fn kept(format: Option<Format>) -> &'static [&'static str] {
        if format.is_some_and(Self::are_held) {
            &["normals"]
        } else {
            &[]
        }
    }

    /// Adds them to what is written; `is_split` if a vertex is to stand once for each side where the format needs that.
    pub(super) fn add_to<'a>(
        &'a self,
        output: Output<'a>,
        format: Format,
        is_split: bool,
    ) -> Output<'a> {
        match self {
            _ if !Self::are_held(format) => output,
            Self::ByVertex(normals) => output.normals(normals),
            Self::BySide(split) if format == Format::Obj => {
                output.normals_of_corners(&split.normals, &split.triangles)
            }
            Self::BySide(split) if is_split || format.is_gltf() => Output {
                surface: split.as_triangles(),
                ..output
            }
            .normals(&split.normals),
            // Averages over both sides would make flat faces look like pillows.
            Self::BySide(_) => output,
        }
    }

    /// The vertices that are copies of others, by what they are copies of, where a file has a vertex for each side.
    pub(super) fn sources(&self, format: Format, is_split: bool) -> Option<&[u32]> {
        match self {
            Self::BySide(split) if is_split && format == Format::Ply => Some(&split.sources),
            _ => None,
        }
    }

    /// Positions, normals and triangles of a mesh with these normals, where each vertex has one.
    pub(super) fn surface<'a>(&'a self, mesh: &'a Mesh) -> (Triangles<'a>, &'a [[f64; 3]]) {
        match self {
            Self::ByVertex(normals) => (mesh.as_triangles(), normals),
            Self::BySide(split) => (split.as_triangles(), &split.normals),
        }
    }

    /// The note on a file without them.
    pub(super) fn note(&self, format: Format, is_split: bool) -> Option<&'static str> {
        let is_left_out = matches!(self, Self::BySide(_)) && format == Format::Ply && !is_split;
        is_left_out.then_some(
            "limit normals left out: vertices on sharp edges have one for each side; --split-normals writes a vertex for \
             each, and OBJ files hold them as they are",
        )
    }
}
