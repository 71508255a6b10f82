//! One level of detail: what divides the coarser level divides it as well, so that the coarser is nested in it.
//!
//! Takes what an exact refinement takes and the coarser level; gives the level, its place-by-place distance from the limit surface,
//! and its vertices' places on the coarser level. Where places count as well, what is too far off is divided until nothing is.

use super::coarser::on_coarser;
use super::demands::{Demands, Functions, Room};
use super::leaves::{Covering, Descent, Leaves};
use super::quadtree::NodeAddress;
use super::{ADDED, Task, once, probe};
use crate::certificate::{ParamPatch, exceeds};
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::mesh::Mesh;
use crate::parallel::IsStopped;
use crate::patch::Rules;
use crate::progress::{Observer, SharedWatch, Stage};
use crate::refine::RefineError;
use crate::refine::exact_options::ExactOptions;
use crate::refine::exact_result::{Exact, ExactStop};
use crate::refine::level::Level;
use crate::scheme::Scheme;
use crate::vector::{DVec3, vector};

/// The level within `options`' tolerance in which `coarser` is nested; with geomorphs the tolerances hold place by place, the coarser
/// level's from the start. `surface` is the limit surface of the mesh that the level is one of.
pub(in crate::refine) fn nested(
    surface: &LimitSurface<'_>,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    tolerance: f64,
    coarser: Option<&Level>,
    with_geomorph: bool,
    observer: &mut Observer<'_>,
) -> Result<Level, RefineError> {
    let mesh = surface.control();
    let (most, cap) = options.budget();
    let room = Room::of(
        mesh,
        options,
        most.saturating_sub(mesh.face_count()) / ADDED,
    );
    let mut demands = Demands::default();
    let mut fits = true;
    if with_geomorph {
        let functions = Functions::positions(surface, tolerance);
        let found = functions.demands(room, &SharedWatch::new(observer, Stage::Refining))?;
        fits = found.is_some();
        demands = found.unwrap_or_default();
    }
    demands = demands.of_whole_leaves();
    if let Some(coarser) = coarser {
        divide_as(
            mesh,
            &coarser.exact,
            &mut demands,
            &SharedWatch::new(observer, Stage::Refining),
        )?;
    }
    loop {
        let task = Task {
            mesh,
            scheme,
            options,
            demands: &demands,
        };
        let mut exact = once(task, observer)?;
        let watch = SharedWatch::new(observer, Stage::Bounding);
        watch.triangles(exact.mesh.face_count());
        let rounding = probe::rounding(mesh, options.caps.levels, &watch)?;
        let morph = coarser.filter(|_| with_geomorph).map(|coarser| {
            on_coarser(mesh, &coarser.exact, &exact, &watch).map(|morph| (morph, coarser.tolerance))
        });
        let mut morph = morph.transpose()?;
        let start = morph
            .as_ref()
            .map(|(morph, tolerance)| (&morph.positions[..], tolerance - rounding));
        let end = (exact.mesh.positions(), tolerance - rounding);
        let apart = Apart {
            surface,
            ends: [Some(end), start],
        };
        let off = apart.off(mesh, &exact, &watch)?;
        if let Some(failure) = surface.failure() {
            return Err(failure.clone().into());
        }
        if let Some((morph, _)) = &mut morph {
            morph.start = off.greatest[1] + rounding;
        }
        let parametric = off.greatest[0] + rounding;
        if exact.error.certified {
            // Points are no farther from each other than those of the same place.
            exact.error.upper = exact.error.upper.min(parametric);
        }
        let mut level = Level {
            exact,
            tolerance,
            parametric,
            geomorph: morph.map(|(morph, _)| morph),
        };
        if !with_geomorph || off.failing.is_empty() || level.exact.stop != ExactStop::Met {
            return Ok(level);
        }
        let deepest = |place: &NodeAddress| place.level as usize >= options.caps.levels;
        let mut is_new = false;
        for place in off.failing.into_iter().filter(|place| !deepest(place)) {
            is_new |= demands.add(place);
        }
        // Without room for them, or where nothing may be divided any further, that is how far it comes.
        if !fits || !is_new || demands.len() > room.nodes {
            level.exact.stop = if fits && !is_new {
                ExactStop::LevelCap
            } else {
                cap
            };
            return Ok(level);
        }
    }
}

/// Demands that what has leaves below it on a level is divided.
fn divide_as(
    mesh: &Mesh,
    level: &Exact,
    demands: &mut Demands,
    watch: &SharedWatch<'_>,
) -> Result<(), RefineError> {
    let leaves = Leaves::of(mesh, level);
    let blocks = watch.long_shares(mesh.face_count(), |block, is_stopped| {
        let mut parents = Parents {
            found: Vec::new(),
            is_stopped,
        };
        block.for_each(|face| {
            leaves.descend(face as u32, (), &mut parents);
        });
        parents.found
    })?;
    watch.each(blocks.into_iter().flatten(), |place| {
        demands.add(place);
    })?;
    Ok(())
}

/// Collects the nodes that leaves are children of.
struct Parents<'a> {
    found: Vec<NodeAddress>,
    is_stopped: &'a IsStopped<'a>,
}

impl Descent for Parents<'_> {
    type Node = ();

    fn children(&mut self, (): ()) -> [(); 4] {
        [(); 4]
    }

    fn leaf(&mut self, place: NodeAddress, (): (), _: &[Covering]) {
        if let Some(parent) = place.parent()
            && self.found.last() != Some(&parent)
        {
            self.found.push(parent);
        }
    }

    fn is_over(&self) -> bool {
        (self.is_stopped)()
    }
}

/// Where the vertices of a mesh are, and how far it may be from the surface.
type End<'a> = (&'a [[f64; 3]], f64);

/// Triangles with their vertices in one place and another, and their parts of the surface.
struct Apart<'a> {
    surface: &'a LimitSurface<'a>,
    /// After a geomorph, and before.
    ends: [Option<End<'a>>; 2],
}

/// How far triangles are from the surface, place by place.
struct Off {
    /// The greatest bounds, by end.
    greatest: [f64; 2],
    /// Leaves with triangles that are too far off.
    failing: Vec<NodeAddress>,
}

impl Apart<'_> {
    /// How far the triangles of a mesh are from the surface at the ends.
    fn off(&self, mesh: &Mesh, exact: &Exact, watch: &SharedWatch<'_>) -> Result<Off, RefineError> {
        let leaves = Leaves::of(mesh, exact);
        let triangles = exact.mesh.triangles();
        let blocks = watch.long_shares(mesh.face_count(), |block, is_stopped| {
            let mut off = Off {
                greatest: [0.0; 2],
                failing: Vec::new(),
            };
            for face in block {
                let (sheet, rules) = ParamPatch::over(self.surface, FaceId(face as u32));
                let mut looking = Looking {
                    rules,
                    triangles,
                    ends: &self.ends,
                    off: &mut off,
                    is_stopped,
                };
                if !leaves.descend(face as u32, sheet, &mut looking) {
                    off.greatest = [f64::INFINITY; 2];
                }
            }
            off
        })?;
        let mut off = Off {
            greatest: [0.0; 2],
            failing: Vec::new(),
        };
        for block in blocks {
            off.greatest = [0, 1].map(|end| off.greatest[end].max(block.greatest[end]));
            off.failing.extend(block.failing);
        }
        Ok(off)
    }
}

/// Looks at the triangles of leaves.
struct Looking<'a> {
    rules: &'a Rules<'a>,
    triangles: &'a [[u32; 3]],
    ends: &'a [Option<End<'a>>; 2],
    off: &'a mut Off,
    is_stopped: &'a IsStopped<'a>,
}

impl Looking<'_> {
    /// By number, the vertices at a leaf's corners and in the middles of its edges.
    fn vertices(&self, covering: &[Covering]) -> [u32; 6] {
        let mut vertices = [0; 6];
        for own in covering {
            for (of_part, at) in own
                .part
                .corners([0, 1, 2], [3, 4, 5])
                .into_iter()
                .enumerate()
            {
                vertices[at] = self.triangles[own.triangle as usize][own.corner(of_part)];
            }
        }
        vertices
    }
}

impl Descent for Looking<'_> {
    type Node = ParamPatch;

    fn children(&mut self, sheet: ParamPatch) -> [ParamPatch; 4] {
        sheet.children(self.rules)
    }

    fn leaf(&mut self, place: NodeAddress, sheet: ParamPatch, covering: &[Covering]) {
        let [a, b, c, d, e, f] = self.vertices(covering);
        let mut fails = false;
        for (end, &(positions, enough)) in self
            .ends
            .iter()
            .enumerate()
            .filter_map(|(i, end)| Some((i, end.as_ref()?)))
        {
            let at = |vertices: [u32; 3]| vertices.map(|v| vector(positions[v as usize]));
            let (corners, middles): ([DVec3; 3], [DVec3; 3]) = (at([a, b, c]), at([d, e, f]));
            let greatest = &mut self.off.greatest[end];
            for &Covering { part, .. } in covering {
                // Distances below a thousandth of the tolerance need not be known better.
                let target = greatest.max(1e-3 * enough).min(enough);
                let bound = sheet.off(
                    part,
                    part.corners(corners, middles),
                    corners,
                    target,
                    self.rules,
                );
                *greatest = if exceeds(bound, *greatest) {
                    bound
                } else {
                    *greatest
                };
                fails |= exceeds(bound, enough);
            }
        }
        if fails {
            self.off.failing.push(place);
        }
    }

    fn is_over(&self) -> bool {
        (self.is_stopped)()
    }
}
