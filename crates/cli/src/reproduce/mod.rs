//! `limitmesh reproduce`: the paper's table and figures, measured and drawn anew.
//!
//! Takes the models (files whose names match, built-in ones else); writes a folder with one page, its pictures,
//! and the numbers as CSV and JSON. Everything that the page says of numbers is worked out from the numbers.

mod cast;
mod figures;
mod folder;
mod html;
mod ink;
mod methods;
mod numbers;
mod page;
mod plot;
mod prose;
mod readings;
mod settings;
mod space;
mod statistics;
mod studio;
mod study;

use std::time::Instant;

use limitmesh::scheme::{Loop, Scheme};

use crate::arguments::ReproduceArguments;
use crate::failure::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::words::{counted, seconds};

use cast::{Casting, HEAD, Player, SHOE, SPHERE, TABLE_1};
use figures::Picture;
use figures::view::Shown;
use folder::Folder;
use numbers::Results;
use settings::Settings;
use studio::Studio;

/// Figure 9's uniform counts, printed as 576 and 1328, and its adaptive counts as the text extracted from its PDF has
/// them. 5,760 is a sphere of 20 slices by 10 stacks after two levels; 13,280 is 830 faces after two.
const FIGURE_9_SPHERE: (usize, &str) = (5760, "188");
const FIGURE_9_BUNNY: (usize, &str) = (13_280, "6626");

/// Runs the command.
pub(crate) fn run(arguments: &ReproduceArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    let start = Instant::now();
    let settings = Settings::new(arguments.quick);
    let casting = Casting::new(arguments.models.as_deref(), progress)?;
    let company = Company::gather(&casting)?;
    let mut folder = Folder::new(arguments.output.clone())?;
    let studio = Studio::new(settings.picture_side);

    let mut table_1 = Vec::new();
    for (index, player) in company.table_1.iter().enumerate() {
        let stage = |what: &str| {
            let count = company.table_1.len();
            progress.stage(format!("Table 1: {} ({} of {count}), {what}", player.name, index + 1));
        };
        table_1.push(study::study(player, &settings, &stage)?);
    }
    let portraits = portraits(&company.table_1, &studio, &mut folder, progress)?;
    progress.stage("Figures 2 and 5");
    let all: Vec<&Player> = company.table_1.iter().collect();
    let figure_2 = match company.table_1.first() {
        Some(player) => figures::cone::cone(player, &mut folder)?,
        None => None,
    };
    let figure_5 = figures::closure::closure(&all, &mut folder)?;
    progress.stage("Figure 7");
    let figure_7 = company.heads.iter().map(|head| figures::head::head(head, &studio, &mut folder));
    let figure_7 = figure_7.collect::<Result<Vec<_>, _>>()?;
    progress.stage("Figure 8");
    let figure_8 = figures::shoe::shoe(&company.shoe, &studio, &mut folder)?;
    progress.stage("Figure 9");
    let figure_9 = figures::view::view_dependent(&company.shown(), &studio, &mut folder)?;

    let results = Results {
        version: env!("CARGO_PKG_VERSION"),
        scheme: Loop.name(),
        settings,
        table_1,
        figure_2,
        figure_5,
        figure_7,
        figure_8,
        figure_9,
        seconds: start.elapsed().as_secs_f64(),
    };
    write(&results, &portraits, &mut folder)?;
    progress.clear();
    output::print(&format!(
        "{} written in {}: {}",
        counted(folder.count(), "file", "files"),
        seconds(start.elapsed().as_secs_f64()),
        folder.path_of("index.html").display()
    ))?;
    Ok(Outcome::Done)
}

/// All models that take part.
struct Company {
    table_1: Vec<Player>,
    /// The head that plays in Figure 7, and the built-in one beside it.
    heads: Vec<Player>,
    shoe: Player,
    sphere: Player,
}

impl Company {
    fn gather(casting: &Casting<'_>) -> anyhow::Result<Self> {
        let head = casting.play(&HEAD)?;
        let heads = if head.origin.file { vec![head, casting.builtin(&HEAD)?] } else { vec![head] };
        Ok(Self {
            table_1: TABLE_1.iter().map(|part| casting.play(part)).collect::<Result<_, _>>()?,
            heads,
            shoe: casting.play(&SHOE)?,
            sphere: casting.play(&SPHERE)?,
        })
    }

    /// The models of Figure 9.
    fn shown(&self) -> Vec<Shown<'_>> {
        let pairs = [(Some(&self.sphere), FIGURE_9_SPHERE), (self.table_1.first(), FIGURE_9_BUNNY)];
        let shown = pairs.into_iter().filter_map(|(player, (paper_uniform, paper_adaptive_printed))| {
            Some(Shown { player: player?, paper_uniform, paper_adaptive_printed })
        });
        shown.collect()
    }
}

/// Figure 6: the control meshes of Table 1.
fn portraits(
    players: &[Player],
    studio: &Studio,
    folder: &mut Folder,
    progress: &Progress,
) -> anyhow::Result<Vec<Picture>> {
    progress.stage("Figure 6");
    let mut pictures = Vec::new();
    for player in players {
        let file = format!("figure6-{}.png", player.name);
        folder.write(&file, &studio.portrait(&player.mesh, player.view())?)?;
        let caption = format!("{}: {}", player.name, counted(player.mesh.face_count(), "face", "faces"));
        pictures.push(Picture::new(file, format!("Control mesh of the {caption}"), caption));
    }
    Ok(pictures)
}

/// Writes the numbers, the charts and, last, the page.
fn write(results: &Results, portraits: &[Picture], folder: &mut Folder) -> anyhow::Result<()> {
    folder.write("table1.csv", numbers::table_1_csv(results.rows()).as_bytes())?;
    folder.write("drift.csv", numbers::drift_csv(&results.table_1).as_bytes())?;
    folder.write("seams.csv", numbers::seams_csv(&results.table_1).as_bytes())?;
    folder.write("reproduction.json", output::json(results)?.as_bytes())?;
    let rows: Vec<_> = results.rows().cloned().collect();
    folder.write("table1.svg", plot::table_1(&rows)?.as_bytes())?;
    let drift: Vec<_> = results.table_1.iter().flat_map(|study| study.drift.clone()).collect();
    let angle = results.settings.extra_angle_degrees;
    folder.write("drift.svg", plot::drift(&drift, angle)?.as_bytes())?;
    folder.write("index.html", page::page(results, portraits).as_bytes())
}
