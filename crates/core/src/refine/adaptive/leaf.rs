//! The triangles of a leaf some of whose edges are split (the paper's Figure 5, [`crate::closure`]) as parts of its patch.

use crate::certificate::SubTriangle;

/// A triangle of a leaf. Labels are those of [`crate::closure`]: 0 to 2 for the leaf's corners, 3 + c for the vertex on the edge from corner c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LeafTriangle {
    /// The part of the leaf's patch that it approximates.
    pub(super) part: SubTriangle,
    /// The labels of its corners, in the order of the part's, which may begin elsewhere than the triangle.
    pub(super) corners: [usize; 3],
    /// For each edge, from the corner of its number, the leaf's edge that it is part of.
    pub(super) borders: [Option<usize>; 3],
}

impl LeafTriangle {
    /// The triangle of a pattern with these labels.
    pub(super) fn of(labels: [u8; 3]) -> Self {
        let has = |label: usize| labels.contains(&(label as u8));
        let corner = (0..3).find(|&corner| has(corner));
        let part = match (corner, labels.iter().filter(|&&label| label > 2).count()) {
            (Some(_), 0) => SubTriangle::Whole,
            (Some(_), 1) => {
                // The middle of an edge (3, 4 or 5), one end of that, and the corner opposite.
                let edge = usize::from(!has(3)) + usize::from(has(5));
                let second = !has(edge);
                SubTriangle::Half { edge, second }
            }
            (Some(corner), _) => match [has(3 + corner), has(3 + (corner + 2) % 3)] {
                [true, true] => SubTriangle::Child(corner),
                [at_end, _] => {
                    let edge = if at_end { (corner + 2) % 3 } else { corner };
                    SubTriangle::Quarter { edge, at_end }
                }
            },
            (None, _) => SubTriangle::Child(3),
        };
        let corners = part.corners([0, 1, 2], [3, 4, 5]);
        let borders = [0, 1, 2].map(|i| edge_with(corners[i], corners[(i + 1) % 3]));
        Self {
            part,
            corners,
            borders,
        }
    }

    /// Which of the triangle's labels is that of its first corner here.
    pub(super) fn turn(&self, labels: [u8; 3]) -> usize {
        let is_other = |label: &&u8| usize::from(**label) != self.corners[0];
        labels.iter().take_while(is_other).count()
    }
}

/// The leaf's edge on which two labels lie.
fn edge_with(a: usize, b: usize) -> Option<usize> {
    let lies_on =
        |label: usize, edge: usize| label == edge || label == (edge + 1) % 3 || label == 3 + edge;
    (0..3).find(|&edge| lies_on(a, edge) && lies_on(b, edge))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closure::{Diagonal, closure};

    #[test]
    fn corners_are_those_of_the_parts() {
        for split in 0..8 {
            for diagonal in [Diagonal::FromStart, Diagonal::FromEnd] {
                for &labels in closure(split, diagonal).triangles() {
                    let own = LeafTriangle::of(labels);
                    let case = format!("{split} {diagonal:?}: {labels:?} {own:?}");
                    let turned = |turn: usize| {
                        (0..3).all(|i| own.corners[i] == usize::from(labels[(i + turn) % 3]))
                    };
                    assert!((0..3).any(turned), "{case}");
                    assert_eq!(
                        own.corners,
                        own.part.corners([0, 1, 2], [3, 4, 5]),
                        "{case}"
                    );
                    // Twice the barycentric coordinates of the labels.
                    let places = [
                        [2, 0, 0],
                        [0, 2, 0],
                        [0, 0, 2],
                        [1, 1, 0],
                        [0, 1, 1],
                        [1, 0, 1],
                    ];
                    for i in 0..3 {
                        let [a, b] = [i, (i + 1) % 3].map(|i| places[own.corners[i]]);
                        let opposite = (0..3).find(|&axis| a[axis] == 0 && b[axis] == 0);
                        assert_eq!(
                            own.borders[i],
                            opposite.map(|axis| (axis + 1) % 3),
                            "{case}"
                        );
                    }
                }
            }
        }
    }
}
