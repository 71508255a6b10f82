//! Uniform √3-subdivision: step after step, and the limits of the result.

use super::masks::DoubleStep;
use super::origins::Origins;
use super::sharp_edges::SharpEdges;
use super::step::Level;
use crate::clock::Clock;
use crate::index::{HalfEdgeId, VertexId};
use crate::limit::{LimitTable, SidedNormals, TangentPlane};
use crate::mesh::{Mesh, Sharpness, check_finite};
use crate::progress::{Observer, Stage, Watch, unobserved};
use crate::refine::{RefineError, Refinement, StepReport, Stop, UniformOptions};

/// Refines `mesh` by steps of √3-subdivision, each of which gives three times as many triangles.
///
/// [`UniformOptions::levels`] counts single steps. Old vertices keep their numbers; the three
/// triangles of a triangle's half-edges are adjacent in the order. Infinitely sharp edges are
/// treated as boundaries of both sides.
///
/// # Errors
/// A semi-sharp tag ([`RefineError::FadingTag`]), or an error of [`crate::refine::uniform`].
pub fn uniform(mesh: &Mesh, options: &UniformOptions) -> Result<Refinement, RefineError> {
    uniform_observed(mesh, options, &mut unobserved)
}

/// [`uniform`] with an observer.
///
/// # Errors
/// Those of [`uniform`], or the observer asked to stop.
pub fn uniform_observed(
    mesh: &Mesh,
    options: &UniformOptions,
    observer: &mut Observer<'_>,
) -> Result<Refinement, RefineError> {
    let mut watch = Watch::new(observer, Stage::Refining);
    watch.triangles(mesh.face_count());
    watch.stage(Stage::Refining, Some(options.levels))?;
    let mut level = Level::control(mesh)?;
    let mut origins = options.origins.then(|| Origins::of(mesh));
    let (mut steps, mut stop) = (Vec::new(), Stop::Levels);
    for step in 1..=options.levels {
        let start = Clock::start();
        let faces_before = level.mesh.face_count();
        let needed = faces_before.saturating_mul(3);
        if options.max_triangles.is_some_and(|cap| needed > cap) {
            stop = Stop::TriangleCap { needed };
            break;
        }
        level = level.step(origins.as_mut(), &mut watch)?;
        let (faces_after, duration) = (level.mesh.face_count(), start.elapsed());
        let closure = [0; 4];
        steps.push(StepReport {
            step,
            faces_before,
            divisible: faces_before,
            closure,
            faces_after,
            duration,
        });
        watch.triangles(faces_after);
        watch.done(step)?;
    }
    let (limits, normals) = match (options.limit, options.normals) {
        (false, false) => (None, None),
        (positions, normals) => limits(&level, positions, normals, &mut watch)?,
    };
    let mesh = match limits {
        Some(positions) => level.mesh.with_positions(positions)?,
        None => level.mesh,
    };
    check_finite(mesh.positions())?;
    let (origins, parents) = origins.map(Origins::finish).unwrap_or_default();
    Ok(Refinement {
        mesh,
        normals,
        origins,
        parents,
        steps,
        stop,
    })
}

type Limits = (Option<Vec<[f64; 3]>>, Option<SidedNormals>);

/// Limit positions and normals of the vertices of a level, as far as requested.
fn limits(
    level: &Level,
    positions: bool,
    normals: bool,
    watch: &mut Watch<'_>,
) -> Result<Limits, RefineError> {
    watch.stage(Stage::Limits, Some(level.mesh.vertex_count()))?;
    let table = LimitTable::new(&DoubleStep);
    // The rings of two steps are those of an even level; without sharp edges, all levels have such
    // rings.
    let has_curves =
        level.mesh.topology().boundary_edge_count() > 0 || !level.mesh.tags().creases.is_empty();
    let even = if level.is_odd() && has_curves {
        Some(level.step(None, watch)?.mesh)
    } else {
        None
    };
    let mesh = even.as_ref().unwrap_or(&level.mesh);
    let count = level.mesh.vertex_count();
    let positions = match positions {
        true => Some(table.positions_polled(mesh, &mut |done| watch.done(done.min(count)))??),
        false => None,
    };
    let positions = positions.map(|mut all| {
        all.truncate(count);
        all
    });
    let normals = match (normals, &even) {
        (false, _) => None,
        (true, None) => Some(table.sided_normals_polled(mesh, &mut |done| watch.done(done))??),
        (true, Some(even)) => Some(odd_normals(&level.mesh, even, &table, watch)?),
    };
    Ok((positions, normals))
}

/// The limit normals of an odd level by those of the `even` one after it.
fn odd_normals(
    mesh: &Mesh,
    even: &Mesh,
    table: &LimitTable<'_>,
    watch: &mut Watch<'_>,
) -> Result<SidedNormals, RefineError> {
    let (count, sharp) = (mesh.vertex_count(), SharpEdges::of(mesh)?);
    let finer = table.sided_normals_polled(even, &mut |done| watch.done(done.min(count)))??;
    let mut normals = SidedNormals::new(finer.by_vertex()[..count].to_vec());
    let topology = mesh.topology();
    for h in topology.half_edges().filter(|_| !sharp.is_empty()) {
        // The face that a smooth half-edge gives leaves from its origin, on the same side of creases; and of the two at a corner of
        // a face of an odd level one is smooth.
        let smooth = if sharp.is_sharp(h) {
            topology.twin(h.previous())
        } else {
            Some(h)
        };
        let normal = smooth.map(|h| finer.at(even.topology(), HalfEdgeId(3 * h.0)));
        let vertex = topology.origin(h);
        if let Some(normal) = normal.filter(|&normal| normal != finer.by_vertex()[vertex.index()]) {
            normals.add_side(vertex, core::iter::once(h), normal);
        }
    }
    Ok(normals.finished())
}

/// Limit position of every vertex of a control mesh under √3-subdivision.
///
/// # Errors
/// A semi-sharp tag, or a vertex without a limit.
pub fn limit_positions(mesh: &Mesh) -> Result<Vec<[f64; 3]>, RefineError> {
    SharpEdges::of(mesh)?;
    Ok(LimitTable::new(&DoubleStep).positions(mesh)?)
}

/// Unit limit normals of a control mesh under √3-subdivision, one for each side of its sharp edges.
///
/// # Errors
/// A semi-sharp tag, or a vertex without a limit.
pub fn limit_normals(mesh: &Mesh) -> Result<SidedNormals, RefineError> {
    SharpEdges::of(mesh)?;
    Ok(LimitTable::new(&DoubleStep).sided_normals(mesh)?)
}

/// The span of the limit tangents of a vertex: the tangent plane of the surface, or less where it
/// has none.
///
/// # Errors
/// A semi-sharp tag, or a ring without a limit.
pub fn tangent_plane(mesh: &Mesh, vertex: VertexId) -> Result<Vec<TangentPlane>, RefineError> {
    SharpEdges::of(mesh)?;
    let ring = Sharpness::of(mesh).ring(vertex);
    let stencil = LimitTable::new(&DoubleStep).sharp_stencil(&ring)?;
    Ok(stencil
        .sides()
        .iter()
        .map(|side| side.tangent_plane())
        .collect())
}
