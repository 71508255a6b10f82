//! Geomview OFF in text.

mod colours;
mod keyword;
mod read;
mod vertex_columns;
mod write;

use crate::codec::Codec;
use crate::format::Format;

pub(super) const CODEC: Codec = Codec {
    begins: read::begins,
    capacity: |_| write::capacity(),
    read: |bytes, _| read::read(bytes).map_err(|flaw| flaw.read_as(Format::Off)),
    write: |writer, output, _| Ok(write::write(writer, output)?),
    write_file: None,
};
