//! The limit surface over one face at the places of a [`Grid`].
//!
//! A face far from boundaries and creases with one irregular corner at most depends on the corner,
//! its ring and five points more, and every place on it is a fixed combination of these: the
//! weights are tabulated for each valence. Where no corner is irregular and rows are long, those of
//! the face's polynomial take less time. Any other face is refined towards its irregular parts, and
//! its regular parts are evaluated as polynomials.

use core::ops::Range;
use std::sync::OnceLock;

use super::grid::{Grid, Owned};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::parallel;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::extraordinary::ExtraordinaryPatch;
use crate::patch::large_rings::LargeRings;
use crate::patch::quartic::{Quartic, coefficients};
use crate::patch::{Patch, Rules, assemble, root_patch};
use crate::vector::{DVec3, vector};

/// Valences that have tables; they grow with the valence, and faces at others are few.
const TABULATED: usize = 24;

/// Places that are computed together.
const LANES: usize = 4;

/// Rounding leaves no more of a cross product of tangents that is zero than this, by the square of the piece's size.
const CROSS_ROUNDING: f64 = 1e-13;

/// Regular faces of at least this many segments a side are evaluated by rows, which take a third of
/// the products; short rows cost as much to begin.
const ROWS_FROM: usize = 16;

/// Sizes of pieces whose fourth powers neither vanish nor overflow.
const SAFE_SIZES: Range<f64> = 1e-60..1e60;

/// The places of a grid in the order in which they are evaluated: those inside, and then those on each side. Each
/// group starts at a multiple of [`LANES`].
pub(super) struct Slots {
    /// Where the groups start, and the end.
    starts: [usize; 5],
    /// By place `[i, j]` at `j · (segments + 1) + i`; corners have none.
    of_place: Vec<u16>,
    /// For each corner that may come first, and each vertex of the grid.
    pub(super) turned: [Vec<u16>; 3],
}

/// No slot.
const NOWHERE: u16 = u16::MAX;

impl Slots {
    fn new(grid: &Grid) -> Self {
        let n = grid.segments;
        let mut of_place = vec![NOWHERE; (n + 1) * (n + 1)];
        let mut next = 0usize;
        let mut starts = [0; 5];
        let inside = (1..n)
            .flat_map(|j| (1..n - j).map(move |i| [i, j]))
            .collect::<Vec<_>>();
        let sides = [0, 1, 2].map(|side| {
            grid.on_sides[side]
                .iter()
                .map(|&v| grid.places[v as usize])
                .collect()
        });
        let [first, second, third]: [Vec<_>; 3] = sides;
        for (group, places) in [inside, first, second, third].iter().enumerate() {
            starts[group] = next;
            for &[i, j] in places {
                of_place[j * (n + 1) + i] = next as u16;
                next += 1;
            }
            next = next.next_multiple_of(LANES);
        }
        starts[4] = next;
        let turned = [0, 1, 2].map(|turn| {
            let slot = |&[i, j]: &[usize; 2]| {
                let weights = [n - i - j, i, j];
                of_place[weights[(turn + 2) % 3] * (n + 1) + weights[(turn + 1) % 3]]
            };
            grid.places.iter().map(slot).collect()
        });
        Self {
            starts,
            of_place,
            turned,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.starts[4]
    }

    /// By the set of owned sides and the corner that comes first: the slots of the vertices that a face counts as its own, in their order.
    pub(super) fn orders(&self, grid: &Grid) -> Vec<[Vec<u16>; 3]> {
        let order = |owned: &Owned, turn: usize| {
            owned
                .vertices
                .iter()
                .map(|&v| self.turned[turn][usize::from(v)])
                .collect()
        };
        grid.owned
            .iter()
            .map(|owned| [0, 1, 2].map(|turn| order(owned, turn)))
            .collect()
    }
}

/// Weights of the control points of a face for positions and both tangents at all slots: `LANES` slots together, for
/// each of these three, for each control point but the first. Those of the first complete the sums to 1 and 0.
struct Weights(Vec<f64>);

/// The surface over a mesh.
pub(super) struct Pieces<'a> {
    mesh: &'a Mesh,
    sharpness: &'a Sharpness<'a>,
    large: LargeRings,
    rules: &'a Rules<'a>,
    segments: usize,
    pub(super) slots: Slots,
    /// The valences of vertices inside the surface without tags; 0 for others.
    valences: Vec<u8>,
    /// By valence.
    weights: [OnceLock<Weights>; TABULATED + 1],
}

/// The values of a face, by slot.
pub(super) struct Values {
    pub(super) points: Vec<[f64; 3]>,
    /// Unit normals on the face's side, zero where there is none; empty if not requested.
    pub(super) normals: Vec<[f64; 3]>,
    controls: Vec<DVec3>,
}

impl<'a> Pieces<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        sharpness: &'a Sharpness<'a>,
        rules: &'a Rules<'a>,
        grid: &Grid,
    ) -> Self {
        let topology = mesh.topology();
        let valence = |v: usize| {
            let vertex = VertexId(v as u32);
            let (valence, open) = topology.valence_and_openness(vertex);
            let plain =
                !open && !sharpness.is_tagged(vertex) && (3..=TABULATED as u32).contains(&valence);
            if plain { valence as u8 } else { 0 }
        };
        Self {
            mesh,
            sharpness,
            large: LargeRings::with_tags(mesh, sharpness, rules),
            rules,
            segments: grid.segments,
            slots: Slots::new(grid),
            valences: parallel::map(topology.vertex_count(), valence),
            weights: [const { OnceLock::new() }; TABULATED + 1],
        }
    }

    /// Room for one face.
    pub(super) fn room(&self, normals: bool) -> Values {
        let slots = vec![[0.0; 3]; self.slots.len()];
        Values {
            normals: if normals { slots.clone() } else { Vec::new() },
            points: slots,
            controls: Vec::new(),
        }
    }

    /// Evaluates a face inside and on the given sides; other slots have no meaning. Gives the
    /// corner of the face that counts as the first in the slots.
    pub(super) fn evaluate(&self, face: usize, sides: u8, values: &mut Values) -> usize {
        if let Some((turn, valence)) = self.gather(face, &mut values.controls) {
            if valence == 6 && self.segments >= ROWS_FROM {
                self.evaluate_regular(sides, values);
                return turn;
            }
            let size = values.controls[1..]
                .iter()
                .fold(DVec3::ZERO, |most, p| most.max(p.abs()))
                .max_element();
            if SAFE_SIZES.contains(&size) {
                let weights = self.weights[valence].get_or_init(|| Weights::new(valence, self));
                for group in 0..4 {
                    // Side 0 of the face that is turned is side `turn` of the face.
                    if group == 0 || sides >> ((group - 1 + turn) % 3) & 1 != 0 {
                        weights.apply(
                            self.slots.starts[group]..self.slots.starts[group + 1],
                            size,
                            values,
                        );
                    }
                }
                return turn;
            }
        }
        let patch = root_patch(
            self.mesh,
            self.sharpness,
            &self.large,
            FaceId(face as u32),
            self.rules,
        );
        self.evaluate_patch(&patch, values);
        0
    }

    /// Evaluates a face whose corners are regular, whose control points are gathered, by rows of its polynomial.
    fn evaluate_regular(&self, sides: u8, values: &mut Values) {
        let Values {
            points,
            normals,
            controls,
        } = values;
        let first = core::mem::take(&mut controls[0]);
        // By corner, the ring from the next corner on, as `gather` numbers its points.
        let rings = [[1, 2, 3, 4, 5, 6], [2, 0, 6, 7, 8, 9], [0, 1, 9, 10, 11, 3]];
        let net =
            BezierTriangle::of(&assemble([0, 1, 2], rings.each_ref(), [0; 3]).map(|i| controls[i]));
        let quartic = |corner: usize| {
            let mut all = coefficients(&net, corner);
            all[0] += first;
            Quartic::with_scale(all)
        };
        let step = 1.0 / self.segments as f64;
        let mut fill_row = |quartic: &Quartic, v: f64, slots: Range<usize>| {
            if normals.is_empty() {
                quartic.points_along(v, step, step, &mut points[slots]);
            } else {
                let normals = &mut normals[slots.clone()];
                quartic.points_and_normals_along(v, step, step, &mut points[slots], normals);
            }
        };
        let whole = quartic(0);
        let mut start = self.slots.starts[0];
        for row in 1..self.segments - 1 {
            let end = start + self.segments - 1 - row;
            fill_row(&whole, row as f64 * step, start..end);
            start = end;
        }
        for side in (0..3).filter(|side| sides >> side & 1 != 0) {
            let start = self.slots.starts[1 + side];
            let seen_from = if side == 0 { whole } else { quartic(side) };
            fill_row(&seen_from, 0.0, start..start + self.segments - 1);
        }
    }

    /// The control points of a face by differences to the first, except for the first itself: the
    /// irregular corner, its ring from the next corner on, and those that complete the other
    /// corners' rings (see [`ExtraordinaryPatch`]). With the corner's number and valence; `None`
    /// where there is more than that or something sharp.
    fn gather(&self, face: usize, controls: &mut Vec<DVec3>) -> Option<(usize, usize)> {
        let topology = self.mesh.topology();
        let valences = topology.triangles()[face].map(|v| self.valences[v as usize]);
        let irregular = valences.map(|valence| valence != 6);
        if valences.contains(&0) || irregular.iter().filter(|&&is| is).count() > 1 {
            return None;
        }
        let turn = irregular.iter().position(|&is| is).unwrap_or(0);
        let corner = HalfEdgeId::of(FaceId(face as u32), turn);
        let at = |v: VertexId| vector(self.mesh.positions()[v.index()]);
        let first = at(topology.origin(corner));
        controls.clear();
        controls.push(first);
        let mut around = |mut h: HalfEdgeId, skipped: usize, count: usize| {
            for step in 0..count {
                if step >= skipped {
                    controls.push(at(topology.target(h)) - first);
                }
                h = topology.twin(h.previous()).unwrap_or(h);
            }
        };
        let valence = valences[turn] as usize;
        around(corner, 0, valence);
        around(corner.next(), 3, 6);
        around(corner.previous(), 3, 5);
        Some((turn, valence))
    }

    /// Evaluates all places of a face piece by piece.
    pub(super) fn evaluate_patch(&self, patch: &Patch, values: &mut Values) {
        let mut points = vec![[0.0; 3]; self.segments + 1];
        let mut normals = points.clone();
        self.for_each_regular(patch, self.segments, [0, 0], false, &mut |part| {
            let piece = Quartic::of(&part.net, 0);
            let step = 1.0 / part.segments as f64;
            for b in 0..=part.segments {
                let count = part.segments + 1 - b;
                let v = b as f64 * step;
                if values.normals.is_empty() {
                    piece.points_along(v, 0.0, step, &mut points[..count]);
                } else {
                    piece.points_and_normals_along(
                        v,
                        0.0,
                        step,
                        &mut points[..count],
                        &mut normals[..count],
                    );
                }
                for a in 0..count {
                    if let Some(slot) = self.slot(part.place(a, b)) {
                        values.points[slot] = points[a];
                        if let Some(normal) = values.normals.get_mut(slot) {
                            *normal = normals[a];
                        }
                    }
                }
            }
        });
    }

    #[inline]
    fn slot(&self, [i, j]: [usize; 2]) -> Option<usize> {
        let slot = self.slots.of_place[j * (self.segments + 1) + i];
        (slot != NOWHERE).then_some(slot as usize)
    }

    /// Calls `visit` for regular parts that meet all places of a piece but an irregular corner.
    fn for_each_regular(
        &self,
        patch: &Patch,
        segments: usize,
        origin: [usize; 2],
        flipped: bool,
        visit: &mut dyn FnMut(Part),
    ) {
        if let Patch::Regular(points) = patch {
            visit(Part {
                net: BezierTriangle::of(points),
                segments,
                origin,
                flipped,
            });
        } else if segments > 1 {
            let half = segments / 2;
            let refined = patch.refined(self.rules);
            let [i, j] = origin;
            for (part, origin) in [[i, j], [i + half, j], [i, j + half], [i + half, j + half]]
                .into_iter()
                .enumerate()
            {
                // The middle part is inverted; it is regular, so that no part of it is.
                self.for_each_regular(&refined.part(part), half, origin, part == 3, visit);
            }
        }
    }
}

/// A regular part of a face, and its position in the grid.
struct Part {
    net: BezierTriangle,
    segments: usize,
    /// Its first corner.
    origin: [usize; 2],
    /// Whether its other corners lie towards lower places.
    flipped: bool,
}

impl Part {
    /// The place `a` steps towards the second corner and `b` towards the third.
    #[inline]
    fn place(&self, a: usize, b: usize) -> [usize; 2] {
        let [i, j] = self.origin;
        if self.flipped {
            [i - a, j - b]
        } else {
            [i + a, j + b]
        }
    }
}

impl Weights {
    /// The weights for faces with one corner of the given valence.
    fn new(valence: usize, pieces: &Pieces<'_>) -> Self {
        let count = valence + 5;
        let mut weights = vec![0.0; 3 * count * pieces.slots.len()];
        // Three at a time, one for each coordinate.
        for three in 0..count.div_ceil(3) {
            let mut points = vec![DVec3::ZERO; 3 * count.div_ceil(3)];
            for axis in 0..3 {
                points[3 * three + axis][axis] = 1.0;
            }
            let patch = ExtraordinaryPatch {
                corner: 0,
                at: DVec3::ZERO,
                ring: points[..valence].iter().copied().collect(),
                outer: core::array::from_fn(|i| points[valence + i]),
            };
            let patch = Patch::Extraordinary(Box::new(patch));
            pieces.for_each_regular(&patch, pieces.segments, [0, 0], false, &mut |part| {
                let piece = Quartic::of(&part.net, 0);
                let (step, zoom) = (
                    1.0 / part.segments as f64,
                    (pieces.segments / part.segments) as f64,
                );
                for b in 0..=part.segments {
                    for a in 0..=part.segments - b {
                        let Some(slot) = pieces.slot(part.place(a, b)) else {
                            continue;
                        };
                        let (u, v) = (a as f64 * step, b as f64 * step);
                        let [by_u, by_v] = piece.tangents(u, v);
                        for (kind, value) in [piece.point(u, v), zoom * by_u, zoom * by_v]
                            .into_iter()
                            .enumerate()
                        {
                            let row = (slot / LANES * 3 + kind) * count;
                            for control in 3 * three..count.min(3 * three + 3) {
                                weights[(row + control) * LANES + slot % LANES] =
                                    value[control - 3 * three];
                            }
                        }
                    }
                }
            });
        }
        Self(weights)
    }

    /// Evaluates the given slots, a multiple of [`LANES`]. `size` is that of the greatest difference.
    fn apply(&self, slots: Range<usize>, size: f64, values: &mut Values) {
        let Some((first, differences)) = values.controls.split_first() else {
            return;
        };
        let count = differences.len();
        let first = first.to_array();
        // Coordinates far from the origin have fewer digits to spare for differences.
        let distance = first.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let least = CROSS_ROUNDING * size * (size + distance);
        let rows =
            self.0[3 * count * slots.start..3 * count * slots.end].chunks_exact(3 * count * LANES);
        let points = values.points[slots.clone()].as_chunks_mut::<LANES>().0;
        if values.normals.is_empty() {
            for (row, points) in rows.zip(points) {
                *points = moved(combined(&row[..count * LANES], differences), first);
            }
            return;
        }
        let normals = values.normals[slots].as_chunks_mut::<LANES>().0;
        for (row, (points, normals)) in rows.zip(points.iter_mut().zip(normals)) {
            let (position, tangents) = row.split_at(count * LANES);
            let (by_u, by_v) = tangents.split_at(count * LANES);
            *points = moved(combined(position, differences), first);
            *normals = units(
                &combined(by_u, differences),
                &combined(by_v, differences),
                least * least,
            );
        }
    }
}

/// Sums of control points by weights, by axis and lane.
#[inline]
fn combined(weights: &[f64], controls: &[DVec3]) -> [[f64; LANES]; 3] {
    let mut sums = [[0.0; LANES]; 3];
    for (weights, control) in weights.as_chunks::<LANES>().0.iter().zip(controls) {
        let [x, y, z] = control.to_array();
        for l in 0..LANES {
            sums[0][l] += weights[l] * x;
            sums[1][l] += weights[l] * y;
            sums[2][l] += weights[l] * z;
        }
    }
    sums
}

/// Points by their differences to the first.
#[inline]
fn moved(differences: [[f64; LANES]; 3], first: [f64; 3]) -> [[f64; 3]; LANES] {
    core::array::from_fn(|l| [0, 1, 2].map(|axis| first[axis] + differences[axis][l]))
}

/// Unit vectors along cross products, zero where the square of their length is not above `least_square`.
#[inline]
fn units(s: &[[f64; LANES]; 3], t: &[[f64; LANES]; 3], least_square: f64) -> [[f64; 3]; LANES] {
    let mut units = [[0.0; LANES]; 3];
    for l in 0..LANES {
        let x = s[1][l] * t[2][l] - s[2][l] * t[1][l];
        let y = s[2][l] * t[0][l] - s[0][l] * t[2][l];
        let z = s[0][l] * t[1][l] - s[1][l] * t[0][l];
        let square = x * x + y * y + z * z;
        let factor = if square > least_square {
            1.0 / square.sqrt()
        } else {
            0.0
        };
        (units[0][l], units[1][l], units[2][l]) = (x * factor, y * factor, z * factor);
    }
    core::array::from_fn(|l| [units[0][l], units[1][l], units[2][l]])
}
