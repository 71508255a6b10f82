//! The bound for a triangle that lies over many triangles of the other surface, or over the edge between two.
//!
//! Let t be a triangle and u a direction across it. Every point v of space has coordinates (λ₁, λ₂, h) with
//! v = c₀ + λ₁ (c₁ − c₀) + λ₂ (c₂ − c₀) + h u, so that (λ₁, λ₂) is its shadow on the plane of t, h its height, and t
//! the triangle of shadows λ₁ ≥ 0, λ₂ ≥ 0, λ₃ = 1 − λ₁ − λ₂ ≥ 0. A sheet D of the other surface is gathered from one
//! of its triangles: wherever the shadow of a side meets t, the triangle across is added.
//!
//! **Cover.** Every side of D that an odd number of its triangles share then casts its shadow
//! outside t. So the number of shadows of D's triangles that cover a point is odd at all points of
//! t or at none (the degree modulo two of a map is constant off the image of the boundary;
//! orientation, folds and planarity do not matter). If it is odd at one point, then at each point
//! of t a line along u meets D, and the distance from t to the surface is at most the greatest |h|
//! of D over t. Heights are linear on a triangle, so that it is attained at a corner of D's
//! triangles clipped to t.
//!
//! **Inset.** The surface may end inside t, at a boundary or where it turns down a ridge so steeply that heights say
//! nothing. Such sides are not crossed. The argument then holds for the part s = {λᵢ ≥ mᵢ} of t that they do not reach,
//! a smaller copy of t. A point of t is at most as far from its counterpart in s as the corners are from theirs, and
//! this sideways step w and the height combine to √(w² + h² + 2 w h sin φ), φ being the angle between u and the
//! normal of t.
//!
//! **Rounding.** The computed coordinates of D's vertices are taken for exact ones of vertices slightly off: all
//! triangles at a vertex see the same numbers, so that the argument about shadows holds for the displaced sheet
//! without any error as long as each answer "the shadow is outside" and each count is right, which the tests of signs
//! below prove by their error bounds (Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997, eq. 20); whatever
//! is in doubt counts as meeting t, or as a point at which nothing can be counted. How far the vertices are off is added
//! to the bound; see [`View::new`].

use super::scale::ROUNDOFF;
use super::seen::Seen;
use super::target::Target;
use crate::geometry::NONE;
use crate::vector::DVec3;

/// A side is not crossed if the triangle beyond is higher than the goal and steeper than this: squared cosine of its
/// angle to the direction. Beyond 72° a sideways step to the ridge is shorter than the height by a factor of three.
const STEEP: f64 = 0.1;

/// Where a surface ends within t, the inset is this much wider than it would have to be, so that rounding (2^-52 of the
/// coordinates) cannot make the side reach into it.
const INSET_MARGIN: f64 = 1.0 / (1u64 << 40) as f64;

/// Insets that leave less than this of t are not tried: the sideways step is then as long as t itself.
const LEAST_LEFT: f64 = 0.1;

/// Where shadows are counted, in weights of the corners of s; irregular, so that sides that pass through the middle or
/// parallel to a side of t do not pass through all of them.
const COUNTED_AT: [[f64; 2]; 4] = [
    [0.3281, 0.3397],
    [0.2113, 0.5347],
    [0.5189, 0.2371],
    [0.1693, 0.1987],
];

/// Coordinates of space by a triangle and a direction.
struct View {
    base: DVec3,
    rows: [DVec3; 3],
    /// The greatest distance of the vertices at computed coordinates from the true ones.
    slack: f64,
    /// Sine of the angle between the direction and the triangle's normal, or a little more.
    tilt: f64,
}

/// A triangle of the sheet, its corners as (λ₁, λ₂, h).
#[derive(Clone, Copy)]
struct Patch {
    face: u32,
    /// The side through which it was entered.
    entered: u32,
    corners: [DVec3; 3],
}

/// Gathers sheets; its memory is used again from one to the next.
pub(super) struct Cover {
    sheet: Vec<Patch>,
    ends: Vec<[DVec3; 2]>,
    seen: Seen,
    /// Triangles visited so far.
    pub(super) visited: u64,
}

impl View {
    /// The coordinates by triangle `t` and unit vector `direction`; `None` where they are not defined.
    ///
    /// With e₁, e₂ the sides from c₀, det = u · (e₁ × e₂) and κ = |e₁| |e₂| / |det|, a coordinate is a product of one
    /// of the rows (e₂ × u, u × e₁, e₁ × e₂) / det with v − c₀. Each row is known to (24 + 8 κ) roundings of its greatest
    /// possible length, |e₂| / |det|, |e₁| / |det| and κ, the product adds 4, and v − c₀ is off by one rounding of
    /// the greatest coordinate M and at most 4 M long. Times |e₁|, |e₂| and 1 this is a displacement of at most
    /// 3 κ (28 + 8 κ) 4 M + 3 κ · 2 M roundings; 512 κ² M is more than that, as κ ≥ 1.
    fn new([a, b, c]: [DVec3; 3], direction: DVec3, magnitude: f64) -> Option<Self> {
        let (e1, e2) = (b - a, c - a);
        let normal = e1.cross(e2);
        let determinant = direction.dot(normal);
        let condition = (e1.length() * e2.length() / determinant.abs()).max(1.0);
        let slack = 512.0 * condition * condition * ROUNDOFF * magnitude;
        let cosine = determinant / normal.length();
        let rows = [
            e2.cross(direction) / determinant,
            direction.cross(e1) / determinant,
            normal / determinant,
        ];
        let usable =
            slack.is_finite() && cosine.is_finite() && rows.iter().all(|row| row.is_finite());
        // The cosine is known to some roundings times the condition, of which the root makes far more near 1.
        let squared = (1.0 - cosine * cosine).max(0.0) + 64.0 * condition * ROUNDOFF;
        usable.then(|| Self {
            base: a,
            rows,
            slack,
            tilt: squared.sqrt(),
        })
    }

    #[inline]
    fn of(&self, p: DVec3) -> DVec3 {
        let p = p - self.base;
        DVec3::new(
            self.rows[0].dot(p),
            self.rows[1].dot(p),
            self.rows[2].dot(p),
        )
    }
}

impl Cover {
    pub(crate) fn new() -> Self {
        Self {
            sheet: Vec::new(),
            ends: Vec::new(),
            seen: Seen::new(),
            visited: 0,
        }
    }

    /// An upper bound of the distance of triangle `t` to the surface, from the sheet around triangle `start` seen along
    /// `direction`; infinite if the sheet does not cover t, has more than `limit` triangles, or no bound near `goal`
    /// can come of it.
    pub(super) fn bound(
        &mut self,
        target: &Target<'_, '_>,
        t: [DVec3; 3],
        start: u32,
        direction: DVec3,
        goal: f64,
        limit: usize,
    ) -> f64 {
        let Some(view) = View::new(t, direction, target.scale.magnitude) else {
            return f64::INFINITY;
        };
        if !self.gather(target, &view, start, goal, limit) {
            return f64::INFINITY;
        }
        let Some(inset) = self.inset(t) else {
            return f64::INFINITY;
        };
        if !self.covers(inset) {
            return f64::INFINITY;
        }
        let step = sideways(t, inset);
        let height = self.height(inset);
        (step * step + height * height + 2.0 * step * height * view.tilt).sqrt()
            + view.slack
            + target.scale.slack
    }

    /// Whether the last sheet had ends within t, so that the bound holds a step sideways.
    pub(super) fn is_inset(&self) -> bool {
        !self.ends.is_empty()
    }

    /// Gathers the sheet and the ends that it has within t. Whether it is of at most `limit` triangles.
    fn gather(
        &mut self,
        target: &Target<'_, '_>,
        view: &View,
        start: u32,
        goal: f64,
        limit: usize,
    ) -> bool {
        self.sheet.clear();
        self.ends.clear();
        self.seen.clear();
        self.seen.insert(start);
        let corners = target.triangle(start).map(|p| view.of(p));
        self.sheet.push(Patch {
            face: start,
            entered: NONE,
            corners,
        });
        let mut next = 0;
        while let Some(&patch) = self.sheet.get(next) {
            next += 1;
            if next > limit {
                break;
            }
            for corner in 0..3 {
                let side = 3 * patch.face + corner;
                if side != patch.entered {
                    self.look_across(target, view, &patch, corner as usize, goal);
                }
            }
        }
        self.visited += next as u64;
        next <= limit
    }

    /// Adds the triangle across a side whose shadow meets t, or notes that the sheet ends there.
    #[inline]
    fn look_across(
        &mut self,
        target: &Target<'_, '_>,
        view: &View,
        patch: &Patch,
        corner: usize,
        goal: f64,
    ) {
        let (from, to) = (patch.corners[corner], patch.corners[(corner + 1) % 3]);
        if passes_by(from, to) {
            return;
        }
        let side = 3 * patch.face + corner as u32;
        let Some(across) = target.across(side) else {
            self.ends.push([from, to]);
            return;
        };
        let face = across / 3;
        if self.seen.contains(face) {
            return;
        }
        let (vertices, first) = (target.vertices(face), across as usize % 3);
        let opposite = view.of(target.vertex(vertices[(first + 2) % 3]));
        if opposite.z.abs() > goal && is_steep(from, to, opposite, view, target.triangle(face)) {
            self.ends.push([from, to]);
            return;
        }
        let mut corners = [opposite; 3];
        let runs_back = vertices[first] != target.vertices(patch.face)[corner];
        (corners[first], corners[(first + 1) % 3]) =
            if runs_back { (to, from) } else { (from, to) };
        self.seen.insert(face);
        self.sheet.push(Patch {
            face,
            entered: across,
            corners,
        });
    }

    /// By how much of the weights of its corners t has to be inset so that no end of the sheet reaches it. Each end
    /// is avoided where that costs the least step sideways.
    fn inset(&self, t: [DVec3; 3]) -> Option<[f64; 3]> {
        let mut inset = [0.0f64; 3];
        if self.ends.is_empty() {
            return Some(inset);
        }
        let altitude = |corner: usize| {
            let (a, b) = (t[(corner + 1) % 3], t[(corner + 2) % 3]);
            (b - a).cross(t[corner] - a).length() / (b - a).length()
        };
        let altitudes = [altitude(1), altitude(2), altitude(0)];
        for &[from, to] in &self.ends {
            let depths = depths(from, to)?;
            if (0..3).any(|i| depths[i] <= inset[i]) {
                continue;
            }
            let cost = |i: usize| (depths[i] - inset[i]) * altitudes[i];
            let cheapest = (1..3).fold(0, |best, i| if cost(i) < cost(best) { i } else { best });
            inset[cheapest] = depths[cheapest];
        }
        (inset.iter().sum::<f64>() <= 1.0 - LEAST_LEFT).then_some(inset)
    }

    /// Whether the shadows of the sheet cover some point of the inset t an odd number of times, and so all of it.
    fn covers(&self, inset: [f64; 3]) -> bool {
        let left = 1.0 - inset.iter().sum::<f64>();
        COUNTED_AT.iter().find_map(|at| {
            let (x, y) = (inset[0] + left * at[0], inset[1] + left * at[1]);
            let mut odd = false;
            for patch in &self.sheet {
                odd ^= holds(&patch.corners, x, y)?;
            }
            Some(odd)
        }) == Some(true)
    }

    /// The greatest height, up or down, of the sheet over the inset t.
    fn height(&self, inset: [f64; 3]) -> f64 {
        let mut greatest = 0.0f64;
        for patch in &self.sheet {
            let [a, b, c] = patch.corners.map(|corner| corner.z.abs());
            if a.max(b).max(c) > greatest {
                greatest = greatest.max(clipped_height(&patch.corners, inset));
            }
        }
        greatest
    }
}

/// λ₁, λ₂ and λ₃ of a shadow.
#[inline]
fn weights(p: DVec3) -> [f64; 3] {
    [p.x, p.y, 1.0 - p.x - p.y]
}

/// The sign of the turn a, b, p: of (a − p) × (b − p), or 0 where rounding hides it.
#[inline]
fn turn(a: DVec3, b: DVec3, x: f64, y: f64) -> i32 {
    let (left, right) = ((a.x - x) * (b.y - y), (a.y - y) * (b.x - x));
    let difference = left - right;
    // 3 roundings and a little, where nothing vanishes; 4 are allowed.
    let error = 4.0 * ROUNDOFF * (left.abs() + right.abs()) + f64::MIN_POSITIVE;
    if difference > error {
        1
    } else if difference < -error {
        -1
    } else {
        0
    }
}

/// Whether the shadow of a side certainly does not meet t: beyond one of its sides, or t on one side of it.
#[inline]
fn passes_by(a: DVec3, b: DVec3) -> bool {
    // λ₃ < 0, also after the rounding of the sum.
    const BEYOND: f64 = 1.0 + 4.0 * ROUNDOFF;
    if (a.x < 0.0 && b.x < 0.0)
        || (a.y < 0.0 && b.y < 0.0)
        || (a.x + a.y > BEYOND && b.x + b.y > BEYOND)
    {
        return true;
    }
    let first = turn(a, b, 0.0, 0.0);
    first != 0 && turn(a, b, 1.0, 0.0) == first && turn(a, b, 0.0, 1.0) == first
}

/// Whether a triangle's shadow holds the point; `None` if it is too near one of the sides to
/// decide.
#[inline]
fn holds(&[a, b, c]: &[DVec3; 3], x: f64, y: f64) -> Option<bool> {
    if (a.x < x && b.x < x && c.x < x)
        || (a.x > x && b.x > x && c.x > x)
        || (a.y < y && b.y < y && c.y < y)
        || (a.y > y && b.y > y && c.y > y)
    {
        return Some(false);
    }
    match [turn(a, b, x, y), turn(b, c, x, y), turn(c, a, x, y)] {
        [1, 1, 1] | [-1, -1, -1] => Some(true),
        turns if turns.contains(&1) && turns.contains(&-1) => Some(false),
        _ => None,
    }
}

/// Whether the triangle beyond a side leaves the plane of t so steeply that the sheet should end before it.
#[cold]
fn is_steep(from: DVec3, to: DVec3, opposite: DVec3, view: &View, [a, b, c]: [DVec3; 3]) -> bool {
    // The direction is the one along which only the height changes.
    let direction = view.rows[0].cross(view.rows[1]);
    let normal = (b - a).cross(c - a);
    let along = normal.dot(direction);
    let gentle = along * along >= STEEP * normal.length_squared() * direction.length_squared();
    // Without area it has no slope, and its neighbours decide.
    !gentle && normal.length_squared() > 0.0 && from != to && opposite.is_finite()
}

/// How far the shadow of a side reaches into t from each of t's sides, in weights, with a margin; `None` if it is lost
/// in rounding.
fn depths(from: DVec3, to: DVec3) -> Option<[f64; 3]> {
    let (a, b) = (weights(from), weights(to));
    let size = 1.0 + a.iter().chain(&b).fold(0.0f64, |size, w| size.max(w.abs()));
    let margin = INSET_MARGIN * size;
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for i in 0..3 {
        // The part with weight ≥ −margin.
        let (start, end) = (a[i] + margin, b[i] + margin);
        if start < 0.0 && end < 0.0 {
            return None;
        }
        if start < 0.0 {
            first = first.max(start / (start - end));
        } else if end < 0.0 {
            last = last.min(start / (start - end));
        }
    }
    if first > last {
        return None;
    }
    let at = |i: usize, t: f64| a[i] * (1.0 - t) + b[i] * t;
    Some(core::array::from_fn(|i| {
        at(i, first).max(at(i, last)).max(0.0) + 2.0 * margin
    }))
}

/// The greatest distance of a point of t from its counterpart in the inset copy of t.
fn sideways(t: [DVec3; 3], inset: [f64; 3]) -> f64 {
    // Weight i belongs to corner i + 1.
    let of = [inset[2], inset[0], inset[1]];
    let step = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        ((t[j] - t[i]) * of[j] + (t[k] - t[i]) * of[k]).length()
    };
    step(0).max(step(1)).max(step(2))
}

/// The greatest height, up or down, of a triangle over the inset t: at the corners of its clipped
/// part.
///
/// Where the cuts fall is known to a few roundings of the weights. The points of t in the strip between the computed and
/// the true cut are that far from others, which [`View::new`] has room for.
fn clipped_height(corners: &[DVec3; 3], inset: [f64; 3]) -> f64 {
    // Each of the three cuts adds one corner; rounding may make a cut cross twice where it runs along a side.
    const MOST: usize = 9;
    let mut polygon = [DVec3::ZERO; MOST];
    polygon[..3].copy_from_slice(corners);
    let mut count = 3;
    for (i, &least) in inset.iter().enumerate() {
        let above = |p: DVec3| weights(p)[i] - least;
        let whole = polygon;
        let mut kept = 0;
        for place in 0..count {
            let (p, q) = (whole[place], whole[(place + 1) % count]);
            let (p_above, q_above) = (above(p), above(q));
            if p_above >= 0.0 && kept < MOST {
                polygon[kept] = p;
                kept += 1;
            }
            if (p_above >= 0.0) != (q_above >= 0.0) && kept < MOST {
                polygon[kept] = p + (q - p) * (p_above / (p_above - q_above));
                kept += 1;
            }
        }
        count = kept;
        if count == 0 {
            return 0.0;
        }
    }
    polygon[..count]
        .iter()
        .fold(0.0, |greatest, p| greatest.max(p.z.abs()))
}
