//! A front that follows a camera around a model, drawn: what the camera sees, and the same triangles from outside.
//!
//! `cargo run --release -p limitmesh-render --example moving_camera [PICTURE]`; without an argument the picture goes to the folder for
//! temporary files.

use std::error::Error;
use std::path::PathBuf;

use limitmesh::criterion;
use limitmesh::front::{Demand, Front};
use limitmesh::scheme::Loop;
use limitmesh::{Mesh, Triangles};
use limitmesh_render::{Camera, GridStyle, Panel, Style, grid, render};

/// Pixels that the triangles may be off, and the pictures' size.
const LIMIT: f64 = 0.25;
const SIZE: [u32; 2] = [400, 300];

/// Frames of the camera's way, of which every so-many-th is drawn.
const FRAMES: u32 = 40;
const DRAWN: u32 = 13;

fn main() -> Result<(), Box<dyn Error>> {
    let picture = std::env::args_os().nth(1).map(PathBuf::from);
    let picture =
        picture.unwrap_or_else(|| std::env::temp_dir().join("limitmesh-moving-camera.png"));
    let soup = limitmesh_models::find("bunny")
        .ok_or("no such built-in model")?
        .soup();
    let (control, _) = Mesh::from_soup(&soup, &Default::default())?;
    let size = control.diagonal();
    let [low, high] = control.as_triangles().bounding_box().unwrap_or_default();
    let middle = [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis]));
    let [width, height] = SIZE;
    let up = [0.0, 1.0, 0.0];
    let outside = [middle[0] + 1.1 * size, middle[1] + 0.3 * size, middle[2]];
    let outside = Camera::perspective(outside, middle, up, 40.0)?;
    let style = Style::default().wireframe(true);

    let mut front = Front::new(&control, &Loop)?;
    let mut panels = Vec::new();
    for frame in 0..FRAMES {
        // A quarter of a turn, and nearer.
        let part = f64::from(frame) / f64::from(FRAMES - 1);
        let (sine, cosine) = (core::f64::consts::FRAC_PI_2 * part).sin_cos();
        let away = (0.9 - 0.55 * part) * size;
        let eye = [
            middle[0] + away * sine,
            middle[1] + 0.1 * size,
            middle[2] + away * cosine,
        ];
        let camera = criterion::Camera {
            eye,
            target: middle,
            up,
            fov_degrees: 30.0,
            width,
            height,
        };
        let changes = front.update(&Demand::pixels(LIMIT, &[camera]))?;
        let (new, all) = (changes.triangles.len(), front.triangles().len());
        println!(
            "frame {frame}: {all} triangles, {new} of them new, off by {:.2} pixels at most",
            front.pixels().unwrap_or(0.0)
        );
        if frame % DRAWN == 0 {
            let surface = Triangles {
                positions: front.positions(),
                triangles: front.triangles(),
            };
            let seen = Camera::perspective(eye, middle, up, 30.0)?;
            for (camera, what) in [(&seen, "from the camera"), (&outside, "from outside")] {
                let image = render(surface, None, None, camera, &style, width, height)?;
                panels.push(Panel::new(
                    image,
                    format!("frame {frame}, {what}: {all} triangles"),
                ));
            }
        }
    }
    std::fs::write(
        &picture,
        grid(&panels, &GridStyle::default().columns(2))?.encode_png()?,
    )?;
    println!("drawn: {}", picture.display());
    Ok(())
}
