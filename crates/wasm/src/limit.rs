//! Limits of a mesh's own vertices.

use limitmesh::limit::LimitTable;
use wasm_bindgen::prelude::*;

use crate::control::Control;
use crate::failure::Failure;
use crate::inputs::{ControlIn, Listener, MeshIn};
use crate::options;
use crate::soup::soup;
use crate::told::observer;

/// Where vertices go; its arrays are handed over once each.
#[wasm_bindgen]
pub struct Limits {
    positions: Vec<f64>,
    normals: Vec<f64>,
}

/// Limit positions and normals of the input's vertices; NaN where a vertex is in no face.
///
/// # Errors
/// The mesh is none, an option has no meaning, or the listener said stop.
#[wasm_bindgen]
pub fn limit(
    mesh: &MeshIn,
    control: &ControlIn,
    listener: Option<Listener>,
) -> Result<Limits, JsValue> {
    Ok(limits(mesh, control, listener.as_ref())?)
}

fn limits(mesh: &MeshIn, told: &ControlIn, listener: Option<&Listener>) -> Result<Limits, Failure> {
    let control = Control::new(
        soup(mesh)?,
        &options::build(told),
        told,
        &mut observer(listener),
    )?;
    let table = LimitTable::new(control.scheme);
    let of_input = |all: Vec<[f64; 3]>| -> Vec<f64> {
        let own = |v: &Option<u32>| v.map_or([f64::NAN; 3], |v| all[v as usize]);
        control.vertices.iter().flat_map(own).collect()
    };
    Ok(Limits {
        positions: of_input(table.positions(&control.mesh)?),
        normals: of_input(table.normals(&control.mesh)?),
    })
}

#[wasm_bindgen]
impl Limits {
    /// Three numbers a vertex.
    pub fn positions(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.positions)
    }

    /// Unit normals; at sharp edges an average of the sides.
    pub fn normals(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.normals)
    }
}
