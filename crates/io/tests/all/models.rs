//! The shared models, read and written again. Needs the folder in `LIMITMESH_MODELS`.

use super::support::{output, shared, triangles};
use limitmesh_io::{WriteOptions, read, write};

/// The sharp edges of the files are edges of their faces if tags count from 0, and not if they count from 1.
#[test]
fn tags_count_vertices_from_zero() {
    let Some(folder) = shared("") else { return };
    for (name, creases) in [
        ("rook_creased.obj", 280),
        ("mechpart_creased.obj", 113),
        ("loop_icos_semisharp.obj", 15),
    ] {
        let soup = read(folder.join(name)).unwrap();
        assert_eq!(soup.creases.len(), creases, "{name}");
        let is_edge = |ends: [u32; 2]| {
            soup.faces.iter().any(|face| {
                (0..face.len()).any(|i| {
                    let edge = [face[i], face[(i + 1) % face.len()]];
                    edge == ends || edge == [ends[1], ends[0]]
                })
            })
        };
        assert!(
            soup.creases.iter().all(|tag| is_edge(tag.vertices)),
            "{name}"
        );
        let shifted = |tag: &limitmesh::mesh::CreaseTag| tag.vertices.map(|v| v.wrapping_sub(1));
        assert!(
            !soup.creases.iter().all(|tag| is_edge(shifted(tag))),
            "{name}"
        );
    }
    let icosahedra = read(folder.join("loop_icos_semisharp.obj")).unwrap();
    let corners = icosahedra
        .corners
        .iter()
        .map(|tag| (tag.vertex, tag.sharpness));
    assert_eq!(corners.collect::<Vec<_>>(), [(4, 2.5), (16, 4.5)]);
}

#[test]
fn polygons_keep_their_sizes() {
    let Some(folder) = shared("") else { return };
    let soup = read(folder.join("fish_cage.obj")).unwrap();
    let of_size = |n| soup.faces.iter().filter(|face| face.len() == n).count();
    assert_eq!([of_size(3), of_size(4), of_size(5)], [8, 100, 4]);
    let soup = read(folder.join("bob_cage.obj")).unwrap();
    assert!(soup.faces.iter().all(|face| face.len() == 4));
}

/// Each input is written in every format and read again: equal in all but STL, where it is equal as `f32`.
#[test]
fn models_survive_every_format() {
    let Some(folder) = shared("") else { return };
    let target = tempfile::tempdir().unwrap();
    for name in [
        "skull_low.obj",
        "goathead_be.ply",
        "featuretype.stl",
        "mannequin.off",
    ] {
        let mut soup = read(folder.join(name)).unwrap();
        // What was left out is not written here, nor anything else apart from the shape.
        soup.left_out.clear();
        soup.channels.clear();
        let triangles = triangles(&soup);
        let output = output(&soup.positions, &triangles);
        for extension in ["obj", "ply", "off"] {
            let path = target.path().join("copy").with_extension(extension);
            write(&path, &output, &WriteOptions::default()).unwrap();
            assert_eq!(read(&path).unwrap(), soup, "{name} as {extension}");
        }
        let path = target.path().join("copy.stl");
        write(&path, &output, &WriteOptions::default()).unwrap();
        let corners = soup
            .faces
            .iter()
            .flatten()
            .map(|&v| soup.positions[v as usize]);
        let corners = corners.map(|p| p.map(|x| f64::from(x as f32)));
        assert!(
            read(&path).unwrap().positions.into_iter().eq(corners),
            "{name} as stl"
        );
    }
}
