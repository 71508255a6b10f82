//! The constrained Delaunay triangulation of the inside of a rim in the plane.

use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use crate::parallel::{IsStopped, asking, sort_asking};

/// Points and edges that are taken between two questions whether that is still of use.
const ASKED: usize = 256;

/// Halvings of a square in each direction along the curve through it.
const ORDER: u32 = 16;

/// Triangles that cover the region to the left of the directed rim edges, with all points for
/// vertices. `None` where two points are at one place or rim edges cross or touch, and when
/// stopped. Points are at most some units from the origin. Coordinates too close to 0 to be
/// distinguished are 0.
pub fn triangulated(
    points: &[[f64; 2]],
    rim: &[[u32; 2]],
    is_stopped: &IsStopped<'_>,
) -> Option<Vec<[u32; 3]>> {
    let mut net = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let order = along_curve(points, is_stopped);
    if is_stopped() {
        return None;
    }
    let mut handles = vec![FixedVertexHandle::from_index(0); points.len()];
    for (at, &point) in order.iter().enumerate() {
        let is_told = |x: &f64| x.abs() >= spade::MIN_ALLOWED_VALUE;
        let [x, y] = points[point as usize].map(|x| if is_told(&x) { x } else { 0.0 });
        let handle = net.insert(Point2::new(x, y)).ok()?;
        if handle.index() != at || at.is_multiple_of(ASKED) && is_stopped() {
            return None;
        }
        handles[point as usize] = handle;
    }
    for (at, &[from, to]) in rim.iter().enumerate() {
        let (from, to) = (handles[from as usize], handles[to as usize]);
        if !net.can_add_constraint(from, to) || at.is_multiple_of(ASKED) && is_stopped() {
            return None;
        }
        net.add_constraint(from, to);
    }
    let mut is_inside = vec![false; net.num_all_faces()];
    let mut pending = Vec::new();
    for &[from, to] in rim {
        // A rim edge with a point on it has become two.
        let edge = net.get_edge_from_neighbors(handles[from as usize], handles[to as usize])?;
        pending.push(edge.face());
    }
    let mut passed = 0usize;
    while let Some(face) = pending.pop() {
        passed += 1;
        if passed.is_multiple_of(ASKED) && is_stopped() {
            return None;
        }
        let inner = face.as_inner()?;
        if core::mem::replace(&mut is_inside[face.fix().index()], true) {
            continue;
        }
        let open = inner
            .adjacent_edges()
            .into_iter()
            .filter(|edge| !edge.is_constraint_edge());
        pending.extend(open.map(|edge| edge.rev().face()));
    }
    let inside = asking(net.inner_faces(), is_stopped).filter(|face| is_inside[face.fix().index()]);
    Some(
        inside
            .map(|face| face.vertices().map(|vertex| order[vertex.fix().index()]))
            .collect(),
    )
}

/// The numbers of points in the order in which Hilbert's curve passes them: each is inserted next
/// to the one before, so that it is found in a few steps however the points were numbered.
fn along_curve(points: &[[f64; 2]], is_stopped: &IsStopped<'_>) -> Vec<u32> {
    let corner = [0, 1].map(|axis| {
        points
            .iter()
            .fold(f64::INFINITY, |low, point| low.min(point[axis]))
    });
    let size = points
        .iter()
        .flat_map(|point| [point[0] - corner[0], point[1] - corner[1]])
        .fold(0.0, f64::max);
    let scale = f64::from((1u32 << ORDER) - 1) / size;
    // Where all are at one place there is no order among them.
    let cell = |x: f64| {
        if scale.is_finite() {
            (x * scale) as u32
        } else {
            0
        }
    };
    let place = |[x, y]: [f64; 2]| along_hilbert_curve([cell(x - corner[0]), cell(y - corner[1])]);
    let numbered = asking((0..).zip(points), is_stopped);
    let mut order: Vec<(u32, u32)> = numbered
        .map(|(number, &point)| (place(point), number))
        .collect();
    sort_asking(&mut order, is_stopped);
    order.into_iter().map(|(_, number)| number).collect()
}

/// Where Hilbert's curve (D. Hilbert, *Ueber die stetige Abbildung einer Linie auf ein Flächenstück*, 1891) passes a cell of a square of 2 to the power of
/// [`ORDER`] by as many: quarter by quarter, the curve in each turned so that it goes on where the one before ended.
fn along_hilbert_curve([mut x, mut y]: [u32; 2]) -> u32 {
    let mut passed = 0;
    for level in (0..ORDER).rev() {
        let (right, upper) = (x >> level & 1, y >> level & 1);
        passed = passed << 2 | ((3 * right) ^ upper);
        if upper == 0 {
            if right == 1 {
                (x, y) = (!x, !y);
            }
            core::mem::swap(&mut x, &mut y);
        }
    }
    passed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The edges of polygons with these numbers of points, one after the other.
    fn rim(polygons: &[u32]) -> Vec<[u32; 2]> {
        let mut first = 0;
        let polygons = polygons.iter().flat_map(|&count| {
            first += count;
            (0..count).map(move |at| [first - count + at, first - count + (at + 1) % count])
        });
        polygons.collect()
    }

    fn area(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> f64 {
        let area = |triangle: &[u32; 3]| {
            let [[a, b], [c, d], [e, f]] = triangle.map(|point| points[point as usize]);
            let area = 0.5 * ((c - a) * (f - b) - (d - b) * (e - a));
            assert!(area > 0.0);
            area
        };
        triangles.iter().map(area).sum()
    }

    /// A square with a square hole and a point inside: the rest is covered, and all points are
    /// used.
    #[test]
    fn what_is_enclosed_is_covered() {
        let square = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]];
        let mut hole = square(0.25);
        hole.reverse();
        let points = [&square(1.0)[..], &hole, &[[0.6, 0.1]]].concat();
        let triangles = triangulated(&points, &rim(&[4, 4]), &|| false).unwrap();
        assert!((area(&points, &triangles) - 3.75).abs() < 1e-12);
        // Euler: 2 (8 + 1) − 8 − 2 · 0.
        assert_eq!(triangles.len(), 10);
        assert!((0..9).all(|point| triangles.as_flattened().contains(&point)));
    }

    /// Cells one after the other on the curve are neighbours, and all are passed.
    #[test]
    fn the_curve_goes_from_cell_to_cell() {
        const SIDE: u32 = 64;
        let cells = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| [x, y]));
        let mut passed: Vec<(u32, [u32; 2])> = cells
            .map(|cell| (along_hilbert_curve(cell), cell))
            .collect();
        passed.sort_unstable();
        for (at, pair) in passed.windows(2).enumerate() {
            let [(before, [a, b]), (after, [c, d])] = [pair[0], pair[1]];
            assert!(before as usize == at && after as usize == at + 1);
            assert_eq!(a.abs_diff(c) + b.abs_diff(d), 1, "{pair:?}");
        }
    }

    #[test]
    fn rims_that_cross_or_touch_are_refused() {
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(triangulated(&bow, &rim(&[4]), &|| false), None);
        let double = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(triangulated(&double, &rim(&[5]), &|| false), None);
        let touching = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.0], [0.0, 1.0]];
        assert_eq!(triangulated(&touching, &rim(&[5]), &|| false), None);
        let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
        assert_eq!(triangulated(&clockwise, &rim(&[3]), &|| false), None);
        let square = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(triangulated(&square, &rim(&[3]), &|| true), None);
    }
}
