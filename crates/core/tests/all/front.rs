//! A front that refines and coarsens: equal bytes from any previous demand, and the least forest,
//! by brute force.

#![allow(missing_docs, clippy::unwrap_used)]

use std::collections::{BTreeSet, HashMap};
use std::ops::ControlFlow;

use crate::support::{Random, lumpy, mapped, octahedron, sheet, tagged_obj, torus};
use limitmesh::criterion::Camera;
use limitmesh::front::{Demand, Front, FrontError, Measure};
use limitmesh::mesh::PolygonSoup;
use limitmesh::progress::Progress;
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{FaceId, LimitSurface, Mesh};

/// Closed and open, regular and not, with infinitely sharp and semi-sharp edges.
fn models() -> Vec<(&'static str, Mesh)> {
    let creased = |mesh: Mesh| mesh.with_creases_above(0.9).unwrap();
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n\
        t crease 2/1/0 0 1 2.5\nt crease 2/1/0 1 2 1.5\nt crease 2/1/0 4 5 9\n";
    vec![
        ("octahedron", octahedron()),
        ("torus", torus(6, 5)),
        ("sheet", sheet(3, 4, 3)),
        ("lumpy", lumpy(9, 7)),
        ("creased", creased(lumpy(6, 5))),
        ("fading", tagged_obj(cube)),
        ("cut", fins()),
    ]
}

/// Three sheets that meet in an edge of two segments.
fn fins() -> Mesh {
    let mut positions = vec![[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.2, 2.0]];
    let mut soup = PolygonSoup::default();
    for fin in 0..3 {
        let (sine, cosine) = (2.1 * f64::from(fin)).sin_cos();
        let first = positions.len() as u32;
        positions.extend((0..3).map(|i| [cosine, sine, 0.8 * f64::from(i)]));
        for i in 0..2 {
            soup.faces.push(&[i, first + i, first + i + 1]);
            soup.faces.push(&[i, first + i + 1, i + 1]);
        }
    }
    soup.positions = positions;
    let (mesh, _) = Mesh::from_soup(&soup, &Default::default()).unwrap();
    assert!(!mesh.junctions().is_empty());
    mesh
}

fn bytes(front: &Front<'_>) -> (Vec<u8>, Vec<[u32; 3]>) {
    let mesh = front.mesh().unwrap();
    let positions = mesh
        .positions()
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    (positions, mesh.triangles().to_vec())
}

fn fresh(control: &Mesh, scheme: &dyn Scheme, demand: &Demand) -> (Vec<u8>, Vec<[u32; 3]>) {
    let mut front = Front::new(control, scheme).unwrap();
    front.update(demand).unwrap();
    bytes(&front)
}

fn camera(random: &mut Random, size: f64) -> Camera {
    let mut point = |size: f64| [0; 3].map(|_| size * random.signed());
    Camera {
        eye: point(1.5 * size),
        target: point(0.3 * size),
        up: [0.1, 0.2, 1.0],
        fov_degrees: 50.0,
        width: 90,
        height: 60,
    }
}

/// A client that copies only the reported changes.
#[derive(Default)]
struct Copy {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Copy {
    fn follow(&mut self, front: &Front<'_>) {
        self.positions.resize(front.positions().len(), [0.0; 3]);
        self.triangles.resize(front.triangles().len(), [0; 3]);
        for &vertex in &front.changes().vertices {
            self.positions[vertex as usize] = front.positions()[vertex as usize];
        }
        for &triangle in &front.changes().triangles {
            self.triangles[triangle as usize] = front.triangles()[triangle as usize];
        }
    }
}

/// Triangles by their corners' places, each from its least corner on.
fn unnumbered(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<[[u64; 3]; 3]> {
    let mut all: Vec<[[u64; 3]; 3]> = triangles
        .iter()
        .map(|triangle| {
            let mut corners = triangle.map(|v| positions[v as usize].map(f64::to_bits));
            let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
            corners.rotate_left(least);
            corners
        })
        .collect();
    all.sort_unstable();
    all
}

#[test]
fn updates_give_what_a_fresh_front_does() {
    let mut random = Random::new(5);
    for (name, control) in models() {
        let size = control.diagonal();
        let mut front = Front::new(&control, &Loop).unwrap();
        let mut copy = Copy {
            positions: front.positions().to_vec(),
            triangles: front.triangles().to_vec(),
        };
        for step in 0..12 {
            let tolerance = size * 10f64.powf(-2.2 + 0.8 * random.signed());
            let demand = match random.below(5) {
                0 => Demand::tolerance(tolerance).max_levels(2 + random.below(3) as u32),
                1 => Demand::pixels(0.5 + random.signed().abs(), &[camera(&mut random, size)]),
                2 => Demand::tolerance(0.0).triangles(control.face_count() + random.below(600)),
                3 => {
                    let cameras = [camera(&mut random, size), camera(&mut random, size)];
                    Demand::pixels(0.1, &cameras).triangles(100 + random.below(600))
                }
                _ => Demand::tolerance(tolerance),
            };
            let changes = front.update(&demand).unwrap();
            assert!(changes.vertices.is_sorted() && changes.triangles.is_sorted());
            copy.follow(&front);
            assert!(
                bytes(&front) == fresh(&control, &Loop, &demand),
                "{name}, step {step}: {demand:?}"
            );
            let mesh = front.mesh().unwrap();
            assert_eq!(
                unnumbered(&copy.positions, &copy.triangles),
                unnumbered(mesh.positions(), mesh.triangles()),
                "{name}, step {step}"
            );
            let is_closed = |mesh: &Mesh| mesh.topology().boundary_edge_count() == 0;
            assert_eq!(is_closed(&control), is_closed(&mesh), "{name}, step {step}");
            // Asked again it changes nothing.
            let again = front.update(&demand).unwrap();
            assert!(
                again.vertices.is_empty() && again.triangles.is_empty(),
                "{name}, step {step}: {demand:?}"
            );
        }
    }
}

/// Wherever an update is cancelled, there is a whole mesh, and the next one ends where a fresh front does.
#[test]
fn cancelled_updates_go_on_from_where_they_were() {
    let mut random = Random::new(23);
    for (name, control) in models() {
        let size = control.diagonal();
        let mut front = Front::new(&control, &Loop).unwrap();
        let mut copy = Copy {
            positions: front.positions().to_vec(),
            triangles: front.triangles().to_vec(),
        };
        let mut cancelled = 0;
        for step in 0..24 {
            let tolerance = size * 10f64.powf(-2.8 + 0.8 * random.signed());
            let demand = match step % 4 {
                0 => Demand::tolerance(0.0).triangles(control.face_count() + random.below(4000)),
                1 => Demand::pixels(0.02 + 0.02 * random.signed(), &[camera(&mut random, size)])
                    .triangles(20_000),
                _ => Demand::tolerance(tolerance),
            };
            let (mut calls, last) = (0, 1 + random.below(6));
            let mut observer = |_: &Progress| {
                calls += 1;
                if calls < last {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            };
            match front.update_observed(&demand, &mut observer) {
                Err(FrontError::Cancelled(_)) => cancelled += 1,
                other => drop(other.unwrap()),
            }
            copy.follow(&front);
            let mesh = front.mesh().unwrap();
            assert!(mesh.validate().is_ok());
            assert_eq!(
                unnumbered(&copy.positions, &copy.triangles),
                unnumbered(mesh.positions(), mesh.triangles()),
                "{name}, step {step}"
            );
            if step % 3 == 2 {
                front.update(&demand).unwrap();
                copy.follow(&front);
                assert!(
                    bytes(&front) == fresh(&control, &Loop, &demand),
                    "{name}, step {step}: {demand:?}"
                );
            }
        }
        assert!(cancelled > 5, "{name}: {cancelled}");
    }
    let mut never = |_: &Progress| ControlFlow::Break(());
    let control = octahedron();
    let found = Front::measured_by_observed(&control, &Loop, Measure::Distance, &mut never);
    assert!(matches!(found, Err(FrontError::Cancelled(_))));
}

/// A camera that moves a little from frame to frame is looked at node by node; a fresh front asks all nodes.
#[test]
fn cameras_that_move_a_little() {
    for (name, control) in [("lumpy", lumpy(9, 7)), ("sheet", sheet(4, 5, 3))] {
        let size = control.diagonal();
        let mut front = Front::new(&control, &Loop).unwrap();
        let mut counts = BTreeSet::new();
        for frame in 0..30 {
            let angle = 0.03 * f64::from(frame);
            let camera = Camera {
                eye: [
                    size * angle.cos(),
                    size * angle.sin(),
                    (0.5 + 0.2 * (3.0 * angle).sin()) * size,
                ],
                target: [0.2 * size * (2.0 * angle).sin(), 0.0, 0.0],
                up: [0.0, 0.0, 1.0],
                fov_degrees: 40.0,
                width: 400,
                height: 300,
            };
            let demand = Demand::pixels(1.5, &[camera]);
            front.update(&demand).unwrap();
            assert!(
                bytes(&front) == fresh(&control, &Loop, &demand),
                "{name}, frame {frame}"
            );
            assert!(front.pixels().unwrap() <= 1.5);
            counts.insert(front.triangles().len());
        }
        assert!(counts.len() > 10, "{name}: {counts:?}");
    }
}

/// The visible region does not depend on the distance of a camera's target, nor on the length of
/// its upward direction.
#[test]
fn lengths_of_a_cameras_directions_do_not_count() {
    let control = lumpy(9, 7);
    let control = mapped(&control, |&[x, y, z]| [x, y, z - 2.0]);
    let camera = |length: f64| Camera {
        eye: [0.0; 3],
        target: [0.1 * length, 0.2 * length, -length],
        up: [0.0, length, 0.0],
        fov_degrees: 20.0,
        width: 400,
        height: 300,
    };
    let demand = |length: f64| Demand::pixels(0.5, &[camera(length)]);
    let expected = fresh(&control, &Loop, &demand(1.0)).1;
    for length in [2f64.powi(-600), 2f64.powi(-1000), 2f64.powi(400)] {
        assert!(
            fresh(&control, &Loop, &demand(length)).1 == expected,
            "{length}"
        );
    }
    // Much is outside the picture.
    let all = Camera {
        fov_degrees: 120.0,
        ..camera(1.0)
    };
    let all = Demand::pixels(
        0.5 * 10f64.to_radians().tan() / 60f64.to_radians().tan(),
        &[all],
    );
    assert!(expected.len() < fresh(&control, &Loop, &all).1.len());
}

/// The samples of the surface over a mesh's triangles: each within the front's bound of the triangle's point at the same place.
fn farthest(control: &Mesh, scheme: &dyn Scheme, front: &Front<'_>) -> f64 {
    let surface = LimitSurface::new(control, scheme).unwrap();
    let mesh = front.mesh().unwrap();
    // Where vertices stand on the control faces, from an evenly refined surface: by their positions.
    let depth = 6;
    let cells = 1u32 << depth;
    let mut places: HashMap<(usize, [u64; 3]), Vec<[u32; 3]>> = HashMap::new();
    let rounded = |p: [f64; 3]| p.map(|x| ((x / control.diagonal() * 1e9).round() + 0.0).to_bits());
    let mut all = Vec::new();
    for face in 0..control.face_count() {
        for i in 0..=cells {
            for j in 0..=cells - i {
                all.push((FaceId(face as u32), [cells - i - j, i, j]));
            }
        }
    }
    let weights = |w: [u32; 3]| w.map(|w| f64::from(w) / f64::from(cells));
    let found = surface.at_all(
        &all.iter()
            .map(|&(face, at)| (face, weights(at)))
            .collect::<Vec<_>>(),
    );
    for (&(face, at), point) in all.iter().zip(&found) {
        places
            .entry((face.index(), rounded(point.position)))
            .or_default()
            .push(at);
    }
    let mut most = 0.0f64;
    // Triangles stand in the order of control faces.
    let mut face = 0;
    for triangle in mesh.triangles() {
        let corners = triangle.map(|v| mesh.positions()[v as usize]);
        let of = |face: usize| {
            let found: Option<Vec<_>> = corners
                .iter()
                .map(|&p| places.get(&(face, rounded(p))))
                .collect();
            found.filter(|all| all.iter().all(|list| list.len() == 1))
        };
        while of(face).is_none() {
            face += 1;
            assert!(
                face < control.face_count(),
                "no face has the triangle's corners"
            );
        }
        let at: Vec<[f64; 3]> = of(face)
            .unwrap()
            .iter()
            .map(|list| weights(list[0]))
            .collect();
        let inside: Vec<[f64; 3]> = (0..=6u32)
            .flat_map(|i| (0..=6 - i).map(move |j| [i, j, 6 - i - j].map(|w| f64::from(w) / 6.0)))
            .collect();
        let mix = |points: &[[f64; 3]], w: [f64; 3]| {
            [0, 1, 2].map(|axis| (0..3).map(|k| w[k] * points[k][axis]).sum())
        };
        let there: Vec<(FaceId, [f64; 3])> = inside
            .iter()
            .map(|&w| (FaceId(face as u32), mix(&at, w)))
            .collect();
        for (point, &w) in surface.at_all(&there).iter().zip(&inside) {
            most = most.max(crate::support::distance(point.position, mix(&corners, w)));
        }
    }
    most
}

#[test]
fn bounds_hold_by_samples() {
    for (name, control) in models() {
        // Copies have places of their own.
        if name == "cut" {
            continue;
        }
        let size = control.diagonal();
        let mut front = Front::new(&control, &Loop).unwrap();
        for part in [0.02, 0.004] {
            front
                .update(&Demand::tolerance(part * size).max_levels(6))
                .unwrap();
            at_most!(front.bound(), part * size, "{name}");
            let most = farthest(&control, &Loop, &front);
            at_most!(most, front.bound() + 1e-9 * size, "{name}");
            at_least!(most, 0.3 * front.bound(), "{name}");
        }
    }
}

/// A greater tolerance divides less, everywhere: its vertices are among those of a smaller one.
#[test]
fn fronts_are_nested() {
    for (name, control) in models() {
        let mut front = Front::new(&control, &LoopWarren).unwrap();
        let mut before: Option<BTreeSet<[u64; 3]>> = None;
        let mut tolerance = 0.1 * control.diagonal();
        while tolerance > 0.002 * control.diagonal() {
            front.update(&Demand::tolerance(tolerance)).unwrap();
            let mesh = front.mesh().unwrap();
            let own: BTreeSet<[u64; 3]> = mesh
                .positions()
                .iter()
                .map(|p| p.map(f64::to_bits))
                .collect();
            assert!(before.is_none_or(|before| before.is_subset(&own)), "{name}");
            before = Some(own);
            tolerance *= 0.7;
        }
    }
}

/// As many triangles as fit, and not one distance smaller.
#[test]
fn budgets_are_used() {
    for (name, control) in models() {
        let mut front = Front::new(&control, &Loop).unwrap();
        for most in [control.face_count(), 200, 777, 300] {
            front
                .update(&Demand::tolerance(0.0).triangles(most))
                .unwrap();
            let (count, limit) = (front.triangles().len(), front.limit());
            at_most!(count, most.max(control.face_count()), "{name}");
            assert_eq!(count, front.mesh().unwrap().face_count());
            let demand = Demand::tolerance(limit);
            assert!(
                bytes(&front) == fresh(&control, &Loop, &demand),
                "{name}, {most}"
            );
            let below = f64::from_bits(limit.to_bits() - 1);
            let mut finer = Front::new(&control, &Loop).unwrap();
            finer.update(&Demand::tolerance(below)).unwrap();
            above!(finer.triangles().len(), most, "{name}");
        }
    }
}

#[test]
fn other_schemes_are_estimated() {
    let control = octahedron();
    let mut front = Front::new(&control, &ModifiedButterfly).unwrap();
    assert!(!front.is_certified());
    let demand = Demand::tolerance(0.1);
    front.update(&demand).unwrap();
    assert!(front.triangles().len() > 30 && front.bound() <= 0.1);
    front.update(&Demand::tolerance(0.4)).unwrap();
    front.update(&demand).unwrap();
    assert!(bytes(&front) == fresh(&control, &ModifiedButterfly, &demand));
}

#[test]
fn demands_out_of_range_are_refused() {
    let control = octahedron();
    let mut front = Front::new(&control, &Loop).unwrap();
    let before = bytes(&front);
    let mut nowhere = camera(&mut Random::new(1), 1.0);
    nowhere.target = nowhere.eye;
    for demand in [
        Demand::tolerance(-1.0),
        Demand::tolerance(f64::NAN),
        Demand::tolerance(f64::INFINITY),
        Demand::pixels(f64::NAN, &[]),
        Demand::pixels(1.0, &[nowhere]),
    ] {
        assert!(front.update(&demand).is_err(), "{demand:?}");
    }
    assert!(bytes(&front) == before);
    // Without cameras nothing is visible.
    front.update(&Demand::tolerance(0.01)).unwrap();
    front.update(&Demand::pixels(1.0, &[])).unwrap();
    assert!(bytes(&front) == before);
}
