//! Any bytes as an STL file.

#![no_main]

use limitmesh_io::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| limitmesh_fuzz::read_and_build(bytes, Format::Stl));
