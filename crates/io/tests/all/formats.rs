//! What each reader understands, on small files written out here.

#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests fail as the tests do"
)]

use limitmesh::Triangles;
use limitmesh::mesh::{Channel, CornerTag, CreaseTag, Domain, PolygonSoup};
use limitmesh_io::{Format, Output, WriteOptions, read_bytes, write_to};

fn obj(text: &str) -> PolygonSoup {
    read_bytes(text.as_bytes(), Format::Obj).unwrap_or_else(|error| panic!("{error}"))
}

fn polygons(soup: &PolygonSoup) -> Vec<&[u32]> {
    soup.faces.iter().collect()
}

const SQUARE: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
];
const OBJ_SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn obj_corners_in_every_form() {
    for face in [
        "f 1 2 3 4",
        "f 1/1 2/2 3/3 4/4",
        "f 1//9 2//9 3//9 4//9",
        "f 1/1/1 2/2/2 3/3/3 4/4/4",
    ] {
        let soup = obj(&format!("{OBJ_SQUARE}{face}\n"));
        assert_eq!(soup.positions, SQUARE, "{face}");
        assert_eq!(polygons(&soup), [&[0, 1, 2, 3]], "{face}");
    }
}

#[test]
fn obj_relative_indices_count_back_from_their_own_line() {
    let soup = obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4/-1 -2 -1//-7\n");
    assert_eq!(polygons(&soup), [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn obj_faces_may_come_before_their_vertices() {
    let soup = obj(&format!("f 1 2 3\nf 1 3 4\n{OBJ_SQUARE}"));
    assert_eq!(soup.positions, SQUARE);
    assert_eq!(polygons(&soup), [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn obj_lines_comments_and_continuations() {
    let text = "\u{feff}# comment \\\r\n\r\n  v\t0 0 0 # here \\\r\nv 1 \\\r\n 0 0 0.5\r\n\
                v 1 1\\\r\n 0 0.1 0.2 0.3\r\nv 0 1 0\r\ng a b\r\ns off\r\nusemtl x#y\r\nf 1 2 \\\r\n3 4#5\\\n";
    // The last corner is `4#5`: no comment, as no blank stands before it.
    let error = read_bytes(text.as_bytes(), Format::Obj)
        .unwrap_err()
        .to_string();
    assert!(error.contains("line 13, face 0: expected"), "{error}");
    let soup = obj(&text.replace("4#5\\\n", "4 #5\\\n"));
    assert_eq!(soup.positions, SQUARE);
    assert_eq!(polygons(&soup), [&[0, 1, 2, 3]]);
    // The same with lines that end with CR alone, as on machines of long ago.
    assert_eq!(
        obj(&text.replace("4#5\\\n", "4").replace("\r\n", "\r")),
        soup
    );
}

#[test]
fn obj_names_in_any_encoding() {
    let mut bytes = b"# caf\xe9 \xff\xfe\no \xe9\n".to_vec();
    bytes.extend_from_slice(OBJ_SQUARE.as_bytes());
    bytes.extend_from_slice(b"g \x80\x81\nf 1 2 3\n");
    assert_eq!(read_bytes(&bytes, Format::Obj).unwrap().faces.len(), 1);
}

#[test]
fn obj_tags() {
    let tags = "t crease 2/1/0 0 1 2.5\nt crease 4/2/0 1 2 2 3 1 10\nt crease 4/1/0 0 2 1 3 inf\n\
                t corner 1/1/0 3 10\nt corner 2/1/0 0 1 4.5\nt interpolateboundary 1/0/0 2\nt\nt smooth\n";
    let soup = obj(&format!("{tags}{OBJ_SQUARE}f 1 2 3 4\n"));
    let crease = |a, b, sharpness| CreaseTag {
        vertices: [a, b],
        sharpness,
    };
    let corner = |vertex, sharpness| CornerTag { vertex, sharpness };
    assert_eq!(
        soup.creases,
        [
            crease(0, 1, 2.5),
            crease(1, 2, 1.0),
            crease(2, 3, 10.0),
            crease(0, 2, f64::INFINITY),
            crease(1, 3, f64::INFINITY)
        ]
    );
    assert_eq!(
        soup.corners,
        [corner(3, 10.0), corner(0, 4.5), corner(1, 4.5)]
    );
}

#[test]
fn numbers_keep_every_bit() {
    let soup = obj(
        "v 0.1 1e-320 -0\nv 1.7976931348623157e308 123456789.123456789 +3.\nv .5 -2E+3 4.9e-324\nf 1 2 3\n",
    );
    let expected = [
        [0.1, 1e-320, -0.0],
        [f64::MAX, 123_456_789.123_456_79, 3.0],
        [0.5, -2000.0, f64::from_bits(1)],
    ];
    for (met, expected) in soup
        .positions
        .as_flattened()
        .iter()
        .zip(expected.as_flattened())
    {
        assert_eq!(met.to_bits(), expected.to_bits());
    }
}

fn ply(header: &str, body: &[u8]) -> PolygonSoup {
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend_from_slice(body);
    read_bytes(&bytes, Format::Ply).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn ply_text_with_extra_elements_and_properties() {
    let text = "ply\nformat ascii 1.0\ncomment é\nobj_info x\nelement camera 2\nproperty float f\n\
                property list uchar short l\nelement vertex 4\nproperty uchar red\nproperty float64 x\n\
                property list int float uv\nproperty float y\nproperty int8 z\nelement face 2\n\
                property float32 q\nproperty list uint8 int32 vertex_index\nproperty uchar flag\n\
                element edge 1\nproperty int a\nend_header\n";
    let body = "1.5 2 7 8\n2.5 0\n255 0 2 .1 .2 0 0\n\n 0 1 0 0 0\n0 1 1 9 1 0\n7 0 0 1 0\n\
                0.5 3 0 1 2 1\n0.5 4 0 1 2 3 1\n0\nanything after the last element\n";
    let mut soup = ply(text, body.as_bytes());
    assert_eq!(
        soup.left_out.last().map(String::as_str),
        Some("32 bytes after the last element")
    );
    soup.left_out.pop();
    assert_eq!(soup.positions, SQUARE);
    assert_eq!(polygons(&soup), [&[0, 1, 2][..], &[0, 1, 2, 3]]);
    // Lines that end with CR LF, or CR alone.
    for end in ["\r\n", "\r"] {
        let mut same = ply(&text.replace('\n', end), body.replace('\n', end).as_bytes());
        same.left_out.pop();
        assert_eq!(same, soup);
    }
}

/// Every type of both byte orders, in all three places: coordinate, list length, index.
#[test]
fn ply_binary_with_every_type() {
    let integers = ["char", "uchar", "short", "ushort", "int", "uint"];
    let names = [
        integers.as_slice(),
        &["int8", "uint8", "int16", "uint16", "int32", "uint32"],
    ]
    .concat();
    for big in [false, true] {
        for name in names
            .iter()
            .chain(&["float", "double", "float32", "float64"])
        {
            let list = if name.contains("float") || *name == "double" {
                "uchar"
            } else {
                name
            };
            let header = format!(
                "ply\nformat binary_{}_endian 1.0\nelement other 2\nproperty list {list} {name} skipped\n\
                 element face 1\nproperty {name} q\nproperty list {list} {list} vertex_indices\n\
                 element vertex 4\nproperty double w\nproperty {name} x\nproperty {name} y\nproperty {name} z\n\
                 end_header\n",
                if big { "big" } else { "little" }
            );
            let mut body = Vec::new();
            let mut put = |kind: &str, value: i32| {
                let little = match kind {
                    "char" | "int8" => (value as i8).to_le_bytes().to_vec(),
                    "uchar" | "uint8" => (value as u8).to_le_bytes().to_vec(),
                    "short" | "int16" => (value as i16).to_le_bytes().to_vec(),
                    "ushort" | "uint16" => (value as u16).to_le_bytes().to_vec(),
                    "int" | "int32" => value.to_le_bytes().to_vec(),
                    "uint" | "uint32" => (value as u32).to_le_bytes().to_vec(),
                    "float" | "float32" => (value as f32).to_le_bytes().to_vec(),
                    _ => f64::from(value).to_le_bytes().to_vec(),
                };
                if big {
                    body.extend(little.iter().rev())
                } else {
                    body.extend(little)
                }
            };
            put(list, 2);
            put(name, 5);
            put(name, 6);
            put(list, 0);
            put(name, 9);
            put(list, 4);
            (0..4).for_each(|i| put(list, i));
            for point in SQUARE {
                put("double", 77);
                point.iter().for_each(|&x| put(name, 100 * x as i32 + 3));
            }
            let soup = ply(&header, &body);
            assert_eq!(polygons(&soup), [&[0, 1, 2, 3]], "{header}");
            let expected = SQUARE.map(|p| p.map(|x| 100.0 * x + 3.0));
            assert_eq!(soup.positions, expected, "{header}");
        }
    }
}

/// After a header with CR LF the body begins with the next byte, even if that is a line end's.
#[test]
fn ply_binary_body_may_begin_with_any_byte() {
    for end in ["\n", "\r\n", "\r"] {
        let header = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\n\
                      property uchar z\nend_header\n";
        let soup = ply(&header.replace('\n', end), b"\n\r\n");
        assert_eq!(soup.positions, [[10.0, 13.0, 10.0]]);
    }
}

#[test]
fn ply_strips_turn_every_other_triangle() {
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                  element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    let soup = ply(
        header,
        b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n9 0 1 2 3 -1 3 2 1 -1\n",
    );
    assert_eq!(polygons(&soup), [[0, 1, 2], [2, 1, 3], [3, 2, 1]]);
}

const ASCII_STL: &str = "solid one two
  FACET normal nan nan nan
    Outer Loop
      vertex 0 0 0
      vertex 1 0 0\tvertex 0 1.5e0 0
    endloop
  endfacet
EndSolid one
solid
endsolid
solid facet
 facet normal 0 0 1 outer loop vertex 0 0 1
 vertex 1 0 1
 vertex 0 1 1 endloop endfacet
endsolid facet normal";

#[test]
fn stl_text_with_several_solids() {
    for text in [
        ASCII_STL.to_owned(),
        ASCII_STL.replace('\n', "\r\n"),
        format!("\u{feff}\n {ASCII_STL}\n\n"),
    ] {
        let soup =
            read_bytes(text.as_bytes(), Format::Stl).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(polygons(&soup), [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(soup.positions[2], [0.0, 1.5, 0.0]);
        assert_eq!(soup.positions[3], [0.0, 0.0, 1.0]);
    }
}

/// A binary file of `facets` facets whose first 80 bytes begin with `start`.
fn binary_stl(start: &[u8], facets: u32) -> Vec<u8> {
    let mut bytes = start.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(facets.to_le_bytes());
    for facet in 0..facets {
        let values = [0, 0, 1, 0, 0, facet, 1, 0, facet, 0, 1, facet];
        values
            .iter()
            .for_each(|&v| bytes.extend((v as f32).to_le_bytes()));
        bytes.extend([7, 7]);
    }
    bytes
}

#[test]
fn stl_binary_that_begins_with_solid() {
    let starts: [&[u8]; 4] = [
        b"",
        b"solid",
        b"solid x\nfacet normal 0 0 1\nouter loop",
        b"v 1 2 3\nply\nOFF",
    ];
    for start in starts {
        let bytes = binary_stl(start, 3);
        let soup = read_bytes(&bytes, Format::Stl).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(polygons(&soup), [[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
        assert_eq!(soup.positions[8], [0.0, 1.0, 2.0]);
    }
}

#[test]
fn stl_binary_with_bytes_after_the_last_facet() {
    let mut bytes = binary_stl(b"solid by some program", 2);
    bytes.extend(b"trailer");
    assert_eq!(read_bytes(&bytes, Format::Stl).unwrap().faces.len(), 2);
}

#[test]
fn off_in_many_dresses() {
    let square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    let with = |extra: &str| square.replace("0\n", &format!("0 {extra}\n"));
    let files = [
        format!("OFF\n4 2 5\n{square}3 0 1 2\n4 0 1 2 3\n"),
        format!("OFF 4 2 5\n{square}3 0 1 2\n4 0 1 2 3"),
        format!(
            "OFF # keyword\n# counts\n\n4 2 # no edges\n\n{square}# faces\n3 0 1 2 # one\n\n4 0 1 2 3\n"
        ),
        format!("4 2 5\n{square}3 0 1 2\n4 0 1 2 3\n"),
        format!(
            "COFF\r\n4 2 5\r\n{}3 0 1 2 255 0 0\r\n4 0 1 2 3 0.5 0.5 0.5 1\r\n",
            with("255 0 0 255")
        ),
        format!("NOFF\n4 2 5\n{}3 0 1 2 7\n4 0 1 2 3\n", with("0 0 1")),
        format!(
            "STCNOFF\n4 2 5\n{}3 0 1 2\n4 0 1 2 3\n",
            with("0 0 1 1 0 0 1 .5 .5")
        ),
        format!("off\n4 2 5\n{square}3 0 1 2\n4 0 1 2 3\n"),
        format!("OFF4 2 5\n{square}3 0 1 2\n4 0 1 2 3\n"),
        format!("\nOff4\n2\n{square}3 0 1 2\n4 0 1 2 3\n").replace("4\n2", "4 2"),
        format!("cnoff4 2 0\n{}3 0 1 2\n4 0 1 2 3\n", with("0 0 1 1 0 0 1")),
    ];
    for file in files {
        let soup = read_bytes(file.as_bytes(), Format::Off)
            .unwrap_or_else(|error| panic!("{error}\n{file}"));
        assert_eq!(soup.positions, SQUARE, "{file}");
        assert_eq!(polygons(&soup), [&[0, 1, 2][..], &[0, 1, 2, 3]], "{file}");
    }
}

/// Normals, colours and texture coordinates follow the position in this order, whatever the order of the keyword's letters.
#[test]
fn off_columns_are_read_under_all_keywords() {
    let (normal, colour, texture) = ([0.6, 0.0, -0.8], [0.25, 0.5, 1.0, 0.75], [3.5, -2.0]);
    for keyword in [
        "OFF", "NOFF", "COFF", "STOFF", "CNOFF", "NCOFF", "STNOFF", "NSTOFF", "STCOFF", "CSTOFF",
        "STCNOFF", "STNCOFF", "CNSTOFF", "noff", "stoff", "stcnoff", "StCnOff",
    ] {
        for glued in [" ", "\n", ""] {
            for opacity in [3, 4] {
                let letters = keyword.to_ascii_uppercase();
                let has = |letter: &str| letters.trim_end_matches("OFF").contains(letter);
                let mut columns: Vec<f64> = Vec::new();
                if has("N") {
                    columns.extend(normal);
                }
                if has("C") {
                    columns.extend(&colour[..opacity]);
                }
                if has("T") {
                    columns.extend(texture);
                }
                let columns: String = columns.iter().map(|x| format!(" {x}")).collect();
                let text = format!(
                    "{keyword}{glued}3 1 3\n0 0 0{columns}\n1 0 0{columns}\n0 1 0{columns}\n3 0 1 2\n"
                );
                let soup = read_bytes(text.as_bytes(), Format::Off)
                    .unwrap_or_else(|why| panic!("{why}\n{text}"));
                let mut expected: Vec<(&str, &[f64])> = Vec::new();
                expected.extend(has("N").then_some(("normals", &normal[..])));
                expected.extend(has("T").then_some(("texture coordinates", &texture[..])));
                expected.extend(has("C").then_some(("colours", &colour[..opacity])));
                let found: Vec<(&str, &[f64])> = soup
                    .channels
                    .iter()
                    .map(|own| (own.name.as_str(), own.value(2)))
                    .collect();
                assert_eq!(found, expected, "{text}");
                assert!(
                    soup.channels
                        .iter()
                        .all(|own| own.domain == Domain::Vertex && own.indices.len() == 3)
                );
                assert_eq!(
                    soup.left_out,
                    if has("N") { vec!["normals"] } else { vec![] },
                    "{text}"
                );
            }
        }
    }
}

/// The tetrahedron of a file that begins as ModelNet's do: its volume is a sixth, by hand.
#[test]
fn off_keyword_that_touches_the_counts() {
    let soup = read_bytes(include_bytes!("../data/glued.off"), Format::Off).unwrap();
    let volume: f64 = polygons(&soup)
        .iter()
        .map(|face| {
            let [a, b, c] = [0, 1, 2].map(|i| soup.positions[face[i] as usize]);
            let cross = [
                b[1] * c[2] - b[2] * c[1],
                b[2] * c[0] - b[0] * c[2],
                b[0] * c[1] - b[1] * c[0],
            ];
            (0..3).map(|i| a[i] * cross[i]).sum::<f64>() / 6.0
        })
        .sum();
    assert_eq!((soup.positions.len(), soup.faces.len()), (4, 4));
    assert!((volume - 1.0 / 6.0).abs() < 1e-15, "{volume}");
}

#[test]
fn extensions_in_capitals_and_small_letters() {
    for (name, format) in [
        ("a.obj", Format::Obj),
        ("b.PLY", Format::Ply),
        ("c.d.Stl", Format::Stl),
        ("e.oFF", Format::Off),
    ] {
        assert_eq!(Format::from_path(name.as_ref()).unwrap(), format);
    }
    for (name, expected) in [
        ("a.txt", "'txt'"),
        ("obj", "no extension"),
        (".obj", "no extension"),
        ("", "no extension"),
    ] {
        let message = Format::from_path(name.as_ref()).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}

/// What reading `bytes` says that it left out.
fn find(soup: &PolygonSoup, name: &str) -> Channel {
    soup.channels
        .iter()
        .find(|channel| channel.name == name)
        .unwrap_or_else(|| panic!("{name}"))
        .clone()
}

fn left_out(bytes: &[u8], format: Format) -> Vec<String> {
    read_bytes(bytes, format).unwrap().left_out
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn what_an_obj_file_held_and_a_soup_cannot_is_named() {
    let cases: [(&str, &[&str]); 11] = [
        // No corner names the texture coordinate, and no face stands under a material.
        ("vt 0 0\nvn 0 0 1\n", &["texture coordinates", "normals"]),
        ("mtllib a.mtl\n", &["materials"]),
        (
            "l 1 2\np 3\nvp 0.5\n",
            &["lines", "points", "points in parameter space"],
        ),
        ("v 0 0 1 0.5 0.5\n", &["colours"]),
        ("v 0 0 1 1 0.5 red 0.5\n", &["colours"]),
        ("v 0 0 1 0.5\n", &["weights of vertices"]),
        (
            "curv 0 1 1 2\ncurv 0 1 1 2\nbevel on\n",
            &["statements 'curv'", "statements 'bevel'"],
        ),
        ("t hole 1/0/0 0\n", &["tags 'hole'"]),
        // Nothing is said of what says nothing.
        ("g\no\ns off\ns 0\n", &[]),
        ("v 0 0 1 1\n", &[]),
        ("# vt 0 0\n\nt\n", &[]),
    ];
    for (more, expected) in cases {
        for text in [format!("{TRIANGLE}{more}"), format!("{more}{TRIANGLE}")] {
            // Vertices before the triangle's move its indices, which is all the same here.
            assert_eq!(left_out(text.as_bytes(), Format::Obj), expected, "{text}");
        }
    }
}

/// Texture coordinates, colours, and the names under which faces stand, as they are written by hand here.
#[test]
fn obj_files_hold_channels() {
    let text = "mtllib a.mtl b.mtl\no car\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0.5 0\nv 1 1 0\nv 0 1 0 0 0 1\n\
        vt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0.25 0.125\nf 1/1 2/2 3/3\nusemtl red\ng wheel left\nf 1/-1 3/3 4\n";
    let soup = obj(text);
    assert_eq!(
        soup.left_out,
        ["that 1 corner has no texture coordinates: 0 0 takes their place"]
    );
    assert_eq!(soup.material_libraries, ["a.mtl b.mtl"]);
    let [texture, colour, object, group, material] = &soup.channels[..] else {
        panic!("{:?}", soup.channels)
    };
    let values = |channel: &Channel| -> Vec<Vec<f64>> {
        (0..channel.indices.len())
            .map(|element| channel.value(element).to_vec())
            .collect()
    };
    let places = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.5, 0.25, 0.125],
        [1.0, 1.0, 0.0],
        [0.0; 3],
    ];
    assert_eq!(values(texture), places);
    assert_eq!(
        values(colour),
        [[1.0, 0.0, 0.0], [0.0, 0.5, 0.0], [1.0; 3], [0.0, 0.0, 1.0]]
    );
    let names = |channel: &Channel| -> Vec<String> {
        channel
            .indices
            .iter()
            .map(|&number| channel.labels[number as usize].clone())
            .collect()
    };
    assert_eq!(names(object), ["car", "car"]);
    assert_eq!(names(group), ["", "wheel left"]);
    assert_eq!(names(material), ["", "red"]);

    // And back again.
    let triangles = [[0, 1, 2], [0, 2, 3]];
    let surface = Triangles {
        positions: &soup.positions,
        triangles: &triangles,
    };
    let output = Output::new(surface)
        .channels(&soup.channels)
        .material_libraries(&soup.material_libraries);
    let mut bytes = Vec::new();
    write_to(&mut bytes, Format::Obj, &output, &WriteOptions::default()).unwrap();
    let again = obj(std::str::from_utf8(&bytes).unwrap());
    assert_eq!(again.channels.len(), soup.channels.len());
    for (now, before) in again.channels.iter().zip(&soup.channels) {
        let is_named = !before.labels.is_empty();
        assert!(
            if is_named {
                names(now) == names(before)
            } else {
                values(now) == values(before)
            },
            "{}",
            now.name
        );
    }
    assert_eq!(again.material_libraries, soup.material_libraries);
}

/// Corners that name texture coordinates that are not there: the shape is read, and that is told.
#[test]
fn texture_coordinates_that_are_not_there_are_told() {
    for corner in ["1/2", "1/x", "1/0", "1/-2"] {
        let soup = obj(&format!("vt 0 0\n{OBJ_SQUARE}f {corner} 2/1 3/1\n"));
        assert_eq!(
            soup.left_out,
            ["texture coordinates: some corners name others than there are"],
            "{corner}"
        );
        assert!(soup.channels.is_empty());
    }
}

/// Colours, texture coordinates and other numbers, as other programs write them; read, written in both forms, and read again.
#[test]
fn ply_files_hold_channels() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
        property uchar alpha\nproperty int joint\nproperty double heat\nelement face 2\n\
        property list uchar int vertex_indices\nproperty int texnumber\nproperty list uchar float texcoord\nend_header\n\
        0 0 0 0 0 255 0 0 255 7 0.5\n1 0 0 1 0 0 255 0 128 -3 1.5\n1 1 0 1 1 0 0 255 255 7 2.5\n0 1 0 0 1 51 51 51 0 7 0.1\n\
        3 0 1 2 0 6 0 0 1 0 1 1\n3 0 2 3 1 6 0.5 0.5 0.25 0.25 0 1\n";
    let soup = read_bytes(text.as_bytes(), Format::Ply).unwrap();
    assert!(soup.left_out.is_empty(), "{:?}", soup.left_out);
    let values = |channel: &Channel| -> Vec<f64> {
        (0..channel.indices.len())
            .flat_map(|element| channel.value(element).to_vec())
            .collect()
    };
    let check = |soup: &PolygonSoup, expects_places: bool| {
        let colours = find(soup, "red,green,blue,alpha");
        let expected = [
            [1.0, 0.0, 0.0, 1.0],
            [0.0, 1.0, 0.0, 128.0 / 255.0],
            [0.0, 0.0, 1.0, 1.0],
            [0.2, 0.2, 0.2, 0.0],
        ];
        assert_eq!(values(&colours), expected.concat());
        assert_eq!(values(&find(soup, "joint")), [7.0, -3.0, 7.0, 7.0]);
        assert_eq!(values(&find(soup, "heat")), [0.5, 1.5, 2.5, 0.1]);
        assert_eq!(values(&find(soup, "texnumber")), [0.0, 1.0]);
        let corners = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.5, 0.5, 0.25, 0.25, 0.0, 1.0];
        assert_eq!(values(&find(soup, "texcoord")), corners);
        if expects_places {
            assert_eq!(
                values(&find(soup, "s,t")),
                [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]
            );
        }
    };
    check(&soup, true);
    let triangles = [[0, 1, 2], [0, 2, 3]];
    let surface = Triangles {
        positions: &soup.positions,
        triangles: &triangles,
    };
    for ascii in [true, false] {
        let mut bytes = Vec::new();
        let output = Output::new(surface).channels(&soup.channels);
        write_to(
            &mut bytes,
            Format::Ply,
            &output,
            &WriteOptions::default().ascii(ascii),
        )
        .unwrap();
        let again = read_bytes(&bytes, Format::Ply).unwrap();
        assert!(again.left_out.is_empty(), "{:?}", again.left_out);
        check(&again, true);
        let header = String::from_utf8_lossy(&bytes);
        for line in [
            "property float s",
            "property uchar red",
            "property uchar alpha",
            "property int joint",
            "property double heat",
        ] {
            assert!(header.contains(&format!("{line}\n")), "{line}");
        }
    }
}

/// Lists that do not fit, and numbers that are none: the shape is read, and that is told.
#[test]
fn ply_channels_that_do_not_fit_are_told() {
    let ply = |heat: &str, list: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property float heat\nelement face 1\nproperty list uchar int vertex_indices\n\
             property list uchar float texcoord\nend_header\n0 0 0 {heat}\n1 0 0 1\n0 1 0 1\n3 0 1 2 {list}\n"
        )
    };
    let told = |heat: &str, list: &str| left_out(ply(heat, list).as_bytes(), Format::Ply);
    assert!(told("1", "6 0 0 1 0 1 1").is_empty());
    assert_eq!(
        told("nan", "6 0 0 1 0 1 1"),
        ["vertex properties heat (not all finite)"]
    );
    assert_eq!(
        told("1", "4 0 0 1 0"),
        ["face properties texcoord (not two numbers for each corner)"]
    );
    assert_eq!(
        told("1", "0"),
        ["face properties texcoord (not two numbers for each corner)"]
    );
}

#[test]
fn what_a_ply_file_held_and_a_soup_cannot_is_named() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float nx\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\n\
        property int flags\nelement edge 1\nproperty int a\nelement note 0\nproperty int b\nend_header\n\
        0 0 0 1 9\n1 0 0 1 9\n0 1 0 1 9\n3 0 1 2 7\n5\n";
    // Of normals one number says nothing; red and flags are carried.
    let named = ["vertex properties nx", "element edge"];
    assert_eq!(left_out(ply.as_bytes(), Format::Ply), named);
    assert_eq!(
        left_out(format!("{ply} \n\n").as_bytes(), Format::Ply),
        named
    );
    let more = left_out(format!("{ply}\n4 5\n").as_bytes(), Format::Ply);
    assert_eq!(more[2..], ["4 bytes after the last element"]);
    let surface = Triangles {
        positions: &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: &[[0, 1, 2]],
    };
    let normals = [[0.0, 0.0, 1.0]; 3];
    let mut binary = Vec::new();
    let output = Output::new(surface).normals(&normals);
    write_to(&mut binary, Format::Ply, &output, &WriteOptions::default()).unwrap();
    assert_eq!(left_out(&binary, Format::Ply), ["normals"]);
    binary.push(7);
    assert_eq!(
        left_out(&binary, Format::Ply),
        ["normals", "1 byte after the last element"]
    );
}

#[test]
fn stl_solids_and_attributes_are_read_and_written_back() {
    let solid = |name: &str| {
        format!(
            "solid{name}\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
             endsolid{name}\n"
        )
    };
    let bytes = [
        solid(" a b"),
        solid(""),
        solid(" gr\u{f6}\u{df}e"),
        solid(" a b"),
    ]
    .concat();
    let soup = read_bytes(bytes.as_bytes(), Format::Stl).unwrap();
    assert!(
        soup.left_out.is_empty()
            && read_bytes(solid("").as_bytes(), Format::Stl)
                .unwrap()
                .channels
                .is_empty()
    );
    let names = find(&soup, "names of objects");
    assert_eq!(
        (names.indices.as_slice(), names.labels.as_slice()),
        (
            &[0, 1, 2, 0][..],
            &["a b", "", "gr\u{f6}\u{df}e"].map(str::to_owned)[..]
        )
    );
    let triangles: Vec<[u32; 3]> = soup
        .faces
        .iter()
        .map(|face| face.try_into().unwrap())
        .collect();
    let surface = Triangles {
        positions: &soup.positions,
        triangles: &triangles,
    };
    let write = |ascii: bool, channels: &[Channel]| {
        let mut bytes = Vec::new();
        let output = Output::new(surface).channels(channels);
        write_to(
            &mut bytes,
            Format::Stl,
            &output,
            &WriteOptions::default().ascii(ascii),
        )
        .unwrap();
        bytes
    };
    // What is a solid in one file is one in the other, line by line.
    let lines = |bytes: &[u8]| -> Vec<String> {
        let text = String::from_utf8(bytes.to_vec()).unwrap();
        text.lines()
            .filter(|line| line.contains("solid"))
            .map(str::to_owned)
            .collect()
    };
    assert_eq!(lines(&write(true, &soup.channels)), lines(bytes.as_bytes()));
    let mut binary = write(false, &soup.channels);
    assert!(
        read_bytes(&binary, Format::Stl)
            .unwrap()
            .channels
            .is_empty()
    );
    // The two bytes at the end of the second facet and of the last.
    binary[84 + 50 + 48..84 + 100].copy_from_slice(&0x8421u16.to_le_bytes());
    binary[84 + 150 + 48..].copy_from_slice(&7u16.to_le_bytes());
    let soup = read_bytes(&binary, Format::Stl).unwrap();
    let values: Vec<f64> = (0..4)
        .map(|face| find(&soup, "attributes of facets").value(face)[0])
        .collect();
    assert_eq!(values, [0.0, f64::from(0x8421), 0.0, 7.0]);
    assert_eq!(write(false, &soup.channels), binary);
    binary.extend([0; 3]);
    assert_eq!(
        left_out(&binary, Format::Stl),
        ["3 bytes after the last facet"]
    );
}

#[test]
fn what_an_off_file_held_and_a_soup_cannot_is_named() {
    let off = |keyword: &str, column: &str, face: &str, end: &str| {
        let text = format!(
            "{keyword}\n3 1 0\n0 0 0{column}\n1 0 0{column}\n0 1 0{column}\n3 0 1 2{face}\n{end}"
        );
        left_out(text.as_bytes(), Format::Off)
    };
    assert!(off("OFF", "", "", "").is_empty());
    assert!(off("OFF", "", " 0", "\n# the end\n").is_empty());
    // Announced, and not there.
    assert!(off("COFF", "", "", "").is_empty());
    for column in [" 255 0 0", " 255 0 0 255", " 0.5 1e0 0"] {
        assert!(off("COFF", column, column, "").is_empty(), "{column}");
    }
    for column in [" 300 0 0", " red", " 1.5 0 0", " -1 0 0", " 7", " 1 2"] {
        assert_eq!(
            off("OFF", column, column, ""),
            ["colours", "colours of faces"],
            "{column}"
        );
    }
    assert_eq!(off("NOFF", " 0 0 1", "", ""), ["normals"]);
    // The normal comes first, so that the colour is 255 0 0 1.
    assert_eq!(
        off("STCNOFF", " 0 0 1 255 0 0 1 0.5 0.5", "", ""),
        ["normals"]
    );
    assert_eq!(off("NOFF", " 0 0", "", ""), ["normals"]);
    assert_eq!(off("STOFF", " 0.5", "", ""), ["texture coordinates"]);
    assert_eq!(off("STOFF", " 0.5 x", "", ""), ["texture coordinates"]);
    // Announced, and not there.
    assert!(off("STNOFF", "", "", "").is_empty());
    assert_eq!(
        off("OFF", "", "", "3 0 1 2\n"),
        ["what stands after the last face"]
    );
}

/// Colours of vertices and faces, in both of the ways in which files have them: read, and written as they were.
#[test]
fn off_colours_are_read_and_written_back() {
    for (of_vertices, of_faces, expected) in [
        (
            ["255 0 0 51", "0 255 0 255", "0 0 255 0", "0 0 0 255"],
            "51 102 255 255",
            [1.0, 0.0, 0.0, 0.2],
        ),
        (
            [
                "1.0 0.0 0.0 0.2",
                "0.0 1.0 0.0 1.0",
                "0.0 0.0 1.0 0.0",
                "0.0 0.0 0.0 1.0",
            ],
            "0.2 0.4 1.0 1.0",
            [1.0, 0.0, 0.0, 0.2],
        ),
    ] {
        let [a, b, c, d] = of_vertices;
        let text = format!(
            "COFF\n4 2 0\n0 0 0 {a}\n1 0 0 {b}\n0 1 0 {c}\n0 0 1 {d}\n3 0 1 2 {of_faces}\n3 0 2 3 {of_faces}\n"
        );
        let soup = read_bytes(text.as_bytes(), Format::Off).unwrap();
        let (colours, faces) = (find(&soup, "colours"), find(&soup, "colours of faces"));
        for (i, x) in expected.into_iter().enumerate() {
            assert!((colours.value(0)[i] - x).abs() < 1e-7);
            assert!((faces.value(1)[i] - [0.2, 0.4, 1.0, 1.0][i]).abs() < 1e-7);
        }
        let triangles = [[0, 1, 2], [0, 2, 3]];
        let surface = Triangles {
            positions: &soup.positions,
            triangles: &triangles,
        };
        let mut bytes = Vec::new();
        let output = Output::new(surface).channels(&soup.channels);
        write_to(&mut bytes, Format::Off, &output, &WriteOptions::default()).unwrap();
        assert_eq!(String::from_utf8(bytes).unwrap(), text);
    }
    // Three numbers, not everywhere: Geomview's grey there.
    let text = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0 0 128 255\n";
    let soup = read_bytes(text.as_bytes(), Format::Off).unwrap();
    assert_eq!(find(&soup, "colours of faces").value(0), [0.666; 3]);
    assert_eq!(
        find(&soup, "colours of faces").value(1),
        [0.0, 128.0 / 255.0, 1.0]
    );
}

/// Names in any encoding come out as the bytes that they were.
#[test]
fn obj_names_are_the_same_bytes_again() {
    let text =
        b"mtllib gr\xf6\xdfe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng \xff\xfe \xe6\x9c\xa8\nusemtl \x80\nf 1 2 3\n";
    let soup = read_bytes(text, Format::Obj).unwrap();
    let surface = Triangles {
        positions: &soup.positions,
        triangles: &[[0, 1, 2]],
    };
    let mut bytes = Vec::new();
    let output = Output::new(surface)
        .channels(&soup.channels)
        .material_libraries(&soup.material_libraries);
    write_to(&mut bytes, Format::Obj, &output, &WriteOptions::default()).unwrap();
    for line in text
        .split(|&b| b == b'\n')
        .filter(|line| line.first().is_some_and(|&c| c != b'v' && c != b'f'))
    {
        assert!(
            bytes.split(|&b| b == b'\n').any(|own| own == line),
            "{line:x?}"
        );
    }
}
