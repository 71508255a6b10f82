//! The page: one HTML file with its own style, readable on a phone and on paper.

use super::figures::Picture;
use super::figures::closure::ClosureFigure;
use super::figures::cone::ConeFigure;
use super::figures::view::ViewFigure;
use super::html::{escape, findings, header, list, paragraph, pictures, section, table, wide};
use super::numbers::{Results, references_cells, shd, table_1_cells};
use super::prose;
use super::statistics::{Against, against};
use super::study::Row;
use crate::format::thousands;
use crate::paper_models::{self, HEAD, Part, SHOE, SPHERE, TABLE_1};

const STYLE: &str = include_str!("page.css");

/// Sections in order: their address on the page, their heading, their name in the list at the top.
const SECTIONS: [(&str, &str, &str); 10] = [
    ("models", "The models", "Models"),
    (
        "table-1",
        "Table 1: distance to the limit surface",
        "Table 1",
    ),
    ("figure-2", "Figure 2: the cone of normals", "Figure 2"),
    ("figure-5", "Figure 5: no cracks", "Figure 5"),
    ("figure-7", "Figure 7: the head", "Figure 7"),
    ("figure-8", "Figure 8: two thresholds", "Figure 8"),
    (
        "figure-9",
        "Figure 9: view-dependent refinement",
        "Figure 9",
    ),
    ("drift", "More steps", "More steps"),
    ("seams", "Which vertices move", "Seam rules"),
    ("files", "The numbers, and how to run this again", "Files"),
];

/// The whole page.
pub(super) fn page(results: &Results, portraits: &[Picture]) -> String {
    let contents: [String; 10] = [
        models(results, portraits),
        table_1(results),
        results.figure_2.as_ref().map_or_else(no_cone, figure_2),
        figure_5(&results.figure_5),
        figure_7(results),
        pictures(&results.figure_8.pictures, "") + &findings(&prose::figure_8(&results.figure_8)),
        figure_9(&results.figure_9),
        drift(results),
        seams(results),
        files(results),
    ];
    let links: String = SECTIONS
        .iter()
        .map(|(id, _, name)| format!("<a href=\"#{id}\">{name}</a>\n"))
        .collect();
    let sections: String = SECTIONS
        .iter()
        .zip(contents)
        .map(|((id, title, _), content)| section(id, title, &content))
        .collect();
    let lead = "“An Adaptive Subdivision Method Based on Limit Surface Normal” by Chen, Luo and Ling divides a face \
                of a subdivision surface where its normal leaves a cone around the limit normals of its vertices. \
                This page repeats the paper's table and figures, and measures what it leaves out.";
    let brief = list(&prose::brief(results));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Adaptive subdivision by limit normals: the paper reproduced</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
         <h1>Adaptive subdivision by limit normals: the paper reproduced</h1>\n\
         <p class=\"lead\">{lead}</p>\n<div class=\"brief\">\n{brief}</div>\n<nav>\n{links}</nav>\n{sections}\
         </main>\n</body>\n</html>\n"
    )
}

/// A cell of text that is no number.
fn words(text: &str) -> String {
    format!("<td class=\"words\">{}</td>", escape(text))
}

fn models(results: &Results, portraits: &[Picture]) -> String {
    let head = header(
        &[
            "model",
            "played by",
            "what it is",
            "vertices",
            "faces",
            "open edges",
            "greatest valence",
        ],
        &[1, 2],
    );
    let row = |study: &super::study::Study| {
        vec![
            study.model.to_owned(),
            format!(
                "<td class=\"words\"><code>{}</code></td>",
                escape(&study.origin.source)
            ),
            words(&study.origin.about),
            thousands(study.control_vertices),
            thousands(study.control_faces),
            thousands(study.boundary_edges),
            study.max_valence.to_string(),
        ]
    };
    let groups: Vec<_> = results
        .table_1
        .iter()
        .map(|study| vec![row(study)])
        .collect();
    let files = results
        .table_1
        .iter()
        .filter(|study| study.origin.file)
        .count();
    let played = match files {
        0 => "All six are played by built-in shapes of the same names here".to_owned(),
        6 => "All six are played by files here".to_owned(),
        _ => format!(
            "{files} of the six are played by files here, the others by built-in shapes of the same names"
        ),
    };
    let intro = format!(
        "The paper names six models and shows small pictures of them (its Figure 6); their meshes are not published. \
         {played}, as control meshes of Loop's scheme."
    );
    paragraph(&intro)
        + &pictures(portraits, " six")
        + &table("models-table", "Control meshes of Table 1", &head, &groups)
}

fn table_1(results: &Results) -> String {
    let over = "<tr class=\"over\"><th colspan=\"2\"></th><th colspan=\"2\">limit normal (paper)</th>\
                <th colspan=\"2\">Amresh</th><th></th><th colspan=\"2\">uniform, limit vertices</th>\
                <th colspan=\"2\">exact, at equal triangles</th></tr>\n";
    let head = header(
        &[
            "model", "angle", "faces", "SHD %", "faces", "SHD %", "ratio %", "faces", "SHD %",
            "faces", "SHD %",
        ],
        &[],
    );
    let groups: Vec<Vec<Vec<String>>> = results
        .table_1
        .iter()
        .map(|study| {
            study
                .rows
                .iter()
                .map(|row| table_1_row(table_1_cells(row), row.ratio_percent))
                .collect()
        })
        .collect();
    let steps = results.settings.steps;
    let intro = format!(
        "Symmetric Hausdorff distance (SHD, equations 14 to 16) between the surface after {steps} steps and the limit \
         surface, in per cent of the diagonal of the control mesh's bounding box. Amresh's method divides a face \
         whose normal differs from an edge neighbour's; its threshold is searched for the same number of faces. \
         Ratio: the paper's method by Amresh's. Beside them, uniform refinement with its vertices moved to the limit \
         surface, at the level whose face count is nearest in ratio, and exact refinement, this project's own method: \
         it refines the limit surface of the control mesh itself, so that no step drifts from it; all vertices lie on \
         that surface, and the places with the greatest distance are divided first, until there are as many faces as \
         the paper's method has."
    );
    let chart = Picture::drawn(
        "table1",
        "Distances of Table 1 as dots on a logarithmic scale",
        "The same numbers: a line for each setting, a dot for each method.",
    );
    let notes: String = prose::table_1_notes(results)
        .iter()
        .map(|note| paragraph(note))
        .collect();
    paragraph(&intro)
        + &table(
            "table1",
            "Also as table1.csv. A ratio below 100 is in the paper's favour.",
            &(over.to_owned() + &head),
            &groups,
        )
        + &wide(&chart)
        + &findings(&prose::table_1(results))
        + &references(results)
        + &notes
}

/// The criteria and the scheme of three of the paper's references, at the counts of Table 1.
fn references(results: &Results) -> String {
    let over = "<tr class=\"over\"><th colspan=\"2\"></th><th colspan=\"2\">planarity (Zorin)</th>\
                <th colspan=\"2\">vertex errors (Müller)</th><th colspan=\"2\">√3 (Kobbelt)</th></tr>\n";
    let head = header(
        &[
            "model", "angle", "faces", "SHD %", "faces", "SHD %", "faces", "SHD %",
        ],
        &[],
    );
    let row = |row: &Row| {
        let mut cells = references_cells(row);
        for column in [2, 4, 6] {
            cells[column] = cells[column]
                .parse()
                .map_or_else(|_| cells[column].clone(), thousands);
        }
        cells[1].push('°');
        cells.to_vec()
    };
    let groups: Vec<Vec<Vec<String>>> = results
        .table_1
        .iter()
        .map(|study| study.rows.iter().map(row).collect())
        .collect();
    let intro = "Methods of three of the paper's references, with no more faces than its own: the planarity of Zorin, Schröder and \
                 Sweldens (how high the limit surface is over a triangle in the middles of its edges) and the vertex errors of Müller and \
                 Jaeschke (how far control points are from their limits), both over a quadtree whose neighbours differ by one level and \
                 with vertices on the limit surface, and Kobbelt's √3-subdivision, against a limit surface of its own.";
    let caption = "Also as references.csv.";
    paragraph(intro) + &table("references", caption, &(over.to_owned() + &head), &groups)
}

/// A row of Table 1 with its counts in groups of three digits and its ratio marked.
fn table_1_row(cells: [String; 11], ratio_percent: f64) -> Vec<String> {
    let class = match against(ratio_percent) {
        Against::Below => " class=\"below\"",
        Against::Equal => "",
        Against::Above => " class=\"above\"",
    };
    let mut row = cells.to_vec();
    for column in [2, 4, 7, 9] {
        row[column] = row[column]
            .parse()
            .map_or_else(|_| row[column].clone(), thousands);
    }
    row[1].push('°');
    row[6] = format!("<td{class}>{}</td>", row[6]);
    row
}

fn no_cone() -> String {
    paragraph(
        "No vertex of the model has its face normals outside the cone at first and inside after two steps.",
    )
}

fn figure_2(cone: &ConeFigure) -> String {
    let head = header(
        &[
            "mesh",
            "angles of the face normals from the limit normal, counter-clockwise",
            "greatest",
        ],
        &[1],
    );
    let rows = cone.stages.iter().map(|stage| {
        let angles: Vec<String> = stage
            .angles_degrees
            .iter()
            .map(|a| format!("{a:.1}°"))
            .collect();
        let name = match stage.step {
            0 => "control mesh".to_owned(),
            1 => "1 step".to_owned(),
            step => format!("{step} steps"),
        };
        vec![vec![
            name,
            words(&angles.join(", ")),
            format!("{:.1}°", stage.greatest()),
        ]]
    });
    let groups: Vec<_> = rows.collect();
    let caption = format!("Vertex {} of the {}", cone.vertex, cone.model);
    wide(&cone.picture)
        + &table("cone-table", &caption, &head, &groups)
        + &findings(&prose::figure_2(cone))
}

fn figure_5(closure: &ClosureFigure) -> String {
    let head = header(
        &[
            "model",
            "step",
            "divided",
            "(a) whole",
            "(b) in two",
            "(c) in three",
            "(d) in four",
        ],
        &[],
    );
    let groups: Vec<Vec<Vec<String>>> = closure
        .counts
        .chunk_by(|a, b| a.model == b.model)
        .map(|counts| {
            let row = |count: &super::figures::closure::ClosureCount| {
                let mut row = vec![
                    count.model.to_owned(),
                    count.step.to_string(),
                    thousands(count.divisible),
                ];
                row.extend(count.cases.map(thousands));
                row
            };
            counts.iter().map(row).collect()
        })
        .collect();
    let caption = format!(
        "Faces by what a step does to them, at {}°",
        closure.angle_degrees
    );
    wide(&closure.picture)
        + &table("closure-table", &caption, &head, &groups)
        + &findings(&prose::figure_5(closure))
}

fn figure_7(results: &Results) -> String {
    let heads = results.figure_7.iter().map(|head| {
        let source = format!(
            "<p><code>{}</code>: {}</p>\n",
            escape(&head.origin.source),
            escape(&head.origin.about)
        );
        source + &pictures(&head.pictures, "")
    });
    heads.collect::<String>() + &findings(&prose::figure_7(&results.figure_7))
}

fn figure_9(view: &ViewFigure) -> String {
    let names: Vec<&str> = view.models.iter().map(|model| model.name).collect();
    let head = header(&[&["α"], names.as_slice()].concat(), &[]);
    let parts = view.models.first().map_or(&[][..], |model| &model.tried);
    let groups: Vec<Vec<Vec<String>>> = parts
        .iter()
        .map(|tried| {
            let part = tried.part_of_pi;
            let drawn = if part == view.part_of_pi {
                " (drawn)"
            } else {
                ""
            };
            let mut row = vec![format!("π/{part}{drawn}")];
            row.extend(
                view.models
                    .iter()
                    .map(|m| m.faces_at(part).map_or_else(String::new, thousands)),
            );
            vec![row]
        })
        .collect();
    let models: String = view
        .models
        .iter()
        .map(|model| pictures(&model.pictures, ""))
        .collect();
    let uniform: Vec<String> = view
        .models
        .iter()
        .map(|m| format!("{} {}", m.name, thousands(m.uniform_faces)))
        .collect();
    let caption = format!(
        "Faces after two view-dependent steps (uniform: {})",
        uniform.join(", ")
    );
    models + &table("view-table", &caption, &head, &groups) + &findings(&prose::figure_9(view))
}

fn drift(results: &Results) -> String {
    let angle = results.settings.extra_angle_degrees;
    let intro = format!(
        "The paper's method at {angle}° after more and more steps, beside uniform refinement with limit vertices after \
         as many levels. (Uniform refinement is not shown at the level that stands for the limit surface itself.)"
    );
    let picture = Picture::drawn(
        "drift",
        "Distance against the number of steps, a small chart for each model",
        "All charts have the same scales. The numbers are in drift.csv.",
    );
    paragraph(&intro) + &wide(&picture) + &findings(&prose::drift_findings(results))
}

fn seams(results: &Results) -> String {
    let over = "<tr class=\"over\"><th></th><th colspan=\"2\">all</th><th colspan=\"2\">any</th>\
                <th colspan=\"2\">inner</th></tr>\n";
    let head = over.to_owned()
        + &header(
            &[
                "model", "faces", "SHD %", "faces", "SHD %", "faces", "SHD %",
            ],
            &[],
        );
    let groups: Vec<Vec<Vec<String>>> = results
        .table_1
        .iter()
        .map(|study| {
            let mut row = vec![study.model.to_owned()];
            for seam in &study.seams {
                row.extend([
                    thousands(seam.measured.faces),
                    shd(seam.measured.shd_percent),
                ]);
            }
            vec![row]
        })
        .collect();
    let caption = format!(
        "{} steps at {}°, by seam rule",
        results.settings.steps, results.settings.extra_angle_degrees
    );
    paragraph(&prose::seams(results)) + &table("seam-table", &caption, &head, &groups)
}

fn files(results: &Results) -> String {
    let stems = |part: &Part| format!("{}: {}", part.name, paper_models::stems(part).join(" or "));
    let parts: Vec<String> = TABLE_1
        .iter()
        .chain([&HEAD, &SHOE, &SPHERE])
        .map(stems)
        .collect();
    let looked_for = format!(
        "With --models DIR, these names are looked for with the extension off, obj, ply or stl: {}. A built-in model \
         takes the place of one that is not there.",
        parts.join("; ")
    );
    let again = "<p>Written by <code>limitmesh reproduce</code>, version ";
    format!(
        "<ul>\n<li><a href=\"table1.csv\">table1.csv</a>: Table 1</li>\n\
         <li><a href=\"drift.csv\">drift.csv</a>: distances by steps</li>\n\
         <li><a href=\"seams.csv\">seams.csv</a>: distances by seam rule</li>\n\
         <li><a href=\"reproduction.json\">reproduction.json</a>: all of it, with both directions of each distance, \
         sample counts, matched angles and seconds</li>\n</ul>\n{again}{}. The same models give the same page for any \
         number of threads.</p>\n{}",
        escape(results.version),
        paragraph(&looked_for)
    )
}
