//! Channels in and out: tables of values with an index for each vertex, corner or face.

use limitmesh::mesh::{Channel, Domain, Interpolation, SeamRule, Semantic};
use wasm_bindgen::prelude::*;

use crate::failure::Failure;
use crate::inputs::ChannelIn;
use crate::options::named;

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

/// The library's channel.
///
/// # Errors
/// A name that stands for nothing, or no numbers in a value.
pub(crate) fn channel(row: usize, told: &ChannelIn) -> Result<Channel, Failure> {
    let place = |field: &str| format!("channels[{row}].{field}");
    let semantic = named(&SEMANTICS, &told.semantic(), place("semantic"))?;
    let domain = named(&DOMAINS, &told.domain(), place("domain"))?;
    let interpolation = named(
        &INTERPOLATIONS,
        &told.interpolation(),
        place("interpolation"),
    )?;
    let components = told.components() as usize;
    if components == 0 {
        let message = "components is 0, expected at least 1";
        return Err(Failure::option(place("components"), message));
    }
    Ok(Channel::new(told.name(), semantic, domain, components)
        .interpolated(interpolation)
        .with(told.data(), told.index()))
}

/// A channel of a result.
#[wasm_bindgen]
pub struct ChannelOut(Channel);

impl ChannelOut {
    pub(crate) fn new(channel: Channel) -> Self {
        Self(channel)
    }
}

#[wasm_bindgen]
impl ChannelOut {
    /// The values, one after the other, handed over once.
    pub fn data(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.0.values)
    }

    /// By element of the domain the number of its value, handed over once.
    pub fn index(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.0.indices)
    }

    /// What the elements are.
    pub fn domain(&self) -> String {
        let found = DOMAINS.iter().find(|(_, own)| *own == self.0.domain);
        found.map_or("other", |(name, _)| name).to_owned()
    }
}
