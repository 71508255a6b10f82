//! The models of the crate limitmesh-models for unit tests: that crate is built upon the library as others see it, whose
//! types are not those of a build for tests.

use crate::mesh::PolygonSoup;

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
