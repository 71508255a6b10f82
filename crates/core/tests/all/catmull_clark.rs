//! Catmull–Clark's surface beside closed forms, and its certified meshes beside a subdivision of its own.

#![allow(clippy::unwrap_used)]

mod bad_cages;

use std::collections::BTreeMap;

use limitmesh::carry::carried;
use limitmesh::front::{Demand, Front};
use limitmesh::limit::LimitTable;
use limitmesh::mesh::{BuildOptions, Channel, CornerTag, CreaseTag, Domain, PolygonSoup, Semantic};
use limitmesh::refine::{ExactOptions, Finish, Traced, UniformOptions, exact, quads, uniform};
use limitmesh::scheme::CatmullClark;
use limitmesh::{FaceId, LimitSurface, Mesh, QuadControl, QuadOptions};

use crate::opensubdiv;
use crate::support::{Point, Random, shared_models};

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

mod queries;

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
    corners: BTreeMap<u32, f64>,
    smooth_triangles: bool,
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
        let corners = soup.corners.iter();
        Self {
            points: soup.positions.clone(),
            faces: soup.faces.iter().map(<[u32]>::to_vec).collect(),
            sharp: creases
                .map(|tag| (key(tag.vertices[0], tag.vertices[1]), tag.sharpness))
                .collect(),
            corners: corners.map(|tag| (tag.vertex, tag.sharpness)).collect(),
            smooth_triangles: false,
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
        let mut edges_at = vec![Vec::new(); self.points.len()];
        for edge in edges.keys() {
            edge.iter().for_each(|&v| edges_at[v as usize].push(edge));
        }
        let mut faces_at = vec![Vec::new(); self.points.len()];
        for (face, &centre) in self.faces.iter().zip(&centres) {
            face.iter().for_each(|&v| faces_at[v as usize].push(centre));
        }
        for v in 0..self.points.len() as u32 {
            let own = &edges_at[v as usize];
            if own.is_empty() {
                points.push(at(v));
                continue;
            }
            let other = |edge: &[u32; 2]| at(if edge[0] == v { edge[1] } else { edge[0] });
            let around = mean(&faces_at[v as usize]);
            let neighbours = mean(&own.iter().map(|edge| other(edge)).collect::<Vec<_>>());
            let n = own.len() as f64;
            let corner = self.corners.get(&v).copied().unwrap_or(0.0);
            let by = |less: f64| {
                let sharp: Vec<_> = own.iter().filter(|edge| sharpness(edge) > less).collect();
                if corner > less {
                    return at(v);
                }
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
                .chain([corner])
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
                [a, b] => {
                    let weight = |face: usize| match self.faces[face].len() {
                        3 if self.smooth_triangles => 0.47,
                        _ => 0.25,
                    };
                    let w = 0.5 * (weight(a) + weight(b));
                    let ends = times(0.5 - w, sum(edge.map(at)));
                    sum([ends, times(w, sum([centres[a], centres[b]]))])
                }
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
        let corners = self
            .corners
            .iter()
            .map(|(&v, &s)| (v, if s < 10.0 { s - 1.0 } else { s }));
        Self {
            points,
            faces,
            sharp,
            corners: corners.filter(|&(_, s)| s > 0.0).collect(),
            smooth_triangles: self.smooth_triangles,
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

/// How far a mesh is from plain subdivision, and how far that is from its own limit.
fn from_plain(mesh: &Mesh, soup: &PolygonSoup, levels: usize) -> (f64, f64) {
    let mut plain = Plain::of(soup);
    for _ in 1..levels {
        plain = plain.refined();
    }
    let ((coarse, few), (points, triangles)) = (plain.mesh(), plain.refined().mesh());
    // Each step leaves two thirds of the distance from the limit at most.
    let rest = 2.0 * distance((&coarse, &few), (&points, &triangles));
    let own = mesh.as_triangles();
    let sampled = distance((own.positions, own.triangles), (&points, &triangles));
    (sampled, rest)
}

/// A mesh within a share of the diagonal is no farther from plain subdivision than what is proven and what that is from its own limit.
fn check(name: &str, soup: &PolygonSoup, levels: usize, share: f64) -> usize {
    let (control, _) = QuadControl::from_soup(soup, &BuildOptions::default()).unwrap();
    let mesh = &control.mesh;
    mesh.validate().unwrap();
    let tolerance = share * mesh.diagonal();
    let goal = ExactOptions::default().tolerance(tolerance);
    let found = exact(mesh, &CatmullClark, &goal).unwrap();
    let error = found.error;
    assert!(
        error.certified && error.upper <= tolerance,
        "{name}: {error:?}"
    );
    let (sampled, rest) = from_plain(&found.mesh, soup, levels);
    assert!(
        sampled <= error.upper + rest,
        "{name}: {sampled} {rest} {error:?}"
    );
    assert!(
        sampled + rest >= 0.9 * error.lower,
        "{name}: {sampled} {rest} {error:?}"
    );
    found.mesh.face_count()
}

/// A cube with an infinitely sharp edge, and another that is sharp for so many levels.
fn creased_cube(sharpness: f64) -> PolygonSoup {
    let mut soup = cube();
    for (vertices, sharpness) in [([0, 2], 10.0), ([2, 3], sharpness)] {
        soup.creases.push(CreaseTag {
            vertices,
            sharpness,
        });
    }
    soup
}

/// A cube without one side and with another in two triangles.
fn opened(mut cube: PolygonSoup) -> PolygonSoup {
    cube.faces = Default::default();
    let faces: [&[u32]; 6] = [
        &[0, 2, 3, 1],
        &[4, 5, 7],
        &[4, 7, 6],
        &[0, 1, 5, 4],
        &[2, 6, 7, 3],
        &[0, 4, 6, 2],
    ];
    faces.iter().for_each(|face| cube.faces.push(face));
    cube
}

#[test]
fn certified_meshes_are_where_plain_subdivision_leads() {
    check("cube", &cube(), 5, 1e-2);
    check("creased cube", &creased_cube(2.5), 5, 1e-2);
    let mut open = cube();
    open.faces = Default::default();
    [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4]]
        .iter()
        .for_each(|face| open.faces.push(face));
    open.positions.truncate(8);
    check("open cube", &open, 5, 1e-2);
}

/// Normals at corners are those on their own sides of sharp edges.
#[test]
fn normals_at_corners_are_where_the_surface_goes() {
    let (control, _) =
        QuadControl::from_soup(&creased_cube(10.0), &BuildOptions::default()).unwrap();
    let mesh = &control.mesh;
    let (table, surface) = (
        LimitTable::new(&CatmullClark),
        LimitSurface::new(mesh, &CatmullClark).unwrap(),
    );
    let topology = mesh.topology();
    for h in topology.half_edges() {
        let mut place = [1e-7; 3];
        place[h.corner()] = 1.0 - 2e-7;
        let near = surface.at(h.face(), place).normal;
        let found = table.normal_at(mesh, h).unwrap();
        let dot: f64 = (0..3).map(|axis| near[axis] * found[axis]).sum();
        assert!(dot > 1.0 - 1e-6, "{h:?}: {found:?} and {near:?}");
    }
}

#[test]
fn fronts_are_where_plain_subdivision_leads() {
    for soup in [cube(), creased_cube(2.5)] {
        let (control, _) = QuadControl::from_soup(&soup, &BuildOptions::default()).unwrap();
        let mut front = Front::new(&control.mesh, &CatmullClark).unwrap();
        let tolerance = 3e-3 * control.mesh.diagonal();
        front.update(&Demand::tolerance(tolerance)).unwrap();
        let (sampled, rest) = from_plain(&front.mesh().unwrap(), &soup, 5);
        assert!(front.bound() <= tolerance);
        assert!(sampled <= front.bound() + rest, "{sampled} {rest}");
    }
}

/// Quads stay within the bound if they are cut by their other diagonals, which replaces all of them here; plain subdivision says so.
/// Gives the shares of triangles that have become quads without and with the option for them.
fn quads_cut_otherwise(
    name: &str,
    soup: &PolygonSoup,
    finish: Finish,
    levels: usize,
    share: f64,
) -> [f64; 2] {
    let (control, _) = QuadControl::from_soup(soup, &BuildOptions::default()).unwrap();
    [false, true].map(|for_quads| {
        let goal = ExactOptions::default().tolerance(share * control.mesh.diagonal());
        let goal = goal.finish(finish).for_quads(for_quads);
        let found = exact(&control.mesh, &CatmullClark, &goal).unwrap();
        let pairs = quads(&found, &control.mesh, &CatmullClark).unwrap();
        let topology = found.mesh.topology();
        let mut triangles = found.mesh.triangles().to_vec();
        let mut met = vec![false; triangles.len()];
        for &[h, twin] in &pairs {
            assert_eq!(topology.twin(h), Some(twin), "{name}");
            for half in [h, twin] {
                assert!(
                    !std::mem::replace(&mut met[half.face().index()], true),
                    "{name}"
                );
            }
            let [a, b, c, d] =
                [h, h.previous(), twin, twin.previous()].map(|h| topology.origin(h).0);
            triangles[h.face().index()] = [b, a, d];
            triangles[twin.face().index()] = [d, c, b];
        }
        let (sampled, rest) = from_plain(
            &Mesh::from_triangles(found.mesh.positions().to_vec(), triangles).unwrap(),
            soup,
            levels,
        );
        assert!(
            sampled <= found.error.upper + rest,
            "{name}: {sampled} {rest} {:?}",
            found.error
        );
        2.0 * pairs.len() as f64 / met.len() as f64
    })
}

#[test]
fn quads_are_near_however_they_are_cut() {
    let twisted = {
        let mut soup = cube();
        soup.positions[7] = [1.9, 0.4, 1.3];
        soup
    };
    let mut open = creased_cube(1.6);
    open.faces = Default::default();
    let faces: [&[u32]; 5] = [
        &[0, 2, 3, 1],
        &[4, 5, 7, 6],
        &[0, 1, 5, 4],
        &[2, 6, 7],
        &[2, 7, 3],
    ];
    faces.iter().for_each(|face| open.faces.push(face));
    for (name, soup) in [("cube", cube()), ("twisted", twisted), ("open", open)] {
        for finish in [Finish::OnSurface, Finish::Balanced] {
            let [plain, asked] = quads_cut_otherwise(name, &soup, finish, 5, 1e-2);
            assert!(
                plain > 0.0 && asked > 0.6,
                "{name} {finish:?}: {plain} {asked}"
            );
        }
    }
}

/// A smooth channel whose values are positions is where the vertices are, also where a step divides polygons first.
#[test]
fn positions_as_a_channel_take_the_step() {
    let soup = opened(creased_cube(1.6));
    for smooth_triangles in [false, true] {
        let rules = QuadOptions::default().smooth_triangles(smooth_triangles);
        let build = BuildOptions::default();
        let (control, _) = QuadControl::from_soup_with(&soup, &build, &rules).unwrap();
        let values = soup.positions.as_flattened().to_vec();
        let channel = Channel::new("positions", Semantic::Displacement, Domain::Vertex, 3)
            .with(values, (0..8).collect());
        let channel = control.channel(&soup, &channel).unwrap();
        let mesh = &control.mesh;
        let options = UniformOptions::default()
            .levels(2)
            .limit(true)
            .origins(true);
        let fine = uniform(mesh, &CatmullClark, &options).unwrap();
        let found = carried(&[channel], mesh, &CatmullClark, &fine)
            .unwrap()
            .remove(0);
        for (corner, &vertex) in fine.mesh.triangles().as_flattened().iter().enumerate() {
            let value: Point = found.value(corner).try_into().unwrap();
            let position = fine.mesh.positions()[vertex as usize];
            assert!(near(position, value, 1e-13), "{position:?} {value:?}");
        }
        let moved: Vec<Point> = soup
            .positions
            .iter()
            .map(|[x, y, z]| [x + 0.3 * y, y + 0.2 * x * z, 2.0 * z])
            .collect();
        let found = control.positions(&soup, &moved).unwrap();
        let other = PolygonSoup {
            positions: moved,
            ..soup.clone()
        };
        let (other, _) = QuadControl::from_soup_with(&other, &build, &rules).unwrap();
        for (&own, &expected) in found.iter().zip(other.mesh.positions()) {
            assert!(near(own, expected, 1e-13), "{own:?} {expected:?}");
        }
    }
}

/// Linear channels are bilinear over quads, whichever diagonal cuts these: by the corners of the polygons.
#[test]
fn linear_channels_are_bilinear_over_quads() {
    let soup = creased_cube(1.6);
    let (control, _) = QuadControl::from_soup(&soup, &BuildOptions::default()).unwrap();
    let mesh = &control.mesh;
    let polygons: Vec<&[u32]> = soup.faces.iter().collect();
    let mut random = Random::new(5);
    let values: Vec<f64> = (0..24).map(|_| random.signed()).collect();
    let place = |face: usize, vertex: u32| {
        let polygon = control.trace.faces[face] as usize;
        4 * polygon + polygons[polygon].iter().position(|&v| v == vertex).unwrap()
    };
    let corners = mesh.triangles().as_flattened().iter().enumerate();
    let indices = corners.map(|(corner, &v)| place(corner / 3, v) as u32);
    let channel = Channel::new("x", Semantic::Other, Domain::Corner, 1)
        .with(values.clone(), indices.collect());
    let options = UniformOptions::default().levels(2).origins(true);
    let fine = uniform(mesh, &CatmullClark, &options).unwrap();
    let found = carried(&[channel], mesh, &CatmullClark, &fine)
        .unwrap()
        .remove(0);
    let mut met = [0; 2];
    for corner in fine.mesh.topology().half_edges() {
        let origin = fine.corner_origin(mesh.triangles(), corner).unwrap();
        let own = mesh.triangles()[origin.face as usize];
        let at = |steps: usize| {
            let first = place(origin.face as usize, own[0]);
            values[first / 4 * 4 + (first + steps) % 4]
        };
        let expected = match origin.barycentric {
            [0.0, 0.5, 0.5] => (at(0) + at(1) + at(2) + at(3)) / 4.0,
            [0.5, 0.25, 0.25] => (9.0 * at(0) + 3.0 * at(1) + at(2) + 3.0 * at(3)) / 16.0,
            _ => continue,
        };
        met[usize::from(origin.barycentric[0] == 0.0)] += 1;
        assert!((found.value(corner.index())[0] - expected).abs() < 1e-14);
    }
    assert!(met[0] >= 6 && met[1] >= 12, "{met:?}");
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
        ("bob_cage.obj", 5, [(3e-3, 2_300), (1e-3, 4_700)]),
        ("fish_cage.obj", 5, [(3e-3, 1_700), (1e-3, 4_500)]),
        ("monsterfrog.obj", 3, [(3e-3, 18_500), (1e-3, 31_000)]),
        ("rook_creased.obj", 3, [(3e-3, 16_500), (1e-3, 36_500)]),
    ] {
        let soup = obj(&std::fs::read_to_string(folder.join(name)).unwrap());
        for (share, most) in shares {
            let triangles = check(name, &soup, levels, share);
            assert!(triangles <= most, "{name}: {triangles}");
        }
    }
}

/// Each vertex of a uniform mesh is one of plain subdivision's, and its triangles are halves of the quads there.
#[test]
fn uniform_refinement_is_plain_subdivision() {
    let mixed = opened(cube());
    let mut tagged = mixed.clone();
    tagged.faces.push(&[1, 3, 7, 5]);
    for (vertices, sharpness) in [([4, 7], 0.4), ([7, 5], 1.7), ([0, 2], 10.0)] {
        tagged.creases.push(CreaseTag {
            vertices,
            sharpness,
        });
    }
    for (name, soup, step, smooths) in [
        ("cube", cube(), 0, false),
        ("creased", creased_cube(1.6), 0, true),
        ("mixed and open", mixed.clone(), 1, false),
        ("smooth triangles", mixed, 1, true),
        ("smooth triangles with tags", tagged, 1, true),
    ] {
        let rules = QuadOptions::default().smooth_triangles(smooths);
        let (control, _) =
            QuadControl::from_soup_with(&soup, &BuildOptions::default(), &rules).unwrap();
        let mut plain = Plain::of(&soup);
        plain.smooth_triangles = smooths;
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

fn uniform_points(soup: &PolygonSoup, smooths: bool, levels: usize) -> (Vec<Point>, f64) {
    let rules = QuadOptions::default().smooth_triangles(smooths);
    let (control, _) = QuadControl::from_soup_with(soup, &BuildOptions::default(), &rules).unwrap();
    let quads = soup.faces.iter().all(|face| face.len() == 4);
    let levels = levels - usize::from(!quads);
    let options = UniformOptions::default().levels(levels);
    let found = uniform(&control.mesh, &CatmullClark, &options).unwrap();
    (found.mesh.positions().to_vec(), control.mesh.diagonal())
}

#[test]
fn uniform_refinement_is_the_other_implementation_s() {
    let is_other = |name: &str, cage: &PolygonSoup, smooths, levels| {
        let theirs = opensubdiv::of_cage(cage, opensubdiv::catmull_clark(smooths), levels);
        let (ours, size) = uniform_points(cage, smooths, levels);
        opensubdiv::assert_same_points(name, &ours, &theirs, size);
    };
    for seed in 0..40 {
        let cage = random_cage(&mut Random::new(seed));
        for smooths in [false, true] {
            is_other(&format!("cage {seed}"), &cage, smooths, 3);
        }
    }
    let Some(folder) = shared_models() else {
        return;
    };
    for name in ["bob_cage", "fish_cage", "monsterfrog", "rook_creased"] {
        let text = std::fs::read_to_string(folder.join(name).with_extension("obj")).unwrap();
        is_other(name, &obj(&text), false, 2);
    }
}

/// The middle of an edge of a tetrahedron, by hand: (½ − 0.47) · 2 + 0.47 · ⅔ towards the edge's own middle.
#[test]
fn smooth_triangles_have_their_weights() {
    let corners = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let cage = soup(&corners, &[&[0, 1, 2], &[0, 3, 1], &[0, 2, 3], &[1, 3, 2]]);
    for (smooths, expected) in [(false, 2.0 / 3.0), (true, 28.0 / 75.0)] {
        let rules = QuadOptions::default().smooth_triangles(smooths);
        let (control, _) =
            QuadControl::from_soup_with(&cage, &BuildOptions::default(), &rules).unwrap();
        let points = control.mesh.positions();
        let is_there = |&p: &Point| near(p, [expected, 0.0, 0.0], 1e-15);
        assert_eq!(points.iter().filter(|p| is_there(p)).count(), 1);
    }
}

/// A torus of quads, some of them cut or missing, two perhaps joined to a hexagon, with tags.
pub(crate) fn random_cage(random: &mut Random) -> PolygonSoup {
    let (m, n) = (3 + random.below(4) as u32, 4 + random.below(2) as u32);
    let mut cage = PolygonSoup::default();
    for i in 0..m {
        for j in 0..n {
            let [a, b] =
                [(i, m), (j, n)].map(|(i, n)| std::f64::consts::TAU * f64::from(i) / f64::from(n));
            let r = 2.0 + b.cos();
            let at = [r * a.cos(), r * a.sin(), b.sin()];
            cage.positions.push(at.map(|x| x + 0.35 * random.signed()));
        }
    }
    let vertex = |i: u32, j: u32| (i % m) * n + j % n;
    let mut faces: Vec<Vec<u32>> = Vec::new();
    let hexagon = random.below(2 * m as usize) as u32;
    for i in 0..m {
        for j in 0..n {
            let [a, b] = [vertex(i, j), vertex(i + 1, j)];
            let [c, d] = [vertex(i + 1, j + 1), vertex(i, j + 1)];
            match (hexagon == i, j) {
                (true, 0) => faces.push(vec![a, b, c, vertex(i + 1, 2), vertex(i, 2), d]),
                (true, 1) => {}
                _ => match random.below(12) {
                    0 => {}
                    1 => faces.extend([vec![a, b, c], vec![a, c, d]]),
                    _ => faces.push(vec![a, b, c, d]),
                },
            }
        }
    }
    let sharpness = |random: &mut Random| [0.4, 1.0, 1.7, 2.3, 10.0, 10.0][random.below(6)];
    for _ in 0..random.below(7) {
        let face = &faces[random.below(faces.len())];
        let at = random.below(face.len());
        let vertices = [face[at], face[(at + 1) % face.len()]];
        let sharpness = sharpness(random);
        if cage
            .creases
            .iter()
            .all(|tag| key(tag.vertices[0], tag.vertices[1]) != key(vertices[0], vertices[1]))
        {
            cage.creases.push(CreaseTag {
                vertices,
                sharpness,
            });
        }
    }
    if random.below(3) == 0 {
        let (vertex, sharpness) = (faces[0][0], sharpness(random));
        cage.corners.push(CornerTag { vertex, sharpness });
    }
    faces.iter().for_each(|face| cage.faces.push(face));
    cage
}

/// `LIMITMESH_CAGES` sets how many.
#[test]
fn random_polygon_cages_are_within_what_is_proven() {
    let cages = std::env::var("LIMITMESH_CAGES")
        .ok()
        .and_then(|cages| cages.parse().ok());
    for seed in 0..cages.unwrap_or(60) {
        let cage = random_cage(&mut Random::new(seed));
        check(&format!("cage {seed}"), &cage, 4, 3e-3);
    }
}
