//! Perspective cameras on the command line and in files: `EYE,TARGET,UP,FOV,WxH`.

use std::path::Path;

use anyhow::Context;
use limitmesh::criterion::Camera;

use super::values::{Size, finite};

/// How a camera is written.
const FORM: &str = "eye, target and up (three numbers each), the vertical angle of view in degrees and the size in \
                    pixels, all with commas between them, such as 0,0,5,0,0,0,0,1,0,45,1920x1080";

/// Sines of angles up to this are 0 but for rounding.
const PARALLEL: f64 = 1e-9;

/// A camera as an option has it.
pub(super) fn camera(text: &str) -> Result<Camera, String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let [numbers @ .., fov, size] = parts.as_slice() else { return Err(format!("expected {FORM}")) };
    let numbers = numbers.iter().map(|part| finite(part)).collect::<Result<Vec<f64>, String>>()?;
    let [a, b, c, d, e, f, g, h, i] = numbers[..] else {
        return Err(format!(
            "{} numbers before the angle of view and the size; expected {FORM}",
            numbers.len()
        ));
    };
    let Size { width, height } = size.parse()?;
    let fov_degrees = finite(fov)?;
    let camera = Camera { eye: [a, b, c], target: [d, e, f], up: [g, h, i], fov_degrees, width, height };
    check(&camera)?;
    Ok(camera)
}

/// Refuses a camera that looks nowhere.
fn check(camera: &Camera) -> Result<(), String> {
    if !(camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0) {
        return Err(format!(
            "{}° is out of range: an angle of view is above 0 and below 180 degrees",
            camera.fov_degrees
        ));
    }
    let length = |v: [f64; 3]| v.iter().fold(0.0f64, |length, x| length.hypot(*x));
    let sight = [0, 1, 2].map(|axis| camera.target[axis] - camera.eye[axis]);
    if length(sight) == 0.0 {
        return Err("the eye stands on the target: the camera has no direction of sight".to_owned());
    }
    if length(camera.up) == 0.0 {
        return Err("0,0,0 is no upward direction: at least one number must differ from 0".to_owned());
    }
    let [s, u] = [sight, camera.up].map(|v| v.map(|x| x / length(v)));
    let cross = [s[1] * u[2] - s[2] * u[1], s[2] * u[0] - s[0] * u[2], s[0] * u[1] - s[1] * u[0]];
    // Also catches what is not a number after an overflow.
    if length(cross) > PARALLEL { Ok(()) } else { Err("the upward direction is that of sight".to_owned()) }
}

/// The cameras of a file: one a line, with nothing after a `#`.
///
/// # Errors
/// The file cannot be read, a line is no camera, or there is none.
pub(crate) fn cameras_in(path: &Path) -> anyhow::Result<Vec<Camera>> {
    let text = std::fs::read_to_string(path).with_context(|| format!("{} cannot be read", path.display()))?;
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
    anyhow::ensure!(!cameras.is_empty(), "{}: no camera in it; expected {FORM}", path.display());
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
        assert_eq!(camera("0,-1.5,5, 0,0,0, 0,1,0, 45, 1920x1080"), Ok(expected));
    }

    #[test]
    fn cameras_that_look_nowhere_are_refused() {
        let bad = [
            ("", "expected eye"),
            ("1,2", "0 numbers"),
            ("0,0,5,0,0,0,0,1,0,1920x1080", "8 numbers"),
            ("0,0,5,0,0,0,0,1,0,1,45,1920x1080", "10 numbers"),
            ("0,0,5,0,0,0,0,1,x,45,1920x1080", "not a number"),
            ("0,0,5,0,0,0,0,1,NaN,45,1920x1080", "not a finite number"),
            ("0,0,5,0,0,0,0,1,0,45,1920", "WxH"),
            ("0,0,5,0,0,0,0,1,0,45,0x1080", "1 to"),
            ("0,0,5,0,0,0,0,1,0,0,1920x1080", "above 0 and below 180"),
            ("0,0,5,0,0,0,0,1,0,180,1920x1080", "above 0 and below 180"),
            ("0,0,5,0,0,5,0,1,0,45,1920x1080", "no direction of sight"),
            ("0,0,5,0,0,0,0,0,0,45,1920x1080", "no upward direction"),
            ("0,0,5,0,0,0,0,0,-2,45,1920x1080", "that of sight"),
        ];
        for (text, words) in bad {
            let told = camera(text).unwrap_err();
            assert!(told.contains(words), "{text}: {told}");
        }
    }
}
