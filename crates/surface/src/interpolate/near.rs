//! Control points of one mesh whose limits are a little away from its vertices, computed
//! repeatedly: the fairest within reaches, and those of given limits.

use super::control_points::{ControlPoints, Limits, Near};
use super::{InterpolateError, MOST_ATTEMPTS, THROUGH};
use crate::limit::LimitTable;
use crate::mesh::Mesh;
use crate::progress::{Cancelled, Stage, Watch};
use crate::scheme::Scheme;
use crate::vector::DVec3;

/// A negligible energy, relative to that of limits at the vertices: the rest is not visible.
const NOTHING: f64 = 1e-4;

/// Finds control points near the vertices of a mesh.
#[doc(hidden)]
pub struct NearVertices<'m> {
    mesh: &'m Mesh,
    table: LimitTable<'m>,
    points: ControlPoints<'m>,
}

impl<'m> NearVertices<'m> {
    #[doc(hidden)]
    pub fn new(
        mesh: &'m Mesh,
        scheme: &'m dyn Scheme,
        watch: &mut Watch<'_>,
    ) -> Result<Self, InterpolateError> {
        let table = LimitTable::new(scheme);
        let rows = table.position_rows(mesh, &mut |_| watch.poll())??;
        let points = ControlPoints::new(mesh, rows, &[], &mut |_| watch.poll())?;
        Ok(Self {
            mesh,
            table,
            points,
        })
    }

    /// Whether the limit of a vertex can be anywhere else than at it.
    #[doc(hidden)]
    pub fn is_free(&self, v: usize) -> bool {
        !self.points.is_fixed(v)
    }

    /// By vertex, the distance from it of the limits of the fairest control points that stay within
    /// a reach of each. `nearness` is the weight of nearness relative to fairness, and the search
    /// begins with limits that are `from` their vertices.
    #[doc(hidden)]
    pub fn fairest(
        &self,
        reach: &[f64],
        nearness: f64,
        from: &[DVec3],
        watch: &mut Watch<'_>,
    ) -> Result<Vec<DVec3>, Cancelled> {
        watch.stage(Stage::Interpolating, Some(self.mesh.vertex_count()))?;
        Ok(self
            .points
            .solve(
                &Limits::Near(&Near {
                    reach,
                    nearness,
                    nothing: NOTHING,
                    from,
                }),
                watch,
            )?
            .away)
    }

    /// The control mesh whose limits are so far `away` from the vertices.
    #[doc(hidden)]
    pub fn control(
        &mut self,
        away: &[DVec3],
        watch: &mut Watch<'_>,
    ) -> Result<Mesh, InterpolateError> {
        let most = away.iter().map(|away| away.length()).fold(0.0, f64::max)
            + THROUGH * self.mesh.diagonal();
        let mut attempt = 0;
        loop {
            let moved = self.points.solve(&Limits::At(away), watch)?;
            let positions = moved
                .by
                .iter()
                .enumerate()
                .map(|(v, &by)| self.points.position(v, by))
                .collect();
            let control = self.mesh.clone().with_positions(positions)?;
            let limits = self
                .table
                .positions_polled(&control, &mut |done| watch.done(done))??;
            attempt += 1;
            if !self
                .points
                .lead_through(&limits, (most, attempt >= MOST_ATTEMPTS), &mut |_| {
                    watch.poll()
                })?
            {
                return Ok(control);
            }
        }
    }
}
