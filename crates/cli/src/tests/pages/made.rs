//! Files that are made by tests.

use super::kept::{is_rewriting, root};

/// Compares a file of the repository with what it has to be, or writes it.
#[track_caller]
pub(super) fn check(path: &str, made: &[u8]) {
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
