//! Polygons of `FB_ngon_encoding` and `EXT_mesh_polygon`: as polygons where they are whole, as triangles where they are not.

use super::mutations::exercise;
use super::support::{TRIANGLE, floats, glb, mesh, parts};
use crate::support::shared;
use limitmesh_io::gltf::{Joining, MeshSoup};
use limitmesh_io::{Asset, Format, read_bytes};
use serde_json::{Value, json};

/// A document of one mesh that grows.
struct Document {
    bin: Vec<u8>,
    json: Value,
}

impl Document {
    fn new(positions: &[[f32; 3]]) -> Self {
        let json = json!({"asset": {"version": "2.0"}, "meshes": [{"primitives": []}], "bufferViews": [], "accessors": []});
        let bin = Vec::new();
        let mut own = Self { bin, json };
        let positions = floats(positions.as_flattened());
        own.accessor(positions, 12, 5126, "VEC3");
        own
    }

    fn accessor(&mut self, bytes: Vec<u8>, size: usize, component: u32, kind: &str) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let (start, length) = (self.bin.len(), bytes.len());
        self.bin.extend(bytes);
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        let view = json!({"buffer": 0, "byteOffset": start, "byteLength": length});
        views.push(view);
        let view = views.len() - 1;
        let all = self.json["accessors"].as_array_mut().unwrap();
        all.push(json!({"bufferView": view, "componentType": component, "count": length / size, "type": kind}));
        all.len() - 1
    }

    fn indices(&mut self, all: &[u32]) -> usize {
        let bytes = all.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(bytes, 4, 5125, "SCALAR")
    }

    fn bytes(&mut self, all: &[u8]) -> usize {
        self.accessor(all.to_vec(), 1, 5121, "SCALAR")
    }

    fn primitive(&mut self, primitive: Value) {
        let mut own = json!({"attributes": {"POSITION": 0}});
        let members = primitive.as_object().unwrap().clone();
        own.as_object_mut().unwrap().extend(members);
        let list = self.json["meshes"][0]["primitives"].as_array_mut().unwrap();
        list.push(own);
    }

    fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        glb(&json.to_string(), &self.bin)
    }

    fn read(&self) -> MeshSoup {
        mesh(&self.glb())
    }

    #[track_caller]
    fn complaint(&self) -> String {
        super::support::complaint(&self.glb())
    }
}

/// Points of which no four are in one plane.
fn points(count: u8) -> Vec<[f32; 3]> {
    let all = (0..count).map(f32::from);
    all.map(|x| [x, x * x, x * x * x]).collect()
}

fn faces(own: &MeshSoup) -> Vec<&[u32]> {
    own.soup.faces.iter().collect()
}

/// A primitive whose triangles, of so many vertices, are said to be fans of polygons.
fn fans(vertices: u8, triangles: &[[u32; 3]]) -> Document {
    let mut document = Document::new(&points(vertices));
    let indices = document.indices(triangles.as_flattened());
    document.primitive(json!({"indices": indices, "extensions": {"FB_ngon_encoding": {}}}));
    document
}

#[test]
fn fans_are_polygons() {
    // A quad, a triangle, a pentagon, and a triangle that begins where the pentagon does not.
    let triangles = [
        [0, 1, 2],
        [0, 2, 3],
        [3, 2, 4],
        [5, 6, 7],
        [5, 7, 8],
        [5, 8, 9],
        [6, 5, 9],
    ];
    let found = fans(10, &triangles).read();
    let expected: [&[u32]; 4] = [&[0, 1, 2, 3], &[3, 2, 4], &[5, 6, 7, 8, 9], &[6, 5, 9]];
    assert_eq!(faces(&found), expected);
    assert_eq!(found.as_triangles, 0);
    // Without the extension these are triangles, and so they are in a strip.
    let mut document = fans(10, &triangles);
    let primitive = &mut document.json["meshes"][0]["primitives"][0];
    primitive.as_object_mut().unwrap().remove("extensions");
    assert_eq!(document.read().soup.faces.len(), 7);
    let mut document = fans(10, &[[0, 1, 2], [3, 4, 5]]);
    document.json["meshes"][0]["primitives"][0]["mode"] = json!(5);
    let found = document.read();
    assert_eq!((found.soup.faces.len(), found.as_triangles), (4, 4));
}

#[test]
fn triangles_that_are_no_fan_stay_triangles() {
    // A fan that is closed around its vertex, two triangles of one vertex alone, one without area, and a quad.
    let triangles = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 6],
        [4, 7, 8],
        [1, 5, 6],
        [1, 6, 6],
        [2, 3, 4],
        [2, 4, 5],
    ];
    let found = fans(9, &triangles).read();
    let mut expected: Vec<&[u32]> = triangles[..7].iter().map(|own| &own[..]).collect();
    expected.push(&[2, 3, 4, 5]);
    assert_eq!(faces(&found), expected);
    assert_eq!(found.as_triangles, 3);
    // The scene says so as well.
    let soup = read_bytes(&fans(9, &triangles).glb(), Format::Glb).unwrap();
    assert_eq!(soup.left_out, found.cut_polygons().as_slice());
    assert!(soup.left_out[0].ends_with("triangles instead (3)"));
}

/// Both drafts of `EXT_mesh_polygon`: triangles with loops apart, and loops with triangles apart, or none.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Draft {
    Triangles,
    Loops,
    LoopsAlone,
}

/// Polygons with these loops and triangles, each with its offsets.
fn polygons(
    draft: Draft,
    vertices: u8,
    [loops, loop_starts]: [&[u8]; 2],
    [triangles, triangle_starts]: [&[u32]; 2],
) -> Document {
    let mut document = Document::new(&points(vertices));
    let (loops, loop_starts) = (document.bytes(loops), document.bytes(loop_starts));
    let count = document.json["accessors"][loop_starts]["count"].clone();
    let (triangles, triangle_starts) = (
        document.indices(triangles),
        document.indices(triangle_starts),
    );
    let primitive = match draft {
        Draft::Triangles => json!({"indices": triangles, "extensions": {"EXT_mesh_polygon":
            {"count": count, "indicesOffsets": triangle_starts, "loopIndices": loops, "loopIndicesOffsets": loop_starts}}}),
        Draft::Loops => json!({"mode": 2, "indices": loops, "extensions": {"EXT_mesh_polygon":
            {"count": count, "indicesOffsets": loop_starts, "triangleIndices": triangles,
            "triangleIndicesOffsets": triangle_starts}}}),
        Draft::LoopsAlone => json!({"mode": 2, "indices": loops, "extensions": {"EXT_mesh_polygon":
            {"count": count, "indicesOffsets": loop_starts}}}),
    };
    document.primitive(primitive);
    document
}

#[test]
fn loops_are_polygons() {
    let loops = [0, 1, 2, 3, 255, 4, 5, 6, 255, 7, 3, 2, 1, 0];
    let triangles = [0, 1, 2, 0, 2, 3, 4, 5, 6, 7, 3, 2, 7, 2, 1, 7, 1, 0];
    for draft in [Draft::Triangles, Draft::Loops, Draft::LoopsAlone] {
        let document = polygons(draft, 8, [&loops, &[0, 5, 9]], [&triangles, &[0, 6, 9]]);
        let found = document.read();
        let expected: [&[u32]; 3] = [&[0, 1, 2, 3], &[4, 5, 6], &[7, 3, 2, 1, 0]];
        assert_eq!(faces(&found), expected, "{draft:?}");
        assert_eq!(found.as_triangles, 0);
    }
}

#[test]
fn polygons_with_more_than_an_outline_are_their_triangles() {
    // A quad with a hole, a triangle with a vertex inside, and a quad.
    let loops = [0, 1, 2, 3, 255, 4, 5, 6, 255, 0, 1, 2, 255, 3, 2, 1, 0, 255];
    let hole = [
        0, 1, 4, 1, 5, 4, 1, 2, 5, 2, 6, 5, 2, 3, 6, 3, 0, 4, 3, 4, 6,
    ];
    let inside = [0, 1, 7, 1, 2, 7, 2, 0, 7];
    let quad = [3, 2, 1, 3, 1, 0];
    let triangles = [&hole[..], &inside, &quad].concat();
    let starts: [&[u32]; 2] = [&triangles, &[0, 21, 30]];
    for draft in [Draft::Triangles, Draft::Loops] {
        let found = polygons(draft, 8, [&loops, &[0, 9, 13]], starts).read();
        assert_eq!((found.soup.faces.len(), found.as_triangles), (11, 2));
        assert_eq!(found.soup.faces.get(7), [0, 1, 7]);
        assert_eq!(found.soup.faces.get(10).len(), 4, "{draft:?}");
    }
    let alone = polygons(Draft::LoopsAlone, 8, [&loops, &[0, 9, 13]], starts);
    assert!(
        alone.complaint().contains(
            "expected one loop of at least 3 vertices, or triangleIndices, found polygon 0 with loops of [4, 3] vertices"
        ),
        "{}",
        alone.complaint()
    );
}

#[test]
fn flaws_of_polygons_are_named() {
    let (loops, triangles) = ([0, 1, 2, 3, 255, 3, 2, 1, 0], [0, 1, 2, 0, 2, 3]);
    let triangles = [triangles, [3, 2, 1, 3, 1, 0]].concat();
    let usual: ([&[u8]; 2], [&[u32]; 2]) = ([&loops, &[0, 5]], [&triangles, &[0, 6]]);
    let flaw = |draft, own: ([&[u8]; 2], [&[u32]; 2])| polygons(draft, 4, own.0, own.1).complaint();
    let place = "meshes[0].primitives[0].extensions.EXT_mesh_polygon";
    for draft in [Draft::Triangles, Draft::Loops] {
        let document = polygons(draft, 4, usual.0, usual.1);
        assert_eq!(document.read().soup.faces.len(), 2);
        // Offsets that do not ascend, that begin late, that lead too far, and that cut a triangle.
        for starts in [[5u8, 0], [1, 5], [0, 10]] {
            let found = flaw(draft, ([&loops, &starts], usual.1));
            assert!(found.contains("offsets that ascend from 0"), "{found}");
        }
        let found = flaw(draft, (usual.0, [&triangles, &[0, 5]]));
        assert!(found.contains("multiples of 3"), "{found}");
        // One more than there are polygons; no such vertex.
        let found = flaw(draft, (usual.0, [&triangles, &[0, 6, 12]]));
        assert!(
            found.contains("2 elements (as many as there are polygons)"),
            "{found}"
        );
        let found = flaw(draft, ([&[0, 1, 2, 4, 255, 3, 2, 1, 0], &[0, 5]], usual.1));
        assert!(
            found.contains("4 in element 3") && found.contains("below 4"),
            "{found}"
        );
        let other = [0, 1, 2, 0, 2, 9, 3, 2, 1, 3, 1, 0];
        let found = flaw(draft, (usual.0, [&other, &[0, 6]]));
        assert!(found.contains("9 in element 5"), "{found}");
        // What is missing.
        let mut document = polygons(draft, 4, usual.0, usual.1);
        let own = &mut document.json["meshes"][0]["primitives"][0]["extensions"];
        own["EXT_mesh_polygon"] = json!({"count": 2});
        assert!(document.complaint().contains(place));
    }
}

/// The corners of a cube, and its sides.
const CUBE: [[u32; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

fn corner(i: u32) -> [f32; 3] {
    [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 })
}

/// The cube with vertices of its own for each side, as files have them, and texture coordinates that are the sides'.
fn cube() -> Document {
    let positions: Vec<[f32; 3]> = CUBE.as_flattened().iter().map(|&i| corner(i)).collect();
    let mut document = Document::new(&positions);
    let texture: Vec<f32> = (0..24u8).flat_map(|v| [f32::from(v), 0.0]).collect();
    let texture = document.accessor(floats(&texture), 8, 5126, "VEC2");
    // Fans that begin at the first and the second corner in turn.
    let fan = |side: u32| {
        let own = [0, 1, 2, 3].map(|i| 4 * side + (i + side) % 4);
        [own[0], own[1], own[2], own[0], own[2], own[3]]
    };
    let indices: Vec<u32> = (0..6).flat_map(fan).collect();
    let indices = document.indices(&indices);
    document.json["extensionsUsed"] = json!(["FB_ngon_encoding", "ODD_thing"]);
    document.primitive(
        json!({"attributes": {"POSITION": 0, "TEXCOORD_0": texture}, "indices": indices,
        "extensions": {"FB_ngon_encoding": {}}}),
    );
    document
}

#[test]
fn polygons_are_joined_and_keep_their_values() {
    let mut document = cube();
    let found = document.read();
    assert_eq!((found.soup.positions.len(), found.soup.faces.len()), (8, 6));
    let table = &found.attributes[0];
    let corners = found.soup.faces.iter().flatten().zip(&table.corners);
    for (number, (&v, &value)) in (0..).zip(corners) {
        // The file's vertex, which its value names.
        let own = 4 * (number / 4) + (number + number / 4) % 4;
        assert_eq!(table.values[2 * value as usize], f64::from(own));
        let position = corner(CUBE.as_flattened()[own as usize]).map(f64::from);
        assert_eq!(found.soup.positions[v as usize], position);
    }
    // In a scene that mirrors it, polygons and their values turn over.
    document.json["nodes"] = json!([{"mesh": 0, "scale": [-1, 1, 1]}]);
    let turned = read_bytes(&document.glb(), Format::Glb).unwrap();
    for (number, (own, turned)) in found.soup.faces.iter().zip(turned.faces.iter()).enumerate() {
        let reversed: Vec<u32> = turned.iter().rev().copied().collect();
        assert_eq!(own, reversed);
        for place in 0..4 {
            let value = table.corners[4 * number + place];
            assert_eq!(
                turned_value(&document, 4 * number + 3 - place),
                table.values[2 * value as usize]
            );
        }
    }
}

/// The first texture coordinate at a corner of the scene.
fn turned_value(document: &Document, corner: usize) -> f64 {
    let soup = read_bytes(&document.glb(), Format::Glb).unwrap();
    soup.channels[0].value(corner)[0]
}

#[test]
fn the_extensions_go_with_the_polygons() {
    let loops = polygons(
        Draft::Loops,
        4,
        [&[0, 1, 2, 3], &[0]],
        [&[0, 1, 2, 0, 2, 3], &[0]],
    );
    for (mut document, name) in [(cube(), "FB_ngon_encoding"), (loops, "EXT_mesh_polygon")] {
        document.json["extensionsUsed"] = json!([name, "ODD_thing"]);
        document.json["extensionsRequired"] = json!([name]);
        let mut asset = Asset::from_bytes(&document.glb(), None).unwrap();
        asset.replace(0, 0, &TRIANGLE).unwrap();
        assert!(asset.left_out().is_empty());
        let (text, bin) = parts(&asset.to_bytes(Format::Glb).unwrap());
        let new: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(new["extensionsUsed"], json!(["ODD_thing"]), "{name}");
        assert!(!text.contains(name), "{text}");
        let primitive = &new["meshes"][0]["primitives"][0];
        assert!(primitive.get("mode").is_none_or(|mode| mode == 4));
        // The triangle, and a byte for each view that was.
        assert!(bin.len() < 100, "{}", bin.len());
        let again = Asset::from_bytes(&glb(&text, &bin), None).unwrap();
        assert_eq!(
            again.mesh(0, Joining::Together).unwrap().soup.faces.len(),
            1
        );
    }
}

#[test]
fn cards_of_quads_keep_both_sides() {
    // A bent quad and its back, with the same vertices.
    let mut document = Document::new(&[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.5],
        [0.0, 1.0, 0.0],
    ]);
    let indices = document.indices(&[0, 1, 2, 0, 2, 3, 3, 2, 1, 3, 1, 0]);
    document.primitive(json!({"indices": indices, "extensions": {"FB_ngon_encoding": {}}}));
    let found = document.read();
    assert_eq!((found.soup.positions.len(), found.kept_apart.backs), (8, 1));
    let sizes: Vec<usize> = found.soup.faces.iter().map(<[u32]>::len).collect();
    assert_eq!(sizes, [4, 4]);
}

/// A file that assimp wrote, whose document names the extension, and no primitive has it until it is given to it.
#[test]
fn the_primitive_has_to_have_the_extension() {
    let Some(path) = shared("assets/quad_skin.glb") else {
        return;
    };
    let (text, bin) = parts(&std::fs::read(path).unwrap());
    let mut json: Value = serde_json::from_str(&text).unwrap();
    assert!(text.contains("FB_ngon_encoding"));
    assert_eq!(mesh(&glb(&text, &bin)).soup.faces.len(), 2);
    json["meshes"][0]["primitives"][0]["extensions"] = json!({"FB_ngon_encoding": {}});
    let found = mesh(&glb(&json.to_string(), &bin));
    assert_eq!((found.soup.faces.len(), found.influences.len()), (1, 4));
    assert_eq!(found.soup.faces.get(0).len(), 4);
}

#[test]
fn whatever_bytes_become_is_read_or_refused() {
    let loops = [0, 1, 2, 3, 255, 3, 2, 1, 0];
    let triangles = [0, 1, 2, 0, 2, 3, 3, 2, 1, 3, 1, 0];
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let drafts = [Draft::Triangles, Draft::Loops, Draft::LoopsAlone];
    let of = |draft| polygons(draft, 4, [&loops, &[0, 5]], [&triangles, &[0, 6]]);
    for document in drafts.map(of).into_iter().chain([cube()]) {
        let bytes = document.glb();
        for _ in 0..400 {
            let mut bytes = bytes.clone();
            for _ in 0..1 + random(4) {
                let place = random(bytes.len());
                // Digits stay digits, so that more of it is still JSON.
                let is_digit = bytes[place].is_ascii_digit();
                bytes[place] = match is_digit {
                    true => b'0' + random(10) as u8,
                    false => random(256) as u8,
                };
            }
            exercise(&bytes);
        }
    }
}
