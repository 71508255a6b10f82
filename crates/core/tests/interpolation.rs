//! Control points whose limit surface passes through given vertices, against dense systems built from closed forms, against
//! uniform refinement, and against circles.

#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use std::f64::consts::TAU;

use limitmesh::interpolate::{
    InterpolateError, InterpolateOptions, Interpolated, InterpolationMethod,
    interpolate as interpolate_within,
};
use limitmesh::limit::LimitTable;
use limitmesh::measure::limit_reference;
use limitmesh::mesh::{BoundaryRule, CornerTag, CreaseTag, PolygonSoup, Tags};
use limitmesh::refine::{ExactOptions, UniformOptions, exact, uniform};
use limitmesh::ring::{EdgeShape, RingShape, VertexKind};
use limitmesh::scheme::{EdgeMask, Loop, LoopWarren, ModifiedButterfly, Scheme, Support, VertexMask};
use limitmesh::{Mesh, VertexId};
use nalgebra::{DMatrix, DVector};
use support::{Point, Random, distance, lumpy, octahedron, sheet, torus};

fn interpolate(mesh: &Mesh, scheme: &dyn Scheme) -> Result<Interpolated, InterpolateError> {
    interpolate_within(mesh, scheme, &InterpolateOptions::default())
}

fn model(name: &str) -> Mesh {
    Mesh::from_soup(&limitmesh_models::find(name).unwrap().soup(), &Default::default()).unwrap().0
}

/// The greatest distance of the library's limits from the vertices of a mesh.
fn from_limits(control: &Mesh, scheme: &dyn Scheme, vertices: &Mesh) -> f64 {
    let limits = LimitTable::new(scheme).positions(control).unwrap();
    farthest(&limits, vertices.positions())
}

fn farthest(a: &[Point], b: &[Point]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(&a, &b)| distance(a, b)).fold(0.0, f64::max)
}

/// The limit weights of a mesh without tags, from closed forms alone: `β` is the weight of an interior vertex's neighbours.
fn dense(mesh: &Mesh, beta: impl Fn(f64) -> f64) -> DMatrix<f64> {
    let n = mesh.vertex_count();
    let (mut faces, mut neighbours) = (std::collections::BTreeMap::new(), vec![Vec::new(); n]);
    for &[a, b, c] in mesh.triangles() {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            *faces.entry([p.min(q), p.max(q)]).or_insert(0) += 1;
        }
    }
    for (&[a, b], &count) in &faces {
        neighbours[a as usize].push((b as usize, count));
        neighbours[b as usize].push((a as usize, count));
    }
    let mut matrix = DMatrix::zeros(n, n);
    for (v, around) in neighbours.iter().enumerate() {
        let boundary: Vec<usize> = around.iter().filter(|&&(_, count)| count == 1).map(|&(u, _)| u).collect();
        if let [a, b] = boundary[..] {
            matrix[(v, v)] = 2.0 / 3.0;
            (matrix[(v, a)], matrix[(v, b)]) = (1.0 / 6.0, 1.0 / 6.0);
            continue;
        }
        let k = around.len() as f64;
        let own = 3.0 / (8.0 * beta(k));
        matrix[(v, v)] = own / (own + k);
        around.iter().for_each(|&(u, _)| matrix[(v, u)] = 1.0 / (own + k));
    }
    matrix
}

fn loop_beta(k: f64) -> f64 {
    (0.625 - (0.375 + 0.25 * (TAU / k).cos()).powi(2)) / k
}

fn warren_beta(k: f64) -> f64 {
    if k == 3.0 { 3.0 / 16.0 } else { 3.0 / (8.0 * k) }
}

/// Solves a dense system for the points of a mesh.
fn dense_solution(matrix: &DMatrix<f64>, mesh: &Mesh) -> Vec<Point> {
    let lu = matrix.clone().lu();
    let axis = |axis: usize| {
        let right = DVector::from_iterator(mesh.vertex_count(), mesh.positions().iter().map(|p| p[axis]));
        lu.solve(&right).unwrap()
    };
    let [x, y, z] = [axis(0), axis(1), axis(2)];
    (0..mesh.vertex_count()).map(|v| [x[v], y[v], z[v]]).collect()
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
        for (scheme, beta) in [(&Loop, loop_beta as fn(f64) -> f64), (&LoopWarren, warren_beta)] {
            let Interpolated { mesh: control, method, residual, displacement, most_displaced, .. } =
                interpolate(mesh, scheme).unwrap();
            let expected = dense_solution(&dense(mesh, beta), mesh);
            let size = mesh.diagonal();
            assert!(farthest(control.positions(), &expected) < 1e-11 * size, "mesh {i}, {}", scheme.name());
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

/// What the documentation claims of the symmetric system: its eigenvalues after scaling by the diagonal.
#[test]
fn systems_are_as_well_conditioned_as_claimed() {
    for mesh in [octahedron(), model("tetrahedron"), lumpy(40, 1), lumpy(100, 5), torus(9, 6)] {
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
            assert!(eigenvalues.min() > least - 1e-12, "{} {least}", eigenvalues.min());
            assert!(eigenvalues.max() < most + 1e-12, "{} {most}", eigenvalues.max());
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

/// Uniform refinement brings each old vertex nearer to its limit, without any limit stencil.
fn refinement_tends_to(vertices: &Mesh, control: &Mesh, scheme: &dyn Scheme, levels: usize, near: f64) {
    let refined = uniform(control, scheme, &UniformOptions::default().levels(levels)).unwrap().mesh;
    let away = farthest(&refined.positions()[..vertices.vertex_count()], vertices.positions());
    let before = farthest(control.positions(), vertices.positions());
    assert!(away < near * before, "{}: {away} of {before}", scheme.name());
}

#[test]
fn uniform_refinement_tends_to_the_vertices() {
    for mesh in [octahedron(), model("tetrahedron"), lumpy(12, 7), sheet(3, 3, 8)] {
        for scheme in [&Loop, &LoopWarren] {
            let control = interpolate(&mesh, scheme).unwrap().mesh;
            refinement_tends_to(&mesh, &control, scheme, 5, 0.03);
        }
    }
}

/// Tags on some edges and vertices, many of them fading, some single ones that end in darts.
fn tagged(mesh: Mesh, seed: u64, lasting_only: bool) -> Mesh {
    let mut random = Random::new(seed);
    let mut sharpness = |one_in| {
        let is_tagged = random.below(one_in) == 0;
        let fading = 1.6 + 1.5 * random.signed();
        is_tagged.then_some(if lasting_only || random.below(2) == 0 { f64::INFINITY } else { fading })
    };
    let mut tags = Tags::default();
    let topology = mesh.topology();
    for h in topology.half_edges().filter(|&h| topology.twin(h).is_some_and(|twin| h < twin)) {
        let vertices = topology.ends(h).map(|v| v.0);
        tags.creases.extend(sharpness(8).map(|sharpness| CreaseTag { vertices, sharpness }));
    }
    for vertex in 0..mesh.vertex_count() as u32 {
        tags.corners.extend(sharpness(15).map(|sharpness| CornerTag { vertex, sharpness }));
    }
    mesh.with_tags(tags).unwrap()
}

#[test]
fn creases_darts_and_fading_tags_are_followed() {
    let mut general = 0;
    for seed in 1..9 {
        for mesh in [octahedron(), lumpy(20, seed), sheet(4, 3, seed), torus(7, 6)] {
            let mesh = tagged(mesh, seed, seed % 2 == 0);
            let found = interpolate(&mesh, &Loop).unwrap();
            assert_ne!(found.method, InterpolationMethod::LeastSquares, "{seed}: {found:?}");
            general += usize::from(found.method == InterpolationMethod::NormalEquations);
            assert_eq!(found.mesh.tags(), mesh.tags());
            assert!(from_limits(&found.mesh, &Loop, &mesh) < 1e-12 * mesh.diagonal());
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
    assert_eq!((&found.mesh, found.method), (&flat, InterpolationMethod::Unchanged));

    // A crease round a torus is the same whatever the points beside it.
    let (m, n) = (12, 8);
    let line: Vec<u32> = (0..m).map(|i| i * n).collect();
    let crease =
        |i: usize| CreaseTag { vertices: [line[i], line[(i + 1) % line.len()]], sharpness: f64::INFINITY };
    let tags = Tags { creases: (0..line.len()).map(crease).collect(), ..Tags::default() };
    let mesh = torus(m, n).with_tags(tags).unwrap();
    let mut random = Random::new(3);
    let mut moved = mesh.positions().to_vec();
    for (v, p) in moved.iter_mut().enumerate().filter(|&(v, _)| !line.contains(&(v as u32))) {
        *p = p.map(|x| x + 0.2 * random.signed() + v as f64 * 1e-3);
    }
    let moved = mesh.clone().with_positions(moved).unwrap();
    let [a, b] = [&mesh, &moved].map(|mesh| interpolate(mesh, &Loop).unwrap().mesh);
    assert_ne!(a.positions(), b.positions());
    // The accuracy that is worth having depends on the whole mesh, and nothing else does.
    for &v in &line {
        assert!(distance(a.positions()[v as usize], b.positions()[v as usize]) < 1e-13 * mesh.diagonal());
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
    Mesh::from_triangles(positions, triangles).unwrap().with_creases_above(0.9).unwrap()
}

#[test]
fn pegs_keep_their_radius() {
    // By the spline alone, the least radius between two of n points on a circle of radius 5 (Catmull and Rom's remark that
    // cubic interpolation is of fourth order): 16 points lose less than 6e-5 of it, 8 points less than 1.3e-3.
    for (facets, least) in [(16, 4.9997), (8, 4.994)] {
        let mesh = peg(facets);
        let control = interpolate(&mesh, &Loop).unwrap().mesh;
        // On the rims the control points are on the circle that a periodic cubic B-spline through the points has.
        let expected = 5.0 / (2.0 / 3.0 + (TAU / f64::from(facets)).cos() / 3.0);
        for v in (0..facets).chain(2 * facets..3 * facets) {
            let [x, y, _] = control.positions()[v as usize];
            assert!((x.hypot(y) - expected).abs() < 1e-12, "{} {expected}", x.hypot(y));
        }
        let surface = limit_reference(&control, &Loop, 4).unwrap();
        let rims = surface.positions().iter().filter(|p| p[2].abs() > 4.0 - 1e-9 && p[0].hypot(p[1]) > 4.95);
        let radii: Vec<f64> = rims.map(|p| p[0].hypot(p[1])).collect();
        let worst = radii.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(radii.len() > 100 && worst >= least, "{worst}");
        assert!(radii.iter().all(|&r| r <= 5.0 + 1e-12));
        // The plain limit loses several per cent.
        let plain = limit_reference(&mesh, &Loop, 4).unwrap();
        let most = plain.positions().iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
        assert!(most < 4.9, "{most}");
    }
}

#[test]
fn an_exact_refinement_meets_every_vertex() {
    let mesh = model("cup");
    let control = interpolate(&mesh, &Loop).unwrap().mesh;
    let tolerance = 0.001 * mesh.diagonal();
    let refined = exact(&control, &Loop, &ExactOptions::default().tolerance(tolerance)).unwrap();
    assert!(refined.error.certified && refined.error.upper <= tolerance);
    let vertices = &refined.mesh.positions()[..mesh.vertex_count()];
    assert!(farthest(vertices, mesh.positions()) < 1e-12 * mesh.diagonal());
}

/// Sheets that share an edge or only a vertex, in one soup.
#[test]
fn copies_where_sheets_were_cut_keep_the_same_bits() {
    // Three fans of a strip around one line of several edges, which bends.
    let line: Vec<Point> =
        (0..6).map(|i| [f64::from(i), 0.3 * f64::from(i * i % 5), 0.1 * f64::from(i)]).collect();
    let mut positions = line.clone();
    let mut faces = Vec::new();
    for sheet in 0..3 {
        let (sine, cosine) = (2.0 * f64::from(sheet) + 0.3).sin_cos();
        let first = positions.len() as u32;
        for row in 1..4 {
            let out = f64::from(row);
            positions.extend(
                line.iter().map(|p| [p[0] + 0.05 * out * out, p[1] + out * cosine, p[2] + out * sine]),
            );
        }
        let at = |row: u32, i: u32| if row == 0 { i } else { first + 6 * (row - 1) + i };
        for (row, i) in (0..3).flat_map(|row| (0..5).map(move |i| (row, i))) {
            faces.push([at(row, i), at(row + 1, i), at(row + 1, i + 1)]);
            faces.push([at(row, i), at(row + 1, i + 1), at(row, i + 1)]);
        }
    }
    let mut soup = PolygonSoup { positions, ..PolygonSoup::default() };
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
        assert!(from_limits(&found.mesh, &Loop, &mesh) < 1e-12 * mesh.diagonal());
        let refined = exact(&found.mesh, &Loop, &ExactOptions::default().triangles(3000)).unwrap();
        refined.mesh.validate().unwrap();
    }
}

#[test]
fn the_same_bytes_come_out_of_any_number_of_threads() {
    let fine = uniform(&lumpy(60, 4), &Loop, &UniformOptions::default().levels(3)).unwrap().mesh;
    for mesh in [fine.clone(), tagged(fine, 5, false)] {
        let bits = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let options =
                [0.0, 1e-3 * mesh.diagonal()].map(|within| InterpolateOptions::default().within(within));
            options.map(|options| {
                let found = pool.install(|| interpolate_within(&mesh, &Loop, &options).unwrap());
                let bits = |mesh: &Mesh| {
                    mesh.positions().as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>()
                };
                (bits(&found.mesh), found.iterations, found.residual.to_bits(), found.fairness)
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
        let scaled = |mesh: &Mesh| mesh.positions().iter().map(|p| p.map(|x| x * factor)).collect::<Vec<_>>();
        let found = interpolate(&mesh.clone().with_positions(scaled(&mesh)).unwrap(), &Loop).unwrap();
        assert_eq!(found.mesh.positions(), scaled(&plain.mesh));
        assert_eq!((found.iterations, found.method), (plain.iterations, plain.method));
    }
    let far: Vec<Point> = mesh.positions().iter().map(|p| p.map(|x| x + 1e6)).collect();
    let far = mesh.clone().with_positions(far).unwrap();
    let found = interpolate(&far, &Loop).unwrap();
    assert!(from_limits(&found.mesh, &Loop, &far) < 1e-9);
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
            assert_eq!(found.method, InterpolationMethod::ConjugateGradients, "{}", scheme.name());
            assert!(from_limits(&found.mesh, scheme, &mesh) < 1e-12 * mesh.diagonal());
        }
    }
}

#[test]
fn a_scheme_that_interpolates_changes_nothing() {
    let mesh = tagged(lumpy(20, 3), 4, false);
    let found = interpolate(&mesh, &ModifiedButterfly).unwrap();
    assert_eq!((&found.mesh, found.method), (&mesh, InterpolationMethod::Unchanged));
    assert_eq!((found.residual, found.displacement, found.iterations), (0.0, 0.0, 0));
}

/// Loop's edges, and vertices with another weight for their neighbours together.
struct Weighted {
    ring: f64,
}

impl Scheme for Weighted {
    fn name(&self) -> &str {
        "weighted"
    }
    fn support(&self) -> Support {
        Support::OneRing
    }
    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        if shape.kind() != VertexKind::Interior {
            return Loop.vertex_mask(shape);
        }
        let k = shape.valence as usize;
        VertexMask { centre: 1.0 - self.ring, ring: vec![self.ring / k as f64; k] }
    }
    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        Loop.edge_mask(shape)
    }
}

/// The butterfly's edges, and vertices that do not stay.
struct Drifting;

impl Scheme for Drifting {
    fn name(&self) -> &str {
        "drifting"
    }
    fn support(&self) -> Support {
        Support::TwoRing
    }
    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        let k = shape.valence as usize;
        match shape.kind() {
            VertexKind::Interior => VertexMask { centre: 0.9, ring: vec![0.1 / k as f64; k] },
            _ => ModifiedButterfly.vertex_mask(shape),
        }
    }
    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        ModifiedButterfly.edge_mask(shape)
    }
}

#[test]
fn other_schemes_are_solved_for_too() {
    for mesh in [lumpy(30, 2), sheet(6, 5, 3), torus(9, 6)] {
        for scheme in [&Weighted { ring: 0.3 } as &dyn Scheme, &Drifting] {
            let found = interpolate(&mesh, scheme).unwrap();
            assert_ne!(found.method, InterpolationMethod::LeastSquares, "{}", scheme.name());
            assert!(found.displacement > 1e-3);
            assert!(from_limits(&found.mesh, scheme, &mesh) < 1e-12 * mesh.diagonal(), "{}", scheme.name());
            refinement_tends_to(&mesh, &found.mesh, scheme, 3, 0.3);
        }
    }
}

/// Where all neighbours' weights are such that a pattern of three colours vanishes in the limit, no control points have any
/// limit with that pattern; the answer is that of least squares.
#[test]
fn what_has_no_solution_is_called_least_squares() {
    // w + 6u = 1 and w = 3u: the limit weights 1/3 and 1/9, where the neighbours together have c with 3/(8β) = 3, kβ = 3/4.
    let scheme = Weighted { ring: 0.75 };
    let mut random = Random::new(8);
    let mesh = torus(9, 6);
    let moved = mesh.positions().iter().map(|p| p.map(|x| x + 0.1 * random.signed())).collect();
    let mesh = mesh.with_positions(moved).unwrap();
    let found = interpolate(&mesh, &scheme).unwrap();
    assert_eq!(found.method, InterpolationMethod::LeastSquares);
    let matrix = dense(&mesh, |k| 0.75 / k);
    let svd = matrix.clone().svd(true, true);
    assert!(svd.singular_values.min() < 1e-12);
    let axis = |axis: usize| {
        let away = DVector::from_iterator(mesh.vertex_count(), mesh.positions().iter().map(|p| p[axis]));
        let right = &away - &matrix * &away;
        svd.solve(&right, 1e-9).unwrap()
    };
    let [x, y, z] = [axis(0), axis(1), axis(2)];
    for (v, (p, q)) in mesh.positions().iter().zip(found.mesh.positions()).enumerate() {
        let expected = [p[0] + x[v], p[1] + y[v], p[2] + z[v]];
        assert!(distance(*q, expected) < 1e-9, "{v}: {q:?} {expected:?}");
    }
    assert!((found.residual - from_limits(&found.mesh, &scheme, &mesh)).abs() < 1e-12);
    assert!(found.residual > 1e-3);
}

#[test]
fn what_has_no_limit_is_an_error() {
    struct Broken;
    impl Scheme for Broken {
        fn name(&self) -> &str {
            "broken"
        }
        fn support(&self) -> Support {
            Support::OneRing
        }
        fn vertex_mask(&self, shape: RingShape) -> VertexMask {
            VertexMask { centre: 2.0, ring: vec![0.0; shape.valence as usize] }
        }
        fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
            Loop.edge_mask(shape)
        }
    }
    let error = interpolate(&octahedron(), &Broken).unwrap_err();
    assert!(error.to_string().contains("broken"), "{error}");
    // A control point beyond the greatest number.
    let huge = octahedron().positions().iter().map(|p| p.map(|x| x * 1.2e308)).collect();
    let huge = octahedron().with_positions(huge).unwrap();
    assert!(interpolate(&huge, &Loop).is_err());
    let corner = CornerTag { vertex: 0, sharpness: f64::INFINITY };
    let tags = Tags { corners: vec![corner], ..Tags::default() };
    assert!(interpolate(&octahedron().with_tags(tags).unwrap(), &Loop).is_ok());
}

/// The energy that the documentation names, on a mesh without tags.
fn thin_plate(mesh: &Mesh) -> f64 {
    let topology = mesh.topology();
    let of = |v: VertexId| {
        let ring: Vec<VertexId> = topology.ring(v).collect();
        let ends = if topology.is_boundary(v) { vec![ring[0], ring[ring.len() - 1]] } else { ring };
        let at = |v: VertexId| mesh.positions()[v.index()];
        (0..3)
            .map(|i| (ends.iter().map(|&u| at(u)[i]).sum::<f64>() / ends.len() as f64 - at(v)[i]).powi(2))
            .sum::<f64>()
    };
    topology.vertices().map(of).sum::<f64>() / 2.0
}

#[test]
fn limits_stay_within_and_the_net_gets_fairer() {
    for mesh in [
        octahedron(),
        lumpy(60, 6),
        sheet(7, 6, 2),
        tagged(lumpy(40, 2), 3, true),
        tagged(torus(9, 7), 1, false),
    ] {
        let size = mesh.diagonal();
        let through = interpolate(&mesh, &Loop).unwrap();
        let (mut energy, mut share) = (thin_plate(&through.mesh), 1.0);
        for within in [1e-4, 1e-3, 1e-2, 3e-2].map(|part| part * size) {
            let options = InterpolateOptions::default().within(within);
            let found = interpolate_within(&mesh, &Loop, &options).unwrap();
            let away = from_limits(&found.mesh, &Loop, &mesh);
            assert!(away <= within + 1e-12 * size && away > 0.3 * within, "{away} of {within}");
            assert!((away - found.residual).abs() < 1e-12 * size);
            let fairness = found.fairness.unwrap();
            assert!(fairness.least_energy <= fairness.energy && fairness.energy < share);
            assert!(fairness.least_energy > 0.99 * fairness.energy, "{fairness:?}");
            share = fairness.energy;
            if mesh.tags().is_empty() {
                let now = thin_plate(&found.mesh);
                assert!(now < energy, "{now} {energy}");
                energy = now;
            }
        }
    }
}

/// On a closed mesh the whole surface is one region: no feasible control mesh may be fairer than what is proven.
#[test]
fn no_other_net_is_fairer_than_proven() {
    let mesh = lumpy(25, 4);
    let within = 0.01 * mesh.diagonal();
    let matrix = dense(&mesh, loop_beta);
    let through = thin_plate(&interpolate(&mesh, &Loop).unwrap().mesh);
    let found = interpolate_within(&mesh, &Loop, &InterpolateOptions::default().within(within)).unwrap();
    let fairness = found.fairness.unwrap();
    assert!((thin_plate(&found.mesh) / through - fairness.energy).abs() < 1e-4);
    // Limits moved at random, and a little from those found, by projection into the balls.
    let limits = LimitTable::new(&Loop).positions(&found.mesh).unwrap();
    let mut random = Random::new(5);
    for try_ in 0..200 {
        let far = within * 0.5f64.powi(try_ % 12);
        let near: Vec<Point> = limits
            .iter()
            .zip(mesh.positions())
            .map(|(&limit, &v)| {
                let moved = limit.map(|x| x + far * random.signed());
                let away = distance(moved, v);
                let part = (within / away).min(1.0);
                [0, 1, 2].map(|i| v[i] + part * (moved[i] - v[i]))
            })
            .collect();
        let other = mesh.clone().with_positions(near).unwrap();
        let net = other.clone().with_positions(dense_solution(&matrix, &other)).unwrap();
        assert!(thin_plate(&net) / through >= fairness.least_energy);
        assert!(thin_plate(&net) / through >= 0.998 * fairness.energy, "{try_}");
    }
}

/// Where nothing holds it back, the fairest line is straight: a boundary between two corners, its limits within reach.
#[test]
fn lines_within_reach_of_straight_ones_get_straight() {
    let mut positions: Vec<Point> =
        (0..=10).map(|i| [f64::from(i), 0.0, 0.05 * f64::from(i % 3) - 0.05]).collect();
    positions.extend((0..=10).map(|i| [f64::from(i), 3.0, 0.0]));
    let mut triangles = Vec::new();
    for i in 0..10 {
        triangles.extend([[i, i + 1, i + 12], [i, i + 12, i + 11]]);
    }
    positions[0][2] = 0.0;
    positions[10][2] = 0.0;
    let corners = [0, 10, 11, 21].map(|vertex| CornerTag { vertex, sharpness: f64::INFINITY }).to_vec();
    let tags = Tags { corners, ..Tags::default() };
    let mesh = Mesh::from_triangles(positions, triangles).unwrap().with_tags(tags).unwrap();
    let found = interpolate_within(&mesh, &Loop, &InterpolateOptions::default().within(0.06)).unwrap();
    let fairness = found.fairness.unwrap();
    assert!(fairness.energy < 1e-6, "{fairness:?}");
    assert!(found.mesh.positions().iter().all(|p| p[2].abs() < 1e-2));
    // Corners keep their place.
    for v in [0, 10, 11, 21] {
        assert_eq!(found.mesh.positions()[v], mesh.positions()[v]);
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let error = interpolate_within(&mesh, &Loop, &InterpolateOptions::default().within(bad)).unwrap_err();
        assert!(matches!(error, InterpolateError::Mesh(_)), "{error}");
    }
}
