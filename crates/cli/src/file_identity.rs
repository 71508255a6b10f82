//! Which paths name one file: by links, by `./`, and by capitals where the file system does not distinguish them.

use std::path::{Path, PathBuf};

/// A file, whichever path names it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum FileIdentity {
    /// One that is there: by its device, and its number on that.
    #[cfg(unix)]
    There { device: u64, number: u64 },
    /// One that may not be there: by its path from the root, without links as far as that is there.
    Path(PathBuf),
}

impl FileIdentity {
    /// Of the file that a path names, as far as is known without making it.
    pub(crate) fn of(path: &Path) -> Self {
        #[cfg(unix)]
        if let Ok(found) = std::fs::metadata(path) {
            use std::os::unix::fs::MetadataExt;
            return Self::There {
                device: found.dev(),
                number: found.ino(),
            };
        }
        Self::Path(whole(path))
    }
}

fn whole(path: &Path) -> PathBuf {
    if let Ok(there) = path.canonicalize() {
        return there;
    }
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => std::path::absolute(path).unwrap_or_else(|_| path.to_owned()),
    }
}
