//! Random control meshes that are hard on a certificate: any valence, boundaries, sharp edges,
//! semi-sharp tags, sheets that are cut apart where more than two meet, slivers, folds, thin sheets
//! with holes, flat ones, tiny, huge and far from the origin.

use limitmesh::mesh::MeshError;
use limitmesh::mesh::{INFINITELY_SHARP, Tags};
use limitmesh::{Mesh, PolygonSoup};

use crate::support::{Point, Random, corner, crease, lumpy, octahedron, sheet, torus};

/// Cages that are made for one seed at most, until one has faces.
const MOST_TRIES: usize = 100;

/// A random cage and what it is.
pub(crate) struct Cage {
    pub(crate) mesh: Mesh,
    pub(crate) what: String,
}

/// The cage of a seed.
pub(crate) fn cage(seed: u64) -> Cage {
    let mut random = Random::new(seed);
    // A few of the small ones have no face that is any good.
    core::iter::repeat_with(|| random_cage(&mut random, seed))
        .take(MOST_TRIES)
        .flatten()
        .next()
        .unwrap()
}

fn random_cage(random: &mut Random, seed: u64) -> Option<Cage> {
    let (mut positions, mut triangles, mut what) = base(random, seed);
    if random.below(3) == 0 {
        flip(&mut triangles, random);
        what += ", flipped";
    }
    if random.below(4) == 0 && triangles.len() > 4 {
        let removed = 1 + random.below(triangles.len() / 4);
        for _ in 0..removed {
            triangles.swap_remove(random.below(triangles.len()));
        }
        what += ", holes";
    }
    if random.below(6) == 0 {
        fins(&mut positions, &mut triangles, random, &mut what);
    }
    deform(&mut positions, random, &mut what);
    let mut soup = PolygonSoup {
        positions,
        ..PolygonSoup::default()
    };
    triangles
        .iter()
        .for_each(|triangle| soup.faces.push(triangle));
    let mesh = match Mesh::from_soup(&soup, &Default::default()) {
        Ok((mesh, _)) => mesh,
        Err(MeshError::NoFaces { .. }) => return None,
        Err(error) => panic!("{what}: {error}"),
    };
    let mesh = tagged(mesh, random, &mut what);
    Some(Cage { mesh, what })
}

type Raw = (Vec<Point>, Vec<[u32; 3]>, String);

fn base(random: &mut Random, seed: u64) -> Raw {
    let raw =
        |mesh: Mesh, what: String| (mesh.positions().to_vec(), mesh.triangles().to_vec(), what);
    let size = |random: &mut Random| 3 + random.below(4) as u32;
    match random.below(10) {
        0 => raw(octahedron(), "octahedron".into()),
        1 => raw(lumpy(1 + random.below(30), seed), "lumpy".into()),
        2 => raw(torus(size(random), size(random)), "torus".into()),
        3 => raw(
            sheet(1 + random.below(5) as u32, 1 + random.below(5) as u32, seed),
            "sheet".into(),
        ),
        4 => washer(
            3 + random.below(8) as u32,
            0.02 * (1 + random.below(20)) as f64,
        ),
        5 => bipyramid([3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 20, 30, 40][random.below(13)]),
        6 => fan([2, 3, 4, 6, 9, 20, 30, 40][random.below(8)]),
        7 => soup_of_tetrahedra(1 + random.below(3) as u32),
        8 => book(2 + random.below(4) as u32, 1 + random.below(3) as u32),
        _ => pillow(3 + random.below(9) as u32),
    }
}

/// A flat ring with a hole, closed: its rims bend both ways.
fn washer(n: u32, thickness: f64) -> Raw {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..n {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        for (radius, z) in [(1.0, 0.0), (1.5, thickness), (2.0, 0.0), (1.5, -thickness)] {
            positions.push([radius * angle.cos(), radius * angle.sin(), z]);
        }
    }
    let at = |i: u32, j: u32| 4 * (i % n) + j % 4;
    for i in 0..n {
        for j in 0..4 {
            triangles.push([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    (positions, triangles, format!("washer of {n}"))
}

fn bipyramid(n: u32) -> Raw {
    let mut positions = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    let mut triangles = Vec::new();
    for i in 0..n {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        positions.push([angle.cos(), angle.sin(), 0.0]);
        let (a, b) = (2 + i, 2 + (i + 1) % n);
        triangles.extend([[0, a, b], [1, b, a]]);
    }
    (positions, triangles, format!("bipyramid of {n}"))
}

fn fan(n: u32) -> Raw {
    let mut positions = vec![[0.0, 0.0, 0.5]];
    for i in 0..=n {
        let angle = 5.0 * f64::from(i) / f64::from(n);
        positions.push([angle.cos(), angle.sin(), 0.2 * f64::from(i % 3)]);
    }
    (
        positions,
        (1..=n).map(|i| [0, i, i + 1]).collect(),
        format!("fan of {n}"),
    )
}

fn soup_of_tetrahedra(count: u32) -> Raw {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..count {
        let x = f64::from(i);
        positions.extend([
            [x, 0.0, 0.0],
            [x + 1.0, 0.0, 0.1],
            [x, 1.0, 0.0],
            [x + 0.2, 0.3, 1.0],
        ]);
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        triangles.extend(faces.map(|face| face.map(|v: u32| 4 * i + v)));
    }
    (positions, triangles, format!("{count} tetrahedra"))
}

/// Sheets of two by `n` quads that share their first edges: more than two are cut apart there.
fn book(pages: u32, n: u32) -> Raw {
    let mut positions: Vec<Point> = (0..=n).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let mut triangles = Vec::new();
    for page in 0..pages {
        let angle = 5.0 * f64::from(page) / f64::from(pages);
        let first = positions.len() as u32;
        for column in 1..=2 {
            let (x, y) = (f64::from(column), 0.3 * f64::from(column * column));
            let (sine, cosine) = angle.sin_cos();
            positions.extend(
                (0..=n).map(|i| [f64::from(i), cosine * x - sine * y, sine * x + cosine * y]),
            );
        }
        let at = |i: u32, column: u32| {
            if column == 0 {
                i
            } else {
                first + (column - 1) * (n + 1) + i
            }
        };
        for (i, j) in (0..n).flat_map(|i| [(i, 0), (i, 1)]) {
            triangles.push([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    (positions, triangles, format!("book of {pages}"))
}

/// Triangles more at edges that have theirs.
fn fins(
    positions: &mut Vec<Point>,
    triangles: &mut Vec<[u32; 3]>,
    random: &mut Random,
    what: &mut String,
) {
    let count = 1 + random.below(4);
    for _ in 0..count {
        let (f, i) = (random.below(triangles.len()), random.below(3));
        let [a, b] = [0, 1].map(|k| triangles[f][(i + k) % 3]);
        let [from, to] = [a, b].map(|v| positions[v as usize]);
        let tip = std::array::from_fn(|axis| 0.5 * (from[axis] + to[axis]) + random.signed());
        triangles.push([b, a, positions.len() as u32]);
        positions.push(tip);
    }
    *what += &format!(", {count} fins");
}

/// Two sheets joined along a star-shaped outline that bends both ways.
fn pillow(n: u32) -> Raw {
    let mut positions = vec![[0.0, 0.0, 0.1], [0.0, 0.0, -0.1]];
    let mut triangles = Vec::new();
    for i in 0..2 * n {
        let angle = std::f64::consts::PI * f64::from(i) / f64::from(n);
        let radius = if i % 2 == 0 { 1.0 } else { 0.4 };
        positions.push([radius * angle.cos(), radius * angle.sin(), 0.0]);
        let (a, b) = (2 + i, 2 + (i + 1) % (2 * n));
        triangles.extend([[0, a, b], [1, b, a]]);
    }
    (positions, triangles, format!("star pillow of {n}"))
}

/// Turns random edges in the quadrilaterals around them, unless that would make an edge twice.
fn flip(triangles: &mut [[u32; 3]], random: &mut Random) {
    for _ in 0..2 * triangles.len() {
        let (f, i) = (random.below(triangles.len()), random.below(3));
        let [a, b, c] = [0, 1, 2].map(|k| triangles[f][(i + k) % 3]);
        let beyond = triangles
            .iter()
            .position(|t| (0..3).any(|k| (t[k], t[(k + 1) % 3]) == (b, a)));
        let Some(g) = beyond else { continue };
        let d = triangles[g]
            .into_iter()
            .find(|&v| v != a && v != b)
            .unwrap();
        let joined = triangles.iter().any(|t| t.contains(&c) && t.contains(&d));
        if c != d && !joined {
            (triangles[f], triangles[g]) = ([c, a, d], [d, b, c]);
        }
    }
}

/// Noise, stretching, shearing, flattening, scale and place.
fn deform(positions: &mut [Point], random: &mut Random, what: &mut String) {
    let noise = [0.0, 0.02, 0.3, 1.5][random.below(4)];
    for p in positions.iter_mut() {
        *p = p.map(|x| x + noise * random.signed());
    }
    *what += &format!(", noise {noise}");
    if random.below(2) == 0 {
        let factors: Point = std::array::from_fn(|_| 10f64.powf(-4.0 * random.signed().max(0.0)));
        let shear = [0.0, 0.0, 3.0, 30.0][random.below(4)];
        for p in positions.iter_mut() {
            *p = [
                p[0] * factors[0] + shear * p[1],
                p[1] * factors[1],
                p[2] * factors[2],
            ];
        }
        *what += &format!(", stretched {factors:?}, sheared {shear}");
    }
    if random.below(12) == 0 {
        positions.iter_mut().for_each(|p| p[2] = 0.0);
        *what += ", flat";
    }
    if random.below(4) == 0 {
        let scale = 10f64.powf(12.0 * random.signed());
        positions.iter_mut().for_each(|p| *p = p.map(|x| scale * x));
        *what += &format!(", times {scale:e}");
    } else if random.below(4) == 0 {
        let place: Point = std::array::from_fn(|_| 1e6 * random.signed());
        positions
            .iter_mut()
            .for_each(|p| *p = std::array::from_fn(|i| p[i] + place[i]));
        *what += ", far away";
    }
}

/// Sharp edges and vertices, for good or for some levels.
fn tagged(mesh: Mesh, random: &mut Random, what: &mut String) -> Mesh {
    let share = [0, 0, 5, 30, 100][random.below(5)];
    if share == 0 {
        return mesh;
    }
    let fades = random.below(2) == 0;
    let sharpness = |random: &mut Random| match random.below(3) {
        _ if !fades => INFINITELY_SHARP,
        0 => INFINITELY_SHARP,
        _ => [0.3, 1.0, 1.5, 2.0, 3.7][random.below(5)],
    };
    let mut tags = Tags::default();
    for triangle in mesh.triangles() {
        for i in 0..3 {
            let vertices = [triangle[i], triangle[(i + 1) % 3]];
            if random.below(200) < share {
                tags.creases.push(crease(vertices, sharpness(random)));
            }
        }
    }
    for vertex in 0..mesh.vertex_count() as u32 {
        if random.below(800) < share {
            tags.corners.push(corner(vertex, sharpness(random)));
        }
    }
    let kind = if fades { "fading " } else { "" };
    *what += &format!(
        ", {} {kind}creases and {} corners",
        tags.creases.len(),
        tags.corners.len()
    );
    mesh.with_tags(tags).unwrap()
}
