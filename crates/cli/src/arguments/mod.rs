//! The command line: one file a command, help texts that say each option's unit, default and effect.

mod asset;
mod batch;
mod channels;
mod compare;
mod evaluate;
mod exact;
mod features;
mod info;
mod interpolation;
mod limit;
mod lod;
mod measure;
mod models;
mod project;
mod quantity;
mod refine;
mod render;
mod reproduce;
mod shared;
mod shipped;
mod tolerances;
mod values;
mod view;
mod viewer;

pub(crate) use asset::AssetArguments;
pub(crate) use batch::{BatchArguments, BatchJobArguments};
pub(crate) use channels::ChannelArguments;
pub(crate) use compare::CompareArguments;
pub(crate) use evaluate::{EvaluateArguments, Place, Places};
pub(crate) use exact::ExactArguments;
pub(crate) use features::{
    Boundary, ConcaveCorners, CreaseAngle, CreasesFrom, FeatureArguments, Featured,
};
pub(crate) use info::InfoArguments;
pub(crate) use interpolation::InterpolationArguments;
pub(crate) use limit::LimitArguments;
pub(crate) use lod::LodArguments;
pub(crate) use measure::MeasureArguments;
pub(crate) use models::ModelsArguments;
pub(crate) use project::ProjectArguments;
pub(crate) use quantity::{Length, Unit};
pub(crate) use refine::{FaceKind, MOST_EXACT, Method, RefineArguments, Way};
pub(crate) use render::RenderArguments;
pub(crate) use reproduce::ReproduceArguments;
pub(crate) use shared::{
    BuildArguments, OverwriteArguments, RefiningScheme, SMOOTH_TRIANGLES, SchemeName,
};
pub(crate) use shipped::{CompletionsArguments, ManArguments};
pub(crate) use tolerances::MorphTolerance;
pub(crate) use values::{Extent, MAX_STEPS, Shard, Size};
pub(crate) use view::ViewArguments;
pub(crate) use viewer::Viewer;

use clap::{Arg, Args, Parser, Subcommand};

use shared::GENERAL;

const EXAMPLES: &str = "\
Examples:
  limitmesh refine builtin:head -o head.ply --picture head.png
        a mesh within 0.1 % of the smooth surface of a built-in model, and a picture of it
  limitmesh view duck.glb
        a page in the browser, whose slider refines the mesh
  limitmesh info scan.stl
        says what is in a file and what would be repaired
  limitmesh measure head.ply --limit-of builtin:head
        how far the refined mesh is from the limit surface
  limitmesh evaluate builtin:head --at 0,0.5,0.25,0.25
        point, normal and curvature of the limit surface over a place of face 0
  limitmesh project scan.ply --onto control.obj -o deviation.ply
        how far points of a scan are from the limit surface, as a colour map
  limitmesh lod builtin:cup -o cup.glb --morph
        levels of detail with geomorphs, in one file
  limitmesh compare builtin:head --angle 5
        the methods side by side at equal triangle counts
  limitmesh batch jobs.jsonl -o results.jsonl
        many meshes, each in a process of its own

Exit codes: 0 done, 1 bad input or output, 2 usage, 3 stopped short of what was asked (a cap); 130, 143 and 129 where
Ctrl-C, SIGTERM or SIGHUP cancelled it: no file is left half written.";

/// Smooths triangle meshes by adaptive subdivision, measures them, shows them.
///
/// A control mesh is refined only where its faces stand badly for the smooth limit surface: until the mesh is
/// certainly within a tolerance of it, has as many triangles as it may, or keeps an angle. INPUT is a file (OBJ,
/// PLY, STL, OFF, glTF, 3MF), - for standard input with --from, or builtin:NAME; `limitmesh models` lists the names.
///
/// Counts may be written 20000, 20,000, 20k or 2e4; lengths with a unit, such as 0.05mm, where --unit says what the
/// numbers of the mesh are.
#[derive(Parser, Debug)]
#[command(name = "limitmesh", bin_name = "limitmesh", version, propagate_version = true, after_help = EXAMPLES)]
#[command(mut_args(with_negative_numbers), mut_subcommands(|own| own.mut_args(with_negative_numbers)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) global: GlobalArguments,
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// Takes -5 after an option for its value, so that the error says what is wrong with it.
fn with_negative_numbers(argument: Arg) -> Arg {
    match !argument.is_positional() && argument.get_action().takes_values() {
        true => argument.allow_negative_numbers(true),
        false => argument,
    }
}

/// Options of every command.
#[derive(Args, Debug)]
pub(crate) struct GlobalArguments {
    /// Print no progress and no notes on standard error; errors still appear
    #[arg(long, short, global = true, help_heading = GENERAL)]
    pub(crate) quiet: bool,

    /// Number of threads; 0 takes all processors. Results are the same bytes for any number
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = values::threads)]
    #[arg(global = true, help_heading = GENERAL)]
    pub(crate) threads: usize,
}

/// The command.
#[derive(Subcommand, Debug)]
pub(crate) enum Command {
    Refine(Box<RefineArguments>),
    Measure(MeasureArguments),
    Compare(CompareArguments),
    View(Box<ViewArguments>),
    Render(RenderArguments),
    Reproduce(ReproduceArguments),
    Info(InfoArguments),
    Evaluate(EvaluateArguments),
    Project(ProjectArguments),
    Lod(Box<LodArguments>),
    Models(ModelsArguments),
    Batch(BatchArguments),
    #[command(hide = true)]
    BatchJob(BatchJobArguments),
    #[command(hide = true)]
    Completions(CompletionsArguments),
    #[command(hide = true)]
    Man(ManArguments),
}
