//! Catmull–Clark's surface beside closed forms, and its certified meshes beside a subdivision of its own.

use std::collections::BTreeMap;

use limitmesh::limit::LimitTable;
use limitmesh::mesh::{BuildOptions, CreaseTag, PolygonSoup};
use limitmesh::refine::{ExactOptions, UniformOptions, exact, uniform};
use limitmesh::scheme::CatmullClark;
use limitmesh::{FaceId, LimitSurface, QuadControl};

use crate::support::{Point, shared_models};

fn soup(positions: &[Point], faces: &[&[u32]]) -> PolygonSoup {
    let mut soup = PolygonSoup {
        positions: positions.to_vec(),
        ..PolygonSoup::default()
    };
    faces.iter().for_each(|face| soup.faces.push(face));
    soup
}

fn cube() -> PolygonSoup {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 });
    let positions: Vec<Point> = (0..8).map(corner).collect();
    soup(
        &positions,
        &[
            &[0, 2, 3, 1],
            &[4, 5, 7, 6],
            &[0, 1, 5, 4],
            &[2, 6, 7, 3],
            &[0, 4, 6, 2],
            &[1, 3, 7, 5],
        ],
    )
}

fn near(a: Point, b: Point, error: f64) -> bool {
    (0..3).all(|axis| (a[axis] - b[axis]).abs() < error)
}

/// Values of the design, from exact arithmetic.
#[test]
fn the_cube_s_surface_is_where_it_should_be() {
    let (control, _) = QuadControl::from_soup(&cube(), &BuildOptions::default()).unwrap();
    let mesh = &control.mesh;
    let table = LimitTable::new(&CatmullClark);
    let limits = table.positions(mesh).unwrap();
    for (limit, corner) in limits.iter().zip(mesh.positions()) {
        assert!(near(*limit, corner.map(|x| 0.5 * x), 1e-15), "{limit:?}");
    }
    let surface = LimitSurface::new(mesh, &CatmullClark).unwrap();
    for face in 0..mesh.face_count() as u32 {
        let corners = mesh.triangles()[face as usize].map(|v| mesh.positions()[v as usize]);
        let middle = |a: usize, b: usize| [0, 1, 2].map(|i| 0.5 * (corners[a][i] + corners[b][i]));
        // On the edges of the quad, and on its diagonal.
        for (weights, middle, factor) in [
            ([0.5, 0.5, 0.0], middle(0, 1), 395.0 / 648.0),
            ([0.5, 0.0, 0.5], middle(0, 2), 395.0 / 648.0),
            ([0.0, 0.5, 0.5], middle(1, 2), 68.0 / 81.0),
        ] {
            let point = surface.at(FaceId(face), weights).position;
            assert!(near(point, middle.map(|x| factor * x), 1e-14), "{point:?}");
        }
    }
}

/// Subdivision by the rules as they are written, on lists of polygons.
#[derive(Clone)]
struct Plain {
    points: Vec<Point>,
    faces: Vec<Vec<u32>>,
    sharp: BTreeMap<[u32; 2], f64>,
}

fn sum(points: impl IntoIterator<Item = Point>) -> Point {
    points
        .into_iter()
        .fold([0.0; 3], |sum, p| [0, 1, 2].map(|i| sum[i] + p[i]))
}

fn times(factor: f64, point: Point) -> Point {
    point.map(|x| factor * x)
}

fn mean(points: &[Point]) -> Point {
    times(1.0 / points.len() as f64, sum(points.iter().copied()))
}

fn key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Plain {
    fn of(soup: &PolygonSoup) -> Self {
        let creases = soup.creases.iter();
        Self {
            points: soup.positions.clone(),
            faces: soup.faces.iter().map(<[u32]>::to_vec).collect(),
            sharp: creases
                .map(|tag| (key(tag.vertices[0], tag.vertices[1]), tag.sharpness))
                .collect(),
        }
    }

    /// The faces along each edge.
    fn edges(&self) -> BTreeMap<[u32; 2], Vec<usize>> {
        let mut edges: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (face, own) in self.faces.iter().enumerate() {
            for i in 0..own.len() {
                edges
                    .entry(key(own[i], own[(i + 1) % own.len()]))
                    .or_default()
                    .push(face);
            }
        }
        edges
    }

    fn refined(&self) -> Self {
        let edges = self.edges();
        let at = |v: u32| self.points[v as usize];
        let centres: Vec<Point> = self
            .faces
            .iter()
            .map(|face| mean(&face.iter().map(|&v| at(v)).collect::<Vec<_>>()))
            .collect();
        let sharpness = |edge: &[u32; 2]| match edges[edge].len() {
            1 => f64::INFINITY,
            _ => self.sharp.get(edge).copied().unwrap_or(0.0),
        };
        let mut points = Vec::new();
        for v in 0..self.points.len() as u32 {
            let own: Vec<&[u32; 2]> = edges.keys().filter(|edge| edge.contains(&v)).collect();
            let other = |edge: &[u32; 2]| at(if edge[0] == v { edge[1] } else { edge[0] });
            let faces = self
                .faces
                .iter()
                .zip(&centres)
                .filter(|(face, _)| face.contains(&v));
            let around = mean(&faces.map(|(_, &centre)| centre).collect::<Vec<_>>());
            let neighbours = mean(&own.iter().map(|edge| other(edge)).collect::<Vec<_>>());
            let n = own.len() as f64;
            let by = |less: f64| {
                let sharp: Vec<_> = own.iter().filter(|edge| sharpness(edge) > less).collect();
                match sharp[..] {
                    [] | [_] => times(1.0 / n, sum([times(n - 2.0, at(v)), neighbours, around])),
                    [a, b] => sum([
                        times(0.75, at(v)),
                        times(0.125, other(a)),
                        times(0.125, other(b)),
                    ]),
                    _ => at(v),
                }
            };
            let fading: Vec<f64> = own
                .iter()
                .map(|e| sharpness(e))
                .filter(|&s| s > 0.0 && s <= 1.0)
                .collect();
            let now = if fading.is_empty() {
                1.0
            } else {
                fading.iter().sum::<f64>() / fading.len() as f64
            };
            points.push(sum([times(now, by(0.0)), times(1.0 - now, by(1.0))]));
        }
        let mut on_edges = BTreeMap::new();
        let mut sharp = BTreeMap::new();
        for (edge, faces) in &edges {
            let middle = mean(&[at(edge[0]), at(edge[1])]);
            let s = sharpness(edge).min(1.0);
            let smooth = match faces[..] {
                [a, b] => mean(&[middle, mean(&[centres[a], centres[b]])]),
                _ => middle,
            };
            let number = points.len() as u32;
            on_edges.insert(*edge, number);
            points.push(sum([times(s, middle), times(1.0 - s, smooth)]));
            let left = sharpness(edge) - if sharpness(edge) < 10.0 { 1.0 } else { 0.0 };
            if left > 0.0 && faces.len() == 2 {
                sharp.extend(edge.map(|v| (key(v, number), left)));
            }
        }
        let mut faces = Vec::new();
        for (face, centre) in self.faces.iter().zip(&centres) {
            let number = points.len() as u32;
            points.push(*centre);
            for i in 0..face.len() {
                let side =
                    |i: usize| on_edges[&key(face[i % face.len()], face[(i + 1) % face.len()])];
                faces.push(vec![face[i], side(i), number, side(i + face.len() - 1)]);
            }
        }
        Self {
            points,
            faces,
            sharp,
        }
    }

    /// The triangles of all faces.
    fn mesh(&self) -> (Vec<Point>, Vec<[u32; 3]>) {
        let fan = |face: &Vec<u32>| {
            (2..face.len())
                .map(|i| [face[0], face[i - 1], face[i]])
                .collect::<Vec<_>>()
        };
        (
            self.points.clone(),
            self.faces.iter().flat_map(fan).collect(),
        )
    }
}

/// How far the sampled points of two sets of triangles are apart.
fn distance(a: (&[Point], &[[u32; 3]]), b: (&[Point], &[[u32; 3]])) -> f64 {
    let triangles = |(positions, triangles)| limitmesh::Triangles {
        positions,
        triangles,
    };
    let options = limitmesh::measure::SamplingOptions::default().samples(60_000);
    let found = limitmesh::measure::hausdorff(triangles(a), triangles(b), &options);
    found.unwrap().symmetric()
}

fn check(name: &str, soup: &PolygonSoup, levels: usize, share: f64) {
    let (control, _) = QuadControl::from_soup(soup, &BuildOptions::default()).unwrap();
    let mesh = &control.mesh;
    let tolerance = share * mesh.diagonal();
    let found = exact(
        mesh,
        &CatmullClark,
        &ExactOptions::default().tolerance(tolerance),
    )
    .unwrap();
    assert!(
        found.error.certified && found.error.upper <= tolerance,
        "{name}: {:?}",
        found.error
    );
    let mut plain = Plain::of(soup);
    for _ in 0..levels {
        plain = plain.refined();
    }
    let (points, triangles) = plain.mesh();
    let own = found.mesh.as_triangles();
    let sampled = distance((own.positions, own.triangles), (&points, &triangles));
    let seconds = found.statistics.levels;
    eprintln!(
        "{name}: {} triangles, upper {} sampled {sampled} levels {seconds}",
        found.mesh.face_count(),
        found.error.upper
    );
    assert!(
        sampled <= found.error.upper + 0.35 * tolerance,
        "{name}: {sampled} {:?}",
        found.error
    );
    assert!(
        sampled >= 0.5 * found.error.lower,
        "{name}: {sampled} {:?}",
        found.error
    );
}

#[test]
fn certified_meshes_are_where_plain_subdivision_leads() {
    check("cube", &cube(), 5, 1e-2);
    let mut creased = cube();
    creased.creases.push(CreaseTag {
        vertices: [0, 2],
        sharpness: 10.0,
    });
    creased.creases.push(CreaseTag {
        vertices: [2, 3],
        sharpness: 2.5,
    });
    check("creased cube", &creased, 5, 1e-2);
    let mut open = cube();
    open.faces = Default::default();
    [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4]]
        .iter()
        .for_each(|face| open.faces.push(face));
    open.positions.truncate(8);
    check("open cube", &open, 5, 1e-2);
}

/// The polygons and tags of an OBJ file.
fn obj(text: &str) -> PolygonSoup {
    let mut soup = PolygonSoup::default();
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |i: usize| words[i].parse::<f64>().unwrap();
        let index = |word: &&str| word.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
        match words.first() {
            Some(&"v") => soup.positions.push([number(1), number(2), number(3)]),
            Some(&"f") => soup
                .faces
                .push(&words[1..].iter().map(index).collect::<Vec<_>>()),
            Some(&"t") if words[1] == "crease" => soup.creases.push(CreaseTag {
                vertices: [number(3) as u32, number(4) as u32],
                sharpness: number(5),
            }),
            _ => {}
        }
    }
    soup
}

#[test]
fn production_cages_are_met_with_few_triangles() {
    let Some(folder) = shared_models() else {
        return;
    };
    for (name, levels, shares) in [
        ("bob_cage.obj", 5, [3e-3, 1e-3]),
        ("fish_cage.obj", 5, [3e-3, 1e-3]),
        ("monsterfrog.obj", 3, [3e-3, 1e-3]),
        ("rook_creased.obj", 3, [3e-3, 1e-3]),
    ] {
        let soup = obj(&std::fs::read_to_string(folder.join(name)).unwrap());
        for share in shares {
            check(name, &soup, levels, share);
        }
    }
}

/// Each vertex of a uniform mesh is one of plain subdivision's, and its triangles are halves of the quads there.
#[test]
fn uniform_refinement_is_plain_subdivision() {
    let mut creased = cube();
    creased.creases.push(CreaseTag {
        vertices: [0, 2],
        sharpness: 10.0,
    });
    creased.creases.push(CreaseTag {
        vertices: [2, 3],
        sharpness: 1.6,
    });
    let mut mixed = cube();
    mixed.faces = Default::default();
    let faces: [&[u32]; 6] = [
        &[0, 2, 3, 1],
        &[4, 5, 7],
        &[4, 7, 6],
        &[0, 1, 5, 4],
        &[2, 6, 7, 3],
        &[0, 4, 6, 2],
    ];
    faces.iter().for_each(|face| mixed.faces.push(face));
    for (name, soup, step) in [
        ("cube", cube(), 0),
        ("creased", creased, 0),
        ("mixed and open", mixed, 1),
    ] {
        let (control, _) = QuadControl::from_soup(&soup, &BuildOptions::default()).unwrap();
        let mut plain = Plain::of(&soup);
        (0..step).for_each(|_| plain = plain.refined());
        for levels in 0..4 {
            let options = UniformOptions::default().levels(levels).origins(true);
            let found = uniform(&control.mesh, &CatmullClark, &options).unwrap();
            found.mesh.validate().unwrap();
            assert!(found.mesh.topology().has_quads());
            let bits = |p: &Point| p.map(|x| (x * 1e10 + 0.3713).round() as i64);
            let sorted = |points: &[Point]| {
                let mut points: Vec<_> = points.iter().map(bits).collect();
                points.sort_unstable();
                points
            };
            assert!(
                sorted(found.mesh.positions()) == sorted(&plain.points),
                "{name} {levels}"
            );
            let centre = |corners: &[Point]| mean(corners);
            let quads = found.mesh.triangles().as_chunks::<2>().0;
            let own: Vec<Point> = quads
                .iter()
                .map(|[[a, b, d], [c, ..]]| {
                    centre(&[*a, *b, *c, *d].map(|v| found.mesh.positions()[v as usize]))
                })
                .collect();
            let expected: Vec<Point> = plain
                .faces
                .iter()
                .map(|face| {
                    centre(
                        &face
                            .iter()
                            .map(|&v| plain.points[v as usize])
                            .collect::<Vec<_>>(),
                    )
                })
                .collect();
            assert!(sorted(&own) == sorted(&expected), "{name} {levels}");
            plain = plain.refined();
        }
    }
}
