//! `limitmesh reproduce`.

use std::path::PathBuf;

use clap::Args;

const DETAILS: &str = "\
In --models, these names are looked for, with the extension off, obj, ply or stl, in this order:
  bunny   bunny_1k, bunny            radish  radish, radish_standin
  teddy   teddy                      cusp    cusp, cusp_standin
  shark   shark, fish_cage           head    mannequin_142, head
  cup     cup, cup_standin           shoe    shoe, boot_684
                                     sphere  sphere_360, sphere
The built-in model of the same name (limitmesh models) takes the place of one that is not there.

Examples:
  limitmesh reproduce
  limitmesh reproduce -o paper --models ~/models
  limitmesh reproduce --quick -o /tmp/look";

/// Reproduce the paper's table and figures
///
/// Writes a folder with one page (index.html), its pictures, and the numbers as CSV and JSON: the paper's
/// Table 1 with the method of Amresh, Farin and Razdan, uniform refinement and exact refinement, its
/// Figures 2, 5, 7, 8 and 9, how the distance changes with the number of steps, and what the seam rules do. Takes a minute or two.
#[derive(Args, Debug)]
#[command(after_help = DETAILS)]
pub(crate) struct ReproduceArguments {
    /// Folder to write; made if it does not exist, files in it are overwritten
    #[arg(short, long, value_name = "DIR", default_value = "reproduction")]
    pub(crate) output: PathBuf,

    /// Folder with the paper's models; built-in models stand in for those that are not there
    #[arg(long, value_name = "DIR")]
    pub(crate) models: Option<PathBuf>,

    /// One angle, fewer samples, coarser references and smaller pictures: a first look in seconds
    #[arg(long)]
    pub(crate) quick: bool,
}
