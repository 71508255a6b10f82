//! Units of files: 3MF packages say theirs to every command, glTF documents are in metres, and what goes from one to the other keeps its size;
//! areas and volumes are those of what is shown.

use std::io::{Cursor, Read};
use std::path::Path;

use zip::ZipArchive;

use crate::common::{OCTAHEDRON, bytes, data, done, file, folder, number, soup, usage_error};
use crate::glb::Glb;
use crate::package;

#[test]
fn lengths_are_in_the_unit_of_the_package_for_all_formats() {
    let folder = folder();
    let input = data("ball_inch.3mf");
    // 0.05 mm of a ball with a radius of an inch.
    for name in ["out.stl", "out.ply", "out.glb", "out.3mf"] {
        let output = folder.path().join(name);
        done("refine {} -o {} --tolerance 0.05mm", &[&input, &output]);
        assert_eq!(soup(&output).faces.len(), 5000, "{name}");
        done(
            "refine {} -o {} --tolerance 0.05mm --unit in",
            &[&input, &output],
        );
        usage_error(
            "refine {} -o {} --tolerance 0.05mm --unit mm",
            &[&input, &output],
            "says that it is in in",
        );
    }
    done(
        "refine {} -o {} --tolerance 0.05mm",
        &[&input, &folder.path().join("out.stl")],
    )
    .saying("its numbers are in");
    // A package says a unit, though the file says none.
    let output = folder.path().join("out.3mf");
    let input = file(&folder, "octahedron.obj", OCTAHEDRON);
    done("refine {} -o {}", &[&input, &output]).saying("in mm, as its format has a unit");
}

#[test]
fn every_command_knows_the_unit_of_a_package() {
    let folder = folder();
    let (input, output) = (data("ball_inch.3mf"), folder.path().join("out.ply"));
    let levels = folder.path().join("levels.glb");
    let picture = folder.path().join("out.png");
    let commands = [
        ("info {} --weld 0.001mm", &[&input][..]),
        ("measure {} {} --certified --gap 0.1mm", &[&input, &input]),
        (
            "measure {} --limit-of {} --interpolate=0.1mm --reference-levels 2",
            &[&input, &input],
        ),
        (
            "project {} --onto {} --tolerance 0.1mm -o {}",
            &[&input, &input, &output],
        ),
        ("evaluate {} --at 0,1,0,0 --interpolate=0.1mm", &[&input]),
        (
            "lod {} -o {} --levels 2 --tolerance 1mm",
            &[&input, &levels],
        ),
        ("render {} -o {} --weld 0.001mm", &[&input, &picture]),
    ];
    for (command, paths) in commands {
        let paths: Vec<&Path> = paths.iter().map(|path| path.as_path()).collect();
        done(command, &paths);
        let line = format!("{command} --unit mm");
        usage_error(&line, &paths, "says that it is in in");
    }
    let scale = &Glb::read(&levels).json["nodes"][0]["scale"];
    assert_eq!(scale, &serde_json::json!([0.0254, 0.0254, 0.0254]));
}

/// The distance of the farthest point from the middle.
fn radius(points: impl Iterator<Item = [f64; 3]>) -> f64 {
    points
        .map(|p| p.iter().map(|x| x * x).sum::<f64>().sqrt())
        .fold(0.0, f64::max)
}

/// The unit that a package names.
fn unit(path: &Path) -> String {
    let mut archive = ZipArchive::new(Cursor::new(bytes(path))).expect("an archive");
    let mut text = String::new();
    archive
        .by_name("3D/3dmodel.model")
        .expect("a model")
        .read_to_string(&mut text)
        .expect("text");
    text.split("unit=\"")
        .nth(1)
        .and_then(|rest| rest.split('"').next())
        .expect("a unit")
        .to_owned()
}

#[test]
fn metres_of_documents_and_millimetres_of_packages_are_the_same_size() {
    let folder = folder();
    let input = data("ball_mm.3mf");
    let path = |name: &str| folder.path().join(name);
    let (package, document, back, plain) =
        (path("a.3mf"), path("a.glb"), path("b.3mf"), path("c.3mf"));
    done("refine {} -o {} --tolerance 0.05mm", &[&input, &package]);
    done("refine {} -o {} --tolerance 0.05mm", &[&input, &document]).saying("scales the mm");
    let glb = Glb::read(&document);
    let scale = number(&glb.json["nodes"][0]["scale"][0]);
    let points = glb.points(&glb.primitive(0)["attributes"]["POSITION"]);
    let expected = radius(
        package::triangles(&package)
            .into_iter()
            .flat_map(|own| own.0),
    );
    let shown = scale * radius(points.into_iter());
    assert!(
        (1000.0 * shown - expected).abs() < 1e-5 && (8.0..10.0).contains(&expected),
        "{shown} {expected}"
    );
    // The other way, and with the unit that somebody says.
    done("refine {} -o {} --tolerance 10m", &[&document, &back]).saying("in mm, 1000");
    done(
        "refine {} -o {} --tolerance 10m --unit cm",
        &[&document, &plain],
    );
    for (path, of_metres, name) in [(&back, 1000.0, "millimeter"), (&plain, 1.0, "centimeter")] {
        let found = radius(package::triangles(path).into_iter().flat_map(|own| own.0));
        assert!(
            (0.9 * shown..shown).contains(&(found / of_metres)),
            "{found} of {shown} m"
        );
        assert_eq!(unit(path), name);
    }
    // A measure knows both units.
    let run = done("measure {} {} --json", &[&package, &document]).saying("its mm are taken to m");
    let distance = number(&run.json()["hausdorff"]["symmetric"]);
    assert!(distance < 1e-8, "{distance} m");
}
