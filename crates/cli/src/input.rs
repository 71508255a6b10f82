//! Input: a file, standard input or a built-in model becomes a control mesh, with what was found on the way.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Context;
use limitmesh::mesh::{
    BuildOptions, Channel, ChannelError, Diagnosis, MeshError, PolygonFaces, Trace, Weld,
};
use limitmesh::{Mesh, PolygonSoup, QuadControl, QuadOptions};
use limitmesh_io::channels::NORMALS;
use limitmesh_io::gltf::AssetContents;
use limitmesh_io::threemf::PackageContents;
use limitmesh_io::{Asset, Format, Package};

use crate::arguments::{BuildArguments, ChannelArguments, CreasesFrom, Unit};
use crate::creases::Hints;
use crate::failure::usage;
use crate::format::{counted, thousands};
use crate::progress::Progress;

/// The prefix of a built-in model's name.
const BUILTIN: &str = "builtin:";

/// Standard input where a file is expected.
const STANDARD_INPUT: &str = "-";

/// The contents of a file or a built-in model.
pub(crate) struct Soup {
    /// As given on the command line.
    pub(crate) name: String,
    /// `obj`, `ply`, `stl`, `off`, `gltf`, `glb`, `3mf` or `builtin`.
    pub(crate) format: &'static str,
    /// Positions, polygons and tags.
    pub(crate) soup: PolygonSoup,
    /// Normals of its corners or vertices, which say where edges were meant to be sharp.
    pub(crate) normals: Option<Channel>,
    /// The glTF document, if it was one, and what else that holds.
    pub(crate) asset: Option<(Asset, AssetContents)>,
    /// The contents of a 3MF package.
    pub(crate) package: Option<PackageContents>,
    /// The unit of its numbers, by itself or by `--unit`.
    pub(crate) unit: Option<Unit>,
    /// The rules by which its polygons become quads, where they are to.
    pub(crate) quads: Option<QuadOptions>,
    /// Time taken to read or generate it.
    pub(crate) reading: Duration,
}

impl Soup {
    /// Whether most of its faces are quads.
    pub(crate) fn is_of_quads(&self) -> bool {
        is_of_quads(&self.soup.faces)
    }

    /// It with the triangles that a glTF document has for polygons, where these do not become quads.
    fn with_cut_polygons(mut self) -> anyhow::Result<Self> {
        let has_polygons = self.soup.faces.iter().any(|face| face.len() > 3);
        let Some((asset, _)) = &self.asset else {
            return Ok(self);
        };
        if self.quads.is_some() || !has_polygons {
            return Ok(self);
        }
        let cut = asset.scene_triangles()?;
        for own in self.soup.channels.iter_mut().chain(&mut self.normals) {
            if let Some(cut) = cut.channels.iter().find(|cut| cut.name == own.name) {
                (own.values, own.indices) = (cut.values.clone(), cut.indices.clone());
            }
        }
        (self.soup.positions, self.soup.faces) = (cut.positions, cut.faces);
        Ok(self)
    }
}

/// Whether most faces are quads: they are then a cage for Catmull–Clark's scheme, as modelling programs mean it.
pub(crate) fn is_of_quads(faces: &PolygonFaces) -> bool {
    let quads = faces.iter().filter(|face| face.len() == 4);
    2 * quads.count() > faces.len()
}

/// A note that a file's faces decide the scheme.
pub(crate) fn of_quads(name: &str) -> String {
    format!("{name}: its faces are quads for the most part, so that --scheme catmull-clark holds")
}

impl Input {
    /// Its hints of sharp edges, apart from tags.
    pub(crate) fn hints(&self) -> Hints<'_> {
        Hints {
            is_tagged: self.is_tagged,
            normals: self.normals.as_ref(),
            channels: &self.channels,
        }
    }

    /// Its mesh with the edges sharp that are to be, by what it says.
    ///
    /// # Errors
    /// It says nothing of that kind.
    pub(crate) fn with_creases(self, from: CreasesFrom) -> anyhow::Result<Self> {
        let edges = self.hints().edges(&self.mesh, from, &self.name)?;
        Ok(Self {
            mesh: self.mesh.with_creases(&edges),
            ..self
        })
    }

    /// It with its numbers measured in another unit, where both are known.
    ///
    /// # Errors
    /// They are beyond what numbers hold then.
    pub(crate) fn in_unit(self, other: Option<Unit>, progress: &Progress) -> anyhow::Result<Self> {
        let Some(factor) = factor(self.unit, other, &self.name, progress) else {
            return Ok(self);
        };
        let positions = self
            .mesh
            .positions()
            .iter()
            .map(|p| p.map(|x| factor * x))
            .collect();
        Ok(Self {
            mesh: self.mesh.with_positions(positions)?,
            unit: other,
            ..self
        })
    }
}

/// The factor from one unit to another, where both are known and differ; a note names it for the file `name`.
pub(crate) fn factor(
    own: Option<Unit>,
    other: Option<Unit>,
    name: &str,
    progress: &Progress,
) -> Option<f64> {
    let (own, other) = own.zip(other).filter(|(own, other)| own != other)?;
    progress.note(format!(
        "{name}: its {} are taken to {}",
        own.name(),
        other.name()
    ));
    Some(own.in_others(other))
}

/// A control mesh and where it came from.
pub(crate) struct Input {
    /// As given on the command line.
    pub(crate) name: String,
    /// `obj`, `ply`, `stl`, `off`, `gltf`, `glb`, `3mf` or `builtin`.
    pub(crate) format: &'static str,
    /// The contents of the file that were left out, in words.
    pub(crate) left_out: Vec<String>,
    /// Whether it tags edges or vertices as sharp.
    pub(crate) is_tagged: bool,
    /// The mesh.
    pub(crate) mesh: Mesh,
    /// Findings and repairs.
    pub(crate) diagnosis: Diagnosis,
    /// The input's face that each face of the mesh is from, and the corners.
    pub(crate) trace: Trace,
    /// Normals of the corners, as the file has them.
    pub(crate) normals: Option<Channel>,
    /// Values of the mesh's corners and faces.
    pub(crate) channels: Vec<Channel>,
    /// Files that describe the materials that channels name.
    pub(crate) material_libraries: Vec<String>,
    /// Pictures that texture coordinates are places on.
    pub(crate) texture_files: Vec<String>,
    /// The glTF document, if it was one.
    pub(crate) asset: Option<Asset>,
    /// The unit of its numbers, by itself or by `--unit`.
    pub(crate) unit: Option<Unit>,
    /// Time taken to read or generate it.
    pub(crate) reading: Duration,
    /// Time taken to repair and connect it.
    pub(crate) building: Duration,
}

/// Reads a file, standard input for `-`, or generates the model after `builtin:`.
///
/// # Errors
/// The file cannot be read, or there is no such model; the message lists those that there are.
pub(crate) fn read(
    path: &Path,
    build: &BuildArguments,
    progress: &Progress,
) -> anyhow::Result<Soup> {
    let name = display_name(path);
    progress.stage(format!("reading {name}"));
    let start = Instant::now();
    let (mut document, mut held, mut unit) = (None, None, build.unit);
    let (soup, format) = match builtin_name(path) {
        Some(model) => (builtin(model)?, "builtin"),
        None => {
            let format = format_of(path, build.from)?;
            let soup = if format.is_gltf() {
                let asset = asset(path)?;
                let (soup, contents) = (asset.scene_soup()?, asset.contents()?);
                unit.get_or_insert(Unit::M);
                document = Some((asset, contents));
                soup
            } else if format == Format::ThreeMf {
                let package = package(path)?;
                unit = Some(unit_of_package(&package, build.unit, &name)?);
                held = Some(package.contents());
                package.scene_soup()?
            } else if path.as_os_str() == STANDARD_INPUT {
                let bytes = standard_input()?;
                let soup = limitmesh_io::read_bytes(&bytes, format);
                soup.map_err(|why| anyhow::anyhow!("{name}: {why}"))?
            } else {
                limitmesh_io::read_as(path, format)?
            };
            (soup, format.extension())
        }
    };
    let mut soup: PolygonSoup = soup;
    let normals = soup
        .channels
        .iter()
        .position(|channel| channel.name == NORMALS && channel.arity == 3);
    let normals = normals.map(|at| soup.channels.remove(at));
    Ok(Soup {
        name,
        format,
        soup,
        normals,
        asset: document,
        package: held,
        unit,
        quads: None,
        reading: start.elapsed(),
    })
}

/// Opens a glTF document: a file, or standard input for `-`.
///
/// # Errors
/// It cannot be read, or breaks the rules.
pub(crate) fn asset(path: &Path) -> anyhow::Result<Asset> {
    if path.as_os_str() == STANDARD_INPUT {
        let bytes = standard_input()?;
        return Asset::from_bytes(&bytes, None)
            .map_err(|why| anyhow::anyhow!("standard input: {why}"));
    }
    Ok(Asset::open(path)?)
}

/// Opens a 3MF package: a file, or standard input for `-`.
///
/// # Errors
/// It cannot be read, or breaks the rules.
pub(crate) fn package(path: &Path) -> anyhow::Result<Package> {
    if path.as_os_str() == STANDARD_INPUT {
        return Package::from_bytes(standard_input()?)
            .map_err(|why| anyhow::anyhow!("standard input: {why}"));
    }
    Ok(Package::open(path)?)
}

/// The unit of a package that is called `name`.
///
/// # Errors
/// Another one was given.
pub(crate) fn unit_of_package(
    package: &Package,
    given: Option<Unit>,
    name: &str,
) -> anyhow::Result<Unit> {
    let own = Unit::of_package(package.unit())?;
    match given.filter(|&given| given != own) {
        Some(given) => usage(format!(
            "--unit {}: {name} says that it is in {}",
            given.name(),
            own.name()
        )),
        None => Ok(own),
    }
}

fn standard_input() -> anyhow::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    std::io::stdin()
        .lock()
        .read_to_end(&mut bytes)
        .context("standard input cannot be read")?;
    Ok(bytes)
}

/// Refuses to read standard input twice.
pub(crate) fn check_once<'a>(inputs: impl Iterator<Item = &'a PathBuf>) -> anyhow::Result<()> {
    match inputs
        .filter(|path| path.as_os_str() == STANDARD_INPUT)
        .count()
    {
        0 | 1 => Ok(()),
        _ => usage("standard input can be read once only"),
    }
}

/// How an input is called in messages and reports.
pub(crate) fn display_name(path: &Path) -> String {
    if path.as_os_str() == STANDARD_INPUT {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    }
}

/// The name of a built-in model, if that is what is asked for.
pub(crate) fn builtin_name(path: &Path) -> Option<&str> {
    path.to_str()?.strip_prefix(BUILTIN)
}

/// The format that a name says, or where it says none the one that was given.
///
/// # Errors
/// Neither says which.
pub(crate) fn format_of(path: &Path, given: Option<Format>) -> anyhow::Result<Format> {
    match (Format::from_path(path), given) {
        (Ok(format), _) => Ok(format),
        (Err(_), Some(given)) => Ok(given),
        (Err(_), None) if path.as_os_str() == STANDARD_INPUT => {
            usage("standard input has no name that says its format; --from FORMAT does")
        }
        (Err(_), None) if path.is_dir() => usage(format!(
            "{0} is a folder; give its files, such as {0}/*.stl",
            path.display()
        )),
        (Err(unknown), None) => Err(unknown.into()),
    }
}

fn builtin(name: &str) -> anyhow::Result<PolygonSoup> {
    let model = limitmesh_models::find(name).with_context(|| {
        let names: Vec<&str> = limitmesh_models::all()
            .iter()
            .map(|model| model.name)
            .collect();
        format!(
            "there is no built-in model '{name}'; there are: {}",
            names.join(", ")
        )
    })?;
    Ok(model.soup())
}

/// Reads a control mesh; notes what was left out, but for what is `kept`, and what had to be repaired.
///
/// # Errors
/// As for [`read`] and [`connect`].
pub(crate) fn load(
    path: &Path,
    build: &BuildArguments,
    kept: &[&str],
    progress: &Progress,
) -> anyhow::Result<Input> {
    connect(read(path, build, progress)?, build, kept, progress)
}

/// [`read`] for refinement, where channels are as `channels` asks.
///
/// # Errors
/// As for [`read`]; or there is no channel of a name that is asked for.
pub(crate) fn read_for(
    path: &Path,
    build: &BuildArguments,
    channels: &ChannelArguments,
    progress: &Progress,
) -> anyhow::Result<Soup> {
    let mut read = read(path, build, progress)?;
    let names = read
        .soup
        .channels
        .iter()
        .map(|channel| channel.name.as_str());
    channels.check(&read.name, names)?;
    channels.apply(&mut read.soup.channels)?;
    Ok(read)
}

/// A control mesh of what was read; notes what was left out, but for what is `kept`, and what had to be repaired.
///
/// # Errors
/// No mesh can be made of it, or only by a repair that `build` forbids.
pub(crate) fn connect(
    read: Soup,
    build: &BuildArguments,
    kept: &[&str],
    progress: &Progress,
) -> anyhow::Result<Input> {
    let input = connected(read, build, progress)?;
    let name = &input.name;
    let words = input.left_out.iter().map(String::as_str);
    let lost: Vec<&str> = words.filter(|words| !kept.contains(words)).collect();
    if !lost.is_empty() {
        progress.note(format!("{name}: left out: {}", lost.join("; ")));
    }
    progress.notes(
        input
            .diagnosis
            .repairs()
            .iter()
            .map(|line| format!("{name}: {line}")),
    );
    Ok(input)
}

/// What a soup becomes.
pub(crate) enum ControlMesh {
    Triangles(Mesh, Trace),
    Quads(QuadControl),
}

impl ControlMesh {
    /// Of a soup; its polygons become quads by these rules, if there are any, or else triangles.
    ///
    /// # Errors
    /// As for [`Mesh::from_soup`].
    pub(crate) fn of(
        soup: &PolygonSoup,
        options: &BuildOptions,
        quads: Option<&QuadOptions>,
    ) -> Result<(Self, Diagnosis), MeshError> {
        Ok(match quads {
            None => {
                let (mesh, diagnosis, trace) = Mesh::from_soup_traced(soup, options)?;
                (Self::Triangles(mesh, trace), diagnosis)
            }
            Some(rules) => {
                let (quads, diagnosis) = QuadControl::from_soup_with(soup, options, rules)?;
                (Self::Quads(quads), diagnosis)
            }
        })
    }

    /// A channel of the soup on the mesh.
    ///
    /// # Errors
    /// It does not fit the soup.
    pub(crate) fn channel(
        &self,
        soup: &PolygonSoup,
        channel: &Channel,
    ) -> Result<Channel, ChannelError> {
        match self {
            Self::Triangles(mesh, trace) => channel.on_mesh(soup, mesh, trace),
            Self::Quads(quads) => quads.channel(soup, channel),
        }
    }

    pub(crate) fn into_parts(self) -> (Mesh, Trace) {
        match self {
            Self::Triangles(mesh, trace) => (mesh, trace),
            Self::Quads(quads) => (quads.mesh, quads.trace),
        }
    }
}

/// A control mesh of what was read; notes where edges nearly close.
///
/// # Errors
/// No mesh can be made of it, or only by a repair that `build` forbids.
pub(crate) fn connected(
    read: Soup,
    build: &BuildArguments,
    progress: &Progress,
) -> anyhow::Result<Input> {
    let options = &build.in_unit(read.unit).options()?;
    let read = read.with_cut_polygons()?;
    let (name, mut soup) = (read.name, read.soup);
    let faces = counted(soup.faces.len(), "face", "faces");
    progress.stage(format!("connecting {faces}"));
    let start = Instant::now();
    let built = ControlMesh::of(&soup, options, read.quads.as_ref());
    let (control, diagnosis) = built.map_err(|error| describe(&name, error))?;
    let on_mesh = |channel: &Channel| control.channel(&soup, channel);
    let channels = soup.channels.iter().map(on_mesh).collect::<Result<_, _>>();
    let channels = channels.with_context(|| name.clone())?;
    let normals = read.normals.as_ref().map(on_mesh).transpose();
    let normals = normals.with_context(|| name.clone())?;
    let (mesh, trace) = control.into_parts();
    let triangles = |weld| {
        let options = BuildOptions::default().weld(weld);
        Some(Mesh::from_soup(&soup, &options).ok()?.0)
    };
    let near = nearly_closed(&mesh, options.weld, triangles);
    progress.notes(near.map(|near| format!("{name}: {near}")));
    let input = Input {
        name,
        format: read.format,
        left_out: std::mem::take(&mut soup.left_out),
        is_tagged: !soup.creases.is_empty() || !soup.corners.is_empty(),
        mesh,
        diagnosis,
        trace,
        normals,
        channels,
        material_libraries: std::mem::take(&mut soup.material_libraries),
        texture_files: std::mem::take(&mut soup.texture_files),
        asset: read.asset.map(|(asset, _)| asset),
        unit: read.unit,
        reading: read.reading,
        building: Duration::ZERO,
    };
    // Large soups are given back before refinement needs the memory.
    drop(soup);
    Ok(Input {
        building: start.elapsed(),
        ..input
    })
}

/// Vertices nearer to each other than this share of the diagonal are usually one, written with too few digits: about
/// ten steps of single precision.
const NEAR: f64 = 1e-6;

/// Reports where open edges of a mesh would close if nearly equal positions were merged too; `build` makes it anew of triangles for that.
pub(crate) fn nearly_closed(
    mesh: &Mesh,
    weld: Weld,
    build: impl Fn(Weld) -> Option<Mesh>,
) -> Option<String> {
    let mut open = mesh.topology().boundary_edge_count();
    if open == 0 || weld != Weld::Exact {
        return None;
    }
    // The edges of quads may be halves of those of polygons.
    if mesh.topology().has_quads() {
        open = build(weld)?.topology().boundary_edge_count();
    }
    // As it would be typed: one digit.
    let distance: f64 = format!("{:.0e}", NEAR * mesh.diagonal()).parse().ok()?;
    let left = build(Weld::Within(distance))?
        .topology()
        .boundary_edge_count();
    (left < open).then(|| {
        let closing = if left == 0 { "all of them".to_owned() } else { thousands(open - left) };
        let open = counted(open, "edge is open", "edges are open");
        format!("{open}; {closing} would close with --weld {distance:e}, which merges nearly equal positions")
    })
}

/// An error of building with the input's name before it.
pub(crate) fn describe(name: &str, error: MeshError) -> anyhow::Error {
    anyhow::Error::new(error).context(format!("{name} gives no control mesh"))
}
