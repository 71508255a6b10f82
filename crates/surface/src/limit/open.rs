//! Limit stencils of open rings: boundary vertices and corners on a boundary.
//!
//! The boundary curve refines alone (the scheme's contract), so that the difference matrix D is
//! block triangular: boundary rows have boundary columns only. Its strongly connected components
//! split it further, and each eigenvalue belongs to one component. A left eigenvector is supported
//! on its component and on those that this one depends on: with D = [[B, 0], [C, A]] (boundary
//! first), `y·A = λy` and `x·(B − λ) = −y·C`.
//!
//! * **Smooth boundary vertex**: the first tangent runs along the boundary and is the dominant left eigenvector
//!   of B; the second crosses it and is the dominant one of A, continued to the boundary. For Loop's rules with
//!   θ = π/(k−1) and σ = cot(θ/2) the second has sin(iθ) at the interior neighbours, x = (sin θ − σ)/(1 + 2cos θ)
//!   at the boundary neighbours and −2x − σ at the vertex. (The masks in common use belong to other boundary
//!   rules than 3/4, 1/8, 1/8; with these rules they are off by degrees from five edges on, see the tests.)
//!   With two edges there is no interior neighbour and both tangents come from B.
//! * **Corner**: the two dominant left eigenvectors of B, that is both boundary edges, where they dominate A or draw
//!   it along.

use super::LimitError;
use super::complex::Complex;
use super::eigen::{
    components, eigenspace_dimension, eigenvalues, join_jordan_blocks, left_vector, only_solution,
};
use super::matrix::Matrix;
use super::neighbourhood::Neighbourhood;
use super::stencil::{LimitStencil, TangentPlane, is_real, same_modulus};

/// Greatest valence whose tangents are computed: a dense eigenproblem of this size takes a second. Beyond it a
/// boundary vertex has its limit position but no tangent plane, as the surfaces of usual schemes have none there.
const GREATEST_VALENCE: usize = 512;

/// An eigenvalue of D and the component it belongs to.
#[derive(Clone, Copy)]
struct Mode {
    value: Complex,
    component: usize,
    on_boundary: bool,
    /// Whether the eigenvalue has a Jordan block: its pattern grows by a power of the number of
    /// steps over others of equal modulus, and its one left eigenvector gives the direction.
    defective: bool,
}

/// The limit stencil of an open ring.
///
/// # Errors
/// The masks are not those of a scheme as its contract describes it, or do not converge here.
pub(super) fn analyse(neighbourhood: &Neighbourhood<'_>) -> Result<LimitStencil, LimitError> {
    let position = position(neighbourhood)?;
    let bare = LimitStencil::without_tangents(neighbourhood.shape, neighbourhood.support, position);
    if neighbourhood.valence() > GREATEST_VALENCE {
        return Ok(bare);
    }
    let differences = difference_matrix(neighbourhood)?;
    let components = components(&differences);
    let modes = modes(neighbourhood, &differences, &components)?;
    let greatest = modes.first().map_or(0.0, |mode| mode.value.modulus());
    if greatest >= 1.0 - 1e-12 {
        let what = format!(
            "differences must shrink, but the difference matrix has an eigenvalue of modulus {greatest}"
        );
        return Err(neighbourhood.unsuitable(what));
    }
    let Some((pair, plane, next)) = choose(neighbourhood, &differences, &modes) else {
        return Ok(bare);
    };
    let vector = |mode: Mode| left_vector(&differences, &components, mode.component, mode.value.re);
    let (Some(along), Some(across)) = (vector(pair[0]), vector(pair[1])) else {
        return Ok(bare);
    };
    let tangents = scaled(neighbourhood, along, across);
    let eigenvalues = pair.map(|mode| mode.value.modulus());
    Ok(LimitStencil {
        tangents,
        plane,
        eigenvalues,
        next_eigenvalue: next,
        ..bare
    }
    .oriented())
}

/// Weights of the limit position: the left eigenvector for 1 of the boundary's part of S.
fn position(neighbourhood: &Neighbourhood<'_>) -> Result<Vec<f64>, LimitError> {
    let boundary: Vec<usize> = (0..neighbourhood.len())
        .filter(|&i| neighbourhood.is_on_boundary(i))
        .collect();
    let mut rows = Vec::new();
    for &point in &boundary {
        let row = neighbourhood.row(point)?;
        if (0..row.len()).any(|i| row[i] != 0.0 && !neighbourhood.is_on_boundary(i)) {
            let what =
                "the masks of boundary vertices and boundary edges must use boundary vertices only";
            return Err(neighbourhood.unsuitable(what));
        }
        rows.push(row);
    }
    let stays = rows[0][0] == 1.0 && rows[0][1..].iter().all(|&weight| weight == 0.0);
    if neighbourhood.shape.corner && !stays {
        return Err(neighbourhood.unsuitable("a corner must keep its place"));
    }
    let mut weights = vec![0.0; neighbourhood.len()];
    if stays {
        weights[0] = 1.0;
        return Ok(weights);
    }
    // As in a closed ring: the first column of x·(S − 1) = 0 is replaced by "the weights sum to 1".
    let n = boundary.len();
    let system = Matrix::from_fn(n, n, |equation, unknown| match equation {
        0 => 1.0,
        _ => rows[unknown][boundary[equation]] - f64::from(u8::from(equation == unknown)),
    });
    let solution = only_solution(system).ok_or_else(|| {
        neighbourhood.unsuitable("the eigenvalue 1 of the boundary's ring matrix must be simple")
    })?;
    boundary
        .iter()
        .zip(solution)
        .for_each(|(&point, weight)| weights[point] = weight);
    Ok(weights)
}

/// D over all points but the vertex.
fn difference_matrix(neighbourhood: &Neighbourhood<'_>) -> Result<Matrix, LimitError> {
    let n = neighbourhood.len() - 1;
    let centre = neighbourhood.row(0)?;
    let rows = (1..=n).map(|point| neighbourhood.row(point));
    let rows = rows.collect::<Result<Vec<_>, LimitError>>()?;
    Ok(Matrix::from_fn(n, n, |i, j| rows[i][j + 1] - centre[j + 1]))
}

/// All eigenvalues of D, by falling modulus.
fn modes(
    neighbourhood: &Neighbourhood<'_>,
    differences: &Matrix,
    components: &[Vec<usize>],
) -> Result<Vec<Mode>, LimitError> {
    let mut modes = Vec::with_capacity(differences.row_count());
    for (component, rows) in components.iter().enumerate() {
        let on_boundary = rows.iter().all(|&i| neighbourhood.is_on_boundary(i + 1));
        let own = differences.block(rows, rows);
        let Some(values) = eigenvalues(&own) else {
            return Err(neighbourhood
                .unsuitable("the eigenvalues of its ring matrix could not be computed"));
        };
        let values = join_jordan_blocks(&own, values).into_iter();
        modes.extend(values.map(|(value, defective)| Mode {
            value,
            component,
            on_boundary,
            defective,
        }));
    }
    modes.sort_by(|a, b| b.value.modulus().total_cmp(&a.value.modulus()));
    Ok(modes)
}

/// The modes of both tangents, their span, and the greatest modulus among the others.
fn choose(
    neighbourhood: &Neighbourhood<'_>,
    differences: &Matrix,
    modes: &[Mode],
) -> Option<([Mode; 2], TangentPlane, f64)> {
    let place = |from: usize, on_boundary: bool| {
        (from..modes.len()).find(|&i| modes[i].on_boundary == on_boundary)
    };
    let modulus = |i: Option<usize>| i.map_or(0.0, |i| modes[i].value.modulus());
    let along = place(0, true)?;
    let second_on_boundary = place(along + 1, true);
    let from_boundary = neighbourhood.shape.corner || neighbourhood.valence() == 2;
    let across = if from_boundary {
        second_on_boundary?
    } else {
        place(0, false)?
    };
    let other_across = place(across + 1, from_boundary);
    let others = (0..modes.len()).filter(|i| ![along, across].contains(i));
    let greatest_other = others.map(|i| modes[i].value.modulus()).fold(0.0, f64::max);
    let (slow, fast) = (modulus(Some(along)), modulus(Some(across)));
    let strict = |a: f64, b: f64| a > b && !same_modulus(a, b);
    if !is_real(modes[along].value) || !is_real(modes[across].value) || slow == 0.0 || fast == 0.0 {
        return None;
    }
    let pair = [modes[along], modes[across]];
    let in_block = pair
        .iter()
        .filter(|mode| mode.defective)
        .map(|mode| mode.value.modulus());
    let next = in_block.fold(greatest_other, f64::max);
    // A Jordan block outlasts simple eigenvalues of its own modulus.
    let outlasts = pair[1].defective
        && same_modulus(fast, greatest_other)
        && !(0..modes.len()).any(|i| {
            i != across && modes[i].defective && same_modulus(modes[i].value.modulus(), fast)
        });
    if from_boundary && draws_others_along(differences, modes, pair) {
        return Some((pair, TangentPlane::Surface, fast));
    }
    if outlasts {
        return Some((pair, TangentPlane::Surface, fast));
    }
    if strict(slow.min(fast), greatest_other) {
        return Some((pair, TangentPlane::Surface, next));
    }
    // The boundary's own tangent and the pattern across it are still the first of their kinds: the faces along
    // the boundary approach their plane, whatever others do.
    let ribbon = !from_boundary
        && strict(slow, modulus(second_on_boundary))
        && strict(fast, modulus(other_across));
    (ribbon && strict(fast, modulus(second_on_boundary))).then_some((
        pair,
        TangentPlane::BoundaryRibbon,
        next,
    ))
}

/// Whether patterns inside that shrink exactly as both boundary edges do are drawn along by these, and so outgrown by
/// the boundary's plane (like the number of steps): D has no other left eigenvectors for that eigenvalue.
///
/// So it is at corners of three faces with Loop's scheme.
fn draws_others_along(differences: &Matrix, modes: &[Mode], pair: [Mode; 2]) -> bool {
    let value = pair[0].value;
    let is_same = |mode: &Mode| (mode.value - value).modulus() <= 1e-12;
    let no_slower = |mode: &&Mode| {
        mode.value.modulus() > value.modulus()
            || same_modulus(mode.value.modulus(), value.modulus())
    };
    let count = modes.iter().filter(no_slower).count();
    is_same(&pair[1])
        && count > 2
        && modes.iter().filter(no_slower).all(is_same)
        && eigenspace_dimension(differences, value.re) == 2
}

/// Both eigenvectors in the scale that [`LimitStencil::tangent_weights`] promises.
fn scaled(neighbourhood: &Neighbourhood<'_>, along: Vec<f64>, across: Vec<f64>) -> Vec<[f64; 2]> {
    let k = neighbourhood.valence();
    let greatest_of = |values: &[f64]| values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let greatest = |vector: &[f64]| {
        let ring = greatest_of(&vector[..k]);
        if ring > 0.0 {
            ring
        } else {
            greatest_of(vector)
        }
    };
    let along_scale = greatest(&along).copysign(along[0]);
    let length = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>().sqrt();
    let inner = length(&across[1..k - 1]);
    let across_scale = if inner > 1e-9 * length(&across) {
        inner / ((k - 1) as f64 / 2.0).sqrt()
    } else {
        greatest(&across)
    };
    along
        .iter()
        .zip(&across)
        .map(|(u, w)| [u / along_scale, w / across_scale])
        .collect()
}
