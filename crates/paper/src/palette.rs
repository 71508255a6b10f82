//! The colours and pens of the drawn figures and charts.

use limitmesh_render::svg::{Drawing, Label, Pen};

/// Colours that people with any colour vision can tell apart (Okabe and Ito's), and greys.
pub(super) const PAPER: [u8; 3] = [0, 114, 178];
pub(super) const AMRESH: [u8; 3] = [213, 94, 0];
pub(super) const UNIFORM: [u8; 3] = [0, 158, 115];
pub(super) const EXACT: [u8; 3] = [204, 121, 167];
pub(super) const PLANARITY: [u8; 3] = [230, 159, 0];
pub(super) const VERTEX_ERROR: [u8; 3] = [86, 180, 233];
pub(super) const SQRT3: [u8; 3] = [90, 90, 90];
pub(super) const INK: [u8; 3] = [29, 39, 51];
pub(super) const PALE: [u8; 3] = [120, 131, 144];
pub(super) const GRID: [u8; 3] = [223, 228, 234];

/// A line as thin as those of a grid.
pub(super) fn thin(colour: [u8; 3]) -> Pen {
    Pen::line(colour, 1.0)
}

/// Text that does not matter much.
pub(super) fn small() -> Label {
    Label::default().size(11.0).colour(PALE)
}

/// Text of ordinary size.
pub(super) fn plain() -> Label {
    Label::default().size(13.0).colour(INK)
}

/// A polygon with a faint area under an opaque outline.
pub(super) fn tinted(
    drawing: &mut Drawing,
    points: &[[f64; 2]],
    fill: [u8; 3],
    opacity: f64,
    outline: &Pen,
) {
    drawing.polygon(points, &Pen::area(fill).opacity(opacity));
    drawing.polygon(points, outline);
}

/// A dot of a chart, with a rim that keeps it apart from others.
pub(super) fn dot(drawing: &mut Drawing, at: [f64; 2], radius: f64, colour: [u8; 3]) {
    drawing.circle(at, radius, &Pen::line([255; 3], 0.8).fill(colour));
}
