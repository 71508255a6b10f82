//! Figure 7: the head of 142 faces, three uniform steps beside three steps of the paper's method at π/36.

use limitmesh::refine::SeamRule;
use serde::Serialize;

use super::Picture;
use crate::reproduce::cast::{Origin, Player};
use crate::reproduce::folder::Folder;
use crate::reproduce::methods;
use crate::reproduce::studio::Studio;
use crate::reproduce::study::SEAMS;
use crate::words::thousands;

const STEPS: usize = 3;
/// π/36.
const ANGLE_DEGREES: f64 = 5.0;
/// Printed as 988: 142 faces split in four three times.
pub(in crate::reproduce) const PAPER_UNIFORM: usize = 9088;
/// The paper's count of its method's faces.
pub(in crate::reproduce) const PAPER_ADAPTIVE: usize = 3954;

/// One head.
#[derive(Debug, Serialize)]
pub(in crate::reproduce) struct Head {
    pub(in crate::reproduce) origin: Origin,
    pub(in crate::reproduce) control_faces: usize,
    pub(in crate::reproduce) uniform_faces: usize,
    pub(in crate::reproduce) adaptive_faces: usize,
    /// Faces by seam rule, at the same angle.
    pub(in crate::reproduce) by_seam: Vec<(&'static str, usize)>,
    /// The angle whose count is nearest to the paper's, and that count.
    pub(in crate::reproduce) matching_angle_degrees: f64,
    pub(in crate::reproduce) matching_faces: usize,
    pub(in crate::reproduce) pictures: Vec<Picture>,
}

/// Refines a head both ways and draws it.
pub(in crate::reproduce) fn head(
    player: &Player,
    studio: &Studio,
    folder: &mut Folder,
) -> anyhow::Result<Head> {
    let control = &player.mesh;
    let uniform = methods::uniform_plain(control, STEPS)?.mesh;
    let refine = |angle, seam| methods::paper(control, angle, STEPS, seam).map(|r| r.mesh);
    let adaptive = refine(ANGLE_DEGREES, SeamRule::All)?;
    let mut by_seam = Vec::new();
    for (seam, name) in SEAMS {
        by_seam.push((name, refine(ANGLE_DEGREES, seam)?.face_count()));
    }
    let matching = methods::nearest(PAPER_ADAPTIVE, |angle| refine(angle, SeamRule::All))?;
    let camera = studio.camera(control, player.view())?;
    let place = if player.origin.file { "file" } else { "builtin" };
    let mut pictures = Vec::new();
    for (mesh, step, words) in [
        (control, "control", "control mesh"),
        (&uniform, "uniform", "uniform, 3 steps"),
        (&adaptive, "adaptive", "limit normal, π/36, 3 steps"),
    ] {
        let file = format!("figure7-{place}-{step}.png");
        folder.write(&file, &studio.draw(mesh, &camera)?)?;
        let caption = format!("{words}: {} faces", thousands(mesh.face_count()));
        pictures.push(Picture::new(file, format!("Head, {caption}"), caption));
    }
    Ok(Head {
        origin: player.origin.clone(),
        control_faces: control.face_count(),
        uniform_faces: uniform.face_count(),
        adaptive_faces: adaptive.face_count(),
        by_seam,
        matching_angle_degrees: matching.angle_degrees,
        matching_faces: matching.mesh.face_count(),
        pictures,
    })
}
