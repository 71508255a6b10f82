//! 3MF packages: lengths are the build's, triangles inherit what they carry, and what cannot be followed is reported.

use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};

use tempfile::TempDir;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use crate::common::{
    bytes, counts, done, folder, is_png, json_of, number, refuses, run, soup, usage_error,
};

const RELATIONSHIPS: &str = "<Relationships><Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" \
                             Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

/// Sides of the cube from -1 to 1, by their corners; those on low z first, on high z last.
const SIDES: [[usize; 4]; 6] = [
    [0, 2, 3, 1],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
    [4, 5, 7, 6],
];

/// A package with a cube, whose sides' triangles have the attributes `of_side`, more in its mesh, and these items of object 1.
fn cube(
    folder: &TempDir,
    name: &str,
    of_side: &dyn Fn(usize) -> String,
    more: &str,
    items: &str,
) -> PathBuf {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<model unit=\"centimeter\" xmlns=\"c\">\n<resources>\n",
    );
    text += "<m:colorgroup id=\"9\" xmlns:m=\"m\"><m:color color=\"#FF0000\"/></m:colorgroup>\n";
    text += "<object id=\"1\" name=\"Box\"><mesh><vertices>\n";
    for corner in 0..8 {
        let side = |bit: usize| if corner >> bit & 1 == 0 { -1 } else { 1 };
        text += &format!(
            "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n",
            side(0),
            side(1),
            side(2)
        );
    }
    text += "</vertices><triangles>\n";
    for (side, [a, b, c, d]) in SIDES.into_iter().enumerate() {
        for [a, b, c] in [[a, b, c], [a, c, d]] {
            text += &format!(
                "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"{}/>\n",
                of_side(side)
            );
        }
    }
    text += &format!(
        "</triangles>{more}</mesh></object>\n</resources>\n<build>{items}</build>\n</model>\n"
    );
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in [
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/3dmodel.model", &text),
        ("Metadata/a.config", "<a/>"),
    ] {
        writer
            .start_file(name, SimpleFileOptions::default())
            .expect("an archive");
        writer.write_all(text.as_bytes()).expect("an archive");
    }
    let path = folder.path().join(name);
    std::fs::write(&path, writer.finish().expect("an archive").into_inner()).expect("writable");
    path
}

const ITEM: &str = "<item objectid=\"1\"/>";

/// A triangle of a package's first object: its corners' positions, and the text of its tag.
pub(crate) type Triangle = ([[f64; 3]; 3], String);

/// The triangles of a package, read tag by tag.
pub(crate) fn triangles(path: &Path) -> Vec<Triangle> {
    let bytes = bytes(path);
    let mut archive = ZipArchive::new(Cursor::new(bytes)).expect("an archive");
    let mut text = String::new();
    archive
        .by_name("3D/3dmodel.model")
        .expect("a model")
        .read_to_string(&mut text)
        .expect("text");
    let tags = |name: &'static str| text.split('<').filter(move |tag| tag.starts_with(name));
    let positions: Vec<[f64; 3]> = tags("vertex ")
        .map(|tag| ["x", "y", "z"].map(|key| value(tag, key).parse().expect("a number")))
        .collect();
    let corners = |tag: &str| {
        ["v1", "v2", "v3"].map(|key| positions[value(tag, key).parse::<usize>().expect("an index")])
    };
    tags("triangle ")
        .map(|tag| (corners(tag), tag.to_owned()))
        .collect()
}

/// An attribute of a tag, empty without one.
fn value<'a>(tag: &'a str, key: &str) -> &'a str {
    tag.split_once(&format!(" {key}=\""))
        .and_then(|(_, rest)| rest.split('"').next())
        .unwrap_or_default()
}

/// The side of the cube that a triangle lies in.
fn side(corners: &[[f64; 3]; 3]) -> usize {
    let planes = [
        (2, -1.0),
        (1, -1.0),
        (1, 1.0),
        (0, -1.0),
        (0, 1.0),
        (2, 1.0),
    ];
    let found = planes
        .iter()
        .position(|&(axis, at)| corners.iter().all(|p| (p[axis] - at).abs() < 1e-9));
    found.expect("a side")
}

#[test]
fn triangles_inherit_what_their_side_carries() {
    let folder = folder();
    let output = folder.path().join("out.3mf");
    let of_side = |side: usize| {
        format!(
            " pid=\"9\" p1=\"{side}\" paint_color=\"{}\" x:own='&amp;'",
            ["", "4", "8", "0C", "1C", "2C"][side]
        )
    };
    let input = cube(&folder, "in.3mf", &of_side, "", ITEM);
    // With sharp edges the cube is itself; flat regions keep the sides apart, as these carry different things.
    done(
        "refine {} -o {} --crease-angle 30 --divide-flat --tolerance 1%",
        &[&input, &output],
    );
    let found = triangles(&output);
    assert!(found.len() >= 12);
    for (corners, tag) in &found {
        let rest = tag
            .split_once("\" pid")
            .map(|(_, rest)| rest.trim_end().trim_end_matches("/>"));
        let expected = of_side(side(corners));
        assert_eq!(rest, expected.strip_prefix(" pid"), "{tag}");
    }
    // The round cube: from each side two thirds and more of the surface where it was.
    done(
        "refine {} -o {} --tolerance 0.5% --crease-angle none",
        &[&input, &output],
    );
    let found = triangles(&output);
    assert!(found.len() > 100);
    for (corners, tag) in &found {
        let centre = [0, 1, 2].map(|i| corners.iter().map(|p| p[i]).sum::<f64>() / 3.0);
        let most = (0..3).fold(0, |best, i| {
            if centre[i].abs() > centre[best].abs() {
                i
            } else {
                best
            }
        });
        let others = (0..3)
            .filter(|&i| i != most)
            .map(|i| centre[i].abs())
            .fold(0.0, f64::max);
        if others < 0.3 * centre[most].abs() {
            let expected = [[3, 4], [1, 2], [0, 5]][most][usize::from(centre[most] > 0.0)];
            assert_eq!(value(tag, "p1"), expected.to_string(), "{corners:?}");
        }
    }
    // Left out on demand.
    done(
        "refine {} -o {} --channel paint_color=drop --channel x:own=drop",
        &[&input, &output],
    );
    assert!(
        triangles(&output)
            .iter()
            .all(|(_, tag)| !tag.contains("paint_color") && tag.contains("pid"))
    );
    refuses(
        &[("input", &input), ("output", &output)],
        "
        2 | refine {input} -o {output} --channel pid=linear | it can be nearest or drop
        2 | refine {input} -o {output} --channel colour=drop | no channel 'colour'; there are: p1; paint_color; pid; x:own",
    );
}

#[test]
fn paint_in_parts_is_taken_at_the_centre() {
    let folder = folder();
    let output = folder.path().join("out.3mf");
    // The top in four, the part in the middle painted 4, at the first corner 8.
    let of_side = |side: usize| {
        if side == 5 {
            " slic3rpe:mmu_segmentation=\"80043\"".to_owned()
        } else {
            String::new()
        }
    };
    let input = cube(&folder, "in.3mf", &of_side, "", ITEM);
    let found = done(
        "refine {} -o {} --tolerance 0.2% --crease-angle none",
        &[&input, &output],
    );
    found.saying("took paint at the centre");
    let found = triangles(&output);
    let paint = |tag: &str| value(tag, "slic3rpe:mmu_segmentation").to_owned();
    let painted: Vec<&Triangle> = found
        .iter()
        .filter(|(_, tag)| !paint(tag).is_empty())
        .collect();
    assert!(painted.iter().any(|(_, tag)| paint(tag) == "4"));
    assert!(painted.iter().any(|(_, tag)| paint(tag) == "8"));
    for (corners, tag) in painted {
        let [x, y, z] = [0, 1, 2].map(|i| corners.iter().map(|p| p[i]).sum::<f64>() / 3.0);
        assert!(z > 0.0, "{tag}");
        // Both triangles begin at the corner of low x and y.
        if paint(tag) == "8" {
            assert!(x < 0.1 && y < 0.1, "{x} {y}");
        }
    }
}

#[test]
fn lengths_are_the_builds() {
    let folder = folder();
    let output = folder.path().join("out.3mf");
    let plain = |_: usize| String::new();
    let small = cube(&folder, "small.3mf", &plain, "", ITEM);
    let large =
        "<item objectid=\"1\"/><item objectid=\"1\" transform=\"0 0 30 0 1 0 -1 0 0 100 0 0\"/>";
    let large = cube(&folder, "large.3mf", &plain, "", large);
    let [few, many] = [&small, &large].map(|input: &PathBuf| {
        done(
            "refine {} -o {} --tolerance 0.5mm --crease-angle none",
            &[input, &output],
        );
        triangles(&output).len()
    });
    assert!(many > 4 * few, "{many} and {few}");
    // The file says what it is in.
    usage_error(
        "refine {} -o {} --unit mm",
        &[&small, &output],
        "says that it is in cm",
    );
    let report = json_of(
        "refine {} -o {} --tolerance 0.5mm --report - --crease-angle none",
        &[&small, &output],
    );
    let mesh = &report["meshes"][0];
    assert_eq!(mesh["parameters"]["exact"]["tolerance"], 0.05);
    assert!(number(&mesh["error"]["upper"]) <= 0.05);
    // What another command finds between the files.
    let measured = json_of(
        "measure {} --limit-of {} --certified --json --crease-angle none",
        &[&output, &small],
    );
    assert!(number(&measured["hausdorff"]["upper"]) <= 0.0501);
    // All items together, in another format and from one.
    let stl = folder.path().join("out.stl");
    done("refine {} -o {} --tolerance 1%", &[&large, &stl]);
    assert!(soup(&stl).positions.iter().any(|p| p[0] > 90.0));
    assert!(soup(&stl).positions.iter().any(|p| p[0] < 1.0));
    let from = folder.path().join("from.3mf");
    done("refine builtin:cube -o {} --tolerance 1%", &[&from]);
    let read = soup(&from);
    assert_eq!(
        (
            counts(&read).boundary_edges,
            counts(&read).euler_characteristic
        ),
        (0, 2)
    );
    // The same package from and to streams of bytes.
    let picture = folder.path().join("out.png");
    done(
        "refine {} -o {} --tolerance 1% --picture {}",
        &[&large, &output, &picture],
    );
    is_png(&picture);
}

#[test]
fn what_cannot_be_followed_stays_and_is_told() {
    let folder = folder();
    let output = folder.path().join("out.3mf");
    let of_side = |side: usize| format!(" p1=\"{side}\"");
    let beams = cube(
        &folder,
        "beams.3mf",
        &of_side,
        "<b:beamlattice><b:beam v1=\"0\" v2=\"7\"/></b:beamlattice>",
        ITEM,
    );
    done("refine {} -o {}", &[&beams, &output]).saying(
        "object 1 'Box': kept as it is: b:beamlattice names its vertices or triangles by number",
    );
    assert_eq!(triangles(&output).len(), 12);
    let mixed = cube(&folder, "mixed.3mf", &of_side, "", ITEM);
    done("refine {} -o {} --optimize", &[&mixed, &output])
        .saying("its triangles carry different things");
    let told = done(
        "refine {} -o {} --method uniform --levels 1",
        &[&mixed, &output],
    )
    .stderr;
    silent!(told, "kept as it is");
    assert_eq!(triangles(&output).len(), 48);
    // What all triangles have in common can be followed anyway.
    let plain = cube(
        &folder,
        "plain.3mf",
        &|_| " pid=\"9\" p1=\"0\"".to_owned(),
        "",
        ITEM,
    );
    done(
        "refine {} -o {} --method uniform --levels 1",
        &[&plain, &output],
    );
    let found = triangles(&output);
    assert!(
        found.len() == 48
            && found
                .iter()
                .all(|(_, tag)| tag.contains("pid=\"9\" p1=\"0\""))
    );
    done("refine {} --dry-run", &[&mixed]);
    usage_error(
        "refine {} -o {} --angle 5 --view 0,0,1",
        &[&plain, &output],
        "look at one mesh",
    );
    let unbuilt = cube(&folder, "unbuilt.3mf", &of_side, "", "");
    run("refine {} -o {}", &[&unbuilt, &output])
        .expect(1)
        .saying("nothing is built");
}

#[test]
fn info_lists_objects() {
    let folder = folder();
    let input = cube(
        &folder,
        "in.3mf",
        &|_| " pid=\"9\"".to_owned(),
        "<x/>",
        &ITEM.repeat(3),
    );
    let found = done("info {}", &[&input]);
    says!(found.stdout, "in cm; 3 items are built");
    assert!(found.stdout.contains(
        "object 1 'Box': 8 vertices, 12 triangles, built 3 times; triangles have pid; x"
    ));
    let json = json_of("info {} --json", &[&input]);
    assert_eq!(json["package"]["objects"][0]["built"], 3);
    assert_eq!(json["package"]["unit"], "cm");
}

/// A package of what comes from elsewhere has the unit that its numbers are said to have, and is read so again.
#[test]
fn units_come_out_as_they_were_said() {
    let folder = folder();
    let output = folder.path().join("out.3mf");
    for (words, unit, of_length) in [
        ("", "millimeter", "mm"),
        ("--unit in", "inch", "in"),
        ("--unit um", "micron", "µm"),
    ] {
        done(&format!("refine builtin:cube -o {{}} {words}"), &[&output]);
        let source = limitmesh_io::threemf::Package::open(&output).expect("a package");
        assert_eq!(format!("{:?}", source.unit()).to_lowercase(), unit);
        let again = folder.path().join("again.3mf");
        let line = format!("refine {{}} -o {{}} --tolerance 0.5{of_length}");
        done(&line, &[&output, &again]);
    }
}
