//! How well the leaves stand for the limit surface, as they would be emitted, and where new vertices lie.
//!
//! Takes the leaves that are new or whose closure changed; walks down to them from their control faces, refining the
//! patches on the way, so that no points of any level need be kept.

use super::forest::Forest;
use super::leaf::{LeafTriangle, leaf_triangles};
use crate::certificate::{Deviation, Effort, Pieces, Samples, SubTriangle, TriangleFrame};
use crate::criterion::{Criteria, Region};
use crate::index::{FaceId, HalfEdgeId};
use crate::limit::SidedNormals;
use crate::mesh::{Mesh, Sharpness};
use crate::parallel;
use crate::patch::large_rings::LargeRings;
use crate::patch::{LimitPoint, Patch, Rules, root_patch};
use crate::vector::{DVec3, vector};

/// Control faces that one call takes together: enough to outweigh the call, few enough to share the work evenly.
const BLOCK: usize = 64;

/// Set for a leaf that is to be evaluated.
pub(super) const WANTED: u8 = 1;
/// Set for a node with such a leaf below it.
pub(super) const ABOVE_WANTED: u8 = 2;

/// What an evaluation found.
#[derive(Default)]
pub(super) struct Found {
    pub(super) leaves: Vec<Leaf>,
    /// Limits of vertices that had none yet.
    pub(super) points: Vec<(u32, LimitPoint)>,
}

/// The value of a leaf: how many times over it fails the criteria.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub(super) node: u32,
    pub(super) value: f64,
    /// What a distance in any direction is multiplied by at most.
    pub(super) scale: f64,
    pub(super) deviation: Deviation,
    /// The diagonal by which a leaf with two split edges is cut starts at the unsplit edge's end.
    pub(super) diagonal_from_end: bool,
}

/// What a triangle of a leaf comes to.
#[derive(Clone, Copy)]
struct Value {
    value: f64,
    /// What a distance in any direction is multiplied by at most.
    scale: f64,
    deviation: Deviation,
    /// The chord of the greatest angle between its normal and the limit normals at its corners.
    tilt: f64,
}

/// What an evaluation looks at.
pub(super) struct Evaluation<'a> {
    pub(super) control: &'a Mesh,
    pub(super) sharpness: &'a Sharpness<'a>,
    /// Whether normals may differ from side to side.
    pub(super) has_sides: bool,
    /// Limit normals of the control vertices.
    pub(super) sided: &'a SidedNormals,
    pub(super) rules: &'a Rules<'a>,
    pub(super) forest: &'a Forest,
    /// Limits of the vertices; positions that are not a number are not known yet.
    pub(super) points: &'a [LimitPoint],
    /// How far vertices are moved along their normals; empty where none is.
    pub(super) offsets: &'a [f64],
    pub(super) marks: &'a [u8],
    pub(super) criteria: &'a Criteria,
    /// Values at or below this need not be told apart.
    pub(super) target: f64,
    /// How often regular pieces may be halved to tighten a bound.
    pub(super) halvings: usize,
    /// By node, the diagonals that must be kept.
    pub(super) fixed: Option<&'a [bool]>,
}

impl Evaluation<'_> {
    /// Evaluates all wanted leaves below the given control faces, in their order.
    pub(super) fn run(&self, roots: &[u32]) -> Vec<Found> {
        parallel::pieces_of(roots.len(), BLOCK, |block| {
            let mut found = Found::default();
            for &root in &roots[block] {
                let patch = root_patch(
                    self.control,
                    self.sharpness,
                    &LargeRings::default(),
                    FaceId(root),
                    self.rules,
                );
                let corners = [0, 1, 2].map(|corner| {
                    let h = HalfEdgeId::of(FaceId(root), corner);
                    let normal = vector(self.sided.at(self.control.topology(), h));
                    LimitPoint { normal, ..self.known(self.forest.corners(root)[corner]) }
                });
                self.visit(root, &patch, corners, &mut found);
            }
            found
        })
    }

    fn visit(&self, node: u32, patch: &Patch, corners: [LimitPoint; 3], found: &mut Found) {
        let Some(first) = self.forest.children(node) else {
            if self.marks[node as usize] & WANTED != 0 {
                self.leaf(node, patch, corners, found);
            }
            return;
        };
        let refined = patch.refined(self.rules);
        let middles = [0, 1, 2].map(|edge| {
            let vertex = self.forest.corners(first + edge as u32)[(edge + 1) % 3];
            self.limit(vertex, || refined.middle(edge), found)
        });
        for part in 0..4 {
            let child = first + part as u32;
            if self.marks[child as usize] == 0 {
                continue;
            }
            let mut own = [middles[1], middles[2], middles[0]];
            if part < 3 {
                own[part] = corners[part];
                own[(part + 1) % 3] = middles[part];
                own[(part + 2) % 3] = middles[(part + 2) % 3];
            }
            self.visit(child, &refined.part(part), own, found);
        }
    }

    /// A vertex as it is known, at the place where it is emitted.
    #[inline]
    fn known(&self, vertex: u32) -> LimitPoint {
        let point = self.points[vertex as usize];
        match self.offsets.get(vertex as usize) {
            Some(&offset) => LimitPoint { position: point.position + offset * point.normal, ..point },
            None => point,
        }
    }

    /// How far the corners of a leaf and the vertices on its edges are from the surface at most.
    fn moved(&self, node: u32) -> f64 {
        if self.offsets.is_empty() {
            return 0.0;
        }
        let middles = (0..3).filter_map(|edge| self.forest.middle(node, edge));
        let vertices = self.forest.corners(node).into_iter().chain(middles);
        vertices.filter_map(|v| self.offsets.get(v as usize)).fold(0.0, |most, offset| most.max(offset.abs()))
    }

    /// The limit of a vertex: as it is known, with the normal on this side where that matters.
    fn limit(&self, vertex: u32, compute: impl FnOnce() -> LimitPoint, found: &mut Found) -> LimitPoint {
        let known = self.known(vertex);
        if known.position.is_nan() {
            let computed = compute();
            found.points.push((vertex, computed));
            computed
        } else if self.criteria.needs_normals() || self.has_sides {
            LimitPoint { normal: compute().normal, ..known }
        } else {
            known
        }
    }

    fn leaf(&self, node: u32, patch: &Patch, corners: [LimitPoint; 3], found: &mut Found) {
        let split = self.forest.split_edges(node);
        let mut pieces = Pieces::of(patch);
        // The corners, then the middles of the edges that are split.
        let [a, b, c] = corners;
        let mut points = [a, b, c, a, b, c];
        let mut middles = [None; 3];
        for edge in (0..3).filter(|edge| split & 1 << edge != 0) {
            if let Some(vertex) = self.forest.middle(node, edge) {
                points[3 + edge] = self.limit(vertex, || pieces.refined(self.rules).middle(edge), found);
                middles[edge] = Some(3 + edge);
            }
        }
        let open = self.forest.open_edges(node);
        let is_cone_given_up = self.forest.level(node) >= self.criteria.deepest_cone();
        let mut best: Option<Leaf> = None;
        let is_choice = split.count_ones() == 2;
        let fixed = self.fixed.filter(|_| is_choice).map(|fixed| fixed[node as usize]);
        let mut tilt = 0.0f64;
        // What the triangle comes to that both diagonals leave as it is.
        let mut cut_off: Option<Value> = None;
        for diagonal_from_end in [false, true] {
            if fixed.is_some_and(|fixed| fixed != diagonal_from_end) {
                continue;
            }
            let mut leaf =
                Leaf { node, value: 0.0, scale: 0.0, deviation: Deviation::default(), diagonal_from_end };
            for triangle in leaf_triangles([0, 1, 2], middles, diagonal_from_end) {
                let LeafTriangle { part, corners, borders } = triangle;
                let is_shared = is_choice && matches!(part, SubTriangle::Child(_));
                let found = match cut_off {
                    Some(known) if is_shared => known,
                    _ => {
                        let corners = corners.map(|at| points[at]);
                        let open = borders.map(|border| border.is_some_and(|edge| open[edge]));
                        self.triangle(&mut pieces, part, corners, open, is_cone_given_up)
                    }
                };
                if is_shared {
                    cut_off = Some(found);
                }
                tilt = tilt.max(found.tilt);
                leaf.value = leaf.value.max(found.value);
                leaf.scale = leaf.scale.max(found.scale);
                leaf.deviation = leaf.deviation.max(found.deviation);
            }
            if best.is_none_or(|best| leaf.value < best.value) {
                best = Some(leaf);
            }
            if !is_choice || leaf.value <= self.target {
                break;
            }
        }
        // The surface's corners are that far from the triangles' own.
        let moved = self.moved(node);
        found.leaves.extend(best.map(|leaf| Leaf {
            value: leaf.value.max(moved * leaf.scale),
            deviation: leaf.deviation.off(moved, moved * tilt),
            ..leaf
        }));
    }

    /// The value of a triangle and its deviation from its part of the surface.
    fn triangle<'p>(
        &'p self,
        pieces: &mut Pieces<'p>,
        part: SubTriangle,
        corners: [LimitPoint; 3],
        open: [bool; 3],
        is_cone_given_up: bool,
    ) -> Value {
        let frame = TriangleFrame::new(corners.map(|point| point.position));
        let (tilt, slope) = expected(&frame, &corners);
        // The neighbour stands as far from the limit normals, on their other side.
        let chord = 2.0 * tilt;
        let region = Region::around(corners.map(|point| point.position), frame.normal()).turned(chord);
        let target = self.target * self.criteria.allowed_length(&region);
        let effort = Effort { target, halvings: self.halvings, open, chord, slope };
        let deviation = pieces.deviation(part, &frame, self.rules, effort);
        let region = region.grown(deviation.own);
        let scale = 1.0 / self.criteria.allowed_length(&region);
        let distance = self.criteria.distance_ratio(&deviation.apart(chord, slope), &region);
        let cone = self.criteria.cone_ratio(frame.normal(), corners.map(|point| point.normal), &region);
        let cone = if is_cone_given_up { cone.min(1.0) } else { cone };
        Value { value: distance.max(cone), scale, deviation, tilt }
    }
}

/// Points of the limit surface over leaves, for a lower bound: those at the given depth below each, corners left out.
impl Evaluation<'_> {
    pub(super) fn samples(&self, leaf: u32, depth: usize) -> Vec<DVec3> {
        let mut path = Vec::new();
        let mut node = leaf;
        while let Some((parent, place)) = self.forest.parent(node) {
            path.push(place);
            node = parent;
        }
        let mut patch =
            root_patch(self.control, self.sharpness, &LargeRings::default(), FaceId(node), self.rules);
        for place in path.into_iter().rev() {
            patch = patch.refined(self.rules).part(place);
        }
        if let Patch::Mesh(mesh) = &patch {
            return Samples::of(mesh, depth, self.rules).points();
        }
        let mut points = Vec::new();
        self.sample(&patch, depth, &mut points);
        points
    }

    fn sample(&self, patch: &Patch, depth: usize, points: &mut Vec<DVec3>) {
        let refined = patch.refined(self.rules);
        points.extend((0..3).map(|edge| refined.middle(edge).position));
        if depth > 1 {
            (0..4).for_each(|part| self.sample(&refined.part(part), depth - 1, points));
        }
    }
}

/// What the neighbours of a triangle are expected from: the greatest chord of the angles between its plane and the limit
/// normals at its corners, and the greatest slope of a drift, from its own angles.
fn expected(frame: &TriangleFrame, corners: &[LimitPoint; 3]) -> (f64, f64) {
    let squares = corners.iter().map(|corner| corner.normal.distance_squared(frame.normal()));
    (squares.fold(0.0, f64::max).sqrt(), frame.least_slope())
}
