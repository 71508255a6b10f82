//! The weights of control points at places of the limit surface, for all faces of the same shape together.
//!
//! The surface is linear in its control points, three of which are put on the axes at a time, all others at the origin: the
//! coordinates of points, tangents and polynomials' coefficients are their weights then.

use super::table::{COEFFICIENTS, LANES, SUMS, groups};
use crate::index::{FaceId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::patch::large_rings::LargeRings;
use crate::patch::polynomial::Polynomial;
use crate::patch::{Patch, Rules, Support, root_patch};
use crate::vector::DVec3;

/// Levels at which all places must be on a regular piece: more than the resolution of places and
/// the levels of semi-sharp tags.
const DEEPEST: u32 = 64;

/// A place over the face, by its weights of the second and the third corner; in the order of a support's corners.
pub(super) type ParamPoint = [f64; 2];

/// Where a place stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    /// The number of the regular piece.
    pub(super) piece: u32,
    /// The place there.
    pub(super) at: ParamPoint,
}

/// A mesh whose control points are moved to measure the effect.
pub(super) struct Probe<'a> {
    mesh: Mesh,
    sharpness: &'a Sharpness<'a>,
    large: LargeRings,
    rules: &'a Rules<'a>,
}

/// The places and values whose weights are wanted.
pub(super) struct Wanted<'a> {
    pub(super) support: &'a Support,
    pub(super) face: FaceId,
    /// Places.
    pub(super) places: &'a [ParamPoint],
    /// By place, the number of its row.
    pub(super) rows: &'a [Option<u32>],
    /// By regular piece, the number of its block of coefficients.
    pub(super) pieces: &'a [Option<u32>],
}

impl<'a> Probe<'a> {
    /// `mesh` with all points at the origin, as far as pieces are made of them.
    pub(super) fn new(
        mesh: &Mesh,
        sharpness: &'a Sharpness<'a>,
        large: &LargeRings,
        rules: &'a Rules<'a>,
    ) -> Self {
        let (mut mesh, mut large) = (mesh.clone(), large.clone());
        for vertex in mesh.topology().vertices() {
            mesh.set_position(vertex, [0.0; 3]);
        }
        (0..large.vertices().count()).for_each(|number| large.set_mean(number, DVec3::ZERO));
        Self {
            mesh,
            sharpness,
            large,
            rules,
        }
    }

    /// Whether pieces are quartics over triangles, rather than bicubics.
    pub(super) fn has_quartics(&self) -> bool {
        !self.mesh.topology().has_quads()
    }

    fn set(&mut self, point: u32, to: DVec3) {
        match (point as usize).checked_sub(self.mesh.vertex_count()) {
            None => self.mesh.set_position(VertexId(point), to.to_array()),
            Some(number) => self.large.set_mean(number, to),
        }
    }

    fn patch(&self, face: FaceId) -> Patch {
        root_patch(&self.mesh, self.sharpness, &self.large, face, self.rules)
    }

    /// The pieces of the places, and the number of regular pieces; `None` where a place is on none.
    pub(super) fn standing(
        &self,
        support: &Support,
        face: FaceId,
        places: &[ParamPoint],
    ) -> Option<(Vec<Standing>, u32)> {
        let mut found = vec![None; places.len()];
        let mut count = 0;
        let mut on_face = on_face(support, places);
        self.descend(&self.patch(face), &mut on_face, DEEPEST, &mut |_, own| {
            for place in own {
                found[place.number] = Some(Standing {
                    piece: count,
                    at: place.at,
                });
            }
            count += 1;
        });
        Some((found.into_iter().collect::<Option<Vec<_>>>()?, count))
    }

    /// The weights that are wanted: all rows, then all blocks of coefficients.
    pub(super) fn weights(&mut self, wanted: &Wanted<'_>) -> Vec<[f64; LANES]> {
        let Wanted {
            support,
            face,
            places,
            rows,
            pieces,
        } = *wanted;
        let groups = groups(support.points.len());
        let row_count = rows.iter().flatten().count();
        let block_start = row_count * SUMS * groups;
        let blocks = pieces.iter().flatten().count() * COEFFICIENTS * groups;
        let mut weights = vec![[0.0; LANES]; block_start + blocks];
        for (three, points) in support.points[1..].chunks(3).enumerate() {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            points
                .iter()
                .zip(axes)
                .for_each(|(&point, axis)| self.set(point, axis));
            let patch = self.patch(face);
            let mut write = |start: usize, value: DVec3| {
                for (axis, value) in value.to_array().into_iter().enumerate().take(points.len()) {
                    let point = 3 * three + axis;
                    weights[start + point / LANES][point % LANES] = value;
                }
            };
            let mut number = 0;
            self.descend(
                &patch,
                &mut on_face(support, places),
                DEEPEST,
                &mut |piece, own| {
                    if let Some(block) = pieces[number] {
                        let start = block_start + block as usize * COEFFICIENTS * groups;
                        let coefficients = piece.coefficients().into_iter().flatten();
                        for (i, value) in coefficients.enumerate() {
                            write(start + i * groups, value);
                        }
                    }
                    number += 1;
                    for (row, at) in own
                        .iter()
                        .filter_map(|place| Some((rows[place.number]?, place.at)))
                    {
                        let start = row as usize * SUMS * groups;
                        let [by_u, by_v] = piece.tangents(at[0], at[1]);
                        let sums = [piece.point(at[0], at[1]), by_u, by_v];
                        sums.into_iter()
                            .enumerate()
                            .for_each(|(i, value)| write(start + i * groups, value));
                    }
                },
            );
            points
                .iter()
                .for_each(|&point| self.set(point, DVec3::ZERO));
        }
        for row in weights[..block_start].chunks_mut((SUMS * groups).max(1)) {
            scale(&mut row[groups..]);
        }
        weights
    }

    /// Calls `visit` for regular pieces that meet all places of a piece but an irregular corner.
    fn descend(
        &self,
        patch: &Patch,
        places: &mut [Standpoint],
        levels: u32,
        visit: &mut dyn FnMut(&Polynomial, &[Standpoint]),
    ) {
        if places.is_empty() {
            return;
        }
        if let Some(piece) = Polynomial::of(patch) {
            visit(&piece, places);
        } else if levels > 0 {
            let refined = patch.refined(self.rules);
            places.iter_mut().for_each(Standpoint::enter_part);
            // Stable: the result does not depend on how this sorts.
            places.sort_by_key(|place| place.part);
            for own in places.chunk_by_mut(|a, b| a.part == b.part) {
                self.descend(&refined.part(own[0].part), own, levels - 1, visit);
            }
        }
    }
}

/// Weights of tangents that are far from 1 come from deep parts; normals do not depend on their size.
fn scale(tangents: &mut [[f64; LANES]]) {
    let greatest = tangents
        .as_flattened()
        .iter()
        .fold(0.0f64, |greatest, weight| greatest.max(weight.abs()));
    if greatest > 0.0 {
        tangents
            .as_flattened_mut()
            .iter_mut()
            .for_each(|weight| *weight /= greatest);
    }
}

/// A place on the way down.
#[derive(Clone, Copy)]
struct Standpoint {
    number: usize,
    at: ParamPoint,
    /// The part that it is in.
    part: usize,
}

/// Places as the face counts its corners.
fn on_face(support: &Support, places: &[ParamPoint]) -> Vec<Standpoint> {
    let turned = |(number, &[u, v]): (usize, &ParamPoint)| {
        let mut weights = [0.0; 3];
        for (corner, weight) in [1.0 - u - v, u, v].into_iter().enumerate() {
            weights[(support.turn + corner) % 3] = weight;
        }
        Standpoint {
            number,
            at: [weights[1], weights[2]],
            part: 0,
        }
    };
    places.iter().enumerate().map(turned).collect()
}

impl Standpoint {
    /// Goes to the part that the place is in: the middle one where that has it, too, since it is regular before others are.
    fn enter_part(&mut self) {
        let [u, v] = self.at;
        (self.part, self.at) = match () {
            () if 1.0 - u - v > 0.5 => (0, [2.0 * u, 2.0 * v]),
            () if u > 0.5 => (1, [2.0 * u - 1.0, 2.0 * v]),
            () if v > 0.5 => (2, [2.0 * u, 2.0 * v - 1.0]),
            () => (3, [1.0 - 2.0 * u, 1.0 - 2.0 * v]),
        };
    }
}
