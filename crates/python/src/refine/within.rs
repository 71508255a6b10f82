//! The smoothest mesh near the input: its control mesh, and how far the result is from what was given.

use limitmesh::Mesh;
use limitmesh::mesh::FaceParts;
use limitmesh::progress::Observer;
use limitmesh::refine::{
    Exact, ExactOptions, InputDistance, Origin, WithinOptions, turned_over_triangles,
    within_observed,
};

use super::Refined;
use crate::control::{Control, Recipe};
use crate::errors::Failure;
use crate::options::{Extent, Goals};

/// How near the input a result has to be.
pub(super) struct Near {
    within: f64,
    tolerance: f64,
    /// The mesh that was given, before faces were divided and vertices moved.
    input: Mesh,
}

impl Near {
    /// Makes a control mesh the smoothest that is so near.
    ///
    /// # Errors
    /// The observer asked to stop, or the scheme has no limit there.
    pub(super) fn of(
        control: &mut Control,
        within: Extent,
        (recipe, goals): (&Recipe, &Goals),
        observer: &mut Observer<'_>,
    ) -> Result<Self, Failure> {
        let within = within.of(control.diagonal);
        let tolerance = WithinOptions::usual_tolerance(within, control.diagonal);
        let mut options = WithinOptions::default()
            .within(within)
            .tolerance(Some(tolerance));
        if let Some(cap) = goals.max_triangles {
            options = options.max_triangles(Some(cap));
        }
        let found = within_observed(&control.mesh, recipe.scheme, &options, observer)?;
        let before = std::mem::replace(&mut control.mesh, found.control);
        for channel in &mut control.channels {
            *channel = channel.on_parts(&found.parts, &control.mesh);
        }
        control.tables.parts = found.parts.after(&control.tables.parts);
        Ok(Self {
            within,
            tolerance,
            input: control.whole.take().unwrap_or(before),
        })
    }

    /// What refinement is asked therefore.
    pub(super) fn asked_of(&self, options: ExactOptions) -> ExactOptions {
        options
            .tolerance(self.tolerance)
            .flat_regions(false)
            .origins(true)
    }

    /// How far a result is from the input.
    ///
    /// # Errors
    /// Coordinates too large to be measured, or the observer asked to stop.
    pub(super) fn distance(
        &self,
        found: &Exact,
        parts: &FaceParts,
        observer: &mut Observer<'_>,
    ) -> Result<InputDistance, Failure> {
        let on_whole = |origin: &Origin| {
            let (face, barycentric) = parts.on_whole(origin.face, origin.barycentric);
            Origin { face, barycentric }
        };
        let origins: Vec<Origin> = found.origins.iter().map(on_whole).collect();
        let input = self.input.as_triangles();
        match InputDistance::new(input, found, &origins, 0.0)? {
            Some(distance) => {
                Ok(distance.decided([input, found.mesh.as_triangles()], self.within, observer)?)
            }
            None => Err(Failure::Option(
                "triangles reach over several faces of the input".to_owned(),
            )),
        }
    }

    /// How many triangles of a result are turned over.
    pub(super) fn inverted(&self, found: &Exact, parts: &FaceParts) -> usize {
        turned_over_triangles(self.input.as_triangles(), found, parts)
    }

    /// Puts down how far it is, and where that is too far.
    pub(super) fn tell(&self, distance: InputDistance, refined: &mut Refined) {
        refined.input_distance = Some((distance.lower, distance.upper));
        if refined.stop == "met" && distance.upper > self.within {
            refined.stop = "input-distance";
        }
    }
}
