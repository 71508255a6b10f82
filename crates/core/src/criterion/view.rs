//! View-dependent adaptation (the paper's section 3.3, equations 11 to 13).

/// Where the viewer looks from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sight {
    /// Parallel projection: the direction of sight `N_view`, from the viewer into the scene.
    Direction([f64; 3]),
    /// Perspective: the eye point; each face has the direction from the eye to its centroid.
    Eye([f64; 3]),
}

/// A view and how much tolerance it gives to faces that look at the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the viewer looks from.
    pub sight: Sight,
    /// The paper's dilatant factor k (1 in most of its experiments).
    pub dilatation: f64,
}
