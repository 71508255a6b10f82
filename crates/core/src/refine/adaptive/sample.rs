//! Triangles that some control faces take, for estimates: nothing is emitted, and all others are divided no more than these ask for.

use super::demands::Demands;
use super::judge::Goal;
use super::{Engine, Plan, with_engine};
use crate::mesh::Mesh;
use crate::progress::Observer;
use crate::refine::RefineError;
use crate::refine::exact_options::ExactOptions;
use crate::scheme::Scheme;

/// The triangles that a distance takes over each of the first so many control faces, which are divided as those beside them across
/// edges are. Of triangles that strips may be made of the same part is left everywhere.
pub(in crate::refine) fn count_in(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    distance: f64,
    faces: usize,
    observer: &mut Observer<'_>,
) -> Result<Vec<f64>, RefineError> {
    with_engine(mesh, scheme, (options, &Demands::default()), observer, |engine| {
        let mut is_divided = vec![false; mesh.face_count()];
        for h in 0..3 * faces as u32 {
            is_divided[h as usize / 3] = true;
            engine.edges.twin(h).into_iter().for_each(|twin| is_divided[twin as usize / 3] = true);
        }
        let goal = Goal::Partly(f64::INFINITY, engine.floor(Some(distance)), is_divided);
        let Some(mut plan) = engine.without_strips().plan(goal, usize::MAX)? else { return Ok(Vec::new()) };
        let left = engine.left_of_strips(&mut plan)?;
        let flat = &engine.control.flat;
        let count = |face: u32| {
            let own = plan.closed[face as usize].triangles as usize;
            let count = flat.count_over(engine.control, &engine.edges, &plan.chains, face, own) as f64;
            if flat.may_have_strips(face) { left * count } else { count }
        };
        Ok((0..faces as u32).map(count).collect())
    })
}

impl Engine<'_> {
    /// The part of the triangles that strips may be made of that is left once they are.
    fn left_of_strips(&self, plan: &mut Plan) -> Result<f64, RefineError> {
        let over_strips =
            |plan: &Plan| self.control.flat.over_strips(|face| plan.closed[face as usize].triangles as usize);
        let saved = self.triangles_at_most(plan) - self.triangles(plan)?;
        Ok(1.0 - saved.min(over_strips(plan)) as f64 / over_strips(plan).max(1) as f64)
    }
}
