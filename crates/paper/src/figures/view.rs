//! Figure 9: view-dependent refinement of the sphere and the bunny, in front view and from the side.
//!
//! The paper prints neither threshold nor steps. Two steps give its sphere's uniform count; of the thresholds
//! that it uses elsewhere, or might, the one whose sphere comes nearest to its adaptive count is drawn.

use limitmesh::Mesh;
use limitmesh::criterion::{LimitNormal, View, Viewpoint};
use limitmesh::refine::SeamRule;
use limitmesh_render::ViewDirection;
use serde::Serialize;

use super::Picture;
use crate::folder::Folder;
use crate::format::thousands;
use crate::methods;
use crate::paper_models::{Origin, Player};
use crate::pictures::Renderer;
use crate::readings::readings;
use crate::vector::{cross, dot, unit};

const STEPS: usize = 2;
/// Thresholds that are tried, as parts of π.
const PARTS_OF_PI: [u32; 7] = [90, 60, 45, 36, 18, 12, 9];

/// A model of Figure 9 with the paper's counts: uniform (zeros restored) and adaptive as printed.
pub(crate) struct Shown<'a> {
    pub(crate) player: &'a Player,
    pub(crate) paper_uniform: usize,
    pub(crate) paper_adaptive_printed: &'static str,
}

#[derive(Debug, Serialize)]
pub(crate) struct ViewFigure {
    pub(crate) models: Vec<ViewModel>,
    /// The threshold that is drawn, as a part of π.
    pub(crate) part_of_pi: u32,
}

#[derive(Debug, Serialize)]
pub(crate) struct ViewModel {
    pub(crate) name: &'static str,
    pub(crate) origin: Origin,
    pub(crate) control_faces: usize,
    pub(crate) uniform_faces: usize,
    pub(crate) paper_uniform: usize,
    pub(crate) paper_adaptive_printed: &'static str,
    pub(crate) paper_adaptive_readings: Vec<usize>,
    /// Faces at each threshold that was tried.
    pub(crate) tried: Vec<Tried>,
    /// Faces that look away from the viewer: of the control mesh, the uniform and the adaptive refinement.
    pub(crate) back_faces: [usize; 3],
    pub(crate) pictures: Vec<Picture>,
}

#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Tried {
    pub(crate) part_of_pi: u32,
    pub(crate) faces: usize,
}

impl ViewModel {
    /// The faces at one of the thresholds.
    pub(crate) fn faces_at(&self, part_of_pi: u32) -> Option<usize> {
        self.tried
            .iter()
            .find(|t| t.part_of_pi == part_of_pi)
            .map(|t| t.faces)
    }
}

/// Refines both models and draws them. The first decides on the threshold.
pub(crate) fn view_dependent(
    shown: &[Shown<'_>],
    renderer: &Renderer,
    folder: &mut Folder<'_>,
) -> anyhow::Result<ViewFigure> {
    let mut part_of_pi = None;
    let mut models = Vec::new();
    for show in shown {
        let mut model = scan(show)?;
        let chosen = *part_of_pi.get_or_insert_with(|| nearest_threshold(&model));
        draw(show, chosen, &mut model, renderer, folder)?;
        models.push(model);
    }
    Ok(ViewFigure {
        models,
        part_of_pi: part_of_pi.unwrap_or(PARTS_OF_PI[0]),
    })
}

/// The threshold whose count is nearest, in ratio, to a reading of the paper's, as a share of the uniform one.
fn nearest_threshold(model: &ViewModel) -> u32 {
    let scale = model.uniform_faces as f64 / model.paper_uniform as f64;
    let off = |tried: &Tried| {
        let ratios = model
            .paper_adaptive_readings
            .iter()
            .map(|&r| tried.faces as f64 / (r as f64 * scale));
        ratios
            .map(|ratio| ratio.ln().abs())
            .fold(f64::MAX, f64::min)
    };
    let best = model.tried.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    best.map_or(PARTS_OF_PI[0], |tried| tried.part_of_pi)
}

fn refine(player: &Player, part_of_pi: u32) -> anyhow::Result<Mesh> {
    let view = View {
        viewpoint: Viewpoint::Direction(player.front.sight),
        dilatation: 1.0,
    };
    let angle = std::f64::consts::PI / f64::from(part_of_pi);
    let criterion = LimitNormal::new(angle).view(view);
    Ok(methods::adaptive(&player.mesh, &criterion, STEPS, SeamRule::All)?.mesh)
}

/// The counts at all thresholds.
fn scan(show: &Shown<'_>) -> anyhow::Result<ViewModel> {
    let control = &show.player.mesh;
    let mut tried = Vec::new();
    for part_of_pi in PARTS_OF_PI {
        tried.push(Tried {
            part_of_pi,
            faces: refine(show.player, part_of_pi)?.face_count(),
        });
    }
    let low = show.paper_uniform >> (2 * STEPS);
    Ok(ViewModel {
        name: show.player.name,
        origin: show.player.origin.clone(),
        control_faces: control.face_count(),
        uniform_faces: control.face_count() << (2 * STEPS),
        paper_uniform: show.paper_uniform,
        paper_adaptive_printed: show.paper_adaptive_printed,
        paper_adaptive_readings: readings(show.paper_adaptive_printed, low, show.paper_uniform),
        tried,
        back_faces: [0; 3],
        pictures: Vec::new(),
    })
}

fn draw(
    show: &Shown<'_>,
    part_of_pi: u32,
    model: &mut ViewModel,
    renderer: &Renderer,
    folder: &mut Folder<'_>,
) -> anyhow::Result<()> {
    let player = show.player;
    let uniform = methods::uniform_plain(&player.mesh, STEPS)?.mesh;
    let adaptive = refine(player, part_of_pi)?;
    let front = player.front;
    model.back_faces =
        [&player.mesh, &uniform, &adaptive].map(|mesh| back_faces(mesh, front.sight));
    // The viewer of the front view is then on the left.
    let side = ViewDirection {
        sight: unit(cross(front.up, front.sight)),
        up: front.up,
    };
    for (mesh, view, key, words) in [
        (&uniform, front, "uniform", "uniform, front view"),
        (&adaptive, front, "front", "view-dependent, front view"),
        (
            &adaptive,
            side,
            "side",
            "view-dependent, from the side (the viewer is on the left)",
        ),
    ] {
        let file = format!("figure9-{}-{key}.png", player.name);
        folder.write(
            &file,
            &renderer.draw(mesh, &renderer.camera(&uniform, view)?)?,
        )?;
        let caption = format!("{words}: {} faces", thousands(mesh.face_count()));
        model.pictures.push(Picture::new(
            file,
            format!("{}, {caption}", player.name),
            caption,
        ));
    }
    Ok(())
}

/// Number of faces whose normal points along the direction of sight.
fn back_faces(mesh: &Mesh, sight: [f64; 3]) -> usize {
    mesh.topology()
        .faces()
        .filter(|&face| dot(mesh.face_normal(face), sight) > 0.0)
        .count()
}
