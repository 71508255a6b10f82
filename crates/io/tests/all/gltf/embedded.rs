//! Images in files that a GLB names, put into it.

use limitmesh_io::gltf::with_images;
use serde_json::Value;

use super::support::{document, glb, parts};

const PNG: &[u8] = b"\x89PNG and five";

#[test]
fn images_of_the_folder_are_in_the_file_and_all_else_stays() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a picture.png"), PNG).unwrap();
    std::fs::write(folder.path().join("text.png"), b"none").unwrap();
    let top = r#""buffers":[{"byteLength":5}],"bufferViews":[{"buffer":0,"byteLength":5}],
        "images":[{"uri":"missing.png"},{"uri":"a%20picture.png","name":"it"},{"uri":"text.png"},{"uri":"../a picture.png"}]"#;
    let before = glb(&document(top, ""), b"bytes");
    let (text, bin) = parts(&with_images(&before, folder.path()).unwrap());
    let after: Value = serde_json::from_str(&text).unwrap();
    let image = &after["images"][1];
    assert_eq!(image["name"], "it");
    assert_eq!(image["mimeType"], "image/png");
    assert!(image["uri"].is_null());
    let view = &after["bufferViews"][image["bufferView"].as_u64().unwrap() as usize];
    let [at, length] = ["byteOffset", "byteLength"].map(|name| view[name].as_u64().unwrap());
    assert_eq!(&bin[at as usize..][..length as usize], PNG);
    assert_eq!(&bin[..5], b"bytes");
    assert_eq!(after["buffers"][0]["byteLength"], at + length);
    for other in [0, 2, 3] {
        assert!(after["images"][other]["uri"].is_string(), "{other}");
    }
}

#[test]
fn without_such_images_it_is_the_same_file_and_what_is_none_is_refused() {
    let folder = std::path::Path::new("");
    let plain = glb(&document(r#""images":[{"uri":"data:,"}]"#, ""), b"bytes");
    assert_eq!(with_images(&plain, folder).unwrap(), plain);
    for bytes in [&b""[..], b"glTF", b"[]"] {
        assert!(with_images(bytes, folder).is_err(), "{bytes:?}");
    }
}
