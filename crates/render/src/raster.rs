//! Coverage and depth: which triangle is seen at each sample of a tile.
//!
//! Edge functions in exact integers on a grid of 1/256 pixel (Pineda 1988), so triangles that share an edge
//! neither overlap nor leave a gap; samples exactly on an edge go by the top-left rule. Tiles bound the memory
//! that anti-aliasing needs and are independent of each other.

use std::ops::{Add, BitOr};

use crate::project::{Corner, Piece, Projected, STEPS};

/// Side of a tile in pixels: with 16 samples a pixel, its depths and faces fit a core's second-level cache.
pub(crate) const TILE: u32 = 32;

/// Stands for "nothing is seen here".
pub(crate) const NOTHING: u32 = u32::MAX;

/// The places of a pixel's samples, in grid steps from its upper left corner.
///
/// With n² samples, every sample has a row and a column of its own (a sheared grid), so that edges close to the
/// horizontal or vertical get n² levels of coverage rather than n.
pub(crate) fn sample_places(side: u32) -> Vec<[i32; 2]> {
    let n = side as i32;
    let step = STEPS / (n * n);
    let place = |i: i32, j: i32| step * (n * i + j) + step / 2;
    (0..n * n)
        .map(|s| [place(s % n, s / n), place(s / n, s % n)])
        .collect()
}

/// A rectangle of pixels; right and bottom are excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) right: i32,
    pub(crate) bottom: i32,
}

impl Rectangle {
    /// The pixels that three corners may touch.
    fn around(corners: [Corner; 3]) -> Self {
        let (x, y) = (corners.map(|c| c.x), corners.map(|c| c.y));
        let low = |v: [i32; 3]| v[0].min(v[1]).min(v[2]).div_euclid(STEPS);
        let high = |v: [i32; 3]| v[0].max(v[1]).max(v[2]).div_euclid(STEPS) + 1;
        Self {
            left: low(x),
            top: low(y),
            right: high(x),
            bottom: high(y),
        }
    }

    fn intersection(self, other: Self) -> Self {
        Self {
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            right: self.right.min(other.right),
            bottom: self.bottom.min(other.bottom),
        }
    }

    fn is_empty(self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }
}

/// Which pieces touch which tile, in the order of the pieces.
pub(crate) struct Bins {
    columns: u32,
    picture: Rectangle,
    starts: Vec<usize>,
    pieces: Vec<u32>,
}

impl Bins {
    pub(crate) fn new(projected: &Projected, width: u32, height: u32) -> Self {
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let picture = Rectangle {
            left: 0,
            top: 0,
            right: width as i32,
            bottom: height as i32,
        };
        let touched = |piece: &Piece| tiles_touched(projected.triangle(piece), picture, columns);
        let mut starts = vec![0; columns as usize * rows as usize + 1];
        for tile in projected.pieces.iter().flat_map(touched) {
            starts[tile + 1] += 1;
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut pieces = vec![0; starts[starts.len() - 1]];
        let mut next = starts.clone();
        for (index, piece) in projected.pieces.iter().enumerate() {
            for tile in touched(piece) {
                pieces[next[tile]] = index as u32;
                next[tile] += 1;
            }
        }
        Self {
            columns,
            picture,
            starts,
            pieces,
        }
    }

    /// Number of tiles.
    pub(crate) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The pieces that touch a tile.
    pub(crate) fn pieces(&self, tile: usize) -> &[u32] {
        &self.pieces[self.starts[tile]..self.starts[tile + 1]]
    }

    /// The pixels of a tile.
    pub(crate) fn rectangle(&self, tile: usize) -> Rectangle {
        let (column, row) = (tile as u32 % self.columns, tile as u32 / self.columns);
        let (left, top) = ((column * TILE) as i32, (row * TILE) as i32);
        let whole = Rectangle {
            left,
            top,
            right: left + TILE as i32,
            bottom: top + TILE as i32,
        };
        whole.intersection(self.picture)
    }
}

/// Indices of the tiles that a triangle's bounding rectangle touches.
fn tiles_touched(
    corners: [Corner; 3],
    picture: Rectangle,
    columns: u32,
) -> impl Iterator<Item = usize> {
    let seen = Rectangle::around(corners).intersection(picture);
    let tile = |pixel: i32| pixel.max(0) as usize / TILE as usize;
    let (rows, across) = if seen.is_empty() {
        (0..0, 0..0)
    } else {
        (
            tile(seen.top)..tile(seen.bottom - 1) + 1,
            tile(seen.left)..tile(seen.right - 1) + 1,
        )
    };
    rows.flat_map(move |row| {
        across
            .clone()
            .map(move |column| row * columns as usize + column)
    })
}

/// What is seen at each sample of a tile: the depth and the triangle of the nearest surface.
pub(crate) struct Tile<const S: usize> {
    pub(crate) depth: Vec<[f32; S]>,
    pub(crate) face: Vec<[u32; S]>,
}

impl<const S: usize> Tile<S> {
    pub(crate) fn new() -> Self {
        let pixels = (TILE * TILE) as usize;
        Self {
            depth: vec![[-1.0; S]; pixels],
            face: vec![[NOTHING; S]; pixels],
        }
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        self.depth.fill([-1.0; S]);
        self.face.fill([NOTHING; S]);
    }

    /// Index of a pixel of the picture within the tile whose pixels are `tile`.
    #[inline]
    pub(crate) fn index(tile: Rectangle, x: i32, y: i32) -> usize {
        ((y - tile.top) * TILE as i32 + (x - tile.left)) as usize
    }

    /// Lets `face` with these corners cover what is farther away in the tile. Of two surfaces at the same depth
    /// the earlier one stays.
    pub(crate) fn cover(
        &mut self,
        places: &[[i32; 2]; S],
        tile: Rectangle,
        corners: [Corner; 3],
        face: u32,
    ) {
        let Some(setup) = Setup::new(corners) else {
            return;
        };
        let bounds = Rectangle::around(corners);
        let seen = bounds.intersection(tile);
        // Within two tiles' extent the edge functions stay under 2³⁰, and 32 bits are twice as fast.
        let span = (bounds.right - bounds.left).max(bounds.bottom - bounds.top);
        if span <= 2 * TILE as i32 {
            self.fill::<i32>(&setup, places, tile, seen, face);
        } else {
            self.fill::<i64>(&setup, places, tile, seen, face);
        }
    }

    fn fill<T: Whole>(
        &mut self,
        setup: &Setup,
        places: &[[i32; 2]; S],
        tile: Rectangle,
        seen: Rectangle,
        face: u32,
    ) {
        let offsets = [0, 1, 2].map(|e| places.map(|[x, y]| T::narrow(setup.edge_offset(e, x, y))));
        let low = offsets.map(|edge| edge.into_iter().fold(T::MAX, T::min));
        let high = offsets.map(|edge| edge.into_iter().fold(T::MIN, T::max));
        let rises = places.map(|[x, y]| setup.depth_rise(x, y) as f32);
        let zero = T::narrow(0);
        for y in seen.top..seen.bottom {
            for x in seen.left..seen.right {
                let base = [0, 1, 2].map(|e| T::narrow(setup.edge(e, x * STEPS, y * STEPS)));
                if (0..3).any(|e| base[e] + high[e] < zero) {
                    continue;
                }
                let start = setup.depth(x * STEPS, y * STEPS) as f32;
                let pixel = Self::index(tile, x, y);
                let (depths, faces) = (&mut self.depth[pixel], &mut self.face[pixel]);
                let whole = (0..3).all(|e| base[e] + low[e] >= zero);
                for s in 0..S {
                    let depth =
                        (start + rises[s]).clamp(setup.depth_range[0], setup.depth_range[1]);
                    let inside = whole
                        || (base[0] + offsets[0][s])
                            | (base[1] + offsets[1][s])
                            | (base[2] + offsets[2][s])
                            >= zero;
                    let nearer = inside & (depth > depths[s]);
                    depths[s] = if nearer { depth } else { depths[s] };
                    faces[s] = if nearer { face } else { faces[s] };
                }
            }
        }
    }
}

/// The integers that edge functions are computed in.
trait Whole: Copy + Ord + Add<Output = Self> + BitOr<Output = Self> {
    const MIN: Self;
    const MAX: Self;
    fn narrow(value: i64) -> Self;
}

impl Whole for i32 {
    const MIN: Self = i32::MIN;
    const MAX: Self = i32::MAX;
    #[inline]
    fn narrow(value: i64) -> Self {
        value as i32
    }
}

impl Whole for i64 {
    const MIN: Self = i64::MIN;
    const MAX: Self = i64::MAX;
    #[inline]
    fn narrow(value: i64) -> Self {
        value
    }
}

/// A triangle's edge functions, not negative exactly at the samples it covers, and its depth.
struct Setup {
    /// Edge e starts at corner e and has this direction.
    corners: [[i64; 2]; 3],
    directions: [[i64; 2]; 3],
    /// −1 for edges whose own samples belong to the neighbour.
    bias: [i64; 3],
    depth_at_first: f64,
    depth_slope: [f64; 2],
    depth_range: [f32; 2],
}

impl Setup {
    /// `None` for triangles without area on the grid.
    fn new(corners: [Corner; 3]) -> Option<Self> {
        let point = |c: Corner| [i64::from(c.x), i64::from(c.y)];
        let [a, b, c] = corners;
        let cross = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        // Both sides of a surface are visible: turn the corners so that the inside is positive.
        let [a, b, c] = match cross(point(a), point(b), point(c)).signum() {
            1 => [a, b, c],
            -1 => [a, c, b],
            _ => return None,
        };
        let area = cross(point(a), point(b), point(c)) as f64;
        let corners = [a, b, c].map(point);
        let directions = [0, 1, 2].map(|e: usize| {
            let (from, to) = (corners[e], corners[(e + 1) % 3]);
            [to[0] - from[0], to[1] - from[1]]
        });
        // With y downwards, the inside is below a top edge (running right) and right of a left edge (running up).
        let bias = directions.map(|[x, y]| if y < 0 || (y == 0 && x > 0) { 0 } else { -1 });
        let depths = [a, b, c].map(|corner| corner.depth);
        let (rise_b, rise_c) = (depths[1] - depths[0], depths[2] - depths[0]);
        let ([bx, by], [cx, cy]) = (directions[0], directions[2].map(|d| -d));
        let slope = [
            (rise_b * cy as f64 - rise_c * by as f64) / area,
            (rise_c * bx as f64 - rise_b * cx as f64) / area,
        ];
        let range = [
            depths[0].min(depths[1]).min(depths[2]) as f32,
            depths[0].max(depths[1]).max(depths[2]) as f32,
        ];
        let depth_at_first = depths[0];
        Some(Self {
            corners,
            directions,
            bias,
            depth_at_first,
            depth_slope: slope,
            depth_range: range,
        })
    }

    /// Edge function `e` at a point of the grid.
    #[inline]
    fn edge(&self, e: usize, x: i32, y: i32) -> i64 {
        let ([dx, dy], [x0, y0]) = (self.directions[e], self.corners[e]);
        dx * (i64::from(y) - y0) - dy * (i64::from(x) - x0) + self.bias[e]
    }

    /// How much edge function `e` grows over this distance.
    #[inline]
    fn edge_offset(&self, e: usize, x: i32, y: i32) -> i64 {
        let [dx, dy] = self.directions[e];
        dx * i64::from(y) - dy * i64::from(x)
    }

    /// The plane's depth at a point of the grid.
    #[inline]
    fn depth(&self, x: i32, y: i32) -> f64 {
        let [x0, y0] = self.corners[0];
        self.depth_at_first + self.depth_rise(x - x0 as i32, y - y0 as i32)
    }

    #[inline]
    fn depth_rise(&self, x: i32, y: i32) -> f64 {
        self.depth_slope[0] * f64::from(x) + self.depth_slope[1] * f64::from(y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn corner(x: i32, y: i32) -> Corner {
        Corner { x, y, depth: 0.5 }
    }

    /// How often each sample of the tile's pixels is covered when every triangle starts afresh.
    fn counts(triangles: &[[Corner; 3]]) -> Vec<u32> {
        let places: [[i32; 2]; 16] = sample_places(4).try_into().unwrap();
        let area = Rectangle {
            left: 0,
            top: 0,
            right: TILE as i32,
            bottom: TILE as i32,
        };
        let mut counts = vec![0; (TILE * TILE * 16) as usize];
        for &triangle in triangles {
            let mut tile = Tile::<16>::new();
            tile.cover(&places, area, triangle, 7);
            for (count, face) in counts.iter_mut().zip(tile.face.iter().flatten()) {
                *count += u32::from(*face != NOTHING);
            }
        }
        counts
    }

    #[test]
    fn samples_have_a_row_and_a_column_each() {
        for side in [1, 2, 4, 8] {
            let places = sample_places(side);
            for axis in 0..2 {
                let mut seen: Vec<i32> = places.iter().map(|p| p[axis]).collect();
                seen.sort_unstable();
                let step = STEPS / (side * side) as i32;
                let expected: Vec<i32> = (0..(side * side) as i32)
                    .map(|i| i * step + step / 2)
                    .collect();
                assert_eq!(seen, expected);
            }
        }
    }

    #[test]
    fn shared_edges_through_samples_are_covered_once() {
        // Samples lie at odd multiples of 8 steps: this fan's edges pass exactly through many of them.
        let centre = corner(16 * 256 + 8, 16 * 256 + 8);
        let rim = [
            (8, 8),
            (4104, 8),
            (8200, 8),
            (8200, 4104),
            (8200, 8200),
            (4104, 8200),
            (8, 8200),
            (8, 4104),
        ];
        let fan: Vec<[Corner; 3]> = (0..8)
            .map(|i| {
                let ((ax, ay), (bx, by)) = (rim[i], rim[(i + 1) % 8]);
                [centre, corner(ax, ay), corner(bx, by)]
            })
            .collect();
        let counts = counts(&fan);
        assert!(counts.iter().all(|&count| count <= 1));
        // The square holds its upper and left border but not the lower and right ones: 512 × 512 sample columns
        // and rows, of which the sheared grid fills one in sixteen.
        let covered: u32 = counts.iter().sum();
        let inside = |place: i32, pixel: i32| (8..8200).contains(&(pixel * STEPS + place));
        let mut expected = 0;
        for y in 0..TILE as i32 {
            for x in 0..TILE as i32 {
                let places = sample_places(4);
                expected += places
                    .iter()
                    .filter(|p| inside(p[0], x) && inside(p[1], y))
                    .count() as u32;
            }
        }
        assert_eq!(covered, expected);
    }

    proptest! {
        /// A quadrilateral cut along either diagonal covers the same samples, each once, and a sample is covered
        /// exactly where it lies inside by the definition of a triangle.
        #[test]
        fn triangles_that_share_an_edge_neither_overlap_nor_leave_a_gap(
            offsets in prop::array::uniform4((0i32..10_000, 0i32..10_000))
        ) {
            // One corner in each quadrant around the tile's middle, in the order in which they enclose it.
            let quadrants = [(-1, -1), (1, -1), (1, 1), (-1, 1)];
            let place = |i: usize| {
                corner(4096 + quadrants[i].0 * offsets[i].0, 4096 + quadrants[i].1 * offsets[i].1)
            };
            let [a, b, c, d] = [place(0), place(1), place(2), place(3)];
            let cross = |p: Corner, q: Corner, r: Corner| {
                i64::from(q.x - p.x) * i64::from(r.y - p.y) - i64::from(q.y - p.y) * i64::from(r.x - p.x)
            };
            let turns = [cross(a, b, c), cross(b, c, d), cross(c, d, a), cross(d, a, b)];
            prop_assume!(turns.iter().all(|&t| t > 0));
            let first = counts(&[[a, b, c], [a, c, d]]);
            let second = counts(&[[a, b, d], [d, b, c]]);
            prop_assert!(first.iter().all(|&count| count <= 1));
            prop_assert!(first == second);
            let places = sample_places(4);
            for pixel in 0..(TILE * TILE) as usize {
                let (x, y) = ((pixel % TILE as usize) as i32, (pixel / TILE as usize) as i32);
                for (s, place) in places.iter().enumerate() {
                    let p = corner(x * STEPS + place[0], y * STEPS + place[1]);
                    let sides = [cross(a, b, p), cross(b, c, p), cross(c, d, p), cross(d, a, p)];
                    if sides.iter().all(|&side| side != 0) {
                        let inside = sides.iter().all(|&side| side > 0);
                        prop_assert_eq!(first[pixel * 16 + s] == 1, inside);
                    }
                }
            }
        }
    }
}
