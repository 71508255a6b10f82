//! The meshes of a source that were refined, and the report on them.

use std::time::Duration;

use super::control::Control;
use super::refined::Refined;
use super::source::Item;
use crate::arguments::RefineArguments;
use crate::failure::Outcome;
use crate::format::counted;
use crate::output;
use crate::progress::Progress;
use crate::report::{
    AssetMeshReport, AssetReport, MeshReport, OutputReport, ParametersReport, RefineReport,
    SecondsReport, SizeReport, VERSION,
};

/// The meshes so far.
#[derive(Default)]
pub(super) struct Done {
    /// By mesh, where there is to be a report.
    reports: Vec<AssetMeshReport>,
    /// Why results are less than was asked for.
    short: Vec<String>,
    meshes: usize,
    triangles: usize,
    reading: Duration,
    building: Duration,
    pub(super) refining: Duration,
    pub(super) writing: Duration,
}

impl Done {
    /// The arguments for the next mesh: what the others left of the cap.
    pub(super) fn share(&self, arguments: &RefineArguments) -> RefineArguments {
        let left = arguments.max_triangles().saturating_sub(self.triangles);
        RefineArguments {
            max_triangles: Some(left.max(1)),
            ..arguments.clone()
        }
    }

    /// Adds a mesh. It is examined for a report alone.
    pub(super) fn add<Own>(
        &mut self,
        item: Item<Own>,
        control: Control,
        refined: Refined,
        parameters: ParametersReport,
        size: SizeReport,
        progress: &Progress,
    ) {
        self.meshes += 1;
        self.triangles += refined.mesh.face_count();
        self.reading += item.reading;
        self.building += item.building;
        if let Outcome::StoppedShort(why) = &refined.outcome {
            self.short.push(item.line(why));
        }
        if item.arguments.report.is_none() {
            return;
        }
        progress.stage("examining the result");
        let name = item.arguments.output_name();
        self.reports.push(AssetMeshReport {
            mesh: item.number,
            scale: item.scale,
            of: MeshReport {
                input: item.input,
                diagnosis: (&control.diagnosis).into(),
                parameters,
                interpolation: control.interpolation,
                method: refined.report,
                size,
                output: OutputReport::of(
                    name,
                    &refined.mesh,
                    refined.quads.len(),
                    refined.inverted,
                ),
            },
        });
    }

    /// Notes how many meshes there are, which are called so, and what was left out; writes the report, and gives how all ended.
    ///
    /// # Errors
    /// The report cannot be written.
    pub(super) fn finish(
        mut self,
        nouns: Option<[&str; 2]>,
        left_out: Vec<String>,
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<Outcome> {
        let path = crate::input::display_name(arguments.input());
        if let Some([one, many]) = nouns {
            let meshes = counted(self.meshes, one, many);
            let triangles = counted(self.triangles, "triangle", "triangles");
            let name = arguments.output_name();
            if !left_out.is_empty() {
                progress.note(format!("{path}: left out: {}", left_out.join(", ")));
            }
            progress.note(format!("{name}: {meshes} with {triangles}"));
        }
        progress.clear();
        match (&arguments.report, nouns, self.reports.pop()) {
            (Some(file), None, Some(own)) => {
                let (version, of, seconds) = (VERSION, own.of, self.seconds());
                output::write_json(
                    file,
                    &RefineReport {
                        version,
                        of,
                        seconds,
                    },
                )?;
            }
            (Some(file), _, last) => {
                self.reports.extend(last);
                let report = AssetReport {
                    version: VERSION,
                    path,
                    left_out,
                    seconds: self.seconds(),
                    meshes: self.reports,
                };
                output::write_json(file, &report)?;
            }
            (None, ..) => {}
        }
        Ok(match self.short.is_empty() {
            true => Outcome::Done,
            false => Outcome::StoppedShort(self.short.join("\n")),
        })
    }

    fn seconds(&self) -> SecondsReport {
        let all = self.reading + self.building + self.refining + self.writing;
        SecondsReport {
            read: self.reading.as_secs_f64(),
            repair: self.building.as_secs_f64(),
            refine: self.refining.as_secs_f64(),
            write: self.writing.as_secs_f64(),
            total: all.as_secs_f64(),
        }
    }
}
