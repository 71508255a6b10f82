//! Uniform refinement: every triangle is split in four at each level.
//!
//! Takes a mesh, a scheme and a number of levels; gives the mesh of the last level, or its
//! triangles alone, with the vertices on the limit surface and their normals if requested. Levels
//! are done one by one; the last ones before the limit of a scheme of Loop's family are done
//! together, by arithmetic and the exact surface instead of masks.

mod grid;
mod limits;
mod pieces;
#[cfg(test)]
mod tests;

use self::limits::{AtLimit, Wanted};
use super::driver::Driver;
use super::{RefineError, Refinement, StepReport, Stop};
use crate::clock::Clock;
use crate::limit::SidedNormals;
use crate::mesh::{
    Junctions, MAX_FACES, Mesh, MeshError, Sharpness, Topology, Triangles, check_finite,
};
use crate::patch::Rules;
use crate::progress::{Observer, Stage, Watch, unobserved};
use crate::scheme::Scheme;

/// Levels that are done together at most: tables of the combined triangle then stay in the processor's caches.
const MOST_TOGETHER: usize = 4;

/// The options of uniform refinement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UniformOptions {
    /// Number of levels.
    pub levels: usize,
    /// Whether to move the vertices to the limit surface at the end.
    pub limit: bool,
    /// Whether to compute the limit normals of the vertices, too ([`Refinement::normals`]).
    pub normals: bool,
    /// Whether to report the origins of vertices and triangles ([`Refinement::origins`]).
    pub origins: bool,
    /// The most triangles: refinement stops before the level that would exceed them.
    pub max_triangles: Option<usize>,
}

impl Default for UniformOptions {
    fn default() -> Self {
        Self {
            levels: 3,
            limit: false,
            normals: false,
            origins: false,
            max_triangles: None,
        }
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
/// Old vertices keep their numbers, new ones follow level by level in the order of their edges'
/// first half-edges; the four triangles of a face are consecutive, those at its corners first, then
/// the middle one.
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

/// [`uniform`], with an observer.
///
/// # Errors
/// See [`RefineError`].
pub fn uniform_observed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &UniformOptions,
    observer: &mut Observer<'_>,
) -> Result<Refinement, RefineError> {
    let Some(last) = LastLevels::of(mesh, scheme, options)? else {
        return by_steps(mesh, scheme, options, observer);
    };
    let wanted = Wanted {
        normals: options.normals,
        connections: true,
    };
    let (found, steps) = last.refined(mesh, wanted, observer)?;
    let AtLimit {
        triangles,
        twins,
        outgoing,
        positions,
        normals,
        tags,
    } = found;
    let topology = Topology::from_parts(triangles, twins, outgoing);
    let mesh = Mesh::from_parts(topology, positions, tags, Junctions::default());
    Ok(Refinement {
        mesh,
        normals,
        origins: Vec::new(),
        parents: Vec::new(),
        steps,
        stop: last.end.stop,
    })
}

/// The result of uniform refinement without connections, to draw, to measure or to write.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct UniformTriangles {
    /// The positions of the vertices.
    pub positions: Vec<[f64; 3]>,
    /// The vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Unit limit normals of the vertices, an average of the sides at sharp edges; empty if not
    /// requested.
    pub normals: Vec<[f64; 3]>,
    /// The limit normals of triangles' corners at sharp edges, each of its own side, by 3 · triangle + corner, ascending. Empty
    /// without sharp edges.
    pub sides: Vec<(u32, [f64; 3])>,
    /// Levels that were done.
    pub levels: usize,
    /// The reason why there were no more.
    pub stop: Stop,
}

impl UniformTriangles {
    fn new(
        (positions, triangles): (Vec<[f64; 3]>, Vec<[u32; 3]>),
        normals: Option<SidedNormals>,
        levels: usize,
        stop: Stop,
    ) -> Self {
        let sides = normals.iter().flat_map(|normals| normals.sides());
        let sides = sides.map(|&(corner, normal)| (corner.0, normal)).collect();
        let normals = normals
            .map(SidedNormals::into_by_vertex)
            .unwrap_or_default();
        Self {
            positions,
            triangles,
            normals,
            sides,
            levels,
            stop,
        }
    }

    /// The surface.
    pub fn as_triangles(&self) -> Triangles<'_> {
        Triangles {
            positions: &self.positions,
            triangles: &self.triangles,
        }
    }
}

/// [`uniform`] without origins and without the mesh's connections: its vertices, triangles and
/// normals are those of [`uniform`], in the same order.
///
/// Connections are more than a third of a mesh's bytes, a quarter where it has normals. They are
/// not computed where the last levels are done together: on the limit surface of schemes of Loop's
/// family, where no semi-sharp tags are left and no sheets were cut apart. Elsewhere they are
/// computed for the steps, and dropped at the end.
///
/// ```
/// use limitmesh::Mesh;
/// use limitmesh::refine::{UniformOptions, uniform_triangles};
/// use limitmesh::scheme::Loop;
///
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let tetrahedron = Mesh::from_triangles(corners, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// let options = UniformOptions::default().levels(3).limit(true).normals(true);
/// let smooth = uniform_triangles(&tetrahedron, &Loop, &options)?;
/// assert_eq!((smooth.triangles.len(), smooth.normals.len()), (4 * 64, smooth.positions.len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// See [`RefineError`].
pub fn uniform_triangles(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &UniformOptions,
) -> Result<UniformTriangles, RefineError> {
    uniform_triangles_observed(mesh, scheme, options, &mut unobserved)
}

/// [`uniform_triangles`], with an observer.
///
/// # Errors
/// See [`RefineError`].
pub fn uniform_triangles_observed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &UniformOptions,
    observer: &mut Observer<'_>,
) -> Result<UniformTriangles, RefineError> {
    let options = options.origins(false);
    let Some(last) = LastLevels::of(mesh, scheme, &options)? else {
        let Refinement {
            mesh,
            normals,
            steps,
            stop,
            ..
        } = by_steps(mesh, scheme, &options, observer)?;
        return Ok(UniformTriangles::new(
            mesh.into_positions_and_triangles(),
            normals,
            steps.len(),
            stop,
        ));
    };
    let wanted = Wanted {
        normals: options.normals,
        connections: false,
    };
    let (found, _) = last.refined(mesh, wanted, observer)?;
    Ok(UniformTriangles::new(
        (found.positions, found.triangles),
        found.normals,
        last.end.levels,
        last.end.stop,
    ))
}

/// Level by level.
fn by_steps(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &UniformOptions,
    observer: &mut Observer<'_>,
) -> Result<Refinement, RefineError> {
    let UniformOptions {
        levels,
        limit,
        normals,
        origins,
        max_triangles,
    } = *options;
    let all = |mesh: &Mesh| Ok(vec![true; mesh.face_count()]);
    Driver {
        scheme,
        levels,
        limit,
        normals,
        origins,
        max_triangles,
    }
    .run(mesh, observer, all, |_, _| None)
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
                return Self {
                    levels: level,
                    stop: Stop::TriangleCap { needed },
                    too_many: 0,
                };
            }
            if needed > MAX_FACES {
                return Self {
                    levels: level,
                    stop: Stop::Levels,
                    too_many: needed,
                };
            }
            faces = needed;
        }
        Self {
            levels: options.levels,
            stop: Stop::Levels,
            too_many: 0,
        }
    }
}

/// How many of the last levels can be done together: none for other schemes and for quads, while there are
/// semi-sharp tags, where sheets were cut apart (whose copies of vertices the steps keep alike),
/// and at the first level, after which most faces are regular.
fn levels_together(mesh: &Mesh, rules: &Rules<'_>, levels: usize) -> usize {
    let is_of_triangles = !mesh.topology().has_quads();
    if !rules.is_certified() || !is_of_triangles || !mesh.junctions().is_empty() {
        return 0;
    }
    let first = levels
        .saturating_sub(MOST_TOGETHER)
        .max(1)
        .max(Sharpness::of(mesh).semi_sharp_levels());
    levels.saturating_sub(first)
}

/// Refinement whose last levels are done together.
struct LastLevels<'a> {
    rules: Rules<'a>,
    end: End,
    /// How many.
    together: usize,
}

impl<'a> LastLevels<'a> {
    /// `None` where steps are to do all levels.
    ///
    /// # Errors
    /// More faces than can be numbered.
    fn of(
        mesh: &Mesh,
        scheme: &'a dyn Scheme,
        options: &UniformOptions,
    ) -> Result<Option<Self>, RefineError> {
        // Levels that are done together leave no trace.
        if !options.limit || options.origins {
            return Ok(None);
        }
        let rules = Rules::of(scheme);
        let end = End::of(mesh.face_count(), options);
        let together = levels_together(mesh, &rules, end.levels);
        if together > 0 && end.too_many > 0 {
            let (what, count) = ("faces", end.too_many);
            return Err(MeshError::TooMany {
                what,
                count,
                limit: MAX_FACES,
            }
            .into());
        }
        Ok((together > 0).then_some(Self {
            rules,
            end,
            together,
        }))
    }

    /// The first levels by steps, then the last ones; with a report of each level.
    fn refined(
        &self,
        mesh: &Mesh,
        wanted: Wanted,
        observer: &mut Observer<'_>,
    ) -> Result<(AtLimit, Vec<StepReport>), RefineError> {
        let &Self {
            ref rules,
            ref end,
            together,
        } = self;
        let first = UniformOptions::default().levels(end.levels - together);
        let Refinement {
            mesh, mut steps, ..
        } = by_steps(mesh, rules.scheme(), &first, observer)?;
        let start = Clock::start();
        let mut watch = Watch::new(observer, Stage::Refining);
        watch.triangles(mesh.face_count());
        watch.stage(Stage::Refining, Some(end.levels))?;
        watch.done(end.levels - together)?;
        let found = limits::refined_at_limit(&mesh, rules, together, wanted, &mut watch)?;
        let mut faces = mesh.face_count();
        for step in end.levels - together + 1..=end.levels {
            let (faces_before, faces_after) = (faces, 4 * faces);
            // The time of levels that are done together is that of the last.
            let duration = if step == end.levels {
                start.elapsed()
            } else {
                Default::default()
            };
            let divisible = faces_before;
            steps.push(StepReport {
                step,
                faces_before,
                divisible,
                closure: [0; 4],
                faces_after,
                duration,
            });
            faces = faces_after;
        }
        watch.triangles(faces);
        watch.done(end.levels)?;
        if !stays_finite(&mesh) {
            check_finite(&found.positions)?;
        }
        Ok((found, steps))
    }
}

/// Whether no point of the limit surface can overflow. Points are combinations of control points by
/// weights whose absolute values sum to 1; the intermediate values, differences and coefficients of
/// quartics, are within some thousand times these, or at a vertex as many times as it has edges,
/// which are fewer than [`MAX_FACES`].
fn stays_finite(control: &Mesh) -> bool {
    const FAR: f64 = 1e290;
    control
        .positions()
        .as_flattened()
        .iter()
        .all(|x| x.abs() <= FAR)
}
