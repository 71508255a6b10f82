//! Perspective cameras on the command line and in files: `EYE,TARGET,UP,FOV,WxH`.

use std::path::Path;

use anyhow::Context;
use limitmesh::criterion::Camera;

use super::quantity::finite;
use super::values::Size;

/// How a camera is written.
const FORM: &str = "eye, target and up (three numbers each), the vertical angle of view in degrees and the size in \
                    pixels, all with commas between them, such as 0,0,5,0,0,0,0,1,0,45,1920x1080";

/// A camera as an option has it.
pub(super) fn camera(text: &str) -> Result<Camera, String> {
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
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        match camera(line) {
            Ok(camera) => cameras.push(camera),
            Err(what) => anyhow::bail!("{}, line {}: {what}", path.display(), i + 1),
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
    fn cameras_are_read() {
        let expected = Camera {
            eye: [0.0, -1.5, 5.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_degrees: 45.0,
            width: 1920,
            height: 1080,
        };
        assert_eq!(
            camera("0,-1.5,5, 0,0,0, 0,1,0, 45, 1920x1080"),
            Ok(expected)
        );
    }

    #[test]
    fn cameras_that_look_nowhere_are_refused() {
        let bad = [
            ("", "give eye"),
            ("1,2", "0 numbers"),
            ("0,0,5,0,0,0,0,1,0,1920x1080", "8 numbers"),
            ("0,0,5,0,0,0,0,1,0,1,45,1920x1080", "10 numbers"),
            ("0,0,5,0,0,0,0,1,x,45,1920x1080", "not a number"),
            ("0,0,5,0,0,0,0,1,NaN,45,1920x1080", "not a finite number"),
            ("0,0,5,0,0,0,0,1,0,45,1920", "WxH"),
            ("0,0,5,0,0,0,0,1,0,45,0x1080", "1 to"),
            ("0,0,5,0,0,0,0,1,0,0,1920x1080", "above 0 and below 180"),
            ("0,0,5,0,0,0,0,1,0,180,1920x1080", "above 0 and below 180"),
            ("0,0,5,0,0,5,0,1,0,45,1920x1080", "eye to its target"),
            ("0,0,5,0,0,0,0,0,0,45,1920x1080", "upward direction"),
            ("0,0,5,0,0,0,0,0,-2,45,1920x1080", "that of sight"),
        ];
        for (text, words) in bad {
            let told = camera(text).unwrap_err();
            assert!(told.contains(words), "{text}: {told}");
        }
    }
}
