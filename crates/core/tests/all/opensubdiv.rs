//! Uniform refinement by the port of OpenSubdiv: another implementation of the schemes.

#![allow(clippy::unwrap_used)]

use limitmesh::Mesh;
use limitmesh::mesh::{CornerTag, CreaseTag, PolygonSoup};
use opensubdiv_rs::{far, sdc};

use crate::support::{Point, distance};

/// How it is told which scheme it is.
pub(crate) fn loops() -> (sdc::SchemeType, sdc::Options) {
    let options = sdc::Options::default()
        .with_vtx_boundary_interpolation(sdc::VtxBoundaryInterpolation::EdgeOnly);
    (sdc::SchemeType::Loop, options)
}

pub(crate) fn catmull_clark(smooth_triangles: bool) -> (sdc::SchemeType, sdc::Options) {
    let triangles = match smooth_triangles {
        true => sdc::TriangleSubdivision::Smooth,
        false => sdc::TriangleSubdivision::Catmark,
    };
    let options = loops().1.with_triangle_subdivision(triangles);
    (sdc::SchemeType::Catmark, options)
}

/// The positions after so many levels.
pub(crate) fn of_mesh(mesh: &Mesh, levels: usize) -> Vec<Point> {
    let cage = PolygonSoup {
        positions: mesh.positions().to_vec(),
        faces: mesh.triangles().iter().map(|t| t.as_slice()).collect(),
        creases: mesh.tags().creases.clone(),
        corners: mesh.tags().corners.clone(),
        ..PolygonSoup::default()
    };
    of_cage(&cage, loops(), levels)
}

/// The positions after so many levels.
pub(crate) fn of_cage(
    cage: &PolygonSoup,
    (scheme, options): (sdc::SchemeType, sdc::Options),
    levels: usize,
) -> Vec<Point> {
    let sizes: Vec<usize> = cage.faces.iter().map(<[u32]>::len).collect();
    let vertices: Vec<u32> = cage.faces.iter().flatten().copied().collect();
    let edges: Vec<[u32; 2]> = cage.creases.iter().map(|tag| tag.vertices).collect();
    let sharp: Vec<u32> = cage.corners.iter().map(|tag| tag.vertex).collect();
    let lasts = |sharpness: f64| sharpness.min(10.0) as f32;
    let of_edge = |tag: &CreaseTag| lasts(tag.sharpness);
    let of_vertex = |tag: &CornerTag| lasts(tag.sharpness);
    let [on_edges, on_vertices]: [Vec<f32>; 2] = [
        cage.creases.iter().map(of_edge).collect(),
        cage.corners.iter().map(of_vertex).collect(),
    ];
    let descriptor = far::TopologyDescriptor::new(cage.positions.len(), &sizes, &vertices)
        .with_creases(&edges, &on_edges)
        .with_corners(&sharp, &on_vertices);
    let mut refiner = far::TopologyRefinerFactory::create(descriptor, scheme, options).unwrap();
    refiner.refine_uniform(far::UniformOptions::new(levels));
    let primvars = far::PrimvarRefiner::new(&refiner);
    let mut positions = cage.positions.clone();
    for level in 1..=levels {
        let mut next = vec![[0.0f64; 3]; refiner.level(level).num_vertices()];
        primvars.interpolate(level, &positions, &mut next);
        positions = next;
    }
    positions
}

/// Checks that each of `ours` is one of `theirs` and each of theirs one of ours; where sheets were cut apart, ours has some twice. Its
/// weights are `f32`: `size` is the mesh's.
pub(crate) fn assert_same_points(name: &str, ours: &[Point], theirs: &[Point], size: f64) {
    let tolerance = 2e-6 * size;
    for (from, to) in [(ours, theirs), (theirs, ours)] {
        let mut to = to.to_vec();
        to.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        for &p in from {
            let first = to.partition_point(|q| q[0] < p[0] - tolerance);
            let mut near = to[first..].iter().take_while(|q| q[0] <= p[0] + tolerance);
            let found = near.any(|&q| distance(p, q) < tolerance);
            assert!(found, "{name}: nothing is at {p:?}");
        }
    }
}
