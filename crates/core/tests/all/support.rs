//! Meshes for tests, and a brute-force Loop subdivision that shares no code with the library.
#![allow(dead_code, missing_docs, unreachable_pub, clippy::unwrap_used)]

use std::collections::{BTreeMap, HashMap};
use std::io::Write;
use std::path::{Path, PathBuf};

use limitmesh::measure::{
    CertifiedHausdorff, CertifiedOptions, SamplingOptions, certified_hausdorff, hausdorff,
};
use limitmesh::mesh::{CornerTag, CreaseTag, INFINITELY_SHARP, Tags};
use limitmesh::refine::limit_reference;
use limitmesh::refine::{Exact, ExactOptions, RefineError, UniformOptions, uniform};
use limitmesh::scheme::Scheme;
use limitmesh::{HalfEdgeId, Mesh, Triangles};

pub type Point = [f64; 3];

pub fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|i| a[i] - b[i])
}

pub fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

pub fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A small deterministic generator, so that tests do not depend on a crate's stream of random numbers.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Uniform in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

/// Closed and open meshes, even and uneven.
pub fn samples() -> Vec<(&'static str, Mesh)> {
    vec![
        ("octahedron", octahedron()),
        ("torus", torus(5, 4)),
        ("sheet", sheet(4, 5, 3)),
        ("lumpy", lumpy(12, 7)),
    ]
}

pub fn octahedron() -> Mesh {
    let positions = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// The triangles of a grid of so many columns and rows of vertices, row by row.
pub fn grid(columns: u32, rows: u32) -> Vec<[u32; 3]> {
    let quads = (0..rows - 1).flat_map(|j| (0..columns - 1).map(move |i| j * columns + i));
    quads
        .flat_map(|v| {
            [
                [v, v + 1, v + columns + 1],
                [v, v + columns + 1, v + columns],
            ]
        })
        .collect()
}

/// A torus-like grid of `m` by `n` quads, each cut in two: every vertex has valence 6.
pub fn torus(m: u32, n: u32) -> Mesh {
    let tau = std::f64::consts::TAU;
    let mut positions = Vec::new();
    for i in 0..m {
        for j in 0..n {
            let (u, v) = (
                tau * f64::from(i) / f64::from(m),
                tau * f64::from(j) / f64::from(n),
            );
            let r = 2.0 + 0.7 * v.cos();
            positions.push([r * u.cos(), r * u.sin(), 0.7 * v.sin()]);
        }
    }
    let at = |i: u32, j: u32| (i % m) * n + j % n;
    let mut triangles = Vec::new();
    for i in 0..m {
        for j in 0..n {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// An open sheet of `m` by `n` quads with diagonals either way, so that valences vary inside and on the boundary.
pub fn sheet(m: u32, n: u32, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let mut positions = Vec::new();
    for i in 0..=m {
        for j in 0..=n {
            let mut jitter = || 0.2 * random.signed();
            positions.push([
                f64::from(i) + jitter(),
                f64::from(j) + jitter(),
                3.0 * jitter(),
            ]);
        }
    }
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let mut triangles = Vec::new();
    for i in 0..m {
        for j in 0..n {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if random.below(2) == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// A closed surface with valences from 3 up: an octahedron whose faces are split at random and whose vertices
/// are then moved.
pub fn lumpy(splits: usize, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let base = octahedron();
    let mut positions = base.positions().to_vec();
    let mut triangles = base.triangles().to_vec();
    for _ in 0..splits {
        let f = random.below(triangles.len());
        let [a, b, c] = triangles[f];
        let middle = positions.len() as u32;
        let centre: Point = std::array::from_fn(|axis| {
            [a, b, c]
                .iter()
                .map(|&v| positions[v as usize][axis])
                .sum::<f64>()
                / 2.4
        });
        positions.push(centre);
        triangles[f] = [a, b, middle];
        triangles.extend([[b, c, middle], [c, a, middle]]);
    }
    for p in &mut positions {
        *p = p.map(|x| x + 0.1 * random.signed());
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// One level of Loop subdivision (the paper's equation 1; boundaries 1/8, 3/4, 1/8) from edge maps alone.
/// Old vertices keep their numbers; the new vertex of each edge is returned by its ends.
pub struct BruteForceLoop {
    pub positions: Vec<Point>,
    pub triangles: Vec<[u32; 3]>,
    pub edge_vertices: BTreeMap<[u32; 2], u32>,
}

pub fn brute_force_loop(positions: &[Point], triangles: &[[u32; 3]]) -> BruteForceLoop {
    let mut opposite: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for [p, q, r] in [[a, b, c], [b, c, a], [c, a, b]] {
            opposite.entry([p.min(q), p.max(q)]).or_default().push(r);
        }
    }
    let combine = |terms: &[(f64, u32)]| -> Point {
        std::array::from_fn(|axis| {
            terms
                .iter()
                .map(|&(w, v)| w * positions[v as usize][axis])
                .sum()
        })
    };
    let mut neighbours = vec![Vec::new(); positions.len()];
    let mut boundary = vec![Vec::new(); positions.len()];
    for ([a, b], faces) in &opposite {
        for (from, to) in [(*a, *b), (*b, *a)] {
            neighbours[from as usize].push(to);
            if faces.len() == 1 {
                boundary[from as usize].push(to);
            }
        }
    }
    let mut refined: Vec<Point> = (0..positions.len())
        .map(|v| {
            let own = v as u32;
            if let [a, b] = boundary[v][..] {
                return combine(&[(0.75, own), (0.125, a), (0.125, b)]);
            }
            let k = neighbours[v].len() as f64;
            let c = 3.0 / 8.0 + (2.0 * std::f64::consts::PI / k).cos() / 4.0;
            let beta = (5.0 / 8.0 - c * c) / k;
            let mut terms = vec![(1.0 - k * beta, own)];
            terms.extend(neighbours[v].iter().map(|&u| (beta, u)));
            combine(&terms)
        })
        .collect();
    let mut edge_vertices = BTreeMap::new();
    for (&[a, b], faces) in &opposite {
        edge_vertices.insert([a, b], refined.len() as u32);
        refined.push(match faces[..] {
            [c, d] => combine(&[(0.375, a), (0.375, b), (0.125, c), (0.125, d)]),
            _ => combine(&[(0.5, a), (0.5, b)]),
        });
    }
    let on = |p: u32, q: u32| edge_vertices[&[p.min(q), p.max(q)]];
    let split = triangles
        .iter()
        .flat_map(|&[a, b, c]| {
            let [ab, bc, ca] = [on(a, b), on(b, c), on(c, a)];
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        })
        .collect();
    BruteForceLoop {
        positions: refined,
        triangles: split,
        edge_vertices,
    }
}

pub fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Each triangle's corner positions, rotated so that the least comes first, all sorted: a mesh without its
/// numbering, rounded to `digits` decimals.
pub fn unnumbered(mesh: &Mesh, digits: i32) -> Vec<[[i64; 3]; 3]> {
    let scale = 10f64.powi(digits);
    let mut all: Vec<[[i64; 3]; 3]> = mesh
        .triangles()
        .iter()
        .map(|t| {
            let mut corners =
                t.map(|v| mesh.positions()[v as usize].map(|x| (x * scale).round() as i64));
            let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
            corners.rotate_left(least);
            corners
        })
        .collect();
    all.sort_unstable();
    all
}

/// A mesh of triangles with tags, read as plainly as can be.
pub fn tagged_obj(text: &str) -> Mesh {
    let (mut positions, mut triangles, mut tags) = (Vec::new(), Vec::new(), Tags::default());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |i: usize| words[i].parse::<f64>().unwrap();
        match words.first() {
            Some(&"v") => positions.push([number(1), number(2), number(3)]),
            Some(&"f") => {
                let corner =
                    |i: usize| words[i].split('/').next().unwrap().parse::<u32>().unwrap() - 1;
                triangles.push([corner(1), corner(2), corner(3)]);
            }
            Some(&"t") if words[1] == "crease" => {
                let vertices = [number(3) as u32, number(4) as u32];
                tags.creases.push(crease(vertices, number(5)));
            }
            Some(&"t") if words[1] == "corner" => {
                tags.corners.push(corner(number(3) as u32, number(4)));
            }
            _ => {}
        }
    }
    tags.corners.sort_by_key(|tag| tag.vertex);
    Mesh::from_triangles(positions, triangles)
        .unwrap()
        .with_tags(tags)
        .unwrap()
}

/// Every vertex of an exact refinement is a vertex of the uniform refinement that is as deep (five levels at most), with its
/// limit at the same place.
pub fn vertices_are_of_uniform_refinement(
    control: &Mesh,
    scheme: &dyn Scheme,
    result: &Exact,
    name: &str,
) {
    let levels = result.statistics.levels.min(5);
    let reference = limit_reference(control, scheme, levels).unwrap();
    let scale = 1e-9 * control.diagonal();
    let key = |p: &Point| p.map(|x| (x / scale / 1000.0).round() as i64);
    let mut near: HashMap<[i64; 3], Vec<Point>> = HashMap::new();
    for p in reference.positions() {
        near.entry(key(p)).or_default().push(*p);
    }
    let finest = 1.0 / (1u64 << levels) as f64;
    for (p, origin) in result.mesh.positions().iter().zip(&result.origins) {
        if origin.barycentric.iter().any(|b| b % finest != 0.0) {
            continue;
        }
        let [x, y, z] = key(p);
        let cells = (-1..=1)
            .flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [x + i, y + j, z + k])));
        let found = cells
            .filter_map(|cell| near.get(&cell))
            .flatten()
            .any(|q| (0..3).all(|i| (p[i] - q[i]).abs() < scale));
        assert!(found, "{name}, {}: {p:?} from {origin:?}", scheme.name());
    }
}

/// The edges of a mesh whose faces are turned by more than 30 degrees, and the boundary, are sharp.
pub fn creased(positions: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Mesh {
    let mesh = Mesh::from_triangles(positions, triangles).unwrap();
    let unit = |face| {
        let n: [f64; 3] = mesh.face_normal(face);
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        n.map(|x| x / length)
    };
    let topology = mesh.topology();
    let mut creases = Vec::new();
    for h in topology.half_edges() {
        let Some(twin) = topology.twin(h).filter(|twin| h < *twin) else {
            continue;
        };
        let [a, b] = [h, twin].map(|h| unit(h.face()));
        if (0..3).map(|i| a[i] * b[i]).sum::<f64>() < 30f64.to_radians().cos() {
            let [from, to] = topology.ends(h);
            creases.push(crease([from.0, to.0], INFINITELY_SHARP));
        }
    }
    mesh.with_tags(Tags {
        creases,
        ..Tags::default()
    })
    .unwrap()
}

/// A peg of so many facets, radius 1 and height 3, turned in space by a rotation that leaves no coordinate whole; its ends are fans
/// from a vertex of the rim.
pub fn peg(facets: u32) -> Mesh {
    let turned = |[x, y, z]: [f64; 3]| {
        let (s, c) = 0.7f64.sin_cos();
        let [x, y, z] = [c * x - s * y, s * x + c * y, z];
        [x, c * y - s * z, s * y + c * z]
    };
    let rim = |z: f64| {
        (0..facets).map(move |i| {
            let (s, c) = (std::f64::consts::TAU * f64::from(i) / f64::from(facets)).sin_cos();
            [c, s, z]
        })
    };
    let positions = rim(0.0).chain(rim(3.0)).map(turned).collect();
    let mut triangles = Vec::new();
    for i in 0..facets {
        let next = (i + 1) % facets;
        triangles.extend([[i, next, facets + next], [i, facets + next, facets + i]]);
    }
    for i in 1..facets - 1 {
        triangles.extend([[0, i + 1, i], [facets, facets + i, facets + i + 1]]);
    }
    creased(positions, triangles)
}

/// Triangles of results that are checked: more would take long.
const MOST_CHECKED: usize = 20_000;

/// [`limitmesh::refine::exact`], what is certified being checked by the program that shares nothing with the library.
pub fn exact(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
) -> Result<Exact, RefineError> {
    let found = limitmesh::refine::exact(control, scheme, options)?;
    let has_places =
        !found.origins.is_empty() && found.error.certified && found.error.upper.is_finite();
    if has_places && found.mesh.face_count() <= MOST_CHECKED {
        crate::certificate::proofs::check(control, scheme, &found).unwrap();
    }
    Ok(found)
}

/// A built-in model.
pub fn model(name: &str) -> Mesh {
    let soup = limitmesh_models::find(name).unwrap().soup();
    Mesh::from_soup(&soup, &Default::default()).unwrap().0
}

/// The folder of shared models; says that a test is skipped where there is none.
pub fn shared_models() -> Option<PathBuf> {
    let folder = std::env::var_os("LIMITMESH_MODELS").map(PathBuf::from);
    if folder.is_none() {
        // Written directly: the test harness keeps what macros print to itself.
        let said = std::io::stderr().write_all(b"skipped: LIMITMESH_MODELS is not set\n");
        said.unwrap();
    }
    folder
}

/// A shared model of triangles, as OBJ.
pub fn shared_model(folder: &Path, name: &str) -> Mesh {
    tagged_obj(&std::fs::read_to_string(folder.join(name)).unwrap())
}

/// Refinement to a tolerance.
pub fn within(tolerance: f64) -> ExactOptions {
    ExactOptions::default().tolerance(tolerance)
}

/// The distance of two meshes by so many samples.
pub fn sampled(a: &Mesh, b: &Mesh, samples: usize) -> f64 {
    let options = SamplingOptions::default().samples(samples);
    let found = hausdorff(a.as_triangles(), b.as_triangles(), &options);
    found.unwrap().symmetric()
}

/// The distance of two meshes, enclosed.
pub fn enclosed(a: &Mesh, b: &Mesh, options: &CertifiedOptions) -> CertifiedHausdorff {
    certified_hausdorff(a.as_triangles(), b.as_triangles(), options).unwrap()
}

/// So many threads.
pub fn pool(threads: usize) -> rayon::ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap()
}

/// Tags on edges and vertices: those for which there is a sharpness, of one in so many.
pub fn tagged_by(
    mesh: Mesh,
    [edges, vertices]: [usize; 2],
    mut sharpness: impl FnMut(usize) -> Option<f64>,
) -> Mesh {
    let mut tags = Tags::default();
    let topology = mesh.topology();
    let is_first = |&h: &HalfEdgeId| topology.twin(h).is_some_and(|twin| h < twin);
    for h in topology.half_edges().filter(is_first) {
        let vertices = topology.ends(h).map(|v| v.0);
        let tag = |sharpness| crease(vertices, sharpness);
        tags.creases.extend(sharpness(edges).map(tag));
    }
    for vertex in 0..mesh.vertex_count() as u32 {
        let tag = |sharpness| CornerTag { vertex, sharpness };
        tags.corners.extend(sharpness(vertices).map(tag));
    }
    mesh.with_tags(tags).unwrap()
}

/// So many levels of uniform refinement.
pub fn divided(mesh: &Mesh, scheme: &dyn Scheme, levels: usize) -> Mesh {
    let options = UniformOptions::default().levels(levels);
    uniform(mesh, scheme, &options).unwrap().mesh
}

pub fn crease(vertices: [u32; 2], sharpness: f64) -> CreaseTag {
    CreaseTag {
        vertices,
        sharpness,
    }
}

pub fn corner(vertex: u32, sharpness: f64) -> CornerTag {
    CornerTag { vertex, sharpness }
}

/// Creases alone.
pub fn creases(creases: Vec<CreaseTag>) -> Tags {
    Tags {
        creases,
        ..Tags::default()
    }
}

/// Corners alone.
pub fn corners(corners: Vec<CornerTag>) -> Tags {
    Tags {
        corners,
        ..Tags::default()
    }
}

pub fn surface<'a>(positions: &'a [[f64; 3]], triangles: &'a [[u32; 3]]) -> Triangles<'a> {
    Triangles {
        positions,
        triangles,
    }
}

/// A mesh with its vertices elsewhere.
pub fn mapped(mesh: &Mesh, place: impl FnMut(&Point) -> Point) -> Mesh {
    let positions = mesh.positions().iter().map(place).collect();
    mesh.clone().with_positions(positions).unwrap()
}
