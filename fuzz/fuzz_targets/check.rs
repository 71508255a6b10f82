//! Any bytes as the files that `limitmesh-check` reads; and as what follows the head of a proof of a small mesh.

#![no_main]

use limitmesh_check::proof::Proof;
use limitmesh_check::{read, verdict};

const MESH: &str = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    for name in ["a.obj", "a.off", "a.ply"] {
        let _ = read::mesh(name, bytes);
    }
    let _ = Proof::read(bytes);
    let Ok(mesh) = read::mesh("a.off", MESH.as_bytes()) else { return };
    let head = format!("limitmesh proof 1\nscheme loop\nwithin 0.3\ncontrol {0}\nresult {0}\nend\n", mesh.digest());
    if let Ok(proof) = Proof::read(&[head.as_bytes(), bytes].concat()) {
        let _ = verdict::refused(&mesh, &mesh, &proof, 0.3);
    }
});
