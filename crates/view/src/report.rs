//! What is known of a mesh, in numbers.

use serde::Serialize;

/// A refined mesh in numbers. Lengths are in the mesh's unit.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Its triangles.
    pub triangles: usize,
    /// Its vertices.
    pub vertices: usize,
    /// How far it is from the limit surface at most; `None` where that is not known.
    pub upper: Option<f64>,
    /// And at least.
    pub lower: Option<f64>,
    /// Whether that is proven.
    pub certified: bool,
    /// How long its refinement took.
    pub seconds: f64,
    /// What else there is to say, in lines of text.
    pub words: Vec<String>,
    /// The uniform mesh that stands next to it.
    pub uniform: Option<UniformReport>,
}

/// A uniformly subdivided mesh in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct UniformReport {
    /// How often its control faces are divided in four.
    pub levels: u32,
    /// Its triangles.
    pub triangles: usize,
    /// How far it is from the limit surface, as sampled; `None` where that is not known.
    pub upper: Option<f64>,
}
