//! Normals by side: what files hold of them, and what pictures show.

use crate::common::{done, file, folder, run, text, usage_error};

/// A prism of twelve sides, radius 2 and height 1, in the format OBJ: its ends are polygons.
fn prism() -> String {
    let mut text = String::new();
    let corners = 12;
    for z in [0.0, 1.0] {
        for i in 0..corners {
            let (sine, cosine) =
                (std::f64::consts::TAU * f64::from(i) / f64::from(corners)).sin_cos();
            text += &format!("v {} {} {z}\n", 2.0 * cosine, 2.0 * sine);
        }
    }
    let face = |list: &mut dyn Iterator<Item = i32>| {
        list.fold("f".to_owned(), |line, vertex| format!("{line} {vertex}")) + "\n"
    };
    for i in 0..corners {
        let next = (i + 1) % corners;
        text += &face(&mut [i + 1, next + 1, next + corners + 1, i + corners + 1].into_iter());
    }
    text += &face(&mut (1..=corners).rev());
    text + &face(&mut (corners + 1..=2 * corners))
}

fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn normal(corners: [&Vec<f64>; 3]) -> Vec<f64> {
    let [u, v] = [1, 2].map(|at| {
        (0..3)
            .map(|i| corners[at][i] - corners[0][i])
            .collect::<Vec<f64>>()
    });
    let cross = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
    let normal = [cross(1, 2), cross(2, 0), cross(0, 1)];
    let length = dot(&normal, &normal).sqrt();
    normal.iter().map(|x| x / length).collect()
}

/// The pixels of a picture, row by row.
pub(crate) fn pixels(png: &[u8]) -> Vec<Vec<u8>> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png))
        .read_info()
        .expect("a picture");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut bytes).expect("a picture");
    let bytes = &bytes[..info.buffer_size()];
    let width = bytes.len() / (info.width * info.height) as usize;
    bytes.chunks_exact(width).map(<[u8]>::to_vec).collect()
}

/// The ends are shaded as planes, the side as round, by whatever reads the files.
#[test]
fn each_side_of_a_rim_has_its_normals() {
    let folder = folder();
    let input = file(&folder, "prism.obj", &prism());
    let [obj, ply, split, stl] =
        ["out.obj", "out.ply", "split.ply", "out.stl"].map(|name| folder.path().join(name));
    let options = "--crease-angle 40 --tolerance 0.01 --quiet --ascii";
    for method in ["", "--optimize"] {
        let line = format!("refine {{}} -o {{}} {options} {method}");
        done(&line, &[&input, &obj]);
        let text = text(&obj);
        let list = |key: &str| -> Vec<Vec<f64>> {
            text.lines()
                .filter(|line| line.split(' ').next() == Some(key))
                .map(numbers)
                .collect()
        };
        let (positions, normals) = (list("v"), list("vn"));
        let mut flat = 0;
        for line in text.lines().filter(|line| line.starts_with("f ")) {
            let corners: Vec<(usize, usize)> = line[2..]
                .split(' ')
                .map(|word| word.split_once("//").expect("a normal"))
                .map(|(v, n)| (v.parse().expect("a number"), n.parse().expect("a number")))
                .collect();
            let own = normal([0, 1, 2].map(|at| &positions[corners[at].0 - 1]));
            let is_flat = own[2].abs() > 0.999_999;
            flat += usize::from(is_flat);
            for (_, at) in corners {
                let least = if is_flat { 1.0 - 1e-9 } else { 0.9 };
                above!(dot(&own, &normals[at - 1]), least, "{line}: {own:?}");
            }
        }
        assert!(flat > 20, "{flat}");
    }

    let line = format!("refine {{}} -o {{}} {}", options.replace("--quiet", ""));
    let said = run(&line, &[&input, &ply]);
    said.expect(0).saying("--split-normals");
    assert!(!text(&ply).contains(" nx\n"));
    let options = format!("{options} --split-normals");
    let line = format!("refine {{}} -o {{}} {options} --provenance");
    done(&line, &[&input, &split]);
    let text = text(&split);
    let (header, body) = text.split_once("end_header\n").expect("a header");
    assert!(header.contains("nx\n") && header.contains("parent_a\n"));
    let rows: Vec<Vec<f64>> = body.lines().map(numbers).collect();
    let vertices: Vec<&Vec<f64>> = rows.iter().take_while(|row| row.len() > 6).collect();
    let faces = &rows[vertices.len()..];
    assert!(faces.len() > 50);
    for face in faces {
        let corners = [1, 2, 3].map(|at| vertices[face[at] as usize]);
        let own = normal(corners);
        for corner in corners {
            assert!(dot(&own, &corner[3..6]) > 0.9, "{own:?} {corner:?}");
        }
    }
    let line = format!("refine {{}} -o {{}} {options}");
    usage_error(&line, &[&input, &stl], "--split-normals");
}
