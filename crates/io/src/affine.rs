//! Affine maps of space, and how much they stretch.

use limitmesh::math;

/// Three rows: x' = row · (x, y, z, 1).
pub(crate) type Affine = [[f64; 4]; 3];

pub(crate) const IDENTITY: Affine = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
];

/// `a` after `b`.
pub(crate) fn product(a: &Affine, b: &Affine) -> Affine {
    a.map(|row| {
        std::array::from_fn(|column| {
            let own = if column == 3 { row[3] } else { 0.0 };
            row[0] * b[0][column] + row[1] * b[1][column] + row[2] * b[2][column] + own
        })
    })
}

/// From 16 numbers by column; the last row counts as 0, 0, 0, 1.
pub(crate) fn of_columns(m: &[f64; 16]) -> Affine {
    std::array::from_fn(|row| std::array::from_fn(|column| m[4 * column + row]))
}

/// Scaling, then rotating by a quaternion x, y, z, w of any length, then moving.
pub(crate) fn of_parts(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> Affine {
    let length = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z, w] = if length > 0.0 {
        rotation.map(|c| c / length)
    } else {
        [0.0, 0.0, 0.0, 1.0]
    };
    let rows = [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - z * w),
            2.0 * (x * z + y * w),
        ],
        [
            2.0 * (x * y + z * w),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - x * w),
        ],
        [
            2.0 * (x * z - y * w),
            2.0 * (y * z + x * w),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ];
    std::array::from_fn(|i| {
        let [a, b, c] = rows[i];
        [a * scale[0], b * scale[1], c * scale[2], translation[i]]
    })
}

/// Where a point goes.
pub(crate) fn apply(m: &Affine, [x, y, z]: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
}

/// Which way a normal looks after it, of any length: outwards still where it turns surfaces inside out.
pub(crate) fn apply_to_normal(m: &Affine, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let rows = linear(m);
    let sign = if determinant(&rows) < 0.0 { -1.0 } else { 1.0 };
    // Cofactors are the inverse's transpose times the determinant, and there where it is 0.
    std::array::from_fn(|i| {
        let [b, c] = [rows[(i + 1) % 3], rows[(i + 2) % 3]];
        let cofactors = [
            b[1] * c[2] - b[2] * c[1],
            b[2] * c[0] - b[0] * c[2],
            b[0] * c[1] - b[1] * c[0],
        ];
        sign * (cofactors[0] * x + cofactors[1] * y + cofactors[2] * z)
    })
}

/// Whether it turns surfaces inside out.
pub(crate) fn mirrors(m: &Affine) -> bool {
    determinant(&linear(m)) < 0.0
}

/// Of several the one that makes vectors longest, and the first of equals; without any, the map that does nothing.
pub(crate) fn largest<'a>(all: impl Iterator<Item = &'a Affine>) -> &'a Affine {
    let stretched = all.map(|m| (m, greatest_stretch(m)));
    stretched
        .reduce(|most, own| if own.1 > most.1 { own } else { most })
        .map_or(&IDENTITY, |(m, _)| m)
}

/// A stretch by which lengths can be divided: 1 in the place of what nothing shows, or not as anything that is finite.
pub(crate) fn usable(stretch: f64) -> f64 {
    if stretch > 0.0 && stretch.is_finite() {
        stretch
    } else {
        1.0
    }
}

/// The corners of the box around points; `None` if there are none.
pub(crate) fn bounding_box(points: impl IntoIterator<Item = [f64; 3]>) -> Option<[[f64; 3]; 2]> {
    let boxes = points.into_iter().map(|point| [point; 2]);
    boxes.reduce(|[low, high], [p, _]| {
        let ends = |i: usize| [low[i].min(p[i]), high[i].max(p[i])];
        let [x, y, z] = [0, 1, 2].map(ends);
        [[x[0], y[0], z[0]], [x[1], y[1], z[1]]]
    })
}

/// How many times longer it makes vectors at most: the greatest singular value M, √λ of the greatest eigenvalue of MᵀM,
/// by the closed form for symmetric matrices of three rows (Smith 1961).
pub(crate) fn greatest_stretch(m: &Affine) -> f64 {
    let m = linear(m);
    let size = m.as_flattened().iter();
    let size = size.fold(0.0f64, |most, x| most.max(x.abs()));
    if size == 0.0 || !size.is_finite() {
        return size;
    }
    let m = m.map(|row| row.map(|x| x / size));
    let a: [[f64; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..3).map(|k| m[k][i] * m[k][j]).sum::<f64>())
    });
    let mean = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
    let off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    let spread = (0..3)
        .map(|i| (a[i][i] - mean) * (a[i][i] - mean))
        .sum::<f64>()
        + 2.0 * off;
    let p = (spread / 6.0).sqrt();
    let greatest = if p == 0.0 {
        mean
    } else {
        let b: [[f64; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| (a[i][j] - if i == j { mean } else { 0.0 }) / p)
        });
        mean + 2.0 * p * math::cos(math::acos((0.5 * determinant(&b)).clamp(-1.0, 1.0)) / 3.0)
    };
    size * greatest.max(0.0).sqrt()
}

/// The linear part, by rows.
pub(crate) fn linear(m: &Affine) -> [[f64; 3]; 3] {
    m.map(|[a, b, c, _]| [a, b, c])
}

fn determinant([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_of_known_matrices() {
        assert_eq!(greatest_stretch(&IDENTITY), 1.0);
        let turned = of_parts([5.0; 3], [0.3, -0.2, 0.5, 0.7], [0.5, -3.0, 2.0]);
        assert!((greatest_stretch(&turned) - 3.0).abs() < 1e-14);
        assert!(mirrors(&turned));
        // A shear by 1 stretches by the golden ratio.
        let shear = [
            [1.0, 1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ];
        assert!((greatest_stretch(&shear) - (1.0 + 5f64.sqrt()) / 2.0).abs() < 1e-14);
        let tiny = of_parts([0.0; 3], [0.0, 0.6, 0.0, 0.8], [1.16e-4; 3]);
        assert!((greatest_stretch(&tiny) / 1.16e-4 - 1.0).abs() < 1e-14);
    }

    /// Normals stay at right angles to what they were at right angles to, and look away from what they looked away from.
    #[test]
    fn normals_stay_normals() {
        for scale in [[1.0, 2.0, 0.1], [-3.0, 1.0, 0.5], [-1.0, -1.0, -2.0]] {
            let m = of_parts([7.0, 8.0, 9.0], [0.1, 0.9, -0.4, 0.2], scale);
            let [u, v, n] = [[1.0, 2.0, 0.0], [0.0, 1.0, 3.0], [6.0, -3.0, 1.0]];
            let moved =
                |d: [f64; 3]| linear(&m).map(|row| row[0] * d[0] + row[1] * d[1] + row[2] * d[2]);
            let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
            let normal = apply_to_normal(&m, n);
            assert!(dot(normal, moved(u)).abs() < 1e-12 && dot(normal, moved(v)).abs() < 1e-12);
            assert!(dot(normal, moved(n)) > 1e-3);
        }
    }

    #[test]
    fn the_stretch_is_that_of_the_worst_direction() {
        // Against directions all around.
        let m = product(
            &of_parts([0.0; 3], [0.1, 0.9, -0.4, 0.2], [1.0, 2.0, 0.1]),
            &of_parts([1.0; 3], [-0.5, 0.2, 0.3, 0.4], [0.7, 0.2, 3.0]),
        );
        let mut most = 0.0f64;
        for i in 0..400 {
            for j in 0..800 {
                let (u, v) = (
                    f64::from(i) / 400.0 * std::f64::consts::PI,
                    f64::from(j) / 400.0 * std::f64::consts::PI,
                );
                let d = [u.sin() * v.cos(), u.sin() * v.sin(), u.cos()];
                let moved = linear(&m).map(|row| row[0] * d[0] + row[1] * d[1] + row[2] * d[2]);
                most = most.max(moved.iter().map(|x| x * x).sum::<f64>().sqrt());
            }
        }
        let stretch = greatest_stretch(&m);
        assert!(
            most <= stretch * (1.0 + 1e-12) && most > 0.9999 * stretch,
            "{most} {stretch}"
        );
    }
}
