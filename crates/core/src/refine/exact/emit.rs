//! Emits the leaves as a conforming mesh: the closure patterns of the paper's Figure 5, connected by table.

use super::forest::Forest;
use super::grow::Growth;
use super::options::{Exact, ExactStop, Origin};
use crate::certificate::TriangleFrame;
use crate::criterion::Region;
use crate::emit::{Diagonal, Pattern, closure};
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::{
    CreaseTag, Groups, INFINITELY_SHARP, Junctions, Mesh, NONE, Tags, Topology, check_finite,
    outgoing_half_edges,
};
use crate::parallel;
use crate::refine::RefineError;
use crate::refine::junctions::join_copies;
use crate::vector::vector;

/// What rounding may do to an angle against its limit, relative: normals are taken anew from what is emitted.
const CONE_ROUNDING: f64 = 1e-6;

/// The emitted triangles.
pub(super) struct Emission {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Twins of their half-edges.
    pub(super) twins: Vec<u32>,
    pub(super) leaves: Leaves,
}

impl Emission {
    /// The triangles of the leaves as they stand.
    pub(super) fn of(growth: &Growth<'_>) -> Self {
        let leaves = growth.leaves();
        let (triangles, twins) = growth.connect(&leaves);
        Self { triangles, twins, leaves }
    }
}

/// The leaves in the order of the control faces, and where each one's triangles start.
pub(super) struct Leaves {
    pub(super) order: Vec<u32>,
    /// By node: its first triangle.
    pub(super) starts: Vec<u32>,
    /// The control face of each leaf in `order`.
    pub(super) roots: Vec<u32>,
}

impl Growth<'_> {
    /// The mesh as it stands.
    pub(super) fn finish(mut self, stop: ExactStop, emission: Emission) -> Result<Exact, RefineError> {
        let junctions = self.junctions(&emission);
        let mut positions: Vec<[f64; 3]> =
            (0..self.points.len()).map(|vertex| self.emitted(vertex as u32).to_array()).collect();
        join_copies(&mut positions, &junctions.vertices);
        check_finite(&positions)?;
        // Before bounds are tightened for lengths, which may do worse in pictures.
        let pixels = self.pixels(&emission);
        let error = self.probe(&emission)?;
        let failed = self.options.tolerance.filter(|&tolerance| error.upper > tolerance);
        let stop = if stop == ExactStop::Met && failed.is_some() { ExactStop::Rounding } else { stop };
        let beyond = failed.map_or(0.0, |tolerance| error.upper / tolerance);
        let (tags, sides) = (self.tags(&emission), self.sides(&emission));
        self.check_rules()?;
        let Emission { triangles, twins, leaves } = emission;
        let parents = leaves.parents(&self.forest, |leaf| self.pattern(leaf));
        let origins = self.origins();
        let outgoing = outgoing_half_edges(&triangles, &twins, self.forest.vertex_count());
        let topology = Topology::from_parts(triangles, twins, outgoing);
        let mut exact = Exact {
            mesh: Mesh::from_parts(topology, positions, tags, junctions),
            normals: self.points.iter().map(|point| point.normal.to_array()).collect(),
            sides,
            origins,
            parents,
            error,
            pixels,
            open_cones: 0,
            worst: if self.criteria.is_some() { self.worst_value().max(beyond) } else { 0.0 },
            stop,
            levels: (0..self.forest.node_count() as u32)
                .map(|node| self.forest.level(node))
                .max()
                .unwrap_or(0),
            refused: 0,
        };
        exact.open_cones = self.open_cones(&exact);
        if exact.open_cones > 0 && exact.stop == ExactStop::Met {
            exact.stop = ExactStop::Cones;
        }
        Ok(exact)
    }

    /// Triangles outside their cones.
    fn open_cones(&self, exact: &Exact) -> usize {
        if self.options.angle.is_none() {
            return 0;
        }
        let surface = exact.mesh.as_triangles();
        let is_open = |face: usize| {
            let corners = surface.corners(face).map(vector);
            let normals = [0, 1, 2].map(|corner| HalfEdgeId::of(FaceId(face as u32), corner));
            let normals = normals.map(|corner| vector(exact.corner_normal(corner)));
            let frame = TriangleFrame::new(corners);
            let tilt = normals.iter().map(|normal| normal.distance(frame.normal())).fold(0.0, f64::max);
            let region = Region::around(corners, frame.normal()).turned(2.0 * tilt);
            self.criteria.cone_ratio(frame.normal(), normals, &region) > 1.0 + CONE_ROUNDING
        };
        parallel::map(exact.mesh.face_count(), is_open).into_iter().filter(|&is_open| is_open).count()
    }

    pub(super) fn pattern(&self, leaf: u32) -> &'static Pattern {
        let diagonal = if self.diagonals[leaf as usize] { Diagonal::FromEnd } else { Diagonal::FromStart };
        closure(self.forest.split_edges(leaf), diagonal)
    }

    fn leaves(&self) -> Leaves {
        let forest = &self.forest;
        let mut leaves =
            Leaves { order: Vec::new(), starts: vec![NONE; forest.node_count()], roots: Vec::new() };
        let mut count = 0u32;
        let mut stack = Vec::new();
        for root in 0..forest.roots() as u32 {
            stack.push(root);
            while let Some(node) = stack.pop() {
                if let Some(first) = forest.children(node) {
                    stack.extend((first..first + 4).rev());
                    continue;
                }
                leaves.order.push(node);
                leaves.roots.push(root);
                leaves.starts[node as usize] = count;
                count += 1 + forest.split_edges(node).count_ones();
            }
        }
        leaves
    }

    /// Triangles and twins of their half-edges.
    fn connect(&self, leaves: &Leaves) -> (Vec<[u32; 3]>, Vec<u32>) {
        let forest = &self.forest;
        let total = forest.triangle_count();
        let mut triangles = Vec::with_capacity(total);
        let mut twins = vec![NONE; 3 * total];
        for &leaf in &leaves.order {
            let pattern = self.pattern(leaf);
            let [a, b, c] = forest.corners(leaf);
            let [d, e, f] = [0, 1, 2].map(|edge| forest.middle(leaf, edge).unwrap_or(NONE));
            let labels = [a, b, c, d, e, f];
            triangles
                .extend(pattern.triangles().iter().map(|triangle| triangle.map(|at| labels[at as usize])));
            let base = 3 * leaves.starts[leaf as usize];
            for h in 0..3 * pattern.triangles().len() {
                if let Some(twin) = pattern.twin(h) {
                    twins[base as usize + h] = base + twin as u32;
                }
            }
            for edge in 0..3 {
                let Some(twin) = forest.twin(leaf, edge) else { continue };
                let (other, side) = (twin / 3, twin as usize % 3);
                let own = pattern.border(edge).map(|h| base + h as u32);
                match forest.children(other) {
                    None => join(&mut twins, own[0], self.border(leaves, other, side)),
                    Some(first) => {
                        let next = first + (side as u32 + 1) % 3;
                        join(&mut twins, own[0], self.border(leaves, next, side));
                        join(&mut twins, own[1], self.border(leaves, first + side as u32, side));
                    }
                }
            }
        }
        (triangles, twins)
    }

    /// The half-edges of the emitted triangles along an edge of a leaf: twice the same where it is not split.
    pub(super) fn borders(&self, leaves: &Leaves, leaf: u32, edge: usize) -> [u32; 2] {
        self.pattern(leaf).border(edge).map(|h| 3 * leaves.starts[leaf as usize] + h as u32)
    }

    /// The half-edge of the emitted triangles along an edge of a leaf that is not split.
    fn border(&self, leaves: &Leaves, leaf: u32, edge: usize) -> u32 {
        3 * leaves.starts[leaf as usize] + self.pattern(leaf).border(edge)[0] as u32
    }

    /// The copies of vertices and edges of cut sheets, whose trees are split alike.
    fn junctions(&self, emission: &Emission) -> Junctions {
        let control = self.control.junctions();
        let mut junctions = Junctions { vertices: control.vertices.clone(), edges: Groups::default() };
        let start = |h: u32| self.control.positions()[self.control.topology().origin(HalfEdgeId(h)).index()];
        for group in control.edges.iter() {
            let along: Vec<(Vec<u32>, Vec<u32>)> = group
                .iter()
                .map(|&h| {
                    let (mut vertices, mut half_edges) = (Vec::new(), Vec::new());
                    self.along(&emission.leaves, h / 3, h as usize % 3, &mut vertices, &mut half_edges);
                    if start(h) != start(group[0]) {
                        vertices.reverse();
                        half_edges.reverse();
                    }
                    (vertices, half_edges)
                })
                .collect();
            let least = |list: fn(&(Vec<u32>, Vec<u32>)) -> usize| along.iter().map(list).min().unwrap_or(0);
            for place in 0..least(|(vertices, _)| vertices.len()) {
                junctions.vertices.push(along.iter().map(|(vertices, _)| vertices[place]));
            }
            for place in 0..least(|(_, half_edges)| half_edges.len()) {
                junctions.edges.push(along.iter().map(|(_, half_edges)| half_edges[place]));
            }
        }
        junctions
    }

    /// The vertices inside a boundary edge of a node and the emitted half-edges along it, from its start to its end.
    fn along(
        &self,
        leaves: &Leaves,
        node: u32,
        edge: usize,
        vertices: &mut Vec<u32>,
        half_edges: &mut Vec<u32>,
    ) {
        let Some(first) = self.forest.children(node) else {
            half_edges.push(self.border(leaves, node, edge));
            return;
        };
        let next = (edge + 1) % 3;
        self.along(leaves, first + edge as u32, edge, vertices, half_edges);
        vertices.push(self.forest.corners(first + edge as u32)[next]);
        self.along(leaves, first + next as u32, edge, vertices, half_edges);
    }

    /// The tags of the emitted mesh: creases along those of the control mesh, and its corners.
    pub(super) fn tags(&self, emission: &Emission) -> Tags {
        let corners = self.control.tags().corners.iter().filter(|tag| tag.sharpness >= INFINITELY_SHARP);
        let mut tags = Tags { corners: corners.copied().collect(), ..Tags::default() };
        if self.lasting.is_empty() {
            return tags;
        }
        for &leaf in &emission.leaves.order {
            let open = self.forest.open_edges(leaf);
            for edge in (0..3).filter(|&edge| open[edge]) {
                let [first, second] = self.borders(&emission.leaves, leaf, edge);
                let halves = [Some(first), (second != first).then_some(second)];
                for h in halves.into_iter().flatten() {
                    // Each is met from both sides; boundaries have one only.
                    let twin = emission.twins[h as usize];
                    if twin != NONE && h < twin {
                        let triangle = emission.triangles[h as usize / 3];
                        let ends = [0, 1].map(|i| triangle[(h as usize + i) % 3]);
                        tags.creases.push(CreaseTag { vertices: ends, sharpness: INFINITELY_SHARP });
                    }
                }
            }
        }
        tags
    }

    /// Where the vertices came from.
    fn origins(&self) -> Vec<Origin> {
        const NOWHERE: Origin = Origin { face: NONE, barycentric: [0.0; 3] };
        let mut origins = vec![NOWHERE; self.forest.vertex_count()];
        for root in 0..self.forest.roots() as u32 {
            let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            self.place(root, root, corners, &mut origins);
        }
        origins
    }

    fn place(&self, root: u32, node: u32, corners: [[f64; 3]; 3], origins: &mut [Origin]) {
        for (vertex, barycentric) in self.forest.corners(node).into_iter().zip(corners) {
            let origin = &mut origins[vertex as usize];
            if origin.face == NONE {
                *origin = Origin { face: root, barycentric };
            }
        }
        let Some(first) = self.forest.children(node) else { return };
        let middle = |edge: usize| {
            let (a, b) = (corners[edge], corners[(edge + 1) % 3]);
            [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]))
        };
        for part in 0..3 {
            let mut own = corners;
            own[(part + 1) % 3] = middle(part);
            own[(part + 2) % 3] = middle((part + 2) % 3);
            self.place(root, first + part as u32, own, origins);
        }
        self.place(root, first + 3, [middle(1), middle(2), middle(0)], origins);
    }
}

impl Leaves {
    /// The control face of each triangle.
    fn parents(&self, forest: &Forest, pattern: impl Fn(u32) -> &'static Pattern) -> Vec<u32> {
        let mut parents = Vec::with_capacity(forest.triangle_count());
        for (&leaf, &root) in self.order.iter().zip(&self.roots) {
            parents.extend(core::iter::repeat_n(root, pattern(leaf).triangles().len()));
        }
        parents
    }
}

fn join(twins: &mut [u32], a: u32, b: u32) {
    twins[a as usize] = b;
    twins[b as usize] = a;
}
