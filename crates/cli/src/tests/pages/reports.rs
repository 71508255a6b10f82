//! `docs/reports.md` and `docs/reports.schema.json`: what reports hold, from their types.

use std::fmt::Write;

use serde_json::Value;

use super::made;
use super::schema::{BATCH_LINE, REPORTS, schema};

const BEGINNING: &str = "\
# Reports

What a program can read of limitmesh: every report is JSON, with the fields below. [reports.schema.json](reports.schema.json)
is the JSON Schema of all of them (draft 2020-12); each type is one of its definitions.

Names of fields stay and new ones may be added. All numbers are finite. Angles are degrees, times seconds, lengths the
mesh's unit. Faces and vertices are counted from 0 as in the input. A field that ends with `?` may be null.

A sampled distance is a lower bound of the true one. Where `certified` is true, or the kind is `certified interval`, the true
distance lies between `lower` and `upper`, rounding included.

Exit codes: 0 done; 1 bad input or output; 2 usage; 3 stopped short of what was asked, with the result so far written; 130, 143
and 129 where Ctrl-C, SIGTERM or SIGHUP cancelled it, with no file left half written.

This page and the schema are generated from the program: do not edit them.

| command | report |
|---|---|
";

#[test]
fn the_page_and_the_schema_are_those_of_the_types() {
    let schema = schema();
    made::check("docs/reports.md", page(&schema).as_bytes());
    let text = serde_json::to_string_pretty(&schema).unwrap();
    made::check("docs/reports.schema.json", format!("{text}\n").as_bytes());
}

fn page(schema: &Value) -> String {
    let mut page = BEGINNING.to_owned();
    let mut names: Vec<String> = Vec::new();
    for (command, name, is_list) in
        REPORTS
            .into_iter()
            .chain([("a line of `batch`", BATCH_LINE, false)])
    {
        let command = if command.contains('`') {
            command.to_owned()
        } else {
            format!("`limitmesh {command}`")
        };
        let list = if is_list { "a list of " } else { "" };
        writeln!(page, "| {command} | {list}{} |", link(name)).unwrap();
        names.push(name.to_owned());
    }
    // Parts follow in the order in which they are first named.
    let mut next = 0;
    while let Some(name) = names.get(next).cloned() {
        let definition = &schema["$defs"][&name];
        page.push_str(&section(schema, &name, definition));
        for part in references(definition) {
            if !names.contains(&part) && values(&schema["$defs"][&part]).is_none() {
                names.push(part);
            }
        }
        next += 1;
    }
    page
}

/// A type with its fields; where it is one of several, with those of each.
fn section(schema: &Value, name: &str, definition: &Value) -> String {
    let about = definition["description"].as_str().unwrap_or_default();
    let mut page = format!("\n## {name}\n\n{}\n", in_a_line(about));
    if definition.get("properties").is_some() {
        page.push_str(&table(schema, definition));
    }
    for variant in definition["oneOf"].as_array().into_iter().flatten() {
        let about = in_a_line(variant["description"].as_str().unwrap_or("It is so:"));
        writeln!(page, "\n{about}").unwrap();
        page.push_str(&table(schema, variant));
    }
    if let Some(variants) = definition["anyOf"].as_array() {
        let variants: Vec<String> = variants.iter().map(|own| kind(schema, own).0).collect();
        writeln!(page, "\nOne of {}.", variants.join(", ")).unwrap();
    }
    page
}

fn table(schema: &Value, definition: &Value) -> String {
    let mut page = "\n| field | type | what |\n|---|---|---|\n".to_owned();
    let Some(properties) = definition["properties"].as_object() else {
        return String::new();
    };
    // Required fields are in the order of the report.
    let required = definition["required"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str);
    let mut order: Vec<&str> = required.collect();
    order.extend(
        properties
            .keys()
            .map(String::as_str)
            .filter(|key| !order.contains(key))
            .collect::<Vec<_>>(),
    );
    for field in order {
        let own = &properties[field];
        let (kind, may_be_null) = kind(schema, own);
        let mark = if may_be_null { "?" } else { "" };
        let about = in_a_line(own["description"].as_str().unwrap_or_default());
        writeln!(page, "| `{field}{mark}` | {kind} | {about} |").unwrap();
    }
    page
}

/// The type of a value in words, and whether it may be null.
fn kind(schema: &Value, own: &Value) -> (String, bool) {
    if let Some(name) = reference(own) {
        let words = values(&schema["$defs"][&name]);
        return (words.unwrap_or_else(|| link(&name)), false);
    }
    if let Some(variants) = own["anyOf"].as_array() {
        let is_null = |variant: &&Value| variant["type"] == "null";
        let kinds: Vec<String> = variants
            .iter()
            .filter(|own| !is_null(own))
            .map(|own| kind(schema, own).0)
            .collect();
        return (kinds.join(" or "), variants.iter().any(|own| is_null(&own)));
    }
    if let Some(value) = own["const"].as_str() {
        return (format!("`{value}`"), false);
    }
    let types: Vec<&str> = match &own["type"] {
        Value::Array(types) => types.iter().filter_map(Value::as_str).collect(),
        one => one.as_str().into_iter().collect(),
    };
    let may_be_null = types.contains(&"null");
    let words = match types.iter().find(|own| **own != "null") {
        Some(&"integer") => "whole number".to_owned(),
        Some(&"boolean") => "true or false".to_owned(),
        Some(&"string") => "text".to_owned(),
        Some(&"array") => match (&own["minItems"], kind(schema, &own["items"]).0) {
            (Value::Number(count), each) => format!("{count} × {each}"),
            (_, each) => format!("list of {each}"),
        },
        Some(&"object") => match own.get("additionalProperties") {
            Some(each) => format!("{} by name", kind(schema, each).0),
            None => "object".to_owned(),
        },
        Some(other) => (*other).to_owned(),
        None => "any report".to_owned(),
    };
    (words, may_be_null)
}

/// The words that a type of words alone may be.
fn values(definition: &Value) -> Option<String> {
    let variants = definition["oneOf"]
        .as_array()
        .map(|all| all.iter().map(|own| &own["const"]).collect());
    let all: Vec<&Value> = variants.or(definition["enum"]
        .as_array()
        .map(|all| all.iter().collect()))?;
    let words: Option<Vec<String>> = all
        .iter()
        .map(|own| Some(format!("`{}`", own.as_str()?)))
        .collect();
    Some(words?.join(", "))
}

fn reference(own: &Value) -> Option<String> {
    Some(own["$ref"].as_str()?.strip_prefix("#/$defs/")?.to_owned())
}

/// All types that a definition names, in its order.
fn references(own: &Value) -> Vec<String> {
    match own {
        Value::Object(members) => {
            let below = members.values().flat_map(references);
            reference(own).into_iter().chain(below).collect()
        }
        Value::Array(items) => items.iter().flat_map(references).collect(),
        _ => Vec::new(),
    }
}

fn link(name: &str) -> String {
    format!("[{name}](#{})", name.to_lowercase())
}

fn in_a_line(text: &str) -> String {
    text.split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
        .replace('|', "\\|")
}
