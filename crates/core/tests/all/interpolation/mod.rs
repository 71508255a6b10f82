//! Control points whose limit surface passes through given vertices, or near them, against dense systems built from closed
//! forms, against uniform refinement, and against circles.

#![allow(clippy::unwrap_used, clippy::panic)]

mod other_schemes;
mod through;
mod uneven_lines;
mod within;

use std::f64::consts::TAU;

use crate::support::{Point, Random, distance, divided, model, tagged_by};
use limitmesh::interpolate::{InterpolateError, InterpolateOptions, Interpolated};
use limitmesh::limit::LimitTable;
use limitmesh::scheme::Scheme;
use limitmesh::{Mesh, VertexId};
use nalgebra::{DMatrix, DVector};

pub(crate) fn interpolate(
    mesh: &Mesh,
    scheme: &dyn Scheme,
) -> Result<Interpolated, InterpolateError> {
    limitmesh::interpolate::interpolate(mesh, scheme, &InterpolateOptions::default())
}

/// The greatest distance of the library's limits from the vertices of a mesh, except for the
/// relaxed ones.
pub(crate) fn from_limits(found: &Interpolated, scheme: &dyn Scheme, vertices: &Mesh) -> f64 {
    let may_be = beside_long_edges(vertices);
    assert!(
        found.relaxed.iter().all(|v| may_be.contains(&v.0)),
        "{:?} of {may_be:?}",
        found.relaxed
    );
    let limits = LimitTable::new(scheme).positions(&found.mesh).unwrap();
    let through = |v: &usize| !found.relaxed.contains(&VertexId(*v as u32));
    let distances = (0..limits.len())
        .filter(through)
        .map(|v| distance(limits[v], vertices.positions()[v]));
    distances.fold(0.0, f64::max)
}

/// The ends of tagged and boundary edges more than three times as long as the shortest such edge at one of their ends: by the tags and faces alone.
fn beside_long_edges(mesh: &Mesh) -> Vec<u32> {
    let mut faces = std::collections::BTreeMap::new();
    for &[a, b, c] in mesh.triangles() {
        [[a, b], [b, c], [c, a]]
            .iter()
            .for_each(|&[p, q]| *faces.entry([p.min(q), p.max(q)]).or_insert(0) += 1);
    }
    let boundary = faces
        .iter()
        .filter(|&(_, &count)| count == 1)
        .map(|(&ends, _)| ends);
    let lines: Vec<[u32; 2]> = boundary
        .chain(mesh.tags().creases.iter().map(|tag| tag.vertices))
        .collect();
    let length =
        |[a, b]: [u32; 2]| distance(mesh.positions()[a as usize], mesh.positions()[b as usize]);
    let shortest = |v: u32| {
        let own = lines
            .iter()
            .filter(|ends| ends.contains(&v))
            .map(|&ends| length(ends));
        own.fold(f64::INFINITY, f64::min)
    };
    let is_long = |ends: &&[u32; 2]| {
        length(**ends) > 3.0 * shortest(ends[0]).min(shortest(ends[1])) * (1.0 - 1e-12)
    };
    lines.iter().filter(is_long).flatten().copied().collect()
}

pub(crate) fn farthest(a: &[Point], b: &[Point]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(&a, &b)| distance(a, b))
        .fold(0.0, f64::max)
}

/// The limit weights of a mesh without tags, from closed forms alone: `β` is the weight of an interior vertex's neighbours.
pub(crate) fn dense(mesh: &Mesh, beta: impl Fn(f64) -> f64) -> DMatrix<f64> {
    let n = mesh.vertex_count();
    let (mut faces, mut neighbours) = (std::collections::BTreeMap::new(), vec![Vec::new(); n]);
    for &[a, b, c] in mesh.triangles() {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            *faces.entry([p.min(q), p.max(q)]).or_insert(0) += 1;
        }
    }
    for (&[a, b], &count) in &faces {
        neighbours[a as usize].push((b as usize, count));
        neighbours[b as usize].push((a as usize, count));
    }
    let mut matrix = DMatrix::zeros(n, n);
    for (v, around) in neighbours.iter().enumerate() {
        let boundary: Vec<usize> = around
            .iter()
            .filter(|&&(_, count)| count == 1)
            .map(|&(u, _)| u)
            .collect();
        if let [a, b] = boundary[..] {
            matrix[(v, v)] = 2.0 / 3.0;
            (matrix[(v, a)], matrix[(v, b)]) = (1.0 / 6.0, 1.0 / 6.0);
            continue;
        }
        let k = around.len() as f64;
        let own = 3.0 / (8.0 * beta(k));
        matrix[(v, v)] = own / (own + k);
        around
            .iter()
            .for_each(|&(u, _)| matrix[(v, u)] = 1.0 / (own + k));
    }
    matrix
}

pub(crate) fn loop_beta(k: f64) -> f64 {
    (0.625 - (0.375 + 0.25 * (TAU / k).cos()).powi(2)) / k
}

/// Solves a dense system for the points of a mesh.
pub(crate) fn dense_solution(matrix: &DMatrix<f64>, mesh: &Mesh) -> Vec<Point> {
    let lu = matrix.clone().lu();
    let axis = |axis: usize| {
        let right = DVector::from_iterator(
            mesh.vertex_count(),
            mesh.positions().iter().map(|p| p[axis]),
        );
        lu.solve(&right).unwrap()
    };
    let [x, y, z] = [axis(0), axis(1), axis(2)];
    (0..mesh.vertex_count())
        .map(|v| [x[v], y[v], z[v]])
        .collect()
}

/// Uniform refinement brings each old vertex nearer to its limit, without any limit stencil.
pub(crate) fn refinement_tends_to(
    vertices: &Mesh,
    control: &Mesh,
    scheme: &dyn Scheme,
    levels: usize,
    near: f64,
) {
    let refined = divided(control, scheme, levels);
    let away = farthest(
        &refined.positions()[..vertices.vertex_count()],
        vertices.positions(),
    );
    let before = farthest(control.positions(), vertices.positions());
    below!(away, near * before, "{}", scheme.name());
}

/// Tags on some edges and vertices, many of them semi-sharp, some single ones that end in darts.
pub(crate) fn tagged(mesh: Mesh, seed: u64, lasting_only: bool) -> Mesh {
    let mut random = Random::new(seed);
    tagged_by(mesh, [8, 15], |one_in| {
        let is_tagged = random.below(one_in) == 0;
        let fading = 1.6 + 1.5 * random.signed();
        let lasts = lasting_only || random.below(2) == 0;
        is_tagged.then_some(if lasts { f64::INFINITY } else { fading })
    })
}
