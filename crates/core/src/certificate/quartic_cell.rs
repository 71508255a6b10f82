//! How far a triangle can be from its part of a regular piece, from the piece's derivatives.
//!
//! A regular piece is a quartic S over its domain. Let T be the triangle over part D of the domain, its corners on those of
//! S, and f the height of S over the plane of T: a quartic that is 0 at the corners of D. Fifteen coefficients less three
//! are left: the second derivatives W₁, W₂, W₃ along the edges in their middles, four third derivatives at the centroid and
//! five fourth ones. Each group fixes one part of f = q + c + r ([`Heights`]):
//!
//! * q = −½ Σ λᵢλⱼ Wᵢⱼ, whose greatest height has a closed form;
//! * c = −Σ (tᵢ/12) λₐλ_b(λ_b − λₐ) + B λ₀λ₁λ₂, tᵢ the third derivative along edge i from a to b, and
//!   B = −¼(t₁ + 2 f‴(e₁e₁e₂)) + (t₂ − t₃)/12: so |c| is at most [`CUBIC`] max |tᵢ| + |B|/27;
//! * r, linear in the fourth derivatives, is at most [`QUARTIC`] times the greatest of the six |f⁗(eᵢeᵢeⱼeⱼ)|.
//!
//! So the greatest height lies within |c| + |r| of that of q, for parts of any size. Where that does not decide, the
//! coefficients of f in Bernstein's basis over sixteen parts of D bound it.
//!
//! **At the edges.** Along an edge the curve of S differs from its chord by −½τ(1 − τ)W + (T/6)(x³
//! − x/4) + (F/24)(x⁴ − 1/16), x = τ − ½, W, T and F being the second, third and fourth derivatives
//! along the edge in its middle. Its distance from the chord and its slope towards the chord's ends
//! follow term by term.
//!
//! **No two points in one place.** Let A be the derivative of the projection of S on the plane of T less that of the point of T,
//! both over the domain, in the metric of the plane in which T has three edges of length 1. Where ‖A‖ < 1 all over D the
//! projection takes no two points to one place, since from one point of D to another it changes by the change on T and the mean of A
//! along the way; its rim is the three curves, so nothing of S reaches over an edge farther than the edge's own curve. With
//! f = q + c + r as above, now within the plane ([`turn`]):
//!
//! * the part of q is linear over D: greatest in a corner. There it is ½Wᵢ and −½Wⱼ along the edges that end and start
//!   in the corner, so ‖A‖² ≤ ⅔ · ¼(|Wᵢ|² + |Wⱼ|² + |Wᵢ − Wⱼ|²) ≤ max |W|², ⅔ Σ|Aeᵢ|² being the square of the Frobenius norm;
//! * along an edge the derivative of c is at most Σ |tᵢ|/12 + ¼|B|, and |B| ≤ 11/12 times the greatest third derivative T: less than ½T;
//! * that of r is linear in the fourth derivatives: at most [`QUARTIC_SLOPE`] times the greatest F of the six along pairs of edges, for
//!   vectors, too, as each of their components obeys it;
//! * a unit vector is the sum of two edges times factors of 2/√3 together, so c and r add 2/√3
//!   times these, either with lengths in that metric or, by bounds of T and F, times the greatest
//!   stretch of lengths by the metric.
//!
//! **What reaches over an edge.** A point whose barycentric coordinate of the corner opposite is λ lies λ times the altitude inside the
//! edge on T, and within the curve's own reach g and λ times the change along an edge beyond that on S. That change is at most 2/√3 ‖A‖ times the
//! altitude, so λ ≤ g/(altitude (1 − 2/√3 ‖A‖)) for points that reach over the edge ([`share_beyond`]). Their heights are those
//! of the curve and λ times the greatest derivative of heights along edges: the greatest second derivative and what c and r add.
//!
//! Otherwise all that is known is |S − T| ≤ ½ Σ λᵢλⱼ M ≤ M/6, M bounding second derivatives along edges all over D.

mod heights;

use super::deviation::Deviation;
use super::triangle_frame::TriangleFrame;
use crate::patch::Quartic;
use crate::vector::{DVec3, Extremes, hypotenuse};
pub(crate) use heights::{Heights, edge_range, quadratic_height};

/// Bounds Σ λₐλ_b|λ_b − λₐ|/12 over the triangle, which is 0.1176/12 at most: a polynomial wherever the coordinates are in
/// order, whose Bernstein coefficients over small parts are less (`the_cubic_constant_holds`).
pub(super) const CUBIC: f64 = 0.00985;

/// Bounds |r| where the six fourth derivatives along pairs of edges are at most 1: linear in the fourth derivatives, it is
/// greatest at a vertex of that polytope, 0.00505 by Bernstein coefficients over small parts (`the_quartic_constant_holds`).
pub(super) const QUARTIC: f64 = 0.0052;

/// Bounds the derivative of r along an edge where the six fourth derivatives along pairs of edges are at most 1: linear in them again, and
/// 5/72 at a vertex of that polytope (`the_quartic_constant_holds`).
pub(super) const QUARTIC_SLOPE: f64 = 0.0695;

/// The greatest of |x³ − x/4|/6 for |x| ≤ 1/2, √3/216, rounded up.
pub(super) const CURVE_CUBIC: f64 = 0.00802;

/// A unit vector is the sum of two edges of a triangle with edges of length 1 times factors whose
/// sum is at most this: 2/√3, rounded up.
pub(super) const DIRECTIONS: f64 = 1.154_701;

/// Less than 1 after any rounding.
pub(super) const NEARLY_ONE: f64 = 1.0 - 1e-6;

/// A direction or a place in a piece's domain.
pub(crate) type Domain = [f64; 2];

/// The second, third and fourth derivatives of a regular piece, or of its height over a plane.
#[derive(Clone, Copy, Debug)]
struct Jet<T> {
    /// By u twice, by u and v, by v twice: coefficients of 1, u, v, u², uv, v².
    second: [[T; 6]; 3],
    /// By u three times to v three times: coefficients of 1, u, v.
    third: [[T; 3]; 4],
    /// By u four times to v four times.
    fourth: [T; 5],
}

impl<T> Jet<T>
where
    T: Copy + core::ops::Mul<f64, Output = T>,
{
    /// The derivatives of a polynomial with these coefficients of u², uv, v², of u³ to v³, and of u⁴ to v⁴.
    #[inline]
    fn of(square: [T; 3], cubic: [T; 4], quartic: [T; 5]) -> Self {
        let ([uu, uv, vv], [uuu, uuv, uvv, vvv], [uuuu, uuuv, uuvv, uvvv, vvvv]) =
            (square, cubic, quartic);
        Self {
            second: [
                [
                    uu * 2.0,
                    uuu * 6.0,
                    uuv * 2.0,
                    uuuu * 12.0,
                    uuuv * 6.0,
                    uuvv * 2.0,
                ],
                [uv, uuv * 2.0, uvv * 2.0, uuuv * 3.0, uuvv * 4.0, uvvv * 3.0],
                [
                    vv * 2.0,
                    uvv * 2.0,
                    vvv * 6.0,
                    uuvv * 2.0,
                    uvvv * 6.0,
                    vvvv * 12.0,
                ],
            ],
            third: [
                [uuu * 6.0, uuuu * 24.0, uuuv * 6.0],
                [uuv * 2.0, uuuv * 6.0, uuvv * 4.0],
                [uvv * 2.0, uuvv * 4.0, uvvv * 6.0],
                [vvv * 6.0, uvvv * 6.0, vvvv * 24.0],
            ],
            fourth: [uuuu * 24.0, uuuv * 6.0, uuvv * 4.0, uvvv * 6.0, vvvv * 24.0],
        }
    }
}

/// A regular piece with bounds of its parts.
#[derive(Clone, Debug)]
pub(crate) struct QuarticJet {
    jet: Jet<DVec3>,
    /// The coefficients of the polynomial by their powers of u and v: the second, third and fourth ones.
    powers: ([DVec3; 3], [DVec3; 4], [DVec3; 5]),
    /// The bound of third derivatives along three directions with coordinates up to 1.
    most_third: f64,
    /// The bound of fourth derivatives along four directions with coordinates up to 1.
    most_fourth: f64,
}

/// A part of a piece's domain: a triangle with three corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell(pub(crate) [Domain; 3]);

impl QuarticJet {
    pub(crate) fn of(piece: &Quartic) -> Self {
        let (square, cubic, quartic) = piece.powers();
        let jet = Jet::of(square, cubic, quartic);
        // Third derivatives are linear: greatest in a corner.
        let (mut at_corners, mut sizes) = ([0.0; 4], [0.0; 5]);
        for (most, &[c, u, v]) in at_corners.iter_mut().zip(&jet.third) {
            let ends = (c + u).length_squared().larger((c + v).length_squared());
            *most = c.length_squared().larger(ends).sqrt();
        }
        sizes
            .iter_mut()
            .zip(&jet.fourth)
            .for_each(|(size, c): (&mut f64, &DVec3)| *size = c.length());
        Self {
            jet,
            powers: (square, cubic, quartic),
            most_third: at_corners[0] + 3.0 * (at_corners[1] + at_corners[2]) + at_corners[3],
            most_fourth: sizes[0] + 4.0 * (sizes[1] + sizes[3]) + 6.0 * sizes[2] + sizes[4],
        }
    }

    /// The heights of a part over the plane of its corners.
    #[inline]
    pub(crate) fn heights(&self, cell: &Cell, normal: DVec3) -> Heights {
        let (square, cubic, quartic) = &self.powers;
        let (mut heights, mut thirds, mut fourths) = ([0.0; 3], [0.0; 4], [0.0; 5]);
        (0..3).for_each(|i| heights[i] = normal.dot(square[i]));
        (0..4).for_each(|i| thirds[i] = normal.dot(cubic[i]));
        (0..5).for_each(|i| fourths[i] = normal.dot(quartic[i]));
        Heights::of(&Jet::of(heights, thirds, fourths), cell)
    }

    /// The distances of a part of the surface from the edges of the triangle of its corners; `open`
    /// edges have no neighbour. Third and fourth derivatives are bounded over the whole piece.
    pub(crate) fn edge_bounds(
        &self,
        cell: &Cell,
        frame: &TriangleFrame,
        open: [bool; 3],
    ) -> EdgeBounds {
        let bends = self.bends(cell);
        let (third, fourth) = self.most(reach(cell));
        let first = 0.5 * third + QUARTIC_SLOPE * fourth;
        let steep = third / 12.0 + fourth / 48.0;
        let off = CURVE_CUBIC * third + fourth / 384.0;
        let rest = EdgeRest {
            off,
            height: off,
            outward: steep,
            along: steep,
        };
        let inside = InnerRest {
            turn: turn(frame, &bends, frame.stretch() * first),
            rise: first,
        };
        EdgeBounds::of(frame, &bends, [rest; 3], open, inside, third + fourth)
    }

    /// The distances from the edges by the part's own third and fourth derivatives, where the first
    /// is known.
    pub(crate) fn closer_edge_bounds(
        &self,
        known: &EdgeBounds,
        cell: &Cell,
        frame: &TriangleFrame,
        open: [bool; 3],
    ) -> EdgeBounds {
        let EdgeBounds { bends, rest, .. } = known;
        let part = self.part(cell);
        let rests = [0, 1, 2].map(|edge| part.rest(edge, frame));
        EdgeBounds::of(frame, bends, rests, open, part.inside(frame, bends), *rest)
    }

    /// Third and fourth derivatives of a part.
    fn part(&self, &Cell([first, second, last]): &Cell) -> PartDerivatives {
        let (s, r) = (minus(second, first), minus(last, first));
        let centroid = [0, 1].map(|axis| (first[axis] + second[axis] + last[axis]) / 3.0);
        let thirds = self.third_at(centroid);
        let (by_ss, by_rr) = (
            contracted::<3, 2>(&contracted::<4, 3>(&thirds, s), s),
            contracted::<3, 2>(&contracted::<4, 3>(&thirds, r), r),
        );
        let [[a], [b]] = [s, r].map(|way| contracted::<2, 1>(&by_ss, way));
        let [[c], [d]] = [s, r].map(|way| contracted::<2, 1>(&by_rr, way));
        let by_ss = contracted::<4, 3>(&contracted::<5, 4>(&self.jet.fourth, s), s);
        let by_rr = contracted::<4, 3>(&contracted::<5, 4>(&self.jet.fourth, r), r);
        let [by_sss, by_ssr] = [s, r].map(|way| contracted::<3, 2>(&by_ss, way));
        let by_rrr = contracted::<3, 2>(&by_rr, r);
        let [[ssss], [sssr]] = [s, r].map(|way| contracted::<2, 1>(&by_sss, way));
        let [ssrr] = contracted::<2, 1>(&by_ssr, r);
        let [[srrr], [rrrr]] = [s, r].map(|way| contracted::<2, 1>(&by_rrr, way));
        let across = d - a + 3.0 * (b - c);
        let both = ssss - 4.0 * (sssr + srrr) + 6.0 * ssrr + rrrr;
        PartDerivatives {
            thirds: [a, across, d],
            bubble: -0.25 * (2.0 * b - a) + (across + d) / 12.0,
            pairs: [
                ssss,
                both,
                rrrr,
                ssrr,
                ssss - 2.0 * sssr + ssrr,
                rrrr - 2.0 * srrr + ssrr,
            ],
            // A sixth and a third of the way from the centroid.
            middles: [
                a + ssss / 6.0 - sssr / 3.0,
                across + (rrrr - ssss + 2.0 * (sssr - srrr)) / 6.0,
                d + rrrr / 6.0 - srrr / 3.0,
            ],
        }
    }

    /// The second derivatives along the edges of a part in their middles.
    #[inline]
    fn bends(&self, &Cell(corners): &Cell) -> [DVec3; 3] {
        let mut bends = [DVec3::ZERO; 3];
        for (edge, bend) in bends.iter_mut().enumerate() {
            let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
            *bend = self.bend(halfway(from, to), minus(to, from));
        }
        bends
    }

    /// The second derivatives, as coefficients of 1, u, v, u², uv, v².
    pub(super) fn second(&self) -> &[[DVec3; 6]; 3] {
        &self.jet.second
    }

    /// The third derivatives at a place: by u three times to v three times.
    pub(super) fn third_at(&self, [u, v]: Domain) -> [DVec3; 4] {
        let mut found = [DVec3::ZERO; 4];
        for (found, &[c, by_u, by_v]) in found.iter_mut().zip(&self.jet.third) {
            *found = c + by_u * u + by_v * v;
        }
        found
    }

    /// The third derivatives: by u three times to v three times, as coefficients of 1, u, v.
    pub(super) fn third(&self) -> &[[DVec3; 3]; 4] {
        &self.jet.third
    }

    /// The fourth derivatives.
    pub(super) fn fourth(&self) -> &[DVec3; 5] {
        &self.jet.fourth
    }

    /// The bounds of third and fourth derivatives along directions with coordinates up to `reach`.
    pub(super) fn most(&self, reach: f64) -> (f64, f64) {
        let cube = reach * reach * reach;
        (self.most_third * cube, self.most_fourth * cube * reach)
    }

    /// The second derivative along a direction.
    #[inline]
    fn bend(&self, at: Domain, [du, dv]: Domain) -> DVec3 {
        let [uu, uv, vv] = &self.jet.second;
        // Two edges of nearly all parts are parallel to the domain's.
        if dv == 0.0 {
            return quadratic(uu, at) * (du * du);
        }
        if du == 0.0 {
            return quadratic(vv, at) * (dv * dv);
        }
        quadratic(uu, at) * (du * du)
            + quadratic(uv, at) * (2.0 * du * dv)
            + quadratic(vv, at) * (dv * dv)
    }
}

/// The distances of a part of the surface from the edges of its triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeBounds {
    /// How far curves are from their edges within the triangle's plane.
    side: f64,
    /// The distance from edges without a neighbour.
    open: f64,
    /// The heights of the curves over the others and of what reaches over these, and how far it does, by edge.
    edge_heights: [f64; 3],
    displacements: [f64; 3],
    /// The greatest ratio of that to the distance from the edge's ends, by edge.
    slopes: [f64; 3],
    /// The distance of the surface from the triangle, where none of the others is bounded.
    loose: Option<f64>,
    /// Second derivatives along the edges in their middles, and their greatest deviation anywhere.
    bends: [DVec3; 3],
    rest: f64,
}

/// The third and fourth derivatives of a part, along its edges: from the first corner to the second, on to the third, and from the first to
/// the third.
struct PartDerivatives {
    /// Third ones at the centroid.
    thirds: [DVec3; 3],
    /// B of the module's page.
    bubble: DVec3,
    /// Fourth ones along the edges, then along pairs of two.
    pairs: [DVec3; 6],
    /// Third ones in the middles of the edges.
    middles: [DVec3; 3],
}

impl PartDerivatives {
    /// The share of third and fourth derivatives along an edge.
    #[inline]
    fn rest(&self, edge: usize, frame: &TriangleFrame) -> EdgeRest {
        let (third, fourth) = (self.middles[edge], self.pairs[edge]);
        let (outward, along) = (frame.outward(edge), frame.along(edge));
        let steep = |way: DVec3| third.dot(way).abs() / 12.0 + fourth.dot(way).abs() / 48.0;
        let off = |way: DVec3| CURVE_CUBIC * third.dot(way).abs() + fourth.dot(way).abs() / 384.0;
        EdgeRest {
            off: off(outward),
            height: off(frame.normal()),
            outward: steep(outward),
            along: steep(along),
        }
    }

    /// Their share inside the part.
    #[inline]
    fn inside(&self, frame: &TriangleFrame, bends: &[DVec3; 3]) -> InnerRest {
        let length = |vector: DVec3| frame.stretched_squared(vector).sqrt();
        let height = |vector: DVec3| vector.dot(frame.normal()).abs();
        let by = |size: &dyn Fn(DVec3) -> f64| {
            let thirds = self.thirds.map(size).iter().sum::<f64>();
            let fourth = self.pairs.map(size).into_iter().fold(0.0, f64::larger);
            thirds / 12.0 + 0.25 * size(self.bubble) + QUARTIC_SLOPE * fourth
        };
        InnerRest {
            turn: turn(frame, bends, by(&length)),
            rise: by(&height),
        }
    }
}

/// The share of third and fourth derivatives inside a part.
#[derive(Clone, Copy, Debug)]
struct InnerRest {
    /// ‖A‖ of the module's page, with that of second derivatives.
    turn: f64,
    /// To the derivatives of heights along edges.
    rise: f64,
}

/// The share of third and fourth derivatives along an edge.
#[derive(Clone, Copy, Debug)]
struct EdgeRest {
    /// To the distance of the curve from the edge's line within the triangle's plane, and to its height.
    off: f64,
    height: f64,
    /// To the curve's slope towards the ends: outwards, and along the edge.
    outward: f64,
    along: f64,
}

impl EdgeBounds {
    /// By the second derivatives along the edges in their middles, the share of third and fourth
    /// ones in the curves and inside, and the greatest deviation of second derivatives along edges.
    #[inline]
    fn of(
        frame: &TriangleFrame,
        bends: &[DVec3; 3],
        rests: [EdgeRest; 3],
        open: [bool; 3],
        inside: InnerRest,
        rest: f64,
    ) -> Self {
        let slopes = [0.0; 3];
        let mut found = Self {
            side: 0.0,
            open: 0.0,
            edge_heights: [0.0; 3],
            displacements: [0.0; 3],
            slopes,
            loose: None,
            bends: *bends,
            rest,
        };
        // Fails for NaN.
        let mut is_plain = !frame.is_flat() && inside.turn < NEARLY_ONE;
        let heights = bends.map(|bend| bend.dot(frame.normal()).abs());
        let rise = heights.into_iter().fold(0.0, f64::larger) + inside.rise;
        for edge in 0..3 {
            // Outwards where the derivative points inwards.
            let outward = -bends[edge].dot(frame.outward(edge));
            let along = bends[edge].dot(frame.along(edge)).abs();
            let by_rest = rests[edge];
            let room = frame.length(edge) - (0.5 * along + by_rest.along);
            let swing = (0.5 * outward.abs() + by_rest.outward) / room;
            is_plain &= room > 0.0 && swing <= frame.slope_at(edge);
            let off = 0.125 * outward.abs() + by_rest.off;
            // A curve that bends inwards may reach outwards by the rest alone, nearer to an end.
            let outward = outward.larger(0.0);
            found.side = found.side.larger(off);
            if open[edge] {
                found.open = found.open.larger(off);
            } else {
                let reach = 0.125 * outward + by_rest.off;
                found.displacements[edge] = reach;
                found.edge_heights[edge] = 0.125 * heights[edge]
                    + by_rest.height
                    + rise * share_beyond(reach, frame.altitude(edge), inside.turn);
                found.slopes[edge] = (0.5 * outward + by_rest.outward) / room;
            }
        }
        if !is_plain {
            let most = bends
                .iter()
                .map(|bend| bend.length_squared())
                .fold(0.0, f64::max)
                .sqrt();
            found.loose = Some((most + rest) / 6.0);
        }
        found
    }

    /// Whether the derivatives do not bound the distances from the edges.
    pub(crate) fn is_loose(&self) -> bool {
        self.loose.is_some()
    }

    /// The deviation where the surface is so high at most.
    pub(crate) fn deviation(&self, height: f64) -> Deviation {
        match self.loose {
            Some(own) => Deviation {
                slopes: [f64::INFINITY; 3],
                ..Deviation::alone(own)
            },
            None => {
                let alone = hypotenuse(height, self.open);
                let across = if self.open > 0.0 { alone } else { 0.0 };
                Deviation {
                    own: hypotenuse(height, self.side),
                    height: alone,
                    edge_heights: self.edge_heights,
                    displacements: self.displacements,
                    slopes: self.slopes,
                    across,
                    ..Deviation::default()
                }
            }
        }
    }

    /// The deviation, at this height of the surface, of a triangle whose corners were moved off the
    /// surface by up to `moved`, up to `aside` of that within its plane.
    ///
    /// Let the piece be moved within the plane so that each corner is over that of the triangle,
    /// and points between by their barycentric coordinates. Its curves are relative to the
    /// triangle's edges as those of the surface to its own chords; its heights are unchanged; and
    /// no point was moved farther than a corner. So the surface's own curves are no more than
    /// `aside` farther from the edges, at right angles to heights, and [`Deviation::off`] bounds
    /// the gaps at the corners.
    pub(crate) fn deviation_off(&self, height: f64, moved: f64, aside: f64) -> Deviation {
        if self.loose.is_some() {
            return self.deviation(height).grown(moved);
        }
        let farther = |distance: f64| {
            if distance > 0.0 {
                distance + aside
            } else {
                0.0
            }
        };
        let moved_piece = Self {
            side: self.side + aside,
            open: farther(self.open),
            ..*self
        };
        let found = moved_piece.deviation(height).off(moved, aside);
        // Heights of the curves are those over the surface's own chords.
        let edge_heights = if moved > 0.0 {
            [found.height; 3]
        } else {
            found.edge_heights
        };
        Deviation {
            edge_heights,
            ..found
        }
    }
}

/// A bound of ‖A‖ by the second derivatives along the edges in their middles, and the change by third and fourth ones of the
/// first derivatives along edges, in the metric of the triangle.
#[inline]
fn turn(frame: &TriangleFrame, bends: &[DVec3; 3], rest: f64) -> f64 {
    let most = bends
        .iter()
        .map(|&bend| frame.stretched_squared(bend))
        .fold(0.0, f64::max)
        .sqrt();
    most + DIRECTIONS * rest
}

/// The greatest barycentric coordinate, of the corner opposite, of a point that reaches over an edge, by how far the curve there
/// does, the altitude, and ‖A‖.
#[inline]
fn share_beyond(reach: f64, altitude: f64, turn: f64) -> f64 {
    let room = altitude * (1.0 - DIRECTIONS * turn);
    if room > reach { reach / room } else { 1.0 }
}

/// The greatest coordinate of an edge's direction.
#[inline]
fn reach(&Cell([a, b, c]): &Cell) -> f64 {
    let edges = [minus(b, a), minus(c, b), minus(a, c)];
    edges
        .as_flattened()
        .iter()
        .fold(0.0, |most, x| most.larger(x.abs()))
}

/// A symmetric form with one direction put in: N − 1 = M.
#[inline]
fn contracted<const N: usize, const M: usize>(form: &[DVec3; N], [u, v]: Domain) -> [DVec3; M] {
    let mut found = [DVec3::ZERO; M];
    for (i, found) in found.iter_mut().enumerate() {
        *found = form[i] * u + form[i + 1] * v;
    }
    found
}

/// The value of a quadratic polynomial.
#[inline]
pub(super) fn quadratic<T>(c: &[T; 6], [u, v]: Domain) -> T
where
    T: Copy + core::ops::Add<Output = T> + core::ops::Mul<f64, Output = T>,
{
    c[0] + (c[1] + c[3] * u + c[4] * v) * u + (c[2] + c[5] * v) * v
}

fn minus(a: Domain, b: Domain) -> Domain {
    [a[0] - b[0], a[1] - b[1]]
}

fn halfway(a: Domain, b: Domain) -> Domain {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

#[cfg(test)]
mod tests;
