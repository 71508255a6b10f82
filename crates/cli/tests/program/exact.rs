//! `refine --method exact`, the default: goals, caps, the certified error, where vertices came from.

use std::path::Path;

use serde_json::{Value, json};

use crate::common::{
    claimed, count, counts, done, file, folder, json_of, list, number, run, soup, text, usage_error,
};

/// Refines to an exit code and gives the report, after checking that it fits the file and itself.
#[track_caller]
fn refine(code: i32, input: &str, output: &Path, options: &str) -> Value {
    let line = format!("refine {input} -o {{}} --report - {options}");
    let report = run(&line, &[output]).expect(code).json();
    assert_eq!(report["parameters"]["method"], "exact");
    assert_eq!(
        claimed(&report["output"]),
        counts(&soup(output)),
        "{input} {options}"
    );
    assert_eq!(report["output"]["t_junctions"], 0);
    let error = &report["error"];
    let is_of_distance =
        options.contains("tolerance") || options.contains("triangles") || options.is_empty();
    if error["upper"].is_null() && !is_of_distance {
        // Where nothing was asked of distances, what can be proven may not be worth reporting.
        assert_eq!(
            (&error["upper_percent"], &error["certified"]),
            (&Value::Null, &json!(false))
        );
    } else {
        at_most!(number(&error["lower"]), number(&error["upper"]), "{error}");
        let percent = 100.0 * number(&error["upper"]) / number(&error["diagonal"]);
        assert!((percent - number(&error["upper_percent"])).abs() < 1e-12 * percent);
        assert_eq!(error["certified"], true);
    }
    let rounds = list(&report["rounds"]);
    for (i, round) in rounds.iter().enumerate() {
        assert_eq!(round["round"], i + 1);
    }
    report
}

fn triangles(report: &Value) -> u64 {
    count(&report["output"]["triangles"])
}

#[test]
fn a_thousandth_of_the_diagonal_is_kept_by_default() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let report = refine(0, "builtin:cup", &output, "");
    let info = json_of("info builtin:cup --json", &[]);
    let diagonal = number(&info["mesh"]["bounding_box"]["diagonal"]);
    let expected = json!({
        "tolerance": 0.1 / 100.0 * diagonal, "tolerance_percent": 0.1, "triangles": null, "pixels": null,
        "cameras": [], "balance": false, "optimize": false, "divide_flat": false, "max_levels": 24, "max_memory": null,
        "provenance": false
    });
    assert_eq!(report["parameters"]["exact"], expected);
    assert_eq!(report["parameters"]["levels"], Value::Null);
    assert_eq!(report["parameters"]["angle_degrees"], Value::Null);
    assert_eq!(
        (&report["stop"], &report["steps"]),
        (&json!("met"), &json!([]))
    );
    assert!(number(&report["error"]["upper_percent"]) <= 0.1);
    assert_eq!(report["output"]["watertight"], info["mesh"]["watertight"]);
    let said = done("refine builtin:cup -o {}", &[&output]);
    says!(said.stderr, " % of the diagonal (");
    says!(said.stderr, "certified; at least 0.0");
}

#[test]
fn the_interval_holds_what_samples_find() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let report = refine(0, "builtin:head", &output, "--tolerance 0.5%");
    let measured = json_of("measure {} --limit-of builtin:head --json", &[&output]);
    let sampled = number(&measured["hausdorff"]["symmetric"]);
    let (lower, upper) = (
        number(&report["error"]["lower"]),
        number(&report["error"]["upper"]),
    );
    // Five levels of uniform refinement approximate the surface: a few hundredths of a per cent of the error off.
    assert!(sampled <= 1.01 * upper, "{sampled} {upper}");
    assert!(sampled >= 0.9 * lower, "{sampled} {lower}");
    assert!(upper <= number(&report["parameters"]["exact"]["tolerance"]));
}

#[test]
fn a_number_of_triangles_is_used_up_and_not_passed() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let few = refine(0, "builtin:shoe", &output, "--triangles 3000");
    let many = refine(0, "builtin:shoe", &output, "--triangles 12000");
    for (report, wanted) in [(&few, 3000), (&many, 12000)] {
        assert_eq!(report["stop"], "triangles");
        at_most!(triangles(report), wanted);
        above!(triangles(report), wanted * 9 / 10);
    }
    // Four times the triangles: about a quarter of the distance.
    assert!(number(&many["error"]["upper"]) < 0.5 * number(&few["error"]["upper"]));
    // Whichever comes first ends it.
    let met = refine(
        0,
        "builtin:shoe",
        &output,
        "--triangles 100000 --tolerance 1%",
    );
    assert_eq!(met["stop"], "met");
    assert!(triangles(&met) < 10_000 && number(&met["error"]["upper_percent"]) <= 1.0);
    assert_eq!(
        refine(
            0,
            "builtin:shoe",
            &output,
            "--triangles 3000 --tolerance 0.001%"
        )["stop"],
        "triangles"
    );
    let too_few = refine(3, "builtin:shoe", &output, "--triangles 1");
    let control = limitmesh_models::find("shoe")
        .expect("a model")
        .soup()
        .faces
        .len() as u64;
    assert_eq!(triangles(&too_few), control);
}

#[test]
fn what_no_machine_can_meet_ends_in_a_conforming_mesh() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for tolerance in ["1e-300", "1e-12%"] {
        let caps = [
            ("--max-triangles 5000", "triangle-cap"),
            ("--levels 2", "level-cap"),
            ("--max-memory 2M", "memory-cap"),
        ];
        for (cap, stop) in caps {
            let options = format!("--tolerance {tolerance} {cap}");
            let report = refine(3, "builtin:cup", &output, &options);
            assert_eq!(report["stop"], stop, "{options}");
            assert_eq!(report["output"]["watertight"], true);
            match stop {
                "triangle-cap" => assert!(triangles(&report) <= 5000 && triangles(&report) > 2000),
                "level-cap" => assert_eq!(report["levels"], 2),
                // Each triangle takes more than the 86 bytes of its indices, twins, positions and normals.
                _ => assert!(triangles(&report) < (2 << 20) / 86 && triangles(&report) > 700),
            }
            let line = format!("refine builtin:cup -o {{}} -q {options}");
            let told = run(&line, &[&output]).expect(3);
            let cap = cap.replace("5000", "5,000").replace("2M", "2.0 MiB");
            says!(told.stderr, &cap);
            says!(told.stderr, "before the tolerance of 1e-");
            assert!(told.stderr.contains("was written with"), "{}", told.stderr);
        }
    }
}

#[test]
fn cameras_see_the_detail() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let camera = |eye: &str| format!("--view {eye},0,0,0,0,1,0,40,800x600");
    let front = refine(
        0,
        "builtin:sphere",
        &output,
        &format!("--pixels 0.5 {}", camera("0,0,5")),
    );
    assert_eq!(front["parameters"]["exact"]["pixels"], 0.5);
    let seen = json!([{
        "eye": [0.0, 0.0, 5.0], "target": [0.0, 0.0, 0.0], "up": [0.0, 1.0, 0.0], "fov_degrees": 40.0, "width": 800,
        "height": 600
    }]);
    assert_eq!(front["parameters"]["exact"]["cameras"], seen);
    assert_eq!(front["stop"], "met");
    at_most!(number(&front["pixels"]), 0.5);
    above!(number(&front["pixels"]), 0.05);
    let words = format!(
        "refine builtin:sphere -o {{}} --pixels 0.5 {}",
        camera("0,0,5")
    );
    done(&words, &[&output]).saying("pixels as the cameras see it");
    // Most of the detail is on the side of the camera.
    let centres = soup(&output);
    let in_front = centres
        .faces
        .iter()
        .filter(|face| {
            face.iter()
                .map(|&v| centres.positions[v as usize][2])
                .sum::<f64>()
                > 0.0
        })
        .count();
    above!(in_front * 2, centres.faces.len() * 11 / 10);
    // From farther away less is needed, for two cameras more than for one, of one pixel where nothing is said.
    let far = refine(
        0,
        "builtin:sphere",
        &output,
        &format!("--pixels 0.5 {}", camera("0,0,50")),
    );
    assert!(triangles(&far) < triangles(&front));
    let both = format!("--pixels 0.5 {} {}", camera("0,0,5"), camera("0,0,-5"));
    let both = refine(0, "builtin:sphere", &output, &both);
    assert!(triangles(&both) > triangles(&front));
    assert_eq!(
        refine(0, "builtin:sphere", &output, &camera("0,0,5"))["parameters"]["exact"]["pixels"],
        1.0
    );
    // The same from a file.
    let lines = "# two cameras\n0,0,5, 0,0,0, 0,1,0, 40, 800x600 # the front\n\n0,0,-5,0,0,0,0,1,0,40,800x600\n";
    let path = file(&folder, "path.txt", lines);
    let words = "refine builtin:sphere -o {} --pixels 0.5 --view {} --report -";
    let report = json_of(words, &[&output, &path]);
    assert_eq!(triangles(&report), triangles(&both));
}

#[test]
fn cameras_that_cannot_be_used_are_refused() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let path = file(
        &folder,
        "path.txt",
        "0,0,5,0,0,0,0,1,0,40,800x600\n0,0,5,0,0,0,0,0,0,40,800x600\n",
    );
    let words = "refine builtin:sphere -o {} --view {}";
    run(words, &[&output, &path])
        .expect(1)
        .saying("path.txt, line 2")
        .saying("upward direction");
    let empty = file(&folder, "empty.txt", "# nothing\n");
    run(words, &[&output, &empty])
        .expect(1)
        .saying("empty.txt has no camera");
    run(words, &[&output, &folder.path().join("none.txt")])
        .expect(1)
        .saying("none.txt cannot be read");
    let inside = "refine builtin:sphere -o {} --view 0,0,0.1,0,0,5,0,1,0,40,800x600";
    usage_error(inside, &[&output], "stands inside the mesh");
    assert!(!output.exists());
}

#[test]
fn a_view_makes_the_angle_depend_on_the_viewer() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let all = refine(0, "builtin:icosphere", &output, "--angle 3");
    // Triangles of the half that looks away from a viewer who looks down from above.
    let behind = || {
        let soup = soup(&output);
        let low = |face: &[u32]| face.iter().all(|&v| soup.positions[v as usize][2] < -0.5);
        soup.faces.iter().filter(|face| low(face)).count()
    };
    let behind_all = behind();
    let seen = refine(
        0,
        "builtin:icosphere",
        &output,
        "--angle 3 --view 0,0,-1 --dilatation 2",
    );
    assert!(behind() < behind_all, "{} {behind_all}", behind());
    assert!(triangles(&all) > 1000);
    assert_eq!(seen["parameters"]["view"]["dilatation"], 2.0);
}

#[test]
fn a_dry_run_predicts_and_writes_nothing() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for tolerance in ["0.1%", "0.01%"] {
        let words = format!("refine builtin:cup --tolerance {tolerance} --dry-run");
        let predicted = json_of(&format!("{words} --report -"), &[]);
        let estimate = number(&predicted["estimate"]["triangles"]);
        let found = triangles(&refine(
            0,
            "builtin:cup",
            &output,
            &format!("--tolerance {tolerance}"),
        )) as f64;
        assert!(
            (0.5..2.0).contains(&(estimate / found)),
            "{tolerance}: {estimate} {found}"
        );
        let text = done(&words, &[]).stdout;
        says!(text, "triangles");
        says!(text, "nothing was written");
    }
    std::fs::remove_file(&output).expect("removable");
    done("refine builtin:cup -o {} --dry-run", &[&output]);
    assert!(!output.exists());
}

/// The rows of numbers of an ASCII PLY file's two elements, and the names of the vertices' properties.
fn rows(path: &Path) -> (Vec<String>, Vec<Vec<f64>>, Vec<Vec<f64>>) {
    let text = text(path);
    let (header, body) = text.split_once("end_header\n").expect("a header");
    let (vertex, face) = header.split_once("element face ").expect("faces");
    assert!(face.contains("property int parent_face"));
    let names = vertex
        .lines()
        .filter_map(|line| line.strip_prefix("property ")?.split(' ').next_back());
    let count: usize = vertex
        .split("element vertex ")
        .nth(1)
        .and_then(|rest| rest.lines().next()?.parse().ok())
        .expect("a count");
    let mut rows: Vec<Vec<f64>> = body
        .lines()
        .map(|line| {
            line.split(' ')
                .map(|x| x.parse().expect("a number"))
                .collect()
        })
        .collect();
    let faces = rows.split_off(count);
    (names.map(str::to_owned).collect(), rows, faces)
}

#[test]
fn vertices_and_triangles_know_where_they_came_from() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    refine(
        0,
        "builtin:cube",
        &output,
        "--tolerance 0.5% --ascii --provenance --scheme loop",
    );
    let (names, vertices, faces) = rows(&output);
    assert_eq!(
        names[6..],
        [
            "parent_face",
            "parent_a",
            "parent_b",
            "parent_c",
            "input_face"
        ]
    );
    let control = limitmesh::Mesh::from_soup(
        &limitmesh_models::find("cube").expect("a model").soup(),
        &Default::default(),
    )
    .expect("a mesh")
    .0;
    let limits = limitmesh::limit::LimitTable::new(&limitmesh::scheme::Loop)
        .positions(&control)
        .expect("limit positions");
    let mut corners = 0;
    for vertex in &vertices {
        let barycentric = &vertex[7..10];
        assert_eq!(vertex[10], (vertex[6] / 2.0).floor());
        assert!(barycentric.iter().all(|b| (0.0..=1.0).contains(b)));
        assert_eq!(barycentric.iter().sum::<f64>(), 1.0);
        // A corner of a control face lies at the limit of that control vertex.
        if let Some(corner) = barycentric.iter().position(|&b| b == 1.0) {
            let limit = limits[control.triangles()[vertex[6] as usize][corner] as usize];
            assert!(
                (0..3).all(|axis| (limit[axis] - vertex[axis]).abs() < 1e-12),
                "{vertex:?} {limit:?}"
            );
            corners += 1;
        }
    }
    assert_eq!(corners, control.vertex_count());
    let mut parents = vec![0; control.face_count()];
    for face in &faces {
        assert_eq!((face.len(), face[0]), (6, 3.0));
        // The cube's six squares are cut into two triangles each, in their order.
        assert_eq!(face[5], (face[4] / 2.0).floor());
        parents[face[4] as usize] += 1;
        for &vertex in &face[1..4] {
            let vertex = &vertices[vertex as usize];
            // A corner of the triangle lies in its control face, or on an edge of a neighbour.
            assert!(
                vertex[6] == face[4] || vertex[7..10].contains(&0.0),
                "{vertex:?} {face:?}"
            );
        }
    }
    assert!(parents.iter().all(|&count| count > 0), "{parents:?}");
    // The file remains one that can be read.
    assert_eq!(soup(&output).faces.len(), faces.len());
    let plain = folder.path().join("plain.ply");
    done(
        "refine builtin:cube -o {} --tolerance 0.5% --provenance --scheme loop",
        &[&plain],
    );
    assert_eq!(soup(&plain).positions, soup(&output).positions);
}

/// Where masks may be negative nothing is proven, and nothing is called so.
#[test]
fn estimates_are_not_called_certified() {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let told = run(
        "refine builtin:cube -o {} --scheme butterfly --tolerance 1% --report -",
        &[&output],
    );
    let told = told.expect(0);
    let error = &told.json()["error"];
    assert_eq!(error["certified"], false);
    assert!(number(&error["upper_percent"]) <= 1.0);
    says!(told.stderr, "by samples, not certified");
}

/// Binary STL rounds coordinates: what it loses counts among the distance.
#[test]
fn what_a_format_rounds_is_part_of_the_distance() {
    let folder = folder();
    let cube = folder.path().join("far.obj");
    let mut text = String::new();
    for corner in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|axis| 500_000.37 + f64::from(corner >> axis & 1));
        text += &format!("v {x} {y} {z}\n");
    }
    for face in [
        [1, 3, 4, 2],
        [5, 6, 8, 7],
        [1, 2, 6, 5],
        [3, 7, 8, 4],
        [1, 5, 7, 3],
        [2, 4, 8, 6],
    ] {
        text += &format!("f {} {} {} {}\n", face[0], face[1], face[2], face[3]);
    }
    std::fs::write(&cube, text).expect("a folder to write to");
    let input = cube.to_str().expect("a name");
    let kept = refine(
        0,
        input,
        &folder.path().join("kept.ply"),
        "--tolerance 0.004 --faces triangles",
    );
    assert!(number(&kept["error"]["upper"]) <= 0.004);
    for (name, code) in [("rounded.stl", 3), ("kept.stl", 0)] {
        let output = folder.path().join(name);
        let options = if code == 0 {
            "--tolerance 0.004 --ascii"
        } else {
            "--tolerance 0.004"
        };
        let line = format!("refine {input} -o {{}} --report - {options}");
        let report = run(&line, &[&output]).expect(code).json();
        let told = number(&report["error"]["upper"]);
        assert_eq!(told > 0.004, code == 3, "{told}");
        let line = format!("measure {{}} --limit-of {input} --certified --json");
        let measured = run(&line, &[&output]);
        let lower = number(&measured.expect(0).json()["hausdorff"]["lower"]);
        assert!(lower <= told, "{lower} {told}");
        assert_eq!(lower > 0.004, code == 3, "{lower}");
    }
}
