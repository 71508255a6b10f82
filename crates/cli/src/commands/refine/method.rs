//! The methods that a method's name and a scheme's choose together: their goals, what is reported of these, and the refinement.

use super::goals::Goals;
use super::refined::Refined;
use super::task::Task;
use super::{exact, restricted, sqrt3, stepwise};
use crate::arguments::Way;
use crate::report::ParametersReport;

/// A method with what it is to reach.
pub(super) enum Method {
    Exact(Box<Goals>),
    Stepwise,
    Sqrt3Steps,
    Sqrt3,
    Restricted,
}

impl Method {
    /// The method for a control mesh.
    ///
    /// # Errors
    /// A goal that this mesh cannot have.
    pub(super) fn new(task: &Task<'_>) -> anyhow::Result<Self> {
        Ok(match task.arguments.way() {
            Way::Exact => Self::Exact(Box::new(Goals::new(task)?)),
            Way::Stepwise => Self::Stepwise,
            Way::Sqrt3Steps => Self::Sqrt3Steps,
            Way::Sqrt3 => Self::Sqrt3,
            Way::Restricted => Self::Restricted,
        })
    }

    /// The options, defaults filled in.
    ///
    /// # Errors
    /// A length has a unit, and the mesh's is not known.
    pub(super) fn parameters(&self, task: &Task<'_>) -> anyhow::Result<ParametersReport> {
        let (arguments, diagonal) = (task.arguments, task.control.diagonal);
        let own = match self {
            Self::Exact(goals) => exact::parameters(task, goals)?,
            Self::Stepwise | Self::Sqrt3Steps => stepwise::parameters(arguments)?,
            Self::Sqrt3 => sqrt3::parameters(arguments, diagonal)?,
            Self::Restricted => restricted::parameters(arguments, diagonal)?,
        };
        let unit = arguments.build.unit;
        Ok(ParametersReport {
            interpolate_within: arguments.interpolation.within(diagonal, unit)?,
            ..own
        })
    }

    /// Refines a control mesh.
    ///
    /// # Errors
    /// The refinement's own.
    pub(super) fn run(&self, task: &Task<'_>) -> anyhow::Result<Refined> {
        match self {
            Self::Exact(goals) => exact::run(task, goals),
            Self::Stepwise => stepwise::run(task),
            Self::Sqrt3Steps => sqrt3::by_steps(task),
            Self::Sqrt3 => sqrt3::to_goals(task),
            Self::Restricted => restricted::run(task),
        }
    }
}
