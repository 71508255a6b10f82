//! Figure 5 of the paper: the cover of a triangle when 0, 1, 2 or 3 of its edges are split.
//!
//! Corners are numbered 0, 1, 2 and the new vertex on the edge from corner `c` to the next one is `3 + c`. Each
//! pattern also says which of its half-edges are twins inside the triangle and which lie along its border, so
//! that a refined topology follows without any search.

/// The diagonal of the quadrilateral that two split edges leave (the paper does not define it).
///
/// With the unsplit edge running from corner `u` to the next one, the quadrilateral is `u`, `u+1`, the new
/// vertex after `u+1`, the new vertex before `u`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diagonal {
    /// From `u` to the new vertex on the edge after `u+1`.
    FromStart,
    /// From `u+1` to the new vertex on the edge before `u`.
    FromEnd,
}

/// Marks a half-edge of a pattern that lies along the triangle's border.
const BORDER: u8 = u8::MAX;

/// The triangles that cover one face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern {
    count: u8,
    triangles: [[u8; 3]; 4],
    twins: [u8; 12],
    border: [[u8; 2]; 3],
}

impl Pattern {
    /// The covering triangles, counter-clockwise, over corners 0 to 2 and new vertices 3 to 5.
    #[inline]
    pub fn triangles(&self) -> &[[u8; 3]] {
        &self.triangles[..self.count as usize]
    }

    /// The half-edge (3·triangle + corner, within the pattern) that is the twin of half-edge `h`; `None` on the
    /// border.
    #[inline]
    pub fn twin(&self, h: usize) -> Option<usize> {
        let twin = self.twins[h];
        (twin != BORDER).then_some(twin as usize)
    }

    /// The half-edges along the face's half-edge `corner`: the first and the second half, or the
    /// one edge twice where it is not split.
    #[inline]
    pub fn border(&self, corner: usize) -> [usize; 2] {
        self.border[corner].map(usize::from)
    }

    const fn new(triangles: [[u8; 3]; 4], count: u8) -> Self {
        let mut pattern = Self {
            count,
            triangles,
            twins: [BORDER; 12],
            border: [[BORDER; 2]; 3],
        };
        let half_edges = 3 * count as usize;
        let mut h = 0;
        while h < half_edges {
            let (from, to) = pattern.ends(h);
            let mut g = 0;
            while g < half_edges {
                let (other_from, other_to) = pattern.ends(g);
                if other_from == to && other_to == from {
                    pattern.twins[h] = g as u8;
                }
                g += 1;
            }
            let mut c = 0u8;
            while c < 3 {
                let (next, middle) = ((c + 1) % 3, 3 + c);
                if from == c && (to == next || to == middle) {
                    pattern.border[c as usize][0] = h as u8;
                }
                if to == next && (from == c || from == middle) {
                    pattern.border[c as usize][1] = h as u8;
                }
                c += 1;
            }
            h += 1;
        }
        pattern
    }

    const fn ends(&self, h: usize) -> (u8, u8) {
        let triangle = self.triangles[h / 3];
        (triangle[h % 3], triangle[(h + 1) % 3])
    }
}

const UNUSED: [u8; 3] = [0; 3];

/// Case (b): one edge, from corner `c`, is split and joined to the corner opposite.
const fn bisected(c: u8) -> Pattern {
    let (next, opposite, middle) = ((c + 1) % 3, (c + 2) % 3, 3 + c);
    Pattern::new(
        [
            [c, middle, opposite],
            [middle, next, opposite],
            UNUSED,
            UNUSED,
        ],
        2,
    )
}

/// Case (c): all edges but the one from corner `u` are split.
const fn trisected(u: u8, diagonal: Diagonal) -> Pattern {
    let (end, tip) = ((u + 1) % 3, (u + 2) % 3);
    let (after, before) = (3 + end, 3 + tip);
    let cut_off = [after, tip, before];
    match diagonal {
        Diagonal::FromStart => {
            Pattern::new([[u, end, after], [u, after, before], cut_off, UNUSED], 3)
        }
        Diagonal::FromEnd => {
            Pattern::new([[u, end, before], [end, after, before], cut_off, UNUSED], 3)
        }
    }
}

/// Case (a).
const WHOLE: Pattern = Pattern::new([[0, 1, 2], UNUSED, UNUSED, UNUSED], 1);
/// Case (d), and every divisible face.
const QUARTERED: Pattern = Pattern::new([[0, 3, 5], [1, 4, 3], [2, 5, 4], [3, 4, 5]], 4);

const PATTERNS: [[Pattern; 2]; 8] = [
    [WHOLE; 2],
    [bisected(0); 2],
    [bisected(1); 2],
    [
        trisected(2, Diagonal::FromStart),
        trisected(2, Diagonal::FromEnd),
    ],
    [bisected(2); 2],
    [
        trisected(1, Diagonal::FromStart),
        trisected(1, Diagonal::FromEnd),
    ],
    [
        trisected(0, Diagonal::FromStart),
        trisected(0, Diagonal::FromEnd),
    ],
    [QUARTERED; 2],
];

/// The covering of a face whose edge from corner `c` is split where bit `c` of `split` is set. The diagonal
/// matters only for two split edges.
#[inline]
pub fn closure(split: u8, diagonal: Diagonal) -> &'static Pattern {
    &PATTERNS[(split & 7) as usize][diagonal as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> impl Iterator<Item = (u8, Diagonal)> {
        (0..8).flat_map(|split| [(split, Diagonal::FromStart), (split, Diagonal::FromEnd)])
    }

    /// Positions in exact arithmetic: corners of a triangle of area 1/2 and its edge midpoints.
    fn place(label: u8) -> [f64; 2] {
        [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [0.5, 0.5],
            [0.0, 0.5],
        ][label as usize]
    }

    #[test]
    fn triangles_cover_the_face_once() {
        for (split, diagonal) in all() {
            let mut area = 0.0;
            for &t in closure(split, diagonal).triangles() {
                let [a, b, c] = t.map(place);
                let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                assert!(
                    twice > 0.0,
                    "{split} {diagonal:?}: {t:?} is turned over or flat"
                );
                area += twice / 2.0;
            }
            assert_eq!(area, 0.5, "{split} {diagonal:?}");
        }
    }

    #[test]
    fn each_split_edge_adds_one_triangle_and_uses_its_vertex() {
        for (split, diagonal) in all() {
            let pattern = closure(split, diagonal);
            assert_eq!(pattern.triangles().len(), 1 + split.count_ones() as usize);
            for c in 0..3 {
                let used = pattern.triangles().as_flattened().contains(&(3 + c));
                assert_eq!(used, split & (1 << c) != 0, "{split} {diagonal:?}");
            }
        }
    }

    #[test]
    fn half_edges_are_twins_inside_or_on_the_border_in_order() {
        for (split, diagonal) in all() {
            let pattern = closure(split, diagonal);
            let border: Vec<usize> = (0..3).flat_map(|c| pattern.border(c)).collect();
            for h in 0..3 * pattern.triangles().len() {
                match pattern.twin(h) {
                    Some(twin) => {
                        assert_eq!(pattern.twin(twin), Some(h));
                        assert_eq!(pattern.ends(twin), (pattern.ends(h).1, pattern.ends(h).0));
                        assert!(!border.contains(&h));
                    }
                    None => assert!(border.contains(&h), "{split} {diagonal:?}: {h}"),
                }
            }
            for c in 0..3u8 {
                let [first, second] = pattern.border(c as usize);
                assert_eq!(pattern.ends(first).0, c);
                assert_eq!(pattern.ends(second).1, (c + 1) % 3);
                assert_eq!(first == second, split & (1 << c) == 0);
            }
        }
    }
}
