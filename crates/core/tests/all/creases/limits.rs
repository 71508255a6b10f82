//! Limit positions and normals of tagged vertices against iteration.
//!
//! A fan of circles round one vertex is refined again and again and cropped to the vertex's surroundings. Rules
//! commute with affine maps: for the normal on one side, the vertex is moved to the origin after each step and two
//! directions of that side are mapped to the axes, so that no digits are lost to shrinking.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use limitmesh::limit::LimitTable;
use limitmesh::mesh::{Sharpness, Tags};
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{HalfEdgeId, Mesh, VertexId};

use crate::support::{Point, cross, distance, divided, dot};

const CENTRE: VertexId = VertexId(0);

/// A hilly fan round vertex 0: circles of `k` vertices each, joined by strips; part of circles where `open`.
fn fan(k: u32, open: bool) -> Mesh {
    const CIRCLES: u32 = 4;
    let whole = if open { 2.5 } else { TAU };
    let parts = if open { k - 1 } else { k };
    let mut positions = vec![[0.1, -0.2, 0.3]];
    for circle in 1..=CIRCLES {
        for i in 0..k {
            let (sine, cosine) =
                (whole * f64::from(i) / f64::from(parts) + 0.1 * f64::from(circle)).sin_cos();
            let bump = |a: f64, b: f64| (a * f64::from(i) + b * f64::from(circle)).sin();
            let radius = f64::from(circle) * (1.0 + 0.1 * bump(2.1, 0.7));
            positions.push([
                radius * cosine,
                radius * sine,
                0.4 * bump(1.3, 2.9) + 0.3 * bump(0.9, 0.2),
            ]);
        }
    }
    let at = |circle: u32, i: u32| {
        if circle == 0 {
            0
        } else {
            1 + (circle - 1) * k + i % k
        }
    };
    let mut triangles = Vec::new();
    for i in 0..parts {
        triangles.push([0, at(1, i), at(1, i + 1)]);
        for circle in 1..CIRCLES {
            triangles.push([at(circle, i), at(circle + 1, i), at(circle + 1, i + 1)]);
            triangles.push([at(circle, i), at(circle + 1, i + 1), at(circle, i + 1)]);
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// The fan with sharp spokes, by slot, that go on outwards to the rim.
fn tagged(k: u32, open: bool, spokes: &[(u32, f64)], corner: f64) -> Mesh {
    let out = |&(slot, sharpness): &(u32, f64)| {
        (0..4).map(move |circle| {
            let from = if circle == 0 {
                0
            } else {
                1 + (circle - 1) * k + slot
            };
            crate::support::crease([from, 1 + circle * k + slot], sharpness)
        })
    };
    let corners = vec![crate::support::corner(0, corner)];
    fan(k, open)
        .with_tags(Tags {
            creases: spokes.iter().flat_map(out).collect(),
            corners,
        })
        .unwrap()
}

/// The faces within `radius` edges of vertex 0, which stays vertex 0, with their tags, and their vertices' numbers.
fn cropped(mesh: &Mesh, radius: usize) -> (Mesh, BTreeMap<u32, u32>) {
    let mut far = BTreeMap::from([(0u32, 0usize)]);
    for step in 1..=radius {
        let known: Vec<u32> = far
            .iter()
            .filter(|&(_, &d)| d == step - 1)
            .map(|(&v, _)| v)
            .collect();
        for v in known {
            for u in mesh.topology().ring(VertexId(v)) {
                far.entry(u.0).or_insert(step);
            }
        }
    }
    let index: BTreeMap<u32, u32> = far.keys().copied().zip(0..).collect();
    let inside = |vertices: &[u32]| vertices.iter().all(|v| index.contains_key(v));
    let triangles: Vec<[u32; 3]> = mesh
        .triangles()
        .iter()
        .filter(|t| inside(&t[..]))
        .map(|t| t.map(|v| index[&v]))
        .collect();
    let positions = index
        .keys()
        .map(|&v| mesh.positions()[v as usize])
        .collect();
    let cropped = Mesh::from_triangles(positions, triangles).unwrap();
    let mut tags = mesh.tags().clone();
    tags.creases.retain(|tag| inside(&tag.vertices));
    tags.corners.retain(|tag| inside(&[tag.vertex]));
    tags.creases
        .iter_mut()
        .for_each(|tag| tag.vertices = tag.vertices.map(|v| index[&v]));
    tags.corners
        .iter_mut()
        .for_each(|tag| tag.vertex = index[&tag.vertex]);
    let (topology, edges) = (cropped.topology(), &mut tags.creases);
    edges.retain(|tag| {
        topology
            .edge_between(VertexId(tag.vertices[0]), VertexId(tag.vertices[1]))
            .is_some()
    });
    (cropped.with_tags(tags).unwrap(), index)
}

/// One refinement, and the new neighbour of vertex 0 on the edge to its neighbour `first`.
fn step(mesh: &Mesh, scheme: &dyn Scheme, first: u32) -> (Mesh, u32) {
    let refined = divided(mesh, scheme, 1);
    // Rings start at the same edge before and after.
    let slot = ring(mesh).iter().position(|&v| v == first).unwrap();
    let on_edge = ring(&refined)[slot];
    let (mesh, index) = cropped(&refined, 3);
    (mesh, index[&on_edge])
}

fn unit(a: Point) -> Point {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// The vertex and its neighbours, slot by slot.
fn ring(mesh: &Mesh) -> Vec<u32> {
    mesh.topology().ring(CENTRE).map(|v| v.0).collect()
}

/// The limit position of vertex 0 by iteration.
fn iterated_position(mesh: &Mesh, scheme: &dyn Scheme) -> Point {
    let mut mesh = mesh.clone();
    for _ in 0..70 {
        mesh = step(&mesh, scheme, ring(&mesh)[0]).0;
    }
    mesh.positions()[0]
}

/// The normal, by iteration, of so many faces at vertex 0, counter-clockwise from the edge to `first`.
fn iterated_normal(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    first: u32,
    faces: usize,
    steps: usize,
) -> Point {
    let mut mesh = mesh.clone();
    let mut first = first;
    // Rows of the map from the original space.
    let mut rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for count in 0.. {
        let around = ring(&mesh);
        let start = around.iter().position(|&v| v == first).unwrap();
        let origin = mesh.positions()[0];
        let spoke = |slot: usize| {
            let p = mesh.positions()[around[(start + slot) % around.len()] as usize];
            [0, 1, 2].map(|axis| p[axis] - origin[axis])
        };
        // A quarter turn in a closed ring, and half of an open one: never parallel.
        let apart = if faces == around.len() {
            faces.div_ceil(4)
        } else {
            faces.div_ceil(2)
        };
        let (a, b) = (spoke(0), spoke(apart));
        let c = cross(a, b);
        if count == steps {
            let mapped = unit(c);
            return unit(
                [0, 1, 2].map(|axis| (0..3).map(|row| rows[row][axis] * mapped[row]).sum()),
            );
        }
        // The dual basis of a, b and their normal, as long as they are.
        let size = dot(c, c).sqrt();
        let normal = c.map(|x| x / size.sqrt());
        let dual = [cross(b, normal), cross(normal, a), c];
        let volume = dot(a, dual[0]);
        let map = dual.map(|row| row.map(|x| x / volume));
        let moved = |p: &Point| {
            let p = [0, 1, 2].map(|axis| p[axis] - origin[axis]);
            map.map(|row| dot(row, p))
        };
        let next =
            map.map(|row| [0, 1, 2].map(|axis| (0..3).map(|i| row[i] * rows[i][axis]).sum()));
        let most = next
            .as_flattened()
            .iter()
            .fold(0.0, |most: f64, x: &f64| most.max(x.abs()));
        rows = next.map(|row: Point| row.map(|x| x / most));
        let positions = mesh.positions().iter().map(moved).collect();
        let before = mesh.clone().with_positions(positions).unwrap();
        (mesh, first) = step(&before, scheme, first);
    }
    unreachable!()
}

/// Checks position and all sides' normals of vertex 0.
fn check(name: &str, mesh: &Mesh, scheme: &dyn Scheme, steps: usize, tolerance: f64) {
    let table = LimitTable::new(scheme);
    let position = table.position(mesh, CENTRE).unwrap();
    let expected = iterated_position(mesh, scheme);
    assert!(
        distance(position, expected) < 1e-10,
        "{name}: {position:?}, expected {expected:?}"
    );
    let all = table.sided_normals(mesh).unwrap();
    assert_eq!(table.positions(mesh).unwrap()[0], position, "{name}");
    assert_eq!(
        table.normal(mesh, CENTRE).unwrap(),
        all.by_vertex()[0],
        "{name}"
    );
    let lasting = Sharpness::of(mesh);
    let lasting = lasting.infinitely_sharp();
    for sector in lasting.sectors(CENTRE) {
        let first = mesh.topology().target(sector.first).0;
        let expected = iterated_normal(mesh, scheme, first, sector.shape.faces() as usize, steps);
        for h in sector.outgoing(mesh.topology()) {
            let normal = all.at(mesh.topology(), h);
            assert_eq!(table.normal_at(mesh, h).unwrap(), normal);
            let off = distance(normal, expected);
            assert!(
                off < tolerance,
                "{name}, {:?}: {normal:?}, expected {expected:?} ({off})",
                sector.shape
            );
        }
    }
    let corners: Vec<HalfEdgeId> = mesh.topology().outgoing_ring(CENTRE).collect();
    assert_eq!(
        corners.len(),
        lasting
            .sectors(CENTRE)
            .iter()
            .map(|s| s.shape.faces() as usize)
            .sum::<usize>()
    );
}

const INFINITE: f64 = f64::INFINITY;

#[test]
fn darts_have_the_limits_of_iteration() {
    for k in 3..=12 {
        for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
            let mesh = tagged(k, false, &[(k / 2, INFINITE)], 0.0);
            check(
                &format!("{} dart {k}", scheme.name()),
                &mesh,
                scheme,
                200,
                1e-8,
            );
        }
    }
}

#[test]
fn a_dart_of_six_edges_has_the_known_weights() {
    use limitmesh::ring::RingShape;
    let shape = RingShape {
        dart: true,
        ..RingShape::interior(6)
    };
    let table = LimitTable::new(&Loop);
    let stencil = table.stencil(shape).unwrap();
    let known = [0.5164, 0.0986, 0.0681, 0.0822, 0.0845, 0.0822, 0.0681];
    for (weight, known) in stencil.position_weights().iter().zip(known) {
        below!((weight - known).abs(), 5.1e-5, "{weight}, expected {known}");
    }
}

#[test]
fn creases_have_the_limits_of_iteration_on_both_sides() {
    for k in 3..=12 {
        // Sectors of up to five faces, so that both sides are smooth.
        for second in (1..k).filter(|&second| second <= 5 && k - second <= 5) {
            let mesh = tagged(k, false, &[(0, INFINITE), (second, INFINITE)], 0.0);
            check(&format!("crease {k}, {second}"), &mesh, &Loop, 250, 1e-8);
        }
    }
}

#[test]
fn corners_have_the_limits_of_iteration() {
    // Sides of one face or two: with more of them Loop's surface has no tangent plane at a corner.
    for (k, spokes) in [
        (6, vec![0, 2, 4]),
        (5, vec![1, 2, 4]),
        (5, vec![0, 1, 2, 3, 4]),
        (3, vec![0, 1, 2]),
    ] {
        let spokes: Vec<(u32, f64)> = spokes.into_iter().map(|slot| (slot, INFINITE)).collect();
        let mesh = tagged(k, false, &spokes, 0.0);
        check(&format!("corner {k}"), &mesh, &Loop, 120, 1e-8);
    }
    // A boundary vertex with a crease that runs into it.
    for k in [4, 5] {
        check(
            &format!("open {k}"),
            &tagged(k, true, &[(2, INFINITE)], 0.0),
            &Loop,
            120,
            1e-8,
        );
    }
}

#[test]
fn what_fades_has_the_limits_of_iteration() {
    for k in 3..=9 {
        for s in [0.5, 1.0, 1.5, 2.3, 3.7] {
            let name = |kind: &str| format!("{kind} {k}, sharpness {s}");
            let half = k / 2;
            check(
                &name("dart"),
                &tagged(k, false, &[(0, s)], 0.0),
                &Loop,
                120,
                1e-8,
            );
            check(
                &name("crease"),
                &tagged(k, false, &[(0, s), (half, s)], 0.0),
                &Loop,
                120,
                1e-8,
            );
            check(&name("corner"), &tagged(k, false, &[], s), &Loop, 120, 1e-8);
            let mixed = [(0, s), (half, INFINITE), (k - 1, 0.7 * s)];
            check(
                &name("mixed"),
                &tagged(k, false, &mixed, 0.4 * s),
                &Loop,
                200,
                1e-8,
            );
        }
    }
    for s in [0.5, 1.0, 2.3] {
        check(
            "open",
            &tagged(5, true, &[(1, s), (3, 2.0)], 0.0),
            &Loop,
            200,
            1e-8,
        );
        check(
            "into crease",
            &tagged(7, false, &[(0, INFINITE), (2, s), (4, INFINITE)], 0.0),
            &Loop,
            200,
            1e-8,
        );
    }
}

#[test]
fn two_ring_schemes_have_the_limits_of_iteration_at_tags() {
    // Two faces a side at least: with a single one the scheme converges like 1/n, too slowly to be
    // iterated.
    for k in 4..=8 {
        let half = k / 2;
        let name = |kind: &str| format!("butterfly {kind} {k}");
        let crease = tagged(k, false, &[(0, INFINITE), (half, INFINITE)], 0.0);
        check(&name("crease"), &crease, &ModifiedButterfly, 120, 1e-7);
        check(
            &name("dart"),
            &tagged(k, false, &[(0, INFINITE)], 0.0),
            &ModifiedButterfly,
            120,
            1e-7,
        );
        for s in [0.5, 1.0, 2.3] {
            let fading = tagged(k, false, &[(0, s), (half, s)], 0.0);
            check(&name("fading"), &fading, &ModifiedButterfly, 120, 1e-7);
        }
    }
}
