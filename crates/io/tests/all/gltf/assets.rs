//! Files that other programs wrote: each is read, or refused by a flaw that names the place; and edits keep the rest.

use super::support::plain;
use crate::support::shared;
use limitmesh_io::gltf::Joining;
use limitmesh_io::{Asset, Format};
use serde_json::Value;
use std::path::PathBuf;

fn files() -> Vec<PathBuf> {
    let Some(folder) = shared("assets") else {
        return vec![];
    };
    let all = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = all
        .filter(|path| Format::from_path(path).is_ok_and(Format::is_gltf))
        .collect();
    files.sort();
    files
}

/// The flaws of files that are damaged, or whose other files are not there.
const REFUSED: [(&str, &str); 9] = [
    (
        "BoxWithInfinites.glb",
        "meshes[0].primitives[0].attributes.POSITION: expected a finite number, found -inf in element 0",
    ),
    ("IndexOutOfRange.gltf", "buffers[0].uri"),
    ("Mesh_PrimitiveMode_05.gltf", "buffers[0].uri"),
    ("Mesh_PrimitiveMode_06.gltf", "buffers[0].uri"),
    ("RecursiveNodes.gltf", "nodes[0]: the node is below itself"),
    ("SimpleMorph.gltf", "buffers[0].uri"),
    ("TestScene.gltf", "buffers[0].uri"),
    (
        "badArray.gltf",
        "meshes[0].primitives: expected an array, found an object",
    ),
    ("badUint.gltf", "buffers[0].uri"),
];

#[test]
fn each_file_is_read_or_refused_by_place() {
    for file in files() {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let read =
            Asset::open(&file).and_then(|asset| Ok((asset.scene_soup()?, asset.contents()?)));
        let refused = REFUSED.iter().find(|(own, _)| *own == name);
        match (read, refused) {
            (Ok((soup, contents)), None) => {
                assert!(
                    !soup.faces.is_empty() && !contents.meshes.is_empty(),
                    "{name} is empty"
                );
            }
            (Ok(_), Some(_)) => panic!("{name} is read"),
            (Err(error), Some((_, part))) => {
                let text = error.to_string();
                assert!(text.contains(part), "{text}");
                assert!(text.contains(&name), "{text}");
            }
            (Err(error), None) => panic!("{error}"),
        }
    }
}

/// The document without what may change.
fn rest(mut json: Value, (views, accessors, buffers): (usize, usize, usize)) -> Value {
    for mesh in json["meshes"].as_array_mut().into_iter().flatten() {
        for primitive in mesh["primitives"].as_array_mut().into_iter().flatten() {
            let members = primitive.as_object_mut().unwrap();
            for key in ["attributes", "indices", "targets", "mode"] {
                members.remove(key);
            }
        }
    }
    for (key, count) in [
        ("bufferViews", views),
        ("accessors", accessors),
        ("buffers", buffers),
    ] {
        json[key].as_array_mut().unwrap().truncate(count);
    }
    if let Some(first) = json["buffers"][0].as_object_mut() {
        first.remove("byteLength");
        first.remove("uri");
    }
    json
}

/// A document without the names of how geometry is stored, and where views are if they were compressed: `extensions.rs` looks at these.
fn without_storage(mut json: Value, is_compressed: bool) -> Value {
    const STORAGE: [&str; 3] = [
        "EXT_meshopt_compression",
        "KHR_mesh_quantization",
        "FB_ngon_encoding",
    ];
    for key in ["extensionsUsed", "extensionsRequired"] {
        let Some(list) = json.get_mut(key).and_then(Value::as_array_mut) else {
            continue;
        };
        list.retain(|name| !STORAGE.iter().any(|own| name == own));
        if list.is_empty() {
            json.as_object_mut().unwrap().remove(key);
        }
    }
    if !is_compressed {
        return json;
    }
    json["buffers"].as_array_mut().unwrap().truncate(1);
    for view in json["bufferViews"].as_array_mut().unwrap() {
        view.as_object_mut()
            .unwrap()
            .retain(|key, _| !["buffer", "byteOffset", "extensions"].contains(&&key[..]));
    }
    json
}

/// Two documents without the accessors and views that only the first has the bytes of, none of which anything names, and without the places of
/// others: `unused.rs` looks at their bytes.
fn without_unused([mut old, mut new]: [Value; 2]) -> [Value; 2] {
    let moving = ["animations", "skins"]
        .map(|key| new[key].to_string())
        .concat();
    let count = |json: &Value, key: &str| json[key].as_array().map_or(0, Vec::len);
    for i in 0..count(&new, "accessors") {
        let has_view = |json: &Value| json["accessors"][i].get("bufferView").is_some();
        if has_view(&old) && !has_view(&new) {
            let names =
                ["input", "output", "inverseBindMatrices"].map(|key| format!("\"{key}\":{i}"));
            assert!(
                names
                    .iter()
                    .all(|name| !moving.contains(&format!("{name},"))
                        && !moving.contains(&format!("{name}}}")))
            );
            for json in [&mut old, &mut new] {
                json["accessors"][i].take();
            }
        }
    }
    let users = format!("{}{}", new["accessors"], new["images"]);
    for i in 0..count(&new, "bufferViews") {
        if old["bufferViews"][i]["byteLength"] != 1 && new["bufferViews"][i]["byteLength"] == 1 {
            let is_named = |end: &str| users.contains(&format!("\"bufferView\":{i}{end}"));
            assert!(!is_named(",") && !is_named("}"), "view {i} of {users}");
            for json in [&mut old, &mut new] {
                json["bufferViews"][i].take();
            }
        }
        for json in [&mut old, &mut new] {
            json["bufferViews"][i]
                .as_object_mut()
                .and_then(|view| view.remove("byteOffset"));
        }
    }
    [old, new]
}

#[test]
fn edits_touch_only_what_may_change() {
    for file in files() {
        let Ok(mut asset) = Asset::open(&file) else {
            continue;
        };
        let original = std::fs::read(&file).unwrap();
        let text = match original.strip_prefix(b"glTF") {
            Some(_) => super::support::parts(&original).0,
            None => String::from_utf8(original).unwrap(),
        };
        if text.contains("KHR_draco") {
            // The extension goes: the next test, and `extensions.rs`.
            continue;
        }
        let mut changed = 0;
        for mesh in 0..asset.mesh_count() {
            let Ok(own) = asset.mesh(mesh, Joining::Together) else {
                continue;
            };
            for part in &own.parts {
                let triangles: Vec<[u32; 3]> = part
                    .faces
                    .clone()
                    .map(|face| own.soup.faces.get(face).try_into().unwrap())
                    .collect();
                let positions = &own.soup.positions;
                asset
                    .replace(mesh, part.primitive, &plain(positions, &triangles))
                    .unwrap();
                changed += 1;
            }
        }
        let json: Value = serde_json::from_str(&text).unwrap();
        let count = |key: &str| json[key].as_array().map_or(0, Vec::len);
        let counts = (count("bufferViews"), count("accessors"), count("buffers"));
        if changed == 0 {
            continue;
        }
        let new = asset.to_bytes(Format::Gltf).unwrap();
        let new: Value = serde_json::from_slice(&new).unwrap();
        let is_compressed = text.contains("EXT_meshopt_compression");
        let [old, new] = without_unused(
            [json, new].map(|own| without_storage(rest(own, counts), is_compressed)),
        );
        assert_eq!(new, old, "{}", file.display());
        // What was written shows the same triangles.
        let again =
            Asset::from_bytes(&asset.to_bytes(Format::Glb).unwrap(), file.parent()).unwrap();
        for mesh in 0..asset.mesh_count() {
            let (Ok(old), Ok(new)) = (
                asset.mesh(mesh, Joining::Never),
                again.mesh(mesh, Joining::Never),
            ) else {
                continue;
            };
            let corners = |soup: &limitmesh::PolygonSoup| -> Vec<[f32; 3]> {
                let all = soup.faces.iter().flatten();
                all.map(|&v| soup.positions[v as usize].map(|x| x as f32))
                    .collect()
            };
            assert_eq!(corners(&old.soup), corners(&new.soup), "{}", file.display());
        }
    }
}

#[test]
fn compressed_meshes_are_those_that_were_compressed() {
    // The same box three times, by three writers: plain, Draco, meshopt.
    let Some(uncompressed) = shared("assets/BoxInterleaved.glb") else {
        return;
    };
    let sizes = |path: PathBuf| {
        let [low, high] = Asset::open(&path).unwrap().bounding_box().unwrap().unwrap();
        [0, 1, 2].map(|i| ((high[i] - low[i]) * 1e3).round() / 1e3)
    };
    let folder = uncompressed.parent().unwrap().to_owned();
    for name in ["BoxDraco.gltf", "BoxMeshopt.glb"] {
        let mesh = Asset::open(&folder.join(name))
            .unwrap()
            .mesh(0, Joining::Together)
            .unwrap();
        assert_eq!(
            (mesh.soup.positions.len(), mesh.soup.faces.len()),
            (8, 12),
            "{name}"
        );
        assert_eq!(
            sizes(folder.join(name)),
            sizes(uncompressed.clone()),
            "{name}"
        );
    }
    // What was Draco is not any more, and nothing says that it were.
    let mut asset = Asset::open(&folder.join("BoxDraco.gltf")).unwrap();
    let own = asset.mesh(0, Joining::Together).unwrap();
    let triangles: Vec<[u32; 3]> = own
        .soup
        .faces
        .iter()
        .map(|face| face.try_into().unwrap())
        .collect();
    asset
        .replace(0, 0, &plain(&own.soup.positions, &triangles))
        .unwrap();
    let text = String::from_utf8(asset.to_bytes(Format::Gltf).unwrap()).unwrap();
    assert!(
        !text.contains("draco") && !text.contains("extensions"),
        "{text}"
    );
}
