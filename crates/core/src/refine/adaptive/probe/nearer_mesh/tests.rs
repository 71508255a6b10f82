use super::super::super::demands::Demands;
use super::super::super::with_engine;
use super::super::farthest::sample;
use super::*;
use crate::measure::distances_to;
use crate::mesh::Mesh;
use crate::models::stirred;
use crate::progress::unobserved;
use crate::refine::{ExactOptions, UniformOptions, uniform};
use crate::scheme::Loop;
use crate::vector::DVec3;

/// Points of a triangle.
fn spread(corners: [DVec3; 3]) -> impl Iterator<Item = DVec3> {
    const PARTS: usize = 6;
    (0..=PARTS).flat_map(move |i| {
        (0..=PARTS - i).map(move |j| {
            let [u, v] = [i, j].map(|part| part as f64 / PARTS as f64);
            corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0])
        })
    })
}

/// The greatest distance of points to a mesh.
fn greatest(points: &[[f64; 3]], mesh: &Mesh) -> f64 {
    distances_to(points, mesh.as_triangles())
        .unwrap()
        .into_iter()
        .fold(0.0, f64::max)
}

/// A mesh that stands for a limit surface, off by no more than `most`, and by how much. Of two levels the coarser one is off by that, as the
/// points of the finer one tell, which lie on the surface; that one is off by less.
fn reference(mesh: &Mesh, most: f64) -> (Mesh, f64) {
    let options = UniformOptions::default().limit(true);
    let at_level = |levels| uniform(mesh, &Loop, &options.levels(levels)).unwrap().mesh;
    let mut coarse = at_level(2);
    for levels in 3.. {
        let fine = at_level(levels);
        let off = greatest(fine.positions(), &coarse);
        if off <= most {
            return (fine, off);
        }
        coarse = fine;
    }
    unreachable!("levels without end")
}

/// Every seventh control face from the first on, whatever it came to, against dense samples of the surface over it and of the triangles;
/// the latter are measured to uniform refinement.
fn holds(
    name: &str,
    (mesh, reference, off): (&Mesh, &Mesh, f64),
    options: &ExactOptions,
    first: usize,
) -> bool {
    let tolerance = options.tolerance.unwrap();
    with_engine(
        mesh,
        &Loop,
        (options, &Demands::default()),
        &mut unobserved,
        |engine| {
            let outcome = match engine.is_balanced {
                true => engine.balanced(tolerance, usize::MAX)?.unwrap(),
                false => {
                    let plan = engine.plan(Goal::Within(tolerance), usize::MAX)?.unwrap();
                    engine.emit(plan, usize::MAX, false)?.unwrap()
                }
            };
            let (plan, emission) = (&outcome.plan, &outcome.emission);
            let nearest = Nearest::of(engine.sources(plan, emission), engine.watch)?;
            let faces: Vec<u32> = (first..mesh.face_count())
                .step_by(7)
                .map(|face| face as u32)
                .collect();
            let known = ErrorBounds {
                lower: 0.0,
                upper: 2.0 * tolerance,
                at: [0.0; 3],
                certified: true,
            };
            let known = (&known, 0.5 * tolerance);
            let Some(found) = anew(engine, (plan, emission, &nearest), &faces, known)? else {
                return Ok(false);
            };
            let (mut over_faces, mut most) = (Vec::new(), known.1);
            for &face in &faces {
                let mut points = Vec::new();
                sample(
                    engine.control.piece(face).surface(engine.control.rules),
                    6,
                    &mut points,
                );
                for point in points {
                    let distance = nearest.distance(point, face, &|| false);
                    assert!(
                        distance <= found.upper,
                        "{name}: {distance} from the surface, {}",
                        found.upper
                    );
                    most = most.max(distance);
                }
            }
            for triangle in with_beside(emission, &faces) {
                let at = |vertex: u32| vector(emission.positions[vertex as usize]);
                let points = spread(emission.triangles[triangle].map(at));
                over_faces.extend(points.map(|point| point.to_array()));
            }
            let distance = greatest(&over_faces, reference);
            assert!(
                distance <= found.upper + off,
                "{name}: {distance} from the mesh, {}",
                found.upper
            );
            let tight = 1.05 * most.max(distance) + 0.3 * known.1;
            assert!(
                found.upper <= tight,
                "{name}: {distance} from the mesh, {most} from the surface, {}",
                found.upper
            );
            if found.lower > 0.0 {
                let at = vector(found.at);
                let distance = nearest
                    .distance(at, faces[0], &|| false)
                    .max(greatest(&[found.at], reference));
                assert!(
                    distance + off >= found.lower,
                    "{name}: {distance} at {at:?}, {}",
                    found.lower
                );
            }
            Ok(true)
        },
    )
    .unwrap()
}

#[test]
fn no_sample_is_beyond_what_faces_come_to() {
    let mut found = [0; 2];
    for (name, seed) in [
        ("icosphere", 1),
        ("torus", 0),
        ("torus", 2),
        ("sheet", 2),
        ("spike", 1),
        ("head", 1),
        ("cup", 0),
        ("cup", 2),
    ] {
        let mesh = stirred(name, seed);
        for (round, share) in [4e-3, 1e-2].into_iter().enumerate() {
            let tolerance = share * mesh.diagonal();
            let (reference, off) = reference(&mesh, 0.1 * tolerance);
            let options = ExactOptions::default().tolerance(tolerance);
            for (kind, is_balanced) in [false, true].into_iter().enumerate() {
                found[kind] += usize::from(holds(
                    name,
                    (&mesh, &reference, off),
                    &options.clone().balance(is_balanced),
                    round,
                ));
            }
        }
    }
    let sharp = stirred("torus", 1).with_creases_above(0.5).unwrap();
    let tolerance = 4e-3 * sharp.diagonal();
    let (reference, off) = reference(&sharp, 0.1 * tolerance);
    let options = ExactOptions::default().tolerance(tolerance);
    found[0] += usize::from(holds("sharp torus", (&sharp, &reference, off), &options, 0));
    assert!(found[0] >= 8 && found[1] >= 8, "{found:?}");
}
