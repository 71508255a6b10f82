//! Better triangles at the same count: edge flips towards even valences, sliding along the body, projection to it.

use super::{Field, Surface, collapse::shape};
use glam::DVec3;

/// Below this least cosine between the body's normal and those of the faces around it, a vertex marks a tip or a
/// ridge and stays.
const TIP: f64 = 0.35;

/// Rounds of flipping and sliding; more change nothing visible.
const ROUNDS: usize = 6;

/// The least cosine between the normals of the two faces of an edge that may be flipped: the crease of a feature is
/// kept.
const FLAT_ENOUGH: f64 = 0.9;

/// How far a vertex slides towards the mean of its neighbours in a round.
const SLIDE: f64 = 0.35;

/// Improves a half of a surface, open along x = 0, on the body of `field`.
pub(super) fn polish(half: &mut Surface, field: Field<'_>) {
    for _ in 0..ROUNDS {
        flip_edges(half);
        slide(half, field);
    }
}

/// Flips interior edges where that brings valences closer to 6 (4 in the mirror plane, whose image doubles them)
/// or turns slivers into better triangles.
fn flip_edges(half: &mut Surface) {
    let edges = half.directed_edges();
    let find = |from: u32, to: u32| {
        let place = edges.partition_point(|e| (e.0, e.1) < (from, to));
        edges.get(place).filter(|e| (e.0, e.1) == (from, to))
    };
    let mut valence: Vec<i64> = half
        .neighbours()
        .iter()
        .map(|(all, _)| all.len() as i64)
        .collect();
    let mut touched = vec![false; half.triangles.len()];
    let mut made: Vec<(u32, u32)> = Vec::new();
    for &(a, b, c, face) in edges.iter().filter(|e| e.0 < e.1) {
        let Some(&(_, _, d, other)) = find(b, a) else {
            continue;
        };
        // An edge that is there already must not be made a second time.
        let joined =
            find(c, d).is_some() || find(d, c).is_some() || made.contains(&(c.min(d), c.max(d)));
        let [face, other] = [face as usize, other as usize];
        if touched[face]
            || touched[other]
            || joined
            || !flip_is_better(half, &valence, [a, b, c, d])
        {
            continue;
        }
        half.triangles[face] = [a, d, c];
        half.triangles[other] = [d, b, c];
        touched[face] = true;
        touched[other] = true;
        made.push((c.min(d), c.max(d)));
        for (v, change) in [(a, -1), (b, -1), (c, 1), (d, 1)] {
            valence[v as usize] += change;
        }
    }
}

/// Whether the edge between `a` and `b`, with `c` on its left and `d` on its right, had better join `c` and `d`.
fn flip_is_better(half: &Surface, valence: &[i64], [a, b, c, d]: [u32; 4]) -> bool {
    let p = |v: u32| half.positions[v as usize];
    let normal = |[a, b, c]: [u32; 3]| (p(b) - p(a)).cross(p(c) - p(a)).normalize_or_zero();
    let (old, new) = ([[a, b, c], [b, a, d]], [[a, d, c], [d, b, c]]);
    let flat = |pair: [[u32; 3]; 2]| normal(pair[0]).dot(normal(pair[1])) > FLAT_ENOUGH;
    let in_mirror = new.iter().any(|t| t.iter().all(|&v| p(v).x == 0.0));
    let loses_too_much = valence[a as usize] <= 4 || valence[b as usize] <= 4;
    if !flat(old) || !flat(new) || in_mirror || loses_too_much {
        return false;
    }
    let worst = |pair: [[u32; 3]; 2]| shape(pair[0].map(p)).min(shape(pair[1].map(p)));
    let off = |v: u32, change: i64| {
        let regular = if p(v).x == 0.0 { 4 } else { 6 };
        (valence[v as usize] + change - regular).pow(2)
    };
    let before = off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0);
    let after = off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1);
    let better_valence = after < before && worst(new) > 0.6 * worst(old);
    let better_shape = after <= before + 2 && worst(new) > 1.5 * worst(old);
    better_valence || better_shape
}

/// Moves each vertex towards the mean of its neighbours within the surface, then back onto the body.
fn slide(half: &mut Surface, field: Field<'_>) {
    let neighbours = half.neighbours();
    let faces = half.faces_at_vertices();
    let old = half.positions.clone();
    let normals: Vec<DVec3> = half
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| old[v as usize]);
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect();
    let step = 1e-4
        * old
            .iter()
            .fold(0.0_f64, |most, p| most.max(p.abs().max_element()));
    for (v, (all, boundary)) in neighbours.iter().enumerate() {
        // A vertex in the mirror plane slides along the plane, between its neighbours there.
        let list = if boundary.is_empty() { all } else { boundary };
        let mean = list.iter().map(|&u| old[u as usize]).sum::<DVec3>() / list.len() as f64;
        let normal = gradient(field, old[v], step).normalize_or_zero();
        let flatness = faces[v].iter().fold(1.0_f64, |least, &face| {
            least.min(normals[face as usize].dot(normal))
        });
        let mut pull = (mean - old[v]) * (SLIDE * ((flatness - TIP) / (1.0 - TIP)).max(0.0));
        pull -= normal * pull.dot(normal);
        let mut p = old[v] + pull;
        if !boundary.is_empty() {
            p.x = 0.0;
        }
        half.positions[v] = project(field, p, step);
    }
}

/// The nearby point of the body's surface, by Newton steps along the gradient; in the mirror plane it stays there.
pub(super) fn project(field: Field<'_>, start: DVec3, step: f64) -> DVec3 {
    let mut p = start;
    for _ in 0..3 {
        let mut gradient = gradient(field, p, step);
        if p.x == 0.0 {
            gradient.x = 0.0;
        }
        let steepness = gradient.length_squared();
        // Where the field is too flat to tell a direction the point stays.
        if steepness > 0.01 {
            p -= gradient * (field(p) / steepness);
        }
    }
    p
}

fn gradient(field: Field<'_>, p: DVec3, step: f64) -> DVec3 {
    let along = |axis: DVec3| (field(p + axis * step) - field(p - axis * step)) / (2.0 * step);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}
