use super::*;
use crate::limit::LimitTable;
use crate::mesh::{CornerTag, CreaseTag, Tags};
use crate::scheme::{Loop, LoopWarren};

/// The result by steps, one after another, and stencils at every vertex.
fn by_steps(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    levels: usize,
) -> (Mesh, Vec<[f64; 3]>, crate::limit::SidedNormals) {
    let mesh = uniform(mesh, scheme, &UniformOptions::default().levels(levels))
        .unwrap()
        .mesh;
    let table = LimitTable::new(scheme);
    let (positions, normals) = (
        table.positions(&mesh).unwrap(),
        table.sided_normals(&mesh).unwrap(),
    );
    (mesh, positions, normals)
}

fn together(mesh: &Mesh, scheme: &dyn Scheme, levels: usize) -> Refinement {
    let options = UniformOptions::default()
        .levels(levels)
        .limit(true)
        .normals(true);
    uniform(mesh, scheme, &options).unwrap()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3)
        .map(|axis| (a[axis] - b[axis]).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// The result without connections equals the mesh.
fn check_triangles(name: &str, control: &Mesh, scheme: &dyn Scheme, options: &UniformOptions) {
    let found = uniform_triangles(control, scheme, options).unwrap();
    let Refinement {
        mesh,
        normals,
        steps,
        stop,
        ..
    } = uniform(control, scheme, options).unwrap();
    assert!(
        found.as_triangles().triangles == mesh.topology().triangles(),
        "{name}: the triangles"
    );
    assert!(found.positions == mesh.positions(), "{name}: the positions");
    assert_eq!((found.levels, found.stop), (steps.len(), stop), "{name}");
    let Some(normals) = normals else {
        assert!(found.normals.is_empty() && found.sides.is_empty(), "{name}");
        return;
    };
    assert!(found.normals == normals.by_vertex(), "{name}: the normals");
    for h in mesh.topology().half_edges() {
        let side = found
            .sides
            .binary_search_by_key(&h.0, |&(corner, _)| corner);
        let of_vertex = found.normals[mesh.topology().origin(h).index()];
        let normal = side.map_or(of_vertex, |i| found.sides[i].1);
        assert_eq!(normal, normals.at(mesh.topology(), h), "{name}: {h}");
    }
}

/// Everything that steps and stencils give, by another way.
fn check(name: &str, control: &Mesh, scheme: &dyn Scheme, levels: usize) {
    let (mesh, positions, normals) = by_steps(control, scheme, levels);
    let found = together(control, scheme, levels);
    assert!(
        found.mesh.topology() == mesh.topology(),
        "{name}: the topology"
    );
    assert_eq!(found.mesh.tags(), mesh.tags(), "{name}");
    assert_eq!(found.steps.len(), levels);
    check_triangles(
        name,
        control,
        scheme,
        &UniformOptions::default()
            .levels(levels)
            .limit(true)
            .normals(true),
    );
    let (diagonal, topology) = (control.diagonal(), mesh.topology());
    for (v, (&a, &b)) in found.mesh.positions().iter().zip(&positions).enumerate() {
        assert!(
            distance(a, b) <= 1e-12 * diagonal,
            "{name}, level {levels}: vertex {v} is at {a:?}, not {b:?}"
        );
    }
    let sided = found.normals.unwrap();
    for (v, (&a, &b)) in sided
        .by_vertex()
        .iter()
        .zip(normals.by_vertex())
        .enumerate()
    {
        assert!(
            distance(a, b) <= 1e-9,
            "{name}, level {levels}: vertex {v} has the normal {a:?}, not {b:?}"
        );
    }
    for h in topology.half_edges() {
        let (a, b) = (sided.at(topology, h), normals.at(topology, h));
        assert!(
            distance(a, b) <= 1e-9,
            "{name}, level {levels}: {h} has the normal {a:?}, not {b:?}"
        );
    }
}

/// A sheet of 6 × 5 quadrilaterals, cut this way and that, bent, with vertices of many valences and a boundary.
fn sheet() -> Mesh {
    let mut triangles = Vec::new();
    for y in 0..5u32 {
        for x in 0..6u32 {
            let [a, b, c, d] = [y * 7 + x, y * 7 + x + 1, y * 7 + x + 8, y * 7 + x + 7];
            let cut = if (x * 5 + y * 3) % 4 == 0 {
                [[a, b, d], [b, c, d]]
            } else {
                [[a, b, c], [a, c, d]]
            };
            triangles.extend(cut);
        }
    }
    let at = |v: u32| {
        let (x, y) = (f64::from(v % 7), f64::from(v / 7));
        [
            x + 0.2 * (3.0 * y).sin(),
            y - 0.2 * (2.0 * x).cos(),
            (0.7 * x).sin() * (0.9 * y).cos() + 0.1 * (x * y).sin(),
        ]
    };
    Mesh::from_triangles((0..42).map(at).collect(), triangles).unwrap()
}

/// Two pyramids over one base: tips with as many edges as that, the others with four.
fn pyramids(base: u32) -> Mesh {
    let around = |v: u32| {
        let (sine, cosine) = (core::f64::consts::TAU * f64::from(v) / f64::from(base)).sin_cos();
        [cosine, 1.3 * sine, 0.2 * (2.0 * cosine).sin()]
    };
    let positions = (0..base)
        .map(around)
        .chain([[0.1, 0.0, 1.1], [0.0, 0.2, -0.9]])
        .collect();
    let faces = (0..base)
        .flat_map(|v| [[v, (v + 1) % base, base], [(v + 1) % base, v, base + 1]])
        .collect();
    Mesh::from_triangles(positions, faces).unwrap()
}

#[test]
fn levels_done_together_are_those_done_one_by_one() {
    for levels in 2..=6 {
        check("pyramids", &pyramids(30), &Loop, levels.min(5));
        for base in [3, 4, 7] {
            check("pyramids", &pyramids(base), &Loop, levels);
            check("pyramids", &pyramids(base), &LoopWarren, levels);
        }
        check("sheet", &sheet(), &Loop, levels);
        let triangle = Mesh::from_triangles(
            vec![[0.0; 3], [1.0, 0.0, 0.2], [0.3, 0.9, 0.0]],
            vec![[0, 1, 2]],
        );
        check("triangle", &triangle.unwrap(), &Loop, levels);
    }
}

#[test]
fn sharp_edges_and_corners_keep_both_their_sides() {
    let crease = |a: u32, b: u32, sharpness: f64| CreaseTag {
        vertices: [a, b],
        sharpness,
    };
    let corner = |vertex: u32, sharpness: f64| CornerTag { vertex, sharpness };
    let sheet = sheet();
    let inside: Vec<CreaseTag> = (15..20).map(|v| crease(v + 1, v, f64::INFINITY)).collect();
    let ends: Vec<CreaseTag> = inside[1..3].to_vec();
    let semi_sharp: Vec<CreaseTag> = inside
        .iter()
        .map(|tag| CreaseTag {
            sharpness: 1.6,
            ..*tag
        })
        .collect();
    let cross: Vec<CreaseTag> = inside
        .iter()
        .copied()
        .chain([crease(17, 10, 10.0), crease(17, 24, 10.0)])
        .collect();
    for (name, creases, corners) in [
        ("crease", inside.clone(), vec![]),
        ("two darts", ends, vec![]),
        (
            "crease with a corner",
            inside.clone(),
            vec![corner(17, f64::INFINITY)],
        ),
        (
            "crossing",
            cross,
            vec![corner(0, f64::INFINITY), corner(41, 2.5)],
        ),
        ("semi_sharp", semi_sharp, vec![corner(12, 0.5)]),
    ] {
        let sheet = sheet.clone().with_tags(Tags { creases, corners }).unwrap();
        for levels in 2..=5 {
            check(name, &sheet, &Loop, levels);
        }
    }
}

/// Cone points and folds have no tangent plane: there the normal is the average of faces, those of the steps.
#[test]
fn without_a_tangent_plane_faces_are_averaged() {
    // A double pyramid over a segment: two vertices with two edges.
    let corners = vec![
        [0.0, 0.0, 1.0],
        [1.0, 0.1, 0.0],
        [-1.0, 0.0, 0.2],
        [0.0, 0.5, -1.0],
    ];
    let corner = vec![CornerTag {
        vertex: 0,
        sharpness: f64::INFINITY,
    }];
    let pyramid =
        Mesh::from_triangles(corners, vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]).unwrap();
    let cone = pyramid
        .with_tags(Tags {
            creases: vec![],
            corners: corner,
        })
        .unwrap();
    for levels in 2..=5 {
        check("cone", &cone, &Loop, levels);
    }
    let flat = sheet();
    let positions = flat
        .positions()
        .iter()
        .map(|p| [p[0], p[0], 0.5 * p[0]])
        .collect();
    check("line", &flat.with_positions(positions).unwrap(), &Loop, 3);
}

#[test]
fn the_same_bytes_whatever_the_threads() {
    let control = sheet();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| together(&control, &Loop, 6))
    };
    let one = run(1);
    for threads in [2, 3, 7] {
        let other = run(threads);
        assert!(
            one.mesh == other.mesh && one.normals == other.normals,
            "{threads} threads"
        );
    }
}

#[test]
fn caps_hold_and_too_much_is_refused() {
    let control = pyramids(4);
    let options = UniformOptions::default()
        .levels(5)
        .limit(true)
        .normals(true);
    let capped = uniform(&control, &Loop, &options.max_triangles(Some(8 * 64))).unwrap();
    assert_eq!(
        (capped.mesh.face_count(), capped.stop),
        (512, Stop::TriangleCap { needed: 2048 })
    );
    let refused = uniform(&control, &Loop, &options.levels(40)).unwrap_err();
    assert!(
        matches!(
            refused,
            RefineError::Mesh(MeshError::TooMany { what: "faces", .. })
        ),
        "{refused}"
    );
}

#[test]
fn whoever_needs_no_connections_gets_the_same_whatever_is_asked_for() {
    let control = sheet();
    for limit in [false, true] {
        for normals in [false, true] {
            let options = UniformOptions::default()
                .levels(4)
                .limit(limit)
                .normals(normals);
            check_triangles("sheet", &control, &Loop, &options);
            check_triangles(
                "sheet, capped",
                &control,
                &Loop,
                &options.max_triangles(Some(60 * 64)),
            );
        }
    }
}

/// Coordinates so large that sums of a few of them overflow are reported, by either way.
#[test]
fn what_overflows_is_an_error() {
    let huge = |scale: f64| {
        let positions = sheet()
            .positions()
            .iter()
            .map(|p| p.map(|x| x * scale))
            .collect();
        sheet().with_positions(positions).unwrap()
    };
    let options = UniformOptions::default().levels(5).limit(true);
    for scale in [1e289, 1e299] {
        let found = uniform_triangles(&huge(scale), &Loop, &options).unwrap();
        let small = uniform_triangles(&sheet(), &Loop, &options).unwrap();
        for (a, b) in found.positions.iter().zip(&small.positions) {
            assert!(distance(a.map(|x| x / scale), *b) < 1e-13);
        }
    }
    let refused = [
        uniform_triangles(&huge(2e307), &Loop, &options).map(|_| ()),
        uniform(&huge(2e307), &Loop, &options).map(|_| ()),
    ];
    for refused in refused {
        assert!(
            matches!(refused, Err(RefineError::Mesh(MeshError::NotFinite { .. }))),
            "{refused:?}"
        );
    }
}
