//! `project`: points against the limit surface, in text, JSON and files.

use crate::common::{OCTAHEDRON, done, file, folder, is_png, json_of, number, run, text};

#[track_caller]
fn near(found: &serde_json::Value, expected: f64) {
    let found = number(found);
    assert!((found - expected).abs() < 1e-6, "{found} and {expected}");
}

/// The limit of a vertex of valence 4 is 24/55 of it: along the axes nothing is nearer from outside.
#[test]
fn points_along_the_axes_of_an_octahedron() {
    let folder = folder();
    let control = file(&folder, "octahedron.obj", OCTAHEDRON);
    let points = file(
        &folder,
        "points.csv",
        "x,y,z\n2,0,0\n0,-3,0\n0.3,0,0 # inside\n",
    );
    let out = folder.path().join("out.csv");
    let found = json_of(
        "project {} --onto {} -o {} --json",
        &[&points, &control, &out],
    );
    assert_eq!(
        (&found["points"]["count"], &found["sign"]),
        (&3.into(), &"inside".into())
    );
    let distance = &found["distance"];
    let corner = 24.0 / 55.0;
    near(&distance["greatest"], 3.0 - corner);
    near(&distance["farthest"]["closest"][1], -corner);
    assert_eq!(
        (&distance["farthest"]["index"], &distance["negative"]),
        (&1.into(), &1.into())
    );
    near(&distance["median"], 2.0 - corner);
    // As a table, with the distance of the point inside below 0 and no more than its way along the axis.
    let table = text(&out);
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .map(|word| word.parse().expect("a number"))
                .collect()
        })
        .collect();
    assert!(table.starts_with("x,y,z,distance,closest_x,"), "{table}");
    assert_eq!((rows.len(), rows[0].len()), (3, 11));
    assert!((rows[0][3] - (2.0 - corner)).abs() < 1e-6);
    assert!(rows[2][3] < 0.0 && rows[2][3] > 0.3 - corner - 3.5e-6);
    let text = done("project {} --onto {}", &[&points, &control]).stdout;
    assert!(text.contains("RMS") && text.contains("1 inside"), "{text}");
}

/// A scan with its triangles: coloured, with places and closest points that evaluate finds again.
#[test]
fn a_scan_keeps_its_vertices_and_triangles() {
    let folder = folder();
    let control = file(&folder, "octahedron.obj", OCTAHEDRON);
    let scan = file(
        &folder,
        "scan.obj",
        "v 0.5 0.1 0\nv 0 0.5 0.1\nv 0.1 0 0.5\nf 1 2 3\n",
    );
    let out = folder.path().join("map.ply");
    done("project {} --onto {} -o {}", &[&scan, &control, &out]);
    let soup = limitmesh_io::read(&out).expect("a mesh");
    assert_eq!(
        soup.positions,
        [[0.5, 0.1, 0.0], [0.0, 0.5, 0.1], [0.1, 0.0, 0.5]]
    );
    assert_eq!(soup.faces.len(), 1);
    let value = |name: &str, vertex: usize| {
        let channel = soup.channels.iter().find(|channel| channel.name == name);
        channel
            .unwrap_or_else(|| panic!("no {name}: {:?}", soup.channels))
            .value(vertex)[0]
    };
    for vertex in 0..3 {
        let face = value("control_face", vertex);
        let weights = ["w0", "w1", "w2"].map(|name| value(name, vertex));
        let place = format!("{face},{},{},{}", weights[0], weights[1], weights[2]);
        let there = json_of(&format!("evaluate {{}} --at {place} --json"), &[&control]);
        for (axis, name) in ["closest_x", "closest_y", "closest_z"]
            .into_iter()
            .enumerate()
        {
            near(&there[0]["point"][axis], value(name, vertex));
        }
        assert!(value("quality", vertex) > 0.0);
    }
    let picture = folder.path().join("map.png");
    done("project {} --onto {} -o {}", &[&scan, &control, &picture]);
    is_png(&picture);
}

#[test]
fn open_surfaces_have_two_sides() {
    let folder = folder();
    let points = file(&folder, "points.xyz", "0.5 0.3 2\n0.5 0.3 -1\n");
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let control = file(&folder, "square.obj", square);
    let found = json_of(
        "project {} --onto {} --boundary corners --json",
        &[&points, &control],
    );
    assert_eq!(found["sign"], "normal");
    near(&found["distance"]["greatest"], 2.0);
    near(&found["distance"]["least"], -1.0);
}

#[test]
fn what_cannot_be_is_told() {
    let folder = folder();
    let control = file(&folder, "octahedron.obj", OCTAHEDRON);
    let points = file(&folder, "points.xyz", "1 2 3\n4 five 6\n");
    let error = run("project {} --onto {}", &[&points, &control])
        .expect(1)
        .stderr;
    says!(error, "points.xyz");
    says!(error, "line 2");
    let decimal = file(&folder, "decimal.csv", "x;y;z\n1,5;2,5;3,5\n");
    let error = run("project {} --onto {}", &[&decimal, &control])
        .expect(1)
        .stderr;
    says!(error, "decimal.csv");
    says!(error, "line 2");
    says!(error, "1,5");
    let short = file(&folder, "short.pts", "3\n1 2 3\n2 3 4\n");
    run("project {} --onto {}", &[&short, &control])
        .expect(1)
        .saying("line 1 promises 3 points, but there are 2");
    let none = file(&folder, "none.xyz", "# none\n");
    assert!(
        run("project {} --onto {}", &[&none, &control])
            .expect(1)
            .stderr
            .contains("no points")
    );
    let points = file(&folder, "points.txt", "1 2 3\n");
    let error = run("project {} --onto {} -o map.png", &[&points, &control])
        .expect(2)
        .stderr;
    assert!(error.contains("no triangles"), "{error}");
    assert!(
        run("project {} --onto {} -o map.stl", &[&points, &control])
            .expect(2)
            .stderr
            .contains(".ply")
    );
    let error = run(
        "project {} --onto {} --scheme butterfly",
        &[&points, &control],
    )
    .expect(2)
    .stderr;
    assert!(error.contains("butterfly"), "{error}");
    let error = run("project {} --onto {} --tolerance 0", &[&points, &control])
        .expect(2)
        .stderr;
    assert!(error.contains("tolerance"), "{error}");
}
