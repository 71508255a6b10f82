//! `view`: the page in one file, and the page that the program serves.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::GzDecoder;
use serde_json::{Value, json};

use crate::common::{bytes, command, done, folder, number, text, usage_error};

/// The data of a page.
struct Page {
    html: String,
    data: Value,
}

impl Page {
    fn of(html: String) -> Self {
        let data = element(&html, "limitmesh").expect("data");
        Self {
            data: serde_json::from_str(data).expect("JSON"),
            html,
        }
    }

    /// A part of the page, unpacked where it is packed.
    fn part(&self, part: &Value) -> Vec<u8> {
        let (name, is_packed) = match part.as_str() {
            Some(name) => (name, false),
            None => (part["blob"].as_str().expect("a name"), part["gzip"] == true),
        };
        let own = STANDARD
            .decode(element(&self.html, name).expect("a part"))
            .expect("base64");
        if !is_packed {
            return own;
        }
        let mut unpacked = Vec::new();
        GzDecoder::new(&own[..])
            .read_to_end(&mut unpacked)
            .expect("gzip");
        unpacked
    }
}

/// The text in an element.
fn element<'h>(html: &'h str, id: &str) -> Option<&'h str> {
    let (_, rest) = html.split_once(&format!("id=\"{id}\">"))?;
    Some(rest.split_once("</script>")?.0)
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes
        .as_chunks()
        .0
        .iter()
        .map(|&own| f32::from_le_bytes(own))
        .collect()
}

/// The greatest of some distances is near what is proven, and none is beyond.
fn are_near(distances: &[f32], report: &Value) {
    assert_eq!(distances.len() as f64, number(&report["triangles"]));
    let greatest = distances.iter().copied().fold(0.0, f32::max);
    let [lower, upper] = ["lower", "upper"].map(|name| number(&report[name]));
    at_most!(f64::from(greatest), upper * (1.0 + 1e-3));
    assert!(f64::from(greatest) > 0.7 * lower, "{greatest} of {lower}");
}

#[test]
fn a_page_holds_what_refine_gives() {
    let folder = folder();
    let (page, mesh) = (
        folder.path().join("cup.html"),
        folder.path().join("cup.glb"),
    );
    let written = done("view builtin:cup -o {} --stops 0.1%,1%", &[&page]);
    says!(written.stderr, "a page with 2 meshes");
    let page = Page::of(text(&page));
    assert_eq!(page.data["name"], "builtin:cup");
    assert!(page.data["live"].is_null() && page.data["left_out"] == json!([]));
    let stops = page.data["stops"].as_array().expect("stops");
    for (stop, share) in stops.iter().zip(["1%", "0.1%"]) {
        done(
            &format!("refine builtin:cup -o {{}} --overwrite --tolerance {share}"),
            &[&mesh],
        );
        let parts = &stop["parts"];
        assert!(page.part(&parts["glb"]) == bytes(&mesh), "{share}");
        are_near(&floats(&page.part(&parts["distances"])), &stop["report"]);
        assert!(page.part(&parts["uniform"]).starts_with(b"glTF"));
    }
    assert_eq!(stops.len(), 2);
    assert!(page.part(&page.data["picture"]).starts_with(b"\x89PNG"));
}

#[test]
fn a_cage_has_the_edges_of_its_polygons() {
    let page = folder();
    let page = page.path().join("cube.html");
    done("view builtin:cube -o {}", &[&page]);
    let page = Page::of(text(&page));
    let cage = floats(&page.part(&page.data["cage"]));
    let soup = limitmesh_models::find("cube").expect("a model").soup();
    let sides: usize = soup.faces.iter().map(<[u32]>::len).sum();
    // Each edge of a closed cage is a side of two polygons.
    assert_eq!(cage.len(), 6 * sides / 2);
}

#[test]
fn what_cannot_be_viewed_is_refused() {
    usage_error("view -", &[], "not standard input");
    usage_error("view builtin:cup --stops 1%", &[], "--output");
    usage_error(
        "view builtin:cup -o {} --no-open",
        &[Path::new("page.html")],
        "cannot be used with",
    );
    usage_error(
        "view builtin:cup --stops 1% --no-open",
        &[],
        "cannot be used with",
    );
}

/// A program that serves a page, ended with the test.
struct Served {
    child: Child,
    port: u16,
    /// With slashes around it.
    path: String,
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// An answer's status and body.
struct Answer {
    status: u16,
    body: Vec<u8>,
}

impl Served {
    fn new(options: &str) -> Self {
        let mut child = command(&format!("view {options} --no-open"), &[])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let mut line = String::new();
        let stdout = child.stdout.take().expect("its output");
        BufReader::new(stdout)
            .read_line(&mut line)
            .expect("its address");
        let line = line.trim().strip_prefix("http://").expect("an address");
        let (host, path) = line.split_at(line.find('/').expect("a path"));
        let port = host
            .rsplit(':')
            .next()
            .expect("a port")
            .parse()
            .expect("a number");
        Self {
            child,
            port,
            path: path.to_owned(),
        }
    }

    fn connected(&self) -> TcpStream {
        TcpStream::connect(("127.0.0.1", self.port)).expect("a server")
    }

    fn ask(&self, method: &str, path: &str, headers: &str, body: &str) -> Answer {
        let mut stream = self.connected();
        let length = body.len();
        write!(
            stream,
            "{method} {path} HTTP/1.1\r\n{headers}Connection: close\r\nContent-Length: {length}\r\n\r\n{body}"
        )
        .expect("sent");
        let mut all = Vec::new();
        stream.read_to_end(&mut all).expect("an answer");
        let end = all
            .windows(4)
            .position(|own| own == b"\r\n\r\n")
            .expect("a head");
        let head = String::from_utf8_lossy(&all[..end]).into_owned();
        let status = head
            .split(' ')
            .nth(1)
            .expect("a status")
            .parse()
            .expect("a number");
        let body = all[end + 4..].to_vec();
        let is_chunked = head.to_lowercase().contains("transfer-encoding: chunked");
        let body = if is_chunked { unchunked(&body) } else { body };
        Answer { status, body }
    }

    /// The request of a page that stays open.
    fn opened(&self) -> TcpStream {
        let mut page = self.connected();
        let (path, host) = (&self.path, self.host());
        write!(page, "GET {path}alive HTTP/1.1\r\n{host}\r\n").expect("sent");
        page.read_exact(&mut [0]).expect("a sign of life");
        page
    }

    fn host(&self) -> String {
        format!("Host: 127.0.0.1:{}\r\n", self.port)
    }

    fn refine(&self, tolerance: f64) -> Answer {
        let body = json!({ "tolerance": tolerance, "uniform": false }).to_string();
        self.ask("POST", &format!("{}refine", self.path), &self.host(), &body)
    }
}

fn unchunked(mut body: &[u8]) -> Vec<u8> {
    let mut all = Vec::new();
    while let Some(end) = body.windows(2).position(|own| own == b"\r\n") {
        let length = std::str::from_utf8(&body[..end]).expect("a length");
        let length = usize::from_str_radix(length, 16).expect("a length");
        all.extend(&body[end + 2..][..length]);
        body = &body[end + 2 + length + 2..];
        if length == 0 {
            break;
        }
    }
    all
}

#[test]
fn the_page_gets_meshes_and_nobody_else_does() {
    let served = Served::new("builtin:cup");
    let page = served.ask("GET", &served.path, &served.host(), "");
    assert_eq!(page.status, 200);
    let page = Page::of(String::from_utf8(page.body).expect("text"));
    assert_eq!(page.data["live"]["refine"], "refine");
    let answer = served.refine(1e-3);
    assert_eq!(answer.status, 200);
    let (length, rest) = answer.body.split_at(4);
    let length = u32::from_le_bytes(length.try_into().expect("four bytes")) as usize;
    let said: Value = serde_json::from_slice(&rest[..length]).expect("JSON");
    let part = |name: &str| {
        let [start, size] =
            [0, 1].map(|i| said["parts"][name][i].as_u64().expect("a place") as usize);
        &rest[length..][start..start + size]
    };
    assert!(part("glb").starts_with(b"glTF"));
    are_near(&floats(part("distances")), &said["report"]);
    assert_eq!(served.refine(-1.0).status, 400);

    let (own, path) = (served.host(), served.path.as_str());
    let port = served.port;
    for (path, headers) in [
        (path, format!("Host: localhost.example:{port}\r\n")),
        (path, format!("{own}Origin: http://localhost.example\r\n")),
        (path, format!("{own}Sec-Fetch-Site: cross-site\r\n")),
        ("/", own.clone()),
        ("/00000000000000000000000000000000/", own.clone()),
    ] {
        assert_eq!(
            served.ask("GET", path, &headers, "").status,
            403,
            "{path} {headers}"
        );
    }
}

#[test]
#[cfg(unix)]
fn a_signal_ends_it_in_good_order() {
    let mut served = Served::new("builtin:cup");
    let page = served.opened();
    let process = served.child.id().to_string();
    // Ctrl-C is ignored by whatever a shell starts in the background, these tests among them.
    let sent = Command::new("kill").args(["-TERM", &process]).status();
    assert!(sent.expect("kill").success());
    let status = served.child.wait().expect("its end");
    drop(page);
    assert!(status.success(), "{status}");
}

#[test]
fn a_newer_request_wins_and_the_program_ends_with_its_page() {
    let mut served = Served::new("builtin:head");
    let page = served.opened();
    std::thread::scope(|scope| {
        let long = scope.spawn(|| served.refine(1e-7));
        std::thread::sleep(Duration::from_millis(300));
        assert_eq!(served.refine(1e-2).status, 200);
        assert_eq!(long.join().expect("an answer").status, 409);
    });
    drop(page);
    let gone = Instant::now();
    while served.child.try_wait().expect("its state").is_none() {
        assert!(gone.elapsed() < Duration::from_secs(60), "it still runs");
        std::thread::sleep(Duration::from_millis(100));
    }
    assert!(gone.elapsed() > Duration::from_secs(8), "it ended at once");
}
