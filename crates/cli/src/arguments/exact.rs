//! Options of `limitmesh refine --method exact`: its goals and its caps.

use clap::Args;

use super::values::{self, Extent};

/// The heading of these options in the help.
const HEADING: &str = "Goals and caps of --method exact";

/// What exact refinement is to reach, and what it must not exceed.
#[derive(Args, Debug)]
#[command(next_help_heading = HEADING)]
pub(crate) struct ExactArguments {
    /// Greatest distance between the mesh and the limit surface, either way [default without another goal: 0.1%]
    ///
    /// A length in the mesh's unit, or with % in per cent of the diagonal of the control mesh's bounding box.
    #[arg(long, value_name = "T", value_parser = values::tolerance, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<Extent>,

    /// The best mesh with at most so many triangles, the worst places refined first
    ///
    /// With other goals, whichever is reached first ends the refinement.
    #[arg(long, value_name = "N", value_parser = values::positive)]
    pub(crate) triangles: Option<usize>,

    /// Divide no part of a control face more often [1 to 24; default: 24]
    ///
    /// What was reached by then is written, and the exit code is 3.
    #[arg(long, value_name = "N", value_parser = values::exact_levels)]
    pub(crate) max_levels: Option<usize>,

    /// Say where each vertex and triangle came from, as properties of a PLY file
    ///
    /// Vertices have parent_face and the barycentric coordinates parent_a, parent_b and parent_c there, triangles
    /// have parent_face: faces of the control mesh, counted from 0.
    #[arg(long)]
    pub(crate) provenance: bool,
}
