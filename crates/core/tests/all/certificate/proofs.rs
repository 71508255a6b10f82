//! Results by `limitmesh-check`, which shares nothing with the library: it confirms what is certified, and nothing below what was found.

use limitmesh::Mesh;
use limitmesh::refine::Exact;
use limitmesh::scheme::Scheme;
use limitmesh_check::mesh::Mesh as Plain;
use limitmesh_check::proof::Proof as Claim;
use limitmesh_check::verdict;
use limitmesh_io::{Proof, ProofError};

/// Bounds that a search has tightened are not proven by the triangles one by one; these prove so many times as much at most.
const MOST_TIMES: f64 = 1024.0;

fn plain(mesh: &Mesh) -> Plain {
    Plain { positions: mesh.positions().to_vec(), triangles: mesh.triangles().to_vec() }
}

/// How many triangles of a result are refused at a length; none where there can be no proof.
pub(crate) fn refused(
    control: &Mesh,
    scheme: &dyn Scheme,
    result: &Exact,
    within: f64,
) -> Result<Option<usize>, String> {
    let Some(scheme) = scheme.loop_family() else { return Ok(None) };
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
    let refused = verdict::refused(&plain(control), &plain(&result.mesh), &claim, within)?;
    Ok(Some(refused.len()))
}

/// Confirmed at what is certified, or a little above; refused below what was found.
pub(super) fn check(control: &Mesh, scheme: &dyn Scheme, result: &Exact) -> Result<(), String> {
    let error = result.error;
    let below = 0.999 * error.lower;
    if below > 0.0 && refused(control, scheme, result, below)? == Some(0) {
        return Err(format!("confirmed at {below:e}, although {error:?}"));
    }
    let mut times = 1.0;
    while refused(control, scheme, result, times * error.upper)?.is_some_and(|count| count > 0) {
        times *= 2.0;
        if times > MOST_TIMES {
            return Err(format!("not confirmed at {times} times {error:?}"));
        }
    }
    Ok(())
}
