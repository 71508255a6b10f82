//! The paper's figures, each from its own file: what is measured for it, and its pictures.

pub(super) mod closure;
pub(super) mod cone;
pub(super) mod head;
pub(super) mod shoe;
pub(super) mod view;

use serde::Serialize;

use crate::room::Room;

/// A picture file of the page.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Picture {
    /// File name within the folder.
    pub(super) file: String,
    /// The same for phones, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) narrow: Option<String>,
    /// What it shows, for those who cannot see it.
    pub(super) alt: String,
    /// What stands below it.
    pub(super) caption: String,
}

impl Picture {
    pub(super) fn new(
        file: impl Into<String>,
        alt: impl Into<String>,
        caption: impl Into<String>,
    ) -> Self {
        Self {
            file: file.into(),
            narrow: None,
            alt: alt.into(),
            caption: caption.into(),
        }
    }

    /// A drawing in both its layouts, whose files are called `stem`.
    pub(super) fn drawn(stem: &str, alt: impl Into<String>, caption: impl Into<String>) -> Self {
        Self {
            narrow: Some(Room::Narrow.file(stem)),
            ..Self::new(Room::Wide.file(stem), alt, caption)
        }
    }
}
