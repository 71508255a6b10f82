//! Results by `limitmesh-check`, which shares nothing with the library: it confirms what is certified, and nothing below what was found.

use limitmesh::Mesh;
use limitmesh::refine::Exact;
use limitmesh::scheme::Scheme;
use limitmesh_check::mesh::Mesh as Plain;
use limitmesh_check::proof::Proof as Claim;
use limitmesh_check::tiling::Refusal;
use limitmesh_check::verdict;
use limitmesh_io::{Proof, ProofError};

fn plain(mesh: &Mesh) -> Plain {
    Plain { positions: mesh.positions().to_vec(), triangles: mesh.triangles().to_vec() }
}

/// The triangles of a result that are refused at a length; none where there can be no proof.
pub(crate) fn refused(
    control: &Mesh,
    scheme: &dyn Scheme,
    result: &Exact,
    within: f64,
) -> Result<Option<Vec<Refusal>>, String> {
    // Triangles that came of collapses are over several control faces.
    let (Some(scheme), false) = (scheme.loop_family(), result.is_optimized) else { return Ok(None) };
    let proof = Proof {
        control,
        holds_control: true,
        scheme,
        result: result.mesh.as_triangles(),
        origins: &result.origins,
        parents: &result.parents,
    };
    let bytes = match proof.to_bytes(within) {
        Err(ProofError::SeveralFaces(_)) => return Ok(None),
        bytes => bytes.map_err(|why| why.to_string())?,
    };
    let claim = Claim::read(&bytes)?;
    verdict::refused(&plain(control), &plain(&result.mesh), &claim, within).map(Some)
}

/// Confirmed at what is certified, or at some multiple; refused below what was found.
pub(super) fn check(control: &Mesh, scheme: &dyn Scheme, result: &Exact) -> Result<(), String> {
    let error = result.error;
    let below = 0.999 * error.lower;
    if below > 0.0 && refused(control, scheme, result, below)?.is_some_and(|refused| refused.is_empty()) {
        return Err(format!("confirmed at {below:e}, although {error:?}"));
    }
    // Bounds that a search has tightened are not proven by the triangles one by one, which may drift along the surface; as far as the mesh is large they do not.
    let mut within = error.upper;
    while let Some([first, ..]) = refused(control, scheme, result, within)?.as_deref() {
        if within > 2.0 * control.diagonal() {
            return Err(format!("not confirmed at {within:e}, {error:?}: {first:?}"));
        }
        within *= 2.0;
    }
    Ok(())
}
