//! A line of the jobs: what it asks for, as arguments of `limitmesh refine`.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::Path;

use clap::CommandFactory;
use serde_json::value::RawValue;

use crate::arguments::{Arguments, Viewer};
use crate::file_identity::FileIdentity;
use crate::output::is_folder;

/// Whether a name is an address, with a scheme of at least two letters: `C://` is a drive.
pub(super) fn is_address(name: &str) -> bool {
    name.split_once("://").is_some_and(|(scheme, _)| {
        scheme.len() > 1
            && scheme
                .bytes()
                .all(|byte| byte.is_ascii_alphanumeric() || b"+.-:".contains(&byte))
    })
}

/// Options of `refine` that are no matter of a job: the report is in its result, and the batch has the others.
const NOT_OF_JOBS: [&str; 6] = ["output", "report", "threads", "quiet", "help", "version"];

/// Options that name other files to be written.
const WRITING: [&str; 2] = ["picture", "proof"];

/// A job.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Job {
    /// As the line names it.
    pub(super) input: String,
    /// None for a dry run.
    pub(super) output: Option<String>,
    /// The other files that it writes: a picture, a proof.
    pub(super) others: Vec<String>,
    /// Files that options name and that decide on the result.
    pub(super) option_files: Vec<String>,
    /// Its options, sorted by their names.
    pub(super) options: Vec<String>,
}

impl Job {
    /// The arguments of `limitmesh refine`.
    pub(super) fn words(&self) -> Vec<OsString> {
        let mut words: Vec<OsString> = self.options.iter().map(Into::into).collect();
        words.extend(
            self.output
                .as_ref()
                .map(|path| format!("--output={path}").into()),
        );
        words.extend(["--report=-", "--"].map(Into::into));
        words.push(self.input.clone().into());
        words
    }

    /// The files that it writes.
    pub(super) fn written(&self) -> impl Iterator<Item = &str> {
        let written = self.output.iter().chain(&self.others);
        written.map(String::as_str)
    }

    /// The files that it reads or writes.
    pub(super) fn files(&self) -> impl Iterator<Item = &str> {
        let read = std::iter::once(&self.input).chain(&self.option_files);
        read.map(String::as_str).chain(self.written())
    }

    /// Gives another file that it writes another name.
    pub(super) fn rename(&mut self, old: &str, new: &str) {
        let others = self.others.iter_mut().filter(|name| *name == old);
        others.for_each(|name| *name = new.to_owned());
        for option in &mut self.options {
            if let Some((key, value)) = option.split_once('=')
                && WRITING
                    .iter()
                    .any(|name| key.strip_prefix("--") == Some(name))
                && value == old
            {
                *option = format!("{key}={new}");
            }
        }
    }
}

/// Understands lines.
pub(super) struct Reader {
    /// Names of `refine`'s options.
    known: BTreeSet<String>,
    /// Whether files may be at addresses.
    takes_addresses: bool,
}

impl Reader {
    pub(super) fn new(takes_addresses: bool) -> Self {
        let mut whole = Arguments::command();
        whole.build();
        let refine = whole
            .find_subcommand("refine")
            .into_iter()
            .flat_map(|own| own.get_arguments());
        let names = refine.filter_map(|own| own.get_long()).map(str::to_owned);
        Self {
            known: names
                .filter(|name| !NOT_OF_JOBS.contains(&name.as_str()))
                .collect(),
            takes_addresses,
        }
    }

    /// The job of a line.
    ///
    /// # Errors
    /// It is none, in words.
    pub(super) fn job(&self, line: &[u8]) -> Result<Job, String> {
        let line = std::str::from_utf8(line).map_err(|why| format!("it is no UTF-8: {why}"))?;
        let fields: BTreeMap<String, Box<RawValue>> = serde_json::from_str(line)
            .map_err(|why| format!("it is no JSON object of a job: {}", without_line(&why)))?;
        let mut job = Job {
            input: String::new(),
            output: None,
            others: vec![],
            option_files: vec![],
            options: vec![],
        };
        let (mut is_dry, mut has_input) = (false, false);
        for (name, value) in &fields {
            let name = name.replace('_', "-");
            let value = Value::of(value).map_err(|what| format!("'{name}' is {what}"))?;
            match name.as_str() {
                "input" => (job.input, has_input) = (value.into_text(&name)?, true),
                "output" => job.output = Some(value.into_text(&name)?),
                known if self.known.contains(known) => {
                    is_dry |= known == "dry-run" && value == Value::Yes;
                    if known == "view" {
                        job.option_files.extend(
                            value
                                .texts()
                                .iter()
                                .filter_map(|text| file_of_cameras(text)),
                        );
                    }
                    if WRITING.contains(&known) {
                        job.others.extend(value.texts());
                    }
                    job.options.extend(value.words(known));
                }
                _ => return Err(format!("'{name}' is no option of a job")),
            }
        }
        if !has_input {
            return Err("it has no 'input'".to_owned());
        }
        if job.input == "-" || job.written().any(|name| name == "-") {
            return Err("standard input and output are not for jobs".to_owned());
        }
        if is_dry {
            // Nothing is written.
            job.output = None;
        } else if job.output.is_none() {
            return Err("it has no 'output'".to_owned());
        }
        if let Some(folder) = job.written().find(|name| is_folder(Path::new(name))) {
            return Err(format!("{folder} is a folder; give a file"));
        }
        self.check_addresses(&job)?;
        Ok(job)
    }
}

impl Reader {
    /// Whether files are where they can be reached.
    fn check_addresses(&self, job: &Job) -> Result<(), String> {
        if let Some(name) = job.option_files.iter().find(|name| is_address(name)) {
            return Err(format!("{name} is an address; give a file of this machine"));
        }
        match job.files().find(|name| is_address(name)) {
            Some(name) if !self.takes_addresses => Err(format!(
                "{name} is an address; limitmesh.batch of the Python package copies such files"
            )),
            _ => Ok(()),
        }
    }
}

/// The file that an option names in which cameras are.
fn file_of_cameras(text: &str) -> Option<String> {
    matches!(text.parse(), Ok(Viewer::File(_))).then(|| text.to_owned())
}

/// The message of serde_json on a text of one line.
fn without_line(why: &serde_json::Error) -> String {
    why.to_string().replace(" at line 1 column ", " at column ")
}

/// The value of a field.
#[derive(PartialEq)]
enum Value {
    /// Text, or a number as it was written.
    One(String),
    Many(Vec<String>),
    Yes,
    No,
}

impl Value {
    fn of(value: &RawValue) -> Result<Self, &'static str> {
        let text = value.get();
        let wrong = "an object; give text, a number, true, false, null or a list";
        match text.as_bytes().first() {
            Some(b'"') => Ok(Self::One(
                serde_json::from_str(text).map_err(|_| "no text")?,
            )),
            Some(b'{') | None => Err(wrong),
            Some(b'[') => {
                let items: Vec<&RawValue> = serde_json::from_str(text).map_err(|_| "no list")?;
                let are_numbers = items.iter().all(|item| !item.get().starts_with('"'));
                let items = items.into_iter().map(|item| match Self::of(item)? {
                    Self::One(text) if !item.get().starts_with('[') => Ok(text),
                    _ => Err("a list of something other than texts or numbers"),
                });
                let items = items.collect::<Result<Vec<_>, _>>()?;
                // A point.
                if are_numbers && !items.is_empty() {
                    Ok(Self::One(items.join(",")))
                } else {
                    Ok(Self::Many(items))
                }
            }
            Some(b't') => Ok(Self::Yes),
            Some(b'f' | b'n') => Ok(Self::No),
            Some(_) => Ok(Self::One(text.to_owned())),
        }
    }

    fn into_text(self, name: &str) -> Result<String, String> {
        match self {
            Self::One(text) if !text.is_empty() => Ok(text),
            _ => Err(format!("'{name}' is no name of a file")),
        }
    }

    fn texts(&self) -> Vec<String> {
        match self {
            Self::One(text) => vec![text.clone()],
            Self::Many(texts) => texts.clone(),
            Self::Yes | Self::No => Vec::new(),
        }
    }

    /// As the command line has it.
    fn words(&self, name: &str) -> Vec<String> {
        match self {
            Self::Yes => vec![format!("--{name}")],
            _ => self
                .texts()
                .into_iter()
                .map(|text| format!("--{name}={text}"))
                .collect(),
        }
    }
}

/// Which files belong to whom: none is written twice, and none that is read.
#[derive(Default)]
pub(super) struct Claims {
    /// By line; none for the batch's own.
    written: BTreeMap<FileIdentity, Option<usize>>,
    read: BTreeSet<FileIdentity>,
}

impl Claims {
    /// The batch itself has this file.
    pub(super) fn take(&mut self, path: &Path) {
        self.written.insert(FileIdentity::of(path), None);
    }

    /// A job reads this file.
    pub(super) fn read(&mut self, path: &Path) {
        self.read.insert(FileIdentity::of(path));
    }

    /// The job on that line writes its files, when all jobs have said what they read.
    ///
    /// # Errors
    /// One of them is another's, in words.
    pub(super) fn write(&mut self, job: &Job, line: usize) -> Result<(), String> {
        let files: Vec<(FileIdentity, &Path)> = job
            .written()
            .map(Path::new)
            .map(|path| (FileIdentity::of(path), path))
            .collect();
        for (i, (file, path)) in files.iter().enumerate() {
            let name = path.display();
            if files[..i].iter().any(|(earlier, _)| earlier == file) {
                return Err(format!("{name} would be written twice"));
            }
            match self.written.get(file) {
                Some(Some(other)) => return Err(format!("{name} is what line {other} writes")),
                Some(None) => return Err(format!("{name} holds the jobs or the results")),
                None if self.read.contains(file) => {
                    return Err(format!(
                        "{name} is the input of a job; a batch that is resumed needs inputs as they were"
                    ));
                }
                None => {}
            }
        }
        self.written
            .extend(files.into_iter().map(|(file, _)| (file, Some(line))));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_have_schemes() {
        for name in ["s3://b/a.stl", "memory://a.ply", "simplecache::s3://b/a"] {
            assert!(is_address(name), "{name}");
        }
        for name in [
            "a.stl",
            "/a//b.stl",
            "C://a.stl",
            "://a",
            "a b://c",
            "builtin:cup",
        ] {
            assert!(!is_address(name), "{name}");
        }
    }

    fn job(line: &str) -> Result<Job, String> {
        Reader::new(false).job(line.as_bytes())
    }

    #[test]
    fn options_are_those_of_the_command_line() {
        let line = r#"{"output": "b.ply", "input": "-a.obj", "tolerance": 0.10, "optimize": true, "ascii": false,
            "view": [0, 0.5, -1e0], "channel": ["a=drop", "b=smooth"], "max_memory": "1G", "scheme": null}"#;
        let job = job(&line.replace('\n', "")).unwrap();
        let expected = [
            "--channel=a=drop",
            "--channel=b=smooth",
            "--max-memory=1G",
            "--optimize",
            "--tolerance=0.10",
            "--view=0,0.5,-1e0",
            "--output=b.ply",
            "--report=-",
            "--",
            "-a.obj",
        ];
        assert_eq!(job.words(), expected);
    }

    #[test]
    fn what_is_no_job_is_told() {
        for (line, words) in [
            ("{", "column 1"),
            ("[1]", "no JSON object"),
            (r#"{"output": "a.ply"}"#, "no 'input'"),
            (r#"{"input": "a.ply"}"#, "no 'output'"),
            (r#"{"input": 3, "output": true}"#, "'output' is no name"),
            (r#"{"input": "-", "output": "a.ply"}"#, "standard input"),
            (r#"{"input": "a.obj", "output": "b/"}"#, "a folder"),
            (
                r#"{"input": "a.obj", "output": "s3://bucket/b.ply"}"#,
                "limitmesh.batch of the Python package",
            ),
            (
                r#"{"input": "a.obj", "output": "b.ply", "optimise": false}"#,
                "'optimise' is no option",
            ),
            (
                r#"{"input": "a.obj", "output": "b.ply", "report": "r.json"}"#,
                "'report' is no option",
            ),
            (
                r#"{"input": "a.obj", "output": "b.ply", "tolerance": {"mm": 1}}"#,
                "'tolerance' is an object",
            ),
            (
                r#"{"input": "a.obj", "output": "b.ply", "view": [[1]]}"#,
                "'view' is a list of something",
            ),
        ] {
            let what = job(line).unwrap_err();
            assert!(what.contains(words), "{line}: {what}");
        }
        assert!(
            Reader::new(false)
                .job(b"{\"input\": \"\xff\"}")
                .unwrap_err()
                .contains("UTF-8")
        );
        assert!(job(r#"{"input": "a.obj", "dry-run": true}"#).is_ok());
    }

    #[test]
    fn addresses_are_for_who_takes_them() {
        let of = |line: &str| Reader::new(true).job(line.as_bytes());
        let mut job =
            of(r#"{"input": "s3://b/a.obj", "output": "s3://b/a.ply", "picture": "s3://b/a.png"}"#)
                .unwrap();
        job.rename("s3://b/a.png", "here.png");
        assert_eq!(
            (&job.others, &job.options),
            (
                &vec!["here.png".to_owned()],
                &vec!["--picture=here.png".to_owned()]
            )
        );
        let what = of(r#"{"input": "a.obj", "output": "a.ply", "view": "s3://b/views.json"}"#)
            .unwrap_err();
        assert!(what.contains("give a file of this machine"), "{what}");
    }
}
