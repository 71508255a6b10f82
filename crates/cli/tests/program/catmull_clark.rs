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
