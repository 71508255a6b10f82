//! Damaged documents: errors name the place as JavaScript would, the value met and what was expected, and make no room
//! for what the document merely claims.

use super::support::{complaint, document, glb};
use limitmesh_io::Asset;

/// What is said of a sound triangle in which some text is replaced.
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
        ("\"POSITION\":0", "\"POSITION\":9", format!("{position}: met 9, expected an index below 2, the number of accessors")),
        ("\"POSITION\":0", "\"POSITION\":-1", format!("{position}: met -1, expected a whole number from 0")),
        ("\"indices\":1", "\"indices\":0", "glTF accessors[0]: met an object, expected unsigned whole numbers, one an element".to_owned()),
        (
            "\"count\":3,\"type\":\"VEC3\"",
            "\"count\":4,\"type\":\"VEC3\"",
            format!(
                "{position} (accessors[0]): met 4 elements of 12 bytes, 12 apart, from byte 0, expected elements within the view's 36 bytes"
            ),
        ),
        (
            "\"count\":3,\"type\":\"VEC3\"",
            "\"count\":2147483648,\"type\":\"VEC3\"",
            format!(
                "{position} (accessors[0]): met 2147483648 elements of 12 bytes, 12 apart, from byte 0, expected elements within the view's 36 bytes"
            ),
        ),
        (
            "\"count\":3,\"type\":\"VEC3\"",
            "\"count\":99999999999,\"type\":\"VEC3\"",
            "glTF accessors[0].count: met 99999999999, expected at most 4294967295".to_owned(),
        ),
        ("5126", "5124", "glTF accessors[0].componentType: met 5124, expected 5120, 5121, 5122, 5123, 5125 or 5126".to_owned()),
        ("VEC3", "VEC9", "glTF accessors[0].type: met \"VEC9\", expected SCALAR, VEC2, VEC3, VEC4, or MAT4 of 32-bit numbers".to_owned()),
        (
            "\"byteLength\":36",
            "\"byteLength\":36,\"byteStride\":0",
            format!("{position} (bufferViews[0].byteStride): met 0, expected at least 4"),
        ),
        (
            "\"byteLength\":36",
            "\"byteLength\":36,\"byteStride\":8",
            format!("{position} (accessors[0]): met elements of 12 bytes in a view with a stride of 8, expected a stride no smaller"),
        ),
        (
            "\"byteOffset\":36",
            "\"byteOffset\":18446744073709551615",
            "glTF meshes[0].primitives[0].indices (bufferViews[1]): met 3 bytes from byte 18446744073709551615, expected bytes within its buffer of 39".to_owned(),
        ),
        (
            "\"byteLength\":39",
            "\"byteLength\":41",
            format!("{position} (buffers[0].byteLength): met 41, expected at most 40, the length of the GLB's binary chunk"),
        ),
        (
            "{\"byteLength\":39}",
            "{\"byteLength\":39,\"uri\":\"../secret.bin\"}",
            format!("{position} (buffers[0].uri): met \"../secret.bin\", expected a path below the document's folder"),
        ),
        (
            "{\"byteLength\":39}",
            "{\"byteLength\":39,\"uri\":\"http://example.com/a.bin\"}",
            format!("{position} (buffers[0].uri): met \"http://example.com/a.bin\", expected a path below the document's folder"),
        ),
        (
            "{\"byteLength\":39}",
            "{\"byteLength\":39,\"uri\":\"a.bin\"}",
            format!("{position} (buffers[0].uri): met 'a.bin', which cannot be read: the document has no folder, expected a file beside the document"),
        ),
        (
            "{\"byteLength\":39}",
            "{\"byteLength\":1073741824,\"uri\":\"data:;base64,AAAA\"}",
            format!("{position} (buffers[0].byteLength): met 1073741824, expected at most 3, the bytes there are"),
        ),
        ("\"version\":\"2.0\"", "\"version\":\"1.0\"", "glTF asset.version: met \"1.0\", expected 2.0".to_owned()),
        ("\"indices\":1", "\"indices\":1,\"mode\":7", "glTF meshes[0].primitives[0].mode: met 7, expected 0 to 6".to_owned()),
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
        "glTF meshes[0].primitives[0].indices: met index 3 in element 2, expected indices below 3, the number of vertices"
    );
    bin[38] = 2;
    bin[16..20].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert_eq!(
        complaint(&glb(&json, &bin)),
        "glTF meshes[0].primitives[0].attributes.POSITION: met inf in element 1, expected a finite number"
    );
}

#[test]
fn nodes_form_trees() {
    let refused = |nodes: &str| {
        let json = format!(r#"{{"asset":{{"version":"2.0"}},"nodes":{nodes}}}"#);
        Asset::from_bytes(json.as_bytes(), None).expect_err("a flaw").to_string()
    };
    assert_eq!(
        refused(r#"[{"children":[1]},{"children":[0]}]"#),
        "glTF nodes[0]: met a circle of children, expected a node that is not below itself"
    );
    assert_eq!(
        refused(r#"[{"children":[2]},{"children":[2]},{}]"#),
        "glTF nodes[1].children[0]: met 2, expected a node that is no child of another"
    );
    assert_eq!(
        refused(r#"[{"children":[5]}]"#),
        "glTF nodes[0].children[0]: met 5, expected an index below 1, the number of nodes"
    );
    assert_eq!(refused(r#"[{"scale":[1,2]}]"#), "glTF nodes[0].scale: met an array of 2, expected 3 numbers");
    // A chain as deep as it is long is none of the stack's business.
    let chain: Vec<String> = (1..100_000).map(|child| format!(r#"{{"children":[{child}]}}"#)).collect();
    let json = format!(r#"{{"asset":{{"version":"2.0"}},"nodes":[{},{{}}]}}"#, chain.join(","));
    assert!(Asset::from_bytes(json.as_bytes(), None).is_ok());
}

#[test]
fn containers() {
    let refused = |bytes: &[u8]| Asset::from_bytes(bytes, None).expect_err("a flaw").to_string();
    let sound = glb(r#"{"asset":{"version":"2.0"}}"#, &[1, 2, 3, 4]);
    assert!(Asset::from_bytes(&sound, None).is_ok());
    let changed = |at: usize, word: u32| {
        let mut bytes = sound.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        refused(&bytes)
    };
    assert_eq!(changed(4, 1), "glTF the GLB header: met version 1, expected 2");
    assert_eq!(
        changed(8, 4_000_000_000),
        format!(
            "glTF the GLB header: met a length of 4000000000 bytes in a file of {}, expected the file's length",
            sound.len()
        )
    );
    assert_eq!(
        changed(12, 4_000_000_000),
        "glTF chunk 0 of the GLB, at byte 12: met a length of 4000000000 bytes with 40 left, expected a chunk within the file"
    );
    assert_eq!(
        changed(16, 7),
        "glTF chunk 0 of the GLB, at byte 12: met the kind 0x00000007, expected JSON first"
    );
    assert_eq!(refused(b"glTF"), "glTF the GLB: met 4 bytes, expected at least 12");
    assert_eq!(refused(b"[]"), "glTF the document: met an array of 0, expected an object");
    assert_eq!(refused(b"{}"), "glTF the document: met no 'asset', expected one, which it needs");
    assert!(refused(b"{\"asset\":").starts_with("glTF the JSON text: met EOF while parsing"));
    let deep = "[".repeat(100_000);
    assert!(refused(deep.as_bytes()).contains("recursion limit"));
}
