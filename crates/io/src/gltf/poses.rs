//! Where morph targets and joints take the vertices of a mesh.
//!
//! What holds at rest, such as that a triangle has no area, need not hold where its vertices are moved apart. So it is looked at in some
//! poses: at rest, at weight 1 of each morph target, and with all targets together at weights that nobody would choose, where it
//! holds by chance only. What joints do to vertices with the same joints and weights is one affine map; of others it is not known.

use super::primitive::Primitive;
use limitmesh::mesh::are_on_one_line;

/// A vertex of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Local {
    pub(super) part: usize,
    pub(super) vertex: u32,
}

/// A mesh's primitives, moved by their targets.
#[derive(Clone, Copy)]
pub(super) struct Poses<'a> {
    primitives: &'a [Primitive],
    targets: usize,
}

impl<'a> Poses<'a> {
    pub(super) fn new(primitives: &'a [Primitive]) -> Self {
        let targets = primitives
            .iter()
            .map(|primitive| primitive.targets.len())
            .max()
            .unwrap_or(0);
        Self {
            primitives,
            targets,
        }
    }

    /// Whether a triangle of a primitive has no area at rest, and one elsewhere.
    pub(super) fn opens(&self, part: usize, triangle: [u32; 3]) -> bool {
        let positions = &self.primitives[part].positions;
        are_on_one_line(triangle.map(|v| positions[v as usize]))
            && !self.always(
                triangle.map(|vertex| Local { part, vertex }),
                are_on_one_line,
            )
    }

    /// Whether something holds of vertices in all poses; not where joints move them differently.
    pub(super) fn always<const N: usize>(
        &self,
        vertices: [Local; N],
        holds: impl Fn([[f64; 3]; N]) -> bool,
    ) -> bool {
        let rest = vertices.map(|own| self.primitives[own.part].positions[own.vertex as usize]);
        let influences = |own: &Local| {
            self.primitives[own.part]
                .influences
                .get(own.vertex as usize)
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
                holds(
                    (0..self.targets)
                        .fold(rest, |points, target| moved(target, weight(target), points)),
                )
            })
    }

    /// A point and what a target adds to a vertex.
    fn added(&self, own: Local, target: usize, weight: f64, point: [f64; 3]) -> [f64; 3] {
        let targets = &self.primitives[own.part].targets;
        let added = targets
            .get(target)
            .and_then(|target| target.displacements.get(own.vertex as usize));
        added.map_or(point, |added| {
            std::array::from_fn(|i| point[i] + weight * added[i])
        })
    }
}
