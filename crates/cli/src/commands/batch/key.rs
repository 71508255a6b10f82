//! The key of a result by all that it depends on: SHA-256 of the program's version, the options, the formats and the input's bytes.
//!
//! Each part is hashed after its length, so that no two lists of parts are one.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use limitmesh_io::Asset;
use sha2::{Digest, Sha256};

use super::job::Job;
use crate::input;
use crate::report::VERSION;

/// Read at once.
const BLOCK: usize = 1 << 16;

/// The key of a job, in hexadecimal digits; its input is read from this file.
///
/// # Errors
/// A file cannot be read.
pub(super) fn key(job: &Job, input: &str) -> io::Result<String> {
    let mut hash = Sha256::new();
    part(&mut hash, VERSION.as_bytes());
    let extension = |path: &str| {
        Path::new(path)
            .extension()
            .unwrap_or_default()
            .to_ascii_lowercase()
    };
    part(
        &mut hash,
        job.output
            .as_deref()
            .map(extension)
            .unwrap_or_default()
            .as_encoded_bytes(),
    );
    hash.update((job.options.len() as u64).to_le_bytes());
    job.options
        .iter()
        .for_each(|option| part(&mut hash, option.as_bytes()));
    for path in &job.option_files {
        file(&mut hash, Path::new(path))?;
    }
    let path = Path::new(input);
    if let Some(model) = input::builtin_name(path) {
        part(&mut hash, model.as_bytes());
    } else {
        let extension = extension(input);
        part(&mut hash, extension.as_encoded_bytes());
        file(&mut hash, path)?;
        if extension == "gltf" || extension == "glb" {
            // What is wrong with a document is found when it is refined.
            for (name, own) in Asset::open(path)
                .map(|asset| asset.files_beside())
                .unwrap_or_default()
            {
                part(&mut hash, name.as_os_str().as_encoded_bytes());
                file(&mut hash, &own)?;
            }
        }
    }
    Ok(hash
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect())
}

fn part(hash: &mut Sha256, bytes: &[u8]) {
    hash.update((bytes.len() as u64).to_le_bytes());
    hash.update(bytes);
}

/// The bytes of a file, with their number after them.
fn file(hash: &mut Sha256, path: &Path) -> io::Result<()> {
    let mut file = File::open(path)?;
    let (mut block, mut length) = (vec![0; BLOCK], 0u64);
    loop {
        match file.read(&mut block)? {
            0 => break,
            count => {
                hash.update(&block[..count]);
                length += count as u64;
            }
        }
    }
    hash.update(length.to_le_bytes());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_differ_with_what_results_depend_on_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str, bytes: &str| {
            std::fs::write(folder.path().join(name), bytes).unwrap();
            folder.path().join(name).display().to_string()
        };
        let job = |input: &str, output: &str, options: &[&str]| Job {
            input: input.to_owned(),
            output: Some(output.to_owned()),
            others: Vec::new(),
            option_files: Vec::new(),
            options: options.iter().map(|&own| own.to_owned()).collect(),
        };
        let (a, b, c) = (
            at("a.obj", "v 0 0 0"),
            at("b.obj", "v 0 0 0"),
            at("c.obj", "v 0 0 1"),
        );
        let of = |job: Job| key(&job, &job.input).unwrap();
        let first = of(job(&a, "x.ply", &["--tolerance=1"]));
        assert_eq!(first.len(), 64);
        assert_eq!(of(job(&b, "y.PLY", &["--tolerance=1"])), first);
        for other in [
            job(&c, "x.ply", &["--tolerance=1"]),
            job(&a, "x.obj", &["--tolerance=1"]),
            job(&a, "x.ply", &["--tolerance=2"]),
            job(&a, "x.ply", &["--tolerance=", "1"]),
            job("builtin:cup", "x.ply", &["--tolerance=1"]),
        ] {
            assert_ne!(of(other), first);
        }
        let elsewhere = job("s3://bucket/a.obj", "x.ply", &["--tolerance=1"]);
        assert_eq!(key(&elsewhere, &a).unwrap(), first);
        let none = job("none.obj", "x.ply", &[]);
        assert!(key(&none, &none.input).is_err());
    }

    #[test]
    fn files_beside_a_document_count() {
        let folder = tempfile::tempdir().unwrap();
        let text =
            r#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "a%20b.bin", "byteLength": 3}]}"#;
        std::fs::write(folder.path().join("a.gltf"), text).unwrap();
        let of = |bytes: &str| {
            std::fs::write(folder.path().join("a b.bin"), bytes).unwrap();
            let input = folder.path().join("a.gltf").display().to_string();
            let none = Vec::new;
            let job = Job {
                input,
                output: None,
                others: none(),
                option_files: none(),
                options: none(),
            };
            key(&job, &job.input).unwrap()
        };
        assert_ne!(of("abc"), of("abd"));
        assert_eq!(of("abc"), of("abc"));
    }
}
