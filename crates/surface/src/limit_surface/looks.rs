//! The direction in which the surface over whole control faces faces, and cones of its normals.

use super::LimitSurface;
use crate::facing::Viewpoint;
use crate::facing::{self, Facing, NormalCone};
use crate::index::FaceId;
use crate::parallel::Cancelled;
use crate::patch::root_patch;
use crate::progress::{Observer, SharedWatch, Stage, uncancelled};

/// Faces that are processed together.
const BLOCK: usize = 64;

impl LimitSurface<'_> {
    /// Whether all of the surface over a control face shows its front to a viewer, or its back:
    /// proven, and [undecided](Facing::Undecided) where both are seen, where rounding or bounds do
    /// not decide, where the surface has no tangent plane, for schemes but the Loop family and Catmull–Clark and
    /// on faces that do not exist.
    ///
    /// ```
    /// use limitmesh_surface::Viewpoint;
    /// use limitmesh_surface::{FaceId, Facing, LimitSurface, Mesh, scheme::Loop};
    ///
    /// let mesh = Mesh::from_triangles(
    ///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
    ///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
    /// )?;
    /// let surface = LimitSurface::new(&mesh, &Loop)?;
    /// // The first face looks along (1, 1, −1).
    /// assert_eq!(surface.facing(FaceId(0), &Viewpoint::Eye([9.0, 9.0, -9.0])), Facing::Front);
    /// assert_eq!(surface.facing(FaceId(0), &Viewpoint::Direction([1.0, 1.0, -1.0])), Facing::Back);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn facing(&self, face: FaceId, viewpoint: &Viewpoint) -> Facing {
        if face.index() >= self.mesh.face_count() {
            return Facing::Undecided;
        }
        let patch = root_patch(self.mesh, &self.sharpness, &self.large, face, &self.rules);
        facing::of_patch(&patch, &self.rules, viewpoint, facing::DEEPEST)
    }

    /// [`Self::facing`] of all control faces, in order, on all threads.
    pub fn facing_of_all(&self, viewpoint: &Viewpoint) -> Vec<Facing> {
        uncancelled(|observer| self.facing_of_all_observed(viewpoint, observer))
    }

    /// [`Self::facing_of_all`] with an observer.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn facing_of_all_observed(
        &self,
        viewpoint: &Viewpoint,
        observer: &mut Observer<'_>,
    ) -> Result<Vec<Facing>, Cancelled> {
        let faces = self.mesh.face_count();
        let watch = SharedWatch::new(observer, Stage::Looking);
        watch.triangles(faces);
        watch.stage(Stage::Looking, Some(faces))?;
        let of_face = |face: usize| self.facing(FaceId(face as u32), viewpoint);
        let blocks = watch.pieces(faces, BLOCK, |block| block.map(of_face).collect::<Vec<_>>())?;
        watch.done(faces)?;
        Ok(blocks.concat())
    }

    /// A cone that holds all normals of the surface over a control face, with the apexes which
    /// decide by one product how the surface faces any viewpoint; `None` where the normals are not
    /// known to be within a half space.
    pub fn normal_cone(&self, face: FaceId) -> Option<NormalCone> {
        if face.index() >= self.mesh.face_count() {
            return None;
        }
        let patch = root_patch(self.mesh, &self.sharpness, &self.large, face, &self.rules);
        let mut points = Vec::new();
        let cone = facing::cone_of_patch(&patch, &self.rules, &mut points, facing::DEEPEST)?;
        Some(NormalCone::of(&cone, points.into_iter()))
    }
}
