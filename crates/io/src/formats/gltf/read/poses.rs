//! Where morph targets and joints take the vertices of a mesh.
//!
//! A property at rest, such as a face without area, need not hold where its vertices are moved apart. So it is tested in some
//! poses: at rest, at weight 1 of each morph target, and with all targets together at weights that nobody would choose, where it
//! holds by chance only. What joints do to vertices with the same joints and weights is one affine map; of others it is not known.

use super::primitive::{Local, Primitive};
use limitmesh::mesh::are_on_one_line;

/// A mesh's primitives, moved by their targets.
#[derive(Clone, Copy)]
pub(super) struct Poses<'a> {
    primitives: &'a [Primitive],
    targets: usize,
}

impl<'a> Poses<'a> {
    pub(super) fn new(primitives: &'a [Primitive]) -> Self {
        let targets = target_count(primitives);
        Self {
            primitives,
            targets,
        }
    }

    /// Whether a face of a primitive has no area at rest, and one elsewhere.
    pub(super) fn opens(&self, part: usize, face: &[u32]) -> bool {
        let positions = &self.primitives[part].positions;
        let Some((&first, others)) = face.split_first() else {
            return false;
        };
        let fan = || others.windows(2).map(|own| [first, own[0], own[1]]);
        fan().all(|own| are_on_one_line(own.map(|v| positions[v as usize])))
            && fan().any(|own| {
                let own = own.map(|vertex| Local { part, vertex });
                !self.always(own, are_on_one_line)
            })
    }

    /// Whether something holds of vertices in all poses; not where joints move them differently.
    pub(super) fn always<const N: usize>(
        &self,
        vertices: [Local; N],
        holds: impl Fn([[f64; 3]; N]) -> bool,
    ) -> bool {
        let rest = vertices.map(|own| self.primitives[own.part].positions[own.vertex as usize]);
        let influences = |own: &Local| {
            let found = &self.primitives[own.part].influences;
            found.get(own.vertex as usize)
        };
        let moved = |target: usize, weight: f64, points: [[f64; 3]; N]| {
            std::array::from_fn(|i| self.added(vertices[i], target, weight, points[i]))
        };
        holds(rest)
            && vertices
                .windows(2)
                .all(|pair| influences(&pair[0]) == influences(&pair[1]))
            && (0..self.targets).all(|target| holds(moved(target, 1.0, rest)))
            && (self.targets < 2 || {
                // Fractions of the golden ratio's multiples.
                let weight =
                    |target: usize| (0.618_033_988_749_895 * (target + 1) as f64).fract() + 0.25;
                let together = |points, target| moved(target, weight(target), points);
                holds((0..self.targets).fold(rest, together))
            })
    }

    /// A point and what a target adds to a vertex.
    fn added(&self, own: Local, target: usize, weight: f64, point: [f64; 3]) -> [f64; 3] {
        let target = self.primitives[own.part].targets.get(target);
        let added = target.and_then(|target| target.displacements.get(own.vertex as usize));
        added.map_or(point, |added| {
            [0, 1, 2].map(|i| point[i] + weight * added[i])
        })
    }
}

/// The most morph targets that a primitive has.
pub(super) fn target_count(primitives: &[Primitive]) -> usize {
    let all = primitives.iter().map(|primitive| primitive.targets.len());
    all.max().unwrap_or(0)
}
