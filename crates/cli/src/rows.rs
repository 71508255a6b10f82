//! Text files with a value a line: cameras, places, points.

/// The lines of a text by their numbers, without comments after `#` and without blank lines.
pub(crate) fn rows(text: &str) -> impl Iterator<Item = (usize, &str)> {
    // Editors may mark a file as UTF-8.
    let lines = text.trim_start_matches('\u{feff}').lines();
    let plain = lines.map(|line| line.split_once('#').map_or(line, |(own, _)| own).trim());
    (1..).zip(plain).filter(|(_, line)| !line.is_empty())
}
