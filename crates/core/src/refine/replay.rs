//! Replay: a refinement's vertices on the limit surfaces of other positions of its control mesh, such as the frames of an animation.
//!
//! Takes a control mesh and a refinement of it; gives a table of weights, and with it, for any
//! positions of the control vertices, all positions and normals of the refined mesh, each on the
//! true limit surface of these; the triangles are unchanged. Stencils do this for uniform
//! refinement; here faces whose surroundings are alike share their weights, and where many vertices
//! are on one polynomial (Stam, "Evaluation of Loop Subdivision Surfaces", 1998), that is found
//! once and evaluated.

mod build;
mod table;
mod wanted;
mod weights;

use super::exact_result::Exact;
use crate::error_messages;
use crate::limit::LimitError;
use crate::mesh::{Groups, Mesh, MeshError, Sharpness, check_finite};
use crate::parallel::Cancelled;
use crate::patch::Rules;
use crate::patch::large_rings::LargeRings;
use crate::progress::{Observer, Stage, Watch, unobserved};
use crate::scheme::Scheme;
use crate::vector::{DVec3, vector};
use build::{Control, build};
use table::{LANES, Table, average};
use wanted::Wants;

/// An error of a replay.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReplayError {
    /// The surface is not made of polynomials.
    Scheme {
        /// Its name.
        scheme: String,
    },
    /// The origins of the vertices are not known.
    NoOrigins {
        /// Origins that are known.
        origins: usize,
        /// Vertices of the refined mesh.
        vertices: usize,
    },
    /// A vertex came from no place of the control mesh, or its place on a side of a sharp edge is not known.
    Elsewhere {
        /// The vertex of the refined mesh.
        vertex: u32,
    },
    /// A place over a control face is on no polynomial.
    NoPolynomial {
        /// The control face, or one like it.
        face: u32,
    },
    /// A frame does not fit the control mesh.
    Frame {
        /// Its number, from 0.
        frame: usize,
        /// The cause.
        why: MeshError,
    },
    /// A frame's surface needs too many triangles.
    TooMany {
        /// Its number, from 0.
        frame: usize,
        /// Triangles that there may be.
        most: usize,
    },
    /// More weights than can be numbered.
    TooLarge,
    /// Positions are not those of the control mesh's vertices.
    Mesh(MeshError),
    /// A limit position does not exist.
    Limit(LimitError),
    /// The observer asked to stop.
    Cancelled(Cancelled),
}

error_messages! {
    ReplayError {
        Self::Scheme { scheme } => ("the scheme {scheme:?} is none of those whose surfaces are made of polynomials, which a replay needs"),
        Self::NoOrigins { origins, vertices } => ("{origins} origins for {vertices} vertices: a replay needs a refinement with origins"),
        Self::Elsewhere { vertex } => ("vertex {vertex} has no place in the control mesh: a replay needs a refinement of that mesh, without flat regions"),
        Self::NoPolynomial { face } => ("the limit surface over control face {face} is on no polynomial"),
        Self::Frame { frame, why } => ("frame {frame}: {why}"),
        Self::TooMany { frame, most } => ("frame {frame} would take more than {most} triangles"),
        Self::TooLarge => ("the table would be too large"),
    }
    from { Mesh(MeshError), Limit(LimitError), Cancelled(Cancelled) }
}

/// The data that compute a refinement's vertices for other positions of the control vertices.
///
/// ```
/// use limitmesh::refine::{ExactOptions, Frame, Replay, exact};
/// use limitmesh::{Mesh, scheme::Loop};
///
/// let mesh = Mesh::from_triangles(
///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
/// )?;
/// let refined = exact(&mesh, &Loop, &ExactOptions::default().tolerance(1e-3).flat_regions(false))?;
/// let replay = Replay::new(&mesh, &Loop, &refined)?;
///
/// // The control mesh moves; the triangles stay.
/// let mut moved = mesh.positions().to_vec();
/// moved[0][2] += 0.5;
/// let mut frame = Frame::default();
/// replay.frame(&moved, &mut frame)?;
/// assert_eq!(frame.positions.len(), refined.mesh.vertex_count());
/// let refined = refined.moved_to(&frame)?;
/// assert!(refined.mesh.as_triangles().diagonal() > 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Replay {
    table: Table,
    control_vertices: usize,
    /// The vertices around control vertices of very many edges, whose means count as points.
    rings: Groups,
    /// Half-edges adjacent to sharp edges, and the slots of their normals.
    sides: Vec<(u32, u32)>,
    /// Vertices with several sides, and the slots of these.
    averages: Vec<(u32, Vec<u32>)>,
    /// Copies of vertices of cut sheets.
    copies: Groups,
}

/// The vertices of a refined mesh for some positions of the control vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Points of the limit surface, by the refined mesh's vertices.
    pub positions: Vec<[f64; 3]>,
    /// Unit limit normals; see [`Exact::normals`].
    pub normals: Vec<[f64; 3]>,
    /// Normals by side; see [`Exact::sides`].
    pub sides: Vec<(u32, [f64; 3])>,
    /// Memory that is used again.
    slots: [Vec<[f64; 3]>; 2],
    inputs: Vec<[f64; LANES]>,
}

impl Replay {
    /// Prepares a replay of `refined`, a refinement of `control`: with
    /// [origins](super::ExactOptions::origins), and without
    /// [flat regions](super::ExactOptions::flat_regions), which bend when the control mesh does.
    /// The positions of `control` are ignored. Vertices that were moved off the surface, to
    /// [balance](super::Finish::Balanced) its distance, are on it in every frame.
    ///
    /// # Errors
    /// A scheme whose surfaces are not made of polynomials, a refinement whose vertices have no origins in the control
    /// mesh, or a vertex without a limit.
    pub fn new(control: &Mesh, scheme: &dyn Scheme, refined: &Exact) -> Result<Self, ReplayError> {
        Self::new_observed(control, scheme, refined, &mut unobserved)
    }

    /// [`Self::new`] with an observer.
    ///
    /// # Errors
    /// Those of [`Self::new`], or the observer asked to stop.
    pub fn new_observed(
        control: &Mesh,
        scheme: &dyn Scheme,
        refined: &Exact,
        observer: &mut Observer<'_>,
    ) -> Result<Self, ReplayError> {
        let rules = Rules::of(scheme);
        if !rules.is_certified() {
            return Err(ReplayError::Scheme {
                scheme: scheme.name().to_owned(),
            });
        }
        let (sharpness, large) = (Sharpness::of(control), LargeRings::of(control));
        let stencils = rules.table().vertex_stencils(control)?;
        let wants = Wants::of(control, &stencils, refined)?;
        let known = Control {
            mesh: control,
            sharpness: &sharpness,
            large: &large,
            rules: &rules,
            stencils: &stencils,
        };
        let mut watch = Watch::new(observer, Stage::Weighing);
        watch.triangles(refined.mesh.face_count());
        let (mut table, slots) = build(&known, &wants, &mut watch)?;
        let count = refined.mesh.vertex_count();
        let slot = |spot: u32| slots[spot as usize];
        table.slots = slots[..count].to_vec();
        let mut rings = Groups::default();
        large
            .vertices()
            .for_each(|vertex| rings.push(control.topology().ring(vertex).map(|v| v.0)));
        let averages = wants.averages.into_iter();
        Ok(Self {
            table,
            control_vertices: control.vertex_count(),
            rings,
            sides: wants
                .sides
                .into_iter()
                .map(|(h, spot)| (h, slot(spot)))
                .collect(),
            averages: averages
                .map(|(vertex, spots)| (vertex, spots.into_iter().map(slot).collect()))
                .collect(),
            copies: refined.mesh.junctions().vertices.clone(),
        })
    }

    /// The positions and normals of the refined mesh, given those of the control vertices. The
    /// bytes of the results depend neither on the number of threads nor on the previous contents of
    /// `frame`.
    ///
    /// # Errors
    /// Not as many positions as control vertices, or a coordinate that is not finite.
    pub fn frame(&self, control: &[[f64; 3]], frame: &mut Frame) -> Result<(), ReplayError> {
        self.fill(control, frame, true)?;
        let [_, normals] = &frame.slots;
        frame.normals.resize(self.table.slots.len(), [0.0; 3]);
        self.table.take(normals, &mut frame.normals);
        for (vertex, slots) in &self.averages {
            frame.normals[*vertex as usize] =
                average(slots.iter().map(|&slot| normals[slot as usize]));
        }
        frame.sides.clear();
        frame.sides.extend(
            self.sides
                .iter()
                .map(|&(h, slot)| (h, normals[slot as usize])),
        );
        Ok(())
    }

    /// [`Self::frame`] without normals, which are unchanged.
    ///
    /// # Errors
    /// Those of [`Self::frame`].
    pub fn positions(&self, control: &[[f64; 3]], frame: &mut Frame) -> Result<(), ReplayError> {
        self.fill(control, frame, false)
    }

    fn fill(
        &self,
        control: &[[f64; 3]],
        frame: &mut Frame,
        with_normals: bool,
    ) -> Result<(), ReplayError> {
        if control.len() != self.control_vertices {
            return Err(MeshError::Broken {
                place: format!(
                    "{} positions for {} control vertices",
                    control.len(),
                    self.control_vertices
                ),
                what: "one position for each control vertex is needed",
            }
            .into());
        }
        check_finite(control)?;
        let means = self.rings.iter().map(|ring| mean(ring, control));
        frame.inputs.clear();
        frame.inputs.extend(
            control
                .iter()
                .copied()
                .chain(means)
                .map(|[x, y, z]| [x, y, z, 0.0]),
        );
        let [positions, normals] = &mut frame.slots;
        positions.resize(self.table.slot_count(), [0.0; 3]);
        normals.resize(self.table.slot_count(), [0.0; 3]);
        let normals = if with_normals {
            &mut normals[..]
        } else {
            &mut []
        };
        self.table.fill(&frame.inputs, positions, normals);
        frame.positions.resize(self.table.slots.len(), [0.0; 3]);
        self.table.take(positions, &mut frame.positions);
        super::junctions::join_copies(&mut frame.positions, &self.copies);
        Ok(())
    }

    /// Bytes of the data kept between frames.
    pub fn table_bytes(&self) -> usize {
        let of_groups = |groups: &Groups| {
            groups
                .iter()
                .map(|group| 4 * (group.len() + 1))
                .sum::<usize>()
        };
        let averages = self
            .averages
            .iter()
            .map(|(_, slots)| size_of::<(u32, Vec<u32>)>() + 4 * slots.len());
        self.table.bytes()
            + size_of_val(&self.sides[..])
            + averages.sum::<usize>()
            + of_groups(&self.rings)
            + of_groups(&self.copies)
    }
}

/// The mean of some positions.
fn mean(ring: &[u32], positions: &[[f64; 3]]) -> [f64; 3] {
    let sum: DVec3 = ring.iter().map(|&v| vector(positions[v as usize])).sum();
    (sum / ring.len() as f64).to_array()
}

impl Exact {
    /// The triangles with the vertices of a frame. Nothing is proven of them: the bounds are
    /// infinite, and the other reports are those of the refinement.
    ///
    /// # Errors
    /// The frame is that of another mesh, or a coordinate is not finite.
    pub fn moved_to(mut self, frame: &Frame) -> Result<Self, MeshError> {
        if frame.normals.len() != self.normals.len() || frame.sides.len() != self.sides.len() {
            return Err(MeshError::Broken {
                place: format!(
                    "{} normals and {} on sides",
                    frame.normals.len(),
                    frame.sides.len()
                ),
                what: "a frame has the normals of the mesh that it was made from",
            });
        }
        self.mesh = self.mesh.with_positions(frame.positions.clone())?;
        self.normals.clone_from(&frame.normals);
        self.sides.clone_from(&frame.sides);
        self.error = super::ErrorBounds {
            lower: 0.0,
            upper: f64::INFINITY,
            certified: false,
            at: [0.0; 3],
        };
        self.pixels = self.pixels.map(|_| f64::INFINITY);
        self.attribute_bounds.fill(f64::INFINITY);
        Ok(self)
    }
}
