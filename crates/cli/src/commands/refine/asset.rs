//! glTF in, glTF out: each mesh of the asset is refined once, and everything else stays as it is.
//!
//! A mesh is refined at the scale of its largest appearance, its coordinates times the greatest stretch of its nodes, so
//! that all lengths are the scene's; the result is divided by that again.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use anyhow::Context;
use limitmesh::Mesh;
use limitmesh::carry::borders;
use limitmesh::mesh::{BuildOptions, Channel, Domain, MeshError, Semantic, Trace, Weld};
use limitmesh_io::gltf::{CornerAttribute, KeptApart, MeshSoup};
use limitmesh_io::{Asset, Format, ReadError};

use super::super::channels::Channels;
use super::attribute_goals::AttributeGoals;
use super::carried::Carried;
use super::control::Control;
use super::goals::Goals;
use super::put_back::{MOST_WIDE, PutBack, channel, moved_positions};
use super::selection::Selection;
use super::several::{self, Progressed};
use super::{estimate, looked_at, split_normals};
use crate::arguments::{
    ConcaveCorners, CreasesFrom, Featured, MorphTolerance, RefineArguments, RelativeTo, Unit, Way,
};
use crate::bulk::Shown;
use crate::creases::Hints;
use crate::failure::{Outcome, usage};
use crate::format::{counted, thousands};
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::report::{ChannelReport, InputReport};

/// An asset to be refined.
pub(super) struct Job {
    /// With lengths instead of per cents.
    arguments: RefineArguments,
    input: Format,
    /// None for a dry run without a name.
    output: Option<Format>,
}

/// Notes which attributes of a mesh were left out: those that are lost or too wide, and `others`.
fn leave_out(
    left_out: &mut Vec<String>,
    own: &MeshSoup,
    is_lost: impl Fn(&CornerAttribute) -> bool,
    others: Vec<String>,
) {
    let tables = own
        .attributes
        .iter()
        .filter(|table| is_lost(table) || table.width > MOST_WIDE);
    for name in tables.map(|table| table.name.clone()).chain(others) {
        if !left_out.contains(&name) {
            left_out.push(name);
        }
    }
}

impl Job {
    /// The job that a command line asks for, if that is to edit an asset.
    pub(super) fn of(
        arguments: &RefineArguments,
        output: Option<Format>,
    ) -> anyhow::Result<Option<Self>> {
        let path = arguments.input();
        let is_edited = input::builtin_name(path).is_none() && output.is_none_or(Format::is_gltf);
        let input = if is_edited {
            Some(input::format_of(path, arguments.build.from)?)
        } else {
            None
        };
        let Some(input) = input.filter(|format| format.is_gltf()) else {
            return match arguments.asset.given() {
                Some(option) => usage(format!("{option} is for glTF assets that stay glTF")),
                None => Ok(None),
            };
        };
        let build = arguments
            .build
            .in_unit(Some(arguments.build.unit.unwrap_or(Unit::M)));
        let job = Self {
            arguments: RefineArguments {
                build,
                ..arguments.clone()
            },
            input,
            output,
        };
        job.check()?;
        Ok(Some(job))
    }

    /// Refuses what has no meaning for several meshes in one scene.
    fn check(&self) -> anyhow::Result<()> {
        let RefineArguments {
            exact,
            view,
            eye,
            build,
            ..
        } = &self.arguments;
        if !exact.camera.is_empty()
            || !exact.camera_path.is_empty()
            || view.is_some()
            || eye.is_some()
        {
            return usage(
                "cameras and views look at one mesh; the meshes of an asset stand in a scene, perhaps many times",
            );
        }
        build.options()?;
        Ok(())
    }

    /// Refuses choices for attributes that no mesh has, and sharp edges by normals where there are none.
    fn check_channels(&self, asset: &Asset, name: &str) -> anyhow::Result<()> {
        let contents = asset.contents()?;
        let primitives = contents.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let names: BTreeSet<&str> = primitives
            .flat_map(|own| &own.attributes)
            .map(String::as_str)
            .collect();
        // What moves vertices, and what is found anew, is no matter of choice.
        let is_free = |name: &&str| {
            let kind = name.split_once('_').map_or(*name, |(kind, _)| kind);
            !["POSITION", "NORMAL", "TANGENT", "JOINTS", "WEIGHTS"].contains(&kind)
        };
        if self.arguments.features.creases_from == CreasesFrom::Normals && !names.contains("NORMAL")
        {
            return usage(format!("--creases-from: {name} has no normals"));
        }
        self.arguments
            .channels
            .check(name, names.iter().copied().filter(is_free))?;
        let named = names
            .iter()
            .copied()
            .filter(is_free)
            .map(|own| (own, own.starts_with("TEXCOORD_")));
        self.arguments.channels.check_tolerances(name, named)
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
        let Some(bounds) = bounds else {
            anyhow::bail!("{name}: the scene shows no triangles that could be refined");
        };
        let diagonal = match self.arguments.asset.relative_to {
            RelativeTo::Scene => Some(several::diagonal(bounds)),
            RelativeTo::Mesh => None,
        };
        if let Some(diagonal) = diagonal {
            several::set_lengths(&mut self.arguments, diagonal)?;
        }
        let selection = Selection::new(&asset, &self.arguments.asset)?;
        let mut done = Progressed::default();
        for mesh in 0..asset.mesh_count() {
            self.mesh(
                (mesh, &selection),
                &mut asset,
                diagonal,
                &mut done,
                progress,
            )?;
        }
        done.left_out.extend(asset.left_out());
        self.finish(&asset, &name, reading, done, progress)
    }

    /// Refines a mesh and puts it back, unless there is nothing to refine, or more than can be carried along. Lengths in per cent are of
    /// `diagonal`, or of the mesh's own.
    fn mesh(
        &self,
        (mesh, selection): (usize, &Selection),
        asset: &mut Asset,
        diagonal: Option<f64>,
        done: &mut Progressed,
        progress: &Progress,
    ) -> anyhow::Result<()> {
        let arguments = &self.arguments;
        let stretch = asset.stretch(mesh);
        let as_shown = |weld: Weld| -> Result<MeshSoup, ReadError> {
            let joining = arguments.asset.joining(weld, stretch);
            let mut own =
                asset.mesh_of(mesh, joining, |primitive| selection.has(mesh, primitive))?;
            own.soup
                .positions
                .iter_mut()
                .flatten()
                .for_each(|x| *x *= stretch);
            Ok(own)
        };
        let weld = arguments.build.options()?.weld;
        let mut own = as_shown(weld)?;
        if own.parts.is_empty() {
            return Ok(());
        }
        let name = asset.mesh_name(mesh);
        // By glTF's rules the way round says which side is drawn.
        let options = BuildOptions::default()
            .weld(Weld::Never)
            .strict(arguments.build.strict)
            .keep_windings(true);
        let built = match Mesh::from_soup_traced(&own.soup, &options) {
            Err(MeshError::NoFaces { reason }) => {
                progress.note(format!("{name}: kept as it is: {reason}"));
                return Ok(());
            }
            built => built.map_err(|error| input::describe(&name, error))?,
        };
        self.notes(&name, &own, &built.1, progress);
        let near = input::nearly_closed(&built.0, weld, |weld| {
            Some(
                Mesh::from_soup(&as_shown(weld).ok()?.soup, &options)
                    .ok()?
                    .0,
            )
        });
        if let Some(near) = near {
            progress.note(format!("{name}: {near}"));
        }
        let (built, diagnosis, trace) = built;
        let (built, arguments) = self.sharpened(&name, &own, (built, &trace), progress)?;
        own.soup.channels = own.attributes.iter().map(channel).collect();
        arguments.channels.apply(&mut own.soup.channels)?;
        let on_mesh = |channel: &Channel| channel.on_mesh(&own.soup, &built, &trace);
        let narrow = own
            .soup
            .channels
            .iter()
            .filter(|channel| channel.arity <= MOST_WIDE);
        let channels = narrow.map(on_mesh).collect::<Result<_, _>>()?;
        let vertices = trace.vertices(&own.soup);
        let arguments = self.of_mesh(&arguments, &own, done);
        let shown = Shown::of(asset.largest(mesh), stretch);
        let control = Control::new(
            (built, diagnosis, trace.faces),
            shown,
            diagonal,
            &arguments,
            progress,
        )?;
        let mut channels = Channels::of_asset(channels, &arguments);
        channels.on_parts(&control.featured.concave.parts, &control.featured.mesh);
        let kept = kept_edges(&own, &control, &channels);
        let goals =
            Goals::new(&arguments, &control.featured.mesh, control.diagonal)?.keeping_origins(kept);
        let attributes = attribute_goals(
            (&own, stretch),
            &control,
            &channels,
            (&arguments, goals.length),
        )?;
        let goals = goals.with_attributes(attributes);
        let parameters = several::parameters(&arguments, &goals);
        if self.output.is_none() || arguments.exact.dry_run {
            let told = (
                self.input_report(&name, &own),
                (&control.diagnosis).into(),
                parameters,
            );
            return estimate::run(&control.featured.mesh, &goals, &arguments, told, progress);
        }
        let one = several::one(
            &name,
            (&control, &channels, &goals),
            (true, self.output),
            &arguments,
            progress,
        )?;
        let Control {
            featured, before, ..
        } = &control;
        let carried = Carried {
            trail: &one.refined.trail,
            control: featured.mesh.triangles(),
            parts: &featured.concave.parts,
            faces: &before.faces,
            vertices: &vertices,
        };
        let back = PutBack {
            own: &own,
            control: &featured.mesh,
            channels: &channels,
            refined: &one.refined,
            carried: &carried,
        };
        let told = back.put(asset, mesh, (stretch, arguments.scheme.in_quarters()?))?;
        for note in told.notes {
            progress.note(format!("{name}: {note}"));
        }
        let is_dropped = |table: &CornerAttribute| arguments.channels.drops(&table.name);
        leave_out(&mut done.left_out, &own, is_dropped, told.left_out);
        let told = (self.input_report(&name, &own), control, parameters);
        done.add((&name, mesh, stretch), one, told, &arguments);
        Ok(())
    }

    /// The mesh with the edges sharp that the document's normals say are, if that is asked for; if nothing is, a note counts them. And the
    /// arguments with what is sharp by its looks.
    fn sharpened(
        &self,
        name: &str,
        own: &MeshSoup,
        (mesh, trace): (Mesh, &Trace),
        progress: &Progress,
    ) -> anyhow::Result<(Mesh, RefineArguments)> {
        let normals = own
            .normals
            .as_ref()
            .map(|normals| normals.on_mesh(&own.soup, &mesh, trace))
            .transpose()?;
        let hints = Hints {
            is_tagged: false,
            normals: normals.as_ref(),
            channels: &[],
        };
        let (arguments, note) = looked_at(&self.arguments, (&mesh, &trace.faces), &hints);
        for note in note
            .into_iter()
            .chain(split_normals((&hints, &mesh), &arguments))
        {
            progress.note(format!("{name}: {note}"));
        }
        if normals.is_none() {
            return Ok((mesh, arguments));
        }
        let edges = hints.edges(&mesh, arguments.features.creases_from, name)?;
        Ok((mesh.with_creases(&edges), arguments))
    }

    /// What was repaired, and what stays apart.
    fn notes(
        &self,
        name: &str,
        own: &MeshSoup,
        diagnosis: &limitmesh::mesh::Diagnosis,
        progress: &Progress,
    ) {
        for line in diagnosis.repairs() {
            progress.note(format!("{name}: {line}"));
        }
        if own.borders > 0 {
            let edges = counted(own.borders, "edge", "edges");
            progress.note(format!(
                "{name}: {edges} where primitives meet others that stay are kept straight"
            ));
        }
        let KeptApart {
            moving,
            by_skins,
            by_morphs,
            touching,
            backs,
            ..
        } = own.kept_apart;
        if backs > 0 {
            let are = if backs == 1 {
                "face is the back of another"
            } else {
                "faces are the backs of others"
            };
            progress.note(format!(
                "{name}: {} {are}: both sides are kept, each as if alone",
                thousands(backs)
            ));
        }
        let vertices = |count| counted(count, "vertex", "vertices");
        if moving > 0 {
            let vertices = vertices(moving);
            let because = match (by_skins > 0, by_morphs > 0) {
                (true, false) => {
                    "of their joints and weights (--weld-ignores skin joins them)".to_owned()
                }
                (false, true) => "of morph targets (--weld-ignores morphs joins them)".to_owned(),
                _ => format!(
                    "of joints and morph targets (--weld-ignores skin joins {by_skins}, morphs {by_morphs}, skin,morphs all)"
                ),
            };
            progress.note(format!(
                "{name}: {vertices} kept apart where others stand, because {because}"
            ));
        }
        if touching > 0 {
            progress.note(format!(
                "{name}: {} of primitives that merely touch stay apart",
                vertices(touching)
            ));
        }
    }

    /// The arguments for a mesh: its share of the cap, and what keeps the borders of several primitives.
    fn of_mesh(
        &self,
        arguments: &RefineArguments,
        own: &MeshSoup,
        done: &Progressed,
    ) -> RefineArguments {
        let mut arguments = done.share(arguments);
        // A flat region has triangles across borders, and across the faces that values belong to.
        let is_kept = |own: &CornerAttribute| !self.arguments.channels.drops(&own.name);
        let has_values = own.attributes.iter().any(is_kept) || !own.influences.is_empty();
        if own.borders > 0 {
            // Where they stay straight around a corner of 180° and more, the surface would fold over.
            arguments
                .features
                .concave_corners
                .get_or_insert(ConcaveCorners::Divided);
        }
        arguments.exact.divide_flat |= own.parts.len() > 1 || has_values;
        arguments
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
        channels
            .iter()
            .map(|own| ChannelReport::chosen(own, &self.arguments.channels))
            .collect()
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
        let (Some(path), Some(format), false) =
            (&arguments.output, self.output, arguments.exact.dry_run)
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
            let missing =
                output::write_asset(path, asset, (format, arguments.asset.link_resources))?;
            for file in missing {
                progress.note(format!(
                    "{name}: {} is named in it, and was not found",
                    file.display()
                ));
            }
        }
        let writing = start.elapsed();
        let outcome = done.finish(
            name,
            [reading, writing],
            (arguments, ["mesh", "meshes"]),
            progress,
        )?;
        if let Some(picture) = &arguments.picture {
            let folder = arguments.input().parent();
            let scene = Asset::from_bytes(&asset.to_bytes(Format::Glb)?, folder)?.scene_soup()?;
            several::draw(picture, &scene, arguments, progress)?;
        }
        Ok(outcome)
    }
}

/// What is asked beside the shape: values of channels, and the surfaces that morph targets make, within `length` unless something
/// else is said.
fn attribute_goals(
    (own, stretch): (&MeshSoup, f64),
    control: &Control,
    channels: &Channels,
    (arguments, length): (&RefineArguments, Option<f64>),
) -> anyhow::Result<AttributeGoals> {
    let mesh = &control.featured.mesh;
    let mut goals = AttributeGoals::default();
    if arguments.way() != Way::Exact {
        return Ok(goals);
    }
    goals.add_channels(channels, mesh, &arguments.channels)?;
    let exact = &arguments.exact;
    let is_free = exact.triangles.is_none() && !exact.balance && !exact.optimize;
    let tolerance = match arguments.asset.morph_tolerance {
        Some(MorphTolerance::None) => None,
        Some(MorphTolerance::Within(extent)) => {
            Some(extent.length(control.diagonal, arguments.build.unit)?)
        }
        None => length.filter(|_| is_free),
    };
    let Some(tolerance) = tolerance else {
        return Ok(goals);
    };
    for table in own
        .attributes
        .iter()
        .filter(|table| table.is_displacement())
    {
        let channel = channels
            .all()
            .iter()
            .find(|channel| channel.name == table.name);
        if let Some(channel) = channel.filter(|channel| channel.values.iter().any(|&x| x != 0.0)) {
            let moved = mesh
                .clone()
                .with_positions(moved_positions(mesh, channel, stretch));
            let name = table.name.trim_end_matches(".POSITION").to_owned();
            goals.add_surface(name, moved.with_context(|| table.name.clone())?, tolerance);
        }
    }
    Ok(goals)
}

/// Edges of a control mesh that stay when others are collapsed: where attributes change, and between primitives.
fn kept_edges(own: &MeshSoup, control: &Control, channels: &Channels) -> Vec<[u32; 2]> {
    let Featured { mesh, concave, .. } = &control.featured;
    let primitive = |face: usize| {
        let input = control.before.faces[concave.parts.whole(face as u32) as usize] as usize;
        own.parts
            .iter()
            .position(|part| part.faces.contains(&input))
            .unwrap_or(0) as u32
    };
    let values = (0..own.parts.len()).map(|part| part as f64).collect();
    let primitives = Channel::new("primitives", Semantic::Label, Domain::Face, 1)
        .with(values, (0..mesh.face_count()).map(primitive).collect());
    let mut kept = borders(channels.all(), mesh);
    kept.extend(borders(&[primitives], mesh));
    kept.sort_unstable();
    kept.dedup();
    kept
}
