//! Damaged documents: errors name the place as JavaScript would, what was expected and what was found, and make no room
//! for what the document merely claims.

use super::support::{complaint, document, glb, refused};
use crate::support::cases;
use limitmesh_io::Asset;

/// A sound triangle.
fn sound() -> String {
    let top = r#""buffers":[{"byteLength":39}],
        "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],
        "accessors":[{"count":3,"type":"VEC3","componentType":5126,"bufferView":0},
            {"count":3,"type":"SCALAR","componentType":5121,"bufferView":1}]"#;
    document(top, r#""attributes":{"POSITION":0},"indices":1"#)
}

/// The error on it where some text is replaced.
#[track_caller]
fn with(old: &str, new: &str) -> String {
    let sound = sound();
    assert!(sound.contains(old), "{old}");
    let mut bin = vec![0; 36];
    bin.extend([0, 1, 2]);
    complaint(&glb(&sound.replacen(old, new, 1), &bin))
}

#[test]
fn places_have_names() {
    let position = "glTF meshes[0].primitives[0].attributes.POSITION";
    let table = r#"
        "POSITION":0 | "POSITION":9 | @: expected an index below 2 (the number of accessors), found 9
        "POSITION":0 | "POSITION":-1 | @: expected a whole number from 0, found -1
        "indices":1 | "indices":0 | glTF accessors[0]: indices are unsigned whole numbers, one an element
        "count":3,"type":"VEC3" | "count":4,"type":"VEC3" | @ (accessors[0]): it has 4 elements of 12 bytes, 12 apart, from byte 0 on, but the view has 36 bytes
        "count":3,"type":"VEC3" | "count":2147483648,"type":"VEC3" | @ (accessors[0]): it has 2147483648 elements of 12 bytes, 12 apart, from byte 0 on, but the view has 36 bytes
        "count":3,"type":"VEC3" | "count":99999999999,"type":"VEC3" | glTF accessors[0].count: expected at most 4294967295, found 99999999999
        5126 | 5124 | glTF accessors[0].componentType: expected 5120, 5121, 5122, 5123, 5125 or 5126, found 5124
        VEC3 | VEC9 | glTF accessors[0].type: expected SCALAR, VEC2, VEC3, VEC4, or MAT4 of 32-bit numbers, found "VEC9"
        "byteLength":36 | "byteLength":36,"byteStride":0 | @ (bufferViews[0].byteStride): expected at least 4, found 0
        "byteLength":36 | "byteLength":36,"byteStride":8 | @ (accessors[0]): its elements of 12 bytes overlap: the view has a stride of 8
        "byteOffset":36 | "byteOffset":18446744073709551615 | glTF meshes[0].primitives[0].indices (bufferViews[1]): it names 3 bytes from byte 18446744073709551615 on, but its buffer has 39
        "byteLength":39 | "byteLength":41 | @ (buffers[0].byteLength): expected at most 40 (the length of the GLB's binary chunk), found 41
        {"byteLength":39} | {"byteLength":39,"uri":"../secret.bin"} | @ (buffers[0].uri): expected a path below the document's folder, found "../secret.bin"
        {"byteLength":39} | {"byteLength":39,"uri":"http://example.com/a.bin"} | @ (buffers[0].uri): expected a path below the document's folder, found "http://example.com/a.bin"
        {"byteLength":39} | {"byteLength":39,"uri":"a.bin"} | @ (buffers[0].uri): the file 'a.bin' cannot be read: the document has no folder
        {"byteLength":39} | {"byteLength":1073741824,"uri":"data:;base64,AAAA"} | @ (buffers[0].byteLength): expected at most 3 (the bytes that there are), found 1073741824
        "version":"2.0" | "version":"1.0" | glTF asset.version: expected 2.0, found "1.0"
        "indices":1 | "indices":1,"mode":7 | glTF meshes[0].primitives[0].mode: expected 0 to 6, found 7"#;
    for [old, new, expected] in cases(table) {
        assert_eq!(
            with(&old, &new),
            expected.replace('@', position),
            "{old} -> {new}"
        );
    }
}

#[test]
fn indices_and_numbers_out_of_range() {
    let json = sound();
    let mut bin = vec![0; 36];
    bin.extend([0, 1, 3]);
    assert_eq!(
        complaint(&glb(&json, &bin)),
        "glTF meshes[0].primitives[0].indices: expected indices below 3 (the number of vertices), found 3 in element 2"
    );
    bin[38] = 2;
    bin[16..20].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert_eq!(
        complaint(&glb(&json, &bin)),
        "glTF meshes[0].primitives[0].attributes.POSITION: expected a finite number, found inf in element 1"
    );
}

#[test]
fn nodes_form_trees() {
    let table = r#"
        [{"children":[1]},{"children":[0]}] | nodes[0]: the node is below itself
        [{"children":[2]},{"children":[2]},{}] | nodes[1].children[0]: expected a node that is no child of another, found 2
        [{"children":[5]}] | nodes[0].children[0]: expected an index below 1 (the number of nodes), found 5
        [{"scale":[1,2]}] | nodes[0].scale: expected 3 numbers, found an array of 2"#;
    for [nodes, expected] in cases(table) {
        let json = format!(r#"{{"asset":{{"version":"2.0"}},"nodes":{nodes}}}"#);
        assert_eq!(refused(json.as_bytes()), format!("glTF {expected}"));
    }
    // A chain as deep as it is long is none of the stack's business.
    let chain: Vec<String> = (1..100_000)
        .map(|child| format!(r#"{{"children":[{child}]}}"#))
        .collect();
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{},{{}}]}}"#,
        chain.join(",")
    );
    assert!(Asset::from_bytes(json.as_bytes(), None).is_ok());
}

#[test]
fn containers() {
    let sound = glb(r#"{"asset":{"version":"2.0"}}"#, &[1, 2, 3, 4]);
    assert!(Asset::from_bytes(&sound, None).is_ok());
    let changed = |at: usize, word: u32| {
        let mut bytes = sound.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        refused(&bytes)
    };
    let length = sound.len();
    let names = "it names a length of 4000000000 bytes, but";
    let first = "chunk 0 of the GLB, at byte 12";
    for (at, word, expected) in [
        (
            4,
            1,
            "the GLB header: expected version 2, found 1".to_owned(),
        ),
        (
            8,
            4_000_000_000,
            format!("the GLB header: {names} the file has {length}"),
        ),
        (12, 4_000_000_000, format!("{first}: {names} 40 are left")),
        (
            16,
            7,
            format!("{first}: expected JSON in the first chunk, found the kind 0x00000007"),
        ),
    ] {
        assert_eq!(changed(at, word), format!("glTF {expected}"));
    }
    for (text, expected) in [
        ("glTF", "the GLB: expected at least 12 bytes, found 4"),
        (
            "[]",
            "the document: expected an object, found an array of 0",
        ),
        ("{}", "the document: 'asset' is missing"),
    ] {
        assert_eq!(refused(text.as_bytes()), format!("glTF {expected}"));
    }
    assert!(
        refused(b"{\"asset\":")
            .starts_with("glTF the JSON text: it cannot be read: EOF while parsing")
    );
    let deep = "[".repeat(100_000);
    assert!(refused(deep.as_bytes()).contains("recursion limit"));
}
