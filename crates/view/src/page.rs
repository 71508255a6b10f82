//! The page as a file: the viewer with the data in it.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Map, Value, json};

use crate::Stop;
use crate::stop::bytes;

/// The viewer, which has a place for data.
const VIEWER: &str = include_str!("../assets/view.html");

/// That place.
const PLACE: &str = "<!--limitmesh:data-->";

/// Where a page that a program serves sends its requests, relative to its own address.
#[derive(Clone, Copy, Debug)]
pub struct Live {
    /// Refines the mesh to a tolerance.
    pub refine: &'static str,
    /// An answer that never ends while the page is open.
    pub alive: &'static str,
    /// The refined mesh as a file.
    pub file: &'static str,
}

/// What a page holds.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// What the mesh is called.
    pub name: String,
    /// The unit of its numbers, if it is known.
    pub unit: Option<String>,
    /// The diagonal of its box: tolerances are shares of it.
    pub diagonal: f64,
    /// The tolerance that the page starts with.
    pub start: f64,
    /// The server that it asks for meshes; without one it shows its stops.
    pub live: Option<Live>,
    /// A picture for browsers that cannot draw, as a PNG file.
    pub picture: Option<Vec<u8>>,
    /// The edges of the control cage: two points each.
    pub cage: Vec<[[f32; 3]; 2]>,
    /// Meshes from the coarsest to the finest.
    pub stops: Vec<Stop>,
    /// No more bytes than this are put into the page, but for the first mesh.
    pub most: Option<usize>,
}

/// What did not fit into a page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Left(pub Vec<String>);

impl Page {
    /// The page, and what was left out of it.
    ///
    /// # Errors
    /// A number that JSON cannot hold.
    pub fn html(&self) -> io::Result<(String, Left)> {
        let mut blobs = Blobs {
            most: self.most.unwrap_or(usize::MAX),
            ..Blobs::default()
        };
        let mut stops = Vec::new();
        for (number, stop) in self.stops.iter().enumerate() {
            let Some(parts) = blobs.parts(number, stop)? else {
                let share = 100.0 * stop.tolerance;
                blobs.left.push(format!("the mesh within {share} %"));
                continue;
            };
            stops.push(
                json!({ "tolerance": stop.tolerance, "report": stop.report, "parts": parts }),
            );
        }
        let cage: Vec<f32> = self.cage.iter().flatten().flatten().copied().collect();
        let cage = (!cage.is_empty())
            .then(|| blobs.add_plain("data-cage", &bytes(&cage), "the control cage"));
        let picture = self.picture.as_ref();
        let picture =
            picture.map(|picture| blobs.add_plain("data-picture", picture, "the picture"));
        let live = self.live.as_ref();
        let data = json!({
            "version": 1,
            "name": self.name,
            "unit": self.unit,
            "diagonal": self.diagonal,
            "start": self.start,
            "live": live.map(|live| json!({ "refine": live.refine, "alive": live.alive, "file": live.file })),
            "picture": picture.flatten(),
            "cage": cage.flatten(),
            "stops": stops,
            "left_out": blobs.left,
            "most": self.most,
        });
        // Nothing in a text may end the element that it stands in.
        let data = serde_json::to_string(&data)?.replace('<', "\\u003c");
        let elements = format!(
            "<script type=\"application/json\" id=\"limitmesh\">{data}</script>{}",
            blobs.elements
        );
        Ok((VIEWER.replacen(PLACE, &elements, 1), Left(blobs.left)))
    }
}

/// The binary parts of a page as elements of text.
#[derive(Default)]
struct Blobs {
    elements: String,
    most: usize,
    left: Vec<String>,
}

impl Blobs {
    /// The parts of a stop; `None` where not even its mesh fits. The first one fits in any case.
    fn parts(&mut self, number: usize, stop: &Stop) -> io::Result<Option<Map<String, Value>>> {
        let mut parts = Map::new();
        for (name, part) in stop.parts() {
            let Some(part) = part else {
                parts.insert(name.to_owned(), Value::Null);
                continue;
            };
            let (id, packed) = (format!("data-{name}-{number}"), gzipped(&part)?);
            let is_mesh = name == "glb";
            if is_mesh && number == 0 || self.fits(&packed) {
                self.put(&id, &packed);
                parts.insert(name.to_owned(), json!({ "blob": id, "gzip": true }));
            } else if is_mesh {
                return Ok(None);
            } else {
                let what = name.replace('_', " ");
                self.left
                    .push(format!("{what} within {} %", 100.0 * stop.tolerance));
                parts.insert(name.to_owned(), Value::Null);
            }
        }
        Ok(Some(parts))
    }

    /// The name of a part that is not packed, or a line about it where it does not fit.
    fn add_plain(&mut self, name: &str, bytes: &[u8], what: &str) -> Option<Value> {
        let fits = self.fits(bytes);
        match fits {
            true => self.put(name, bytes),
            false => self.left.push(what.to_owned()),
        }
        fits.then(|| Value::from(name))
    }

    fn fits(&self, bytes: &[u8]) -> bool {
        self.elements.len() + bytes.len().div_ceil(3) * 4 <= self.most
    }

    fn put(&mut self, name: &str, bytes: &[u8]) {
        self.elements.push_str("<script type=\"text/plain\" id=\"");
        self.elements.push_str(name);
        self.elements.push_str("\">");
        STANDARD.encode_string(bytes, &mut self.elements);
        self.elements.push_str("</script>");
    }
}

/// The same bytes for the same input, whenever and wherever.
fn gzipped(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(bytes)?;
    packed.finish()
}
