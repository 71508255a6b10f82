//! Parts stay parts: where nobody says which edges are sharp, neither the file nor the command line, those are that look so, and the
//! surface keeps its size.

use limitmesh::Mesh;
use limitmesh::part::Look;

use crate::arguments::{CreaseAngle, CreasesFrom, FeatureArguments, InterpolationArguments};
use crate::creases::Hints;
use crate::format::{counted, number};

/// What options say of a surface's sharp edges and of its vertices, once the mesh has been looked at.
pub(crate) struct Decided {
    pub(crate) features: FeatureArguments,
    pub(crate) interpolation: InterpolationArguments,
    /// What was found, in words.
    pub(crate) note: Option<String>,
}

/// Looks at a mesh, with the input's faces that its own are from, if the crease angle is to be found and the file does not tell edges apart.
/// A part's surface is led through its vertices where it `can_be`, unless something else is asked for.
pub(crate) fn decided(
    (mut features, mut interpolation): (FeatureArguments, InterpolationArguments),
    (mesh, faces): (&Mesh, &[u32]),
    hints: &Hints<'_>,
    can_be_led: bool,
) -> Decided {
    let is_open = features.crease_angle == Some(CreaseAngle::Auto)
        && features.creases_from == CreasesFrom::None
        && !hints.tell_edges_apart(mesh);
    let look = is_open.then(|| Look::of(mesh, faces));
    let Some(Look::Part(part)) = look else { return Decided { features, interpolation, note: None } };
    features.crease_angle = Some(CreaseAngle::Found(part.degrees));
    interpolation.is_of_part = can_be_led && interpolation.given().is_none();
    let edges = part.creases.edges.len();
    let led = if interpolation.is_of_part { ", surface led through the vertices" } else { "" };
    let them = if edges == 1 && !interpolation.is_of_part { "it" } else { "them" };
    let note = format!(
        "looks like a part: {} sharper than {}° kept sharp{led}; --crease-angle none smooths {them}",
        counted(edges, "edge", "edges"),
        number(part.degrees),
    );
    Decided { features, interpolation, note: Some(note) }
}
