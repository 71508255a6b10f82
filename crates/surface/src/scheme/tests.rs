//! Tests of the masks: sums, the contract of [`Scheme`], and linear precision on the fans each rule is made for.

use super::{EdgeMask, Loop, LoopWarren, ModifiedButterfly, Scheme};
use crate::ring::{EdgeShape, RingShape};

const SCHEMES: [&dyn Scheme; 3] = [&Loop, &LoopWarren, &ModifiedButterfly];

fn all_rings() -> Vec<RingShape> {
    let flags = [(false, false), (false, true), (true, false), (true, true)];
    let rings = |(open, corner)| {
        (2..=12).chain([33]).map(move |valence| RingShape {
            valence,
            open,
            corner,
            dart: false,
        })
    };
    flags.into_iter().flat_map(rings).collect()
}

/// Every edge shape between two rings, boundary edges where both slots are on the boundary.
fn all_edges() -> Vec<EdgeShape> {
    let mut edges = Vec::new();
    for origin in all_rings() {
        for target in all_rings() {
            for origin_slot in slots(origin) {
                for target_slot in slots(target) {
                    let edge = EdgeShape {
                        origin,
                        origin_slot,
                        target,
                        target_slot,
                    };
                    if is_at_end(origin, origin_slot) == is_at_end(target, target_slot) {
                        edges.push(edge);
                    }
                }
            }
        }
    }
    edges
}

fn slots(ring: RingShape) -> Vec<u32> {
    if ring.open {
        (0..ring.valence).collect()
    } else {
        vec![0]
    }
}

fn is_at_end(ring: RingShape, slot: u32) -> bool {
    ring.open && (slot == 0 || slot + 1 == ring.valence)
}

fn sum(mask: &EdgeMask) -> f64 {
    mask.origin
        + mask.target
        + mask
            .origin_ring
            .iter()
            .chain(&mask.target_ring)
            .sum::<f64>()
}

#[test]
fn weights_sum_to_one() {
    for scheme in SCHEMES {
        for shape in all_rings() {
            let mask = scheme.vertex_mask(shape);
            assert_eq!(mask.ring.len(), shape.valence as usize);
            let sum = mask.centre + mask.ring.iter().sum::<f64>();
            assert!(
                (sum - 1.0).abs() < 1e-13,
                "{} {shape:?}: {sum}",
                scheme.name()
            );
        }
        for shape in all_edges() {
            let mask = scheme.edge_mask(shape);
            assert_eq!(mask.origin_ring.len(), shape.origin.valence as usize);
            assert_eq!(mask.target_ring.len(), shape.target.valence as usize);
            assert!(
                (sum(&mask) - 1.0).abs() < 1e-13,
                "{} {shape:?}: {}",
                scheme.name(),
                sum(&mask)
            );
        }
    }
}

#[test]
fn corners_stay() {
    for scheme in SCHEMES {
        for shape in all_rings().into_iter().filter(|shape| shape.corner) {
            let mask = scheme.vertex_mask(shape);
            assert!(mask.centre == 1.0 && mask.ring.iter().all(|&weight| weight == 0.0));
        }
    }
}

/// Sheets that share a boundary stay together.
#[test]
fn boundaries_use_boundary_vertices_only() {
    for scheme in SCHEMES {
        for shape in all_rings().into_iter().filter(|shape| shape.open) {
            let mask = scheme.vertex_mask(shape);
            assert!(
                mask.ring[1..mask.ring.len() - 1]
                    .iter()
                    .all(|&weight| weight == 0.0)
            );
        }
        let boundary = all_edges().into_iter().filter(EdgeShape::is_boundary);
        for shape in boundary {
            let mask = scheme.edge_mask(shape);
            for ring in [&mask.origin_ring, &mask.target_ring] {
                assert!(
                    ring[1..ring.len() - 1].iter().all(|&weight| weight == 0.0),
                    "{shape:?}"
                );
            }
            // Nor may they depend on how many faces are on the other side.
            let with_valence = |ring: RingShape, slot| {
                let ring = RingShape { valence: 4, ..ring };
                (ring, if slot == 0 { 0 } else { 3 })
            };
            let (origin, origin_slot) = with_valence(shape.origin, shape.origin_slot);
            let (target, target_slot) = with_valence(shape.target, shape.target_slot);
            let other = scheme.edge_mask(EdgeShape {
                origin,
                origin_slot,
                target,
                target_slot,
            });
            assert_eq!((mask.origin, mask.target), (other.origin, other.target));
            assert_eq!(mask.origin_ring.first(), other.origin_ring.first());
            assert_eq!(mask.origin_ring.last(), other.origin_ring.last());
        }
    }
}

/// An edge as a map from vertices to weights, for vertices named from both ends.
fn unified(mask: &EdgeMask, shape: &EdgeShape) -> Vec<(String, f64)> {
    let mut weights: Vec<(String, f64)> = Vec::new();
    let mut add =
        |name: String, weight: f64| match weights.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sum)) => *sum += weight,
            None => weights.push((name, weight)),
        };
    add("origin".into(), mask.origin);
    add("target".into(), mask.target);
    let around = |ring: RingShape, slot: u32, i: usize| {
        let steps = i as i64 - i64::from(slot);
        if ring.open {
            steps
        } else {
            (steps + i64::from(ring.valence) / 2).rem_euclid(ring.valence.into())
                - i64::from(ring.valence) / 2
        }
    };
    for (i, &weight) in mask.origin_ring.iter().enumerate() {
        let name = match around(shape.origin, shape.origin_slot, i) {
            0 => "target".into(),
            1 => "left".into(),
            -1 => "right".into(),
            steps => format!("origin {steps}"),
        };
        add(name, weight);
    }
    for (i, &weight) in mask.target_ring.iter().enumerate() {
        let name = match around(shape.target, shape.target_slot, i) {
            0 => "origin".into(),
            1 => "right".into(),
            -1 => "left".into(),
            steps => format!("target {steps}"),
        };
        add(name, weight);
    }
    weights.retain(|(_, weight)| *weight != 0.0);
    weights.sort_by(|a, b| a.0.cmp(&b.0));
    weights
}

/// Which end is called the origin makes no difference.
#[test]
fn edges_have_no_direction() {
    let swapped_name = |name: &str| match name {
        "left" => "right".to_owned(),
        "right" => "left".to_owned(),
        _ if name.starts_with("origin") => name.replacen("origin", "target", 1),
        _ => name.replacen("target", "origin", 1),
    };
    for scheme in SCHEMES {
        // In rings of two and three edges a neighbour has several names, and weights may move between them.
        let edges = all_edges()
            .into_iter()
            .filter(|e| e.origin.valence > 3 && e.target.valence > 3);
        for shape in edges {
            let EdgeShape {
                origin,
                origin_slot,
                target,
                target_slot,
            } = shape;
            let back = EdgeShape {
                origin: target,
                origin_slot: target_slot,
                target: origin,
                target_slot: origin_slot,
            };
            let there = unified(&scheme.edge_mask(shape), &shape);
            let back = unified(&scheme.edge_mask(back), &back);
            let mut back: Vec<_> = back
                .into_iter()
                .map(|(name, weight)| (swapped_name(&name), weight))
                .collect();
            back.sort_by(|a, b| a.0.cmp(&b.0));
            assert_eq!(
                there.len(),
                back.len(),
                "{} {shape:?}: {there:?} {back:?}",
                scheme.name()
            );
            for (a, b) in there.iter().zip(&back) {
                assert!(
                    a.0 == b.0 && (a.1 - b.1).abs() < 1e-14,
                    "{} {shape:?}: {there:?} {back:?}",
                    scheme.name()
                );
            }
        }
    }
}

/// Sum of weight × position over a mask of an edge whose rings lie in the plane.
fn apply(mask: &EdgeMask, ends: [[f64; 2]; 2], rings: [&[[f64; 2]]; 2]) -> [f64; 2] {
    let around_origin = rings[0].iter().zip(&mask.origin_ring);
    let around_target = rings[1].iter().zip(&mask.target_ring);
    let all = around_origin
        .chain(around_target)
        .chain([(&ends[0], &mask.origin), (&ends[1], &mask.target)]);
    all.fold([0.0; 2], |sum, (p, w)| {
        [sum[0] + w * p[0], sum[1] + w * p[1]]
    })
}

fn fan(count: usize, step: f64, about: [f64; 2], first: f64) -> Vec<[f64; 2]> {
    let point = |j: usize| {
        let (sine, cosine) = (first + step * j as f64).sin_cos();
        [about[0] + cosine, about[1] + sine]
    };
    (0..count).map(point).collect()
}

fn assert_midpoint(met: [f64; 2], ends: [[f64; 2]; 2], place: &str) {
    for axis in 0..2 {
        let middle = (ends[0][axis] + ends[1][axis]) / 2.0;
        assert!(
            (met[axis] - middle).abs() < 1e-13,
            "{place}: {met:?}, ends {ends:?}"
        );
    }
}

/// On a regular mesh, with or without a straight boundary, the masks reproduce linear functions.
#[test]
fn linear_precision_on_regular_meshes() {
    let sixth = core::f64::consts::FRAC_PI_3;
    let origin = [0.0, 0.0];
    for scheme in SCHEMES {
        // Inside: the edge from the origin to (1, 0).
        let ends = [origin, [1.0, 0.0]];
        let rings = [
            fan(6, sixth, origin, 0.0),
            fan(6, sixth, ends[1], 3.0 * sixth),
        ];
        let shape = EdgeShape::between(RingShape::interior(6), RingShape::interior(6));
        assert_midpoint(
            apply(&scheme.edge_mask(shape), ends, [&rings[0], &rings[1]]),
            ends,
            scheme.name(),
        );
        // From the boundary y = 0 into the mesh above, both edges.
        for slot in [1, 2] {
            let ring = fan(4, sixth, origin, 0.0);
            let ends = [origin, ring[slot]];
            let inner = fan(6, sixth, ends[1], sixth * slot as f64 + 3.0 * sixth);
            let (open, closed) = (RingShape::boundary(4), RingShape::interior(6));
            let out = EdgeShape {
                origin: open,
                origin_slot: slot as u32,
                target: closed,
                target_slot: 0,
            };
            let mask = scheme.edge_mask(out);
            assert_midpoint(apply(&mask, ends, [&ring, &inner]), ends, scheme.name());
            let back = EdgeShape {
                origin: closed,
                origin_slot: 0,
                target: open,
                target_slot: slot as u32,
            };
            let mask = scheme.edge_mask(back);
            assert_midpoint(
                apply(&mask, [ends[1], ends[0]], [&inner, &ring]),
                ends,
                scheme.name(),
            );
        }
        // Along the boundary.
        let ring = [fan(4, sixth, origin, 0.0), fan(4, sixth, [1.0, 0.0], 0.0)];
        let open = RingShape::boundary(4);
        let shape = EdgeShape {
            origin: open,
            origin_slot: 0,
            target: open,
            target_slot: 3,
        };
        let ends = [origin, [1.0, 0.0]];
        assert_midpoint(
            apply(&scheme.edge_mask(shape), ends, [&ring[0], &ring[1]]),
            ends,
            scheme.name(),
        );
    }
}

/// The butterfly's own rules reproduce linear functions on regular fans: the full circle, half of it at a
/// boundary, a third of it at a corner. The other end is regular, so that the rule stands alone.
#[test]
fn butterfly_is_linear_on_fans() {
    use core::f64::consts::{PI, TAU};
    let origin = [0.0, 0.0];
    let regular = RingShape::interior(6);
    for k in 3..=20u32 {
        let fans = [
            (RingShape::interior(k), TAU / f64::from(k)),
            (RingShape::boundary(k), PI / f64::from(k - 1)),
            (
                RingShape {
                    corner: true,
                    ..RingShape::boundary(k)
                },
                2.0 * PI / 3.0 / f64::from(k - 1),
            ),
        ];
        for (shape, step) in fans.into_iter().filter(|(shape, _)| !shape.is_regular()) {
            let slots = if shape.open {
                1..shape.valence - 1
            } else {
                0..1
            };
            for slot in slots {
                let ring = fan(k as usize, step, origin, 0.0);
                let ends = [origin, ring[slot as usize]];
                let edge = EdgeShape {
                    origin: shape,
                    origin_slot: slot,
                    target: regular,
                    target_slot: 0,
                };
                let mask = ModifiedButterfly.edge_mask(edge);
                assert!(mask.target_ring.iter().all(|&weight| weight == 0.0));
                assert_midpoint(
                    apply(&mask, ends, [&ring, &[[0.0; 2]; 6]]),
                    ends,
                    &format!("{edge:?}"),
                );
            }
        }
    }
}

/// The weights printed in the paper of 1996.
#[test]
fn butterfly_weights_in_print() {
    let ring_of = |k| {
        let mask = ModifiedButterfly.edge_mask(EdgeShape::between(
            RingShape::interior(k),
            RingShape::interior(6),
        ));
        assert!((mask.origin - 0.75).abs() < 1e-15);
        mask.origin_ring
    };
    assert_eq!(ring_of(3), [5.0 / 12.0, -1.0 / 12.0, -1.0 / 12.0]);
    assert_eq!(ring_of(4), [3.0 / 8.0, 0.0, -1.0 / 8.0, 0.0]);
    let root = 5f64.sqrt();
    // (1/4 + cos 72° + ½ cos 144°)/5 with cos 72° = (√5 − 1)/4 and cos 144° = −(√5 + 1)/4, and so on.
    let expected = [
        0.35,
        (0.25 + (root - 1.0) / 4.0 - (root + 1.0) / 8.0) / 5.0,
        (0.25 - (root + 1.0) / 4.0 + (root - 1.0) / 8.0) / 5.0,
    ];
    let five = ring_of(5);
    for (j, expected) in [
        (0, expected[0]),
        (1, expected[1]),
        (2, expected[2]),
        (3, expected[2]),
        (4, expected[1]),
    ] {
        assert!((five[j] - expected).abs() < 1e-15, "{five:?}");
    }
}
