//! Closing again what was split comes to the same as a walk over whole faces of which nothing is known.

use super::super::demands::Demands;
use super::super::dirty::Dirty;
use super::super::{Engine, with_engine};
use super::*;
use crate::models::stirred;
use crate::progress::unobserved;
use crate::refine::ExactOptions;
use crate::scheme::Loop;

#[test]
fn faces_closed_again_are_as_if_closed_whole() {
    let models = [("icosphere", 5), ("torus", 6), ("sheet", 8), ("head", 9), ("spike", 10), ("cup", 3)];
    let coarse = models.map(|(name, seed)| (name, seed, 3e-3));
    // Divided more deeply many nodes are walked over row by row.
    let fine = [("shoe", 0, 1e-4), ("bunny", 0, 1e-4), ("torus", 5, 1e-4)];
    let (mut again, mut judged) = (0, 0);
    for (name, seed, tolerance) in coarse.into_iter().chain(fine) {
        let mesh = stirred(name, seed);
        let tolerance = tolerance * mesh.diagonal();
        let options = ExactOptions::default().tolerance(tolerance);
        with_engine(&mesh, &Loop, (&options, &Demands::default()), &mut unobserved, |engine| {
            let mut plan = engine.plan(Goal::Within(tolerance), usize::MAX)?.unwrap();
            let mut state = seed;
            for round in 0..12 {
                let mut next = |below: usize| {
                    state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    (state >> 33) as usize % below
                };
                let mut dirty = Dirty::none(plan.closed.len());
                for _ in 0..1 + plan.closed.len() / 30 {
                    let mut place = Place::root(next(plan.closed.len()) as u32);
                    let mut word = plan.decision.trees.root(place.face);
                    while is_split(word) {
                        let child = next(4);
                        (word, place) = (plan.decision.trees.child(word, child), place.child(child));
                    }
                    if round % 3 == 2 {
                        plan.decision.trees.make_strict(place);
                    }
                    engine.split(&mut plan.decision.trees, place, &mut dirty)?;
                    // Now and then by more levels at once.
                    for level in 0..next(3) {
                        place = place.child((level + next(4)) % 4);
                        engine.split(&mut plan.decision.trees, place, &mut dirty)?;
                    }
                }
                let faces = dirty.faces();
                assert!(engine.carry_out(&mut plan, dirty, usize::MAX)?);
                let Engine { control, max_levels, .. } = *engine;
                let (trees, chains, edges) = (&plan.decision.trees, &plan.chains, &engine.edges);
                let closing = Closing { control, goal: &plan.goal, max_levels, edges, trees, chains };
                let mut knots = Vec::new();
                for face in 0..plan.closed.len() as u32 {
                    let known = (plan.decision.allowance(face), &Closed::default());
                    let whole = closing.close(face, known, &|| false, &mut knots);
                    let found = &plan.closed[face as usize];
                    let counts = |closed: &Closed| (closed.vertices, closed.triangles);
                    assert_eq!(counts(found), counts(&whole), "{name}, face {face}");
                    assert!(found.is_as(&whole), "{name}, face {face}");
                    let extent =
                        |closed: &Closed| closed.extent().map(|own| (own.bound, own.tilt, own.worst));
                    assert_eq!(extent(found), extent(&whole), "{name}, face {face}");
                    judged += whole.known().len();
                }
                again += faces.len();
            }
            Ok(())
        })
        .unwrap();
    }
    assert!(again > 500 && judged > 10_000, "{again}, {judged}");
}
