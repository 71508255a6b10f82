//! Triangles whose corners were moved off the surface, over parts that are known ([`BentFour`]),
//! among their neighbours.
//!
//! The bounds are those of [`super::super::quartic_cell`] and [`super::super::deviation`], written
//! for four at once: heights over the triangle's own plane by the quadratic part, whose corners
//! stand where the surface's do; the distances of curves from their edges, and whether the surface
//! folds, by the bends within that plane; chords and slopes among the neighbours as in
//! [`super::super::dihedral::around`].

use super::super::deviation::SHARPEST;
use super::super::quartic_cell::{DIRECTIONS, NEARLY_ONE};
use super::super::triangle_frame::SLIVER;
use super::{BentFour, FOUR, Vectors, cross, dot, minus};
use wide::f64x4;

/// Four triangles that have neighbours beyond all edges. By corner, axis and triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MovedFour {
    /// The corners.
    pub(crate) corners: [[[f64; FOUR]; 3]; 3],
    /// How far these were moved off the surface.
    pub(crate) steps: [[[f64; FOUR]; 3]; 3],
    /// By edge, the corner opposite of the triangle beyond it.
    pub(crate) opposite: [[[f64; FOUR]; 3]; 3],
}

/// The bounds of triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FoundFour {
    /// An upper bound of the distance between each triangle and its part of the surface; infinite
    /// if unknown.
    pub(crate) bound: [f64; FOUR],
    /// The approximate height of the surface over it on either side.
    pub(crate) height: [f64; FOUR],
    /// A height that some point of it reaches.
    pub(crate) least: [f64; FOUR],
}

/// Four triangles.
struct Triangle {
    /// From each corner to the next.
    edges: [Vectors; 3],
    lengths: [f64x4; 3],
    /// The products of the edges from each corner.
    products: [f64x4; 3],
    /// Of the parallelogram.
    area: f64x4,
    normal: Vectors,
    /// All corners are numbers, and rounding does not decide the plane.
    has_plane: f64x4,
}

/// The distances of parts of the surface from the edges of their triangles.
struct EdgeDeviations {
    /// How far curves are from their edges.
    side: f64x4,
    /// Second derivatives outwards, 0 where they point inwards.
    outward: [f64x4; 3],
    /// The greatest slopes of how far curves reach over the edges.
    slopes: [f64x4; 3],
    /// Whether each curve stays within the angles at its edge.
    is_plain: f64x4,
}

/// The squared chords of the angles to the neighbours, the greatest slopes of tangential
/// displacements, and whether all have planes.
struct Around {
    squared: [f64x4; 3],
    slopes: [f64x4; 3],
    is_known: f64x4,
}

impl MovedFour {
    /// The bounds of the triangles over their parts, which are kept in a unit that multiplies
    /// lengths by `scale`.
    #[inline(never)]
    pub(crate) fn bounds(&self, part: &BentFour, scale: f64) -> FoundFour {
        let [from, second, third] = self.corners.each_ref().map(vectors);
        let [to_second, to_third] =
            [second, third].map(|to| minus(&to, &from).map(|axis| axis * scale));
        let triangle = Triangle::of(to_second, to_third);
        let bends = part
            .bends
            .each_ref()
            .map(|bend| bend.each_ref().map(single));
        let [rest, curve, steep, first] =
            [&part.rest, &part.curve, &part.steep, &part.first].map(single);
        let (lifts, moved, aside) = triangle.lifts(self.steps.each_ref().map(vectors), scale);
        let (low, high) = quadratic_range(
            bends.each_ref().map(|bend| dot(bend, &triangle.normal)),
            lifts,
        );
        let height = high.fast_max(-low);
        let edges = triangle.edge_bounds(&bends, curve, steep);
        let opposite = [from, second, third].map(|corner| corner.map(|axis| axis * scale));
        let around = triangle.around(&opposite, self.opposite.each_ref().map(vectors), scale);
        let turn = triangle.turn(&bends, first);
        let is_plain = triangle.has_plane
            & rest.simd_lt(f64x4::splat(f64::INFINITY))
            & edges.is_plain
            & turn.simd_lt(f64x4::splat(NEARLY_ONE))
            & around.is_known;
        // As `EdgeBounds::deviation_off` and `Deviation::bound` have it.
        let (most, off) = (height + rest, edges.side + aside);
        let own = (most * most + off * off).sqrt().fast_max(moved);
        let at_corners = most.fast_max(moved);
        let apart = (at_corners * at_corners + 4.0 * aside * aside).sqrt();
        let within = |edge: usize| edges.slopes[edge].simd_le(around.slopes[edge]);
        let (mut is_helped, mut among) = (triangle.has_plane, apart);
        let seen = bends.each_ref().map(|bend| dot(bend, &triangle.normal));
        let rise = steepest(&seen, lifts) + first;
        // What is as high as h may be so far off along the plane: no farther than twice that and this part of h together.
        let twice = 2.0 * aside;
        let part = at_corners
            .simd_gt(f64x4::ZERO)
            .bitselect((apart - twice) / at_corners, f64x4::ONE);
        for (edge, squared) in around.squared.into_iter().enumerate() {
            is_helped = is_helped & within(edge) & squared.simd_le(f64x4::splat(SHARPEST));
            let (chord, times) = (squared.sqrt(), 1.0 + 0.5 * squared);
            let outward = edges.outward[edge];
            let reach = 0.125 * outward + curve + aside;
            // As `share_beyond` in `quartic_cell` has it.
            let room = triangle.area / triangle.lengths[edge] * (1.0 - DIRECTIONS * turn);
            let share = room.simd_gt(reach).bitselect(reach / room, f64x4::ONE);
            let along = Along {
                ends: [lifts[edge], lifts[(edge + 1) % 3]].map(|lift| times * part * lift),
                bend: times * part * seen[edge],
                outward: chord * outward,
            };
            let others = times * (twice + curve + rise * share) + chord * (curve + aside);
            let at_edge = along.greatest() + others;
            among = among.fast_max(at_edge.fast_min(apart * times + chord * reach));
        }
        let bound = is_helped.bitselect(own.fast_min(among), own);
        let share = 1.0 / scale;
        FoundFour {
            bound: is_plain
                .bitselect(bound * share, f64x4::splat(f64::INFINITY))
                .to_array(),
            height: (height * share).to_array(),
            least: triangle
                .has_plane
                .bitselect((height - rest) * share, f64x4::ZERO)
                .to_array(),
        }
    }
}

/// The curve over an edge, point by point: its height, which is linear but for a bend, and how far it reaches over the edge, both times
/// what they count.
struct Along {
    ends: [f64x4; 2],
    bend: f64x4,
    outward: f64x4,
}

impl Along {
    /// The greatest sum of both anywhere along the edge.
    #[inline(always)]
    fn greatest(&self) -> f64x4 {
        let on_side = |sign: f64| {
            let [from, to] = self.ends.map(|end| sign * end);
            let (rise, bend) = (to - from, self.outward - sign * self.bend);
            let inner = from + 0.5 * rise + 0.125 * bend + 0.5 * rise * rise / bend;
            let is_met = bend.simd_gt(2.0 * rise.abs());
            from.fast_max(to).fast_max(is_met.bitselect(inner, from))
        };
        on_side(1.0).fast_max(on_side(-1.0))
    }
}

/// The greatest derivative along an edge of a quadratic with these second derivatives along the edges and values at the corners.
#[inline(always)]
fn steepest([p, q, s]: &[f64x4; 3], [a, b, c]: [f64x4; 3]) -> f64x4 {
    let bend = p.abs().fast_max(q.abs()).fast_max(s.abs());
    let rise = (b - a)
        .abs()
        .fast_max((c - b).abs())
        .fast_max((a - c).abs());
    bend + rise
}

/// Triangles as their neighbours see them: the greatest chords between their normals and the limit normals at their corners, and
/// the tangents of their least angles.
pub(crate) struct SeenFour {
    pub(crate) normal_deviation: [f64; FOUR],
    pub(crate) slope: [f64; FOUR],
}

impl MovedFour {
    /// What neighbours see of the triangles, given the limit normals at their corners.
    #[inline(never)]
    pub(crate) fn seen(&self, normals: &[[[f64; FOUR]; 3]; 3], scale: f64) -> SeenFour {
        let [from, second, third] = self.corners.each_ref().map(vectors);
        let [to_second, to_third] =
            [second, third].map(|to| minus(&to, &from).map(|axis| axis * scale));
        let triangle = Triangle::of(to_second, to_third);
        let squared = normals.each_ref().map(vectors).map(|normal| {
            let apart = minus(&normal, &triangle.normal);
            dot(&apart, &apart)
        });
        let most = squared[0].fast_max(squared[1]).fast_max(squared[2]);
        let [a, b, c] = triangle.products;
        let is_known = triangle.has_plane;
        // Unit vectors are off by no more than 1e-12.
        let normal_deviation = most.sqrt() + 1e-12;
        SeenFour {
            normal_deviation: is_known
                .bitselect(normal_deviation, f64x4::splat(2.0))
                .to_array(),
            slope: is_known
                .bitselect(triangle.area / a.fast_max(b).fast_max(c), f64x4::ZERO)
                .to_array(),
        }
    }
}

impl Triangle {
    /// The triangles with these edges from their first corners.
    #[inline(always)]
    fn of(to_second: Vectors, to_third: Vectors) -> Self {
        let edges = [
            to_second,
            minus(&to_third, &to_second),
            to_third.map(|axis| -axis),
        ];
        let across = cross(&to_second, &to_third);
        let area = dot(&across, &across).sqrt();
        let share = 1.0 / area;
        let lengths = edges.each_ref().map(|edge| dot(edge, edge).sqrt());
        Self {
            lengths,
            products: [0, 1, 2].map(|corner| -dot(&edges[corner], &edges[(corner + 2) % 3])),
            normal: across.map(|axis| axis * share),
            has_plane: area.simd_gt(SLIVER * lengths[0] * lengths[2]),
            edges,
            area,
        }
    }

    /// Heights of the surface's corners over the plane; how far corners were moved at most, and how far within the plane.
    #[inline(always)]
    fn lifts(&self, steps: [Vectors; 3], scale: f64) -> ([f64x4; 3], f64x4, f64x4) {
        let [mut moved, mut aside] = [f64x4::ZERO; 2];
        let lifts = steps.map(|step| {
            let step = step.map(|axis| axis * scale);
            let lift = dot(&step, &self.normal);
            let within: Vectors =
                core::array::from_fn(|axis| step[axis] - lift * self.normal[axis]);
            moved = moved.fast_max(dot(&step, &step));
            aside = aside.fast_max(dot(&within, &within));
            -lift
        });
        (lifts, moved.sqrt(), aside.sqrt())
    }

    /// As in [`super::super::quartic_cell::QuarticJet::edge_bounds`].
    #[inline(always)]
    fn edge_bounds(&self, bends: &[Vectors; 3], curve: f64x4, steep: f64x4) -> EdgeDeviations {
        let zero = f64x4::ZERO;
        let tangents = self.products.map(|product| self.area / product.abs());
        let (mut side, mut outwards, mut slopes) = (zero, [zero; 3], [zero; 3]);
        let mut is_plain = self.has_plane;
        for edge in 0..3 {
            let share = 1.0 / self.lengths[edge];
            let outward = -(dot(&bends[edge], &cross(&self.edges[edge], &self.normal)) * share);
            let along = (dot(&bends[edge], &self.edges[edge]) * share).abs();
            let room = self.lengths[edge] - (0.5 * along + steep);
            let half = 0.5 * outward;
            let stays = (half.abs() + steep)
                .simd_le(room * tangents[edge].fast_min(tangents[(edge + 1) % 3]));
            is_plain = is_plain & room.simd_gt(zero) & stays;
            side = side.fast_max(0.125 * outward.abs() + curve);
            // A curve that bends inwards may reach outwards by the rest alone, nearer to an end.
            outwards[edge] = outward.fast_max(zero);
            slopes[edge] = (half.fast_max(zero) + steep) / room;
        }
        EdgeDeviations {
            side,
            outward: outwards,
            slopes,
            is_plain,
        }
    }

    /// ‖A‖ of `quartic_cell`, by changes of barycentric coordinates times the area.
    #[inline(always)]
    fn turn(&self, bends: &[Vectors; 3], first: f64x4) -> f64x4 {
        let across = [&self.edges[0], &self.edges[2]].map(|edge| cross(edge, &self.normal));
        let mut most = f64x4::ZERO;
        for bend in bends {
            let [x, y] = across.each_ref().map(|across| dot(bend, across));
            // Edge 2 runs towards the first corner.
            most = most.fast_max(x * x + y * y + x * y);
        }
        let square = self.area * self.area;
        let [a, b, c] = self.lengths.map(|length| length * length);
        // The greatest stretch of lengths by the metric, times the area.
        let half_trace = 0.25 * (a + b + c);
        let stretch = (half_trace
            + (half_trace * half_trace - 0.75 * square)
                .fast_max(f64x4::ZERO)
                .sqrt())
        .sqrt();
        (most.sqrt() + DIRECTIONS * first * stretch) / self.area
    }

    /// As in [`super::super::dihedral::around`], for triangles with neighbours beyond all edges.
    #[inline(always)]
    fn around(&self, corners: &[Vectors; 3], opposite: [Vectors; 3], scale: f64) -> Around {
        let share = 1.0 / self.area;
        let free = [0, 1, 2].map(|corner| {
            let lengths = self.lengths[corner] * self.lengths[(corner + 2) % 3];
            (lengths + self.products[corner]) * share
        });
        let mut around = Around {
            squared: [f64x4::ZERO; 3],
            slopes: free,
            is_known: f64x4::ZERO.simd_eq(f64x4::ZERO),
        };
        for edge in 0..3 {
            let out = minus(&opposite[edge].map(|axis| axis * scale), &corners[edge]);
            let across = cross(&out, &self.edges[edge]);
            let area = dot(&across, &across).sqrt();
            let share = 1.0 / area;
            let apart = minus(&self.normal, &across.map(|axis| axis * share));
            around.squared[edge] = dot(&apart, &apart);
            let at_start = dot(&out, &self.edges[edge]);
            let product = at_start.fast_max(self.lengths[edge] * self.lengths[edge] - at_start);
            around.slopes[edge] = free[edge]
                .fast_min(free[(edge + 1) % 3])
                .fast_min(area / product);
            around.is_known = around.is_known
                & area.simd_gt(f64x4::ZERO)
                & area.simd_lt(f64x4::splat(f64::INFINITY));
        }
        around
    }
}

/// The least and the greatest value of quadratics, by their second derivatives along the edges and their values at the corners, as
/// [`super::super::quartic_cell`] has it of one.
#[inline(always)]
pub(super) fn quadratic_range([p, q, s]: [f64x4; 3], [a, b, c]: [f64x4; 3]) -> (f64x4, f64x4) {
    let (mut low, mut high) = (a.fast_min(b).fast_min(c), a.fast_max(b).fast_max(c));
    let mut take = |is_met: f64x4, value: f64x4| {
        let value = is_met.bitselect(value, a);
        (low, high) = (low.fast_min(value), high.fast_max(value));
    };
    for (bend, from, to) in [(p, a, b), (q, b, c), (s, c, a)] {
        let rise = to - from;
        // Where the derivative along the edge vanishes.
        let is_met = (2.0 * rise.abs()).simd_lt(bend.abs());
        take(
            is_met,
            0.5 * (from + to) - 0.125 * bend - 0.5 * rise * rise / bend,
        );
    }
    // Where both derivatives from the first corner do.
    let mixed = p + s - q;
    let determinant = 4.0 * p * s - mixed * mixed;
    let (by_second, by_third) = (p - 2.0 * (b - a), s - 2.0 * (c - a));
    let share = 1.0 / determinant;
    let second = (2.0 * s * by_second - mixed * by_third) * share;
    let third = (2.0 * p * by_third - mixed * by_second) * share;
    let zero = f64x4::ZERO;
    let is_inside = determinant.simd_gt(zero)
        & second.simd_gt(zero)
        & third.simd_gt(zero)
        & (second + third).simd_lt(f64x4::splat(1.0));
    take(
        is_inside,
        a - 0.25 * (second * by_second + third * by_third),
    );
    (low, high)
}

#[inline(always)]
fn vectors(rows: &[[f64; FOUR]; 3]) -> Vectors {
    [
        f64x4::new(rows[0]),
        f64x4::new(rows[1]),
        f64x4::new(rows[2]),
    ]
}

#[inline(always)]
fn single(row: &[f32; FOUR]) -> f64x4 {
    f64x4::new(row.map(f64::from))
}
