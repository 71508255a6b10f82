//! `limitmesh models`: the built-in models and what each is.

use serde::Serialize;

use crate::arguments::ModelsArguments;
use crate::failure::Outcome;
use crate::output;

/// A built-in model.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ModelEntry {
    /// Its name, after `builtin:`.
    name: &'static str,
    /// Its description.
    about: &'static str,
}

/// Lists the built-in models.
pub(crate) fn run(arguments: &ModelsArguments) -> anyhow::Result<Outcome> {
    let entries = limitmesh_models::all().iter().map(|model| ModelEntry {
        name: model.name,
        about: model.about,
    });
    if arguments.json {
        output::print(&output::json(&entries.collect::<Vec<_>>())?)?;
    } else {
        let width = entries
            .clone()
            .map(|entry| entry.name.len())
            .max()
            .unwrap_or(0);
        let lines: String = entries
            .map(|ModelEntry { name, about }| format!("builtin:{name:<width$}  {about}\n"))
            .collect();
        output::print(&lines)?;
    }
    Ok(Outcome::Done)
}
