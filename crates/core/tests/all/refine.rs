//! Refinement against brute force and another implementation, and what must hold for every refined mesh.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::ops::ControlFlow;

use crate::opensubdiv;
use crate::support::*;
use limitmesh::criterion::{
    Criterion, CriterionError, LimitNormal, NeighbourNormal, View, Viewpoint,
};
use limitmesh::limit::LimitTable;
use limitmesh::mesh::{CornerTag, INFINITELY_SHARP, Tags};
use limitmesh::progress::{Cancelled, Progress, Stage};
use limitmesh::refine::{
    RefineError, SeamRule, StepwiseOptions, Stop, UniformOptions, stepwise, uniform,
    uniform_observed,
};
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{FaceId, Mesh};
use proptest::prelude::*;

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Divides the faces of a fixed list (by a hash of the face's number and the mesh's size).
struct Arbitrary {
    seed: usize,
    one_in: usize,
}

impl Criterion for Arbitrary {
    fn name(&self) -> &str {
        "arbitrary"
    }

    fn ratios(&self, mesh: &Mesh, _: &LimitTable<'_>) -> Result<Vec<f64>, CriterionError> {
        let mut random = Random::new((self.seed + mesh.face_count()) as u64);
        Ok((0..mesh.face_count())
            .map(|_| {
                if random.below(self.one_in) == 0 {
                    1.1
                } else {
                    1.0
                }
            })
            .collect())
    }
}

fn refined(mesh: &Mesh, levels: usize) -> Mesh {
    divided(mesh, &Loop, levels)
}

#[test]
fn uniform_loop_is_brute_force_loop() {
    for (name, mesh) in samples() {
        let (mut positions, mut triangles) = (mesh.positions().to_vec(), mesh.triangles().to_vec());
        for level in 1..=3 {
            let next = brute_force_loop(&positions, &triangles);
            (positions, triangles) = (next.positions, next.triangles);
            let ours = refined(&mesh, level);
            ours.validate().unwrap();
            let oracle = Mesh::from_triangles(positions.clone(), triangles.clone()).unwrap();
            assert_eq!(
                ours.face_count(),
                4usize.pow(level as u32) * mesh.face_count()
            );
            assert!(
                unnumbered(&ours, 10) == unnumbered(&oracle, 10),
                "{name}, level {level}"
            );
        }
    }
}

#[test]
fn uniform_loop_is_the_other_implementation_s() {
    for (name, mesh) in samples() {
        let theirs = opensubdiv::of_mesh(&mesh, 2);
        let ours = refined(&mesh, 2);
        opensubdiv::assert_same_points(name, ours.positions(), &theirs, mesh.diagonal());
    }
}

#[test]
fn stepwise_with_every_face_divisible_is_uniform() {
    // A cone of no width divides every face of a curved surface.
    for seam in [SeamRule::All, SeamRule::Any, SeamRule::Inner] {
        let options = StepwiseOptions::default().levels(2).seam(seam);
        let found = stepwise(
            &octahedron(),
            &Loop,
            &Arbitrary { seed: 0, one_in: 1 },
            &options,
        );
        assert_eq!(found.unwrap().mesh, refined(&octahedron(), 2));
    }
}

/// The seam rules, distinguished by the old vertices of a half-divided sheet that moved.
#[test]
fn seam_rules_move_the_vertices_they_name() {
    struct First;
    impl Criterion for First {
        fn name(&self) -> &str {
            "first"
        }
        fn ratios(&self, mesh: &Mesh, _: &LimitTable<'_>) -> Result<Vec<f64>, CriterionError> {
            Ok((0..mesh.face_count())
                .map(|f| if f == 0 { 2.0 } else { 0.0 })
                .collect())
        }
    }
    let mesh = lumpy(20, 5);
    let smooth = brute_force_loop(mesh.positions(), mesh.triangles()).positions;
    for (seam, expected) in [
        (SeamRule::All, (0..mesh.vertex_count()).collect::<Vec<_>>()),
        (SeamRule::Any, {
            let mut corners = mesh.triangles()[0].map(|v| v as usize).to_vec();
            corners.sort_unstable();
            corners
        }),
        (SeamRule::Inner, vec![]),
    ] {
        let options = StepwiseOptions::default().levels(1).seam(seam);
        let found = stepwise(&mesh, &Loop, &First, &options).unwrap().mesh;
        found.validate().unwrap();
        let moved: Vec<usize> = (0..mesh.vertex_count())
            .filter(|&v| {
                let p = found.positions()[v];
                if p != mesh.positions()[v] {
                    assert!(distance(p, smooth[v]) < 1e-14);
                }
                p != mesh.positions()[v]
            })
            .collect();
        assert_eq!(moved, expected, "{seam:?}");
    }
}

#[test]
fn points_come_from_the_old_positions_whatever_else_is_split() {
    let mesh = lumpy(20, 9);
    let oracle = brute_force_loop(mesh.positions(), mesh.triangles());
    let options = StepwiseOptions::default().levels(1);
    let found = stepwise(&mesh, &Loop, &Arbitrary { seed: 1, one_in: 3 }, &options)
        .unwrap()
        .mesh;
    for &p in found.positions() {
        assert!(oracle.positions.iter().any(|&q| distance(p, q) < 1e-14));
    }
}

#[test]
fn the_report_counts_figure_5() {
    let mesh = lumpy(40, 2);
    let criterion = Arbitrary { seed: 4, one_in: 4 };
    let options = StepwiseOptions::default().levels(3);
    let found = stepwise(&mesh, &Loop, &criterion, &options).unwrap();
    assert_eq!(found.steps.len(), 3);
    let mut faces = mesh.face_count();
    for step in &found.steps {
        assert_eq!(step.faces_before, faces);
        assert_eq!(step.divisible + step.closure.iter().sum::<usize>(), faces);
        let [a, b, c, d] = step.closure;
        faces = 4 * (step.divisible + d) + 3 * c + 2 * b + a;
        assert_eq!(step.faces_after, faces);
    }
    assert!(
        found
            .steps
            .iter()
            .all(|step| step.closure[1] > 0 && step.closure[2] > 0)
    );
    assert_eq!(found.mesh.face_count(), faces);
}

#[test]
fn the_quadrilateral_of_two_split_edges_gets_its_shorter_diagonal() {
    // One triangle next to two divisible ones.
    let positions = vec![
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 3.0, 0.0],
        [5.0, 5.0, 0.0],
        [-4.0, 1.0, 0.0],
    ];
    let mesh = Mesh::from_triangles(positions, vec![[0, 1, 2], [2, 1, 3], [0, 2, 4]]).unwrap();
    struct Others;
    impl Criterion for Others {
        fn name(&self) -> &str {
            "others"
        }
        fn ratios(&self, mesh: &Mesh, _: &LimitTable<'_>) -> Result<Vec<f64>, CriterionError> {
            Ok((0..mesh.face_count()).map(|f| f as f64 * 2.0).collect())
        }
    }
    let options = StepwiseOptions::default().levels(1).seam(SeamRule::Inner);
    let found = stepwise(&mesh, &Loop, &Others, &options).unwrap().mesh;
    let at = |v: u32| found.positions()[v as usize];
    // The first face gives three triangles; vertices 5 and above are new.
    let first_three = &found.triangles()[..3];
    let new: Vec<u32> = {
        let mut all: Vec<u32> = first_three
            .iter()
            .flatten()
            .copied()
            .filter(|&v| v > 4)
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    let [p, q] = new[..] else {
        panic!("two new vertices expected, found {new:?}")
    };
    let uses = |a: u32, b: u32| {
        first_three
            .iter()
            .filter(|t| t.contains(&a) && t.contains(&b))
            .count()
            == 2
    };
    // p and q lie on edges 1-2 and 2-0 in some order.
    let on_12 = if distance(at(p), [2.0, 1.5, 0.0]) < distance(at(q), [2.0, 1.5, 0.0]) {
        p
    } else {
        q
    };
    let on_20 = if on_12 == p { q } else { p };
    let from_0 = distance(at(0), at(on_12));
    let from_1 = distance(at(1), at(on_20));
    assert!(uses(0, on_12) == (from_0 < from_1) && uses(1, on_20) == (from_1 < from_0));
}

#[test]
fn caps_and_satisfaction_are_told() {
    let mesh = torus(6, 5);
    let capped = uniform(
        &mesh,
        &Loop,
        &UniformOptions::default()
            .levels(5)
            .max_triangles(Some(1000)),
    )
    .unwrap();
    assert_eq!(capped.stop, Stop::TriangleCap { needed: 3840 });
    assert_eq!(capped.mesh.face_count(), 960);
    let criterion = LimitNormal::new(20.0 * DEGREE);
    let options = StepwiseOptions::default().levels(12);
    let satisfied = stepwise(&mesh, &Loop, &criterion, &options).unwrap();
    assert_eq!(satisfied.stop, Stop::Satisfied);
    // Satisfied means that no face leaves the cone any more.
    let limits = LimitTable::new(&Loop);
    assert!(
        criterion
            .divisible(&satisfied.mesh, &limits)
            .unwrap()
            .iter()
            .all(|&d| !d)
    );
    let normals = limits.normals(&satisfied.mesh).unwrap();
    for (f, t) in satisfied.mesh.triangles().iter().enumerate() {
        let n = satisfied.mesh.face_normal(FaceId(f as u32));
        let length = distance(n, [0.0; 3]);
        for &v in t {
            let cosine: f64 = (0..3).map(|i| normals[v as usize][i] * n[i]).sum::<f64>() / length;
            assert!(cosine > (20.0 * DEGREE).cos() - 1e-12);
        }
    }
}

#[test]
fn the_observer_sees_each_step_and_can_cancel() {
    let options = UniformOptions::default().levels(4);
    let mut triangles = Vec::new();
    let mut watch = |progress: &Progress| {
        assert_eq!((progress.stage, progress.total), (Stage::Refining, Some(4)));
        assert_eq!(progress.triangles, 8 << (2 * progress.done));
        triangles.push(progress.triangles);
        ControlFlow::Continue(())
    };
    let watched = uniform_observed(&octahedron(), &Loop, &options, &mut watch).unwrap();
    assert_eq!(
        watched.mesh.positions(),
        uniform(&octahedron(), &Loop, &options)
            .unwrap()
            .mesh
            .positions()
    );
    assert!(triangles.is_sorted());
    triangles.dedup();
    assert_eq!(triangles, [8, 32, 128, 512, 2048]);

    // It is called more than once a step, and never again once it said so.
    for last in 1..=12 {
        let mut calls = 0;
        let mut observer = |_: &Progress| {
            calls += 1;
            if calls == last {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let cancelled = uniform_observed(&octahedron(), &Loop, &options, &mut observer);
        assert_eq!(cancelled.unwrap_err(), RefineError::Cancelled(Cancelled));
        assert_eq!(calls, last);
    }
}

#[test]
fn a_view_leaves_back_faces_and_divides_the_silhouette() {
    let mesh = refined(&octahedron(), 3);
    let view = View {
        viewpoint: Viewpoint::Direction([0.0, 0.0, -1.0]),
        dilatation: 1.0,
    };
    let criterion = LimitNormal::new(20.0 * DEGREE).view(view);
    let flags = criterion.divisible(&mesh, &LimitTable::new(&Loop)).unwrap();
    let z: Vec<f64> = (0..mesh.face_count())
        .map(|f| {
            let n = mesh.face_normal(FaceId(f as u32));
            n[2] / distance(n, [0.0; 3])
        })
        .collect();
    assert!(
        (0..z.len()).all(|f| z[f] >= 0.0 || !flags[f]),
        "a back face is divided"
    );
    let steep = |low: f64, high: f64| {
        let band: Vec<bool> = (0..z.len())
            .filter(|&f| z[f] >= low && z[f] < high)
            .map(|f| flags[f])
            .collect();
        band.iter().filter(|&&d| d).count() as f64 / band.len() as f64
    };
    assert!(
        steep(0.0, 0.1) > steep(0.5, 1.0),
        "the silhouette is not preferred"
    );
    // From far away an eye point is a direction.
    let eye = View {
        viewpoint: Viewpoint::Eye([0.0, 0.0, 1e9]),
        dilatation: 1.0,
    };
    let far = LimitNormal::new(20.0 * DEGREE).view(eye);
    assert_eq!(
        far.divisible(&mesh, &LimitTable::new(&Loop)).unwrap(),
        flags
    );
}

#[test]
fn overflow_is_an_error_and_not_an_infinite_mesh() {
    let mesh = octahedron();
    let mesh = mapped(&mesh, |p| p.map(|x| x * f64::MAX));
    // Either all sums stay in range or the vertex is named; never NaN in a mesh.
    match stepwise(
        &mesh,
        &ModifiedButterfly,
        &NeighbourNormal::new(0.1),
        &StepwiseOptions::default(),
    ) {
        Ok(found) => found.mesh.validate().unwrap(),
        Err(error) => assert!(error.to_string().contains("no finite number")),
    }
}

fn check_invariants(before: &Mesh, after: &Mesh) {
    after.validate().unwrap();
    let (a, b) = (before.topology(), after.topology());
    assert_eq!(a.euler_characteristic(), b.euler_characteristic());
    assert_eq!(a.boundary_edge_count() == 0, b.boundary_edge_count() == 0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_flags_give_a_conforming_mesh(
        seed in 0u64..1000,
        splits in 0usize..60,
        one_in in 1usize..9,
        open in any::<bool>(),
        scheme in 0usize..3,
        seam in 0usize..3,
    ) {
        let mesh = if open { sheet(2 + splits as u32 % 6, 3, seed) } else { lumpy(splits, seed) };
        let scheme: &dyn Scheme = [&Loop as &dyn Scheme, &LoopWarren, &ModifiedButterfly][scheme];
        let seam = [SeamRule::All, SeamRule::Any, SeamRule::Inner][seam];
        let criterion = Arbitrary { seed: seed as usize, one_in };
        let options = StepwiseOptions::default().levels(3).seam(seam);
        let found = stepwise(&mesh, scheme, &criterion, &options).unwrap();
        check_invariants(&mesh, &found.mesh);
    }

    #[test]
    fn criteria_give_conforming_meshes(seed in 0u64..1000, angle in 1.0f64..40.0, amresh in any::<bool>()) {
        let mesh = lumpy(15, seed);
        let criteria: [&dyn Criterion; 2] =
            [&LimitNormal::new(angle * DEGREE), &NeighbourNormal::new(angle * DEGREE)];
        let options = StepwiseOptions::default().levels(3);
        let found = stepwise(&mesh, &Loop, criteria[usize::from(amresh)], &options).unwrap();
        check_invariants(&mesh, &found.mesh);
    }
}

/// Sheets that meet along a cut stay together when only one of them is divided.
#[test]
fn cut_sheets_stay_together() {
    // Three strips of triangles along the polyline through (0,0,z), z = 0 … 4.
    let mut soup = limitmesh::PolygonSoup::default();
    for z in 0..5 {
        soup.positions.push([0.0, 0.0, f64::from(z)]);
    }
    for (strip, [x, y]) in [[1.0, 0.0], [-0.5, 0.9], [-0.4, -0.8]]
        .into_iter()
        .enumerate()
    {
        for z in 0..5 {
            soup.positions
                .push([x, y, f64::from(z) + 0.1 * f64::from(strip as u32)]);
        }
        let outer = 5 * (strip as u32 + 1);
        for z in 0..4 {
            soup.faces.push(&[z, outer + z, z + 1]);
            soup.faces.push(&[z + 1, outer + z, outer + z + 1]);
        }
    }
    let (mesh, diagnosis) = Mesh::from_soup(&soup, &Default::default()).unwrap();
    assert_eq!(diagnosis.non_manifold_edges.count, 4);
    assert_eq!(mesh.junctions().edges.len(), 4);
    for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
        for seam in [SeamRule::All, SeamRule::Any, SeamRule::Inner] {
            for seed in 0..8 {
                let criterion = Arbitrary { seed, one_in: 3 };
                let options = StepwiseOptions::default()
                    .levels(3)
                    .seam(seam)
                    .limit(seed % 2 == 0);
                let found = stepwise(&mesh, scheme, &criterion, &options).unwrap().mesh;
                // `validate` checks that copies stand at one place; each edge group must keep three members.
                found.validate().unwrap();
                assert!(found.junctions().edges.len() > 4);
                assert!(found.junctions().edges.iter().all(|group| group.len() == 3));
                let cut_length: usize = found.junctions().edges.len();
                // No sheet has a vertex inside a piece of the cut: the pieces form one path of 5 + new vertices.
                assert_eq!(found.junctions().vertices.len(), cut_length + 1);
            }
        }
    }
}

#[test]
fn tags_go_to_the_pieces_of_what_they_name() {
    let crease = |a, b, sharpness| crate::support::crease([a, b], sharpness);
    let tags = Tags {
        creases: vec![
            crease(0, 2, 2.5),
            crease(2, 4, INFINITELY_SHARP),
            crease(4, 0, 1.0),
        ],
        corners: vec![corner(1, f64::INFINITY), corner(5, 2.0)],
    };
    let mesh = octahedron().with_tags(tags).unwrap();
    let found = refined(&mesh, 2);
    // Each crease that has not faded now runs along four edges between its old ends.
    let ends = |of: f64| -> Vec<u32> {
        let tags = found
            .tags()
            .creases
            .iter()
            .filter(|tag| tag.sharpness == of);
        let all: Vec<u32> = tags.flat_map(|tag| tag.vertices).collect();
        let mut once: Vec<u32> = all
            .iter()
            .copied()
            .filter(|v| all.iter().filter(|u| *u == v).count() == 1)
            .collect();
        once.sort_unstable();
        once
    };
    assert_eq!(found.tags().creases.len(), 8);
    assert_eq!(
        (ends(0.5), ends(INFINITELY_SHARP)),
        (vec![0, 2], vec![2, 4])
    );
    assert_eq!(
        found.tags().corners,
        [CornerTag {
            vertex: 1,
            sharpness: f64::INFINITY
        }]
    );
    assert_eq!(found.positions()[1], mesh.positions()[1]);
    found.validate().unwrap();
}

#[test]
fn parameters_out_of_range_are_errors() {
    let options = StepwiseOptions::default();
    let named =
        |criterion: &dyn Criterion| match stepwise(&octahedron(), &Loop, criterion, &options) {
            Err(RefineError::Criterion(CriterionError::BadParameter { name, .. })) => name,
            other => panic!("expected an error, found {other:?}"),
        };
    for angle in [f64::NAN, -0.1, 3.2, f64::INFINITY] {
        assert_eq!(named(&LimitNormal::new(angle)), "angle");
        assert_eq!(named(&NeighbourNormal::new(angle)), "angle");
    }
    let seen = |viewpoint, dilatation| {
        LimitNormal::new(0.1).view(View {
            viewpoint,
            dilatation,
        })
    };
    assert_eq!(
        named(&seen(Viewpoint::Direction([0.0; 3]), 1.0)),
        "direction of sight"
    );
    assert_eq!(
        named(&seen(Viewpoint::Eye([0.0, f64::NAN, 0.0]), 1.0)),
        "eye point"
    );
    assert_eq!(named(&seen(Viewpoint::Eye([0.0; 3]), -1.0)), "dilatation");
}

#[test]
fn the_size_of_a_mesh_does_not_matter() {
    let mesh = lumpy(20, 3);
    let count = |size: f64, criterion: &dyn Criterion| {
        let scaled = mapped(&mesh, |p| p.map(|x| x * size));
        stepwise(&scaled, &Loop, criterion, &StepwiseOptions::default())
            .unwrap()
            .mesh
            .face_count()
    };
    let view = View {
        viewpoint: Viewpoint::Direction([0.0, 1e-200, -1e-200]),
        dilatation: 1.0,
    };
    let criteria: [&dyn Criterion; 3] = [
        &LimitNormal::new(10.0 * DEGREE),
        &NeighbourNormal::new(10.0 * DEGREE),
        &LimitNormal::new(10.0 * DEGREE).view(view),
    ];
    for criterion in criteria {
        let usual = count(1.0, criterion);
        assert!(usual > mesh.face_count());
        // Powers of two: scaling is exact, so that the flags are the same.
        for exponent in [-600, -200, 200, 600] {
            assert_eq!(
                count(2f64.powi(exponent), criterion),
                usual,
                "size 2^{exponent}"
            );
        }
    }
}
