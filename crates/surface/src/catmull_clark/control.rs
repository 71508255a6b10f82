//! Control meshes of quads: those of a file's polygons, refined once where not all of them are quads.
//!
//! Takes polygons as fans of triangles; gives a mesh whose triangles are halves of quads. A step of Catmull–Clark subdivision leaves the
//! limit surface as it is.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::quads::{halves, in_half};
use super::ring::vertex_weights;
use crate::index::{HalfEdgeId, VertexId};
use crate::math;
use crate::mesh::{
    BoundaryRule, BuildOptions, Diagnosis, Fans, Groups, Junctions, Mesh, MeshError, NONE,
    PolygonFaces, PolygonSoup, Sharpness, Tags, Topology, Trace, outgoing_half_edges,
};
use crate::options;
use crate::ring::SharpRing;
use crate::vector::{DVec3, unit_or_zero, vector};

options! {
    /// What is done to polygons before they are quads.
    #[derive(Clone, Copy, Debug)]
    pub struct QuadOptions {
        /// Whether edges of triangles follow OpenSubdiv's `smooth triangles` in the step that makes quads of them: the surface over
        /// triangles is rounder.
        pub smooth_triangles: bool = false,
        /// The rule of the boundary, as [`Mesh::with_boundary`] has it for meshes that are already there.
        pub boundary: BoundaryRule = BoundaryRule::Smooth,
        /// Edges at which the polygons' normals differ by more than this angle (radians, 0 to π) are sharp for ever, if it is given.
        pub crease_angle: Option<f64> = None,
    }
}

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
    /// The faces and corners of the soup that those of the mesh are from.
    pub trace: Trace,
    /// The polygons, where a step has divided them.
    pub(super) divided: Option<Arc<Divided>>,
}

/// Polygons before a step.
#[derive(Debug)]
pub(super) struct Divided {
    pub(super) fans: Fans,
    pub(super) smooth_triangles: bool,
}

impl QuadControl {
    /// The quads of a file's polygons. Defects are repaired as for [`Mesh::from_soup`], but that polygons without area stay; those that
    /// visit a vertex twice are cut into triangles.
    ///
    /// # Errors
    /// Those of [`Mesh::from_soup`].
    pub fn from_soup(
        soup: &PolygonSoup,
        options: &BuildOptions,
    ) -> Result<(Self, Diagnosis), MeshError> {
        Self::from_soup_with(soup, options, &QuadOptions::default())
    }

    /// [`Self::from_soup`] by other rules.
    ///
    /// # Errors
    /// Those of [`Mesh::from_soup`].
    pub fn from_soup_with(
        soup: &PolygonSoup,
        options: &BuildOptions,
        rules: &QuadOptions,
    ) -> Result<(Self, Diagnosis), MeshError> {
        let (mut fans, diagnosis) = Mesh::fans_from_soup(soup, options)?;
        let polygons = Polygons::of(&fans);
        if let Some(angle) = rules.crease_angle {
            let edges = polygons.creases_above(&fans.mesh, angle);
            fans.mesh = fans.mesh.with_creases(&edges);
        }
        let control = match polygons.as_quads(&fans)? {
            Some(quads) => quads,
            None => {
                let kept = polygons.kept_corners(&fans.mesh, rules.boundary);
                fans.mesh = fans.mesh.with_corners(&kept);
                let smooth_triangles = rules.smooth_triangles;
                let mut control = polygons.refined(&fans, smooth_triangles)?;
                control.divided = Some(Arc::new(Divided {
                    fans,
                    smooth_triangles,
                }));
                control
            }
        };
        let mesh = control.mesh.with_boundary(rules.boundary);
        Ok((Self { mesh, ..control }, diagnosis))
    }
}

/// What a face beside an edge weighs where it is a triangle that is to be smooth, as in OpenSubdiv; others weigh a quarter.
const SMOOTH_TRIANGLE: f64 = 0.47;

/// Polygons by the half-edges of their fans along their sides.
pub(super) struct Polygons {
    loops: Vec<Vec<HalfEdgeId>>,
    /// By half-edge, the polygon and the place in its loop; [`NONE`] inside a polygon.
    places: Vec<[u32; 2]>,
    centroids: Vec<DVec3>,
}

impl Polygons {
    pub(super) fn of(fans: &Fans) -> Self {
        let topology = fans.mesh.topology();
        let mut polygons = Self {
            loops: Vec::new(),
            places: vec![[NONE; 2]; topology.half_edge_count()],
            centroids: Vec::new(),
        };
        for first in topology.faces().filter_map(|face| fans.side(face)) {
            if polygons.places[first.index()][0] == NONE {
                let own: Vec<HalfEdgeId> = fans.sides(first).collect();
                for (place, h) in (0..).zip(&own) {
                    polygons.places[h.index()] = [polygons.loops.len() as u32, place];
                }
                let corners = own.iter().map(|&h| at(&fans.mesh, topology.origin(h)));
                let sum: DVec3 = corners.sum();
                polygons.centroids.push(sum / own.len() as f64);
                polygons.loops.push(own);
            }
        }
        polygons
    }

    /// The edges at which the polygons' normals differ by more than an angle; those of polygons without area do not.
    fn creases_above(&self, mesh: &Mesh, angle: f64) -> Vec<HalfEdgeId> {
        let topology = mesh.topology();
        let normal = |(own, &middle): (&Vec<HalfEdgeId>, &DVec3)| {
            let area = |&h: &HalfEdgeId| {
                let [from, to] = topology.ends(h).map(|v| at(mesh, v) - middle);
                from.cross(to)
            };
            unit_or_zero(own.iter().map(area).sum())
        };
        let normals: Vec<DVec3> = self.loops.iter().zip(&self.centroids).map(normal).collect();
        let normal = |h: HalfEdgeId| normals[self.places[h.index()][0] as usize];
        let is_above = |&h: &HalfEdgeId| {
            topology
                .twin(h)
                .filter(|&twin| h < twin)
                .is_some_and(|twin| {
                    let [own, other] = [h, twin].map(normal);
                    math::atan2(own.cross(other).length(), own.dot(other)) > angle
                })
        };
        self.loops
            .iter()
            .flatten()
            .copied()
            .filter(is_above)
            .collect()
    }

    /// The sides that leave a vertex, in their order around it.
    fn outgoing(&self, topology: &Topology, vertex: VertexId) -> Vec<HalfEdgeId> {
        let is_side = |h: &HalfEdgeId| self.places[h.index()][0] != NONE;
        topology.outgoing_ring(vertex).filter(is_side).collect()
    }

    /// The vertices of the boundary that a rule keeps where they are.
    fn kept_corners(&self, mesh: &Mesh, rule: BoundaryRule) -> Vec<VertexId> {
        let topology = mesh.topology();
        let is_kept = |&v: &VertexId| {
            topology.is_boundary(v)
                && match rule {
                    BoundaryRule::Fixed => true,
                    BoundaryRule::Corners => self.outgoing(topology, v).len() == 1,
                    _ => false,
                }
        };
        topology.vertices().filter(is_kept).collect()
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

    /// Quads as they are, without the vertices in their middles; nothing where not all polygons are quads, or a quad has no diagonal whose
    /// ends nothing else joins.
    fn as_quads(&self, fans: &Fans) -> Result<Option<QuadControl>, MeshError> {
        if self.loops.iter().any(|own| own.len() != 4) {
            return Ok(None);
        }
        let (mesh, topology) = (&fans.mesh, fans.mesh.topology());
        let centres = &fans.centres;
        let name = |v: u32| {
            if v < centres.start {
                v
            } else {
                v - centres.len() as u32
            }
        };
        let sides = self.loops.iter().flatten();
        let mut quads = QuadList::over(sides.map(|&h| topology.ends(h).map(|v| name(v.0))));
        let mut rows = PolygonFaces::default();
        for own in &self.loops {
            let sides = [0, 1, 2, 3].map(|i| own[i]);
            let [a, b, c, d] = sides.map(|h| topology.origin(h));
            let square = |a, b| at(mesh, a).distance_squared(at(mesh, b));
            // The shorter diagonal bends less.
            let is_turned = square(a, c) < square(b, d);
            let sources = sides.map(|h| {
                rows.push(&[fans.trace.corners[h.index()]]);
                rows.len() as u32 - 1
            });
            let input = fans.trace.faces[sides[0].face().index()];
            quads.push([a, b, c, d].map(|v| name(v.0)), sources, input, is_turned);
        }
        if quads.has_doubles {
            return Ok(None);
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
        junctions.vertices.rename(name);
        let mut positions = mesh.positions().to_vec();
        positions.drain(centres.start as usize..centres.end as usize);
        let mut tags = mesh.tags().clone();
        for tag in &mut tags.creases {
            tag.vertices = tag.vertices.map(name);
        }
        for tag in &mut tags.corners {
            tag.vertex = name(tag.vertex);
        }
        let mut trace = quads.trace(rows);
        (trace.between, trace.rows) = Default::default();
        let mesh = assembled(quads.triangles, twins, positions, tags, junctions)?;
        Ok(Some(QuadControl {
            mesh,
            trace,
            divided: None,
        }))
    }

    /// All polygons after a step. The vertices in their middles go where it puts them.
    pub(super) fn refined(&self, fans: &Fans, smooths: bool) -> Result<QuadControl, MeshError> {
        let (mesh, topology) = (&fans.mesh, fans.mesh.topology());
        let sharpness = Sharpness::of(mesh);
        let sides: Vec<HalfEdgeId> = self.loops.iter().flatten().copied().collect();
        let mut positions: Vec<[f64; 3]> = Vec::with_capacity(mesh.vertex_count() + sides.len());
        positions.extend(topology.vertices().map(|v| {
            let point = match fans.centres.contains(&v.0) {
                true => self.centroid(topology.outgoing(v).next()),
                false => self.vertex_point(mesh, &sharpness, v),
            };
            point.to_array()
        }));
        let mut on_sides: HashMap<HalfEdgeId, u32> = HashMap::with_capacity(sides.len());
        for &h in &sides {
            let twin = topology.twin(h);
            if twin.is_none_or(|twin| h < twin) {
                let number = positions.len() as u32;
                let both = [Some(h), twin].into_iter().flatten();
                both.for_each(|h| _ = on_sides.insert(h, number));
                positions.push(self.side_point(mesh, &sharpness, h, smooths).to_array());
            }
        }
        // By side, the quad at the corner where it begins: its corners are that, the middle of the side, the centre, and the middle of the
        // side before.
        let numbers: HashMap<HalfEdgeId, u32> = sides.iter().copied().zip(0..).collect();
        let mut quads = QuadList::default();
        for &h in &sides {
            let before = self.before(h);
            let [corner, centre] = [h, h.previous()].map(|h| topology.origin(h).0);
            let vertices = [corner, on_sides[&h], centre, on_sides[&before]];
            // As the rows are numbered.
            let (own, count) = (numbers[&h], sides.len() as u32);
            let polygon = 2 * count + self.places[h.index()][0];
            let sources = [own, count + own, polygon, count + numbers[&before]];
            let input = fans.trace.faces[h.face().index()];
            quads.push(vertices, sources, input, false);
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
        let trace = quads.trace(self.rows(&sides, &fans.trace));
        let mesh = assembled(quads.triangles, twins, positions, tags, junctions)?;
        Ok(QuadControl {
            mesh,
            trace,
            divided: None,
        })
    }

    /// The soup's corners that those after a step are put between: by side one where it begins, by side both at its ends, by polygon all.
    fn rows(&self, sides: &[HalfEdgeId], trace: &Trace) -> PolygonFaces {
        let corner = |&h: &HalfEdgeId| trace.corners[h.index()];
        let mut rows = PolygonFaces::with_capacity(2 * sides.len(), 4 * sides.len());
        sides.iter().for_each(|h| rows.push(&[corner(h)]));
        for &h in sides {
            rows.push(&[h, self.side(h, 1)].map(|h| corner(&h)));
        }
        for own in &self.loops {
            rows.push(&own.iter().map(corner).collect::<Vec<_>>());
        }
        rows
    }

    fn centroid(&self, h: HalfEdgeId) -> DVec3 {
        self.centroids[self.places[h.index()][0] as usize]
    }

    /// The new point on a side. Triangles beside it weigh more where they are to be smooth.
    fn side_point(
        &self,
        mesh: &Mesh,
        sharpness: &Sharpness<'_>,
        h: HalfEdgeId,
        smooths: bool,
    ) -> DVec3 {
        let [from, to] = mesh.topology().ends(h).map(|v| at(mesh, v));
        let middle = 0.5 * (from + to);
        let sharp = sharpness.edge(h).min(1.0);
        let Some(twin) = mesh.topology().twin(h).filter(|_| sharp < 1.0) else {
            return middle;
        };
        let faces = 0.5 * (self.centroid(h) + self.centroid(twin));
        let share = |h: HalfEdgeId| match self.loops[self.places[h.index()][0] as usize].len() {
            3 if smooths => SMOOTH_TRIANGLE,
            _ => 0.25,
        };
        let share = share(h) + share(twin);
        sharp * middle + (1.0 - sharp) * ((1.0 - share) * middle + share * faces)
    }

    fn vertex_point(&self, mesh: &Mesh, sharpness: &Sharpness<'_>, vertex: VertexId) -> DVec3 {
        let topology = mesh.topology();
        let outgoing = self.outgoing(topology, vertex);
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
            4.0 * self.centroid(outgoing[slot]) - at(mesh, vertex) - ends
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
    /// By triangle, the face of the soup.
    inputs: Vec<u32>,
    /// By corner, the row of those that it comes from.
    sources: Vec<u32>,
    /// By quad, whether its first half begins at its second corner.
    turns: Vec<bool>,
    /// Pairs of vertices that an edge or a diagonal joins.
    joined: HashSet<[u32; 2]>,
    /// Whether some of them are joined twice.
    has_doubles: bool,
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
    fn push(&mut self, vertices: [u32; 4], sources: [u32; 4], input: u32, prefers_turn: bool) {
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
        self.has_doubles |= !self.joined.insert(diagonal(is_turned));
        self.turns.push(is_turned);
        let turn = |i: usize| (i + usize::from(is_turned)) % 4;
        self.triangles
            .extend(halves([0, 1, 2, 3].map(|i| vertices[turn(i)])));
        let of_halves = [0, 1, 3, 2, 3, 1].map(|i| sources[turn(i)]);
        self.sources.extend(of_halves);
        self.inputs.extend([input; 2]);
    }

    /// The soup's faces and corners, given the rows of the corners.
    fn trace(&self, rows: PolygonFaces) -> Trace {
        let corners = self.sources.iter().map(|&row| rows.get(row as usize)[0]);
        let mut trace = Trace::default();
        trace.corners = corners.collect();
        trace.faces = self.inputs.clone();
        (trace.between, trace.rows) = (self.sources.clone(), rows);
        trace
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
