//! All that is measured of one model: its rows of Table 1, its drift over steps, its seam rules.
//!
//! Everything is measured against one reference, the model's limit surface as uniform refinement with limit
//! vertices gives it, whose search tree is built once; √3-subdivision has a limit surface of its own.

use std::time::Instant;

use limitmesh::Mesh;
use limitmesh::front::Measure;
use limitmesh::measure::{Bvh, SamplingOptions, hausdorff_between};
use limitmesh::refine::SeamRule;
use limitmesh::refine::limit_reference;
use limitmesh::scheme::Loop;
use serde::Serialize;

use super::matching::{match_angle, nearest_level};
use super::methods;
use super::settings::Settings;
use crate::paper_models::{Origin, Player};

/// A surface's distance to the limit surface. Lengths are in per cent of the diagonal of the control mesh's
/// bounding box.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Measured {
    pub(super) faces: usize,
    /// Symmetric Hausdorff distance, equation (16).
    pub(super) shd_percent: f64,
    /// From the surface to the limit surface.
    pub(super) forward_percent: f64,
    /// From the limit surface to the surface.
    pub(super) backward_percent: f64,
    /// Root mean square from the surface to the limit surface.
    pub(super) forward_rms_percent: f64,
    /// Samples of both directions together.
    pub(super) samples: usize,
}

/// A row of Table 1.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Row {
    pub(super) model: &'static str,
    pub(super) angle_degrees: f64,
    pub(super) paper: Measured,
    pub(super) amresh: Measured,
    pub(super) amresh_angle_degrees: f64,
    /// The paper's ratio: SHD of its method by SHD of Amresh's.
    pub(super) ratio_percent: f64,
    pub(super) uniform_limit: Measured,
    pub(super) uniform_limit_level: usize,
    /// Exact refinement with at most as many faces as the paper's method.
    pub(super) exact: Measured,
    /// Upper bound of its distance, which is proven.
    pub(super) exact_upper_percent: f64,
    /// By Zorin's planarity, as a distance, with at most as many faces.
    pub(super) planarity: Measured,
    /// By Müller's vertex errors, with at most as many faces.
    pub(super) vertex_error: Measured,
    /// Adaptive √3-subdivision with at most as many faces, against its own limit surface.
    pub(super) sqrt3: Measured,
}

/// One step count of the paper's method, and uniform refinement with limit vertices at as many levels.
#[derive(Clone, Debug, Serialize)]
pub(super) struct DriftPoint {
    pub(super) model: &'static str,
    pub(super) steps: usize,
    pub(super) paper: Measured,
    /// None where the level is that of the reference.
    pub(super) uniform_limit: Option<Measured>,
}

/// One seam rule.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SeamRow {
    pub(super) model: &'static str,
    pub(super) seam: &'static str,
    pub(super) measured: Measured,
}

/// What stands for a model's limit surface.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Reference {
    pub(super) level: usize,
    pub(super) triangles: usize,
    /// Distance of the level before it, which is about three times its own: each level divides it by four.
    pub(super) coarser_level_shd_percent: f64,
}

/// All of one model.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Study {
    pub(super) model: &'static str,
    pub(super) origin: Origin,
    pub(super) control_vertices: usize,
    pub(super) control_faces: usize,
    pub(super) boundary_edges: usize,
    pub(super) max_valence: u32,
    pub(super) reference: Reference,
    pub(super) rows: Vec<Row>,
    pub(super) drift: Vec<DriftPoint>,
    pub(super) seams: Vec<SeamRow>,
    pub(super) seconds: f64,
}

/// The seam rules by their names on the command line.
pub(super) const SEAMS: [(SeamRule, &str); 3] = [
    (SeamRule::All, "all"),
    (SeamRule::Any, "any"),
    (SeamRule::Inner, "inner"),
];

/// Steps at least of what stands for the limit surface of √3-subdivision.
const SQRT3_STEPS: u32 = 6;

/// Refines and measures one model; `stage` is told what comes next.
///
/// # Errors
/// A refinement or a measurement fails.
pub(super) fn study(
    player: &Player,
    settings: &Settings,
    stage: &dyn Fn(&str),
) -> anyhow::Result<Study> {
    let start = Instant::now();
    let control = &player.mesh;
    let level = settings.reference_level(control.face_count());
    stage("limit surface");
    let reference = limit_reference(control, &Loop, level)?;
    let reference_triangles = reference.face_count();
    let tree = Bvh::new(reference.as_triangles())?;
    let sqrt3 = methods::sqrt3_reference(control, SQRT3_STEPS, settings.reference_triangles)?.0;
    let trees = [&tree, &Bvh::new(sqrt3.as_triangles())?];
    let mut bench = Bench::new(player.name, control, trees, level, settings);
    let reference = Reference {
        level,
        triangles: reference_triangles,
        coarser_level_shd_percent: bench.uniform_limit(level - 1)?.shd_percent,
    };
    let mut rows = Vec::new();
    for &angle in settings.angles_degrees {
        stage(&format!("{angle}°"));
        rows.push(bench.row(angle)?);
    }
    stage("drift");
    let drift = bench.drift()?;
    stage("seam rules");
    let seams = bench.seams()?;
    let valence = |v| control.topology().valence_and_openness(v).0;
    Ok(Study {
        model: player.name,
        origin: player.origin.clone(),
        control_vertices: control.vertex_count(),
        control_faces: control.face_count(),
        boundary_edges: control.topology().boundary_edge_count(),
        max_valence: control
            .topology()
            .vertices()
            .map(valence)
            .max()
            .unwrap_or(0),
        reference,
        rows,
        drift,
        seams,
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// A model beside its limit surface. What was measured once is remembered.
struct Bench<'a> {
    model: &'static str,
    control: &'a Mesh,
    reference: &'a Bvh<'a>,
    /// The limit surface of √3-subdivision.
    sqrt3: &'a Bvh<'a>,
    level: usize,
    settings: &'a Settings,
    uniform: Vec<Option<Measured>>,
    paper: Vec<(f64, usize, &'static str, Measured)>,
}

impl<'a> Bench<'a> {
    fn new(
        model: &'static str,
        control: &'a Mesh,
        [reference, sqrt3]: [&'a Bvh<'a>; 2],
        level: usize,
        settings: &'a Settings,
    ) -> Self {
        let uniform = vec![None; level];
        Self {
            model,
            control,
            reference,
            sqrt3,
            level,
            settings,
            uniform,
            paper: Vec::new(),
        }
    }

    /// A length in per cent of the diagonal of the control mesh's bounding box.
    fn percent(&self, length: f64) -> f64 {
        100.0 * length / self.control.diagonal()
    }

    fn measure(&self, surface: &Mesh) -> anyhow::Result<Measured> {
        self.measure_against(surface, self.reference)
    }

    fn measure_against(&self, surface: &Mesh, reference: &Bvh<'_>) -> anyhow::Result<Measured> {
        let tree = Bvh::new(surface.as_triangles())?;
        let options = SamplingOptions::default().samples(self.settings.samples);
        let found = hausdorff_between(&tree, reference, &options);
        Ok(Measured {
            faces: surface.face_count(),
            shd_percent: self.percent(found.symmetric()),
            forward_percent: self.percent(found.forward.max),
            backward_percent: self.percent(found.backward.max),
            forward_rms_percent: self.percent(found.forward.rms),
            samples: found.forward.samples + found.backward.samples,
        })
    }

    /// Uniform refinement with its vertices on the limit surface, at a level below the reference's.
    fn uniform_limit(&mut self, level: usize) -> anyhow::Result<Measured> {
        if let Some(Some(measured)) = self.uniform.get(level) {
            return Ok(*measured);
        }
        let measured = self.measure(&limit_reference(self.control, &Loop, level)?)?;
        if let Some(slot) = self.uniform.get_mut(level) {
            *slot = Some(measured);
        }
        Ok(measured)
    }

    /// The paper's method.
    fn paper(
        &mut self,
        angle: f64,
        steps: usize,
        (seam, name): (SeamRule, &'static str),
    ) -> anyhow::Result<Measured> {
        let same = |known: &&(f64, usize, &str, Measured)| {
            (known.0, known.1, known.2) == (angle, steps, name)
        };
        if let Some(known) = self.paper.iter().find(same) {
            return Ok(known.3);
        }
        let measured = self.measure(&methods::paper(self.control, angle, steps, seam)?.mesh)?;
        self.paper.push((angle, steps, name, measured));
        Ok(measured)
    }

    fn row(&mut self, angle: f64) -> anyhow::Result<Row> {
        let steps = self.settings.steps;
        let paper = self.paper(angle, steps, SEAMS[0])?;
        let matched = match_angle(paper.faces, angle, |angle| {
            methods::amresh(self.control, angle, steps)
        })?;
        let amresh = self.measure(&matched.refinement.mesh)?;
        let exact = methods::exact_with(self.control, paper.faces)?;
        let restricted = |measure| methods::restricted(self.control, measure, paper.faces);
        let planarity = self.measure(&restricted(Measure::PlanarityDistance)?)?;
        let vertex_error = self.measure(&restricted(Measure::VertexError)?)?;
        let sqrt3 = methods::sqrt3_with(self.control, paper.faces)?;
        let uniform_limit_level = nearest_level(self.control.face_count(), paper.faces);
        Ok(Row {
            model: self.model,
            angle_degrees: angle,
            paper,
            amresh,
            amresh_angle_degrees: matched.angle_degrees,
            ratio_percent: ratio_percent(paper.shd_percent, amresh.shd_percent),
            uniform_limit: self.uniform_limit(uniform_limit_level)?,
            uniform_limit_level,
            exact: self.measure(&exact.mesh)?,
            exact_upper_percent: self.percent(exact.error.upper),
            planarity,
            vertex_error,
            sqrt3: self.measure_against(&sqrt3, self.sqrt3)?,
        })
    }

    fn drift(&mut self) -> anyhow::Result<Vec<DriftPoint>> {
        let angle = self.settings.extra_angle_degrees;
        let mut points = Vec::new();
        for steps in 1..=self.settings.drift_steps {
            let paper = self.paper(angle, steps, SEAMS[0])?;
            let uniform_limit = if steps < self.level {
                Some(self.uniform_limit(steps)?)
            } else {
                None
            };
            points.push(DriftPoint {
                model: self.model,
                steps,
                paper,
                uniform_limit,
            });
        }
        Ok(points)
    }

    fn seams(&mut self) -> anyhow::Result<Vec<SeamRow>> {
        let (angle, steps) = (self.settings.extra_angle_degrees, self.settings.steps);
        let rows = SEAMS.map(|rule| {
            let measured = self.paper(angle, steps, rule)?;
            Ok(SeamRow {
                model: self.model,
                seam: rule.1,
                measured,
            })
        });
        rows.into_iter().collect()
    }
}

/// One distance in per cent of another; 100 where both vanish.
fn ratio_percent(shd: f64, by: f64) -> f64 {
    if shd == by {
        100.0
    } else {
        100.0 * shd / by.max(f64::MIN_POSITIVE)
    }
}
