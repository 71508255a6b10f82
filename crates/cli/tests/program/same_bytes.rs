//! Hashes of what the library makes of the built-in models, which the tests of the npm package compare with their own.

use std::fmt::Write;

use limitmesh::Mesh;
use limitmesh::refine::{ExactOptions, exact};
use limitmesh::scheme::Loop;
use sha2::{Digest, Sha256};

use crate::kept::{is_rewriting, root};

/// Shares of the diagonal, as the package's callers write them.
const GOALS: [(&str, f64); 3] = [
    ("1%", 1.0 / 100.0),
    ("0.1%", 0.1 / 100.0),
    ("0.02%", 0.02 / 100.0),
];

/// The package refines without threads, as WebAssembly: the bytes of positions and triangles are these, or its test fails.
#[test]
fn models_refine_to_the_hashes_that_the_npm_package_is_compared_with() {
    let mut lines = String::new();
    for model in limitmesh_models::all() {
        let (mesh, _) = Mesh::from_soup(&model.soup(), &Default::default()).expect("a mesh");
        for (goal, share) in GOALS {
            let options = ExactOptions::default()
                .tolerance(share * mesh.diagonal())
                .origins(false);
            let found = exact(&mesh, &Loop, &options).expect("a refined mesh");
            let (hash, triangles) = (hash(&found.mesh), found.mesh.face_count());
            writeln!(lines, "{} {goal} {triangles} {hash}", model.name).expect("a line");
        }
    }
    let path = root().join("npm/test/same-bytes.txt");
    if is_rewriting() {
        std::fs::write(&path, &lines).expect("the file");
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == lines,
        "{} is not what the library makes; LIMITMESH_REWRITE=1 cargo test -p limitmesh-cli same_bytes writes it",
        path.display()
    );
}

/// SHA-256 of positions as 64-bit numbers and of triangles as 32-bit ones, little-endian.
fn hash(mesh: &Mesh) -> String {
    let mut hash = Sha256::new();
    for x in mesh.positions().as_flattened() {
        hash.update(x.to_le_bytes());
    }
    for v in mesh.triangles().as_flattened() {
        hash.update(v.to_le_bytes());
    }
    hash.finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
