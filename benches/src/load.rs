//! Reading, repairing and connecting a large file: seconds and peak memory.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use anyhow::{Result, ensure};

use crate::clock::peak_bytes;
use crate::mesh;

/// Runs [`child`] in a process of its own, three times.
pub(crate) fn load(file: &Path) -> Result<()> {
    println!(
        "\n{} read, repaired, topology built",
        file.file_name().unwrap_or_default().to_string_lossy()
    );
    for _ in 0..3 {
        let output = Command::new(std::env::current_exe()?)
            .arg("load-child")
            .arg(file)
            .output()?;
        ensure!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        print!("{}", String::from_utf8_lossy(&output.stdout));
    }
    Ok(())
}

/// Loads one file and tells how long it took and how much memory the process had at its peak.
pub(crate) fn child(file: &Path) -> Result<()> {
    let before = peak_bytes()?;
    let start = Instant::now();
    let loaded = mesh(file)?;
    let seconds = start.elapsed().as_secs_f64();
    let peak = peak_bytes()?;
    println!(
        "{} triangles in {seconds:.3} s, peak {:.1} MB above the empty process: {:.0} bytes a triangle",
        loaded.face_count(),
        (peak - before) as f64 / 1e6,
        (peak - before) as f64 / loaded.face_count() as f64
    );
    Ok(())
}
