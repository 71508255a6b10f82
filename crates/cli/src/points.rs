//! Points to project: the vertices of a mesh as its file has them, or three coordinates a line of text.

use std::path::Path;

use anyhow::{Context, bail};

use crate::arguments::BuildArguments;
use crate::format::counted;
use crate::input;
use crate::progress::Progress;

/// Points, and the triangles over them where there are any.
pub(crate) struct Points {
    /// As given on the command line.
    pub(crate) name: String,
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Extensions of text files.
const TEXT: [&str; 5] = ["xyz", "txt", "csv", "asc", "pts"];

/// Reads points.
///
/// # Errors
/// The file cannot be read, a line has no three numbers, or there are no points.
pub(crate) fn read(path: &Path, build: &BuildArguments, progress: &Progress) -> anyhow::Result<Points> {
    let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
    let is_text = extension.and_then(|extension| extension.into_string().ok());
    let is_standard_input = path.as_os_str() == "-" && build.from.is_none();
    let points = if is_standard_input || is_text.is_some_and(|extension| TEXT.contains(&&*extension)) {
        let name = if is_standard_input { "standard input".into() } else { path.display().to_string() };
        progress.stage(format!("reading {name}"));
        let text = if is_standard_input {
            std::io::read_to_string(std::io::stdin())
        } else {
            std::fs::read_to_string(path)
        };
        let positions = coordinates(&text.with_context(|| name.clone())?).with_context(|| name.clone())?;
        Points { name, positions, triangles: Vec::new() }
    } else {
        let input::Soup { name, soup, .. } = input::read(path, build, progress)?;
        let count = soup.positions.len();
        let triangle = |face: &[u32]| <[u32; 3]>::try_from(face).ok();
        let triangles: Vec<[u32; 3]> = soup
            .faces
            .iter()
            .filter_map(triangle)
            .filter(|corners| corners.iter().all(|&v| (v as usize) < count))
            .collect();
        if triangles.len() < soup.faces.len() {
            let left = counted(soup.faces.len() - triangles.len(), "face is", "faces are");
            progress.note(format!(
                "{name}: {left} no triangles over its points and left out; all points are projected"
            ));
        }
        Points { name, positions: soup.positions, triangles }
    };
    if let Some(index) = points.positions.iter().position(|at| !at.iter().all(|x| x.is_finite())) {
        bail!("{}: point {index} (from 0) is not finite", points.name);
    }
    if points.positions.is_empty() {
        bail!("{}: no points", points.name);
    }
    Ok(points)
}

/// Three numbers a line, between commas, semicolons or blanks; more are ignored, as is what follows `#`. A first line without numbers is a
/// heading.
fn coordinates(text: &str) -> anyhow::Result<Vec<[f64; 3]>> {
    let mut found = Vec::new();
    // Editors may mark a file as UTF-8.
    for (line, row) in text.trim_start_matches('\u{feff}').lines().zip(1..) {
        let line = line.split('#').next().unwrap_or("").trim();
        if line.is_empty() {
            continue;
        }
        let words = line.split(|c: char| c == ',' || c == ';' || c.is_whitespace());
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).take(3).collect();
        let numbers: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
        match <[f64; 3]>::try_from(numbers) {
            Ok(point) if point.iter().all(|x| x.is_finite()) => found.push(point),
            Err(numbers) if numbers.is_empty() && found.is_empty() && row == 1 => {}
            _ => bail!("line {row}: three coordinates are expected, not '{}'", words.join(" ")),
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::coordinates;

    #[test]
    fn lines_are_points() {
        let text = "\u{feff}x;y;z\n1;2;3\n\n# none\n 4, 5 , 6, 255\n-1e-3\t0 7 # last\n";
        let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [-1e-3, 0.0, 7.0]];
        assert_eq!(coordinates(text).expect("points"), expected);
    }

    #[test]
    fn lines_that_are_none_are_named() {
        for (text, row) in [("1 2\n", 1), ("1 2 3\nx y z\n", 2), ("1 2 nan\n", 1), ("x y z\nx y z\n", 2)] {
            let error = coordinates(text).expect_err("no point").to_string();
            assert!(error.starts_with(&format!("line {row}: ")), "{error}");
        }
    }
}
