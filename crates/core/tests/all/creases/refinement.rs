//! Uniform refinement of tagged meshes.

use limitmesh::Mesh;
use limitmesh::mesh::Tags;
use limitmesh::scheme::{Loop, ModifiedButterfly, Scheme};

use crate::creases::plain::{Plain, randomly_tagged};
use crate::opensubdiv;
use crate::support::*;

fn refined(mesh: &Mesh, scheme: &dyn Scheme, levels: usize) -> Mesh {
    divided(mesh, scheme, levels)
}

/// Checks that two meshes have the same triangles between the same points.
fn assert_same(ours: &Mesh, plain: &Plain, name: &str) {
    let nearest = |p: &Point| {
        let near = |v: &usize| distance(*p, plain.positions[*v]);
        let v = (0..plain.positions.len())
            .min_by(|a, b| near(a).total_cmp(&near(b)))
            .unwrap();
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
    let renumbered = ours
        .triangles()
        .iter()
        .map(|t| t.map(|v| number[v as usize]))
        .collect();
    assert!(
        sorted(renumbered) == sorted(plain.triangles.clone()),
        "{name}"
    );
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

fn check_against_other(name: &str, mesh: &Mesh, levels: usize) {
    let ours = refined(mesh, &Loop, levels);
    let theirs = opensubdiv::of_mesh(mesh, levels);
    opensubdiv::assert_same_points(name, ours.positions(), &theirs, mesh.diagonal());
}

#[test]
fn tagged_refinement_is_the_other_implementation_s() {
    for (name, mesh) in samples() {
        for seed in 0..4 {
            check_against_other(
                &format!("{name}, {seed}"),
                &randomly_tagged(mesh.clone(), 4, seed),
                3,
            );
        }
    }
}

#[test]
fn the_shared_models_with_tags_are_the_other_implementation_s() {
    let Some(folder) = shared_models() else {
        return;
    };
    let models = [
        ("mechpart_creased.obj", 113, 3),
        ("rook_creased.obj", 280, 2),
        ("loop_icos_semisharp.obj", 15, 4),
    ];
    for (name, creases, levels) in models {
        let mesh = shared_model(&folder, name);
        assert_eq!(mesh.tags().creases.len(), creases);
        check_against_other(name, &mesh, levels);
    }
}

#[test]
fn tags_of_sharpness_zero_change_nothing() {
    for (_, mesh) in samples() {
        let creases = mesh.triangles().iter().map(|t| crease([t[0], t[1]], 0.0));
        let corners = (0..mesh.vertex_count() as u32).map(|vertex| corner(vertex, 0.0));
        let tags = Tags {
            creases: creases.collect(),
            corners: corners.collect(),
        };
        let tagged = mesh.clone().with_tags(tags).unwrap();
        for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
            let (with, without) = (refined(&tagged, scheme, 2), refined(&mesh, scheme, 2));
            assert_eq!(
                (with.positions(), with.triangles()),
                (without.positions(), without.triangles())
            );
        }
    }
}
