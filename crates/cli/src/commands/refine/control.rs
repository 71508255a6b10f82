//! The control mesh of a refinement: what was read, with the tags that options put on it, made to interpolate if asked.

use std::time::{Duration, Instant};

use limitmesh::Mesh;

use super::interpolation;
use super::nearness::Nearness;
use crate::arguments::{Featured, RefineArguments, Way};
use crate::bulk::{Bulk, Shown};
use crate::format::counted;
use crate::progress::Progress;
use crate::report::InterpolationReport;
use limitmesh::mesh::Diagnosis;

/// What is refined, and what it is compared with.
pub(super) struct Control {
    pub(super) featured: Featured,
    pub(super) diagnosis: Diagnosis,
    /// The mesh that was read.
    pub(super) before: Before,
    /// How it is shown, and its area and volume then.
    pub(super) shown: Shown,
    pub(super) bulk: Bulk,
    pub(super) interpolation: Option<InterpolationReport>,
    /// What lengths are given in per cent of.
    pub(super) diagonal: f64,
    /// How long control points took.
    pub(super) took: Duration,
}

/// The mesh that was read, before corners were divided and control points moved.
pub(super) struct Before {
    /// Where somebody asks how far the result is from it.
    pub(super) surface: Option<BeforeSurface>,
    /// The input's face of each face.
    pub(super) faces: Vec<u32>,
    /// How far the limits of the control points are from its vertices at most, where they were moved for that.
    pub(super) residual: Option<f64>,
}

/// Positions and triangles of the mesh that was read.
pub(super) struct BeforeSurface {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Control {
    /// Of a mesh with the input's face of each of its faces. Lengths in per cent are of `diagonal`, or of the mesh's own.
    ///
    /// # Errors
    /// There is no control mesh that interpolates as asked.
    pub(super) fn new(
        (mesh, mut diagnosis, faces): (Mesh, Diagnosis, Vec<u32>),
        shown: Shown,
        diagonal: Option<f64>,
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<Self> {
        let start = Instant::now();
        let bulk = Bulk::as_shown(&mesh, &shown);
        let is_compared = arguments.way() == Way::Exact && !arguments.exact.no_input_distance;
        let surface = is_compared.then(|| BeforeSurface {
            positions: mesh.positions().to_vec(),
            triangles: mesh.triangles().to_vec(),
        });
        let featured = arguments.features.apply(mesh)?;
        for note in [along_needles(&featured), divided_corners(&featured)]
            .into_iter()
            .flatten()
        {
            progress.note(note);
        }
        diagnosis.concave_corners = featured.concave.corners.clone();
        let Featured {
            mesh,
            mut concave,
            along_needles,
        } = featured;
        let diagonal = diagonal.unwrap_or_else(|| mesh.diagonal());
        let (mesh, interpolation) = match Nearness::of(arguments, &mesh, diagonal)? {
            Some(near) => {
                let (mesh, parts) = near.control(&mesh, arguments, progress)?;
                concave.parts = parts.after(&concave.parts);
                (mesh, None)
            }
            None if arguments.interpolation.is_led() => {
                let asked = (arguments.interpolation, arguments.build.unit);
                interpolation::apply(mesh, asked, arguments.scheme()?, progress)?
            }
            None => (mesh, None),
        };
        let featured = Featured {
            mesh,
            concave,
            along_needles,
        };
        let before = Before {
            surface,
            faces,
            residual: interpolation.as_ref().map(|report| report.residual),
        };
        let took = start.elapsed();
        Ok(Self {
            featured,
            diagnosis,
            before,
            shown,
            bulk,
            interpolation,
            diagonal,
            took,
        })
    }
}

/// Tells about edges that are not sharp though their faces meet at more than the crease angle.
fn along_needles(control: &Featured) -> Option<String> {
    let edges = counted(control.along_needles, "edge", "edges");
    let are = if control.along_needles == 1 {
        "is"
    } else {
        "are"
    };
    (control.along_needles > 0)
        .then(|| format!("{edges} along needles {are} not sharp: the faces beyond these decide"))
}

/// Tells about sharp edges that divide corners of 180° and more.
fn divided_corners(control: &Featured) -> Option<String> {
    let concave = &control.concave;
    let corners = counted(concave.corners.count, "corner", "corners");
    let edges = counted(concave.edges, "sharp edge", "sharp edges");
    let divide = if concave.edges == 1 {
        "divides"
    } else {
        "divide"
    };
    (concave.edges > 0).then(|| {
        format!("{edges} {divide} {corners} of 180° or more, so that flat faces stay flat")
    })
}
