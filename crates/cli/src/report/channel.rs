//! The report on a mesh's values apart from its shape.

use limitmesh::mesh::{Channel, Domain, Interpolation};
use serde::Serialize;

use crate::arguments::ChannelArguments;

/// A channel of the input.
#[derive(Serialize, Debug, Clone)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ChannelReport {
    /// Its name in the file, or what it is where the format gives no names.
    pub(crate) name: String,
    /// `vertex`, `corner` or `face`.
    pub(crate) domain: &'static str,
    /// Numbers in a value.
    pub(crate) arity: usize,
    /// `smooth`, `linear` or `nearest`; `drop` where it is left out on demand.
    pub(crate) interpolation: &'static str,
    /// Values in the table.
    pub(crate) values: usize,
}

impl From<&Channel> for ChannelReport {
    fn from(channel: &Channel) -> Self {
        Self {
            name: channel.name.clone(),
            domain: match channel.domain {
                Domain::Vertex => "vertex",
                Domain::Corner => "corner",
                Domain::Face => "face",
            },
            arity: channel.arity,
            interpolation: match channel.interpolation {
                Interpolation::Smooth(_) => "smooth",
                Interpolation::Linear => "linear",
                _ => "nearest",
            },
            values: channel.value_count(),
        }
    }
}

impl ChannelReport {
    /// Of a channel that is carried as options say.
    pub(crate) fn chosen(channel: &Channel, arguments: &ChannelArguments) -> Self {
        let found = Self::from(channel);
        let interpolation = if arguments.drops_channel(channel) {
            "drop"
        } else {
            found.interpolation
        };
        Self {
            interpolation,
            ..found
        }
    }

    /// Of an attribute of triangles that others inherit from them.
    pub(crate) fn inherited(name: &str, faces: usize, arguments: &ChannelArguments) -> Self {
        let interpolation = if arguments.drops(name, false) {
            "drop"
        } else {
            "nearest"
        };
        Self {
            name: name.to_owned(),
            domain: "face",
            arity: 1,
            interpolation,
            values: faces,
        }
    }

    /// `texture coordinates (2 numbers a corner)`.
    pub(crate) fn in_words(&self) -> String {
        match self.interpolation {
            "nearest" => format!("{} (by {})", self.name, self.domain),
            _ => format!(
                "{} ({} a {})",
                self.name,
                crate::format::counted(self.arity, "number", "numbers"),
                self.domain
            ),
        }
    }
}
