//! Damaged files: each error names the place, what was expected and what was found, and none makes room for
//! what the file does not hold.

#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests fail as the tests do"
)]

use limitmesh_io::{Format, read, read_bytes};

#[track_caller]
fn refuses(format: Format, bytes: impl AsRef<[u8]>, message: &str) {
    match read_bytes(bytes.as_ref(), format) {
        Ok(soup) => panic!(
            "read {} vertices, {} faces",
            soup.positions.len(),
            soup.faces.len()
        ),
        Err(error) => assert_eq!(error.to_string(), message),
    }
}

#[test]
fn obj() {
    let refuses = |text: &str, message: &str| refuses(Format::Obj, text, message);
    refuses(
        "v 0 0\n",
        "OBJ line 1, vertex 0: expected a finite number for z, found the end of the line",
    );
    refuses(
        "v 0 0 0\nv 1",
        "OBJ line 2, vertex 1: expected a finite number for y, found the end of the file",
    );
    refuses(
        "v 0 0 0\n\nv 1 x 2\n",
        "OBJ line 3, vertex 1: expected a finite number for y, found 'x'",
    );
    refuses(
        "v inf 0 0\n",
        "OBJ line 1, vertex 0: expected a finite number for x, found 'inf'",
    );
    refuses(
        "v 0 -NaN 0\n",
        "OBJ line 1, vertex 0: expected a finite number for y, found '-NaN'",
    );
    refuses(
        "v 0 0 1e999\n",
        "OBJ line 1, vertex 0: expected a finite number for z, found '1e999'",
    );
    refuses(
        "v 0 0,5 1\n",
        "OBJ line 1, vertex 0: expected a finite number for y, found '0,5'",
    );
    let form = "expected a vertex index from 1, or one from -1 to -1, counting back from the latest vertex";
    for word in [
        "0",
        "-2",
        "x",
        "1.5",
        "/1",
        "99999999999999999999",
        "4294967296",
        "-9223372036854775808",
    ] {
        refuses(
            &format!("v 0 0 0\nf 1 {word} 1\n"),
            &format!("OBJ line 2, face 0: {form}, found '{word}'"),
        );
    }
    refuses(
        "v 0 0 0\nf 1 1 1\nf 1 3 2\nv 0 0 0\n",
        "OBJ line 3: a face names vertex 3, but the last vertex is 2 (faces count from 1)",
    );
    refuses(
        "v 0 0 0\nf 1 1 1\nf 1 1 \\\n4294967295\n",
        "OBJ line 4: a face names vertex 4294967295, but the last vertex is 1 (faces count from 1)",
    );
    refuses(
        "# nothing\nf 1 2 3\n",
        "OBJ line 3: expected at least one vertex (v X Y Z), found the end of the file",
    );
}

#[test]
fn obj_tags() {
    let refuses = |tag: &str, message: &str| {
        refuses(
            Format::Obj,
            format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n{tag}\n"),
            message,
        );
    };
    refuses(
        "t crease 2/1/0 1 3 10",
        "OBJ line 5: a tag names vertex 3, but the last vertex is 2 (tags count from 0)",
    );
    refuses(
        "t crease 2/1/0 1 -1 10",
        "OBJ line 5: expected a vertex index from 0 in a tag, found '-1'",
    );
    refuses(
        "t crease 2/1/0 1 2",
        "OBJ line 5: expected a sharpness of at least 0, found the end of the line",
    );
    refuses(
        "t corner 1/1/0 1 -2",
        "OBJ line 5: expected a sharpness of at least 0, found '-2'",
    );
    refuses(
        "t corner 1/1/0 1 nan",
        "OBJ line 5: expected a sharpness of at least 0, found 'nan'",
    );
    refuses(
        "t corner x",
        "OBJ line 5: expected the tag's counts, as in 2/1/0, found 'x'",
    );
    refuses(
        "t corner 1",
        "OBJ line 5: expected the tag's counts, as in 2/1/0, found '1'",
    );
    refuses(
        "t crease 3/1/0 0 1 2 10",
        "OBJ line 5: the tag has 3 vertices and 1 sharpnesses; each tagged place needs 2 of the former, \
         and one of the latter for all or for each",
    );
    refuses(
        "t crease 999999999999/1/0 0 1 2 10",
        "OBJ line 5: expected a vertex index from 0 in a tag, found the end of the line",
    );
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const FACE: &str = "property list uchar int vertex_indices\n";

/// So many that to compare each with all others would take minutes.
#[test]
fn ply_headers_of_hundreds_of_thousands_of_lines() {
    let lines = |line: &dyn Fn(usize) -> String| (0..200_000).map(line).collect::<String>();
    let properties = lines(&|i| format!("property float p{i}\n"));
    refuses(
        Format::Ply,
        format!("ply\nformat ascii 1.0\nelement vertex 1\n{properties}end_header\n"),
        "PLY line 1004: expected at most 1000 in an element, found one more property 'p1000'",
    );
    let elements = lines(&|i| format!("element e{i} 0\n"));
    refuses(
        Format::Ply,
        format!("ply\nformat ascii 1.0\n{elements}end_header\n"),
        "PLY line 1003: expected at most 1000 of them, found one more element 'e1000'",
    );
}

#[test]
fn ply_headers() {
    let refuses = |text: &str, message: &str| refuses(Format::Ply, text, message);
    refuses(
        "ply\n",
        "PLY line 2: expected end_header, found the end of the file",
    );
    refuses(
        "plx\n",
        "PLY line 1: expected the word ply alone on the first line, found 'plx'",
    );
    refuses(
        "ply\nformat ascii 2.0\nend_header\n",
        "PLY line 2: expected version 1.0, found '2.0'",
    );
    refuses(
        "ply\nformat binary 1.0\n",
        "PLY line 2: expected ascii, binary_little_endian or binary_big_endian, found 'binary'",
    );
    refuses(
        "ply\nend_header\n",
        "PLY line 2: the header names no format, such as ascii 1.0",
    );
    refuses(
        "ply\nformat ascii 1.0\nend_header\n",
        "PLY line 3: the header has no element vertex",
    );
    refuses(
        "ply\nformat ascii 1.0\nelement vertex -1\n",
        "PLY line 3: expected the number of elements, found '-1'",
    );
    refuses(
        "ply\nformat ascii 1.0\nelement vertex 4294967296\n",
        "PLY line 3: expected at most 4294967295 elements 'vertex', found 4294967296",
    );
    refuses(
        "ply\nformat ascii 1.0\nproperty float x\n",
        "PLY line 3: a property stands before the first element",
    );
    refuses(
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty half x\n",
        "PLY line 4: expected a type: char, uchar, short, ushort, int, uint, float or double, or int8 to \
         uint32, float32 or float64, found 'half'",
    );
    refuses(
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty list float int l\n",
        "PLY line 4: expected an integer type for the length of a list, found 'float'",
    );
    refuses(
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float x\n",
        "PLY line 5: the element has a second property 'x'",
    );
    refuses(
        "ply\nformat ascii 1.0\nelement vertex 0\nelement vertex 0\n",
        "PLY line 4: the header has a second element 'vertex'",
    );
    refuses(
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float z\nend_header\n",
        "PLY line 3: element vertex has no number y",
    );
    refuses(
        &format!(
            "ply\nformat ascii 1.0\nelement vertex 0\n{XYZ}element face 0\nproperty int vertex_index\nend_header\n"
        ),
        "PLY line 7: property vertex_index of element face is no list of integers",
    );
    refuses(
        &format!("ply\nformat ascii 1.0\nelement vertex 0\n{XYZ}element face 0\nend_header\n"),
        "PLY line 7: element face has no list vertex_indices",
    );
    refuses(
        "ply\nformat ascii 1.0\nvertices 7\n",
        "PLY line 3: expected format NAME 1.0, element NAME COUNT, property TYPE NAME, comment or \
         end_header, found 'vertices 7'",
    );
}

#[test]
fn ply_text() {
    let header =
        format!("ply\nformat ascii 1.0\nelement vertex 3\n{XYZ}element face 2\n{FACE}end_header\n");
    let refuses =
        |body: &str, message: &str| refuses(Format::Ply, format!("{header}{body}"), message);
    refuses(
        "0 0 0\n1 0\n0 1 0\n",
        "PLY line 11, vertex 1: expected a number, found the end of the line",
    );
    refuses(
        "0 0 0\n1 0 0 5\n0 1 0\n",
        "PLY line 11, vertex 1: expected the end of the line after the last property, found '5'",
    );
    refuses(
        "0 0 0\n1 0 nan\n0 1 0\n",
        "PLY line 11, vertex 1: expected a finite number for z, found NaN",
    );
    refuses(
        "0 0 0\n1 0 0\n1 0 -\n",
        "PLY line 12, vertex 2: expected a number, found '-'",
    );
    let vertices = "0 0 0\n1 0 0\n0 1 0\n";
    let with = |faces: &str, message: &str| refuses(&format!("{vertices}{faces}"), message);
    with(
        "3 0 1 2\n",
        "PLY line 14, face 1: expected an integer, found the end of the file",
    );
    with(
        "3 0 1 2\n3 0 1",
        "PLY line 14, face 1: expected a number, found the end of the file",
    );
    with(
        "3 0 1 2\n3 0 1 2.0\n",
        "PLY line 14, face 1: expected an integer, found '2.0'",
    );
    with(
        "3 0 1 2\n-3 0 1 2\n",
        "PLY line 14, face 1: expected the length of a list, found -3",
    );
    with(
        "3 0 1 3\n3 0 1 2\n",
        "PLY line 13, face 0: expected a vertex index below 3 (the number of vertices), found 3",
    );
    with(
        "3 0 1 -1\n3 0 1 2\n",
        "PLY line 13, face 0: expected a vertex index below 3 (the number of vertices), found -1",
    );
    with(
        "4000000000 0 1\n3 0 1 2\n",
        "PLY line 13, face 0: expected a number, found the end of the line",
    );
}

#[test]
fn ply_binary() {
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\n{XYZ}element face 2\n{FACE}end_header\n"
    );
    let begin = header.len();
    let with = |vertices: &[f32], faces: &[u8], message: String| {
        let mut bytes = header.clone().into_bytes();
        vertices.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend(faces);
        refuses(Format::Ply, bytes, &message);
    };
    let promise = "3 elements vertex of 12 bytes each, as line 3 promises";
    with(
        &[0.0; 5],
        &[],
        format!(
            "PLY byte {begin}, vertex 1: expected {promise}, found 20 bytes up to the end of the file"
        ),
    );
    let not_finite = [0.0, 0.0, 0.0, 0.0, f32::NEG_INFINITY, 0.0, 0.0, 0.0, 0.0];
    let after = begin + 20;
    with(
        &not_finite,
        &[],
        format!("PLY byte {after}, vertex 1: expected a finite number for y, found -inf"),
    );
    let faces = begin + 36;
    let (end, from) = (faces + 1, faces + 1);
    with(
        &[0.0; 9],
        &[3],
        format!(
            "PLY byte {end}, face 0: expected 12 bytes from byte {from}, found the end of the file"
        ),
    );
    let face = [3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0];
    let cut = [&face[..], &face[..10]].concat();
    let (end, from) = (faces + 23, faces + 14);
    with(
        &[0.0; 9],
        &cut,
        format!(
            "PLY byte {end}, face 1: expected 12 bytes from byte {from}, found the end of the file"
        ),
    );
    let mut beyond = [face, face].concat();
    beyond[25] = 0xff;
    beyond[22] = 1;
    let index = 0xff00_0001_u32.cast_signed();
    let place = faces + 26;
    with(
        &[0.0; 9],
        &beyond,
        format!(
            "PLY byte {place}, face 1: expected a vertex index below 3 (the number of vertices), found {index}"
        ),
    );
}

#[test]
fn stl_text() {
    let refuses = |text: &str, message: &str| refuses(Format::Stl, text, message);
    refuses(
        "solid x\n",
        "STL line 2: expected facet or endsolid, found the end of the file",
    );
    refuses(
        "solid\nfacet\nouter\nloop\nvertex 0 0 0\nvertex 1 0 0",
        "STL line 6, facet 0: expected vertex, found the end of the file",
    );
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    refuses(
        &format!("solid\n{facet}"),
        "STL line 9: expected facet or endsolid, found the end of the file",
    );
    refuses(
        &format!("solid\n{facet}endsolid\nend"),
        "STL line 10: expected solid, found 'end'",
    );
    let with = |from: &str, to: &str, message: &str| {
        refuses(
            &format!("solid\n{facet}{}endsolid\n", facet.replacen(from, to, 1)),
            message,
        );
    };
    with(
        "1 0 0\nv",
        "1 0\nv",
        "STL line 12, facet 1: expected a finite number for z, found the end of the line",
    );
    with(
        "1 0 0\nv",
        "1 infinity 0\nv",
        "STL line 12, facet 1: expected a finite number for y, found 'infinity'",
    );
    with(
        "vertex 0 1 0\n",
        "",
        "STL line 13, facet 1: expected vertex, found 'endloop'",
    );
    with(
        "endloop",
        "vertex 1 1 0\nendloop",
        "STL line 14, facet 1: expected endloop, found 'vertex'",
    );
    with(
        "outer loop\n",
        "",
        "STL line 10, facet 1: expected outer loop, found 'vertex'",
    );
    with(
        "endfacet\n",
        "",
        "STL line 15, facet 1: expected endfacet, found 'endsolid'",
    );
}

#[test]
fn stl_binary() {
    let binary = |count: u32, length: usize| {
        let mut bytes = vec![b'x'; 80];
        bytes.extend(count.to_le_bytes());
        bytes.resize(84 + length, 0);
        bytes
    };
    let refuses = |bytes: &[u8], message: &str| refuses(Format::Stl, bytes, message);
    refuses(
        b"no such thing",
        "STL byte 13: expected 'solid', or the 84 bytes that begin a binary file, found the end of the file",
    );
    refuses(
        &binary(3, 149),
        "STL byte 233, facet 2: expected 3 facets of 50 bytes, as byte 80 promises, found the end of the file",
    );
    refuses(
        &binary(u32::MAX, 100),
        "STL byte 184, facet 2: expected 4294967295 facets of 50 bytes, as byte 80 promises, found the end of the file",
    );
    refuses(
        &binary(0, 100),
        "STL byte 80: the file promises no facet, but 100 bytes follow",
    );
    let mut bytes = binary(2, 100);
    bytes[84 + 50 + 12 + 8..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    refuses(
        &bytes,
        "STL byte 154, facet 1: expected a finite number, found NaN",
    );
}

#[test]
fn off() {
    let refuses = |text: &str, message: &str| refuses(Format::Off, text, message);
    refuses("OFX\n", "OFF line 1: expected the keyword OFF, found 'OFX'");
    refuses("OFF BINARY\n", "OFF line 1: binary OFF files are not read");
    refuses(
        "4OFF\n1 1 0\n",
        "OFF line 1: expected three coordinates a vertex (OFF, COFF, NOFF, STOFF), found '4OFF'",
    );
    refuses(
        "nOFF\n3\n1 1 0\n",
        "OFF line 1: expected three coordinates a vertex (OFF, COFF, NOFF, STOFF), found 'nOFF'",
    );
    refuses(
        "OFF\n",
        "OFF line 2: expected the number of vertices, found the end of the file",
    );
    refuses(
        "OFF\nx 1 0\n",
        "OFF line 2: expected the number of vertices, found 'x'",
    );
    refuses(
        "OFF\n3 -1 0\n",
        "OFF line 2: expected the number of faces, found '-1'",
    );
    refuses(
        "OFF\n3\n",
        "OFF line 2: expected the number of faces, found the end of the line",
    );
    refuses(
        "OFF\n5000000000 1 0\n",
        "OFF line 2: expected at most 4294967295 vertices, found 5000000000",
    );
    refuses(
        "OFF\n3 1 0\n0 0 0\n1 0 0\n",
        "OFF line 5, vertex 2: expected a finite number for x, found the end of the file",
    );
    let with = |body: &str, message: &str| refuses(&format!("OFF\n3 2 0\n{body}"), message);
    with(
        "0.0 0 0\n1 0 0\n1.25 0.25\n3 0 1 2\n",
        "OFF line 5, vertex 2: expected a finite number for z, found the end of the line",
    );
    with(
        "0.0 0 0\n1 0 0\n1.25 0.25 nan\n3 0 1 2\n",
        "OFF line 5, vertex 2: expected a finite number for z, found 'nan'",
    );
    let with = |faces: &str, message: &str| with(&format!("0 0 0\n1 0 0\n0 1 0\n{faces}"), message);
    with(
        "3 0 1 2\n",
        "OFF line 7, face 1: expected the face's number of corners, found the end of the file",
    );
    with(
        "3 0 1 2\n3 0 1\n",
        "OFF line 7, face 1: expected 3 vertex indices, found the end of the line",
    );
    with(
        "3 0 1 2\n3 0 1",
        "OFF line 7, face 1: expected 3 vertex indices, found the end of the file",
    );
    with(
        "3 0 1 3\n3 0 1 2\n",
        "OFF line 6, face 0: expected a vertex index below 3 (the number of vertices), found '3'",
    );
    with(
        "3 0 1 -1\n3 0 1 2\n",
        "OFF line 6, face 0: expected a vertex index below 3 (the number of vertices), found '-1'",
    );
    with(
        "3 0 1 x\n3 0 1 2\n",
        "OFF line 6, face 0: expected 3 vertex indices, found 'x'",
    );
    with(
        "-3 0 1 x\n3 0 1 2\n",
        "OFF line 6, face 0: expected the face's number of corners, found '-3'",
    );
    with(
        "999999999999 0 1 2\n3 0 1 2\n",
        "OFF line 6, face 0: expected 999999999999 vertex indices, found the end of the line",
    );
}

/// Headers that promise billions are refused at once: what they promise would take tens of gigabytes.
#[test]
fn counts_beyond_the_file() {
    let ply = |encoding: &str| {
        format!(
            "ply\nformat {encoding} 1.0\nelement vertex 4294967295\n{XYZ}element face 4294967295\n{FACE}end_header\n0 0 0\n"
        )
    };
    let faces = format!(
        "ply\nformat ascii 1.0\nelement vertex 1\n{XYZ}element face 4294967295\n{FACE}end_header\n0 0 0\n1 0\n"
    );
    let skipped = format!(
        "ply\nformat binary_big_endian 1.0\nelement x 4294967295\n{FACE}element vertex 0\n{XYZ}end_header\n"
    );
    refuses(
        Format::Ply,
        ply("ascii"),
        "PLY line 11, vertex 1: expected a number, found the end of the file",
    );
    refuses(
        Format::Ply,
        ply("binary_big_endian"),
        "PLY byte 184, vertex 0: expected 4294967295 elements vertex of 12 \
         bytes each, as line 3 promises, found 6 bytes up to the end of the file",
    );
    refuses(
        Format::Ply,
        faces,
        "PLY line 12, face 1: expected an integer, found the end of the file",
    );
    refuses(
        Format::Ply,
        skipped,
        "PLY byte 172, x 0: expected 1 bytes from byte 172, found the end of the file",
    );
    refuses(
        Format::Off,
        "OFF\n4294967295 4294967295 0\n0 0 0\n",
        "OFF line 4, vertex 1: expected a finite number for x, found the end of the file",
    );
}

/// Elements without properties take no bytes, so that any number of them may stand in a header.
#[test]
fn billions_of_nothing() {
    for encoding in ["ascii", "binary_little_endian"] {
        let text = format!(
            "ply\nformat {encoding} 1.0\nelement x 4294967295\nelement vertex 0\n{XYZ}end_header\n"
        );
        assert!(
            read_bytes(text.as_bytes(), Format::Ply)
                .unwrap()
                .positions
                .is_empty()
        );
    }
}

#[test]
fn content_under_another_name() {
    let stl = {
        let mut bytes = b"v 0 0 0".to_vec();
        bytes.resize(84, 0);
        bytes
    };
    let files: [(&[u8], &str, Option<Format>); 13] = [
        (b"ply\nformat ascii 1.0\n", "a PLY file", Some(Format::Ply)),
        (b"OFF\n0 0 0\n", "an OFF file", Some(Format::Off)),
        (b"# c\n\nv 0 0 0\n", "an OBJ file", Some(Format::Obj)),
        (b"mtllib x.mtl\n", "an OBJ file", Some(Format::Obj)),
        (
            b"solid x\n facet normal 0 0 0\n",
            "an STL file",
            Some(Format::Stl),
        ),
        (&stl, "a binary STL file", Some(Format::Stl)),
        (b"glTF\x02\0\0\0", "a binary glTF file", None),
        (b"\x1f\x8b\x08", "gzip data", None),
        (b"PK\x03\x04", "a ZIP archive", Some(Format::ThreeMf)),
        (b"{\"asset\":{}}", "JSON, as glTF is", None),
        (b"<?xml version=\"1.0\"?>", "XML or HTML", None),
        (
            b"version https://git-lfs.github.com/spec/v1\n",
            "a Git LFS pointer, not the file itself",
            None,
        ),
        (b"\xff\xfev\0 \x000\0", "UTF-16 text", None),
    ];
    for (bytes, words, format) in files {
        let is_own =
            |named: Format| Some(named) == format || named.is_gltf() && words.contains("glTF");
        for named in Format::ALL.iter().copied().filter(|&named| !is_own(named)) {
            refuses(
                named,
                bytes,
                &format!("named as {named}, but the content looks like {words}"),
            );
        }
    }
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str| read(folder.path().join(name)).unwrap_err().to_string();
    std::fs::create_dir(folder.path().join("folder.obj")).unwrap();
    std::fs::write(folder.path().join("empty.ply"), b"").unwrap();
    std::fs::write(folder.path().join("ply.obj"), b"ply\n").unwrap();
    std::fs::write(folder.path().join("bad.off"), b"OFF\n1 x 0\n").unwrap();
    let at = |rest: &str| format!("{}/{rest}", folder.path().display());
    assert!(message("missing.obj").starts_with(&format!("cannot read {}: ", at("missing.obj"))));
    assert!(message("folder.obj").starts_with(&format!("cannot read {}: ", at("folder.obj"))));
    assert_eq!(message("empty.ply"), at("empty.ply: the file is empty"));
    assert_eq!(
        message("ply.obj"),
        at("ply.obj: named as OBJ, but the content looks like a PLY file")
    );
    assert_eq!(
        message("bad.off"),
        at("bad.off: OFF line 2: expected the number of faces, found 'x'")
    );
    assert_eq!(
        message("mesh.fbx"),
        at(
            "mesh.fbx: the extension 'fbx' is unknown; known are .obj, .ply, .stl, .off, .gltf, .glb and .3mf"
        )
    );
}

#[test]
fn long_and_unprintable_words_are_shortened() {
    let text = format!("v 0 0 \u{7}\u{e9}{}\n", "y".repeat(1000));
    let message = read_bytes(text.as_bytes(), Format::Obj)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("found '\\u{7}é") || message.contains("found 'é"),
        "{message}"
    );
    assert!(message.len() < 150, "{message}");
}

#[cfg(unix)]
#[test]
fn devices_that_never_end_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for format in Format::ALL {
        let path = folder
            .path()
            .join("endless")
            .with_extension(format.extension());
        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(
            error.contains("endless") && error.contains("it is a device"),
            "{error}"
        );
    }
}
