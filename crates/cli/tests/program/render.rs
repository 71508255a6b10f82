//! `render` and `--picture`: PNG files of the size asked for, which show what was asked for.

use crate::common::{bytes, done, folder, refuses, run, usage_error};
use crate::shading::pixels;

/// Width and height in a PNG file's header.
fn size(png: &[u8]) -> [u32; 2] {
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!(&png[12..16], b"IHDR");
    [&png[16..20], &png[20..24]].map(|b| u32::from_be_bytes(b.try_into().expect("four bytes")))
}

#[test]
fn pictures_differ_by_what_is_asked_for() {
    let folder = folder();
    let path = folder.path().join("out.png");
    let mut pictures = Vec::new();
    for options in [
        "",
        "--flat",
        "--wireframe",
        "--view 1,0,0",
        "--flat --wireframe --view 0,1,0",
    ] {
        let line = format!("render builtin:head -o {{}} --size 160x120 {options}");
        done(&line, &[&path]);
        let png = bytes(&path);
        assert_eq!(size(&png), [160, 120]);
        assert!(!pictures.contains(&png), "{options}");
        pictures.push(png);
    }
    done(
        "render builtin:head -o {} --size 160x120 --crease-angle 30 --threads 1",
        &[&path],
    );
    assert!(
        pictures[0] == bytes(&path),
        "edges beyond 30° show by default"
    );
    done(
        "render builtin:head -o {} --size 160x120 --smooth",
        &[&path],
    );
    assert!(pictures[0] != bytes(&path), "and not where all is smooth");
}

#[test]
fn refine_draws_its_result() {
    let folder = folder();
    let (mesh, path) = (folder.path().join("out.ply"), folder.path().join("out.png"));
    done("refine builtin:cup -o {} --picture {}", &[&mesh, &path]);
    let png = bytes(&path);
    assert_eq!(size(&png), [1200, 900]);
    assert!(png.len() > 20_000, "{} bytes", png.len());
}

#[test]
fn wrong_pictures_are_refused() {
    let folder = folder();
    let path = folder.path().join("out.png");
    refuses(
        &[("path", &path)],
        "
        2 | render builtin:head -o {path} --flat --smooth | cannot be used with
        2 | render builtin:head -o {path} --flat --crease-angle 30 | cannot be used with",
    );
    let missing = folder.path().join("missing.png");
    run("render builtin:head -o {} --texture {}", &[&path, &missing])
        .expect(1)
        .saying(&format!("--texture {}", missing.display()));
    usage_error("render builtin:head -o {} --size 0x10", &[&path], "1 to");
    usage_error("render builtin:head -o {} --size big", &[&path], "WxH");
    usage_error(
        "render builtin:head -o {}",
        &[&path.with_extension("gif")],
        ".png",
    );
    assert!(!path.exists());
}

#[test]
fn textures_lie_on_surfaces_with_texture_coordinates() {
    let folder = folder();
    let (mesh, path) = (
        folder.path().join("square.obj"),
        folder.path().join("out.png"),
    );
    let plain = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\n";
    std::fs::write(&mesh, format!("{plain}f 1 2 3 4\n")).expect("written");
    let bare = run(
        "render {} -o {} --size 160x120 --texture checker",
        &[&mesh, &path],
    );
    bare.expect(2)
        .saying("no texture coordinates")
        .saying("--texture");
    std::fs::write(
        &mesh,
        format!("{plain}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"),
    )
    .expect("written");
    let drawn = |options: &str| {
        let line = format!("render {{}} -o {{}} --size 160x120 {options}");
        done(&line, &[&mesh, &path]);
        bytes(&path)
    };
    let none = drawn("");
    let checker = drawn("--texture checker");
    assert!(none == drawn("--texture none") && none != checker);
    // A picture of a picture has the same colours all over its side.
    let picture = folder.path().join("texture.png");
    std::fs::write(&picture, &checker).expect("written");
    done("render {} -o {} --texture {}", &[&mesh, &path, &picture]);
    std::fs::write(&picture, "no picture").expect("written");
    let broken = run("render {} -o {} --texture {}", &[&mesh, &path, &picture]);
    broken
        .expect(1)
        .saying("texture.png")
        .saying("PNG and JPEG");
    let missing = run(
        "render {} -o {} --texture {}",
        &[&mesh, &path, &folder.path().join("none.png")],
    );
    missing.expect(1).saying("none.png");
}

/// The limit surface of a coarse mesh has no corners: it covers other pixels than the mesh, and nearly as many as the mesh four levels
/// finer with its vertices on the limit surface, which is framed alike and drawn by triangles.
#[test]
fn limit_surfaces_are_drawn_by_rays() {
    let folder = folder();
    let path = folder.path().join("exact.png");
    let draw = |options: &str| {
        let line = format!("render builtin:cube -o {{}} --size 120x90 {options}");
        done(&line, &[&path]);
        bytes(&path)
    };
    let exact = draw("--exact");
    assert_eq!(size(&exact), [120, 90]);
    assert!(
        exact != draw(""),
        "it is not the control mesh that is drawn"
    );
    let covered = |png: &[u8]| {
        let pixels = pixels(png);
        pixels.iter().filter(|&pixel| *pixel != pixels[0]).count()
    };
    let (fine, drawn) = (
        folder.path().join("fine.ply"),
        folder.path().join("fine.png"),
    );
    done(
        "refine builtin:cube -o {} --method uniform --levels 4 --limit",
        &[&fine],
    );
    done("render {} -o {} --size 120x90", &[&fine, &drawn]);
    let (own, other) = (covered(&exact), covered(&bytes(&drawn)));
    above!(other, 120 * 90 / 10);
    below!(own.abs_diff(other) * 50, other);
    assert!(
        exact == draw("--exact --threads 1"),
        "the same bytes on one thread"
    );
    assert!(exact != draw("--exact --scheme loop-warren"));
    assert!(exact != draw("--exact --crease-angle 30"));
    refuses(
        &[("path", &path)],
        "
        2 | render builtin:cube -o {path} --exact --wireframe |
        2 | render builtin:cube -o {path} --exact --smooth | --smooth
        2 | render builtin:cube -o {path} --scheme loop | it needs --exact
        2 | render builtin:cube -o {path} --exact --scheme butterfly | loop, loop-warren, catmull-clark]",
    );
}
