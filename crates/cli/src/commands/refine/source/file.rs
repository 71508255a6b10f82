//! One mesh: read from a file or a built-in model, and written to another file with what it carries, its proof and its picture.

use limitmesh::mesh::{Channel, Semantic, Tags};
use limitmesh_io::Format;

use super::super::control::Read;
use super::super::refined::Refined;
use super::super::task::Task;
use super::super::{proof, written};
use super::item::{Item, Source, sharpened};
use crate::arguments::{RefineArguments, RefiningScheme};
use crate::bulk::Shown;
use crate::commands::channels::Channels;
use crate::commands::named_files::Destination;
use crate::commands::normals::Normals;
use crate::commands::{picture, shading};
use crate::creases::Hints;
use crate::format::counted;
use crate::input::{self, Input, of_quads};
use crate::progress::Progress;
use crate::report::InputReport;

/// A file of one mesh.
pub(crate) struct FileSource {
    /// The format to write; none for a dry run without a name.
    pub(crate) format: Option<Format>,
}

impl Source for FileSource {
    type Own = ();
    const NOUNS: Option<[&'static str; 2]> = None;

    fn item(
        &mut self,
        _: usize,
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<Option<(Read, Item<()>)>> {
        let kept = Normals::kept(self.format);
        let (build, channels) = (&arguments.build, &arguments.channels);
        let mut read = input::read_for(arguments.input(), build, channels, progress)?;
        let is_of_quads = read.is_of_quads();
        let arguments = &by_faces(arguments, &read.name, is_of_quads, progress);
        read.quads = arguments.quads();
        let input = input::connect(read, build, kept, progress)?;
        item_of(input, arguments, self.format, progress).map(Some)
    }

    fn put(&mut self, _: &Item<()>, refined: &mut Refined, task: &Task<'_>) -> anyhow::Result<()> {
        let (Some(path), Some(format)) = (&task.arguments.output, task.format) else {
            return Ok(());
        };
        let is_split = written::notes(format, task.arguments, refined, task.progress);
        written::write(path, format, is_split, task.arguments, refined)
    }

    fn prove_and_draw(&self, refined: &mut Refined, task: &Task<'_>) -> anyhow::Result<()> {
        if let Some(path) = &task.arguments.proof {
            task.progress.stage("checking the proof");
            proof::write(path, refined, task)?;
        }
        if let Some(path) = &task.arguments.picture {
            draw(path, refined, task)?;
        }
        Ok(())
    }
}

/// The arguments with the scheme that the faces of what is called `name` decide, where none was asked for.
pub(crate) fn by_faces(
    arguments: &RefineArguments,
    name: &str,
    is_of_quads: bool,
    progress: &Progress,
) -> RefineArguments {
    if arguments.asked_scheme().is_some() || !is_of_quads {
        return arguments.clone();
    }
    if let Some(option) = arguments.needs_triangles() {
        progress.note(format!(
            "{name}: its quads are cut into triangles, as {option} is for these: --scheme loop holds"
        ));
        return arguments.clone();
    }
    progress.note(of_quads(name));
    RefineArguments {
        scheme: Some(RefiningScheme::CatmullClark),
        ..arguments.clone()
    }
}

/// The mesh of an input with its sharp edges, and what of it reaches the output.
///
/// # Errors
/// The input does not fit the arguments.
pub(crate) fn item_of(
    input: Input,
    arguments: &RefineArguments,
    format: Option<Format>,
    progress: &Progress,
) -> anyhow::Result<(Read, Item<()>)> {
    let arguments = &RefineArguments {
        build: arguments.build.in_unit(input.unit),
        ..arguments.clone()
    };
    let report = InputReport::of(&input, &arguments.channels);
    let lost = format.and_then(|format| lost_tags(input.mesh.tags(), format));
    let hints = Hints {
        is_tagged: input.is_tagged,
        normals: input.normals.as_ref(),
        channels: &input.channels,
    };
    let sharp = sharpened(
        input.mesh,
        &input.trace.faces,
        &hints,
        &input.name,
        arguments,
    )?;
    progress.notes(sharp.notes.into_iter().chain(lost));
    let arguments = sharp.arguments;
    let own = match arguments.way().is_sqrt3() {
        true => without_channels(&input.channels, progress),
        false => input.channels,
    };
    let files = [input.material_libraries, input.texture_files];
    let channels = Channels::of_input(own, files, &Destination::of(&arguments, format), progress);
    let is_texture = |own: &Channel| own.semantic == Semantic::TextureCoordinates;
    let names = channels
        .all()
        .iter()
        .map(|own| (own.name.as_str(), is_texture(own)));
    arguments.channels.check_tolerances(&input.name, names)?;
    let read = Read {
        mesh: sharp.mesh,
        diagnosis: input.diagnosis,
        faces: input.trace.faces,
        shown: Shown::default(),
    };
    let item = Item {
        own: (),
        number: 0,
        name: None,
        scale: 1.0,
        arguments,
        channels,
        input: report,
        is_traced: false,
        reading: input.reading,
        building: input.building,
    };
    Ok((read, item))
}

/// Leaves out what the input carries, and says so.
fn without_channels(channels: &[Channel], progress: &Progress) -> Vec<Channel> {
    if !channels.is_empty() {
        let names: Vec<&str> = channels
            .iter()
            .map(|channel| channel.name.as_str())
            .collect();
        let names = names.join("; ");
        progress.note(format!(
            "left out: {names} (--scheme sqrt3 carries no values)"
        ));
    }
    Vec::new()
}

/// A note about tags of the input that the output's format has no place for.
fn lost_tags(tags: &Tags, format: Format) -> Option<String> {
    if tags.is_empty() || format == Format::Obj {
        return None;
    }
    let kinds = [
        (tags.creases.len(), "crease tag", "crease tags"),
        (tags.corners.len(), "corner tag", "corner tags"),
    ];
    let found = kinds.into_iter().filter(|&(count, ..)| count > 0);
    let found: Vec<String> = found
        .map(|(count, one, many)| counted(count, one, many))
        .collect();
    let found = found.join(" and ");
    Some(format!(
        "{found}: followed, but left out of the output, whose format has none"
    ))
}

/// Draws a refined mesh, shaded by its normals if it has some.
fn draw(path: &std::path::Path, refined: &Refined, task: &Task<'_>) -> anyhow::Result<()> {
    let split;
    let (surface, normals) = match &refined.normals {
        Some(normals) => normals.surface(&refined.mesh),
        None => {
            split = shading::without_normals(&refined.mesh)?;
            (split.as_triangles(), &split.normals[..])
        }
    };
    let sight = task.arguments.sight();
    picture::draw_edges(path, surface, normals, sight, task.progress)
}
