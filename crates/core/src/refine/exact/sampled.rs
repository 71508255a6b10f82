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

/// Faces that are drawn at first: one in so many, but so many at least and at most.
const ONE_IN: usize = 30;
const FEWEST: usize = 32;
const MOST: usize = 128;

/// So many times as many are drawn as long as the estimate's standard error is more than this part of it, and the faces that are
/// divided are no more than that part of all.
const MORE: usize = 3;
const CLOSE: f64 = 0.06;
const MUCH: f64 = 0.25;

/// So many faces are divided for each, those beside it among them. Where these are all, all are looked at.
const DIVIDED: usize = 4;

/// What faces count as beside how they bend, in tolerances: that of one that is hardly divided.
const LEAST: f64 = 0.25;

/// How much a face bends by what it shares with its neighbours' edges around a corner: half as much as the edges.
const AT_CORNER: f64 = 0.5;

/// Where too many triangles would have to be made, and faces bend by so many tolerances on average, four times the tolerance is
/// looked at: what faces that are divided take for another level of division is known.
const BENT: f64 = 8.0;

/// A level of division takes so many times the triangles: four on curved surfaces, two along curved rims.
const LEVEL: f64 = 4.0;
const GROWTH: [f64; 2] = [2.0, LEVEL];

/// With vertices off the surface a tolerance takes as many triangles as so many times that with vertices on it.
const BALANCED: f64 = 1.5;

/// Control faces that one call takes together.
const BLOCK: usize = 1024;

/// A face that was drawn, and how many it is counted for.
#[derive(Clone, Copy)]
struct Drawn {
    face: u32,
    weight: f64,
}

/// About how many triangles a tolerance takes, and whether they were counted.
pub(super) fn triangles(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    tolerance: f64,
    observer: &mut Observer<'_>,
) -> Result<(usize, bool), RefineError> {
    let faces = control.face_count();
    let sharpness = Sharpness::of(control);
    let bends = bends(control, &sharpness, observer)?;
    if faces as f64 + bends.iter().sum::<f64>() / tolerance <= COUNTED {
        return Ok((count(control, scheme, options, 1.0, observer)?, true));
    }
    let tolerance = if options.balance { BALANCED * tolerance } else { tolerance };
    let shares = bends.iter().map(|bend| bend / tolerance + LEAST).collect();
    let options = options.clone().balance(false);
    let sampling = Sampling { control, scheme, sharpness, options, tolerance, shares };
    let mut wanted = (faces / ONE_IN).clamp(FEWEST, MOST);
    loop {
        let drawn = sampling.drawn(wanted);
        let made = sampling.made(&drawn);
        let (added, error) = match made > MUCH && sampling.bend() > BENT {
            true => (sampling.extrapolated(&drawn, observer)?, 0.0),
            false => sampling.added(&drawn, 1.0, observer)?,
        };
        let found = faces as f64 + added.max(0.0);
        if error <= CLOSE * found || MORE as f64 * made > MUCH {
            return Ok((found.round() as usize, false));
        }
        wanted *= MORE;
    }
}

/// What faces are drawn from.
struct Sampling<'a> {
    control: &'a Mesh,
    scheme: &'a dyn Scheme,
    sharpness: Sharpness<'a>,
    options: ExactOptions,
    tolerance: f64,
    /// What faces count as, in tolerances.
    shares: Vec<f64>,
}

impl Sampling<'_> {
    /// How much faces bend on average, in tolerances.
    fn bend(&self) -> f64 {
        self.shares.iter().sum::<f64>() / self.shares.len().max(1) as f64
    }

    /// About the part of all triangles that is made where these faces are divided.
    fn made(&self, drawn: &[Drawn]) -> f64 {
        let own: f64 = drawn.iter().map(|one| self.shares[one.face as usize]).sum();
        (DIVIDED as f64 * own / self.shares.iter().sum::<f64>()).min(1.0)
    }

    /// About so many faces at even steps through the sum of their shares, or all where these are hardly more.
    fn drawn(&self, wanted: usize) -> Vec<Drawn> {
        match self.shares.len() <= DIVIDED * wanted {
            true => (0..self.shares.len() as u32).map(|face| Drawn { face, weight: 1.0 }).collect(),
            false => at_even_steps(&self.shares, wanted),
        }
    }

    /// The triangles beyond one a face at so many times the tolerance, and the standard error of that.
    fn added(
        &self,
        drawn: &[Drawn],
        times: f64,
        observer: &mut Observer<'_>,
    ) -> Result<(f64, f64), RefineError> {
        let is_whole = drawn.len() == self.shares.len();
        let seeds: Vec<HalfEdgeId> = drawn.iter().map(|one| HalfEdgeId::of(FaceId(one.face), 0)).collect();
        let around = (!is_whole).then(|| submesh(self.control, &self.sharpness, &seeds, rings(self.scheme)));
        let (mesh, distance) = (around.as_ref().unwrap_or(self.control), times * self.tolerance);
        let counts = count_in(mesh, self.scheme, &self.options, distance, seeds.len(), observer)?;
        let added: Vec<f64> =
            drawn.iter().zip(counts).map(|(one, count)| one.weight * (count - 1.0)).collect();
        let sum: f64 = added.iter().sum();
        let mean = sum / added.len().max(1) as f64;
        let squares: f64 = added.iter().map(|added| (added - mean).powi(2)).sum();
        Ok((sum, if is_whole { 0.0 } else { squares.sqrt() }))
    }

    /// The same from what it is at four and sixteen times the tolerance.
    fn extrapolated(&self, drawn: &[Drawn], observer: &mut Observer<'_>) -> Result<f64, RefineError> {
        let (found, _) = self.added(drawn, LEVEL, observer)?;
        let (before, _) = self.added(drawn, LEVEL * LEVEL, observer)?;
        Ok(found * (found / before).clamp(GROWTH[0], GROWTH[1]))
    }
}

/// Rings around faces that the division of those beside them depends on.
fn rings(scheme: &dyn Scheme) -> usize {
    match scheme.support() {
        Support::OneRing => 2,
        Support::TwoRing => 4,
    }
}

/// Faces at so many even steps through the sum of their shares.
fn at_even_steps(shares: &[f64], wanted: usize) -> Vec<Drawn> {
    let step = shares.iter().sum::<f64>() / wanted as f64;
    let (mut sum, mut next) = (0.0, 0.5 * step);
    let mut drawn = Vec::new();
    for (face, &share) in (0..).zip(shares) {
        sum += share;
        let hits = ((sum - next) / step).floor() + 1.0;
        if hits > 0.0 {
            drawn.push(Drawn { face, weight: hits * step / share });
            next += hits * step;
        }
    }
    drawn
}

/// About how far the surface over each face is from its triangle: as its edges say, and those around its corners.
fn bends(
    control: &Mesh,
    sharpness: &Sharpness<'_>,
    observer: &mut Observer<'_>,
) -> Result<Vec<f64>, Cancelled> {
    let watch = SharedWatch::new(observer, Stage::Refining);
    let own = watch.map(control.face_count(), BLOCK, |face| {
        let normal = control.unit_face_normal(face);
        let edges = [0, 1, 2].map(|edge| HalfEdgeId::of(FaceId(face as u32), edge));
        edges.into_iter().map(|h| bend_along(control, sharpness, normal, h)).fold(0.0, f64::max)
    })?;
    let mut at_corners = vec![0.0f64; control.vertex_count()];
    watch.each(control.triangles().iter().zip(&own), |(corners, &bend)| {
        for &vertex in corners {
            at_corners[vertex as usize] = at_corners[vertex as usize].max(AT_CORNER * bend);
        }
    })?;
    watch.map(control.face_count(), BLOCK, |face| {
        let corners = control.triangles()[face];
        corners.iter().fold(own[face], |bend, &vertex| bend.max(at_corners[vertex as usize]))
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
        let shares: Vec<f64> = (0..1000).map(|i| 0.5 + f64::from(i % 7) * f64::from(i % 3)).collect();
        let total: f64 = shares.iter().sum();
        for count in [50, 200, 3000] {
            let drawn = at_even_steps(&shares, count);
            let of_shares: f64 = drawn.iter().map(|one| one.weight * shares[one.face as usize]).sum();
            assert!((of_shares - total).abs() < 1e-9 * total, "{count}: {of_shares} of {total}");
            let of_faces: f64 = drawn.iter().map(|one| one.weight).sum();
            assert!((of_faces / 1000.0 - 1.0).abs() < 0.25, "{count}: {of_faces}");
        }
    }
}
