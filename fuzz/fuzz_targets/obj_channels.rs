//! Any bytes as an OBJ file, whose channels are carried to a refined mesh and written.

#![no_main]

use limitmesh_io::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| limitmesh_fuzz::carry(bytes, Format::Obj));
