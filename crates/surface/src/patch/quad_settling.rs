//! How fast the surface around an irregular vertex of quads settles to an affine image of its characteristic map.
//!
//! As [`super::settling`] has it for triangles, with the points around half a quad at the vertex, which a step takes to points of the
//! same form. The map is the limit of steps on points that the limit of the vertex is taken from.

use std::sync::Arc;

use super::bicubic::Bicubic;
use super::normal_net::{QUINTIC, quintic_products};
use super::polynomial::Net as _;
use super::quad::QuadPatch;
use super::settling::greatest_growth;
use super::{Patch, Rules};
use crate::catmull_clark::form::{QuadForm, QuadForms, Settling};
use crate::catmull_clark::ring::subdominant;
use crate::row::{Row, sum};
use crate::vector::DVec3;

/// Steps after which the map is given up.
const MOST_STEPS: usize = 4_000;

/// The map has converged where no coordinate changes by more in a step.
const CONVERGED: f64 = 1e-15;

impl QuadPatch {
    /// How the piece settles; `None` where its part at the irregular vertex is of another form than it, and at vertices of other kinds.
    pub(crate) fn settling(&self, rules: &Rules<'_>) -> Option<&Settling> {
        let forms = rules.quad_forms();
        self.form.settling(|| settling(&self.form, forms))
    }
}

fn settling(form: &Arc<QuadForm>, forms: &QuadForms) -> Option<Settling> {
    let part = form.step(forms).same(form)?;
    // A half has three of its quad's corners.
    let corner = *[0, 1, 3].get(part)?;
    let (functionals, edges) = form.smooth_limits(corner)?;
    let eigenvalue = subdominant(edges);
    let step = |points: &[DVec3]| refined(form, forms, part, points);
    let count = form.point_count();
    let map = map(&functionals, count, step)?;
    let (_, tangents) = step(&map)?;
    let jacobian = tangents.iter().flat_map(quintic_products);
    let least_jacobian = jacobian
        .map(|normal| normal.z)
        .fold(f64::INFINITY, f64::min);
    let differences = tangents.as_flattened().as_flattened().iter();
    let steepest = differences.fold(DVec3::ZERO, |most, by| most.max(by.abs()));
    let left = |points: Vec<DVec3>| {
        let [limit, t1, t2] = functionals.each_ref().map(|row| sum(row, &points));
        let left = |(point, at): (&DVec3, &DVec3)| point - (limit + at.x * t1 + at.y * t2);
        points.iter().zip(&map).map(left).collect()
    };
    let growth = greatest_growth(count, eigenvalue, left, |points| {
        let (next, tangents) = step(points)?;
        Some((next, tangents.as_flattened().as_flattened().to_vec()))
    })?;
    Some(Settling {
        growth,
        least_jacobian,
        steepest: [steepest.x, steepest.y],
        functionals,
        map,
    })
}

/// The nets of a regular piece's derivatives.
type Tangents = [[DVec3; QUINTIC]; 2];

/// The points of the part of the same form after a step, and the nets of the derivatives over the others.
fn refined(
    form: &QuadForm,
    forms: &QuadForms,
    part: usize,
    points: &[DVec3],
) -> Option<(Vec<DVec3>, Vec<Tangents>)> {
    let step = form.step(forms);
    let after = step.points(points);
    let mut found = Vec::new();
    for other in (0..4).filter(|&other| other != part) {
        let (form, points) = step.part(other, &after);
        append(&mut found, QuadPatch::piece(form, points), forms)?;
    }
    Some((step.part(part, &after).1, found))
}

/// Appends those of a piece, or of its parts: the other half of the vertex's own quad has that at the corner opposite, until it is
/// divided. Derivatives by a part's places are half as long.
fn append(found: &mut Vec<Tangents>, piece: Patch, forms: &QuadForms) -> Option<()> {
    let of = |piece: &Bicubic, scale: f64| {
        let tangents = piece.part_net().tangents();
        tangents.map(|net| net.map(|by| scale * by))
    };
    match piece {
        Patch::Bicubic(piece) => found.push(of(&piece, 1.0)),
        Patch::Quad(own) => {
            let step = own.form.step(forms);
            let after = step.points(own.points());
            for part in 0..4 {
                let (form, points) = step.part(part, &after);
                let Patch::Bicubic(piece) = QuadPatch::piece(form, points) else {
                    return None;
                };
                found.push(of(&piece, 2.0));
            }
        }
        _ => return None,
    }
    Some(())
}

/// The map's points, whose tangents are the unit vectors.
fn map<T>(
    [position, first, second]: &[Row; 3],
    count: usize,
    step: impl Fn(&[DVec3]) -> Option<(Vec<DVec3>, T)>,
) -> Option<Vec<DVec3>> {
    let mut points = vec![DVec3::ZERO; count];
    for (row, axis) in [(first, DVec3::X), (second, DVec3::Y)] {
        row.iter()
            .for_each(|&(at, weight)| points[at as usize] += weight * axis);
    }
    for _ in 0..MOST_STEPS {
        let mut next = step(&points)?.0;
        let (limit, [a, b]) = (
            sum(position, &next),
            [first, second].map(|row| sum(row, &next)),
        );
        // Columns are what the inverse of the tangents makes of them.
        let determinant = a.x * b.y - a.y * b.x;
        for point in &mut next {
            let [x, y] = [point.x - limit.x, point.y - limit.y];
            *point = DVec3::new(x * b.y - y * b.x, y * a.x - x * a.y, 0.0) / determinant;
        }
        let change = next.iter().zip(&points);
        let greatest = change
            .map(|(a, b)| (a - b).abs().max_element())
            .fold(0.0, f64::max);
        points = next;
        if greatest <= CONVERGED {
            return Some(points);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LimitSurface;
    use crate::catmull_clark::QuadControl;
    use crate::index::FaceId;
    use crate::mesh::{BuildOptions, PolygonSoup};
    use crate::scheme::CatmullClark;
    use limitmesh_testing::Random;

    /// Points at random around a vertex of so many quads, each of them in four.
    fn fan(edges: u32, random: &mut Random) -> crate::mesh::Mesh {
        let mut soup = PolygonSoup::default();
        let turn = |i: u32| core::f64::consts::TAU * f64::from(i) / f64::from(2 * edges);
        soup.positions.push([0.0; 3]);
        for i in 0..2 * edges {
            soup.positions.push([turn(i).cos(), turn(i).sin(), 0.0]);
        }
        for i in 0..edges {
            let [a, b, c] = [0, 1, 2].map(|step| 1 + (2 * i + step) % (2 * edges));
            soup.faces.push(&[0, a, b, c]);
        }
        for p in &mut soup.positions {
            *p = p.map(|x| x + 0.2 * random.signed());
        }
        let (control, _) = QuadControl::from_soup(&soup, &BuildOptions::default()).unwrap();
        control.mesh
    }

    /// Brute force: what is left of points at random after many steps, in the nets of the regular pieces.
    #[test]
    fn what_is_left_never_grows_beyond() {
        let mut random = Random::new(3);
        let mut found = 0;
        for edges in [3, 5, 6, 7, 8, 12] {
            let mesh = fan(edges, &mut random);
            let surface = LimitSurface::new(&mesh, &CatmullClark).unwrap();
            let (rules, forms) = (surface.rules(), surface.rules().quad_forms());
            for face in (0..mesh.face_count() as u32).map(FaceId) {
                let Some(corner) = (0..3).find(|&i| mesh.triangles()[face.index()][i] == 0) else {
                    continue;
                };
                let mut patch = surface.patch(face);
                for _ in 0..3 {
                    patch = patch.refined(rules).part(corner);
                }
                let Patch::Quad(patch) = patch else { panic!() };
                let settling = patch.settling(rules).unwrap();
                assert!(
                    (0.05..8.0).contains(&settling.growth),
                    "{edges}: {}",
                    settling.growth
                );
                assert!(
                    settling.least_jacobian > 0.0,
                    "{edges}: {}",
                    settling.least_jacobian
                );
                found += 1;
                let (part, eigenvalue) = (corner, subdominant(edges as usize));
                let limits = settling.functionals.each_ref();
                let [limit, t1, t2] = limits.map(|row| sum(row, patch.points()));
                let on_map = |at: DVec3| at.x * t1 + at.y * t2;
                let longest = |points: &[DVec3], scale: f64| {
                    let pairs = points.iter().zip(&settling.map);
                    pairs
                        .map(|(p, &at)| ((p - limit) / scale - on_map(at)).length())
                        .fold(0.0, f64::max)
                };
                let (_, of_map) = refined(&patch.form, forms, part, &settling.map).unwrap();
                let (mut points, mut scale) = (patch.points().to_vec(), 1.0);
                let first = longest(&points, 1.0);
                for level in 0..8 {
                    let (next, nets) = refined(&patch.form, forms, part, &points).unwrap();
                    let [own, of_map] =
                        [&nets, &of_map].map(|nets| nets.as_flattened().as_flattened());
                    for (own, &of_map) in own.iter().zip(of_map) {
                        let beside = own / scale - on_map(of_map);
                        let most = settling.growth * first + 1e-9;
                        assert!(beside.length() <= most, "{edges}, level {level}");
                    }
                    (points, scale) = (next, scale * eigenvalue);
                }
                assert!(longest(&points, scale) < first, "{edges}");
            }
        }
        assert!(found > 40, "{found}");
    }
}
