//! The result: the emitted mesh with its error, origins and tags.

use super::backs::shows_back;
use super::emit::Emission;
use super::flat::{Assembled, RimGaps};
use super::neighbours::sharp_edges;
use super::rounds::Verified;
use super::{Engine, probe, sides};
use crate::certificate::{TriangleFrame, exceeds};
use crate::criterion::{Criteria, Region};
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::{Mesh, Topology, check_finite, outgoing_half_edges_polled};
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch, Stage};
use crate::refine::RefineError;
use crate::refine::exact_options::ExactOptions;
use crate::refine::exact_result::{ErrorBounds, Exact, ExactStop, Statistics};
use crate::vector::vector;

impl Verified {
    /// Measures the mesh as a whole, and hands it out.
    pub(super) fn finish(
        self,
        engine: &Engine<'_>,
        stop: ExactStop,
        options: &ExactOptions,
        gaps: &mut RimGaps,
    ) -> Result<Exact, RefineError> {
        let Self { state, emission } = self;
        let (control, watch) = (engine.control, engine.watch);
        watch.stage(Stage::Bounding, None)?;
        let stop = if stop == ExactStop::Met && state.has_failed {
            ExactStop::LevelCap
        } else {
            stop
        };
        engine.check(&emission)?;
        let is_met = stop == ExactStop::Met && options.goals.tolerance.is_some();
        let mut error = probe::probe(engine, &state, &emission, is_met)?;
        // Where nothing was asked of distances, a bound far from the truth says nothing.
        if options.goals.tolerance.is_none()
            && options.goals.triangles.is_none()
            && error.upper > ErrorBounds::TIGHT * error.lower
        {
            error.upper = f64::INFINITY;
        }
        let failed = options
            .goals
            .tolerance
            .filter(|&tolerance| exceeds(error.upper, tolerance));
        let stop = if stop == ExactStop::Met && failed.is_some() {
            ExactStop::Rounding
        } else {
            stop
        };
        let beyond = failed.map_or(0.0, |tolerance| error.upper / tolerance);
        let value = state.worst();
        let worst = match (&control.criteria, options.goals.tolerance) {
            (Some(_), _) => value.max(beyond),
            (None, Some(tolerance)) => (value / tolerance).max(beyond),
            (None, None) => 0.0,
        };
        let pixels = options.goals.pixels.as_ref().map(|_| {
            state
                .measured
                .iter()
                .map(|face| face.pixels)
                .fold(0.0, f64::max)
        });
        let levels = state.levels(watch)?;
        drop(state);
        let mut exact = Exact {
            error,
            pixels,
            stop,
            ..engine.assemble(emission, gaps)?
        };
        (exact.statistics.worst, exact.statistics.levels) = (worst, levels);
        if options.goals.angle.is_some()
            && let Some(criteria) = &control.criteria
        {
            exact.statistics.open_cones = open_cones(&exact, criteria, watch)?;
        }
        if exact.statistics.open_cones > 0 && exact.stop == ExactStop::Met {
            exact.stop = ExactStop::Cones;
        }
        Ok(exact)
    }
}

impl Engine<'_> {
    /// Whether what was emitted is all finite, and all stencils were found.
    pub(super) fn check(&self, emission: &Emission) -> Result<(), RefineError> {
        check_finite(&emission.positions)?;
        match self.control.rules.failure() {
            Some(why) => Err(why.clone().into()),
            None => Ok(()),
        }
    }

    /// The mesh of what was emitted, of which nothing is proven yet.
    pub(super) fn assemble(
        &self,
        emission: Emission,
        gaps: &mut RimGaps,
    ) -> Result<Exact, RefineError> {
        let (control, watch) = (self.control, self.watch);
        watch.stage(Stage::Assembling, None)?;
        let tags = sides::tags(control, watch, &emission)?;
        let sides = sides::sides(control, watch, &emission)?;
        let sharp = sharp_edges(&emission, watch)?;
        let Emission {
            positions,
            normals,
            origins,
            triangles,
            twins,
            parents,
            starts,
            junctions,
            ..
        } = emission;
        let whole = Assembled {
            positions,
            normals,
            origins,
            triangles,
            twins,
            parents,
            tags,
            sides,
            junctions,
        };
        let (whole, unfolded) = control
            .flat
            .merge(control, whole, &starts, &sharp, gaps, watch)?;
        let Assembled {
            positions,
            normals,
            origins,
            triangles,
            twins,
            parents,
            tags,
            sides,
            junctions,
        } = whole;
        let outgoing =
            outgoing_half_edges_polled(&triangles, &twins, positions.len(), &mut |_| watch.poll())?;
        let topology = Topology::from_parts(triangles, twins, outgoing);
        Ok(Exact {
            mesh: Mesh::from_parts(topology, positions, tags, junctions),
            normals,
            sides,
            origins,
            statistics: Statistics {
                off_planes: control.flat.off_planes(),
                unfolded,
                ..Statistics::default()
            },
            within_rims: control.flat.within_rims(control.demands),
            parents,
            side_origins: None,
            error: ErrorBounds {
                lower: 0.0,
                upper: f64::INFINITY,
                at: [0.0; 3],
                certified: false,
            },
            pixels: None,
            attribute_bounds: Vec::new(),
            stop: ExactStop::Met,
        })
    }
}

/// Triangles outside their cones.
pub(super) fn open_cones(
    exact: &Exact,
    criteria: &Criteria,
    watch: &SharedWatch<'_>,
) -> Result<usize, Cancelled> {
    let surface = exact.mesh.as_triangles();
    let is_open = |face: usize| {
        let corners = surface.corners(face).map(vector);
        let normals = [0, 1, 2].map(|corner| HalfEdgeId::of(FaceId(face as u32), corner));
        let normals = normals.map(|corner| vector(exact.corner_normal(corner)));
        let frame = TriangleFrame::new(corners);
        let normal_deviation = normals
            .iter()
            .map(|normal| normal.distance(frame.normal()))
            .fold(0.0, f64::max);
        let region = Region::around(corners, frame.normal()).turned(2.0 * normal_deviation);
        // By equation (11) it is the triangle that counts.
        let backs = criteria.backs(&region, |_, viewpoint, _| {
            shows_back(&corners, viewpoint).then_some(0.0)
        });
        // Normals are taken anew from the emitted triangles, which rounds angles.
        criteria.cone_ratio(frame.normal(), normals, &region, &backs) > 1.0 + 1e-6
    };
    let open = watch.pieces(
        exact.mesh.face_count(),
        parallel::share(exact.mesh.face_count()),
        |block| block.filter(|&face| is_open(face)).count(),
    );
    Ok(open?.into_iter().sum())
}
