//! `limitmesh refine`.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, Args, ValueEnum};
use limitmesh::QuadOptions;
use limitmesh::criterion::{Camera, View, Viewpoint};
use limitmesh::scheme::Scheme;
use limitmesh_io::{Format, WriteOptions};
use serde::Serialize;

use super::asset::AssetArguments;
use super::channels::ChannelArguments;
use super::exact::ExactArguments;
use super::features::FeatureArguments;
use super::interpolation::InterpolationArguments;
use super::shared::{BuildArguments, GENERAL, OverwriteArguments, RefiningScheme, formats};
use super::values;
use super::viewer::{Viewer, cameras_in};
use crate::failure::{UsageError, usage};
use crate::output::is_standard_output;

/// The rule that decides which faces are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Method {
    /// Parts of faces that are too far from the limit surface, or fail another goal; vertices lie on the limit surface
    Exact,
    /// Faces whose normal leaves the cone around a limit normal of their vertices, step by step
    LimitNormal,
    /// Faces whose normal differs too much from an edge neighbour's, step by step (Amresh, Farin and Razdan)
    Amresh,
    /// All faces
    Uniform,
    /// Parts of faces that are not flat at their corners and the middles of their edges, by --angle or --tolerance, over a restricted quadtree
    /// (Zorin, Schröder and Sweldens)
    Planarity,
    /// Parts of faces whose corners' control points are too far from their limits, by --tolerance, over a restricted quadtree (Müller and Jaeschke)
    VertexError,
}

impl Method {
    /// As it is called on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::LimitNormal => "limit-normal",
            Self::Amresh => "amresh",
            Self::Uniform => "uniform",
            Self::Planarity => "planarity",
            Self::VertexError => "vertex-error",
        }
    }
}

/// What faces a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FaceKind {
    /// Triangles alone
    Triangles,
    /// Quads where the distance allows it, and triangles between them
    Quads,
}

/// How a mesh is refined: what method and scheme mean together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// To goals that are proven.
    Exact,
    /// Step by step: uniformly, or what a criterion marks.
    Stepwise,
    /// Uniform steps of √3-subdivision.
    Sqrt3Steps,
    /// Adaptive √3-subdivision, to goals that are estimated.
    Sqrt3,
    /// Over a restricted quadtree, by a criterion of the literature.
    Restricted,
}

impl Way {
    /// Whether it is one of √3-subdivision, which has a limit surface of its own.
    pub(crate) fn is_sqrt3(self) -> bool {
        matches!(self, Self::Sqrt3Steps | Self::Sqrt3)
    }
}

const EXAMPLES: &str = "\
Examples:
  limitmesh refine builtin:cup -o cup.ply
  limitmesh refine scan.stl -o smooth.obj --tolerance 0.05 --report smooth.json
  limitmesh refine builtin:head -o head.ply --triangles 20000
  limitmesh refine builtin:cup -o seen.ply --pixels 0.5 --view 0,-4,2,0,0,0,0,0,1,40,1920x1080
  limitmesh refine builtin:cup --tolerance 0.001% --dry-run
  limitmesh refine builtin:cup -o cup.ply --method limit-normal --angle 5 --levels 4
  limitmesh refine builtin:sphere -o seen.ply --method limit-normal --view 0,0,-1 --levels 5
  limitmesh refine builtin:cup -o cup.ply --method planarity --angle 5
  limitmesh refine builtin:cup -o cup.ply --method vertex-error --tolerance 0.1%
  limitmesh refine part.stl -o part.ply --crease-angle 30 --interpolate
  limitmesh refine scan.stl -o smooth.ply --interpolate=0.05
  limitmesh refine builtin:head -o head.ply --scheme sqrt3 --angle 10
  limitmesh refine builtin:head -o head.ply --scheme sqrt3 --method uniform --levels 5 --limit
  limitmesh refine big.ply -o fine.ply --method uniform --max-triangles 20M
  limitmesh refine part.stl -o part.ply --tolerance 0.05mm --unit mm
  limitmesh refine *.stl -o smooth/ --triangles 20k
  limitmesh refine walk_*.obj -o smooth/ --shared-topology --tolerance 0.05% --report walk.json
  limitmesh refine - --from stl -o - --to ply < scan.stl > smooth.ply

Exit code 3 means that a cap was reached before what was asked for; the mesh is written, and free of cracks.";

const FIRST_EXAMPLES: &str = "\
Examples:
  limitmesh refine scan.stl -o smooth.obj --tolerance 0.05 --report smooth.json
  limitmesh refine builtin:head -o head.ply --triangles 20000 --picture head.png
  limitmesh refine *.stl -o smooth/ --triangles 20k";

/// The options that a first user needs, which `-h` shows by these headings; `--help` shows all.
const USUAL: [(&str, &[&str]); 3] = [
    (
        "Goal",
        &[
            "tolerance",
            "within",
            "triangles",
            "angle",
            "optimize",
            "unit",
        ],
    ),
    ("Sharpness", &["crease_angle", "boundary", "interpolate"]),
    (
        "Output",
        &["output", "to", "overwrite", "report", "picture", "dry_run"],
    ),
];

/// Gives usual options their heading, and keeps others out of the short help.
fn by_use(argument: Arg) -> Arg {
    let id = argument.get_id().as_str();
    let is_kept = argument.is_positional() || id == "help";
    match USUAL.iter().find(|(_, ids)| ids.contains(&id)) {
        Some((heading, ids)) => {
            let place = ids.iter().position(|own| *own == id);
            let argument = argument.help_heading(*heading);
            place.into_iter().fold(argument, Arg::display_order)
        }
        None if is_kept => argument,
        None if argument.get_help_heading().is_some() => argument.hide_short_help(true),
        None => argument.help_heading("Other options").hide_short_help(true),
    }
}

/// Triangles at most where no number is given: as many as take about 10 gigabytes.
pub(crate) const MOST_EXACT: usize = 30_000_000;
const MOST_STEPWISE: usize = 50_000_000;
/// A restricted quadtree keeps the pieces of its nodes.
const MOST_RESTRICTED: usize = 5_000_000;

/// The dilatant factor where none is given: the paper's in most of its experiments.
const USUAL_DILATATION: f64 = 1.0;

/// The heading of the options of the stepwise methods.
const STEPWISE: &str = "Options of the other methods";

/// Refine a mesh where it stands badly for its smooth limit surface
///
/// By default the result is within a tolerance of the limit surface, certainly and in both directions, with all
/// vertices on it. The other methods refine step by step: each step marks faces, splits them in four, and closes
/// the gaps to their neighbours. No method leaves cracks.
#[derive(Args, Clone, Debug)]
#[command(after_help = FIRST_EXAMPLES, after_long_help = EXAMPLES, mut_args(by_use))]
#[command(disable_help_flag = true, disable_version_flag = true)]
pub(crate) struct RefineArguments {
    /// Mesh files (.obj, .ply, .stl, .off, .gltf, .glb, .3mf), - for standard input, or builtin:NAME
    ///
    /// With several, --output is a folder: each is refined by itself, and where one fails the others go on.
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,

    /// The angle that a face's normal may differ by [degrees, above 0 to 180]
    ///
    /// Smaller angles divide more faces. For exact and limit-normal it is the cone around the limit normals of the
    /// face's vertices; for amresh the angle between neighbouring faces; for planarity that to limit normals at corners and middles of
    /// edges. Not with --method uniform and vertex-error. Default: 10 for limit-normal, amresh and planarity; for exact it is one of the goals, and there is none. Where the surface has no tangent
    /// plane, as at a cusp, exact ends at 1/1024 of a control face times the angle in radians, and says so.
    #[arg(long, value_name = "DEG", value_parser = values::angle, allow_hyphen_values = true)]
    pub(crate) angle: Option<f64>,

    #[command(flatten)]
    pub(crate) features: FeatureArguments,

    #[command(flatten)]
    pub(crate) interpolation: InterpolationArguments,

    /// File to write, whose extension (.obj, .ply, .stl, .off, .gltf, .glb, .3mf) chooses the format; FOLDER/, or - for standard output
    ///
    /// In a folder, which is made if its name ends with a slash, files are called as their inputs are. Without this, x.obj becomes
    /// x-smooth.obj in the same folder, and builtin:cup becomes cup-smooth.ply in the current one.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) overwrite: OverwriteArguments,

    /// Format to write, whatever the name of the file says; standard output needs it
    #[arg(long, value_parser = formats(), value_name = "FORMAT")]
    pub(crate) to: Option<Format>,

    /// The inputs are frames of one mesh: refine them with the same triangles, each within the goals
    ///
    /// Frames share faces and tags, and only vertices move. A part is divided if any frame needs it; the files that are written have
    /// identical triangles, and each frame's vertices on its own limit surface. What is proven is reported for every frame in
    /// --report FILE.json. Sharp edges, texture coordinates and the like are those of the first frame, of whose diagonal
    /// --tolerance is a part where it is in per cent.
    #[arg(long)]
    pub(crate) shared_topology: bool,

    /// The rule that decides which faces are divided
    #[arg(long, value_enum, default_value = "exact")]
    pub(crate) method: Method,

    /// Who looks at the mesh: a direction of sight X,Y,Z, an eye @X,Y,Z, a camera EYE,TARGET,UP,FOV,WxH, or a file of cameras
    ///
    /// A direction, from the viewer into the scene, or an eye makes --angle depend on the viewer, with --method exact or limit-normal:
    /// faces that look away are never divided, those that look straight at the viewer where their normal leaves a cone of --dilatation
    /// times --angle, which closes towards the silhouette; there limit-normal divides always. With exact it never gets narrower than
    /// --angle: a viewer never costs triangles, and it takes a --dilatation above 1 to have the front coarser. Cameras are for --pixels:
    /// one mesh serves them all, however many times this is given. EYE, TARGET and UP are X,Y,Z each; FOV is the vertical angle of view
    /// in degrees, WxH the picture in pixels, such as 0,0,5,0,0,0,0,1,0,45,1920x1080. A file has one camera a line, with nothing after
    /// a '#'.
    #[arg(long, value_name = "WHO", allow_hyphen_values = true)]
    pub(crate) view: Vec<Viewer>,

    /// Factor on the angle of faces that look straight at the viewer [at least 0; default: 1]
    ///
    /// Larger values divide fewer of them; with a direction or an eye in --view only. With --method exact values below 1 count as 1.
    #[arg(long, value_name = "K", value_parser = values::factor, allow_hyphen_values = true)]
    pub(crate) dilatation: Option<f64>,

    /// Subdivision scheme
    ///
    /// sqrt3 divides triangles by their centres and flips edges, so that no closing triangles are needed; --angle, --tolerance
    /// (estimated from samples, not proven) and --triangles are its goals, and with --method uniform each of --levels steps gives three times
    /// the triangles. It follows boundaries, corners and edges that are sharp for ever; texture coordinates and the like are left out.
    /// Default: catmull-clark for files, and meshes of glTF assets, whose faces are quads for the most part, where no other option is for
    /// triangles alone; else loop.
    #[arg(long, value_enum)]
    pub(crate) scheme: Option<RefiningScheme>,

    /// Faces to write [default: quads for --scheme catmull-clark in OBJ, PLY and OFF files, else triangles]
    ///
    /// Two triangles become a quad where the distance holds for both of its diagonals. Between smaller and larger quads there are triangles;
    /// with --method uniform all faces are quads. Triangles alone are fewer for the same distance. Quads are for distances: with --angle,
    /// cameras, --attribute-tolerance and --shared-topology there are triangles.
    #[arg(long, value_enum)]
    pub(crate) faces: Option<FaceKind>,

    /// Make the surface rounder where a cage for Catmull–Clark has triangles
    ///
    /// OpenSubdiv's rule: edges of triangles have other weights in the first step. With --scheme catmull-clark only.
    #[arg(long)]
    pub(crate) smooth_triangles: bool,

    /// Give no more triangles
    ///
    /// The mesh that was reached by then is written, and the exit code is 3; the stepwise methods stop before the step that
    /// would give more. Default: 30000000 for exact, 5000000 for planarity and vertex-error, 50000000 for the others, which keep
    /// memory below about 10 gigabytes.
    #[arg(long, value_name = "N", value_parser = values::positive)]
    pub(crate) max_triangles: Option<usize>,

    #[command(flatten)]
    pub(crate) channels: ChannelArguments,

    #[command(flatten)]
    pub(crate) build: BuildArguments,

    /// Divide no part of a control face more often [0 to 24]
    ///
    /// The mesh that was reached by then is written. Of the stepwise methods it is the number of steps [0 to 12; default: 3]; for goals it is a
    /// cap [1 to 24; default: 24, for planarity and vertex-error 30, for --scheme sqrt3, where two levels divide an edge in three, 20], and
    /// the exit code is 3 where it is reached.
    #[arg(long, value_name = "N", value_parser = values::levels)]
    pub(crate) levels: Option<usize>,

    /// Write PLY and STL as text rather than binary
    #[arg(long)]
    pub(crate) ascii: bool,

    /// Write a vertex for each side of sharp edges, with the limit normal of that side: PLY only
    ///
    /// OBJ files hold normals by corner, with or without this.
    #[arg(long)]
    pub(crate) split_normals: bool,

    /// Write a JSON report: input, repairs, parameters, result, seconds (- for standard output, or FOLDER/)
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,

    /// Draw the refined mesh with its edges, but for those of triangles smaller than 4 pixels (or FOLDER/)
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,

    /// Write a proof of the distance, which limitmesh-check confirms (or FOLDER/)
    ///
    /// limitmesh-check is a small program that shares nothing with limitmesh: it recomputes the limit surface and checks that each point of the
    /// result is within the distance of it, and each point of it of the result. The proof is checked before it is written. It needs triangles over one
    /// control face each: --divide-flat is implied, and --optimize does not go with it. For OBJ, OFF and PLY files.
    #[arg(long, value_name = "FILE.proof")]
    pub(crate) proof: Option<PathBuf>,

    // Their headings hold for what follows.
    #[command(flatten)]
    pub(crate) exact: ExactArguments,

    #[command(flatten)]
    pub(crate) asset: AssetArguments,

    /// Print the options that a first user needs; all others: --help
    #[arg(short, long, action = ArgAction::Help, help_heading = GENERAL)]
    pub(crate) help: Option<bool>,

    /// Move the vertices to the limit surface of the last mesh at the end
    ///
    /// With --method uniform that is the limit surface of the input. The adaptive methods have drifted from it by
    /// then, and may come out farther from it than without this option.
    #[arg(long, help_heading = STEPWISE)]
    pub(crate) limit: bool,
}

impl RefineArguments {
    /// How the mesh is refined.
    pub(crate) fn way(&self) -> Way {
        match (self.scheme_name(), self.method) {
            (RefiningScheme::Sqrt3, Method::Uniform) => Way::Sqrt3Steps,
            (RefiningScheme::Sqrt3, _) => Way::Sqrt3,
            (_, Method::Exact) => Way::Exact,
            (_, Method::Planarity | Method::VertexError) => Way::Restricted,
            (_, Method::LimitNormal | Method::Amresh | Method::Uniform) => Way::Stepwise,
        }
    }

    /// The cap on triangles that holds.
    pub(crate) fn max_triangles(&self) -> usize {
        let most = match self.way() {
            Way::Exact | Way::Sqrt3 => MOST_EXACT,
            Way::Restricted => MOST_RESTRICTED,
            Way::Stepwise | Way::Sqrt3Steps => MOST_STEPWISE,
        };
        self.max_triangles.unwrap_or(most)
    }

    /// The scheme, where it is one that splits triangles in four.
    ///
    /// # Errors
    /// It is not.
    pub(crate) fn scheme(&self) -> anyhow::Result<&'static dyn Scheme> {
        Ok(self.scheme_name().in_quarters()?.scheme())
    }

    /// The name of the scheme that holds: what was asked for, or what a file's faces decided.
    pub(crate) fn scheme_name(&self) -> RefiningScheme {
        self.asked_scheme().unwrap_or_default()
    }

    /// The scheme that was asked for, if only by an option that goes with no other.
    pub(crate) fn asked_scheme(&self) -> Option<RefiningScheme> {
        let needs_quads = self.smooth_triangles || self.faces == Some(FaceKind::Quads);
        self.scheme
            .or(needs_quads.then_some(RefiningScheme::CatmullClark))
    }

    /// The first option that is for triangles alone, as it was given.
    pub(crate) fn needs_triangles(&self) -> Option<String> {
        let exact = &self.exact;
        let options = [
            ("--within", exact.within.is_some()),
            ("--optimize", exact.optimize),
            ("--proof", self.proof.is_some()),
        ];
        if !matches!(self.method, Method::Exact | Method::Uniform) {
            return Some(format!("--method {}", self.method.name()));
        }
        let mut given = options.into_iter().filter(|&(_, is_given)| is_given);
        given.next().map(|(name, _)| name.to_owned())
    }

    /// Whether the scheme is for quads.
    pub(crate) fn has_quads(&self) -> bool {
        self.scheme_name() == RefiningScheme::CatmullClark
    }

    /// Why there can be no quads, if there cannot.
    pub(crate) fn no_quads(&self, format: Option<Format>) -> Option<&'static str> {
        let is_by_distance = self.angle.is_none()
            && !self.has_cameras()
            && !self.shared_topology
            && self.channels.given_tolerance().is_none();
        if !self.has_quads() {
            Some("--faces quads is for --scheme catmull-clark, whose meshes have some")
        } else if !is_by_distance {
            Some(
                "--faces quads keeps distances; not --angle, cameras, --attribute-tolerance and --shared-topology",
            )
        } else if !matches!(format, None | Some(Format::Obj | Format::Ply | Format::Off)) {
            Some("--faces quads is for OBJ, PLY and OFF files; the others hold triangles alone")
        } else {
            None
        }
    }

    /// Whether quads are written.
    pub(crate) fn has_quads_out(&self, format: Option<Format>) -> bool {
        self.faces != Some(FaceKind::Triangles) && self.no_quads(format).is_none()
    }

    /// The rules by which polygons become quads, where the scheme is for these.
    pub(crate) fn quads(&self) -> Option<QuadOptions> {
        let options = self.features.quads(self.smooth_triangles);
        self.has_quads().then_some(options)
    }

    /// The view that makes the angle depend on the viewer.
    pub(crate) fn viewer(&self) -> Option<View> {
        let viewpoint = |viewer: &Viewer| match *viewer {
            Viewer::Direction(direction) => Some(Viewpoint::Direction(direction)),
            Viewer::Eye(eye) => Some(Viewpoint::Eye(eye)),
            Viewer::Camera(_) | Viewer::File(_) => None,
        };
        Some(View {
            viewpoint: self.view.iter().find_map(viewpoint)?,
            dilatation: self.dilatation.unwrap_or(USUAL_DILATATION),
        })
    }

    /// Whether there are cameras.
    pub(crate) fn has_cameras(&self) -> bool {
        let is_camera = |own: &Viewer| matches!(own, Viewer::Camera(_) | Viewer::File(_));
        self.view.iter().any(is_camera)
    }

    /// The direction of sight of pictures.
    pub(crate) fn sight(&self) -> Option<[f64; 3]> {
        self.view.iter().find_map(|viewer| match viewer {
            Viewer::Direction(direction) => Some(*direction),
            _ => None,
        })
    }

    /// All cameras.
    ///
    /// # Errors
    /// A file of cameras cannot be read.
    pub(crate) fn cameras(&self) -> anyhow::Result<Vec<Camera>> {
        let mut cameras = Vec::new();
        for viewer in &self.view {
            match viewer {
                Viewer::Camera(camera) => cameras.push(*camera),
                Viewer::File(path) => cameras.extend(cameras_in(path)?),
                Viewer::Direction(_) | Viewer::Eye(_) => {}
            }
        }
        Ok(cameras)
    }

    /// Whether flat regions are divided like all else, as proofs need it.
    pub(crate) fn divides_flat(&self) -> bool {
        self.exact.divide_flat || self.proof.is_some()
    }

    /// The one input of a job: the first.
    pub(crate) fn input(&self) -> &Path {
        self.inputs.first().map_or(Path::new(""), PathBuf::as_path)
    }

    /// The file to write; a dry run has none.
    pub(crate) fn output_name(&self) -> String {
        let name = |path: &PathBuf| {
            if is_standard_output(path) {
                "standard output".to_owned()
            } else {
                path.display().to_string()
            }
        };
        self.output.as_ref().map_or(String::new(), name)
    }

    /// The format to write; none for a dry run without a name.
    ///
    /// # Errors
    /// Neither the name of the file nor an option says which.
    pub(crate) fn format(&self) -> anyhow::Result<Option<Format>> {
        let Some(path) = &self.output else {
            return Ok(self.to);
        };
        match self.to {
            Some(to) => Ok(Some(to)),
            None if is_standard_output(path) => {
                usage("standard output has no name that says its format; --to FORMAT does")
            }
            None => Ok(Some(
                Format::from_path(path).map_err(|unknown| UsageError(unknown.to_string()))?,
            )),
        }
    }

    /// How the output is written.
    pub(crate) fn write_options(&self) -> WriteOptions {
        WriteOptions::default().ascii(self.ascii)
    }
}
