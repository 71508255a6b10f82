//! Which triangle lies across each side, for triangles of any kind.
//!
//! Takes triangles by their indices; gives, for each side that exactly two triangles share, the other one's side.
//! Sides with one triangle or with more than two have no partner, and neither have those of a triangle that names a
//! vertex twice.

/// No partner.
const NONE: u32 = u32::MAX;

/// A side of a triangle: `3 · triangle + corner`, running from that corner to the next.
pub(super) type Side = u32;

/// The partner of every side.
pub(super) struct Neighbours {
    across: Vec<Side>,
}

/// A side as seen from the lesser of its vertices.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Use {
    greater: u32,
    side: Side,
}

impl Neighbours {
    /// Finds the partners in time and memory linear in the number of triangles. `None` if there are more sides than
    /// `u32` can name.
    pub(super) fn new(triangles: &[[u32; 3]], vertices: usize) -> Option<Self> {
        let sides = u32::try_from(triangles.len().checked_mul(3)?).ok().filter(|&sides| sides < NONE)?;
        let mut starts = vec![0u32; vertices + 1];
        for_each_side(triangles, |_, lesser, _| starts[lesser as usize + 1] += 1);
        for vertex in 0..vertices {
            starts[vertex + 1] += starts[vertex];
        }
        // Filling moves each vertex's start to its end, which is the next one's start.
        let mut uses = vec![Use { greater: 0, side: 0 }; starts[vertices] as usize];
        for_each_side(triangles, |side, lesser, greater| {
            let place = &mut starts[lesser as usize];
            uses[*place as usize] = Use { greater, side };
            *place += 1;
        });
        let mut across = vec![NONE; sides as usize];
        let mut first = 0;
        for &last in &starts[..vertices] {
            let own = &mut uses[first..last as usize];
            own.sort_unstable();
            for edge in own.chunk_by(|a, b| a.greater == b.greater) {
                if let [a, b] = edge {
                    across[a.side as usize] = b.side;
                    across[b.side as usize] = a.side;
                }
            }
            first = last as usize;
        }
        Some(Self { across })
    }

    /// The side of the other triangle at this side, if there is exactly one other.
    #[inline]
    pub(super) fn across(&self, side: Side) -> Option<Side> {
        Some(self.across[side as usize]).filter(|&other| other != NONE)
    }
}

/// Calls `f(side, lesser vertex, greater vertex)` for the sides of all triangles with three different vertices.
fn for_each_side(triangles: &[[u32; 3]], mut f: impl FnMut(Side, u32, u32)) {
    for (face, &[a, b, c]) in triangles.iter().enumerate() {
        if a != b && b != c && c != a {
            for (corner, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
                f((3 * face + corner) as Side, from.min(to), from.max(to));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partners_are_mutual_and_only_where_two_triangles_meet() {
        // A closed tetrahedron, one of its faces turned round; a fin on one edge; a triangle naming a vertex twice.
        let triangles = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 3, 2], [0, 1, 4], [2, 2, 3]];
        let neighbours = Neighbours::new(&triangles, 5).unwrap();
        let ends = |side: Side| {
            let t = triangles[side as usize / 3];
            let (a, b) = (t[side as usize % 3], t[(side as usize + 1) % 3]);
            (a.min(b), a.max(b))
        };
        for side in 0..18 {
            let partner = neighbours.across(side);
            let alone = side >= 12 || ends(side) == (0, 1);
            assert_eq!(partner.is_none(), alone, "{side}");
            if let Some(other) = partner {
                assert_eq!((neighbours.across(other), ends(other)), (Some(side), ends(side)));
            }
        }
    }
}
