//! The step before refinement that makes the limit surface pass through the vertices: what it does, and what is said of it.

use limitmesh::Mesh;
use limitmesh::interpolate::{
    InterpolateOptions, Interpolated, InterpolationMethod, interpolate_observed,
};
use limitmesh::part::{FoldedRegion, Unfolded, interpolate_unfolded_observed};
use limitmesh::scheme::Scheme;

use crate::arguments::{InterpolationArguments, Unit};
use crate::format::{counted, number, point, upper_bound};
use crate::progress::Progress;
use crate::report::{InterpolationReport, percent};

/// The control mesh whose limit surface passes through the vertices of `mesh`, if that is asked for, and what is reported of it.
///
/// # Errors
/// Some vertex has no limit, or none that is near enough.
pub(super) fn apply(
    mesh: Mesh,
    arguments: InterpolationArguments,
    unit: Option<Unit>,
    scheme: &dyn Scheme,
    progress: &Progress,
) -> anyhow::Result<(Mesh, Option<InterpolationReport>)> {
    let diagonal = mesh.diagonal();
    let Some(within) = arguments.within(diagonal, unit)? else {
        return Ok((mesh, None));
    };
    if arguments.is_of_part {
        let Unfolded {
            interpolated,
            folded,
            ..
        } = interpolate_unfolded_observed(&mesh, scheme, &mut progress.observer())?;
        if let Some(largest) = folded.first() {
            progress.note(folded_in_words(&interpolated, folded.len(), largest));
        }
        let report = InterpolationReport::new(&interpolated, within, diagonal, folded.len());
        return Ok((interpolated.mesh, Some(report)));
    }
    let options = InterpolateOptions::default().within(within);
    let found = interpolate_observed(&mesh, scheme, &options, &mut progress.observer())?;
    progress.note(in_words(&found, within, diagonal));
    let report = InterpolationReport::new(&found, within, diagonal, 0);
    Ok((found.mesh, Some(report)))
}

/// Where the surface of a part misses vertices, because through them it would fold.
fn folded_in_words(found: &Interpolated, regions: usize, largest: &FoldedRegion) -> String {
    let vertices = counted(found.relaxed.len(), "vertex", "vertices");
    let faces = counted(largest.faces.len(), "face", "faces");
    let [low, high] = largest.bounding_box.map(point);
    let largest = if regions == 1 {
        "it has"
    } else {
        "the largest has"
    };
    format!(
        "the surface misses {vertices}: through them it would fold in {}; {largest} {faces}, from {low} to {high}",
        counted(regions, "region", "regions")
    )
}

fn in_words(found: &Interpolated, within: f64, diagonal: f64) -> String {
    let relaxed = found.relaxed.len();
    let mut vertices = counted(found.mesh.vertex_count() - relaxed, "vertex", "vertices");
    if relaxed > 0 {
        let others = counted(relaxed, "vertex", "vertices");
        vertices +=
            &format!(", and by {others} next to much longer edges of sharp lines and boundaries");
    }
    let percent = percent(found.displacement, diagonal.max(f64::MIN_POSITIVE));
    let moved = format!(
        "control points moved by up to {} ({} %, vertex {})",
        number(found.displacement),
        number(percent),
        found.most_displaced.index()
    );
    match found.method {
        InterpolationMethod::Unchanged => {
            format!("the limit surface passes through {vertices} as it is")
        }
        InterpolationMethod::LeastSquares => format!(
            "no control points let the limit surface pass through {vertices}: by least squares it passes within {}; {moved}",
            upper_bound(found.residual)
        ),
        _ if within > 0.0 => {
            format!(
                "the limit surface passes within {} of {vertices}: {moved}",
                number(found.residual)
            )
        }
        _ => format!("the limit surface passes through {vertices}: {moved}"),
    }
}
