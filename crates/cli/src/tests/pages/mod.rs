//! Pages of the documentation that are made from the code: `docs/cli.md` from the command line, `docs/reports.md` and
//! `docs/reports.schema.json` from the types of the reports.

mod cli;
#[path = "../../../tests/program/kept.rs"]
mod kept;
mod made;
mod reports;
pub(crate) mod schema;
