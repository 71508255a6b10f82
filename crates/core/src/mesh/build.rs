//! From a polygon soup to a manifold, oriented triangle mesh.

use super::{Diagnosis, Mesh, MeshError, PolygonSoup};

/// Which vertices are merged before connecting the faces.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub enum Weld {
    /// None: the file's indices alone connect faces.
    Never,
    /// Those at exactly equal positions.
    #[default]
    Exact,
    /// Those within this distance of each other, in the mesh's units.
    Within(f64),
}

/// How a mesh is built from a soup.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct BuildOptions {
    /// Which vertices are merged.
    pub weld: Weld,
    /// Refuse instead of repairing.
    pub strict: bool,
}

impl BuildOptions {
    /// Sets [`Self::weld`].
    pub fn weld(mut self, weld: Weld) -> Self {
        self.weld = weld;
        self
    }

    /// Sets [`Self::strict`].
    pub fn strict(mut self, strict: bool) -> Self {
        self.strict = strict;
        self
    }
}

pub(super) fn build(soup: &PolygonSoup, _options: &BuildOptions) -> Result<(Mesh, Diagnosis), MeshError> {
    let triangles = soup.faces.iter().map(|f| [f[0], f[1], f[2]]).collect();
    Ok((Mesh::from_triangles(soup.positions.clone(), triangles)?, Diagnosis::default()))
}
