//! Pieces with the part of a ring that is near, against the same pieces with all of it.

use super::*;
use crate::index::FaceId;
use crate::mesh::{CornerTag, CreaseTag, Tags};
use crate::patch::large_rings::LargeRings;
use crate::patch::large_rings::tests::{fan, limits};
use crate::patch::{Patch, root_patch};
use crate::scheme::{Loop, LoopWarren, Scheme};

/// A fan of so many faces around vertex 0 with tags of each kind: on the vertex, on edges at it, on the rim, semi-sharp, infinitely sharp and both.
pub(in super::super) fn tagged_fans(faces: usize) -> Vec<(&'static str, Mesh)> {
    let spoke = |i: usize, sharpness: f64| CreaseTag {
        vertices: [0, 1 + i as u32],
        sharpness,
    };
    let rim = |i: usize, sharpness: f64| CreaseTag {
        vertices: [1 + i as u32, 2 + i as u32],
        sharpness,
    };
    let corner = |sharpness: f64| {
        vec![CornerTag {
            vertex: 0,
            sharpness,
        }]
    };
    let many = |i: usize| spoke(i, [0.4, 1.0, 1.7, 2.5, 3.2][i % 5]);
    let half = faces / 2;
    let kinds = [
        ("corner", vec![], corner(2.5)),
        ("corner and an edge", vec![spoke(3, 1.5)], corner(2.2)),
        (
            "lasting corner and an edge",
            vec![spoke(3, 10.0), spoke(half, 1.2)],
            corner(10.0),
        ),
        ("edge", vec![spoke(half, 1.6)], vec![]),
        ("curve", vec![spoke(5, 2.5), spoke(half, 1.7)], vec![]),
        ("narrow curve", vec![spoke(5, 2.5), spoke(9, 1.2)], vec![]),
        (
            "many edges",
            (0..faces).step_by(3).map(many).collect(),
            vec![],
        ),
        (
            "lasting curve and an edge",
            vec![spoke(4, 10.0), spoke(half, 10.0), spoke(half + 9, 1.5)],
            vec![],
        ),
        (
            "lasting edges",
            vec![spoke(4, 10.0), spoke(20, 10.0), spoke(half, 10.0)],
            vec![],
        ),
        (
            "lasting end and an edge",
            vec![spoke(4, 10.0), spoke(half, 1.3)],
            vec![],
        ),
        (
            "rim",
            vec![rim(0, 1.5), rim(1, 1.5), rim(half, 3.3)],
            vec![],
        ),
        ("rim and an edge", vec![rim(0, 3.3), spoke(1, 1.4)], vec![]),
    ];
    let tagged = |(kind, creases, corners): (&'static str, Vec<CreaseTag>, Vec<CornerTag>)| {
        let tags = Tags { creases, corners };
        [true, false]
            .map(|is_closed| (kind, fan(faces, is_closed).with_tags(tags.clone()).unwrap()))
    };
    kinds.into_iter().flat_map(tagged).collect()
}

fn near(found: &[DVec3], expected: &[DVec3], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (a, b) in found.iter().zip(expected) {
        assert!(a.distance(*b) < 1e-12, "{what}: {a} {b}");
    }
}

/// All of a piece some levels down, and the vertex far down.
fn surface(patch: &Patch, rules: &Rules<'_>) -> Vec<DVec3> {
    let mut found = Vec::new();
    limits(patch, rules, 3, &mut found);
    let mut deep = patch.clone();
    for _ in 0..100 {
        let refined = deep.refined(rules);
        found.push(refined.middle(0).position);
        deep = refined.part(0);
    }
    found
}

/// Points of the surface lie in the hull of what the piece gives: no farther in any direction that is tried.
fn is_held(patch: &Patch, surface: &[DVec3], what: &str) {
    for i in 0..40 {
        let t = f64::from(i);
        let direction = DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin());
        let mut farthest = f64::NEG_INFINITY;
        patch.for_each_hull_point(|point| farthest = farthest.max(point.dot(direction)));
        let beyond = surface
            .iter()
            .map(|point| point.dot(direction))
            .fold(f64::NEG_INFINITY, f64::max);
        assert!(beyond <= farthest + 1e-12, "{what}: {beyond} {farthest}");
    }
}

/// Surfaces and bounds equal those of whole rings at every level, with few points.
#[test]
fn pieces_do_not_ask_for_neighbours_far_away() {
    let mut twins = 0;
    for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
        let rules = Rules::of(scheme);
        for (kind, mesh) in tagged_fans(300) {
            let sharpness = Sharpness::of(&mesh);
            let large = [
                LargeRings::with_tags(&mesh, &sharpness, &rules),
                LargeRings::default(),
            ];
            let is_whole = large[0].whole(VertexId(0)).is_none();
            assert_eq!(
                is_whole,
                kind == "lasting end and an edge" && !mesh.topology().is_boundary(VertexId(0))
            );
            for face in [
                0,
                1,
                3,
                4,
                8,
                20,
                BEYOND,
                BEYOND + 5,
                149,
                150,
                160,
                298,
                299,
            ] {
                let what = format!("{kind}, {}, face {face}", mesh.face_count());
                let face = FaceId(3 * face as u32);
                let mut patches = large
                    .each_ref()
                    .map(|large| root_patch(&mesh, &sharpness, large, face, &rules));
                let [found, expected] = patches.each_ref().map(|patch| surface(patch, &rules));
                near(&found, &expected, &what);
                is_held(&patches[0], &expected, &what);
                let mut points = 0;
                patches[0].for_each_hull_point(|_| points += 1);
                assert!(is_whole || points < KEPT + 40, "{what}: {points} points");
                for _ in 0..5 {
                    let [Patch::SemiSharp(found), Patch::SemiSharp(expected)] = &patches else {
                        break;
                    };
                    let both = [
                        found.infinitely_sharp_twin(&rules),
                        expected.infinitely_sharp_twin(&rules),
                    ];
                    assert_eq!(both[0].is_some(), both[1].is_some(), "{what}");
                    if let [Some((found, apart)), Some((expected, whole_apart))] = both {
                        assert!(
                            (apart - whole_apart).abs() < 1e-12,
                            "{what}: {apart} {whole_apart}"
                        );
                        near(&surface(&found, &rules), &surface(&expected, &rules), &what);
                        twins += 1;
                    }
                    patches = patches
                        .each_ref()
                        .map(|patch| patch.refined(&rules).part(0));
                }
            }
        }
    }
    assert!(twins > 500, "{twins}");
}
