//! Figure 8: the shoe of 684 faces, two steps of the paper's method at π/18 and at π/36.

use limitmesh::refine::SeamRule;
use serde::Serialize;

use super::Picture;
use crate::reproduce::cast::{Origin, Player};
use crate::reproduce::folder::Folder;
use crate::reproduce::methods;
use crate::reproduce::readings::readings;
use crate::reproduce::studio::Studio;
use crate::words::thousands;

const STEPS: usize = 2;
/// The paper's thresholds, and its counts as they read with their zeros lost.
const SETTINGS: [(f64, &str, &str); 2] = [(10.0, "π/18", "846"), (5.0, "π/36", "186")];

#[derive(Debug, Serialize)]
pub(in crate::reproduce) struct Shoe {
    pub(in crate::reproduce) origin: Origin,
    pub(in crate::reproduce) control_faces: usize,
    pub(in crate::reproduce) uniform_faces: usize,
    pub(in crate::reproduce) settings: Vec<ShoeSetting>,
    pub(in crate::reproduce) pictures: Vec<Picture>,
}

#[derive(Debug, Serialize)]
pub(in crate::reproduce) struct ShoeSetting {
    pub(in crate::reproduce) angle: &'static str,
    pub(in crate::reproduce) faces: usize,
    /// The paper's count as the text extracted from its PDF has it.
    pub(in crate::reproduce) printed: &'static str,
    /// What it may have been: between the control mesh's count and the uniform one's.
    pub(in crate::reproduce) readings: Vec<usize>,
}

/// Refines the shoe at both thresholds and draws it.
pub(in crate::reproduce) fn shoe(
    player: &Player,
    studio: &Studio,
    folder: &mut Folder,
) -> anyhow::Result<Shoe> {
    let control = &player.mesh;
    let control_faces = control.face_count();
    let uniform_faces = control_faces << (2 * STEPS);
    let camera = studio.camera(control, player.view())?;
    folder.write("figure8-control.png", &studio.draw(control, &camera)?)?;
    let caption = format!("control mesh: {} faces", thousands(control_faces));
    let mut pictures = vec![Picture::new("figure8-control.png", format!("Shoe, {caption}"), caption)];
    let mut settings = Vec::new();
    for (degrees, angle, printed) in SETTINGS {
        let mesh = methods::paper(control, degrees, STEPS, SeamRule::All)?.mesh;
        let file = format!("figure8-{degrees}.png");
        folder.write(&file, &studio.draw(&mesh, &camera)?)?;
        let caption = format!("2 steps, {angle}: {} faces", thousands(mesh.face_count()));
        pictures.push(Picture::new(file, format!("Shoe, {caption}"), caption));
        let readings = readings(printed, control_faces, uniform_faces);
        settings.push(ShoeSetting { angle, faces: mesh.face_count(), printed, readings });
    }
    Ok(Shoe { origin: player.origin.clone(), control_faces, uniform_faces, settings, pictures })
}
