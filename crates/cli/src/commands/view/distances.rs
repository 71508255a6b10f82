//! How far the triangles of a refined mesh are from the limit surface, by closest points of samples inside them.

use limitmesh::{LimitSurface, PolygonSoup, Proximity};

use crate::progress::Progress;

/// Points that are looked for at most: some hundredths of a second each ten thousand.
const MOST_SAMPLES: usize = 200_000;

/// Distances are known to this share of the diagonal.
const PRECISION: f64 = 1e-7;

/// The samples of a triangle by the weights of its corners: its middle, and the middles of its edges.
const SAMPLES: [[f64; 3]; 4] = [
    [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
];

/// A limit surface whose closest points are known.
pub(super) struct Distances<'a> {
    proximity: Proximity<'a>,
    precision: f64,
}

impl<'a> Distances<'a> {
    /// `None` where the surface's closest points are not known.
    pub(super) fn to(surface: &'a LimitSurface<'a>, diagonal: f64) -> Option<Self> {
        let proximity = Proximity::new(surface).ok()?;
        Some(Self {
            proximity,
            precision: PRECISION * diagonal,
        })
    }

    /// The greatest distance of the samples of each triangle; `None` for other polygons, for too many, and where that is cancelled.
    pub(super) fn of(&self, mesh: &PolygonSoup, progress: &Progress) -> Option<Vec<f32>> {
        let count = match mesh.faces.len() {
            few if few * SAMPLES.len() <= MOST_SAMPLES => SAMPLES.len(),
            some if some <= MOST_SAMPLES => 1,
            _ => return None,
        };
        let mut points = Vec::with_capacity(count * mesh.faces.len());
        for face in mesh.faces.iter() {
            let corners: [u32; 3] = face.try_into().ok()?;
            let corners = corners.map(|v| mesh.positions.get(v as usize).copied());
            let [a, b, c] = [corners[0]?, corners[1]?, corners[2]?];
            points.extend(SAMPLES[..count].iter().map(|weights| {
                [0, 1, 2]
                    .map(|axis| weights[0] * a[axis] + weights[1] * b[axis] + weights[2] * c[axis])
            }));
        }
        let found = self
            .proximity
            .closest_observed(&points, self.precision, &mut progress.observer())
            .ok()?;
        let greatest = |own: &[limitmesh::Closest]| {
            own.iter().fold(0.0, |most: f64, at| most.max(at.distance))
        };
        Some(
            found
                .chunks(count)
                .map(|own| greatest(own) as f32)
                .collect(),
        )
    }
}
