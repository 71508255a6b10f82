//! Exact refinement where pieces have no simple form: semi-sharp tags, and schemes outside Loop's
//! family.

#![allow(clippy::unwrap_used)]

use crate::support::{
    Random, exact, model, octahedron, pool, sampled, shared_model, shared_models, tagged_by,
    tagged_obj, vertices_are_of_uniform_refinement, within,
};
use limitmesh::Mesh;
use limitmesh::refine::limit_reference;
use limitmesh::refine::{ExactOptions, ExactStop, Finish};
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};

/// Tags on about a fifth of the edges and a tenth of the vertices, most of them semi-sharp.
fn tagged(mesh: Mesh, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    tagged_by(mesh, [5, 10], |one_in| {
        let (is_tagged, lasts) = (random.below(one_in) == 0, random.below(10) == 0);
        let fading = 2.5 + 2.2 * random.signed();
        is_tagged.then_some(if lasts { f64::INFINITY } else { fading })
    })
}

fn named(name: &str) -> Mesh {
    match name {
        "octahedron" => octahedron(),
        name => model(name),
    }
}

/// The greatest distance found between a refined mesh and the limit surface.
fn off(control: &Mesh, scheme: &dyn Scheme, mesh: &Mesh, levels: usize) -> f64 {
    sampled(
        mesh,
        &limit_reference(control, scheme, levels).unwrap(),
        25_000,
    )
}

/// Refinement to a share of the size is certified, as samples of so many levels have it, too.
fn is_followed(control: &Mesh, scheme: &dyn Scheme, share: f64, levels: usize, name: &str) {
    let tolerance = share * control.diagonal();
    let result = exact(control, scheme, &within(tolerance)).unwrap();
    result.mesh.validate().unwrap();
    assert_eq!(result.stop, ExactStop::Met);
    assert!(result.error.certified, "{name}");
    at_most!(result.error.upper, tolerance, "{name}");
    vertices_are_of_uniform_refinement(control, scheme, &result, name);
    let found = off(control, scheme, &result.mesh, levels);
    // The reference's own chords leave the surface by less than this.
    at_most!(found, result.error.upper + 0.05 * tolerance, "{name}");
}

#[test]
fn fading_tags_are_followed_to_the_limit() {
    for (seed, name) in ["tetrahedron", "cube", "octahedron", "spike", "sheet"]
        .into_iter()
        .enumerate()
    {
        for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
            let control = tagged(named(name), seed as u64 + 1);
            is_followed(&control, scheme, 0.004, 5, name);
        }
    }
}

#[test]
fn tags_that_fade_leave_no_crease() {
    let control = tagged(octahedron(), 3);
    let result = exact(&control, &Loop, &within(0.01)).unwrap();
    let lasting = control
        .tags()
        .creases
        .iter()
        .filter(|tag| tag.sharpness.is_infinite())
        .count();
    assert_eq!(result.mesh.tags().creases.is_empty(), lasting == 0);
    assert!(
        result
            .mesh
            .tags()
            .creases
            .iter()
            .all(|tag| tag.sharpness.is_infinite())
    );
}

#[test]
fn butterfly_passes_through_the_control_vertices_and_its_limit() {
    for name in ["tetrahedron", "cube", "sheet", "spike", "sphere", "teddy"] {
        let control = named(name);
        let tolerance = 0.01 * control.diagonal();
        let scheme = &ModifiedButterfly;
        let result = exact(&control, scheme, &within(tolerance)).unwrap();
        result.mesh.validate().unwrap();
        assert_eq!(result.stop, ExactStop::Met, "{name}");
        assert!(!result.error.certified);
        assert_eq!(
            &result.mesh.positions()[..control.vertex_count()],
            control.positions(),
            "{name}"
        );
        vertices_are_of_uniform_refinement(&control, scheme, &result, name);
        let found = off(&control, scheme, &result.mesh, 4);
        assert!(result.error.lower <= result.error.upper);
        assert!(
            (0.85..1.05).contains(&(found / result.error.upper)),
            "{name}: {found} of {:?}",
            result.error
        );
    }
}

#[test]
fn tagged_butterfly_meshes_are_refined_too() {
    for (seed, name) in ["cube", "octahedron", "sheet"].into_iter().enumerate() {
        let control = tagged(named(name), seed as u64 + 7);
        let scheme = &ModifiedButterfly;
        let tolerance = 0.01 * control.diagonal();
        let result = exact(&control, scheme, &within(tolerance)).unwrap();
        result.mesh.validate().unwrap();
        vertices_are_of_uniform_refinement(&control, scheme, &result, name);
    }
}

#[test]
fn budgets_hold_for_butterfly() {
    let control = model("cube");
    let options = ExactOptions::default().triangles(400);
    let result = exact(&control, &ModifiedButterfly, &options).unwrap();
    let count = result.mesh.face_count();
    assert!((340..=400).contains(&count), "{count}");
}

#[test]
fn normals_are_those_of_the_limit() {
    let control = tagged(octahedron(), 5);
    for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
        let result = exact(&control, scheme, &within(0.02)).unwrap();
        let expected = limitmesh::limit::LimitTable::new(scheme)
            .normals(&control)
            .unwrap();
        assert_eq!(&result.normals[..control.vertex_count()], &expected[..]);
        let lengths = result
            .normals
            .iter()
            .map(|n| n.iter().map(|x| x * x).sum::<f64>());
        assert!(
            lengths
                .into_iter()
                .all(|square| square == 0.0 || (square - 1.0).abs() < 1e-9)
        );
    }
}

#[test]
fn threads_change_nothing() {
    let tagged = tagged(model("sheet"), 11);
    let plain = model("cube");
    let run = || {
        let options = |control: &Mesh| within(0.01 * control.diagonal());
        let loop_result = exact(&tagged, &Loop, &options(&tagged)).unwrap();
        let butterfly = exact(&plain, &ModifiedButterfly, &options(&plain)).unwrap();
        [loop_result, butterfly].map(|found| (found.mesh, found.normals, found.error))
    };
    assert!(pool(1).install(run) == pool(3).install(run));
}

/// A triangle of 1e-29 whose sides are semi-sharp over ten levels: a hundred times as long as it is
/// wide.
const NEEDLE: &str = "
v 9.881072525791189e-30 0.0 0.0
v 1.4269167202302316e-31 -5.094112858583294e-31 0.0
v 0.0 0.0 1.6636115550843632e-31
f 1 2 3
t crease 2/1/0 0 1 10.0
t crease 2/1/0 0 2 10.0
t crease 2/1/0 1 2 10.0
t corner 1/1/0 0 1.0
t corner 1/1/0 2 1.0
t corner 1/1/0 1 10.0
";

/// Pieces whose surroundings are of one kind share their weights, so that thousands of triangles come at once where nothing is certain, too.
#[test]
fn schemes_without_proofs_come_to_an_end() {
    let control = tagged_obj(NEEDLE);
    let found = exact(
        &control,
        &ModifiedButterfly,
        &ExactOptions::default()
            .triangles(40)
            .finish(Finish::Collapsed),
    )
    .unwrap();
    found.mesh.validate().unwrap();
    assert_eq!(found.mesh.face_count(), 40);
    let greatest = off(&control, &ModifiedButterfly, &found.mesh, 7);
    at_most!(greatest, 1.1 * found.error.upper);
}

#[test]
fn shared_models_with_fading_creases_are_followed() {
    let Some(folder) = shared_models() else {
        return;
    };
    for (name, levels) in [("loop_icos_semisharp.obj", 6), ("rook_creased.obj", 4)] {
        let control = shared_model(&folder, name);
        is_followed(&control, &Loop, 0.001, levels, name);
    }
}
