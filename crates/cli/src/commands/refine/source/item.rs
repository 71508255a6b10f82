//! A mesh of a source, and what all sources do.

use std::time::Duration;

use limitmesh::Mesh;

use super::super::control::Read;
use super::super::goals::Goals;
use super::super::refined::Refined;
use super::super::task::Task;
use crate::arguments::{CreasesFrom, RefineArguments, Way};
use crate::commands::channels::Channels;
use crate::creases::Hints;
use crate::format::counted;
use crate::parts;
use crate::progress::Progress;
use crate::report::InputReport;

/// Meshes that are refined one after the other, and written together.
pub(crate) trait Source {
    /// The data of a mesh that a source keeps until its result is put back.
    type Own;

    /// A mesh and several, in words; `None` where there is only one.
    const NOUNS: Option<[&'static str; 2]>;

    fn count(&self) -> usize {
        1
    }

    /// Lengths in per cent are of this; of each mesh's own diagonal where it is `None`.
    fn diagonal(&self) -> Option<f64> {
        None
    }

    /// Reads a mesh; `None` where there is nothing to refine, so that it stays as it is.
    ///
    /// # Errors
    /// It cannot be read, or does not fit the arguments.
    fn item(
        &mut self,
        number: usize,
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<Option<(Read, Item<Self::Own>)>>;

    /// Adds goals that only this source knows.
    ///
    /// # Errors
    /// They cannot be had of this mesh.
    fn add_goals(&self, _: &Self::Own, _: &mut Goals, _: &Task<'_>) -> anyhow::Result<()> {
        Ok(())
    }

    /// Writes a result, or puts it where its mesh was.
    ///
    /// # Errors
    /// It cannot be written, or the source cannot take it.
    fn put(
        &mut self,
        item: &Item<Self::Own>,
        refined: &mut Refined,
        task: &Task<'_>,
    ) -> anyhow::Result<()>;

    /// Writes what belongs to a result that has been put: its proof, its picture.
    ///
    /// # Errors
    /// It cannot be made or written.
    fn prove_and_draw(&self, _: &mut Refined, _: &Task<'_>) -> anyhow::Result<()> {
        Ok(())
    }

    /// Writes what all meshes are together, with the picture, when each has been put.
    ///
    /// # Errors
    /// It cannot be written.
    fn write(&mut self, _: &RefineArguments, _: &Progress) -> anyhow::Result<()> {
        Ok(())
    }

    /// The attributes that were left out, by the source's names.
    fn left_out(&self) -> Vec<String> {
        Vec::new()
    }
}

/// A mesh that is refined, without its geometry.
pub(crate) struct Item<Own> {
    pub(crate) own: Own,
    pub(crate) number: usize,
    /// As messages call it; `None` where it is all there is.
    pub(crate) name: Option<String>,
    /// How many times larger it appears than in its own coordinates, at most.
    pub(crate) scale: f64,
    /// With what was decided by looking at the mesh.
    pub(crate) arguments: RefineArguments,
    pub(crate) channels: Channels,
    pub(crate) input: InputReport,
    pub(crate) is_traced: bool,
    pub(crate) reading: Duration,
    pub(crate) building: Duration,
}

impl<Own> Item<Own> {
    /// A line about this mesh.
    pub(crate) fn line(&self, words: &str) -> String {
        match &self.name {
            Some(name) => format!("{name}: {words}"),
            None => words.to_owned(),
        }
    }
}

/// A mesh with its sharp edges, by its file or by its looks.
pub(super) struct Sharpened {
    pub(super) mesh: Mesh,
    pub(super) arguments: RefineArguments,
    pub(super) notes: Vec<String>,
}

/// Looks at a mesh, with the input's faces that its own are from, and makes the edges sharp that are to be.
///
/// Looks count for exact refinement, or where that is asked for.
///
/// # Errors
/// The file that is called `name` says nothing of the kind that is asked for.
pub(crate) fn sharpened(
    mesh: Mesh,
    faces: &[u32],
    hints: &Hints<'_>,
    name: &str,
    arguments: &RefineArguments,
) -> anyhow::Result<Sharpened> {
    // What is as smooth as a distance allows has sharp edges only where somebody says so.
    let is_smoothed = arguments.exact.within.is_some();
    let features = match arguments.way() {
        Way::Exact if !is_smoothed => arguments.features.or_auto(),
        _ => arguments.features,
    };
    let can_be_led = !arguments.way().is_sqrt3() && !arguments.shared_topology && !is_smoothed;
    let interpolation = arguments.interpolation;
    let decided = parts::decided(features, interpolation, &mesh, faces, hints, can_be_led);
    let arguments = RefineArguments {
        features: decided.features,
        interpolation: decided.interpolation,
        ..arguments.clone()
    };
    let from = arguments.features.creases_from;
    let split = split_normals(hints, &mesh, &arguments);
    let edges = hints.edges(&mesh, from, name)?;
    Ok(Sharpened {
        mesh: mesh.with_creases(&edges),
        arguments,
        notes: decided.note.into_iter().chain(split).collect(),
    })
}

/// A note about normals that say that edges are sharp, where nothing says what to do about that.
fn split_normals(hints: &Hints<'_>, mesh: &Mesh, arguments: &RefineArguments) -> Option<String> {
    let features = &arguments.features;
    if features.angle().is_some() || features.creases_from != CreasesFrom::None {
        return None;
    }
    let edges = hints.split_edges(mesh);
    let have = counted(edges, "edge has", "edges have");
    (edges > 0).then(|| {
        format!(
            "{have} different normals on both sides; --creases-from normals keeps such edges sharp"
        )
    })
}
