//! Figure 7: the head of 142 faces, three uniform steps beside three steps of the paper's method at π/36; and the same for an
//! ellipsoid of as many faces, since how many are divided depends on how evenly a mesh bends.

use limitmesh::refine::SeamRule;
use serde::Serialize;

use super::Picture;
use crate::folder::Folder;
use crate::format::thousands;
use crate::matching::match_angle;
use crate::methods;
use crate::paper_models::{Origin, Player};
use crate::pictures::Renderer;
use crate::study::SEAMS;

const STEPS: usize = 3;
/// π/36.
const ANGLE_DEGREES: f64 = 5.0;
/// Printed as 988: 142 faces split in four three times.
pub(crate) const PAPER_UNIFORM: usize = 9088;
/// The paper's count of its method's faces.
pub(crate) const PAPER_ADAPTIVE: usize = 3954;

/// One head, or the ellipsoid.
#[derive(Debug, Serialize)]
pub(crate) struct Head {
    pub(crate) name: &'static str,
    pub(crate) origin: Origin,
    pub(crate) control_faces: usize,
    pub(crate) uniform_faces: usize,
    pub(crate) adaptive_faces: usize,
    /// Faces by seam rule, at the same angle.
    pub(crate) by_seam: Vec<(&'static str, usize)>,
    /// The angle whose count is nearest to the paper's, and that count.
    pub(crate) matching_angle_degrees: f64,
    pub(crate) matching_faces: usize,
    pub(crate) pictures: Vec<Picture>,
}

impl Head {
    /// How far its adaptive count is from the paper's, in per cent.
    pub(crate) fn off_percent(&self) -> f64 {
        100.0 * (self.adaptive_faces as f64 / PAPER_ADAPTIVE as f64 - 1.0)
    }
}

/// Refines a head both ways and draws it.
pub(crate) fn head(
    player: &Player,
    renderer: &Renderer,
    folder: &mut Folder<'_>,
) -> anyhow::Result<Head> {
    let control = &player.mesh;
    let uniform = methods::uniform_plain(control, STEPS)?.mesh;
    let refine = |angle, seam| methods::paper(control, angle, STEPS, seam);
    let adaptive = refine(ANGLE_DEGREES, SeamRule::All)?.mesh;
    let mut by_seam = Vec::new();
    for (seam, name) in SEAMS {
        by_seam.push((name, refine(ANGLE_DEGREES, seam)?.mesh.face_count()));
    }
    let matching = match_angle(PAPER_ADAPTIVE, ANGLE_DEGREES, |angle| {
        refine(angle, SeamRule::All)
    })?;
    let camera = renderer.camera(control, player.view())?;
    let place = if player.origin.file {
        "file"
    } else {
        "builtin"
    };
    let name = player.name;
    let mut pictures = Vec::new();
    for (mesh, step, words) in [
        (control, "control", "control mesh"),
        (&uniform, "uniform", "uniform, 3 steps"),
        (&adaptive, "adaptive", "limit normal, π/36, 3 steps"),
    ] {
        let file = format!("figure7-{name}-{place}-{step}.png");
        folder.write(&file, &renderer.draw(mesh, &camera)?)?;
        let caption = format!("{words}: {} faces", thousands(mesh.face_count()));
        pictures.push(Picture::new(file, format!("{name}, {caption}"), caption));
    }
    Ok(Head {
        name,
        origin: player.origin.clone(),
        control_faces: control.face_count(),
        uniform_faces: uniform.face_count(),
        adaptive_faces: adaptive.face_count(),
        by_seam,
        matching_angle_degrees: matching.angle_degrees,
        matching_faces: matching.refinement.mesh.face_count(),
        pictures,
    })
}
