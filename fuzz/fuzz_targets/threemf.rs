//! Any bytes as a 3MF package, and any text as its model: read as a mesh, and edited.

#![no_main]

use limitmesh_io::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    limitmesh_fuzz::read_and_build(bytes, Format::ThreeMf);
    limitmesh_fuzz::edit_package(bytes.to_vec());
    limitmesh_fuzz::edit_package(limitmesh_fuzz::packed(bytes));
});
