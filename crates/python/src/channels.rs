//! Channels in and out: tables of values with an index for each vertex, corner or face.

use limitmesh::mesh::{Channel, Domain, Interpolation, SeamRule, Semantic, Storage};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::OptionError;

/// A channel as the Python half hands it over.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct ChannelIn<'py> {
    name: String,
    semantic: String,
    domain: String,
    interpolation: String,
    storage: String,
    values: PyReadonlyArray2<'py, f64>,
    indices: PyReadonlyArray1<'py, i64>,
    labels: Vec<String>,
}

const SEMANTICS: [(&str, Semantic); 6] = [
    ("texture", Semantic::TextureCoordinates),
    ("colour", Semantic::Colour),
    ("skin-weight", Semantic::SkinWeight),
    ("displacement", Semantic::Displacement),
    ("label", Semantic::Label),
    ("other", Semantic::Other),
];

const DOMAINS: [(&str, Domain); 3] = [
    ("vertex", Domain::Vertex),
    ("corner", Domain::Corner),
    ("face", Domain::Face),
];

const INTERPOLATIONS: [(&str, Interpolation); 7] = [
    ("linear", Interpolation::Linear),
    ("nearest", Interpolation::Nearest),
    ("smooth-none", Interpolation::Smooth(SeamRule::None)),
    (
        "smooth-corners-only",
        Interpolation::Smooth(SeamRule::CornersOnly),
    ),
    (
        "smooth-corners-plus1",
        Interpolation::Smooth(SeamRule::CornersPlus1),
    ),
    (
        "smooth-corners-plus2",
        Interpolation::Smooth(SeamRule::CornersPlus2),
    ),
    (
        "smooth-boundaries",
        Interpolation::Smooth(SeamRule::Boundaries),
    ),
];

const STORAGES: [(&str, Storage); 9] = [
    ("double", Storage::Double),
    ("single", Storage::Single),
    ("byte", Storage::Byte),
    ("int8", Storage::Int8),
    ("uint8", Storage::Uint8),
    ("int16", Storage::Int16),
    ("uint16", Storage::Uint16),
    ("int32", Storage::Int32),
    ("uint32", Storage::Uint32),
];

/// The value that a name stands for.
fn named<T: Copy>(all: &[(&str, T)], name: &str, what: &str) -> PyResult<T> {
    let found = all.iter().find(|(own, _)| *own == name);
    found.map(|&(_, value)| value).ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|&(name, _)| name).collect();
        OptionError::new_err(format!(
            "{what} is '{name}', expected one of {}",
            names.join(", ")
        ))
    })
}

/// The name of a value.
fn name_of<T: PartialEq>(all: &[(&'static str, T)], value: &T) -> &'static str {
    all.iter()
        .find(|(_, own)| own == value)
        .map_or("other", |&(name, _)| name)
}

impl ChannelIn<'_> {
    /// The library's channel.
    ///
    /// # Errors
    /// A name that stands for nothing, an index that is negative.
    pub(crate) fn channel(&self) -> PyResult<Channel> {
        let what = |field: &str| format!("channels[{:?}].{field}", self.name);
        let semantic = named(&SEMANTICS, &self.semantic, &what("semantic"))?;
        let domain = named(&DOMAINS, &self.domain, &what("domain"))?;
        let interpolation = named(&INTERPOLATIONS, &self.interpolation, &what("interpolation"))?;
        let storage = named(&STORAGES, &self.storage, &what("storage"))?;
        let arity = self.values.shape()[1];
        let indices = self
            .indices
            .as_slice()?
            .iter()
            .enumerate()
            .map(|(row, &index)| {
                u32::try_from(index).map_err(|_| {
                    OptionError::new_err(format!(
                        "{}[{row}] is {index}, expected at least 0",
                        what("indices")
                    ))
                })
            });
        let mut channel = Channel::new(&*self.name, semantic, domain, arity)
            .interpolated(interpolation)
            .stored(storage)
            .with(
                self.values.as_slice()?.to_vec(),
                indices.collect::<PyResult<_>>()?,
            );
        channel.labels.clone_from(&self.labels);
        Ok(channel)
    }
}

/// A channel for the Python half.
pub(crate) fn told<'py>(py: Python<'py>, channel: Channel) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let (rows, arity) = (channel.value_count(), channel.arity);
    dict.set_item("name", &channel.name)?;
    dict.set_item("semantic", name_of(&SEMANTICS, &channel.semantic))?;
    dict.set_item("domain", name_of(&DOMAINS, &channel.domain))?;
    dict.set_item(
        "interpolation",
        name_of(&INTERPOLATIONS, &channel.interpolation),
    )?;
    dict.set_item("storage", name_of(&STORAGES, &channel.storage))?;
    dict.set_item("labels", &channel.labels)?;
    dict.set_item(
        "values",
        PyArray1::from_vec(py, channel.values).reshape([rows, arity])?,
    )?;
    dict.set_item("indices", PyArray1::from_vec(py, channel.indices))?;
    Ok(dict)
}
