//! Vector drawings: lines, arrows, arcs, polygons and labels, written as SVG.
//!
//! Coordinates are in pixels from the upper left corner, y downwards. Numbers are written with at most three
//! decimals, so the same drawing is the same bytes everywhere. A number that is not finite is remembered and
//! reported when the drawing is finished, so that drawing itself needs no error handling.
//!
//! ```
//! use limitmesh_render::Align;
//! use limitmesh_render::svg::{Drawing, Label, Pen};
//!
//! let mut drawing = Drawing::new(200.0, 160.0)?;
//! drawing.polygon(&[[30.0, 130.0], [170.0, 130.0], [100.0, 60.0]], &Pen::default().fill([225, 233, 244]));
//! drawing.arrow([100.0, 105.0], [100.0, 20.0], &Pen::line([20, 92, 158], 2.0));
//! drawing.label([108.0, 34.0], "n", &Label::default().italic(true).align(Align::Left));
//! let svg: String = drawing.finish()?;
//! # Ok::<(), limitmesh_render::RenderError>(())
//! ```

use std::fmt::Write as _;

use crate::RenderError;
use crate::text::Align;

/// How lines and areas look. Colours are 8-bit sRGB.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pen {
    /// The line's colour; `None` for no line (default: a blue black).
    pub stroke: Option<[u8; 3]>,
    /// The line's width in pixels (default: 1.5).
    pub width: f64,
    /// Lengths of dashes and gaps in turn, in pixels; empty for a solid line (default).
    pub dashes: Vec<f64>,
    /// The area's colour; `None` for no area (default).
    pub fill: Option<[u8; 3]>,
    /// 0 invisible to 1 opaque, of line and area (default: 1).
    pub opacity: f64,
}

impl Default for Pen {
    fn default() -> Self {
        Self {
            stroke: Some([26, 30, 38]),
            width: 1.5,
            dashes: Vec::new(),
            fill: None,
            opacity: 1.0,
        }
    }
}

impl Pen {
    /// A solid line.
    pub fn line(colour: [u8; 3], width: f64) -> Self {
        Self {
            stroke: Some(colour),
            width,
            ..Self::default()
        }
    }

    /// An area without outline.
    pub fn area(colour: [u8; 3]) -> Self {
        Self {
            stroke: None,
            fill: Some(colour),
            ..Self::default()
        }
    }

    /// Lengths of dashes and gaps in turn, in pixels.
    pub fn dashes(self, dashes: &[f64]) -> Self {
        Self {
            dashes: dashes.to_vec(),
            ..self
        }
    }

    /// The area's colour.
    pub fn fill(self, colour: [u8; 3]) -> Self {
        Self {
            fill: Some(colour),
            ..self
        }
    }

    /// 0 invisible to 1 opaque.
    pub fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// How a label is set.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Label {
    /// Height of an em in pixels (default: 14).
    pub size: f64,
    /// Bold rather than regular (default: no).
    pub bold: bool,
    /// Italic rather than upright, as for variables (default: no).
    pub italic: bool,
    /// 8-bit sRGB (default: a blue black).
    pub colour: [u8; 3],
    /// On which side of the anchor it lies (default: left-aligned).
    pub align: Align,
    /// Turned counter-clockwise by this many degrees around its anchor (default: 0).
    pub turn: f64,
}

impl Default for Label {
    fn default() -> Self {
        let colour = [26, 30, 38];
        Self {
            size: 14.0,
            bold: false,
            italic: false,
            colour,
            align: Align::Left,
            turn: 0.0,
        }
    }
}

impl Label {
    /// Height of an em in pixels.
    pub fn size(self, size: f64) -> Self {
        Self { size, ..self }
    }

    /// Bold rather than regular.
    pub fn bold(self, bold: bool) -> Self {
        Self { bold, ..self }
    }

    /// Italic rather than upright.
    pub fn italic(self, italic: bool) -> Self {
        Self { italic, ..self }
    }

    /// 8-bit sRGB.
    pub fn colour(self, colour: [u8; 3]) -> Self {
        Self { colour, ..self }
    }

    /// On which side of the anchor it lies.
    pub fn align(self, align: Align) -> Self {
        Self { align, ..self }
    }

    /// Turned counter-clockwise by this many degrees around its anchor.
    pub fn turn(self, turn: f64) -> Self {
        Self { turn, ..self }
    }
}

/// The fonts asked for, best first; all are plain sans-serif faces.
const FONTS: &str = "'Noto Sans', 'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', sans-serif";

/// The longest side of a drawing, in pixels.
const MAX_SIDE: f64 = 100_000.0;

/// A drawing under way; later elements lie on top of earlier ones.
#[derive(Clone, Debug)]
pub struct Drawing {
    width: f64,
    height: f64,
    body: String,
    bad_number: Option<f64>,
    bad_place: usize,
    elements: usize,
}

impl Drawing {
    /// An empty drawing on white.
    ///
    /// # Errors
    /// A side is not above zero or longer than 100 000.
    pub fn new(width: f64, height: f64) -> Result<Self, RenderError> {
        for (name, side) in [
            ("the drawing's width", width),
            ("the drawing's height", height),
        ] {
            RenderError::check_range(name, side, 1.0..=MAX_SIDE, "from 1 to 100000 pixels")?;
        }
        let mut drawing = Self {
            width,
            height,
            body: String::new(),
            bad_number: None,
            bad_place: 0,
            elements: 0,
        };
        drawing.polygon(
            &[[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]],
            &Pen::area([255; 3]),
        );
        Ok(drawing)
    }

    /// Width in pixels.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// A number as it is written; what is not finite is remembered.
    fn number(&mut self, value: f64) -> String {
        if !value.is_finite() && self.bad_number.is_none() {
            (self.bad_number, self.bad_place) = (Some(value), self.elements);
        }
        let text = format!("{value:.3}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text == "-0" {
            "0".into()
        } else {
            text.into()
        }
    }

    fn colour(colour: [u8; 3]) -> String {
        format!("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2])
    }

    fn pen(&mut self, pen: &Pen) -> String {
        let mut text = match pen.fill {
            Some(fill) => format!(" fill=\"{}\"", Self::colour(fill)),
            None => " fill=\"none\"".into(),
        };
        if let Some(stroke) = pen.stroke {
            let width = self.number(pen.width);
            let colour = Self::colour(stroke);
            text += &format!(
                " stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\" stroke-linejoin=\"round\""
            );
            if !pen.dashes.is_empty() {
                let dashes: Vec<String> = pen.dashes.iter().map(|&d| self.number(d)).collect();
                text += &format!(" stroke-dasharray=\"{}\"", dashes.join(" "));
            }
        }
        if pen.opacity != 1.0 {
            let opacity = self.number(pen.opacity);
            text += &format!(" opacity=\"{opacity}\"");
        }
        text
    }

    fn element(&mut self, text: &str) {
        self.body.push_str("  ");
        self.body.push_str(text);
        self.body.push('\n');
        self.elements += 1;
    }

    fn through(&mut self, name: &str, points: &[[f64; 2]], pen: &Pen) {
        let places: Vec<String> = points
            .iter()
            .map(|p| format!("{},{}", self.number(p[0]), self.number(p[1])))
            .collect();
        let pen = self.pen(pen);
        self.element(&format!("<{name} points=\"{}\"{pen}/>", places.join(" ")));
    }

    /// An open line through points.
    pub fn polyline(&mut self, points: &[[f64; 2]], pen: &Pen) {
        self.through("polyline", points, pen);
    }

    /// A closed line through points, and the area within.
    pub fn polygon(&mut self, points: &[[f64; 2]], pen: &Pen) {
        self.through("polygon", points, pen);
    }

    /// A straight line.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], pen: &Pen) {
        self.polyline(&[from, to], pen);
    }

    /// A straight line with a filled head at `to`, whose size follows the line's width.
    pub fn arrow(&mut self, from: [f64; 2], to: [f64; 2], pen: &Pen) {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        if length == 0.0 {
            return;
        }
        let (ux, uy) = (dx / length, dy / length);
        let head = (4.0 + 3.0 * pen.width).min(length);
        let half = 0.36 * head;
        let at = |along: f64, across: f64| {
            [
                to[0] - ux * along - uy * across,
                to[1] - uy * along + ux * across,
            ]
        };
        self.line(from, at(0.8 * head, 0.0), pen);
        if let Some(stroke) = pen.stroke {
            let tip = [to, at(head, half), at(0.75 * head, 0.0), at(head, -half)];
            self.polygon(
                &tip,
                &Pen {
                    opacity: pen.opacity,
                    ..Pen::area(stroke)
                },
            );
        }
    }

    /// A circle.
    pub fn circle(&mut self, centre: [f64; 2], radius: f64, pen: &Pen) {
        let [x, y, r] = [centre[0], centre[1], radius].map(|value| self.number(value));
        let pen = self.pen(pen);
        self.element(&format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"{pen}/>"));
    }

    /// An arc of a circle between two directions, in degrees counter-clockwise from the right, drawn
    /// counter-clockwise from the first to the second; whole turns are a circle.
    pub fn arc(&mut self, centre: [f64; 2], radius: f64, from: f64, to: f64, pen: &Pen) {
        if (to - from).abs() >= 360.0 {
            self.circle(centre, radius, pen);
            return;
        }
        let span = (to - from).rem_euclid(360.0);
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            [centre[0] + radius * cos, centre[1] - radius * sin]
        };
        let ([x0, y0], [x1, y1]) = (at(from), at(from + span));
        let [x0, y0, x1, y1, r] = [x0, y0, x1, y1, radius].map(|value| self.number(value));
        let large = u8::from(span > 180.0);
        let pen = self.pen(pen);
        self.element(&format!(
            "<path d=\"M {x0} {y0} A {r} {r} 0 {large} 0 {x1} {y1}\"{pen}/>"
        ));
    }

    /// A line of text with its baseline at `at`. Any characters are allowed; those that XML cannot hold are left
    /// out.
    pub fn label(&mut self, at: [f64; 2], text: &str, label: &Label) {
        let [x, y, size, turn] =
            [at[0], at[1], label.size, -label.turn].map(|value| self.number(value));
        let anchor = match label.align {
            Align::Left => "start",
            Align::Centre => "middle",
            Align::Right => "end",
        };
        let weight = if label.bold {
            " font-weight=\"bold\""
        } else {
            ""
        };
        let slope = if label.italic {
            " font-style=\"italic\""
        } else {
            ""
        };
        let turned = if label.turn == 0.0 {
            String::new()
        } else {
            format!(" transform=\"rotate({turn} {x} {y})\"")
        };
        let (colour, text) = (Self::colour(label.colour), escaped(text));
        self.element(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{colour}\"{weight}{slope}{turned}>{text}</text>"
        ));
    }

    /// The drawing as an SVG file.
    ///
    /// # Errors
    /// A number given to one of the elements was not finite.
    pub fn finish(mut self) -> Result<String, RenderError> {
        if let Some(value) = self.bad_number {
            return Err(RenderError::NotFinite {
                what: "drawing element",
                index: self.bad_place,
                value,
            });
        }
        let (width, height) = (self.width, self.height);
        let (width, height) = (self.number(width), self.number(height));
        let mut file = String::with_capacity(self.body.len() + 256);
        // Writing to a string cannot fail.
        let _ = writeln!(
            file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\">"
        );
        file.push_str(&self.body);
        file.push_str("</svg>\n");
        Ok(file)
    }
}

/// Text for XML content and attributes.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            '\t' | '\n' | '\r' => safe.push(' '),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => {}
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_cannot_break_out_of_its_element() {
        let mut drawing = Drawing::new(10.0, 10.0).unwrap();
        drawing.label(
            [0.0, 0.0],
            "</text><script a='\"&\u{0}\n",
            &Label::default(),
        );
        let file = drawing.finish().unwrap();
        assert!(file.contains(">&lt;/text&gt;&lt;script a=&#39;&quot;&amp; </text>"));
    }

    #[test]
    fn numbers_that_are_not_finite_are_reported() {
        let mut drawing = Drawing::new(10.0, 10.0).unwrap();
        drawing.circle([1.0, f64::NAN], 2.0, &Pen::default());
        let error = drawing.finish().unwrap_err();
        assert!(
            matches!(error, RenderError::NotFinite { index: 1, .. }),
            "{error}"
        );
        assert!(Drawing::new(f64::NAN, 1.0).is_err() && Drawing::new(0.0, 1.0).is_err());
    }

    #[test]
    fn an_arc_ends_where_its_angles_say() {
        let mut drawing = Drawing::new(100.0, 100.0).unwrap();
        drawing.arc([50.0, 50.0], 10.0, 0.0, 90.0, &Pen::default());
        drawing.arc([50.0, 50.0], 10.0, 90.0, 0.0, &Pen::default());
        let file = drawing.finish().unwrap();
        // Counter-clockwise on screen is sweep 0; the quarter from the right to the top, then the other three.
        assert!(file.contains("M 60 50 A 10 10 0 0 0 50 40\""), "{file}");
        assert!(file.contains("M 50 40 A 10 10 0 1 0 60 50\""), "{file}");
    }

    #[test]
    fn no_negative_zero_and_no_needless_decimals() {
        let mut drawing = Drawing::new(10.0, 10.0).unwrap();
        drawing.line([-0.0001, 1.5], [2.0, 1.0 / 3.0], &Pen::default());
        assert!(
            drawing
                .finish()
                .unwrap()
                .contains("points=\"0,1.5 2,0.333\"")
        );
    }
}
