//! Adaptive √3-subdivision: the worst triangle first, until all are good enough or the cap is
//! reached.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::Sqrt3Options;
use super::criteria::{Found, Goals};
use super::forest::{Emitted, Forest, Triangle};
use crate::limit::SidedNormals;
use crate::mesh::{MAX_FACES, Mesh, check_size};
use crate::progress::{Observer, Stage, Watch, unobserved};
use crate::refine::{ExactStop, Origin, RefineError, Traced};

/// Divisions between two calls of the observer: some milliseconds.
const POLLED: usize = 64;

/// The result of adaptive √3-subdivision.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Sqrt3 {
    /// The mesh; all vertices lie on the limit surface. Control vertices keep their numbers.
    pub mesh: Mesh,
    /// Unit limit normals, one for each side of sharp edges.
    pub normals: SidedNormals,
    /// The origin of each vertex, with coordinates that are multiples of a power of 1/3; empty
    /// unless [`Sqrt3Options::origins`] is set.
    pub origins: Vec<Origin>,
    /// The control face of each triangle; one of the two where it lies across an edge.
    pub parents: Vec<u32>,
    /// Steps of the most divided part.
    pub levels: usize,
    /// The greatest distance of samples of the limit surface from the triangles that approximate
    /// it: **estimated**, not proven. `None` if only angles were goals.
    pub estimated_distance: Option<f64>,
    /// The greatest ratio of a triangle's error to the goals on quality; 0 without any.
    pub worst: f64,
    /// Why the refinement ended.
    pub stop: ExactStop,
}

impl Traced for Sqrt3 {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn origins(&self) -> &[Origin] {
        &self.origins
    }

    fn parents(&self) -> &[u32] {
        &self.parents
    }
}

/// Refines `control` by adaptive √3-subdivision until the goals are met: each triangle within the
/// cone or the tolerance, or the requested number of triangles, whichever comes first.
///
/// Every division leaves a mesh without cracks and without closing triangles: a triangle is divided by its centre, and the edge between two
/// divided ones is flipped. Where goals are met the result is the least such mesh, whatever the order of the divisions.
///
/// # Errors
/// A goal that is no positive number, a mesh whose diagonal is not within 1e-70 to 1e70, a
/// semi-sharp tag ([`RefineError::FadingTag`]), a vertex without a limit, or more elements than can
/// be numbered.
pub fn adaptive(control: &Mesh, options: &Sqrt3Options) -> Result<Sqrt3, RefineError> {
    adaptive_observed(control, options, &mut unobserved)
}

/// [`adaptive`] with an observer.
///
/// # Errors
/// Those of [`adaptive`], or the observer asked to stop.
pub fn adaptive_observed(
    control: &Mesh,
    options: &Sqrt3Options,
    observer: &mut Observer<'_>,
) -> Result<Sqrt3, RefineError> {
    options.check()?;
    check_size(control)?;
    let mut watch = Watch::new(observer, Stage::Refining);
    watch.triangles(control.face_count());
    watch.poll()?;
    let most = options
        .triangles
        .unwrap_or(MAX_FACES)
        .min(options.max_triangles.unwrap_or(MAX_FACES));
    let mut run = Run {
        forest: Forest::new(control, options.origins, most.max(control.face_count()))?,
        goals: Goals::of(options),
        max_levels: options.max_levels,
        waiting: BinaryHeap::new(),
        seen: Vec::new(),
    };
    let ended = run.divide_all(&mut watch)?;
    let stop = match ended {
        Ended::Full if options.triangles.is_some_and(|asked| asked <= most) => ExactStop::Triangles,
        Ended::Full => ExactStop::TriangleCap,
        Ended::Deep => ExactStop::LevelCap,
        Ended::Met => ExactStop::Met,
    };
    let Run {
        forest,
        goals,
        seen,
        ..
    } = run;
    let left = || {
        seen.iter()
            .filter(|(triangle, _)| forest.is_there(*triangle))
            .map(|(_, found)| found)
    };
    let distance = left().fold(0.0, |most: f64, found| most.max(found.distance));
    let worst = left().fold(0.0, |most: f64, found| most.max(found.ratio));
    let has_quality = options.angle.is_some() || options.tolerance.is_some();
    watch.stage(Stage::Assembling, None)?;
    let Emitted {
        mesh,
        normals,
        origins,
        parents,
        levels,
    } = forest.emit()?;
    Ok(Sqrt3 {
        mesh,
        normals,
        origins,
        parents,
        levels,
        estimated_distance: goals.has_distances().then_some(distance),
        worst: if has_quality { worst } else { 0.0 },
        stop,
    })
}

/// Why there are no more divisions.
enum Ended {
    Met,
    Full,
    Deep,
}

struct Run<'m> {
    forest: Forest<'m>,
    goals: Goals,
    max_levels: usize,
    waiting: BinaryHeap<Waiting>,
    /// Every triangle so far, and its measured errors.
    seen: Vec<(Triangle, Found)>,
}

/// A triangle that fails: the worst first, of equals the earlier.
struct Waiting {
    ratio: f64,
    triangle: Reverse<Triangle>,
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.ratio
            .total_cmp(&other.ratio)
            .then(self.triangle.cmp(&other.triangle))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl Run<'_> {
    fn divide_all(&mut self, watch: &mut Watch<'_>) -> Result<Ended, RefineError> {
        let mut is_deep = false;
        for (i, root) in self.forest.roots().enumerate() {
            if i.is_multiple_of(POLLED) {
                watch.poll()?;
            }
            self.look(root);
        }
        let mut done = 0;
        while let Some(Waiting {
            triangle: Reverse(triangle),
            ..
        }) = self.waiting.pop()
        {
            if !self.forest.is_there(triangle) {
                continue;
            }
            if usize::from(self.forest.level(triangle)) >= self.max_levels {
                is_deep = true;
                continue;
            }
            let divided = self.forest.divide(triangle);
            for fresh in self.forest.take_fresh() {
                self.look(fresh);
            }
            if divided.is_err() {
                return Ok(Ended::Full);
            }
            done += 1;
            if done % POLLED == 0 {
                watch.triangles(self.forest.triangle_count());
                watch.done(done)?;
            }
        }
        Ok(if is_deep { Ended::Deep } else { Ended::Met })
    }

    fn look(&mut self, triangle: Triangle) {
        // A triangle that arose on the way may be divided already.
        if !self.forest.is_there(triangle) {
            return;
        }
        let found = self.goals.look(&mut self.forest, triangle);
        self.seen.push((triangle, found));
        if self.goals.fails(&found) {
            self.waiting.push(Waiting {
                ratio: found.ratio,
                triangle: Reverse(triangle),
            });
        }
    }
}
