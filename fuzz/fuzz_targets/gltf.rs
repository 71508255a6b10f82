//! Any bytes as a glTF document, in either form: read as a mesh, and edited.

#![no_main]

use limitmesh_io::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    limitmesh_fuzz::read_and_build(bytes, Format::Glb);
    limitmesh_fuzz::edit(bytes);
});
