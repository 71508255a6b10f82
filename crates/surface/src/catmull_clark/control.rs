//! Control meshes of quads: polygons put together again from the triangles that they were cut into, and refined once where not all of them
//! are quads.
//!
//! Takes a mesh of triangles with the polygons of which they are parts; gives a mesh whose triangles are halves of quads. A step of
//! Catmull–Clark subdivision leaves the limit surface as it is.

use std::collections::{HashMap, HashSet};

use super::quads::{halves, in_half};
use super::ring::vertex_weights;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{
    BuildOptions, Channel, Diagnosis, Domain, Groups, Junctions, Mesh, MeshError, NONE,
    PolygonSoup, Semantic, Sharpness, Tags, Topology, Trace, outgoing_half_edges,
};
use crate::ring::SharpRing;
use crate::vector::{DVec3, vector};

/// A control mesh of quads for [`crate::scheme::CatmullClark`], made of polygons.
///
/// Its mesh has the halves of quads as triangles: faces 2q and 2q + 1 are those of quad q, whose diagonal is the second edge of both.
/// Where not all polygons are quads, each of them is divided into as many quads as it has corners, by a step of the scheme, which leaves
/// the limit surface as it is.
///
/// ```
/// use limitmesh_surface::limit::LimitTable;
/// use limitmesh_surface::mesh::{BuildOptions, PolygonSoup};
/// use limitmesh_surface::scheme::CatmullClark;
/// use limitmesh_surface::QuadControl;
///
/// let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 });
/// let mut cube = PolygonSoup { positions: (0..8).map(corner).collect(), ..Default::default() };
/// let faces = [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
/// faces.iter().for_each(|face| cube.faces.push(face));
/// let (control, _) = QuadControl::from_soup(&cube, &BuildOptions::default())?;
/// // Each corner of the cube moves half of the way to its centre.
/// assert!(LimitTable::new(&CatmullClark).positions(&control.mesh)?[7].iter().all(|x| (x - 0.5).abs() < 1e-15));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct QuadControl {
    /// The mesh.
    pub mesh: Mesh,
    /// By face of the mesh, the polygon of which it is a part: with [`Self::from_soup`] the soup's face.
    pub polygons: Vec<u32>,
    /// By corner of the mesh, three a face, the corners of the triangles of which it is the mean, by the half-edges that leave them.
    corners: Vec<Vec<HalfEdgeId>>,
}

impl QuadControl {
    /// The quads of a file's polygons.
    ///
    /// # Errors
    /// Those of [`Mesh::from_soup`].
    pub fn from_soup(
        soup: &PolygonSoup,
        options: &BuildOptions,
    ) -> Result<(Self, Diagnosis), MeshError> {
        let (mesh, diagnosis, trace) = Mesh::from_soup_traced(soup, options)?;
        Ok((Self::of(&mesh, &trace.faces)?, diagnosis))
    }

    /// A channel of the triangles on the quads: new corners have the mean of those that they are in the middle of.
    pub fn channel(&self, channel: &Channel) -> Channel {
        if channel.domain == Domain::Face {
            let of_corner =
                |corners: &[Vec<HalfEdgeId>]| channel.indices[corners[0][0].face().index()];
            let indices = self
                .corners
                .as_chunks::<3>()
                .0
                .iter()
                .map(|own| of_corner(own));
            return channel
                .clone()
                .with(channel.values.clone(), indices.collect());
        }
        let mut values = channel.values.clone();
        let mut known: HashMap<Vec<u32>, u32> = HashMap::new();
        let indices = self.corners.iter().map(|corners| {
            let mut own: Vec<u32> = corners.iter().map(|h| channel.indices[h.index()]).collect();
            own.sort_unstable();
            if own[0] == own[own.len() - 1] || channel.semantic == Semantic::Label {
                return own[0];
            }
            *known.entry(own).or_insert_with_key(|own| {
                let value = |at: usize| {
                    let sum: f64 = own
                        .iter()
                        .map(|&i| channel.values[i as usize * channel.arity + at])
                        .sum();
                    sum / own.len() as f64
                };
                values.extend((0..channel.arity).map(value));
                (values.len() / channel.arity) as u32 - 1
            })
        });
        let indices = indices.collect();
        channel.clone().with(values, indices)
    }

    /// The corners of a soup for those of the mesh, by those of the triangles: of new ones the first.
    pub fn trace(&self, triangles: &Trace) -> Trace {
        let mut trace = Trace::default();
        trace.faces = self.polygons.clone();
        let corners = self
            .corners
            .iter()
            .map(|own| triangles.corners[own[0].index()]);
        trace.corners = corners.collect();
        trace
    }

    /// The quads of a mesh, given by triangle the polygon that it is part of.
    ///
    /// # Errors
    /// There are more elements than can be numbered.
    pub fn of(mesh: &Mesh, parts: &[u32]) -> Result<Self, MeshError> {
        let polygons = Polygons::of(mesh.topology(), parts);
        match polygons.loops.iter().all(|own| own.len() == 4) {
            true => polygons.as_quads(mesh, parts),
            false => polygons.refined(mesh, parts),
        }
    }
}

/// Polygons by the half-edges of triangles along their sides.
struct Polygons {
    loops: Vec<Vec<HalfEdgeId>>,
    /// By half-edge, the polygon and the place in its loop; [`NONE`] inside a polygon.
    places: Vec<[u32; 2]>,
}

impl Polygons {
    fn of(topology: &Topology, parts: &[u32]) -> Self {
        let is_inside = |h: HalfEdgeId| {
            let part = |h: HalfEdgeId| parts[h.face().index()];
            topology.twin(h).filter(|&twin| part(twin) == part(h))
        };
        let mut polygons = Self {
            loops: Vec::new(),
            places: vec![[NONE; 2]; topology.half_edge_count()],
        };
        let mut met = vec![false; topology.face_count()];
        for face in topology.faces() {
            if met[face.index()] {
                continue;
            }
            // The triangles of the polygon that hang together, and the sides around them.
            let (mut own, mut sides) = (vec![face], 0);
            met[face.index()] = true;
            let mut at = 0;
            while let Some(&face) = own.get(at) {
                at += 1;
                for h in [0, 1, 2].map(|corner| HalfEdgeId::of(face, corner)) {
                    match is_inside(h) {
                        None => sides += 1,
                        Some(twin) if !met[twin.face().index()] => {
                            met[twin.face().index()] = true;
                            own.push(twin.face());
                        }
                        Some(_) => {}
                    }
                }
            }
            let first = own
                .iter()
                .flat_map(|&face| [0, 1, 2].map(|corner| HalfEdgeId::of(face, corner)))
                .find(|&h| is_inside(h).is_none());
            let next = |h: HalfEdgeId| {
                let mut next = h.next();
                while let Some(twin) = is_inside(next) {
                    next = twin.next();
                }
                next
            };
            let around: Vec<HalfEdgeId> = first.map_or(Vec::new(), |first| {
                let turn = |&h: &HalfEdgeId| Some(next(h)).filter(|&next| next != first);
                core::iter::successors(Some(first), turn)
                    .take(sides)
                    .collect()
            });
            // Triangles around a hole, or that touch themselves, stay triangles.
            if around.len() == sides && own.len() + 2 == sides {
                polygons.push(around);
            } else {
                for face in own {
                    polygons.push(
                        [0, 1, 2]
                            .map(|corner| HalfEdgeId::of(face, corner))
                            .to_vec(),
                    );
                }
            }
        }
        polygons
    }

    fn push(&mut self, own: Vec<HalfEdgeId>) {
        for (place, h) in (0..).zip(&own) {
            self.places[h.index()] = [self.loops.len() as u32, place];
        }
        self.loops.push(own);
    }

    /// The side that follows one, by so many steps.
    fn side(&self, h: HalfEdgeId, steps: usize) -> HalfEdgeId {
        let [polygon, place] = self.places[h.index()];
        let own = &self.loops[polygon as usize];
        own[(place as usize + steps) % own.len()]
    }

    fn before(&self, h: HalfEdgeId) -> HalfEdgeId {
        let [polygon, _] = self.places[h.index()];
        self.side(h, self.loops[polygon as usize].len() - 1)
    }

    /// Quads as they are.
    fn as_quads(&self, mesh: &Mesh, parts: &[u32]) -> Result<QuadControl, MeshError> {
        let topology = mesh.topology();
        let sides = self.loops.iter().flatten();
        let mut quads = QuadList::over(sides.map(|&h| topology.ends(h).map(|v| v.0)));
        for own in &self.loops {
            let sides = [0, 1, 2, 3].map(|i| own[i]);
            let [a, b, c, d] = sides.map(|h| topology.origin(h));
            let square = |a, b| at(mesh, a).distance_squared(at(mesh, b));
            // The shorter diagonal bends less.
            let is_turned = square(a, c) < square(b, d);
            quads.push([a, b, c, d].map(|v| v.0), sides.map(|h| vec![h]), is_turned);
        }
        let moved = |h: HalfEdgeId| {
            let [quad, place] = self.places[h.index()];
            quads.edge(quad, place)
        };
        let mut twins = vec![NONE; 3 * quads.triangles.len()];
        for &h in self.loops.iter().flatten() {
            if let Some(twin) = topology.twin(h) {
                twins[moved(h) as usize] = moved(twin);
            }
        }
        let mut junctions = mesh.junctions().clone();
        junctions.edges.rename(|h| moved(HalfEdgeId(h)));
        let positions = mesh.positions().to_vec();
        let tags = mesh.tags().clone();
        let polygons = self
            .loops
            .iter()
            .flat_map(|own| [parts[own[0].face().index()]; 2]);
        Ok(QuadControl {
            polygons: polygons.collect(),
            mesh: assembled(quads.triangles, twins, positions, tags, junctions)?,
            corners: quads.corners,
        })
    }

    /// All polygons after a step.
    fn refined(&self, mesh: &Mesh, parts: &[u32]) -> Result<QuadControl, MeshError> {
        let topology = mesh.topology();
        let sharpness = Sharpness::of(mesh);
        let sides: Vec<HalfEdgeId> = self.loops.iter().flatten().copied().collect();
        let mut positions: Vec<[f64; 3]> =
            Vec::with_capacity(mesh.vertex_count() + 2 * sides.len());
        let vertices = topology.vertices();
        positions.extend(vertices.map(|v| self.vertex_point(mesh, &sharpness, v).to_array()));
        let mut on_sides: HashMap<HalfEdgeId, u32> = HashMap::with_capacity(sides.len());
        for &h in &sides {
            let twin = topology.twin(h);
            if twin.is_none_or(|twin| h < twin) {
                let number = positions.len() as u32;
                let both = [Some(h), twin].into_iter().flatten();
                both.for_each(|h| _ = on_sides.insert(h, number));
                positions.push(self.side_point(mesh, &sharpness, h).to_array());
            }
        }
        // By side, the quad at the corner where it begins: its corners are that, the middle of the side, the centre, and the middle of the
        // side before.
        let numbers: HashMap<HalfEdgeId, u32> = sides.iter().copied().zip(0..).collect();
        let mut quads = QuadList::default();
        let mut polygons = Vec::with_capacity(2 * sides.len());
        for own in &self.loops {
            let middle = positions.len() as u32;
            positions.push(self.centroid(mesh, own[0]).to_array());
            for &h in own {
                let before = self.before(h);
                let vertices = [
                    topology.origin(h).0,
                    on_sides[&h],
                    middle,
                    on_sides[&before],
                ];
                let sources = [
                    vec![h],
                    vec![h, self.side(h, 1)],
                    own.clone(),
                    vec![before, h],
                ];
                quads.push(vertices, sources, false);
                polygons.extend([parts[own[0].face().index()]; 2]);
            }
        }
        let mut twins = vec![NONE; 3 * quads.triangles.len()];
        let parts_of = |h: HalfEdgeId| {
            let next = numbers[&self.side(h, 1)];
            [quads.edge(numbers[&h], 0), quads.edge(next, 3)]
        };
        for &h in &sides {
            // From the middle of the side to the centre, and back beyond.
            let next = numbers[&self.side(h, 1)];
            let (here, there) = (quads.edge(numbers[&h], 1), quads.edge(next, 2));
            (twins[here as usize], twins[there as usize]) = (there, here);
            if let Some(twin) = topology.twin(h) {
                let ([first, second], [other_first, other_second]) = (parts_of(h), parts_of(twin));
                (twins[first as usize], twins[second as usize]) = (other_second, other_first);
            }
        }
        let tags = mesh.tags().refined(|a, b| {
            let h = topology.edge_between(a, b)?;
            on_sides.get(&h).copied()
        });
        let junctions = refined_junctions(mesh.junctions(), topology, parts_of, |h| on_sides[&h]);
        Ok(QuadControl {
            mesh: assembled(quads.triangles, twins, positions, tags, junctions)?,
            polygons,
            corners: quads.corners,
        })
    }

    fn centroid(&self, mesh: &Mesh, h: HalfEdgeId) -> DVec3 {
        let own = &self.loops[self.places[h.index()][0] as usize];
        let sum: DVec3 = own
            .iter()
            .map(|&h| at(mesh, mesh.topology().origin(h)))
            .sum();
        sum / own.len() as f64
    }

    fn side_point(&self, mesh: &Mesh, sharpness: &Sharpness<'_>, h: HalfEdgeId) -> DVec3 {
        let [from, to] = mesh.topology().ends(h).map(|v| at(mesh, v));
        let middle = 0.5 * (from + to);
        let sharp = sharpness.edge(h).min(1.0);
        let Some(twin) = mesh.topology().twin(h).filter(|_| sharp < 1.0) else {
            return middle;
        };
        let faces = 0.5 * (self.centroid(mesh, h) + self.centroid(mesh, twin));
        sharp * middle + (1.0 - sharp) * 0.5 * (middle + faces)
    }

    fn vertex_point(&self, mesh: &Mesh, sharpness: &Sharpness<'_>, vertex: VertexId) -> DVec3 {
        let topology = mesh.topology();
        let is_side = |h: &HalfEdgeId| self.places[h.index()][0] != NONE;
        let outgoing: Vec<HalfEdgeId> = topology.outgoing_ring(vertex).filter(is_side).collect();
        let mut neighbours: Vec<DVec3> = outgoing
            .iter()
            .map(|&h| at(mesh, topology.target(h)))
            .collect();
        let mut spokes: Vec<f64> = outgoing.iter().map(|&h| sharpness.edge(h)).collect();
        let open = topology.is_boundary(vertex);
        if open {
            // The last edge of an open ring arrives.
            let last = outgoing.last().map(|&h| topology.origin(self.before(h)));
            neighbours.extend(last.map(|v| at(mesh, v)));
            spokes.push(f64::INFINITY);
        }
        // The corners opposite the vertex in quads with the same centroids.
        let opposite = (0..outgoing.len()).map(|slot| {
            let ends = neighbours[slot] + neighbours[(slot + 1) % neighbours.len()];
            4.0 * self.centroid(mesh, outgoing[slot]) - at(mesh, vertex) - ends
        });
        let points = [at(mesh, vertex)]
            .into_iter()
            .chain(neighbours.iter().copied());
        let points = points.chain(opposite);
        let ring = SharpRing {
            open,
            vertex: sharpness.vertex(vertex),
            spokes,
        };
        points
            .zip(vertex_weights(&ring))
            .map(|(point, weight)| weight * point)
            .sum()
    }
}

fn at(mesh: &Mesh, vertex: VertexId) -> DVec3 {
    vector(mesh.positions()[vertex.index()])
}

/// Quads as pairs of halves.
#[derive(Default)]
struct QuadList {
    triangles: Vec<[u32; 3]>,
    /// By corner, those that it comes from.
    corners: Vec<Vec<HalfEdgeId>>,
    /// By quad, whether its first half begins at its second corner.
    turns: Vec<bool>,
    /// Pairs of vertices that an edge or a diagonal joins.
    joined: HashSet<[u32; 2]>,
}

impl QuadList {
    /// None yet, over these edges.
    fn over(edges: impl Iterator<Item = [u32; 2]>) -> Self {
        Self {
            joined: edges.map(pair).collect(),
            ..Self::default()
        }
    }

    /// Adds a quad, cut from its second corner to its fourth, or from the first to the third: as is preferred, unless something else
    /// joins these vertices, as at vertices of two edges.
    fn push(&mut self, vertices: [u32; 4], sources: [Vec<HalfEdgeId>; 4], prefers_turn: bool) {
        let [a, b, c, d] = vertices;
        let diagonal = |is_turned: bool| {
            if is_turned {
                pair([a, c])
            } else {
                pair([b, d])
            }
        };
        let is_taken = self.joined.contains(&diagonal(prefers_turn));
        let is_turned =
            prefers_turn != (is_taken && !self.joined.contains(&diagonal(!prefers_turn)));
        self.joined.insert(diagonal(is_turned));
        self.turns.push(is_turned);
        let turn = |i: usize| (i + usize::from(is_turned)) % 4;
        self.triangles
            .extend(halves([0, 1, 2, 3].map(|i| vertices[turn(i)])));
        let of_halves = [0, 1, 3, 2, 3, 1].map(|i| sources[turn(i)].clone());
        self.corners.extend(of_halves);
    }

    /// The half-edge of a quad's half along the edge from this corner.
    fn edge(&self, quad: u32, corner: u32) -> u32 {
        let turn = u32::from(self.turns[quad as usize]);
        in_half(4 * quad + (corner + 4 - turn) % 4).0
    }
}

fn pair([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn assembled(
    triangles: Vec<[u32; 3]>,
    mut twins: Vec<u32>,
    positions: Vec<[f64; 3]>,
    tags: Tags,
    junctions: Junctions,
) -> Result<Mesh, MeshError> {
    if 3 * triangles.len() >= NONE as usize || positions.len() >= NONE as usize {
        return Err(MeshError::TooMany {
            what: "faces",
            count: triangles.len(),
            limit: NONE as usize / 3,
        });
    }
    for face in 0..triangles.len() as u32 {
        twins[3 * face as usize + 1] = 3 * (face ^ 1) + 1;
    }
    let outgoing = outgoing_half_edges(&triangles, &twins, positions.len());
    let topology = Topology::from_parts(triangles, twins, outgoing).with_quads()?;
    Ok(Mesh::from_parts(topology, positions, tags, junctions))
}

/// The copies of vertices and edges after a step, given the parts of a half-edge and the new vertex on it.
fn refined_junctions(
    junctions: &Junctions,
    topology: &Topology,
    parts_of: impl Fn(HalfEdgeId) -> [u32; 2],
    on_side: impl Fn(HalfEdgeId) -> u32,
) -> Junctions {
    let mut refined = Junctions {
        vertices: junctions.vertices.clone(),
        edges: Groups::default(),
    };
    let first_copies = junctions.first_copies();
    let first = |v: VertexId| first_copies.get(&v.0).copied().unwrap_or(v.0);
    for group in junctions.edges.iter() {
        refined
            .vertices
            .push(group.iter().map(|&h| on_side(HalfEdgeId(h))));
        let start = group
            .first()
            .map(|&h| first(topology.origin(HalfEdgeId(h))));
        for half in [0, 1] {
            refined.edges.push(group.iter().map(|&h| {
                let h = HalfEdgeId(h);
                let runs_along = Some(first(topology.origin(h))) == start;
                parts_of(h)[if runs_along { half } else { 1 - half }]
            }));
        }
    }
    refined
}
