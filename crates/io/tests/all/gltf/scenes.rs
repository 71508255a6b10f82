//! World matrices, instances and skins, against numbers worked out by hand.

use super::support::{document, floats, glb, parts};
use limitmesh_io::{Asset, Format, read_bytes};

const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// A triangle, further floats behind it, and members of the document.
fn asset(nodes: &str, accessors: &str, more: &[f32]) -> Vec<u8> {
    let bin = floats(&[&TRIANGLE[..], more].concat());
    let length = bin.len();
    let top = format!(
        r#""buffers":[{{"byteLength":{length}}}],"bufferViews":[{{"buffer":0,"byteLength":36}},
            {{"buffer":0,"byteOffset":36,"byteLength":{}}}],
           "accessors":[{{"count":3,"type":"VEC3","componentType":5126,"bufferView":0}}{accessors}],{nodes}"#,
        length - 36
    );
    glb(&document(&top, r#""attributes":{"POSITION":0}"#), &bin)
}

fn opened(bytes: &[u8]) -> Asset {
    Asset::from_bytes(bytes, None).unwrap()
}

#[track_caller]
fn same(found: &[[f64; 3]], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len());
    for (p, q) in found.iter().zip(expected) {
        assert!(
            (0..3).all(|i| (p[i] - q[i]).abs() < 1e-12),
            "{found:?}, expected {expected:?}"
        );
    }
}

#[test]
fn matrices_multiply_down_the_tree() {
    // A quarter turn about z after a scale of 2, below a move by (10, 0, 0) and another scale of 3.
    let half = 0.5f64.sqrt();
    let nodes = format!(
        r#""nodes":[{{"translation":[10,0,0],"scale":[3,3,3],"children":[1]}},
            {{"mesh":0,"rotation":[0,0,{half},{half}],"scale":[2,2,2]}}]"#
    );
    let bytes = asset(&nodes, "", &[]);
    let soup = read_bytes(&bytes, Format::Glb).unwrap();
    same(
        &soup.positions,
        &[[10.0, 0.0, 0.0], [10.0, 6.0, 0.0], [4.0, 0.0, 0.0]],
    );
    assert!((opened(&bytes).stretch(0) - 6.0).abs() < 1e-12);
    assert_eq!(
        opened(&bytes)
            .bounding_box()
            .unwrap()
            .map(|[low, high]| [low[0].round(), high[1].round()]),
        Some([4.0, 6.0])
    );
}

#[test]
fn matrices_are_by_column_and_mirrors_turn_faces() {
    let nodes = r#""nodes":[{"mesh":0,"matrix":[0,2,0,0, 1,0,0,0, 0,0,1,0, 5,6,7,1]}]"#;
    let soup = read_bytes(&asset(nodes, "", &[]), Format::Glb).unwrap();
    same(
        &soup.positions,
        &[[5.0, 6.0, 7.0], [5.0, 8.0, 7.0], [6.0, 6.0, 7.0]],
    );
    assert_eq!(soup.faces.get(0), [2, 1, 0]);
}

#[test]
fn instances_count_and_only_the_scene_is_shown() {
    let nodes = r#""scene":1,"scenes":[{"nodes":[0]},{"nodes":[1]}],"nodes":[
        {"mesh":0,"scale":[1,-9,1]},
        {"mesh":0,"scale":[0.5,0.5,0.5],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1,"SCALE":1}}}}]"#;
    let accessors = r#",{"count":2,"type":"VEC3","componentType":5126,"bufferView":1}"#;
    let bytes = asset(nodes, accessors, &[1.0, 2.0, 4.0, 8.0, 8.0, 8.0]);
    let soup = read_bytes(&bytes, Format::Glb).unwrap();
    let scaled = |t: [f64; 3], s: [f64; 3]| {
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
            .map(|p: [f64; 3]| [0, 1, 2].map(|i| 0.5 * (t[i] + s[i] * p[i])))
    };
    let expected = [
        scaled([1.0, 2.0, 4.0], [1.0, 2.0, 4.0]),
        scaled([8.0; 3], [8.0; 3]),
    ]
    .concat();
    same(&soup.positions, &expected);
    // The node of another scene counts for the scale all the same.
    assert!((opened(&bytes).stretch(0) - 9.0).abs() < 1e-12);
}

#[test]
fn meshes_without_nodes_are_as_they_are() {
    let bytes = asset(r#""extras":1"#, "", &[]);
    assert_eq!(opened(&bytes).stretch(0), 1.0);
    assert_eq!(read_bytes(&bytes, Format::Glb).unwrap().faces.len(), 1);
}

/// Everything that a scene shows carries its texture coordinates, upwards, and the names of its materials; mirrored faces run the other
/// way round with their values.
#[test]
fn scenes_carry_attributes_and_names_of_materials() {
    let nodes = r#""nodes":[{"mesh":0},{"mesh":0,"scale":[-1,1,1]}],"materials":[{"name":"skin"},{"name":"wood"}]"#;
    let accessors = r#",{"count":3,"type":"VEC2","componentType":5126,"bufferView":1}"#;
    let coordinates = [0.0, 0.25, 0.5, 0.75, 1.0, 2.0];
    let bytes = asset(nodes, accessors, &coordinates);
    let bytes = with_primitive(
        &bytes,
        r#""attributes":{"POSITION":0,"TEXCOORD_0":1},"material":1"#,
    );
    let soup = read_bytes(&bytes, Format::Glb).unwrap();
    assert_eq!(soup.faces.len(), 2);
    let [texture, materials] = &soup.channels[..] else {
        panic!("{:?}", soup.channels)
    };
    let values: Vec<&[f64]> = (0..6).map(|corner| texture.value(corner)).collect();
    let expected = [[0.0, 0.75], [0.5, 0.25], [1.0, -1.0]];
    assert_eq!(
        values,
        [
            expected[0],
            expected[1],
            expected[2],
            expected[2],
            expected[1],
            expected[0]
        ]
    );
    assert_eq!(materials.name, "materials");
    let names: Vec<&str> = materials
        .indices
        .iter()
        .map(|&i| &materials.labels[i as usize][..])
        .collect();
    assert_eq!(names, ["wood", "wood"]);
}

/// Normals stand at right angles to what they stood at right angles to, on the outside, where each instance is.
#[test]
fn normals_are_as_the_scene_shows_them() {
    let nodes = r#""nodes":[{"mesh":0,"scale":[1,1,2]},{"mesh":0,"scale":[-1,1,1]}]"#;
    let accessors = r#",{"count":3,"type":"VEC3","componentType":5126,"bufferView":1}"#;
    let bytes = asset(
        nodes,
        accessors,
        &[0.0, 0.6, 0.8, f32::NAN, 0.0, 1.0, 0.6, 0.0, 0.8],
    );
    let bytes = with_primitive(&bytes, r#""attributes":{"POSITION":0,"NORMAL":1}"#);
    let soup = read_bytes(&bytes, Format::Glb).unwrap();
    assert_eq!(soup.left_out, ["normals"]);
    let [normals] = &soup.channels[..] else {
        panic!("{:?}", soup.channels)
    };
    assert_eq!(normals.name, "normals");
    let unit = |corner: usize| {
        let own: [f64; 3] = normals.value(corner).try_into().unwrap();
        let length = own.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 {
            own.map(|x| x / length)
        } else {
            own
        }
    };
    let all: Vec<[f64; 3]> = (0..6).map(unit).collect();
    // Twice as high, (0, 0.6, 0.8) becomes (0, 0.6, 0.4); mirrored, faces run the other way and x changes its sign.
    let steep = |a: f64, c: f64| [a / (a * a + c * c).sqrt(), c / (a * a + c * c).sqrt()];
    let [a, c] = steep(0.6, 0.4);
    let expected = [
        [0.0, a, c],
        [0.0; 3],
        [a, 0.0, c],
        [-0.6, 0.0, 0.8],
        [0.0; 3],
        [0.0, 0.6, 0.8],
    ];
    for (found, expected) in all.iter().zip(expected) {
        assert!(
            (0..3).all(|i| (found[i] - expected[i]).abs() < 1e-7),
            "{all:?}"
        );
    }
    // One that is broken keeps no mesh from being read.
    let broken = with_primitive(
        &asset(nodes, accessors, &[0.0; 9]),
        r#""attributes":{"POSITION":0,"NORMAL":7}"#,
    );
    assert!(
        read_bytes(&broken, Format::Glb)
            .unwrap()
            .channels
            .is_empty()
    );
}

/// Colours of materials and the pictures on them, moved as the document says.
#[test]
fn materials_have_base_colours() {
    let nodes = r#""materials":[{},{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"baseColorTexture":{"index":0,
        "texCoord":2,"extensions":{"KHR_texture_transform":{"offset":[0.1,0.2],"scale":[2,3],"rotation":1.5707963267948966}}}}},
        {"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}}],
        "textures":[{"source":0},{}],"images":[{"uri":"data:image/png;base64,AQID"}]"#;
    let colours = opened(&asset(nodes, "", &[])).base_colours().unwrap();
    assert_eq!(colours.len(), 3);
    assert_eq!((colours[0].factor, &colours[0].texture), ([1.0; 4], &None));
    assert_eq!(colours[1].factor, [0.5, 0.25, 1.0, 1.0]);
    let texture = colours[1].texture.as_ref().unwrap();
    assert_eq!((&texture.file[..], texture.set), (&[1u8, 2, 3][..], 2));
    // A quarter turn counter-clockwise with v downwards takes u to −v.
    let expected = [[0.0, -2.0], [3.0, 0.0], [0.1, 0.2]];
    for (column, expected) in texture.transform.iter().zip(expected) {
        assert!(
            (0..2).all(|i| (column[i] - expected[i]).abs() < 1e-12),
            "{:?}",
            texture.transform
        );
    }
    assert_eq!(colours[2].texture, None);
    let broken = nodes.replace(r#""source":0"#, r#""source":7"#);
    let why = opened(&asset(&broken, "", &[]))
        .base_colours()
        .unwrap_err()
        .to_string();
    assert!(why.contains("textures[0].source"), "{why}");
}

/// That document with another primitive.
fn with_primitive(bytes: &[u8], primitive: &str) -> Vec<u8> {
    let (text, bin) = parts(bytes);
    glb(
        &text.replace(r#""attributes":{"POSITION":0}"#, primitive),
        &bin,
    )
}

/// Matrices may bring vertices anywhere: what is no place is an error, in the box of the scene and in the scene as one mesh. Found by fuzzing.
#[test]
fn vertices_that_are_shown_nowhere_are_refused() {
    let top = r#""extensionsUsed":["EXT_mesh_gpu_instancing"],"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}}}],
        "buffers":[{"byteLength":48}],
        "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12}],
        "accessors":[{"count":3,"type":"VEC3","componentType":5126,"bufferView":0},
            {"count":1,"type":"VEC3","componentType":5126,"bufferView":1}]"#;
    let text = super::support::document(top, r#""attributes":{"POSITION":0}"#);
    let corners = [
        0f32,
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        f32::NAN,
        0.0,
        0.0,
    ];
    let bin: Vec<u8> = corners.iter().flat_map(|x| x.to_le_bytes()).collect();
    let asset = limitmesh_io::Asset::from_bytes(&super::support::glb(&text, &bin), None).unwrap();
    for error in [
        asset.bounding_box().unwrap_err(),
        asset.scene_soup().unwrap_err(),
    ] {
        let error = error.to_string();
        assert!(
            error.contains("the scene") && error.contains("finite coordinates"),
            "{error}"
        );
    }
}
