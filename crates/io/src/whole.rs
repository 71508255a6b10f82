//! Files that are written whole or not at all.
//!
//! The bytes go to a temporary file in the same folder, which takes the name at the end. An error, or the end
//! of the program on the way, leaves an earlier file of that name as it was. A program that ends by itself on the way, because of
//! a signal, removes the temporary files first: [`abandon_unfinished`].

use crate::error::WriteError;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Finds out, without writing anything, whether [`write_whole`] could write a file: to be asked before long work.
///
/// # Errors
/// The folder does not exist or may not be written to, or the earlier file of that name is a folder or read-only.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    let failed = WriteError::of(path);
    match earlier(path).map_err(&failed)? {
        Some(device) if !device.is_file() => Ok(()),
        earlier => Unfinished::new(path, earlier.as_ref())
            .map(drop)
            .map_err(&failed),
    }
}

/// The metadata of the earlier file of that name, if there is one; an error if it may not be replaced.
fn earlier(path: &Path) -> io::Result<Option<fs::Metadata>> {
    let Ok(earlier) = fs::metadata(path) else {
        return Ok(None);
    };
    if earlier.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory));
    }
    if earlier.is_file() {
        // A new name over a file asks only the folder for permission, and the superuser may write to what is read-only: ask
        // the file as well.
        if earlier.permissions().readonly() {
            let why = "the file is read-only";
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, why));
        }
        fs::OpenOptions::new().write(true).open(path)?;
    }
    Ok(Some(earlier))
}

/// Writes `bytes` to a file, whole or not at all.
///
/// A new file gets the permissions of any other new file; an earlier one keeps its own. A symbolic link stays
/// one, and the file it points to is replaced. What is not a regular file (a device, a pipe) is written to
/// directly.
///
/// # Errors
/// The folder does not exist, it or the earlier file may not be written to, or there is no space.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    write_whole_with(path, |writer| Ok(write_in_pieces(writer, bytes)?))
}

/// How many bytes the system is given at once: some milliseconds of writing, which a program that is about to end has to wait for.
const PIECE: usize = 1 << 22;

/// Writes bytes so that a program may end on the way.
pub(crate) fn write_in_pieces(writer: &mut dyn Write, bytes: &[u8]) -> io::Result<()> {
    let mut found = bytes.chunks(PIECE);
    found.try_for_each(|piece| writer.write_all(piece))
}

/// Writes what `fill` gives to a file, whole or not at all, as [`write_whole`] does.
///
/// # Errors
/// As for [`write_whole`]; what `fill` returns.
pub fn write_whole_with(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Result<(), WriteError> {
    let failed = WriteError::of(path);
    let earlier = earlier(path).map_err(&failed)?;
    if earlier.as_ref().is_some_and(|e| !e.is_file()) {
        let device = fs::OpenOptions::new().write(true).open(path);
        let mut device = device.map_err(&failed)?;
        return fill(&mut device).map_err(|error| error.in_file(path));
    }
    let file = Unfinished::filled(path, earlier, fill)?;
    let mut register = register();
    file.finish(&mut register).map_err(&failed)?;
    register.finished += 1;
    Ok(())
}

/// A file with all its bytes.
pub(crate) struct WholeFile {
    pub(crate) path: PathBuf,
    pub(crate) bytes: Vec<u8>,
}

/// Writes several files that belong together: all under other names first, which are changed only when all are there.
pub(crate) fn write_together(files: &[WholeFile]) -> Result<(), WriteError> {
    let mut waiting = Vec::with_capacity(files.len());
    for WholeFile { path, bytes } in files {
        let failed = WriteError::of(path);
        let earlier = earlier(path).map_err(&failed)?;
        if earlier.as_ref().is_some_and(|e| !e.is_file()) {
            waiting.push(None);
            continue;
        }
        let fill = |writer: &mut dyn Write| Ok(write_in_pieces(writer, bytes)?);
        waiting.push(Some(Unfinished::filled(path, earlier, fill)?));
    }
    // Held as long as files take their names: a program that ends meanwhile leaves all or none. Nobody holds it while a device is
    // written to, which may last for ever.
    let mut held = None;
    for (file, WholeFile { path, bytes }) in waiting.iter().zip(files) {
        match file {
            Some(file) => {
                let finished = file.finish(held.get_or_insert_with(register));
                finished.map_err(WriteError::of(path))?;
            }
            None => {
                held = None;
                write_whole(path, bytes)?;
            }
        }
    }
    held.get_or_insert_with(register).finished += 1;
    Ok(())
}

/// The files that this process is writing and has written.
struct Register {
    /// The temporary files.
    unfinished: Vec<PathBuf>,
    /// How often writing ended; files that belong together count once.
    finished: usize,
}

static REGISTER: Mutex<Register> = Mutex::new(Register {
    unfinished: Vec::new(),
    finished: 0,
});

fn register() -> MutexGuard<'static, Register> {
    REGISTER.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How often this process has finished writing a file, or files that belong together; what is written to directly may not count.
pub fn finished_files() -> usize {
    register().finished
}

/// Keeps this process from beginning and from finishing files, since it is about to end: see [`abandon_unfinished`].
#[must_use = "files are begun and finished again once this is dropped"]
pub struct Abandoned(MutexGuard<'static, Register>);

impl Abandoned {
    /// [`finished_files`], which would wait for ever if it were called while this is held.
    pub fn finished_files(&self) -> usize {
        self.0.finished
    }
}

/// Removes the temporary files of all files that this process is writing, for a process that is about to end in the midst of it.
///
/// Nothing is begun or finished until what this gives is dropped; writing to a regular file that was under way fails afterwards. Folders
/// that were made for the files stay.
pub fn abandon_unfinished() -> Abandoned {
    let mut register = register();
    for path in register.unfinished.drain(..) {
        // Nobody is left to whom an error could be reported.
        let _ = fs::remove_file(path);
    }
    Abandoned(register)
}

/// A temporary file in the folder of the one that it will be, removed unless it is finished.
struct Unfinished {
    file: fs::File,
    path: PathBuf,
    /// The file that it will be.
    target: PathBuf,
}

impl Unfinished {
    /// A new file in the folder of `path`; of a link, in that of the `earlier` file that it names, which is replaced.
    ///
    /// It is opened here and written to as it is, since errors would name the temporary file otherwise, which nobody asked for.
    fn new(path: &Path, earlier: Option<&fs::Metadata>) -> io::Result<Self> {
        let target = match earlier {
            Some(_) => fs::canonicalize(path)?,
            None => path.to_owned(),
        };
        let folder = match target.parent() {
            Some(folder) if folder != Path::new("") => folder.to_owned(),
            _ => PathBuf::from("."),
        };
        // With the permissions of any new file.
        let mut options = fs::OpenOptions::new();
        options.read(true).write(true).create_new(true);
        let open = |path: &Path| options.open(path);
        let mut register = register();
        let mut name = tempfile::Builder::new();
        let file = name.prefix(".limitmesh-").suffix(".tmp");
        let file = file.make_in(folder, open)?;
        let (file, path) = file.keep().map_err(|error| error.error)?;
        register.unfinished.push(path.clone());
        Ok(Self { file, path, target })
    }

    /// With all that `fill` gives, for `path`, where `earlier` is what is known of an earlier file.
    fn filled(
        path: &Path,
        earlier: Option<fs::Metadata>,
        fill: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
    ) -> Result<Self, WriteError> {
        let failed = WriteError::of(path);
        let mut file = Self::new(path, earlier.as_ref()).map_err(&failed)?;
        fill(&mut file.file).map_err(|error| error.in_file(path))?;
        if let Some(earlier) = earlier {
            fs::set_permissions(&file.path, earlier.permissions()).map_err(&failed)?;
        }
        Ok(file)
    }

    /// Gives it its name.
    fn finish(&self, register: &mut Register) -> io::Result<()> {
        fs::rename(&self.path, &self.target)?;
        register.unfinished.retain(|path| *path != self.path);
        Ok(())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        let mut register = register();
        let unfinished = &mut register.unfinished;
        if let Some(at) = unfinished.iter().position(|path| *path == self.path) {
            unfinished.swap_remove(at);
            // What is to be reported is why it was not finished.
            let _ = fs::remove_file(&self.path);
        }
    }
}
