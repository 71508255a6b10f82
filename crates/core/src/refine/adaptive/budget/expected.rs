//! The distance within which a number of triangles is expected, told by undivided faces: where the search for a budget's begins.

use super::super::{Engine, block};
use crate::certificate::TriangleFrame;
use crate::parallel;
use crate::progress::Cancelled;
use crate::refine::RefineError;

/// Triangles that a face takes for each time that it is too high, about: some are less high than need be, others close gaps.
const FOR_ONE: f64 = 2.9;

/// The distance within which so many triangles are expected, by [`heights`]; `None` where all is flat.
///
/// Triangles' heights fall with the square of their size, so a face of height h takes about h/d triangles within d, and at least one:
/// with the k highest faces divided d = Σh/(wanted − others).
pub(super) fn expected(engine: &Engine<'_>, wanted: f64) -> Result<Option<f64>, RefineError> {
    let mut heights = heights(engine)?;
    parallel::sort_polled(&mut heights, &mut |_| engine.watch.poll(), |a, b| b.total_cmp(a))?;
    let (mut sum, mut others) = (0.0, heights.len() as f64);
    for (at, &height) in heights.iter().enumerate() {
        (sum, others) = (sum + FOR_ONE * height, others - 1.0);
        let distance = sum / (wanted - others);
        let next = heights.get(at + 1).map_or(0.0, |next| FOR_ONE * next);
        if wanted > others && distance >= next {
            return Ok(Some(distance).filter(|distance| *distance > 0.0 && distance.is_finite()));
        }
    }
    Ok(None)
}

/// How high the surface stands over the triangles of the control faces' corners, in the middles of their edges.
pub(super) fn heights(engine: &Engine<'_>) -> Result<Vec<f64>, Cancelled> {
    let control = engine.control;
    let faces = control.mesh.face_count();
    let height = |face: usize| {
        let piece = control.piece(face as u32);
        let frame = TriangleFrame::new(control.corners(face as u32).map(|corner| corner.position));
        let middles = piece.surface(control.rules).middles();
        middles.iter().map(|middle| frame.height(middle.position).abs()).fold(0.0, f64::max)
    };
    engine.watch.map(faces, block(faces), height)
}

#[cfg(test)]
mod tests {
    use super::super::super::demands::Demands;
    use super::super::super::judge::Goal;
    use super::super::super::with_engine;
    use super::*;
    use crate::mesh::Mesh;
    use crate::models;
    use crate::progress::unobserved;
    use crate::refine::ExactOptions;
    use crate::scheme::Loop;

    fn model(name: &str) -> Mesh {
        Mesh::from_soup(&models::find(name).unwrap().soup(), &Default::default()).unwrap().0
    }

    /// Counts that are expected are near those that come about.
    #[test]
    fn what_is_expected_is_of_the_right_size() {
        for name in ["torus", "sphere", "cup", "bunny", "teddy", "shoe"] {
            let mesh = model(name);
            let options = (&ExactOptions::default().triangles(1), &Demands::default());
            with_engine(&mesh, &Loop, options, &mut unobserved, |engine| {
                for wanted in [10_000.0, 40_000.0] {
                    let distance = expected(engine, wanted)?.unwrap();
                    let triangles =
                        engine.plan(Goal::Within(distance), usize::MAX)?.unwrap().triangles as f64;
                    assert!((0.5..1.6).contains(&(triangles / wanted)), "{name}, {wanted}: {triangles}");
                }
                Ok(())
            })
            .unwrap();
        }
    }
}
