//! The control mesh of a refinement: what was read, with the tags that options put on it, made to interpolate if asked.

use limitmesh::mesh::{ConcaveCorners, Diagnosis};
use limitmesh::{Mesh, Triangles};

use super::super::interpolation;
use super::nearness::Nearness;
use crate::arguments::{Featured, RefineArguments, Way};
use crate::bulk::{Bulk, Shown};
use crate::format::counted;
use crate::progress::Progress;
use crate::report::InterpolationReport;

/// The mesh that is refined, and the one that it is compared with.
pub(super) struct Control {
    pub(super) mesh: Mesh,
    /// The corners of 180° and more that were divided, with the faces that they divided.
    pub(super) concave: ConcaveCorners,
    pub(super) diagnosis: Diagnosis,
    /// The input's face of each face of the mesh that was read.
    pub(super) faces: Vec<u32>,
    /// The mesh that was read, where somebody asks how far the result is from it.
    surface: Option<Surface>,
    /// How far the limits of the control points are from the vertices at most, where they were moved for that.
    pub(super) residual: f64,
    /// How the mesh is shown, and the area and volume of the mesh that was read as it is shown.
    pub(super) shown: Shown,
    pub(super) bulk: Bulk,
    pub(super) interpolation: Option<InterpolationReport>,
    /// Lengths in per cent are of this.
    pub(super) diagonal: f64,
}

/// Positions and triangles of a mesh.
struct Surface {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// A mesh that was read, with the input's face of each of its faces.
pub(super) struct Read {
    pub(super) mesh: Mesh,
    pub(super) diagnosis: Diagnosis,
    pub(super) faces: Vec<u32>,
    pub(super) shown: Shown,
}

impl Control {
    /// The control mesh of what was read. Lengths in per cent are of `diagonal`, or of the mesh's own.
    ///
    /// # Errors
    /// There is no control mesh that interpolates as asked.
    pub(super) fn new(
        read: Read,
        diagonal: Option<f64>,
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<Self> {
        let bulk = Bulk::as_shown(&read.mesh, &read.shown);
        let is_compared = arguments.way() == Way::Exact && !arguments.shared_topology;
        let surface = is_compared.then(|| Surface {
            positions: read.mesh.positions().to_vec(),
            triangles: read.mesh.triangles().to_vec(),
        });
        let featured = arguments.features.apply(read.mesh)?;
        let notes = [needles_in_words(&featured), corners_in_words(&featured)];
        progress.notes(notes.into_iter().flatten());
        let mut diagnosis = read.diagnosis;
        diagnosis.concave_corners = featured.concave.corners.clone();
        let (mesh, mut concave) = (featured.mesh, featured.concave);
        let diagonal = diagonal.unwrap_or_else(|| mesh.diagonal());
        let (mesh, interpolation) = match Nearness::of(arguments, &mesh, diagonal)? {
            Some(near) => {
                let (mesh, parts) = near.control(&mesh, arguments, progress)?;
                concave.parts = parts.after(&concave.parts);
                (mesh, None)
            }
            None if arguments.interpolation.is_led() => {
                let unit = arguments.build.unit;
                let scheme = arguments.scheme()?;
                interpolation::apply(mesh, arguments.interpolation, unit, scheme, progress)?
            }
            None => (mesh, None),
        };
        Ok(Self {
            mesh,
            concave,
            diagnosis,
            faces: read.faces,
            surface,
            residual: interpolation.as_ref().map_or(0.0, |report| report.residual),
            shown: read.shown,
            bulk,
            interpolation,
            diagonal,
        })
    }

    /// The mesh that was read, where somebody asks how far the result is from it.
    pub(super) fn surface(&self) -> Option<Triangles<'_>> {
        let own = self.surface.as_ref()?;
        Some(Triangles {
            positions: &own.positions,
            triangles: &own.triangles,
        })
    }
}

/// A note about edges that are not sharp though their faces meet at more than the crease angle.
fn needles_in_words(control: &Featured) -> Option<String> {
    let edges = counted(
        control.along_needles,
        "edge along needles is",
        "edges along needles are",
    );
    (control.along_needles > 0)
        .then(|| format!("{edges} not sharp: the faces beyond the needles decide"))
}

/// A note about sharp edges that divide corners of 180° and more.
fn corners_in_words(control: &Featured) -> Option<String> {
    let concave = &control.concave;
    let corners = counted(concave.corners.count, "corner", "corners");
    let divide = counted(concave.edges, "sharp edge divides", "sharp edges divide");
    (concave.edges > 0)
        .then(|| format!("{divide} {corners} of 180° or more, so that flat faces stay flat"))
}
