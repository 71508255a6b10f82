//! Semi-sharp pieces against uniform refinement of the whole mesh and its limit stencils.

use super::*;
use crate::finer::uniform;
use crate::index::FaceId;
use crate::limit::LimitTable;
use crate::mesh::{CornerTag, CreaseTag, Tags};
use crate::patch::large_rings::LargeRings;
use crate::patch::root_patch;
use crate::scheme::{Loop, LoopWarren, Scheme};
use limitmesh_testing::Random;
use limitmesh_testing::models;

/// Tags on many edges and some vertices, nearly all of them semi-sharp.
fn tagged(name: &str, seed: u64) -> Mesh {
    let mesh = models::model(name);
    let mut random = Random::new(seed);
    let mut sharpness = |share: f64| {
        let (is_tagged, lasts) = (random.unit() < share, random.unit() < 0.15);
        let fading = 3.0 * random.unit();
        is_tagged.then_some(if lasts { f64::INFINITY } else { fading })
    };
    let mut tags = Tags::default();
    let topology = mesh.topology();
    for h in topology
        .half_edges()
        .filter(|&h| topology.twin(h).is_some_and(|twin| h < twin))
    {
        let vertices = topology.ends(h).map(|v| v.0);
        tags.creases
            .extend(sharpness(0.3).map(|sharpness| CreaseTag {
                vertices,
                sharpness,
            }));
    }
    for vertex in 0..mesh.vertex_count() as u32 {
        tags.corners
            .extend(sharpness(0.1).map(|sharpness| CornerTag { vertex, sharpness }));
    }
    mesh.with_tags(tags).unwrap()
}

/// The half-edges that start the four parts of a face after a uniform step: the parts start at the old corners, the
/// middle one at the first new vertex. The face itself may start at any of its half-edges.
fn first_of_part(first: HalfEdgeId, part: usize) -> HalfEdgeId {
    let parts = 4 * first.face().0;
    let turned = |by: usize| (first.corner() + by) % 3;
    match part {
        3 => HalfEdgeId::of(FaceId(parts + 3), turned(1)),
        _ => HalfEdgeId::of(FaceId(parts + turned(part) as u32), [0, 2, 1][part]),
    }
}

struct Check<'a> {
    rules: &'a Rules<'a>,
    /// The control mesh and its refinements.
    levels: &'a [Mesh],
    table: LimitTable<'a>,
    name: &'a str,
}

impl Check<'_> {
    fn visit(&self, patch: &Patch, first: HalfEdgeId, level: usize) {
        let Some(fine) = self.levels.get(level + 1) else {
            return;
        };
        let refined = patch.refined(self.rules);
        let size = fine.diagonal();
        for edge in 0..3 {
            // The part at the edge's start goes from there to the new vertex.
            let corner = HalfEdgeId::of(first_of_part(first, edge).face(), 1);
            let vertex = fine.topology().origin(corner);
            let position = vector(self.table.position(fine, vertex).unwrap());
            let found = refined.middle(edge);
            let what = format!("{}, level {level}, {first}, edge {edge}", self.name);
            assert!(
                found.position.distance(position) < 1e-12 * size,
                "{what}: {found:?}, {position}"
            );
            let normal = vector(self.table.normal_at(fine, corner).unwrap());
            assert!(
                found.normal.distance(normal) < 1e-7,
                "{what}: {found:?}, {normal}"
            );
        }
        for part in 0..4 {
            self.visit(&refined.part(part), first_of_part(first, part), level + 1);
        }
    }
}

#[test]
fn pieces_follow_uniform_refinement() {
    for (seed, name) in ["tetrahedron", "cube", "spike", "sheet", "head"]
        .into_iter()
        .enumerate()
    {
        for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
            let mut levels = vec![tagged(name, seed as u64 + 5)];
            for level in 0..3 {
                levels.push(uniform(&levels[level], scheme, 1));
            }
            let rules = Rules::of(scheme);
            let check = Check {
                rules: &rules,
                levels: &levels,
                table: LimitTable::new(scheme),
                name,
            };
            let sharpness = Sharpness::of(&levels[0]);
            let mut semi_sharp = 0;
            for face in levels[0]
                .topology()
                .faces()
                .step_by(levels[0].face_count().div_ceil(40))
            {
                let patch =
                    root_patch(&levels[0], &sharpness, &LargeRings::default(), face, &rules);
                semi_sharp += usize::from(matches!(patch, Patch::SemiSharp(_)));
                check.visit(&patch, HalfEdgeId::of(face, 0), 0);
            }
            assert!(semi_sharp > 3, "{name}: {semi_sharp}");
        }
    }
}

/// Pieces that have but a part of a ring follow the refinement of all of it.
#[test]
fn parts_of_large_rings_follow_uniform_refinement() {
    for (kind, mesh) in super::whole_ring::tests::tagged_fans(180) {
        let mut levels = vec![mesh];
        for level in 0..2 {
            levels.push(uniform(&levels[level], &Loop, 1));
        }
        let rules = Rules::of(&Loop);
        let check = Check {
            rules: &rules,
            levels: &levels,
            table: LimitTable::new(&Loop),
            name: kind,
        };
        let sharpness = Sharpness::of(&levels[0]);
        let large = LargeRings::with_tags(&levels[0], &sharpness, &rules);
        for face in [0, 3, 4, 54, 90, 178, 179] {
            let face = FaceId(3 * face);
            let patch = root_patch(&levels[0], &sharpness, &large, face, &rules);
            check.visit(&patch, HalfEdgeId::of(face, 0), 0);
        }
    }
}

/// Limit positions of the vertices over each control face, some levels down.
fn limits(mesh: &Mesh, scheme: &dyn Scheme, levels: usize) -> Vec<Vec<DVec3>> {
    let fine = uniform(mesh, scheme, levels);
    let table = LimitTable::new(scheme);
    let positions = table.positions(&fine).unwrap();
    let of_face = |triangles: &[[u32; 3]]| -> Vec<DVec3> {
        triangles
            .as_flattened()
            .iter()
            .map(|&v| vector(positions[v as usize]))
            .collect()
    };
    fine.triangles()
        .chunks_exact(1 << (2 * levels))
        .map(of_face)
        .collect()
}

/// The semi-sharp surface and its infinitely sharp twin are no farther apart than is said, at any of their
/// points; and not much nearer either.
#[test]
fn infinitely_sharp_twins_are_near() {
    let step = |mesh: &Mesh| uniform(mesh, &Loop, 1);
    let (mut seen, mut tightest) = (0, 0.0f64);
    for (seed, name) in ["cube", "tetrahedron", "spike", "sheet", "head"]
        .into_iter()
        .enumerate()
    {
        for fades in [0.4, 1.0, 1.7, 3.0] {
            // Whole creases, corners where they meet and boundaries; with tags here and there, and everywhere.
            let plain = models::model(name);
            let mut folded = plain.with_creases_above(0.6).unwrap();
            let mut tags = folded.tags().clone();
            tags.creases
                .iter_mut()
                .for_each(|tag| tag.sharpness = fades + 1.0);
            folded = step(&folded.with_tags(tags).unwrap());
            for mesh in [folded, tagged(name, 17 + seed as u64)] {
                let mut lasting = mesh.tags().clone();
                lasting
                    .creases
                    .iter_mut()
                    .for_each(|tag| tag.sharpness = f64::INFINITY);
                lasting
                    .corners
                    .iter_mut()
                    .for_each(|tag| tag.sharpness = f64::INFINITY);
                let other = mesh.clone().with_tags(lasting).unwrap();
                for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
                    let (own, twins) = (limits(&mesh, scheme, 4), limits(&other, scheme, 4));
                    let (rules, sharpness) = (Rules::of(scheme), Sharpness::of(&mesh));
                    for face in mesh
                        .topology()
                        .faces()
                        .step_by(mesh.face_count().div_ceil(300))
                    {
                        let patch =
                            root_patch(&mesh, &sharpness, &LargeRings::default(), face, &rules);
                        let Patch::SemiSharp(piece) = patch else {
                            continue;
                        };
                        let Some((_, apart)) = piece.infinitely_sharp_twin(&rules) else {
                            continue;
                        };
                        let distances = own[face.index()].iter().zip(&twins[face.index()]);
                        let farthest = distances.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
                        assert!(
                            farthest <= apart + 1e-13 * mesh.diagonal(),
                            "{name} {fades} {face}: {farthest} {apart}"
                        );
                        seen += 1;
                        tightest = tightest.max(farthest / apart);
                    }
                }
            }
        }
    }
    assert!(
        seen > 1000 && tightest > 0.5,
        "{seen} pieces, at most {tightest} of the bound"
    );
}
