//! What is shown: a file, its control cage, and its limit surface.

use std::path::PathBuf;

use anyhow::Context;
use limitmesh::refine::{ExactOptions, exact_observed};
use limitmesh::{LimitSurface, Mesh, PolygonSoup};
use limitmesh_render::{Camera, Style, ViewDirection, render};

use super::super::limit_control::Prepared;
use super::super::picture::SIZE;
use super::distances::Distances;
use crate::arguments::{Extent, LimitArguments, SchemeName, Unit, ViewArguments};
use crate::input;
use crate::progress::Progress;

/// How near to the surface a picture's mesh is, as a share of the diagonal: about a pixel.
const IN_PICTURE: f64 = 1e-3;

/// A mesh that is shown.
pub(super) struct Subject<'a> {
    pub(super) file: PathBuf,
    /// What it is called, without folders.
    pub(super) name: String,
    /// How it is refined.
    pub(super) limit: LimitArguments,
    /// The same with what was decided by looking at it.
    pub(super) decided: LimitArguments,
    pub(super) unit: Option<Unit>,
    pub(super) diagonal: f64,
    /// The edges of the file's polygons.
    pub(super) cage: Vec<[[f32; 3]; 2]>,
    /// The triangles of the control mesh.
    pub(super) faces: usize,
    mesh: &'a Mesh,
    scheme: SchemeName,
    surface: LimitSurface<'a>,
}

impl<'a> Subject<'a> {
    /// # Errors
    /// The file cannot be read again, or its surface has no limit somewhere.
    pub(super) fn new(
        arguments: &ViewArguments,
        prepared: &'a Prepared,
        progress: &Progress,
    ) -> anyhow::Result<Self> {
        let (mesh, limit) = (&prepared.input.mesh, prepared.limit);
        let read = input::read(&arguments.file, &limit.build, progress)?;
        let surface =
            LimitSurface::new(mesh, limit.scheme().scheme()).with_context(|| read.name.clone())?;
        let name = arguments.file.file_name().map_or_else(
            || read.name.clone(),
            |name| name.to_string_lossy().into_owned(),
        );
        Ok(Self {
            file: arguments.file.clone(),
            name,
            limit: arguments.limit,
            decided: limit,
            unit: limit.build.unit,
            diagonal: mesh.diagonal(),
            cage: edges(&read.soup),
            faces: mesh.face_count(),
            mesh,
            scheme: limit.scheme(),
            surface,
        })
    }

    /// A tolerance as a share of the diagonal.
    ///
    /// # Errors
    /// It has a unit, and the mesh's is not known.
    pub(super) fn share(&self, tolerance: Extent) -> anyhow::Result<f64> {
        Ok(tolerance.length(self.diagonal, self.unit)? / self.diagonal)
    }

    /// What measures distances to its limit surface; `None` where closest points of that are not known.
    pub(super) fn distances(&self) -> Option<Distances<'_>> {
        Distances::to(&self.surface, self.diagonal)
    }

    /// A picture of the smooth surface, as a PNG file.
    ///
    /// # Errors
    /// The mesh cannot be refined.
    pub(super) fn picture(&self, progress: &Progress) -> anyhow::Result<Vec<u8>> {
        let goal = ExactOptions::default().tolerance(IN_PICTURE * self.diagonal);
        let scheme = self.scheme.scheme();
        let exact = exact_observed(self.mesh, scheme, &goal, &mut progress.observer())?;
        let (surface, normals) = (exact.mesh.as_triangles(), Some(&exact.normals[..]));
        let (width, height) = (SIZE.width, SIZE.height);
        let camera = Camera::fit_tightly(surface, ViewDirection::default(), width, height)?;
        let image = render(
            surface,
            normals,
            None,
            &camera,
            &Style::default(),
            width,
            height,
        )?;
        Ok(image.encode_png()?)
    }
}

/// The edges of polygons, each once, by the places of their ends.
fn edges(soup: &PolygonSoup) -> Vec<[[f32; 3]; 2]> {
    let mut pairs: Vec<[u32; 2]> = Vec::new();
    for face in soup.faces.iter() {
        let ends = face.iter().zip(face.iter().cycle().skip(1));
        pairs.extend(ends.map(|(&a, &b)| [a.min(b), a.max(b)]));
    }
    pairs.sort_unstable();
    pairs.dedup();
    let at = |v: u32| soup.positions[v as usize].map(|x| x as f32);
    let there = |v: &u32| (*v as usize) < soup.positions.len();
    let pairs = pairs.iter().filter(|pair| pair.iter().all(there));
    pairs.map(|pair| pair.map(at)).collect()
}
