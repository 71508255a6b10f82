//! The little vector algebra that the drawn figures need.

pub(super) type Vector = [f64; 3];

pub(super) fn sub(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// `a + s·b`.
pub(super) fn add_scaled(a: Vector, s: f64, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + s * b[i])
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The direction of `a`; zero where it has none.
pub(super) fn unit(a: Vector) -> Vector {
    let length = dot(a, a).sqrt();
    if length > 0.0 {
        a.map(|x| x / length)
    } else {
        [0.0; 3]
    }
}

/// The angle between two unit vectors, in degrees; accurate for small ones too.
pub(super) fn angle_degrees(a: Vector, b: Vector) -> f64 {
    let sine = cross(a, b);
    dot(sine, sine).sqrt().atan2(dot(a, b)).to_degrees()
}

/// Two unit vectors perpendicular to the unit vector `n` and to each other; with it they are right-handed.
pub(super) fn tangents(n: Vector) -> [Vector; 2] {
    let axis = if n[0].abs() < 0.6 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let u = unit(cross(axis, n));
    [u, cross(n, u)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_are_a_right_handed_frame() {
        for n in [[1.0, 2.0, 3.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]].map(unit) {
            let [u, v] = tangents(n);
            let off = sub(cross(u, v), n);
            assert!(dot(off, off) < 1e-24);
            assert!((dot(u, u) - 1.0).abs() < 1e-12);
            assert!((angle_degrees(u, n) - 90.0).abs() < 1e-9);
        }
    }
}
