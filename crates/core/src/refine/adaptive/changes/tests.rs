//! What is not measured again would come to the same: everything that it depends on is, bit by bit.

use std::collections::{HashMap, HashSet};

use super::super::bulges::Bulges;
use super::super::carry_out::marked;
use super::super::demands::Demands;
use super::super::dirty::Dirty;
use super::super::emit::Scope;
use super::super::emitted::{Beholder, Emitted, Over, Sources};
use super::super::judge::Goal;
use super::super::measure::measure;
use super::super::measured::Measured;
use super::super::quadtree::{Place, is_split};
use super::super::settle::{beside, sharp_edges};
use super::super::{Engine, Plan, join_copies, with_engine};
use super::*;
use crate::certificate::SubTriangle;
use crate::mesh::Mesh;
use crate::models::{book, stir, stirred};
use crate::patch::Rules;
use crate::progress::unobserved;
use crate::random::Random;
use crate::refine::ExactOptions;
use crate::scheme::Loop;

/// All that a triangle's measurement depends on.
#[derive(Debug, PartialEq)]
struct Known {
    place: Place,
    part: SubTriangle,
    open: [bool; 3],
    corners: [[f64; 3]; 3],
    moves: [[f64; 3]; 3],
    around: (f64, [f64; 3]),
}

impl Known {
    /// What tells it from others of its control face.
    fn key(&self) -> (u32, u64, [[u64; 3]; 3]) {
        (
            self.place.level,
            self.place.path,
            self.corners.map(|corner| corner.map(f64::to_bits)),
        )
    }
}

/// Lists that of a control face's triangles.
struct Listing<'a> {
    emission: &'a Emission,
    sharp: &'a HashSet<u32>,
    found: Listed,
}

impl Beholder for Listing<'_> {
    fn triangle<'p>(&mut self, emitted: &Emitted, _: Over<'_, 'p>, _: &'p Rules<'p>) {
        let Emitted {
            number,
            vertices,
            place,
            part,
            open,
        } = *emitted;
        let corners = vertices.map(|vertex| self.emission.positions[vertex as usize]);
        let moves = vertices.map(|vertex| self.emission.step(vertex).to_array());
        let around = beside(self.emission, self.sharp, number);
        self.found.push((
            number,
            Known {
                place,
                part,
                open,
                corners,
                moves,
                around,
            },
        ));
    }
}

/// With the numbers of the triangles.
type Listed = Vec<(u32, Known)>;

fn listed(sources: &Sources<'_>, sharp: &HashSet<u32>, face: u32) -> Listed {
    let mut listing = Listing {
        emission: sources.emission,
        sharp,
        found: Vec::new(),
    };
    sources.show(face, &|| false, &mut listing);
    listing.found
}

/// Divides a leaf of each of some control faces.
fn divide(engine: &Engine<'_>, plan: &mut Plan, random: &mut Random) {
    let mut dirty = Dirty::none(plan.closed.len());
    for _ in 0..1 + plan.closed.len() / 40 {
        let mut place = Place::root(random.below(plan.closed.len()) as u32);
        let mut word = plan.decision.trees.root(place.face);
        while is_split(word) {
            let child = random.below(4);
            (word, place) = (plan.decision.trees.child(word, child), place.child(child));
        }
        engine
            .split(&mut plan.decision.trees, place, &mut dirty)
            .unwrap();
    }
    assert!(engine.carry_out(plan, dirty, usize::MAX).unwrap());
}

/// What was found with nothing but changes measured holds what is found with all measured anew.
fn assert_holds(found: &[Measured], anew: &[Measured], name: &str) {
    for (face, (found, anew)) in found.iter().zip(anew).enumerate() {
        let greatest = |face: &Measured| [face.worst.0, face.highest.0, face.value, face.pixels];
        let pairs = greatest(found).into_iter().zip(greatest(anew));
        // What is kept of parts is rounded.
        assert!(
            pairs
                .into_iter()
                .all(|(found, anew)| found >= (1.0 - 1e-6) * anew),
            "{name}, {face}: {found:?} {anew:?}"
        );
        let is_known = anew.failing.iter().all(|(place, value)| {
            found
                .failing
                .iter()
                .any(|(known, found)| known == place && *found >= (1.0 - 1e-6) * value)
        });
        assert!(is_known, "{name}, {face}: {found:?} {anew:?}");
    }
}

/// Rounds of random divisions with vertices moved after each, as balancing does it.
fn rounds(name: &str, mesh: &Mesh, (share, seed): (f64, u64), counts: &mut [usize; 2]) {
    let mut random = Random::new(seed);
    let limit = share * mesh.diagonal();
    let options = ExactOptions::default().tolerance(limit).balance(true);
    with_engine(
        mesh,
        &Loop,
        (&options, &Demands::default()),
        &mut unobserved,
        |engine| {
            let (goal, watch) = (Goal::Within(limit), engine.watch);
            let mut plan = engine.plan(Goal::Within(2.0 * limit), usize::MAX)?.unwrap();
            let faces: Vec<u32> = (0..plan.closed.len() as u32).collect();
            let (mut bulges, mut measured) = (Bulges::default(), Vec::<Measured>::new());
            let mut before: Option<Vec<Listed>> = None;
            for round in 0..4 {
                let name = format!("{name}, round {round}");
                let touched = plan.is_touched.clone();
                let kept = plan.emission.take();
                let mut anew = engine.emit_some(&plan, Scope::All)?;
                plan.emission = kept;
                let mut emission = engine.emit_all(&mut plan)?;
                assert_eq!(
                    (&emission.triangles, &emission.twins),
                    (&anew.triangles, &anew.twins),
                    "{name}"
                );
                assert_eq!(emission.normals, anew.normals, "{name}");
                bulges.look(
                    &engine.sources(&plan, &emission),
                    watch,
                    &marked(&touched),
                    (limit, 0),
                )?;
                let mut all_bulges = Bulges::default();
                all_bulges.look(&engine.sources(&plan, &emission), watch, &faces, (limit, 0))?;
                for (known, anew) in bulges.0.iter().zip(&all_bulges.0) {
                    let (known, anew) = (known.ranges.as_flattened(), anew.ranges.as_flattened());
                    assert_eq!(known.len(), anew.len(), "{name}");
                    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * limit;
                    assert!(known.iter().zip(anew).all(is_near), "{name}");
                }
                let moves = bulges.offsets(engine.control, &mut emission, limit, watch)?;
                emission.shift(moves, watch)?;
                // What was taken over lies where it would if all were moved anew.
                anew.junctions = emission.junctions.clone();
                join_copies(&mut anew.positions, &anew.junctions.vertices);
                let moves = bulges.offsets(engine.control, &mut anew, limit, watch)?;
                assert_eq!(moves.1, faces, "{name}");
                anew.shift(moves, watch)?;
                assert_eq!(
                    (&emission.offsets, &emission.positions),
                    (&anew.offsets, &anew.positions),
                    "{name}"
                );
                let changes = Changes::since((Some(&bulges), true), &touched, &emission, watch)?;
                let sources = engine.sources(&plan, &emission);
                let sharp = sharp_edges(&emission, watch)?;
                let known: Vec<_> = faces
                    .iter()
                    .map(|&face| listed(&sources, &sharp, face))
                    .collect();
                let changed = changes.faces(&emission, &engine.edges, watch)?;
                let nothing = Vec::new();
                for (&face, known) in faces.iter().zip(&known) {
                    let before = before
                        .as_ref()
                        .map_or(&nothing, |before| &before[face as usize]);
                    let before: HashMap<_, _> = before
                        .iter()
                        .map(|(_, known)| (known.key(), known))
                        .collect();
                    for (number, known) in known {
                        let is_concerned = changes.concern(&emission, *number);
                        let is_same = before.get(&known.key()) == Some(&known);
                        assert!(is_concerned || is_same, "{name}, {face}: {known:?}");
                        assert!(!is_concerned || changed.contains(&face));
                        counts[usize::from(is_concerned)] += 1;
                    }
                }
                let found = measure(
                    &sources,
                    watch,
                    (&goal, f64::INFINITY),
                    (&changed, Some(&changes), Some(&bulges)),
                )?;
                let anew = measure(
                    &sources,
                    watch,
                    (&goal, f64::INFINITY),
                    (&faces, None, Some(&bulges)),
                )?;
                if measured.is_empty() {
                    measured = faces.iter().map(|&face| Measured::nothing(face)).collect();
                }
                for (&face, mut found) in changed.iter().zip(found) {
                    let is_all = bulges.keep(face, &mut found, &emission);
                    measured[face as usize].replace(found, is_all);
                }
                assert_holds(&measured, &anew, &name);
                before = Some(known);
                plan.emission = Some(emission);
                divide(engine, &mut plan, &mut random);
            }
            Ok(())
        },
    )
    .unwrap();
}

/// Nothing that a skipped measurement depends on has changed: also at boundaries, sharp edges and where sheets were cut.
#[test]
fn what_is_not_measured_again_is_the_same() {
    let mut counts = [0; 2];
    for seed in 1..3 {
        for (name, share) in [
            ("icosphere", 2e-3),
            ("torus", 2e-3),
            ("sheet", 1e-3),
            ("head", 3e-3),
            ("cup", 2e-3),
            ("spike", 1e-2),
        ] {
            rounds(name, &stirred(name, seed), (share, seed), &mut counts);
        }
        let sharp = |name: &str| stirred(name, seed).with_creases_above(0.5).unwrap();
        rounds("sharp torus", &sharp("torus"), (2e-3, seed), &mut counts);
        rounds("sharp cube", &sharp("cube"), (1e-3, seed), &mut counts);
        rounds("book", &stir(book(), seed), (2e-3, seed), &mut counts);
    }
    assert!(counts[0] > 10_000 && counts[1] > 1_000, "{counts:?}");
}

/// What balancing, and dividing for angles, come to is what all triangles come to when they are measured in the end.
#[test]
fn rounds_end_with_what_is_found_anew() {
    for (name, seed) in [
        ("icosphere", 1),
        ("head", 2),
        ("sheet", 1),
        ("spike", 2),
        ("cup", 0),
    ] {
        let mesh = stirred(name, seed);
        let limit = 1e-3 * mesh.diagonal();
        let options = ExactOptions::default().tolerance(limit);
        for options in [options.clone().balance(true), options.clone().angle(0.2)] {
            with_engine(
                &mesh,
                &Loop,
                (&options, &Demands::default()),
                &mut unobserved,
                |engine| {
                    let goal = Goal::Within(if engine.is_balanced { limit } else { 1.0 });
                    let outcome = if engine.is_balanced {
                        engine.balanced(limit, usize::MAX)?
                    } else {
                        let plan = engine.plan(goal.clone(), usize::MAX)?.unwrap();
                        engine.emit_among(plan, &goal, (usize::MAX, false))?
                    };
                    let outcome = outcome.unwrap();
                    let faces: Vec<u32> = (0..outcome.plan.closed.len() as u32).collect();
                    let sources = engine.sources(&outcome.plan, &outcome.emission);
                    let anew = measure(
                        &sources,
                        engine.watch,
                        (&goal, f64::INFINITY),
                        (&faces, None, None),
                    )?;
                    assert_holds(&outcome.measured.unwrap(), &anew, name);
                    Ok(())
                },
            )
            .unwrap();
        }
    }
}
