//! `compare`: four methods at nearly equal triangle counts.

use crate::common::{has_keys, run};

#[test]
fn methods_stand_side_by_side_at_nearly_equal_counts() {
    let list = run("compare builtin:head --json --samples 20000", &[]).expect(0).json();
    let list = list.as_array().expect("a list");
    let names: Vec<_> = list.iter().map(|m| m["method"].as_str().expect("a name")).collect();
    assert_eq!(names, ["limit-normal", "amresh", "uniform", "uniform-limit"]);
    for method in list {
        has_keys(
            method,
            "method angle_degrees levels triangles symmetric symmetric_percent mean_percent seconds",
        );
        let percent = method["symmetric_percent"].as_f64().expect("a number");
        assert!(percent > 0.0 && percent < 5.0, "{method}");
        assert!(method["mean_percent"].as_f64().expect("a number") <= percent);
    }
    let triangles = |i: usize| list[i]["triangles"].as_f64().expect("a count");
    assert!((triangles(0) - triangles(1)).abs() <= 0.02 * triangles(0), "{list:?}");
    let levels = list[2]["levels"].as_u64().expect("a count");
    for uniform in &list[2..] {
        assert_eq!(uniform["triangles"].as_u64(), Some(142 * 4u64.pow(levels as u32)));
        assert!(uniform["angle_degrees"].is_null());
    }
    for other in [levels.saturating_sub(1), levels + 1] {
        let miss = |level: u64| (142.0 * 4f64.powi(level as i32) - triangles(0)).abs();
        assert!(miss(levels) <= miss(other));
    }
}

#[test]
fn the_counts_are_those_of_refine() {
    let folder = crate::common::folder();
    let output = folder.path().join("out.ply");
    let report =
        run("refine builtin:cup -o {} --method limit-normal --angle 6 --levels 2 --report -", &[&output])
            .expect(0)
            .json();
    let list = run("compare builtin:cup --angle 6 --levels 2 --json --samples 20000", &[]).expect(0).json();
    assert_eq!(list[0]["triangles"], report["output"]["triangles"]);
    let angle = list[1]["angle_degrees"].as_f64().expect("an angle");
    let amresh = format!("refine builtin:cup -o {{}} --method amresh --angle {angle} --levels 2 --report -");
    let report = run(&amresh, &[&output]).expect(0).json();
    assert_eq!(list[1]["triangles"], report["output"]["triangles"]);
}

#[test]
fn the_table_is_aligned() {
    let text = run("compare builtin:torus --samples 20000", &[]).expect(0).stdout;
    let rows: Vec<&str> =
        text.lines().skip_while(|line| !line.starts_with("method")).take_while(|l| !l.is_empty()).collect();
    assert_eq!(rows.len(), 5, "{text}");
    let widths: Vec<usize> = rows.iter().map(|row| row.chars().count()).collect();
    assert!(widths.iter().all(|&width| width == widths[0]), "{text}");
}
