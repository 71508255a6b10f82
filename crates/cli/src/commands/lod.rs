//! `limitmesh lod`: levels of detail with geomorphs, in one glTF file or a file each.

use std::path::{Path, PathBuf};

use anyhow::Context;
use limitmesh::mesh::SplitSurface;
use limitmesh::refine::{
    Caps, ExactStop, Level, LodOptions, levels_of_detail_observed, switching_distance,
};
use limitmesh::scheme::Scheme;
use limitmesh::{Mesh, Triangles};
use limitmesh_io::gltf::{DetailLevel, write_levels};
use limitmesh_io::{Asset, Format, Output, Property, WriteOptions};

use super::channels::Channels;
use super::limit_control;
use super::named_files::Destination;
use super::normals::Normals;
use crate::arguments::{Extent, LodArguments, MOST_EXACT};
use crate::failure::{Outcome, usage};
use crate::format::{counted, number, table, thousands, upper_bound};
use crate::input;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use crate::report::{InputReport, LevelReport, LodReport, MorphReport, PictureReport, VERSION};
use crate::written_unit::WrittenUnit;

/// The defaults.
const USUAL_LEVELS: usize = 4;
const USUAL_TOLERANCE: Extent = Extent::Percent(0.1);
const USUAL_RATIO: f64 = 0.25;

/// An item of the soup's left-out list that comes along with the asset.
const MATERIALS: &str = "colours and textures of materials";

/// A level as it is written: a vertex for each side of sharp edges.
struct Written {
    split: SplitSurface,
    /// By vertex, its place on the coarser level and its normal there.
    coarser: Option<[Vec<[f64; 3]>; 2]>,
    channels: Channels,
}

impl Written {
    /// A note on vertices with several values.
    fn note(&self, format: Format) -> Option<String> {
        let surface = self.split.as_triangles();
        self.channels.note(
            format,
            surface,
            self.channels.split_vertices(format, surface),
        )
    }

    fn output(&self) -> Output<'_> {
        self.channels
            .add_to(Output::new(self.split.as_triangles()).normals(&self.split.normals))
    }
}

/// Makes the levels, writes them, and prints when to switch.
pub(crate) fn run(arguments: &LodArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    if output::is_standard_output(&arguments.output) {
        return usage(
            "levels of detail are written to files, not to standard output; give a name such as levels.glb",
        );
    }
    let format =
        Format::from_path(&arguments.output).or_else(|unknown| usage(unknown.to_string()))?;
    if arguments.morph && !format.is_gltf() && format != Format::Ply {
        let name = arguments.output.display();
        return usage(format!(
            "{name}: --morph needs a .glb, .gltf or .ply file: {format} files have no place for it"
        ));
    }
    if let Some(option) = arguments.channels.given_tolerance() {
        return usage(format!(
            "{option} is for `refine`; levels of detail go by --tolerance or --tolerances alone"
        ));
    }
    check_files(arguments, format)?;
    let mut kept = Normals::kept(Some(format)).to_vec();
    if format.is_gltf() {
        kept.push(MATERIALS);
    }
    let build = &arguments.limit.build;
    let mut read = input::read_for(&arguments.input, build, &arguments.channels, progress)?;
    let limit = limit_control::decided(&mut read, &arguments.limit, progress)?;
    let input = input::connect(read, build, &kept, progress)?;
    let diagonal = input.mesh.diagonal();
    let report = InputReport::of(&input, &arguments.channels);
    let prepared = limit_control::prepared(input, &limit, progress)?;
    let arguments = &LodArguments {
        limit: prepared.limit,
        ..arguments.clone()
    };
    let input = prepared.input;
    let mesh = &input.mesh;
    let unit = WrittenUnit::of(&arguments.input, &arguments.limit.build, format);
    unit.note(&arguments.output.display().to_string(), progress);
    let to = Destination {
        format: Some(format),
        ascii: arguments.ascii,
        chosen: &arguments.channels,
        files: (&arguments.input, Some(&arguments.output)),
    };
    let files = [input.material_libraries, input.texture_files];
    let mut channels = Channels::of_input(input.channels, files, &to, progress);
    channels.on_parts(&prepared.parts, mesh);
    let asset = input.asset.filter(|_| format.is_gltf());
    if asset.is_some() {
        progress.note("one mesh of all that the scene shows, in its coordinates, with its materials; nodes, skins, animations and cameras are left out");
    }

    let asked = LodOptions::new(tolerances(arguments, diagonal)?)
        .geomorphs(arguments.morph)
        .caps(Caps {
            triangles: Some(arguments.max_triangles.unwrap_or(MOST_EXACT)),
            ..Caps::default()
        });
    let scheme = arguments.limit.scheme().scheme();
    let mut levels = levels_of_detail_observed(mesh, scheme, &asked, &mut progress.observer())?;
    let found = levels.len();
    leave_out_needless(&mut levels, progress);
    let written = levels
        .iter()
        .rev()
        .map(|level| written(level, mesh, &channels, scheme));
    let written = written.collect::<anyhow::Result<Vec<_>>>()?;
    progress.notes(written.first().and_then(|finest| finest.note(format)));
    let reports = reports(&levels, mesh, arguments, format);
    progress.stage(format!("writing {}", arguments.output.display()));
    match format.is_gltf() {
        true => write_document(arguments, format, &unit, &written, &reports, asset.as_ref())?,
        false => write_files(arguments, format, &unit, &written)?,
    }
    progress.clear();
    progress.note(in_words(&reports, arguments));
    if let Some(path) = &arguments.report {
        let report = LodReport {
            version: VERSION,
            input: report,
            diagonal,
            certified: levels.iter().all(|level| level.exact.error.certified),
            picture: PictureReport {
                pixels: arguments.pixels,
                height: arguments.height,
                fov_degrees: arguments.fov,
            },
            levels: reports,
        };
        output::write_json(path, &report)?;
    }
    // Levels end with the first that could not be reached.
    let short = levels
        .last()
        .filter(|last| last.exact.stop != ExactStop::Met);
    Ok(short.map_or(Outcome::Done, |last| {
        Outcome::StoppedShort(in_short(last, found, &asked))
    }))
}

/// Why the last level is not as near as it should be: the one with that number, counted from 1, of those asked for.
fn in_short(last: &Level, which: usize, asked: &LodOptions) -> String {
    let stop = last.exact.stop;
    let cap = match (stop, asked.caps.triangles) {
        (ExactStop::TriangleCap, Some(most)) => format!("--max-triangles {}", thousands(most)),
        (ExactStop::LevelCap, _) => "the most that a face is divided".to_owned(),
        _ => stop.name().to_owned(),
    };
    format!(
        "{cap} was reached before level {which} of {}, counted from the coarsest, was within {}: LOD0 is as near as that allows",
        asked.tolerances.len(),
        number(last.tolerance),
    )
}

/// Checks before the work that what is to be written can be, replaces no input, and is written once.
fn check_files(arguments: &LodArguments, format: Format) -> anyhow::Result<()> {
    let levels = match arguments.tolerances.len() {
        0 => arguments.levels.unwrap_or(USUAL_LEVELS),
        given => given,
    };
    let files = if format.is_gltf() { 1 } else { levels };
    let mut written: Vec<PathBuf> = (0..files)
        .map(|lod| path(&arguments.output, format, lod))
        .collect();
    written.extend(arguments.report.clone());
    written
        .iter()
        .try_for_each(|path| output::check_writable(path))?;
    let written: Vec<&Path> = written.iter().map(PathBuf::as_path).collect();
    output::check_replaced(&written, &[&arguments.input], Some(arguments.overwrite))?;
    output::check_once(&written)
}

/// From the coarsest to the finest, in the mesh's unit.
fn tolerances(arguments: &LodArguments, diagonal: f64) -> anyhow::Result<Vec<f64>> {
    let length = |extent: &Extent| extent.length(diagonal, arguments.limit.build.unit);
    let lengths: Vec<f64> = if arguments.tolerances.is_empty() {
        let finest = length(&arguments.tolerance.unwrap_or(USUAL_TOLERANCE))?;
        let ratio = arguments.ratio.unwrap_or(USUAL_RATIO);
        let levels = 0..arguments.levels.unwrap_or(USUAL_LEVELS);
        levels
            .rev()
            .map(|level| finest / ratio.powi(level as i32))
            .collect()
    } else {
        arguments
            .tolerances
            .iter()
            .map(length)
            .collect::<anyhow::Result<_>>()?
    };
    if let Some(at) = lengths.windows(2).position(|pair| pair[1] >= pair[0]) {
        return usage(format!(
            "--tolerances are from coarse to fine, each below the one before; number {} is {} in the mesh's unit, after {}",
            at + 2,
            number(lengths[at + 1]),
            number(lengths[at])
        ));
    }
    Ok(lengths)
}

/// Leaves out coarsest levels that are as near as the next finer one, or nearer: no level is coarser than the control mesh.
fn leave_out_needless(levels: &mut Vec<Level>, progress: &Progress) {
    while let [coarsest, finer, ..] = levels.as_mut_slice()
        && (finer.parametric >= coarsest.parametric
            || finer.exact.mesh.face_count() == coarsest.exact.mesh.face_count())
    {
        let [own, next] = [&*coarsest, &*finer].map(|level| level.exact.mesh.face_count());
        progress.note(format!(
            "the level within {}, of {}, is left out: {}",
            number(coarsest.tolerance),
            counted(own, "triangle", "triangles"),
            match own == next {
                true =>
                    "the next finer one has as many, since none is coarser than the control mesh"
                        .to_owned(),
                false => format!(
                    "place by place, the next finer one, of {}, is no nearer",
                    thousands(next)
                ),
            }
        ));
        finer.geomorph = None;
        levels.remove(0);
    }
}

fn written(
    level: &Level,
    control: &Mesh,
    channels: &Channels,
    scheme: &dyn Scheme,
) -> anyhow::Result<Written> {
    let channels = channels.refined(control, &level.exact, scheme)?;
    let (split, normals) = level.split_surface();
    let coarser = level.geomorph.as_ref().map(|morph| {
        let sources = split.sources.iter();
        let positions = sources.map(|&v| morph.positions[v as usize]).collect();
        [positions, normals]
    });
    Ok(Written {
        split,
        coarser,
        channels,
    })
}

/// The reports on the levels, the finest first.
fn reports(
    levels: &[Level],
    control: &Mesh,
    arguments: &LodArguments,
    format: Format,
) -> Vec<LevelReport> {
    let (pixels, height, fov) = (
        arguments.pixels,
        arguments.height,
        arguments.fov.to_radians(),
    );
    let distance = |deviation| switching_distance(deviation, pixels, height, fov);
    // The part of the picture's height that a ball around the control mesh takes where its nearest point is so far away.
    let coverage = |distance: f64| {
        let radius = 0.5 * control.diagonal();
        (radius / ((distance + radius) * (0.5 * fov).tan())).min(1.0)
    };
    // Between morphing levels each place counts; without morphs levels are shown as they are.
    let shown = |level: &Level| match level.exact.error.upper {
        upper if upper.is_finite() && !arguments.morph => upper,
        _ => level.parametric,
    };
    // Where a level is farther off than a coarser one, that waits for it.
    let shown = |at: usize| levels[at..].iter().map(shown).fold(0.0, f64::max);
    let report = |(lod, (i, level)): (usize, (usize, &Level))| {
        let exact = &level.exact;
        // Where the coarser level takes over: it is good enough from there on.
        let coarser = i.checked_sub(1).map(shown);
        let start = level.geomorph.as_ref().zip(coarser);
        let start = start.map(|(morph, coarser)| morph.start.max(coarser));
        let ends = start.or(coarser);
        LevelReport {
            lod,
            path: path(&arguments.output, format, lod).display().to_string(),
            vertices: exact.mesh.vertex_count(),
            triangles: exact.mesh.face_count(),
            tolerance: level.tolerance,
            lower: exact.error.lower,
            upper: Some(exact.error.upper).filter(|upper| upper.is_finite()),
            parametric: level.parametric,
            switching_distance: distance(shown(i)),
            least_coverage: ends.map_or(0.0, |deviation| coverage(distance(deviation))),
            morph: start.map(|start| MorphReport {
                start_parametric: start,
                from_distance: distance(shown(i)),
                to_distance: distance(start),
            }),
            stop: exact.stop.name(),
        }
    };
    let finest_first = levels.iter().enumerate().rev().enumerate();
    finest_first.map(report).collect()
}

/// The file of a level.
fn path(output: &Path, format: Format, lod: usize) -> PathBuf {
    if format.is_gltf() {
        return output.to_owned();
    }
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push(format!("_LOD{lod}."));
    name.push(output.extension().unwrap_or_default());
    output.with_file_name(name)
}

/// Writes all levels into one document.
fn write_document(
    arguments: &LodArguments,
    format: Format,
    unit: &WrittenUnit<'_>,
    levels: &[Written],
    reports: &[LevelReport],
    asset: Option<&Asset>,
) -> anyhow::Result<()> {
    let levels = levels.iter().zip(reports).map(|(level, report)| {
        let own = DetailLevel::new(level.output()).least_coverage(report.least_coverage);
        match &level.coarser {
            Some([positions, normals]) => own.coarser(positions, normals),
            None => own,
        }
    });
    let levels: Vec<DetailLevel<'_>> = levels.collect();
    let path = &arguments.output;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let unit = unit.options(WriteOptions::default()).unit;
    let write = || write_levels(path, format, &name, &levels, asset, unit);
    interrupt::whole_or_not(path, write).context("levels of detail")
}

/// Writes each level into a file of its own.
fn write_files(
    arguments: &LodArguments,
    format: Format,
    unit: &WrittenUnit<'_>,
    levels: &[Written],
) -> anyhow::Result<()> {
    let options = unit.options(WriteOptions::default().ascii(arguments.ascii));
    for (lod, level) in levels.iter().enumerate() {
        let coarser = level.coarser.iter().flat_map(|[positions, _]| positions);
        let coarse = [0, 1, 2].map(|axis| coarser.clone().map(|p| p[axis]).collect::<Vec<f64>>());
        let named = ["coarse_x", "coarse_y", "coarse_z"].iter().zip(&coarse);
        let named = named.filter(|_| level.coarser.is_some());
        let properties = named.map(|(name, own)| Property::numbers(name, own));
        let properties: Vec<Property<'_>> = properties.collect();
        let mut written = level.output().vertex_properties(&properties);
        let positions = unit.positions(written.surface.positions);
        written.surface = Triangles {
            positions: &positions,
            ..written.surface
        };
        let path = path(&arguments.output, format, lod);
        output::write_mesh(&path, format, &written, &options)?;
    }
    Ok(())
}

fn in_words(reports: &[LevelReport], arguments: &LodArguments) -> String {
    let head = [
        "level",
        "triangles",
        "distance to the surface",
        "place by place",
        "from a distance of",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(reports.iter().map(|report| {
        let interval = match report.upper {
            Some(upper) => format!("{} to {}", number(report.lower), upper_bound(upper)),
            None => format!("{} at least", number(report.lower)),
        };
        let name = format!("LOD{}", report.lod);
        let distance = number(report.switching_distance);
        vec![
            name,
            thousands(report.triangles),
            interval,
            upper_bound(report.parametric),
            distance,
        ]
    }));
    let levels = counted(reports.len(), "level", "levels");
    let of = arguments.output.display();
    format!(
        "{of}: {levels}, each off by {} px at most from its distance on\n{}",
        arguments.pixels,
        table(&rows)
    )
}
