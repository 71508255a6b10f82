//! Uniform refinement: every triangle is split in four at each level.
//!
//! Takes a mesh, a scheme and a number of levels; gives the mesh of the last level, with its vertices on the limit surface and
//! their normals if asked for. Levels are done one by one; the last ones before the limit of a scheme of Loop's family are done
//! together, by arithmetic and the exact surface instead of masks.

mod grid;
mod limits;
mod pieces;
#[cfg(test)]
mod tests;

use std::time::Instant;

use super::driver::Driver;
use super::{RefineError, Refinement, StepReport, Stop};
use crate::mesh::{MAX_FACES, Mesh, MeshError, Sharpness, check_finite};
use crate::patch::Rules;
use crate::progress::{Observer, Stage, Watch, unobserved};
use crate::scheme::Scheme;

/// Levels that are done together at most: tables of the combined triangle then stay in the processor's caches.
const MOST_TOGETHER: usize = 4;

/// How to refine uniformly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UniformOptions {
    /// Number of levels.
    pub levels: usize,
    /// Move the vertices to the limit surface at the end.
    pub limit: bool,
    /// Give the limit normals of the vertices, too ([`Refinement::normals`]).
    pub normals: bool,
    /// Tells where vertices and triangles came from ([`Refinement::origins`]).
    pub origins: bool,
    /// Stop before the level that would have more triangles.
    pub max_triangles: Option<usize>,
}

impl Default for UniformOptions {
    fn default() -> Self {
        Self { levels: 3, limit: false, normals: false, origins: false, max_triangles: None }
    }
}

impl UniformOptions {
    /// Sets [`Self::levels`].
    pub fn levels(mut self, levels: usize) -> Self {
        self.levels = levels;
        self
    }

    /// Sets [`Self::limit`].
    pub fn limit(mut self, limit: bool) -> Self {
        self.limit = limit;
        self
    }

    /// Sets [`Self::normals`].
    pub fn normals(mut self, normals: bool) -> Self {
        self.normals = normals;
        self
    }

    /// Sets [`Self::origins`].
    pub fn origins(mut self, origins: bool) -> Self {
        self.origins = origins;
        self
    }

    /// Sets [`Self::max_triangles`].
    pub fn max_triangles(mut self, max_triangles: Option<usize>) -> Self {
        self.max_triangles = max_triangles;
        self
    }
}

/// Refines `mesh` uniformly.
///
/// Old vertices keep their numbers, new ones follow level by level in the order of their edges' first half-edges; the four
/// triangles of a face stand together, those at its corners first, then the middle one.
///
/// # Errors
/// See [`RefineError`].
pub fn uniform(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &UniformOptions,
) -> Result<Refinement, RefineError> {
    uniform_observed(mesh, scheme, options, &mut unobserved)
}

/// [`uniform`], telling an observer how it goes on.
///
/// # Errors
/// See [`RefineError`].
pub fn uniform_observed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &UniformOptions,
    observer: &mut Observer<'_>,
) -> Result<Refinement, RefineError> {
    let all = |mesh: &Mesh| Ok(vec![true; mesh.face_count()]);
    let UniformOptions { levels, limit, normals, origins, max_triangles } = *options;
    let steps =
        |driver: Driver<'_>, observer: &mut Observer<'_>| driver.run(mesh, observer, all, |_, _| None);
    // Levels that are done together leave no trace.
    if limit && !origins {
        let rules = Rules::of(scheme);
        let end = End::of(mesh.face_count(), options);
        let together = levels_together(mesh, &rules, end.levels);
        if together > 0 {
            if end.too_many > 0 {
                let (what, count) = ("faces", end.too_many);
                return Err(MeshError::TooMany { what, count, limit: MAX_FACES }.into());
            }
            let first = end.levels - together;
            let driver = Driver {
                scheme: rules.scheme(),
                levels: first,
                limit: false,
                normals: false,
                origins: false,
                max_triangles: None,
            };
            let refined = steps(driver, observer)?;
            return finish(refined, &rules, &end, together, normals, observer);
        }
    }
    steps(Driver { scheme, levels, limit, normals, origins, max_triangles }, observer)
}

/// How uniform refinement will end.
struct End {
    levels: usize,
    stop: Stop,
    /// The faces of the first level that would have more than can be numbered; 0 if there is none.
    too_many: usize,
}

impl End {
    fn of(mut faces: usize, options: &UniformOptions) -> Self {
        for level in 0..options.levels {
            let needed = faces.saturating_mul(4);
            if options.max_triangles.is_some_and(|cap| needed > cap) {
                return Self { levels: level, stop: Stop::TriangleCap { needed }, too_many: 0 };
            }
            if needed > MAX_FACES {
                return Self { levels: level, stop: Stop::Levels, too_many: needed };
            }
            faces = needed;
        }
        Self { levels: options.levels, stop: Stop::Levels, too_many: 0 }
    }
}

/// How many of the last levels can be done together: none for other schemes, while tags fade, where sheets were cut apart
/// (whose copies of vertices the steps keep alike), and at the first level, after which most faces are regular.
fn levels_together(mesh: &Mesh, rules: &Rules<'_>, levels: usize) -> usize {
    if !rules.is_certified() || !mesh.junctions().is_empty() {
        return 0;
    }
    let first = levels.saturating_sub(MOST_TOGETHER).max(1).max(Sharpness::of(mesh).fading_levels());
    levels.saturating_sub(first)
}

/// The last levels after the first ones.
fn finish(
    refined: Refinement,
    rules: &Rules<'_>,
    end: &End,
    together: usize,
    normals: bool,
    observer: &mut Observer<'_>,
) -> Result<Refinement, RefineError> {
    let start = Instant::now();
    let Refinement { mesh, mut steps, .. } = refined;
    let mut watch = Watch::new(observer, Stage::Refining);
    watch.triangles(mesh.face_count());
    watch.stage(Stage::Refining, Some(end.levels))?;
    watch.done(end.levels - together)?;
    let mut faces = mesh.face_count();
    let (mesh, normals) = limits::refined_at_limit(&mesh, rules, together, normals, &mut watch)?;
    for step in end.levels - together + 1..=end.levels {
        let (faces_before, faces_after) = (faces, 4 * faces);
        // The time of levels that are done together stands at the last.
        let duration = if step == end.levels { start.elapsed() } else { Default::default() };
        let divisible = faces_before;
        steps.push(StepReport { step, faces_before, divisible, closure: [0; 4], faces_after, duration });
        faces = faces_after;
    }
    watch.triangles(faces);
    watch.done(end.levels)?;
    check_finite(mesh.positions())?;
    Ok(Refinement { mesh, normals, origins: Vec::new(), parents: Vec::new(), steps, stop: end.stop })
}
