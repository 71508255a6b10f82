//! `--within`: the smoothest result that is certainly near the input.

use limitmesh::Mesh;
use limitmesh::mesh::FaceParts;
use limitmesh::refine::{WithinOptions, with_room, within_observed};

use super::rounding::most_rounding;
use crate::arguments::RefineArguments;
use crate::failure::Outcome;
use crate::format::{counted, number, upper_bound};
use crate::progress::Progress;
use crate::report::IntervalReport;

/// Collapsing edges takes so many parts of the distance where refining takes one: what is left is compared with the input by way of
/// other triangles.
const COLLAPSING: f64 = 3.0;

/// How near the input the result has to be, in the mesh's unit.
#[derive(Clone, Copy)]
pub(super) struct Nearness {
    pub(super) within: f64,
    /// How far it may be from its limit surface therefore.
    pub(super) tolerance: f64,
}

impl Nearness {
    /// The nearness that is asked for of a mesh, if any. Lengths in per cent are of `diagonal`.
    ///
    /// # Errors
    /// The length has a unit, and the mesh's is not known.
    pub(super) fn of(
        arguments: &RefineArguments,
        mesh: &Mesh,
        diagonal: f64,
    ) -> anyhow::Result<Option<Self>> {
        let Some(within) = arguments.exact.within else {
            return Ok(None);
        };
        let within = within.length(diagonal, arguments.build.unit)?;
        let kept = with_room(within, most_rounding(arguments, mesh)?);
        let tolerance = WithinOptions::usual_tolerance(kept, diagonal);
        Ok(Some(Self { within, tolerance }))
    }

    /// The control mesh whose limit surface is so near a mesh, and where its faces are on those of that mesh.
    ///
    /// # Errors
    /// Some vertex has no limit, or somebody asked to stop.
    pub(super) fn control(
        self,
        mesh: &Mesh,
        arguments: &RefineArguments,
        progress: &Progress,
    ) -> anyhow::Result<(Mesh, FaceParts)> {
        let times = if arguments.exact.optimize {
            COLLAPSING
        } else {
            1.0
        };
        let options = WithinOptions::default()
            .within(with_room(self.within, most_rounding(arguments, mesh)?))
            .tolerance(Some(times * self.tolerance))
            .max_triangles(Some(arguments.max_triangles()));
        let scheme = arguments.scheme()?;
        let found = within_observed(mesh, scheme, &options, &mut progress.observer())?;
        if found.sharpened > 0 {
            let edges = counted(found.sharpened, "edge stays", "edges stay");
            progress.note(format!(
                "{edges} sharp: nothing smoother is within --within there"
            ));
        }
        Ok((found.control, found.parts))
    }

    /// Whether the result is as near as it has to be, and none of its triangles turned over where that is refused.
    pub(super) fn outcome(
        self,
        moved: Option<&IntervalReport>,
        inverted: usize,
        arguments: &RefineArguments,
    ) -> Outcome {
        let asked = format!(
            "--within {}{}",
            number(self.within),
            arguments.build.unit_in_words()
        );
        let why = match moved {
            Some(moved) if moved.upper <= self.within => {
                if !arguments.build.strict || inverted == 0 {
                    return Outcome::Done;
                }
                let triangles = counted(inverted, "triangle is", "triangles are");
                format!("{triangles} turned over, which --strict refuses")
            }
            Some(moved) => format!(
                "{asked} could not be kept: the result is within {}{} of the input",
                upper_bound(moved.upper),
                arguments.build.unit_in_words()
            ),
            None => format!("{asked} could not be proven"),
        };
        Outcome::StoppedShort(format!("{why}\n  {} was written", arguments.output_name()))
    }
}
