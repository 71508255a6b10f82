//! Figure 8: the shoe of 684 faces, two steps of the paper's method at π/18 and at π/36.

use limitmesh::refine::SeamRule;
use serde::Serialize;

use super::Picture;
use crate::folder::Folder;
use crate::format::thousands;
use crate::methods;
use crate::paper_models::{Origin, Player};
use crate::pictures::Renderer;
use crate::readings::readings;

const STEPS: usize = 2;
/// The paper's thresholds, and its counts as they read with their zeros lost.
const SETTINGS: [(f64, &str, &str); 2] = [(10.0, "π/18", "846"), (5.0, "π/36", "186")];

#[derive(Debug, Serialize)]
pub(crate) struct Shoe {
    pub(crate) origin: Origin,
    pub(crate) control_faces: usize,
    pub(crate) uniform_faces: usize,
    pub(crate) settings: Vec<ShoeSetting>,
    pub(crate) pictures: Vec<Picture>,
}

#[derive(Debug, Serialize)]
pub(crate) struct ShoeSetting {
    pub(crate) angle: &'static str,
    pub(crate) faces: usize,
    /// The paper's count as the text extracted from its PDF has it.
    pub(crate) printed: &'static str,
    /// What it may have been: between the control mesh's count and the uniform one's.
    pub(crate) readings: Vec<usize>,
}

/// Refines the shoe at both thresholds and draws it.
pub(crate) fn shoe(
    player: &Player,
    renderer: &Renderer,
    folder: &mut Folder<'_>,
) -> anyhow::Result<Shoe> {
    let control = &player.mesh;
    let control_faces = control.face_count();
    let uniform_faces = control_faces << (2 * STEPS);
    let camera = renderer.camera(control, player.view())?;
    folder.write("figure8-control.png", &renderer.draw(control, &camera)?)?;
    let caption = format!("control mesh: {} faces", thousands(control_faces));
    let mut pictures = vec![Picture::new(
        "figure8-control.png",
        format!("Shoe, {caption}"),
        caption,
    )];
    let mut settings = Vec::new();
    for (degrees, angle, printed) in SETTINGS {
        let mesh = methods::paper(control, degrees, STEPS, SeamRule::All)?.mesh;
        let file = format!("figure8-{degrees}.png");
        folder.write(&file, &renderer.draw(&mesh, &camera)?)?;
        let caption = format!("2 steps, {angle}: {} faces", thousands(mesh.face_count()));
        pictures.push(Picture::new(file, format!("Shoe, {caption}"), caption));
        let readings = readings(printed, control_faces, uniform_faces);
        settings.push(ShoeSetting {
            angle,
            faces: mesh.face_count(),
            printed,
            readings,
        });
    }
    Ok(Shoe {
        origin: player.origin.clone(),
        control_faces,
        uniform_faces,
        settings,
        pictures,
    })
}
