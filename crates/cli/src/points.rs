//! Points to project: the vertices of a mesh as its file has them, or three coordinates a line of text.

use std::path::Path;

use anyhow::{Context, bail};

use crate::arguments::{BuildArguments, Unit};
use crate::format::counted;
use crate::input;
use crate::progress::Progress;
use crate::rows::rows;

/// Points, and the triangles over them where there are any.
pub(crate) struct Points {
    /// As given on the command line.
    pub(crate) name: String,
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Their unit, where that is known.
    unit: Option<Unit>,
}

impl Points {
    /// Them measured in another unit, where both are known.
    pub(crate) fn in_unit(mut self, other: Option<Unit>, progress: &Progress) -> Self {
        if let Some(factor) = input::factor(self.unit, other, &self.name, progress) {
            self.positions
                .iter_mut()
                .flatten()
                .for_each(|x| *x *= factor);
            self.unit = other;
        }
        self
    }
}

/// Extensions of text files.
const TEXT: [&str; 5] = ["xyz", "txt", "csv", "asc", "pts"];

/// Of these, the one whose first line may be the number of points.
const COUNTED: &str = "pts";

/// Reads points.
///
/// # Errors
/// The file cannot be read, a line has no three numbers, or there are no points.
pub(crate) fn read(
    path: &Path,
    build: &BuildArguments,
    progress: &Progress,
) -> anyhow::Result<Points> {
    let extension = path
        .extension()
        .map(|extension| extension.to_ascii_lowercase());
    let is_text = extension.and_then(|extension| extension.into_string().ok());
    let is_standard_input = path.as_os_str() == "-" && build.from.is_none();
    let points = if is_standard_input
        || is_text
            .as_ref()
            .is_some_and(|extension| TEXT.contains(&&**extension))
    {
        let name = if is_standard_input {
            "standard input".into()
        } else {
            path.display().to_string()
        };
        progress.stage(format!("reading {name}"));
        let text = if is_standard_input {
            std::io::read_to_string(std::io::stdin())
        } else {
            std::fs::read_to_string(path)
        };
        let text = text.with_context(|| name.clone())?;
        let has_count = is_text.is_some_and(|extension| extension == COUNTED);
        let positions = coordinates(&text, has_count).with_context(|| name.clone())?;
        Points {
            name,
            positions,
            triangles: Vec::new(),
            unit: build.unit,
        }
    } else {
        let input::Soup {
            name, soup, unit, ..
        } = input::read(path, build, progress)?;
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
        Points {
            name,
            positions: soup.positions,
            triangles,
            unit,
        }
    };
    if let Some(index) = points
        .positions
        .iter()
        .position(|at| !at.iter().all(|x| x.is_finite()))
    {
        bail!("{}: point {index} (from 0) is not finite", points.name);
    }
    if points.positions.is_empty() {
        bail!("{}: no points", points.name);
    }
    Ok(points)
}

/// Three numbers a line, between semicolons, or else between commas or blanks, each between quotes or without; more are ignored, as is
/// what follows `#`. A first line without numbers is a heading; where a count may begin, one whole number is.
fn coordinates(text: &str, has_count: bool) -> anyhow::Result<Vec<[f64; 3]>> {
    let mut found = Vec::new();
    let mut count = None;
    for (row, line) in rows(text) {
        if has_count
            && row == 1
            && let Ok(points) = line.parse::<usize>()
        {
            count = Some(points);
            continue;
        }
        let words: Vec<&str> = words(line).take(3).collect();
        let numbers: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
        match <[f64; 3]>::try_from(numbers) {
            Ok(_) if may_have_decimal_commas(line) => {
                bail!(
                    "line {row}: commas in '{line}' may be decimal ones; write three numbers with decimal points"
                )
            }
            Ok(point) if point.iter().all(|x| x.is_finite()) => found.push(point),
            Err(_) if row == 1 && !words.iter().any(|word| is_like_number(word)) => {}
            _ => bail!(
                "line {row}: expected three coordinates, found '{}'",
                words.join(" ")
            ),
        }
    }
    if let Some(count) = count.filter(|&count| count != found.len()) {
        bail!(
            "line 1 promises {count} points, but there are {}",
            found.len()
        );
    }
    Ok(found)
}

/// The fields of a line between separators. Where there are semicolons a comma is none: it may be a decimal one, which is no number here.
fn words(line: &str) -> impl Iterator<Item = &str> {
    let separator = if line.contains(';') { ';' } else { ',' };
    let mut is_quoted = false;
    let fields = line.split(move |c: char| {
        is_quoted ^= c == '"';
        c == separator && !is_quoted
    });
    fields.flat_map(move |field| {
        let field = field.trim();
        let quoted = field
            .strip_prefix('"')
            .and_then(|rest| rest.strip_suffix('"'))
            .map(str::trim);
        let is_whole = quoted.is_some() || separator == ';' || field.is_empty();
        let whole = is_whole.then_some(quoted.unwrap_or(field));
        whole
            .into_iter()
            .chain(field.split_whitespace().filter(move |_| !is_whole))
    })
}

/// Whether both blanks and commas without a blank next to them stand between the first three numbers of a line: `1,5 2,5 3,5`.
fn may_have_decimal_commas(line: &str) -> bool {
    if !line.contains(',') || line.contains([';', '"']) {
        return false;
    }
    let parts = line.split_whitespace();
    let are_apart = parts
        .clone()
        .any(|part| part.starts_with(',') || part.ends_with(','));
    let has_all = parts
        .clone()
        .next()
        .is_some_and(|first| first.split(',').count() >= 3);
    !are_apart && !has_all && parts.take(3).any(|part| part.contains(','))
}

/// Whether a word is a number, or some, or would be with decimal points or without quotes: it is not of a heading.
fn is_like_number(word: &str) -> bool {
    let plain = word.replace(',', ".").replace('"', "");
    !plain.is_empty()
        && plain
            .split_whitespace()
            .all(|part| part.parse::<f64>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::coordinates;

    #[test]
    fn lines_are_points() {
        let text = "\u{feff}x;y;z\n1;2;3\n\n# none\n 4, 5 , 6, 255\n-1e-3\t0 7 # last\n1, 2 3\n";
        let expected = [
            [1.0, 2.0, 3.0],
            [4.0, 5.0, 6.0],
            [-1e-3, 0.0, 7.0],
            [1.0, 2.0, 3.0],
        ];
        assert_eq!(coordinates(text, false).expect("points"), expected);
        // Commas that can be nothing else, and what comes after the coordinates.
        let expected = [[1.0, 2.0, 3.0]; 4];
        let text = "1,2,3 0,5\n1 2 3 0,5\n1 ,2,3\n1,2, 3\n";
        assert_eq!(coordinates(text, false).expect("points"), expected);
    }

    #[test]
    fn quoted_fields_are_read() {
        let expected = [[1.0, 2.5, -3.0]];
        for text in [
            "\"1\",\"2.5\",\"-3\"\n",
            "\"x, to the left\",y,z\n\"1\", 2.5 ,\"-3\",\"far\"\n",
            "\"x;1\";\"y\";\"z\"\n\" 1 \";2.5;-3\n",
        ] {
            assert_eq!(coordinates(text, false).expect(text), expected, "{text}");
        }
    }

    /// Decimal commas, missing fields and broken quotes are no separators, and no heading.
    #[test]
    fn lines_that_are_none_are_named() {
        for (text, row) in [
            ("1 2\n", 1),
            ("1 2 3\nx y z\n", 2),
            ("1 2 nan\n", 1),
            ("x y z\nx y z\n", 2),
            ("1,5;2,5;3,5\n", 1),
            ("x;y;z\n1,5;2,5;3,5\n", 2),
            ("1;2;3\n1,5;2;3\n", 2),
            ("1 2;3;4\n", 1),
            ("1;;3;4\n", 1),
            ("1,,3,4\n", 1),
            ("\"1,5\",\"2,5\",\"3,5\"\n", 1),
            ("1 2 3\n\"1,2,3\n", 2),
            ("3\n1 2 3\n", 1),
            ("1 2 3;\n4;5;6\n", 1),
            ("1,5 2,5 3,5\n", 1),
            ("x y z\n1,5\t2,5\t3,5\n", 2),
        ] {
            let error = coordinates(text, false).expect_err(text).to_string();
            assert!(
                error.starts_with(&format!("line {row}: ")),
                "{text}: {error}"
            );
        }
    }

    #[test]
    fn a_count_may_stand_first() {
        let points = "1 2 3 -1200 90 80 70\n4 5 6 -1100 1 2 3\n";
        let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        for text in [format!("2\n{points}"), points.to_owned()] {
            assert_eq!(coordinates(&text, true).expect("points"), expected);
        }
        let error = coordinates(&format!("3\n{points}"), true)
            .expect_err("too few")
            .to_string();
        assert_eq!(error, "line 1 promises 3 points, but there are 2");
        let error = coordinates(&format!("{points}2\n"), true)
            .expect_err("another count")
            .to_string();
        assert!(error.starts_with("line 3: "), "{error}");
    }
}
