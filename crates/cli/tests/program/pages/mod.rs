//! The documentation: commands on its pages give what is shown, links lead somewhere, reports are as their schema says, and the
//! files of `examples/models` are what these pages need.

mod commands;
mod links;
mod reports;

use crate::common::text;
use std::path::{Path, PathBuf};

use crate::kept::root;

/// A page of the repository.
struct Page {
    /// Its path below the repository's folder.
    name: String,
    text: String,
}

/// All pages, sorted by their paths.
fn pages() -> Vec<Page> {
    let mut files = Vec::new();
    markdown_in(&root(), false, &mut files);
    for folder in ["docs", "examples", "fuzz", "crates"] {
        markdown_in(&root().join(folder), true, &mut files);
    }
    files.sort();
    let page = |file: PathBuf| {
        let below = file.strip_prefix(root()).expect("below the root");
        let name = below.to_str().expect("a name in UTF-8").to_owned();
        Page {
            name,
            text: text(file),
        }
    };
    files.into_iter().map(page).collect()
}

fn markdown_in(folder: &Path, goes_below: bool, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let is_built = path
            .file_name()
            .is_some_and(|name| name == "target" || name == "node_modules");
        if path.is_dir() && goes_below && !is_built {
            markdown_in(&path, true, found);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
}
