//! Renderer of meshes for the page: smooth, with a wireframe that fades where triangles are small.

use limitmesh::Mesh;
use limitmesh::limit::LimitTable;
use limitmesh::scheme::Loop;
use limitmesh_render::{Camera, Style, ViewDirection, render};

/// Draws square pictures.
pub(super) struct Renderer {
    side: u32,
}

impl Renderer {
    pub(super) fn new(side: u32) -> Self {
        Self { side }
    }

    /// A camera that shows all of `mesh`; pictures to be compared share one.
    pub(super) fn camera(&self, mesh: &Mesh, view: ViewDirection) -> anyhow::Result<Camera> {
        Ok(Camera::fit_tightly(
            mesh.as_triangles(),
            view,
            self.side,
            self.side,
        )?)
    }

    /// The PNG file of a picture; shaded by the normals of the mesh's own limit surface.
    pub(super) fn draw(&self, mesh: &Mesh, camera: &Camera) -> anyhow::Result<Vec<u8>> {
        let normals = LimitTable::new(&Loop).normals(mesh)?;
        let style = Style::default().wireframe(true);
        let image = render(
            mesh.as_triangles(),
            Some(&normals),
            None,
            camera,
            &style,
            self.side,
            self.side,
        )?;
        Ok(image.encode_png()?)
    }

    /// A picture of one mesh alone.
    pub(super) fn portrait(&self, mesh: &Mesh, view: ViewDirection) -> anyhow::Result<Vec<u8>> {
        self.draw(mesh, &self.camera(mesh, view)?)
    }
}
