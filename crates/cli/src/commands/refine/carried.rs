//! The vertices of an asset's file: what they carry, and what moves them, which is linear on each face of the input.

use limitmesh::mesh::{Channel, FaceParts, Semantic};
use limitmesh::refine::Origin;
use limitmesh_io::gltf::VertexAttribute;

/// Triangles' corners as points of the input's faces.
pub(super) struct Carried<'a> {
    /// Of the vertices of the refined mesh.
    pub(super) origins: &'a [Origin],
    /// The control face of each triangle.
    pub(super) parents: &'a [u32],
    /// The control mesh's faces, and where these are in those of the mesh that was read.
    pub(super) control: &'a [[u32; 3]],
    pub(super) parts: &'a FaceParts,
    /// By face of the mesh that was read, the input's face, and by corner, the input's vertex.
    pub(super) faces: &'a [u32],
    pub(super) vertices: &'a [u32],
}

/// Vertices of the input with the weights that a point has of them.
pub(super) type Mixture = [(u32, f64); 3];

impl Carried<'_> {
    /// The input's face of a triangle.
    pub(super) fn input(&self, triangle: usize) -> usize {
        self.faces[self.parts.whole(self.parents[triangle]) as usize] as usize
    }

    /// What a triangle's corner at a vertex is of the vertices of the input's face.
    pub(super) fn place(&self, triangle: usize, vertex: u32) -> Option<Mixture> {
        let parent = self.parents[triangle];
        let own = self.origins[vertex as usize].in_face(self.control, parent)?;
        let (whole, weights) = self.parts.on_whole(parent, own.barycentric);
        Some([0, 1, 2].map(|corner| (self.vertices[3 * whole as usize + corner], weights[corner])))
    }
}

/// The vertices of a file: one for each vertex of a surface and each combination of values there.
pub(super) struct Vertices<'a> {
    channels: &'a [&'a Channel],
    /// By vertex of the surface, the first of the file's; and by these the next of the same.
    first: Vec<u32>,
    next: Vec<u32>,
    /// By vertex of the input's soup, what moves it, if that is carried along.
    influences: Option<&'a [Vec<(u32, f64)>]>,
    /// What the file's vertices have.
    attributes: Vec<VertexAttribute>,
    joints: Vec<f64>,
    weights: Vec<f64>,
}

/// Joints at most that move a vertex of a file: more are not read by everyone.
const MOST_JOINTS: usize = 4;

/// No vertex.
const NONE: u32 = u32::MAX;

impl<'a> Vertices<'a> {
    /// None yet, for a surface with so many vertices.
    pub(super) fn new(
        channels: &'a [&'a Channel],
        influences: Option<&'a [Vec<(u32, f64)>]>,
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
        Self { channels, first: vec![NONE; count], next: Vec::new(), influences, attributes, joints, weights }
    }

    /// Whether places are asked for.
    pub(super) fn need_places(&self) -> bool {
        self.influences.is_some()
    }

    /// All attributes, when there are no more vertices.
    pub(super) fn into_attributes(self) -> Vec<VertexAttribute> {
        let mut all = self.attributes;
        if self.influences.is_some() {
            let width = MOST_JOINTS;
            let joints =
                VertexAttribute { name: "JOINTS_0".to_owned(), width, values: self.joints, is_integer: true };
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

    /// The file's vertex for a corner of the surface at a vertex, which is at a place of the input's; a new one has the next number.
    /// Without a place nothing moves it.
    pub(super) fn number(&mut self, v: u32, corner: usize, place: Option<Mixture>) -> u32 {
        let new = self.next.len() as u32;
        // As if it were new, until a vertex with these values is found.
        for (channel, attribute) in self.channels.iter().zip(&mut self.attributes) {
            attribute.values.extend_from_slice(channel.value(corner));
        }
        let mut known = self.first[v as usize];
        let mut last = NONE;
        while known != NONE {
            if self.attributes.iter().all(|attribute| is_same(attribute, known, new)) {
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
        if let Some(influences) = self.influences {
            for (joint, weight) in mixed(influences, place.unwrap_or_default()) {
                self.joints.push(f64::from(joint));
                self.weights.push(weight);
            }
        }
        new
    }
}

/// The joints that move a point of a face most, with weights that are linear between those of its corners and then add up to 1; ties by
/// joint.
fn mixed(influences: &[Vec<(u32, f64)>], mut place: Mixture) -> [(u32, f64); MOST_JOINTS] {
    // By vertices, so that faces that share a point agree to the bit.
    place.sort_unstable_by_key(|&(vertex, _)| vertex);
    let mut all: Vec<(u32, f64)> = Vec::new();
    for (vertex, share) in place.into_iter().filter(|&(_, share)| share > 0.0) {
        for &(joint, weight) in &influences[vertex as usize] {
            match all.iter_mut().find(|(own, _)| *own == joint) {
                Some((_, sum)) => *sum += share * weight,
                None => all.push((joint, share * weight)),
            }
        }
    }
    all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    all.truncate(MOST_JOINTS);
    let total: f64 = all.iter().map(|&(_, weight)| weight).sum();
    let mut result = [(0, 0.0); MOST_JOINTS];
    for (place, (joint, weight)) in result.iter_mut().zip(all) {
        *place = (joint, weight / total);
    }
    result
}

/// Whether two vertices have the same value in a file.
fn is_same(attribute: &VertexAttribute, a: u32, b: u32) -> bool {
    let width = attribute.width;
    let of = |v: u32| attribute.values[v as usize * width..][..width].iter().map(|&x| x as f32);
    of(a).eq(of(b))
}
