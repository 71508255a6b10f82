//! Paint of slicers on triangles: a tree of divisions, a hexadecimal digit a node, written backwards.
//!
//! The low two bits of a node are how many sides of its triangle are divided, in the middle, 0 to 3; the high two bits of one that is
//! divided are a corner, at which the corners a, b, c begin: one side divided is that across a; two are those at a. Then its
//! children follow, the last first:
//!
//! ```text
//! one side: (a, b, bc) (bc, c, a)      two: (a, ab, ac) (ab, b, ac) (b, c, ac)
//! three: (a, ab, ca) (ab, b, bc) (bc, c, ca) (ab, bc, ca)
//! ```
//!
//! The high bits of a leaf are its paint, 0 for none; 3 for one that the next digit holds. It is what PrusaSlicer and those that
//! come from it write as `paint_color`, `paint_supports`, `slic3rpe:mmu_segmentation` and so on.

/// Local names of attributes that hold such trees.
const NAMES: [&str; 8] = [
    "paint_color",
    "paint_supports",
    "paint_seam",
    "paint_fuzzy_skin",
    "mmu_segmentation",
    "custom_supports",
    "custom_seam",
    "fuzzy_skin",
];

/// Divisions within each other at most: sides have become a billion times shorter by then.
const DEEPEST: usize = 64;

/// A point in barycentric coordinates of the painted triangle.
type Point = [f64; 3];

/// Whether an attribute of a triangle, without its prefix, is painted.
pub(super) fn is_paint(name: &str) -> bool {
    NAMES.contains(&name)
}

/// Whether a code is more than one colour for the whole triangle.
pub(super) fn is_divided(code: &str) -> bool {
    let found = code.bytes().last().and_then(digit);
    found.is_none_or(|node| node & 3 != 0)
}

/// The code of the leaf at a point, empty where there is no paint; none if the tree cannot be read.
pub(super) fn at(code: &str, point: Point) -> Option<String> {
    let mut nodes = Nodes {
        digits: code.as_bytes().iter().rev(),
    };
    let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut found = None;
    nodes.walk(corners, point, 0, true, &mut found)?;
    found
}

struct Nodes<'a> {
    digits: std::iter::Rev<std::slice::Iter<'a, u8>>,
}

impl Nodes<'_> {
    fn next(&mut self) -> Option<u8> {
        self.digits.next().copied().and_then(digit)
    }

    /// Reads a node and all below it, and looks for the leaf with the point if that is inside.
    fn walk(
        &mut self,
        corners: [Point; 3],
        point: Point,
        depth: usize,
        is_inside: bool,
        found: &mut Option<String>,
    ) -> Option<()> {
        let node = self.next()?;
        let high = node >> 2;
        if node & 3 == 0 {
            let second = if high == 3 { Some(self.next()?) } else { None };
            if is_inside {
                *found = Some(match second {
                    Some(second) => format!("{second:X}{node:X}"),
                    None if high == 0 => String::new(),
                    None => format!("{node:X}"),
                });
            }
            return Some(());
        }
        if high == 3 || depth == DEEPEST {
            return None;
        }
        let [a, b, c] = [0, 1, 2].map(|i| corners[(i + high as usize) % 3]);
        let middle = |p: Point, q: Point| [0, 1, 2].map(|i| 0.5 * (p[i] + q[i]));
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        let children: &[[Point; 3]] = match node & 3 {
            1 => &[[a, b, bc], [bc, c, a]],
            2 => &[[a, ab, ca], [ab, b, ca], [b, c, ca]],
            _ => &[[a, ab, ca], [ab, b, bc], [bc, c, ca], [ab, bc, ca]],
        };
        // The one in which the point is farthest inside.
        let depths = children.iter().map(|child| inside(*child, point));
        let own = depths.enumerate().fold((0, f64::NEG_INFINITY), |best, at| {
            if at.1 > best.1 { at } else { best }
        });
        for (number, child) in children.iter().enumerate().rev() {
            self.walk(
                *child,
                point,
                depth + 1,
                is_inside && number == own.0,
                found,
            )?;
        }
        Some(())
    }
}

/// The least barycentric coordinate of a point in a triangle: above 0 inside.
fn inside([a, b, c]: [Point; 3], p: Point) -> f64 {
    let area = |a: Point, b: Point, c: Point| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let whole = area(a, b, c);
    let all = [area(p, b, c), area(a, p, c), area(a, b, p)].into_iter();
    all.map(|part| part / whole).fold(f64::INFINITY, f64::min)
}

fn digit(byte: u8) -> Option<u8> {
    char::from(byte).to_digit(16).map(|value| value as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CENTRE: Point = [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0];

    /// The nodes in the order of the tree, as a file has them.
    fn written(nodes: &[u8]) -> String {
        nodes.iter().rev().map(|node| format!("{node:X}")).collect()
    }

    #[test]
    fn whole_triangles_have_one_leaf() {
        for code in ["4", "8", "0C", "DC"] {
            assert!(!is_divided(code));
            assert_eq!(at(code, CENTRE).as_deref(), Some(code));
        }
        assert_eq!(at("0", CENTRE).as_deref(), Some(""));
    }

    #[test]
    fn leaves_are_where_slicers_divide() {
        // Three sides: the children follow backwards, that in the middle first.
        let code = written(&[3, 4, 8, 0, 0xC, 2]);
        assert!(is_divided(&code));
        let at = |p: Point| super::at(&code, p).expect("a tree");
        assert_eq!(at(CENTRE), "4");
        assert_eq!(at([0.1, 0.1, 0.8]), "8");
        assert_eq!(at([0.1, 0.8, 0.1]), "");
        assert_eq!(at([0.8, 0.1, 0.1]), "2C");
        // One side, across each corner in turn: the child with the next corner is the last in the text.
        for corner in 0..3 {
            let code = written(&[1 | (corner as u8) << 2, 4, 8]);
            let mut near = [0.1; 3];
            near[(corner + 1) % 3] = 0.8;
            assert_eq!(super::at(&code, near).as_deref(), Some("8"));
            near.swap((corner + 1) % 3, (corner + 2) % 3);
            assert_eq!(super::at(&code, near).as_deref(), Some("4"));
        }
        // Two sides: those at the corner, which has a child of its own.
        for corner in 0..3 {
            let code = written(&[2 | (corner as u8) << 2, 4, 8, 0xC, 0]);
            let mut near = [0.1; 3];
            near[corner] = 0.8;
            assert_eq!(super::at(&code, near).as_deref(), Some("0C"));
            let (b, c) = ((corner + 1) % 3, (corner + 2) % 3);
            (near[corner], near[b], near[c]) = (0.15, 0.8, 0.05);
            assert_eq!(super::at(&code, near).as_deref(), Some("8"));
            (near[b], near[c]) = (0.05, 0.8);
            assert_eq!(super::at(&code, near).as_deref(), Some("4"));
        }
    }

    #[test]
    fn what_is_no_tree_is_told() {
        for code in ["", "3", "C", "x", "43", &"3".repeat(100), "D"] {
            assert_eq!(at(code, CENTRE), None, "{code}");
        }
    }
}
