//! Closing again what was split comes to the same as a walk over whole faces of which nothing is known.

use super::super::chains::Inserted;
use super::super::demands::Demands;
use super::super::dirty::Dirty;
use super::super::{Engine, with_engine};
use super::judged::in_walks_order;
use super::*;
use crate::models::{book, stirred};
use crate::progress::unobserved;
use crate::random::Random;
use crate::refine::ExactOptions;
use crate::scheme::Loop;

#[test]
fn faces_closed_again_are_as_if_closed_whole() {
    let models = [
        ("icosphere", 5),
        ("torus", 6),
        ("sheet", 8),
        ("head", 9),
        ("spike", 10),
        ("cup", 3),
        ("book", 1),
    ];
    let coarse = models.map(|(name, seed)| (name, seed, 3e-3, 1.0));
    // Beside faces that are divided by a level more, even ones are closed on several sides: these are walked over row by row.
    let uneven = [
        ("torus", 4, 3e-4, 0.22),
        ("sphere", 4, 1e-4, 0.22),
        ("cup", 4, 1e-4, 0.22),
    ];
    let (mut again, mut judged, mut in_rows) = (0, 0, 0);
    for (name, seed, tolerance, share) in coarse.into_iter().chain(uneven) {
        let mesh = if name == "book" {
            book()
        } else {
            stirred(name, seed)
        };
        let tolerance = tolerance * mesh.diagonal();
        let options = ExactOptions::default().tolerance(tolerance);
        with_engine(
            &mesh,
            &Loop,
            (&options, &Demands::default()),
            &mut unobserved,
            |engine| {
                let faces = engine.control.mesh.face_count();
                let is_finer = (0..faces)
                    .map(|face| face % 5 < 2 || face % 7 == 0)
                    .collect();
                let goal = Goal::Partly(tolerance, share * tolerance, is_finer);
                let mut plan = engine.plan(goal, usize::MAX)?.unwrap();
                let mut random = Random::new(seed);
                for round in 0..12 {
                    let mut dirty = Dirty::none(plan.closed.len());
                    for _ in 0..1 + plan.closed.len() / 30 {
                        let mut place = Place::root(random.below(plan.closed.len()) as u32);
                        // Of two times one beside a leaf that closes gaps, where there are any.
                        let known = plan.closed[place.face as usize].known();
                        if let Some(parent) = known
                            .get(random.below(2 * known.len() + 1))
                            .and_then(|leaf| leaf.place.parent())
                        {
                            place = parent;
                        }
                        let trees = &plan.decision.trees;
                        while trees.word_at(place).is_some_and(is_split) {
                            place = place.child(random.below(4));
                        }
                        if round % 3 == 2 {
                            plan.decision.trees.make_strict(place);
                        }
                        engine.split(&mut plan.decision.trees, place, &mut dirty)?;
                        // Now and then by more levels at once.
                        for _ in 0..random.below(3) {
                            place = place.child(random.below(4));
                            engine.split(&mut plan.decision.trees, place, &mut dirty)?;
                        }
                    }
                    let faces = dirty.faces();
                    assert!(engine.carry_out(&mut plan, dirty, usize::MAX)?);
                    let Engine {
                        control,
                        max_levels,
                        ..
                    } = *engine;
                    let (trees, chains, edges) =
                        (&plan.decision.trees, &plan.chains, &engine.edges);
                    let closing = Closing {
                        control,
                        goal: &plan.goal,
                        max_levels,
                        edges,
                        trees,
                        chains,
                    };
                    let all = Inserted {
                        anew: (0..3 * plan.closed.len() as u32).collect(),
                        at: Vec::new(),
                    };
                    let known = (&Chains::default(), &all);
                    assert_eq!(
                        *chains,
                        Chains::of(control.mesh, edges, trees, known, engine.watch)?,
                        "{name}"
                    );
                    let mut knots = Vec::new();
                    for face in 0..plan.closed.len() as u32 {
                        let known = (plan.decision.allowance(face), &Closed::default());
                        let (whole, _) = closing.close(face, known, &|| false, &mut knots);
                        let found = &plan.closed[face as usize];
                        let counts = |closed: &Closed| (closed.vertices, closed.triangles);
                        assert_eq!(counts(found), counts(&whole), "{name}, face {face}");
                        assert!(found.is_as(&whole), "{name}, face {face}");
                        let extent = |closed: &Closed| {
                            closed.extent().map(|own| (own.bound, own.tilt, own.worst))
                        };
                        assert_eq!(extent(found), extent(&whole), "{name}, face {face}");
                        judged += whole.known().len();
                        let in_order =
                            |a: &&Judged, b: &&Judged| a.place.in_order(&b.place).is_lt();
                        in_rows += usize::from(
                            !in_walks_order(whole.known(), trees).is_sorted_by(in_order),
                        );
                    }
                    again += faces.len();
                }
                Ok(())
            },
        )
        .unwrap();
    }
    assert!(
        again > 500 && judged > 10_000 && in_rows > 500,
        "{again}, {judged}, {in_rows}"
    );
}
