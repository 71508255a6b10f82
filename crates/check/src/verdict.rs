//! Goes through all triangles of a result with the conditions of docs/certificate.md.

use crate::mesh::{Control, Mesh};
use crate::pieces::{Corner, Piece, Scheme, quarters};
use crate::proof::{Place, Proof, WHOLE};
use crate::quartic::{self, CORNERS, Net, SIDES};
use crate::tiling::{self, Refusal};
use crate::triangle::{Frames, ROUNDOFF, Triangle};
use crate::vector::{Vector, add, scale, sub};

/// How often rings are refined and polynomials halved at most.
const MOST_LEVELS: usize = 48;
const MOST_HALVINGS: usize = 24;

/// Weights of less than this count as none where parts are cut.
const NO_WEIGHT: f64 = 1e-14;

const AT_CORNER: &str = "has a corner that is too far from the surface";
const INSIDE: &str = "is too far from the surface, or the surface from it";
const ALONG: &str = "has an edge that is too far from the surface, or the surface from it";

/// The triangles that are not proven to be within the length; none if the proof holds. An error where it is no proof of these meshes.
pub fn refused(
    control: &Mesh,
    result: &Mesh,
    proof: &Proof,
    within: f64,
) -> Result<Vec<Refusal>, String> {
    let origins = proof.origins(control, result)?;
    let control = Control::new(control.clone(), &proof.creases, &proof.corners)?;
    let twins = match tiling::check(&control, result, &origins) {
        Ok(twins) => twins,
        Err(refused) => return Ok(once(refused)),
    };
    let coordinates = control
        .mesh
        .positions
        .iter()
        .chain(&result.positions)
        .flatten();
    let greatest = coordinates.fold(0.0f64, |most, x| most.max(x.abs()));
    if !(1e-90..1e90).contains(&within) || greatest > 1e90 {
        return Err(
            "a length or a coordinate is too small or too large to be computed with".into(),
        );
    }
    let rounding = (128 * control.valence().max(6) + 4096) as f64 * ROUNDOFF * (greatest + within);
    let frames = Frames {
        result,
        twins: &twins,
        within,
        rounding,
    };
    let mut by_face: Vec<u32> = (0..result.triangles.len() as u32).collect();
    by_face.sort_by_key(|&t| origins.parents[t as usize]);
    let mut refused = Vec::new();
    for triangles in
        by_face.chunk_by(|&a, &b| origins.parents[a as usize] == origins.parents[b as usize])
    {
        let face = origins.parents[triangles[0] as usize];
        let mut piece = Piece::new([0, 1, 2].map(|i| control.corner(3 * face + i)));
        for &t in triangles {
            let Some(part) = tiling::part(result, &origins, &control.mesh.triangles, t) else {
                continue;
            };
            let spot = |i: usize| Spot {
                weights: Place::weights(part[i]).map(|weight| weight as f64 / WHOLE as f64),
                corner: Some(i),
                // One of the two triangles at an edge looks at it.
                side: Some(i).filter(|_| twins[3 * t as usize + i] > 3 * t + i as u32),
            };
            let look = Look {
                triangle: frames.triangle(t),
                scheme: proof.scheme,
            };
            if let Err(what) = look.at_piece(&mut piece, &[0, 1, 2].map(spot), 0) {
                refused.push((t, what));
            }
        }
    }
    Ok(once(refused))
}

/// Each triangle with one reason, ascending.
fn once(mut refused: Vec<Refusal>) -> Vec<Refusal> {
    refused.sort_unstable();
    refused.dedup_by_key(|&mut (t, _)| t);
    refused
}

/// A corner of a polygon within a piece.
#[derive(Clone, Copy)]
struct Spot {
    /// Barycentric coordinates in the piece.
    weights: Vector,
    /// The corner of the triangle that it is.
    corner: Option<usize>,
    /// The triangle's edge along which the polygon goes on from it, if that is to be looked at.
    side: Option<usize>,
}

/// Looks at the surface over a triangle of the result.
struct Look {
    triangle: Triangle,
    scheme: Scheme,
}

impl Look {
    /// Looks at a piece over a convex polygon of it.
    fn at_piece(
        &self,
        piece: &mut Piece,
        polygon: &[Spot],
        level: usize,
    ) -> Result<(), &'static str> {
        match piece {
            _ if polygon.is_empty() => Ok(()),
            Piece::Net(net) => (1..polygon.len() - 1).try_for_each(|i| {
                let mut corners = [polygon[0], polygon[i], polygon[i + 1]];
                corners[0].side = corners[0].side.filter(|_| i == 1);
                corners[2].side = corners[2].side.filter(|_| i + 2 == polygon.len());
                self.at_net(
                    &quartic::over(net, &corners.map(|spot| spot.weights)),
                    corners,
                )
            }),
            Piece::Corners(corners, _) if self.is_near(corners, polygon) => Ok(()),
            Piece::Corners(..) if level >= MOST_LEVELS => Err(INSIDE),
            Piece::Corners(corners, parts) => {
                let parts = parts.get_or_insert_with(|| Box::new(quarters(corners, self.scheme)));
                (0..4).try_for_each(|part| {
                    self.at_piece(&mut parts[part], &clipped(polygon, part), level + 1)
                })
            }
        }
    }

    fn at_net(&self, net: &Net, corners: [Spot; 3]) -> Result<(), &'static str> {
        let is_at_corner = |i: usize| {
            corners[i]
                .corner
                .is_none_or(|c| self.triangle.is_at_corner(c, net[CORNERS[i]]))
        };
        let curve = |i: usize| SIDES[i].map(|point| net[point]);
        let is_along = |i: usize| {
            corners[i]
                .side
                .is_none_or(|e| self.triangle.is_curve_along(e, &curve(i), 0))
        };
        match (0..3).all(is_at_corner) {
            false => Err(AT_CORNER),
            true if !self.is_inside(net, 0) => Err(INSIDE),
            true if !(0..3).all(is_along) => Err(ALONG),
            true => Ok(()),
        }
    }

    /// Whether a polynomial is inside, halved as long as that helps.
    fn is_inside(&self, net: &Net, halvings: usize) -> bool {
        if net.iter().all(|&p| self.triangle.is_inside(p)) {
            return true;
        }
        if halvings >= MOST_HALVINGS || !CORNERS.iter().all(|&i| self.triangle.is_inside(net[i])) {
            return false;
        }
        // The sides that are not halved yet come next.
        let [first, second] = quartic::halves(net);
        let first = quartic::turned(&quartic::turned(&first));
        self.is_inside(&first, halvings + 1)
            && self.is_inside(&quartic::turned(&second), halvings + 1)
    }

    /// Whether all control points of a piece are near enough for the polygon.
    fn is_near(&self, corners: &[Corner; 3], polygon: &[Spot]) -> bool {
        let rings = corners.iter().map(|corner| &corner.ring);
        let points: Vec<Vector> = rings
            .flat_map(|ring| ring.around.iter().chain([&ring.at]).copied())
            .collect();
        let is_at_corner = |corner: usize| {
            points
                .iter()
                .all(|&p| self.triangle.is_at_corner(corner, p))
        };
        points.iter().all(|&p| self.triangle.is_inside(p))
            && polygon
                .iter()
                .all(|spot| spot.corner.is_none_or(is_at_corner))
            && polygon.iter().all(|spot| {
                spot.side
                    .is_none_or(|edge| self.triangle.is_along(edge, &points))
            })
    }
}

/// What of a polygon is in a quarter, with coordinates there; nothing where it only touches it, as the other side has that.
fn clipped(polygon: &[Spot], part: usize) -> Vec<Spot> {
    let in_part = |weights: Vector| match part {
        3 => weights.map(|weight| 1.0 - 2.0 * weight),
        _ => std::array::from_fn(|i| 2.0 * weights[i] - if i == part { 1.0 } else { 0.0 }),
    };
    let mut inside: Vec<Spot> = polygon
        .iter()
        .map(|spot| Spot {
            weights: in_part(spot.weights),
            ..*spot
        })
        .collect();
    for line in if part == 3 { 0..3 } else { part..part + 1 } {
        let all = std::mem::take(&mut inside);
        let is_beyond = |sign: f64| all.iter().any(|spot| sign * spot.weights[line] > NO_WEIGHT);
        if is_beyond(-1.0) && !is_beyond(1.0) {
            return Vec::new();
        }
        for (i, &p) in all.iter().enumerate() {
            let q = all[(i + 1) % all.len()];
            let [a, b] = [p, q].map(|spot| spot.weights[line]);
            if a >= -NO_WEIGHT {
                let leaves = a <= NO_WEIGHT && b < -NO_WEIGHT;
                inside.push(Spot {
                    side: p.side.filter(|_| !leaves),
                    ..p
                });
            }
            if a.min(b) < -NO_WEIGHT && a.max(b) > NO_WEIGHT {
                let weights = add(p.weights, scale(sub(q.weights, p.weights), a / (a - b)));
                inside.push(Spot {
                    weights,
                    corner: None,
                    side: p.side.filter(|_| a < 0.0),
                });
            }
        }
    }
    inside
}
