//! Seams of glTF assets whose two sides differ by rounding: what closes them is said, and done where it is asked for.

use serde_json::json;

use crate::common::{data, folder, run};
use crate::glb::Glb;

#[test]
fn nearly_closed_seams_are_told_and_can_be_welded() {
    let folder = folder();
    let (input, output) = (data("web_sphere.glb"), folder.path().join("out.glb"));
    let told = run("refine {} -o {}", &[&input, &output]).expect(0);
    let advice = told
        .stderr
        .split("all of them would close with --weld ")
        .nth(1)
        .expect("advice");
    let distance = advice.split(',').next().expect("a distance");
    for distance in [distance, "1e-5"] {
        let command = format!("refine {{}} -o {{}} --tolerance 0.1% --report - --weld {distance}");
        let run = run(&command, &[&input, &output]).expect(0);
        assert!(!run.stderr.contains("would close"), "{}", run.stderr);
        let report = run.json();
        let written = &report["meshes"][0]["output"];
        assert_eq!(
            (&written["boundary_edges"], &written["euler_characteristic"]),
            (&json!(0), &json!(2))
        );
        // No notch: all vertices are as far out as a sphere's limit is, and the texture's seam is still there.
        let glb = Glb::read(&output);
        let attributes = &glb.primitive(0)["attributes"];
        let points = glb.points(&attributes["POSITION"]);
        let radii: Vec<f64> = points
            .iter()
            .map(|p| p.iter().map(|x| x * x).sum::<f64>().sqrt())
            .collect();
        let [least, most] = [
            radii.iter().copied().fold(f64::MAX, f64::min),
            radii.iter().copied().fold(0.0, f64::max),
        ];
        assert!(least > 0.93 && most < 1.0, "radii from {least} to {most}");
        let texture = glb.numbers(&attributes["TEXCOORD_0"]);
        let across = glb
            .triangles(0)
            .into_iter()
            .map(|t| t.map(|v| texture[2 * v as usize]));
        assert!(
            across
                .clone()
                .all(|[a, b, c]| a.max(b).max(c) - a.min(b).min(c) < 0.5)
        );
    }
}
