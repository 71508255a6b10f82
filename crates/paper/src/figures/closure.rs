//! Figure 5: indivisible faces with none, one, two and three divisible neighbours, drawn from real faces of the
//! models, before and after the step that covers them.

use limitmesh::Mesh;
use limitmesh::criterion::{Criterion, LimitNormal};
use limitmesh::index::{FaceId, HalfEdgeId};
use limitmesh::limit::LimitTable;
use limitmesh::refine::SeamRule;
use limitmesh::scheme::Loop;
use limitmesh_render::svg::{Drawing, Pen};
use limitmesh_render::{Align, RenderError};
use serde::Serialize;

use super::Picture;
use crate::folder::Folder;
use crate::methods;
use crate::palette::{AMRESH, INK, PALE, PAPER, plain, small, tinted};
use crate::paper_models::Player;
use crate::room::Room;
use crate::vector::{Vector, cross, dot, sub, unit};

/// The steps and angle whose cases are counted and drawn.
const STEPS: usize = 3;
const ANGLE_DEGREES: f64 = 10.0;

const FILE: &str = "figure5";

#[derive(Debug, Serialize)]
pub(crate) struct ClosureFigure {
    pub(crate) angle_degrees: f64,
    /// For each model and step: divisible faces, and indivisible ones by case (a) to (d).
    pub(crate) counts: Vec<ClosureCount>,
    /// Where the drawn faces are: model, step and face for each of the four cases; None where no model has one.
    pub(crate) drawn: [Option<Place>; 4],
    pub(crate) picture: Picture,
}

#[derive(Debug, Serialize)]
pub(crate) struct ClosureCount {
    pub(crate) model: &'static str,
    pub(crate) step: usize,
    pub(crate) divisible: usize,
    pub(crate) cases: [usize; 4],
}

#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Place {
    pub(crate) model: &'static str,
    pub(crate) step: usize,
    pub(crate) face: usize,
}

/// A face with its neighbours, before and after a step, in the plane of the face.
struct Example {
    place: Place,
    /// The better shaped and the flatter, the greater; 1 for four equilateral triangles in a plane.
    quality: f64,
    /// The face's corners before the step.
    before: Vec<[f64; 2]>,
    /// Triangles after the step, and which kind of face each covers.
    after: Vec<([[f64; 2]; 3], Kind)>,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Face,
    Divisible,
    Indivisible,
}

/// Counts the cases in all models and draws the best example of each.
pub(crate) fn closure(
    players: &[&Player],
    folder: &mut Folder<'_>,
) -> anyhow::Result<ClosureFigure> {
    let mut counts = Vec::new();
    let mut best: [Option<Example>; 4] = [None, None, None, None];
    for player in players {
        for report in methods::paper(&player.mesh, ANGLE_DEGREES, STEPS, SeamRule::All)?.steps {
            counts.push(ClosureCount {
                model: player.name,
                step: report.step,
                divisible: report.divisible,
                cases: report.closure,
            });
        }
        search(player, &mut best)?;
    }
    for room in Room::ALL {
        folder.write(&room.file(FILE), picture(&best, room)?.as_bytes())?;
    }
    Ok(ClosureFigure {
        angle_degrees: ANGLE_DEGREES,
        counts,
        drawn: best.map(|example| example.map(|e| e.place)),
        picture: Picture::drawn(
            FILE,
            "Four faces with none, one, two and three divided neighbours, and the triangles that cover them",
            "Indivisible faces (blue) beside divisible ones (orange) after a step; dashed: the face before it",
        ),
    })
}

/// Puts the best examples of a model's first two steps into `best`.
fn search(player: &Player, best: &mut [Option<Example>; 4]) -> anyhow::Result<()> {
    let mut mesh = player.mesh.clone();
    for step in 1..=2 {
        let criterion = LimitNormal::new(ANGLE_DEGREES.to_radians());
        let divisible = criterion.divisible(&mesh, &LimitTable::new(&Loop))?;
        let next = methods::adaptive(&mesh, &criterion, 1, SeamRule::All)?.mesh;
        let scene = Scene {
            mesh: &mesh,
            next: &next,
            starts: starts(&mesh, &divisible),
            divisible: &divisible,
        };
        // Cut sheets split edges for each other: their faces do not tell their case by their neighbours alone.
        if scene.starts.last() == Some(&next.face_count()) {
            for face in (0..mesh.face_count()).filter(|&face| !divisible[face]) {
                let place = Place {
                    model: player.name,
                    step,
                    face,
                };
                if let Some(example) = scene.example(place)
                    && let Some(slot) = best.get_mut(scene.divisible_neighbours(face))
                    && slot
                        .as_ref()
                        .is_none_or(|known| known.quality < example.quality)
                {
                    *slot = Some(example);
                }
            }
        }
        mesh = next;
    }
    Ok(())
}

/// Where each face's triangles start after the step: they stand together, in the order of the faces.
fn starts(mesh: &Mesh, divisible: &[bool]) -> Vec<usize> {
    let mut starts = vec![0];
    let mut total = 0;
    for (face, &flag) in divisible.iter().enumerate() {
        total += if flag {
            4
        } else {
            1 + neighbours(mesh, face).filter(|&n| divisible[n]).count()
        };
        starts.push(total);
    }
    starts
}

/// The faces across the edges of `face`.
fn neighbours(mesh: &Mesh, face: usize) -> impl Iterator<Item = usize> + '_ {
    let twin = move |corner| {
        mesh.topology()
            .twin(HalfEdgeId::of(FaceId(face as u32), corner))
    };
    (0..3).filter_map(twin).map(|h| h.face().index())
}

/// A mesh before and after a step.
struct Scene<'a> {
    mesh: &'a Mesh,
    next: &'a Mesh,
    starts: Vec<usize>,
    divisible: &'a [bool],
}

impl Scene<'_> {
    fn divisible_neighbours(&self, face: usize) -> usize {
        neighbours(self.mesh, face)
            .filter(|&n| self.divisible[n])
            .count()
    }

    /// The face of `place` as an example; None at a boundary.
    fn example(&self, place: Place) -> Option<Example> {
        let face = place.face;
        let around: Vec<usize> = neighbours(self.mesh, face).collect();
        if around.len() != 3 {
            return None;
        }
        let corners = self.mesh.as_triangles().corners(face);
        let normal = unit(self.mesh.face_normal(FaceId(face as u32)));
        let edge = unit(sub(corners[1], corners[0]));
        let upright = cross(normal, edge);
        let flat = |p: Vector| {
            let p = sub(p, corners[0]);
            [dot(p, edge), -dot(p, upright)]
        };
        let mut quality = shape(corners);
        let mut after = Vec::new();
        for (&covered, kind) in around
            .iter()
            .zip(around.iter().map(|&n| self.kind(n)))
            .chain([(&face, Kind::Face)])
        {
            let tilt = dot(normal, unit(self.mesh.face_normal(FaceId(covered as u32))));
            quality = quality
                .min(shape(self.mesh.as_triangles().corners(covered)))
                .min(tilt);
            for child in self.starts[covered]..self.starts[covered + 1] {
                after.push((self.next.as_triangles().corners(child).map(flat), kind));
            }
        }
        Some(Example {
            place,
            quality,
            before: corners.map(flat).to_vec(),
            after,
        })
    }

    fn kind(&self, face: usize) -> Kind {
        if self.divisible[face] {
            Kind::Divisible
        } else {
            Kind::Indivisible
        }
    }
}

/// How equilateral a triangle is: 4√3 times its area by the sum of its squared sides.
fn shape([a, b, c]: [Vector; 3]) -> f64 {
    let normal = cross(sub(b, a), sub(c, a));
    let squares: f64 = [sub(b, a), sub(c, b), sub(a, c)]
        .iter()
        .map(|&side| dot(side, side))
        .sum();
    if squares > 0.0 {
        2.0 * 3.0_f64.sqrt() * dot(normal, normal).sqrt() / squares
    } else {
        0.0
    }
}

const CAPTIONS: [&str; 4] = [
    "none divisible: left",
    "one: in two",
    "two: in three",
    "three: in four",
];

fn picture(examples: &[Option<Example>; 4], room: Room) -> Result<String, RenderError> {
    let (columns, panel) = room.pick((4, 240.0), (2, 0.5 * Room::NARROW));
    let height = panel + 54.0;
    let rows = examples.len() / columns;
    let mut drawing = Drawing::new(columns as f64 * panel, rows as f64 * height)?;
    for (case, example) in examples.iter().enumerate() {
        let corner = [
            (case % columns) as f64 * panel,
            (case / columns) as f64 * height,
        ];
        let centre = corner[0] + 0.5 * panel;
        let words = format!("({}) {}", ["a", "b", "c", "d"][case], CAPTIONS[case]);
        let below = corner[1] + panel;
        drawing.label(
            [centre, below + 18.0],
            &words,
            &plain().bold(true).align(Align::Centre),
        );
        let place = match example {
            Some(example) => {
                draw(&mut drawing, example, corner, panel);
                let Place { model, step, face } = example.place;
                format!("{model}, step {step}, face {face}")
            }
            None => "no such face in these models".to_owned(),
        };
        drawing.label(
            [centre, below + 38.0],
            &place,
            &small().align(Align::Centre),
        );
    }
    drawing.finish()
}

/// An example in a square.
fn draw(drawing: &mut Drawing, example: &Example, corner: [f64; 2], side: f64) {
    let points = || {
        example
            .after
            .iter()
            .flat_map(|(triangle, _)| triangle)
            .chain(&example.before)
    };
    let extent = |axis: usize| {
        points().fold((f64::MAX, f64::MIN), |(low, high), p| {
            (low.min(p[axis]), high.max(p[axis]))
        })
    };
    let ((left, right), (top, bottom)) = (extent(0), extent(1));
    let scale = (side - 28.0) / (right - left).max(bottom - top).max(f64::MIN_POSITIVE);
    let place = |p: [f64; 2]| {
        [
            corner[0] + 0.5 * side + scale * (p[0] - 0.5 * (left + right)),
            corner[1] + 0.5 * side + scale * (p[1] - 0.5 * (top + bottom)),
        ]
    };
    for (triangle, kind) in &example.after {
        let (fill, opacity) = match kind {
            Kind::Face => (PAPER, 0.38),
            Kind::Divisible => (AMRESH, 0.24),
            Kind::Indivisible => (PALE, 0.16),
        };
        tinted(
            drawing,
            &triangle.map(place),
            fill,
            opacity,
            &Pen::line(INK, 1.2),
        );
    }
    let before: Vec<[f64; 2]> = example.before.iter().map(|&p| place(p)).collect();
    drawing.polygon(&before, &Pen::line(PAPER, 1.4).dashes(&[5.0, 4.0]));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equilateral_triangle_has_shape_one_and_a_flat_one_none() {
        let equilateral = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.75_f64.sqrt(), 0.0]];
        assert!((shape(equilateral) - 1.0).abs() < 1e-12);
        assert!(shape([[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]).abs() < 1e-12);
    }
}
