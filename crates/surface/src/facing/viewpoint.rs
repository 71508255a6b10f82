//! Where a viewer stands.

/// The position of the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// Parallel projection: the direction of sight `N_view`, from the viewer into the scene; any length but 0.
    Direction([f64; 3]),
    /// Perspective: the eye point; each face has the direction from the eye to its centroid.
    Eye([f64; 3]),
}
