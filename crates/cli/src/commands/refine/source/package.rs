//! 3MF in, 3MF out: each object that has a mesh is refined once, and everything else stays as it is.
//!
//! An object is refined at the scale of its largest appearance in the build, so that all lengths are the build's; the result is
//! divided by that again. Triangles inherit what the one that they came from has.

use std::time::{Duration, Instant};

use limitmesh::mesh::{BuildOptions, Trace, Weld};
use limitmesh_io::threemf::{Inherited, NewTriangles, ObjectSoup, Source as Origin};
use limitmesh_io::{Format, Package};

use super::super::control::Read;
use super::super::refined::Refined;
use super::super::task::Task;
use super::carried::Carried;
use super::item::{Item, Source, sharpened};
use super::scene;
use crate::arguments::RefineArguments;
use crate::bulk::Shown;
use crate::commands::channels::Channels;
use crate::creases::Hints;
use crate::format::counted;
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::report::{ChannelReport, InputReport};

/// A 3MF package whose objects are refined.
pub(crate) struct PackageSource {
    package: Package,
    diagonal: f64,
    reading: Duration,
    left_out: Vec<String>,
}

impl PackageSource {
    /// Opens the package that a command line asks to edit; gives also the arguments with lengths in its unit.
    ///
    /// # Errors
    /// It cannot be read, or an argument has no meaning for it.
    pub(crate) fn open(
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<(Self, RefineArguments)> {
        scene::check_viewers(arguments)?;
        let mut arguments = arguments.clone();
        let name = input::display_name(arguments.input());
        progress.stage(format!("reading {name}"));
        let start = Instant::now();
        let package = input::package(arguments.input())?;
        let Some(bounds) = package.bounding_box()? else {
            anyhow::bail!("{name}: nothing is built that has triangles");
        };
        let unit = input::unit_of_package(&package, arguments.build.unit, &name)?;
        arguments.build = arguments.build.in_unit(Some(unit));
        let contents = package.contents();
        let names = contents
            .objects
            .iter()
            .flat_map(|object| &object.attributes);
        arguments.channels.check(&name, names.map(String::as_str))?;
        arguments.channels.check_inherited()?;
        let diagonal = scene::diagonal(bounds);
        scene::set_lengths(&mut arguments, diagonal)?;
        let source = Self {
            package,
            diagonal,
            reading: start.elapsed(),
            left_out: arguments.channels.dropped(),
        };
        Ok((source, arguments))
    }
}

impl Source for PackageSource {
    /// By corner of the mesh that was read, the object's corner.
    type Own = Vec<u32>;
    const NOUNS: Option<[&'static str; 2]> = Some(["object", "objects"]);

    fn count(&self) -> usize {
        self.package.object_count()
    }

    fn diagonal(&self) -> Option<f64> {
        Some(self.diagonal)
    }

    fn item(
        &mut self,
        number: usize,
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<Option<(Read, Item<Vec<u32>>)>> {
        let name = self.package.object_name(number);
        let weld = arguments.build.options()?.weld;
        let mut own = self.package.object(number, weld != Weld::Never);
        let is_traced = !arguments.exact.optimize;
        if let Some(why) = kept(&own, is_traced) {
            progress.note(format!("{name}: kept as it is: {why}"));
            return Ok(None);
        }
        let scale = self.package.stretch(number);
        scene::enlarge(&mut own.soup, scale);
        let weld = if own.is_joined { Weld::Never } else { weld };
        let options = BuildOptions::default()
            .weld(weld)
            .strict(arguments.build.strict);
        let built = scene::built(&name, &own.soup, &options, None, progress)?;
        let Some((control, diagnosis)) = built else {
            return Ok(None);
        };
        let (mesh, Trace { faces, corners, .. }) = control.into_parts();
        let hints = Hints {
            is_tagged: false,
            normals: None,
            channels: &[],
        };
        let mut sharp = sharpened(mesh, &faces, &hints, &name, arguments)?;
        progress.notes(sharp.notes.iter().map(|line| format!("{name}: {line}")));
        // A flat region has triangles across faces that carry different things.
        let varies = own.varies_within || !own.is_uniform;
        sharp.arguments.exact.divide_flat |= is_traced && varies;
        let count = own.soup.faces.len();
        let channels = own.attributes.iter();
        let channel = |name| ChannelReport::inherited(name, count, &arguments.channels);
        let input = InputReport {
            path: name.clone(),
            format: Format::ThreeMf.extension(),
            vertices: own.soup.positions.len(),
            faces: count,
            left_out: Vec::new(),
            channels: channels.map(|name| channel(name)).collect(),
        };
        let read = Read {
            mesh: sharp.mesh,
            diagnosis,
            faces,
            shown: Shown::of(self.package.largest(number), scale),
        };
        let item = Item {
            own: corners,
            number,
            name: Some(name),
            scale,
            arguments: sharp.arguments,
            channels: Channels::default(),
            input,
            is_traced,
            reading: std::mem::take(&mut self.reading),
            building: Duration::ZERO,
        };
        Ok(Some((read, item)))
    }

    fn put(
        &mut self,
        item: &Item<Vec<u32>>,
        refined: &mut Refined,
        task: &Task<'_>,
    ) -> anyhow::Result<()> {
        let carried = Carried::new(task.control, refined, &item.own);
        let positions = refined.mesh.positions().iter();
        let positions: Vec<[f64; 3]> = positions.map(|p| p.map(|x| x / item.scale)).collect();
        let triangles = refined.mesh.triangles();
        let new = NewTriangles {
            positions: &positions,
            triangles,
            source: &|triangle| origin(&carried, triangles, triangle),
            keeps: &|name| !task.arguments.channels.drops(name, false),
        };
        let inherited = self.package.replace(item.number, &new)?;
        task.progress.notes(
            inherited_in_words(&inherited)
                .iter()
                .map(|line| item.line(line)),
        );
        Ok(())
    }

    fn write(&mut self, arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<()> {
        let Some(path) = &arguments.output else {
            return Ok(());
        };
        let bytes = self.package.to_bytes()?;
        output::write_file(path, &bytes)?;
        match &arguments.picture {
            Some(picture) => scene::draw(
                picture,
                &Package::from_bytes(bytes)?.scene_soup()?,
                progress,
            ),
            None => Ok(()),
        }
    }

    fn left_out(&self) -> Vec<String> {
        self.left_out.clone()
    }
}

/// Why an object cannot be refined.
fn kept(own: &ObjectSoup, is_traced: bool) -> Option<String> {
    if !own.others.is_empty() {
        let others = own.others.join(", ");
        return Some(format!(
            "{others} names its vertices or triangles by number"
        ));
    }
    let needs_sources = !own.is_uniform || own.varies_within;
    (needs_sources && !is_traced).then(|| {
        "its triangles carry different things, which do not follow with --optimize".to_owned()
    })
}

/// The face that a triangle came from, and where its corners are on that.
fn origin(carried: &Carried<'_>, triangles: &[[u32; 3]], triangle: usize) -> Origin {
    if carried.trail.parents.is_empty() {
        return Origin {
            face: 0,
            corners: None,
        };
    }
    let face = carried.input(triangle);
    let corner = |corner: usize| {
        let mut weights = [0.0; 3];
        for (own, weight) in carried.place(triangle, corner, triangles[triangle][corner])? {
            // A repair may have put a corner of another triangle there.
            if own as usize / 3 == face {
                weights[own as usize % 3] += weight;
            }
        }
        Some(weights)
    };
    let [a, b, c] = [0, 1, 2].map(corner);
    let corners = a.zip(b).zip(c).map(|((a, b), c)| [a, b, c]);
    Origin { face, corners }
}

/// Attributes that triangles could not inherit unchanged.
fn inherited_in_words(inherited: &Inherited) -> Vec<String> {
    let lines = [
        (
            inherited.painted_at_centre,
            "took paint at the centre, where the input's were painted in parts",
        ),
        (
            inherited.nearest_corner,
            "took properties of the nearest corner, where these differ between corners",
        ),
        (
            inherited.unreadable_paint,
            "lost paint whose code cannot be read",
        ),
    ];
    let found = lines.into_iter().filter(|&(count, _)| count > 0);
    found
        .map(|(count, what)| format!("{} {what}", counted(count, "triangle", "triangles")))
        .collect()
}
