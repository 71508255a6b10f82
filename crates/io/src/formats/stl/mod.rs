//! STL, ASCII and binary.

mod read;
mod write;

pub(crate) use read::is_binary;

use crate::codec::Codec;
use crate::format::Format;

pub(super) const CODEC: Codec = Codec {
    begins: read::begins,
    capacity: write::capacity,
    read: |bytes, _| read::read(bytes).map_err(|flaw| flaw.read_as(Format::Stl)),
    write: |writer, output, options| Ok(write::write(writer, output, options)?),
    write_file: None,
};
