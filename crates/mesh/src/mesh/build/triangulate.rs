//! Polygons into triangles.
//!
//! Takes the soup's polygons over welded vertices; gives triangles and the input face of each. A
//! quad is cut along a diagonal that lies inside it, the shorter one if both do. More corners are
//! cut by ears in the polygon's best-fit plane (through Newell's normal), with the diagonals then
//! flipped until they are Delaunay; hundreds of corners get the constrained Delaunay triangulation,
//! which takes n log n. Corners in the middle of a straight side are kept, because the neighbouring
//! face may have them too. A polygon whose projection along its normal crosses itself is twisted in
//! space, or worse: it gets the triangulation of least area.

use earcut::{Earcut, Refiner};

use super::super::collinear::are_on_one_line;
use super::super::topology::MAX_FACES;
use super::super::{Diagnosis, MeshError, PolygonSoup};
use crate::geometry::planar;
use crate::vector::{DVec3, unit_or_zero, vector};

/// Up to this many corners polygons are cut by ears, in time that grows with the cube of their number where they cross themselves.
/// Measured: five microseconds a corner at most.
const MOST_EARS: usize = 512;

/// The area that is covered may differ from the polygon's by this part.
const SAME_AREA: f64 = 1e-9;

/// Up to this many corners a twisted polygon gets its triangulation of least area, in time that grows with the
/// cube of their number.
const MOST_LEAST_AREA: usize = 64;

/// Triangles, and which input face each is from.
#[derive(Default)]
pub(super) struct Faces {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) inputs: Vec<u32>,
}

impl Faces {
    /// # Errors
    /// There would be more triangles than can be indexed.
    pub(super) fn with_capacity(count: usize) -> Result<Self, MeshError> {
        if count > MAX_FACES {
            return Err(MeshError::TooMany {
                what: "faces",
                count,
                limit: MAX_FACES,
            });
        }
        Ok(Self {
            triangles: limitmesh_pages::with_capacity(count),
            inputs: limitmesh_pages::with_capacity(count),
        })
    }

    pub(super) fn push(&mut self, triangle: [u32; 3], input: u32) {
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            self.triangles.push(triangle);
            self.inputs.push(input);
        }
    }

    /// Removes the faces that are marked.
    pub(super) fn drop_marked(&mut self, marked: &[bool]) {
        let mut left = marked.iter();
        self.triangles.retain(|_| left.next() != Some(&true));
        let mut left = marked.iter();
        self.inputs.retain(|_| left.next() != Some(&true));
    }
}

/// Cuts all polygons into triangles; `kept[v]` represents vertex `v`.
///
/// # Errors
/// There would be more triangles than can be indexed.
pub(super) fn triangulate(
    soup: &PolygonSoup,
    kept: &[u32],
    diagnosis: &mut Diagnosis,
) -> Result<Faces, MeshError> {
    let sizes = soup.faces.iter().map(|face| face.len().saturating_sub(2));
    let mut faces = Faces::with_capacity(sizes.sum())?;
    let mut cutter = Cutter::default();
    let mut polygon = Vec::new();
    for (input, face) in soup.faces.iter().enumerate() {
        let input = input as u32;
        if face.len() > 3 {
            diagnosis.polygons.add(input);
        }
        clean(face.iter().map(|&v| kept[v as usize]), &mut polygon);
        if polygon.len() < 3 {
            diagnosis.collapsed_faces.add(input);
            continue;
        }
        if !cutter.cut(&soup.positions, &polygon, |triangle| {
            faces.push(triangle, input)
        }) {
            diagnosis.twisted_polygons.add(input);
        }
    }
    Ok(faces)
}

/// The corners without those that repeat the one before, and without spikes (there and straight back).
pub(super) fn clean(corners: impl Iterator<Item = u32>, polygon: &mut Vec<u32>) {
    polygon.clear();
    for v in corners {
        let n = polygon.len();
        if n >= 1 && polygon[n - 1] == v {
            continue;
        }
        if n >= 2 && polygon[n - 2] == v {
            polygon.pop();
            continue;
        }
        polygon.push(v);
    }
    // Across the seam between the last corner and the first as well.
    let mut start = 0;
    while polygon.len() - start >= 2 {
        let (first, last) = (polygon[start], polygon[polygon.len() - 1]);
        if first == last || polygon[polygon.len() - 2] == first {
            polygon.pop();
        } else if polygon[start + 1] == last {
            start += 1;
        } else {
            break;
        }
    }
    polygon.drain(..start);
}

/// Cuts single polygons; keeps its buffers between them.
#[derive(Default)]
pub(super) struct Cutter {
    earcut: Earcut<f64>,
    refiner: Refiner,
    plane: Vec<[f64; 2]>,
    indices: Vec<u32>,
    edges: Vec<u64>,
}

impl Cutter {
    /// Emits the polygon's triangles; false if it crosses itself in its best-fit plane.
    pub(super) fn cut(
        &mut self,
        positions: &[[f64; 3]],
        polygon: &[u32],
        mut emit: impl FnMut([u32; 3]),
    ) -> bool {
        match *polygon {
            [a, b, c] => {
                emit([a, b, c]);
                true
            }
            [a, b, c, d] => {
                let (triangles, proper) = cut_quad(positions, [a, b, c, d]);
                triangles.into_iter().for_each(emit);
                proper
            }
            _ => {
                let proper = self.cut_polygon(positions, polygon);
                for triangle in self.indices.chunks_exact(3) {
                    emit([0, 1, 2].map(|i| polygon[triangle[i] as usize]));
                }
                proper
            }
        }
    }

    /// Leaves triangles over the polygon's corners in `indices`.
    fn cut_polygon(&mut self, positions: &[[f64; 3]], polygon: &[u32]) -> bool {
        let corners = polygon.len() as u32;
        if self.flatten(positions, polygon).is_none() {
            self.cut_fan(corners);
            return (1..polygon.len() - 1)
                .all(|i| is_flat(positions, [polygon[0], polygon[i], polygon[i + 1]]));
        }
        if polygon.len() > MOST_EARS {
            let proper = self.cut_delaunay(polygon).is_some();
            if !proper {
                self.cut_fan(corners);
            }
            return proper;
        }
        self.earcut
            .earcut_slice(&self.plane, &[], &mut self.indices);
        self.orient();
        if self.indices.len() / 3 < polygon.len() - 2 {
            self.restore_straight_corners(corners);
        }
        if self.is_proper(corners) {
            self.refiner.refine(&mut self.indices, &self.plane);
            return true;
        }
        if polygon.len() <= MOST_LEAST_AREA {
            self.cut_least_area(positions, polygon);
        } else {
            self.cut_fan(corners);
        }
        false
    }

    /// The constrained Delaunay triangulation of the polygon's inside; nothing where it crosses
    /// itself, goes round anything twice, or has a corner inside of a side. It may visit a vertex
    /// or an edge twice, as at slits to holes.
    fn cut_delaunay(&mut self, polygon: &[u32]) -> Option<()> {
        // By vertex, the first corner there; by corner, the number of its vertex.
        let mut firsts: Vec<(u32, u32)> = polygon.iter().copied().zip(0..).collect();
        firsts.sort_unstable();
        firsts.dedup_by_key(|&mut (vertex, _)| vertex);
        let number = |vertex: &u32| firsts.partition_point(|(own, _)| own < vertex) as u32;
        let numbers: Vec<u32> = polygon.iter().map(number).collect();
        let points: Vec<[f64; 2]> = firsts
            .iter()
            .map(|&(_, corner)| self.plane[corner as usize])
            .collect();
        let next = numbers.iter().cycle().skip(1);
        let rim: Vec<[u32; 2]> = numbers
            .iter()
            .zip(next)
            .map(|(&from, &to)| [from, to])
            .collect();
        let triangles = planar::triangulated(&points, &rim, &|| false)?;
        self.indices.clear();
        self.indices.extend(
            triangles
                .as_flattened()
                .iter()
                .map(|&point| firsts[point as usize].1),
        );
        let covered: f64 = self.indices.chunks_exact(3).map(|t| self.area(t)).sum();
        let whole: f64 = (1..polygon.len() as u32 - 1)
            .map(|i| self.area(&[0, i, i + 1]))
            .sum();
        // By Euler's formula, whatever its holes.
        let is_whole =
            triangles.len() == polygon.len() - 2 && (covered - whole).abs() <= SAME_AREA * covered;
        is_whole.then_some(())
    }

    /// The triangulation of least area, by dynamic programming over the pairs of corners (G. T. Klincsek,
    /// "Minimal triangulations of polygonal domains", 1980): it bridges a twisted polygon without folds.
    fn cut_least_area(&mut self, positions: &[[f64; 3]], polygon: &[u32]) {
        let n = polygon.len();
        let (origin, scale) = local_frame(positions, polygon);
        let p: Vec<DVec3> = polygon
            .iter()
            .map(|&v| (vector(positions[v as usize]) - origin) * scale)
            .collect();
        // Row i, column k: least area of the corners from i to k, and the apex on the side from i to k.
        let mut least = vec![(0.0, 0); n * n];
        for length in 2..n {
            for i in 0..n - length {
                let k = i + length;
                let mut best = (f64::INFINITY, i + 1);
                for j in i + 1..k {
                    let own = (p[j] - p[i]).cross(p[k] - p[i]).length();
                    let area = least[i * n + j].0 + least[j * n + k].0 + own;
                    if area < best.0 {
                        best = (area, j);
                    }
                }
                least[i * n + k] = best;
            }
        }
        self.indices.clear();
        let mut left = vec![(0, n - 1)];
        while let Some((i, k)) = left.pop() {
            if k - i >= 2 {
                let j = least[i * n + k].1;
                self.indices.extend([i as u32, j as u32, k as u32]);
                left.extend([(i, j), (j, k)]);
            }
        }
    }

    fn cut_fan(&mut self, corners: u32) {
        self.indices.clear();
        self.indices
            .extend((1..corners - 1).flat_map(|i| [0, i, i + 1]));
    }

    /// Projects the polygon along its Newell normal, scaled to unit size; `None` where it has no normal.
    fn flatten(&mut self, positions: &[[f64; 3]], polygon: &[u32]) -> Option<()> {
        let (origin, scale) = local_frame(positions, polygon);
        let local = |v: u32| (vector(positions[v as usize]) - origin) * scale;
        let normal = unit_or_zero(newell(polygon.iter().map(|&v| local(v))));
        if normal == DVec3::ZERO {
            return None;
        }
        let (u, v) = normal.any_orthonormal_pair();
        // Counter-clockwise seen from where the normal points.
        let v = if u.cross(v).dot(normal) < 0.0 { -v } else { v };
        self.plane.clear();
        self.plane.extend(polygon.iter().map(|&w| {
            let p = local(w);
            [p.dot(u), p.dot(v)]
        }));
        Some(())
    }

    /// Turns all triangles counter-clockwise if they are clockwise.
    fn orient(&mut self) {
        let area: f64 = self.indices.chunks_exact(3).map(|t| self.area(t)).sum();
        if area < 0.0 {
            self.indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
        }
    }

    fn area(&self, triangle: &[u32]) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|i| self.plane[triangle[i] as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    /// Cuts triangles with a side along which corners were left out, so that these are used.
    fn restore_straight_corners(&mut self, corners: u32) {
        let mut used = vec![false; corners as usize];
        self.indices.iter().for_each(|&i| used[i as usize] = true);
        let mut next_used = vec![0; corners as usize];
        let mut next = used.iter().position(|&is_used| is_used).unwrap_or(0) as u32;
        for i in (0..corners).rev() {
            next_used[i as usize] = next;
            if used[i as usize] {
                next = i;
            }
        }
        let mut left: Vec<[u32; 3]> = self
            .indices
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .collect();
        self.indices.clear();
        while let Some(triangle) = left.pop() {
            let lacking = (0..3).find_map(|i| {
                let [a, b, apex] = [triangle[i], triangle[(i + 1) % 3], triangle[(i + 2) % 3]];
                let skipped = (a + 1) % corners;
                (skipped != b && next_used[a as usize] == b).then_some([a, skipped, b, apex])
            });
            match lacking {
                Some([a, skipped, b, apex]) => {
                    left.extend([[a, skipped, apex], [skipped, b, apex]])
                }
                None => self.indices.extend(triangle),
            }
        }
    }

    /// Whether the triangles are a disc bounded by the polygon, none of them turned over.
    fn is_proper(&mut self, corners: u32) -> bool {
        if self.indices.len() != 3 * (corners as usize - 2) {
            return false;
        }
        let mut areas = [0.0, 0.0];
        self.edges.clear();
        for t in self.indices.chunks_exact(3) {
            let area = self.area(t);
            areas[0] += area;
            areas[1] += area.abs();
            for [from, to] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
                self.edges.push(u64::from(from) << 32 | u64::from(to));
            }
        }
        self.edges.sort_unstable();
        let has = |edges: &[u64], from: u32, to: u32| {
            edges
                .binary_search(&(u64::from(from) << 32 | u64::from(to)))
                .is_ok()
        };
        let unique = self.edges.windows(2).all(|pair| pair[0] != pair[1]);
        let mut sides = 0;
        let closed = self.edges.iter().all(|&edge| {
            let (from, to) = ((edge >> 32) as u32, edge as u32);
            let is_side = (from + 1) % corners == to;
            sides += u32::from(is_side);
            is_side != has(&self.edges, to, from)
        });
        // Triangles over straight corners may come out turned over by a rounding error.
        unique && closed && sides == corners && areas[1] - areas[0] <= 1e-9 * areas[1]
    }
}

/// A corner to measure from and a factor that brings the polygon to about unit size.
fn local_frame(positions: &[[f64; 3]], polygon: &[u32]) -> (DVec3, f64) {
    let origin = vector(positions[polygon[0] as usize]);
    let farthest =
        |far: f64, &v: &u32| far.max((vector(positions[v as usize]) - origin).abs().max_element());
    let size = polygon.iter().fold(0.0, farthest);
    (
        origin,
        if size > 0.0 && (1.0 / size).is_finite() {
            1.0 / size
        } else {
            1.0
        },
    )
}

/// Twice the vector area of a closed polygon: Newell's normal.
fn newell(mut corners: impl Iterator<Item = DVec3>) -> DVec3 {
    let Some(first) = corners.next() else {
        return DVec3::ZERO;
    };
    let (mut before, mut sum) = (DVec3::ZERO, DVec3::ZERO);
    for corner in corners {
        let spoke = corner - first;
        sum += before.cross(spoke);
        before = spoke;
    }
    sum
}

/// Two triangles, and whether both face the way the quad does.
fn cut_quad(positions: &[[f64; 3]], quad: [u32; 4]) -> ([[u32; 3]; 2], bool) {
    let (origin, scale) = local_frame(positions, &quad);
    let p = quad.map(|v| (vector(positions[v as usize]) - origin) * scale);
    let normal = newell(p.into_iter());
    let upright = |i: usize, j: usize, k: usize| (p[j] - p[i]).cross(p[k] - p[i]).dot(normal) > 0.0;
    let valid = [
        upright(0, 1, 2) && upright(0, 2, 3),
        upright(0, 1, 3) && upright(1, 2, 3),
    ];
    let [a, b, c, d] = quad;
    let lengths = [p[0].distance_squared(p[2]), p[1].distance_squared(p[3])];
    let area = |i: usize, j: usize, k: usize| (p[j] - p[i]).cross(p[k] - p[i]).length();
    let areas = [area(0, 1, 2) + area(0, 2, 3), area(0, 1, 3) + area(1, 2, 3)];
    let first = match valid {
        [true, false] => true,
        [false, true] => false,
        [false, false] if areas[0] != areas[1] => areas[0] < areas[1],
        _ if lengths[0] == lengths[1] => a.min(c) < b.min(d),
        _ => lengths[0] < lengths[1],
    };
    let triangles = if first {
        [[a, b, c], [a, c, d]]
    } else {
        [[a, b, d], [b, c, d]]
    };
    let proper = valid != [false, false] || triangles.iter().all(|&t| is_flat(positions, t));
    (triangles, proper)
}

/// Whether a triangle's corners lie on one line.
pub(super) fn is_flat(positions: &[[f64; 3]], triangle: [u32; 3]) -> bool {
    are_on_one_line(triangle.map(|v| positions[v as usize]))
}

/// The triangles without area under any movement of their vertices.
#[derive(Clone, Copy)]
pub(super) struct Flatness<'a> {
    pub(super) positions: &'a [[f64; 3]],
    /// Input faces that have one somewhere, in ascending order.
    pub(super) opening: &'a [u32],
}

impl Flatness<'_> {
    /// Whether one of the faces has none.
    pub(super) fn is_flat(&self, faces: &Faces, face: u32) -> bool {
        is_flat(self.positions, faces.triangles[face as usize])
            && self
                .opening
                .binary_search(&faces.inputs[face as usize])
                .is_err()
    }
}
