//! Limits at their vertices.

use std::f64::consts::TAU;

use limitmesh::interpolate::{
    InterpolateOptions, Interpolated, InterpolationMethod, interpolate as interpolate_within,
};
use limitmesh::mesh::{BoundaryRule, PolygonSoup, Tags};
use limitmesh::refine::ExactOptions;
use limitmesh::refine::limit_reference;
use limitmesh::scheme::{Loop, LoopWarren, Scheme};
use limitmesh::{Mesh, VertexId};
use nalgebra::DMatrix;

use crate::interpolation::{
    dense, dense_solution, farthest, from_limits, interpolate, loop_beta, model,
    refinement_tends_to, tagged,
};
use crate::support::{
    Point, Random, distance, exact, lumpy, octahedron, pool, sheet, torus, within,
};

fn warren_beta(k: f64) -> f64 {
    if k == 3.0 {
        3.0 / 16.0
    } else {
        3.0 / (8.0 * k)
    }
}

#[test]
fn control_points_are_those_of_a_dense_system() {
    let meshes = [
        octahedron(),
        model("tetrahedron"),
        lumpy(40, 1),
        lumpy(150, 2),
        torus(8, 5),
        sheet(6, 5, 3),
        sheet(1, 4, 4),
    ];
    for (i, mesh) in meshes.iter().enumerate() {
        for (scheme, beta) in [
            (&Loop, loop_beta as fn(f64) -> f64),
            (&LoopWarren, warren_beta),
        ] {
            let Interpolated {
                mesh: control,
                method,
                residual,
                displacement,
                most_displaced,
                ..
            } = interpolate(mesh, scheme).unwrap();
            let expected = dense_solution(&dense(mesh, beta), mesh);
            let size = mesh.diagonal();
            assert!(
                farthest(control.positions(), &expected) < 1e-11 * size,
                "mesh {i}, {}",
                scheme.name()
            );
            assert_eq!(method, InterpolationMethod::ConjugateGradients);
            assert!(residual < 1e-13 * size, "mesh {i}: {residual}");
            let moved = farthest(&expected, mesh.positions());
            assert!((moved - displacement).abs() < 1e-11 * size);
            let v = most_displaced.index();
            assert!((distance(expected[v], mesh.positions()[v]) - moved).abs() < 1e-11 * size);
            assert_eq!(control.triangles(), mesh.triangles());
        }
    }
}

/// The documented property of the symmetric system: its eigenvalues after scaling by the diagonal.
#[test]
fn systems_are_as_well_conditioned_as_claimed() {
    for mesh in [
        octahedron(),
        model("tetrahedron"),
        lumpy(40, 1),
        lumpy(100, 5),
        torus(9, 6),
    ] {
        for beta in [loop_beta as fn(f64) -> f64, warren_beta] {
            let mut matrix = dense(&mesh, beta);
            let (mut least, mut most) = (f64::INFINITY, 0.0f64);
            for v in 0..mesh.vertex_count() {
                let k = f64::from(mesh.ring_shape(VertexId(v as u32)).valence);
                let own = 3.0 / (8.0 * beta(k));
                matrix.row_mut(v).scale_mut(own + k);
                least = least.min(1.0 - k / (2.0 * own));
                most = most.max(1.0 + k / own);
            }
            assert!((&matrix - matrix.transpose()).amax() < 1e-14);
            let scale = matrix.diagonal().map(|x| 1.0 / x.sqrt());
            let scaled = DMatrix::from_diagonal(&scale) * matrix * DMatrix::from_diagonal(&scale);
            let eigenvalues = scaled.symmetric_eigenvalues();
            above!(eigenvalues.min(), least - 1e-12);
            below!(eigenvalues.max(), most + 1e-12);
            assert!(most / least < 10.0 + 1e-9, "{}", most / least);
        }
    }
}

#[test]
fn the_steps_do_not_grow_with_the_mesh() {
    let steps = |m, n| interpolate(&torus(m, n), &Loop).unwrap().iterations;
    let (small, large) = (steps(12, 8), steps(96, 64));
    assert!(small <= 30 && large <= 30, "{small}, {large}");
}

#[test]
fn uniform_refinement_tends_to_the_vertices() {
    for mesh in [
        octahedron(),
        model("tetrahedron"),
        lumpy(12, 7),
        sheet(3, 3, 8),
    ] {
        for scheme in [&Loop, &LoopWarren] {
            let control = interpolate(&mesh, scheme).unwrap().mesh;
            refinement_tends_to(&mesh, &control, scheme, 5, 0.03);
        }
    }
}

#[test]
fn creases_darts_and_fading_tags_are_followed() {
    let mut general = 0;
    for seed in 1..9 {
        for mesh in [
            octahedron(),
            lumpy(20, seed),
            sheet(4, 3, seed),
            torus(7, 6),
        ] {
            let mesh = tagged(mesh, seed, seed % 2 == 0);
            let found = interpolate(&mesh, &Loop).unwrap();
            assert_ne!(
                found.method,
                InterpolationMethod::LeastSquares,
                "{seed}: {found:?}"
            );
            general += usize::from(found.method == InterpolationMethod::NormalEquations);
            assert_eq!(found.mesh.tags(), mesh.tags());
            assert!(from_limits(&found, &Loop, &mesh) < 1e-12 * mesh.diagonal());
            if seed < 3 {
                refinement_tends_to(&mesh, &found.mesh, &Loop, 5, 0.05);
            }
        }
    }
    assert!(general > 5, "{general} systems that are not symmetric");
}

#[test]
fn corners_keep_their_place_and_lines_know_nothing_of_their_sides() {
    let flat = model("cube").with_creases_above(0.5).unwrap();
    let found = interpolate(&flat, &Loop).unwrap();
    // All vertices of a cube are corners.
    assert_eq!(
        (&found.mesh, found.method),
        (&flat, InterpolationMethod::Unchanged)
    );

    // A crease round a torus does not depend on the adjacent points.
    let (m, n) = (12, 8);
    let line: Vec<u32> = (0..m).map(|i| i * n).collect();
    let crease =
        |i: usize| crate::support::crease([line[i], line[(i + 1) % line.len()]], f64::INFINITY);
    let tags = Tags {
        creases: (0..line.len()).map(crease).collect(),
        ..Tags::default()
    };
    let mesh = torus(m, n).with_tags(tags).unwrap();
    let mut random = Random::new(3);
    let mut moved = mesh.positions().to_vec();
    for (v, p) in moved
        .iter_mut()
        .enumerate()
        .filter(|&(v, _)| !line.contains(&(v as u32)))
    {
        *p = p.map(|x| x + 0.2 * random.signed() + v as f64 * 1e-3);
    }
    let moved = mesh.clone().with_positions(moved).unwrap();
    let [a, b] = [&mesh, &moved].map(|mesh| interpolate(mesh, &Loop).unwrap().mesh);
    assert_ne!(a.positions(), b.positions());
    // The accuracy that is worth having depends on the whole mesh, and nothing else does.
    for &v in &line {
        assert!(
            distance(a.positions()[v as usize], b.positions()[v as usize])
                < 1e-13 * mesh.diagonal()
        );
    }
}

/// A closed polygonal prism of radius 5 with a vertex in the middle of each cap.
fn peg(facets: u32) -> Mesh {
    let mut positions = Vec::new();
    for height in [-4.0, 0.0, 4.0] {
        for i in 0..facets {
            let (sine, cosine) = (TAU * f64::from(i) / f64::from(facets)).sin_cos();
            positions.push([5.0 * cosine, 5.0 * sine, height]);
        }
    }
    positions.extend([[0.0, 0.0, -4.0], [0.0, 0.0, 4.0]]);
    let (below, above) = (3 * facets, 3 * facets + 1);
    let mut triangles = Vec::new();
    for i in 0..facets {
        let j = (i + 1) % facets;
        for row in [0, facets] {
            triangles.extend([
                [row + i, row + j, row + facets + j],
                [row + i, row + facets + j, row + facets + i],
            ]);
        }
        triangles.extend([[below, j, i], [above, 2 * facets + i, 2 * facets + j]]);
    }
    Mesh::from_triangles(positions, triangles)
        .unwrap()
        .with_creases_above(0.9)
        .unwrap()
}

#[test]
fn pegs_keep_their_radius() {
    // Interpolation by cubics is of fourth order.
    for (facets, least) in [(16, 4.99965), (8, 4.993)] {
        let mesh = peg(facets);
        let control = interpolate(&mesh, &Loop).unwrap().mesh;
        // On the rims the control points are on the circle that a periodic cubic B-spline through the points has.
        let expected = 5.0 / (2.0 / 3.0 + (TAU / f64::from(facets)).cos() / 3.0);
        for v in (0..facets).chain(2 * facets..3 * facets) {
            let [x, y, _] = control.positions()[v as usize];
            below!((x.hypot(y) - expected).abs(), 1e-12, "{expected}");
        }
        let surface = limit_reference(&control, &Loop, 4).unwrap();
        let rims = surface
            .positions()
            .iter()
            .filter(|p| p[2].abs() > 4.0 - 1e-9 && p[0].hypot(p[1]) > 4.95);
        let radii: Vec<f64> = rims.map(|p| p[0].hypot(p[1])).collect();
        let worst = radii.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(radii.len() > 100 && worst >= least, "{worst}");
        assert!(radii.iter().all(|&r| r <= 5.0 + 1e-12));
        // The plain limit loses several per cent.
        let plain = limit_reference(&mesh, &Loop, 4).unwrap();
        let most = plain
            .positions()
            .iter()
            .map(|p| p[0].hypot(p[1]))
            .fold(0.0, f64::max);
        assert!(most < 4.9, "{most}");
    }
}

#[test]
fn an_exact_refinement_meets_every_vertex() {
    let mesh = model("cup");
    let control = interpolate(&mesh, &Loop).unwrap().mesh;
    let tolerance = 0.001 * mesh.diagonal();
    let refined = exact(&control, &Loop, &within(tolerance)).unwrap();
    assert!(refined.error.certified && refined.error.upper <= tolerance);
    let vertices = &refined.mesh.positions()[..mesh.vertex_count()];
    assert!(farthest(vertices, mesh.positions()) < 1e-12 * mesh.diagonal());
}

/// Sheets that share an edge or only a vertex, in one soup.
#[test]
fn copies_where_sheets_were_cut_keep_the_same_bits() {
    // Three fans of a strip around one line of several edges, which bends.
    let line: Vec<Point> = (0..6)
        .map(|i| [f64::from(i), 0.3 * f64::from(i * i % 5), 0.1 * f64::from(i)])
        .collect();
    let mut positions = line.clone();
    let mut faces = Vec::new();
    for sheet in 0..3 {
        let (sine, cosine) = (2.0 * f64::from(sheet) + 0.3).sin_cos();
        let first = positions.len() as u32;
        for row in 1..4 {
            let out = f64::from(row);
            positions.extend(line.iter().map(|p| {
                [
                    p[0] + 0.05 * out * out,
                    p[1] + out * cosine,
                    p[2] + out * sine,
                ]
            }));
        }
        let at = |row: u32, i: u32| {
            if row == 0 {
                i
            } else {
                first + 6 * (row - 1) + i
            }
        };
        for (row, i) in (0..3).flat_map(|row| (0..5).map(move |i| (row, i))) {
            faces.push([at(row, i), at(row + 1, i), at(row + 1, i + 1)]);
            faces.push([at(row, i), at(row + 1, i + 1), at(row, i + 1)]);
        }
    }
    let mut soup = PolygonSoup {
        positions,
        ..PolygonSoup::default()
    };
    faces.iter().for_each(|face| soup.faces.push(face));
    for rule in [BoundaryRule::Smooth, BoundaryRule::Corners] {
        let (mesh, diagnosis) = Mesh::from_soup(&soup, &Default::default()).unwrap();
        assert_eq!(diagnosis.non_manifold_edges.count, 5);
        let mesh = mesh.with_boundary(rule);
        let found = interpolate(&mesh, &Loop).unwrap();
        // Copies at one place, to the last bit.
        found.mesh.validate().unwrap();
        assert!(found.displacement > 0.01);
        assert!(found.mesh.junctions().vertices.iter().any(|group| {
            let v = group[0] as usize;
            distance(found.mesh.positions()[v], mesh.positions()[v]) > 0.01
        }));
        assert!(from_limits(&found, &Loop, &mesh) < 1e-12 * mesh.diagonal());
        let refined = exact(&found.mesh, &Loop, &ExactOptions::default().triangles(3000)).unwrap();
        refined.mesh.validate().unwrap();
    }
}

#[test]
fn the_same_bytes_come_out_of_any_number_of_threads() {
    // Above 4096 vertices sums are shared among threads. Systems that are not symmetric take longer: those exactly.
    let fine = torus(84, 60);
    for (mesh, part) in [(fine.clone(), 1e-3), (tagged(fine, 5, false), 0.0)] {
        let bits = |threads| {
            let pool = pool(threads);
            let options = [0.0, part * mesh.diagonal()]
                .map(|within| InterpolateOptions::default().within(within));
            options.map(|options| {
                let found = pool.install(|| interpolate_within(&mesh, &Loop, &options).unwrap());
                let bits = |mesh: &Mesh| {
                    mesh.positions()
                        .as_flattened()
                        .iter()
                        .map(|x| x.to_bits())
                        .collect::<Vec<_>>()
                };
                (
                    bits(&found.mesh),
                    found.iterations,
                    found.residual.to_bits(),
                    found.fairness,
                )
            })
        };
        let one = bits(1);
        assert!([2, 5].map(bits).iter().all(|other| *other == one));
    }
}

/// Coordinates of any size and far from the origin cost no digits that they have.
#[test]
fn any_size_and_place_will_do() {
    let mesh = lumpy(30, 9);
    let plain = interpolate(&mesh, &Loop).unwrap();
    for factor in [2f64.powi(-900), 2f64.powi(700)] {
        let scaled = |mesh: &Mesh| {
            mesh.positions()
                .iter()
                .map(|p| p.map(|x| x * factor))
                .collect::<Vec<_>>()
        };
        let found =
            interpolate(&mesh.clone().with_positions(scaled(&mesh)).unwrap(), &Loop).unwrap();
        assert_eq!(found.mesh.positions(), scaled(&plain.mesh));
        assert_eq!(
            (found.iterations, found.method),
            (plain.iterations, plain.method)
        );
    }
    let far: Vec<Point> = mesh
        .positions()
        .iter()
        .map(|p| p.map(|x| x + 1e6))
        .collect();
    let far = mesh.clone().with_positions(far).unwrap();
    let found = interpolate(&far, &Loop).unwrap();
    assert!(from_limits(&found, &Loop, &far) < 1e-9);
    for (p, q) in plain.mesh.positions().iter().zip(found.mesh.positions()) {
        assert!(distance(p.map(|x| x + 1e6), *q) < 1e-8);
    }
    assert_eq!(found.method, InterpolationMethod::ConjugateGradients);
}

#[test]
fn poles_and_small_rings_have_solutions() {
    // Two faces back to back: three vertices with two edges each.
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 1.0, 0.3]];
    let pillow = Mesh::from_triangles(positions, vec![[0, 1, 2], [0, 2, 1]]).unwrap();
    // Two vertices with a great many.
    let k = 3000;
    let mut positions: Vec<Point> = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    let mut triangles = Vec::new();
    for i in 0..k {
        let (sine, cosine) = (TAU * f64::from(i) / f64::from(k)).sin_cos();
        positions.push([cosine, sine, 0.0]);
        let (a, b) = (2 + i, 2 + (i + 1) % k);
        triangles.extend([[0, a, b], [1, b, a]]);
    }
    let spindle = Mesh::from_triangles(positions, triangles).unwrap();
    for mesh in [pillow, spindle] {
        for scheme in [&Loop, &LoopWarren] {
            let found = interpolate(&mesh, scheme).unwrap();
            assert_eq!(
                found.method,
                InterpolationMethod::ConjugateGradients,
                "{}",
                scheme.name()
            );
            assert!(from_limits(&found, scheme, &mesh) < 1e-12 * mesh.diagonal());
        }
    }
}
