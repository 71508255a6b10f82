//! The loop that both refinements share: flags, cap, one step, report, until something ends it.

use super::junctions::join_copies;
use super::lineage::Lineage;
use super::split::SplitEdges;
use super::step::advance;
use super::{RefineError, Refinement, StepReport, Stop};
use crate::clock::Clock;
use crate::limit::{LimitTable, suits};
use crate::mesh::{Mesh, check_finite};
use crate::progress::{Observer, Stage, Watch};
use crate::scheme::Scheme;

/// The data of a run of steps, except for how faces are flagged.
pub(super) struct Driver<'a> {
    pub(super) scheme: &'a dyn Scheme,
    pub(super) levels: usize,
    pub(super) limit: bool,
    pub(super) normals: bool,
    pub(super) origins: bool,
    pub(super) max_triangles: Option<usize>,
}

impl Driver<'_> {
    /// Refines until the levels are done, no face is flagged, or the cap is near.
    pub(super) fn run(
        &self,
        control: &Mesh,
        observer: &mut Observer<'_>,
        flags: impl Fn(&Mesh) -> Result<Vec<bool>, RefineError>,
        moves: impl Fn(&Mesh, &SplitEdges) -> Option<Vec<bool>>,
    ) -> Result<Refinement, RefineError> {
        suits(self.scheme, control)?;
        let mut refined: Option<Mesh> = None;
        let mut lineage = self.origins.then(|| Lineage::of(control));
        let mut steps = Vec::new();
        let mut stop = Stop::Levels;
        let mut watch = Watch::new(observer, Stage::Refining);
        watch.triangles(control.face_count());
        watch.stage(Stage::Refining, Some(self.levels))?;
        for step in 1..=self.levels {
            let start = Clock::start();
            let mesh = refined.as_ref().unwrap_or(control);
            let divisible = flags(mesh)?;
            watch.poll()?;
            let divisible_count = divisible.iter().filter(|&&flag| flag).count();
            if divisible_count == 0 {
                stop = Stop::Satisfied;
                break;
            }
            let split = SplitEdges::of_divisible(mesh, &divisible);
            let needed = split.triangle_count();
            if self.max_triangles.is_some_and(|cap| needed > cap) {
                stop = Stop::TriangleCap { needed };
                break;
            }
            let closure = split.closure_cases(&divisible);
            drop(divisible);
            let moving = moves(mesh, &split);
            let (next, numbered) =
                advance(mesh, self.scheme, split, moving.as_deref(), &mut watch)?;
            if let Some(lineage) = &mut lineage {
                lineage.advance(mesh, &numbered);
            }
            steps.push(StepReport {
                step,
                faces_before: mesh.face_count(),
                divisible: divisible_count,
                closure,
                faces_after: next.face_count(),
                duration: start.elapsed(),
            });
            watch.triangles(next.face_count());
            refined = Some(next);
            watch.done(step)?;
        }
        let mesh = refined.unwrap_or_else(|| control.clone());
        let table = LimitTable::new(self.scheme);
        if self.limit || self.normals {
            watch.stage(Stage::Limits, Some(mesh.vertex_count()))?;
        }
        let normals = match self.normals {
            true => Some(table.sided_normals_polled(&mesh, &mut |done| watch.done(done))??),
            false => None,
        };
        let mesh = if self.limit {
            at_limit(mesh, &table, &mut watch)?
        } else {
            mesh
        };
        // Coordinates near the greatest number may overflow in a weighted sum.
        check_finite(mesh.positions())?;
        let (origins, parents) = lineage.map(Lineage::finish).unwrap_or_default();
        Ok(Refinement {
            mesh,
            normals,
            origins,
            parents,
            steps,
            stop,
        })
    }
}

/// The mesh with its vertices moved to its limit surface.
fn at_limit(
    mesh: Mesh,
    table: &LimitTable<'_>,
    watch: &mut Watch<'_>,
) -> Result<Mesh, RefineError> {
    watch.stage(Stage::Limits, Some(mesh.vertex_count()))?;
    let mut positions = table.positions_polled(&mesh, &mut |done| watch.done(done))??;
    join_copies(&mut positions, &mesh.junctions().vertices);
    Ok(mesh.with_positions(positions)?)
}
