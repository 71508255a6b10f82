//! glTF in, glTF out: each mesh of the asset is refined once, and everything else stays as it is.
//!
//! A mesh is refined at the scale of its largest appearance, its coordinates times the greatest stretch of its nodes, so
//! that all lengths are the scene's; the result is divided by that again.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use anyhow::Context;
use limitmesh::carry::borders;
use limitmesh::mesh::{BuildOptions, Channel, Domain, Semantic, Weld};
use limitmesh::{Mesh, mesh::FaceParts};
use limitmesh_io::gltf::{CornerAttribute, KeptApart, MeshSoup};
use limitmesh_io::{Asset, Format, ReadError};

use super::super::control::Read;
use super::super::goals::Goals;
use super::super::refined::Refined;
use super::super::task::Task;
use super::carried::Carried;
use super::file::by_faces;
use super::item::{Item, Source, sharpened};
use super::put_back::{MOST_WIDE, PutBack, channel, moved_positions};
use super::scene;
use super::selection::Selection;
use super::weights::on_quads;
use crate::arguments::{ConcaveCorners, CreasesFrom, MorphTolerance, RefineArguments, Unit, Way};
use crate::bulk::Shown;
use crate::commands::channels::Channels;
use crate::creases::Hints;
use crate::failure::usage;
use crate::format::{counted, thousands};
use crate::input::{self, ControlMesh};
use crate::output;
use crate::progress::Progress;
use crate::report::{ChannelReport, InputReport};

/// A glTF asset whose meshes are refined.
pub(crate) struct AssetSource {
    asset: Asset,
    name: String,
    input: Format,
    /// None for a dry run without a name.
    output: Option<Format>,
    selection: Selection,
    diagonal: f64,
    reading: Duration,
    left_out: Vec<String>,
}

/// A mesh as its document has it, at the scale of its largest appearance.
pub(crate) struct AssetMesh {
    /// Where its polygons are quads, its influences are those of the quads' vertices.
    soup: MeshSoup,
    /// By corner of the mesh that was read, the vertex that has its influences.
    vertices: Vec<u32>,
    scale: f64,
}

impl AssetSource {
    /// Opens the asset that a command line asks to edit, whose format is `input`; gives also the arguments with lengths of its scene.
    ///
    /// # Errors
    /// It cannot be read, or an argument has no meaning for it.
    pub(crate) fn open(
        arguments: &RefineArguments,
        input: Format,
        output: Option<Format>,
        progress: &Progress,
    ) -> anyhow::Result<(Self, RefineArguments)> {
        scene::check_viewers(arguments)?;
        let unit = arguments.build.unit.unwrap_or(Unit::M);
        let mut arguments = RefineArguments {
            build: arguments.build.in_unit(Some(unit)),
            ..arguments.clone()
        };
        let name = input::display_name(arguments.input());
        progress.stage(format!("reading {name}"));
        let start = Instant::now();
        let asset = input::asset(arguments.input())?;
        check_channels(&asset, &name, &arguments)?;
        check_polygons(&asset, &name, &arguments)?;
        let Some(bounds) = asset.bounding_box()? else {
            anyhow::bail!("{name}: the scene shows no triangles that could be refined");
        };
        let diagonal = scene::diagonal(bounds);
        scene::set_lengths(&mut arguments, diagonal)?;
        let source = Self {
            selection: Selection::new(&asset, &arguments.asset)?,
            reading: start.elapsed(),
            left_out: Vec::new(),
            asset,
            name,
            input,
            output,
            diagonal,
        };
        Ok((source, arguments))
    }

    /// A mesh as it is shown, its vertices merged so, with polygons or the triangles that the document has for them.
    fn as_shown(
        &self,
        mesh: usize,
        weld: Weld,
        has_polygons: bool,
        arguments: &RefineArguments,
    ) -> Result<MeshSoup, ReadError> {
        let scale = self.asset.stretch(mesh);
        let joining = arguments.asset.joining(weld, scale);
        let is_wanted = |primitive| self.selection.has(mesh, primitive);
        let mut own = match has_polygons {
            true => self.asset.mesh_of(mesh, joining, is_wanted)?,
            false => self.asset.triangles_of(mesh, joining, is_wanted)?,
        };
        scene::enlarge(&mut own.soup, scale);
        Ok(own)
    }

    /// Keeps the names of a mesh's attributes that are lost: those that are too wide or dropped, and others.
    fn leave_out(&mut self, own: &MeshSoup, arguments: &RefineArguments, others: Vec<String>) {
        let is_lost =
            |table: &&CornerAttribute| is_dropped(table, arguments) || table.width > MOST_WIDE;
        let lost = own
            .attributes
            .iter()
            .filter(is_lost)
            .map(|table| table.name.clone());
        for name in lost.chain(others) {
            if !self.left_out.contains(&name) {
                self.left_out.push(name);
            }
        }
    }
}

impl Source for AssetSource {
    type Own = AssetMesh;
    const NOUNS: Option<[&'static str; 2]> = Some(["mesh", "meshes"]);

    fn count(&self) -> usize {
        self.asset.mesh_count()
    }

    fn diagonal(&self) -> Option<f64> {
        Some(self.diagonal)
    }

    fn item(
        &mut self,
        number: usize,
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<Option<(Read, Item<AssetMesh>)>> {
        let weld = arguments.build.options()?.weld;
        let mut own = self.as_shown(number, weld, true, arguments)?;
        if own.parts.is_empty() {
            return Ok(None);
        }
        let name = self.asset.mesh_name(number);
        let is_of_quads = input::is_of_quads(&own.soup.faces);
        let arguments = &by_faces(arguments, &name, is_of_quads, progress);
        if !arguments.has_quads() && own.soup.faces.iter().any(|face| face.len() > 3) {
            own = self.as_shown(number, weld, false, arguments)?;
        }
        // By glTF's rules the winding says which side is drawn.
        let options = BuildOptions::default()
            .weld(Weld::Never)
            .strict(arguments.build.strict)
            .keep_windings(true);
        let quads = arguments.quads();
        let built = scene::built(&name, &own.soup, &options, quads.as_ref(), progress)?;
        let Some((control, diagnosis)) = built else {
            return Ok(None);
        };
        progress.notes(
            apart_in_words(&own)
                .into_iter()
                .map(|line| format!("{name}: {line}")),
        );
        let on_mesh = |channel: &Channel| control.channel(&own.soup, channel);
        let normals = own.normals.as_ref().map(on_mesh).transpose()?;
        let mut channels: Vec<Channel> = own.attributes.iter().map(channel).collect();
        arguments.channels.apply(&mut channels)?;
        let is_kept =
            |own: &&Channel| own.arity <= MOST_WIDE && !arguments.channels.drops_channel(own);
        let kept = channels
            .iter()
            .filter(is_kept)
            .map(on_mesh)
            .collect::<Result<_, _>>()?;
        if let ControlMesh::Quads(quads) = &control
            && !own.influences.is_empty()
        {
            own.influences = on_quads(quads, &own.soup, &own.influences)?;
        }
        let is_of_triangles = matches!(control, ControlMesh::Triangles(..));
        let (mesh, trace) = control.into_parts();
        let near = input::nearly_closed(&mesh, weld, |weld| {
            let soup = self.as_shown(number, weld, true, arguments).ok()?.soup;
            Some(Mesh::from_soup(&soup, &options).ok()?.0)
        });
        progress.notes(near.map(|near| format!("{name}: {near}")));
        let vertices = match is_of_triangles {
            true => trace.vertices(&own.soup),
            false => mesh.triangles().as_flattened().to_vec(),
        };
        let hints = Hints {
            is_tagged: false,
            normals: normals.as_ref(),
            channels: &[],
        };
        let sharp = sharpened(mesh, &trace.faces, &hints, &name, arguments)?;
        progress.notes(sharp.notes.iter().map(|line| format!("{name}: {line}")));
        own.soup.channels = channels;
        let scale = self.asset.stretch(number);
        let channels = own.soup.channels.iter();
        let input = InputReport {
            path: name.clone(),
            format: self.input.extension(),
            vertices: own.soup.positions.len(),
            faces: own.soup.faces.len(),
            left_out: Vec::new(),
            channels: channels
                .map(|own| ChannelReport::chosen(own, &arguments.channels))
                .collect(),
        };
        let read = Read {
            mesh: sharp.mesh,
            diagnosis,
            shown: Shown::of(self.asset.largest(number), scale),
            faces: trace.faces.clone(),
        };
        let item = Item {
            number,
            name: Some(name),
            scale,
            arguments: with_kept_borders(sharp.arguments, &own),
            channels: Channels::of_asset(kept),
            input,
            is_traced: true,
            reading: std::mem::take(&mut self.reading),
            building: Duration::ZERO,
            own: AssetMesh {
                vertices,
                soup: own,
                scale,
            },
        };
        Ok(Some((read, item)))
    }

    /// Edges stay where attributes change and between primitives when others are collapsed, and morph targets make surfaces.
    fn add_goals(&self, own: &AssetMesh, goals: &mut Goals, task: &Task<'_>) -> anyhow::Result<()> {
        let control = task.control;
        let parts = &control.concave.parts;
        let primitives = primitives(&own.soup, task.mesh(), parts, &control.faces)?;
        goals.kept_edges.extend(borders(&[primitives], task.mesh()));
        goals.kept_edges.sort_unstable();
        goals.kept_edges.dedup();
        let Some(tolerance) = morph_tolerance(goals, task)? else {
            return Ok(());
        };
        let attributes = own.soup.attributes.iter();
        for table in attributes.filter(|table| table.is_displacement()) {
            let is_own = |channel: &&Channel| channel.name == table.name;
            let channel = task.channels.all().iter().find(is_own);
            let moves = |channel: &&Channel| channel.values.iter().any(|&x| x != 0.0);
            if let Some(channel) = channel.filter(moves) {
                let positions = moved_positions(task.mesh(), channel, own.scale);
                let moved = task.mesh().clone().with_positions(positions);
                let name = table.name.trim_end_matches(".POSITION").to_owned();
                let moved = moved.with_context(|| table.name.clone())?;
                goals.attributes.add_surface(name, moved, tolerance);
            }
        }
        Ok(())
    }

    fn put(
        &mut self,
        item: &Item<AssetMesh>,
        refined: &mut Refined,
        task: &Task<'_>,
    ) -> anyhow::Result<()> {
        let carried = Carried::new(task.control, refined, &item.own.vertices);
        let back = PutBack {
            own: &item.own.soup,
            control: task.mesh(),
            channels: task.channels,
            refined,
            carried: &carried,
            scale: item.scale,
            scheme: task.arguments.scheme_name().in_quarters()?,
        };
        let put = back.put(&mut self.asset, item.number)?;
        task.progress
            .notes(put.notes.iter().map(|note| item.line(note)));
        self.leave_out(&item.own.soup, task.arguments, put.left_out);
        Ok(())
    }

    fn write(&mut self, arguments: &RefineArguments, progress: &Progress) -> anyhow::Result<()> {
        let (Some(path), Some(format)) = (&arguments.output, self.output) else {
            return Ok(());
        };
        self.left_out.extend(self.asset.left_out());
        if output::is_standard_output(path) {
            output::write_file(path, &self.asset.to_bytes(format)?)?;
        } else {
            let are_linked = arguments.asset.link_resources;
            let missing = output::write_asset(path, &self.asset, format, are_linked)?;
            progress.notes(missing.iter().map(|file| {
                let file = file.display();
                format!("{}: {file} is named in it, and was not found", self.name)
            }));
        }
        if let Some(picture) = &arguments.picture {
            let folder = arguments.input().parent();
            let scene = Asset::from_bytes(&self.asset.to_bytes(Format::Glb)?, folder)?;
            scene::draw(picture, &scene.scene_soup()?, progress)?;
        }
        Ok(())
    }

    fn left_out(&self) -> Vec<String> {
        self.left_out.clone()
    }
}

/// Refuses choices for attributes that no mesh has, and sharp edges by normals where there are none.
fn check_channels(asset: &Asset, name: &str, arguments: &RefineArguments) -> anyhow::Result<()> {
    let contents = asset.contents()?;
    let primitives = contents.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let attributes = primitives.flat_map(|own| &own.attributes);
    let names: BTreeSet<&str> = attributes.map(String::as_str).collect();
    if arguments.features.creases_from == CreasesFrom::Normals && !names.contains("NORMAL") {
        return usage(format!("--creases-from: {name} has no normals"));
    }
    // What moves vertices, and what is found anew, is no matter of choice.
    let is_free = |name: &&str| {
        let kind = name.split_once('_').map_or(*name, |(kind, _)| kind);
        !["POSITION", "NORMAL", "TANGENT", "JOINTS", "WEIGHTS"].contains(&kind)
    };
    let free = || names.iter().copied().filter(is_free);
    arguments.channels.check(name, free())?;
    let named = free().map(|own| (own, own.starts_with("TEXCOORD_")));
    arguments.channels.check_tolerances(name, named)
}

/// Refuses Catmull–Clark's scheme where triangles are all that there is: what a modelling program had as quads would come out otherwise.
fn check_polygons(asset: &Asset, name: &str, arguments: &RefineArguments) -> anyhow::Result<()> {
    if !arguments.has_quads() {
        return Ok(());
    }
    let contents = asset.contents()?;
    let primitives = contents.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut extensions = primitives.flat_map(|own| &own.extensions);
    let is_polygons = |name: &String| ["FB_ngon_encoding", "EXT_mesh_polygon"].contains(&&name[..]);
    match extensions.any(is_polygons) {
        true => Ok(()),
        false => usage(format!(
            "--scheme catmull-clark is for polygons, of which {name} has none but triangles: no primitive has FB_ngon_encoding or \
             EXT_mesh_polygon; OBJ, PLY and OFF files have polygons"
        )),
    }
}

/// Whether an attribute is to be left out.
fn is_dropped(own: &CornerAttribute, arguments: &RefineArguments) -> bool {
    arguments
        .channels
        .drops(&own.name, own.name.starts_with("TEXCOORD_"))
}

/// Lines about vertices and faces that stay apart.
fn apart_in_words(own: &MeshSoup) -> Vec<String> {
    let KeptApart {
        moving,
        by_skins,
        by_morphs,
        touching,
        backs,
        ..
    } = own.kept_apart;
    let mut lines = Vec::new();
    let cut = own.cut_polygons();
    lines.extend(cut.map(|cut| format!("left out: {cut}")));
    if own.borders > 0 {
        let edges = counted(own.borders, "edge", "edges");
        lines.push(format!(
            "{edges} where primitives meet others that stay are kept straight"
        ));
    }
    if backs > 0 {
        let are = match backs {
            1 => "face is the back of another",
            _ => "faces are the backs of others",
        };
        let backs = thousands(backs);
        lines.push(format!(
            "{backs} {are}: both sides are kept, each as if alone"
        ));
    }
    if moving > 0 {
        let vertices = counted(moving, "vertex", "vertices");
        let because = match (by_skins > 0, by_morphs > 0) {
            (true, false) => {
                "of their joints and weights (--weld-ignores skin joins them)".to_owned()
            }
            (false, true) => "of morph targets (--weld-ignores morphs joins them)".to_owned(),
            _ => format!(
                "of joints and morph targets (--weld-ignores skin joins {by_skins}, morphs {by_morphs}, skin,morphs all)"
            ),
        };
        lines.push(format!(
            "{vertices} kept apart where others stand, because {because}"
        ));
    }
    if touching > 0 {
        let vertices = counted(touching, "vertex", "vertices");
        lines.push(format!(
            "{vertices} of primitives that merely touch stay apart"
        ));
    }
    lines
}

/// The arguments for a mesh with what keeps the borders of several primitives, and of values.
fn with_kept_borders(mut arguments: RefineArguments, own: &MeshSoup) -> RefineArguments {
    // A flat region has triangles across borders, and across the faces that values belong to.
    let is_kept = |own: &CornerAttribute| !is_dropped(own, &arguments);
    let has_values = own.attributes.iter().any(is_kept) || !own.influences.is_empty();
    arguments.exact.divide_flat |= own.parts.len() > 1 || has_values;
    if own.borders > 0 {
        // Where they stay straight around a corner of 180° and more, the surface would fold over.
        let corners = &mut arguments.features.concave_corners;
        corners.get_or_insert(ConcaveCorners::Fixed);
    }
    arguments
}

/// How far the surfaces of morph targets may be off: as far as the mesh as it rests, unless something else is said.
fn morph_tolerance(goals: &Goals, task: &Task<'_>) -> anyhow::Result<Option<f64>> {
    let (arguments, exact) = (task.arguments, &task.arguments.exact);
    if arguments.way() != Way::Exact {
        return Ok(None);
    }
    let is_free = exact.triangles.is_none() && !exact.balance && !exact.optimize;
    Ok(match arguments.asset.morph_tolerance {
        Some(MorphTolerance::None) => None,
        Some(MorphTolerance::Within(extent)) => {
            Some(extent.length(task.control.diagonal, arguments.build.unit)?)
        }
        None => goals.length.filter(|_| is_free),
    })
}

/// The primitive of each face of a control mesh.
fn primitives(
    own: &MeshSoup,
    control: &Mesh,
    parts: &FaceParts,
    faces: &[u32],
) -> anyhow::Result<Channel> {
    let primitive = |face: usize| {
        let input = faces[parts.whole(face as u32) as usize] as usize;
        let found = own
            .parts
            .iter()
            .position(|part| part.faces.contains(&input));
        debug_assert!(found.is_some(), "face {input} is in no primitive");
        let found = found.with_context(|| format!("face {input} is in no primitive"))?;
        Ok(found as u32)
    };
    let values = (0..own.parts.len()).map(|part| part as f64).collect();
    let of_faces = (0..control.face_count())
        .map(primitive)
        .collect::<anyhow::Result<_>>()?;
    let channel = Channel::new("primitives", Semantic::Label, Domain::Face, 1);
    Ok(channel.with(values, of_faces))
}
