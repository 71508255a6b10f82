//! Options of `limitmesh refine --method exact`: its goals and its caps, some of which other methods have, too.

use clap::Args;
use limitmesh::refine::Finish;

use super::values::{self, Extent};

/// The heading of these options in the help.
const HEADING: &str = "Goals and caps of --method exact, and of others where they say so";

/// The goals and the caps of exact refinement.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = HEADING)]
pub(crate) struct ExactArguments {
    /// Greatest distance between the mesh and the limit surface, either way [default without another goal: 0.1%]
    ///
    /// A length in the mesh's unit, with a unit where --unit gives the mesh's, or with % in per cent of the diagonal of the
    /// control mesh's bounding box. With --scheme sqrt3 it is kept by an estimate; with --method planarity it is how far the middles of
    /// edges are off, with vertex-error how far control points are from their limits [default for that: 0.1%].
    #[arg(long, value_name = "T", value_parser = values::tolerance, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<Extent>,

    /// The smoothest mesh that is certainly within that distance of the input, either way
    ///
    /// For scans and voxels, whose vertices are no more exact than that: steps are smoothed away, and closed parts keep their volume. A
    /// length in the mesh's unit, with a unit where --unit gives the mesh's, or with % in per cent of the diagonal of its bounding box. Takes the
    /// place of --tolerance and --interpolate. Where no smooth surface is so near, as where faces are large against it, edges stay sharp. The exit
    /// code is 3 where it cannot be kept, and with --strict where triangles are turned over.
    #[arg(long, value_name = "T", value_parser = values::tolerance, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["tolerance", "interpolate"])]
    pub(crate) within: Option<Extent>,

    /// The best mesh with at most so many triangles, the worst places refined first
    ///
    /// With other goals, whichever is reached first ends the refinement. Each mesh of a glTF file and each object of a 3MF file may have so many.
    /// From 20,000 on a 32nd of them may be left over, and more where many faces are alike, as on a regular sphere: dividing some of those
    /// would bring the mesh no nearer. Also with --method planarity and vertex-error and with --scheme sqrt3.
    #[arg(long, value_name = "N", value_parser = values::positive)]
    pub(crate) triangles: Option<usize>,

    /// Greatest distance between the mesh and the limit surface as the cameras see it, in pixels [default with a camera in --view: 1]
    ///
    /// Each point of one that is in a picture has one of the other so near there, outlines included; the number that was
    /// reached is reported. What no camera sees stays coarse: what is out of the picture, and of closed meshes what looks away.
    #[arg(long, value_name = "P", value_parser = values::above_zero, allow_hyphen_values = true)]
    pub(crate) pixels: Option<f64>,

    /// Let vertices leave the limit surface by up to half the local error: fewer triangles for the same tolerance
    #[arg(long)]
    pub(crate) balance: bool,

    /// Collapse edges of a finer mesh as long as the tolerance allows: slower, and fewer triangles
    ///
    /// For --tolerance and --triangles. All vertices stay on the limit surface; triangles reach over several control
    /// faces.
    #[arg(long)]
    pub(crate) optimize: bool,

    /// Divide what lies in a plane, or is straight in one direction, like all the rest
    ///
    /// Otherwise a region of the surface that lies in a plane, such as the end of a cylinder with a creased rim, gets triangles
    /// between the vertices of its rim and of the control mesh alone, and the cylinder's side long ones from rim to rim: as near to the
    /// surface with far fewer triangles.
    #[arg(long)]
    pub(crate) divide_flat: bool,

    /// Take no more memory, about [such as 500MB; K, M, G and T are powers of 1024; default: no limit]
    ///
    /// The mesh that was reached by then is written, and the exit code is 3.
    #[arg(long, value_name = "BYTES", value_parser = values::memory, allow_hyphen_values = true)]
    pub(crate) max_memory: Option<usize>,

    /// Predict the triangles and the memory, and write no mesh
    #[arg(long)]
    pub(crate) dry_run: bool,

    /// Say where each vertex and triangle came from, as properties of a PLY file
    ///
    /// Vertices have parent_face and the barycentric coordinates parent_a, parent_b and parent_c there, triangles
    /// have parent_face (with --optimize one of several): faces of the control mesh, counted from 0. Both have input_face, that face's
    /// polygon in the input, as the diagnosis counts them. Also with --method planarity and vertex-error and with --scheme sqrt3.
    #[arg(long)]
    pub(crate) provenance: bool,
}

impl ExactArguments {
    /// What is done to reach the goals with fewer triangles; both at once are refused before.
    pub(crate) fn finish(&self) -> Finish {
        match (self.optimize, self.balance) {
            (true, _) => Finish::Collapsed,
            (false, true) => Finish::Balanced,
            (false, false) => Finish::OnSurface,
        }
    }
}
