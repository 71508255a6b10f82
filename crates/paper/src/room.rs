//! The room that charts and drawn figures are made for: a page on a desktop, or on a phone.
//!
//! Text has the same size in both, so each drawing is laid out twice, and nothing is shrunk until it cannot be read. SVG leaves
//! the choice of a font to the viewer: room is left for the widest of the usual ones.

use limitmesh_render::svg::{Drawing, Label};
use limitmesh_render::{RenderError, TextStyle, text_width};

use super::palette::{dot, plain};

/// How much wider than in Noto Sans text may be: DejaVu Sans, the widest of the fonts asked for, has 1.12 to 1.17 times its
/// width, by style.
const WIDEST: f64 = 1.18;

/// What a drawing is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Room {
    /// Pages wider than a phone's.
    Wide,
    /// Phones held upright.
    Narrow,
}

impl Room {
    pub(super) const ALL: [Self; 2] = [Self::Wide, Self::Narrow];

    /// Pixels of a drawing for phones.
    pub(super) const NARROW: f64 = 380.0;

    /// The name of a drawing's file.
    pub(super) fn file(self, stem: &str) -> String {
        match self {
            Self::Wide => format!("{stem}.svg"),
            Self::Narrow => format!("{stem}-narrow.svg"),
        }
    }

    /// The first of two things for wide drawings, the second for narrow ones.
    pub(super) fn pick<T>(self, wide: T, narrow: T) -> T {
        match self {
            Self::Wide => wide,
            Self::Narrow => narrow,
        }
    }
}

/// Pixels that a label takes in the widest of the usual fonts.
pub(super) fn width_of(text: &str, label: &Label) -> Result<f64, RenderError> {
    let style = TextStyle::default()
        .size(label.size as f32)
        .bold(label.bold);
    Ok(WIDEST * f64::from(text_width(text, &style)?))
}

/// A text in lines that are no wider than `room` where words allow.
pub(super) fn lines(text: &str, room: f64, label: &Label) -> Result<Vec<String>, RenderError> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        if let Some(last) = lines.last_mut()
            && width_of(&format!("{last} {word}"), label)? <= room
        {
            last.push(' ');
            last.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    Ok(lines)
}

/// A text in lines from `top`, the first baseline, downwards.
pub(super) fn paragraph(
    drawing: &mut Drawing,
    [x, top]: [f64; 2],
    lines: &[String],
    label: &Label,
) {
    for (line, row) in lines.iter().zip(0..) {
        drawing.label([x, top + 1.35 * label.size * f64::from(row)], line, label);
    }
}

/// What the colours of a chart mean: a dot and a name each, in as many rows as they need.
pub(super) struct Legend<'a> {
    rows: Vec<Vec<([u8; 3], &'a str, f64)>>,
}

impl<'a> Legend<'a> {
    const ROW: f64 = 19.0;
    /// From a dot's centre to its name, and from that to the next dot's.
    const DOT: f64 = 10.0;
    const GAP: f64 = 18.0;

    /// In rows no wider than `room`.
    pub(super) fn new(entries: &[([u8; 3], &'a str)], room: f64) -> Result<Self, RenderError> {
        let mut rows: Vec<Vec<_>> = Vec::new();
        let mut used = 0.0;
        for &(colour, name) in entries {
            let width = Self::DOT + width_of(name, &plain())?;
            match rows.last_mut() {
                Some(row) if used + Self::GAP + width <= room => {
                    used += Self::GAP + width;
                    row.push((colour, name, width));
                }
                _ => {
                    used = width;
                    rows.push(vec![(colour, name, width)]);
                }
            }
        }
        Ok(Self { rows })
    }

    /// Pixels from above its first row to below its last.
    pub(super) fn height(&self) -> f64 {
        Self::ROW * self.rows.len() as f64
    }

    /// Draws it with its upper left corner at a place.
    pub(super) fn draw(&self, drawing: &mut Drawing, [left, top]: [f64; 2]) {
        for (row, index) in self.rows.iter().zip(1..) {
            let baseline = top + Self::ROW * f64::from(index) - 4.5;
            let mut x = left + 5.0;
            for &(colour, name, width) in row {
                dot(drawing, [x, baseline - 4.5], 5.0, colour);
                drawing.label([x + Self::DOT, baseline], name, &plain());
                x += width + Self::GAP;
            }
        }
    }
}
