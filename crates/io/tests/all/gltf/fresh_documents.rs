//! Documents of meshes that come from other formats: channels and materials are in them, and are read again.

use crate::support::{output, triangles};
use limitmesh::mesh::{Channel, PolygonSoup};
use limitmesh_io::{Format, MATERIAL, TEXTURE, read_bytes, values_lost};

/// Two squares of two materials and a triangle without one, a texture with a seam between them, and colours.
const OBJ: &str = "\
v 0 0 0 1 0 0
v 1 0 0 0 1 0
v 1 1 0 0 0 1
v 0 1 0 1 1 1
v 2 0 0 0.5 0.5 0.5
v 2 1 0 0.25 0.5 0.75
vt 0 0
vt 1 0
vt 1 1
vt 0 0.75
f 1/1 2/2 3/3
usemtl red paint
f 1/1 3/3 4/4
usemtl blue
f 2/1 5/2 6/3
usemtl red paint
f 2/1 6/3 3/4
";

fn corners(soup: &PolygonSoup) -> Vec<String> {
    let find = |name: &str| soup.channels.iter().find(|own| own.name == name);
    let texture = find(TEXTURE)
        .or(find("TEXCOORD_0"))
        .expect("texture coordinates");
    let colour = soup
        .channels
        .iter()
        .find(|own| own.arity == 3)
        .expect("colours");
    let material = find(MATERIAL);
    let mut all = Vec::new();
    for (face, vertices) in soup.faces.iter().enumerate() {
        let name = material.map_or(String::new(), |own| {
            own.labels[own.values[own.indices[face] as usize] as usize].clone()
        });
        for (corner, &v) in vertices.iter().enumerate() {
            let value = |own: &Channel| {
                let element = if own.indices.len() == soup.positions.len() {
                    v as usize
                } else {
                    3 * face + corner
                };
                own.value(element).to_vec()
            };
            all.push(format!(
                "{:?} {:?} {:?} {name}",
                soup.positions[v as usize],
                value(texture),
                value(colour)
            ));
        }
    }
    all.sort();
    all
}

fn written(soup: &PolygonSoup, format: Format) -> Vec<u8> {
    let triangles = triangles(soup);
    let own = output(&soup.positions, &triangles).channels(&soup.channels);
    let bytes = crate::support::written(format, &own, false);
    for channel in &soup.channels {
        assert_eq!(
            values_lost(format, channel, &triangles, soup.positions.len()),
            0,
            "{}",
            channel.name
        );
    }
    bytes
}

#[test]
fn textures_colours_and_materials_of_other_formats_are_in_new_documents() {
    let soup = read_bytes(OBJ.as_bytes(), Format::Obj).expect("an OBJ file");
    for format in [Format::Glb, Format::Gltf] {
        let again = read_bytes(&written(&soup, format), format).expect("a document");
        assert_eq!(corners(&again), corners(&soup), "{format}");
    }
    let text = String::from_utf8(written(&soup, Format::Gltf)).expect("text");
    let document: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let primitives = document["meshes"][0]["primitives"]
        .as_array()
        .expect("primitives");
    let materials: Vec<Option<u64>> = primitives
        .iter()
        .map(|own| own["material"].as_u64())
        .collect();
    assert_eq!(materials, [None, Some(0), Some(1)]);
    assert_eq!(
        document["materials"],
        serde_json::json!([{"name": "red paint"}, {"name": "blue"}])
    );
}

/// A vertex of the file for each combination of values at a vertex of the surface, however many there are at one.
#[test]
fn a_vertex_with_many_values_stands_once_for_each() {
    let (rim, values) = (90, 60);
    let mut obj = String::from("v 0 0 1 1 1 1\n");
    for i in 0..rim {
        obj += &format!("v {i} {} 0 0 0 1\n", i * i);
    }
    (0..values).for_each(|i| obj += &format!("vt {} 0.5\n", f64::from(i) / 64.0));
    let mut met = std::collections::HashSet::new();
    for i in 0..rim {
        // Each third triangle has a value at the tip that one before it has.
        let corners = [
            (1, 1 + (i - i / 3) % values),
            (2 + i, 1 + i % 2),
            (2 + (i + 1) % rim, 3),
        ];
        met.extend(corners);
        obj += &corners
            .map(|(v, t)| format!(" {v}/{t}"))
            .iter()
            .fold("f".to_owned(), |line, own| line + own);
        obj += "\n";
    }
    let soup = read_bytes(obj.as_bytes(), Format::Obj).expect("an OBJ file");
    let again = read_bytes(&written(&soup, Format::Glb), Format::Glb).expect("a document");
    assert!(corners(&again) == corners(&soup));
    let text = String::from_utf8(written(&soup, Format::Gltf)).expect("text");
    let document: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let position = document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
        .as_u64()
        .expect("a number");
    assert_eq!(
        document["accessors"][position as usize]["count"].as_u64(),
        Some(met.len() as u64)
    );
    assert!(met.iter().filter(|(vertex, _)| *vertex == 1).count() > 32);
}

/// Numbers with names of their own get names that the specification leaves free.
#[test]
fn other_numbers_are_attributes_of_their_own() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float s\nproperty float t\nproperty double heat\nproperty float wall-thickness\nproperty int part\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 0 0 1.5 2 7\n1 0 0 1 0 2.5 3 7\n0 1 0 0 1 3.5 4 7\n3 0 1 2\n";
    let soup = read_bytes(ply.as_bytes(), Format::Ply).expect("a PLY file");
    let again = read_bytes(&written(&soup, Format::Glb), Format::Glb).expect("a document");
    let values = |name: &str| {
        &again
            .channels
            .iter()
            .find(|own| own.name == name)
            .expect(name)
            .values
    };
    assert_eq!(values("_HEAT"), &[1.5, 2.5, 3.5]);
    assert_eq!(values("_WALL_THICKNESS"), &[2.0, 3.0, 4.0]);
    assert!(again.channels.iter().all(|own| !own.name.contains("PART")));
}
