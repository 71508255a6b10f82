//! Several levels together, with all vertices on the limit surface: the mesh of the steps, by
//! arithmetic.
//!
//! Takes a mesh without semi-sharp tags and a number of levels; gives the refined mesh with its
//! vertices at their limits and, if requested, their limit normals and the triangles' connections.
//! Numbers of vertices and triangles follow from prefix sums over the faces (`grid.rs`), positions
//! and normals from the exact surface over each face (`pieces.rs`), and each face fills slots of
//! its own, so that the result does not depend on threads.

use core::ops::Range;

use limitmesh_pages::untouched_defaults;

use super::grid::{Grid, Numbering};
use super::pieces::{Pieces, Values};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::limit::SidedNormals;
use crate::mesh::{CreaseTag, Mesh, Sharpness, Tags};
use crate::parallel;
use crate::patch::Rules;
use crate::patch::submesh::submesh;
use crate::progress::{Cancelled, Watch};
use crate::refine::RefineError;
use crate::refine::tags::less_sharp;
use crate::vector::{unit_or_zero, vector};

/// Triangles that one block of work gives, about.
const BLOCK: usize = 1 << 14;

/// The data common to all faces.
struct Work<'a> {
    mesh: &'a Mesh,
    sharpness: &'a Sharpness<'a>,
    grid: &'a Grid,
    numbering: Numbering<'a>,
    pieces: Pieces<'a>,
    /// By the set of owned sides and the corner that comes first: where the values of the vertices that a face counts as its own stand.
    orders: Vec<[Vec<u16>; 3]>,
    wanted: Wanted,
}

/// The requested results, in addition to positions and triangles.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub(super) normals: bool,
    pub(super) connections: bool,
}

/// A mesh with its vertices on the limit surface.
pub(super) struct AtLimit {
    pub(super) triangles: Vec<[u32; 3]>,
    /// The twins of half-edges; empty if connections are not requested.
    pub(super) twins: Vec<u32>,
    /// The half-edge that each vertex keeps; empty likewise.
    pub(super) outgoing: Vec<u32>,
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) normals: Option<SidedNormals>,
    /// The tags of the mesh; none if connections are not requested.
    pub(super) tags: Tags,
}

/// The slots that a run of faces fills. Slots not requested are empty, here and in [`LevelSlots`].
struct Slots<'s> {
    faces: Range<usize>,
    triangles: &'s mut [[u32; 3]],
    twins: &'s mut [u32],
    levels: Vec<LevelSlots<'s>>,
}

/// The slots of the new vertices of one level.
struct LevelSlots<'s> {
    outgoing: &'s mut [u32],
    points: &'s mut [[f64; 3]],
    normals: &'s mut [[f64; 3]],
}

/// Refines a mesh of Loop's family without junctions, without semi-sharp tags, by `levels` levels,
/// and takes its vertices to the limit surface.
pub(super) fn refined_at_limit(
    mesh: &Mesh,
    rules: &Rules<'_>,
    levels: usize,
    wanted: Wanted,
    watch: &mut Watch<'_>,
) -> Result<AtLimit, RefineError> {
    let grid = Grid::new(levels)?;
    let sharpness = Sharpness::of(mesh);
    let numbering = Numbering::new(&grid, mesh.topology());
    let pieces = Pieces::new(mesh, &sharpness, rules, &grid);
    let orders = pieces.slots.orders(&grid);
    let work = Work {
        mesh,
        sharpness: &sharpness,
        grid: &grid,
        numbering,
        pieces,
        orders,
        wanted,
    };

    let vertices = work.numbering.vertex_count();
    let faces = mesh.face_count() << (2 * levels);
    let if_wanted = |is_wanted: bool, count: usize| if is_wanted { count } else { 0 };
    let mut triangles = untouched_defaults::<[u32; 3]>(faces);
    let mut twins = untouched_defaults::<u32>(if_wanted(wanted.connections, 3 * faces));
    let mut outgoing = untouched_defaults::<u32>(if_wanted(wanted.connections, vertices));
    let mut positions = untouched_defaults::<[f64; 3]>(vertices);
    let mut by_vertex = untouched_defaults::<[f64; 3]>(if_wanted(wanted.normals, vertices));
    let blocks = work.blocks(
        &mut triangles,
        &mut twins,
        &mut outgoing,
        &mut positions,
        &mut by_vertex,
    );
    let flat = parallel::each_polled(blocks, &mut |_| watch.poll(), |slots| work.fill(slots))?;
    for (outgoing, v) in outgoing.iter_mut().zip(mesh.topology().vertices()) {
        *outgoing = work.at_corner(mesh.topology().outgoing(v));
    }
    let corners = rules
        .table()
        .positions_polled(mesh, &mut |_| watch.poll())??;
    positions[..mesh.vertex_count()].copy_from_slice(&corners);
    watch.poll()?;
    let normals = match wanted.normals {
        true => Some(work.finished_normals(by_vertex, flat.concat(), rules, watch)?),
        false => None,
    };
    // A failure of general pieces, whose values mean nothing then.
    if let Some(why) = rules.failure() {
        return Err(why.clone().into());
    }
    let tags = if wanted.connections {
        work.tags()
    } else {
        Tags::default()
    };
    Ok(AtLimit {
        triangles,
        twins,
        outgoing,
        positions,
        normals,
        tags,
    })
}

impl<'a> Work<'a> {
    /// Cuts the arrays into runs of faces.
    fn blocks<'s>(
        &self,
        triangles: &'s mut [[u32; 3]],
        mut twins: &'s mut [u32],
        outgoing: &'s mut [u32],
        points: &'s mut [[f64; 3]],
        normals: &'s mut [[f64; 3]],
    ) -> Vec<Slots<'s>> {
        let (faces, each) = (self.mesh.face_count(), self.grid.triangles.len());
        let run = (BLOCK / each).max(1);
        let mut blocks: Vec<Slots<'s>> = triangles
            .chunks_mut(run * each)
            .enumerate()
            .map(|(i, triangles)| Slots {
                faces: i * run..((i + 1) * run).min(faces),
                twins: split_off(&mut twins, 3 * triangles.len()),
                triangles,
                levels: Vec::with_capacity(self.grid.levels),
            })
            .collect();
        let old = self.mesh.vertex_count();
        let (mut outgoing, mut points, mut normals) = (outgoing, points, normals);
        split_off(&mut outgoing, old);
        split_off(&mut points, old);
        split_off(&mut normals, old);
        for level in 1..=self.grid.levels {
            for block in &mut blocks {
                let Range { start, end } = block.faces;
                let count = self.numbering.before(level, end) - self.numbering.before(level, start);
                block.levels.push(LevelSlots {
                    outgoing: split_off(&mut outgoing, count),
                    points: split_off(&mut points, count),
                    normals: split_off(&mut normals, count),
                });
            }
        }
        debug_assert!(
            outgoing.is_empty() && points.is_empty() && normals.is_empty(),
            "each slot is some face's"
        );
        blocks
    }

    /// Fills a run of faces. Gives those with a vertex of their own that has no normal.
    fn fill(&self, slots: Slots<'_>) -> Vec<u32> {
        let grid = self.grid;
        let mut numbers = vec![0u32; grid.places.len()];
        let mut values = self.pieces.room(self.wanted.normals);
        let (mut twins, mut levels) = (slots.twins, slots.levels);
        let mut flat = Vec::new();
        let each = grid.triangles.len();
        for (face, triangles) in slots.faces.zip(slots.triangles.chunks_exact_mut(each)) {
            self.numbering.numbers(face, &mut numbers);
            for (triangle, local) in triangles.iter_mut().zip(&grid.triangles) {
                *triangle = local.map(|v| numbers[v as usize]);
            }
            if self.wanted.connections {
                self.numbering.twins(face, split_off(&mut twins, 3 * each));
            }
            let turn = self
                .pieces
                .evaluate(face, self.numbering.sides(face), &mut values);
            let first = self.numbering.first(face);
            let owned = self.numbering.of(face);
            let order = &self.orders[usize::from(self.numbering.sides(face))][turn];
            let mut is_flat = false;
            for (level, slots) in (1..).zip(&mut levels) {
                let own = owned.level(level);
                let (vertices, order) = (&owned.vertices[own.clone()], &order[own]);
                for (slot, &v) in split_off(&mut slots.outgoing, vertices.len())
                    .iter_mut()
                    .zip(vertices)
                {
                    *slot = first + grid.outgoing[v as usize];
                }
                for (slot, &at) in split_off(&mut slots.points, order.len())
                    .iter_mut()
                    .zip(order)
                {
                    *slot = values.points[at as usize];
                }
                for (slot, &at) in split_off(&mut slots.normals, order.len())
                    .iter_mut()
                    .zip(order)
                {
                    *slot = values.normals[at as usize];
                    is_flat |= *slot == [0.0; 3];
                }
            }
            if is_flat {
                flat.push(face as u32);
            }
        }
        debug_assert!(
            levels.iter().all(|left| left.points.is_empty()),
            "each slot is filled"
        );
        flat
    }

    /// The half-edge of the refined mesh that leaves the corner which `h` leaves, along `h`.
    fn at_corner(&self, h: HalfEdgeId) -> u32 {
        self.numbering.first(h.face().index()) + self.grid.borders[h.corner()][0]
    }

    /// The normals with those of old vertices, both sides of sharp edges, and the replacements
    /// where there is no tangent plane. `flat` are faces with such corners.
    fn finished_normals(
        &self,
        mut by_vertex: Vec<[f64; 3]>,
        mut flat: Vec<u32>,
        rules: &Rules<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<SidedNormals, RefineError> {
        let topology = self.mesh.topology();
        let old = rules
            .table()
            .plane_normals(self.mesh, &mut |_| watch.poll())??;
        by_vertex[..self.mesh.vertex_count()].copy_from_slice(old.by_vertex());
        let mut normals = SidedNormals::new(by_vertex);
        for &(h, normal) in old.sides() {
            normals.add_side(
                topology.origin(h),
                [HalfEdgeId(self.at_corner(h))].into_iter(),
                normal,
            );
        }
        for &(h, _) in old.sides().iter().filter(|(_, normal)| *normal == [0.0; 3]) {
            normals.by_vertex_mut()[topology.origin(h).index()] = [0.0; 3];
        }
        let without = |v: &VertexId| normals.by_vertex()[v.index()] == [0.0; 3];
        let corners = topology.vertices().filter(without);
        flat.extend(
            corners
                .flat_map(|v| topology.outgoing_ring(v))
                .map(|h| h.face().0),
        );
        self.add_creases(&mut normals, &mut flat, watch)?;
        let mut normals = normals.finished();
        if !flat.is_empty() {
            flat.sort_unstable();
            flat.dedup();
            self.add_averages(&mut normals, &flat, rules, watch)?;
        }
        Ok(normals)
    }

    /// Sharp edges have a normal on each side, and their vertices the average of both.
    fn add_creases(
        &self,
        normals: &mut SidedNormals,
        flat: &mut Vec<u32>,
        watch: &mut Watch<'_>,
    ) -> Result<(), Cancelled> {
        let topology = self.mesh.topology();
        if self.sharpness.is_empty() {
            return Ok(());
        }
        let mut rooms = [self.pieces.room(true), self.pieces.room(true)];
        let mut numbers = vec![0u32; self.grid.places.len()];
        for h in topology.half_edges() {
            let Some(twin) = topology
                .twin(h)
                .filter(|&twin| h < twin && self.sharpness.edge(h) > 0.0)
            else {
                continue;
            };
            watch.poll()?;
            self.numbering.numbers(h.face().index(), &mut numbers);
            let on_edge = &self.grid.on_sides[h.corner()];
            let sides = [h, twin].map(|side| self.grid.borders[side.corner()].as_slice());
            let [near, far] = &mut rooms;
            let [near, far] = [self.along(h, near), self.along(twin, far)];
            for (i, &v) in on_edge.iter().enumerate() {
                let number = numbers[v as usize];
                // Seen from the other side the vertices come in the other order.
                let j = on_edge.len() - 1 - i;
                let both = [near[i], far[j]];
                let by_vertex = normals.by_vertex_mut();
                if both.contains(&[0.0; 3]) {
                    by_vertex[number as usize] = [0.0; 3];
                    flat.extend([h.face().0, twin.face().0]);
                } else {
                    by_vertex[number as usize] =
                        unit_or_zero(vector(both[0]) + vector(both[1])).to_array();
                }
                for (side, (normal, rim)) in [h, twin]
                    .into_iter()
                    .zip(both.into_iter().zip([sides[0][i + 1], sides[1][j + 1]]))
                {
                    let first = self.numbering.first(side.face().index());
                    let leaving = self
                        .grid
                        .leaving(rim)
                        .map(|local| HalfEdgeId(first + local));
                    normals.add_side(VertexId(number), leaving, normal);
                }
            }
        }
        Ok(())
    }

    /// The normals of a face at the vertices inside the side of `h`, in its order.
    fn along(&self, h: HalfEdgeId, values: &mut Values) -> Vec<[f64; 3]> {
        let turn = self
            .pieces
            .evaluate(h.face().index(), 1 << h.corner(), values);
        let places = &self.pieces.slots.turned[turn];
        let vertices = self.grid.on_sides[h.corner()].iter();
        vertices
            .map(|&v| values.normals[places[v as usize] as usize])
            .collect()
    }

    /// Where there is no tangent plane, the average of the normals of faces: of those that the steps give.
    fn add_averages(
        &self,
        normals: &mut SidedNormals,
        flat: &[u32],
        rules: &Rules<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), RefineError> {
        let seeds: Vec<HalfEdgeId> = flat
            .iter()
            .map(|&face| HalfEdgeId::of(FaceId(face), 0))
            .collect();
        let around = submesh(self.mesh, self.sharpness, &seeds, 1);
        let options = super::UniformOptions::default().levels(self.grid.levels);
        let around =
            super::uniform_observed(&around, rules.scheme(), &options, &mut watch.observer())?.mesh;
        let averages = rules
            .table()
            .sided_normals_polled(&around, &mut |_| watch.poll())??;
        let mut numbers = vec![0u32; self.grid.places.len()];
        let half_edges = self.grid.half_edge_count();
        for (place, &face) in flat.iter().enumerate() {
            self.numbering.numbers(face as usize, &mut numbers);
            for (&number, &local) in numbers.iter().zip(&self.grid.outgoing) {
                let normal = &mut normals.by_vertex_mut()[number as usize];
                if *normal == [0.0; 3] {
                    let vertex = around
                        .topology()
                        .origin(HalfEdgeId((place * half_edges) as u32 + local));
                    *normal = averages.by_vertex()[vertex.index()];
                }
            }
        }
        for (h, normal) in normals
            .sides_mut()
            .filter(|(_, normal)| **normal == [0.0; 3])
        {
            let (face, local) = (h.index() / half_edges, h.index() % half_edges);
            if let Ok(place) = flat.binary_search(&(face as u32)) {
                *normal = averages.at(
                    around.topology(),
                    HalfEdgeId((place * half_edges + local) as u32),
                );
            }
        }
        Ok(())
    }

    /// The tags: each crease goes to the edges along it.
    fn tags(&self) -> Tags {
        let (tags, topology) = (self.mesh.tags(), self.mesh.topology());
        let sharpness = |start: f64| {
            (0..self.grid.levels).try_fold(start, |sharpness, _| less_sharp(sharpness))
        };
        let mut numbers = vec![0u32; self.grid.places.len()];
        let mut refined = Tags::default();
        for crease in &tags.creases {
            let [a, b] = crease.vertices;
            let (Some(h), Some(sharpness)) = (
                topology.edge_between(VertexId(a), VertexId(b)),
                sharpness(crease.sharpness),
            ) else {
                continue;
            };
            self.numbering.numbers(h.face().index(), &mut numbers);
            let inside = self.grid.on_sides[h.corner()]
                .iter()
                .map(|&v| numbers[v as usize]);
            let [from, to] = topology.ends(h).map(|v| v.0);
            let mut along: Vec<u32> = [from].into_iter().chain(inside).chain([to]).collect();
            if from != a {
                along.reverse();
            }
            refined.creases.extend(along.windows(2).map(|w| CreaseTag {
                vertices: [w[0], w[1]],
                sharpness,
            }));
        }
        let corners = tags
            .corners
            .iter()
            .filter_map(|corner| Some((corner, sharpness(corner.sharpness)?)));
        refined.corners = corners
            .map(|(corner, sharpness)| crate::mesh::CornerTag {
                sharpness,
                ..*corner
            })
            .collect();
        refined
    }
}

/// Takes the first elements off a slice; none off an empty one.
fn split_off<'s, T>(rest: &mut &'s mut [T], count: usize) -> &'s mut [T] {
    let all = core::mem::take(rest);
    let (first, after) = all.split_at_mut(if all.is_empty() { 0 } else { count });
    *rest = after;
    first
}
