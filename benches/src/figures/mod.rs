//! The README's pictures: shapes before and after, the methods at equal triangle counts with their distances to the limit surface, and a plot of
//! error against triangles. From built-in models alone, so that anybody can draw them anew.

mod before_after;
mod comparison;
mod error;

use std::path::Path;

use anyhow::Result;

/// Writes `before_after.png`, `comparison.png` and `error.svg` into `folder`.
pub(crate) fn figures(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    let write = |name: &str, bytes: &[u8]| -> Result<()> {
        let path = folder.join(name);
        std::fs::write(&path, bytes)?;
        println!("{}: {} kB", path.display(), bytes.len().div_ceil(1000));
        Ok(())
    };
    write("before_after.png", &before_after::picture()?)?;
    write("comparison.png", &comparison::picture()?)?;
    write("error.svg", error::plot()?.as_bytes())
}
