//! The models of the crate limitmesh-models for unit tests: that crate is built upon the library as others see it, whose
//! types are not those of a build for tests.

use crate::mesh::{Mesh, PolygonSoup};

/// A model.
pub(crate) struct Model(limitmesh_models::Model);

/// The model of that name.
pub(crate) fn find(name: &str) -> Option<Model> {
    limitmesh_models::find(name).map(Model)
}

impl Model {
    /// The model's polygons.
    pub(crate) fn soup(&self) -> PolygonSoup {
        let soup = self.0.soup();
        PolygonSoup { positions: soup.positions, faces: soup.faces.iter().collect(), ..Default::default() }
    }
}

/// Points on a model's, each off by up to a share of the diagonal that depends on the seed.
#[allow(clippy::unwrap_used)]
pub(crate) fn stirred(name: &str, seed: u64) -> Mesh {
    stir(Mesh::from_soup(&find(name).unwrap().soup(), &Default::default()).unwrap().0, seed)
}

/// The same of any mesh.
#[allow(clippy::unwrap_used)]
pub(crate) fn stir(mesh: Mesh, seed: u64) -> Mesh {
    let mut state = seed;
    let size = [0.0, 0.01, 0.05, 0.2][seed as usize % 4] * mesh.diagonal();
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        size * ((state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    };
    let positions = mesh.positions().iter().map(|p| p.map(|x| x + next())).collect();
    mesh.with_positions(positions).unwrap()
}
