//! Area and volume of a surface.
//!
//! The volume is the sum of those of the tetrahedra over the triangles, V = Σ a·(b × c)/6: above 0 where normals point
//! outwards. Open surfaces have none. Limit surfaces are integrated themselves.

use anyhow::bail;
use limitmesh::scheme::Scheme;
use limitmesh::{LimitSurface, Mesh};
use serde::Serialize;

use crate::pieces::pieces;
use crate::vector::{cross, dot, length, minus};

/// Area and volume, in squares and cubes of the mesh's unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct Bulk {
    pub(crate) area: f64,
    /// Null where the surface has a boundary.
    pub(crate) volume: Option<f64>,
}

/// How a mesh is shown: not as large along all directions, perhaps, nor at right angles.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown {
    /// By rows: x' = row · x.
    linear: [[f64; 3]; 3],
}

impl Default for Shown {
    fn default() -> Self {
        Self {
            linear: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        }
    }
}

impl Shown {
    /// By a map of vectors, where the mesh has been made `stretch` times as large already.
    pub(crate) fn of(linear: [[f64; 3]; 3], stretch: f64) -> Self {
        let linear = linear.map(|row| row.map(|x| x / stretch));
        if linear.iter().flatten().all(|x| x.is_finite()) {
            Self { linear }
        } else {
            Self::default()
        }
    }

    fn point(&self, at: [f64; 3]) -> [f64; 3] {
        self.linear.map(|row| dot(row, at))
    }

    /// How many times larger volumes are.
    fn volume(&self) -> f64 {
        let [a, b, c] = self.linear;
        dot(a, cross(b, c)).abs()
    }
}

impl Bulk {
    /// Of a mesh.
    pub(crate) fn of(mesh: &Mesh) -> Self {
        Self::as_shown(mesh, &Shown::default())
    }

    /// Of a mesh as it is shown.
    pub(crate) fn as_shown(mesh: &Mesh, shown: &Shown) -> Self {
        let surface = mesh.as_triangles();
        let corner = surface.bounding_box().unwrap_or_default()[0];
        let is_closed = mesh.open_edge_count() == 0;
        let sums = pieces(surface.triangles.len(), |faces| {
            faces.map(|face| surface.corners(face)).fold(
                [Sum::default(); 2],
                |[areas, volumes], corners| {
                    let volumes = if is_closed {
                        volumes.with(volume(corners, corner))
                    } else {
                        volumes
                    };
                    [
                        areas.with(area(corners.map(|corner| shown.point(corner)))),
                        volumes,
                    ]
                },
            )
        });
        let total = |which: usize| {
            sums.iter()
                .fold(Sum::default(), |all, sums| {
                    all.with(sums[which].sum).with(sums[which].lost)
                })
                .total()
        };
        Self {
            area: total(0),
            volume: is_closed.then(|| shown.volume() * total(1)),
        }
    }

    /// Of the limit surface of a control mesh; `None` for schemes but the Loop family and Catmull–Clark.
    ///
    /// # Errors
    /// The scheme has no limit at some ring, or area or volume is beyond what numbers hold.
    pub(crate) fn of_limit(control: &Mesh, scheme: &dyn Scheme) -> anyhow::Result<Option<Self>> {
        if scheme.family().is_none() {
            return Ok(None);
        }
        let surface = LimitSurface::without_normals(control, scheme)?;
        let is_closed = control.topology().boundary_edge_count() == 0;
        match (surface.area(), surface.volume()) {
            (Some(area), volume) if volume.is_some() || !is_closed => {
                Ok(Some(Self { area, volume }))
            }
            _ => bail!("area or volume of the limit surface is beyond what numbers hold"),
        }
    }
}

fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    0.5 * length(cross(minus(b, a), minus(c, a)))
}

/// Of the tetrahedron over a triangle with its tip at a point.
fn volume(corners: [[f64; 3]; 3], tip: [f64; 3]) -> f64 {
    let [a, b, c] = corners.map(|corner| minus(corner, tip));
    dot(a, cross(b, c)) / 6.0
}

/// A compensated sum of numbers (Neumaier 1974): the loss of a million roundings would show in a difference.
#[derive(Clone, Copy, Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn with(self, x: f64) -> Self {
        let next = self.sum + x;
        let rounded = if self.sum.abs() >= x.abs() {
            (self.sum - next) + x
        } else {
            (x - next) + self.sum
        };
        Self {
            sum: next,
            lost: self.lost + rounded,
        }
    }

    fn total(self) -> f64 {
        self.sum + self.lost
    }
}

/// How often a closed surface runs around a point: the solid angles of its triangles (Van Oosterom and Strackee 1983)
/// by that of a sphere.
pub(crate) fn winding(
    point: [f64; 3],
    positions: &[[f64; 3]],
    triangles: impl Iterator<Item = [u32; 3]>,
) -> f64 {
    let angles = triangles.map(|triangle| {
        let [a, b, c] = triangle.map(|v| minus(positions[v as usize], point));
        let [la, lb, lc] = [a, b, c].map(length);
        let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        2.0 * dot(a, cross(b, c)).atan2(below)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use limitmesh::PolygonSoup;
    use limitmesh::limit::LimitTable;

    use super::*;

    #[test]
    fn a_closed_surface_runs_once_around_what_is_inside() {
        let soup = limitmesh_models::find("torus").expect("a model").soup();
        let (mesh, _) = Mesh::from_soup(&soup, &Default::default()).expect("a mesh");
        let around = |point| winding(point, mesh.positions(), mesh.triangles().iter().copied());
        // A vertex pushed inwards along the normal is inside; the middle of the hole is not.
        let normals = LimitTable::new(&limitmesh::scheme::Loop)
            .normals(&mesh)
            .expect("normals");
        let (p, n) = (mesh.positions()[5], normals[5]);
        let inside = [0, 1, 2].map(|axis| p[axis] - 0.1 * n[axis]);
        let outside = [0, 1, 2].map(|axis| p[axis] + 0.1 * n[axis]);
        assert!((around(inside) - 1.0).abs() < 1e-9, "{}", around(inside));
        for point in [outside, [0.0; 3], [9.0, 9.0, 9.0]] {
            assert!(around(point).abs() < 1e-9, "{point:?}: {}", around(point));
        }
    }

    /// A cube from one corner to the opposite one, turned inside out or not.
    fn cube(soup: &mut PolygonSoup, low: f64, high: f64, is_turned: bool) {
        let first = soup.positions.len() as u32;
        let side = |bit: u32| if bit == 0 { low } else { high };
        soup.positions
            .extend((0..8u32).map(|c| [side(c & 1), side(c >> 1 & 1), side(c >> 2)]));
        for mut face in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            if is_turned {
                face.reverse();
            }
            soup.faces.push(&face.map(|corner: u32| first + corner));
        }
    }

    /// Cubes by their corners and whether they are inside out.
    fn cubes(cubes: &[(f64, f64, bool)]) -> Mesh {
        let mut soup = PolygonSoup::default();
        cubes
            .iter()
            .for_each(|&(low, high, is_turned)| cube(&mut soup, low, high, is_turned));
        Mesh::from_soup(&soup, &Default::default())
            .expect("a mesh")
            .0
    }

    #[test]
    fn area_and_volume_are_those_of_cubes() {
        let whole = Bulk::of(&cubes(&[(1000.0, 1002.0, false)]));
        assert!(
            (whole.area - 24.0).abs() < 1e-12
                && (whole.volume.expect("closed") - 8.0).abs() < 1e-11
        );
        let hollow = Bulk::of(&cubes(&[(0.0, 4.0, false), (1.0, 2.0, true)]));
        assert_eq!(
            hollow,
            Bulk {
                area: 102.0,
                volume: Some(63.0)
            }
        );
        let open = Mesh::from_triangles(
            vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]],
            vec![[0, 1, 2]],
        );
        assert_eq!(
            Bulk::of(&open.expect("a mesh")),
            Bulk {
                area: 3.0,
                volume: None
            }
        );
    }

    #[test]
    fn sums_of_many_pieces_lose_nothing() {
        // A triangle whose area leaves no digit for halves, before 20,000 of these.
        let large = [
            [0.0, 0.0, -1.0],
            [2f64.powi(27), 0.0, -1.0],
            [0.0, 2f64.powi(28), -1.0],
        ];
        let side = 100u32;
        let small =
            (0..=side).flat_map(|y| (0..=side).map(move |x| [f64::from(x), f64::from(y), 0.0]));
        let corner = |x: u32, y: u32| 3 + y * (side + 1) + x;
        let squares = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        let halves = squares.flat_map(|(x, y)| {
            let [a, b, c, d] = [
                corner(x, y),
                corner(x + 1, y),
                corner(x + 1, y + 1),
                corner(x, y + 1),
            ];
            [[a, b, c], [a, c, d]]
        });
        let positions = large.into_iter().chain(small).collect();
        let triangles = core::iter::once([0, 1, 2]).chain(halves).collect();
        let mesh = Mesh::from_triangles(positions, triangles).expect("a mesh");
        assert!(pieces(mesh.face_count(), |faces| faces.len()).len() > 2);
        assert_eq!(
            Bulk::of(&mesh),
            Bulk {
                area: 2f64.powi(54) + 1e4,
                volume: None
            }
        );
    }
}
