//! Makes the table of a replay.
//!
//! Takes the points on the surface; gives the jobs in the order of their faces' shapes, so that
//! shared weights are near, and the slots of the points.

use std::collections::HashMap;

use super::ReplayError;
use super::table::{COEFFICIENTS, Job, LANES, Piece, SUMS, Table, WHOLE, groups};
use super::wanted::{EvalPoint, Wants};
use super::weights::{ParamPoint, Probe, Standing, Wanted};
use crate::index::{FaceId, VertexId};
use crate::limit::{VertexStencil, VertexStencils};
use crate::mesh::{Mesh, Sharpness};
use crate::parallel::{self, Cancelled};
use crate::patch::large_rings::LargeRings;
use crate::patch::{Rules, Support};
use crate::progress::{Stage, Watch};

/// Places on one polynomial from which its coefficients are worth while, by measurement: they take as long as five places by rows,
/// and with them a place takes half as long, but where there are fewer, rows are shared by more faces.
const MANY: usize = 20;

/// Faces whose supports are found together.
const FACES: usize = 256;

/// Shapes whose weights are found together, and blocks of these at most: each probes a mesh of its own.
const SHAPES: usize = 16;
const MOST_BLOCKS: usize = 64;

/// The control mesh, and all that is known of it.
pub(super) struct Control<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) sharpness: &'a Sharpness<'a>,
    pub(super) large: &'a LargeRings,
    pub(super) rules: &'a Rules<'a>,
    pub(super) stencils: &'a VertexStencils<'a>,
}

/// A face with places, or a corner with sides.
struct Group {
    /// The face or the vertex.
    of: u32,
    /// Each with the number of its point.
    points: Vec<u32>,
}

/// A face of a shape.
struct Member {
    group: usize,
    support: Support,
    /// Its places, by their numbers among those of the shape, in the order of its points.
    places: Vec<u32>,
}

/// The faces whose surfaces are the same function of their control points.
struct Shape {
    /// One at least.
    members: Vec<Member>,
    /// The places of all, each once.
    places: Vec<ParamPoint>,
}

/// Weights of a shape, and the rows that its members use.
struct Weighed {
    weights: Vec<[f64; LANES]>,
    members: Vec<MemberRows>,
}

/// The rows that a face uses of the weights of its shape.
#[derive(Default)]
struct MemberRows {
    /// Where rows start, with their points.
    rows: Vec<(u32, u32)>,
    pieces: Vec<MemberPiece>,
}

/// A polynomial of a face.
struct MemberPiece {
    /// Where the weights of its coefficients start.
    weights: u32,
    /// With their points.
    places: Vec<([u16; 2], u32)>,
}

/// The table without vertices' slots, and the slots of all points.
pub(super) fn build(
    control: &Control<'_>,
    wants: &Wants,
    watch: &mut Watch<'_>,
) -> Result<(Table, Vec<u32>), ReplayError> {
    let (mut corners, faces) = groups_of(&wants.points);
    // Corners with one stencil follow each other: they have equal weights and an equal number of
    // points.
    corners.sort_by_key(|corner| control.stencils.by_vertex[corner.of as usize]);
    let mut building = Building {
        table: Table::default(),
        slots: vec![0; wants.points.len()],
        next: 0,
    };
    building.corners(control, &corners, &wants.points)?;
    let shapes = shapes(control, &faces, &wants.points, watch)?;
    watch.stage(Stage::Weighing, Some(shapes.len()))?;
    let length = shapes.len().div_ceil(MOST_BLOCKS).max(SHAPES);
    let weighed = parallel::long_pieces_polled(
        shapes.len(),
        length,
        &mut |done| watch.done(done),
        |block, is_stopped| {
            let mut probe = Probe::new(
                control.mesh,
                control.sharpness,
                control.large,
                control.rules,
            );
            let weigh = |shape: usize| weigh(&mut probe, &shapes[shape], &faces);
            block
                .take_while(|_| !is_stopped())
                .map(weigh)
                .collect::<Vec<_>>()
        },
    )?;
    for (shape, weighed) in shapes.iter().zip(weighed.into_iter().flatten()) {
        let face = || faces[shape.members[0].group].of;
        building.shape(
            shape,
            weighed.ok_or_else(|| ReplayError::NoPolynomial { face: face() })?,
        )?;
    }
    if let Some(why) = control.rules.failure() {
        return Err(why.clone().into());
    }
    building.table.finish();
    Ok((building.table, building.slots))
}

/// The points at control vertices and those over faces, by vertex and face.
fn groups_of(points: &[EvalPoint]) -> (Vec<Group>, Vec<Group>) {
    let (mut corners, mut faces) = (Vec::new(), Vec::new());
    for (number, point) in (0u32..).zip(points) {
        match *point {
            EvalPoint::Corner(vertex, _) => corners.push((vertex, number)),
            EvalPoint::Over(face, _) => faces.push((face, number)),
        }
    }
    let grouped = |mut all: Vec<(u32, u32)>| {
        all.sort_unstable();
        let own = all.chunk_by(|a, b| a.0 == b.0);
        own.map(|own| Group {
            of: own[0].0,
            points: own.iter().map(|&(_, point)| point).collect(),
        })
        .collect()
    };
    (grouped(corners), grouped(faces))
}

/// The faces by the shape of their surface's support, shapes in the order of their first faces.
fn shapes(
    control: &Control<'_>,
    faces: &[Group],
    points: &[EvalPoint],
    watch: &mut Watch<'_>,
) -> Result<Vec<Shape>, Cancelled> {
    let supports = parallel::pieces_polled(faces.len(), FACES, &mut |_| watch.poll(), |block| {
        let of = |face: usize| {
            Support::of(
                control.mesh,
                control.sharpness,
                control.large,
                FaceId(faces[face].of),
            )
        };
        block.map(of).collect::<Vec<_>>()
    })?;
    let mut shapes: Vec<Shape> = Vec::new();
    let mut known: HashMap<Vec<u32>, usize> = HashMap::new();
    let mut numbers: Vec<HashMap<[u64; 2], u32>> = Vec::new();
    for (group, mut support) in supports.into_iter().flatten().enumerate() {
        let at = *known
            .entry(core::mem::take(&mut support.key))
            .or_insert_with(|| {
                shapes.push(Shape {
                    members: Vec::new(),
                    places: Vec::new(),
                });
                numbers.push(HashMap::new());
                shapes.len() - 1
            });
        let shape = &mut shapes[at];
        let places = faces[group].points.iter().map(|&point| {
            let EvalPoint::Over(_, bits) = points[point as usize] else {
                return 0;
            };
            let [u, v] = EvalPoint::place(bits);
            let weights = [1.0 - u - v, u, v];
            let place = [
                weights[(support.turn + 1) % 3],
                weights[(support.turn + 2) % 3],
            ];
            *numbers[at]
                .entry(place.map(f64::to_bits))
                .or_insert_with(|| {
                    shape.places.push(place);
                    shape.places.len() as u32 - 1
                })
        });
        let places = places.collect();
        shape.members.push(Member {
            group,
            support,
            places,
        });
    }
    Ok(shapes)
}

/// The weights of a shape; `None` where a place is on no polynomial.
fn weigh(probe: &mut Probe<'_>, shape: &Shape, faces: &[Group]) -> Option<Weighed> {
    let first = shape.members.first()?;
    let face = FaceId(faces[first.group].of);
    let (standing, pieces) = probe.standing(&first.support, face, &shape.places)?;
    let mut rows = vec![None; shape.places.len()];
    let mut blocks = vec![None; pieces as usize];
    let (mut row_count, mut block_count) = (0u32, 0u32);
    let mut members = Vec::with_capacity(shape.members.len());
    for member in &shape.members {
        let mut own: Vec<(Standing, u32, u32)> = member
            .places
            .iter()
            .zip(&faces[member.group].points)
            .map(|(&place, &point)| (standing[place as usize], place, point))
            .collect();
        own.sort_by_key(|(standing, ..)| standing.piece);
        let mut taken = MemberRows::default();
        for on_piece in own.chunk_by(|a, b| a.0.piece == b.0.piece) {
            let coded = on_piece
                .iter()
                .map(|(standing, _, point)| Some((coded(standing.at)?, *point)));
            let coded = if on_piece.len() < MANY || !probe.has_quartics() {
                None
            } else {
                coded.collect::<Option<Vec<_>>>()
            };
            match coded {
                Some(places) => {
                    let block = &mut blocks[on_piece[0].0.piece as usize];
                    let weights = *block.get_or_insert_with(|| next(&mut block_count));
                    taken.pieces.push(MemberPiece { weights, places });
                }
                None => taken.rows.extend(on_piece.iter().map(|&(_, place, point)| {
                    (
                        *rows[place as usize].get_or_insert_with(|| next(&mut row_count)),
                        point,
                    )
                })),
            }
        }
        members.push(taken);
    }
    let wanted = Wanted {
        support: &first.support,
        face,
        places: &shape.places,
        rows: &rows,
        pieces: &blocks,
    };
    let weights = probe.weights(&wanted);
    // From numbers to starts.
    let groups = groups(first.support.points.len()) as u32;
    for member in &mut members {
        member
            .rows
            .iter_mut()
            .for_each(|(row, _)| *row *= SUMS as u32 * groups);
        for piece in &mut member.pieces {
            piece.weights =
                (row_count * SUMS as u32 + piece.weights * COEFFICIENTS as u32) * groups;
        }
    }
    Some(Weighed { weights, members })
}

fn next(count: &mut u32) -> u32 {
    *count += 1;
    *count - 1
}

/// A place in whole steps, if it is one of these.
fn coded(at: ParamPoint) -> Option<[u16; 2]> {
    let steps = at.map(|weight| weight * WHOLE);
    let is_whole = steps
        .iter()
        .all(|&step| step.fract() == 0.0 && (0.0..=WHOLE).contains(&step));
    is_whole.then(|| steps.map(|step| step as u16))
}

/// A table that is being made.
struct Building {
    table: Table,
    /// By point.
    slots: Vec<u32>,
    /// The next slot.
    next: u32,
}

impl Building {
    /// Adds weights; gives where they start.
    fn weights(&mut self, weights: &[[f64; LANES]]) -> Result<u32, ReplayError> {
        let start = self.table.weights.len();
        self.table.weights.extend_from_slice(weights);
        let is_small = self.table.weights.len() <= u32::MAX as usize;
        if is_small {
            Ok(start as u32)
        } else {
            Err(ReplayError::TooLarge)
        }
    }

    fn points(&mut self, points: &[u32]) -> Result<u32, ReplayError> {
        self.table.points.extend_from_slice(points);
        let Some(&first) = points.first() else {
            return Ok(0);
        };
        let full = 1 + LANES * groups(points.len());
        self.table
            .points
            .extend(core::iter::repeat_n(first, full - points.len()));
        let is_small = self.table.points.len() <= u32::MAX as usize;
        if is_small {
            Ok(points.len() as u32)
        } else {
            Err(ReplayError::TooLarge)
        }
    }

    fn take_slot(&mut self, point: u32) {
        self.slots[point as usize] = self.next;
        self.next += 1;
    }

    /// The jobs of control vertices.
    fn corners(
        &mut self,
        control: &Control<'_>,
        corners: &[Group],
        eval_points: &[EvalPoint],
    ) -> Result<(), ReplayError> {
        // Where the weights of each side of each stencil start.
        let mut starts: Vec<Option<Vec<u32>>> = vec![None; control.stencils.list.len()];
        for corner in corners {
            let number = control.stencils.by_vertex[corner.of as usize] as usize;
            let starts = match &mut starts[number] {
                Some(known) => known,
                unknown => unknown.insert(self.stencil(&control.stencils.list[number])?),
            };
            let points = control.stencils.points(VertexId(corner.of));
            let points = self.points(&points)?;
            // Points of one side share its slot.
            let mut slots: Vec<(u32, u32)> = Vec::new();
            for &point in &corner.points {
                let EvalPoint::Corner(_, side) = eval_points[point as usize] else {
                    continue;
                };
                if let Some(&(_, slot)) = slots.iter().find(|&&(known, _)| known == side) {
                    self.slots[point as usize] = slot;
                    continue;
                }
                self.table.rows.push(starts[side as usize]);
                slots.push((side, self.next));
                self.take_slot(point);
            }
            self.table.jobs.push(Job {
                points,
                rows: slots.len() as u32,
                pieces: 0,
            });
        }
        self.table.corner_jobs = self.table.jobs.len();
        self.table.sides.sort_unstable_by_key(|&(start, _)| start);
        Ok(())
    }

    /// The weights of a control vertex's sides; gives where they start.
    fn stencil(&mut self, stencil: &VertexStencil) -> Result<Vec<u32>, ReplayError> {
        let groups = groups(stencil.position.len());
        let mut starts = Vec::with_capacity(stencil.sides.len());
        for side in &stencil.sides {
            let mut weights = vec![[0.0; LANES]; SUMS * groups];
            let of_position = stencil.position[1..].iter().copied();
            let tangents =
                [0, 1].map(|tangent| side.tangents.iter().map(move |weights| weights[tangent]));
            let [first, second] = tangents;
            for (i, weight) in of_position.enumerate() {
                weights[i / LANES][i % LANES] = weight;
            }
            for (sum, tangent) in [(1, first), (2, second)] {
                for (i, weight) in tangent.enumerate() {
                    weights[sum * groups + i / LANES][i % LANES] = weight;
                }
            }
            let start = self.weights(&weights)?;
            self.table.sides.push((
                start,
                [side.first, side.faces, stencil.edges].map(|n| n as u32),
            ));
            starts.push(start);
        }
        Ok(starts)
    }

    /// The jobs of the faces of a shape.
    fn shape(&mut self, shape: &Shape, weighed: Weighed) -> Result<(), ReplayError> {
        let start = self.weights(&weighed.weights)?;
        for (member, taken) in shape.members.iter().zip(weighed.members) {
            let points = self.points(&member.support.points)?;
            let (rows, pieces) = (taken.rows.len() as u32, taken.pieces.len() as u32);
            self.table.jobs.push(Job {
                points,
                rows,
                pieces,
            });
            for (row, point) in taken.rows {
                self.table.rows.push(start + row);
                self.take_slot(point);
            }
            for MemberPiece { weights, places } in taken.pieces {
                self.table.pieces.push(Piece {
                    weights: start + weights,
                    places: places.len() as u32,
                });
                for (place, point) in places {
                    self.table.places.push(place);
                    self.take_slot(point);
                }
            }
        }
        Ok(())
    }
}
