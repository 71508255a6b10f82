//! What rounding vertices to 32 bits afterwards does to a distance, and the room that goals leave for it.

use super::ErrorBounds;

/// How far a vertex moves at most as its coordinates become 32-bit numbers, for a mesh in the box of these points.
pub fn most_rounding_to_single(points: &[[f64; 3]]) -> f64 {
    let coordinates = points.as_flattened().iter();
    let largest = coordinates.fold(0.0f64, |most, x| most.max(x.abs()));
    // Half of the last place of `f32`, and of its least number, along each axis.
    let half = largest * f64::from(f32::EPSILON) * 0.5 + 0.5 * f64::from(f32::from_bits(1));
    3f64.sqrt() * half
}

/// The part of a length that is left where rounding takes some of it afterwards, unless that is most of it.
pub fn with_room(length: f64, rounding: f64) -> f64 {
    let room = length - rounding;
    if room > 0.5 * length { room } else { length }
}

impl ErrorBounds {
    /// The bounds after each vertex moved by so much at most.
    pub fn rounded(mut self, rounding: f64) -> Self {
        if rounding > 0.0 {
            self.lower = (self.lower - rounding).next_down().max(0.0);
            self.upper = (self.upper + rounding).next_up();
        }
        self
    }
}
