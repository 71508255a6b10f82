//! Assets and packages: meshes that are refined one after the other within one cap, and what is said of all of them.

use std::path::Path;
use std::time::{Duration, Instant};

use limitmesh::{Mesh, PolygonSoup};
use limitmesh_io::Format;
use limitmesh_io::channels::NORMALS;
use limitmesh_render::Style;

use super::super::channels::Channels;
use super::control::Control;
use super::exact;
use super::goals::Goals;
use super::{Refined, phases, picture, shading, stepwise, summary, turned_over};
use crate::arguments::{Extent, Length, RefineArguments, Way};
use crate::bulk::Bulk;
use crate::failure::Outcome;
use crate::format::counted;
use crate::output;
use crate::progress::Progress;
use crate::report::{
    AssetMeshReport, AssetReport, InputReport, MeshReport, OutputReport, ParametersReport,
    SizeReport, VERSION,
};

/// What became of the meshes so far.
#[derive(Default)]
pub(super) struct Progressed {
    /// By mesh, where there is to be a report.
    reports: Vec<AssetMeshReport>,
    /// Names of attributes that were left out.
    pub(super) left_out: Vec<String>,
    short: Vec<String>,
    meshes: usize,
    triangles: usize,
    refining: Duration,
}

/// A mesh that was refined.
pub(super) struct One {
    pub(super) refined: Refined,
    size: SizeReport,
    refining: Duration,
}

/// The diagonal of a box.
pub(super) fn diagonal([low, high]: [[f64; 3]; 2]) -> f64 {
    low.iter()
        .zip(high)
        .map(|(a, b)| (b - a).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// Makes lengths in per cent that hold for all meshes lengths, of this diagonal.
///
/// # Errors
/// A length has a unit, and the mesh's is not known.
pub(super) fn set_lengths(arguments: &mut RefineArguments, diagonal: f64) -> anyhow::Result<()> {
    if let Some(value) = arguments
        .interpolation
        .within(diagonal, arguments.build.unit)?
    {
        arguments.interpolation.interpolate_within =
            Some(Extent::Length(Length { value, unit: None }));
    }
    Ok(())
}

/// What was asked for, defaults filled in.
pub(super) fn parameters(arguments: &RefineArguments, goals: &Goals) -> ParametersReport {
    match arguments.way() {
        Way::Exact => exact::parameters(arguments, goals),
        _ => stepwise::parameters(arguments),
    }
}

/// Refines a mesh by the method that is asked for, and says what came of it.
pub(super) fn one(
    name: &str,
    (control, channels, goals): (&Control, &Channels, &Goals),
    (keeps_origins, format): (bool, Option<Format>),
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<One> {
    let start = Instant::now();
    let Control {
        featured,
        before,
        bulk,
        shown,
        took,
        ..
    } = control;
    let mut refined = match arguments.way() {
        Way::Exact => exact::run((featured, before, channels), goals, arguments, progress)?,
        _ => stepwise::run(
            (featured.mesh.clone(), channels, keeps_origins),
            arguments,
            format,
            progress,
        )?,
    };
    let refining = *took + start.elapsed();
    let size = SizeReport {
        before: *bulk,
        after: Bulk::as_shown(&refined.mesh, shown),
    };
    refined.tell_size([size.before, size.after], arguments);
    progress.note(summary(name, &refined, refining));
    if let Some(note) = refined.inverted.and_then(turned_over) {
        progress.note(format!("{name}: {note}"));
    }
    Ok(One {
        refined,
        size,
        refining,
    })
}

impl Progressed {
    /// The arguments for the next mesh: what the others left of the cap.
    pub(super) fn share(&self, arguments: &RefineArguments) -> RefineArguments {
        let left = arguments
            .max_triangles()
            .saturating_sub(self.triangles)
            .max(1);
        RefineArguments {
            max_triangles: Some(left),
            ..arguments.clone()
        }
    }

    /// Adds a mesh: its name, its number and how many times larger it appears, what was read and asked for. It is examined for a report
    /// alone.
    pub(super) fn add(
        &mut self,
        (name, mesh, scale): (&str, usize, f64),
        One {
            refined,
            size,
            refining,
        }: One,
        (input, control, parameters): (InputReport, Control, ParametersReport),
        arguments: &RefineArguments,
    ) {
        self.meshes += 1;
        self.triangles += refined.mesh.face_count();
        self.refining += refining;
        if let Outcome::StoppedShort(why) = refined.outcome {
            self.short.push(format!("{name}: {why}"));
        }
        if arguments.report.is_some() {
            let of = MeshReport {
                input,
                diagnosis: (&control.diagnosis).into(),
                parameters,
                interpolation: control.interpolation,
                method: refined.report,
                size,
                output: OutputReport::of(arguments.output_name(), &refined.mesh, refined.inverted),
            };
            self.reports.push(AssetMeshReport { mesh, scale, of });
        }
    }

    /// Says how many there are, which are called so, and writes the report; gives how all ended.
    pub(super) fn finish(
        self,
        name: &str,
        [reading, writing]: [Duration; 2],
        (arguments, [one, many]): (&RefineArguments, [&str; 2]),
        progress: &Progress,
    ) -> anyhow::Result<Outcome> {
        let meshes = counted(self.meshes, one, many);
        let triangles = counted(self.triangles, "triangle", "triangles");
        progress.note(format!(
            "{}: {meshes} with {triangles}",
            arguments.output_name()
        ));
        if let Some(path) = &arguments.report {
            let report = AssetReport {
                version: VERSION,
                path: name.to_owned(),
                left_out: self.left_out,
                meshes: self.reports,
                seconds: phases(reading, Duration::ZERO, self.refining, writing),
            };
            progress.clear();
            output::write_json(path, &report)?;
        }
        Ok(match self.short.is_empty() {
            true => Outcome::Done,
            false => Outcome::StoppedShort(self.short.join("\n")),
        })
    }
}

/// Draws all that was written.
pub(super) fn draw(
    path: &Path,
    scene: &PolygonSoup,
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<()> {
    progress.stage(format!("drawing {}", path.display()));
    let (mesh, _, trace) = Mesh::from_soup_traced(scene, &Default::default())?;
    let normals = scene
        .channels
        .iter()
        .find(|channel| channel.name == NORMALS);
    let split = match normals {
        Some(normals) => shading::by_normals(&mesh, &normals.on_mesh(scene, &mesh, &trace)?),
        None => shading::without_normals(&mesh)?,
    };
    let style = Style::default().wireframe(true);
    let view = picture::view_direction(arguments.view);
    picture::draw(
        path,
        split.as_triangles(),
        Some(&split.normals),
        view,
        &style,
        picture::SIZE,
    )?;
    progress.note(picture::drawn(path, mesh.face_count()));
    Ok(())
}
