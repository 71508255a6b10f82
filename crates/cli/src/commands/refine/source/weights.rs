//! Weights of skins over a refined mesh: the limit of each joint's weights, as if they were heights over the control mesh.
//!
//! w(p) = Σ bᵢ(p) wᵢ, with the b of the scheme that gives the surface itself, so that a skin bends as smoothly as the surface does.
//! Weights are held as sparse lists of joints; three joints are evaluated together, as coordinates of a mesh, and only where they move
//! something near. Of the joints that move a vertex the four with the greatest weights are kept, ties by index, and their weights made to
//! add up to 1. Loop's b are not negative; where another scheme's are, weights below 0 count as 0.

use std::collections::BTreeSet;

use anyhow::Context;
use limitmesh::refine::Origin;
use limitmesh::scheme::Scheme;
use limitmesh::{FaceId, LimitSurface, Mesh, PolygonSoup, QuadControl};

use crate::format::{counted, number};

/// Joints at most that move a vertex of a file: more are not read by everyone.
pub(super) const MOST_JOINTS: usize = 4;

/// The joints that move a vertex, with weights that add up to 1, the greatest first; weights of 0 where there are fewer.
pub(super) type Joints = [(u32, f64); MOST_JOINTS];

/// Weights this far below 0 are roundings of 0.
const ROUNDING: f64 = 1e-12;

/// A note names a share of weights that was left out from here on.
const NOTED: f64 = 0.01;

/// The weights of a refined mesh.
#[derive(Default)]
pub(super) struct Weights {
    /// By vertex.
    pub(super) joints: Vec<Joints>,
    /// Vertices with a joint whose weight was below 0.
    pub(super) clamped: usize,
    /// The greatest share of a vertex's weights that was left out with its fifth joint and those after it.
    pub(super) left_out: f64,
}

impl Weights {
    /// The notes on them.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.clamped > 0 {
            let vertices = counted(self.clamped, "vertex", "vertices");
            notes.push(format!("weights below 0 count as 0 at {vertices}"));
        }
        if self.left_out > NOTED {
            let percent = number(100.0 * self.left_out);
            notes.push(format!(
                "{MOST_JOINTS} joints move a vertex at most: up to {percent} % of its weights were others'"
            ));
        }
        notes
    }
}

/// The lists of joints at the vertices of quads, given those at the vertices of the soup that the quads were made of; weights add up to 1.
///
/// # Errors
/// A step that divides polygons has no weights.
pub(super) fn on_quads(
    quads: &QuadControl,
    soup: &PolygonSoup,
    lists: &[Vec<(u32, f64)>],
) -> anyhow::Result<Vec<Vec<(u32, f64)>>> {
    let shares = lists.iter().map(|list| {
        let total: f64 = list.iter().map(|&(_, weight)| weight).sum();
        let share = |&(joint, weight)| (joint, weight / total);
        list.iter().map(share).collect()
    });
    let shares: Vec<Vec<(u32, f64)>> = shares.collect();
    let mut found = vec![Vec::new(); quads.mesh.vertex_count()];
    for together in all_joints(&shares).chunks(3) {
        let stepped = quads.positions(soup, &coordinates(&shares, together));
        let stepped = stepped.context("weights of joints")?;
        for (list, weights) in found.iter_mut().zip(stepped) {
            let own = together.iter().copied().zip(weights);
            list.extend(own.filter(|&(_, weight)| weight > 0.0));
        }
    }
    Ok(found)
}

/// All joints of lists, in ascending order.
fn all_joints(lists: &[Vec<(u32, f64)>]) -> Vec<u32> {
    let all: BTreeSet<u32> = lists.iter().flatten().map(|&(joint, _)| joint).collect();
    all.into_iter().collect()
}

/// The weights of three joints, or fewer, as coordinates.
fn coordinates(lists: &[Vec<(u32, f64)>], together: &[u32]) -> Vec<[f64; 3]> {
    let mut positions = vec![[0.0; 3]; lists.len()];
    for (position, list) in positions.iter_mut().zip(lists) {
        for (x, joint) in position.iter_mut().zip(together) {
            let mut list = list.iter();
            let own = list.find(|(own, _)| own == joint);
            *x = own.map_or(0.0, |&(_, weight)| weight);
        }
    }
    positions
}

/// The weights at places of the limit surface of a mesh, given those of its vertices; `is_near` if weights count at a control vertex and
/// on the faces around its neighbours alone.
///
/// # Errors
/// The scheme has no limit at the shape of some ring.
pub(super) fn weights(
    control: &Mesh,
    lists: &[Vec<(u32, f64)>],
    scheme: &dyn Scheme,
    is_near: bool,
    places: &[Origin],
) -> anyhow::Result<Weights> {
    // Places of one face together, whatever order vertices have.
    let mut by_face: Vec<u32> = (0..places.len() as u32).collect();
    by_face.sort_by_key(|&v| places[v as usize].face);
    let mut found = Weights {
        joints: vec![[(0, 0.0); MOST_JOINTS]; places.len()],
        ..Default::default()
    };
    let mut totals = vec![0.0; places.len()];
    let mut is_clamped = vec![false; places.len()];
    let mut heights = control.clone();
    for together in all_joints(lists).chunks(3) {
        let positions = coordinates(lists, together);
        let is_moved = moved_faces(control, &positions, is_near);
        heights = heights
            .with_positions(positions)
            .context("weights of joints")?;
        let surface =
            LimitSurface::without_normals(&heights, scheme).context("weights of joints")?;
        let own = by_face
            .iter()
            .copied()
            .filter(|&v| is_moved[places[v as usize].face as usize]);
        let own: Vec<u32> = own.collect();
        let at = own.iter().map(|&v| &places[v as usize]);
        let at: Vec<(FaceId, [f64; 3])> = at
            .map(|place| (FaceId(place.face), place.barycentric))
            .collect();
        let points = surface.at_all(&at);
        if let Some(error) = surface.failure() {
            anyhow::bail!("weights of joints: {error}");
        }
        for (v, point) in own.into_iter().map(|v| v as usize).zip(points) {
            for (&joint, weight) in together.iter().zip(point.position) {
                is_clamped[v] |= weight < -ROUNDING;
                let weight = weight.max(0.0);
                totals[v] += weight;
                insert(&mut found.joints[v], joint, weight);
            }
        }
    }
    found.clamped = is_clamped.into_iter().filter(|&is| is).count();
    for (joints, total) in found.joints.iter_mut().zip(totals) {
        let kept: f64 = joints.iter().map(|&(_, weight)| weight).sum();
        if kept > 0.0 {
            joints.iter_mut().for_each(|(_, weight)| *weight /= kept);
            found.left_out = found.left_out.max(1.0 - kept / total);
        }
    }
    Ok(found)
}

/// Puts a joint in its place among those with the greatest weights; joints come in ascending order.
fn insert(joints: &mut Joints, joint: u32, weight: f64) {
    let Some(place) = joints.iter().position(|&(_, own)| weight > own) else {
        return;
    };
    joints[place..].rotate_right(1);
    joints[place] = (joint, weight);
}

/// By face, whether any of three weights counts there.
fn moved_faces(mesh: &Mesh, weights: &[[f64; 3]], is_near: bool) -> Vec<bool> {
    let has_one: Vec<bool> = weights
        .iter()
        .map(|own| own.iter().any(|&weight| weight > 0.0))
        .collect();
    if !is_near {
        return vec![true; mesh.face_count()];
    }
    // Both halves of a quad are one face.
    let faces = || {
        mesh.triangles()
            .chunks(1 + usize::from(mesh.topology().has_quads()))
    };
    let any = |face: &[[u32; 3]], marks: &[bool]| face.iter().flatten().any(|&v| marks[v as usize]);
    let mut is_adjacent = vec![false; has_one.len()];
    for face in faces().filter(|face| any(face, &has_one)) {
        let corners = face.iter().flatten();
        corners.for_each(|&v| is_adjacent[v as usize] = true);
    }
    let is_moved = |face: &[[u32; 3]]| std::iter::repeat_n(any(face, &is_adjacent), face.len());
    faces().flat_map(is_moved).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greatest_are_kept_and_ties_go_by_index() {
        let mut joints = [(0, 0.0); MOST_JOINTS];
        for (joint, weight) in [
            (1, 0.1),
            (3, 0.3),
            (4, 0.1),
            (6, 0.2),
            (7, 0.1),
            (9, 0.3),
            (11, 0.0),
        ] {
            insert(&mut joints, joint, weight);
        }
        assert_eq!(joints, [(3, 0.3), (9, 0.3), (6, 0.2), (1, 0.1)]);
    }
}
