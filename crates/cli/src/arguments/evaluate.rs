//! `limitmesh evaluate`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use super::limit::LimitArguments;
use super::quantity::finite;

const EXAMPLES: &str = "\
Examples:
  limitmesh evaluate builtin:cup --at 12,0.5,0.25,0.25
        the point, normal and curvature over a place of face 12
  limitmesh evaluate part.obj --crease-angle 30 --at 0,1,0,0 --at 7,0.2,0.3,0.5 --json
  limitmesh evaluate part.obj --at places.txt --json
        one place a line: FACE W0 W1 W2";

/// Say where the limit surface is over places of its control faces, and how it bends there
///
/// Faces are the triangles of the control mesh, counted from 0 as in the file where that has triangles that need no repair; a
/// place is given by the weights of the three corners, which add up to 1; where they do so within 0.0002, as 0.3333 three times, they
/// are divided by their sum. The limit surface itself is evaluated, not a mesh that approximates it. Derivatives are by the weights of the second (u) and the third corner (v). --crease-angle and --boundary may
/// divide faces at concave corners, which are numbered anew then; --concave-corners as-tagged leaves them. Curvature is in 1 / unit (Gaussian: 1 / unit²), below 0 on convex places whose normals point outwards; there
/// is none at irregular vertices, nor for schemes other than loop and loop-warren.
#[derive(Args, Debug, Clone)]
#[command(after_help = EXAMPLES)]
pub(crate) struct EvaluateArguments {
    /// Control mesh: a file, - for standard input, or builtin:NAME
    #[arg(value_name = "CONTROL")]
    pub(crate) control: PathBuf,

    /// A place, or a file of places (- for standard input), one a line, with commas or blanks between the numbers; may be given more
    /// than once
    #[arg(long, value_name = "FACE,W0,W1,W2|FILE", required = true)]
    pub(crate) at: Vec<Places>,

    #[command(flatten)]
    pub(crate) limit: LimitArguments,

    /// Print JSON instead of text: a list of places
    #[arg(long)]
    pub(crate) json: bool,
}

/// A place of a control mesh: a triangle, and the weights of its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) face: u32,
    pub(crate) weights: [f64; 3],
}

/// A place, or a file that holds some.
#[derive(Clone, Debug)]
pub(crate) enum Places {
    One(Place),
    File(PathBuf),
}

impl FromStr for Places {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // The name of a file may hold commas and blanks, but not numbers alone between them.
        let words: Vec<&str> = words(text).collect();
        let is_place = words.len() > 1 && words.iter().all(|word| word.parse::<f64>().is_ok());
        if is_place {
            text.parse().map(Self::One)
        } else {
            Ok(Self::File(text.into()))
        }
    }
}

/// A word between commas and blanks.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c == ',' || c.is_whitespace())
        .filter(|word| !word.is_empty())
}

/// As much of a text as an error may show.
fn shortened(text: &str) -> String {
    const MOST: usize = 60;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

impl FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = words(text).collect();
        let text = &shortened(text);
        let [face, weights @ ..] = &words[..] else {
            return Err("it is empty; give FACE,W0,W1,W2".to_owned());
        };
        let weights = weights
            .iter()
            .map(|weight| finite(weight))
            .collect::<Result<Vec<_>, _>>()?;
        let weights = <[f64; 3]>::try_from(weights).map_err(|weights| {
            format!(
                "'{text}' has {} of three weights; give FACE,W0,W1,W2",
                weights.len()
            )
        })?;
        let face = face.parse().map_err(|_| {
            format!(
                "'{}' is not the number of a face, counted from 0",
                shortened(face)
            )
        })?;
        let weights = limitmesh::barycentric(weights).map_err(|why| format!("'{text}': {why}"))?;
        Ok(Self { face, weights })
    }
}
