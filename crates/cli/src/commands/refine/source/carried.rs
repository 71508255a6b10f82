//! Where the corners of refined triangles are on the input's faces, and what moves the control mesh's vertices.

use limitmesh::Mesh;
use limitmesh::mesh::FaceParts;
use limitmesh::refine::Origin;

use super::super::control::Control;
use super::super::refined::Refined;
use super::super::trail::Trail;

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

impl<'a> Carried<'a> {
    /// The corners of a refined mesh; `vertices` has the input's vertex by corner of the mesh that was read.
    pub(super) fn new(control: &'a Control, refined: &'a Refined, vertices: &'a [u32]) -> Self {
        Self {
            trail: &refined.trail,
            control: control.mesh.triangles(),
            parts: &control.concave.parts,
            faces: &control.faces,
            vertices,
        }
    }

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
        self.trail.corner(triangle, corner, vertex, self.control)
    }

    /// The weights of the input's vertices at a triangle's corner, which is at a vertex.
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

    /// The joints of the control mesh's vertices, given those of the input's: joints with weights that add up to 1, where there are any.
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
            let shares = shares.into_iter().enumerate();
            for (i, share) in shares.filter(|&(_, share)| share > 0.0) {
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
