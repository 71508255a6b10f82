//! Refinement by the library as others see it, for unit tests: its types are not those of a build for tests, its meshes are.

use limitmesh::refine::{self, UniformOptions};
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};

use crate::mesh::Mesh;

/// A mesh after some levels.
#[allow(clippy::unwrap_used)]
pub(crate) fn uniform(mesh: &Mesh, scheme: &dyn crate::scheme::Scheme, levels: usize) -> Mesh {
    let options = UniformOptions::default().levels(levels);
    refine::uniform(mesh, as_seen(scheme), &options)
        .unwrap()
        .mesh
}

/// A mesh after some levels, its vertices on the limit surface.
#[allow(clippy::unwrap_used)]
pub(crate) fn limit_reference(
    mesh: &Mesh,
    scheme: &dyn crate::scheme::Scheme,
    levels: usize,
) -> Mesh {
    refine::limit_reference(mesh, as_seen(scheme), levels).unwrap()
}

/// The library's scheme of that name.
fn as_seen(scheme: &dyn crate::scheme::Scheme) -> &'static dyn Scheme {
    let all: [&dyn Scheme; 3] = [&Loop, &LoopWarren, &ModifiedButterfly];
    let same = all.into_iter().find(|other| other.name() == scheme.name());
    same.unwrap_or_else(|| unreachable!("a scheme of its own: {}", scheme.name()))
}
