//! The vertices of an asset's file: what they carry, and what moves them.

use limitmesh::Mesh;
use limitmesh::mesh::{Channel, FaceParts, Semantic};
use limitmesh::refine::Origin;
use limitmesh_io::gltf::VertexAttribute;

use super::weights::{Joints, MOST_JOINTS};

/// Where a refined mesh came from on its control mesh; nothing where nobody asked.
#[derive(Default)]
pub(super) struct Trail {
    /// Of the vertices.
    pub(super) origins: Vec<Origin>,
    /// The control face of each triangle, of several one.
    pub(super) parents: Vec<u32>,
    /// After collapses, where triangles reach over several control faces: of corners on edges that tell sides apart, ascending.
    pub(super) sides: Option<Vec<(u32, Origin)>>,
}

impl Trail {
    /// Where a triangle's corner at a vertex came from, on its triangle's side of edges.
    fn of(
        &self,
        (triangle, corner): (usize, usize),
        vertex: u32,
        control: &[[u32; 3]],
    ) -> Option<Origin> {
        let origin = self.origins[vertex as usize];
        let Some(sides) = &self.sides else {
            return origin.in_face(control, self.parents[triangle]);
        };
        let own =
            sides.binary_search_by_key(&((3 * triangle + corner) as u32), |&(corner, _)| corner);
        Some(own.map_or(origin, |at| sides[at].1))
    }
}

/// Triangles' corners as points of the input's faces.
pub(super) struct Carried<'a> {
    pub(super) trail: &'a Trail,
    /// The control mesh's faces, and where these are in those of the mesh that was read.
    pub(super) control: &'a [[u32; 3]],
    pub(super) parts: &'a FaceParts,
    /// By face of the mesh that was read, the input's face, and by corner, the input's vertex.
    pub(super) faces: &'a [u32],
    pub(super) vertices: &'a [u32],
}

impl Carried<'_> {
    /// The input's face of a triangle.
    pub(super) fn input(&self, triangle: usize) -> usize {
        self.faces[self.parts.whole(self.trail.parents[triangle]) as usize] as usize
    }

    /// Where a triangle's corner, which is at a vertex, came from on the control mesh.
    pub(super) fn control_place(
        &self,
        triangle: usize,
        corner: usize,
        vertex: u32,
    ) -> Option<Origin> {
        self.trail.of((triangle, corner), vertex, self.control)
    }

    /// What a triangle's corner, which is at a vertex, is of the vertices of the input's face.
    pub(super) fn place(
        &self,
        triangle: usize,
        corner: usize,
        vertex: u32,
    ) -> Option<[(u32, f64); 3]> {
        let own = self.control_place(triangle, corner, vertex)?;
        let (whole, weights) = self.parts.on_whole(own.face, own.barycentric);
        Some([0, 1, 2].map(|corner| (self.vertices[3 * whole as usize + corner], weights[corner])))
    }

    /// What moves the control mesh's vertices, given what moves the input's: joints with weights that add up to 1, where there are any.
    /// Vertices on divided faces are moved as the points are where they stand.
    pub(super) fn influences(
        &self,
        control: &Mesh,
        input: &[Vec<(u32, f64)>],
    ) -> Vec<Vec<(u32, f64)>> {
        let mut lists = vec![Vec::new(); control.vertex_count()];
        let mut is_met = vec![false; lists.len()];
        for (corner, &v) in control.triangles().as_flattened().iter().enumerate() {
            if std::mem::replace(&mut is_met[v as usize], true) {
                continue;
            }
            let own = std::array::from_fn(|i| if i == corner % 3 { 1.0 } else { 0.0 });
            let (whole, shares) = self.parts.on_whole((corner / 3) as u32, own);
            let list: &mut Vec<(u32, f64)> = &mut lists[v as usize];
            for (i, share) in shares
                .into_iter()
                .enumerate()
                .filter(|&(_, share)| share > 0.0)
            {
                let input = &input[self.vertices[3 * whole as usize + i] as usize];
                let total: f64 = input.iter().map(|&(_, weight)| weight).sum();
                for &(joint, weight) in input {
                    let weight = share * (weight / total);
                    match list.iter_mut().find(|(own, _)| *own == joint) {
                        Some((_, sum)) => *sum += weight,
                        None => list.push((joint, weight)),
                    }
                }
            }
        }
        lists
    }
}

/// The vertices of a file: one for each vertex of a surface and each combination of values there.
pub(super) struct Vertices<'a> {
    channels: &'a [&'a Channel],
    /// By vertex of the surface, the first of the file's; and by these the next of the same.
    first: Vec<u32>,
    next: Vec<u32>,
    /// By vertex of the mesh, what moves it, if anything does.
    moving: Option<&'a [Joints]>,
    /// What the file's vertices have.
    attributes: Vec<VertexAttribute>,
    joints: Vec<f64>,
    weights: Vec<f64>,
}

/// No vertex.
const NONE: u32 = u32::MAX;

impl<'a> Vertices<'a> {
    /// None yet, for a surface with so many vertices.
    pub(super) fn new(
        channels: &'a [&'a Channel],
        moving: Option<&'a [Joints]>,
        count: usize,
    ) -> Self {
        let empty = |channel: &&Channel| VertexAttribute {
            name: channel.name.clone(),
            width: channel.arity,
            values: Vec::new(),
            is_integer: channel.semantic == Semantic::Label,
        };
        let attributes = channels.iter().map(empty).collect();
        let (joints, weights) = (Vec::new(), Vec::new());
        Self {
            channels,
            first: vec![NONE; count],
            next: Vec::new(),
            moving,
            attributes,
            joints,
            weights,
        }
    }

    /// All attributes, when there are no more vertices.
    pub(super) fn into_attributes(self) -> Vec<VertexAttribute> {
        let mut all = self.attributes;
        if self.moving.is_some() {
            let width = MOST_JOINTS;
            let joints = VertexAttribute {
                name: "JOINTS_0".to_owned(),
                width,
                values: self.joints,
                is_integer: true,
            };
            let weights = VertexAttribute {
                name: "WEIGHTS_0".to_owned(),
                width,
                values: self.weights,
                is_integer: false,
            };
            all.extend([joints, weights]);
        }
        all
    }

    /// The file's vertex for a corner of the surface at a vertex, which is one of the mesh; a new one has the next number.
    pub(super) fn number(&mut self, v: u32, corner: usize, of_mesh: u32) -> u32 {
        let new = self.next.len() as u32;
        // As if it were new, until a vertex with these values is found.
        for (channel, attribute) in self.channels.iter().zip(&mut self.attributes) {
            attribute.values.extend_from_slice(channel.value(corner));
        }
        let mut known = self.first[v as usize];
        let mut last = NONE;
        while known != NONE {
            if self
                .attributes
                .iter()
                .all(|attribute| is_same(attribute, known, new))
            {
                for attribute in &mut self.attributes {
                    attribute.values.truncate(new as usize * attribute.width);
                }
                return known;
            }
            (last, known) = (known, self.next[known as usize]);
        }
        match last {
            NONE => self.first[v as usize] = new,
            last => self.next[last as usize] = new,
        }
        self.next.push(NONE);
        for (joint, weight) in self
            .moving
            .iter()
            .flat_map(|moving| moving[of_mesh as usize])
        {
            self.joints.push(f64::from(joint));
            self.weights.push(weight);
        }
        new
    }
}

/// Whether two vertices have the same value in a file.
fn is_same(attribute: &VertexAttribute, a: u32, b: u32) -> bool {
    let width = attribute.width;
    let of = |v: u32| {
        attribute.values[v as usize * width..][..width]
            .iter()
            .map(|&x| x as f32)
    };
    of(a).eq(of(b))
}
