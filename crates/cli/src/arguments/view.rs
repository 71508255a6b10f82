//! `limitmesh view`.

use std::path::PathBuf;

use clap::Args;

use super::limit::LimitArguments;
use super::shared::{OverwriteArguments, of_polynomials};
use super::values::{self, Extent};

const EXAMPLES: &str = "\
Examples:
  limitmesh view duck.glb
        a page in the browser, whose slider refines the mesh
  limitmesh view bunny.obj -o bunny.html --stops 1%,0.1%,0.01%
        a page in one file, to be sent to somebody
  limitmesh view builtin:cup --no-open
        prints the address of the page, for a browser elsewhere (ssh -L)";

/// Show a mesh in the browser, refined as a slider moves; or write the page to a file
///
/// The page is served by the program itself, to this computer alone, until the page is closed or Ctrl-C ends the program. It shows the
/// refined mesh, its wireframe, how far it is from the limit surface, the control cage, and uniform subdivision next to it.
#[derive(Args, Debug, Clone)]
#[command(after_help = EXAMPLES)]
#[command(mut_arg("scheme", |scheme| scheme.value_parser(of_polynomials())))]
pub(crate) struct ViewArguments {
    /// Mesh: a file (OBJ, PLY, STL, OFF, glTF, 3MF), or builtin:NAME
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,

    /// Tolerance that the slider starts with: a length, or per cent of the mesh's diagonal
    #[arg(long, value_name = "T", value_parser = values::tolerance, default_value = "0.1%", allow_hyphen_values = true)]
    pub(crate) tolerance: Extent,

    /// Write the page to a file that needs neither the program nor a network
    #[arg(long, short, value_name = "PAGE.html")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) overwrite: OverwriteArguments,

    /// Tolerances of the slider in the file that is written [default: --tolerance alone]
    #[arg(long, value_name = "T,…", value_parser = values::tolerance, value_delimiter = ',', allow_hyphen_values = true)]
    #[arg(requires = "output", conflicts_with_all = ["tolerance", "no_open"])]
    pub(crate) stops: Vec<Extent>,

    /// Print the address of the page and open no browser
    #[arg(long, conflicts_with = "output")]
    pub(crate) no_open: bool,

    #[command(flatten)]
    pub(crate) limit: LimitArguments,
}
