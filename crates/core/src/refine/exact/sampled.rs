//! What a refinement within a tolerance comes to, from a few control faces.
//!
//! The triangles over a control face, but for one, are about in proportion to how much its surface bends, which its neighbours' vertices
//! tell at a glance. So faces are drawn with probabilities in proportion to that and to a little more, as what is told at a glance may be wrong;
//! each is cut out with the faces around it and divided as it would be in the whole mesh, and counts by the inverse of its probability
//! (Horvitz and Thompson, "A Generalization of Sampling Without Replacement From a Finite Universe", 1952). On average that is the
//! number itself, however wrong the glance is. Faces are drawn at even steps through their order, from all parts of the mesh.

use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::patch::submesh::submesh;
use crate::progress::{Cancelled, Observer, SharedWatch, Stage};
use crate::refine::RefineError;
use crate::refine::adaptive::{count, count_in};
use crate::refine::exact_options::ExactOptions;
use crate::scheme::{Scheme, Support};
use crate::vector::{DVec3, vector};

/// So few triangles are counted, which takes a millisecond or two.
const COUNTED: f64 = 1500.0;

/// Faces that are drawn: one in so many, but so many at least and at most.
const ONE_IN: usize = 20;
const FEWEST: usize = 48;
const MOST: usize = 256;

/// Where so many times the fewest are all, they are all looked at.
const WHOLE: usize = 4;

/// What faces count as beside how they bend, in tolerances: that of one that is hardly divided.
const LEAST: f64 = 0.25;

/// Where faces bend on average by so many times four, or sixteen, tolerances, four or sixteen times the tolerance is looked at: another level
/// of division takes four times the triangles then.
const MUCH: f64 = 4.0;

/// A level of division takes so many times the triangles: four on curved surfaces, two along curved rims.
const GROWTH: [f64; 2] = [2.0, 4.0];

/// With vertices off the surface a tolerance takes as many triangles as so many times that with vertices on it.
const BALANCED: f64 = 1.5;

/// Control faces that one call takes together.
const BLOCK: usize = 1024;

/// A face that was drawn, and how many it is counted for.
struct Drawn {
    face: u32,
    weight: f64,
}

/// About how many triangles a tolerance takes, and whether they were counted.
pub(super) fn triangles(
    control: &Mesh,
    scheme: &dyn Scheme,
    (options, tolerance): (&ExactOptions, f64),
    observer: &mut Observer<'_>,
) -> Result<(usize, bool), RefineError> {
    let faces = control.face_count();
    let sharpness = Sharpness::of(control);
    let bends = bends(control, &sharpness, observer)?;
    if faces as f64 + bends.iter().sum::<f64>() / tolerance <= COUNTED {
        return Ok((count(control, scheme, options, 1.0, observer)?, true));
    }
    let tolerance = if options.balance { BALANCED * tolerance } else { tolerance };
    let options = &options.clone().balance(false);
    let share = |bend: f64| bend / tolerance + LEAST;
    let total: f64 = bends.iter().map(|&bend| share(bend)).sum();
    let is_whole = faces <= WHOLE * FEWEST;
    let drawn = match is_whole {
        true => (0..faces as u32).map(|face| Drawn { face, weight: 1.0 }).collect(),
        false => drawn(&bends, share, total / (faces / ONE_IN).clamp(FEWEST, MOST) as f64),
    };
    let seeds: Vec<HalfEdgeId> = drawn.iter().map(|drawn| HalfEdgeId::of(FaceId(drawn.face), 0)).collect();
    let around = (!is_whole).then(|| submesh(control, &sharpness, &seeds, rings(scheme)));
    // The triangles beyond one a face at so many times the tolerance.
    let mut added = |times: f64| -> Result<f64, RefineError> {
        let asked = (options, times * tolerance, seeds.len());
        let counts = count_in(around.as_ref().unwrap_or(control), scheme, asked, observer)?;
        Ok(drawn.iter().zip(counts).map(|(drawn, count)| drawn.weight * (count - 1.0)).sum())
    };
    let levels = levels_left(total / faces.max(1) as f64);
    let times = 4f64.powi(levels);
    let found = added(times)?;
    let added = match levels {
        0 => found,
        _ => found * (found / added(4.0 * times)?).clamp(GROWTH[0], GROWTH[1]).powi(levels),
    };
    Ok((faces + added.max(0.0).round() as usize, false))
}

/// Levels of division that need not be made to know what they come to.
fn levels_left(bend: f64) -> i32 {
    (bend / MUCH).log(4.0).floor().clamp(0.0, 30.0) as i32
}

/// Rings around faces that the division of those beside them depends on.
fn rings(scheme: &dyn Scheme) -> usize {
    match scheme.support() {
        Support::OneRing => 2,
        Support::TwoRing => 4,
    }
}

/// Faces at even steps through the sum of their shares.
fn drawn(bends: &[f64], share: impl Fn(f64) -> f64, step: f64) -> Vec<Drawn> {
    let (mut sum, mut next) = (0.0, 0.5 * step);
    let mut drawn = Vec::new();
    for (face, &bend) in (0..).zip(bends) {
        let share = share(bend);
        sum += share;
        let hits = ((sum - next) / step).floor() + 1.0;
        if hits > 0.0 {
            drawn.push(Drawn { face, weight: hits * step / share });
            next += hits * step;
        }
    }
    drawn
}

/// About how far the surface over each face is from its triangle.
fn bends(
    control: &Mesh,
    sharpness: &Sharpness<'_>,
    observer: &mut Observer<'_>,
) -> Result<Vec<f64>, Cancelled> {
    let watch = SharedWatch::new(observer, Stage::Refining);
    watch.map(control.face_count(), BLOCK, |face| {
        let normal = control.unit_face_normal(face);
        let edges = [0, 1, 2].map(|edge| HalfEdgeId::of(FaceId(face as u32), edge));
        edges.into_iter().map(|h| bend_along(control, sharpness, normal, h)).fold(0.0, f64::max)
    })
}

/// What an edge says of that. The vertex beyond is as far off the plane of the face as a sphere is three times over the middle of
/// an equilateral triangle; and over a sharp edge the curve is an eighth of the second difference of its vertices off the edge.
fn bend_along(control: &Mesh, sharpness: &Sharpness<'_>, normal: DVec3, h: HalfEdgeId) -> f64 {
    let topology = control.topology();
    let at = |vertex: VertexId| vector(control.positions()[vertex.index()]);
    if let Some(twin) = topology.twin(h).filter(|_| sharpness.edge(h) <= 0.0) {
        return normal.dot(at(topology.opposite(twin)) - at(topology.origin(h))).abs() / 3.0;
    }
    let of_curve = |vertex: VertexId| {
        let spokes = topology.ring(vertex).zip(sharpness.spokes(vertex));
        let mut along = spokes.filter(|&(_, sharpness)| sharpness > 0.0).map(|(end, _)| at(end));
        let is_smooth = sharpness.vertex(vertex) <= 0.0;
        match (along.next(), along.next(), along.next()) {
            (Some(a), Some(b), None) if is_smooth => (a + b - 2.0 * at(vertex)).length() / 8.0,
            _ => 0.0,
        }
    };
    let [from, to] = topology.ends(h).map(of_curve);
    from.max(to)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each face is drawn as often as its share of the sum says, and counted for as many as that is rarer.
    #[test]
    fn weights_of_drawn_faces_add_up() {
        let bends: Vec<f64> = (0..1000).map(|i| f64::from(i % 7) * f64::from(i % 3)).collect();
        let share = |bend: f64| bend + 0.5;
        let total: f64 = bends.iter().map(|&bend| share(bend)).sum();
        for count in [50.0, 200.0, 3000.0] {
            let drawn = drawn(&bends, share, total / count);
            let of_shares: f64 = drawn.iter().map(|one| one.weight * share(bends[one.face as usize])).sum();
            assert!((of_shares - total).abs() < 1e-9 * total, "{count}: {of_shares} of {total}");
            let of_faces: f64 = drawn.iter().map(|one| one.weight).sum();
            assert!((of_faces / 1000.0 - 1.0).abs() < 0.25, "{count}: {of_faces}");
        }
    }

    #[test]
    fn levels_are_left_out_where_faces_bend_much() {
        assert_eq!([0.0, 1.0, 15.9, 16.1, 63.0, 65.0, 1e300].map(levels_left), [0, 0, 0, 1, 1, 2, 30]);
    }
}
