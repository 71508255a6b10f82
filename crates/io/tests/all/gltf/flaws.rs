//! Damaged documents: errors name the place as JavaScript would, what was expected and what was found, and make no room
//! for what the document merely claims.

use super::support::{complaint, document, glb};
use limitmesh_io::Asset;

/// The error on a sound triangle in which some text is replaced.
#[track_caller]
fn with(old: &str, new: &str) -> String {
    let top = r#""buffers":[{"byteLength":39}],
        "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],
        "accessors":[{"count":3,"type":"VEC3","componentType":5126,"bufferView":0},
            {"count":3,"type":"SCALAR","componentType":5121,"bufferView":1}]"#;
    let sound = document(top, r#""attributes":{"POSITION":0},"indices":1"#);
    assert!(sound.contains(old), "{old}");
    let mut bin = vec![0; 36];
    bin.extend([0, 1, 2]);
    complaint(&glb(&sound.replacen(old, new, 1), &bin))
}

#[test]
fn places_have_names() {
    let position = "glTF meshes[0].primitives[0].attributes.POSITION";
    let cases = [
        ("\"POSITION\":0", "\"POSITION\":9", format!("{position}: expected an index below 2 (the number of accessors), found 9")),
        ("\"POSITION\":0", "\"POSITION\":-1", format!("{position}: expected a whole number from 0, found -1")),
        ("\"indices\":1", "\"indices\":0", "glTF accessors[0]: indices are unsigned whole numbers, one an element".to_owned()),
        (
            "\"count\":3,\"type\":\"VEC3\"",
            "\"count\":4,\"type\":\"VEC3\"",
            format!(
                "{position} (accessors[0]): it has 4 elements of 12 bytes, 12 apart, from byte 0 on, but the view has 36 bytes"
            ),
        ),
        (
            "\"count\":3,\"type\":\"VEC3\"",
            "\"count\":2147483648,\"type\":\"VEC3\"",
            format!(
                "{position} (accessors[0]): it has 2147483648 elements of 12 bytes, 12 apart, from byte 0 on, but the view has 36 bytes"
            ),
        ),
        (
            "\"count\":3,\"type\":\"VEC3\"",
            "\"count\":99999999999,\"type\":\"VEC3\"",
            "glTF accessors[0].count: expected at most 4294967295, found 99999999999".to_owned(),
        ),
        ("5126", "5124", "glTF accessors[0].componentType: expected 5120, 5121, 5122, 5123, 5125 or 5126, found 5124".to_owned()),
        ("VEC3", "VEC9", "glTF accessors[0].type: expected SCALAR, VEC2, VEC3, VEC4, or MAT4 of 32-bit numbers, found \"VEC9\"".to_owned()),
        (
            "\"byteLength\":36",
            "\"byteLength\":36,\"byteStride\":0",
            format!("{position} (bufferViews[0].byteStride): expected at least 4, found 0"),
        ),
        (
            "\"byteLength\":36",
            "\"byteLength\":36,\"byteStride\":8",
            format!("{position} (accessors[0]): its elements of 12 bytes overlap: the view has a stride of 8"),
        ),
        (
            "\"byteOffset\":36",
            "\"byteOffset\":18446744073709551615",
            "glTF meshes[0].primitives[0].indices (bufferViews[1]): it names 3 bytes from byte 18446744073709551615 on, but its buffer has 39".to_owned(),
        ),
        (
            "\"byteLength\":39",
            "\"byteLength\":41",
            format!("{position} (buffers[0].byteLength): expected at most 40 (the length of the GLB's binary chunk), found 41"),
        ),
        (
            "{\"byteLength\":39}",
            "{\"byteLength\":39,\"uri\":\"../secret.bin\"}",
            format!("{position} (buffers[0].uri): expected a path below the document's folder, found \"../secret.bin\""),
        ),
        (
            "{\"byteLength\":39}",
            "{\"byteLength\":39,\"uri\":\"http://example.com/a.bin\"}",
            format!("{position} (buffers[0].uri): expected a path below the document's folder, found \"http://example.com/a.bin\""),
        ),
        (
            "{\"byteLength\":39}",
            "{\"byteLength\":39,\"uri\":\"a.bin\"}",
            format!("{position} (buffers[0].uri): the file 'a.bin' cannot be read: the document has no folder"),
        ),
        (
            "{\"byteLength\":39}",
            "{\"byteLength\":1073741824,\"uri\":\"data:;base64,AAAA\"}",
            format!("{position} (buffers[0].byteLength): expected at most 3 (the bytes that there are), found 1073741824"),
        ),
        ("\"version\":\"2.0\"", "\"version\":\"1.0\"", "glTF asset.version: expected 2.0, found \"1.0\"".to_owned()),
        ("\"indices\":1", "\"indices\":1,\"mode\":7", "glTF meshes[0].primitives[0].mode: expected 0 to 6, found 7".to_owned()),
    ];
    for (old, new, expected) in cases {
        assert_eq!(with(old, new), expected, "{old} -> {new}");
    }
}

#[test]
fn indices_and_numbers_out_of_range() {
    let top = r#""buffers":[{"byteLength":39}],
        "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],
        "accessors":[{"count":3,"type":"VEC3","componentType":5126,"bufferView":0},
            {"count":3,"type":"SCALAR","componentType":5121,"bufferView":1}]"#;
    let json = document(top, r#""attributes":{"POSITION":0},"indices":1"#);
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
    let refused = |nodes: &str| {
        let json = format!(r#"{{"asset":{{"version":"2.0"}},"nodes":{nodes}}}"#);
        Asset::from_bytes(json.as_bytes(), None)
            .expect_err("a flaw")
            .to_string()
    };
    assert_eq!(
        refused(r#"[{"children":[1]},{"children":[0]}]"#),
        "glTF nodes[0]: the node is below itself"
    );
    assert_eq!(
        refused(r#"[{"children":[2]},{"children":[2]},{}]"#),
        "glTF nodes[1].children[0]: expected a node that is no child of another, found 2"
    );
    assert_eq!(
        refused(r#"[{"children":[5]}]"#),
        "glTF nodes[0].children[0]: expected an index below 1 (the number of nodes), found 5"
    );
    assert_eq!(
        refused(r#"[{"scale":[1,2]}]"#),
        "glTF nodes[0].scale: expected 3 numbers, found an array of 2"
    );
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
    let refused = |bytes: &[u8]| {
        Asset::from_bytes(bytes, None)
            .expect_err("a flaw")
            .to_string()
    };
    let sound = glb(r#"{"asset":{"version":"2.0"}}"#, &[1, 2, 3, 4]);
    assert!(Asset::from_bytes(&sound, None).is_ok());
    let changed = |at: usize, word: u32| {
        let mut bytes = sound.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        refused(&bytes)
    };
    assert_eq!(
        changed(4, 1),
        "glTF the GLB header: expected version 2, found 1"
    );
    assert_eq!(
        changed(8, 4_000_000_000),
        format!(
            "glTF the GLB header: it names a length of 4000000000 bytes, but the file has {}",
            sound.len()
        )
    );
    assert_eq!(
        changed(12, 4_000_000_000),
        "glTF chunk 0 of the GLB, at byte 12: it names a length of 4000000000 bytes, but 40 are left"
    );
    assert_eq!(
        changed(16, 7),
        "glTF chunk 0 of the GLB, at byte 12: expected JSON in the first chunk, found the kind 0x00000007"
    );
    assert_eq!(
        refused(b"glTF"),
        "glTF the GLB: expected at least 12 bytes, found 4"
    );
    assert_eq!(
        refused(b"[]"),
        "glTF the document: expected an object, found an array of 0"
    );
    assert_eq!(refused(b"{}"), "glTF the document: 'asset' is missing");
    assert!(
        refused(b"{\"asset\":")
            .starts_with("glTF the JSON text: it cannot be read: EOF while parsing")
    );
    let deep = "[".repeat(100_000);
    assert!(refused(deep.as_bytes()).contains("recursion limit"));
}
