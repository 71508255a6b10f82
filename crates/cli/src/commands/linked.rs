//! Files that an input names and that stay where they are, such as materials: by names that lead to them from the output's folder.

use std::path::{Component, Path, PathBuf};

use crate::progress::Progress;

/// Names of files in an output, given those in the input; says which lead elsewhere now, and which lead nowhere.
pub(super) fn from_output(
    names: Vec<String>,
    (input, output): (&Path, Option<&Path>),
    progress: &Progress,
) -> Vec<String> {
    let (Some(from), Some(output)) = (folder(input), output.and_then(folder)) else {
        return names;
    };
    if from == output {
        return names;
    }
    let way = way(&output, &from);
    let renamed = |name: String| match way.as_ref().and_then(|way| led(&name, &from, way)) {
        Some(new) => {
            progress.note(format!("{name}: left where it is, and named {new}"));
            new
        }
        None if Path::new(&name).is_absolute() => name,
        None => {
            progress.note(format!("{name}: named as in the input, and not found from the output's folder"));
            name
        }
    };
    names.into_iter().map(renamed).collect()
}

/// The folder that a file is in, whole, if there is one.
fn folder(file: &Path) -> Option<PathBuf> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    folder.canonicalize().ok()
}

/// From one folder to another, as names in files have it; nothing where there is none, as from one drive to another.
fn way(from: &Path, to: &Path) -> Option<String> {
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let mut way = "../".repeat(from.components().count() - shared);
    for part in to.components().skip(shared) {
        let Component::Normal(name) = part else { return None };
        way.push_str(name.to_str()?);
        way.push('/');
    }
    Some(way)
}

/// The name of a file in the folder, or the names of several with blanks between, with the way to the folder before.
fn led(name: &str, folder: &Path, way: &str) -> Option<String> {
    let is_there = |name: &str| !Path::new(name).is_absolute() && folder.join(name).is_file();
    if is_there(name) {
        return Some(format!("{way}{name}"));
    }
    let several: Vec<&str> = name.split_whitespace().collect();
    let are_there = !several.is_empty() && several.iter().all(|name| is_there(name));
    are_there.then(|| several.iter().map(|name| format!("{way}{name}")).collect::<Vec<_>>().join(" "))
}
