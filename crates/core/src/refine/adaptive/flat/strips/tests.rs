//! The test by adjacent vertices lets all faces through over which the surface is straight.

use super::*;
use crate::refine::ExactOptions;
use crate::refine::adaptive::with_engine;
use limitmesh_testing::models::stirred;

/// For each face the least distance within which its derivative along an edge is one, by halving what [`has_direction`] reports of the whole
/// net, lets it through; a much lesser one does not let through all.
#[test]
fn what_has_a_direction_may_have_one() {
    let (mut regular, mut told) = (0, 0);
    for (name, seed) in [
        ("torus", 1),
        ("torus", 2),
        ("sheet", 3),
        ("head", 4),
        ("cup", 5),
        ("shoe", 6),
    ] {
        let mesh = stirred(name, seed);
        let options = ExactOptions::default().tolerance(1e-2);
        with_engine(&mesh, &options, |engine| {
            let (control, size) = (engine.control, mesh.diagonal());
            for face in 0..mesh.face_count() as u32 {
                if !matches!(control.patch(face), Patch::Regular(_)) {
                    continue;
                }
                let (mut low, mut high) = (0.0, size);
                assert!(has_direction(control, face, high), "{name}, face {face}");
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    match has_direction(control, face, middle) {
                        true => high = middle,
                        false => low = middle,
                    }
                }
                assert!(
                    may_have_direction(control, face, high),
                    "{name}, face {face}"
                );
                regular += 1;
                told += usize::from(!may_have_direction(control, face, 0.01 * high));
            }
            Ok(())
        })
        .unwrap();
    }
    assert!(regular > 500 && told > regular / 2, "{told} of {regular}");
}
