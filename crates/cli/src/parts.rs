//! Parts stay parts: where nobody says which edges are sharp, neither the file nor the command line, those are that look so, and the
//! surface keeps its size.

use limitmesh::Mesh;
use limitmesh::part::Look;

use crate::arguments::{CreaseAngle, CreasesFrom, FeatureArguments, InterpolationArguments};
use crate::creases::{Hints, OwnSharpness};
use crate::format::{counted, number};

/// The options for a surface's sharp edges and its vertices, decided by looking at the mesh.
pub(crate) struct Decided {
    pub(crate) features: FeatureArguments,
    pub(crate) interpolation: InterpolationArguments,
    /// The finding, in words.
    pub(crate) note: Option<String>,
}

/// Looks at a mesh, with the input's faces that its own are from, if the crease angle is to be found and the file has no tags. Of a part
/// those edges are sharp that the file's normals say are, or else those beyond an angle. Its surface is led through its vertices where it
/// `can_be`, unless something else is asked for.
pub(crate) fn decided(
    mut features: FeatureArguments,
    mut interpolation: InterpolationArguments,
    mesh: &Mesh,
    faces: &[u32],
    hints: &Hints<'_>,
    can_be_led: bool,
) -> Decided {
    let as_given = |features, interpolation| Decided {
        features,
        interpolation,
        note: None,
    };
    if features.crease_angle != Some(CreaseAngle::Auto)
        || features.creases_from != CreasesFrom::None
    {
        return as_given(features, interpolation);
    }
    let own = hints.sharpness(mesh);
    let look = (own != OwnSharpness::Tags).then(|| Look::of(mesh, faces));
    let Some(Look::Part(part)) = look else {
        return as_given(features, interpolation);
    };
    interpolation.is_of_part = can_be_led && interpolation.given().is_none();
    let (edges, which, tips) = if let OwnSharpness::Normals(edges) = own {
        features.creases_from = CreasesFrom::Normals;
        (
            edges,
            "that have different normals on both sides".to_owned(),
            0,
        )
    } else {
        features.crease_angle = Some(CreaseAngle::Found(part.degrees));
        (
            part.creases.edges.len(),
            format!("sharper than {}°", number(part.degrees)),
            part.tips.len(),
        )
    };
    let tips = if tips > 0 {
        format!(" and {}", counted(tips, "tip", "tips"))
    } else {
        String::new()
    };
    let led = if interpolation.is_of_part {
        ", surface led through the vertices"
    } else {
        ""
    };
    let is_one = edges == 1 && tips.is_empty() && !interpolation.is_of_part;
    let note = format!(
        "looks like a part: {} {which}{tips} kept sharp{led}; --crease-angle none smooths {}",
        counted(edges, "edge", "edges"),
        if is_one { "it" } else { "them" },
    );
    Decided {
        features,
        interpolation,
        note: Some(note),
    }
}
