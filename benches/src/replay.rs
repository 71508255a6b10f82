//! Replay: positions and normals of a refined mesh for frame after frame, beside OpenSubdiv's limit stencils at the same places.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, Result, ensure};
use limitmesh::Mesh;
use limitmesh::refine::{Exact, ExactOptions, Frame, Replay, exact};
use limitmesh::scheme::Loop;

use crate::clock::one_thread;
use crate::mesh;
use crate::peers::{OpenSubdiv, program_for};

/// Rounds in which each evaluates some frames, of so many vertices together: the clock of a thread knows milliseconds.
const ROUNDS: usize = 25;
const VERTICES: usize = 1_000_000;

/// The frames that rounds go through.
const FRAMES: usize = 16;

/// Tolerances in per cent of the diagonal.
const TOLERANCES: [f64; 3] = [0.1, 0.02, 0.004];

/// The precisions of the peer, and the processors that it is compiled for: the one that all this runs on, and any.
const PEERS: [(&str, &str); 4] = [
    ("double", "native"),
    ("float", "native"),
    ("double", "x86-64"),
    ("float", "x86-64"),
];

/// Replay of a refined model, warm, one thread, in turns with OpenSubdiv.
pub(crate) fn replay(model: &Path) -> Result<()> {
    let control = mesh(model)?;
    let name = model.file_name().unwrap_or_default().to_string_lossy();
    println!(
        "\nreplay of {name}, nanoseconds a vertex, least of {ROUNDS} warm rounds in turns; bytes a vertex"
    );
    println!(
        "tolerance  vertices                      positions  and normals  bytes  made in ms  greatest distance apart"
    );
    for percent in TOLERANCES {
        let tolerance = 0.01 * percent * control.diagonal();
        let options = ExactOptions::default()
            .tolerance(tolerance)
            .flat_regions(false);
        let refined = exact(&control, &Loop, &options)?;
        compare(model, &control, &refined, percent)?;
    }
    Ok(())
}

/// The control points turned around the third axis, the more the higher they are.
fn frames(control: &Mesh) -> Vec<Vec<[f64; 3]>> {
    let heights = || control.positions().iter().map(|p| p[2]);
    let (low, high) = (
        heights().fold(f64::MAX, f64::min),
        heights().fold(f64::MIN, f64::max),
    );
    let turned = |frame: usize, &[x, y, z]: &[f64; 3]| {
        let angle = 0.3 * frame as f64 / FRAMES as f64 * (z - low) / (high - low);
        [
            x * angle.cos() - y * angle.sin(),
            x * angle.sin() + y * angle.cos(),
            z,
        ]
    };
    let frame = |frame| {
        control
            .positions()
            .iter()
            .map(|p| turned(frame, p))
            .collect()
    };
    (1..=FRAMES).map(frame).collect()
}

fn compare(model: &Path, control: &Mesh, refined: &Exact, percent: f64) -> Result<()> {
    let frames = frames(control);
    let (built, replay) = one_thread(|| Replay::new(control, &Loop, refined))?;
    let replay = replay?;
    let mut frame = Frame::default();
    // Places stand face by face for the peer.
    let mut order: Vec<usize> = (0..refined.origins.len()).collect();
    order.sort_by_key(|&vertex| refined.origins[vertex].face);
    let folder = tempfile::tempdir()?;
    let places = folder.path().join("places");
    let mut text = String::new();
    for &vertex in &order {
        let [_, s, t] = refined.origins[vertex].barycentric;
        writeln!(text, "{} {s} {t}", refined.origins[vertex].face)?;
    }
    std::fs::write(&places, text)?;
    let mut peers = Vec::new();
    for (precision, processor) in PEERS {
        peers.extend(Peer::of((precision, processor), model, &places)?);
    }
    let mut best = [f64::MAX; 2];
    let count = refined.mesh.vertex_count();
    let several = (VERTICES / count).max(1);
    for _ in 0..ROUNDS {
        let mut moved = frames.iter().cycle().take(several);
        let (seconds, done) =
            one_thread(|| moved.try_for_each(|at| replay.positions(at, &mut frame)))?;
        done?;
        best[0] = best[0].min(seconds.all / several as f64);
        let mut moved = frames.iter().cycle().take(several);
        let (seconds, done) = one_thread(|| moved.try_for_each(|at| replay.frame(at, &mut frame)))?;
        done?;
        best[1] = best[1].min(seconds.all / several as f64);
        peers.iter_mut().try_for_each(|peer| peer.round(several))?;
    }
    let each = |seconds: f64| 1e9 * seconds / count as f64;
    let bytes = replay.table_bytes() as f64 / count as f64;
    println!(
        "{percent:7} %  {count:8}  ours                 {:9.1}  {:11.1}  {bytes:5.0}  {:10.1}",
        each(best[0]),
        each(best[1]),
        1e3 * built.all
    );
    replay.frame(control.positions(), &mut frame)?;
    for peer in &mut peers {
        ensure!(
            peer.stencils == count,
            "{} stencils for {count} vertices",
            peer.stencils
        );
        let apart = peer.apart(&order, &frame.positions, &folder.path().join("positions"))?;
        let times = [peer.best[0] / best[0], peer.best[1] / best[1]];
        println!(
            "           OpenSubdiv, {:6} for {:6}  {:9.1}  {:11.1}  {:5.0}              {:.1e} %, ours {:.2} and {:.2} times as fast, {:.2} of the bytes",
            peer.precision,
            peer.processor,
            each(peer.best[0]),
            each(peer.best[1]),
            peer.bytes as f64 / count as f64,
            100.0 * apart / control.diagonal(),
            times[0],
            times[1],
            replay.table_bytes() as f64 / peer.bytes as f64,
        );
    }
    if peers.is_empty() {
        println!("           OpenSubdiv is not installed");
    }
    Ok(())
}

/// OpenSubdiv's program, with its stencils made.
struct Peer {
    precision: &'static str,
    processor: &'static str,
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    stencils: usize,
    bytes: usize,
    best: [f64; 2],
}

impl Peer {
    fn of(
        (precision, processor): (&'static str, &'static str),
        model: &Path,
        places: &Path,
    ) -> Result<Option<Self>> {
        let Some(program) = program_for(OpenSubdiv::Stencils, processor)? else {
            return Ok(None);
        };
        let mut process = Command::new(program)
            .arg(precision)
            .args([model, places])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let input = process
            .stdin
            .take()
            .context("no input of OpenSubdiv's program")?;
        let output = process
            .stdout
            .take()
            .context("no output of OpenSubdiv's program")?;
        let mut peer = Self {
            precision,
            processor,
            process,
            input,
            output: BufReader::new(output),
            stencils: 0,
            bytes: 0,
            best: [f64::MAX; 2],
        };
        let line = peer.line()?;
        let numbers = line
            .split_whitespace()
            .map(str::parse)
            .collect::<Result<Vec<usize>, _>>()?;
        let [stencils, bytes] = numbers[..] else {
            anyhow::bail!("OpenSubdiv's program printed {line:?}, expected two numbers");
        };
        (peer.stencils, peer.bytes) = (stencils, bytes);
        Ok(Some(peer))
    }

    fn line(&mut self) -> Result<String> {
        let mut line = String::new();
        self.output.read_line(&mut line)?;
        ensure!(!line.is_empty(), "OpenSubdiv's program ended");
        Ok(line)
    }

    fn ask(&mut self, what: &str) -> Result<f64> {
        writeln!(self.input, "{what}")?;
        self.input.flush()?;
        Ok(self.line()?.trim().parse()?)
    }

    fn round(&mut self, several: usize) -> Result<()> {
        for (best, what) in ["p", "n"].into_iter().enumerate() {
            let mut seconds = 0.0;
            for _ in 0..several {
                seconds += self.ask(what)?;
            }
            self.best[best] = self.best[best].min(seconds / several as f64);
        }
        Ok(())
    }

    /// The greatest distance of its positions from ours.
    fn apart(&mut self, order: &[usize], positions: &[[f64; 3]], file: &Path) -> Result<f64> {
        self.ask(&format!("w {}", file.display()))?;
        let bytes = std::fs::read(file)?;
        let numbers: Vec<f64> = bytes
            .as_chunks::<8>()
            .0
            .iter()
            .map(|bytes| f64::from_le_bytes(*bytes))
            .collect();
        let points = numbers.as_chunks::<3>().0;
        let apart = points.iter().zip(order).map(|(point, &vertex)| {
            let squares = point
                .iter()
                .zip(positions[vertex])
                .map(|(a, b)| (a - b) * (a - b));
            squares.sum::<f64>().sqrt()
        });
        Ok(apart.fold(0.0, f64::max))
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // It ends with its input; where that fails there is nobody to tell.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
