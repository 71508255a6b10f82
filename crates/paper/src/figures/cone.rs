//! Figure 2: the cone of normals at one vertex of a real model over two uniform steps: how the normals of its
//! faces come to lie within the cone of angle α around the limit normal.
//!
//! Drawn twice: in space, and looking down the limit normal, where a face normal stands at its angle from the
//! limit normal and the cone is a circle.

use limitmesh::Mesh;
use limitmesh::index::VertexId;
use limitmesh::limit::LimitTable;
use limitmesh::scheme::Loop;
use limitmesh_render::svg::{Drawing, Pen};
use limitmesh_render::{Align, RenderError};
use serde::Serialize;

use super::Picture;
use crate::folder::Folder;
use crate::methods;
use crate::palette::{self, AMRESH, GRID, INK, PALE, PAPER, plain, thin, tinted};
use crate::paper_models::Player;
use crate::room::Room;
use crate::vector::{Vector, add_scaled, angle_degrees, cross, dot, sub, tangents, unit};

/// The cone's angle α, in degrees.
const ALPHA: f64 = 10.0;
const STEPS: usize = 2;

const FILE: &str = "figure2";

const VALENCES: std::ops::RangeInclusive<u32> = 5..=7;

#[derive(Debug, Serialize)]
pub(crate) struct ConeFigure {
    pub(crate) model: &'static str,
    pub(crate) vertex: u32,
    pub(crate) alpha_degrees: f64,
    /// The vertex's limit normal on the control mesh.
    pub(crate) limit_normal: Vector,
    pub(crate) stages: Vec<Stage>,
    pub(crate) picture: Picture,
}

/// The vertex after so many steps.
#[derive(Debug, Serialize)]
pub(crate) struct Stage {
    pub(crate) step: usize,
    /// Angle between the limit normal computed on this mesh and that on the control mesh: rounding alone.
    pub(crate) limit_normal_turn_degrees: f64,
    /// Angles of the normals of the faces around the vertex from the limit normal, counter-clockwise.
    pub(crate) angles_degrees: Vec<f64>,
    #[serde(skip)]
    faces: Vec<[Vector; 3]>,
    #[serde(skip)]
    centre: Vector,
}

impl Stage {
    /// The greatest of the angles.
    pub(crate) fn greatest(&self) -> f64 {
        self.angles_degrees.iter().copied().fold(0.0, f64::max)
    }
}

/// Finds a vertex as in the paper's figure, and draws it. None where no vertex of the model has the cone's
/// angle exceeded at first and kept after two steps.
pub(crate) fn cone(player: &Player, folder: &mut Folder<'_>) -> anyhow::Result<Option<ConeFigure>> {
    let mut meshes = vec![player.mesh.clone()];
    for step in 1..=STEPS {
        meshes.push(methods::uniform_plain(&player.mesh, step)?.mesh);
    }
    let table = LimitTable::new(&Loop);
    let normals = meshes
        .iter()
        .map(|mesh| table.normals(mesh))
        .collect::<Result<Vec<_>, _>>()?;
    let Some(vertex) = choose(&meshes, &normals) else {
        return Ok(None);
    };
    let normal = normals[0][vertex.index()];
    let stages: Vec<Stage> = meshes
        .iter()
        .enumerate()
        .map(|(step, mesh)| {
            let faces = faces_around(mesh, vertex);
            Stage {
                step,
                limit_normal_turn_degrees: angle_degrees(normals[step][vertex.index()], normal),
                angles_degrees: faces
                    .iter()
                    .map(|&f| angle_degrees(face_normal(f), normal))
                    .collect(),
                centre: mesh.positions()[vertex.index()],
                faces,
            }
        })
        .collect();
    for room in Room::ALL {
        folder.write(&room.file(FILE), picture(&stages, normal, room)?.as_bytes())?;
    }
    let picture = Picture::drawn(
        FILE,
        "Face normals around a vertex entering the cone around its limit normal over two steps",
        format!(
            "The faces around the vertex (each ring drawn at the same size), the cone of {ALPHA}° around the limit \
             normal (black) and the face normals; and the same looking down the limit normal."
        ),
    );
    let (model, vertex) = (player.name, vertex.0);
    Ok(Some(ConeFigure {
        model,
        vertex,
        alpha_degrees: ALPHA,
        limit_normal: normal,
        stages,
        picture,
    }))
}

/// The vertex all of whose face normals enter the cone, not before the last step, from farthest outside.
fn choose(meshes: &[Mesh], normals: &[Vec<Vector>]) -> Option<VertexId> {
    let control = meshes.first()?;
    let mut best: Option<(f64, VertexId)> = None;
    for vertex in control.topology().vertices() {
        let (valence, open) = control.topology().valence_and_openness(vertex);
        if open || !VALENCES.contains(&valence) {
            continue;
        }
        let normal = normals.first()?[vertex.index()];
        let mut spread = meshes.iter().map(|mesh| {
            let angles = faces_around(mesh, vertex)
                .into_iter()
                .map(|f| angle_degrees(face_normal(f), normal));
            angles.fold((f64::MAX, 0.0), |(least, most): (f64, f64), a| {
                (least.min(a), most.max(a))
            })
        });
        let (first, middle, last) = (spread.next()?, spread.next()?, spread.next()?);
        // All normals start outside; some are still outside after one step.
        let as_drawn = first.1 < 75.0 && middle.1 > ALPHA && last.1 < ALPHA;
        if as_drawn && best.is_none_or(|(least, _)| first.0 > least) {
            best = Some((first.0, vertex));
        }
    }
    best.map(|(_, vertex)| vertex)
}

/// The corners of the faces around a vertex, counter-clockwise, the vertex first.
fn faces_around(mesh: &Mesh, vertex: VertexId) -> Vec<[Vector; 3]> {
    let topology = mesh.topology();
    let place = |v: VertexId| mesh.positions()[v.index()];
    let corners = |h| {
        [
            place(vertex),
            place(topology.target(h)),
            place(topology.opposite(h)),
        ]
    };
    topology.outgoing_ring(vertex).map(corners).collect()
}

fn face_normal([a, b, c]: [Vector; 3]) -> Vector {
    unit(cross(sub(b, a), sub(c, a)))
}

const PANEL: f64 = 300.0;
const SPACE_HEIGHT: f64 = 270.0;

/// Height of a stage on a phone, where both of its pictures stand side by side.
const ROW: f64 = 236.0;

fn picture(stages: &[Stage], normal: Vector, room: Room) -> Result<String, RenderError> {
    let count = stages.len() as f64;
    let (width, height) = room.pick(
        (PANEL * count, SPACE_HEIGHT + PANEL + 20.0),
        (Room::NARROW, ROW * count),
    );
    let scale = room.pick(1.0, 0.5 * Room::NARROW / PANEL);
    let mut drawing = Drawing::new(width, height)?;
    let widest = stages.iter().map(Stage::greatest).fold(ALPHA, f64::max);
    for (index, stage) in stages.iter().enumerate() {
        let [x, y] = room.pick([PANEL * index as f64, 0.0], [0.0, ROW * index as f64]);
        let title = match stage.step {
            0 => "(a) control mesh".to_owned(),
            1 => "(b) after one step".to_owned(),
            step => format!("(c) after {step} steps"),
        };
        let middle = x + 0.5 * room.pick(PANEL, Room::NARROW);
        drawing.label(
            [middle, y + 20.0],
            &title,
            &plain().bold(true).align(Align::Centre),
        );
        let [space, above] = room.pick(
            [[middle, 178.0], [middle, SPACE_HEIGHT + 0.5 * PANEL]],
            [[0.25 * width, y + 140.0], [0.75 * width, y + 120.0]],
        );
        in_space(&mut drawing, stage, normal, space, scale);
        from_above(&mut drawing, stage, normal, widest, above, scale);
        let greatest = format!("greatest {:.1}°, cone {ALPHA}°", stage.greatest());
        let below = [above[0], above[1] + 0.5 * PANEL * scale - 4.0];
        drawing.label(below, &greatest, &plain().align(Align::Centre));
    }
    drawing.finish()
}

fn colour(angle: f64) -> [u8; 3] {
    if angle > ALPHA { AMRESH } else { PAPER }
}

/// The ring, the cone and the normals, seen from the side and a little from above.
fn in_space(drawing: &mut Drawing, stage: &Stage, normal: Vector, origin: [f64; 2], scale: f64) {
    let [u, v] = tangents(normal);
    // Heights are drawn in full; depth is foreshortened as from 25° above the tangent plane.
    let (rise, depth) = (25.0_f64.to_radians().cos(), 25.0_f64.to_radians().sin());
    let size = stage.faces.iter().flatten().map(|&p| {
        let d = sub(p, stage.centre);
        dot(d, d).sqrt()
    });
    let (ring, arrow) = (
        105.0 * scale / size.fold(f64::MIN_POSITIVE, f64::max),
        120.0 * scale,
    );
    let flat = |d: Vector| {
        [
            origin[0] + dot(d, u),
            origin[1] - rise * dot(d, normal) + depth * dot(d, v),
        ]
    };
    let mut faces: Vec<(f64, [[f64; 2]; 3], f64)> = Vec::new();
    for (face, &angle) in stage.faces.iter().zip(&stage.angles_degrees) {
        let corners = face.map(|p| sub(p, stage.centre).map(|c| ring * c));
        let far = corners.iter().map(|&c| dot(c, v)).sum::<f64>();
        faces.push((far, corners.map(flat), angle));
    }
    faces.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, corners, angle) in &faces {
        tinted(drawing, corners, colour(*angle), 0.16, &thin(INK));
    }
    let alpha = ALPHA.to_radians();
    let rim: Vec<[f64; 2]> = (0..72)
        .map(|i| {
            let turn = f64::from(i) * std::f64::consts::TAU / 72.0;
            let side = add_scaled(u.map(|c| c * turn.cos()), turn.sin(), v);
            flat(add_scaled(normal.map(|c| c * alpha.cos()), alpha.sin(), side).map(|c| arrow * c))
        })
        .collect();
    let ends = [rim[0], rim[36]];
    drawing.polygon(&[origin, ends[0], ends[1]], &Pen::area(GRID).opacity(0.8));
    tinted(drawing, &rim, GRID, 0.8, &thin(PALE));
    for end in ends {
        drawing.line(origin, end, &thin(PALE));
    }
    for (face, &angle) in stage.faces.iter().zip(&stage.angles_degrees) {
        drawing.arrow(
            origin,
            flat(face_normal(*face).map(|c| arrow * c)),
            &Pen::line(colour(angle), 1.7),
        );
    }
    drawing.arrow(
        origin,
        flat(normal.map(|c| arrow * c)),
        &Pen::line(INK, 2.2),
    );
}

/// The normals by angle and direction around the limit normal.
fn from_above(
    drawing: &mut Drawing,
    stage: &Stage,
    normal: Vector,
    widest: f64,
    centre: [f64; 2],
    scale: f64,
) {
    let [u, v] = tangents(normal);
    let scale = 118.0 * scale / widest;
    drawing.circle(centre, scale * ALPHA, &thin(PALE).fill(GRID));
    let mut ring = 2.0 * ALPHA;
    while ring <= widest {
        drawing.circle(centre, scale * ring, &thin(GRID));
        ring += ALPHA;
    }
    let place = |n: Vector, angle: f64| {
        let direction = [dot(n, u), dot(n, v)];
        let length = direction[0].hypot(direction[1]).max(f64::MIN_POSITIVE);
        [
            centre[0] + scale * angle * direction[0] / length,
            centre[1] + scale * angle * direction[1] / length,
        ]
    };
    for (face, &angle) in stage.faces.iter().zip(&stage.angles_degrees) {
        let at = place(face_normal(*face), angle);
        drawing.line(centre, at, &Pen::line(colour(angle), 1.2).opacity(0.6));
        palette::dot(drawing, at, 5.0, colour(angle));
    }
    drawing.circle(centre, 4.0, &Pen::area(INK));
}
