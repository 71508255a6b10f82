//! The JSON Schema of the reports, made from their types.

use limitmesh::mesh::Diagnosis;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Value, json};

use crate::commands::batch::BatchLine;
use crate::commands::models::ModelEntry;
use crate::report::projection::ProjectionReport;
use crate::report::{
    AssetReport, ComparedMethod, EvaluationReport, FramesReport, InformationReport, LodReport,
    MeasureReport, PredictionReport, RefineReport,
};

/// The report of each command: how it is asked for, the name of its type, and whether it is a list of these.
pub(super) const REPORTS: [(&str, &str, bool); 11] = [
    ("refine --report FILE.json", "RefineReport", false),
    (
        "`limitmesh refine --report FILE.json`, glTF to glTF or 3MF to 3MF",
        "AssetReport",
        false,
    ),
    (
        "refine --shared-topology --report FILE.json",
        "FramesReport",
        false,
    ),
    (
        "refine --dry-run --report FILE.json",
        "PredictionReport",
        false,
    ),
    ("measure --json", "MeasureReport", false),
    ("info --json", "InformationReport", false),
    ("evaluate --json", "EvaluationReport", true),
    ("project --json", "ProjectionReport", false),
    ("lod --report FILE.json", "LodReport", false),
    ("compare --json", "ComparedMethod", true),
    ("models --json", "ModelEntry", true),
];

/// The line that `batch` writes for each job.
pub(super) const BATCH_LINE: &str = "BatchLine";

/// The schema of all reports; each is a definition by the name of its type.
pub(super) fn schema() -> Value {
    let mut generator = SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator();
    generator.subschema_for::<RefineReport>();
    generator.subschema_for::<AssetReport>();
    generator.subschema_for::<FramesReport>();
    generator.subschema_for::<PredictionReport>();
    generator.subschema_for::<MeasureReport>();
    generator.subschema_for::<InformationReport>();
    generator.subschema_for::<EvaluationReport>();
    generator.subschema_for::<ProjectionReport>();
    generator.subschema_for::<LodReport>();
    generator.subschema_for::<ComparedMethod>();
    generator.subschema_for::<ModelEntry>();
    generator.subschema_for::<BatchLine<'_>>();
    let one = |name: &str| json!({ "$ref": format!("#/$defs/{name}") });
    let reports = REPORTS.map(|(_, name, is_list)| match is_list {
        true => json!({ "type": "array", "items": one(name) }),
        false => one(name),
    });
    let all: Vec<Value> = reports.into_iter().chain([one(BATCH_LINE)]).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Reports of limitmesh",
        "anyOf": all,
        "$defs": generator.take_definitions(true),
    })
}

/// The library's findings in a mesh, by their names.
pub(crate) fn findings(generator: &mut SchemaGenerator) -> Schema {
    let finding = generator.subschema_for::<Finding>();
    let names: Vec<&str> = Diagnosis::default()
        .findings()
        .map(|(name, _)| name)
        .collect();
    let properties: serde_json::Map<String, Value> = names
        .iter()
        .map(|name| ((*name).to_owned(), finding.clone().to_value()))
        .collect();
    let schema = json!({ "type": "object", "properties": properties, "required": names });
    schema.try_into().unwrap()
}

/// How often something was found, and where first.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "describes a type of the library")]
pub(crate) struct Finding {
    /// How many there are.
    count: usize,
    /// The first few places, in the input's numbering, ascending.
    first: Vec<u32>,
}

/// Sampled distance from one surface to another.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "describes a type of the library")]
pub(crate) struct OneSided {
    /// The greatest distance found.
    max: f64,
    /// The mean over the surface.
    mean: f64,
    /// The root mean square over the surface.
    rms: f64,
    /// The distance that 95 % of these samples do not exceed.
    percentile_95: f64,
    /// Samples taken, vertices included.
    samples: usize,
    /// The point at which the maximum was found.
    at: [f64; 3],
    /// The other surface's closest point to it.
    to: [f64; 3],
}

/// The greatest distance from one surface to another lies between two values.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "describes a type of the library")]
pub(crate) struct Bounds {
    /// Some point, `at`, is at least this far away.
    lower: f64,
    /// No point is farther away.
    upper: f64,
    /// The farthest point found.
    at: [f64; 3],
    /// The other surface's closest point to it.
    to: [f64; 3],
    /// Whether the interval is as narrow as was asked for.
    converged: bool,
}
