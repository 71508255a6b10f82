//! Files of the repository that tests make anew: each is what a test makes, or is written with `LIMITMESH_REWRITE=1`.

use std::path::PathBuf;

/// The repository's folder.
pub(crate) fn root() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "..", ".."].iter().collect()
}

/// Whether files are to be written rather than compared.
pub(crate) fn is_rewriting() -> bool {
    std::env::var_os("LIMITMESH_REWRITE").is_some_and(|value| value == "1")
}

/// Compares a file of the repository with what it has to be, or writes it.
#[track_caller]
pub(crate) fn check(path: &str, made: &[u8]) {
    let file = root().join(path);
    let is_same = std::fs::read(&file).is_ok_and(|found| found == made);
    if !is_same && is_rewriting() {
        std::fs::write(&file, made).expect("the file can be written");
    } else {
        assert!(
            is_same,
            "{path} is not what the program says; LIMITMESH_REWRITE=1 cargo test -p limitmesh-cli pages writes it"
        );
    }
}
