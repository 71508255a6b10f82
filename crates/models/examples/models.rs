//! Prints the built-in models; with the name of a folder, writes each into it as numbers that any language reads: `NAME.positions`, 64-bit
//! floating-point numbers, three a vertex, and `NAME.index3` or `NAME.index4`, 32-bit whole numbers, so many a face, all little-endian.

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1);
    for model in limitmesh_models::all() {
        let soup = model.soup();
        let Some(folder) = &folder else {
            println!("{}: {} faces", model.name, soup.faces.len());
            continue;
        };
        let size = soup.faces.get(0).len();
        if soup.faces.iter().any(|face| face.len() != size) {
            return Err(format!("{} has faces of different sizes", model.name).into());
        }
        let positions = soup.positions.as_flattened().iter();
        let positions: Vec<u8> = positions.flat_map(|x| x.to_le_bytes()).collect();
        let corners = soup.faces.iter().flatten();
        let index: Vec<u8> = corners.flat_map(|v| v.to_le_bytes()).collect();
        let file = |extension: &str| Path::new(folder).join(model.name).with_extension(extension);
        std::fs::create_dir_all(folder)?;
        std::fs::write(file("positions"), positions)?;
        std::fs::write(file(&format!("index{size}")), index)?;
    }
    Ok(())
}
