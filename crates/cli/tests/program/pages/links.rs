//! Links on pages: files are there, and headings, too; and the README stays short.

use std::path::Path;

use super::{Page, pages};
use crate::kept::root;

#[test]
fn links_between_files_lead_somewhere() {
    let pages = pages();
    let mut dead = Vec::new();
    for page in &pages {
        let folder = root()
            .join(&page.name)
            .parent()
            .expect("a folder")
            .to_owned();
        for target in targets(&page.text) {
            let (path, heading) = target.split_once('#').unwrap_or((target, ""));
            let file = if path.is_empty() {
                root().join(&page.name)
            } else {
                folder.join(path)
            };
            let is_there = file.exists()
                && (heading.is_empty() || headings(&file).iter().any(|own| own == heading));
            if !is_there {
                dead.push(format!("{}: {target}", page.name));
            }
        }
    }
    assert!(dead.is_empty(), "{dead:#?}");
}

#[test]
fn pages_are_all_reached_from_the_readme() {
    let pages = pages();
    let mut reached = vec!["README.md".to_owned()];
    let mut next = 0;
    while let Some(name) = reached.get(next).cloned() {
        next += 1;
        let Some(page) = pages.iter().find(|page| page.name == name) else {
            continue;
        };
        for target in targets(&page.text) {
            let path = target.split('#').next().unwrap_or_default();
            let file = Path::new(&page.name).parent().expect("a folder").join(path);
            let file = normal(&file);
            if !reached.contains(&file) {
                reached.push(file);
            }
        }
    }
    let lost: Vec<&String> = pages
        .iter()
        .map(|page| &page.name)
        .filter(|name| name.starts_with("docs/") && !reached.contains(name))
        .collect();
    assert!(lost.is_empty(), "{lost:?}");
}

#[test]
fn the_readme_is_short() {
    let Page { text, .. } = pages()
        .into_iter()
        .find(|page| page.name == "README.md")
        .expect("a README");
    at_most!(text.lines().count(), 150);
    at_most!(text.len(), 8192);
}

/// The links of a page below the repository, outside code.
pub(super) fn targets(text: &str) -> Vec<&str> {
    let mut is_code = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        }
        if is_code {
            continue;
        }
        let parts = line
            .split("](")
            .skip(1)
            .filter_map(|after| after.split(')').next());
        found.extend(
            parts.filter(|target| !target.contains("://") && !target.starts_with("mailto:")),
        );
    }
    found
}

/// The names by which GitHub links to the headings of a page.
fn headings(file: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let titles = text
        .lines()
        .filter(|line| line.starts_with('#'))
        .map(|line| line.trim_start_matches('#').trim());
    let slug = |title: &str| {
        let kept = title
            .chars()
            .filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        kept.map(|c| if c == ' ' { '-' } else { c })
            .collect::<String>()
            .to_lowercase()
    };
    titles.map(slug).collect()
}

/// A path without `..`.
fn normal(path: &Path) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in path.iter().filter_map(|part| part.to_str()) {
        match part {
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}
