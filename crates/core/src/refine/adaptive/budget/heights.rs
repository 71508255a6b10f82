//! The distance within which a number of triangles is expected, by the heights of undivided faces: where the search for a budget's begins.

use super::super::Engine;
use crate::certificate::TriangleFrame;
use crate::parallel;
use crate::progress::Cancelled;
use crate::vector::hypotenuse;

/// Triangles that a face takes for each time that it is too high, about: some are less high than need be, others close gaps.
const FOR_ONE: f64 = 2.9;

/// The distance within which so many triangles are expected; `None` where all is flat, or where there are as many faces. Heights fall with the
/// square of the triangles' size, so a face of height h takes about c h/d triangles within d, and at least one: with the k highest faces
/// divided d = c Σh/(wanted − others).
pub(super) fn expected(engine: &Engine<'_>, wanted: f64) -> Result<Option<f64>, Cancelled> {
    let mut heights = heights(engine)?;
    parallel::sort_polled(&mut heights, &mut |_| engine.watch.poll(), |a, b| {
        b.total_cmp(a)
    })?;
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

/// How high the surface stands over the triangles of the control faces' corners, in the middles of their edges, and how far it is off the edges
/// that are open; 0 where that is no more than rounding.
fn heights(engine: &Engine<'_>) -> Result<Vec<f64>, Cancelled> {
    let (control, rounding) = (engine.control, engine.rounding);
    let faces = control.mesh.face_count();
    let height = |face: usize| {
        let piece = control.piece(face as u32);
        let corners = control.corners(face as u32).map(|corner| corner.position);
        let (frame, open) = (TriangleFrame::new(corners), control.open(face as u32));
        let middles = piece.surface(control.rules).middles();
        let off = |edge: usize| {
            let middle = middles[edge].position;
            let aside = if open[edge] {
                frame.outward(edge).dot(middle - corners[edge])
            } else {
                0.0
            };
            hypotenuse(frame.height(middle), aside)
        };
        let height = off(0).max(off(1)).max(off(2));
        if height > rounding { height } else { 0.0 }
    };
    engine.watch.map(faces, parallel::share(faces), height)
}
