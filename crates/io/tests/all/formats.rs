//! The syntax that each reader understands, on small files written out here.

use super::support::{
    cases, channel, labels, output, read, refused, text as text_of, triangles, values, written,
};
use limitmesh::mesh::{Channel, CornerTag, CreaseTag, Domain, PolygonSoup};
use limitmesh_io::Format;

fn obj(text: &str) -> PolygonSoup {
    read(text, Format::Obj)
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
    let error = refused(text, Format::Obj);
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
    assert_eq!(read(&bytes, Format::Obj).faces.len(), 1);
}

#[test]
fn obj_tags() {
    let tags = "t crease 2/1/0 0 1 2.5\nt crease 4/2/0 1 2 2 3 1 10\nt crease 4/1/0 0 2 1 3 inf\n\
                t corner 1/1/0 3 10\nt corner 2/1/0 0 1 4.5\nt interpolateboundary 1/0/0 2\nt\nt smooth\n";
    let soup = obj(&format!("{tags}{OBJ_SQUARE}f 1 2 3 4\n"));
    let crease = |own: &CreaseTag| (own.vertices, own.sharpness);
    let infinite = f64::INFINITY;
    let creases = [
        ([0, 1], 2.5),
        ([1, 2], 1.0),
        ([2, 3], 10.0),
        ([0, 2], infinite),
        ([1, 3], infinite),
    ];
    assert_eq!(soup.creases.iter().map(crease).collect::<Vec<_>>(), creases);
    let corner = |own: &CornerTag| (own.vertex, own.sharpness);
    let corners: Vec<_> = soup.corners.iter().map(corner).collect();
    assert_eq!(corners, [(3, 10.0), (0, 4.5), (1, 4.5)]);
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
    let bits = |all: &[[f64; 3]]| {
        all.iter()
            .flatten()
            .map(|x| x.to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(bits(&soup.positions), bits(&expected));
}

fn ply(header: &str, body: &[u8]) -> PolygonSoup {
    read([header.as_bytes(), body].concat(), Format::Ply)
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
        soup.left_out.pop().as_deref(),
        Some("32 bytes after the last element")
    );
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
    let names = "char uchar short ushort int uint int8 uint8 int16 uint16 int32 uint32 float double float32 float64";
    for big in [false, true] {
        for name in names.split(' ') {
            let is_real = name.contains("float") || name == "double";
            let list = if is_real { "uchar" } else { name };
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
            let start = [
                (list, 2),
                (name, 5),
                (name, 6),
                (list, 0),
                (name, 9),
                (list, 4),
            ];
            start.iter().for_each(|&(kind, value)| put(kind, value));
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
        let soup = read(text, Format::Stl);
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
    let facet = "solid x\nfacet normal 0 0 1\nouter loop";
    for start in ["", "solid", facet, "v 1 2 3\nply\nOFF"] {
        let soup = read(binary_stl(start.as_bytes(), 3), Format::Stl);
        assert_eq!(polygons(&soup), [[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
        assert_eq!(soup.positions[8], [0.0, 1.0, 2.0]);
    }
}

#[test]
fn off_in_many_dresses() {
    let square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    let table = r"
        OFF\n4 2 5\n*3 0 1 2\n4 0 1 2 3\n |
        OFF 4 2 5\n*3 0 1 2\n4 0 1 2 3 |
        OFF # keyword\n# counts\n\n4 2 # no edges\n\n*# faces\n3 0 1 2 # one\n\n4 0 1 2 3\n |
        4 2 5\n*3 0 1 2\n4 0 1 2 3\n |
        COFF\n4 2 5\n*3 0 1 2 255 0 0\n4 0 1 2 3 0.5 0.5 0.5 1\n | 255 0 0 255
        NOFF\n4 2 5\n*3 0 1 2 7\n4 0 1 2 3\n | 0 0 1
        STCNOFF\n4 2 5\n*3 0 1 2\n4 0 1 2 3\n | 0 0 1 1 0 0 1 .5 .5
        off\n4 2 5\n*3 0 1 2\n4 0 1 2 3\n |
        OFF4 2 5\n*3 0 1 2\n4 0 1 2 3\n |
        \nOff4 2\n*3 0 1 2\n4 0 1 2 3\n |
        cnoff4 2 0\n*3 0 1 2\n4 0 1 2 3\n | 0 0 1 1 0 0 1";
    for [file, columns] in cases(&table.replace(" |\n", " | \n")) {
        let file = file.replace('*', &square.replace("0\n", &format!("0 {columns}\n")));
        for file in [file.replace('\n', "\r\n"), file] {
            let soup = read(&file, Format::Off);
            assert_eq!(soup.positions, SQUARE, "{file}");
            assert_eq!(polygons(&soup), [&[0, 1, 2][..], &[0, 1, 2, 3]], "{file}");
        }
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
                let colour = &colour[..opacity];
                let columns: [(&str, &str, &[f64]); 3] = [
                    ("N", "normals", &normal),
                    ("C", "colours", colour),
                    ("T", "texture coordinates", &texture),
                ];
                let mut there: Vec<_> = columns.into_iter().filter(|(own, ..)| has(own)).collect();
                let numbers = there.iter().flat_map(|(_, _, own)| *own);
                let line: String = numbers.map(|x| format!(" {x}")).collect();
                let text = format!(
                    "{keyword}{glued}3 1 3\n0 0 0{line}\n1 0 0{line}\n0 1 0{line}\n3 0 1 2\n"
                );
                let soup = read(&text, Format::Off);
                // Colours are the last of the channels.
                there.sort_by_key(|(own, ..)| *own == "C");
                let found = soup
                    .channels
                    .iter()
                    .map(|own| (own.name.as_str(), own.value(2)));
                let expected = there.iter().map(|&(_, name, own)| (name, own));
                assert!(found.eq(expected), "{text}");
                let is_whole =
                    |own: &Channel| own.domain == Domain::Vertex && own.indices.len() == 3;
                assert!(soup.channels.iter().all(is_whole));
                let left_out = if has("N") { vec!["normals"] } else { vec![] };
                assert_eq!(soup.left_out, left_out, "{text}");
            }
        }
    }
}

/// The tetrahedron of a file that begins as ModelNet's do: its volume is a sixth, by hand.
#[test]
fn off_keyword_that_touches_the_counts() {
    let soup = read(include_bytes!("../data/glued.off"), Format::Off);
    let sixth = |face: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|i| soup.positions[face[i] as usize]);
        let cross = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        (a[0] * cross(1, 2) + a[1] * cross(2, 0) + a[2] * cross(0, 1)) / 6.0
    };
    let volume: f64 = soup.faces.iter().map(sixth).sum();
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

/// The statements that reading bytes leaves out.
fn left_out(bytes: impl AsRef<[u8]>, format: Format) -> Vec<String> {
    read(bytes, format).left_out
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn what_an_obj_file_held_and_a_soup_cannot_is_named() {
    // No corner names the texture coordinate, and no face stands under a material; nothing is said of what says nothing.
    let table = r"
        vt 0 0\nvn 0 0 1\n | texture coordinates, normals
        mtllib a.mtl\n | materials
        l 1 2\np 3\nvp 0.5\n | lines, points, points in parameter space
        v 0 0 1 0.5 0.5\n | colours
        v 0 0 1 1 0.5 red 0.5\n | colours
        v 0 0 1 0.5\n | weights of vertices
        curv 0 1 1 2\ncurv 0 1 1 2\nbevel on\n | statements 'curv', statements 'bevel'
        t hole 1/0/0 0\n | tags 'hole'
        g\no\ns off\ns 0\n | _
        v 0 0 1 1\n | _
        # vt 0 0\n\nt\n | _";
    for [more, expected] in cases(table) {
        for text in [format!("{TRIANGLE}{more}"), format!("{more}{TRIANGLE}")] {
            // Vertices before the triangle's move its indices, which is all the same here.
            let left_out = left_out(&text, Format::Obj).join(", ");
            assert_eq!(left_out, expected.trim_matches('_'), "{text}");
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
    let places = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.5, 0.25, 0.125],
        [1.0, 1.0, 0.0],
        [0.0; 3],
    ];
    assert_eq!(values(texture), places);
    let colours = [[1.0, 0.0, 0.0], [0.0, 0.5, 0.0], [1.0; 3], [0.0, 0.0, 1.0]];
    assert_eq!(values(colour), colours);
    assert_eq!(labels(object), ["car", "car"]);
    assert_eq!(labels(group), ["", "wheel left"]);
    assert_eq!(labels(material), ["", "red"]);

    // And back again.
    let own = output(&soup.positions, &[[0, 1, 2], [0, 2, 3]]).channels(&soup.channels);
    let own = own.material_libraries(&soup.material_libraries);
    let again = obj(&text_of(Format::Obj, &own));
    assert_eq!(again.channels.len(), soup.channels.len());
    for (now, before) in again.channels.iter().zip(&soup.channels) {
        match before.labels.is_empty() {
            true => assert_eq!(values(now), values(before), "{}", now.name),
            false => assert_eq!(labels(now), labels(before), "{}", now.name),
        }
    }
    assert_eq!(again.material_libraries, soup.material_libraries);
}

/// Corners that name texture coordinates that are not there: the shape is read, and that is reported.
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
    let soup = read(text, Format::Ply);
    let check = |soup: &PolygonSoup| {
        let numbers = |name: &str| values(channel(soup, name)).concat();
        let colours = [
            [1.0, 0.0, 0.0, 1.0],
            [0.0, 1.0, 0.0, 128.0 / 255.0],
            [0.0, 0.0, 1.0, 1.0],
            [0.2, 0.2, 0.2, 0.0],
        ];
        assert_eq!(numbers("red,green,blue,alpha"), colours.concat());
        assert_eq!(numbers("joint"), [7.0, -3.0, 7.0, 7.0]);
        assert_eq!(numbers("heat"), [0.5, 1.5, 2.5, 0.1]);
        assert_eq!(numbers("texnumber"), [0.0, 1.0]);
        let corners = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.5, 0.5, 0.25, 0.25, 0.0, 1.0];
        assert_eq!(numbers("texcoord"), corners);
        assert_eq!(numbers("s,t"), [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
        assert!(soup.left_out.is_empty(), "{:?}", soup.left_out);
    };
    check(&soup);
    let own = output(&soup.positions, &[[0, 1, 2], [0, 2, 3]]).channels(&soup.channels);
    for ascii in [true, false] {
        let bytes = written(Format::Ply, &own, ascii);
        check(&read(&bytes, Format::Ply));
        let header = String::from_utf8_lossy(&bytes);
        for line in [
            "float s",
            "uchar red",
            "uchar alpha",
            "int joint",
            "double heat",
        ] {
            assert!(header.contains(&format!("property {line}\n")), "{line}");
        }
    }
}

/// Lists that do not fit, and numbers that are none: the shape is read, and that is reported.
#[test]
fn ply_channels_that_do_not_fit_are_told() {
    let ply = |heat: &str, list: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property float heat\nelement face 1\nproperty list uchar int vertex_indices\n\
             property list uchar float texcoord\nend_header\n0 0 0 {heat}\n1 0 0 1\n0 1 0 1\n3 0 1 2 {list}\n"
        )
    };
    let lists = "face properties texcoord (not two numbers for each corner)";
    for (heat, list, expected) in [
        ("1", "6 0 0 1 0 1 1", ""),
        (
            "nan",
            "6 0 0 1 0 1 1",
            "vertex properties heat (not all finite)",
        ),
        ("1", "4 0 0 1 0", lists),
        ("1", "0", lists),
    ] {
        assert_eq!(left_out(ply(heat, list), Format::Ply).concat(), expected);
    }
}

#[test]
fn what_a_ply_file_held_and_a_soup_cannot_is_named() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float nx\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\n\
        property int flags\nelement edge 1\nproperty int a\nelement note 0\nproperty int b\nend_header\n\
        0 0 0 1 9\n1 0 0 1 9\n0 1 0 1 9\n3 0 1 2 7\n5\n";
    // Of normals one number says nothing; red and flags are carried.
    let named = ["vertex properties nx", "element edge"];
    assert_eq!(left_out(ply, Format::Ply), named);
    assert_eq!(left_out(format!("{ply} \n\n"), Format::Ply), named);
    let more = left_out(format!("{ply}\n4 5\n"), Format::Ply);
    assert_eq!(more[2..], ["4 bytes after the last element"]);
    let normals = [[0.0, 0.0, 1.0]; 3];
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let own = output(&positions, &[[0, 1, 2]]).normals(&normals);
    let mut binary = written(Format::Ply, &own, false);
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
    let names = [" a b", "", " gr\u{f6}\u{df}e", " a b"];
    let file = names.map(solid).concat();
    let soup = read(&file, Format::Stl);
    assert!(soup.left_out.is_empty() && read(solid(""), Format::Stl).channels.is_empty());
    assert_eq!(
        labels(channel(&soup, "names of objects")),
        names.map(str::trim)
    );
    let triangles = triangles(&soup);
    let write = |ascii: bool, soup: &PolygonSoup| {
        written(
            Format::Stl,
            &output(&soup.positions, &triangles).channels(&soup.channels),
            ascii,
        )
    };
    // What is a solid in one file is one in the other, line by line.
    let lines = |text: &str| -> Vec<String> {
        text.lines()
            .filter(|line| line.contains("solid"))
            .map(str::to_owned)
            .collect()
    };
    assert_eq!(
        lines(&String::from_utf8(write(true, &soup)).unwrap()),
        lines(&file)
    );
    let mut binary = write(false, &soup);
    assert!(read(&binary, Format::Stl).channels.is_empty());
    // The two bytes at the end of the second facet and of the last.
    binary[84 + 50 + 48..84 + 100].copy_from_slice(&0x8421u16.to_le_bytes());
    binary[84 + 150 + 48..].copy_from_slice(&7u16.to_le_bytes());
    let soup = read(&binary, Format::Stl);
    let attributes = values(channel(&soup, "attributes of facets")).concat();
    assert_eq!(attributes, [0.0, f64::from(0x8421), 0.0, 7.0]);
    assert_eq!(write(false, &soup), binary);
    binary.extend([0; 3]);
    assert_eq!(
        left_out(&binary, Format::Stl),
        ["3 bytes after the last facet"]
    );
}

#[test]
fn what_an_off_file_held_and_a_soup_cannot_is_named() {
    // The keyword, what stands after a position, what stands after a face, the end, and what is left out. What is announced need not be
    // there, and the normal comes first, so that the colour of the line with most is 255 0 0 1.
    let table = r"
        OFF | _ | _ | _ | _
        OFF | _ |  0 | \n# the end\n | _
        COFF | _ | _ | _ | _
        COFF | 255 0 0 | 255 0 0 | _ | _
        COFF | 255 0 0 255 | 255 0 0 255 | _ | _
        COFF | 0.5 1e0 0 | 0.5 1e0 0 | _ | _
        OFF | 300 0 0 | 300 0 0 | _ | colours, colours of faces
        OFF | red | red | _ | colours, colours of faces
        OFF | 1.5 0 0 | 1.5 0 0 | _ | colours, colours of faces
        OFF | -1 0 0 | -1 0 0 | _ | colours, colours of faces
        OFF | 7 | 7 | _ | colours, colours of faces
        OFF | 1 2 | 1 2 | _ | colours, colours of faces
        NOFF | 0 0 1 | _ | _ | normals
        STCNOFF | 0 0 1 255 0 0 1 0.5 0.5 | _ | _ | normals
        NOFF | 0 0 | _ | _ | normals
        STOFF | 0.5 | _ | _ | texture coordinates
        STOFF | 0.5 x | _ | _ | texture coordinates
        STNOFF | _ | _ | _ | _
        OFF | _ | _ | 3 0 1 2\n | what stands after the last face";
    for case in cases::<5>(table) {
        let [keyword, column, face, end, expected] =
            case.map(|own| own.trim_matches('_').to_owned());
        let text = format!(
            "{keyword}\n3 1 0\n0 0 0 {column}\n1 0 0 {column}\n0 1 0 {column}\n3 0 1 2 {face}\n{end}"
        );
        assert_eq!(left_out(&text, Format::Off).join(", "), expected, "{text}");
    }
}

/// Colours of vertices and faces, in both of the ways in which files have them: read, and written as they were.
#[test]
fn off_colours_are_read_and_written_back() {
    let bytes = "COFF\n4 2 0\n0 0 0 255 0 0 51\n1 0 0 0 255 0 255\n0 1 0 0 0 255 0\n0 0 1 0 0 0 255\n\
        3 0 1 2 51 102 255 255\n3 0 2 3 51 102 255 255\n";
    let parts = "COFF\n4 2 0\n0 0 0 1.0 0.0 0.0 0.2\n1 0 0 0.0 1.0 0.0 1.0\n0 1 0 0.0 0.0 1.0 0.0\n\
        0 0 1 0.0 0.0 0.0 1.0\n3 0 1 2 0.2 0.4 1.0 1.0\n3 0 2 3 0.2 0.4 1.0 1.0\n";
    for file in [bytes, parts] {
        let soup = read(file, Format::Off);
        let (vertices, faces) = (
            channel(&soup, "colours"),
            channel(&soup, "colours of faces"),
        );
        let found = [vertices.value(0), faces.value(1)].concat();
        let expected = [1.0, 0.0, 0.0, 0.2, 0.2, 0.4, 1.0, 1.0];
        assert!(
            found
                .iter()
                .zip(expected)
                .all(|(x, y)| (x - y).abs() < 1e-7),
            "{found:?}"
        );
        let own = output(&soup.positions, &[[0, 1, 2], [0, 2, 3]]).channels(&soup.channels);
        assert_eq!(text_of(Format::Off, &own), file);
    }
    // Three numbers, not everywhere: Geomview's grey there.
    let text = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0 0 128 255\n";
    let soup = read(text, Format::Off);
    let colours = [[0.666; 3], [0.0, 128.0 / 255.0, 1.0]];
    assert_eq!(values(channel(&soup, "colours of faces")), colours);
}

/// Names in any encoding come out as the bytes that they were.
#[test]
fn obj_names_are_the_same_bytes_again() {
    let text =
        b"mtllib gr\xf6\xdfe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng \xff\xfe \xe6\x9c\xa8\nusemtl \x80\nf 1 2 3\n";
    let soup = read(text, Format::Obj);
    let own = output(&soup.positions, &[[0, 1, 2]]).channels(&soup.channels);
    let own = own.material_libraries(&soup.material_libraries);
    let bytes = written(Format::Obj, &own, false);
    let lines = |bytes: &[u8]| -> Vec<Vec<u8>> {
        bytes.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect()
    };
    let written = lines(&bytes);
    for line in lines(text)
        .iter()
        .filter(|line| !line.starts_with(b"v") && !line.starts_with(b"f"))
    {
        assert!(written.contains(line), "{line:x?}");
    }
}
