//! PLY files keep the types of what they hold, and the names of their pictures, through reading and writing.

use super::support::{self, channel, output, unwritten};
use limitmesh::mesh::PolygonSoup;
use limitmesh_io::Format;

/// One column of each type there is, at both ends of its range.
const TYPES: &str = "\
ply
format ascii 1.0
comment TextureFile my picture.png
comment TextureFile other.png
element vertex 3
property double x
property double y
property double z
property char a
property uchar b
property short c
property ushort d
property int e
property uint f
property float g
property double h
element face 1
property list uchar int vertex_indices
property short region
end_header
0 0 0 -128 0 -32768 0 -2147483648 0 -0.1 0.1
1 0 0 127 255 32767 65535 2147483647 4294967295 0.5 0.3
0 1 0 1 2 3 4 5 6 7 8
3 0 1 2 -7
";

fn read(bytes: &[u8]) -> PolygonSoup {
    support::read(bytes, Format::Ply)
}

fn written(soup: &PolygonSoup, ascii: bool) -> Vec<u8> {
    let own = output(&soup.positions, &[[0, 1, 2]]).channels(&soup.channels);
    support::written(Format::Ply, &own.texture_files(&soup.texture_files), ascii)
}

/// The text comes back to the byte but for the line that names the program; the binary form holds the same.
#[test]
fn types_and_pictures_are_kept() {
    let soup = read(TYPES.as_bytes());
    assert_eq!(soup.texture_files, ["my picture.png", "other.png"]);
    let text = String::from_utf8(written(&soup, true)).unwrap();
    assert_eq!(text.replace("comment written by limitmesh\n", ""), TYPES);
    let binary = written(&soup, false);
    // A vertex: three doubles, 1 + 1 + 2 + 2 + 4 + 4 + 4 + 8 bytes; the face: 1 + 12 + 2 bytes.
    let header = binary
        .windows(11)
        .position(|bytes| bytes == b"end_header\n")
        .unwrap();
    assert_eq!(binary.len() - header - 11, 3 * (24 + 26) + 15);
    assert_eq!(written(&read(&binary), true), text.as_bytes());
}

/// Numbers that are no longer whole, or too great for their type, are not cut.
#[test]
fn what_a_type_cannot_hold_is_written_as_a_double() {
    let mut soup = read(TYPES.as_bytes());
    let place = soup
        .channels
        .iter()
        .position(|channel| channel.name == "b")
        .unwrap();
    for value in [0.5, 256.0, -1.0] {
        soup.channels[place].values[1] = value;
        let text = String::from_utf8(written(&soup, true)).unwrap();
        for line in ["property double b\n", "property char a\n"] {
            assert!(text.contains(line), "{text}");
        }
        assert_eq!(read(text.as_bytes()).channels[place].values[1], value);
    }
}

/// Colours of 16 bits are 0 to 1, as those of 8 are.
#[test]
fn colours_of_two_bytes_are_kept() {
    let text = TYPES
        .replace("char a", "ushort red")
        .replace("uchar b", "ushort green");
    let text = text
        .replace("short c", "ushort blue")
        .replace("ushort d", "float d");
    let text = text.replace("-128 0 -32768 0", "0 7 65535 0");
    let text = text.replace("127 255 32767 65535", "127 255 32767 0");
    let soup = read(text.as_bytes());
    let colour = channel(&soup, "red,green,blue");
    assert_eq!(colour.values[..3], [0.0, 7.0 / 65535.0, 1.0]);
    let again = String::from_utf8(written(&soup, true)).unwrap();
    for line in ["property ushort green\n", "0 7 65535"] {
        assert!(again.contains(line), "{again}");
    }
}

/// A name with a line break would be a line of the header.
#[test]
fn names_of_pictures_with_line_breaks_are_refused() {
    let soup = read(TYPES.as_bytes());
    let names = ["a\nelement face 7".to_owned()];
    let own = output(&soup.positions, &[[0, 1, 2]]).texture_files(&names);
    assert!(unwritten(Format::Ply, &own).contains("line break"));
}
