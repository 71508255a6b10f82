//! `limitmesh reproduce`: the folder is whole, its numbers are numbers, and the page says what the files say.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{bytes, done, file, folder, list, names, number, run, text};

const COLUMNS: &str = "model,angle_degrees,faces,shd_percent,amresh_faces,amresh_shd_percent,ratio_percent,\
                       uniform_limit_faces,uniform_limit_shd_percent,exact_faces,exact_shd_percent";
const MODELS: [&str; 6] = ["bunny", "teddy", "shark", "cup", "radish", "cusp"];

fn read(folder: &Path, name: &str) -> String {
    text(folder.join(name))
}

/// The texts between two marks, each time they occur.
fn between<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    text.split(from)
        .skip(1)
        .filter_map(|rest| rest.split(to).next())
        .collect()
}

#[test]
fn the_folder_is_whole_and_the_page_says_what_the_files_say() {
    let place = folder();
    // The folder does not exist, nor does the one it is in.
    let out = place.path().join("new").join("paper");
    done("reproduce --quick -o {}", &[&out]);

    let csv = read(&out, "table1.csv");
    let rows = csv_is_sound(&csv);
    let page = read(&out, "index.html");
    links_lead_somewhere(&page, &out);
    json_agrees(&read(&out, "reproduction.json"), &rows);
    for name in names(&out).iter().filter(|name| name.ends_with(".svg")) {
        let svg = read(&out, name);
        assert!(svg.starts_with("<svg"), "{name}");
        assert!(svg.trim_end().ends_with("</svg>"), "{name}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
    }

    // Nothing but the seconds depends on the number of threads, or on what was in the folder before.
    let before = contents(&out);
    fs::write(out.join("index.html"), "x".repeat(1 << 20)).expect("writable");
    done("reproduce --quick --threads 1 -o {}", &[&out]);
    assert!(before == contents(&out), "the same run gave other files");
}

/// All files but the one with seconds in it.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let all = names(folder)
        .into_iter()
        .filter(|name| name != "reproduction.json");
    all.map(|name| (name.clone(), bytes(folder.join(&name))))
        .collect()
}

fn csv_is_sound(csv: &str) -> Vec<Vec<String>> {
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some(COLUMNS));
    let rows: Vec<Vec<String>> = lines
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect();
    for model in MODELS {
        assert!(rows.iter().any(|row| row[0] == model), "no row for {model}");
    }
    for row in &rows {
        let numbers: Vec<f64> = row[1..]
            .iter()
            .map(|cell| cell.parse().expect("a number"))
            .collect();
        assert_eq!(numbers.len(), 10, "{row:?}");
        assert!(numbers.iter().all(|x| x.is_finite() && *x > 0.0), "{row:?}");
        let [faces, shd, amresh_faces, amresh_shd, ratio] = [1, 2, 3, 4, 5].map(|i| numbers[i]);
        // The cells are rounded to four digits and to tenths of a per cent.
        assert!(
            (ratio - 100.0 * shd / amresh_shd).abs() < 0.06 + 1e-3 * ratio,
            "{row:?}"
        );
        assert!((amresh_faces / faces - 1.0).abs() < 0.05, "{row:?}");
        // Exact refinement has no more faces than the paper's method, and is not farther away.
        at_most!(numbers[8], faces, "{row:?}");
        above!(numbers[8], 0.8 * faces, "{row:?}");
        at_most!(numbers[9], shd, "{row:?}");
    }
    rows
}

fn links_lead_somewhere(page: &str, folder: &Path) {
    let links = ["src", "srcset", "href"]
        .map(|key| between(page, &format!(" {key}=\""), "\""))
        .concat();
    // Charts and drawn figures have a layout for phones.
    assert_eq!(
        between(page, "<source media=\"(max-width: 52rem)\"", ">").len(),
        4
    );
    assert!(links.len() > 30, "{links:?}");
    for link in links {
        match link.strip_prefix('#') {
            Some(id) => assert!(
                page.contains(&format!("id=\"{id}\"")),
                "no {link} on the page"
            ),
            None => {
                let bytes = bytes(folder.join(link));
                assert!(!bytes.is_empty(), "{link} is empty");
            }
        }
    }
}

fn json_agrees(json: &str, rows: &[Vec<String>]) {
    let json: Value = serde_json::from_str(json).expect("JSON");
    // The paper's Figure 7: 142 faces split in four three times.
    for head in list(&json["figure_7"]) {
        assert_eq!(head["control_faces"], 142);
        assert_eq!(head["uniform_faces"], 9088);
        assert!(head["adaptive_faces"].as_u64() < Some(9088));
    }
    let studies = list(&json["table_1"]);
    let measured: Vec<&Value> = studies
        .iter()
        .flat_map(|study| list(&study["rows"]))
        .collect();
    assert_eq!(measured.len(), rows.len());
    for (value, row) in measured.into_iter().zip(rows) {
        assert_eq!(value["model"], row[0].as_str());
        assert_eq!(value["paper"]["faces"].to_string(), row[2]);
        let paper = &value["paper"];
        let [shd, forward, backward] = ["shd_percent", "forward_percent", "backward_percent"]
            .map(|key| paper[key].as_f64().expect(key));
        assert!(
            (shd - forward.max(backward)).abs() < 1e-12 * shd,
            "equation (16): {paper}"
        );
        assert!((shd - row[3].parse::<f64>().expect("a number")).abs() < 1e-3 * shd);
    }
    for row in studies.iter().flat_map(|study| list(&study["rows"])) {
        let [sampled, upper, uniform] = [
            &row["exact"]["shd_percent"],
            &row["exact_upper_percent"],
            &row["uniform_limit"]["shd_percent"],
        ]
        .map(|x| number(x));
        // The reference is itself off the limit surface: it is two levels finer than the uniform mesh, each of which leaves a third.
        assert!(sampled <= upper + uniform / 9.0, "{row}");
    }
    // Uniform refinement of the sphere's 360 faces, twice, and fewer where the view matters.
    let sphere = &json["figure_9"]["models"][0];
    assert_eq!(sphere["uniform_faces"], 5760);
    for tried in list(&sphere["tried"]) {
        assert!(tried["faces"].as_u64() < Some(5760), "{tried}");
    }
}

#[test]
fn a_model_that_cannot_be_read_is_named() {
    let place = folder();
    let bad = file(&place, "teddy.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
    let out = place.path().join("out");
    let run = run("reproduce --quick --models {} -o {}", &[place.path(), &out]).expect(1);
    assert!(
        run.stderr.contains(&bad.display().to_string()),
        "{}",
        run.stderr
    );
    assert!(!out.exists(), "nothing is written");
}

#[test]
fn a_folder_of_models_that_is_none_is_refused() {
    let place = folder();
    let missing = place.path().join("nowhere");
    let run = run("reproduce --quick --models {}", &[&missing]).expect(1);
    assert!(run.stderr.contains("nowhere"), "{}", run.stderr);
}
