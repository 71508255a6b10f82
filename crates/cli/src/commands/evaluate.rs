//! `limitmesh evaluate`: points, normals, derivatives and curvature of the limit surface over places of its control faces.

use std::path::Path;

use anyhow::{Context, bail};
use limitmesh::{FaceId, LimitSurface, SurfacePoint};

use super::limit_control;
use crate::arguments::{EvaluateArguments, Place, Places};
use crate::failure::Outcome;
use crate::format::{counted, number, point, table};
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::report::EvaluationReport;
use crate::rows::rows;

/// Evaluates places, and prints what was found in their order.
pub(crate) fn run(arguments: &EvaluateArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    let files = arguments.at.iter().filter_map(|at| match at {
        Places::File(path) => Some(path),
        Places::One(_) => None,
    });
    input::check_once(core::iter::once(&arguments.control).chain(files))?;
    let places: Vec<Place> = arguments
        .at
        .iter()
        .map(places)
        .collect::<anyhow::Result<Vec<_>>>()?
        .concat();
    let (input, limit) = limit_control::load(&arguments.control, &arguments.limit, progress)?;
    let name = input.name.clone();
    let prepared = limit_control::prepared(input, &limit, progress)?;
    let (mesh, faces) = (&prepared.input.mesh, prepared.face_inputs());
    if !faces.iter().zip(0..).all(|(&face, own)| face == own) {
        let count = counted(mesh.face_count(), "triangle", "triangles");
        progress.note(format!(
            "{name}: places are on the {count} of the control mesh, which are not the file's faces; --json names these as input_face"
        ));
    }
    if let Some(place) = places
        .iter()
        .find(|place| place.face as usize >= mesh.face_count())
    {
        let count = counted(mesh.face_count(), "triangle", "triangles");
        bail!(
            "{name}: there is no face {}: the control mesh has {count}, counted from 0",
            place.face
        );
    }
    progress.stage(format!(
        "evaluating {}",
        counted(places.len(), "place", "places")
    ));
    let surface = LimitSurface::new(mesh, limit.scheme().scheme()).with_context(|| name.clone())?;
    let at: Vec<(FaceId, [f64; 3])> = places
        .iter()
        .map(|place| (FaceId(place.face), place.weights))
        .collect();
    let (points, derivatives) = (surface.at_all(&at), surface.derivatives_at(&at));
    if let Some(error) = surface.failure() {
        bail!("{name}: {error}");
    }
    let found = places.into_iter().zip(points).zip(derivatives);
    let report = |((place, limits), derivatives): ((Place, SurfacePoint), _)| {
        let tangents = surface.tangents_at_corner(FaceId(place.face), place.weights);
        EvaluationReport::new(
            place,
            faces[place.face as usize],
            limits,
            tangents,
            derivatives,
        )
    };
    let reports: Vec<EvaluationReport> = found.map(report).collect();
    progress.clear();
    output::print(&if arguments.json {
        output::json(&reports)?
    } else {
        in_words(&reports)
    })?;
    Ok(Outcome::Done)
}

/// The places that were given at once.
fn places(given: &Places) -> anyhow::Result<Vec<Place>> {
    let path = match given {
        Places::One(place) => return Ok(vec![*place]),
        Places::File(path) => path,
    };
    let text = if path == Path::new("-") {
        std::io::read_to_string(std::io::stdin())
    } else {
        std::fs::read_to_string(path)
    };
    let text = text.with_context(|| {
        format!(
            "'{}' is no place FACE,W0,W1,W2, and cannot be read as a file of places",
            path.display()
        )
    })?;
    let places = rows(&text).map(|(row, line)| {
        line.parse()
            .map_err(|what| anyhow::anyhow!("{}: line {row}: {what}", path.display()))
    });
    let places = places.collect::<anyhow::Result<Vec<Place>>>()?;
    if places.is_empty() {
        bail!(
            "{} has no places; give one a line: FACE W0 W1 W2",
            path.display()
        );
    }
    Ok(places)
}

fn in_words(reports: &[EvaluationReport]) -> String {
    let mut rows = vec![
        [
            "face",
            "weights",
            "point",
            "normal",
            "Gaussian",
            "mean",
            "principal",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    let none = || "-".to_owned();
    rows.extend(reports.iter().map(|report| {
        let curvature = report.curvature.as_ref();
        vec![
            report.face.to_string(),
            report.barycentric.map(number).join(", "),
            point(report.point),
            report.normal.map_or_else(none, point),
            curvature.map_or_else(none, |curvature| number(curvature.gaussian)),
            curvature.map_or_else(none, |curvature| number(curvature.mean)),
            curvature.map_or_else(none, |curvature| curvature.principal.map(number).join(", ")),
        ]
    }));
    table(&rows)
}
