//! glTF assets put together by hand, and a reader of what is written that shares nothing with the library's.

use crate::common::{bytes, count, json_file, words};
use std::path::Path;

use limitmesh::mesh::{PolygonFaces, PolygonSoup};
use limitmesh::{Mesh, Triangles};
use serde_json::{Value, json};

/// An asset that grows: bytes, and views and accessors that name them.
pub(crate) struct Builder {
    bytes: Vec<u8>,
    pub(crate) json: Value,
}

impl Builder {
    /// With a node that has the only mesh.
    pub(crate) fn new() -> Self {
        let json = json!({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": []}], "bufferViews": [], "accessors": []});
        Self {
            bytes: Vec::new(),
            json,
        }
    }

    fn push(&mut self, key: &str, value: Value) -> usize {
        let list = self.json[key].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    pub(crate) fn view(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let view =
            json!({"buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start});
        self.push("bufferViews", view)
    }

    /// An accessor of floats, `width` an element.
    pub(crate) fn floats(&mut self, values: &[f32], width: usize) -> usize {
        let view = self.view(values.iter().flat_map(|x| x.to_le_bytes()));
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"][(width - 1).min(4)];
        let mut accessor = json!({"bufferView": view, "componentType": 5126, "count": values.len() / width, "type": kind});
        if width == 3 {
            let of = |i: usize| values.iter().skip(i).step_by(3).copied();
            accessor["min"] = (0..3)
                .map(|i| of(i).fold(f32::INFINITY, f32::min))
                .collect();
            accessor["max"] = (0..3)
                .map(|i| of(i).fold(f32::NEG_INFINITY, f32::max))
                .collect();
        }
        self.push("accessors", accessor)
    }

    pub(crate) fn points(&mut self, points: &[[f32; 3]]) -> usize {
        self.floats(points.as_flattened(), 3)
    }

    /// An accessor of any kind.
    pub(crate) fn accessor(&mut self, accessor: Value) -> usize {
        self.push("accessors", accessor)
    }

    pub(crate) fn indices(&mut self, triangles: &[[u32; 3]]) -> usize {
        let corners = triangles.as_flattened();
        let view = self.view(corners.iter().flat_map(|&v| (v as u16).to_le_bytes()));
        self.accessor(
            json!({"bufferView": view, "componentType": 5123, "count": corners.len(), "type": "SCALAR"}),
        )
    }

    /// Four bytes a vertex.
    pub(crate) fn joints(&mut self, joints: &[[u8; 4]]) -> usize {
        let view = self.view(joints.iter().flatten().copied());
        self.accessor(
            json!({"bufferView": view, "componentType": 5121, "count": joints.len(), "type": "VEC4"}),
        )
    }

    pub(crate) fn primitive(&mut self, primitive: Value) {
        let list = self.json["meshes"][0]["primitives"]
            .as_array_mut()
            .expect("a list");
        list.push(primitive);
    }

    /// Writes it as a GLB.
    pub(crate) fn write(&self, path: &Path) {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bytes.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let mut out = b"glTF\x02\0\0\0".to_vec();
        out.extend((28 + text.len() as u32 + bin.len() as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", text), (b"BIN\0", bin)] {
            out.extend((chunk.len() as u32).to_le_bytes());
            out.extend(kind);
            out.extend(chunk);
        }
        std::fs::write(path, out).expect("writable");
    }
}

/// A GLB that was written.
pub(crate) struct Glb {
    pub(crate) json: Value,
    bytes: Vec<u8>,
}

impl Glb {
    pub(crate) fn read(path: &Path) -> Self {
        let glb = bytes(path);
        let word =
            |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().expect("four")) as usize;
        assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
        let json = serde_json::from_slice(&glb[20..20 + word(12)]).expect("JSON");
        let bin = 20 + word(12);
        Self {
            json,
            bytes: glb[bin + 8..bin + 8 + word(bin)].to_vec(),
        }
    }

    /// A text document, without the bytes of its buffers.
    pub(crate) fn text(path: &Path) -> Self {
        let json = json_file(path);
        Self {
            json,
            bytes: Vec::new(),
        }
    }

    /// The binary chunk.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The numbers of an accessor, one element after the other. Bounds that it has are checked.
    pub(crate) fn numbers(&self, accessor: &Value) -> Vec<f64> {
        let accessor = &self.json["accessors"][count(accessor) as usize];
        let view = &self.json["bufferViews"][count(&accessor["bufferView"]) as usize];
        let whole = |value: &Value| value.as_u64().unwrap_or(0) as usize;
        let width = match words(&accessor["type"]) {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        let size = match whole(&accessor["componentType"]) {
            5121 => 1,
            5123 => 2,
            _ => 4,
        };
        let start = whole(&view["byteOffset"]) + whole(&accessor["byteOffset"]);
        let stride = view["byteStride"]
            .as_u64()
            .map_or(width * size, |stride| stride as usize);
        let mut values = Vec::new();
        for element in 0..whole(&accessor["count"]) {
            for i in 0..width {
                let at = start + element * stride + i * size;
                let own = &self.bytes[at..at + size];
                values.push(match accessor["componentType"].as_u64() {
                    Some(5126) => f64::from(f32::from_le_bytes(own.try_into().expect("four"))),
                    Some(5121) => f64::from(own[0]),
                    Some(5123) => f64::from(u16::from_le_bytes(own.try_into().expect("two"))),
                    _ => f64::from(u32::from_le_bytes(own.try_into().expect("four"))),
                });
            }
        }
        for (key, of) in [("min", f64::min as fn(f64, f64) -> f64), ("max", f64::max)] {
            for (i, bound) in accessor[key].as_array().into_iter().flatten().enumerate() {
                let found = values.iter().skip(i).step_by(width).copied().reduce(of);
                // The last place of a double is the JSON reader's.
                assert_eq!(
                    bound.as_f64().map(|x| x as f32),
                    found.map(|x| x as f32),
                    "exact bounds"
                );
            }
        }
        values
    }

    pub(crate) fn points(&self, accessor: &Value) -> Vec<[f64; 3]> {
        self.numbers(accessor).as_chunks::<3>().0.to_vec()
    }

    pub(crate) fn primitive(&self, primitive: usize) -> &Value {
        &self.json["meshes"][0]["primitives"][primitive]
    }

    pub(crate) fn triangles(&self, primitive: usize) -> Vec<[u32; 3]> {
        let corners = self.numbers(&self.primitive(primitive)["indices"]);
        corners
            .as_chunks::<3>()
            .0
            .iter()
            .map(|corners| corners.map(|v| v as u32))
            .collect()
    }
}

/// A surface of many triangles, within a small part of its size of the limit of a mesh whose vertices at one place are one.
pub(crate) fn limit(positions: &[[f64; 3]], triangles: &[[u32; 3]], tolerance: f64) -> Mesh {
    let faces: PolygonFaces = triangles.iter().map(|corners| &corners[..]).collect();
    let soup = PolygonSoup {
        positions: positions.to_vec(),
        faces,
        ..Default::default()
    };
    let (mesh, _) = Mesh::from_soup(&soup, &Default::default()).expect("a mesh");
    let options = limitmesh::refine::ExactOptions::default().tolerance(tolerance * mesh.diagonal());
    limitmesh::refine::exact(&mesh, &limitmesh::scheme::Loop, &options)
        .expect("refined")
        .mesh
}

/// The greatest distances of the first surface's vertices from the second, and of the second's from the first.
pub(crate) fn distances(a: Triangles<'_>, b: Triangles<'_>) -> [f64; 2] {
    [(a, b), (b, a)].map(|(from, to)| {
        let all = limitmesh::measure::distances_to(from.positions, to).expect("distances");
        all.into_iter().fold(0.0, f64::max)
    })
}
