//! The points of the surface that are likely to be farthest from the mesh: what lower bounds are found with.
//!
//! Heights over leaves are of no use here: neighbours may have had leaves split since, so that vertices of the mesh lie where the
//! surface stood highest over them.

use core::ops::Range;

use super::super::divide::child_open;
use super::super::emit::Emission;
use super::super::emitted::{Emitted, Over, Sources, TriangleVisitor};
use super::super::quadtree::NodeAddress;
use super::super::surface::Surface;
use crate::certificate::TriangleFrame;
use crate::geometry::nearer;
use crate::parallel::IsStopped;
use crate::patch::Rules;
use crate::patch::child_corners;
use crate::vector::{DVec3, Extremes, vector};

/// Levels below a leaf whose vertices are sampled: the greatest distance is met within some per cent.
pub(super) const SAMPLED_LEVELS: usize = 3;

/// Triangles that are looked at between two questions whether that is still of use.
const LOOKED_AT: usize = 1 << 14;

/// The point of the surface over a leaf that is farthest from its triangles; over the one that bends most of a control face's where
/// none is given. Where vertices were moved, those that stand highest and lowest, and the corners.
pub(super) fn farthest(
    sources: &Sources<'_>,
    face: u32,
    leaf: Option<NodeAddress>,
    is_stopped: &IsStopped<'_>,
) -> Vec<DVec3> {
    let Sources {
        control, emission, ..
    } = *sources;
    let is_moved = !emission.offsets.is_empty();
    let (place, triangles) = match leaf {
        Some(place) if is_moved => (place, Vec::new()),
        _ => {
            let wanted = match leaf {
                Some(place) => Wanted::Leaf(place),
                None => Wanted::LeafOf(most_bent(emission, face, is_stopped)),
            };
            let place = NodeAddress::root(face);
            let mut found = Finder {
                wanted,
                is_found: false,
                place,
                triangles: Vec::new(),
            };
            sources.show(face, is_stopped, &mut found);
            if found.is_found {
                (found.place, found.triangles)
            } else {
                (place, Vec::new())
            }
        }
    };
    let piece = control.piece(face);
    let (mut surface, mut corners) = (piece.surface(control.rules), control.corners(face));
    for level in 0..place.level {
        let child = place.digit(level);
        corners = child_corners(corners, surface.middles(), child);
        surface = surface.child(child);
    }
    let mut points = Vec::new();
    if control.flat.is_within_rim(face) {
        let open = control.open(face);
        let open = [0, 1, 2].map(|edge| open[edge] && place.lies_along(edge));
        sample_rim(surface, open, SAMPLED_LEVELS, &mut points);
    } else {
        sample(surface, SAMPLED_LEVELS, &mut points);
    }
    if is_moved {
        let frame = TriangleFrame::new(corners.map(|corner| corner.position));
        let by_height = |a: &&DVec3, b: &&DVec3| frame.height(**a).total_cmp(&frame.height(**b));
        let ends = [
            points.iter().max_by(by_height),
            points.iter().min_by(by_height),
        ];
        let corners = corners.map(|corner| corner.position);
        return ends.into_iter().flatten().copied().chain(corners).collect();
    }
    let corners =
        |triangle: [u32; 3]| triangle.map(|vertex| vector(emission.positions[vertex as usize]));
    let triangles: Vec<[DVec3; 3]> = triangles.into_iter().map(corners).collect();
    let mut farthest: Option<(f64, DVec3)> = None;
    for point in points {
        let most = farthest.map_or(-1.0, |(squared, _)| squared);
        let mut least = f64::INFINITY;
        for corners in &triangles {
            // If one is near enough, the point is not the farthest.
            if least <= most {
                break;
            }
            least = nearer(least, corners.map(|corner| corner - point));
        }
        if least > most {
            farthest = Some((least, point));
        }
    }
    farthest.map(|(_, point)| point).into_iter().collect()
}

/// Points of a surface.
pub(super) fn sample(surface: Surface<'_>, levels: usize, points: &mut Vec<DVec3>) {
    points.extend(surface.middles().map(|middle| middle.position));
    if levels > 1 {
        (0..4).for_each(|child| sample(surface.child(child), levels - 1, points));
    }
}

/// Points of a surface's curves over its open edges.
fn sample_rim(surface: Surface<'_>, open: [bool; 3], levels: usize, points: &mut Vec<DVec3>) {
    if levels == 0 || open == [false; 3] {
        return;
    }
    let middles = surface.middles();
    points.extend(
        (0..3)
            .filter(|&edge| open[edge])
            .map(|edge| middles[edge].position),
    );
    (0..4).for_each(|child| {
        sample_rim(
            surface.child(child),
            child_open(open, child),
            levels - 1,
            points,
        )
    });
}

/// The triangle of a control face over which the surface bends most, as far as the normals at its corners tell.
fn most_bent(emission: &Emission, face: u32, is_stopped: &IsStopped<'_>) -> u32 {
    let Emission {
        positions,
        normals,
        triangles,
        ..
    } = emission;
    let (mut number, mut greatest) = (0, -1.0);
    for triangle in emission.triangles_of(face) {
        if triangle % LOOKED_AT == LOOKED_AT - 1 && is_stopped() {
            break;
        }
        let at = |list: &[[f64; 3]], corner: usize| {
            vector(list[triangles[triangle][corner % 3] as usize])
        };
        let bend = |edge: usize| {
            let along = at(positions, edge + 1) - at(positions, edge);
            (at(normals, edge + 1) - at(normals, edge)).dot(along).abs()
        };
        let bend = bend(0).larger(bend(1)).larger(bend(2));
        if bend > greatest {
            (number, greatest) = (triangle as u32, bend);
        }
    }
    number
}

/// Which leaf is looked for.
#[derive(Clone, Copy)]
enum Wanted {
    Leaf(NodeAddress),
    /// That of a triangle.
    LeafOf(u32),
}

/// Finds the triangles of a leaf.
struct Finder {
    wanted: Wanted,
    is_found: bool,
    /// The leaf at hand, or that one.
    place: NodeAddress,
    triangles: Vec<[u32; 3]>,
}

impl TriangleVisitor for Finder {
    fn wants(&self, node: NodeAddress, triangles: Range<u32>) -> bool {
        match self.wanted {
            Wanted::Leaf(leaf) => node.holds(leaf),
            Wanted::LeafOf(triangle) => triangles.contains(&triangle),
        }
    }

    fn triangle<'p>(&mut self, emitted: &Emitted, _: Over<'_, 'p>, _: &'p Rules<'p>) {
        // Those of a leaf follow each other.
        if emitted.place != self.place {
            if self.is_found {
                return;
            }
            (self.place, self.triangles) = (emitted.place, Vec::new());
        }
        self.triangles.push(emitted.vertices);
        self.is_found |= match self.wanted {
            Wanted::Leaf(leaf) => emitted.place == leaf,
            Wanted::LeafOf(triangle) => emitted.number == triangle,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::judge::Goal;
    use super::super::super::with_engine;
    use super::*;
    use crate::refine::ExactOptions;
    use limitmesh_testing::models::stirred;

    /// All triangles with their leaves.
    struct Listing(Vec<(u32, NodeAddress)>);

    impl TriangleVisitor for Listing {
        fn triangle<'p>(&mut self, emitted: &Emitted, _: Over<'_, 'p>, _: &'p Rules<'p>) {
            self.0.push((emitted.number, emitted.place));
        }
    }

    /// Nodes that are skipped hold no farther point: the result is that of a list of all.
    #[test]
    fn the_leaf_of_a_triangle_is_found_with_all_of_its_triangles() {
        let mut found_in_parts = 0;
        for (name, seed) in [
            ("icosphere", 3),
            ("torus", 6),
            ("spike", 2),
            ("head", 1),
            ("cup", 5),
        ] {
            let mesh = stirred(name, seed);
            let tolerance = 3e-4 * mesh.diagonal();
            let options = ExactOptions::default().tolerance(tolerance);
            with_engine(&mesh, &options, |engine| {
                let found = engine
                    .refined(Goal::Within(tolerance), usize::MAX)?
                    .unwrap();
                let emission = &found.emission;
                let sources = engine.sources(&found.state, emission);
                for face in (0..mesh.face_count() as u32).step_by(3) {
                    let mut all = Listing(Vec::new());
                    sources.show(face, &|| false, &mut all);
                    for &(number, leaf) in all.0.iter().step_by(7) {
                        let expected = all.0.iter().filter(|&&(_, place)| place == leaf);
                        let mut expected: Vec<[u32; 3]> = expected
                            .map(|&(number, _)| emission.triangles[number as usize])
                            .collect();
                        for wanted in [Wanted::Leaf(leaf), Wanted::LeafOf(number)] {
                            let place = NodeAddress::root(face);
                            let mut found = Finder {
                                wanted,
                                is_found: false,
                                place,
                                triangles: Vec::new(),
                            };
                            sources.show(face, &|| false, &mut found);
                            assert!(found.is_found && found.place == leaf, "{name}, {leaf:?}");
                            // They may begin at other corners.
                            let mut triangles = found.triangles;
                            let sorted = |triangle: &mut [u32; 3]| triangle.sort_unstable();
                            expected.iter_mut().chain(&mut triangles).for_each(sorted);
                            expected.sort_unstable();
                            triangles.sort_unstable();
                            assert_eq!(triangles, expected, "{name}, {leaf:?}");
                            found_in_parts += usize::from(triangles.len() > 1);
                        }
                    }
                }
                Ok(())
            })
            .unwrap();
        }
        assert!(found_in_parts > 100, "{found_in_parts}");
    }
}
