//! Exact refinement: within a proven distance, an angle, or with a number of triangles.

use js_sys::Object;
use limitmesh::carry::{borders, carried};
use limitmesh::mesh::Channel;
use limitmesh::progress::Observer;
use limitmesh::refine::{ErrorBounds, Exact, ExactStop, exact_observed, most_rounding_to_single};
use wasm_bindgen::prelude::*;

use crate::channels::ChannelOut;
use crate::control::Control;
use crate::failure::Failure;
use crate::inputs::{ControlIn, GoalsIn, Listener, MeshIn};
use crate::soup::soup;
use crate::told;
use crate::{options, told::observer};

/// A refined mesh; its arrays are handed over once each.
#[wasm_bindgen]
pub struct Refined {
    control: Control,
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[f64; 3]>,
    sides: Vec<(u32, [f64; 3])>,
    parents: Vec<u32>,
    channels: Vec<Channel>,
    reached: Reached,
    levels: usize,
    inverted: usize,
}

/// Refines a mesh to goals.
///
/// # Errors
/// The mesh is none, an option has no meaning, or the listener said stop.
#[wasm_bindgen]
pub fn refine(
    mesh: &MeshIn,
    control: &ControlIn,
    goals: &GoalsIn,
    listener: Option<Listener>,
) -> Result<Refined, JsValue> {
    Ok(refined(mesh, control, goals, listener.as_ref())?)
}

fn refined(
    mesh: &MeshIn,
    told: &ControlIn,
    goals: &GoalsIn,
    listener: Option<&Listener>,
) -> Result<Refined, Failure> {
    let mut observer = observer(listener);
    let control = Control::new(soup(mesh)?, &options::build(told), told, &mut observer)?;
    let scale = Scale {
        diagonal: control.diagonal,
        is_rounded: goals.is_single(),
    };
    let (found, channels) = exact_of(&control, told, goals, scale, &mut observer)?;
    let moved = match goals.is_single() {
        true => rounding(found.mesh.positions()),
        false => 0.0,
    };
    let reached = Reached::of(&found, goals, control.diagonal, moved);
    Ok(Refined::new(found, reached, control, channels))
}

/// What lengths are given in parts of, and whether positions are rounded to 32 bits afterwards.
#[derive(Clone, Copy)]
pub(crate) struct Scale {
    pub(crate) diagonal: f64,
    pub(crate) is_rounded: bool,
}

/// A control mesh refined to goals, and what it carries.
///
/// # Errors
/// The mesh has no limit, or the observer said stop.
pub(crate) fn exact_of(
    control: &Control,
    told: &ControlIn,
    goals: &GoalsIn,
    scale: Scale,
    observer: &mut Observer<'_>,
) -> Result<(Exact, Vec<Channel>), Failure> {
    let varies = control.channels.iter().any(Channel::varies_within_faces);
    let rounding = match scale.is_rounded {
        true => most_rounding_to_single(control.mesh.positions()),
        false => 0.0,
    };
    let unfolds = told.divides_concave_corners();
    let options = options::exact(goals, scale.diagonal, rounding, varies, unfolds);
    let options = options.kept_edges(borders(&control.channels, &control.mesh));
    let found = exact_observed(&control.mesh, control.scheme, &options, observer)?;
    let channels = match control.channels.is_empty() {
        true => Vec::new(),
        false => carried(&control.channels, &control.mesh, control.scheme, &found)?,
    };
    Ok((found, channels))
}

impl Refined {
    fn new(found: Exact, reached: Reached, mut control: Control, channels: Vec<Channel>) -> Self {
        let inverted = found.inverted_triangles();
        let (positions, triangles) = found.mesh.into_positions_and_triangles();
        // What the result needs no longer.
        (control.channels, control.vertices) = Default::default();
        Self {
            parents: control.input_faces(found.parents),
            control,
            positions,
            triangles,
            normals: found.normals,
            sides: found.sides,
            channels,
            reached,
            levels: found.statistics.levels,
            inverted,
        }
    }
}

/// How far one of these positions moves as its numbers become those of 32 bits.
fn rounding(positions: &[[f64; 3]]) -> f64 {
    let square = |x: f64| (x - f64::from(x as f32)) * (x - f64::from(x as f32));
    let squares = positions.iter().map(|own| own.map(square));
    squares
        .fold(0.0f64, |most, [x, y, z]| most.max(x + y + z))
        .sqrt()
}

/// Bounds of the distance of a result as it is handed over, and why it ended.
pub(crate) struct Reached {
    pub(crate) error: ErrorBounds,
    pub(crate) stop: ExactStop,
}

impl Reached {
    /// That of a result whose positions are rounded by so much afterwards, with a tolerance in parts of a diagonal.
    pub(crate) fn of(found: &Exact, goals: &GoalsIn, diagonal: f64, rounded: f64) -> Self {
        let error = found.error.rounded(rounded);
        let tolerance = goals.tolerance().map(|own| own.of(diagonal));
        let is_past = rounded > 0.0 && tolerance.is_some_and(|tolerance| error.upper > tolerance);
        let stop = match found.stop {
            ExactStop::Met if is_past => ExactStop::Rounding,
            stop => stop,
        };
        Self { error, stop }
    }
}

#[wasm_bindgen]
impl Refined {
    /// Three numbers a vertex.
    pub fn positions(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.positions).into_flattened()
    }

    /// The same in single precision.
    pub fn positions_single(&mut self) -> Vec<f32> {
        told::singles(&std::mem::take(&mut self.positions))
    }

    /// Three vertices a triangle.
    pub fn index(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.triangles).into_flattened()
    }

    /// The limit normals of vertices.
    pub fn normals(&mut self) -> Vec<f32> {
        told::singles(&std::mem::take(&mut self.normals))
    }

    /// Corners, numbered as in the index, whose normal is not that of their vertex.
    pub fn side_corners(&self) -> Vec<u32> {
        self.sides.iter().map(|&(corner, _)| corner).collect()
    }

    /// The normals of these.
    pub fn side_normals(&self) -> Vec<f32> {
        let rows: Vec<[f64; 3]> = self.sides.iter().map(|&(_, normal)| normal).collect();
        told::singles(&rows)
    }

    /// By triangle, the input's face.
    pub fn parents(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.parents)
    }

    /// What was carried along, handed over once, in the input's order.
    pub fn channels(&mut self) -> Vec<ChannelOut> {
        let channels = std::mem::take(&mut self.channels).into_iter();
        channels.map(ChannelOut::new).collect()
    }

    /// All else that is told of it, by the names of TypeScript's result.
    pub fn told(&self) -> Object {
        let (object, error) = (Object::new(), Object::new());
        told::set(&error, "lower", self.reached.error.lower);
        told::set(&error, "upper", self.reached.error.upper);
        told::set(&error, "certified", self.reached.error.certified);
        told::set(&object, "error", error);
        told::set(&object, "stop", self.reached.stop.name());
        told::set(&object, "levels", self.levels as f64);
        told::set(&object, "inverted", self.inverted as f64);
        let crease_angle = self.control.crease_angle.map(JsValue::from);
        told::set(
            &object,
            "creaseAngle",
            crease_angle.unwrap_or(JsValue::NULL),
        );
        let diagnosis = told::diagnosis(&self.control.diagnosis);
        told::set(&object, "diagnosis", diagnosis);
        object
    }
}
