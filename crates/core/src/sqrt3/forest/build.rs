//! A forest of control faces: cut open along sharp edges, each side with vertices of its own.

use std::collections::{BTreeMap, HashMap};

use super::places::Dart;
use super::rims::{Group, Rims};
use super::{Forest, Kind, Node, Side, Vertex};
use crate::geometry::NONE;
use crate::index::{HalfEdgeId, VertexId};
use crate::limit::LimitTable;
use crate::mesh::{Mesh, Sharpness};
use crate::refine::RefineError;
use crate::ring::VertexRule;
use crate::sqrt3::masks::{DoubleStep, shrinking};
use crate::sqrt3::origins::of_control;
use crate::sqrt3::sharp_edges::SharpEdges;
use crate::sqrt3::step::check_valences;
use crate::vector::{DVec3, vector};

impl<'m> Forest<'m> {
    /// The control faces alone.
    ///
    /// # Errors
    /// A semi-sharp tag, an interior vertex of two edges, or a vertex without a limit.
    pub(in crate::sqrt3) fn new(
        control: &'m Mesh,
        origins: bool,
        max_triangles: usize,
    ) -> Result<Self, RefineError> {
        let sharp = SharpEdges::of(control)?;
        check_valences(control)?;
        let table = LimitTable::new(&DoubleStep);
        let mut limits = table.positions(control)?;
        // Copies where sheets were cut apart have the same bits, whatever the order of their rings.
        for copies in control.junctions().vertices.iter() {
            copies
                .iter()
                .for_each(|&v| limits[v as usize] = limits[copies[0] as usize]);
        }
        let normals = table.plane_normals(control, &mut |_| Ok(()))??;
        let mut forest = Self {
            control,
            nodes: Vec::with_capacity(control.face_count()),
            vertices: Vec::with_capacity(control.vertex_count()),
            rims: Rims::default(),
            rim_of: HashMap::new(),
            smoothed: BTreeMap::new(),
            darts: Vec::new(),
            origins: origins.then(Vec::new),
            normals,
            triangles: control.face_count(),
            max_triangles,
            fresh: Vec::new(),
        };
        let corners = forest.add_vertices(&sharp, &limits);
        for (face, corners) in corners.as_chunks::<3>().0.iter().enumerate() {
            forest.add_face(face, *corners, &sharp);
        }
        forest.add_rims(&sharp);
        Ok(forest)
    }

    /// A vertex for each side of sharp edges at each vertex; gives that of each half-edge's origin.
    fn add_vertices(&mut self, sharp: &SharpEdges<'_>, limits: &[[f64; 3]]) -> Vec<u32> {
        let topology = self.control.topology();
        let sharpness = Sharpness::of(self.control);
        let mut of_corner = vec![NONE; topology.half_edge_count()];
        for v in topology.vertices() {
            let at = vector(self.control.positions()[v.index()]);
            let kind = match sharp.rule(v) {
                VertexRule::Smooth => Kind::Smooth(shrinking(topology.valence_and_openness(v).0)),
                VertexRule::Crease => Kind::Curve,
                VertexRule::Corner => Kind::Corner,
                VertexRule::Dart => Kind::Dart(self.add_dart(sharp, v, at)),
            };
            let first = self.vertices.len() as u32;
            let sides: Vec<Vec<HalfEdgeId>> = match sharpness.is_tagged(v) {
                true => sharpness
                    .sectors(v)
                    .iter()
                    .map(|sector| sector.outgoing(topology).collect())
                    .collect(),
                false => vec![topology.outgoing_ring(v).collect()],
            };
            for side in sides {
                let number = self.vertices.len() as u32;
                let normal = side
                    .first()
                    .map_or(DVec3::ZERO, |&h| vector(self.normals.at(topology, h)));
                side.into_iter().for_each(|h| of_corner[h.index()] = number);
                let limit = Some(vector(limits[v.index()]));
                let maker = v.0;
                self.vertices.push(Vertex {
                    kind,
                    level: 0,
                    at,
                    maker,
                    limit,
                    normal: Some(normal),
                    first,
                });
                if let Some(origins) = &mut self.origins {
                    origins.push(of_control(self.control, v));
                }
            }
        }
        of_corner
    }

    fn add_dart(&mut self, sharp: &SharpEdges<'_>, v: VertexId, at: DVec3) -> u32 {
        let topology = self.control.topology();
        let place = |h: HalfEdgeId| vector(self.control.positions()[topology.target(h).index()]);
        // The one sharp edge comes first.
        let is_before = |h: &HalfEdgeId| !sharp.is_sharp(*h);
        let outgoing = || topology.outgoing_ring(v);
        let ring = outgoing()
            .skip_while(is_before)
            .chain(outgoing().take_while(is_before))
            .map(place)
            .collect();
        self.darts.push(Dart {
            rings: vec![(at, ring)],
        });
        self.darts.len() as u32 - 1
    }

    fn add_face(&mut self, face: usize, corners: [u32; 3], sharp: &SharpEdges<'_>) {
        let topology = self.control.topology();
        let half_edges = [0, 1, 2].map(|corner| HalfEdgeId((3 * face + corner) as u32));
        let mut bits = 0;
        let across = half_edges.map(|h| {
            let is_sharp = sharp.is_sharp(h);
            bits |= u8::from(is_sharp) << h.corner();
            topology
                .twin(h)
                .filter(|_| !is_sharp)
                .map_or(NONE, |twin| twin.0)
        });
        let (children, apexes) = ([NONE; 3], [NONE; 2]);
        self.nodes.push(Node {
            corners,
            across,
            children,
            parent: NONE,
            apexes,
            root: face as u32,
            level: 0,
            sharp: bits,
            is_split: false,
        });
    }

    /// Sharp edges with all their sides: both of a crease, one of a boundary, all copies of an edge that was cut.
    fn add_rims(&mut self, sharp: &SharpEdges<'_>) {
        let (topology, junctions) = (self.control.topology(), self.control.junctions());
        let first_copies = junctions.first_copies();
        let place = |h: HalfEdgeId| {
            let v = topology.origin(h).0;
            first_copies.get(&v).copied().unwrap_or(v)
        };
        for copies in junctions.edges.iter() {
            let start = copies.first().map(|&h| place(HalfEdgeId(h)));
            let sides = copies
                .iter()
                .map(|&h| (h, Some(place(HalfEdgeId(h))) != start))
                .collect();
            self.add_rim(Group {
                sides,
                is_crease: false,
            });
        }
        for h in topology.half_edges().filter(|&h| sharp.is_sharp(h)) {
            if self.rim_of.contains_key(&h.0) {
                continue;
            }
            let sides: Vec<(Side, bool)> = [(h.0, false)]
                .into_iter()
                .chain(topology.twin(h).map(|twin| (twin.0, true)))
                .collect();
            let is_crease = sides.len() > 1;
            self.add_rim(Group { sides, is_crease });
        }
    }

    fn add_rim(&mut self, group: Group) {
        let ends = group.sides.iter().map(|&(h, turned)| {
            let [a, b] = self.ends(h);
            if turned { [b, a] } else { [a, b] }
        });
        let ends = ends.collect();
        let sides: Vec<Side> = group.sides.iter().map(|&(h, _)| h).collect();
        let rim = self.rims.add(group, ends);
        for (number, h) in sides.into_iter().enumerate() {
            self.rim_of.insert(h, (rim, number as u32));
        }
    }
}
