//! The paper's adaptive refinement: flags on the current mesh, Figure 5's four cases, points from old positions.

use super::driver::Driver;
use super::junctions::agree;
use super::split::SplitEdges;
use super::{RefineError, Refinement};
use crate::criterion::Criterion;
use crate::index::{HalfEdgeId, VertexId};
use crate::limit::LimitTable;
use crate::mesh::Mesh;
use crate::options;
use crate::parallel;
use crate::progress::{Observer, unobserved};
use crate::scheme::Scheme;

/// The vertices that take their new position in a step; the paper does not define them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SeamRule {
    /// All vertices of the mesh.
    #[default]
    All,
    /// Vertices with at least one divided face.
    Any,
    /// Vertices all of whose faces are divided.
    Inner,
}

options! {
    /// The options of stepwise refinement.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct StepwiseOptions {
        /// Greatest number of steps.
        pub levels: usize = 3,
        /// The vertices that move.
        pub seam: SeamRule = SeamRule::All,
        /// Whether to move the vertices to the limit surface of the last mesh at the end.
        pub limit: bool = false,
        /// Whether to report the origins of vertices and triangles
        /// ([`Refinement::origins`](crate::refine::Refinement::origins)).
        pub origins: bool = false,
        /// The most triangles: refinement stops before the step that would exceed them.
        pub max_triangles: Option<usize> = None,
    }
}

/// Refines the faces of `mesh` that fail by `criterion`.
///
/// Each step's mesh is the next step's control mesh. Its faces are flagged, every edge of a flagged face is
/// split, the other faces are closed by the cases of Figure 5, and all points are computed from the old
/// positions: so each step leaves a conforming mesh, and the limit surface is that of the current mesh.
///
/// # Errors
/// See [`RefineError`].
pub fn stepwise(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    criterion: &dyn Criterion,
    options: &StepwiseOptions,
) -> Result<Refinement, RefineError> {
    stepwise_observed(mesh, scheme, criterion, options, &mut unobserved)
}

/// [`stepwise`], with an observer.
///
/// # Errors
/// See [`RefineError`].
pub fn stepwise_observed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    criterion: &dyn Criterion,
    options: &StepwiseOptions,
    observer: &mut Observer<'_>,
) -> Result<Refinement, RefineError> {
    let limits = LimitTable::new(scheme);
    let flags = |mesh: &Mesh| Ok(criterion.divisible(mesh, &limits)?);
    let driver = Driver {
        scheme,
        levels: options.levels,
        limit: options.limit,
        normals: false,
        origins: options.origins,
        max_triangles: options.max_triangles,
    };
    driver.run(mesh, observer, flags, |mesh, split| {
        moving_vertices(mesh, split, options.seam)
    })
}

/// Which vertices take their new position under a seam rule; `None` for all.
fn moving_vertices(mesh: &Mesh, split: &SplitEdges, seam: SeamRule) -> Option<Vec<bool>> {
    let topology = mesh.topology();
    let divided = |h: HalfEdgeId| split.count(h.face().index()) == 3;
    let combine: fn(bool, bool) -> bool = match seam {
        SeamRule::All => return None,
        SeamRule::Any => |a, b| a | b,
        SeamRule::Inner => |a, b| a & b,
    };
    let mut moves = parallel::map(mesh.vertex_count(), |v| {
        let faces = topology.outgoing_ring(VertexId(v as u32));
        faces.map(divided).reduce(combine).unwrap_or(false)
    });
    agree(&mut moves, &mesh.junctions().vertices, combine);
    Some(moves)
}
