//! The effort of a bound: the distance that is good enough, the expected neighbours, and the most
//! halvings of pieces.

use super::hull_points::{DeviationBound, HullPoint};
use super::triangle_frame::TriangleFrame;
use super::trilinear::TrilinearFrame;

/// Halvings of a net for the bound of a curve: each takes little of the net along.
const RIM_HALVINGS: usize = 6;

/// When a bound is good enough, and how much may be done to get there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Distance below which a bound is good enough.
    pub(crate) target: f64,
    /// How often a regular piece may be halved.
    pub(crate) halvings: usize,
    /// Which edges have no neighbour.
    pub(crate) open: [bool; 3],
    /// Whether nothing counts but the curves over these.
    pub(crate) rim_alone: bool,
    /// Expected chords of the angles between the triangle and its neighbours, by edge.
    pub(crate) chords: [f64; 3],
    /// Expected greatest slopes, by edge.
    pub(crate) slopes: [f64; 3],
    /// Whether the distance of a triangle that certainly misses the target is not needed.
    pub(crate) gives_up: bool,
    /// Then the least chord of angles that can count, with slopes no greater than those expected: a
    /// bound beyond the target with it stays beyond it.
    pub(crate) least_chord: Option<f64>,
}

impl Effort {
    /// For triangles of flat regions, of whose edges the open ones count alone.
    pub(crate) fn along_rim(target: f64, open: [bool; 3]) -> Self {
        let (chords, slopes) = ([0.0; 3], [0.0; 3]);
        Self {
            target,
            halvings: RIM_HALVINGS,
            open,
            rim_alone: true,
            chords,
            slopes,
            gives_up: false,
            least_chord: None,
        }
    }

    /// The bound of a triangle that looks as far as this says.
    pub(super) fn bound<'f, P: HullPoint>(&self, frame: &'f P::Frame) -> DeviationBound<'f, P> {
        DeviationBound {
            frame,
            open: self.open,
            rim_alone: self.rim_alone,
        }
    }

    /// The triangle's own frame, if it can represent points.
    pub(super) fn seen_from(&self, frame: &TriangleFrame) -> Option<TrilinearFrame> {
        let has_neighbours = !self.rim_alone && self.open == [false; 3];
        has_neighbours.then(|| TrilinearFrame::of(frame)).flatten()
    }
}
