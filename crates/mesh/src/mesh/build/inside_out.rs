//! Closed components whose normals point inwards, turned round.
//!
//! Takes triangles that agree on an orientation within each component. A component is inside out if
//! its volume is negative and no other component is around it whose cavity it could bound. All
//! components inside it are turned with it: a file that was mirrored has all of it inside out, and
//! a cavity in it stays a cavity.

use super::orient::{Components, Neighbours, turn};
use super::triangulate::Faces;
use crate::geometry::{NONE, solid_angle};
use crate::mesh::Diagnosis;
use crate::vector::{DVec3, vector};

/// A volume below this part of the volumes that add up to it is rounding: sheets that coincide enclose nothing.
const ROUNDING: f64 = 1e-12;

/// A component without boundary.
struct Closed<'a> {
    faces: &'a [u32],
    /// Half of its greatest extent along an axis.
    size: f64,
    /// By the cube of its size: negative where its normals point inwards, 0 where that is not certain.
    volume: f64,
    low: DVec3,
    high: DVec3,
    /// One of its vertices.
    point: DVec3,
}

/// Turns closed components round that are inside out; `position` gives that of a vertex.
pub(super) fn turn_inside_out(
    faces: &mut Faces,
    neighbours: &mut Neighbours,
    components: &Components,
    position: impl Fn(u32) -> [f64; 3],
    diagnosis: &mut Diagnosis,
) {
    let corners = |face: u32| faces.triangles[face as usize].map(|v| vector(position(v)));
    let is_closed = |own: &&[u32]| {
        own.iter().all(|&face| {
            neighbours.twins[3 * face as usize..][..3]
                .iter()
                .all(|&twin| twin != NONE)
        })
    };
    let closed: Vec<Closed<'_>> = components
        .iter()
        .filter(is_closed)
        .map(|own| Closed::of(own, corners))
        .collect();
    let inside_out = InsideOut { closed, corners };
    let mut turned = vec![false; faces.triangles.len()];
    let mut named = Vec::new();
    for own in inside_out.found() {
        own.iter().for_each(|&face| turned[face as usize] = true);
        named.extend(own.iter().map(|&face| faces.inputs[face as usize]).min());
    }
    if !named.is_empty() {
        diagnosis.inside_out_components.add_all(named);
        turn(&mut faces.triangles, neighbours, &turned);
    }
}

impl<'a> Closed<'a> {
    fn of(faces: &'a [u32], corners: impl Fn(u32) -> [DVec3; 3]) -> Self {
        let point = faces.first().map_or(DVec3::ZERO, |&face| corners(face)[0]);
        let mut closed = Self {
            faces,
            size: 0.0,
            volume: 0.0,
            low: point,
            high: point,
            point,
        };
        for [a, b, c] in faces.iter().map(|&face| corners(face)) {
            closed.low = closed.low.min(a).min(b).min(c);
            closed.high = closed.high.max(a).max(b).max(c);
        }
        // Cubes of very large and very small coordinates would overflow or vanish.
        let size = (0.5 * closed.high - 0.5 * closed.low).max_element();
        let mut magnitude = 0.0;
        for face in faces.iter().map(|&face| corners(face)) {
            let [a, b, c] = face.map(|corner| corner / size - point / size);
            // Of the tetrahedron between the triangle and the point.
            let volume = a.dot(b.cross(c)) / 6.0;
            closed.volume += volume;
            magnitude += volume.abs();
        }
        let is_certain = closed.volume.abs() > ROUNDING * magnitude;
        closed.volume = if is_certain { closed.volume } else { 0.0 };
        closed.size = size;
        closed
    }
}

/// The closed components, and the corners of their faces.
struct InsideOut<'a, F> {
    closed: Vec<Closed<'a>>,
    corners: F,
}

impl<F: Fn(u32) -> [DVec3; 3]> InsideOut<'_, F> {
    /// The faces of each component that is to be turned.
    fn found(&self) -> Vec<&[u32]> {
        if !self.closed.iter().any(|own| own.volume < 0.0) {
            return Vec::new();
        }
        // A component inside another is smaller.
        let mut order: Vec<usize> = (0..self.closed.len()).collect();
        order.sort_by(|&a, &b| self.closed[b].size.total_cmp(&self.closed[a].size));
        let mut signs = vec![1.0; self.closed.len()];
        for (place, &own) in order.iter().enumerate() {
            if signs[own] * self.closed[own].volume >= 0.0 {
                continue;
            }
            let around = order[..place]
                .iter()
                .map(|&other| signs[other] * self.winding(other, own));
            if around.sum::<f64>() < 0.5 {
                signs[own] = -signs[own];
                for &other in &order[place + 1..] {
                    if self.winding(own, other).abs() > 0.5 {
                        signs[other] = -signs[other];
                    }
                }
            }
        }
        let turned = (0..self.closed.len()).filter(|&own| signs[own] < 0.0);
        turned.map(|own| self.closed[own].faces).collect()
    }

    /// How often a component runs around a vertex of another: its solid angle by that of a sphere.
    fn winding(&self, around: usize, of: usize) -> f64 {
        let (own, point) = (&self.closed[around], self.closed[of].point);
        if point.cmplt(own.low).any() || point.cmpgt(own.high).any() {
            return 0.0;
        }
        let angles = own
            .faces
            .iter()
            .map(|&face| solid_angle((self.corners)(face), point));
        angles.sum::<f64>() / (4.0 * core::f64::consts::PI)
    }
}
