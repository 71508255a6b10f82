//! Damaged files: each error names the place, what was expected and what was found, and none makes room for
//! what the file does not hold.

use super::support::{cases, read, refused};
use limitmesh_io::Format;

#[track_caller]
fn refuses(format: Format, bytes: impl AsRef<[u8]>, message: &str) {
    assert_eq!(refused(bytes, format), message);
}

/// Refuses what `file` makes of the first column of a table with the message in the second.
#[track_caller]
fn refuses_all(format: Format, table: &str, file: impl Fn(&str) -> String) {
    for [text, message] in cases(table) {
        refuses(format, file(&text), &message);
    }
}

#[test]
fn obj() {
    let table = r"
        v 0 0\n | OBJ line 1, vertex 0: expected a finite number for z, found the end of the line
        v 0 0 0\nv 1 | OBJ line 2, vertex 1: expected a finite number for y, found the end of the file
        v 0 0 0\n\nv 1 x 2\n | OBJ line 3, vertex 1: expected a finite number for y, found 'x'
        v inf 0 0\n | OBJ line 1, vertex 0: expected a finite number for x, found 'inf'
        v 0 -NaN 0\n | OBJ line 1, vertex 0: expected a finite number for y, found '-NaN'
        v 0 0 1e999\n | OBJ line 1, vertex 0: expected a finite number for z, found '1e999'
        v 0 0,5 1\n | OBJ line 1, vertex 0: expected a finite number for y, found '0,5'
        v 0 0 0\nf 1 1 1\nf 1 3 2\nv 0 0 0\n | OBJ line 3: a face names vertex 3, but the last vertex is 2 (faces count from 1)
        v 0 0 0\nf 1 1 1\nf 1 1 \\n4294967295\n | OBJ line 4: a face names vertex 4294967295, but the last vertex is 1 (faces count from 1)
        # nothing\nf 1 2 3\n | OBJ line 3: expected at least one vertex (v X Y Z), found the end of the file";
    refuses_all(Format::Obj, table, str::to_owned);
    let form = "expected a vertex index from 1, or one from -1 to -1, counting back from the latest vertex";
    let integers = [
        "0",
        "-2",
        "99999999999999999999",
        "4294967296",
        "-9223372036854775808",
    ];
    for word in integers.iter().chain(&["x", "1.5", "/1"]) {
        let message = format!("OBJ line 2, face 0: {form}, found '{word}'");
        refuses(Format::Obj, format!("v 0 0 0\nf 1 {word} 1\n"), &message);
    }
}

#[test]
fn obj_tags() {
    let table = r"
        t crease 2/1/0 1 3 10 | OBJ line 5: a tag names vertex 3, but the last vertex is 2 (tags count from 0)
        t crease 2/1/0 1 -1 10 | OBJ line 5: expected a vertex index from 0 in a tag, found '-1'
        t crease 2/1/0 1 2 | OBJ line 5: expected a sharpness of at least 0, found the end of the line
        t corner 1/1/0 1 -2 | OBJ line 5: expected a sharpness of at least 0, found '-2'
        t corner 1/1/0 1 nan | OBJ line 5: expected a sharpness of at least 0, found 'nan'
        t corner x | OBJ line 5: expected the tag's counts, as in 2/1/0, found 'x'
        t corner 1 | OBJ line 5: expected the tag's counts, as in 2/1/0, found '1'
        t crease 3/1/0 0 1 2 10 | OBJ line 5: the tag has 3 vertices and 1 sharpnesses; each tagged place needs 2 of the former, and one of the latter for all or for each
        t crease 999999999999/1/0 0 1 2 10 | OBJ line 5: expected a vertex index from 0 in a tag, found the end of the line";
    let file = |tag: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n{tag}\n");
    refuses_all(Format::Obj, table, file);
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
    let table = r"
        ply\n | PLY line 2: expected end_header, found the end of the file
        plx\n | PLY line 1: expected the word ply alone on the first line, found 'plx'
        ply\nformat ascii 2.0\nend_header\n | PLY line 2: expected version 1.0, found '2.0'
        ply\nformat binary 1.0\n | PLY line 2: expected ascii, binary_little_endian or binary_big_endian, found 'binary'
        ply\nend_header\n | PLY line 2: the header names no format, such as ascii 1.0
        ply\nformat ascii 1.0\nend_header\n | PLY line 3: the header has no element vertex
        ply\nformat ascii 1.0\nelement vertex -1\n | PLY line 3: expected the number of elements, found '-1'
        ply\nformat ascii 1.0\nelement vertex 4294967296\n | PLY line 3: expected at most 4294967295 elements 'vertex', found 4294967296
        ply\nformat ascii 1.0\nproperty float x\n | PLY line 3: a property stands before the first element
        ply\nformat ascii 1.0\nelement vertex 0\nproperty half x\n | PLY line 4: expected a type: char, uchar, short, ushort, int, uint, float or double, or int8 to uint32, float32 or float64, found 'half'
        ply\nformat ascii 1.0\nelement vertex 0\nproperty list float int l\n | PLY line 4: expected an integer type for the length of a list, found 'float'
        ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float x\n | PLY line 5: the element has a second property 'x'
        ply\nformat ascii 1.0\nelement vertex 0\nelement vertex 0\n | PLY line 4: the header has a second element 'vertex'
        ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float z\nend_header\n | PLY line 3: element vertex has no number y
        ply\nformat ascii 1.0\nvertices 7\n | PLY line 3: expected format NAME 1.0, element NAME COUNT, property TYPE NAME, comment or end_header, found 'vertices 7'";
    refuses_all(Format::Ply, table, str::to_owned);
    let faces = r"
        property int vertex_index\n | PLY line 7: property vertex_index of element face is no list of integers
         | PLY line 7: element face has no list vertex_indices";
    refuses_all(Format::Ply, faces, |property| {
        let start = format!("ply\nformat ascii 1.0\nelement vertex 0\n{XYZ}element face 0\n");
        format!("{start}{property}end_header\n")
    });
}

#[test]
fn ply_text() {
    let header =
        format!("ply\nformat ascii 1.0\nelement vertex 3\n{XYZ}element face 2\n{FACE}end_header\n");
    let vertices = r"
        0 0 0\n1 0\n0 1 0\n | PLY line 11, vertex 1: expected a number, found the end of the line
        0 0 0\n1 0 0 5\n0 1 0\n | PLY line 11, vertex 1: expected the end of the line after the last property, found '5'
        0 0 0\n1 0 nan\n0 1 0\n | PLY line 11, vertex 1: expected a finite number for z, found NaN
        0 0 0\n1 0 0\n1 0 -\n | PLY line 12, vertex 2: expected a number, found '-'";
    refuses_all(Format::Ply, vertices, |body| format!("{header}{body}"));
    let faces = r"
        3 0 1 2\n | PLY line 14, face 1: expected an integer, found the end of the file
        3 0 1 2\n3 0 1 | PLY line 14, face 1: expected a number, found the end of the file
        3 0 1 2\n3 0 1 2.0\n | PLY line 14, face 1: expected an integer, found '2.0'
        3 0 1 2\n-3 0 1 2\n | PLY line 14, face 1: expected the length of a list, found -3
        3 0 1 3\n3 0 1 2\n | PLY line 13, face 0: expected a vertex index below 3 (the number of vertices), found 3
        3 0 1 -1\n3 0 1 2\n | PLY line 13, face 0: expected a vertex index below 3 (the number of vertices), found -1
        4000000000 0 1\n3 0 1 2\n | PLY line 13, face 0: expected a number, found the end of the line";
    refuses_all(Format::Ply, faces, |body| {
        format!("{header}0 0 0\n1 0 0\n0 1 0\n{body}")
    });
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
    let promise = "expected 3 elements vertex of 12 bytes each, as line 3 promises";
    let met = "found 20 bytes up to the end of the file";
    with(
        &[0.0; 5],
        &[],
        format!("PLY byte {begin}, vertex 1: {promise}, {met}"),
    );
    let not_finite = [0.0, 0.0, 0.0, 0.0, f32::NEG_INFINITY, 0.0, 0.0, 0.0, 0.0];
    let (place, expected) = (begin + 20, "expected a finite number for y, found -inf");
    with(
        &not_finite,
        &[],
        format!("PLY byte {place}, vertex 1: {expected}"),
    );
    let (faces, end) = (begin + 36, "found the end of the file");
    let (place, from) = (faces + 1, faces + 1);
    let message = format!("PLY byte {place}, face 0: expected 12 bytes from byte {from}, {end}");
    with(&[0.0; 9], &[3], message);
    let face = [3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0];
    let (place, from) = (faces + 23, faces + 14);
    let message = format!("PLY byte {place}, face 1: expected 12 bytes from byte {from}, {end}");
    with(&[0.0; 9], &[&face[..], &face[..10]].concat(), message);
    let mut beyond = [face, face].concat();
    (beyond[25], beyond[22]) = (0xff, 1);
    let (place, index) = (faces + 26, 0xff00_0001_u32.cast_signed());
    let expected = "expected a vertex index below 3 (the number of vertices)";
    with(
        &[0.0; 9],
        &beyond,
        format!("PLY byte {place}, face 1: {expected}, found {index}"),
    );
}

#[test]
fn stl_text() {
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    let whole = r"
        solid x\n | STL line 2: expected facet or endsolid, found the end of the file
        solid\nfacet\nouter\nloop\nvertex 0 0 0\nvertex 1 0 0 | STL line 6, facet 0: expected vertex, found the end of the file
        solid\n@ | STL line 9: expected facet or endsolid, found the end of the file
        solid\n@endsolid\nend | STL line 10: expected solid, found 'end'";
    refuses_all(Format::Stl, whole, |text| text.replace('@', facet));
    let replaced = r"
        1 0 0\nv | 1 0\nv | STL line 12, facet 1: expected a finite number for z, found the end of the line
        1 0 0\nv | 1 infinity 0\nv | STL line 12, facet 1: expected a finite number for y, found 'infinity'
        vertex 0 1 0\n |  | STL line 13, facet 1: expected vertex, found 'endloop'
        endloop | vertex 1 1 0\nendloop | STL line 14, facet 1: expected endloop, found 'vertex'
        outer loop\n |  | STL line 10, facet 1: expected outer loop, found 'vertex'
        endfacet\n |  | STL line 15, facet 1: expected endfacet, found 'endsolid'";
    for [from, to, message] in cases(replaced) {
        let changed = facet.replacen(&from, &to, 1);
        refuses(
            Format::Stl,
            format!("solid\n{facet}{changed}endsolid\n"),
            &message,
        );
    }
}

#[test]
fn stl_binary() {
    let binary = |count: u32, length: usize| {
        let mut bytes = vec![b'x'; 80];
        bytes.extend(count.to_le_bytes());
        bytes.resize(84 + length, 0);
        bytes
    };
    let mut broken = binary(2, 100);
    broken[84 + 50 + 12 + 8..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let messages = r"
        byte 13: expected 'solid', or the 84 bytes that begin a binary file, found the end of the file
        byte 233, facet 2: expected 3 facets of 50 bytes, as byte 80 promises, found the end of the file
        byte 184, facet 2: expected 4294967295 facets of 50 bytes, as byte 80 promises, found the end of the file
        byte 80: the file promises no facet, but 100 bytes follow
        byte 154, facet 1: expected a finite number, found NaN";
    let none = b"no such thing".to_vec();
    let files = [
        none,
        binary(3, 149),
        binary(u32::MAX, 100),
        binary(0, 100),
        broken,
    ];
    for (bytes, [message]) in files.iter().zip(cases(messages)) {
        refuses(Format::Stl, bytes, &format!("STL {message}"));
    }
}

#[test]
fn off() {
    let headers = r"
        OFX\n | OFF line 1: expected the keyword OFF, found 'OFX'
        OFF BINARY\n | OFF line 1: binary OFF files are not read
        4OFF\n1 1 0\n | OFF line 1: expected three coordinates a vertex (OFF, COFF, NOFF, STOFF), found '4OFF'
        nOFF\n3\n1 1 0\n | OFF line 1: expected three coordinates a vertex (OFF, COFF, NOFF, STOFF), found 'nOFF'
        OFF\n | OFF line 2: expected the number of vertices, found the end of the file
        OFF\nx 1 0\n | OFF line 2: expected the number of vertices, found 'x'
        OFF\n3 -1 0\n | OFF line 2: expected the number of faces, found '-1'
        OFF\n3\n | OFF line 2: expected the number of faces, found the end of the line
        OFF\n5000000000 1 0\n | OFF line 2: expected at most 4294967295 vertices, found 5000000000
        OFF\n3 1 0\n0 0 0\n1 0 0\n | OFF line 5, vertex 2: expected a finite number for x, found the end of the file";
    refuses_all(Format::Off, headers, str::to_owned);
    let vertices = r"
        0.0 0 0\n1 0 0\n1.25 0.25\n3 0 1 2\n | OFF line 5, vertex 2: expected a finite number for z, found the end of the line
        0.0 0 0\n1 0 0\n1.25 0.25 nan\n3 0 1 2\n | OFF line 5, vertex 2: expected a finite number for z, found 'nan'";
    refuses_all(Format::Off, vertices, |body| format!("OFF\n3 2 0\n{body}"));
    let faces = r"
        3 0 1 2\n | OFF line 7, face 1: expected the face's number of corners, found the end of the file
        3 0 1 2\n3 0 1\n | OFF line 7, face 1: expected 3 vertex indices, found the end of the line
        3 0 1 2\n3 0 1 | OFF line 7, face 1: expected 3 vertex indices, found the end of the file
        3 0 1 3\n3 0 1 2\n | OFF line 6, face 0: expected a vertex index below 3 (the number of vertices), found '3'
        3 0 1 -1\n3 0 1 2\n | OFF line 6, face 0: expected a vertex index below 3 (the number of vertices), found '-1'
        3 0 1 x\n3 0 1 2\n | OFF line 6, face 0: expected 3 vertex indices, found 'x'
        -3 0 1 x\n3 0 1 2\n | OFF line 6, face 0: expected the face's number of corners, found '-3'
        999999999999 0 1 2\n3 0 1 2\n | OFF line 6, face 0: expected 999999999999 vertex indices, found the end of the line";
    refuses_all(Format::Off, faces, |body| {
        format!("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n{body}")
    });
}

/// Headers that promise billions are refused at once: what they promise would take tens of gigabytes.
#[test]
fn counts_beyond_the_file() {
    let most = u32::MAX;
    let table = r"
        ascii | element vertex @\n^element face @\n~end_header\n0 0 0\n | PLY line 11, vertex 1: expected a number, found the end of the file
        binary_big_endian | element vertex @\n^element face @\n~end_header\n0 0 0\n | PLY byte 184, vertex 0: expected @ elements vertex of 12 bytes each, as line 3 promises, found 6 bytes up to the end of the file
        ascii | element vertex 1\n^element face @\n~end_header\n0 0 0\n1 0\n | PLY line 12, face 1: expected an integer, found the end of the file
        binary_big_endian | element x @\n~element vertex 0\n^end_header\n | PLY byte 172, x 0: expected 1 bytes from byte 172, found the end of the file";
    for [encoding, text, message] in cases(&table.replace('@', &most.to_string())) {
        let text = text.replace('^', XYZ).replace('~', FACE);
        refuses(
            Format::Ply,
            format!("ply\nformat {encoding} 1.0\n{text}"),
            &message,
        );
    }
    let message = "OFF line 4, vertex 1: expected a finite number for x, found the end of the file";
    refuses(
        Format::Off,
        format!("OFF\n{most} {most} 0\n0 0 0\n"),
        message,
    );
}

/// Elements without properties take no bytes, so that any number of them may stand in a header.
#[test]
fn billions_of_nothing() {
    for encoding in ["ascii", "binary_little_endian"] {
        let text = format!(
            "ply\nformat {encoding} 1.0\nelement x 4294967295\nelement vertex 0\n{XYZ}end_header\n"
        );
        assert!(read(text, Format::Ply).positions.is_empty());
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
    let message = |name: &str| {
        limitmesh_io::read(folder.path().join(name))
            .unwrap_err()
            .to_string()
    };
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
    let message = refused(text, Format::Obj);
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
        let error = limitmesh_io::read(&path).unwrap_err().to_string();
        assert!(
            error.contains("endless") && error.contains("it is a device"),
            "{error}"
        );
    }
}
