//! The measured numbers as CSV and JSON, written the same way wherever they appear.

use serde::Serialize;

use super::figures::closure::ClosureFigure;
use super::figures::cone::ConeFigure;
use super::figures::head::Head;
use super::figures::shoe::Shoe;
use super::figures::view::ViewFigure;
use super::settings::Settings;
use super::study::{Row, Study};

/// All that was found. Seconds are here alone: everything else is the same on every run.
#[derive(Debug, Serialize)]
pub(super) struct Results {
    pub(super) version: &'static str,
    pub(super) scheme: &'static str,
    pub(super) settings: Settings,
    pub(super) table_1: Vec<Study>,
    pub(super) figure_2: Option<ConeFigure>,
    pub(super) figure_5: ClosureFigure,
    pub(super) figure_7: Vec<Head>,
    pub(super) figure_8: Shoe,
    pub(super) figure_9: ViewFigure,
    pub(super) seconds: f64,
}

impl Results {
    /// All rows of Table 1.
    pub(super) fn rows(&self) -> impl Iterator<Item = &Row> {
        self.table_1.iter().flat_map(|study| &study.rows)
    }
}

/// A distance in per cent of a diagonal: four significant digits, more than the sampling is worth.
pub(super) fn shd(x: f64) -> String {
    significant(x, 4)
}

/// A ratio in per cent.
pub(super) fn ratio(x: f64) -> String {
    format!("{x:.1}")
}

/// A number with so many significant digits, never in powers of ten.
pub(super) fn significant(x: f64, digits: i32) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let decimals = (digits - 1 - x.abs().log10().floor() as i32).clamp(0, 17) as usize;
    format!("{x:.decimals$}")
}

/// A difference with its sign, for reading.
pub(super) fn signed(x: f64, decimals: usize) -> String {
    format!("{x:+.decimals$}").replace('-', "−")
}

/// The header of table1.csv.
pub(super) const TABLE_1_COLUMNS: [&str; 11] = [
    "model",
    "angle_degrees",
    "faces",
    "shd_percent",
    "amresh_faces",
    "amresh_shd_percent",
    "ratio_percent",
    "uniform_limit_faces",
    "uniform_limit_shd_percent",
    "exact_faces",
    "exact_shd_percent",
];

/// The cells of a row of Table 1, as in the CSV and on the page.
pub(super) fn table_1_cells(row: &Row) -> [String; 11] {
    [
        row.model.to_owned(),
        row.angle_degrees.to_string(),
        row.paper.faces.to_string(),
        shd(row.paper.shd_percent),
        row.amresh.faces.to_string(),
        shd(row.amresh.shd_percent),
        ratio(row.ratio_percent),
        row.uniform_limit.faces.to_string(),
        shd(row.uniform_limit.shd_percent),
        row.exact.faces.to_string(),
        shd(row.exact.shd_percent),
    ]
}

/// Table 1 as a file.
pub(super) fn table_1_csv<'a>(rows: impl Iterator<Item = &'a Row>) -> String {
    csv(
        &TABLE_1_COLUMNS,
        rows.map(|row| table_1_cells(row).to_vec()),
    )
}

/// The header of references.csv.
const REFERENCES_COLUMNS: [&str; 8] = [
    "model",
    "angle_degrees",
    "planarity_faces",
    "planarity_shd_percent",
    "vertex_error_faces",
    "vertex_error_shd_percent",
    "sqrt3_faces",
    "sqrt3_shd_percent",
];

/// The cells of a row of other methods of the literature, as in the CSV and on the page.
pub(super) fn references_cells(row: &Row) -> [String; 8] {
    [
        row.model.to_owned(),
        row.angle_degrees.to_string(),
        row.planarity.faces.to_string(),
        shd(row.planarity.shd_percent),
        row.vertex_error.faces.to_string(),
        shd(row.vertex_error.shd_percent),
        row.sqrt3.faces.to_string(),
        shd(row.sqrt3.shd_percent),
    ]
}

/// Those as a file.
pub(super) fn references_csv<'a>(rows: impl Iterator<Item = &'a Row>) -> String {
    csv(
        &REFERENCES_COLUMNS,
        rows.map(|row| references_cells(row).to_vec()),
    )
}

/// Distance against steps as a file; empty cells where the level is that of the reference.
pub(super) fn drift_csv(studies: &[Study]) -> String {
    let header = [
        "model",
        "steps",
        "faces",
        "shd_percent",
        "uniform_limit_faces",
        "uniform_limit_shd_percent",
    ];
    let rows = studies.iter().flat_map(|study| &study.drift).map(|point| {
        let uniform = point.uniform_limit;
        vec![
            point.model.to_owned(),
            point.steps.to_string(),
            point.paper.faces.to_string(),
            shd(point.paper.shd_percent),
            uniform.map_or(String::new(), |m| m.faces.to_string()),
            uniform.map_or(String::new(), |m| shd(m.shd_percent)),
        ]
    });
    csv(&header, rows)
}

/// The seam rules as a file.
pub(super) fn seams_csv(studies: &[Study]) -> String {
    let rows = studies.iter().flat_map(|study| &study.seams).map(|row| {
        let measured = &row.measured;
        vec![
            row.model.to_owned(),
            row.seam.to_owned(),
            measured.faces.to_string(),
            shd(measured.shd_percent),
        ]
    });
    csv(&["model", "seam", "faces", "shd_percent"], rows)
}

/// No cell has a comma, a quote or a line end in it.
fn csv(header: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut text = header.join(",") + "\n";
    for row in rows {
        text.push_str(&row.join(","));
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_significant() {
        assert_eq!(
            [0.123_456, 12.345_6, 1234.56, 0.001_234_56, 0.0].map(shd),
            ["0.1235", "12.35", "1235", "0.001235", "0"]
        );
    }
}
