//! glTF in, glTF out: each mesh of the asset is refined once, and everything else stays as it is.
//!
//! A mesh is refined at the scale of its largest appearance, its coordinates times the greatest stretch of its nodes, so
//! that all lengths are the scene's; the result is divided by that again.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use limitmesh::Mesh;
use limitmesh::mesh::{BuildOptions, Channel, Domain, MeshError, Semantic, Weld};
use limitmesh_io::gltf::{CornerAttribute, Geometry, Joining, MeshSoup};
use limitmesh_io::{Asset, Format};
use limitmesh_render::Style;

use super::carried::{Carried, Vertices};
use super::channels::Channels;
use super::control::Control;
use super::exact::{self, Goals};
use super::{Refined, change_in_words, estimate, picture, stepwise, summary, turned_over};
use crate::arguments::{Extent, Length, Method, RefineArguments};
use crate::bulk::Bulk;
use crate::failure::{Outcome, usage};
use crate::format::counted;
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::report::{
    AssetMeshReport, AssetReport, ChannelReport, InputReport, OutputReport, SecondsReport, SizeReport,
    VERSION,
};

/// An asset to be refined.
pub(super) struct Job {
    /// With lengths instead of per cents.
    arguments: RefineArguments,
    input: Format,
    /// None for a dry run without a name.
    output: Option<Format>,
}

/// What became of the meshes so far.
#[derive(Default)]
struct Progressed {
    reports: Vec<AssetMeshReport>,
    /// Names of attributes that were left out.
    left_out: Vec<String>,
    short: Vec<String>,
    triangles: usize,
    refining: Duration,
}

impl Job {
    /// The job that a command line asks for, if that is to edit an asset.
    pub(super) fn of(arguments: &RefineArguments, output: Option<Format>) -> anyhow::Result<Option<Self>> {
        let path = arguments.input();
        if input::builtin_name(path).is_some() || output.is_some_and(|format| !format.is_gltf()) {
            return Ok(None);
        }
        let input = input::format_of(path, arguments.build.from)?;
        if !input.is_gltf() {
            return Ok(None);
        }
        let job = Self { arguments: arguments.clone(), input, output };
        job.check()?;
        Ok(Some(job))
    }

    /// Refuses what has no meaning for several meshes in one scene.
    fn check(&self) -> anyhow::Result<()> {
        let RefineArguments { exact, view, eye, build, .. } = &self.arguments;
        if !exact.camera.is_empty() || !exact.camera_path.is_empty() || view.is_some() || eye.is_some() {
            return usage(
                "cameras and views look at one mesh; the meshes of an asset stand in a scene, perhaps many times",
            );
        }
        if matches!(build.options()?.weld, Weld::Within(_)) {
            return usage(
                "the vertices of an asset become one where they stand and move together; --weld can be 0 or none",
            );
        }
        Ok(())
    }

    /// Refuses choices for attributes that no mesh has.
    fn check_channels(&self, asset: &Asset, name: &str) -> anyhow::Result<()> {
        let contents = asset.contents()?;
        let primitives = contents.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let names: BTreeSet<&str> = primitives.flat_map(|own| &own.attributes).map(String::as_str).collect();
        // What moves vertices, and what is found anew, is no matter of choice.
        let is_free = |name: &&str| {
            let kind = name.split_once('_').map_or(*name, |(kind, _)| kind);
            !["POSITION", "NORMAL", "TANGENT", "JOINTS", "WEIGHTS"].contains(&kind)
        };
        self.arguments.channels.check(name, names.into_iter().filter(is_free))
    }

    /// Refines all meshes and writes the asset.
    pub(super) fn run(mut self, progress: &Progress) -> anyhow::Result<Outcome> {
        let name = input::display_name(self.arguments.input());
        progress.stage(format!("reading {name}"));
        let start = Instant::now();
        let mut asset = input::asset(self.arguments.input())?;
        self.check_channels(&asset, &name)?;
        let bounds = asset.bounding_box()?;
        let reading = start.elapsed();
        let Some([low, high]) = bounds else {
            anyhow::bail!("{name}: the scene shows no triangles that could be refined");
        };
        let diagonal = low.iter().zip(high).map(|(a, b)| (b - a).powi(2)).sum::<f64>().sqrt();
        if let Some(within) = self.arguments.interpolation.within(diagonal, self.arguments.build.unit)? {
            self.arguments.interpolation.interpolate_within =
                Some(Extent::Length(Length { value: within, unit: None }));
        }
        let mut done = Progressed::default();
        for mesh in 0..asset.mesh_count() {
            self.mesh(mesh, &mut asset, diagonal, &mut done, progress)?;
        }
        self.finish(&asset, &name, reading, done, progress)
    }

    /// Refines a mesh and puts it back, unless there is nothing to refine, or more than can be carried along.
    fn mesh(
        &self,
        mesh: usize,
        asset: &mut Asset,
        diagonal: f64,
        done: &mut Progressed,
        progress: &Progress,
    ) -> anyhow::Result<()> {
        let arguments = &self.arguments;
        let joining = match arguments.build.options()?.weld {
            Weld::Never => Joining::Never,
            _ => Joining::Together,
        };
        let mut own = asset.mesh(mesh, joining)?;
        if own.parts.is_empty() {
            return Ok(());
        }
        let name = asset.mesh_name(mesh);
        let lost = if own.has_targets {
            Some("morph targets are not carried along yet")
        } else if !own.influences.is_empty() && !self.is_traced() {
            Some("its skin is carried along with --method exact, without --optimize")
        } else {
            None
        };
        if let Some(what) = lost {
            progress.note(format!("{name}: kept as it is: {what}"));
            return Ok(());
        }
        let stretch = asset.stretch(mesh);
        own.soup.positions.iter_mut().flatten().for_each(|x| *x *= stretch);
        let options = BuildOptions::default().weld(Weld::Never).strict(arguments.build.strict);
        let built = match Mesh::from_soup_traced(&own.soup, &options) {
            Err(MeshError::NoFaces { reason }) => {
                progress.note(format!("{name}: kept as it is: {reason}"));
                return Ok(());
            }
            built => built.map_err(|error| input::describe(&name, error))?,
        };
        self.notes(&name, &own, &built.1, progress);
        let (built, diagnosis, trace) = built;
        own.soup.channels = own.attributes.iter().map(channel).collect();
        arguments.channels.apply(&mut own.soup.channels)?;
        let on_mesh = |channel: &Channel| channel.on_mesh(&own.soup, &built, &trace);
        let narrow =
            own.soup.channels.iter().filter(|channel| channel.arity <= MOST_WIDE && self.is_traced());
        let channels = narrow.map(on_mesh).collect::<Result<_, _>>()?;
        let of_corners: Vec<u32> = own.soup.faces.iter().flatten().copied().collect();
        let vertices: Vec<u32> = trace.corners.iter().map(|&corner| of_corners[corner as usize]).collect();
        let control = Control::new((built, diagnosis, trace.faces), Some(diagonal), arguments, progress)?;
        let arguments = self.of_mesh(&own, done)?;
        let goals = Goals::new(&arguments, &control.featured.mesh, diagonal)?;
        // After collapses, triangles reach over several faces.
        let goals = if self.is_traced() { goals.keeping_origins() } else { goals };
        let parameters = match arguments.method {
            Method::Exact => exact::parameters(&arguments, &goals),
            _ => stepwise::parameters(&arguments),
        };
        if self.output.is_none() || arguments.exact.dry_run {
            let told = (self.input_report(&name, &own), (&control.diagnosis).into(), parameters);
            return estimate::run(&control.featured.mesh, &goals, &arguments, told, progress);
        }
        let Control { featured, before, bulk, diagnosis, interpolation, .. } = control;
        let mut channels = Channels::of_asset(channels, &arguments);
        channels.on_parts(&featured.concave.parts, &featured.mesh);
        let start = Instant::now();
        let mut refined = match arguments.method {
            Method::Exact => exact::run((&featured, &before, &channels), &goals, &arguments, progress)?,
            _ => {
                stepwise::run(featured.mesh.clone(), &Channels::default(), &arguments, self.output, progress)?
            }
        };
        let refining = start.elapsed();
        let after = Bulk::of(&refined.mesh);
        refined.achieved.push(change_in_words(bulk, after, arguments.build.unit));
        progress.note(summary(&name, &refined, refining));
        if let Some(note) = refined.inverted.and_then(turned_over) {
            progress.note(format!("{name}: {note}"));
        }
        let carried = Carried {
            origins: &refined.origins,
            parents: &refined.parents,
            control: featured.mesh.triangles(),
            parts: &featured.concave.parts,
            faces: &before.faces,
            vertices: &vertices,
        };
        put_back(asset, mesh, &own, (&refined, &carried), stretch)?;
        done.triangles += refined.mesh.face_count();
        done.refining += refining;
        if let Outcome::StoppedShort(why) = refined.outcome {
            done.short.push(format!("{name}: {why}"));
        }
        let is_lost = |table: &&CornerAttribute| {
            let is_dropped = arguments.channels.drops(&table.name);
            is_dropped || refined.parents.is_empty() || table.width > MOST_WIDE
        };
        for table in own.attributes.iter().filter(is_lost) {
            if !done.left_out.contains(&table.name) {
                done.left_out.push(table.name.clone());
            }
        }
        done.reports.push(AssetMeshReport {
            mesh,
            scale: stretch,
            input: self.input_report(&name, &own),
            diagnosis: (&diagnosis).into(),
            parameters,
            interpolation,
            output: OutputReport::of(arguments.output_name(), &refined.mesh, refined.inverted),
            method: refined.report,
            size: SizeReport { before: bulk, after },
        });
        Ok(())
    }

    /// What was repaired, and what stays apart.
    fn notes(&self, name: &str, own: &MeshSoup, diagnosis: &limitmesh::mesh::Diagnosis, progress: &Progress) {
        for line in diagnosis.repairs() {
            progress.note(format!("{name}: {line}"));
        }
        if own.kept_apart.touching > 0 {
            let vertices = counted(own.kept_apart.touching, "vertex", "vertices");
            progress.note(format!("{name}: {vertices} of primitives that merely touch stay apart"));
        }
    }

    /// The arguments for a mesh: its share of the cap, and what keeps the borders of several primitives.
    fn of_mesh(&self, own: &MeshSoup, done: &Progressed) -> anyhow::Result<RefineArguments> {
        let mut arguments = self.arguments.clone();
        arguments.max_triangles = Some(arguments.max_triangles().saturating_sub(done.triangles).max(1));
        if own.parts.len() > 1 && !self.is_traced() {
            return usage(
                "a mesh of several primitives keeps the borders between them with --method exact, without --optimize",
            );
        }
        // A flat region has triangles across borders, and across the faces that values belong to.
        let is_kept = |own: &CornerAttribute| !arguments.channels.drops(&own.name);
        let has_values = own.attributes.iter().any(is_kept) || !own.influences.is_empty();
        arguments.exact.divide_flat |= self.is_traced() && (own.parts.len() > 1 || has_values);
        Ok(arguments)
    }

    /// Whether it is known of triangles which face they came from, and where on it.
    fn is_traced(&self) -> bool {
        self.arguments.method == Method::Exact && !self.arguments.exact.optimize
    }

    fn input_report(&self, name: &str, own: &MeshSoup) -> InputReport {
        InputReport {
            path: name.to_owned(),
            format: self.input.extension(),
            vertices: own.soup.positions.len(),
            faces: own.soup.faces.len(),
            left_out: Vec::new(),
            channels: self.channel_reports(&own.soup.channels),
        }
    }

    fn channel_reports(&self, channels: &[Channel]) -> Vec<ChannelReport> {
        channels.iter().map(|own| ChannelReport::chosen(own, &self.arguments.channels)).collect()
    }

    /// Writes the asset, the report and the picture.
    fn finish(
        &self,
        asset: &Asset,
        name: &str,
        reading: Duration,
        done: Progressed,
        progress: &Progress,
    ) -> anyhow::Result<Outcome> {
        let arguments = &self.arguments;
        let (Some(path), Some(format), false) = (&arguments.output, self.output, arguments.exact.dry_run)
        else {
            return Ok(Outcome::Done);
        };
        if !done.left_out.is_empty() {
            progress.note(format!("{name}: left out: {}", done.left_out.join(", ")));
        }
        progress.stage(format!("writing {}", arguments.output_name()));
        let start = Instant::now();
        if output::is_standard_output(path) {
            output::write_file(path, &asset.to_bytes(format)?)?;
        } else {
            let missing = output::write_asset(path, asset, format)?;
            for file in missing {
                progress.note(format!("{name}: {} is named in it, and was not found", file.display()));
            }
        }
        let writing = start.elapsed();
        let meshes = counted(done.reports.len(), "mesh", "meshes");
        let triangles = counted(done.triangles, "triangle", "triangles");
        progress.note(format!("{}: {meshes} with {triangles}", arguments.output_name()));
        if let Some(report) = &arguments.report {
            let seconds = SecondsReport {
                read: reading.as_secs_f64(),
                repair: 0.0,
                refine: done.refining.as_secs_f64(),
                write: writing.as_secs_f64(),
                total: (reading + done.refining + writing).as_secs_f64(),
            };
            let left_out = done.left_out;
            let report_of = AssetReport {
                version: VERSION,
                path: name.to_owned(),
                left_out,
                meshes: done.reports,
                seconds,
            };
            progress.clear();
            output::write_json(report, &report_of)?;
        }
        if let Some(picture) = &arguments.picture {
            progress.stage(format!("drawing {}", picture.display()));
            let folder = arguments.input().parent();
            let scene = Asset::from_bytes(&asset.to_bytes(Format::Glb)?, folder)?.scene_soup()?;
            let (mesh, _) = Mesh::from_soup(&scene, &Default::default())?;
            let style = Style::default().wireframe(true);
            picture::draw(
                picture,
                mesh.as_triangles(),
                None,
                picture::view_direction(arguments.view),
                &style,
                picture::SIZE,
            )?;
        }
        Ok(match done.short.is_empty() {
            true => Outcome::Done,
            false => Outcome::StoppedShort(done.short.join("\n")),
        })
    }
}

/// Replaces the primitives of a mesh by the triangles that came of them, and attributes by their values there.
fn put_back(
    asset: &mut Asset,
    mesh: usize,
    own: &MeshSoup,
    (refined, carried): (&Refined, &Carried<'_>),
    stretch: f64,
) -> anyhow::Result<()> {
    let Some(normals) = &refined.normals else { anyhow::bail!("no normals were found") };
    let (surface, normals) = normals.surface(&refined.mesh);
    for (number, part) in own.parts.iter().enumerate() {
        let is_known = !carried.parents.is_empty();
        let is_own = |channel: &&Channel| {
            let table = own.attributes.iter().find(|table| table.name == channel.name);
            table.is_some_and(|table| table.is_in[number])
        };
        let channels: Vec<&Channel> = refined.channels.all().iter().filter(is_own).collect();
        let is_skinned = is_known && part.attributes.iter().any(|name| name == "JOINTS_0");
        let influences = (is_skinned && !own.influences.is_empty()).then_some(&own.influences[..]);
        let mut vertices = Vertices::new(&channels, influences, surface.positions.len());
        let (mut positions, mut directions) = (Vec::new(), Vec::new());
        let mut triangles = Vec::new();
        for (triangle, corners) in surface.triangles.iter().enumerate() {
            if own.parts.len() > 1 && !part.faces.contains(&carried.input(triangle)) {
                continue;
            }
            let of_mesh = refined.mesh.triangles()[triangle];
            triangles.push([0, 1, 2].map(|corner| {
                let v = corners[corner];
                let place =
                    vertices.need_places().then(|| carried.place(triangle, of_mesh[corner])).flatten();
                let number = vertices.number(v, 3 * triangle + corner, place);
                if number as usize == positions.len() {
                    positions.push(surface.positions[v as usize].map(|x| x / stretch));
                    directions.push(normals[v as usize]);
                }
                number
            }));
        }
        // A primitive of which nothing is left, as it had no area, stays as it is.
        if !triangles.is_empty() {
            let (positions, normals) = (&positions[..], Some(&directions[..]));
            let attributes = &vertices.into_attributes()[..];
            asset.replace(
                mesh,
                part.primitive,
                &Geometry { positions, normals, triangles: &triangles, attributes },
            )?;
        }
    }
    Ok(())
}

/// An attribute as a channel of the mesh's soup.
fn channel(attribute: &CornerAttribute) -> Channel {
    let semantic = match attribute.name.as_str() {
        name if name.starts_with("TEXCOORD_") => Semantic::TextureCoordinates,
        name if name.starts_with("COLOR_") => Semantic::Colour,
        _ if attribute.is_integer => Semantic::Label,
        _ => Semantic::Other,
    };
    Channel::new(attribute.name.clone(), semantic, Domain::Corner, attribute.width)
        .with(attribute.values.clone(), attribute.corners.concat())
}

/// Numbers of a value at most that vertices of a file can have.
const MOST_WIDE: usize = 4;
