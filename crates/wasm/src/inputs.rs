//! What TypeScript hands over, checked and complete: objects with these fields.

use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// A mesh.
    pub type MeshIn;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn positions(this: &MeshIn) -> Vec<f64>;
    /// Vertices of all polygons, one after the other.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn corners(this: &MeshIn) -> Vec<u32>;
    /// How many corners each polygon has.
    #[wasm_bindgen(method, getter, js_name = faceSize)]
    pub(crate) fn face_size(this: &MeshIn) -> u32;
    /// Pairs of vertices.
    #[wasm_bindgen(method, getter, js_name = creaseEdges)]
    pub(crate) fn crease_edges(this: &MeshIn) -> Vec<u32>;
    #[wasm_bindgen(method, getter, js_name = creaseSharpness)]
    pub(crate) fn crease_sharpness(this: &MeshIn) -> Vec<f64>;
    #[wasm_bindgen(method, getter, js_name = cornerVertices)]
    pub(crate) fn corner_vertices(this: &MeshIn) -> Vec<u32>;
    #[wasm_bindgen(method, getter, js_name = cornerSharpness)]
    pub(crate) fn corner_sharpness(this: &MeshIn) -> Vec<f64>;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn channels(this: &MeshIn) -> Vec<ChannelIn>;

    /// What a mesh carries.
    pub type ChannelIn;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn name(this: &ChannelIn) -> String;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn semantic(this: &ChannelIn) -> String;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn domain(this: &ChannelIn) -> String;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn interpolation(this: &ChannelIn) -> String;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn components(this: &ChannelIn) -> u32;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn data(this: &ChannelIn) -> Vec<f64>;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn index(this: &ChannelIn) -> Vec<u32>;

    /// How a control mesh comes of a mesh, and its limit surface of that.
    pub type ControlIn;
    /// Distance within which vertices are merged; below 0 for none.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn weld(this: &ControlIn) -> f64;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn repair(this: &ControlIn) -> bool;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn boundary(this: &ControlIn) -> String;
    /// In degrees.
    #[wasm_bindgen(method, getter, js_name = creaseAngle)]
    pub(crate) fn crease_angle(this: &ControlIn) -> Option<f64>;
    /// Whether edges are sharp that look so, if the mesh looks like a part.
    #[wasm_bindgen(method, getter, js_name = autoCreases)]
    pub(crate) fn auto_creases(this: &ControlIn) -> bool;
    /// Whether the surface of such a part is led through its vertices.
    #[wasm_bindgen(method, getter, js_name = leadsParts)]
    pub(crate) fn leads_parts(this: &ControlIn) -> bool;
    /// Whether corners of 180° and more are divided.
    #[wasm_bindgen(method, getter, js_name = dividesConcaveCorners)]
    pub(crate) fn divides_concave_corners(this: &ControlIn) -> bool;
    /// How near the limit surface is to pass to the vertices.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn interpolate(this: &ControlIn) -> Option<Extent>;
    /// None for that of the mesh's faces.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn scheme(this: &ControlIn) -> Option<String>;
    #[wasm_bindgen(method, getter, js_name = smoothTriangles)]
    pub(crate) fn smooth_triangles(this: &ControlIn) -> bool;

    /// A length, or a part of the diagonal.
    pub type Extent;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn amount(this: &Extent) -> f64;
    #[wasm_bindgen(method, getter, js_name = isPart)]
    pub(crate) fn is_part(this: &Extent) -> bool;

    /// Goals and caps.
    pub type GoalsIn;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn tolerance(this: &GoalsIn) -> Option<Extent>;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn triangles(this: &GoalsIn) -> Option<f64>;
    /// In degrees.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn angle(this: &GoalsIn) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn optimize(this: &GoalsIn) -> bool;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn balance(this: &GoalsIn) -> bool;
    #[wasm_bindgen(method, getter, js_name = flatRegions)]
    pub(crate) fn flat_regions(this: &GoalsIn) -> bool;
    #[wasm_bindgen(method, getter, js_name = maxTriangles)]
    pub(crate) fn max_triangles(this: &GoalsIn) -> Option<f64>;
    #[wasm_bindgen(method, getter, js_name = maxLevels)]
    pub(crate) fn max_levels(this: &GoalsIn) -> Option<f64>;
    #[wasm_bindgen(method, getter, js_name = maxMemory)]
    pub(crate) fn max_memory(this: &GoalsIn) -> Option<f64>;
    /// Whether positions are rounded to 32 bits.
    #[wasm_bindgen(method, getter, js_name = isSingle)]
    pub(crate) fn is_single(this: &GoalsIn) -> bool;

    /// How a distance is found.
    pub type HowIn;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn certified(this: &HowIn) -> bool;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn samples(this: &HowIn) -> f64;
    /// How narrow the interval is to be.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn gap(this: &HowIn) -> Option<Extent>;
    #[wasm_bindgen(method, getter, js_name = maxWork)]
    pub(crate) fn max_work(this: &HowIn) -> Option<f64>;
    /// Of uniform refinement that stands for a limit surface.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn levels(this: &HowIn) -> Option<f64>;

    /// Who hears of progress, and says whether to go on.
    pub type Listener;
    #[wasm_bindgen(method)]
    pub(crate) fn hear(
        this: &Listener,
        stage: &str,
        done: f64,
        total: Option<f64>,
        triangles: f64,
    ) -> bool;
}

impl Extent {
    /// As a length.
    pub(crate) fn of(&self, diagonal: f64) -> f64 {
        match self.is_part() {
            true => self.amount() * diagonal,
            false => self.amount(),
        }
    }
}
