//! What is looked at alone comes to what it comes to among all triangles, what is settled holds in the end, and what is taken over is what
//! would be written.

use super::super::chains::Chains;
use super::super::chains::Inserted;
use super::super::demands::Demands;
use super::super::judge::{Allowance, Extent, Seen};
use super::super::quadtree::{CONDITIONAL, LEAF, Piece, is_split};
use super::super::with_engine;
use super::*;
use crate::certificate::Deviation;
use crate::models::stirred;
use crate::patch::LimitPoint;
use crate::progress::unobserved;
use crate::refine::ExactOptions;
use crate::scheme::Loop;

/// Runs on the plans of some stirred models.
fn with_plans(models: &[(&str, u64)], mut run: impl FnMut(&Engine<'_>, Plan, &str)) {
    for &(name, seed) in models {
        let mesh = stirred(name, seed);
        let tolerance = 10f64.powf(-0.5 - 0.13 * (seed % 20) as f64) * mesh.diagonal();
        let options = ExactOptions::default().tolerance(tolerance);
        with_engine(
            &mesh,
            &Loop,
            (&options, &Demands::default()),
            &mut unobserved,
            |engine| {
                let plan = engine.plan(Goal::Within(tolerance), usize::MAX)?.unwrap();
                run(engine, plan, &format!("{name}, seed {seed}"));
                Ok(())
            },
        )
        .unwrap();
    }
}

/// By control face, what is known of its conditions: nothing, or the greatest bound and its leaf.
type Known = Vec<Option<Option<(f64, Place)>>>;

/// The leaves that fail in what was emitted, and what is found of each face, where nothing is known.
fn found_in(engine: &Engine<'_>, plan: &Plan, emission: &Emission) -> (Vec<(Place, f64)>, Known) {
    let mut settled = SettledFaces::none(plan.closed.len());
    let failing = failing(emission, &plan.goal, &mut settled, engine.watch).unwrap();
    let known = (0..settled.faces()).map(|face| settled.has(face).then(|| settled.worst(face)));
    (failing, known.collect())
}

/// The same in all that is emitted.
fn looked_at_all(engine: &Engine<'_>, plan: &mut Plan) -> (Vec<(Place, f64)>, Known) {
    plan.emission = None;
    let emission = engine.emit_all(plan).unwrap();
    found_in(engine, plan, &emission)
}

/// Runs on the plans of some stirred models before any condition was looked at.
fn with_unsettled(count: u64, mut run: impl FnMut(&Engine<'_>, Plan, &str)) {
    let names = [
        "icosphere",
        "torus",
        "sheet",
        "bumpy",
        "spike",
        "head",
        "cup",
        "shoe",
    ];
    for seed in 0..count {
        let (name, seed) = (names[seed as usize % names.len()], 7 * seed);
        let mesh = stirred(name, seed);
        let tolerance = 10f64.powf(-2.0 - 0.13 * (seed % 20) as f64) * mesh.diagonal();
        let options = ExactOptions::default().tolerance(tolerance);
        with_engine(
            &mesh,
            &Loop,
            (&options, &Demands::default()),
            &mut unobserved,
            |engine| {
                let (goal, control) = (Goal::Within(tolerance), (engine.control, engine.watch));
                let decision = super::super::decide::decide(
                    control,
                    &goal,
                    &engine.edges,
                    engine.max_levels,
                    usize::MAX,
                )?;
                let faces = mesh.face_count();
                let mut plan = Plan::of(goal, decision.unwrap(), faces);
                engine.carry_out(&mut plan, Dirty::all(faces), usize::MAX)?;
                plan.settled = SettledFaces::none(faces);
                run(engine, plan, &format!("{name}, seed {seed}"));
                Ok(())
            },
        )
        .unwrap();
    }
}

/// What is looked at alone comes to what it comes to among all triangles, in plans that do not hold, too.
#[test]
fn areas_tell_what_all_triangles_tell() {
    let (mut plans, mut failed, mut looked_at, mut all) = (0, 0, 0, 0);
    with_unsettled(64, |engine, mut plan, name| {
        let areas = engine.conditional(&plan).unwrap();
        let look = |scope| {
            let part = engine.emit_some(&plan, scope).unwrap();
            let found = found_in(engine, &plan, &part);
            (part, found)
        };
        let (part, found) = look(Scope::Areas(&areas));
        let (_, in_faces) = look(Scope::Faces(&areas));
        let expected = looked_at_all(engine, &mut plan);
        plans += usize::from(!areas.0.is_empty());
        failed += expected.0.len();
        assert!(
            expected.0.iter().all(|(_, bound)| bound.is_finite()),
            "{name}"
        );
        assert_eq!((&found, &in_faces), (&expected, &expected), "{name}");
        looked_at += part
            .triangles
            .iter()
            .filter(|&&triangle| triangle != [0; 3])
            .count();
        all += plan.triangles;
    });
    assert!(
        plans > 30 && failed > 100 && looked_at < all,
        "{plans}, {failed}, {looked_at} of {all}"
    );
}

/// A half-edge beyond which nothing was emitted has no twin that is known, and is not open either.
#[test]
fn triangles_that_lack_a_neighbour_are_told() {
    let (mut known, mut told, mut open) = (0, 0, 0);
    with_unsettled(24, |engine, mut plan, name| {
        let mut areas = engine.conditional(&plan).unwrap();
        areas.0.retain(|face, _| face % 2 == 0);
        plan.emission = None;
        let full = engine.emit_all(&mut plan).unwrap();
        let in_areas = engine.emit_some(&plan, Scope::Areas(&areas)).unwrap();
        let in_faces = engine.emit_some(&plan, Scope::Faces(&areas)).unwrap();
        plan.emission = Some(full);
        let kept = engine.emit_some(&plan, Scope::Faces(&areas)).unwrap();
        let full = plan.emission.as_ref().unwrap();
        // A half-edge by its control face and its number there.
        let local = |emission: &Emission, h: u32| {
            let face = emission.starts.partition_point(|&start| start <= h / 3) - 1;
            (face, h - 3 * emission.starts[face])
        };
        let nobody = HashSet::new();
        for part in [&in_areas, &in_faces, &kept] {
            let conditions = part
                .conditions
                .iter()
                .filter(|(_, first, last)| first < last);
            for h in conditions.flat_map(|&(_, first, last)| 3 * first..3 * last) {
                let (face, own) = local(part, h);
                let whole = 3 * full.starts[face] + own;
                let expected = beyond(full, &nobody, whole);
                match beyond(part, &nobody, h) {
                    None => {
                        assert_eq!(expected, None, "{name}, face {face}, half-edge {own}");
                        open += 1;
                    }
                    Some(twin) if part.is_known(h, twin) => {
                        let expected = expected.unwrap();
                        assert_eq!(
                            local(part, twin),
                            local(full, expected),
                            "{name}, face {face}"
                        );
                        assert_eq!(
                            corners(part, twin / 3),
                            corners(full, expected / 3),
                            "{name}"
                        );
                        known += 1;
                    }
                    Some(_) => {
                        assert!(expected.is_some(), "{name}, face {face}, half-edge {own}");
                        told += 1;
                    }
                }
            }
        }
    });
    assert!(
        known > 1000 && told > 100 && open > 10,
        "{known}, {told}, {open}"
    );
}

/// What is known of conditions is what they come to in the end: divisions change the triangles beside closing ones too,
/// in faces that are not beside the divided one.
#[test]
fn what_is_settled_holds_among_the_triangles_that_are_emitted() {
    let models = [
        ("icosphere", 219),
        ("icosphere", 378),
        ("torus", 19),
        ("torus", 115),
        ("sheet", 218),
        ("bumpy", 94),
        ("spike", 39),
        ("spike", 294),
        ("head", 258),
    ];
    let mut counted = 0;
    with_plans(&models, |engine, mut plan, name| {
        let (failing, found) = looked_at_all(engine, &mut plan);
        assert!(failing.is_empty(), "{name}: {failing:?}");
        for (face, found) in (0..).zip(found) {
            let (found, known) = (
                found.flatten().map_or(0.0, |(bound, _)| bound),
                plan.settled.bound(face),
            );
            assert!(found <= known, "{name}: {found} is settled as {known}");
            counted += usize::from(found > 0.0);
        }
    });
    assert!(counted > 100, "{counted}");
}

/// What the triangles of a plan count on of those beside them, and whether what passes on conditions does so.
fn assert_holds(engine: &Engine<'_>, plan: &mut Plan, name: &str) {
    let (failing, _) = looked_at_all(engine, plan);
    assert!(failing.is_empty(), "{name}: {failing:?}");
    let emission = engine.emit_all(plan).unwrap();
    let sharp = sharp_edges(&emission, engine.watch).unwrap();
    for face in 0..plan.closed.len() as u32 {
        let extent = plan.decision.extent(face);
        let allowance = *plan.decision.allowance(face);
        if allowance == Allowance::NOTHING {
            continue;
        }
        let closing = plan.closed[face as usize]
            .extent()
            .copied()
            .unwrap_or(Extent::NONE);
        let counted = extent.drift_slope.max(closing.drift_slope);
        for triangle in emission.triangles_of(face) {
            let corners = emission.triangles[triangle].map(|vertex| {
                let at = |list: &[[f64; 3]]| vector(list[vertex as usize]);
                LimitPoint {
                    position: at(&emission.positions),
                    normal: at(&emission.normals),
                }
            });
            let seen = Seen::of(&corners, 0);
            let (squared, slopes) = beside(&emission, &sharp, triangle as u32);
            let chord = seen.tilt + allowance.tilt + 1e-9;
            assert!(
                squared.sqrt() <= chord,
                "{name}, face {face}: {} {chord}",
                squared.sqrt()
            );
            for (slope, own) in slopes.into_iter().zip(seen.own_slopes()) {
                let least = own.min(counted) * (1.0 - 1e-9);
                assert!(slope >= least, "{name}, face {face}: {slope} {least}");
            }
        }
    }
}

/// Triangles that pass whatever is beside them count on angles that none there exceeds, also where a plan was made from a coarser
/// one; and that has hardly more triangles than one that was made at once.
#[test]
fn what_triangles_count_on_is_there() {
    let models = ["torus", "sphere", "cup", "head", "bumpy", "icosphere"].map(|name| (name, 0));
    let stirred = [("head", 5), ("cup", 9), ("icosphere", 10), ("torus", 6)];
    with_plans(&[&models[..], &stirred].concat(), |engine, _, name| {
        let mut last = engine
            .plan(Goal::Within(f64::INFINITY), usize::MAX)
            .unwrap()
            .unwrap();
        for share in [1e-2, 2e-3, 1.7e-3, 2e-4] {
            let goal = || Goal::Within(share * engine.control.mesh.diagonal());
            let faces = 0..last.closed.len() as u32;
            let wanting = faces.filter(|&face| last.expected(face) > goal().allowed(face));
            let wanting: Vec<u32> = wanting.collect();
            let mut finer = engine
                .finer(&last, goal(), &wanting, usize::MAX)
                .unwrap()
                .unwrap();
            assert!(engine.settle(&mut finer, usize::MAX).unwrap());
            let mut at_once = engine.plan(goal(), usize::MAX).unwrap().unwrap();
            assert_holds(engine, &mut finer, name);
            assert_holds(engine, &mut at_once, name);
            let most = 1.05 * at_once.triangles as f64 + 20.0;
            assert!(
                finer.triangles as f64 <= most,
                "{name}, {share}: {}",
                finer.triangles
            );
            last = finer;
        }
    });
}

/// What is taken over from an emission to the next is what would be written anew.
#[test]
fn what_is_taken_over_is_what_would_be_written() {
    let models = [
        ("icosphere", 5),
        ("torus", 6),
        ("sheet", 8),
        ("head", 9),
        ("spike", 10),
    ];
    let mut counted = 0;
    with_plans(&models, |engine, mut plan, name| {
        for face in [0, plan.closed.len() as u32 / 2] {
            plan.emission = Some(engine.emit_all(&mut plan).unwrap());
            let mut place = Place::root(face);
            let mut word = plan.decision.trees.root(face);
            while is_split(word) {
                (word, place) = (plan.decision.trees.child(word, 1), place.child(1));
            }
            let mut dirty = Dirty::none(plan.closed.len());
            engine
                .split(&mut plan.decision.trees, place, &mut dirty)
                .unwrap();
            assert!(engine.carry_out(&mut plan, dirty, usize::MAX).unwrap());
            let all = Inserted {
                anew: (0..3 * plan.closed.len() as u32).collect(),
                at: Vec::new(),
            };
            let (edges, trees) = (&engine.edges, &plan.decision.trees);
            let known = (&Chains::default(), &all);
            let expected =
                Chains::of(engine.control.mesh, edges, trees, known, engine.watch).unwrap();
            assert_eq!(plan.chains, expected, "{name}");
            counted += plan
                .is_touched
                .iter()
                .filter(|&&is_touched| !is_touched)
                .count();
            let again = engine.emit_all(&mut plan).unwrap();
            plan.emission = None;
            let anew = engine.emit_all(&mut plan).unwrap();
            let connections = |emission: &Emission| {
                (
                    emission.triangles.clone(),
                    emission.twins.clone(),
                    emission.parents.clone(),
                )
            };
            assert_eq!(connections(&again), connections(&anew), "{name}");
            assert_eq!(
                (&again.positions, &again.normals),
                (&anew.positions, &anew.normals),
                "{name}"
            );
            assert_eq!(again.origins, anew.origins, "{name}");
            let conditions = |emission: &Emission| {
                let conditions = emission.conditions.iter();
                conditions
                    .map(|(own, first, last)| (own.place, *first, *last))
                    .collect::<Vec<_>>()
            };
            assert_eq!(conditions(&again), conditions(&anew), "{name}");
            for h in 0..3 * plan.closed.len() as u32 {
                assert_eq!(
                    again.borders.along(h),
                    anew.borders.along(h),
                    "{name}, edge {h}"
                );
            }
        }
    });
    assert!(counted > 100, "{counted}");
}

/// A leaf that was marked for its condition but has none, and a condition whose leaf does not come, are not settled.
#[test]
fn conditions_do_not_get_lost() {
    let mut counted = 0;
    with_plans(
        &[("icosphere", 0), ("sheet", 4), ("spike", 8), ("head", 12)],
        |engine, mut plan, name| {
            let place = Place {
                face: 0,
                level: 20,
                path: 3,
            };
            let condition = Condition {
                place,
                deviation: Deviation::alone(0.0),
                tilt: 0.0,
                slopes: [1.0; 3],
            };
            plan.closed[0]
                .judged
                .get_or_insert_default()
                .conditions
                .insert(0, condition);
            let mut lost = vec![0];
            let is_whole = |face: &usize| {
                plan.closed[*face].triangles == 1
                    && plan.decision.conditions(*face as u32).is_empty()
            };
            if let Some(face) = (1..plan.closed.len()).find(is_whole) {
                let marked = Piece {
                    roots: vec![LEAF | CONDITIONAL],
                    words: Vec::new(),
                };
                assert!(plan.decision.trees.replace(face as u32, &marked));
                lost.push(face);
                counted += 1;
            }
            let (failing, found) = looked_at_all(engine, &mut plan);
            for face in lost {
                assert_eq!(found[face], None, "{name}");
                let is_told = |&(place, bound): &(Place, f64)| {
                    place.face == face as u32 && bound == f64::INFINITY
                };
                assert!(failing.iter().any(is_told), "{name}: {failing:?}");
            }
        },
    );
    assert!(counted > 0);
}
