//! Documents put together by hand, and a reader of GLBs that shares nothing with the library's.

use limitmesh_io::Asset;
use limitmesh_io::gltf::{Geometry, Joining, MeshSoup};
use serde_json::Value;

/// A GLB of a JSON text and a buffer.
pub(crate) fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend((28 + text.len() as u32 + bin.len() as u32).to_le_bytes());
    out.extend((text.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    out.extend(text);
    out.extend((bin.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(bin);
    out
}

/// JSON text and binary chunk of a GLB.
pub(crate) fn parts(glb: &[u8]) -> (String, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
    let text = String::from_utf8(glb[20..20 + word(12)].to_vec()).unwrap();
    let bin = 20 + word(12);
    let bytes = if bin < glb.len() {
        glb[bin + 8..bin + 8 + word(bin)].to_vec()
    } else {
        Vec::new()
    };
    (text, bytes)
}

/// A document with one primitive: members of the document apart from meshes, and of the primitive.
pub(crate) fn document(top: &str, primitive: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{{{primitive}}}]}}],{top}}}"#
    )
}

/// Little-endian bytes of 32-bit floats.
pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

pub(crate) fn mesh(bytes: &[u8]) -> MeshSoup {
    Asset::from_bytes(bytes, None)
        .unwrap()
        .mesh(0, Joining::Together)
        .unwrap()
}

/// The error on a mesh, or on the document.
#[track_caller]
pub(crate) fn complaint(bytes: &[u8]) -> String {
    match Asset::from_bytes(bytes, None).and_then(|asset| asset.mesh(0, Joining::Together)) {
        Ok(mesh) => panic!("read {} vertices", mesh.soup.positions.len()),
        Err(error) => error.to_string(),
    }
}

/// Triangles of floats as they stand in a written GLB: the positions by accessor, the corners by index.
pub(crate) fn triangles_of(glb: &[u8], mesh: usize, primitive: usize) -> Vec<[[f32; 3]; 3]> {
    let (text, bin) = parts(glb);
    let json: Value = serde_json::from_str(&text).unwrap();
    let primitive = &json["meshes"][mesh]["primitives"][primitive];
    let bytes = |accessor: &Value| {
        let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        assert_eq!(view["buffer"], 0);
        let start = view["byteOffset"].as_u64().unwrap() as usize;
        bin[start..start + view["byteLength"].as_u64().unwrap() as usize].to_vec()
    };
    let position =
        &json["accessors"][primitive["attributes"]["POSITION"].as_u64().unwrap() as usize];
    assert_eq!(
        (&position["componentType"], &position["type"]),
        (&Value::from(5126), &Value::from("VEC3"))
    );
    let numbers: Vec<f32> = bytes(position)
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes(b.try_into().unwrap()))
        .collect();
    let points: Vec<[f32; 3]> = numbers
        .chunks_exact(3)
        .map(|p| p.try_into().unwrap())
        .collect();
    assert_eq!(position["count"], points.len());
    for axis in 0..3 {
        let all = || points.iter().map(|p| f64::from(p[axis]));
        assert_eq!(
            position["min"][axis].as_f64(),
            all().reduce(f64::min),
            "exact bounds"
        );
        assert_eq!(
            position["max"][axis].as_f64(),
            all().reduce(f64::max),
            "exact bounds"
        );
    }
    let indices = &json["accessors"][primitive["indices"].as_u64().unwrap() as usize];
    let corners: Vec<usize> = match indices["componentType"].as_u64() {
        Some(5123) => bytes(indices)
            .chunks_exact(2)
            .map(|b| usize::from(b[0]) + 256 * usize::from(b[1]))
            .collect(),
        Some(5125) => bytes(indices)
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes(b.try_into().unwrap()) as usize)
            .collect(),
        other => panic!("{other:?}"),
    };
    assert_eq!(indices["count"], corners.len());
    corners
        .chunks_exact(3)
        .map(|c| [points[c[0]], points[c[1]], points[c[2]]])
        .collect()
}

/// Triangles without anything else.
pub(crate) fn plain<'a>(positions: &'a [[f64; 3]], triangles: &'a [[u32; 3]]) -> Geometry<'a> {
    Geometry {
        positions,
        normals: None,
        triangles,
        attributes: &[],
        targets: &[],
    }
}

/// One triangle.
pub(crate) const TRIANGLE: Geometry<'_> = Geometry {
    positions: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    normals: None,
    triangles: &[[0, 1, 2]],
    attributes: &[],
    targets: &[],
};

/// Why an asset is none.
#[track_caller]
pub(crate) fn refused(bytes: &[u8]) -> String {
    let asset = Asset::from_bytes(bytes, None);
    asset.expect_err("a flaw").to_string()
}
