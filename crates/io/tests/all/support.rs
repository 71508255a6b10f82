//! Common parts of the tests of all formats: files read and written in memory, tables of cases, and the folder of shared models.

use limitmesh::Triangles;
use limitmesh::mesh::{Channel, PolygonSoup};
use limitmesh_io::{Format, Output, WriteError, WriteOptions, read_bytes, write_to};
use std::path::PathBuf;

#[track_caller]
pub(crate) fn read(bytes: impl AsRef<[u8]>, format: Format) -> PolygonSoup {
    let text = || String::from_utf8_lossy(bytes.as_ref());
    read_bytes(bytes.as_ref(), format).unwrap_or_else(|error| panic!("{error}\n{}", text()))
}

/// Why bytes are not read.
#[track_caller]
pub(crate) fn refused(bytes: impl AsRef<[u8]>, format: Format) -> String {
    let soup = read_bytes(bytes.as_ref(), format);
    soup.expect_err("a file that is not read").to_string()
}

pub(crate) fn try_written(
    format: Format,
    output: &Output<'_>,
    ascii: bool,
) -> Result<Vec<u8>, WriteError> {
    let mut bytes = Vec::new();
    let written = write_to(
        &mut bytes,
        format,
        output,
        &WriteOptions::default().ascii(ascii),
    );
    if written
        .as_ref()
        .is_err_and(|error| !matches!(error, WriteError::Writer { .. }))
    {
        assert!(bytes.is_empty(), "something was written before the check");
    }
    written.map(|()| bytes)
}

#[track_caller]
pub(crate) fn written(format: Format, output: &Output<'_>, ascii: bool) -> Vec<u8> {
    try_written(format, output, ascii).unwrap()
}

/// An output as text.
#[track_caller]
pub(crate) fn text(format: Format, output: &Output<'_>) -> String {
    String::from_utf8(written(format, output, true)).unwrap()
}

/// Why an output is not written.
#[track_caller]
pub(crate) fn unwritten(format: Format, output: &Output<'_>) -> String {
    let written = try_written(format, output, false);
    written
        .expect_err("an output that does not fit")
        .to_string()
}

pub(crate) fn triangles(soup: &PolygonSoup) -> Vec<[u32; 3]> {
    soup.faces
        .iter()
        .map(|face| face.try_into().unwrap())
        .collect()
}

pub(crate) fn output<'a>(positions: &'a [[f64; 3]], triangles: &'a [[u32; 3]]) -> Output<'a> {
    Output::new(Triangles {
        positions,
        triangles,
    })
}

#[track_caller]
pub(crate) fn channel<'a>(soup: &'a PolygonSoup, name: &str) -> &'a Channel {
    soup.channels
        .iter()
        .find(|own| own.name == name)
        .expect(name)
}

/// By element, its value.
pub(crate) fn values(channel: &Channel) -> Vec<&[f64]> {
    (0..channel.indices.len())
        .map(|element| channel.value(element))
        .collect()
}

/// By element, its label.
pub(crate) fn labels(channel: &Channel) -> Vec<&str> {
    channel
        .indices
        .iter()
        .map(|&number| &channel.labels[number as usize][..])
        .collect()
}

/// The cases of a table, a line each: its columns stand between ` | `, and `\n` is the end of a line.
pub(crate) fn cases<const N: usize>(table: &str) -> Vec<[String; N]> {
    let lines = table.lines().filter(|line| !line.trim().is_empty());
    let columns = |line: &str| -> Vec<String> {
        line.split(" | ")
            .map(|own| own.trim_start().replace("\\n", "\n"))
            .collect()
    };
    lines
        .map(|line| columns(line).try_into().unwrap())
        .collect()
}

/// A file or folder of the shared models; says that a test is skipped where they are not there.
pub(crate) fn shared(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("LIMITMESH_MODELS").map(PathBuf::from);
    let found = folder
        .map(|folder| folder.join(name))
        .filter(|path| path.exists());
    if found.is_none() {
        skip("LIMITMESH_MODELS is not set, or lacks a file");
    }
    found
}

/// Says why a test is skipped: directly, since the test harness keeps what macros print to itself.
pub(crate) fn skip(why: &str) {
    let line = format!("skipped: {why}\n");
    std::io::Write::write_all(&mut std::io::stderr(), line.as_bytes()).unwrap();
}
