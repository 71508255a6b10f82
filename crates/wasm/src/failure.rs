//! What can go wrong, as TypeScript learns of it.

use limitmesh::interpolate::InterpolateError;
use limitmesh::limit::LimitError;
use limitmesh::measure::MeasureError;
use limitmesh::mesh::{ChannelError, MeshError};
use limitmesh::part::UnfoldedError;
use limitmesh::progress::Cancelled;
use limitmesh::refine::RefineError;
use wasm_bindgen::JsValue;

/// Why a call gave nothing.
pub(crate) struct Failure {
    code: &'static str,
    /// The argument or option at fault, as TypeScript names it.
    place: String,
    message: String,
}

impl Failure {
    /// The mesh is at fault.
    pub(crate) fn mesh(place: impl Into<String>, message: impl ToString) -> Self {
        Self::new("mesh", place, message)
    }

    /// An option is.
    pub(crate) fn option(place: impl Into<String>, message: impl ToString) -> Self {
        Self::new("option", place, message)
    }

    /// A file is.
    #[cfg(feature = "io")]
    pub(crate) fn read(place: impl Into<String>, message: impl ToString) -> Self {
        Self::new("read", place, message)
    }

    /// The same, of one of several meshes: its places begin with the mesh's name.
    pub(crate) fn of(mut self, mesh: &str) -> Self {
        if self.code == "mesh" {
            let place = format!("{mesh}.{}", self.place);
            self.message = match self.message.strip_prefix(&self.place) {
                Some(rest) => format!("{place}{rest}"),
                None => format!("{mesh}: {}", self.message),
            };
            self.place = place;
        }
        self
    }

    fn new(code: &'static str, place: impl Into<String>, message: impl ToString) -> Self {
        Self {
            code,
            place: place.into(),
            message: message.to_string(),
        }
    }
}

impl From<Failure> for JsValue {
    fn from(failure: Failure) -> Self {
        let Failure {
            code,
            place,
            message,
        } = failure;
        js_sys::Array::of3(&code.into(), &place.into(), &message.into()).into()
    }
}

/// The option of the library's that has no meaning, as TypeScript names it.
fn option_name(name: &str) -> &'static str {
    match name {
        "tolerance" => "tolerance",
        "angle" | "number of angle and pixel goals" => "angle",
        "number of levels" => "maxLevels",
        "crease angle" => "creaseAngle",
        name if name.contains("weld") => "weld",
        name if name.contains("sharpness") => "creases",
        _ => "options",
    }
}

impl From<MeshError> for Failure {
    fn from(error: MeshError) -> Self {
        match &error {
            MeshError::BadOption { name, .. } => Self::option(option_name(name), error),
            MeshError::NotFinite {
                vertex,
                axis,
                value,
            } => {
                let place = format!("positions[{}]", 3 * vertex + axis);
                let message = format!("{place} is {value}, expected a finite number");
                Self::mesh(place, message)
            }
            MeshError::Isolated { .. } => Self::mesh("positions", error),
            _ => Self::mesh("index", error),
        }
    }
}

impl From<LimitError> for Failure {
    fn from(error: LimitError) -> Self {
        Self::mesh("index", error)
    }
}

impl From<Cancelled> for Failure {
    fn from(_: Cancelled) -> Self {
        let message = "the call was cancelled: onProgress returned false";
        Self::new("cancelled", "onProgress", message)
    }
}

impl From<ChannelError> for Failure {
    fn from(error: ChannelError) -> Self {
        Self::option("channels", error)
    }
}

impl From<MeasureError> for Failure {
    fn from(error: MeasureError) -> Self {
        match error {
            MeasureError::Cancelled(cancelled) => cancelled.into(),
            error => Self::mesh("positions", error),
        }
    }
}

impl From<RefineError> for Failure {
    fn from(error: RefineError) -> Self {
        match error {
            RefineError::Cancelled(cancelled) => cancelled.into(),
            RefineError::Mesh(error) => error.into(),
            error => Self::mesh("index", error),
        }
    }
}

impl From<InterpolateError> for Failure {
    fn from(error: InterpolateError) -> Self {
        match error {
            InterpolateError::Cancelled(cancelled) => cancelled.into(),
            InterpolateError::Mesh(error) => error.into(),
            InterpolateError::TooFar { .. } => Self::option("interpolate", error),
            error => Self::mesh("positions", error),
        }
    }
}

impl From<UnfoldedError> for Failure {
    fn from(error: UnfoldedError) -> Self {
        match error {
            UnfoldedError::Interpolate(error) => error.into(),
            UnfoldedError::Refine(error) => error.into(),
            error => Self::mesh("positions", error),
        }
    }
}

#[cfg(feature = "io")]
impl From<limitmesh_io::ReadError> for Failure {
    fn from(error: limitmesh_io::ReadError) -> Self {
        let place = match &error {
            limitmesh_io::ReadError::Flaw { flaw, .. } => flaw.place.to_string(),
            _ => "bytes".to_owned(),
        };
        Self::read(place, error)
    }
}

#[cfg(feature = "io")]
impl From<limitmesh_io::WriteError> for Failure {
    fn from(error: limitmesh_io::WriteError) -> Self {
        Self::read("to", error)
    }
}

#[cfg(feature = "io")]
impl From<limitmesh_io::Flaw> for Failure {
    fn from(flaw: limitmesh_io::Flaw) -> Self {
        Self::read(flaw.place.to_string(), flaw)
    }
}
