//! Who looks at the surface, on the command line and in files.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::Context;
use limitmesh::criterion::Camera;

use super::quantity::finite;
use super::values::{self, Size};
use crate::rows::rows;

/// How a camera is written.
const FORM: &str = "eye, target and up (three numbers each), the vertical angle of view in degrees and the size in \
                    pixels, all with commas between them, such as 0,0,5,0,0,0,0,1,0,45,1920x1080";

/// Somebody who looks at the surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Viewer {
    /// From far away, in this direction.
    Direction([f64; 3]),
    /// From this point.
    Eye([f64; 3]),
    /// With a camera.
    Camera(Camera),
    /// With the cameras of a file.
    File(PathBuf),
}

impl FromStr for Viewer {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(eye) = text.strip_prefix('@') {
            return values::point(eye).map(Self::Eye);
        }
        // The name of a file may have commas, but hardly a number before the first.
        let parts: Vec<&str> = text.split(',').collect();
        match parts.len() {
            0 | 1 => Ok(Self::File(text.into())),
            _ if parts[0].trim().parse::<f64>().is_err() => Ok(Self::File(text.into())),
            3 => values::direction(text).map(Self::Direction),
            _ => camera(text).map(Self::Camera),
        }
    }
}

/// A camera as an option has it.
fn camera(text: &str) -> Result<Camera, String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let [numbers @ .., fov, size] = parts.as_slice() else {
        return Err(format!("give {FORM}"));
    };
    let numbers = numbers
        .iter()
        .map(|part| finite(part))
        .collect::<Result<Vec<f64>, String>>()?;
    let [a, b, c, d, e, f, g, h, i] = numbers[..] else {
        return Err(format!(
            "it has {} numbers before the angle of view and the size; give {FORM}",
            numbers.len()
        ));
    };
    let Size { width, height } = size.parse()?;
    let fov_degrees = finite(fov)?;
    let camera = Camera {
        eye: [a, b, c],
        target: [d, e, f],
        up: [g, h, i],
        fov_degrees,
        width,
        height,
    };
    camera.check().map_err(|why| why.to_string())?;
    Ok(camera)
}

/// The cameras of a file: one a line, with nothing after a `#`.
///
/// # Errors
/// The file cannot be read, a line is no camera, or there is none.
pub(super) fn cameras_in(path: &Path) -> anyhow::Result<Vec<Camera>> {
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("{} cannot be read", path.display()))?;
    let mut cameras = Vec::new();
    for (row, line) in rows(&text) {
        match camera(line) {
            Ok(camera) => cameras.push(camera),
            Err(what) => anyhow::bail!("{}, line {row}: {what}", path.display()),
        }
    }
    anyhow::ensure!(
        !cameras.is_empty(),
        "{} has no camera; give {FORM}",
        path.display()
    );
    Ok(cameras)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewers_are_read() {
        let camera = Camera {
            eye: [0.0, -1.5, 5.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_degrees: 45.0,
            width: 1920,
            height: 1080,
        };
        for (text, viewer) in [
            (
                "0,-1.5,5, 0,0,0, 0,1,0, 45, 1920x1080",
                Viewer::Camera(camera),
            ),
            ("-1,0,0.5", Viewer::Direction([-1.0, 0.0, 0.5])),
            ("@-1,0,0.5", Viewer::Eye([-1.0, 0.0, 0.5])),
            ("fly,by.txt", Viewer::File("fly,by.txt".into())),
        ] {
            assert_eq!(text.parse(), Ok(viewer), "{text}");
        }
    }

    #[test]
    fn viewers_that_look_nowhere_are_refused() {
        for (text, words) in [
            ("1,2", "0 numbers"),
            ("0,0,0", "no direction"),
            ("@1,2", "2 numbers"),
            ("0,0,5,0,0,0,0,1,0,1920x1080", "8 numbers"),
            ("0,0,5,0,0,0,0,1,0,1,45,1920x1080", "10 numbers"),
            ("0,0,5,0,0,0,0,1,x,45,1920x1080", "not a number"),
            ("0,0,5,0,0,0,0,1,NaN,45,1920x1080", "not a finite number"),
            ("0,0,5,0,0,0,0,1,0,45,1920", "WxH"),
            ("0,0,5,0,0,0,0,1,0,45,0x1080", "1 to"),
            ("0,0,5,0,0,0,0,1,0,180,1920x1080", "above 0 and below 180"),
            ("0,0,5,0,0,5,0,1,0,45,1920x1080", "eye to its target"),
            ("0,0,5,0,0,0,0,0,0,45,1920x1080", "upward direction"),
            ("0,0,5,0,0,0,0,0,-2,45,1920x1080", "that of sight"),
        ] {
            let why = text.parse::<Viewer>().unwrap_err();
            assert!(why.contains(words), "{text}: {why}");
        }
    }
}
