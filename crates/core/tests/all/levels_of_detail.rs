//! Levels of detail: nested by brute force, geomorphs against the limit surface as it is evaluated on its own and against closest
//! points of the coarser mesh.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::HashMap;
use std::ops::ControlFlow;

use crate::support::*;
use limitmesh::measure::Bvh;
use limitmesh::mesh::{PolygonFaces, PolygonSoup, Triangles};
use limitmesh::progress::Progress;
use limitmesh::refine::{
    Caps, Exact, ExactStop, Level, LodOptions, RefineError, Traced, exact, levels_of_detail,
    levels_of_detail_observed, switching_distance,
};
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{FaceId, HalfEdgeId, LimitSurface, Mesh};

type Places = [[f64; 3]; 3];

/// Where a triangle's corners are in its control face.
fn places(control: &Mesh, exact: &Exact, triangle: usize) -> Places {
    let place = |corner| {
        exact.corner_origin(
            control.triangles(),
            HalfEdgeId::of(FaceId(triangle as u32), corner),
        )
    };
    [0, 1, 2].map(|corner| place(corner).unwrap().barycentric)
}

fn cross(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    (b[1] - a[1]) * (c[2] - a[2]) - (c[1] - a[1]) * (b[2] - a[2])
}

/// Whether a place is in a triangle of places; all are halves of halves, so nothing is rounded.
fn holds(triangle: &Places, place: [f64; 3]) -> bool {
    let [a, b, c] = *triangle;
    [cross(a, b, place), cross(b, c, place), cross(c, a, place)]
        .iter()
        .all(|&area| area >= 0.0)
}

/// The smallest part of a control face, by division in four, that holds a triangle, and whether it is that part.
fn node(triangle: &Places) -> (Places, bool) {
    let mut node: Places = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let middle = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]));
    loop {
        let is_node = triangle.iter().all(|corner| node.contains(corner));
        let [a, b, c] = node;
        let [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
        let parts = [[a, d, f], [d, b, e], [f, e, c], [e, f, d]];
        match parts
            .into_iter()
            .find(|part| triangle.iter().all(|&corner| holds(part, corner)))
        {
            Some(part) if !is_node => node = part,
            _ => return (node, is_node),
        }
    }
}

fn options(mesh: &Mesh, parts: &[f64]) -> LodOptions {
    LodOptions::new(parts.iter().map(|part| part * mesh.diagonal()).collect())
}

/// Meshes with everything that surfaces may have.
fn all_samples() -> Vec<(&'static str, Mesh)> {
    let mut all = samples();
    all.push(("creased", octahedron().with_creases_above(1.0).unwrap()));
    all.push(("half creased", lumpy(8, 3).with_creases_above(0.9).unwrap()));
    all.push(("three sheets", three_sheets()));
    all
}

/// Three sheets that meet in an edge, which is cut into copies.
fn three_sheets() -> Mesh {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.1, 0.3],
        [-0.6, 0.9, 0.6],
        [-0.5, -0.8, 0.5],
        [1.4, 0.2, 1.5],
        [-1.0, 1.2, -0.7],
    ];
    let mut faces = PolygonFaces::default();
    for face in [[0u32, 2, 1], [0, 3, 1], [0, 4, 1], [1, 2, 5], [0, 6, 3]] {
        faces.push(&face);
    }
    let soup = PolygonSoup {
        positions,
        faces,
        ..PolygonSoup::default()
    };
    Mesh::from_soup(&soup, &Default::default()).unwrap().0
}

#[test]
fn each_level_is_nested_in_the_next() {
    // Tolerances that are near to each other, too.
    let steps = [[0.05, 0.02, 0.005], [0.02, 0.018, 0.015]];
    for ((name, mesh), parts) in all_samples()
        .into_iter()
        .flat_map(|sample| steps.map(|parts| (sample.clone(), parts)))
    {
        let levels = levels_of_detail(&mesh, &Loop, &options(&mesh, &parts)).unwrap();
        assert_eq!(levels.len(), 3, "{name}");
        for pair in levels.windows(2) {
            let [coarse, fine] = [0, 1].map(|i| &pair[i].exact);
            assert!(fine.mesh.face_count() >= coarse.mesh.face_count());
            // All vertices are there again, in the same place.
            let known: HashMap<(u32, [u64; 3]), usize> = fine
                .origins
                .iter()
                .enumerate()
                .map(|(v, origin)| ((origin.face, origin.barycentric.map(f64::to_bits)), v))
                .collect();
            for (v, origin) in coarse.origins.iter().enumerate() {
                let same = known[&(origin.face, origin.barycentric.map(f64::to_bits))];
                assert!(
                    distance(coarse.mesh.positions()[v], fine.mesh.positions()[same])
                        < 1e-12 * mesh.diagonal()
                );
            }
            let mut of_face: Vec<Vec<Places>> = vec![Vec::new(); mesh.face_count()];
            for triangle in 0..coarse.mesh.face_count() {
                let own = places(&mesh, coarse, triangle);
                of_face[coarse.parents[triangle] as usize].push(node(&own).0);
            }
            let mut area = 0.0;
            for triangle in 0..fine.mesh.face_count() {
                let own = places(&mesh, fine, triangle);
                let nodes = &of_face[fine.parents[triangle] as usize];
                let is_nested = nodes
                    .iter()
                    .any(|node| own.iter().all(|&corner| holds(node, corner)));
                assert!(is_nested, "{name}: {own:?}");
                area += cross(own[0], own[1], own[2]);
            }
            assert!(
                (area - mesh.face_count() as f64).abs() < 1e-9,
                "{name}: the triangles cover the faces"
            );
        }
    }
}

/// The vertices stand on the coarser mesh; so do the triangles, but for those within leaves that it closes.
#[test]
fn geomorphs_start_on_the_coarser_level() {
    let mut closing = 0;
    for (name, mesh) in all_samples() {
        let levels = levels_of_detail(&mesh, &Loop, &options(&mesh, &[0.05, 0.01, 0.003])).unwrap();
        assert!(levels[0].geomorph.is_none());
        for pair in levels.windows(2) {
            let (coarse, fine) = (&pair[0].exact, &pair[1].exact);
            let morph = pair[1].geomorph.as_ref().unwrap();
            let bvh = Bvh::new(coarse.mesh.as_triangles()).unwrap();
            let size = 1e-12 * mesh.diagonal();
            for &position in &morph.positions {
                at_most!(bvh.closest(position).distance, size, "{name}: {position:?}");
            }
            assert!(pair[1].positions_at(0.0) == morph.positions);
            assert!(pair[1].positions_at(1.0) == fine.mesh.positions());
            let mut of_face: Vec<Vec<(Places, usize)>> = vec![Vec::new(); mesh.face_count()];
            for triangle in 0..coarse.mesh.face_count() {
                let own = places(&mesh, coarse, triangle);
                of_face[coarse.parents[triangle] as usize].push((own, triangle));
            }
            for triangle in 0..fine.mesh.face_count() {
                let own = places(&mesh, fine, triangle);
                let beneath = of_face[fine.parents[triangle] as usize]
                    .iter()
                    .find(|(coarse, _)| own.iter().all(|&corner| holds(coarse, corner)));
                let corners = fine.mesh.triangles()[triangle].map(|v| morph.positions[v as usize]);
                let Some(&(_, under)) = beneath else {
                    closing += 1;
                    continue;
                };
                // The middle is on the same triangle, by the places' own coordinates.
                let middle: Point =
                    std::array::from_fn(|i| corners.iter().map(|p| p[i]).sum::<f64>() / 3.0);
                let under = Triangles {
                    triangles: &[coarse.mesh.triangles()[under]],
                    ..coarse.mesh.as_triangles()
                };
                let distance = Bvh::new(under).unwrap().closest(middle).distance;
                assert!(distance <= size, "{name}: {distance}");
            }
        }
    }
    above!(closing, 10);
}

/// The greatest distance found between the mesh at a moment and the surface at the same places, as a part of what is claimed.
fn sampled(mesh: &Mesh, scheme: &dyn Scheme, level: &Level, t: f64, random: &mut Random) -> f64 {
    let surface = LimitSurface::without_normals(mesh, scheme).unwrap();
    let positions = level.positions_at(t);
    let (mut at, mut found) = (Vec::new(), Vec::new());
    for triangle in 0..level.exact.mesh.face_count() {
        let own = places(mesh, &level.exact, triangle);
        let corners = level.exact.mesh.triangles()[triangle].map(|v| positions[v as usize]);
        for sample in 0..8 {
            let (mut u, mut v) = (0.5 + 0.5 * random.signed(), 0.5 + 0.5 * random.signed());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            // Edges are where the most is to be found.
            let weights = if sample < 3 {
                [0.5, 0.5 - 0.5 * u, 0.5 * u]
            } else {
                [1.0 - u - v, u, v]
            };
            let mix = |of: [[f64; 3]; 3]| -> [f64; 3] {
                std::array::from_fn(|i| (0..3).map(|corner| weights[corner] * of[corner][i]).sum())
            };
            at.push((FaceId(level.exact.parents[triangle]), mix(own)));
            found.push(mix(corners));
        }
    }
    let truth = surface.at_all(&at).into_iter().zip(found);
    let greatest = truth
        .map(|(truth, found)| distance(truth.position, found))
        .fold(0.0f64, f64::max);
    greatest / level.deviation_at(t)
}

/// The part of a bound that samples find at least: they are few, and around irregular vertices that are closed on one side two bounds add up.
const LEAST_FOUND: f64 = 0.4;

#[test]
fn geomorphs_are_within_their_bound_at_every_moment() {
    let mut random = Random::new(11);
    let loops = all_samples()
        .into_iter()
        .map(|own| (&Loop as &dyn Scheme, own));
    let warrens = samples()
        .into_iter()
        .skip(3)
        .map(|own| (&LoopWarren as &dyn Scheme, own));
    for (scheme, (name, mesh)) in loops.chain(warrens) {
        let levels =
            levels_of_detail(&mesh, scheme, &options(&mesh, &[0.06, 0.015, 0.004])).unwrap();
        for (i, level) in levels.iter().enumerate() {
            assert_eq!(level.exact.stop, ExactStop::Met);
            assert!(level.exact.error.certified && level.exact.error.upper <= level.tolerance);
            at_most!(level.parametric, level.tolerance);
            at_least!(level.parametric, level.exact.error.lower);
            let start = level.deviation_at(0.0);
            assert!(
                i == 0 || start <= levels[i - 1].tolerance,
                "{name}, level {i}: {start}"
            );
            let inner = 0.5 + 0.5 * random.signed();
            for t in [0.0, inner, 0.5, 1.0] {
                let part = sampled(&mesh, scheme, level, t, &mut random);
                at_most!(part, 1.0 + 1e-9, "{name}, level {i} at {t}");
                // Bounds are no wild guesses, but for what is next to nothing.
                let is_end =
                    (t == 0.0 || t == 1.0) && level.deviation_at(t) > 0.002 * level.tolerance;
                assert!(
                    !is_end || part > LEAST_FOUND,
                    "{name}, level {i} at {t}: {part} of what is claimed"
                );
            }
        }
    }
}

/// The documented distance at the start is about the error of the coarser level itself.
#[test]
fn a_geomorph_starts_about_as_far_off_as_the_coarser_level() {
    for (name, mesh) in all_samples() {
        let levels = levels_of_detail(&mesh, &Loop, &options(&mesh, &[0.05, 0.0125])).unwrap();
        let ratio = levels[1].deviation_at(0.0) / levels[0].parametric;
        assert!((0.8..1.3).contains(&ratio), "{name}: {ratio}");
    }
}

#[test]
fn closed_meshes_stay_closed_and_copies_together() {
    for (name, mesh) in all_samples() {
        let levels = levels_of_detail(&mesh, &Loop, &options(&mesh, &[0.05, 0.01])).unwrap();
        let boundary = mesh.topology().boundary_edge_count();
        for level in &levels {
            let own = &level.exact.mesh;
            assert!(own.validate().is_ok(), "{name}");
            assert!(
                (own.topology().boundary_edge_count() == 0) == (boundary == 0),
                "{name}"
            );
            for t in [0.0, 0.3] {
                let positions = level.positions_at(t);
                for copies in own.junctions().vertices.iter() {
                    let first = positions[copies[0] as usize];
                    assert!(
                        copies.iter().all(|&v| positions[v as usize] == first),
                        "{name}"
                    );
                }
            }
        }
        assert!(name != "three sheets" || !levels[1].exact.mesh.junctions().vertices.is_empty());
    }
}

/// Without geomorphs tolerances are for distances alone: fewer triangles, nested all the same.
#[test]
fn levels_without_geomorphs_take_fewer_triangles() {
    let mesh = lumpy(12, 7);
    let asked = options(&mesh, &[0.05, 0.01, 0.002]);
    let levels = levels_of_detail(&mesh, &Loop, &asked.clone().geomorphs(false)).unwrap();
    let morphed = levels_of_detail(&mesh, &Loop, &asked).unwrap();
    for (level, morphed) in levels.iter().zip(&morphed) {
        let plain = within(level.tolerance).flat_regions(false);
        let plain = exact(&mesh, &Loop, &plain).unwrap();
        assert!(level.geomorph.is_none() && level.exact.error.upper <= level.tolerance);
        let count = level.exact.mesh.face_count();
        // Leaves of levels are whole.
        assert!((plain.mesh.face_count()..2 * plain.mesh.face_count()).contains(&count));
        assert!(count < morphed.exact.mesh.face_count());
        // Places slide more than surfaces are apart.
        assert!(level.parametric > level.exact.error.upper);
    }
}

#[test]
fn other_schemes_have_levels_that_are_estimated() {
    let mesh = octahedron();
    let levels =
        levels_of_detail(&mesh, &ModifiedButterfly, &options(&mesh, &[0.05, 0.015])).unwrap();
    for level in &levels {
        assert!(!level.exact.error.certified && level.parametric <= level.tolerance);
    }
    let morph = levels[1].geomorph.as_ref().unwrap();
    assert!(morph.start > levels[1].parametric && morph.start < 1.5 * levels[0].parametric);
}

#[test]
fn sizes_and_threads_change_nothing() {
    let mesh = lumpy(6, 2).with_creases_above(1.1).unwrap();
    let asked = options(&mesh, &[0.05, 0.01]);
    let one = pool(1).install(|| levels_of_detail(&mesh, &Loop, &asked).unwrap());
    let three = pool(3).install(|| levels_of_detail(&mesh, &Loop, &asked).unwrap());
    for factor in [2f64.powi(300), 2f64.powi(-300)] {
        let huge = mapped(&mesh, |p| p.map(|x| factor * x));
        let tolerances = asked
            .tolerances
            .iter()
            .map(|length| factor * length)
            .collect();
        let found = levels_of_detail(&huge, &Loop, &LodOptions::new(tolerances)).unwrap();
        for (level, own) in found.iter().zip(&one) {
            assert_eq!(level.exact.mesh.triangles(), own.exact.mesh.triangles());
            assert_eq!(level.parametric, factor * own.parametric);
            assert_eq!(level.deviation_at(0.0), factor * own.deviation_at(0.0));
            let expected: Vec<Point> = own
                .positions_at(0.0)
                .iter()
                .map(|p| p.map(|x| factor * x))
                .collect();
            assert_eq!(level.positions_at(0.0), expected);
        }
    }
    for (a, b) in one.iter().zip(&three) {
        assert_eq!(a.exact.mesh.positions(), b.exact.mesh.positions());
        assert_eq!((a.parametric, &a.geomorph), (b.parametric, &b.geomorph));
    }
}

/// The weights of a triangle's corners at a place.
fn weights(triangle: &Places, place: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = *triangle;
    [cross(b, c, place), cross(c, a, place), cross(a, b, place)].map(|area| area / cross(a, b, c))
}

/// Each corner's normal is the mean of those of the coarser triangle beneath by its place there: on a crease each side has its own.
#[test]
fn normals_are_those_that_the_coarser_level_is_shaded_with() {
    for (name, mesh) in all_samples() {
        let levels = levels_of_detail(&mesh, &Loop, &options(&mesh, &[0.05, 0.01])).unwrap();
        let [coarse, fine] = [0, 1].map(|level| &levels[level].exact);
        let (split, normals) = levels[1].split_surface();
        let has_sides = split.positions.len() > fine.mesh.vertex_count();
        assert_eq!(
            has_sides,
            !mesh.tags().creases.is_empty(),
            "{name}: creases have sides"
        );
        let mut of_face: Vec<Vec<(Places, u32)>> = vec![Vec::new(); mesh.face_count()];
        for triangle in 0..coarse.mesh.face_count() {
            let own = places(&mesh, coarse, triangle);
            of_face[coarse.parents[triangle] as usize].push((own, triangle as u32));
        }
        let mut compared = 0;
        for triangle in 0..fine.mesh.face_count() {
            let own = places(&mesh, fine, triangle);
            let beneath = of_face[fine.parents[triangle] as usize]
                .iter()
                .find(|(coarse, _)| own.iter().all(|&corner| holds(coarse, corner)));
            let Some((around, under)) = beneath else {
                continue;
            };
            for (corner, &place) in own.iter().enumerate() {
                let weights = weights(around, place);
                let theirs =
                    [0, 1, 2].map(|i| coarse.corner_normal(HalfEdgeId::of(FaceId(*under), i)));
                let expected =
                    std::array::from_fn(|axis| (0..3).map(|i| weights[i] * theirs[i][axis]).sum());
                let found = normals[split.triangles[triangle][corner] as usize];
                assert!(
                    distance(found, expected) < 1e-12,
                    "{name}: {found:?} and {expected:?}"
                );
                compared += 1;
            }
        }
        assert!(compared > fine.mesh.face_count(), "{name}: {compared}");
    }
}

#[test]
fn bad_tolerances_are_refused() {
    let mesh = octahedron();
    for bad in [
        vec![],
        vec![0.1, 0.1],
        vec![0.1, 0.2],
        vec![0.1, f64::NAN],
        vec![0.1, 0.0],
        vec![f64::INFINITY],
    ] {
        let found = levels_of_detail(&mesh, &Loop, &LodOptions::new(bad.clone()));
        assert!(matches!(found, Err(RefineError::Mesh(_))), "{bad:?}");
    }
}

/// Levels end at the first that could not be reached.
#[test]
fn caps_end_the_levels() {
    let mesh = octahedron();
    let asked = options(&mesh, &[0.05, 0.001, 0.0001]).caps(Caps {
        triangles: Some(200),
        ..Caps::default()
    });
    let levels = levels_of_detail(&mesh, &Loop, &asked).unwrap();
    assert_eq!(levels.len(), 2);
    assert_eq!(levels[1].exact.stop, ExactStop::TriangleCap);
    assert!(levels[1].exact.mesh.face_count() <= 200);
    // The result is nested and certified as well.
    let mut random = Random::new(5);
    assert!(sampled(&mesh, &Loop, &levels[1], 0.25, &mut random) <= 1.0 + 1e-9);
}

#[test]
fn observers_can_stop_it() {
    let mesh = lumpy(12, 7);
    let mut calls = 0;
    let mut observer = |_: &Progress| {
        calls += 1;
        if calls > 20 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let found =
        levels_of_detail_observed(&mesh, &Loop, &options(&mesh, &[0.05, 0.001]), &mut observer);
    assert!(matches!(found, Err(RefineError::Cancelled(_))));
}

/// Seen from there, in the middle of a picture, the deviation is as large as asked.
#[test]
fn switching_distances_are_those_of_a_pinhole() {
    let (deviation, pixels, height, fov) = (0.02, 1.5, 1080.0, 0.9);
    let distance = switching_distance(deviation, pixels, height, fov);
    let half_height: f64 = distance * (0.5f64 * fov).tan();
    assert!((deviation / half_height * (height / 2.0) - pixels).abs() < 1e-12);
}
