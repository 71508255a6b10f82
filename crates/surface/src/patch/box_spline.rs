//! Regular pieces: a face and its one-ring where all three corners have six edges, as twelve points.
//!
//! There the limit surface is a quartic box spline, and one refinement takes the twelve points to the eighteen
//! around the four parts. Points stand on the lattice with the face's corners at (0, 0), (1, 0) and (0, 1) and
//! edges along (1, 0), (0, 1) and (1, −1); arrays run through its rows from below, each from the left.

use crate::vector::DVec3;

/// Twelve points: the face's corners and their neighbours.
pub type Points = [DVec3; 12];

/// First and last column of each row of the twelve, from row −1 on.
const ROWS: [(i32, i32); 4] = [(0, 2), (-1, 2), (-1, 1), (-1, 0)];

/// The rows of the eighteen points around the face's four parts, in coordinates of half the step.
const REFINED_ROWS: [(i32, i32); 5] = [(0, 3), (-1, 3), (-1, 2), (-1, 1), (-1, 0)];

/// The six neighbours of a lattice point, counter-clockwise.
const NEIGHBOURS: [(i32, i32); 6] = [(1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)];

/// Where a lattice point stands in an array.
const fn place<const N: usize>(rows: &[(i32, i32); N], x: i32, y: i32) -> u8 {
    let (mut row, mut before) = (0, 0);
    while row < (y + 1) as usize {
        before += rows[row].1 - rows[row].0 + 1;
        row += 1;
    }
    assert!(
        row < N && rows[row].0 <= x && x <= rows[row].1,
        "the point is one of the array"
    );
    (before + x - rows[row].0) as u8
}

/// The face's corners among the twelve.
pub(crate) const CORNERS: [usize; 3] = [
    place(&ROWS, 0, 0) as usize,
    place(&ROWS, 1, 0) as usize,
    place(&ROWS, 0, 1) as usize,
];

/// The neighbours of each corner, counter-clockwise, starting with the next corner.
pub(crate) const RINGS: [[u8; 6]; 3] = {
    let mut rings = [[0; 6]; 3];
    let corners = [(0, 0), (1, 0), (0, 1)];
    let mut corner = 0;
    while corner < 3 {
        // The next corner lies along neighbour 0, 2 and 4.
        let mut slot = 0;
        while slot < 6 {
            let (dx, dy) = NEIGHBOURS[(slot + 2 * corner) % 6];
            rings[corner][slot] = place(&ROWS, corners[corner].0 + dx, corners[corner].1 + dy);
            slot += 1;
        }
        corner += 1;
    }
    rings
};

/// The new points on edges: where they stand among the eighteen, the ends, and the two points opposite.
pub(super) const EDGE_POINTS: [(u8, [u8; 2], [u8; 2]); 15] = {
    let mut list = [(0, [0; 2], [0; 2]); 15];
    let (mut count, mut row) = (0, 0);
    while row < REFINED_ROWS.len() {
        let y = row as i32 - 1;
        let mut x = REFINED_ROWS[row].0;
        while x <= REFINED_ROWS[row].1 {
            let (left, below) = (x.div_euclid(2), y.div_euclid(2));
            let at = place(&REFINED_ROWS, x, y);
            let (ends, opposite) = match (x.rem_euclid(2), y.rem_euclid(2)) {
                (1, 0) => ([(0, 0), (1, 0)], [(0, 1), (1, -1)]),
                (0, 1) => ([(0, 0), (0, 1)], [(1, 0), (-1, 1)]),
                (1, 1) => ([(1, 0), (0, 1)], [(0, 0), (1, 1)]),
                _ => ([(0, 0); 2], [(0, 0); 2]),
            };
            if x.rem_euclid(2) == 1 || y.rem_euclid(2) == 1 {
                list[count] = (
                    at,
                    [
                        place(&ROWS, left + ends[0].0, below + ends[0].1),
                        place(&ROWS, left + ends[1].0, below + ends[1].1),
                    ],
                    [
                        place(&ROWS, left + opposite[0].0, below + opposite[0].1),
                        place(&ROWS, left + opposite[1].0, below + opposite[1].1),
                    ],
                );
                count += 1;
            }
            x += 1;
        }
        row += 1;
    }
    assert!(count == 15);
    list
};

/// The corners among the eighteen.
pub(super) const REFINED_CORNERS: [u8; 3] = [
    place(&REFINED_ROWS, 0, 0),
    place(&REFINED_ROWS, 2, 0),
    place(&REFINED_ROWS, 0, 2),
];

/// The twelve points of each part among the eighteen. Parts 0 to 2 keep the corner of their number, and each of
/// their corners stands towards the face's; corner `i` of part 3, in the middle, is the new point opposite
/// corner `i`.
pub(super) const PARTS: [[u8; 12]; 4] = {
    let mut parts = [[0; 12]; 4];
    let (mut count, mut row) = (0, 0);
    while row < ROWS.len() {
        let y = row as i32 - 1;
        let mut x = ROWS[row].0;
        while x <= ROWS[row].1 {
            parts[0][count] = place(&REFINED_ROWS, x, y);
            parts[1][count] = place(&REFINED_ROWS, x + 1, y);
            parts[2][count] = place(&REFINED_ROWS, x, y + 1);
            parts[3][count] = place(&REFINED_ROWS, 1 - x, 1 - y);
            x += 1;
            count += 1;
        }
        row += 1;
    }
    parts
};

/// The new points on the face's edges among the eighteen, by the corner where the edge starts, and their
/// neighbours counter-clockwise.
pub(super) const MIDDLES: [(u8, [u8; 6]); 3] = {
    let mut middles = [(0, [0; 6]); 3];
    let at = [(1, 0), (1, 1), (0, 1)];
    let mut edge = 0;
    while edge < 3 {
        let (x, y) = at[edge];
        middles[edge].0 = place(&REFINED_ROWS, x, y);
        let mut slot = 0;
        while slot < 6 {
            middles[edge].1[slot] = place(
                &REFINED_ROWS,
                x + NEIGHBOURS[slot].0,
                y + NEIGHBOURS[slot].1,
            );
            slot += 1;
        }
        edge += 1;
    }
    middles
};

/// The eighteen points around the four parts of a regular face.
#[derive(Clone, Copy, Debug)]
pub struct Refined(pub(super) [DVec3; 18]);

impl Refined {
    /// One refinement by the masks of regular vertices (10/16, 1/16) and edges (3/8, 1/8).
    #[inline]
    pub fn of(points: &Points) -> Self {
        let mut refined = [DVec3::ZERO; 18];
        for &(at, [a, b], [c, d]) in &EDGE_POINTS {
            refined[at as usize] = 0.375 * (points[a as usize] + points[b as usize])
                + 0.125 * (points[c as usize] + points[d as usize]);
        }
        for (corner, &at) in REFINED_CORNERS.iter().enumerate() {
            let ring = ring_sum(points, &RINGS[corner]);
            refined[at as usize] = 0.625 * points[CORNERS[corner]] + 0.0625 * ring;
        }
        Self(refined)
    }

    /// The points of a part.
    #[inline]
    pub(crate) fn part(&self, part: usize) -> Points {
        let mut points = [DVec3::ZERO; 12];
        points
            .iter_mut()
            .zip(&PARTS[part])
            .for_each(|(point, &at)| *point = self.0[at as usize]);
        points
    }

    /// The new point on the edge from corner `edge`, and its neighbours counter-clockwise.
    #[inline]
    pub(crate) fn middle(&self, edge: usize) -> (DVec3, [DVec3; 6]) {
        let (at, ring) = &MIDDLES[edge];
        let mut around = [DVec3::ZERO; 6];
        around
            .iter_mut()
            .zip(ring)
            .for_each(|(point, &at)| *point = self.0[at as usize]);
        (self.0[*at as usize], around)
    }
}

#[inline]
fn ring_sum(points: &Points, ring: &[u8; 6]) -> DVec3 {
    let at = |slot: usize| points[ring[slot] as usize];
    ((at(0) + at(3)) + (at(1) + at(4))) + (at(2) + at(5))
}

/// The twelve points from the corners and their rings, each given with the slot of the next corner in it.
#[inline]
pub fn assemble<T: Copy>(corners: [T; 3], rings: [&[T; 6]; 3], turns: [usize; 3]) -> [T; 12] {
    let mut points = [corners[0]; 12];
    for corner in 0..3 {
        for slot in 0..6 {
            points[RINGS[corner][slot] as usize] = rings[corner][(slot + turns[corner]) % 6];
        }
    }
    for corner in 0..3 {
        points[CORNERS[corner]] = corners[corner];
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a plane over the lattice: refinement keeps affine maps, so that every table shows its mistakes.
    fn plane() -> Points {
        let mut points = [DVec3::ZERO; 12];
        let mut count = 0;
        for (row, &(first, last)) in ROWS.iter().enumerate() {
            for x in first..=last {
                points[count] = DVec3::new(f64::from(x), row as f64 - 1.0, 0.0);
                count += 1;
            }
        }
        points
    }

    #[test]
    fn refinement_keeps_the_lattice() {
        let refined = Refined::of(&plane());
        let mut count = 0;
        for (row, &(first, last)) in REFINED_ROWS.iter().enumerate() {
            for x in first..=last {
                let expected = DVec3::new(f64::from(x) / 2.0, (row as f64 - 1.0) / 2.0, 0.0);
                assert_eq!(refined.0[count], expected);
                count += 1;
            }
        }
    }

    #[test]
    fn parts_and_middles_stand_where_they_should() {
        let points = plane();
        let refined = Refined::of(&points);
        let corner = |i: usize| points[CORNERS[i]];
        let middle = |i: usize| (corner(i) + corner((i + 1) % 3)) / 2.0;
        for i in 0..3 {
            let part = refined.part(i);
            assert_eq!(part[CORNERS[i]], corner(i));
            assert_eq!(part[CORNERS[(i + 1) % 3]], middle(i));
            assert_eq!(part[CORNERS[(i + 2) % 3]], middle((i + 2) % 3));
            assert_eq!(refined.part(3)[CORNERS[i]], middle((i + 1) % 3));
            let (at, ring) = refined.middle(i);
            assert_eq!(at, middle(i));
            assert_eq!(ring.iter().sum::<DVec3>() / 6.0, at);
        }
    }

    #[test]
    fn assembling_undoes_taking_rings() {
        let points = plane();
        let rings = RINGS.map(|ring| ring.map(|at| points[at as usize]));
        assert_eq!(
            assemble(CORNERS.map(|at| points[at]), rings.each_ref(), [0; 3]),
            points
        );
        let turned = rings.map(|[a, b, c, d, e, f]| [e, f, a, b, c, d]);
        assert_eq!(
            assemble(CORNERS.map(|at| points[at]), turned.each_ref(), [2; 3]),
            points
        );
        for (corner, ring) in rings.iter().enumerate() {
            assert_eq!(ring[0], points[CORNERS[(corner + 1) % 3]]);
            assert_eq!(ring[1], points[CORNERS[(corner + 2) % 3]]);
        }
    }
}
