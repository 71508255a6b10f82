//! The surroundings of a quad without their points: what a step of refinement makes of them is a linear map of the points, found once for
//! all surroundings of one form.
//!
//! Nearly all pieces at irregular vertices and tags are of a few forms after a step or two, whatever the control mesh is.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

use super::quads::{Connected, Quads, next, previous};
use super::ring::RingLimits;
use super::step::{Source, slot};
use crate::ring::VertexRule;
use crate::row::{Row, sum, summed};
use crate::vector::DVec3;

/// Forms that are kept at most.
const MOST_FORMS: usize = 1 << 12;

/// The surroundings of a quad, which is the first of some.
#[derive(Debug)]
pub(crate) struct QuadForm {
    quads: Quads,
    /// The sixteen points of a regular one, by row and column, each as weights of the points.
    pub(crate) grid: Option<[[Row; 4]; 4]>,
    step: OnceLock<Step>,
    settling: OnceLock<Option<Settling>>,
}

/// How surroundings of one form after another settle to an affine image of the characteristic map, at a smooth irregular vertex.
#[derive(Debug)]
pub(crate) struct Settling {
    /// The weights of the points of the vertex's limit, and of two tangents.
    pub(crate) functionals: [Row; 3],
    /// The map's points, which a step scales by a factor, with z = 0.
    pub(crate) map: Vec<DVec3>,
    /// How much longer differences from the map can become, at its size, where the longest of its points is 1.
    pub(crate) growth: f64,
    /// The least coefficient of the Jacobian of the map's regular pieces, by differences of their nets.
    pub(crate) least_jacobian: f64,
    /// The greatest coordinates of these differences.
    pub(crate) steepest: [f64; 2],
}

/// The result of a step.
#[derive(Debug)]
pub(crate) struct Step {
    /// Points after the step, by those before it.
    rows: Vec<Row>,
    /// The limits of the points in the middles of the half's edges, by points after the step.
    pub(crate) middles: [Middle; 3],
    parts: [(Arc<QuadForm>, Vec<u32>); 4],
}

/// The limit of a new vertex, on the quad's side.
#[derive(Debug)]
pub(crate) struct Middle {
    pub(crate) position: Row,
    pub(crate) tangents: Option<[Row; 2]>,
}

/// The forms that are known.
#[derive(Debug, Default)]
pub(crate) struct QuadForms(RwLock<HashMap<Quads, Arc<QuadForm>>>);

impl QuadForms {
    /// The form of some surroundings.
    pub(crate) fn of(&self, quads: Quads) -> Arc<QuadForm> {
        let known = self.0.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(form) = known.get(&quads) {
            return Arc::clone(form);
        }
        drop(known);
        let form = Arc::new(QuadForm {
            grid: grid(&quads),
            quads: quads.clone(),
            step: OnceLock::new(),
            settling: OnceLock::new(),
        });
        let mut known = self.0.write().unwrap_or_else(PoisonError::into_inner);
        if known.len() >= MOST_FORMS {
            return form;
        }
        Arc::clone(known.entry(quads).or_insert(form))
    }
}

impl QuadForm {
    /// How the surroundings settle, found once.
    pub(crate) fn settling(&self, find: impl FnOnce() -> Option<Settling>) -> Option<&Settling> {
        match self.settling.get() {
            Some(known) => known.as_ref(),
            None => {
                let found = find();
                self.settling.get_or_init(|| found).as_ref()
            }
        }
    }

    /// The limit of a smooth irregular vertex that a half-edge of the quad leaves, and two tangents, as weights of the points, and the
    /// number of its edges; `None` at vertices of other kinds.
    pub(crate) fn smooth_limits(&self, h: u32) -> Option<([Row; 3], usize)> {
        let (ring, points) = self.quads.ring(h);
        let is_smooth = ring.rule() == VertexRule::Smooth && ring.semi_sharpness() == 0.0;
        let limits = is_smooth.then(|| RingLimits::of(&ring))?;
        let [first, second] = limits.sides.into_iter().next()?.tangents?;
        let row = |weights: Vec<f64>| points.iter().copied().zip(weights).collect();
        let functionals = [limits.position, first, second].map(row);
        Some((functionals, ring.spokes.len()))
    }

    /// The corners of its quad.
    pub(crate) fn corners(&self) -> [u32; 4] {
        self.quads.corners[0]
    }

    /// The number of points.
    pub(crate) fn point_count(&self) -> usize {
        self.quads.vertex_count()
    }

    /// The result of a step.
    pub(crate) fn step(&self, forms: &QuadForms) -> &Step {
        match self.step.get() {
            Some(step) => step,
            None => {
                // Not while others wait: a thread that waits may hold what this needs.
                let step = Step::of(&self.quads, forms);
                self.step.get_or_init(|| step)
            }
        }
    }
}

impl Step {
    fn of(quads: &Quads, forms: &QuadForms) -> Self {
        let (after, edges) = quads.refined();
        // The half's parts: three at its corners, and the other half of the first.
        let parts = [0, 4, 12, 2].map(|first| after.surroundings(first));
        // The middles' rings are within the parts: numbers are given as points are met.
        let mut numbers: Vec<u32> = Vec::new();
        let mut number = |vertex: u32| match numbers.iter().position(|&known| known == vertex) {
            Some(number) => number as u32,
            None => {
                numbers.push(vertex);
                numbers.len() as u32 - 1
            }
        };
        let parts = parts.map(|(own, sources)| {
            let points: Vec<u32> = sources.into_iter().map(&mut number).collect();
            (forms.of(own), points)
        });
        // The new points on the first edge, in the quad, and on the last edge, as the first part leaves them.
        let middles = [1, 2, 3].map(|h| {
            let (ring, points) = after.ring(h);
            let limits = RingLimits::of(&ring);
            let mut row = |weights: &[f64]| {
                let own = points
                    .iter()
                    .zip(weights)
                    .filter(|(_, weight)| **weight != 0.0);
                summed(
                    own.map(|(&vertex, &weight)| (number(vertex), weight))
                        .collect(),
                )
            };
            let side = limits.side_of(slot(&after, h), ring.spokes.len());
            Middle {
                position: row(&limits.position),
                tangents: side.tangents.as_ref().map(|[a, b]| [row(a), row(b)]),
            }
        });
        let rows = numbers
            .iter()
            .map(|&vertex| Source::of(quads, &edges, vertex).row(quads))
            .collect();
        Self {
            rows,
            middles,
            parts,
        }
    }

    /// The points after the step.
    pub(crate) fn points(&self, before: &[DVec3]) -> Vec<DVec3> {
        self.rows.iter().map(|row| sum(row, before)).collect()
    }

    /// A part's form and its points, of those after the step.
    pub(crate) fn part(&self, part: usize, after: &[DVec3]) -> (Arc<QuadForm>, Vec<DVec3>) {
        let (form, points) = &self.parts[part];
        let points = points.iter().map(|&at| after[at as usize]).collect();
        (Arc::clone(form), points)
    }

    /// The part that has this form again.
    pub(crate) fn same(&self, form: &Arc<QuadForm>) -> Option<usize> {
        self.parts
            .iter()
            .position(|(own, _)| Arc::ptr_eq(own, form))
    }

    /// Whether a part is regular.
    pub(crate) fn is_regular(&self, part: usize) -> bool {
        self.parts[part].0.grid.is_some()
    }
}

/// Whether the surface is regular at a corner of a quad.
fn is_regular_corner(quads: &Quads, h: u32) -> bool {
    let (ring, _) = quads.ring(h);
    if ring.semi_sharpness() > 0.0 {
        return false;
    }
    let edges = ring.spokes.len();
    let slot = slot(quads, h);
    let sector = ring.sectors().into_iter().find(|sector| {
        let place = (slot + edges - sector.first) % edges;
        place < sector.shape.faces() as usize
    });
    sector.is_some_and(|sector| match (ring.rule(), sector.shape.valence) {
        (VertexRule::Smooth, valence) => valence == 4,
        (VertexRule::Crease, valence) => valence == 3 && sector.shape.open,
        (VertexRule::Corner, valence) => valence == 2 && sector.shape.open,
        (VertexRule::Dart, _) => false,
    })
}

/// The points of a regular quad.
fn grid(quads: &Quads) -> Option<[[Row; 4]; 4]> {
    if !(0..4).all(|h| is_regular_corner(quads, h)) {
        return None;
    }
    // By corner: its own place, the steps along the edge from it, and across that edge out of the quad.
    let places: [[i32; 2]; 4] = [[1, 1], [2, 1], [2, 2], [1, 2]];
    let along: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
    let mut grid: [[Option<Row>; 4]; 4] = Default::default();
    let mut set =
        |[u, v]: [i32; 2], vertex: u32| grid[v as usize][u as usize] = Some(vec![(vertex, 1.0)]);
    for h in 0..4u32 {
        let [x, y] = along[h as usize];
        let ([u, v], out) = (places[h as usize], [y, -x]);
        set([u, v], quads.origin(h));
        let Some(twin) = quads.twin(h).filter(|_| quads.edge(h) == 0.0) else {
            continue;
        };
        // Beyond the edge: the twin starts at its end.
        let beyond = [next(next(twin)), previous(twin)].map(|h| quads.origin(h));
        set([u + out[0], v + out[1]], beyond[0]);
        set([u + x + out[0], v + y + out[1]], beyond[1]);
        // Beyond the corner as well, across the edge of the quad that was reached.
        let side = next(twin);
        if let Some(other) = quads.twin(side).filter(|_| quads.edge(side) == 0.0) {
            set(
                [u + out[0] - x, v + out[1] - y],
                quads.origin(previous(other)),
            );
        }
    }
    mirrored(grid)
}

/// Fills in the points beyond sharp edges: mirror images.
fn mirrored(mut grid: [[Option<Row>; 4]; 4]) -> Option<[[Row; 4]; 4]> {
    let image = |near: &Row, far: &Row| {
        let near = near.iter().map(|&(at, weight)| (at, 2.0 * weight));
        summed(
            near.chain(far.iter().map(|&(at, weight)| (at, -weight)))
                .collect(),
        )
    };
    // In the rows that are there, then beyond them.
    for row in &mut grid {
        for (beyond, near, far) in [(0, 1, 2), (3, 2, 1)] {
            if row[beyond].is_none() {
                let mirrored = row[near].as_ref().zip(row[far].as_ref());
                row[beyond] = mirrored.map(|(near, far)| image(near, far));
            }
        }
    }
    for (beyond, near, far) in [(0, 1, 2), (3, 2, 1)] {
        let inner = [grid[near].clone(), grid[far].clone()];
        for (at, own) in grid[beyond]
            .iter_mut()
            .enumerate()
            .filter(|(_, own)| own.is_none())
        {
            let mirrored = inner[0][at].as_ref().zip(inner[1][at].as_ref());
            *own = mirrored.map(|(near, far)| image(near, far));
        }
    }
    let mut full: [[Row; 4]; 4] = Default::default();
    for (full, row) in full
        .as_flattened_mut()
        .iter_mut()
        .zip(grid.into_iter().flatten())
    {
        *full = row?;
    }
    Some(full)
}
