//! Seams in PLY files: texture coordinates are written where the file had them that they came from, at vertices or at corners.

use super::support::{channel, output, read, text, written};
use limitmesh::mesh::{Channel, Domain, Semantic, Storage};
use limitmesh_io::{Format, Property, splits_vertices};

/// Two triangles that share an edge, and a vertex of none.
const POSITIONS: [[f64; 3]; 5] = [
    [0.0; 3],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 1.0, 0.0],
    [9.0; 3],
];
const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [2, 1, 3]];

/// By corner, with a seam at vertex 2 alone: at vertex 1 two values are as good as equal.
fn textures(name: &str) -> Channel {
    let values = [
        [0.0, 0.0],
        [1.0, 0.0],
        [0.0, 0.5],
        [0.25, 0.75],
        [1.0, 0.0],
        [1.0, 1.0],
    ];
    Channel::new(name, Semantic::TextureCoordinates, Domain::Corner, 2)
        .stored(Storage::Single)
        .with(values.concat(), (0..6).collect())
}

#[test]
fn vertices_stand_for_each_value_that_files_had_at_vertices() {
    for name in ["s,t", "u,v", "texture_u,texture_v"] {
        let heat = Channel::new("heat", Semantic::Other, Domain::Vertex, 1)
            .stored(Storage::Double)
            .with(vec![5.0, 6.0, 7.0, 8.0, 9.0], vec![0, 1, 2, 3, 4]);
        // On the other side of the shared edge at vertex 1, where texture coordinates are the same.
        let red = Channel::new("red,green,blue", Semantic::Colour, Domain::Corner, 3)
            .stored(Storage::Byte)
            .with(vec![1.0, 0.0, 0.0, 0.0, 0.0, 1.0], vec![0, 0, 0, 0, 1, 1]);
        let channels = [textures(name), heat, red];
        assert!(splits_vertices(&channels, &TRIANGLES, POSITIONS.len()));
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let normals = [z, y, x, [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]];
        let (quality, parts) = ([0.5, 1.5, 2.5, 3.5, 4.5], [3, 4, 5, 6, 7]);
        let properties = [
            Property::integers("part", &parts),
            Property::numbers("twice", &quality),
        ];
        let own = output(&POSITIONS, &TRIANGLES)
            .normals(&normals)
            .quality(&quality);
        let own = own.vertex_properties(&properties).channels(&channels);
        let file = text(Format::Ply, &own);
        let (header, body) = file.split_once("end_header\n").unwrap();
        for part in name.split(',') {
            assert!(
                header.contains(&format!("property float {part}\n")),
                "{header}"
            );
        }
        assert!(!header.contains("texcoord"), "{header}");
        // Copies come last, with all that their vertices have; what is in no triangle stays, with the first values.
        let expected = "\
            0 0 0 0 0 1 0.5 3 0.5 0 0 5 255 0 0\n\
            1 0 0 0 1 0 1.5 4 1.5 1 0 6 255 0 0\n\
            0 1 0 1 0 0 2.5 5 2.5 0 0.5 7 255 0 0\n\
            1 1 0 0 0 -1 3.5 6 3.5 1 1 8 0 0 255\n\
            9 9 9 0 -1 0 4.5 7 4.5 0 0 9 255 0 0\n\
            0 1 0 1 0 0 2.5 5 2.5 0.25 0.75 7 255 0 0\n\
            1 0 0 0 1 0 1.5 4 1.5 1 0 6 0 0 255\n\
            3 0 1 2\n\
            3 5 6 3\n";
        assert_eq!(body, expected);
        // What is read is what was given, corner by corner, in both forms.
        for ascii in [true, false] {
            let soup = read(written(Format::Ply, &own, ascii), Format::Ply);
            let found = channel(&soup, name);
            for (corner, &v) in soup.faces.iter().flatten().enumerate() {
                assert_eq!(found.value(v as usize), channels[0].value(corner));
                let place = POSITIONS[TRIANGLES.as_flattened()[corner] as usize];
                assert_eq!(soup.positions[v as usize], place);
            }
        }
    }
}

#[test]
fn without_seams_vertices_stand_once_and_lists_by_corner_stay_lists() {
    let smooth = |name: &str| {
        let mut channel = textures(name);
        channel.indices[3] = 2;
        channel
    };
    assert!(!splits_vertices(
        &[smooth("s,t")],
        &TRIANGLES,
        POSITIONS.len()
    ));
    for channel in [smooth("s,t"), textures("texcoord"), smooth("texcoord")] {
        let is_list = channel.name == "texcoord";
        let file = text(
            Format::Ply,
            &output(&POSITIONS, &TRIANGLES).channels(&[channel]),
        );
        assert!(file.contains("element vertex 5\n"), "{file}");
        assert_eq!(file.contains("property float t\n"), !is_list, "{file}");
        assert_eq!(
            file.contains("property list uchar float texcoord\n"),
            is_list,
            "{file}"
        );
        assert_eq!(
            file.contains("\n3 0 1 2 6 0 0 1 0 0 0.5\n"),
            is_list,
            "{file}"
        );
    }
}
