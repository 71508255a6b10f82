//! The control points on which the limit surface over a face depends, and a key of the rules between them.
//!
//! Takes a face of a mesh of the Loop family; gives the control points in an order of their own, and a key. Faces with equal keys
//! have the same surface as a function of their control points, so that what is found of one of them serves all.

use std::collections::HashMap;

use super::from_mesh::{is_semi_sharp, sector_of};
use super::large_rings::LargeRings;
use super::sector::{Centre, Far};
use crate::catmull_clark::quads::{Connected, MeshQuads, of_face};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};

/// Control points that are looked for one by one: no face has more where nothing is unusual.
const FEW: usize = 32;

/// The control points of the surface over a face.
#[derive(Clone, Debug)]
pub struct Support {
    /// The corner of the face that counts as the first.
    pub turn: usize,
    /// The key of the points' rules.
    pub key: Vec<u32>,
    /// Vertices, that corner first; from the number of vertices on the means of large rings, by the number of the ring.
    pub points: Vec<u32>,
}

/// A corner with the points around it, and what they are to the rules, in words.
struct Corner {
    points: Vec<u32>,
    role: Vec<u32>,
}

impl Support {
    /// That of a face of `mesh`, whose large rings are `large`. Of the three turns the one with the least key is taken.
    /// A half of a quad has no other.
    pub fn of(mesh: &Mesh, sharpness: &Sharpness<'_>, large: &LargeRings, face: FaceId) -> Self {
        if mesh.topology().has_quads() {
            let (quads, points) = MeshQuads { mesh, sharpness }.surroundings(of_face(face));
            return Self {
                turn: 0,
                key: quads.words(),
                points,
            };
        }
        let half_edges = [0, 1, 2].map(|corner| HalfEdgeId::of(face, corner));
        let corners = match is_semi_sharp(mesh, sharpness, large, half_edges) {
            true => half_edges.map(|h| Corner::semi_sharp(mesh, sharpness, h)),
            false => half_edges.map(|h| Corner::infinitely_sharp(mesh, sharpness, large, h)),
        };
        let turns = [0, 1, 2].map(|turn| Self::turned(&corners, turn));
        let [first, second, third] = turns;
        let least = if second.key < first.key {
            second
        } else {
            first
        };
        if third.key < least.key { third } else { least }
    }

    fn turned(corners: &[Corner; 3], turn: usize) -> Self {
        let mut numbered = Numbered::default();
        let corners = [0, 1, 2].map(|i| &corners[(turn + i) % 3]);
        let mut key: Vec<u32> = corners
            .iter()
            .flat_map(|corner| corner.role.iter().copied())
            .collect();
        corners
            .iter()
            .for_each(|corner| key.push(numbered.number(corner.points[0])));
        for corner in corners {
            key.extend(
                corner.points[1..]
                    .iter()
                    .map(|&point| numbered.number(point)),
            );
        }
        Self {
            turn,
            key,
            points: numbered.points,
        }
    }
}

/// Points by the order in which they came.
#[derive(Default)]
struct Numbered {
    points: Vec<u32>,
    /// Once there are many.
    numbers: HashMap<u32, u32>,
}

impl Numbered {
    fn number(&mut self, point: u32) -> u32 {
        let count = self.points.len();
        let known = match count <= FEW {
            true => self
                .points
                .iter()
                .position(|&known| known == point)
                .map(|at| at as u32),
            false => {
                if self.numbers.is_empty() {
                    self.numbers = self.points.iter().copied().zip(0..).collect();
                }
                self.numbers.get(&point).copied()
            }
        };
        known.unwrap_or_else(|| {
            self.points.push(point);
            if count > FEW {
                self.numbers.insert(point, count as u32);
            }
            count as u32
        })
    }
}

impl Corner {
    /// A corner of a face with semi-sharp tags: the whole ring, and how sharp it is.
    fn semi_sharp(mesh: &Mesh, sharpness: &Sharpness<'_>, h: HalfEdgeId) -> Self {
        let topology = mesh.topology();
        let vertex = topology.origin(h);
        let ring = sharpness.ring(vertex);
        let slot = topology.slot(h);
        let mut role = vec![
            FADES,
            u32::from(ring.open),
            slot as u32,
            ring.spokes.len() as u32,
        ];
        let sharp = ring.spokes.iter().chain([&ring.vertex]);
        role.extend(
            sharp.flat_map(|sharp| [sharp.to_bits() as u32, (sharp.to_bits() >> 32) as u32]),
        );
        Self {
            points: [vertex]
                .into_iter()
                .chain(topology.ring(vertex))
                .map(|v| v.0)
                .collect(),
            role,
        }
    }

    /// Any other corner: the sector on the face's side, as pieces are made of it.
    fn infinitely_sharp(
        mesh: &Mesh,
        sharpness: &Sharpness<'_>,
        large: &LargeRings,
        h: HalfEdgeId,
    ) -> Self {
        let topology = mesh.topology();
        let vertex = topology.origin(h);
        let is_plain = !sharpness.is_tagged(vertex);
        let mut points = vec![vertex.0];
        if let Some(near) = large.near(topology, h).filter(|_| is_plain) {
            points.extend(near.neighbours.iter().map(|v| v.0));
            let (far, valence) = match near.far {
                Far::Mean { valence, .. } => (1, valence as u32),
                Far::Ends {
                    after_first,
                    before_last,
                } => (2 + u32::from(after_first) + 2 * u32::from(before_last), 0),
                Far::Kept => (0, 0),
            };
            if far == 1 {
                points.push((mesh.vertex_count() + near.number) as u32);
            }
            let role = vec![
                NEAR,
                far,
                valence,
                near.slot as u32,
                near.neighbours.len() as u32,
            ];
            return Self { points, role };
        }
        let sector = sector_of(topology, sharpness, h);
        let neighbours: Vec<VertexId> = sector.neighbours(topology).collect();
        let slot = sector
            .outgoing(topology)
            .take_while(|&other| other != h)
            .count() as u32;
        let centre = match Centre::of(sector.shape) {
            Centre::Smooth { sharp } => [0, sharp.map_or(0, |slot| 1 + slot as u32)],
            Centre::Crease => [1, 0],
            Centre::Corner { open, sharp } => {
                [2 + u32::from(open), sharp.map_or(0, |slot| 1 + slot as u32)]
            }
        };
        points.extend(neighbours.iter().map(|v| v.0));
        Self {
            points,
            role: vec![WHOLE, centre[0], centre[1], slot, neighbours.len() as u32],
        }
    }
}

/// Kinds of corners.
const WHOLE: u32 = 0;
const NEAR: u32 = 1;
const FADES: u32 = 2;
