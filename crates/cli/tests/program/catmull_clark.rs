//! Cages of polygons by Catmull–Clark's scheme.

use limitmesh::mesh::Semantic;

use crate::common::{done, file, folder, json_file, json_of, number, soup, usage_error};

/// A cube with texture coordinates and a sharp edge.
const CUBE: &str = "\
v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1
vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1
f 1/1 3/2 4/3 2/4\nf 5/1 6/2 8/3 7/4\nf 1/1 2/2 6/3 5/4\nf 3/1 7/2 8/3 4/4\nf 1/1 5/2 7/3 3/4\nf 2/1 4/2 8/3 6/4
";

#[test]
fn a_cage_is_refined_measured_and_keeps_its_texture_coordinates() {
    let place = folder();
    let cage = file(&place, "cube.obj", CUBE);
    let (out, report) = (place.path().join("out.obj"), place.path().join("out.json"));
    let words = "refine {} -o {} --scheme catmull-clark --tolerance 1% --report {}";
    done(words, &[&cage, &out, &report]).saying("of the limit surface, certified");
    let upper = number(&json_file(&report)["error"]["upper"]);
    // The middle of a face goes to 68/81.
    let positions = soup(&out).positions;
    let farthest = positions
        .iter()
        .flatten()
        .fold(0.0f64, |most, x| most.max(x.abs()));
    assert!((farthest - 68.0 / 81.0).abs() < 1e-9, "{farthest}");
    assert!(
        soup(&out)
            .channels
            .iter()
            .any(|channel| channel.semantic == Semantic::TextureCoordinates)
    );
    let measured = json_of(
        "measure {} --limit-of {} --scheme catmull-clark --json",
        &[&out, &cage],
    );
    assert!(number(&measured["hausdorff"]["symmetric"]) <= 1.01 * upper);
    assert!(upper < 0.035, "{upper}");
}

/// Quads come out unless triangles are asked for, in files that hold them; uniform meshes have no triangles at all.
#[test]
fn quads_come_out() {
    let place = folder();
    let cage = file(&place, "cube.obj", CUBE);
    let report = place.path().join("out.json");
    let quads = |name: &str, words: &str| {
        let out = place.path().join(name);
        let words = format!("refine {{}} -o {{}} --scheme catmull-clark --report {{}} {words}");
        done(&words, &[&cage, &out, &report]);
        let sides: Vec<usize> = soup(&out).faces.iter().map(<[u32]>::len).collect();
        let quads = sides.iter().filter(|&&sides| sides == 4).count();
        let output = &json_file(&report)["output"];
        assert_eq!(number(&output["quads"]) as usize, quads, "{name}");
        assert_eq!(
            number(&output["triangles"]) as usize,
            sides.len() + quads,
            "{name}"
        );
        (quads, sides.len())
    };
    for name in ["out.obj", "out.ply", "out.off"] {
        let (quads, faces) = quads(name, "--tolerance 0.5%");
        assert!(
            quads > faces / 2 && quads < faces,
            "{name}: {quads} of {faces}"
        );
    }
    assert_eq!(
        quads("uniform.ply", "--method uniform --levels 2 --limit"),
        (96, 96)
    );
    assert_eq!(
        quads("triangles.ply", "--tolerance 1% --faces triangles").0,
        0
    );
    assert_eq!(quads("out.stl", "--tolerance 1%").0, 0);
    assert_eq!(quads("angle.ply", "--angle 10").0, 0);
    let out = place.path().join("out.glb");
    let words = "refine {} -o {} --scheme catmull-clark --faces quads";
    usage_error(words, &[&cage, &out], "the others hold triangles");
    let words = "refine {} -o {} --overwrite --faces quads --scheme loop";
    usage_error(
        words,
        &[&cage, &place.path().join("out.ply")],
        "catmull-clark",
    );
}

#[test]
fn polygons_of_any_size_are_divided_and_what_is_for_triangles_is_refused() {
    let place = folder();
    let mixed = CUBE.replace("f 2/1 4/2 8/3 6/4", "f 2 4 8\nf 2 8 6");
    let (cage, out) = (
        file(&place, "mixed.obj", &mixed),
        place.path().join("out.ply"),
    );
    for goal in [
        "--triangles 500",
        "--balance",
        "--angle 8",
        "--method uniform --levels 2 --limit",
    ] {
        done(
            &format!("refine {{}} -o {{}} --overwrite --scheme catmull-clark {goal}"),
            &[&cage, &out],
        );
    }
    for refused in ["--method limit-normal", "--within 0.1", "--optimize"] {
        let words = format!("refine {{}} -o {{}} --overwrite --scheme catmull-clark {refused}");
        usage_error(&words, &[&cage, &out], "triangles");
    }
}

#[test]
fn points_are_projected_and_pictures_drawn_by_rays() {
    let place = folder();
    let cage = file(&place, "cube.obj", CUBE);
    let points = file(&place, "points.csv", "0 0 3\n0 0.5 0\n");
    let words = "project {} --onto {} --scheme catmull-clark --json";
    let report = json_of(words, &[&points, &cage]);
    assert_eq!(report["sign"], "inside");
    let [greatest, least] = ["greatest", "least"].map(|end| number(&report["distance"][end]));
    // The middle of a face goes to 68/81.
    assert!((greatest - (3.0 - 68.0 / 81.0)).abs() < 1e-6, "{greatest}");
    assert!(least < -0.3 && least > -68.0 / 81.0, "{least}");
    let picture = place.path().join("cube.png");
    done(
        "render {} -o {} --exact --scheme catmull-clark --size 60x40",
        &[&cage, &picture],
    )
    .saying("12 control faces");
    assert!(picture.metadata().is_ok_and(|data| data.len() > 500));
}

/// Edges of triangles have the weights that OpenSubdiv gives them: the middles of a tetrahedron's are nearer to its centre.
#[test]
fn smooth_triangles_are_for_catmull_clark_alone() {
    let place = folder();
    let tetrahedron =
        "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
    let cage = file(&place, "tetrahedron.obj", tetrahedron);
    let (out, report) = (place.path().join("out.ply"), place.path().join("out.json"));
    let words = "refine {} -o {} --scheme catmull-clark --smooth-triangles --method uniform --levels 0 --report {}";
    done(words, &[&cage, &out, &report]);
    // ((½ − 0.47) · 2 + 0.47 · ⅔) towards the edge's own middle.
    let is_middle =
        |p: &&[f64; 3]| (p[0] - 28.0 / 75.0).abs() < 1e-6 && p[1].abs() + p[2].abs() < 1e-6;
    assert_eq!(soup(&out).positions.iter().filter(is_middle).count(), 1);
    assert_eq!(json_file(&report)["parameters"]["smooth_triangles"], true);
    let measure = "measure {} --limit-of {} --json --scheme catmull-clark";
    done(
        "refine {} -o {} --overwrite --scheme catmull-clark --smooth-triangles --tolerance 0.5%",
        &[&cage, &out],
    );
    let near = json_of(&format!("{measure} --smooth-triangles"), &[&out, &cage]);
    let far = json_of(measure, &[&out, &cage]);
    let distance = |of: &serde_json::Value| number(&of["hausdorff"]["symmetric"]);
    assert!(distance(&near) < 0.2 * distance(&far), "{near} {far}");
    usage_error(
        "refine {} -o {} --overwrite --scheme loop --smooth-triangles",
        &[&cage, &out],
        "--scheme catmull-clark",
    );
    usage_error(
        "measure {} --limit-of {} --scheme loop --smooth-triangles",
        &[&out, &cage],
        "--scheme catmull-clark",
    );
}

/// What is not in the surface is said by the file's own faces.
#[test]
fn repairs_of_cages_name_the_file_s_faces() {
    let place = folder();
    let vertices = "v -1 -3 -1\nv 1 -3 -1\nv 7 7 7";
    let faces = "f 2/1 6/2 8/3 4/4\nf 1/1 1/2 2/3\nf 1/1 2/2 9/3 10/4\n";
    let bad = format!("{CUBE}{vertices}\n{faces}");
    let cage = file(&place, "bad.obj", &bad);
    let (out, report) = (place.path().join("out.ply"), place.path().join("out.json"));
    let words = "refine {} -o {} --scheme catmull-clark --tolerance 1% --report {}";
    done(words, &[&cage, &out, &report]).saying("1 face that repeats another: left out (face 6)");
    let found = &json_file(&report)["diagnosis"];
    assert_eq!(found["collapsed_faces"]["first"][0], 7);
    assert_eq!(found["non_manifold_edges"]["count"], 1);
    assert_eq!(found["isolated_vertices"]["first"][0], 10);
    assert_eq!(found["polygons"]["count"], 0);
}

/// A file whose faces are quads for the most part has Catmull–Clark's surface, in whatever asks for a surface, unless an option is for
/// triangles; creases by angle are those of the polygons.
#[test]
fn the_faces_of_a_file_decide() {
    let place = folder();
    let mixed = CUBE.replace("f 2/1 4/2 8/3 6/4", "f 2 4 8\nf 2 8 6");
    let cage = file(&place, "mixed.obj", &mixed);
    let [out, report] = ["out.ply", "out.json"].map(|name| place.path().join(name));
    let scheme = |words: &str| {
        let words = format!("refine {{}} -o {{}} --overwrite --report {{}} {words}");
        let said = done(&words, &[&cage, &out, &report]).stderr;
        let scheme = json_file(&report)["parameters"]["scheme"].clone();
        (
            said.contains("quads for the most part"),
            said.contains("cut into triangles"),
            scheme,
        )
    };
    assert_eq!(scheme(""), (true, false, "catmull-clark".into()));
    assert_eq!(scheme("--scheme loop"), (false, false, "loop".into()));
    assert_eq!(scheme("--optimize"), (false, true, "loop".into()));
    scheme("--tolerance 0.2%");
    let measured = json_of("measure {} --limit-of {} --json", &[&out, &cage]);
    assert!(
        number(&measured["hausdorff"]["symmetric"]) < 1e-2,
        "{measured}"
    );
    let other = json_of(
        "measure {} --limit-of {} --scheme loop --json",
        &[&out, &cage],
    );
    assert!(number(&other["hausdorff"]["symmetric"]) > 3e-2, "{other}");
    // All edges of the cube are sharp, and none that the step makes.
    scheme("--crease-angle 30");
    let positions = soup(&out).positions;
    assert!(
        positions
            .iter()
            .all(|p| p.iter().any(|x| (x.abs() - 1.0).abs() < 1e-12))
    );
    assert!(
        positions
            .iter()
            .any(|p| p.iter().all(|x| (x.abs() - 1.0).abs() < 1e-12))
    );
}
