use super::*;
use crate::index::FaceId;
use crate::measure::{Bvh, CertifiedOptions, SamplingOptions, certified_hausdorff, hausdorff};
use crate::mesh::{CornerTag, CreaseTag, INFINITELY_SHARP, Tags};
use proptest::prelude::*;

/// A mesh of this build from the arrays of one of the library as others see it.
fn own(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Mesh {
    Mesh::from_triangles(positions.to_vec(), triangles.to_vec()).unwrap()
}

fn model(name: &str) -> Mesh {
    let model = limitmesh_testing::models::model(name);
    own(model.positions(), model.triangles())
}

/// A mesh after some levels of Loop's scheme, its vertices on the limit surface.
fn limit_reference(mesh: &Mesh, levels: usize) -> Mesh {
    let positions = mesh.positions().to_vec();
    let control = limitmesh::Mesh::from_triangles(positions, mesh.triangles().to_vec()).unwrap();
    let fine = limitmesh::refine::limit_reference(&control, &limitmesh::scheme::Loop, levels);
    let fine = fine.unwrap();
    own(fine.positions(), fine.triangles())
}

fn run(fine: &Mesh, options: &SimplifyOptions) -> Simplified {
    let coarse = simplify(fine, &Features::default(), options).unwrap();
    check_invariants(fine, &coarse);
    coarse
}

fn within(tolerance: f64) -> SimplifyOptions {
    SimplifyOptions::default().tolerance(Some(tolerance))
}

/// The invariants for any mesh and any goal.
fn check_invariants(fine: &Mesh, coarse: &Simplified) {
    let mesh = &coarse.mesh;
    mesh.validate().unwrap();
    assert_eq!(
        mesh.topology().euler_characteristic(),
        fine.topology().euler_characteristic()
    );
    assert_eq!(boundary_loops(mesh), boundary_loops(fine));
    assert_eq!(mesh.vertex_count(), coarse.vertices.len());
    for (at, &v) in mesh.positions().iter().zip(&coarse.vertices) {
        assert_eq!(*at, fine.positions()[v as usize]);
    }
}

fn boundary_loops(mesh: &Mesh) -> usize {
    let topology = mesh.topology();
    let mut met = vec![false; mesh.vertex_count()];
    let mut loops = 0;
    for v in topology.vertices().filter(|&v| topology.is_boundary(v)) {
        loops += usize::from(!met[v.index()]);
        let mut at = v;
        while !core::mem::replace(&mut met[at.index()], true) {
            at = topology.target(topology.outgoing(at));
        }
    }
    loops
}

/// A square of `n` × `n` cells over [0, 1]², with heights.
fn square(n: usize, height: impl Fn(f64, f64) -> f64) -> Mesh {
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            let (x, y) = (i as f64 / n as f64, j as f64 / n as f64);
            positions.push([x, y, height(x, y)]);
            if i < n && j < n {
                triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// Each triangle cut in four, the new vertices in the middles of the edges, which keeps the
/// surface.
fn split_flat(mesh: &Mesh, times: usize) -> Mesh {
    let mut mesh = mesh.clone();
    for _ in 0..times {
        let mut positions = mesh.positions().to_vec();
        let mut middles = std::collections::BTreeMap::new();
        let mut triangles = Vec::new();
        for &[a, b, c] in mesh.triangles() {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[p, q]| {
                *middles.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                    let (p, q) = (vector(positions[p as usize]), vector(positions[q as usize]));
                    positions.push(p.midpoint(q).to_array());
                    positions.len() as u32 - 1
                })
            });
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        let split = |crease: &CreaseTag| {
            let [p, q] = crease.vertices;
            let middle = middles[&[p.min(q), p.max(q)]];
            [[p, middle], [middle, q]].map(|vertices| CreaseTag {
                vertices,
                ..*crease
            })
        };
        let creases = mesh.tags().creases.iter().flat_map(split).collect();
        let tags = Tags {
            creases,
            corners: mesh.tags().corners.clone(),
        };
        mesh = Mesh::from_triangles(positions, triangles)
            .unwrap()
            .with_tags(tags)
            .unwrap();
    }
    mesh
}

#[test]
fn a_flat_square_keeps_its_corners_alone() {
    let corners = [0, 20, 420, 440];
    let fine = square(20, |_, _| 0.0);
    let features = Features {
        vertices: corners.to_vec(),
        ..Features::default()
    };
    let coarse = simplify(&fine, &features, &within(1e-9)).unwrap();
    check_invariants(&fine, &coarse);
    assert_eq!(
        (coarse.vertices, coarse.mesh.face_count()),
        (corners.to_vec(), 2)
    );
    assert!(coarse.estimate < 1e-15);
    // Without tags the corners are kept as well: to lose one would leave the surface.
    assert_eq!(run(&fine, &within(1e-9)).vertices, corners);
}

#[test]
fn a_cube_with_creases_becomes_twelve_triangles() {
    let cube = model("cube");
    let diagonal = |&[a, b]: &[u32; 2]| {
        let (p, q) = (
            vector(cube.positions()[a as usize]),
            vector(cube.positions()[b as usize]),
        );
        (p - q)
            .abs()
            .to_array()
            .iter()
            .filter(|&&x| x > 0.0)
            .count()
            > 1
    };
    let topology = cube.topology();
    let mut edges: Vec<[u32; 2]> = topology
        .half_edges()
        .map(|h| topology.ends(h).map(|v| v.0))
        .filter(|[a, b]| a < b)
        .collect();
    edges.retain(|edge| !diagonal(edge));
    assert_eq!(edges.len(), 12);
    let creases = edges
        .iter()
        .map(|&vertices| CreaseTag {
            vertices,
            sharpness: INFINITELY_SHARP,
        })
        .collect();
    let tagged = cube
        .clone()
        .with_tags(Tags {
            creases,
            corners: Vec::new(),
        })
        .unwrap();
    let fine = split_flat(&tagged, 4);
    let coarse = run(&fine, &within(1e-9));
    assert_eq!(coarse.mesh.face_count(), 12);
    assert_eq!(coarse.vertices, (0..8).collect::<Vec<u32>>());
    let mut kept: Vec<[u32; 2]> = coarse
        .mesh
        .tags()
        .creases
        .iter()
        .map(|crease| crease.vertices)
        .collect();
    kept.sort_unstable();
    edges.sort_unstable();
    assert_eq!(kept, edges);
    // Without tags the shape says the same.
    assert_eq!(
        run(&split_flat(&cube, 4), &within(1e-9)).mesh.face_count(),
        12
    );
}

/// Greatest distances between a mesh inscribed in the unit sphere about the origin and the sphere, sampled densely.
fn distance_to_sphere(mesh: &Mesh) -> f64 {
    let mut greatest = 0.0f64;
    for face in 0..mesh.face_count() {
        let [a, b, c] = mesh.as_triangles().corners(face).map(vector);
        for i in 0..=24 {
            for j in 0..=24 - i {
                let (u, v) = (f64::from(i) / 24.0, f64::from(j) / 24.0);
                greatest = greatest.max((1.0 - (a * (1.0 - u - v) + b * u + c * v).length()).abs());
            }
        }
    }
    greatest
}

#[test]
fn a_sphere_stays_within_the_tolerance_and_close_to_the_optimum() {
    let onto_sphere = |p: &[f64; 3]| vector(*p).normalize().to_array();
    let flat = split_flat(&model("icosphere"), 3);
    let fine = flat
        .clone()
        .with_positions(flat.positions().iter().map(onto_sphere).collect())
        .unwrap();
    for tolerance in [0.02, 0.005] {
        let coarse = run(&fine, &within(tolerance));
        let distance = distance_to_sphere(&coarse.mesh);
        // Half an edge of the fine mesh above its chords.
        let slack = distance_to_sphere(&fine);
        assert!(distance <= tolerance + slack, "{distance} for {tolerance}");
        // The asymptotic optimum is 0.19245·∫√K dA / ε = 0.19245·4π/ε vertices.
        let optimum = 0.19245 * 4.0 * core::f64::consts::PI / distance;
        assert!((coarse.mesh.vertex_count() as f64) < 2.0 * optimum);
    }
}

#[test]
fn the_number_of_triangles_is_kept() {
    let fine = limit_reference(&model("bumpy"), 3);
    for triangles in [4000, 1001, 100] {
        let coarse = run(
            &fine,
            &SimplifyOptions::default()
                .triangles(Some(triangles))
                .certify(false),
        );
        assert!((triangles - 1..=triangles).contains(&coarse.mesh.face_count()));
    }
    // Both goals: the first one reached stops it.
    let stopped = run(&fine, &within(4e-3).triangles(Some(9000)));
    assert!((8999..=9000).contains(&stopped.mesh.face_count()));
    let stopped = run(&fine, &within(4e-3).triangles(Some(4)));
    assert_eq!(stopped.mesh, run(&fine, &within(4e-3)).mesh);
}

#[test]
fn both_directions_keep_the_tolerance_on_the_models() {
    for (name, levels) in [
        ("bumpy", 3),
        ("cup", 2),
        ("head", 3),
        ("torus", 3),
        ("sheet", 3),
        ("cusp", 2),
    ] {
        let fine = limit_reference(&model(name), levels);
        let tolerance = 0.002 * fine.diagonal();
        let coarse = run(&fine, &within(tolerance));
        assert!(coarse.mesh.face_count() < fine.face_count() / 2, "{name}");
        let options = SamplingOptions::default().samples(50_000);
        let distance = hausdorff(coarse.mesh.as_triangles(), fine.as_triangles(), &options)
            .unwrap()
            .symmetric();
        assert!(distance <= tolerance, "{name}: {distance} > {tolerance}");
    }
}

#[test]
fn triangles_do_not_fold_over() {
    for name in ["bunny", "radish"] {
        let fine = limit_reference(&model(name), 2);
        let coarse = run(&fine, &SimplifyOptions::default().triangles(Some(2000)));
        let fine_surface = Bvh::new(fine.as_triangles()).unwrap();
        for face in 0..coarse.mesh.face_count() {
            let [a, b, c] = coarse.mesh.as_triangles().corners(face).map(vector);
            let below = fine_surface.closest(((a + b + c) / 3.0).to_array()).face;
            let normal = vector(coarse.mesh.face_normal(FaceId(face as u32))).normalize();
            let surface = vector(fine.face_normal(FaceId(below))).normalize();
            assert!(
                normal.dot(surface) > 0.0,
                "{name}: triangle {face} is turned over"
            );
        }
    }
}

#[test]
fn options_and_features_out_of_range_are_refused() {
    let mesh = model("tetrahedron");
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        let error = simplify(&mesh, &Features::default(), &within(tolerance)).unwrap_err();
        assert!(matches!(
            error,
            SimplifyError::Mesh(MeshError::BadOption {
                name: "tolerance",
                ..
            })
        ));
    }
    let none = SimplifyOptions::default().triangles(Some(0));
    let error = simplify(&mesh, &Features::default(), &none).unwrap_err();
    assert!(matches!(
        error,
        SimplifyError::Mesh(MeshError::BadOption {
            name: "triangles",
            ..
        })
    ));
    for features in [
        Features {
            vertices: vec![4],
            ..Features::default()
        },
        Features {
            edges: vec![[0, 4]],
            ..Features::default()
        },
        Features {
            edges: vec![[1, 1]],
            ..Features::default()
        },
    ] {
        assert!(simplify(&mesh, &features, &within(0.1)).is_err());
    }
}

#[test]
fn the_smallest_meshes_are_left_alone() {
    let triangle = Mesh::from_triangles(
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        vec![[0, 1, 2]],
    )
    .unwrap();
    assert_eq!(run(&triangle, &within(10.0)).mesh, triangle);
    let tetrahedron = model("tetrahedron");
    assert_eq!(run(&tetrahedron, &within(10.0)).mesh, tetrahedron);
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let fine = limit_reference(&model("cusp"), 2);
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| run(&fine, &SimplifyOptions::default().triangles(Some(800))))
    };
    let (one, three) = (with_threads(1), with_threads(3));
    assert_eq!((&one.mesh, &one.vertices), (&three.mesh, &three.vertices));
}

#[test]
fn creases_stay_where_they_are() {
    // A crease along the ridge of a roof with a wavy height, one corner on it, one vertex tagged by hand.
    let n = 32;
    let fine = square(n, |x, y| 0.3 - (x - 0.5).abs() + 0.05 * (6.0 * y).sin());
    let ridge = |j: usize| ((n / 2) * (n + 1) + j) as u32;
    let creases = (0..n)
        .map(|j| CreaseTag {
            vertices: [ridge(j), ridge(j + 1)],
            sharpness: INFINITELY_SHARP,
        })
        .collect();
    let corners = vec![CornerTag {
        vertex: ridge(5),
        sharpness: INFINITELY_SHARP,
    }];
    let fine = fine.with_tags(Tags { creases, corners }).unwrap();
    let tolerance = 0.002;
    let coarse = run(&fine, &within(tolerance));
    assert!(coarse.mesh.face_count() < fine.face_count() / 8);
    let corner = coarse.mesh.tags().corners[0].vertex;
    assert_eq!(coarse.vertices[corner as usize], ridge(5));
    let edges: Vec<[[f64; 3]; 2]> = coarse
        .mesh
        .tags()
        .creases
        .iter()
        .map(|crease| crease.vertices.map(|v| coarse.mesh.positions()[v as usize]))
        .collect();
    assert!(edges.len() < n / 2);
    // Each fine crease vertex is near a coarse crease edge, and together these are as long as the ridge is deep.
    for j in 0..=n {
        let p = vector(fine.positions()[ridge(j) as usize]);
        let nearest = edges
            .iter()
            .map(|&[a, b]| triangle_plane::squared_to_segment(p, vector(a), vector(b)))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest.sqrt() <= tolerance);
    }
    let length: f64 = edges.iter().map(|[a, b]| (a[1] - b[1]).abs()).sum();
    assert!((length - 1.0).abs() < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn rough_terrain_keeps_the_tolerance(
        heights in proptest::collection::vec(-0.08f64..0.08, 81),
        share in 0.002f64..0.1,
        levels in 1usize..3,
    ) {
        let rough = square(8, |x, y| heights[((x * 8.0).round() * 9.0 + (y * 8.0).round()) as usize]);
        let fine = limit_reference(&rough, levels);
        let tolerance = share * fine.diagonal();
        let coarse = run(&fine, &within(tolerance));
        let options = SamplingOptions::default().samples(50_000);
        let distance = hausdorff(coarse.mesh.as_triangles(), fine.as_triangles(), &options).unwrap();
        prop_assert!(distance.symmetric() <= tolerance, "{} > {tolerance}", distance.symmetric());
    }
}

#[test]
fn the_bound_holds_for_a_given_number_of_triangles() {
    let fine = limit_reference(&model("head"), 3);
    let coarse = run(&fine, &SimplifyOptions::default().triangles(Some(1500)));
    assert!((1499..=1500).contains(&coarse.mesh.face_count()));
    let options = SamplingOptions::default().samples(200_000);
    let distance = hausdorff(coarse.mesh.as_triangles(), fine.as_triangles(), &options)
        .unwrap()
        .symmetric();
    let bound = coarse.bound.unwrap();
    assert!(
        distance <= bound && bound < 1.1 * distance,
        "{distance} and {bound}"
    );
    // Without proof it is made in one go, and never better.
    let quick = run(
        &fine,
        &SimplifyOptions::default()
            .triangles(Some(1500))
            .certify(false),
    );
    assert_eq!(quick.bound, None);
    let quick = hausdorff(quick.mesh.as_triangles(), fine.as_triangles(), &options)
        .unwrap()
        .symmetric();
    assert!(distance <= 1.01 * quick);
}

/// Encloses the distance by another way: branch and bound over both meshes as a whole.
fn enclosed(coarse: &Simplified, fine: &Mesh) -> (f64, f64) {
    let options = CertifiedOptions::default()
        .gap(Some(1e-12))
        .relative_gap(0.01);
    let distance =
        certified_hausdorff(coarse.mesh.as_triangles(), fine.as_triangles(), &options).unwrap();
    (distance.lower(), distance.upper())
}

#[test]
fn the_proven_bound_holds_and_is_tight() {
    for (name, levels) in [
        ("bumpy", 3),
        ("cup", 2),
        ("head", 3),
        ("sheet", 3),
        ("cusp", 2),
        ("bunny", 2),
    ] {
        let fine = limit_reference(&model(name), levels);
        let tolerance = 0.002 * fine.diagonal();
        let coarse = run(&fine, &within(tolerance));
        let (lower, upper) = enclosed(&coarse, &fine);
        let bound = coarse.bound.unwrap();
        assert!(
            lower <= bound && bound <= tolerance,
            "{name}: {lower} {bound} {tolerance}"
        );
        assert!(
            bound <= 1.05 * upper,
            "{name}: {bound} where {upper} is true"
        );
        // The greater part of the tolerance is used.
        assert!(lower > 0.9 * tolerance, "{name}: {lower} of {tolerance}");
    }
}

#[test]
fn more_tolerance_never_asks_for_more_triangles() {
    let fine = limit_reference(&model("cusp"), 3);
    let mut before = usize::MAX;
    for step in 0..8 {
        let tolerance = 0.0004 * 1.2f64.powi(step) * fine.diagonal();
        let count = run(&fine, &within(tolerance)).mesh.face_count();
        assert!(
            count as f64 <= 1.05 * before as f64,
            "{count} after {before}"
        );
        before = count;
    }
}

#[test]
fn cancelling_gives_what_there_is() {
    let fine = limit_reference(&model("bumpy"), 4);
    let enough = fine.face_count() * 3 / 4;
    let mut observer = |progress: &crate::progress::Progress| match progress.triangles {
        1.. if progress.triangles < enough => core::ops::ControlFlow::Break(()),
        _ => core::ops::ControlFlow::Continue(()),
    };
    let options = SimplifyOptions::default().triangles(Some(100));
    let error =
        simplify_observed(&fine, &Features::default(), &options, &mut observer).unwrap_err();
    let SimplifyError::Cancelled(coarse) = error else {
        panic!("{error}")
    };
    check_invariants(&fine, &coarse);
    assert!((enough / 2..enough).contains(&coarse.mesh.face_count()));
    let (lower, upper) = enclosed(&coarse, &fine);
    let bound = coarse.bound.unwrap();
    assert!(
        lower <= bound && bound <= 1.1 * upper,
        "{lower} {bound} {upper}"
    );
    // Before the first collapse there is the fine mesh.
    let stop = &mut |_: &crate::progress::Progress| core::ops::ControlFlow::Break(());
    let error = simplify_observed(&fine, &Features::default(), &options, stop).unwrap_err();
    assert!(matches!(error, SimplifyError::Cancelled(coarse) if coarse.mesh == fine));
}

#[test]
fn the_observer_is_called_often() {
    let fine = limit_reference(&model("bunny"), 3);
    let (mut last, mut longest, mut least) = (None, core::time::Duration::ZERO, usize::MAX);
    let mut observer = |progress: &crate::progress::Progress| {
        let now = std::time::Instant::now();
        longest = longest.max(last.map_or(core::time::Duration::ZERO, |last| now - last));
        last = Some(now);
        least = least.min(if progress.triangles > 0 {
            progress.triangles
        } else {
            usize::MAX
        });
        core::ops::ControlFlow::Continue(())
    };
    let options = within(0.001 * fine.diagonal());
    let coarse = simplify_observed(&fine, &Features::default(), &options, &mut observer).unwrap();
    assert!(least < 2 * coarse.mesh.face_count(), "{least}");
    // Ten times the documented time: other programs may be running.
    assert!(longest.as_millis() < 1000, "{longest:?}");
}
