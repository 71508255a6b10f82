//! `render` and `--picture`: PNG files of the size asked for, which show what was asked for.

use crate::common::{folder, run};

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
    for options in ["", "--flat", "--wireframe", "--view 1,0,0", "--flat --wireframe --view 0,1,0"] {
        run(&format!("render builtin:head -o {{}} --size 160x120 {options}"), &[&path]).expect(0);
        let png = std::fs::read(&path).expect("a picture");
        assert_eq!(size(&png), [160, 120]);
        assert!(!pictures.contains(&png), "{options}");
        pictures.push(png);
    }
    run("render builtin:head -o {} --size 160x120 --smooth --threads 1", &[&path]).expect(0);
    assert!(pictures[0] == std::fs::read(&path).expect("a picture"), "smooth is the default");
}

#[test]
fn refine_draws_its_result() {
    let folder = folder();
    let (mesh, path) = (folder.path().join("out.ply"), folder.path().join("out.png"));
    run("refine builtin:cup -o {} --picture {}", &[&mesh, &path]).expect(0);
    let png = std::fs::read(&path).expect("a picture");
    assert_eq!(size(&png), [1200, 900]);
    assert!(png.len() > 20_000, "{} bytes", png.len());
}

#[test]
fn wrong_pictures_are_refused() {
    let folder = folder();
    let path = folder.path().join("out.png");
    run("render builtin:head -o {} --flat --smooth", &[&path]).expect(2).saying("cannot be used with");
    run("render builtin:head -o {} --size 0x10", &[&path]).expect(2).saying("1 to");
    run("render builtin:head -o {} --size big", &[&path]).expect(2).saying("WxH");
    run("render builtin:head -o {}", &[&path.with_extension("gif")]).expect(2).saying(".png");
    assert!(!path.exists());
}
