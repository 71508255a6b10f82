//! Replay against the limit surface as an object: on moved control points every vertex, and every normal on its side, is where
//! [`LimitSurface`] has that place.

#![allow(missing_docs, clippy::unwrap_used)]

use crate::catmull_clark::random_cage;
use crate::support::*;
use limitmesh::mesh::{PolygonSoup, Tags};
use limitmesh::refine::{
    Exact, ExactOptions, Finish, Frame, Frames, LimitDistanceOptions, RefineError, Replay,
    ReplayError, Traced, exact, exact_frames, limit_distance,
};
use limitmesh::scheme::{CatmullClark, Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{FaceId, HalfEdgeId, LimitSurface, Mesh, QuadControl};

/// Triangles within a hundredth of the size, fewer where `share` is greater.
fn refined(mesh: &Mesh, scheme: &dyn Scheme, share: f64) -> Exact {
    let options = within(share * mesh.diagonal()).flat_regions(false);
    exact(mesh, scheme, &options).unwrap()
}

/// Moved by up to a fifth of the size, all copies of a vertex alike.
fn moved(mesh: &Mesh, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let size = 0.2 * mesh.diagonal();
    let mut positions = mesh.positions().to_vec();
    positions
        .iter_mut()
        .flatten()
        .for_each(|x| *x += size * random.signed());
    for copies in mesh.junctions().vertices.iter() {
        copies
            .iter()
            .for_each(|&copy| positions[copy as usize] = positions[copies[0] as usize]);
    }
    mesh.clone().with_positions(positions).unwrap()
}

fn tagged(mesh: Mesh, one_in: usize, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let topology = mesh.topology();
    let sharp = [
        0.4,
        0.5,
        1.0,
        1.5,
        2.3,
        3.7,
        10.0,
        f64::INFINITY,
        f64::INFINITY,
    ];
    let mut tags = Tags::default();
    for h in topology
        .half_edges()
        .filter(|&h| topology.twin(h).is_none_or(|twin| h < twin))
    {
        if random.below(one_in) == 0 {
            let vertices = topology.ends(h).map(|v| v.0);
            tags.creases
                .push(crease(vertices, sharp[random.below(sharp.len())]));
        }
    }
    for vertex in topology.vertices() {
        if random.below(3 * one_in) > 0 {
            continue;
        }
        tags.corners
            .push(corner(vertex.0, sharp[random.below(sharp.len())]));
    }
    mesh.clone().with_tags(tags).unwrap()
}

/// A closed double cone over an uneven rim: two poles of so many edges.
fn poles(edges: u32) -> Mesh {
    let rim = |i: u32| {
        let angle = core::f64::consts::TAU * f64::from(i) / f64::from(edges);
        let radius = 1.0 + 0.2 * (3.0 * angle).sin();
        [
            radius * angle.cos(),
            radius * angle.sin(),
            0.1 * (5.0 * angle).cos(),
        ]
    };
    let mut positions: Vec<Point> = (0..edges).map(rim).collect();
    positions.extend([[0.1, 0.0, 0.9], [0.0, 0.1, -0.8]]);
    let around = (0..edges).flat_map(|i| {
        let next = (i + 1) % edges;
        [[i, next, edges], [next, i, edges + 1]]
    });
    Mesh::from_triangles(positions, around.collect()).unwrap()
}

/// Three folded pages that meet in an edge.
fn book() -> Mesh {
    let mut soup = PolygonSoup {
        positions: vec![[0.0; 3], [0.0, 0.0, 1.0]],
        ..PolygonSoup::default()
    };
    for page in 0..3u32 {
        let angle = 2.1 * f64::from(page);
        let (a, b) = (2 + 2 * page, 3 + 2 * page);
        soup.positions.push([angle.cos(), angle.sin(), 0.1]);
        soup.positions
            .push([0.8 * (angle + 0.3).cos(), 0.8 * (angle + 0.3).sin(), 1.2]);
        soup.faces.push(&[0, a, 1]);
        soup.faces.push(&[1, a, b]);
    }
    Mesh::from_soup(&soup, &Default::default()).unwrap().0
}

fn meshes() -> Vec<(String, Mesh)> {
    let mut meshes: Vec<(String, Mesh)> = samples()
        .into_iter()
        .map(|(name, mesh)| (name.into(), mesh))
        .collect();
    for seed in 0..3u64 {
        meshes.push((format!("lumpy {seed}"), lumpy(14, seed)));
        meshes.push((format!("sheet {seed}"), sheet(4, 3, seed)));
        meshes.push((
            format!("tagged lumpy {seed}"),
            tagged(lumpy(10, seed), 4, seed),
        ));
        meshes.push((
            format!("tagged sheet {seed}"),
            tagged(sheet(4, 4, seed), 6, seed + 9),
        ));
    }
    meshes.push(("poles of 12".into(), poles(12)));
    meshes.push(("poles of 230".into(), poles(230)));
    meshes.push(("book".into(), book()));
    meshes
}

/// The greatest distance of a frame's vertices from the limit surface at the same places, by the mesh's size, and the greatest
/// difference of normals where there are any.
fn off(control: &Mesh, scheme: &dyn Scheme, refined: &Exact, frame: &Frame) -> [f64; 2] {
    let surface = LimitSurface::new(control, scheme).unwrap();
    let triangles = refined.mesh.triangles();
    let shown = refined.clone().moved_to(frame).unwrap();
    let corners: Vec<(HalfEdgeId, (FaceId, [f64; 3]))> = (0..3 * triangles.len() as u32)
        .map(|h| {
            let origin = refined
                .corner_origin(control.triangles(), HalfEdgeId(h))
                .unwrap();
            (HalfEdgeId(h), (FaceId(origin.face), origin.barycentric))
        })
        .collect();
    let places: Vec<_> = corners.iter().map(|&(_, place)| place).collect();
    let mut off = [0.0f64; 2];
    for ((h, _), expected) in corners.iter().zip(surface.at_all(&places)) {
        let vertex = refined.mesh.topology().origin(*h).index();
        let apart = distance(frame.positions[vertex], expected.position) / control.diagonal();
        off[0] = off[0].max(apart);
        let normal = shown.corner_normal(*h);
        if expected.normal != [0.0; 3] {
            off[1] = off[1].max(distance(normal, expected.normal));
        }
    }
    off
}

/// Cages of quads and other polygons, with holes and tags.
fn cages() -> Vec<(String, Mesh)> {
    let cage = |seed| {
        let soup = random_cage(&mut Random::new(seed));
        let (control, _) = QuadControl::from_soup(&soup, &Default::default()).unwrap();
        (format!("cage {seed}"), control.mesh)
    };
    (0..20).map(cage).collect()
}

#[test]
fn vertices_are_on_the_limit_surface_of_each_frame() {
    let quads = cages().into_iter();
    let quads = quads.map(|(name, mesh)| (name, mesh, vec![(&CatmullClark as &dyn Scheme, 6e-3)]));
    let loops: Vec<(&dyn Scheme, f64)> = vec![(&Loop, 6e-3), (&LoopWarren, 5e-2)];
    let meshes = meshes().into_iter();
    let meshes = meshes.map(|(name, mesh)| (name, mesh, loops.clone()));
    for (name, mesh, schemes) in meshes.chain(quads) {
        for (scheme, share) in schemes {
            let refined = refined(&mesh, scheme, share);
            let replay = Replay::new(&mesh, scheme, &refined).unwrap();
            let mut frame = Frame::default();
            for seed in 0..2 {
                let control = if seed == 0 {
                    mesh.clone()
                } else {
                    moved(&mesh, seed)
                };
                replay.frame(control.positions(), &mut frame).unwrap();
                let [apart, turned] = off(&control, scheme, &refined, &frame);
                assert!(apart < 1e-13, "{name}, {}, {seed}: {apart}", scheme.name());
                below!(turned, 1e-8, "{name}, {}, {seed}", scheme.name());
            }
        }
    }
}

/// Deep inside a face, by polynomials and by rows, and of the same positions what was refined, normals of sharp vertices too.
#[test]
fn what_was_refined_comes_back() {
    for (name, mesh) in [
        ("lumpy", tagged(lumpy(6, 3), 5, 2)),
        ("sheet", sheet(3, 2, 8)),
        ("book", book()),
    ] {
        let refined = refined(&mesh, &Loop, 2e-5);
        let replay = Replay::new(&mesh, &Loop, &refined).unwrap();
        let mut frame = Frame::default();
        replay.frame(mesh.positions(), &mut frame).unwrap();
        for (v, (a, b)) in frame
            .positions
            .iter()
            .zip(refined.mesh.positions())
            .enumerate()
        {
            assert!(
                distance(*a, *b) < 1e-13 * mesh.diagonal(),
                "{name}, {v}: {a:?} {b:?}"
            );
        }
        for (v, (a, b)) in frame.normals.iter().zip(&refined.normals).enumerate() {
            assert!(distance(*a, *b) < 1e-8, "{name}, {v}: {a:?} {b:?}");
        }
        for ((h, a), (other, b)) in frame.sides.iter().zip(&refined.sides) {
            assert_eq!(h, other, "{name}, {a:?}, {b:?}");
            below!(distance(*a, *b), 1e-8, "{name}, {a:?}, {b:?}");
        }
        let copies = refined.mesh.junctions().vertices.iter();
        for copies in copies {
            let at = |v: u32| frame.positions[v as usize];
            assert!(
                copies.iter().all(|&copy| at(copy) == at(copies[0])),
                "{name}"
            );
        }
    }
}

/// A frame does not remember the one before, positions are the same without normals, and far and tiny models have normals.
#[test]
fn frames_stand_alone_at_any_size() {
    let mesh = tagged(lumpy(12, 5), 6, 1);
    let refined = refined(&mesh, &Loop, 5e-3);
    let replay = Replay::new(&mesh, &Loop, &refined).unwrap();
    let (mut kept, mut fresh, mut plain) = (Frame::default(), Frame::default(), Frame::default());
    replay
        .frame(moved(&mesh, 4).positions(), &mut kept)
        .unwrap();
    replay.frame(mesh.positions(), &mut kept).unwrap();
    replay.frame(mesh.positions(), &mut fresh).unwrap();
    replay.positions(mesh.positions(), &mut plain).unwrap();
    assert_eq!(
        (&kept.positions, &kept.normals, &kept.sides),
        (&fresh.positions, &fresh.normals, &fresh.sides)
    );
    assert_eq!(kept.positions, plain.positions);
    for scale in [1e-200, 1e-90, 1e90, 1e200] {
        let scaled: Vec<Point> = mesh
            .positions()
            .iter()
            .map(|p| p.map(|x| scale * x))
            .collect();
        replay.frame(&scaled, &mut fresh).unwrap();
        for (a, b) in fresh.normals.iter().zip(&kept.normals) {
            assert!(distance(*a, *b) < 1e-7, "{scale}: {a:?} {b:?}");
        }
    }
    // All in one point: no normals, and no numbers that are none.
    replay
        .frame(&vec![[3.0; 3]; mesh.vertex_count()], &mut fresh)
        .unwrap();
    assert!(fresh.positions.iter().all(|&p| p == [3.0; 3]));
    assert!(fresh.normals.iter().all(|&n| n == [0.0; 3]));
}

#[test]
fn what_cannot_be_replayed_is_refused() {
    let mesh = octahedron();
    let of = |options: ExactOptions| exact(&mesh, &Loop, &options.tolerance(0.01)).unwrap();
    let blind = of(ExactOptions::default().origins(false));
    assert!(matches!(
        Replay::new(&mesh, &Loop, &blind),
        Err(ReplayError::NoOrigins { origins: 0, .. })
    ));
    let refined = of(ExactOptions::default());
    let options = ExactOptions::default().triangles(60);
    let other = exact(&mesh, &ModifiedButterfly, &options).unwrap();
    let refusal = Replay::new(&mesh, &ModifiedButterfly, &other);
    assert!(matches!(refusal, Err(ReplayError::Scheme { .. })));
    let few = Mesh::from_triangles(mesh.positions()[..3].to_vec(), vec![[0, 1, 2]]).unwrap();
    assert!(matches!(
        Replay::new(&few, &Loop, &refined),
        Err(ReplayError::Elsewhere { .. })
    ));
    let replay = Replay::new(&mesh, &Loop, &refined).unwrap();
    let mut frame = Frame::default();
    assert!(matches!(
        replay.frame(&mesh.positions()[1..], &mut frame),
        Err(ReplayError::Mesh(_))
    ));
    let mut broken = mesh.positions().to_vec();
    broken[2][1] = f64::NAN;
    assert!(matches!(
        replay.frame(&broken, &mut frame),
        Err(ReplayError::Mesh(_))
    ));
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let mesh = tagged(sheet(12, 10, 9), 8, 4);
    let run = |threads: usize| {
        let pool = pool(threads);
        pool.install(|| {
            let refined = refined(&mesh, &Loop, 2e-4);
            let replay = Replay::new(&mesh, &Loop, &refined).unwrap();
            let mut frame = Frame::default();
            replay
                .frame(moved(&mesh, 3).positions(), &mut frame)
                .unwrap();
            assert!(frame.positions.len() > 5000, "{}", frame.positions.len());
            frame
        })
    };
    let one = run(1);
    assert!(one == run(2) && one == run(3));
}

/// Some frames of a mesh: as it is, stretched, and bent.
fn frames(mesh: &Mesh) -> Vec<Vec<Point>> {
    let bent = |p: &Point| {
        let angle = 1.2 * p[2] / mesh.diagonal();
        [
            p[0] * angle.cos() - p[1] * angle.sin(),
            p[0] * angle.sin() + p[1] * angle.cos(),
            1.3 * p[2],
        ]
    };
    let positions = mesh.positions();
    let stretched = positions
        .iter()
        .map(|&[x, y, z]| [x, 1.8 * y, 0.6 * z])
        .collect();
    vec![
        positions.to_vec(),
        stretched,
        positions.iter().map(bent).collect(),
    ]
}

/// The proven bound of every frame holds against certified distances to the frame's own limit
/// surface, which another search finds.
#[test]
fn what_is_proven_of_each_frame_holds() {
    let creased = tagged(sheet(3, 3, 5), 7, 3);
    for (name, mesh) in [
        ("octahedron", octahedron()),
        ("lumpy", lumpy(5, 2)),
        ("creased", creased),
        ("book", book()),
    ] {
        let frames = frames(&mesh);
        let tolerance = 8e-3 * mesh.diagonal();
        let options = within(tolerance);
        let found = exact_frames(&mesh, &Loop, &frames, &options).unwrap();
        let Frames {
            refined,
            replay,
            errors,
            ..
        } = &found;
        assert_eq!(errors.len(), frames.len());
        refined.mesh.validate().unwrap();
        // The first frame is what was refined, to the bit.
        let mut frame = Frame::default();
        replay.frame(&frames[0], &mut frame).unwrap();
        assert_eq!(
            (&frame.positions[..], &frame.normals),
            (refined.mesh.positions(), &refined.normals),
            "{name}"
        );
        assert_eq!(
            (&frame.sides, refined.error),
            (&refined.sides, errors[0]),
            "{name}"
        );
        let mut farthest = 0.0f64;
        for (number, (positions, error)) in frames.iter().zip(errors).enumerate() {
            assert!(error.certified, "{name}, {number}");
            at_most!(error.upper, tolerance, "{name}, {number}");
            let control = mesh.clone().with_positions(positions.clone()).unwrap();
            replay.frame(positions, &mut frame).unwrap();
            let shown = refined.clone().moved_to(&frame).unwrap();
            assert_eq!(shown.mesh.triangles(), refined.mesh.triangles());
            let options = LimitDistanceOptions::default().gap(Some(0.1 * tolerance));
            let measured =
                limit_distance(shown.mesh.as_triangles(), &control, &Loop, &options).unwrap();
            let (low, high) = (measured.distance.lower(), measured.distance.upper());
            at_most!(low, error.upper, "{name}, {number}");
            at_most!(error.lower, high, "{name}, {number}");
            farthest = farthest.max(low);
        }
        above!(farthest, 0.3 * tolerance, "{name}");
        // No more than one frame after the other needs together.
        let alone = |positions: &Vec<Point>| {
            let control = mesh.clone().with_positions(positions.clone()).unwrap();
            exact(&control, &Loop, &options.clone().flat_regions(false))
                .unwrap()
                .mesh
                .face_count()
        };
        let alone: Vec<usize> = frames.iter().map(alone).collect();
        let count = refined.mesh.face_count();
        at_most!(count, alone.iter().sum::<usize>(), "{name}");
    }
}

#[test]
fn frames_that_are_none_are_refused() {
    let mesh = octahedron();
    let options = within(0.01);
    let of =
        |frames: &[Vec<Point>], options: &ExactOptions| exact_frames(&mesh, &Loop, frames, options);
    let own = mesh.positions().to_vec();
    let few = of(&[own.clone(), own[1..].to_vec()], &options);
    assert!(matches!(
        few,
        Err(RefineError::Replay(ReplayError::Frame { frame: 1, .. }))
    ));
    let mut broken = own.clone();
    broken[3][0] = f64::INFINITY;
    let broken = of(&[own.clone(), own.clone(), broken], &options);
    assert!(matches!(
        broken,
        Err(RefineError::Replay(ReplayError::Frame { frame: 2, .. }))
    ));
    assert!(of(&[], &options).is_err());
    assert!(of(core::slice::from_ref(&own), &options.clone().triangles(500)).is_err());
    assert!(
        of(
            core::slice::from_ref(&own),
            &options.clone().finish(Finish::Balanced)
        )
        .is_err()
    );
    let capped = of(&[own.clone(), own], &options.max_triangles(Some(20)));
    assert!(matches!(
        capped,
        Err(RefineError::Replay(ReplayError::TooMany {
            frame: 0,
            most: 20
        }))
    ));
}

/// Very small and very large models are refined at a middling size.
#[test]
fn frames_of_any_size_are_refined_alike() {
    let mesh = lumpy(4, 7);
    let of = |scale: f64| {
        let scaled = |p: &Vec<Point>| {
            p.iter()
                .map(|p| p.map(|x| scale * x))
                .collect::<Vec<Point>>()
        };
        let all: Vec<Vec<Point>> = frames(&mesh).iter().map(scaled).collect();
        let control = mesh.clone().with_positions(all[0].clone()).unwrap();
        let tolerance = 0.02 * scale * mesh.diagonal();
        exact_frames(&control, &Loop, &all, &within(tolerance)).unwrap()
    };
    let scale = 2f64.powi(400);
    let (here, there) = (of(1.0), of(scale));
    assert_eq!(
        here.refined.mesh.triangles(),
        there.refined.mesh.triangles()
    );
    for (a, b) in here.errors.iter().zip(&there.errors) {
        at_most!((a.upper * scale - b.upper).abs(), 1e-6 * b.upper, "{a:?}");
    }
}
