//! Findings in the input: each finding with its count and the first few places.

use std::collections::BTreeMap;

use limitmesh::mesh::{Diagnosis, Finding};
use serde::Serialize;

/// All findings, whether or not something was found.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct DiagnosisReport {
    /// Whether nothing had to be repaired; polygons and equal positions are no defects.
    pub(crate) clean: bool,
    /// By the library's names of the findings.
    #[serde(flatten)]
    #[cfg_attr(test, schemars(schema_with = "crate::tests::pages::schema::findings"))]
    pub(crate) findings: BTreeMap<&'static str, Finding>,
}

impl From<&Diagnosis> for DiagnosisReport {
    fn from(d: &Diagnosis) -> Self {
        let findings = d
            .findings()
            .map(|(name, finding)| (name, finding.clone()))
            .collect();
        Self {
            clean: d.is_clean(),
            findings,
        }
    }
}
