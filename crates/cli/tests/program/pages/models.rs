//! The files of `examples/models`, which pages use: small shapes by formula.
//!
//! Coordinates are rounded to 1/10,000, so that they are the same on every machine.

use std::f64::consts::TAU;

use crate::kept::check;

type Point = [f64; 3];

/// Corners of the flange's cross-section in millimetres: radius and height.
const FLANGE: [[f64; 2]; 6] = [
    [7.0, 0.0],
    [20.0, 0.0],
    [20.0, 5.0],
    [12.0, 5.0],
    [12.0, 18.0],
    [7.0, 18.0],
];
const FLANGE_FACETS: usize = 16;

/// The vase's profile from the foot to the rim.
const VASE: [[f64; 2]; 7] = [
    [0.30, 0.0],
    [0.42, 0.10],
    [0.50, 0.35],
    [0.42, 0.65],
    [0.24, 0.90],
    [0.20, 1.05],
    [0.28, 1.20],
];
const VASE_FACETS: usize = 12;

/// The radius of the ball of voxels, in voxels.
const BALL: f64 = 3.5;

/// Squares along a side of the flag.
const FLAG: usize = 8;

#[test]
fn example_models_are_those_that_are_made_here() {
    check("examples/models/flange.stl", &stl(&flange()));
    check("examples/models/voxels.stl", &stl(&voxels()));
    check("examples/models/vase.obj", vase_obj().as_bytes());
    check(
        "examples/models/vase.mtl",
        b"newmtl clay\nKd 0.9 0.8 0.7\nmap_Kd vase.png\n",
    );
    check("examples/models/vase.png", &checker());
    check("examples/models/vase.glb", &vase_glb());
    for frame in 1..=3 {
        check(
            &format!("examples/models/flag_{frame}.obj"),
            flag(frame).as_bytes(),
        );
    }
}

fn rounded(x: f64) -> f64 {
    (x * 1e4).round() / 1e4
}

/// The point of a profile after a part of a turn about the y axis.
fn turned([radius, height]: [f64; 2], turn: f64) -> Point {
    let (sin, cos) = (TAU * turn).sin_cos();
    [rounded(radius * cos), height, rounded(-radius * sin)]
}

/// A ring with a hub and a bore, of flat facets.
fn flange() -> Vec<[Point; 3]> {
    let at = |corner: usize, facet: usize| {
        turned(
            FLANGE[corner % FLANGE.len()],
            (facet % FLANGE_FACETS) as f64 / FLANGE_FACETS as f64,
        )
    };
    let quads = (0..FLANGE_FACETS).flat_map(|facet| {
        (0..FLANGE.len()).map(move |corner| {
            [
                at(corner, facet),
                at(corner, facet + 1),
                at(corner + 1, facet + 1),
                at(corner + 1, facet),
            ]
        })
    });
    quads.flat_map(halves).collect()
}

/// A ball as a segmentation has it: the faces between voxels inside and outside.
fn voxels() -> Vec<[Point; 3]> {
    let reach = BALL.ceil() as i32;
    let is_inside = |[x, y, z]: [i32; 3]| f64::from(x * x + y * y + z * z) < BALL * BALL;
    let mut quads = Vec::new();
    for cell in cells(reach) {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
            let mut other = cell;
            other[axis] += side;
            if is_inside(cell) && !is_inside(other) {
                let corner = |[u, v]: [f64; 2]| {
                    let mut point = cell.map(f64::from);
                    point[axis] += 0.5 * f64::from(side);
                    point[(axis + 1) % 3] += u * f64::from(side);
                    point[(axis + 2) % 3] += v;
                    point
                };
                quads.push([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(corner));
            }
        }
    }
    quads.into_iter().flat_map(halves).collect()
}

fn cells(reach: i32) -> impl Iterator<Item = [i32; 3]> {
    let range = -reach..=reach;
    range.clone().flat_map(move |x| {
        let range = range.clone();
        range
            .clone()
            .flat_map(move |y| range.clone().map(move |z| [x, y, z]))
    })
}

fn halves([a, b, c, d]: [Point; 4]) -> [[Point; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// A binary STL file, whose facets leave their normals to the reader.
fn stl(triangles: &[[Point; 3]]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        bytes.extend(
            corners
                .as_flattened()
                .iter()
                .flat_map(|&x| (x as f32).to_le_bytes()),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

/// The vase's points, a seam's twice, row by row from the foot; the last is the middle of the foot.
fn vase() -> (Vec<Point>, Vec<[f64; 2]>, Vec<[usize; 3]>) {
    let row = VASE_FACETS + 1;
    let (mut points, mut texture) = (Vec::new(), Vec::new());
    for (level, &corner) in VASE.iter().enumerate() {
        for facet in 0..row {
            points.push(turned(
                corner,
                (facet % VASE_FACETS) as f64 / VASE_FACETS as f64,
            ));
            texture.push([
                rounded(facet as f64 / VASE_FACETS as f64),
                rounded(level as f64 / (VASE.len() - 1) as f64),
            ]);
        }
    }
    let middle = points.len();
    points.push([0.0; 3]);
    texture.push([0.5, 0.0]);
    let mut triangles = Vec::new();
    for facet in 0..VASE_FACETS {
        triangles.push([middle, facet + 1, facet]);
        for level in 0..VASE.len() - 1 {
            let a = level * row + facet;
            triangles.extend([[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]);
        }
    }
    (points, texture, triangles)
}

fn vase_obj() -> String {
    let (points, texture, triangles) = vase();
    let mut text = "mtllib vase.mtl\n".to_owned();
    points
        .iter()
        .for_each(|[x, y, z]| text.push_str(&format!("v {x} {y} {z}\n")));
    texture
        .iter()
        .for_each(|[u, v]| text.push_str(&format!("vt {u} {v}\n")));
    text.push_str("usemtl clay\n");
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| i + 1);
        text.push_str(&format!("f {a}/{a} {b}/{b} {c}/{c}\n"));
    }
    text
}

/// A picture of two colours by turns.
fn checker() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 16, 8);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::NoCompression);
    let colours = [[214, 120, 72], [250, 232, 200]];
    let pixels: Vec<u8> = (0..16 * 8)
        .flat_map(|i| colours[(i % 16 + i / 16) % 2])
        .collect();
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(&pixels))
        .expect("a picture");
    bytes
}

/// A GLB file with positions, texture coordinates and the picture.
fn vase_glb() -> Vec<u8> {
    let (points, texture, triangles) = vase();
    let floats = |x: f64| (x as f32).to_le_bytes();
    let mut parts: [Vec<u8>; 4] = [
        points
            .as_flattened()
            .iter()
            .flat_map(|&x| floats(x))
            .collect(),
        texture
            .iter()
            .flat_map(|&[u, v]| [u, 1.0 - v])
            .flat_map(floats)
            .collect(),
        triangles
            .as_flattened()
            .iter()
            .flat_map(|&i| (i as u16).to_le_bytes())
            .collect(),
        checker(),
    ];
    let mut views = Vec::new();
    let mut start = 0;
    for part in &mut parts {
        views.push(
            serde_json::json!({ "buffer": 0, "byteOffset": start, "byteLength": part.len() }),
        );
        part.resize(part.len().next_multiple_of(4), 0);
        start += part.len();
    }
    let document = serde_json::json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "vase" }],
        "meshes": [{ "name": "vase", "primitives": [
            { "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
        "materials": [{ "name": "clay", "pbrMetallicRoughness":
            { "baseColorTexture": { "index": 0 }, "metallicFactor": 0.0 } }],
        "textures": [{ "source": 0 }],
        "images": [{ "bufferView": 3, "mimeType": "image/png" }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": points.len(), "type": "VEC3",
              "min": [-0.5, 0.0, -0.5], "max": [0.5, 1.2, 0.5] },
            { "bufferView": 1, "componentType": 5126, "count": texture.len(), "type": "VEC2" },
            { "bufferView": 2, "componentType": 5123, "count": 3 * triangles.len(), "type": "SCALAR" }],
        "bufferViews": views,
        "buffers": [{ "byteLength": start }],
    });
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF".to_vec();
    let chunk = |kind: &[u8; 4], content: &[u8]| {
        [&(content.len() as u32).to_le_bytes()[..], kind, content].concat()
    };
    let chunks = [chunk(b"JSON", &text), chunk(b"BIN\0", &parts.concat())].concat();
    bytes.extend(2u32.to_le_bytes());
    bytes.extend((12 + chunks.len() as u32).to_le_bytes());
    bytes.extend(chunks);
    bytes
}

/// A frame of a flag in the wind.
fn flag(frame: usize) -> String {
    let mut text = String::new();
    for (row, column) in (0..=FLAG).flat_map(|row| (0..=FLAG).map(move |column| (row, column))) {
        let [x, y] = [column, row].map(|i| i as f64 / FLAG as f64);
        let height = rounded(0.15 * x * (TAU * (x + 0.2 * y - frame as f64 / 6.0)).sin());
        text.push_str(&format!("v {x} {y} {height}\n"));
    }
    for (row, column) in (0..FLAG).flat_map(|row| (0..FLAG).map(move |column| (row, column))) {
        let a = row * (FLAG + 1) + column + 1;
        let [b, c, d] = [a + 1, a + FLAG + 2, a + FLAG + 1];
        text.push_str(&format!("f {a} {b} {c}\nf {a} {c} {d}\n"));
    }
    text
}
