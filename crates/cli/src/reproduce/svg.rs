//! A small writer of SVG pictures: shapes with style classes that every picture defines alike.
//!
//! Coordinates are rounded to hundredths, so that the text is the same wherever it is written.

use std::fmt::Write;

/// Colours that people with any colour vision can tell apart (Okabe and Ito's), and greys.
pub(super) const PAPER: &str = "#0072b2";
pub(super) const AMRESH: &str = "#d55e00";
pub(super) const UNIFORM: &str = "#009e73";
pub(super) const INK: &str = "#1d2733";
pub(super) const PALE: &str = "#8a95a3";
pub(super) const GRID: &str = "#dfe4ea";

/// A picture in the making.
pub(super) struct Drawing {
    width: f64,
    height: f64,
    title: String,
    body: String,
}

/// Where text stands relative to its point.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Drawing {
    /// An empty picture of that size in pixels; the title is what a screen reader says.
    pub(super) fn new(width: f64, height: f64, title: &str) -> Self {
        Self { width, height, title: title.to_owned(), body: String::new() }
    }

    /// Adds an element by its name and attributes.
    fn element(&mut self, name: &str, attributes: &str) {
        self.body.push_str("  <");
        self.body.push_str(name);
        self.body.push(' ');
        self.body.push_str(attributes);
        self.body.push_str("/>\n");
    }

    pub(super) fn line(&mut self, a: [f64; 2], b: [f64; 2], style: &str) {
        let [[x1, y1], [x2, y2]] = [a, b].map(|p| p.map(number));
        self.element("line", &format!(r#"x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" {style}"#));
    }

    /// A line with an arrow head at `b`.
    pub(super) fn arrow(&mut self, a: [f64; 2], b: [f64; 2], colour: &str, width: f64) {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        if length < 1e-9 {
            return;
        }
        let (ux, uy) = (dx / length, dy / length);
        let head = (3.2 * width).min(0.5 * length);
        let neck = [b[0] - head * ux, b[1] - head * uy];
        self.line(a, neck, &format!(r#"stroke="{colour}" stroke-width="{}""#, number(width)));
        let side = 0.42 * head;
        let wings = [[neck[0] - side * uy, neck[1] + side * ux], [neck[0] + side * uy, neck[1] - side * ux]];
        self.polygon(&[b, wings[0], wings[1]], &format!(r#"fill="{colour}""#));
    }

    pub(super) fn circle(&mut self, centre: [f64; 2], radius: f64, style: &str) {
        let ([x, y], r) = (centre.map(number), number(radius));
        self.element("circle", &format!(r#"cx="{x}" cy="{y}" r="{r}" {style}"#));
    }

    pub(super) fn polygon(&mut self, points: &[[f64; 2]], style: &str) {
        self.element("polygon", &format!(r#"points="{}" {style}"#, joined(points)));
    }

    pub(super) fn polyline(&mut self, points: &[[f64; 2]], style: &str) {
        self.element("polyline", &format!(r#"points="{}" fill="none" {style}"#, joined(points)));
    }

    pub(super) fn text(&mut self, at: [f64; 2], anchor: Anchor, style: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let [x, y] = at.map(number);
        let text = escape(text);
        let _ =
            writeln!(self.body, r#"  <text x="{x}" y="{y}" text-anchor="{anchor}" {style}>{text}</text>"#);
    }

    /// The whole file.
    pub(super) fn finish(self) -> String {
        let ([width, height], title) = ([self.width, self.height].map(number), escape(&self.title));
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" font-family="system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif" font-size="13" fill="{INK}">
  <title>{title}</title>
  <rect width="{width}" height="{height}" fill="white"/>
{}</svg>
"#,
            self.body
        )
    }
}

fn joined(points: &[[f64; 2]]) -> String {
    points.iter().map(|p| p.map(number).join(",")).collect::<Vec<_>>().join(" ")
}

/// A coordinate in hundredths, without a tail of zeros and without a sign on zero.
fn number(x: f64) -> String {
    let hundredths = (100.0 * x).round() / 100.0;
    format!("{}", if hundredths == 0.0 { 0.0 } else { hundredths })
}

/// Text as HTML and SVG want it.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_have_no_negative_zero() {
        assert_eq!([1.0, -0.001, 2.345_6, 1e5].map(number), ["1", "0", "2.35", "100000"]);
    }

    #[test]
    fn text_is_escaped() {
        assert_eq!(escape(r#"a < b & "c""#), "a &lt; b &amp; &quot;c&quot;");
    }
}
