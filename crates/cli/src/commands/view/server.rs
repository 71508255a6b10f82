//! The program as the page's server, until the page is gone.
//!
//! A request for a mesh cancels the one before it. An answer that never ends shows whether the page is still open.

use std::collections::HashMap;
use std::io::{self, Read, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde::Deserialize;
use serde_json::json;
use tiny_http::{Header, Method, Request, Response, Server};

use super::connection::Address;
use super::refined::{self, Listener, Wanted};
use super::subject::Subject;
use crate::arguments::ViewArguments;
use crate::failure::Outcome;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;

/// The program ends when no page has been open for so long.
const ALONE: Duration = Duration::from_secs(10);

/// How often open pages get a sign of life, and their absence is noticed.
const BEAT: Duration = Duration::from_millis(300);

/// No request of the page is longer.
const MOST_ASKED: u64 = 1 << 16;

/// What the page asks for.
#[derive(Deserialize)]
struct Asked {
    /// The number of the page that asks: several may be open.
    #[serde(default)]
    page: u64,
    tolerance: f64,
    #[serde(default)]
    uniform: bool,
    #[serde(default)]
    format: String,
}

/// The server and what it knows of its pages.
struct Pages<'a> {
    subject: &'a Subject<'a>,
    address: Address,
    html: String,
    /// By page, the number of its newest request for a mesh.
    newest: Mutex<HashMap<u64, u64>>,
    /// Meshes are refined one after the other.
    turn: Mutex<()>,
    open: AtomicUsize,
}

/// Serves the page until it is closed.
pub(super) fn serve(
    subject: &Subject<'_>,
    arguments: &ViewArguments,
    progress: &Progress,
) -> anyhow::Result<Outcome> {
    let server = Server::http("127.0.0.1:0")
        .map_err(|error| anyhow::anyhow!("no port of this computer is free: {error}"))?;
    let port = server
        .server_addr()
        .to_ip()
        .map_or(0, |address| address.port());
    let pages = Pages {
        subject,
        address: Address::new(port)?,
        html: super::live(subject, arguments, progress)?,
        newest: Mutex::default(),
        turn: Mutex::new(()),
        open: AtomicUsize::new(0),
    };
    let address = pages.address.page();
    progress.clear();
    // On its own line, for programs that read it.
    output::print(&format!("{address}\n"))?;
    if arguments.no_open {
        progress.note("open this address in a browser; Ctrl-C ends the program");
    } else if let Err(error) = open::that_detached(&address) {
        progress.note(format!(
            "no browser was opened ({error}): open the address in one"
        ));
    }
    // Ctrl-C is how it ends, not a failure.
    interrupt::leave_to_caller();
    std::thread::scope(|scope| {
        let mut last_open = None;
        loop {
            if let Some(request) = server.recv_timeout(BEAT)? {
                scope.spawn(|| pages.answer(request));
            }
            if pages.open.load(Ordering::Relaxed) > 0 {
                last_open = Some(Instant::now());
            }
            // The first page may take its time.
            let is_alone = last_open.is_some_and(|last: Instant| last.elapsed() > ALONE);
            if is_alone || interrupt::is_asked() {
                return Ok(Outcome::Done);
            }
        }
    })
}

impl Pages<'_> {
    /// Answers a request. What the browser no longer wants to hear is lost, and that is as well.
    fn answer(&self, mut request: Request) {
        let asked = self.address.asked(&request).map(str::to_owned);
        let answered = match (request.method(), asked.as_deref()) {
            (Method::Get, Some("")) => {
                let page = Response::from_string(self.html.as_str());
                request.respond(with_type(page, "text/html; charset=utf-8"))
            }
            (Method::Get, Some("alive")) => self.stay(request),
            (Method::Post, Some(what @ ("refine" | "file"))) => {
                let (status, body) = self.mesh(what, &mut request);
                let body = Response::from_data(body).with_status_code(status);
                request.respond(with_type(body, "application/octet-stream"))
            }
            (_, Some(_)) => request.respond(Response::empty(404)),
            (_, None) => request.respond(Response::empty(403)),
        };
        answered.unwrap_or_default();
    }

    /// Writes a sign of life now and then while somebody reads it.
    fn stay(&self, request: Request) -> io::Result<()> {
        self.open.fetch_add(1, Ordering::Relaxed);
        let mut writer = request.into_writer();
        let mut stay = || -> io::Result<()> {
            writer.write_all(
                b"HTTP/1.1 200 OK\r\nContent-Type: application/octet-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n",
            )?;
            while !interrupt::is_asked() {
                writer.write_all(b".")?;
                writer.flush()?;
                std::thread::sleep(BEAT);
            }
            Ok(())
        };
        let ended = stay();
        self.open.fetch_sub(1, Ordering::Relaxed);
        ended
    }

    /// A mesh that is asked for, with the status of the answer.
    fn mesh(&self, what: &str, request: &mut Request) -> (u16, Vec<u8>) {
        let mut text = String::new();
        let read = request
            .as_reader()
            .take(MOST_ASKED)
            .read_to_string(&mut text);
        let asked = read.map_err(anyhow::Error::from);
        let asked = asked.and_then(|_| Ok(serde_json::from_str::<Asked>(&text)?));
        let asked = match asked {
            Ok(asked) if asked.tolerance > 0.0 && asked.tolerance.is_finite() => asked,
            Ok(asked) => {
                let why = format!("a tolerance of {}, expected one above 0", asked.tolerance);
                return (400, error(&why));
            }
            Err(why) => return (400, error(&why.to_string())),
        };
        let number = self.begin(asked.page);
        // The one before ends soon, since this one is newer.
        let Ok(_turn) = self.turn.lock() else {
            return (
                500,
                error("an earlier mesh failed; start the program again"),
            );
        };
        let is_over = || interrupt::is_asked() || self.newest_of(asked.page) != number;
        if is_over() {
            return (409, error("a newer request came"));
        }
        let listener = Listener::new(&is_over);
        let found = match what {
            "file" => self.file(&asked, &listener),
            _ => self.stop(&asked, &listener),
        };
        match found {
            Ok(body) => (200, body),
            Err(_) if is_over() => (409, error("a newer request came")),
            Err(why) => (422, error(&format!("{why:#}"))),
        }
    }

    /// The number of a page's newest request: a new one.
    fn begin(&self, page: u64) -> u64 {
        let mut newest = self.newest.lock().unwrap_or_else(PoisonError::into_inner);
        let own = newest.entry(page).or_default();
        *own += 1;
        *own
    }

    fn newest_of(&self, page: u64) -> u64 {
        let newest = self.newest.lock().unwrap_or_else(PoisonError::into_inner);
        newest.get(&page).copied().unwrap_or_default()
    }

    fn stop(&self, asked: &Asked, listener: &Listener<'_>) -> anyhow::Result<Vec<u8>> {
        let wanted = Wanted {
            tolerance: asked.tolerance,
            uniform: asked.uniform,
        };
        Ok(refined::stop(self.subject, wanted, listener)?.answer()?)
    }

    fn file(&self, asked: &Asked, listener: &Listener<'_>) -> anyhow::Result<Vec<u8>> {
        let extension = match asked.format.as_str() {
            own @ ("glb" | "ply") => own,
            other => anyhow::bail!("'{other}' is not glb or ply"),
        };
        refined::file(self.subject, asked.tolerance, extension, listener)
    }
}

fn error(why: &str) -> Vec<u8> {
    json!({ "error": why }).to_string().into_bytes()
}

/// A response of a type, which is not kept and not guessed at.
fn with_type<R: Read>(response: Response<R>, media: &str) -> Response<R> {
    let headers = [
        ("Content-Type", media),
        ("Cache-Control", "no-store"),
        ("X-Content-Type-Options", "nosniff"),
    ];
    headers.into_iter().fold(
        response,
        |response, (name, value)| match Header::from_bytes(name, value) {
            Ok(header) => response.with_header(header),
            Err(()) => response,
        },
    )
}
