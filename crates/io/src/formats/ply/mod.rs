//! Stanford PLY 1.0.

mod columns;
mod header;
mod read;
mod source;
mod split;
mod write;
mod write_columns;

pub use split::splits_vertices;

use crate::codec::Codec;
use crate::format::Format;

pub(super) const CODEC: Codec = Codec {
    begins: read::begins,
    capacity: |_| write_columns::capacity(),
    read: |bytes, _| read::read(bytes).map_err(|flaw| flaw.read_as(Format::Ply)),
    write: |writer, output, options| Ok(write::write(writer, output, options.ascii)?),
    write_file: None,
};
