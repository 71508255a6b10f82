//! How much memory reading takes: no more than the file's size warrants, whatever its header promises.
//!
//! All in one test, because the highest mark is one for the whole program.

#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests fail as the tests do"
)]

use limitmesh_io::{Format, read, read_bytes};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Bytes that `work` takes at its height, beyond what is taken before.
fn peak_of<T>(work: impl FnOnce() -> T) -> usize {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let result = work();
    let peak = MEMORY.peak_usage();
    drop(result);
    peak.saturating_sub(before)
}

#[test]
fn memory_follows_the_size_of_the_file() {
    promises_take_no_room();
    packages_that_swell_take_a_stated_room();
    zeros_take_no_room();
    room_is_exact();
    a_large_model();
}

/// A few hundred bytes that promise billions of elements take a few thousand bytes to refuse.
fn promises_take_no_room() {
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let list = "property list uint uint vertex_indices\n";
    let most = u32::MAX;
    let mut files = vec![
        (
            Format::Off,
            format!("OFF\n{most} {most} {most}\n0 0 0\n").into_bytes(),
        ),
        (
            Format::Off,
            format!("OFF\n1 {most} 0\n0 0 0\n{most} 0 0\n").into_bytes(),
        ),
        (
            Format::Obj,
            format!("v 0 0 0\nt crease {most}/{most}/{most} 0 0\n").into_bytes(),
        ),
    ];
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for (vertices, faces, other) in [(most, 0, 0), (0, most, 0), (0, 0, most), (1, 1, 0)] {
            let header = format!(
                "ply\nformat {encoding} 1.0\nelement other {other}\n{list}element vertex {vertices}\n{xyz}\
                 element face {faces}\n{list}end_header\n"
            );
            // Twelve bytes for a vertex, or as text three numbers; then the length of a list.
            for body in [
                &b"0 0 0\n4294967295 0 0\n"[..],
                &[0xff; 40],
                b"0 0 0 0 0 0 ~~~~",
            ] {
                files.push((Format::Ply, [header.as_bytes(), body].concat()));
            }
        }
    }
    let mut stl = vec![0xff; 84 + 60];
    stl[80..84].copy_from_slice(&most.to_le_bytes());
    files.push((Format::Stl, stl));
    for (format, bytes) in files {
        let peak = peak_of(|| read_bytes(&bytes, format));
        let text = String::from_utf8_lossy(&bytes);
        assert!(
            peak < 16 * 1024,
            "{peak} bytes to read {} bytes of {format}:\n{text}",
            bytes.len()
        );
    }
}

/// A package of some hundred kilobytes that claims a quarter of a gigabyte is given up at a hundred times its size and 32 MiB, and the room for
/// these is at most doubled where it grows.
fn packages_that_swell_take_a_stated_room() {
    use std::io::Write;
    let mut writer = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default();
    let relationship = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
    let blanks = vec![b' '; 1 << 20];
    writer.start_file("_rels/.rels", options).unwrap();
    write!(
        writer,
        "<Relationships><Relationship Target=\"/m.model\" Type=\"{relationship}\"/></Relationships>"
    )
    .unwrap();
    writer.start_file("m.model", options).unwrap();
    (0..256).for_each(|_| writer.write_all(&blanks).unwrap());
    let bytes = writer.finish().unwrap().into_inner();
    let stated = (32 << 20) + 100 * bytes.len();
    assert!(stated < 64 << 20);
    let peak = peak_of(|| read_bytes(&bytes, Format::ThreeMf).unwrap_err());
    assert!(peak < 3 * stated, "{peak} bytes to refuse {}", bytes.len());
}

/// Accessors that are zeros, named by a thousand meshes, a thousand morph targets, or a thousand nodes with instances.
fn zeros_take_no_room() {
    let zeros = r#"[{"count":1000000,"type":"VEC3","componentType":5126}]"#;
    let many = |one: &str| vec![one; 1000].join(",");
    let mesh = r#"{"primitives":[{"attributes":{"POSITION":0}}]}"#;
    let documents = [
        format!(r#""meshes":[{}]"#, many(mesh)),
        format!(
            r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{}]}}]}}]"#,
            many(r#"{"POSITION":0}"#)
        ),
        format!(
            r#""meshes":[{mesh}],"nodes":[{}]"#,
            many(
                r#"{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}"#
            )
        ),
    ];
    for members in documents {
        let text = format!(r#"{{"asset":{{"version":"2.0"}},"accessors":{zeros},{members}}}"#);
        let peak = peak_of(|| {
            let said = read_bytes(text.as_bytes(), Format::Gltf)
                .unwrap_err()
                .to_string();
            assert!(said.contains("without a buffer view"), "{said}");
        });
        assert!(peak < 16 << 20, "{peak} bytes to refuse {}", text.len());
    }
}

/// Reading takes what the soup takes, and next to nothing beyond.
fn room_is_exact() {
    const SIDE: usize = 200;
    let positions: Vec<[f64; 3]> = (0..SIDE * SIDE)
        .map(|i| [(i % SIDE) as f64, (i / SIDE) as f64, 0.5])
        .collect();
    let triangles: Vec<[u32; 3]> = (0..(SIDE - 1) * SIDE)
        .filter(|i| i % SIDE != SIDE - 1)
        .flat_map(|i| [[i, i + 1, i + SIDE], [i + 1, i + SIDE + 1, i + SIDE]])
        .map(|triangle| triangle.map(|v| v as u32))
        .collect();
    let output = limitmesh_io::Output::new(limitmesh::Triangles {
        positions: &positions,
        triangles: &triangles,
    });
    // A glTF document, and the text of a 3MF package, is kept while its meshes are read.
    let is_kept = |format: Format| format.is_gltf() || format == Format::ThreeMf;
    for &format in Format::ALL.iter().filter(|format| !is_kept(**format)) {
        for ascii in [false, true] {
            let mut bytes = Vec::new();
            let options = limitmesh_io::WriteOptions::default().ascii(ascii);
            limitmesh_io::write_to(&mut bytes, format, &output, &options).unwrap();
            let vertices = if format == Format::Stl {
                3 * triangles.len()
            } else {
                positions.len()
            };
            // 24 bytes a position, 12 for the corners of a triangle, 4 for its start.
            let needed = 24 * vertices + 16 * triangles.len();
            let peak = peak_of(|| read_bytes(&bytes, format).unwrap());
            assert!(
                peak >= needed,
                "the highest mark cannot be under what is held"
            );
            assert!(
                peak < needed + 4096,
                "{format}: {peak} bytes where {needed} are needed"
            );
        }
    }
}

/// The file and the soup of the largest model, per triangle.
fn a_large_model() {
    let Some(folder) = std::env::var_os("LIMITMESH_MODELS").map(std::path::PathBuf::from) else {
        // Written directly: the test harness keeps what macros print to itself.
        let _ = std::io::Write::write_all(
            &mut std::io::stderr(),
            b"skipped in part: LIMITMESH_MODELS is not set\n",
        );
        return;
    };
    let peak = peak_of(|| read(folder.join("gcanyon_530k.ply")).unwrap());
    let each = peak as f64 / 530_450.0;
    assert!(each < 50.0, "{each} bytes a triangle");
}
