//! Bytes flipped, bytes cut, numbers swapped: whatever a file becomes, it is read or refused, and what was read can be
//! written.

use super::support::{document, floats, glb};
use crate::support::shared;
use limitmesh_io::gltf::{Geometry, Joining, MeshSoup, VertexAttribute};
use limitmesh_io::{Asset, Format};
use proptest::prelude::*;

/// How a target moves the vertices of a mesh, and nothing where it doesn't.
fn added(own: &MeshSoup, target: usize) -> Vec<VertexAttribute> {
    let mut values = vec![0.0; 3 * own.soup.positions.len()];
    let tables = own
        .attributes
        .iter()
        .filter(|table| table.target == Some(target) && table.is_displacement());
    for table in tables {
        for (&v, &value) in own.soup.faces.iter().flatten().zip(&table.corners) {
            values[3 * v as usize..][..3].copy_from_slice(&table.values[3 * value as usize..][..3]);
        }
    }
    vec![VertexAttribute {
        name: "POSITION".to_owned(),
        width: 3,
        values,
        is_integer: false,
    }]
}

pub(super) fn exercise(bytes: &[u8]) {
    let Ok(mut asset) = Asset::from_bytes(bytes, None) else {
        return;
    };
    let _ = asset.contents();
    let _ = asset.scene_soup();
    for mesh in 0..asset.mesh_count().min(4) {
        let _ = asset.mesh(mesh, Joining::Never);
        let _ = asset.mesh(
            mesh,
            Joining::Ignoring {
                skins: true,
                morphs: true,
                distance: 0.0,
            },
        );
        let Ok(own) = asset.mesh(mesh, Joining::Together) else {
            continue;
        };
        let stretch = asset.stretch(mesh);
        assert!(stretch > 0.0 && stretch.is_finite());
        let vertices = own.soup.positions.len();
        assert!(
            own.soup
                .faces
                .iter()
                .flatten()
                .all(|&v| (v as usize) < vertices)
        );
        for part in &own.parts {
            let faces = part.faces.clone().map(|face| own.soup.faces.get(face));
            let fans =
                faces.flat_map(|face| face[1..].windows(2).map(|own| [face[0], own[0], own[1]]));
            let triangles: Vec<[u32; 3]> = fans.collect();
            let targets: Vec<Vec<VertexAttribute>> = (0..part.targets.len())
                .map(|target| added(&own, target))
                .collect();
            let geometry = Geometry {
                positions: &own.soup.positions,
                normals: None,
                triangles: &triangles,
                attributes: &[],
                targets: &targets,
            };
            let _ = asset.replace(mesh, part.primitive, &geometry);
        }
    }
    for format in [Format::Glb, Format::Gltf] {
        if let Ok(written) = asset.to_bytes(format) {
            assert!(
                Asset::from_bytes(&written, None).is_ok(),
                "what was written cannot be read"
            );
        }
    }
}

/// A small document with a skin, a morph target, sparse values and instances.
fn seed() -> Vec<u8> {
    let top = r#""buffers":[{"byteLength":120}],
        "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":6},
            {"buffer":0,"byteOffset":56,"byteLength":64}],
        "accessors":[{"count":4,"type":"VEC3","componentType":5126,"bufferView":0},
            {"count":6,"type":"SCALAR","componentType":5121,"bufferView":1},
            {"count":4,"type":"VEC3","componentType":5126,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},
                "values":{"bufferView":2}}},
            {"count":4,"type":"VEC4","componentType":5121,"bufferView":2,"normalized":true},
            {"count":1,"type":"MAT4","componentType":5126,"bufferView":2},
            {"count":2,"type":"VEC3","componentType":5126,"bufferView":2},
            {"count":4,"type":"VEC3","componentType":5126}],
        "scene":0,"scenes":[{"nodes":[0,2]}],"skins":[{"joints":[1],"inverseBindMatrices":4}],
        "nodes":[{"mesh":0,"skin":0,"children":[1]},{"scale":[2,2,2]},
            {"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":5}}}}]"#;
    let primitive = r#""attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":3},"indices":1,"targets":[{"POSITION":2},{"POSITION":6,"COLOR_0":6}]"#;
    let mut bin = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    bin.extend([0, 1, 2, 0, 2, 3, 0, 0]);
    bin.extend(floats(&[
        1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0,
    ]));
    glb(&document(top, primitive), &bin)
}

#[test]
fn the_seed_is_sound() {
    let asset = Asset::from_bytes(&seed(), None).unwrap();
    assert_eq!(
        asset.mesh(0, Joining::Together).unwrap().soup.faces.len(),
        2
    );
    assert_eq!(asset.scene_soup().unwrap().faces.len(), 6);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn flipped_bytes(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut bytes = seed();
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        exercise(&bytes);
    }

    #[test]
    fn cut_bytes(start in any::<prop::sample::Index>(), length in 0usize..60) {
        let mut bytes = seed();
        let start = start.index(bytes.len());
        bytes.drain(start..(start + length).min(bytes.len()));
        exercise(&bytes);
    }

    #[test]
    fn other_digits(changes in prop::collection::vec((any::<prop::sample::Index>(), 0u8..10), 1..4)) {
        let mut bytes = seed();
        let digits: Vec<usize> = (20..bytes.len() - 128).filter(|&i| bytes[i].is_ascii_digit()).collect();
        for (place, digit) in changes {
            bytes[digits[place.index(digits.len())]] = b'0' + digit;
        }
        exercise(&bytes);
    }
}

#[test]
fn small_files_of_others_with_bytes_flipped() {
    let names = [
        "BoxMeshopt.glb",
        "TwoCubes.glb",
        "quad_skin.glb",
        "fuzz.glb",
        "BoxInterleaved.glb",
    ];
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    for name in names {
        let Some(file) = shared(&format!("assets/{name}")) else {
            return;
        };
        let bytes = std::fs::read(file).unwrap();
        for _ in 0..400 {
            let mut bytes = bytes.clone();
            for _ in 0..1 + random(4) {
                let place = random(bytes.len());
                bytes[place] = random(256) as u8;
            }
            if random(4) == 0 {
                bytes.truncate(random(bytes.len()));
            }
            exercise(&bytes);
        }
    }
}
