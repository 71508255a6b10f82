//! The checker shares nothing with anybody.

#[test]
fn the_checker_has_no_dependencies() {
    let manifest = include_str!("../../Cargo.toml");
    let tables: Vec<&str> = manifest
        .lines()
        .filter(|line| line.starts_with('['))
        .collect();
    assert_eq!(tables, ["[package]", "[dependencies]", "[lints]"]);
    let (_, after) = manifest.split_once("[dependencies]").unwrap();
    let (own, _) = after.split_once("[lints]").unwrap();
    assert_eq!(own.trim(), "");
}
