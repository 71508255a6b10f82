//! `limitmesh view`: a mesh as a page in the browser, refined as its slider moves.
//!
//! ```text
//! file ─▶ subject ─▶ refined ─▶ limitmesh_view::Stop ─▶ page (a file) or server (127.0.0.1)
//! ```

mod connection;
mod distances;
mod refined;
mod server;
mod subject;

use std::path::Path;

use limitmesh_view::{Live, Page};

use super::limit_control;
use crate::arguments::ViewArguments;
use crate::failure::{Outcome, usage};
use crate::format::counted;
use crate::output;
use crate::progress::Progress;
use refined::{Listener, Wanted};
use subject::Subject;

/// A page has no more bytes of data than this, but for its first mesh.
const MOST_BYTES: usize = 64 << 20;

/// Where the page sends its requests.
const LIVE: Live = Live {
    refine: "refine",
    alive: "alive",
    file: "file",
};

/// Shows a mesh, or writes the page that shows it.
pub(crate) fn run(arguments: &ViewArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    if output::is_standard_output(&arguments.file) {
        return usage("the slider reads its mesh again and again: give a file, not standard input");
    }
    if let Some(path) = &arguments.output {
        output::check_writable(path)?;
        output::check_replaced(&[path], &[&arguments.file], Some(arguments.overwrite))?;
    }
    // What there is to say of the file is said with each mesh: here nothing of it is left out.
    let quiet = &Progress::new(true);
    let (control, limit) = limit_control::load(&arguments.file, &arguments.limit, quiet)?;
    let prepared = limit_control::prepared(control, &limit, quiet)?;
    let subject = Subject::new(arguments, &prepared, progress)?;
    match &arguments.output {
        Some(path) => write(path, &subject, arguments, progress),
        None => server::serve(&subject, arguments, progress),
    }
}

/// The page without meshes.
fn page(subject: &Subject<'_>, start: f64, progress: &Progress) -> anyhow::Result<Page> {
    Ok(Page {
        name: subject.name.clone(),
        unit: subject.unit.map(|unit| unit.name().to_owned()),
        diagonal: subject.diagonal,
        start,
        cage: subject.cage.clone(),
        picture: Some(subject.picture(progress)?),
        most: Some(MOST_BYTES),
        ..Page::default()
    })
}

/// Writes the page with a mesh for each stop.
fn write(
    path: &Path,
    subject: &Subject<'_>,
    arguments: &ViewArguments,
    progress: &Progress,
) -> anyhow::Result<Outcome> {
    let share = |extent: &_| subject.share(*extent);
    let mut shares = arguments
        .stops
        .iter()
        .map(share)
        .collect::<Result<Vec<_>, _>>()?;
    if shares.is_empty() {
        shares.push(subject.share(arguments.tolerance)?);
    }
    shares.sort_by(|a, b| b.total_cmp(a));
    shares.dedup();
    let stops = shares.iter().map(|&tolerance| {
        let wanted = Wanted {
            tolerance,
            uniform: true,
        };
        progress.stage(format!("refining to {:.4} %", 100.0 * tolerance));
        refined::stop(subject, wanted, &Listener::new(&|| false))
    });
    let page = Page {
        stops: stops.collect::<Result<_, _>>()?,
        ..page(subject, shares[shares.len() - 1], progress)?
    };
    let (html, left) = page.html()?;
    output::write_file(path, html.as_bytes())?;
    let what = left.0.iter().map(|what| {
        format!(
            "{}: left out, as the page would have more than {} MB: {what}",
            path.display(),
            MOST_BYTES >> 20
        )
    });
    progress.notes(what);
    progress.note(format!(
        "{}: a page with {}, {:.1} MB",
        path.display(),
        counted(page.stops.len(), "mesh", "meshes"),
        html.len() as f64 / 1e6
    ));
    Ok(Outcome::Done)
}

/// The page that asks the program for meshes.
fn live(
    subject: &Subject<'_>,
    arguments: &ViewArguments,
    progress: &Progress,
) -> anyhow::Result<String> {
    let start = subject.share(arguments.tolerance)?;
    let page = Page {
        live: Some(LIVE),
        ..page(subject, start, progress)?
    };
    Ok(page.html()?.0)
}
