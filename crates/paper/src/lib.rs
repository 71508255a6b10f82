//! The paper's table and figures, measured and drawn anew, and the methods that they compare.
//!
//! Takes the models (files whose names match, built-in ones else); writes a folder with one page, its pictures,
//! and the numbers as CSV and JSON. Everything that the page says of numbers is worked out from the numbers.

mod figures;
mod folder;
pub mod format;
mod html;
mod matching;
pub mod methods;
mod numbers;
mod page;
mod palette;
mod paper_models;
mod pictures;
mod plot;
mod prose;
mod readings;
mod room;
mod settings;
mod statistics;
mod study;
mod vector;

use std::path::{Path, PathBuf};
use std::time::Instant;

use limitmesh::Mesh;
use limitmesh::scheme::{Loop, Scheme};

use crate::format::counted;
use figures::Picture;
use figures::view::Shown;
use folder::Folder;
use numbers::Results;
use paper_models::{Casting, ELLIPSOID, HEAD, Player, SHOE, SPHERE, TABLE_1};
use pictures::Renderer;
use room::Room;
use settings::Settings;

pub use matching::{Matched, match_angle, nearest_level};

/// What the study needs of the program that runs it.
pub trait Host {
    /// The control mesh in a file, or the built-in model after `builtin:`.
    ///
    /// # Errors
    /// There is none, or it cannot be read.
    fn load(&self, name: &str) -> anyhow::Result<Mesh>;

    /// Writes a file, whole or not at all.
    ///
    /// # Errors
    /// It cannot be written.
    fn write(&self, path: &Path, bytes: &[u8]) -> anyhow::Result<()>;

    /// Says what comes next.
    fn stage(&self, what: &str);
}

/// What is wanted.
#[derive(Clone, Debug)]
pub struct Request {
    /// The folder to write; made if it does not exist, files in it are overwritten.
    pub output: PathBuf,
    /// The folder with the paper's models; built-in models stand in for those that are not there.
    pub models: Option<PathBuf>,
    /// One angle, fewer samples, coarser references and smaller pictures.
    pub quick: bool,
}

/// What was written.
#[derive(Clone, Debug)]
pub struct Written {
    /// Number of files.
    pub files: usize,
    /// The page.
    pub page: PathBuf,
}

/// Figure 9's uniform counts, printed as 576 and 1328, and its adaptive counts as the text extracted from its PDF has
/// them. 5,760 is a sphere of 20 slices by 10 stacks after two levels; 13,280 is 830 faces after two.
const FIGURE_9_SPHERE: (usize, &str) = (5760, "188");
const FIGURE_9_BUNNY: (usize, &str) = (13_280, "6626");

/// Measures and draws everything anew.
///
/// # Errors
/// A model or a file cannot be read or written, or a refinement or measurement fails.
pub fn reproduce(request: &Request, host: &dyn Host) -> anyhow::Result<Written> {
    let start = Instant::now();
    let settings = Settings::new(request.quick);
    let casting = Casting::new(request.models.as_deref(), host)?;
    let company = Company::gather(&casting)?;
    let mut folder = Folder::new(request.output.clone(), host)?;
    let renderer = Renderer::new(settings.picture_side);

    let mut table_1 = Vec::new();
    for (index, player) in company.table_1.iter().enumerate() {
        let stage = |what: &str| {
            let count = company.table_1.len();
            host.stage(&format!(
                "Table 1: {} ({} of {count}), {what}",
                player.name,
                index + 1
            ));
        };
        table_1.push(study::study(player, &settings, &stage)?);
    }
    let portraits = portraits(&company.table_1, &renderer, &mut folder, host)?;
    host.stage("Figures 2 and 5");
    let all: Vec<&Player> = company.table_1.iter().collect();
    let figure_2 = match company.table_1.first() {
        Some(player) => figures::cone::cone(player, &mut folder)?,
        None => None,
    };
    let figure_5 = figures::closure::closure(&all, &mut folder)?;
    host.stage("Figure 7");
    let figure_7 = company
        .heads
        .iter()
        .map(|head| figures::head::head(head, &renderer, &mut folder));
    let figure_7 = figure_7.collect::<Result<Vec<_>, _>>()?;
    host.stage("Figure 8");
    let figure_8 = figures::shoe::shoe(&company.shoe, &renderer, &mut folder)?;
    host.stage("Figure 9");
    let figure_9 = figures::view::view_dependent(&company.shown(), &renderer, &mut folder)?;

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
    Ok(Written {
        files: folder.count(),
        page: folder.path_of("index.html"),
    })
}

/// All models that take part.
struct Company {
    table_1: Vec<Player>,
    /// The head that plays in Figure 7, the built-in one beside it, and the ellipsoid.
    heads: Vec<Player>,
    shoe: Player,
    sphere: Player,
}

impl Company {
    fn gather(casting: &Casting<'_>) -> anyhow::Result<Self> {
        let head = casting.play(&HEAD)?;
        let mut heads = if head.origin.file {
            vec![head, casting.builtin(&HEAD)?]
        } else {
            vec![head]
        };
        heads.push(casting.builtin(&ELLIPSOID)?);
        Ok(Self {
            table_1: TABLE_1
                .iter()
                .map(|part| casting.play(part))
                .collect::<Result<_, _>>()?,
            heads,
            shoe: casting.play(&SHOE)?,
            sphere: casting.play(&SPHERE)?,
        })
    }

    /// The models of Figure 9.
    fn shown(&self) -> Vec<Shown<'_>> {
        let pairs = [
            (Some(&self.sphere), FIGURE_9_SPHERE),
            (self.table_1.first(), FIGURE_9_BUNNY),
        ];
        let shown =
            pairs
                .into_iter()
                .filter_map(|(player, (paper_uniform, paper_adaptive_printed))| {
                    Some(Shown {
                        player: player?,
                        paper_uniform,
                        paper_adaptive_printed,
                    })
                });
        shown.collect()
    }
}

/// Figure 6: the control meshes of Table 1.
fn portraits(
    players: &[Player],
    renderer: &Renderer,
    folder: &mut Folder<'_>,
    host: &dyn Host,
) -> anyhow::Result<Vec<Picture>> {
    host.stage("Figure 6");
    let mut pictures = Vec::new();
    for player in players {
        let file = format!("figure6-{}.png", player.name);
        folder.write(&file, &renderer.portrait(&player.mesh, player.view())?)?;
        let caption = format!(
            "{}: {}",
            player.name,
            counted(player.mesh.face_count(), "face", "faces")
        );
        pictures.push(Picture::new(
            file,
            format!("Control mesh of the {caption}"),
            caption,
        ));
    }
    Ok(pictures)
}

/// Writes the numbers, the charts and, last, the page.
fn write(results: &Results, portraits: &[Picture], folder: &mut Folder<'_>) -> anyhow::Result<()> {
    folder.write(
        "table1.csv",
        numbers::table_1_csv(results.rows()).as_bytes(),
    )?;
    folder.write(
        "references.csv",
        numbers::references_csv(results.rows()).as_bytes(),
    )?;
    folder.write("drift.csv", numbers::drift_csv(&results.table_1).as_bytes())?;
    folder.write("seams.csv", numbers::seams_csv(&results.table_1).as_bytes())?;
    let json = serde_json::to_string_pretty(results)? + "\n";
    folder.write("reproduction.json", json.as_bytes())?;
    let rows: Vec<_> = results.rows().cloned().collect();
    let drift: Vec<_> = results
        .table_1
        .iter()
        .flat_map(|study| study.drift.clone())
        .collect();
    let angle = results.settings.extra_angle_degrees;
    for room in Room::ALL {
        folder.write(&room.file("table1"), plot::table_1(&rows, room)?.as_bytes())?;
        folder.write(
            &room.file("drift"),
            plot::drift(&drift, angle, room)?.as_bytes(),
        )?;
    }
    folder.write("index.html", page::page(results, portraits).as_bytes())
}
