//! Exact refinement with its edges collapsed, on the shared models and at caps, judged by distances that are enclosed anew.

#![allow(clippy::unwrap_used)]

use crate::flat::washer;
use crate::support::{enclosed, exact, model, shared_model, shared_models, within};
use limitmesh::Mesh;
use limitmesh::measure::{CertifiedOptions, SamplingOptions, hausdorff};
use limitmesh::refine::{Exact, ExactOptions, ExactStop, Finish, exact_estimate, limit_reference};
use limitmesh::scheme::Loop;

fn simplified(control: &Mesh, options: ExactOptions) -> Exact {
    exact(control, &Loop, &options.finish(Finish::Collapsed)).unwrap()
}

/// Checks the interval of a result by a mesh much nearer to the limit surface.
fn check_interval(control: &Mesh, result: &Exact) {
    let nearer = exact(control, &Loop, &within(0.2 * result.error.upper)).unwrap();
    let options = CertifiedOptions::default();
    let enclosed = enclosed(&result.mesh, &nearer.mesh, &options);
    let enclosed = enclosed.widened(nearer.error.upper);
    assert!(enclosed.lower() <= result.error.upper);
    assert!(result.error.lower <= enclosed.upper());
}

#[test]
fn a_cap_holds_for_the_result() {
    let control = model("cup");
    let tolerance = 0.002 * control.diagonal();
    let free = simplified(&control, within(tolerance));
    assert_eq!(free.stop, ExactStop::Met);
    check_interval(&control, &free);
    let count = free.mesh.face_count();
    // It fits, though the finer mesh that it comes from does not.
    let fitting = simplified(&control, within(tolerance).max_triangles(Some(count + 100)));
    assert_eq!(
        (fitting.stop, fitting.mesh == free.mesh),
        (ExactStop::Met, true)
    );
    let capped = simplified(&control, within(tolerance).max_triangles(Some(count / 2)));
    assert_eq!(capped.stop, ExactStop::TriangleCap);
    let below = ExactOptions::default()
        .finish(Finish::Collapsed)
        .triangles(count)
        .max_triangles(Some(count / 2));
    let below = exact(&control, &Loop, &below).unwrap();
    assert_eq!(below.stop, ExactStop::TriangleCap);
    assert!(below.mesh.face_count() <= count / 2);
    assert!((count / 2 - 1..=count / 2).contains(&capped.mesh.face_count()));
    assert!(capped.error.upper > tolerance);
    check_interval(&control, &capped);
}

/// With a tolerance whichever is reached first ends it: the tolerance with as few triangles as without the number, or the number.
#[test]
fn a_number_of_triangles_holds_within_a_tolerance_too() {
    let control = model("bunny");
    for (share, number) in [(0.01, 5000), (0.001, 2000), (1e-5, 2000)] {
        let tolerance = share * control.diagonal();
        let found = simplified(&control, within(tolerance).triangles(number));
        check_interval(&control, &found);
        let count = found.mesh.face_count();
        assert!(count <= number, "{number} within {share}: {count}");
        if share == 0.01 {
            let free = simplified(&control, within(tolerance));
            assert_eq!(
                (found.stop, found.mesh == free.mesh),
                (ExactStop::Met, true)
            );
        } else {
            assert_eq!(found.stop, ExactStop::Triangles);
            at_least!(count + 2, number, "{share}");
            above!(found.error.upper, tolerance, "{share}");
        }
    }
}

#[test]
fn it_takes_no_more_triangles_than_refinement_alone() {
    for (name, shares) in [
        ("bunny", [0.01, 0.003, 0.001]),
        ("cusp", [0.01, 0.003, 0.0005]),
        ("icosphere", [0.003, 0.001, 0.0003]),
    ] {
        let mut control = model(name);
        if name == "icosphere" {
            // At semi-sharp edges hardly any can be collapsed.
            let topology = control.topology();
            let edges = topology
                .half_edges()
                .filter(|&h| topology.twin(h).is_some_and(|twin| h.0 < twin.0));
            let crease = |h| crate::support::crease(topology.ends(h).map(|v| v.0), 2.4);
            let creases = edges.step_by(3).map(crease).collect();
            control = control
                .clone()
                .with_tags(crate::support::creases(creases))
                .unwrap();
        }
        for share in shares {
            let tolerance = share * control.diagonal();
            let plain = exact(&control, &Loop, &within(tolerance)).unwrap();
            let result = simplified(&control, within(tolerance));
            assert_eq!(result.stop, ExactStop::Met);
            assert!(result.error.upper <= tolerance);
            let (count, plain) = (result.mesh.face_count(), plain.mesh.face_count());
            assert!(count <= plain, "{name} at {share}: {count}, alone {plain}");
        }
    }
}

#[test]
fn estimates_come_near() {
    for (name, shares) in [
        ("cup", [0.003, 0.0008]),
        ("bunny", [0.003, 0.0008]),
        ("shoe", [0.01, 0.0015]),
    ] {
        let control = model(name);
        for share in shares {
            let options = within(share * control.diagonal()).finish(Finish::Collapsed);
            let expected = exact_estimate(&control, &Loop, &options).unwrap();
            let found = exact(&control, &Loop, &options).unwrap().mesh.face_count();
            let ratio = expected.triangles as f64 / found as f64;
            assert!(
                (1.0 / 1.3..1.3).contains(&ratio),
                "{name} at {share}: {expected:?} for {found}"
            );
        }
    }
}

/// The greatest distance that dense points find, either way, between a mesh and one of uniform refinement, which knows nothing of collapses.
fn sampled(mesh: &Mesh, reference: &Mesh) -> f64 {
    let samples = SamplingOptions::default().samples(60_000);
    hausdorff(mesh.as_triangles(), reference.as_triangles(), &samples)
        .unwrap()
        .symmetric()
}

/// On flat faces collapses cost exactly nothing. They are proven like others: without a bound the result would be that of refinement alone.
#[test]
fn parts_lose_triangles_too() {
    let control = washer(6, false);
    let reference = limit_reference(&control, &Loop, 6).unwrap();
    let chords = sampled(&limit_reference(&control, &Loop, 5).unwrap(), &reference);
    for share in [2e-3, 1e-3, 5e-4] {
        let tolerance = share * control.diagonal();
        let plain = exact(&control, &Loop, &within(tolerance)).unwrap();
        let result = simplified(&control, within(tolerance));
        let counts = [&result, &plain].map(|found| found.mesh.face_count());
        assert!(2 * counts[0] <= counts[1], "{share}: {counts:?}");
        let found = sampled(&result.mesh, &reference);
        assert_eq!(result.stop, ExactStop::Met);
        at_most!(result.error.upper, tolerance);
        at_most!(found, result.error.upper + chords);
    }
}

/// Collapses use the whole tolerance: points of the surface are nearly as far from the mesh as
/// allowed.
#[test]
fn little_of_the_tolerance_is_left() {
    for (name, share, levels) in [("bunny", 2e-3, 3), ("cup", 1e-3, 4), ("head", 3e-3, 4)] {
        let control = model(name);
        let reference = limit_reference(&control, &Loop, levels).unwrap();
        let tolerance = share * control.diagonal();
        let result = simplified(&control, within(tolerance));
        let found = sampled(&result.mesh, &reference);
        assert!(
            (0.8..=1.0).contains(&(found / tolerance)),
            "{name}: {found} of {tolerance}"
        );
    }
}

#[test]
fn triangles_fall_with_the_tolerance_on_a_scanned_mesh() {
    let Some(folder) = shared_models() else {
        return;
    };
    let control = shared_model(&folder, "bunny_3674.obj");
    let mut before = usize::MAX;
    for percent in [0.05, 0.055, 0.06, 0.07] {
        let tolerance = 0.01 * percent * control.diagonal();
        let result = simplified(&control, within(tolerance));
        assert!(result.error.upper <= tolerance);
        let count = result.mesh.face_count();
        at_most!(count as f64, 1.05 * before as f64, "{percent}");
        let plain = exact(&control, &Loop, &within(tolerance))
            .unwrap()
            .mesh
            .face_count();
        below!(count, plain * 4 / 5, "{percent}");
        before = count;
    }
}
