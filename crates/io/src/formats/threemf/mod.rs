//! 3MF: a package is opened, the triangles of its objects are taken out and replaced, and everything else stays as it was.
//!
//! ```text
//! file ─▶ Container ─▶ Model ─▶ ObjectSoup ─▶ (refinement) ─▶ NewTriangles ─▶ Replacement ─▶ file
//!         ZIP parts    XML text                               sources         edited text
//! ```
//!
//! A package holds more than triangles for a print: materials, build plates, slicers' settings, pictures. So it is *edited,
//! never written anew*: all parts but models are copied as they are, and of a model's text only what stands between the tags of
//! `<vertices>` and `<triangles>` changes. Triangles inherit the attributes of the one that they came from.
//!
//! The numbers that a package states of itself are not believed: parts are unpacked to a stated size at most, every index is checked, and a flaw
//! names the part, the line and the object.

mod container;
mod edit;
mod fresh;
mod model;
mod package;
mod paint;
mod properties;
mod scene;
mod volumes;
mod xml;

pub use crate::unit::LengthUnit;
pub use edit::NewTriangles;
pub use package::{ObjectContents, ObjectSoup, Package, PackageContents};
pub use properties::{Inherited, Source};

use crate::capacity::Capacity;
use crate::codec::Codec;
use crate::whole::write_in_pieces;

pub(super) const CODEC: Codec = Codec {
    begins: |bytes| bytes.starts_with(b"PK"),
    capacity: |_| Capacity::of_channels(|_| false),
    read: |bytes, _| Package::from_bytes(bytes.to_vec())?.scene_soup(),
    write: |writer, output, options| {
        let bytes = fresh::write(output.surface, options.unit.unwrap_or_default())?;
        Ok(write_in_pieces(writer, &bytes)?)
    },
    write_file: None,
};
