//! 3MF in, 3MF out: each object that has a mesh is refined once, and everything else stays as it is.
//!
//! An object is refined at the scale of its largest appearance in the build, so that all lengths are the build's; the result is
//! divided by that again. Triangles inherit what the one that they came from has.

use std::time::{Duration, Instant};

use limitmesh::Mesh;
use limitmesh::mesh::{BuildOptions, MeshError, Trace, Weld};
use limitmesh_io::threemf::{Inherited, NewTriangles, ObjectSoup, Source};
use limitmesh_io::{Format, Package};

use super::super::channels::Channels;
use super::carried::Carried;
use super::control::Control;
use super::goals::Goals;
use super::several::{self, Progressed};
use super::{Refined, estimate, looked_at};
use crate::arguments::RefineArguments;
use crate::bulk::Shown;
use crate::creases::Hints;
use crate::failure::{Outcome, usage};
use crate::format::counted;
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::report::{ChannelReport, InputReport};

/// A package to be refined.
pub(super) struct Job {
    /// With lengths instead of per cents.
    arguments: RefineArguments,
    writes: bool,
}

impl Job {
    /// The job that a command line asks for, if that is to edit a package.
    pub(super) fn of(
        arguments: &RefineArguments,
        output: Option<Format>,
    ) -> anyhow::Result<Option<Self>> {
        let path = arguments.input();
        if input::builtin_name(path).is_some()
            || output.is_some_and(|format| format != Format::ThreeMf)
        {
            return Ok(None);
        }
        if input::format_of(path, arguments.build.from)? != Format::ThreeMf {
            return Ok(None);
        }
        let RefineArguments {
            exact, view, eye, ..
        } = arguments;
        if !exact.camera.is_empty()
            || !exact.camera_path.is_empty()
            || view.is_some()
            || eye.is_some()
        {
            return usage(
                "cameras and views look at one mesh; the objects of a package may be built many times",
            );
        }
        Ok(Some(Self {
            arguments: arguments.clone(),
            writes: output.is_some() && !exact.dry_run,
        }))
    }

    /// Refines all objects and writes the package.
    pub(super) fn run(mut self, progress: &Progress) -> anyhow::Result<Outcome> {
        let name = input::display_name(self.arguments.input());
        progress.stage(format!("reading {name}"));
        let start = Instant::now();
        let mut package = input::package(self.arguments.input())?;
        let bounds = package.bounding_box()?;
        let reading = start.elapsed();
        let Some(bounds) = bounds else {
            anyhow::bail!("{name}: nothing is built that has triangles");
        };
        self.arguments.build.unit = Some(input::unit_of_package(
            &package,
            self.arguments.build.unit,
            &name,
        )?);
        let contents = package.contents();
        let names = contents
            .objects
            .iter()
            .flat_map(|object| &object.attributes)
            .map(String::as_str);
        self.arguments.channels.check(&name, names)?;
        self.arguments.channels.check_inherited()?;
        let diagonal = several::diagonal(bounds);
        several::set_lengths(&mut self.arguments, diagonal)?;
        let mut done = Progressed::default();
        done.left_out = self.arguments.channels.dropped();
        for object in 0..package.object_count() {
            self.object(object, &mut package, diagonal, &mut done, progress)?;
        }
        self.finish(&package, &name, reading, done, progress)
    }

    /// Refines an object and puts it back, unless there is nothing to refine, or more than can be inherited.
    fn object(
        &self,
        object: usize,
        package: &mut Package,
        diagonal: f64,
        done: &mut Progressed,
        progress: &Progress,
    ) -> anyhow::Result<()> {
        let name = package.object_name(object);
        let weld = self.arguments.build.options()?.weld;
        let mut own = package.object(object, weld != Weld::Never);
        if let Some(why) = self.kept(&own) {
            progress.note(format!("{name}: kept as it is: {why}"));
            return Ok(());
        }
        let stretch = package.stretch(object);
        own.soup
            .positions
            .iter_mut()
            .flatten()
            .for_each(|x| *x *= stretch);
        let weld = if own.is_joined { Weld::Never } else { weld };
        let options = BuildOptions::default()
            .weld(weld)
            .strict(self.arguments.build.strict);
        let (built, diagnosis, trace) = match Mesh::from_soup_traced(&own.soup, &options) {
            Err(MeshError::NoFaces { reason }) => {
                progress.note(format!("{name}: kept as it is: {reason}"));
                return Ok(());
            }
            built => built.map_err(|error| input::describe(&name, error))?,
        };
        for line in diagnosis.repairs() {
            progress.note(format!("{name}: {line}"));
        }
        let Trace { faces, corners, .. } = trace;
        let hints = Hints {
            is_tagged: false,
            normals: None,
            channels: &[],
        };
        let (arguments, note) = looked_at(&self.arguments, (&built, &faces), &hints);
        if let Some(note) = note {
            progress.note(format!("{name}: {note}"));
        }
        let mut arguments = done.share(&arguments);
        // A flat region has triangles across faces that carry different things.
        arguments.exact.divide_flat |= self.is_traced() && (own.varies_within || !own.is_uniform);
        let shown = Shown::of(package.largest(object), stretch);
        let control = Control::new(
            (built, diagnosis, faces),
            shown,
            Some(diagonal),
            &arguments,
            progress,
        )?;
        let goals = Goals::new(&arguments, &control.featured.mesh, diagonal)?;
        let goals = if self.is_traced() {
            goals.keeping_origins(Vec::new())
        } else {
            goals
        };
        let parameters = several::parameters(&arguments, &goals);
        if !self.writes {
            let told = (
                self.input_report(&name, &own),
                (&control.diagnosis).into(),
                parameters,
            );
            return estimate::run(&control.featured.mesh, &goals, &arguments, told, progress);
        }
        let one = several::one(
            &name,
            (&control, &Channels::default(), &goals),
            (self.is_traced(), Some(Format::ThreeMf)),
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
            vertices: &corners,
        };
        let told = self.put_back((package, object), (&one.refined, &carried), stretch)?;
        inherited_in_words(told)
            .iter()
            .for_each(|line| progress.note(format!("{name}: {line}")));
        let told = (self.input_report(&name, &own), control, parameters);
        done.add((&name, object, stretch), one, told, &arguments);
        Ok(())
    }

    /// Why an object cannot be refined.
    fn kept(&self, own: &ObjectSoup) -> Option<String> {
        if !own.others.is_empty() {
            return Some(format!(
                "{} names its vertices or triangles by number",
                own.others.join(", ")
            ));
        }
        let needs_sources = !own.is_uniform || own.varies_within;
        (needs_sources && !self.is_traced()).then(|| {
            "its triangles carry different things, which do not follow with --optimize".to_owned()
        })
    }

    /// Whether it is known of triangles which face they came from, and where on it.
    fn is_traced(&self) -> bool {
        !self.arguments.exact.optimize
    }

    /// Replaces the triangles of an object.
    fn put_back(
        &self,
        (package, object): (&mut Package, usize),
        (refined, carried): (&Refined, &Carried<'_>),
        stretch: f64,
    ) -> anyhow::Result<Inherited> {
        let positions: Vec<[f64; 3]> = refined
            .mesh
            .positions()
            .iter()
            .map(|p| p.map(|x| x / stretch))
            .collect();
        let triangles = refined.mesh.triangles();
        let source = |triangle: usize| {
            if carried.trail.parents.is_empty() {
                return Source {
                    face: 0,
                    corners: None,
                };
            }
            let face = carried.input(triangle);
            let corner = |corner: usize| {
                let mut weights = [0.0; 3];
                for (own, weight) in carried.place(triangle, corner, triangles[triangle][corner])? {
                    // A repair may have put a corner of another triangle there.
                    let is_own = own as usize / 3 == face;
                    weights[own as usize % 3] += if is_own { weight } else { 0.0 };
                }
                Some(weights)
            };
            let [a, b, c] = [0, 1, 2].map(corner);
            let corners = a.zip(b).zip(c).map(|((a, b), c)| [a, b, c]);
            Source { face, corners }
        };
        let keeps = |name: &str| !self.arguments.channels.drops(name);
        let new = NewTriangles {
            positions: &positions,
            triangles,
            source: &source,
            keeps: &keeps,
        };
        Ok(package.replace(object, &new)?)
    }

    fn input_report(&self, name: &str, own: &ObjectSoup) -> InputReport {
        let faces = own.soup.faces.len();
        let channel =
            |name: &String| ChannelReport::inherited(name, faces, &self.arguments.channels);
        InputReport {
            path: name.to_owned(),
            format: Format::ThreeMf.extension(),
            vertices: own.soup.positions.len(),
            faces,
            left_out: Vec::new(),
            channels: own.attributes.iter().map(channel).collect(),
        }
    }

    /// Writes the package, the report and the picture.
    fn finish(
        &self,
        package: &Package,
        name: &str,
        reading: Duration,
        done: Progressed,
        progress: &Progress,
    ) -> anyhow::Result<Outcome> {
        let arguments = &self.arguments;
        let Some(path) = arguments.output.as_ref().filter(|_| self.writes) else {
            return Ok(Outcome::Done);
        };
        progress.stage(format!("writing {}", arguments.output_name()));
        let start = Instant::now();
        let bytes = package.to_bytes()?;
        output::write_file(path, &bytes)?;
        let writing = start.elapsed();
        let outcome = done.finish(
            name,
            [reading, writing],
            (arguments, ["object", "objects"]),
            progress,
        )?;
        if let Some(picture) = &arguments.picture {
            several::draw(
                picture,
                &Package::from_bytes(bytes)?.scene_soup()?,
                arguments,
                progress,
            )?;
        }
        Ok(outcome)
    }
}

/// What triangles could not inherit as it was.
fn inherited_in_words(told: Inherited) -> Vec<String> {
    let Inherited {
        painted_at_centre,
        unreadable_paint,
        nearest_corner,
        ..
    } = told;
    let triangles = |count: usize| counted(count, "triangle", "triangles");
    let lines = [
        (
            painted_at_centre,
            "took paint at the centre, where the input's were painted in parts",
        ),
        (
            nearest_corner,
            "took properties of the nearest corner, where these differ between corners",
        ),
        (unreadable_paint, "lost paint whose code cannot be read"),
    ];
    let found = lines.into_iter().filter(|&(count, _)| count > 0);
    found
        .map(|(count, what)| format!("{} {what}", triangles(count)))
        .collect()
}
