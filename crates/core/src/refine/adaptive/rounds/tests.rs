//! Bounds that were kept, and bounds that were proven by assumption, hold when all triangles are measured in the end.

use super::super::measured::Measured;
use super::super::with_engine;
use super::*;
use crate::refine::{ExactOptions, Finish};
use limitmesh_testing::models::{book, stirred};

/// A leaf by its path below its control face.
fn leaf(path: &[usize]) -> NodeAddress {
    path.iter()
        .fold(NodeAddress::root(0), |place, &child| place.child(child))
}

#[test]
fn leaves_at_corners_are_distinguished_from_others() {
    // At a corner, the next one there is a child; adjacent to it, a sibling.
    let way = |corner: &[usize], child, is_adjacent| {
        Some(TowardsCorner {
            corner: leaf(corner),
            child,
            is_adjacent,
        })
    };
    assert_eq!(towards_corner(leaf(&[2, 2])), way(&[2, 2, 2], 2, false));
    assert_eq!(towards_corner(leaf(&[1, 1, 3])), way(&[1, 1, 1], 1, true));
    for elsewhere in [
        &[] as &[usize],
        &[3],
        &[3, 3],
        &[0, 1],
        &[0, 1, 1],
        &[0, 3, 0],
        &[2, 3, 3],
    ] {
        assert_eq!(towards_corner(leaf(elsewhere)), None, "{elsewhere:?}");
    }
}

/// Bounds of pieces at irregular vertices depend on when the search for them ends.
const MEASURED_OTHERWISE: f64 = 1.05;

/// The bounds hold those of a new measurement of all triangles; kept parts are rounded.
fn assert_holds(state: &State, anew: &[Measured], is_trusting: bool, name: &str) {
    for (face, anew) in (0..).zip(anew) {
        let found = &state.measured[face as usize];
        let greatest = |face: &Measured| [face.worst.0, face.highest.0, face.value, face.pixels];
        let holds = |(found, anew): (f64, f64)| found >= (1.0 - 1e-6) * anew;
        let mut pairs = greatest(found).into_iter().zip(greatest(anew));
        assert!(
            is_trusting || pairs.all(holds),
            "{name}, {face}: {found:?} {anew:?}"
        );
        assert!(
            !is_trusting
                || state.has_failed
                || anew.value <= MEASURED_OTHERWISE * state.goal.allowed(face),
            "{name}, {face}: {anew:?}"
        );
    }
}

#[test]
fn rounds_end_with_what_is_found_anew() {
    let sharp = |name: &str, seed| stirred(name, seed).with_creases_above(0.5).unwrap();
    for (name, mesh) in [
        ("icosphere", stirred("icosphere", 1)),
        ("torus", stirred("torus", 2)),
        ("head", stirred("head", 2)),
        ("sheet", stirred("sheet", 1)),
        ("spike", stirred("spike", 2)),
        ("cup", stirred("cup", 0)),
        ("sharp torus", sharp("torus", 1)),
        ("sharp cube", sharp("cube", 2)),
        ("book", book()),
    ] {
        let limit = 1e-3 * mesh.diagonal();
        let plain = ExactOptions::default().tolerance(limit);
        for options in [
            plain.clone(),
            plain.clone().finish(Finish::Balanced),
            plain.angle(0.2),
        ] {
            with_engine(&mesh, &options, |engine| {
                let value = engine.floor(options.goals.tolerance);
                let goal = if engine.is_balanced {
                    Goal::Balanced(value)
                } else {
                    Goal::Within(value)
                };
                let found = engine.refined(goal, usize::MAX)?.unwrap();
                let faces: Vec<u32> = (0..found.state.faces()).collect();
                let look = Look {
                    goal: &found.state.goal,
                    divided_above: 0,
                    length: if engine.trusts() { 0.0 } else { f64::INFINITY },
                    changes: None,
                    bulges: engine.is_balanced.then_some(&found.state.bulges),
                    trusted: &[],
                };
                let sources = engine.sources(&found.state, &found.emission);
                let anew = measure(&sources, engine.watch, &faces, &look)?;
                assert_holds(&found.state, &anew, engine.trusts(), name);
                Ok(())
            })
            .unwrap();
        }
    }
}

/// Where levels end the division, leaves fail for good. Nobody counts on proven leaves around which the triangles do not keep what these assume.
#[test]
fn proven_leaves_are_checked_where_levels_end() {
    let mut failed = 0;
    for (name, seed) in [("spike", 2), ("head", 2), ("shoe", 1), ("cup", 3)] {
        let mesh = stirred(name, seed);
        for (levels, share) in [(1, 3e-3), (2, 1e-3), (3, 3e-4)] {
            let options = ExactOptions::default()
                .tolerance(share * mesh.diagonal())
                .max_levels(levels);
            with_engine(&mesh, &options, |engine| {
                let goal = Goal::Within(engine.floor(options.goals.tolerance));
                let Verified { state, .. } = engine.refined(goal, usize::MAX)?.unwrap();
                failed += usize::from(state.has_failed);
                for face in 0..state.faces() {
                    assert!(
                        !state.is_trusted[face as usize] || is_kept(engine.control, &state, face),
                        "{name}, {levels} levels, face {face}"
                    );
                }
                Ok(())
            })
            .unwrap();
        }
    }
    assert!(failed > 6, "{failed}");
}
