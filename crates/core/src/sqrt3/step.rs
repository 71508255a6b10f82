//! One uniform step of √3-subdivision: a mesh gives the next, with three times as many faces.
//!
//! The half-edge h from A to B in a face t, with the face u across it, gives the face number h: `(A, apex of u, apex of t)`,
//! where the apex of a face is its centre. A sharp edge has nothing across it: at an even level it gives `(A, B, apex)`; at an odd
//! one it is cut by `l`, near A, and `r`, near B, there is no centre, and it gives `(l, r, c)` with the face's third corner c.
//! Seen from its other edges, such a face's apex is `r` across from B → c and `l` across from c → A. So numbers and twins are arithmetic.

use super::masks::{centre, crease_point, on_curve, smoothed};
use super::origins::{Made, Origins};
use super::sharp_edges::SharpEdges;
use crate::geometry::NONE;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{
    CreaseTag, Groups, Junctions, MAX_FACES, Mesh, MeshError, Tags, Topology, outgoing_half_edges,
};
use crate::parallel;
use crate::progress::{Cancelled, Watch};
use crate::refine::RefineError;
use crate::ring::VertexRule;
use crate::vector::{DVec3, vector};

/// No corner: the face has no sharp edge that is cut.
const NO_CORNER: u8 = 3;

/// A mesh that a number of steps gave.
pub(super) struct Level {
    pub(super) mesh: Mesh,
    /// Number of steps.
    pub(super) steps: usize,
    /// The vertices at which creases end, and where they were at the even level at or before this: ends of the curves, which are
    /// cut as they were there.
    darts: Vec<(u32, DVec3)>,
}

/// How the elements of a step are numbered.
struct Numbering<'m> {
    topology: &'m Topology,
    sharp: &'m SharpEdges<'m>,
    /// For each face the corner of its sharp edge, if that is cut, else [`NO_CORNER`].
    cut: Vec<u8>,
    /// For each face its centre twice, or the points on its sharp edge.
    apexes: Vec<[u32; 2]>,
    vertex_count: usize,
}

impl Level {
    /// # Errors
    /// A semi-sharp tag.
    pub(super) fn control(mesh: &Mesh) -> Result<Self, RefineError> {
        let sharp = SharpEdges::of(mesh)?;
        check_valences(mesh)?;
        let mut level = Self {
            mesh: mesh.clone(),
            steps: 0,
            darts: Vec::new(),
        };
        if !sharp.is_empty() {
            let darts = mesh
                .topology()
                .vertices()
                .filter(|&v| sharp.rule(v) == VertexRule::Dart);
            level.darts = darts
                .map(|v| (v.0, vector(mesh.positions()[v.index()])))
                .collect();
        }
        Ok(level)
    }

    /// Whether the last step left the curves as they were.
    pub(super) fn is_odd(&self) -> bool {
        self.steps % 2 == 1
    }

    /// The next level; `origins` go on with it.
    ///
    /// # Errors
    /// More faces than can be numbered, or cancelled.
    pub(super) fn step(
        &self,
        origins: Option<&mut Origins<'_>>,
        watch: &mut Watch<'_>,
    ) -> Result<Self, RefineError> {
        let faces = self.mesh.face_count();
        if faces > MAX_FACES / 3 {
            let (what, count) = ("faces", faces.saturating_mul(3));
            return Err(MeshError::TooMany {
                what,
                count,
                limit: MAX_FACES,
            }
            .into());
        }
        let sharp = SharpEdges::of(&self.mesh)?;
        let numbering = Numbering::new(&self.mesh, &sharp, self.is_odd(), watch)?;
        let positions = self.positions(&numbering, watch)?;
        let topology = numbering.connect(watch)?;
        let tags = numbering.tags(self.mesh.tags());
        let junctions = numbering.junctions(self.mesh.junctions());
        let mesh = Mesh::from_parts(topology, positions, tags, junctions);
        if let Some(origins) = origins {
            let straddles = |face: usize| self.is_odd() && numbering.cut[face] == NO_CORNER;
            origins.advance(&self.mesh, &numbering.made(), straddles);
        }
        let mut darts = self.darts.clone();
        if self.is_odd() {
            darts
                .iter_mut()
                .for_each(|(v, place)| *place = vector(mesh.positions()[*v as usize]));
        }
        Ok(Self {
            mesh,
            steps: self.steps + 1,
            darts,
        })
    }

    fn at(&self, vertex: VertexId) -> DVec3 {
        vector(self.mesh.positions()[vertex.index()])
    }

    fn positions(
        &self,
        new: &Numbering<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<Vec<[f64; 3]>, Cancelled> {
        let mut positions =
            parallel::map_polled(self.mesh.vertex_count(), &mut |_| watch.poll(), |v| {
                self.moved(new.sharp, VertexId(v as u32)).to_array()
            })?;
        positions.resize(new.vertex_count, [0.0; 3]);
        for (face, (&cut, &apexes)) in new.cut.iter().zip(&new.apexes).enumerate() {
            if face % (1 << 16) == 0 {
                watch.poll()?;
            }
            if cut == NO_CORNER {
                let corners = self.mesh.triangles()[face].map(|v| self.at(VertexId(v)));
                positions[apexes[0] as usize] = centre(corners).to_array();
            } else {
                let [a, b] = self
                    .mesh
                    .topology()
                    .ends(HalfEdgeId(3 * face as u32 + u32::from(cut)));
                positions[apexes[0] as usize] = self.crease_point(new.sharp, a, b).to_array();
                positions[apexes[1] as usize] = self.crease_point(new.sharp, b, a).to_array();
            }
        }
        Ok(positions)
    }

    /// Where a vertex goes.
    fn moved(&self, sharp: &SharpEdges<'_>, vertex: VertexId) -> DVec3 {
        let (topology, here) = (self.mesh.topology(), self.at(vertex));
        match sharp.rule(vertex) {
            VertexRule::Smooth => smoothed(here, topology.ring(vertex).map(|v| self.at(v))),
            // As if the crease were not there: at odd levels its edge is the one that should have been flipped.
            VertexRule::Dart => {
                let ring = topology
                    .outgoing_ring(vertex)
                    .filter(|&h| !self.is_odd() || !sharp.is_sharp(h));
                smoothed(here, ring.map(|h| self.at(topology.target(h))))
            }
            VertexRule::Crease if self.is_odd() => {
                let mut along = sharp.neighbours(vertex).map(|v| self.on_even(v));
                match (along.next(), along.next()) {
                    (Some(before), Some(after)) => on_curve(here, [before, after]),
                    _ => here,
                }
            }
            VertexRule::Crease | VertexRule::Corner => here,
        }
    }

    /// Where a vertex of a curve was at the last even level.
    fn on_even(&self, vertex: VertexId) -> DVec3 {
        let dart = self.darts.binary_search_by_key(&vertex.0, |&(v, _)| v);
        dart.map_or_else(|_| self.at(vertex), |place| self.darts[place].1)
    }

    /// The new point next to `near` on the sharp edge to `far`.
    fn crease_point(&self, sharp: &SharpEdges<'_>, near: VertexId, far: VertexId) -> DVec3 {
        let (here, there) = (self.on_even(near), self.on_even(far));
        let other = || {
            sharp
                .neighbours(near)
                .find(|&v| v != far)
                .map(|v| self.on_even(v))
        };
        let beyond = (sharp.rule(near) == VertexRule::Crease)
            .then(other)
            .flatten();
        crease_point(beyond.unwrap_or(2.0 * here - there), here, there)
    }
}

/// Refuses two triangles on one another: where an interior vertex has two edges, the edges of a step coincide.
pub(super) fn check_valences(mesh: &Mesh) -> Result<(), MeshError> {
    let topology = mesh.topology();
    match topology
        .vertices()
        .find(|&v| topology.valence_and_openness(v) == (2, false))
    {
        None => Ok(()),
        Some(vertex) => Err(MeshError::Broken {
            place: vertex.to_string(),
            what: "√3-subdivision needs at least three edges at vertices inside the mesh",
        }),
    }
}

impl<'m> Numbering<'m> {
    fn new(
        mesh: &'m Mesh,
        sharp: &'m SharpEdges<'m>,
        cuts: bool,
        watch: &mut Watch<'_>,
    ) -> Result<Self, RefineError> {
        let topology = mesh.topology();
        let cut = match cuts {
            true => parallel::map_polled(mesh.face_count(), &mut |_| watch.poll(), |f| {
                sharp.corner_of(f)
            })?,
            false => vec![NO_CORNER; mesh.face_count()],
        };
        let mut next = mesh.vertex_count();
        let mut apexes = vec![[NONE; 2]; mesh.face_count()];
        for face in 0..apexes.len() {
            if cut[face] == NO_CORNER {
                apexes[face] = [next as u32; 2];
                next += 1;
                continue;
            }
            // The other side of a crease has these points in reverse order.
            let across = topology.twin(HalfEdgeId(3 * face as u32 + u32::from(cut[face])));
            match across
                .map(|twin| apexes[twin.face().index()])
                .filter(|known| known[0] != NONE)
            {
                Some([l, r]) => apexes[face] = [r, l],
                None => {
                    apexes[face] = [next as u32, next as u32 + 1];
                    next += 2;
                }
            }
        }
        if next > NONE as usize {
            let limit = NONE as usize;
            return Err(MeshError::TooMany {
                what: "vertices",
                count: next,
                limit,
            }
            .into());
        }
        Ok(Self {
            topology,
            sharp,
            cut,
            apexes,
            vertex_count: next,
        })
    }

    /// The origin of each new vertex.
    fn made(&self) -> Vec<Made> {
        let mut next = self.topology.vertex_count() as u32;
        let mut made = Vec::with_capacity(self.vertex_count - next as usize);
        for (face, &apexes) in self.apexes.iter().enumerate() {
            // Others were there already, for the other side of a crease.
            if apexes[0] == next {
                let face = face as u32;
                match self.cut_edge(HalfEdgeId(3 * face)) {
                    None => made.push(Made::Centre(face)),
                    Some(h) => made.extend([Made::NearOrigin(h), Made::NearTarget(h)]),
                }
                next = apexes[1] + 1;
            }
        }
        made
    }

    /// The half-edge of the face of `h` that is cut.
    fn cut_edge(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let corner = self.cut[h.face().index()];
        (corner != NO_CORNER).then(|| HalfEdgeId::of(h.face(), corner.into()))
    }

    /// The apex of the face of `h` seen from across `h`.
    fn apex(&self, h: HalfEdgeId) -> u32 {
        let after_cut = self.cut_edge(h).is_some_and(|s| s.next() == h);
        self.apexes[h.face().index()][usize::from(after_cut)]
    }

    /// The half-edge across `h`, if that is smooth.
    fn across(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.topology.twin(h).filter(|_| !self.sharp.is_sharp(h))
    }

    /// The three parts of a sharp edge that is cut, in its direction, as half-edges of the next level.
    fn parts(&self, s: HalfEdgeId) -> [Option<u32>; 3] {
        [
            self.across(s.previous()).map(|w| 3 * w.0),
            Some(3 * s.0),
            Some(3 * s.next().0 + 2),
        ]
    }

    /// The face across part `part` of a sharp edge that is cut.
    fn across_part(&self, s: HalfEdgeId, part: usize) -> Option<u32> {
        self.parts(self.topology.twin(s)?)[2 - part]
    }

    /// The face that `h` gives.
    fn triangle(&self, h: HalfEdgeId) -> [u32; 3] {
        let [a, b] = self.topology.ends(h).map(|v| v.0);
        match self.across(h) {
            Some(twin) => [a, self.apex(twin), self.apex(h)],
            None if self.cut_edge(h) == Some(h) => {
                let [l, r] = self.apexes[h.face().index()];
                [l, r, self.topology.opposite(h).0]
            }
            None => [a, b, self.apex(h)],
        }
    }

    /// The twins of the three half-edges of that face.
    fn twins(&self, h: HalfEdgeId) -> [Option<u32>; 3] {
        let before = h.previous();
        // Child of the face across the edge before, or that edge's own child where it is sharp.
        let last = || self.across(before).map_or(3 * before.0 + 1, |w| 3 * w.0);
        if let Some(twin) = self.across(h) {
            let first = match self.cut_edge(twin) {
                Some(s) if s.next() == twin => Some(3 * s.0 + 1),
                Some(s) => self.across_part(s, 0),
                None => Some(3 * twin.next().0 + 2),
            };
            let last = match self.cut_edge(h) {
                Some(s) if s.next() == h => self.across_part(s, 2),
                Some(s) => Some(3 * s.0 + 2),
                None => Some(last()),
            };
            return [first, Some(3 * twin.0 + 1), last];
        }
        if self.cut_edge(h) == Some(h) {
            let after = self.across(h.next()).map(|w| 3 * w.0);
            return [self.across_part(h, 1), after, Some(3 * before.0 + 2)];
        }
        [
            self.topology.twin(h).map(|twin| 3 * twin.0),
            Some(3 * h.next().0 + 2),
            Some(last()),
        ]
    }

    fn connect(&self, watch: &mut Watch<'_>) -> Result<Topology, Cancelled> {
        let half_edges = self.topology.half_edge_count();
        let triangle = |h: usize| self.triangle(HalfEdgeId(h as u32));
        let triangles: Vec<[u32; 3]> =
            parallel::map_polled(half_edges, &mut |_| watch.poll(), triangle)?;
        let twins = parallel::map_polled(half_edges, &mut |_| watch.poll(), |h| {
            self.twins(HalfEdgeId(h as u32))
                .map(|twin| twin.unwrap_or(NONE))
        })?;
        let twins = twins.into_flattened();
        let outgoing = outgoing_half_edges(&triangles, &twins, self.vertex_count);
        Ok(Topology::from_parts(triangles, twins, outgoing))
    }

    /// The tags of the next level: a crease is one of its parts.
    fn tags(&self, tags: &Tags) -> Tags {
        let mut next = Tags {
            creases: Vec::new(),
            corners: tags.corners.clone(),
        };
        for tag in tags.creases.iter().filter(|tag| tag.sharpness > 0.0) {
            let [a, b] = tag.vertices.map(VertexId);
            let h = self.topology.edge_between(a, b);
            let Some(h) = h.filter(|&h| self.cut_edge(h) == Some(h)) else {
                next.creases.push(*tag);
                continue;
            };
            let [[a, b], [l, r]] = [
                self.topology.ends(h).map(|v| v.0),
                self.apexes[h.face().index()],
            ];
            let parts = [[a, l], [l, r], [r, b]];
            next.creases
                .extend(parts.map(|vertices| CreaseTag { vertices, ..*tag }));
        }
        next
    }

    /// Copies of the vertices and edges along which sheets were cut apart.
    fn junctions(&self, junctions: &Junctions) -> Junctions {
        let mut next = Junctions {
            vertices: junctions.vertices.clone(),
            edges: Groups::default(),
        };
        let first = junctions.first_copies();
        let place = |v: u32| first.get(&v).copied().unwrap_or(v);
        for group in junctions.edges.iter() {
            let members = || group.iter().map(|&h| HalfEdgeId(h));
            let Some(first) = members().next() else {
                continue;
            };
            if self.cut_edge(first) != Some(first) {
                next.edges.push(members().map(|h| 3 * h.0));
                continue;
            }
            // Sheets may run along the edge either way.
            let start = place(self.topology.origin(first).0);
            let turned = |h: HalfEdgeId| place(self.topology.origin(h).0) != start;
            for end in 0..2 {
                let point = |h: HalfEdgeId| {
                    self.apexes[h.face().index()][if turned(h) { 1 - end } else { end }]
                };
                next.vertices.push(members().map(point));
            }
            for part in 0..3 {
                let of = |h: HalfEdgeId| self.parts(h)[if turned(h) { 2 - part } else { part }];
                next.edges.push(members().filter_map(of));
            }
        }
        next
    }
}
