//! The triangles of a leaf by which of its edges are split (the paper's Figure 5), and the parts of its patch that
//! they stand for.

use crate::certificate::SubTriangle;

/// A triangle of a leaf. Corners of the part and of the triangle stand in the same order, which may be another than that
/// of the emitted triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeafTriangle<P> {
    /// The part of the leaf's patch that it stands for.
    pub(super) part: SubTriangle,
    pub(super) corners: [P; 3],
    /// For each edge, from the corner of its number, the leaf's edge that it is part of.
    pub(super) borders: [Option<usize>; 3],
}

/// The triangles of a leaf, given its corners and the vertices on its split edges. Of two split edges, the
/// quadrilateral is cut by the diagonal from the start of the unsplit edge or from its end.
pub(super) fn leaf_triangles<P: Copy>(
    corners: [P; 3],
    middles: [Option<P>; 3],
    diagonal_from_end: bool,
) -> impl Iterator<Item = LeafTriangle<P>> {
    let whole = LeafTriangle {
        part: SubTriangle::Whole,
        corners,
        borders: [Some(0), Some(1), Some(2)],
    };
    let trisected =
        |edge, after, before| trisected(corners, edge, [after, before], diagonal_from_end);
    let list = match middles {
        [None, None, None] => [Some(whole), None, None, None],
        [Some(middle), None, None] => bisected(corners, 0, middle),
        [None, Some(middle), None] => bisected(corners, 1, middle),
        [None, None, Some(middle)] => bisected(corners, 2, middle),
        [None, Some(after), Some(before)] => trisected(0, after, before),
        [Some(before), None, Some(after)] => trisected(1, after, before),
        [Some(after), Some(before), None] => trisected(2, after, before),
        [Some(first), Some(second), Some(third)] => quartered(corners, [first, second, third]),
    };
    list.into_iter().flatten()
}

type Triangles<P> = [Option<LeafTriangle<P>>; 4];

/// One side of the cut from `middle`, on `edge`, to the corner opposite.
fn half<P: Copy>(
    mut corners: [P; 3],
    edge: usize,
    second: bool,
    middle: P,
) -> Option<LeafTriangle<P>> {
    corners[(edge + usize::from(!second)) % 3] = middle;
    let mut borders = [Some(0), Some(1), Some(2)];
    borders[(edge + 1 + usize::from(second)) % 3] = None;
    Some(LeafTriangle {
        part: SubTriangle::Half { edge, second },
        corners,
        borders,
    })
}

/// One of the four parts of a refinement.
fn child<P: Copy>(corners: [P; 3], part: usize, on_next: P, on_last: P) -> Option<LeafTriangle<P>> {
    let (mut own, mut borders) = (corners, [Some(0), Some(1), Some(2)]);
    own[(part + 1) % 3] = on_next;
    own[(part + 2) % 3] = on_last;
    borders[(part + 1) % 3] = None;
    Some(LeafTriangle {
        part: SubTriangle::Child(part),
        corners: own,
        borders,
    })
}

fn bisected<P: Copy>(corners: [P; 3], edge: usize, middle: P) -> Triangles<P> {
    [
        half(corners, edge, false, middle),
        half(corners, edge, true, middle),
        None,
        None,
    ]
}

/// All edges but `edge` are split: the next one at `after`, the one before at `before`.
fn trisected<P: Copy>(
    corners: [P; 3],
    edge: usize,
    [after, before]: [P; 2],
    diagonal_from_end: bool,
) -> Triangles<P> {
    let (end, tip) = ((edge + 1) % 3, (edge + 2) % 3);
    let quarter = |from: usize, on_border: Option<usize>| {
        // Leaving the edge's end, the quarter starts on the next edge; at its start it ends on the edge before.
        let mut borders = [None; 3];
        borders[if from == end { 0 } else { 2 }] = on_border;
        let part = SubTriangle::Quarter {
            edge,
            at_end: from == end,
        };
        Some(LeafTriangle {
            part,
            corners: [corners[from], after, before],
            borders,
        })
    };
    let cut_off = child(corners, tip, before, after);
    if diagonal_from_end {
        [
            cut_off,
            half(corners, tip, true, before),
            quarter(end, Some(end)),
            None,
        ]
    } else {
        [
            cut_off,
            half(corners, end, false, after),
            quarter(edge, Some(tip)),
            None,
        ]
    }
}

fn quartered<P: Copy>(corners: [P; 3], middles: [P; 3]) -> Triangles<P> {
    let [a, b, c] = middles;
    let inner = LeafTriangle {
        part: SubTriangle::Child(3),
        corners: [b, c, a],
        borders: [None; 3],
    };
    [
        child(corners, 0, a, c),
        child(corners, 1, b, a),
        child(corners, 2, c, b),
        Some(inner),
    ]
}
