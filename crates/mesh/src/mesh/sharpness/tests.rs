//! Rules and sectors around vertices with every set of sharp edges, against a count by hand and a walk round.

use core::f64::consts::TAU;

use super::*;
use crate::mesh::{CornerTag, CreaseTag, Tags};

/// `count` triangles around vertex 0, from vertex 1 on; open: without the last of them.
fn fan(count: u32, open: bool) -> Mesh {
    let at = |i: u32| (TAU * f64::from(i) / f64::from(count)).sin_cos();
    let rim = (0..count).map(|i| [at(i).1, at(i).0, 0.0]);
    let positions = core::iter::once([0.0, 0.0, 1.0]).chain(rim).collect();
    let last = count - u32::from(open);
    Mesh::from_triangles(
        positions,
        (0..last).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect(),
    )
    .unwrap()
}

fn tagged(mesh: Mesh, sharp: &[(u32, f64)], corner: Option<f64>) -> Mesh {
    let crease = |&(to, sharpness): &(u32, f64)| CreaseTag {
        vertices: [to, 0],
        sharpness,
    };
    let corners = corner
        .map(|sharpness| CornerTag {
            vertex: 0,
            sharpness,
        })
        .into_iter()
        .collect();
    mesh.with_tags(Tags {
        creases: sharp.iter().map(crease).collect(),
        corners,
    })
    .unwrap()
}

#[test]
fn every_set_of_sharp_edges_gives_the_rule_and_sectors_of_its_count() {
    for (open, count) in [false, true]
        .into_iter()
        .flat_map(|open| (3..=8).map(move |count| (open, count)))
    {
        for set in 0_u32..1 << count {
            let spokes: Vec<u32> = (0..count).filter(|i| set >> i & 1 != 0).collect();
            let sharp: Vec<(u32, f64)> = spokes
                .iter()
                .map(|&i| (1 + i, 0.3 + f64::from(i)))
                .collect();
            let mesh = tagged(fan(count, open), &sharp, None);
            let sharpness = Sharpness::of(&mesh);
            let at_boundary = |i: u32| open && (i == 0 || i + 1 == count);
            let edges = (0..count)
                .filter(|&i| at_boundary(i) || spokes.contains(&i))
                .count();
            let expected = [
                VertexRule::Smooth,
                VertexRule::Dart,
                VertexRule::Crease,
                VertexRule::Corner,
            ];
            assert_eq!(sharpness.rule(VertexId(0)), expected[edges.min(3)]);
            assert_eq!(sharpness.is_empty(), spokes.iter().all(|&i| at_boundary(i)));

            let sectors = sharpness.sectors(VertexId(0));
            assert_eq!(
                sectors.iter().map(|s| s.shape.faces()).sum::<u32>(),
                count - u32::from(open)
            );
            for sector in &sectors {
                let spokes: Vec<VertexId> = sector.neighbours(mesh.topology()).collect();
                assert_eq!(spokes.len(), sector.shape.valence as usize);
                let value = |v: &VertexId| {
                    if at_boundary(v.0 - 1) {
                        f64::INFINITY
                    } else {
                        sharpness.edge(edge(&mesh, v.0))
                    }
                };
                let met: Vec<f64> = spokes.iter().map(value).collect();
                assert_eq!(sector.shape.open, edges >= 2);
                assert_eq!(sector.shape.dart, edges == 1);
                assert_eq!(sector.shape.corner, edges >= 3);
                let inner = if sector.shape.open {
                    1..met.len() - 1
                } else {
                    1..met.len()
                };
                assert!(
                    met[inner].iter().all(|&s| s == 0.0),
                    "sharp edges end sectors"
                );
                assert_eq!(met[0] > 0.0, edges > 0);
                assert_eq!(met[met.len() - 1] > 0.0, edges > 1);
            }
            if edges >= 2 {
                assert_eq!(sectors.len(), if open { edges - 1 } else { edges });
            }
        }
    }
}

fn edge(mesh: &Mesh, to: u32) -> HalfEdgeId {
    mesh.topology()
        .edge_between(VertexId(0), VertexId(to))
        .unwrap()
}

#[test]
fn both_half_edges_know_the_sharpest_tag_and_tags_of_sharpness_zero_are_none() {
    let mesh = tagged(fan(5, false), &[(1, 2.3), (1, 0.5), (3, 0.0)], Some(0.0));
    let sharpness = Sharpness::of(&mesh);
    let h = edge(&mesh, 1);
    assert_eq!(
        [h, mesh.topology().twin(h).unwrap()].map(|h| sharpness.edge(h)),
        [2.3, 2.3]
    );
    assert_eq!(sharpness.edge(edge(&mesh, 3)), 0.0);
    assert_eq!(
        (sharpness.rule(VertexId(0)), sharpness.vertex(VertexId(0))),
        (VertexRule::Dart, 0.0)
    );
    assert!(sharpness.is_semi_sharp() && sharpness.infinitely_sharp().is_empty());
    let none = tagged(fan(5, false), &[(3, 0.0)], None);
    assert!(Sharpness::of(&none).is_empty());
}

#[test]
fn a_vertex_with_a_tag_of_its_own_is_a_corner_and_what_fades_is_not_lasting() {
    let mesh = tagged(fan(6, false), &[(1, 12.0), (3, 4.0)], Some(2.0));
    let sharpness = Sharpness::of(&mesh);
    assert_eq!(sharpness.rule(VertexId(0)), VertexRule::Corner);
    assert_eq!(sharpness.sectors(VertexId(0)).len(), 2);
    let lasting = sharpness.infinitely_sharp();
    assert_eq!(lasting.rule(VertexId(0)), VertexRule::Dart);
    assert_eq!(
        lasting.sectors(VertexId(0)),
        [Sector {
            first: mesh
                .topology()
                .outgoing_ring(VertexId(0))
                .find(|&h| mesh.topology().target(h).0 == 1)
                .unwrap(),
            shape: RingShape {
                dart: true,
                ..RingShape::interior(6)
            },
        }]
    );
    assert!(!lasting.is_semi_sharp());
}
