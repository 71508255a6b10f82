//! The results of measuring emitted triangles among their neighbours ([`super::measure`]): of one triangle, of one that was there
//! before, and of all of a control face.

use super::quadtree::NodeAddress;
use crate::certificate::exceeds;

/// A leaf with a triangle that fails, and its value.
pub(super) type Failing = (NodeAddress, f64);

/// The values of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Value {
    /// Of the distance.
    pub(super) bound: f64,
    /// By the criteria; the bound where there are none.
    pub(super) value: f64,
    /// In the cameras' pictures.
    pub(super) pixels: f64,
}

impl Value {
    /// That of a triangle of which nothing but the distance counts.
    pub(super) fn of(bound: f64) -> Self {
        Self {
            bound,
            value: bound,
            pixels: 0.0,
        }
    }

    /// That of a triangle that fails by a point so far off.
    pub(super) fn failing(least: f64) -> Self {
        Self {
            bound: f64::INFINITY,
            ..Self::of(least)
        }
    }

    /// The lesser of two proofs.
    pub(super) fn least(&self, other: &Self) -> Self {
        Self {
            bound: self.bound.min(other.bound),
            value: self.value.min(other.value),
            pixels: self.pixels.min(other.pixels),
        }
    }
}

/// The last measured values of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct FoundLast {
    /// How far its corners were moved; not numbers as long as it was not measured.
    pub(super) offsets: [f64; 3],
    /// The bound of its distance; its value by the criteria, which may be finite where the bound is not; and the height of the surface over it.
    pub(super) bound: f64,
    pub(super) value: f64,
    pub(super) height: f64,
}

impl FoundLast {
    pub(super) const NOTHING: Self = Self {
        offsets: [f64::NAN; 3],
        bound: f64::INFINITY,
        value: f64::INFINITY,
        height: 0.0,
    };
}

/// The values of a control face's triangles.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    /// The greatest bound of a distance, and the leaf that has it.
    pub(super) worst: (f64, NodeAddress),
    /// The greatest height of the surface over a triangle, about, and the leaf.
    pub(super) highest: (f64, NodeAddress),
    /// The greatest value.
    pub(super) value: f64,
    /// The greatest distance in the cameras' pictures, in pixels.
    pub(super) pixels: f64,
    /// The greatest normal deviation of a triangle, and the least tangent of an angle.
    pub(super) normal_deviation: f64,
    pub(super) slope: f64,
    /// Leaves that fail, in the order of the walk, and their values.
    pub(super) failing: Vec<(NodeAddress, f64)>,
    /// The last values of each triangle, this time's or earlier, where they are kept.
    pub(super) each: Vec<FoundLast>,
}

impl Measured {
    /// Before anything was measured.
    pub(super) fn nothing(face: u32) -> Self {
        let nowhere = (0.0, NodeAddress::root(face));
        Self {
            worst: nowhere,
            highest: nowhere,
            value: 0.0,
            pixels: 0.0,
            normal_deviation: 0.0,
            slope: f64::INFINITY,
            failing: Vec::new(),
            each: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, place: NodeAddress, value: &Value, height: f64) {
        if exceeds(height, self.highest.0) {
            self.highest = (height, place);
        }
        if exceeds(value.bound, self.worst.0) {
            self.worst = (value.bound, place);
        }
        if exceeds(value.value, self.value) {
            self.value = value.value;
        }
        self.pixels = self.pixels.max(value.pixels);
    }

    /// Takes the values of all triangles of the control face, or adds those of some while those of others are not kept.
    pub(super) fn replace(&mut self, found: Self, is_all: bool) {
        if is_all {
            *self = found;
            return;
        }
        if exceeds(found.worst.0, self.worst.0) {
            self.worst = found.worst;
        }
        if exceeds(found.highest.0, self.highest.0) {
            self.highest = found.highest;
        }
        (self.value, self.pixels) = (self.value.max(found.value), self.pixels.max(found.pixels));
        (self.normal_deviation, self.slope) = (
            self.normal_deviation.max(found.normal_deviation),
            self.slope.min(found.slope),
        );
        self.failing.extend(found.failing);
    }
}

/// Adds a leaf that fails to a list in the order of the walk, or the value of another triangle of the last leaf.
pub(super) fn fail(failing: &mut Vec<(NodeAddress, f64)>, place: NodeAddress, value: f64) {
    match failing.last_mut() {
        Some((last, known)) if *last == place => *known = known.max(value),
        _ => failing.push((place, value)),
    }
}
