//! Uniform refinement of tagged meshes.

use limitmesh::Mesh;
use limitmesh::mesh::{CornerTag, CreaseTag, Tags};
use limitmesh::refine::{UniformOptions, uniform};
use limitmesh::scheme::{Loop, ModifiedButterfly, Scheme};

use crate::plain::{Plain, randomly_tagged};
use crate::support::*;

fn samples() -> Vec<(&'static str, Mesh)> {
    vec![
        ("octahedron", octahedron()),
        ("torus", torus(5, 4)),
        ("sheet", sheet(4, 5, 3)),
        ("lumpy", lumpy(12, 7)),
    ]
}

fn refined(mesh: &Mesh, scheme: &dyn Scheme, levels: usize) -> Mesh {
    uniform(mesh, scheme, &UniformOptions::default().levels(levels)).unwrap().mesh
}

/// Checks that two meshes have the same triangles between the same points.
fn assert_same(ours: &Mesh, plain: &Plain, name: &str) {
    let nearest = |p: &Point| {
        let near = |v: &usize| distance(*p, plain.positions[*v]);
        let v = (0..plain.positions.len()).min_by(|a, b| near(a).total_cmp(&near(b))).unwrap();
        assert!(near(&v) < 1e-12, "{name}: {p:?} is {} away", near(&v));
        v as u32
    };
    let number: Vec<u32> = ours.positions().iter().map(nearest).collect();
    let sorted = |mut triangles: Vec<[u32; 3]>| {
        for t in &mut triangles {
            let least = (0..3).min_by_key(|&i| t[i]).unwrap();
            t.rotate_left(least);
        }
        triangles.sort_unstable();
        triangles
    };
    let renumbered = ours.triangles().iter().map(|t| t.map(|v| number[v as usize])).collect();
    assert!(sorted(renumbered) == sorted(plain.triangles.clone()), "{name}");
}

#[test]
fn tagged_refinement_follows_the_plain_rules() {
    for (name, mesh) in samples() {
        for (seed, one_in) in [(1, 2), (2, 3), (3, 5), (4, 12)] {
            let mesh = randomly_tagged(mesh.clone(), one_in, seed);
            let mut plain = Plain::of(&mesh);
            for level in 1..=3 {
                plain = plain.refined();
                let ours = refined(&mesh, &Loop, level);
                ours.validate().unwrap();
                assert_same(&ours, &plain, &format!("{name}, {seed}, level {level}"));
            }
        }
    }
}

#[test]
fn tagged_refinement_is_the_other_implementation_s() {
    use opensubdiv_rs::{far, sdc};
    for (name, mesh) in samples() {
        for seed in 0..4 {
            let mesh = randomly_tagged(mesh.clone(), 4, seed);
            let corners = vec![3usize; mesh.face_count()];
            let tags = mesh.tags();
            let pairs: Vec<[u32; 2]> = tags.creases.iter().map(|tag| tag.vertices).collect();
            let weights: Vec<f32> = tags.creases.iter().map(|tag| tag.sharpness.min(10.0) as f32).collect();
            let vertices: Vec<u32> = tags.corners.iter().map(|tag| tag.vertex).collect();
            let heights: Vec<f32> = tags.corners.iter().map(|tag| tag.sharpness.min(10.0) as f32).collect();
            let descriptor =
                far::TopologyDescriptor::new(mesh.vertex_count(), &corners, mesh.triangles().as_flattened())
                    .with_creases(&pairs, &weights)
                    .with_corners(&vertices, &heights);
            let options = sdc::Options::default()
                .with_vtx_boundary_interpolation(sdc::VtxBoundaryInterpolation::EdgeOnly);
            let mut refiner =
                far::TopologyRefinerFactory::create(descriptor, sdc::SchemeType::Loop, options).unwrap();
            refiner.refine_uniform(far::UniformOptions::new(3));
            let primvars = far::PrimvarRefiner::new(&refiner);
            let mut theirs = mesh.positions().to_vec();
            for level in 1..=3 {
                let mut next = vec![[0.0f64; 3]; refiner.level(level).num_vertices()];
                primvars.interpolate(level, &theirs, &mut next);
                theirs = next;
            }
            let ours = refined(&mesh, &Loop, 3);
            assert_eq!(ours.vertex_count(), theirs.len(), "{name}");
            // Its weights are f32.
            let tolerance = 2e-6 * mesh.diagonal();
            for &p in ours.positions() {
                let nearest = theirs.iter().map(|&q| distance(p, q)).fold(f64::MAX, f64::min);
                assert!(nearest < tolerance, "{name}, {seed}: {p:?} is {nearest} away");
            }
        }
    }
}

#[test]
fn tags_of_sharpness_zero_change_nothing() {
    for (_, mesh) in samples() {
        let creases = mesh.triangles().iter().map(|t| CreaseTag { vertices: [t[0], t[1]], sharpness: 0.0 });
        let corners = (0..mesh.vertex_count() as u32).map(|vertex| CornerTag { vertex, sharpness: 0.0 });
        let tags = Tags { creases: creases.collect(), corners: corners.collect() };
        let tagged = mesh.clone().with_tags(tags).unwrap();
        for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
            let (with, without) = (refined(&tagged, scheme, 2), refined(&mesh, scheme, 2));
            assert_eq!((with.positions(), with.triangles()), (without.positions(), without.triangles()));
        }
    }
}
