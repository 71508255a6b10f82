//! Which materials a surface has where: a colour for each part, and perhaps a texture that lies on it.

use limitmesh::Triangles;

use crate::RenderError;
use crate::check::{check_count, check_finite};
use crate::colour::Linear;
use crate::texture::Texture;

/// What a part of a surface looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Red, green and blue that it sends back of white light, in linear light from 0 to 1; multiplies the texture's colour.
    pub colour: [f32; 3],
    /// The texture; without one the colour alone is seen.
    pub texture: Option<Texture>,
}

/// Which materials a surface has where, and how textures lie on it.
#[derive(Clone, Copy, Debug)]
pub struct Covering<'a> {
    /// All materials.
    pub materials: &'a [Material],
    /// By triangle the number of its material; one that is none of them stands for the style's own colours.
    pub of_triangle: &'a [u32],
    /// Texture coordinates of the triangles' corners, three a triangle: u to the right and v upwards, from 0 to 1 over the texture.
    pub corners: &'a [[f64; 2]],
}

impl Covering<'_> {
    pub(crate) fn check(&self, surface: Triangles<'_>) -> Result<(), RenderError> {
        let faces = surface.triangles.len();
        check_count("materials of triangles", self.of_triangle.len(), faces)?;
        check_count(
            "texture coordinates of corners",
            self.corners.len(),
            3 * faces,
        )?;
        check_finite("texture coordinate", self.corners)
    }

    /// The colour at a point of a triangle; `steps` is how its barycentric coordinates change from pixel to pixel. `None` without a
    /// material.
    pub(crate) fn colour(
        &self,
        triangle: u32,
        weights: [f64; 3],
        steps: [[f64; 3]; 2],
    ) -> Option<Linear> {
        let material = self
            .materials
            .get(self.of_triangle[triangle as usize] as usize)?;
        let own = material.colour.map(|channel| channel.clamp(0.0, 1.0));
        let Some(texture) = &material.texture else {
            return Some(own);
        };
        let corners = &self.corners[3 * triangle as usize..][..3];
        let mixed = |weights: [f64; 3]| {
            [0, 1].map(|axis| {
                corners
                    .iter()
                    .zip(weights)
                    .map(|(corner, weight)| corner[axis] * weight)
                    .sum()
            })
        };
        let seen = texture.mean(mixed(weights), steps.map(mixed));
        Some([0, 1, 2].map(|channel| own[channel] * seen[channel]))
    }
}
