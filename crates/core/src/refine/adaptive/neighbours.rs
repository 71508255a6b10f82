//! The emitted triangles beyond the edges of one. Sharp edges have none.

use std::collections::HashSet;

use super::emit::Emission;
use crate::certificate::around;
use crate::mesh::NONE;
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::{DVec3, vector};

/// The half-edges along sharp edges.
pub(super) fn sharp_edges(
    emission: &Emission,
    watch: &SharedWatch<'_>,
) -> Result<HashSet<u32>, Cancelled> {
    let mut sharp = HashSet::new();
    let all = emission
        .sharp
        .iter()
        .flat_map(|(h, _)| emission.borders.along(*h));
    watch.each(all, |&h| {
        sharp.insert(h);
    })?;
    Ok(sharp)
}

/// The chords of the angles between a triangle and its neighbours, and the room for tangential displacements over its edges, as [`around`] gives them.
pub(super) fn angles(
    emission: &Emission,
    sharp: &HashSet<u32>,
    triangle: u32,
) -> ([f64; 3], [f64; 3]) {
    let opposite = [0, 1, 2].map(|edge| {
        let twin = beyond(emission, sharp, 3 * triangle + edge)?;
        let vertex = emission.triangles[twin as usize / 3][(twin as usize + 2) % 3];
        Some(vector(emission.positions[vertex as usize]))
    });
    around(corners(emission, triangle), &opposite)
}

/// By edge the corners of the triangle beyond, the one opposite last.
pub(super) type Neighbours = [Option<[DVec3; 3]>; 3];

pub(super) fn neighbours(emission: &Emission, sharp: &HashSet<u32>, triangle: u32) -> Neighbours {
    [0, 1, 2].map(|edge| {
        let twin = beyond(emission, sharp, 3 * triangle + edge)?;
        let mut corners = corners(emission, twin / 3);
        corners.rotate_left(twin as usize % 3);
        Some(corners)
    })
}

/// The half-edge on the other side, where there is a triangle.
fn beyond(emission: &Emission, sharp: &HashSet<u32>, h: u32) -> Option<u32> {
    let twin = emission.twins[h as usize];
    let is_open = twin == NONE || !sharp.is_empty() && sharp.contains(&h);
    (!is_open).then_some(twin)
}

fn corners(emission: &Emission, triangle: u32) -> [DVec3; 3] {
    emission.triangles[triangle as usize].map(|vertex| vector(emission.positions[vertex as usize]))
}
