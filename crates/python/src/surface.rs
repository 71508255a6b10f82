//! Points, derivatives and curvature of the limit surface at places of its control faces; which way it looks over whole faces.

use limitmesh::criterion::Viewpoint;
use limitmesh::{FaceId, Facing, LimitSurface, PolygonSoup, barycentric};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::control::{Control, Recipe};
use crate::errors::{Failure, OptionError};
use crate::options::ControlOptions;
use crate::run::run;
use crate::soup::MeshIn;
use crate::tell;

/// What is not there, in rows of three.
const NONE: [f64; 3] = [f64::NAN; 3];

/// Rows for places: positions, normals, two tangents, two first and three second derivatives each, two principal directions each; and Gaussian
/// curvature, mean curvature, the greatest and the least, in rows of four.
type Told<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
);

#[derive(Default)]
struct Found {
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    tangents: Vec<[f64; 3]>,
    first: Vec<[f64; 3]>,
    second: Vec<[f64; 3]>,
    directions: Vec<[f64; 3]>,
    curvatures: Vec<f64>,
}

/// The limit surface at places given by triangles of the input and weights of their corners; NaN for what is not there.
#[pyfunction]
pub(crate) fn limit_surface<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    faces: PyReadonlyArray1<'py, i64>,
    weights: PyReadonlyArray2<'py, f64>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Told<'py>> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let places = places(faces.as_slice()?, weights.as_slice()?, soup.faces.len())?;
    let found = run(py, threads, progress, move |observer| {
        let corners = triangles(&soup);
        let control = recipe.control(soup, observer)?;
        check(&control, corners.as_deref())?;
        let surface = LimitSurface::new(&control.mesh, recipe.scheme)?;
        let (points, derivatives) = (surface.at_all(&places), surface.derivatives_at(&places));
        if let Some(error) = surface.failure() {
            return Err(Failure::Mesh(error.to_string()));
        }
        let mut found = Found::default();
        for ((&(face, weights), point), derivatives) in places.iter().zip(points).zip(derivatives) {
            let limit = Some(point.normal).filter(|normal| *normal != [0.0; 3]);
            let curvature = derivatives.and_then(|derivatives| derivatives.curvature());
            let normal = derivatives
                .and_then(|derivatives| derivatives.normal())
                .or(limit);
            found
                .positions
                .push(derivatives.map_or(point.position, |derivatives| derivatives.position));
            found.normals.push(normal.unwrap_or(NONE));
            let own = derivatives.and_then(|derivatives| derivatives.tangents());
            let tangents = own.or_else(|| surface.tangents_at_corner(face, weights));
            found.tangents.extend(tangents.unwrap_or([NONE; 2]));
            found
                .first
                .extend(derivatives.map_or([NONE; 2], |derivatives| derivatives.first));
            found
                .second
                .extend(derivatives.map_or([NONE; 3], |derivatives| derivatives.second));
            found
                .directions
                .extend(curvature.map_or([NONE; 2], |curvature| curvature.directions));
            found
                .curvatures
                .extend(curvature.map_or([f64::NAN; 4], |curvature| {
                    let [most, least] = curvature.principal;
                    [curvature.gaussian, curvature.mean, most, least]
                }));
        }
        Ok(found)
    })?;
    Ok((
        tell::rows(py, found.positions)?,
        tell::rows(py, found.normals)?,
        tell::rows(py, found.tangents)?,
        tell::rows(py, found.first)?,
        tell::rows(py, found.second)?,
        tell::rows(py, found.directions)?,
        PyArray1::from_vec(py, found.curvatures),
    ))
}

fn places(faces: &[i64], weights: &[f64], count: usize) -> PyResult<Vec<(FaceId, [f64; 3])>> {
    let place = |(row, (&face, weights)): (usize, (&i64, &[f64; 3]))| match u32::try_from(face) {
        Ok(own) if (own as usize) < count => match barycentric(*weights) {
            Ok(weights) => Ok((FaceId(own), weights)),
            Err(why) => Err(OptionError::new_err(format!("barycentric[{row}]: {why}"))),
        },
        _ => Err(OptionError::new_err(format!(
            "at[{row}] names face {face}, expected 0 to {}",
            count.max(1) - 1
        ))),
    };
    faces
        .iter()
        .zip(weights.as_chunks::<3>().0)
        .enumerate()
        .map(place)
        .collect()
}

/// Which side of the surface over each triangle of the input is seen from an eye, or along a direction: 1 for the front, −1 for the
/// back, 0 where both are, or where it is not known.
#[pyfunction]
pub(crate) fn facing<'py>(
    py: Python<'py>,
    mesh: MeshIn<'py>,
    control: ControlOptions,
    eye: Option<[f64; 3]>,
    view: [f64; 3],
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyArray1<i8>>> {
    let (soup, recipe) = (mesh.soup()?, Recipe::new(control)?);
    let viewpoint = eye.map_or(Viewpoint::Direction(view), Viewpoint::Eye);
    let sides = run(py, threads, progress, move |observer| {
        let corners = triangles(&soup);
        let control = recipe.control(soup, observer)?;
        check(&control, corners.as_deref())?;
        let surface = LimitSurface::new(&control.mesh, recipe.scheme)?;
        let found = surface.facing_of_all_observed(&viewpoint, observer)?;
        if let Some(error) = surface.failure() {
            return Err(Failure::Mesh(error.to_string()));
        }
        let side = |facing: Facing| match facing {
            Facing::Front => 1,
            Facing::Back => -1,
            Facing::Undecided => 0,
        };
        Ok(found.into_iter().map(side).collect())
    })?;
    Ok(PyArray1::from_vec(py, sides))
}

/// The corners of all faces, if these are triangles.
fn triangles(soup: &PolygonSoup) -> Option<Vec<u32>> {
    soup.faces
        .iter()
        .all(|face| face.len() == 3)
        .then(|| soup.faces.iter().flatten().copied().collect())
}

/// That the control mesh's triangles are the input's, corner by corner.
fn check(control: &Control, corners: Option<&[u32]>) -> Result<(), Failure> {
    let is_whole = control.tables.parts.is_empty()
        && corners.is_some_and(|corners| control.tables.corners == corners);
    let is_in_order = control
        .tables
        .faces
        .iter()
        .zip(0..)
        .all(|(&face, own)| face == own);
    match is_whole && is_in_order {
        true => Ok(()),
        false => Err(Failure::Mesh(
            "faces are not the control mesh's triangles: polygons were cut or defects repaired; places are on what repair() gives"
                .to_owned(),
        )),
    }
}
