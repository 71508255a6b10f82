//! Reports as `docs/reports.schema.json` describes them: each has all fields that are required, of their types, and no others.

use std::path::Path;

use serde_json::Value;

use crate::common::{folder, json_file, json_of, run};
use crate::kept::root;

#[test]
fn reports_are_as_the_schema_says() {
    let schema = json_file(root().join("docs/reports.schema.json"));
    let folder = folder();
    let models = root().join("examples/models");
    let [report, output] = ["report.json", "out.glb"].map(|name| folder.path().join(name));
    let vase = models.join("vase.glb");
    let written: [(&str, &[&Path], &str); 7] = [
        (
            "refine builtin:cup -o {} --report {}",
            &[&output, &report],
            "RefineReport",
        ),
        (
            "refine builtin:cup -o {} --interpolate --angle 20 --report {}",
            &[&output, &report],
            "RefineReport",
        ),
        (
            "refine builtin:cup -o {} --method limit-normal --view 0,0,1 --report {}",
            &[&output, &report],
            "RefineReport",
        ),
        (
            "refine {} -o {} --report {}",
            &[&vase, &output, &report],
            "AssetReport",
        ),
        (
            "refine builtin:cup --dry-run --report {}",
            &[&report],
            "PredictionReport",
        ),
        (
            "lod builtin:cup -o {} --morph --report {}",
            &[&output, &report],
            "LodReport",
        ),
        (
            "batch {} -o {}",
            &[&folder.path().join("jobs.jsonl"), &report],
            "BatchLine",
        ),
    ];
    std::fs::write(
        folder.path().join("jobs.jsonl"),
        "{\"input\": \"none.obj\", \"output\": \"none.ply\"}\n",
    )
    .expect("written");
    for (command, paths, name) in written {
        let _ = std::fs::remove_file(&output);
        let done = run(command, paths);
        assert!(done.code < Some(2), "{command}: {}", done.stderr);
        check(&schema, name, &json_file(&report));
        std::fs::remove_file(&report).expect("removed");
    }
    let printed: [(&str, &[&Path], &str); 6] = [
        (
            "measure builtin:head builtin:sphere --json",
            &[],
            "MeasureReport",
        ),
        (
            "measure builtin:head --limit-of builtin:head --certified --json",
            &[],
            "MeasureReport",
        ),
        ("info {} --json", &[&vase], "InformationReport"),
        (
            "evaluate builtin:cup --at 0,0.5,0.25,0.25 --json",
            &[],
            "EvaluationReport",
        ),
        (
            "project builtin:head --onto builtin:head --json",
            &[],
            "ProjectionReport",
        ),
        ("models --json", &[], "ModelEntry"),
    ];
    for (command, paths, name) in printed {
        check(&schema, name, &json_of(command, paths));
    }
}

#[test]
fn what_does_not_fit_is_found() {
    let schema: Value = serde_json::json!({ "$defs": { "A": {
        "type": "object", "properties": { "a": { "type": ["integer", "null"] } }, "required": ["a"] } } });
    let fits = |value: &str| {
        misfit(
            &schema,
            &schema["$defs"]["A"],
            &serde_json::from_str(value).unwrap(),
            "A",
        )
    };
    assert_eq!(fits(r#"{"a": 1}"#), None);
    assert_eq!(fits(r#"{"a": null}"#), None);
    assert_eq!(fits(r#"{"a": "1"}"#).unwrap(), "A.a is \"1\"");
    assert_eq!(fits("{}").unwrap(), "A has no a");
    assert_eq!(fits(r#"{"a": 1, "b": 2}"#).unwrap(), "A.b is not described");
}

/// Compares a report, or each of a list of them, with a definition.
#[track_caller]
fn check(schema: &Value, name: &str, report: &Value) {
    let reports = report
        .as_array()
        .cloned()
        .unwrap_or_else(|| vec![report.clone()]);
    assert!(!reports.is_empty(), "no {name}");
    for report in reports {
        assert_eq!(misfit(schema, &schema["$defs"][name], &report, name), None);
    }
}

/// The first place at which a value is not as a schema says. Knows the words that our schemas use.
fn misfit(root: &Value, schema: &Value, value: &Value, at: &str) -> Option<String> {
    let wrong = || Some(format!("{at} is {value}"));
    if let Some(name) = schema["$ref"]
        .as_str()
        .and_then(|path| path.strip_prefix("#/$defs/"))
    {
        return misfit(root, &root["$defs"][name], value, at);
    }
    if schema.get("const").is_some_and(|only| only != value)
        || schema["enum"]
            .as_array()
            .is_some_and(|all| !all.contains(value))
        || !has_type(&schema["type"], value)
    {
        return wrong();
    }
    for word in ["anyOf", "oneOf"] {
        let Some(variants) = schema[word].as_array() else {
            continue;
        };
        // Fields apart from the variants are each variant's, too.
        let misfits: Vec<String> = variants
            .iter()
            .filter_map(|own| misfit(root, &joined(schema, own), value, at))
            .collect();
        return (misfits.len() == variants.len()).then(|| misfits.join(" and "));
    }
    match value {
        Value::Object(fields) => {
            let required = schema["required"]
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Value::as_str);
            if let Some(missing) = required
                .into_iter()
                .find(|name| !fields.contains_key(*name))
            {
                return Some(format!("{at} has no {missing}"));
            }
            fields.iter().find_map(|(name, field)| {
                let own = schema["properties"]
                    .get(name)
                    .or(schema.get("additionalProperties"));
                match own {
                    Some(own) => misfit(root, own, field, &format!("{at}.{name}")),
                    None if schema.get("properties").is_none() => None,
                    None => Some(format!("{at}.{name} is not described")),
                }
            })
        }
        Value::Array(items) => {
            let [least, most] = ["minItems", "maxItems"].map(|word| schema[word].as_u64());
            let count = items.len() as u64;
            if count < least.unwrap_or(0) || count > most.unwrap_or(u64::MAX) {
                return wrong();
            }
            items
                .iter()
                .enumerate()
                .find_map(|(i, item)| misfit(root, &schema["items"], item, &format!("{at}[{i}]")))
        }
        _ => None,
    }
}

fn has_type(types: &Value, value: &Value) -> bool {
    let is = |name: &Value| match name.as_str() {
        Some("null") => value.is_null(),
        Some("boolean") => value.is_boolean(),
        Some("integer") => value.is_i64() || value.is_u64(),
        Some("number") => value.is_number(),
        Some("string") => value.is_string(),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        _ => false,
    };
    match types {
        Value::Null => true,
        Value::Array(names) => names.iter().any(is),
        name => is(name),
    }
}

/// A variant with the fields of the schema that it is a variant of.
fn joined(whole: &Value, variant: &Value) -> Value {
    let mut joined = variant.clone();
    if let (Some(all), Some(own)) = (
        whole["properties"].as_object(),
        joined["properties"].as_object_mut(),
    ) {
        own.extend(all.clone());
    }
    joined
}
