//! The demand on a front and its test for a node: whether it is too far from the surface, and for
//! how long the outcome is certain while cameras move.
//!
//! **Cameras.** As the criterion for pixels proves, a distance V from a point that is seen at depth
//! z, φ off the axis, is at most F V / (cos φ (z − V)) pixels, F being those of a unit length at
//! depth 1. With d the distance from the eye to a ball that holds the node, z ≥ d cos φ, and cos φ
//! ≥ 1/G at the picture's corners, that is within a limit of p pixels if d ≥ V G (F G + p)/p. So a
//! node is divided where its ball is nearer to the eye than that and not outside a side of the
//! frame: which does not depend on the camera's rotation, except for the frame.
//!
//! **For how long.** An eye that moves by m changes d by m at most. Where it moves from e to e′ and
//! the outward normal n of a side of the frame becomes n′, (c − e′)·n′ − (c − e)·n = (e − e′)·n′ +
//! (c − e)·(n′ − n), at most |e − e′| + |c − e| |n′ − n|. So in addition to a clock that advances
//! by
//! |e − e′|, which distant nodes use, there is one that advances by |e − e′| + Λ|n′ − n|, Λ any
//! length, margins shrink no faster than the clock advances, those of sides at a distance beyond Λ
//! no faster than that times distance/Λ.

use super::forest::Extent;
use crate::criterion::{Camera, CriterionError, Lens};
use crate::vector::DVec3;

/// The most levels below a control face: paths take two bits a level.
pub const MOST_LEVELS: u32 = 30;

/// The most triangles, without another goal.
pub(super) const MOST_TRIANGLES: usize = 10_000_000;

/// The rounding error of margins relative to their terms.
const ROUNDING: f64 = 1e-12;

/// The demand on a front: the greatest distance of its triangles from the limit surface, and the
/// greatest number of triangles.
///
/// ```
/// use limitmesh::front::Demand;
/// // As near as 100,000 triangles allow.
/// let demand = Demand::tolerance(0.0).triangles(100_000);
/// # let _ = demand;
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Demand {
    pub(super) goal: Goal,
    /// The requested number.
    pub(super) most: Option<usize>,
    pub(super) max_levels: u32,
}

/// The goal that a node must meet.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Goal {
    /// A distance.
    Tolerance(f64),
    /// A distance in the pictures of cameras.
    Pixels(f64, Vec<Camera>),
}

impl Demand {
    /// Triangles within a distance of the limit surface, in the control mesh's units; 0 or more.
    pub fn tolerance(distance: f64) -> Self {
        Self::of(Goal::Tolerance(distance))
    }

    /// Triangles within `limit` pixels of the limit surface wherever one of the cameras sees it;
    /// invisible parts are left as coarse as their neighbours allow.
    pub fn pixels(limit: f64, cameras: &[Camera]) -> Self {
        Self::of(Goal::Pixels(limit, cameras.to_vec()))
    }

    fn of(goal: Goal) -> Self {
        Self {
            goal,
            most: None,
            max_levels: MOST_LEVELS,
        }
    }

    /// Limits the number of triangles; ten million by default. Where the goal needs more, the front
    /// has the least distance that does not. The control mesh's own triangles are always there.
    pub fn triangles(mut self, most: usize) -> Self {
        self.most = Some(most);
        self
    }

    /// No triangles of more levels below a control face; 30 at most, and by default.
    pub fn max_levels(mut self, levels: u32) -> Self {
        self.max_levels = levels.min(MOST_LEVELS);
        self
    }

    /// # Errors
    /// A limit out of range, or a camera without a direction of sight.
    pub fn check(&self) -> Result<(), CriterionError> {
        let (name, value, cameras) = match &self.goal {
            Goal::Tolerance(distance) => ("tolerance", *distance, &[][..]),
            Goal::Pixels(limit, cameras) => ("limit in pixels", *limit, &cameras[..]),
        };
        if !(value >= 0.0 && value.is_finite()) {
            return Err(CriterionError::BadParameter {
                name,
                value,
                expected: "a finite number from 0 on",
            });
        }
        cameras.iter().try_for_each(Camera::check)
    }
}

/// A camera, prepared for the test of nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Eye {
    at: DVec3,
    /// Outward normals of the frame's sides, and away from where it looks.
    sides: [DVec3; 5],
    /// G, 1/cos φ at the frame's corners.
    stretch: f64,
    /// F G², the factor by which pixels fall with the distance.
    pixels: f64,
}

impl Eye {
    fn of(camera: &Camera) -> Result<Self, CriterionError> {
        let Lens {
            eye,
            forward,
            sides: [right, left, top, bottom],
            pixels,
            greatest_stretch,
        } = Lens::new(camera)?;
        Ok(Self {
            at: eye,
            sides: [right, left, top, bottom, -forward],
            stretch: greatest_stretch,
            pixels: pixels * greatest_stretch * greatest_stretch,
        })
    }

    /// How far it is from another eye to this one, and how far clocks advance that count turns, too; infinitely far where their pictures
    /// differ.
    fn moved(&self, from: &Self, length: f64) -> [f64; 2] {
        if self.pixels != from.pixels || self.stretch != from.stretch {
            return [f64::INFINITY; 2];
        }
        let turned = self
            .sides
            .iter()
            .zip(&from.sides)
            .map(|(a, b)| a.distance(*b));
        let way = self.at.distance(from.at);
        [way, way + length * turned.fold(0.0, f64::max)]
    }

    /// How far outside the frame a ball is; below 0 where some of it may be inside.
    fn outside(&self, extent: &Extent) -> f64 {
        let sight = extent.centre - self.at;
        let sides = self.sides.iter().map(|side| side.dot(sight));
        sides.fold(f64::NEG_INFINITY, f64::max) - extent.radius
    }

    /// How many pixels away from the surface a node would be seen that was not outside the frame, its ball being at a distance.
    fn pixels_at(&self, extent: &Extent, distance: f64) -> f64 {
        if extent.value <= 0.0 {
            return 0.0;
        }
        let room = (distance - extent.radius) / extent.value - self.stretch;
        if room > 0.0 {
            self.pixels / room
        } else {
            f64::INFINITY
        }
    }

    /// How many pixels away from the surface a node may be seen.
    fn pixels(&self, extent: &Extent) -> f64 {
        let pixels = self.pixels_at(extent, extent.centre.distance(self.at));
        if pixels > 0.0 && self.outside(extent) > 0.0 {
            0.0
        } else {
            pixels
        }
    }

    /// Whether those are above a limit, and for how long that is certain.
    fn answer(&self, extent: &Extent, limit: f64, length: f64) -> Answer {
        let distance = extent.centre.distance(self.at);
        let near = extent.radius + extent.value * (self.stretch + self.pixels / limit);
        let rounding = ROUNDING * (distance + near + extent.centre.length() + self.at.length());
        let is_too_far = self.pixels_at(extent, distance) <= limit;
        if is_too_far {
            let margin = if extent.value > 0.0 {
                distance - near - rounding
            } else {
                f64::INFINITY
            };
            return Answer {
                wants: false,
                margin,
                turns: false,
            };
        }
        let outside = self.outside(extent);
        let slowed = outside.abs() * (length / distance).min(1.0) - rounding;
        let wants = outside <= 0.0 || outside.is_nan();
        let margin = if wants {
            slowed.min(near - distance - rounding)
        } else {
            slowed
        };
        Answer {
            wants,
            margin,
            turns: true,
        }
    }
}

/// The outcome of a node's test.
#[derive(Clone, Copy, Debug)]
pub(super) struct Answer {
    /// Whether it wants to be divided.
    pub(super) wants: bool,
    /// The advance of a clock for which the answer is certain; 0 if unknown.
    pub(super) margin: f64,
    /// Whether that clock counts turns, too.
    pub(super) turns: bool,
}

impl Answer {
    /// The answer for this camera and another one: one that wants the node is enough, and neither
    /// may begin to want it.
    fn and(self, other: Self) -> Self {
        let turns = self.turns || other.turns;
        match (self.wants, other.wants) {
            (true, true) => Self {
                margin: self.margin.max(other.margin),
                turns,
                ..self
            },
            (true, false) => self,
            (false, true) => other,
            (false, false) => Self {
                margin: self.margin.min(other.margin),
                turns,
                ..self
            },
        }
    }
}

/// The test of nodes: whether a measure is above a limit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Question {
    /// The cameras; without them, distances are measured.
    pub(super) eyes: Option<Vec<Eye>>,
    pub(super) limit: f64,
    pub(super) max_levels: u32,
}

impl Question {
    /// # Errors
    /// A camera that looks nowhere.
    pub(super) fn of(demand: &Demand) -> Result<Self, CriterionError> {
        let (eyes, limit) = match &demand.goal {
            Goal::Tolerance(distance) => (None, *distance),
            Goal::Pixels(limit, cameras) => {
                let eyes: Result<Vec<Eye>, _> = cameras.iter().map(Eye::of).collect();
                (Some(eyes?), *limit)
            }
        };
        Ok(Self {
            eyes,
            limit,
            max_levels: demand.max_levels,
        })
    }

    /// The value that is compared with the limit.
    pub(super) fn measure(&self, extent: &Extent) -> f64 {
        match &self.eyes {
            None => extent.value,
            Some(eyes) => eyes
                .iter()
                .map(|eye| eye.pixels(extent))
                .fold(0.0, f64::max),
        }
    }

    /// Whether a node is to be divided for the sake of a camera.
    pub(super) fn answer(&self, extent: &Extent, length: f64) -> Answer {
        let unwanted = Answer {
            wants: false,
            margin: f64::INFINITY,
            turns: false,
        };
        let eyes = self.eyes.iter().flatten();
        let answer = eyes
            .map(|eye| eye.answer(extent, self.limit, length))
            .fold(unwanted, Answer::and);
        Answer {
            margin: if answer.margin > 0.0 {
                answer.margin
            } else {
                0.0
            },
            ..answer
        }
    }

    /// How far clocks advance from another question to this one, without turns and with them;
    /// infinitely far where margins do not apply.
    pub(super) fn moved(&self, from: &Self, length: f64) -> [f64; 2] {
        match (&self.eyes, &from.eyes) {
            (Some(eyes), Some(before))
                if eyes.len() == before.len() && self.limit == from.limit =>
            {
                let moved = eyes
                    .iter()
                    .zip(before)
                    .map(|(eye, before)| eye.moved(before, length));
                moved.fold([0.0; 2], |most, own| {
                    [most[0].max(own[0]), most[1].max(own[1])]
                })
            }
            _ => [f64::INFINITY; 2],
        }
    }
}
