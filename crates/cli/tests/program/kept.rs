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
