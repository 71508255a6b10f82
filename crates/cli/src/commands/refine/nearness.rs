//! `--within`: the smoothest result that is certainly near the input.

use limitmesh::Mesh;
use limitmesh::mesh::FaceParts;
use limitmesh::refine::{WithinOptions, within_observed};

use super::goals::{most_rounding, unit_in_words, with_room};
use crate::arguments::RefineArguments;
use crate::failure::Outcome;
use crate::format::{counted, number, upper_bound};
use crate::progress::Progress;
use crate::report::InputDistanceReport;

/// Parts of the distance that collapsing edges takes beside refining: the triangles that are left are compared with the input by way of others.
const COLLAPSING: f64 = 3.0;

/// How near the input the result has to be, in the mesh's unit.
#[derive(Clone, Copy)]
pub(super) struct Nearness {
    pub(super) within: f64,
    /// How far it may be from its limit surface therefore.
    pub(super) tolerance: f64,
}

impl Nearness {
    /// What is asked for of a mesh, lengths in per cent being of `diagonal`; none where nothing is.
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
        let kept = with_room(within, most_rounding(arguments, mesh));
        Ok(Some(Self {
            within,
            tolerance: WithinOptions::usual_tolerance(kept, diagonal),
        }))
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
        let refining = if arguments.exact.optimize {
            COLLAPSING * self.tolerance
        } else {
            self.tolerance
        };
        let options = WithinOptions::default()
            .within(with_room(self.within, most_rounding(arguments, mesh)))
            .tolerance(Some(refining))
            .max_triangles(Some(arguments.max_triangles()));
        let found = within_observed(
            mesh,
            arguments.scheme()?,
            &options,
            &mut progress.observer(),
        )?;
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
        moved: Option<&InputDistanceReport>,
        inverted: usize,
        arguments: &RefineArguments,
    ) -> Outcome {
        let unit = unit_in_words(arguments.build.unit);
        let written = format!("\n  {} was written", arguments.output_name());
        match moved {
            Some(moved) if moved.upper <= self.within => {}
            Some(moved) => {
                return Outcome::StoppedShort(format!(
                    "--within {}{unit} could not be kept: the result is within {}{unit} of the input{written}",
                    number(self.within),
                    upper_bound(moved.upper)
                ));
            }
            None => {
                return Outcome::StoppedShort(format!(
                    "--within {}{unit} could not be proven{written}",
                    number(self.within)
                ));
            }
        }
        if arguments.build.strict && inverted > 0 {
            let triangles = counted(inverted, "triangle is", "triangles are");
            return Outcome::StoppedShort(format!(
                "{triangles} turned over, which --strict refuses{written}"
            ));
        }
        Outcome::Done
    }
}
