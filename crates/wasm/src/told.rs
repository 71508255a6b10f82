//! Small things told to TypeScript and by it: progress, rows of numbers, what was found in a mesh.

use core::ops::ControlFlow;

use js_sys::{Array, Object, Reflect};
use limitmesh::mesh::{Diagnosis, Finding};
use limitmesh::progress::Progress;
use wasm_bindgen::JsValue;

use crate::inputs::Listener;

/// An observer that asks a listener whether to go on.
pub(crate) fn observer(
    listener: Option<&Listener>,
) -> impl FnMut(&Progress) -> ControlFlow<()> + '_ {
    move |at| {
        let Some(listener) = listener else {
            return ControlFlow::Continue(());
        };
        let total = at.total.map(|total| total as f64);
        let stage = at.stage.to_string();
        match listener.hear(&stage, at.done as f64, total, at.triangles as f64) {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    }
}

/// Rows in single precision.
pub(crate) fn singles(rows: &[[f64; 3]]) -> Vec<f32> {
    rows.as_flattened().iter().map(|&x| x as f32).collect()
}

/// A field of an object.
pub(crate) fn set(object: &Object, name: &str, value: impl Into<JsValue>) {
    // A new object takes any field.
    let _ = Reflect::set(object, &name.into(), &value.into());
}

/// A point.
pub(crate) fn point(at: [f64; 3]) -> Array {
    at.iter().copied().map(JsValue::from).collect()
}

/// What was found in the input.
pub(crate) fn diagnosis(found: &Diagnosis) -> Object {
    let texts = |all: Vec<String>| -> Array { all.into_iter().map(JsValue::from).collect() };
    let object = Object::new();
    set(&object, "clean", found.is_clean());
    set(&object, "repairs", texts(found.repairs()));
    set(&object, "preparations", texts(found.preparations()));
    let findings = Object::new();
    for (name, own) in found.findings().filter(|(_, own)| !own.is_empty()) {
        set(&findings, name, finding(own));
    }
    set(&object, "findings", findings);
    object
}

fn finding(found: &Finding) -> Object {
    let object = Object::new();
    set(&object, "count", found.count as f64);
    let first: Array = found.first.iter().copied().map(JsValue::from).collect();
    set(&object, "first", first);
    object
}
