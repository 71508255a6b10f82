//! The result of a method, and its report.

use limitmesh::refine::ExactStop;
use limitmesh::{HalfEdgeId, Mesh};

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::provenance::Provenance;
use super::trail::Trail;
use crate::arguments::{RefineArguments, Unit};
use crate::bulk::Bulk;
use crate::failure::Outcome;
use crate::format::{counted, number, seconds, thousands};
use crate::report::{MethodReport, SizeReport};

/// A refined mesh.
pub(super) struct Refined {
    pub(super) mesh: Mesh,
    /// Pairs of its triangles that are written as quads, by the half-edges between them.
    pub(super) quads: Vec<[HalfEdgeId; 2]>,
    pub(super) normals: Option<Normals>,
    pub(super) channels: Channels,
    pub(super) provenance: Option<Provenance>,
    /// Where vertices and triangles came from; empty where nobody asked, or it is not known.
    pub(super) trail: Trail,
    /// How near the mesh is to the limit surface: sentences of a line each.
    pub(super) achieved: Vec<String>,
    /// Triangles that are turned over against the limit surface; not known of the stepwise methods.
    pub(super) inverted: Option<usize>,
    /// The levels or steps, in words.
    pub(super) how: String,
    pub(super) report: MethodReport,
    pub(super) outcome: Outcome,
}

/// The part of a closed surface's volume that may be lost before a note says what would keep it.
const MUCH_VOLUME: f64 = 0.1;

/// The option that keeps the size of a mesh.
pub(super) const INTERPOLATE: &str = "(--interpolate would lead the surface through the vertices)";

impl Refined {
    /// A mesh by itself.
    pub(super) fn new(mesh: Mesh, how: String, report: MethodReport, outcome: Outcome) -> Self {
        Self {
            mesh,
            quads: Vec::new(),
            normals: None,
            channels: Channels::default(),
            provenance: None,
            trail: Trail::default(),
            achieved: Vec::new(),
            inverted: None,
            how,
            report,
            outcome,
        }
    }

    /// Adds the change of area and volume to what was achieved, and what would have kept much of a volume that is lost.
    pub(super) fn add_size(&mut self, size: &SizeReport, arguments: &RefineArguments) {
        self.achieved.push(change_in_words(
            size.before,
            size.after,
            arguments.build.unit,
        ));
        let keeps_size = arguments.interpolation.is_led()
            || arguments.exact.within.is_some()
            || arguments.way().is_sqrt3();
        let is_said = self.achieved.iter().any(|line| line == INTERPOLATE);
        if let (Some(before), Some(after)) = (size.before.volume, size.after.volume)
            && !keeps_size
            && !is_said
            && after / before < 1.0 - MUCH_VOLUME
        {
            self.achieved.push(INTERPOLATE.to_owned());
        }
    }

    /// The result in lines of at most 100 columns, names of files aside.
    pub(super) fn summary(&self, name: &str, took: f64) -> String {
        let edges = match self.mesh.open_edge_count() {
            0 => "closed".to_owned(),
            open => counted(open, "open edge", "open edges"),
        };
        let first = format!(
            "{name}: {}, {}, {edges} ({}; {})",
            self.faces_in_words(),
            counted(self.mesh.vertex_count(), "vertex", "vertices"),
            self.how,
            seconds(took)
        );
        [vec![first], self.achieved.clone()].concat().join("\n  ")
    }

    /// How many faces there are, of each kind.
    fn faces_in_words(&self) -> String {
        let quads = self.quads.len();
        let triangles = self.mesh.face_count() - 2 * quads;
        let triangles_in_words = counted(triangles, "triangle", "triangles");
        match (quads, triangles) {
            (0, _) => triangles_in_words,
            (_, 0) => counted(quads, "quad", "quads"),
            _ => format!(
                "{} and {triangles_in_words}",
                counted(quads, "quad", "quads")
            ),
        }
    }

    /// A note about triangles that are turned over.
    pub(super) fn inverted_in_words(&self) -> Option<String> {
        let inverted = self.inverted.filter(|&inverted| inverted > 0)?;
        let triangles = counted(inverted, "triangle is", "triangles are");
        Some(format!(
            "{triangles} turned over against the limit surface: it folds there"
        ))
    }
}

fn change_in_words(before: Bulk, after: Bulk, unit: Option<Unit>) -> String {
    let change = |what: &str, power: &str, before: f64, after: f64| {
        if !(before.is_finite() && after.is_finite()) {
            return format!("{what} too large for numbers");
        }
        let unit = unit.map_or_else(String::new, |unit| format!(" {}{power}", unit.name()));
        let percent = 100.0 * (after / before - 1.0);
        let percent = match percent.is_finite() {
            true => format!(" ({percent:+.2} %)"),
            false => String::new(),
        };
        let (before, after) = (number(before), number(after));
        format!("{what} {before} to {after}{unit}{percent}")
    };
    let area = change("area", "²", before.area, after.area);
    match (before.volume, after.volume) {
        (Some(before), Some(after)) => format!("{area}, {}", change("volume", "³", before, after)),
        _ => area,
    }
}

/// How a method ends that takes no triangles away: where there are more than asked, the control mesh had so many.
pub(super) fn capped(mesh: &Mesh, stop: ExactStop, arguments: &RefineArguments) -> Outcome {
    let count = mesh.face_count();
    if let Some(asked) = arguments.exact.triangles.filter(|&asked| count > asked) {
        return Outcome::StoppedShort(format!(
            "the control mesh has {} already, more than --triangles {}; --method exact --optimize goes below",
            thousands(count),
            thousands(asked),
        ));
    }
    let cap = match stop {
        ExactStop::Met | ExactStop::Triangles => return Outcome::Done,
        ExactStop::LevelCap => "levels (--levels)",
        _ => "triangles (--max-triangles)",
    };
    Outcome::StoppedShort(format!(
        "a cap on {cap} was reached before what was asked for; {} was written with {}",
        arguments.output_name(),
        counted(count, "triangle", "triangles"),
    ))
}
