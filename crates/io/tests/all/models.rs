//! The shared models, read and compared with the counts of their list. Needs the folder in `LIMITMESH_MODELS`.

use super::support::{output, shared, triangles};
use limitmesh_io::{WriteOptions, read, write};

/// Stored vertices, faces, creases and corners of each file, from the list that comes with the models. An STL
/// file stores three vertices a facet.
const COUNTS: [(&str, usize, usize, usize, usize); 34] = [
    ("mannequin.off", 428, 839, 0, 0),
    ("mannequin_142.off", 79, 142, 0, 0),
    ("boot_684.off", 344, 684, 0, 0),
    ("teddy.obj", 1598, 3192, 0, 0),
    ("bunny_3674.obj", 1839, 3674, 0, 0),
    ("bunny_1k.off", 502, 1000, 0, 0),
    ("fish_cage.obj", 112, 112, 0, 0),
    ("cup_standin.obj", 360, 720, 0, 0),
    ("radish_standin.obj", 322, 640, 0, 0),
    ("cusp_standin.obj", 242, 480, 0, 0),
    ("sphere_360.obj", 182, 360, 0, 0),
    ("sphere_320.ply", 162, 320, 0, 0),
    ("bob_cage.obj", 334, 334, 0, 0),
    ("skull_low.obj", 5154, 10312, 0, 0),
    ("monsterfrog.obj", 1308, 2584, 0, 0),
    ("plane_holes.obj", 8519, 16747, 0, 0),
    ("goathead_be.ply", 2763, 5522, 0, 0),
    ("teapot.obj", 3644, 6320, 0, 0),
    ("beetle.obj", 1148, 2053, 0, 0),
    ("featuretype.stl", 3 * 3476, 3476, 0, 0),
    ("gcanyon_530k.ply", 266_256, 530_450, 0, 0),
    ("rook_creased.obj", 768, 1510, 280, 0),
    ("mechpart_creased.obj", 115, 238, 113, 0),
    ("loop_icos_semisharp.obj", 48, 80, 15, 2),
    ("loop_saddle_edgecorner.obj", 6, 4, 0, 0),
    ("loop_pole64.obj", 129, 192, 0, 0),
    ("defects/fan3.obj", 5, 3, 0, 0),
    ("defects/hourglass_ico.obj", 23, 40, 0, 0),
    ("defects/triple_vierbein.obj", 75, 108, 0, 0),
    ("defects/moebius.obj", 280, 224, 0, 0),
    ("defects/deg_faces.obj", 6, 4, 0, 0),
    ("defects/extra_vertex.obj", 10, 3, 0, 0),
    ("defects/spider_ascii.stl", 3 * 1368, 1368, 0, 0),
    ("defects/mannequin_flipped.off", 428, 839, 0, 0),
];

#[test]
fn every_model_has_the_counts_of_the_list() {
    let Some(folder) = shared("") else { return };
    for (name, vertices, faces, creases, corners) in COUNTS {
        let soup = read(folder.join(name)).unwrap_or_else(|error| panic!("{error}"));
        let met = (
            soup.positions.len(),
            soup.faces.len(),
            soup.creases.len(),
            soup.corners.len(),
        );
        assert_eq!(met, (vertices, faces, creases, corners), "{name}");
    }
}

/// The sharp edges of the files are edges of their faces if tags count from 0, and not if they count from 1.
#[test]
fn tags_count_vertices_from_zero() {
    let Some(folder) = shared("") else { return };
    for name in [
        "rook_creased.obj",
        "mechpart_creased.obj",
        "loop_icos_semisharp.obj",
    ] {
        let mut soup = read(folder.join(name)).unwrap();
        // What was left out has not been written.
        soup.left_out.clear();
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

#[test]
fn damaged_files_say_where() {
    let Some(folder) = shared("") else { return };
    let message = |name: &str| read(folder.join(name)).unwrap_err().to_string();
    for (name, words) in [
        (
            "sphere_truncated.ply",
            "sphere_truncated.ply: PLY byte 4411, face ",
        ),
        (
            "inf_nan.obj",
            "OBJ line 1, vertex 0: expected a finite number for x, found 'inf'",
        ),
    ] {
        let said = message(&format!("defects/{name}"));
        assert!(said.contains(words), "{said}");
    }
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
