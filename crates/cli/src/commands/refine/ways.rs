//! The ways to refine a mesh by itself, as a method and a scheme together choose one: with its goals, what of these is reported, and the
//! refinement.

use limitmesh::Mesh;
use limitmesh_io::Format;

use super::super::channels::Channels;
use super::control::Before;
use super::exact;
use super::goals::Goals;
use super::{Refined, restricted, sqrt3, stepwise};
use crate::arguments::{Featured, RefineArguments, Way};
use crate::progress::Progress;
use crate::report::ParametersReport;

/// A way that a mesh can go.
pub(super) enum Prepared {
    /// With what is to be reached.
    Exact(Box<Goals>),
    Stepwise,
    Sqrt3Steps,
    Sqrt3,
    Restricted,
}

impl Prepared {
    /// For a control mesh with its channels. Lengths in per cent are of `diagonal`.
    ///
    /// # Errors
    /// A goal that this mesh cannot have.
    pub(super) fn new(
        arguments: &RefineArguments,
        (control, channels): (&Mesh, &Channels),
        diagonal: f64,
    ) -> anyhow::Result<Self> {
        Ok(match arguments.way() {
            Way::Exact => {
                let goals = Goals::new(arguments, control, diagonal)?;
                Self::Exact(Box::new(goals.carrying(channels, control, arguments)?))
            }
            Way::Stepwise => Self::Stepwise,
            Way::Sqrt3Steps => Self::Sqrt3Steps,
            Way::Sqrt3 => Self::Sqrt3,
            Way::Restricted => Self::Restricted,
        })
    }

    /// What was asked for, defaults filled in.
    ///
    /// # Errors
    /// A length has a unit, and the mesh's is not known.
    pub(super) fn parameters(
        &self,
        arguments: &RefineArguments,
        diagonal: f64,
    ) -> anyhow::Result<ParametersReport> {
        match self {
            Self::Exact(goals) => Ok(exact::parameters(arguments, goals)),
            Self::Stepwise | Self::Sqrt3Steps => Ok(stepwise::parameters(arguments)),
            Self::Sqrt3 => sqrt3::parameters(arguments, diagonal),
            Self::Restricted => restricted::parameters(arguments, diagonal),
        }
    }

    /// Refines a control mesh. `before` is the mesh that was read.
    ///
    /// # Errors
    /// The refinement's own.
    pub(super) fn run(
        &self,
        (control, before, diagonal): (Featured, &Before, f64),
        channels: &Channels,
        (arguments, format): (&RefineArguments, Format),
        progress: &Progress,
    ) -> anyhow::Result<Refined> {
        match self {
            Self::Exact(goals) => {
                exact::run((&control, before, channels), goals, arguments, progress)
            }
            Self::Stepwise => stepwise::run(
                (control.mesh, channels, false),
                arguments,
                Some(format),
                progress,
            ),
            Self::Sqrt3Steps => sqrt3::by_steps(&control.mesh, arguments, format, progress),
            Self::Sqrt3 => {
                sqrt3::to_goals((&control, before, diagonal), arguments, format, progress)
            }
            Self::Restricted => restricted::run(
                (&control, before, diagonal),
                channels,
                arguments,
                format,
                progress,
            ),
        }
    }
}
