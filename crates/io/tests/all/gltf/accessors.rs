//! Every component type, stride and sparse value, from bytes that are written here.

use super::support::{document, floats, glb, mesh};

/// The positions of three vertices, whose accessor and view have these members.
fn positions(accessor: &str, view: &str, bin: &[u8]) -> Vec<[f64; 3]> {
    let length = bin.len();
    let top = format!(
        r#""buffers":[{{"byteLength":{length}}}],"bufferViews":[{{"buffer":0,"byteLength":{length}{view}}}],
           "accessors":[{{"count":3,"type":"VEC3",{accessor}}}]"#
    );
    mesh(&glb(&document(&top, r#""attributes":{"POSITION":0}"#), bin))
        .soup
        .positions
}

#[test]
fn component_types() {
    let view = r#""bufferView":0"#;
    let bytes = [0, 1, 127, 128, 129, 255, 2, 3, 4];
    let of = |kind: u32, rest: &str, bin: &[u8]| {
        positions(&format!(r#"{view},"componentType":{kind}{rest}"#), "", bin)
    };
    assert_eq!(
        of(5120, "", &bytes),
        [[0.0, 1.0, 127.0], [-128.0, -127.0, -1.0], [2.0, 3.0, 4.0]]
    );
    assert_eq!(
        of(5121, "", &bytes),
        [[0.0, 1.0, 127.0], [128.0, 129.0, 255.0], [2.0, 3.0, 4.0]]
    );
    let normalized = r#","normalized":true"#;
    assert_eq!(
        of(5120, normalized, &bytes),
        [
            [0.0, 1.0 / 127.0, 1.0],
            [-1.0, -1.0, -1.0 / 127.0],
            [2.0 / 127.0, 3.0 / 127.0, 4.0 / 127.0]
        ]
    );
    assert_eq!(
        of(5121, normalized, &bytes)[1],
        [128.0 / 255.0, 129.0 / 255.0, 1.0]
    );
    let words: Vec<u8> = [0u16, 1, 32767, 32768, 32769, 65535, 2, 3, 4]
        .iter()
        .flat_map(|w| w.to_le_bytes())
        .collect();
    assert_eq!(
        of(5122, "", &words),
        [
            [0.0, 1.0, 32767.0],
            [-32768.0, -32767.0, -1.0],
            [2.0, 3.0, 4.0]
        ]
    );
    assert_eq!(of(5123, "", &words)[1], [32768.0, 32769.0, 65535.0]);
    assert_eq!(
        of(5122, normalized, &words)[1],
        [-1.0, -1.0, -1.0 / 32767.0]
    );
    assert_eq!(
        of(5123, normalized, &words)[0],
        [0.0, 1.0 / 65535.0, 32767.0 / 65535.0]
    );
    let large: Vec<u8> = [0u32, 1, u32::MAX, 7, 8, 9, 2, 3, 4]
        .iter()
        .flat_map(|w| w.to_le_bytes())
        .collect();
    assert_eq!(of(5125, "", &large)[0], [0.0, 1.0, 4_294_967_295.0]);
    let real = floats(&[0.1, -2.5, 1e-30, 4.0, 5.0, 6.0, 7.0, 8.0, 3e38]);
    assert_eq!(
        of(5126, "", &real)[0],
        [f64::from(0.1f32), -2.5, f64::from(1e-30f32)]
    );
}

#[test]
fn offsets_and_strides() {
    // Two bytes before, and four behind each element of six.
    let mut bin = vec![99, 99];
    for element in 0..3u8 {
        for axis in 0..3u8 {
            bin.extend(u16::from(10 * element + axis).to_le_bytes());
        }
        bin.extend([99; 4]);
    }
    let found = positions(
        r#""bufferView":0,"byteOffset":2,"componentType":5123"#,
        r#","byteStride":10"#,
        &bin[..bin.len() - 4],
    );
    assert_eq!(
        found,
        [[0.0, 1.0, 2.0], [10.0, 11.0, 12.0], [20.0, 21.0, 22.0]]
    );
}

#[test]
fn without_a_view_there_are_zeros_that_sparse_values_replace() {
    let mut bin = vec![2, 0, 0, 0];
    bin.extend(floats(&[7.0, 8.0, 9.0]));
    let top = r#""buffers":[{"byteLength":16}],
        "bufferViews":[{"buffer":0,"byteLength":1},{"buffer":0,"byteOffset":4,"byteLength":12}],
        "accessors":[{"count":3,"type":"VEC3","componentType":5126,"sparse":{"count":1,
            "indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":1}}}]"#;
    let found = mesh(&glb(&document(top, r#""attributes":{"POSITION":0}"#), &bin));
    assert_eq!(
        found.soup.positions,
        [[0.0; 3], [7.0, 8.0, 9.0]],
        "two of three are one"
    );
    assert_eq!(found.soup.faces.get(0), [0, 0, 1]);
}

#[test]
fn data_uris_hold_buffers() {
    // Nine bytes 0 to 8.
    let top = r#""buffers":[{"byteLength":9,"uri":"data:application/octet-stream;base64,AAECAwQFBgcI"}],
        "bufferViews":[{"buffer":0,"byteLength":9}],
        "accessors":[{"count":3,"type":"VEC3","componentType":5121,"bufferView":0}]"#;
    let found = mesh(document(top, r#""attributes":{"POSITION":0}"#).as_bytes());
    assert_eq!(
        found.soup.positions,
        [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0], [6.0, 7.0, 8.0]]
    );
}

/// Corners of five vertices on the axis in the order of the indices, by mode.
fn faces(mode: u32, indices: &[u8]) -> Vec<Vec<f64>> {
    let mut bin: Vec<u8> = (0..5u8).flat_map(|x| [x, 0, 0]).collect();
    bin.extend(indices);
    let (length, count) = (bin.len(), indices.len());
    let top = format!(
        r#""buffers":[{{"byteLength":{length}}}],
        "bufferViews":[{{"buffer":0,"byteLength":15}},{{"buffer":0,"byteOffset":15,"byteLength":{count}}}],
        "accessors":[{{"count":5,"type":"VEC3","componentType":5121,"bufferView":0}},
            {{"count":{count},"type":"SCALAR","componentType":5121,"bufferView":1}}]"#
    );
    let primitive = format!(r#""attributes":{{"POSITION":0}},"indices":1,"mode":{mode}"#);
    let soup = mesh(&glb(&document(&top, &primitive), &bin)).soup;
    soup.faces
        .iter()
        .map(|face| {
            face.iter()
                .map(|&v| soup.positions[v as usize][0])
                .collect()
        })
        .collect()
}

#[test]
fn strips_and_fans_become_triangles() {
    assert_eq!(
        faces(4, &[0, 1, 2, 4, 3, 2]),
        [[0.0, 1.0, 2.0], [4.0, 3.0, 2.0]]
    );
    // The specification's windings.
    assert_eq!(
        faces(5, &[0, 1, 2, 3, 4]),
        [[0.0, 1.0, 2.0], [1.0, 3.0, 2.0], [2.0, 3.0, 4.0]]
    );
    assert_eq!(faces(6, &[0, 1, 2, 3]), [[1.0, 2.0, 0.0], [2.0, 3.0, 0.0]]);
    // What joins strips has no area.
    assert_eq!(
        faces(5, &[0, 1, 2, 2, 3, 4]),
        [[0.0, 1.0, 2.0], [2.0, 4.0, 3.0]]
    );
    assert!(faces(1, &[0, 1]).is_empty() && faces(0, &[0]).is_empty());
}
