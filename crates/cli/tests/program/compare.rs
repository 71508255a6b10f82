//! `compare`: eleven methods at nearly equal triangle counts.

use serde_json::Value;

use crate::common::{count, json_of, list, number, words};

#[test]
fn methods_stand_side_by_side_at_nearly_equal_counts() {
    let report = json_of("compare builtin:head --json --samples 20000", &[]);
    let list = list(&report);
    let names: Vec<_> = list.iter().map(|m| words(&m["method"])).collect();
    assert_eq!(
        names,
        [
            "limit-normal",
            "amresh",
            "uniform",
            "uniform-limit",
            "exact",
            "exact-balance",
            "exact-optimize",
            "planarity",
            "planarity-distance",
            "vertex-error",
            "sqrt3"
        ]
    );
    for method in list {
        let percent = number(&method["symmetric_percent"]);
        assert!(percent > 0.0 && percent < 5.0, "{method}");
        assert!(number(&method["mean_percent"]) <= percent);
    }
    let triangles = |i: usize| number(&list[i]["triangles"]);
    assert!(
        (triangles(0) - triangles(1)).abs() <= 0.02 * triangles(0),
        "{list:?}"
    );
    let levels = count(&list[2]["levels"]);
    for uniform in &list[2..4] {
        assert_eq!(
            uniform["triangles"].as_u64(),
            Some(142 * 4u64.pow(levels as u32))
        );
        assert!(uniform["angle_degrees"].is_null());
    }
    // At no more triangles, the exact method is nearer to the limit surface than all others, and its bound holds.
    let exact = &list[4];
    assert!(triangles(4) <= triangles(0) && triangles(4) > 0.9 * triangles(0));
    let percent = |method: &Value| number(&method["symmetric_percent"]);
    assert!(percent(exact) < percent(&list[0]) && percent(exact) < percent(&list[1]));
    assert!(percent(exact) <= 1.02 * number(&exact["certified"]["upper_percent"]));
    let proven = |method: &Value| number(&method["certified"]["upper"]);
    for better in &list[5..7] {
        assert!(better["triangles"].as_f64() <= Some(triangles(0)));
        below!(percent(better), percent(&list[0]), "{better}");
        below!(proven(better), proven(exact), "{better}");
    }
    assert!(
        list[..4]
            .iter()
            .chain(&list[7..])
            .all(|method| method["certified"].is_null())
    );
    for other in &list[7..] {
        let own = number(&other["triangles"]);
        assert!(own <= triangles(0) && own > 0.9 * triangles(0), "{other}");
        assert_eq!(
            other["reference"]["scheme"] == "sqrt3",
            other["method"] == "sqrt3"
        );
    }
    for other in [levels.saturating_sub(1), levels + 1] {
        let miss = |level: u64| (142.0 * 4f64.powi(level as i32) - triangles(0)).abs();
        assert!(miss(levels) <= miss(other));
    }
}
