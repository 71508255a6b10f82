//! The bounds against dense samples of the pieces, both ways.

use super::*;
use crate::certificate::exceeds;
use crate::patch::characteristic::Characteristic;
use crate::patch::extraordinary::ExtraordinaryPatch;
use crate::scheme::Loop;
use limitmesh_testing::Random;

/// A face with one irregular corner: the characteristic map, sheared, stirred and bent.
fn piece(random: &mut Random, valence: usize, noise: f64) -> ExtraordinaryPatch {
    let bend = random.vector();
    let shear = random.signed();
    let mut moved = |p: DVec3| {
        let stir = random.vector() * noise;
        let height = bend.x * p.x * p.x + bend.y * p.x * p.y + bend.z * p.y * p.y;
        DVec3::new(p.x + shear * p.y, p.y, 0.3 * height) + stir
    };
    let map = Characteristic::of(valence).control;
    ExtraordinaryPatch {
        corner: valence % 3,
        at: moved(map.at),
        ring: map.ring.iter().map(|&p| moved(p)).collect(),
        outer: map.outer.map(moved),
    }
}

/// Points of the surface over a patch, with their barycentric coordinates.
fn sample(
    patch: &Patch,
    rules: &Rules<'_>,
    at: [DVec3; 3],
    depth: usize,
    found: &mut Vec<(DVec3, DVec3)>,
) {
    let refined = patch.refined(rules);
    let middles = [0, 1, 2].map(|edge| 0.5 * (at[edge] + at[(edge + 1) % 3]));
    (0..3).for_each(|edge| found.push((middles[edge], refined.middle(edge).position)));
    if depth > 0 {
        for part in 0..4 {
            let mut own = [middles[1], middles[2], middles[0]];
            if part < 3 {
                own[part] = at[part];
                own[(part + 1) % 3] = middles[part];
                own[(part + 2) % 3] = middles[(part + 2) % 3];
            }
            sample(&refined.part(part), rules, own, depth - 1, found);
        }
    }
}

/// The limit position of a corner.
fn limit(patch: &Patch, rules: &Rules<'_>, corner: usize) -> DVec3 {
    match patch {
        Patch::Regular(points) => BezierTriangle::of(points).corners()[corner],
        Patch::Extraordinary(piece) if piece.corner == corner => {
            let weight = 0.375 / rules.beta(piece.ring.len());
            let sum = weight * piece.at + piece.ring.iter().sum::<DVec3>();
            sum / (weight + piece.ring.len() as f64)
        }
        _ => limit(&patch.refined(rules).part(corner), rules, corner),
    }
}

/// The corners of a part, as barycentric coordinates.
fn corners(part: SubTriangle) -> [DVec3; 3] {
    let whole = [DVec3::X, DVec3::Y, DVec3::Z];
    let middle = |edge: usize| 0.5 * (whole[edge % 3] + whole[(edge + 1) % 3]);
    match part {
        SubTriangle::Whole => whole,
        SubTriangle::Half { edge, second } => {
            let mut corners = whole;
            corners[(edge + usize::from(!second)) % 3] = middle(edge);
            corners
        }
        SubTriangle::Child(3) => [middle(1), middle(2), middle(0)],
        SubTriangle::Child(part) => {
            let mut corners = [middle(part), middle(part), middle(part)];
            corners[part] = whole[part];
            corners[(part + 2) % 3] = middle(part + 2);
            corners
        }
        SubTriangle::Quarter { edge, at_end } => [
            whole[(edge + usize::from(at_end)) % 3],
            middle(edge + 1),
            middle(edge + 2),
        ],
    }
}

/// Dense samples never lie farther away than the bounds say, in both directions.
#[test]
fn bounds_hold_for_every_part_and_valence() {
    let rules = Rules::of(&Loop);
    let mut random = Random::new(7);
    let parts = (0..3).flat_map(|edge| {
        let half = |second| SubTriangle::Half { edge, second };
        let quarter = |at_end| SubTriangle::Quarter { edge, at_end };
        [
            SubTriangle::Child(edge),
            half(false),
            half(true),
            quarter(false),
            quarter(true),
        ]
    });
    let parts: Vec<SubTriangle> = parts
        .chain([SubTriangle::Whole, SubTriangle::Child(3)])
        .collect();
    for valence in 3..=20 {
        for noise in [0.0, 0.01, 0.2] {
            let patch = match piece(&mut random, valence, noise) {
                // A regular one now and then.
                piece if valence == 6 => piece.refined(rules.beta(6)).part((piece.corner + 1) % 3),
                piece => Patch::Extraordinary(Box::new(piece)),
            };
            let mut samples = Vec::new();
            sample(
                &patch,
                &rules,
                [DVec3::X, DVec3::Y, DVec3::Z],
                5,
                &mut samples,
            );
            for (corner, at) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
                samples.push((at, limit(&patch, &rules, corner)));
            }
            for &part in &parts {
                let at = corners(part);
                let position =
                    |at: DVec3| samples.iter().find(|s| s.0.distance(at) < 1e-12).unwrap().1;
                let triangle = at.map(position);
                let frame = TriangleFrame::new(triangle);
                let matrix = glam::DMat3::from_cols(at[0], at[1], at[2]).inverse();
                let inside: Vec<DVec3> = samples
                    .iter()
                    .filter(|s| (matrix * s.0).min_element() > -1e-12)
                    .map(|s| s.1)
                    .collect();
                let farthest = inside
                    .iter()
                    .map(|&p| frame.squared(p))
                    .fold(0.0, f64::max)
                    .sqrt();
                let highest = inside
                    .iter()
                    .map(|&p| frame.height(p).abs())
                    .fold(0.0, f64::max);
                for (target, slope) in [
                    (0.0, 0.5),
                    (0.5 * farthest, 0.2),
                    (2.0 * farthest, f64::MAX),
                ] {
                    let effort = Effort {
                        target,
                        halvings: 3,
                        open: [false; 3],
                        rim_alone: false,
                        chords: [0.1; 3],
                        slopes: [slope; 3],
                        gives_up: false,
                        least_chord: None,
                    };
                    let found = Pieces::of(&patch).deviation(part, &frame, &rules, effort);
                    assert!(
                        found.own >= farthest - 1e-12 && found.height >= highest - 1e-12,
                        "valence {valence}, noise {noise}, {part:?}: {found:?}, {farthest}, {highest}"
                    );
                    // And not far above the truth.
                    if target == 0.0 && noise == 0.0 {
                        assert!(
                            found.height <= 1.5 * highest + 0.1,
                            "{valence} {part:?} {found:?} {highest}"
                        );
                    }
                }
            }
        }
    }
}

/// A net with a NaN in any coordinate of any point has no finite bound.
#[test]
fn nothing_is_within_a_distance_of_what_is_not_a_number() {
    let rules = Rules::of(&Loop);
    let mut random = Random::new(3);
    let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let effort = Effort {
        target: 1e9,
        halvings: 1,
        open: [false; 3],
        rim_alone: false,
        chords: [0.1; 3],
        slopes: [0.5; 3],
        gives_up: false,
        least_chord: None,
    };
    let fails = |patch: &Patch, corners: [DVec3; 3], open: bool, what: &str| {
        let effort = Effort {
            open: [open; 3],
            ..effort
        };
        let found = Pieces::of(patch).deviation(
            SubTriangle::Whole,
            &TriangleFrame::new(corners),
            &rules,
            effort,
        );
        assert!(
            exceeds(found.bound([0.1; 3], [0.5; 3]), f64::MAX),
            "{what}: {found:?}"
        );
    };
    for bad in [f64::NAN, f64::INFINITY] {
        for open in [false, true] {
            for valence in [3, 5, 40] {
                let piece = piece(&mut random, valence, 0.1);
                let whole = Patch::Extraordinary(Box::new(piece.clone()));
                for corner in 0..3 {
                    let mut corners = triangle;
                    corners[corner].z = bad;
                    fails(&whole, corners, open, "corner");
                }
                for at in 0..valence {
                    let mut piece = piece.clone();
                    piece.ring[at].y = bad;
                    fails(
                        &Patch::Extraordinary(Box::new(piece)),
                        triangle,
                        open,
                        "ring",
                    );
                }
                let mut piece = piece;
                piece.at.x = bad;
                fails(
                    &Patch::Extraordinary(Box::new(piece)),
                    triangle,
                    open,
                    "vertex",
                );
            }
            for at in 0..12 {
                let mut points =
                    [DVec3::ZERO; 12].map(|_| DVec3::new(random.signed(), random.signed(), 0.0));
                points[at].x = bad;
                fails(&Patch::Regular(points), triangle, open, "regular");
                fails(
                    &Patch::Regular(points),
                    [DVec3::X; 3],
                    open,
                    "triangle without area",
                );
            }
        }
    }
}

/// A bound given up early would have missed the target with any valid angles and slopes; other
/// bounds equal the complete ones.
#[test]
fn nothing_is_given_up_that_could_pass() {
    let rules = Rules::of(&Loop);
    let mut random = Random::new(11);
    let (mut given_up, mut kept) = (0, 0);
    for valence in (3..12).cycle().take(200) {
        let patch = Patch::Extraordinary(Box::new(piece(&mut random, valence, 0.02)));
        let frame = TriangleFrame::new([0, 1, 2].map(|corner| limit(&patch, &rules, corner)));
        let chord = 0.2 * (1.0 + random.signed());
        let all = Effort {
            target: 0.02 + 0.015 * random.signed(),
            halvings: 2,
            open: [false; 3],
            rim_alone: false,
            chords: [0.3; 3],
            slopes: [0.6; 3],
            gives_up: false,
            least_chord: None,
        };
        let some = Effort {
            gives_up: true,
            least_chord: Some(chord.min(0.3)),
            ..all
        };
        let [whole, found] = [all, some]
            .map(|effort| Pieces::of(&patch).deviation(SubTriangle::Whole, &frame, &rules, effort));
        if found.own == f64::INFINITY {
            given_up += 1;
            assert!(
                whole.bound([chord; 3], [0.4; 3]) > all.target
                    && whole.bound([0.3; 3], [0.6; 3]) > all.target
            );
        } else {
            kept += 1;
            assert_eq!(whole, found);
        }
    }
    assert!(given_up > 100 && kept > 5, "{given_up}, {kept}");
}
