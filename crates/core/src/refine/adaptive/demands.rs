//! Nodes that are divided regardless of the error of their triangles: for the sake of what else the triangles are to hold
//! ([`AttributeGoal`]).
//!
//! Takes the goals; gives, before anything is refined, the nodes over which the linear function is too far off, which depends on
//! nothing but their places. Triangles that close gaps are looked at once they are emitted: a leaf with one that fails is divided,
//! too. So are those along rims of flat regions that could not be triangulated (`flat::gaps`).

use std::collections::{BTreeSet, HashSet};
use std::sync::atomic::{AtomicUsize, Ordering};

use super::leaves::{Covering, Descent, Leaves};
use super::quadtree::NodeAddress;
use crate::certificate::{Effort, ParamPatch, Pieces, SubTriangle, TriangleFrame, exceeds};
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::math;
use crate::mesh::Mesh;
use crate::parallel::IsStopped;
use crate::patch::Rules;
use crate::progress::SharedWatch;
use crate::refine::RefineError;
use crate::refine::attribute_goal::{AttributeGoal, GoalKind};
use crate::refine::exact_options::ExactOptions;
use crate::refine::exact_result::Exact;
use crate::scheme::Scheme;

/// The nodes for which there is room.
#[derive(Clone, Copy)]
pub(super) struct Room {
    /// Control faces.
    faces: usize,
    max_levels: u32,
    /// Nodes at most.
    pub(super) nodes: usize,
}

impl Room {
    pub(super) fn of(mesh: &Mesh, options: &ExactOptions, nodes: usize) -> Self {
        Self {
            faces: mesh.face_count(),
            max_levels: options.caps.levels as u32,
            nodes,
        }
    }
}

/// Nodes that are divided, and flat regions that are judged by their triangles though their rims would do.
#[derive(Clone, Debug, Default)]
pub(super) struct Demands {
    divided: HashSet<NodeAddress>,
    by_triangles: BTreeSet<u32>,
    all_by_triangles: bool,
    /// No leaf asks for middles of its edges.
    leaves_are_whole: bool,
}

impl Demands {
    /// These, where no leaf asks for middles of its edges: places of patterns are farther off than those of nodes.
    pub(super) fn of_whole_leaves(self) -> Self {
        Self {
            leaves_are_whole: true,
            ..self
        }
    }

    /// Whether leaves may ask for middles of their edges.
    pub(super) fn let_leaves_ask(&self) -> bool {
        !self.leaves_are_whole
    }

    /// Whether a node is divided.
    #[inline]
    pub(super) fn divides(&self, place: NodeAddress) -> bool {
        !self.divided.is_empty() && self.divided.contains(&place)
    }

    /// Adds a node and all that hold it; says whether it is new.
    pub(super) fn add(&mut self, place: NodeAddress) -> bool {
        let is_new = self.divided.insert(place);
        let mut above = place;
        while let Some(parent) = above.parent()
            && self.divided.insert(parent)
        {
            above = parent;
        }
        is_new
    }

    /// Has a flat region judged by its triangles.
    pub(super) fn judge_by_triangles(&mut self, region: u32) {
        self.by_triangles.insert(region);
    }

    /// Judges all regions by their triangles.
    pub(super) fn judge_all_by_triangles(&mut self) {
        self.all_by_triangles = true;
    }

    /// Whether a flat region is judged by its triangles in any case.
    pub(super) fn judges_by_triangles(&self, region: u32) -> bool {
        self.all_by_triangles || self.by_triangles.contains(&region)
    }

    pub(super) fn len(&self) -> usize {
        self.divided.len()
    }
}

/// By goal and function, the surface over a node.
type ParamPatches<'r, 'a> = Vec<Vec<(ParamPatch, &'r Rules<'a>)>>;

/// A goal, with the limit functions as surfaces.
#[derive(Clone, Copy)]
struct Goal<'a> {
    tolerance: f64,
    kind: GoalKind,
    surfaces: &'a [LimitSurface<'a>],
}

/// The functions that goals are about.
pub(super) struct Functions<'a> {
    goals: Vec<Goal<'a>>,
}

/// How well emitted triangles approximate the functions.
pub(super) struct Held {
    /// By goal, the greatest bound.
    pub(super) bounds: Vec<f64>,
    /// Leaves with triangles that fail.
    pub(super) failing: Vec<NodeAddress>,
}

/// By goal, its functions as surfaces.
///
/// # Errors
/// The scheme has no limit at the shape of some ring.
pub(super) fn surfaces_of<'a>(
    goals: &'a [AttributeGoal],
    scheme: &'a dyn Scheme,
) -> Result<Vec<Vec<LimitSurface<'a>>>, RefineError> {
    let of_mesh = |mesh| LimitSurface::without_normals(mesh, scheme);
    let of_goal =
        |goal: &'a AttributeGoal| goal.meshes.iter().map(of_mesh).collect::<Result<_, _>>();
    Ok(goals.iter().map(of_goal).collect::<Result<_, _>>()?)
}

impl<'a> Functions<'a> {
    /// The functions of goals, of which these are the surfaces.
    pub(super) fn of(goals: &[AttributeGoal], surfaces: &'a [Vec<LimitSurface<'a>>]) -> Self {
        let of_goal = |(goal, surfaces): (&AttributeGoal, &'a Vec<_>)| Goal {
            tolerance: goal.tolerance,
            kind: goal.kind,
            surfaces,
        };
        Self {
            goals: goals.iter().zip(surfaces).map(of_goal).collect(),
        }
    }

    /// The positions of a surface as values, within a tolerance.
    pub(super) fn positions(surface: &'a LimitSurface<'a>, tolerance: f64) -> Self {
        let surfaces = core::slice::from_ref(surface);
        Self {
            goals: vec![Goal {
                tolerance,
                kind: GoalKind::Values,
                surfaces,
            }],
        }
    }

    /// These goals with tolerances so many times as large.
    pub(super) fn coarser(&self, times: f64) -> Self {
        let coarser = |goal: &Goal<'a>| Goal {
            tolerance: times * goal.tolerance,
            ..*goal
        };
        Self {
            goals: self.goals.iter().map(coarser).collect(),
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.goals.is_empty()
    }

    /// The nodes over which a function is too far from linear; `None` if there is no room for them.
    pub(super) fn demands(
        &self,
        room: Room,
        watch: &SharedWatch<'_>,
    ) -> Result<Option<Demands>, RefineError> {
        let Room {
            faces,
            max_levels,
            nodes,
        } = room;
        let count = AtomicUsize::new(0);
        let blocks = watch.long_shares(faces, |block, is_stopped| {
            let mut found = Vec::new();
            let search = Dividing {
                functions: self,
                max_levels,
                most: nodes,
                count: &count,
                is_stopped,
            };
            for face in block {
                search.node(
                    NodeAddress::root(face as u32),
                    &self.sheets(face),
                    &mut found,
                );
            }
            found
        })?;
        self.check()?;
        if count.load(Ordering::Relaxed) > nodes {
            return Ok(None);
        }
        let mut divided = HashSet::with_capacity(count.load(Ordering::Relaxed));
        watch.each(blocks.into_iter().flatten(), |place| {
            divided.insert(place);
        })?;
        Ok(Some(Demands {
            divided,
            ..Demands::default()
        }))
    }

    /// How well the triangles approximate the functions.
    pub(super) fn held(
        &self,
        control: &Mesh,
        found: &Exact,
        watch: &SharedWatch<'_>,
    ) -> Result<Held, RefineError> {
        let leaves = Leaves::of(control, found);
        let blocks = watch.long_shares(control.face_count(), |block, is_stopped| {
            let held = Held {
                bounds: vec![0.0; self.goals.len()],
                failing: Vec::new(),
            };
            let mut looking = Looking {
                functions: self,
                held,
                is_stopped,
            };
            for face in block {
                if !leaves.descend(face as u32, self.sheets(face), &mut looking) {
                    looking.held.bounds.fill(f64::INFINITY);
                }
            }
            looking.held
        })?;
        self.check()?;
        let mut held = Held {
            bounds: vec![0.0; self.goals.len()],
            failing: Vec::new(),
        };
        for block in blocks {
            held.bounds
                .iter_mut()
                .zip(block.bounds)
                .for_each(|(all, own)| *all = all.max(own));
            held.failing.extend(block.failing);
        }
        Ok(held)
    }

    /// Whether all goals are met.
    pub(super) fn are_met(&self, bounds: &[f64]) -> bool {
        self.goals
            .iter()
            .zip(bounds)
            .all(|(goal, &bound)| !exceeds(bound, goal.tolerance))
    }

    fn sheets(&self, face: usize) -> ParamPatches<'_, 'a> {
        let face = FaceId(face as u32);
        debug_assert!(self.goals.iter().all(|goal| !goal.surfaces.is_empty()));
        let of_goal = |goal: &Goal<'a>| {
            goal.surfaces
                .iter()
                .map(|surface| ParamPatch::over(surface, face))
                .collect()
        };
        self.goals.iter().map(of_goal).collect()
    }

    /// A stencil that failed on the way.
    fn check(&self) -> Result<(), RefineError> {
        let mut failures = self
            .goals
            .iter()
            .flat_map(|goal| goal.surfaces)
            .filter_map(LimitSurface::failure);
        failures
            .next()
            .map_or(Ok(()), |failure| Err(failure.clone().into()))
    }
}

/// Looks at the triangles of leaves.
struct Looking<'s, 'a> {
    functions: &'s Functions<'a>,
    held: Held,
    is_stopped: &'s IsStopped<'s>,
}

impl<'s, 'a> Descent for Looking<'s, 'a> {
    type Node = ParamPatches<'s, 'a>;

    fn children(&mut self, sheets: Self::Node) -> [Self::Node; 4] {
        children(&sheets)
    }

    fn leaf(&mut self, place: NodeAddress, sheets: Self::Node, covering: &[Covering]) {
        for &Covering { part, .. } in covering {
            let mut fails = false;
            for (number, goal) in self.functions.goals.iter().enumerate() {
                let bound = bound(goal, &sheets[number], part);
                let known = &mut self.held.bounds[number];
                *known = known.max(bound);
                fails |= exceeds(bound, goal.tolerance);
            }
            let failing = match part {
                SubTriangle::Child(child) => place.child(child),
                _ => place,
            };
            if fails && self.held.failing.last() != Some(&failing) {
                self.held.failing.push(failing);
            }
        }
    }

    fn is_over(&self) -> bool {
        (self.is_stopped)()
    }
}

/// The functions over the four parts of a node.
fn children<'r, 'a>(sheets: &[Vec<(ParamPatch, &'r Rules<'a>)>]) -> [ParamPatches<'r, 'a>; 4] {
    let mut parts: [ParamPatches<'r, 'a>; 4] = Default::default();
    for of_goal in sheets {
        parts
            .iter_mut()
            .for_each(|part| part.push(Vec::with_capacity(of_goal.len())));
        for (sheet, rules) in of_goal {
            for (part, own) in parts.iter_mut().zip(sheet.children(rules)) {
                part.last_mut()
                    .into_iter()
                    .for_each(|list| list.push((own.clone(), *rules)));
            }
        }
    }
    parts
}

/// How far a goal's function is from what a triangle over a part of a node holds.
fn bound(goal: &Goal<'_>, sheets: &[(ParamPatch, &Rules<'_>)], part: SubTriangle) -> f64 {
    match goal.kind {
        GoalKind::Values => {
            let target = goal.tolerance / (sheets.len() as f64).sqrt();
            let squares = sheets
                .iter()
                .map(|(sheet, rules)| math::powi(sheet.off_linear(part, target, rules), 2));
            squares.sum::<f64>().sqrt()
        }
        GoalKind::Surface => {
            let apart = sheets.iter().map(|(sheet, rules)| {
                let frame = TriangleFrame::new(sheet.corners_of(part, rules));
                let effort = Effort {
                    target: goal.tolerance,
                    halvings: 2,
                    open: [false; 3],
                    rim_alone: false,
                    // No chord that counts is as great.
                    chords: [4.0; 3],
                    slopes: [0.0; 3],
                    gives_up: false,
                    least_chord: None,
                };
                Pieces::of(&sheet.patch)
                    .deviation(part, &frame, rules, effort)
                    .own
            });
            apart.fold(0.0, |most, own| if exceeds(own, most) { own } else { most })
        }
    }
}

/// Divides nodes as long as a function is too far from linear.
struct Dividing<'s, 'a> {
    functions: &'s Functions<'a>,
    max_levels: u32,
    most: usize,
    count: &'s AtomicUsize,
    is_stopped: &'s IsStopped<'s>,
}

impl Dividing<'_, '_> {
    fn node(
        &self,
        place: NodeAddress,
        sheets: &[Vec<(ParamPatch, &Rules<'_>)>],
        found: &mut Vec<NodeAddress>,
    ) {
        if place.level >= self.max_levels || (self.is_stopped)() {
            return;
        }
        let fails = |(goal, sheets): (&Goal<'_>, &Vec<(ParamPatch, &Rules<'_>)>)| {
            exceeds(bound(goal, sheets, SubTriangle::Whole), goal.tolerance)
        };
        if !self.functions.goals.iter().zip(sheets).any(fails)
            || self.count.fetch_add(1, Ordering::Relaxed) >= self.most
        {
            return;
        }
        found.push(place);
        for (child, sheets) in children(sheets).into_iter().enumerate() {
            self.node(place.child(child), &sheets, found);
        }
    }
}
