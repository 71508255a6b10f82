//! Plots of series over linear or logarithmic axes, such as error against triangles, written as SVG.
//!
//! Takes series of points and names, gives a file with axes at round numbers, a light grid and a legend.
//!
//! ```
//! use limitmesh_render::plot::{Axis, Plot, Series};
//!
//! let svg = Plot::new(
//!     "Error against triangles",
//!     Axis::new("triangles").logarithmic(),
//!     Axis::new("Hausdorff distance").unit("% of the diagonal").logarithmic(),
//! )
//! .with(Series::new("uniform", vec![[142.0, 2.1], [568.0, 0.55], [2272.0, 0.14]]))
//! .with(Series::new("adaptive", vec![[142.0, 2.1], [310.0, 0.56], [900.0, 0.15]]))
//! .to_svg()?;
//! assert!(svg.starts_with("<svg"));
//! # Ok::<(), limitmesh_render::RenderError>(())
//! ```

use crate::RenderError;
use crate::svg::{Drawing, Label, Pen};
use crate::text::{Align, TextStyle, text_width};
use crate::ticks::{self, Tick};

/// How numbers are spread along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spread {
    /// Equal differences are equally long.
    #[default]
    Linear,
    /// Equal ratios are equally long; only numbers above zero.
    Logarithmic,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Axis {
    /// What the numbers are.
    pub title: String,
    /// Their unit, added to the title in brackets where not empty.
    pub unit: String,
    /// Linear (default) or logarithmic.
    pub spread: Spread,
    /// First and last number; from the data with some room where `None`.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..Self::default()
        }
    }

    /// The numbers' unit.
    pub fn unit(self, unit: impl Into<String>) -> Self {
        Self {
            unit: unit.into(),
            ..self
        }
    }

    /// Makes it logarithmic.
    pub fn logarithmic(self) -> Self {
        Self {
            spread: Spread::Logarithmic,
            ..self
        }
    }

    /// First and last number.
    pub fn range(self, first: f64, last: f64) -> Self {
        Self {
            range: Some([first, last]),
            ..self
        }
    }

    fn heading(&self) -> String {
        if self.unit.is_empty() {
            self.title.clone()
        } else {
            format!("{} ({})", self.title, self.unit)
        }
    }
}

/// Points with a name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Series {
    /// The name in the legend; none where empty.
    pub name: String,
    /// The points, in the order in which a line joins them.
    pub points: Vec<[f64; 2]>,
    /// Whether a line joins them (default: yes).
    pub line: bool,
    /// Whether each is marked (default: yes).
    pub markers: bool,
    /// Whether the line is dashed (default: no).
    pub dashed: bool,
    /// 8-bit sRGB; the next of a palette that all colour vision can tell apart where `None`.
    pub colour: Option<[u8; 3]>,
}

impl Series {
    /// Marked points joined by a line.
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.into(),
            points,
            line: true,
            markers: true,
            dashed: false,
            colour: None,
        }
    }

    /// Marked points alone.
    pub fn scatter(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            line: false,
            ..Self::new(name, points)
        }
    }

    /// Whether each point is marked.
    pub fn markers(self, markers: bool) -> Self {
        Self { markers, ..self }
    }

    /// Whether the line is dashed.
    pub fn dashed(self, dashed: bool) -> Self {
        Self { dashed, ..self }
    }

    /// 8-bit sRGB.
    pub fn colour(self, colour: [u8; 3]) -> Self {
        Self {
            colour: Some(colour),
            ..self
        }
    }
}

/// Where the legend stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Legend {
    /// Right of the plot, where it hides nothing.
    #[default]
    Beside,
    /// In the upper right corner.
    UpperRight,
    /// In the lower left corner.
    LowerLeft,
    /// No legend.
    None,
}

/// A plot.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plot {
    /// Above the plot; may be empty.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is plotted.
    pub series: Vec<Series>,
    /// Where the legend stands.
    pub legend: Legend,
    /// Width in pixels (default: 640).
    pub width: f64,
    /// Height in pixels (default: 420).
    pub height: f64,
}

/// Colours that stay apart for every kind of colour vision: their lightness differs as well as their hue.
const PALETTE: [[u8; 3]; 7] = [
    [20, 92, 158],
    [214, 96, 28],
    [26, 138, 104],
    [150, 62, 134],
    [204, 154, 24],
    [84, 168, 214],
    [88, 88, 96],
];
const GRID: [u8; 3] = [226, 229, 234];
const MINOR_GRID: [u8; 3] = [241, 243, 246];
const FRAME: [u8; 3] = [96, 102, 112];
const TICK_SIZE: f64 = 12.0;
const TITLE_SIZE: f64 = 13.5;

/// The part of a drawing that the data fills, and the ranges of the axes.
struct Field {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: Range,
    y: Range,
}

/// An axis with its ends fixed.
#[derive(Clone, Copy)]
struct Range {
    low: f64,
    high: f64,
    spread: Spread,
}

impl Range {
    /// 0 at the first number, 1 at the last.
    fn place(&self, value: f64) -> f64 {
        match self.spread {
            Spread::Linear => (value - self.low) / (self.high - self.low),
            Spread::Logarithmic => (value / self.low).ln() / (self.high / self.low).ln(),
        }
    }

    fn ticks(&self, count: usize) -> Vec<Tick> {
        match self.spread {
            Spread::Linear => ticks::linear(self.low, self.high, count),
            Spread::Logarithmic => ticks::logarithmic(self.low, self.high, count),
        }
    }
}

impl Field {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.left + (self.right - self.left) * self.x.place(x),
            self.bottom + (self.top - self.bottom) * self.y.place(y),
        ]
    }
}

impl Plot {
    /// A plot without series.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        let (legend, series) = (Legend::default(), Vec::new());
        Self {
            title: title.into(),
            x,
            y,
            series,
            legend,
            width: 640.0,
            height: 420.0,
        }
    }

    /// Adds a series.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Where the legend stands.
    pub fn legend(self, legend: Legend) -> Self {
        Self { legend, ..self }
    }

    /// Width and height in pixels, at least 160 each.
    pub fn size(self, width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            ..self
        }
    }

    /// The plot as an SVG file.
    ///
    /// # Errors
    /// Numbers that are not finite, or not above zero on a logarithmic axis; a range that is empty; no points at
    /// all; a size too small for axes and labels.
    pub fn to_svg(&self) -> Result<String, RenderError> {
        for (name, side) in [
            ("the plot's width", self.width),
            ("the plot's height", self.height),
        ] {
            RenderError::check_range(name, side, 160.0..=20_000.0, "from 160 to 20000 pixels")?;
        }
        let field = self.field()?;
        let mut drawing = Drawing::new(self.width, self.height)?;
        self.draw_axes(&mut drawing, &field);
        for (index, series) in self.series.iter().enumerate() {
            draw_series(&mut drawing, &field, series, index);
        }
        self.draw_legend(&mut drawing, &field)?;
        let middle = 0.5 * (field.left + field.right);
        let title = Label::default().size(15.0).bold(true).align(Align::Centre);
        drawing.label([middle, 24.0], &self.title, &title);
        drawing.finish()
    }

    fn field(&self) -> Result<Field, RenderError> {
        let (x, y) = (self.range(0, &self.x)?, self.range(1, &self.y)?);
        let style = TextStyle::default().size(TICK_SIZE as f32);
        let mut widest = 0.0f64;
        for label in y.ticks(6).iter().filter_map(|tick| tick.label.as_deref()) {
            widest = widest.max(text_width(label, &style)?.into());
        }
        let legend = match self.legend {
            Legend::Beside => self.legend_width()? + if self.has_legend() { 18.0 } else { 0.0 },
            _ => 0.0,
        };
        let left = 18.0 + widest + if self.y.title.is_empty() { 0.0 } else { 26.0 };
        let top = if self.title.is_empty() { 18.0 } else { 42.0 };
        let right = self.width - 20.0 - legend;
        let bottom = self.height - 34.0 - if self.x.title.is_empty() { 0.0 } else { 22.0 };
        if right - left < 60.0 || bottom - top < 60.0 {
            return Err(RenderError::BadOption {
                name: "the room left for the plot between its labels",
                value: (right - left).min(bottom - top),
                expected: "at least 60 pixels: a larger plot or shorter names",
            });
        }
        Ok(Field {
            left,
            right,
            top,
            bottom,
            x,
            y,
        })
    }

    fn has_legend(&self) -> bool {
        self.legend != Legend::None && self.series.iter().any(|series| !series.name.is_empty())
    }

    fn legend_width(&self) -> Result<f64, RenderError> {
        let style = TextStyle::default().size(TICK_SIZE as f32);
        let mut widest = 0.0f64;
        for series in self.series.iter().filter(|series| !series.name.is_empty()) {
            widest = widest.max(40.0 + f64::from(text_width(&series.name, &style)?));
        }
        Ok(widest)
    }

    /// The ends of an axis: those given, or the data's with a little room.
    fn range(&self, axis: usize, settings: &Axis) -> Result<Range, RenderError> {
        let spread = settings.spread;
        let check = |index: usize, value: f64| match spread {
            _ if !value.is_finite() => Err(RenderError::NotFinite {
                what: "plotted point",
                index,
                value,
            }),
            Spread::Logarithmic if value <= 0.0 => Err(RenderError::BadOption {
                name: "a number on a logarithmic axis",
                value,
                expected: "above 0",
            }),
            _ => Ok(()),
        };
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for (index, point) in self
            .series
            .iter()
            .flat_map(|series| &series.points)
            .enumerate()
        {
            check(index, point[axis])?;
            (low, high) = (low.min(point[axis]), high.max(point[axis]));
        }
        if let Some([first, last]) = settings.range {
            check(0, first)?;
            check(1, last)?;
            RenderError::check_range(
                "the axis's last number",
                last,
                first.next_up()..=f64::MAX,
                "above the first",
            )?;
            return Ok(Range {
                low: first,
                high: last,
                spread,
            });
        }
        if low > high {
            return Err(RenderError::Empty);
        }
        Ok(match spread {
            Spread::Linear => {
                let room = if high > low {
                    0.05 * (high - low)
                } else {
                    0.5 * high.abs().max(1.0)
                };
                // An axis of amounts starts at zero rather than just below it.
                let from = if low >= 0.0 && low < 0.35 * high {
                    0.0
                } else {
                    low - room
                };
                Range {
                    low: from,
                    high: high + room,
                    spread,
                }
            }
            Spread::Logarithmic => {
                let room = if high > low {
                    (high / low).powf(0.06)
                } else {
                    2.0
                };
                let (low, high) = (
                    (low / room).max(f64::MIN_POSITIVE),
                    (high * room).min(f64::MAX),
                );
                Range { low, high, spread }
            }
        })
    }

    fn draw_axes(&self, drawing: &mut Drawing, field: &Field) {
        let text = Label::default().size(TICK_SIZE).colour(FRAME);
        let (grid, minor) = (Pen::line(GRID, 1.0), Pen::line(MINOR_GRID, 1.0));
        let across = ((field.right - field.left) / 80.0).ceil() as usize;
        let upwards = ((field.bottom - field.top) / 55.0).ceil() as usize;
        let (columns, rows) = (field.x.ticks(across), field.y.ticks(upwards));
        for labelled in [false, true] {
            let pen = if labelled { &grid } else { &minor };
            for tick in columns.iter().filter(|t| t.label.is_some() == labelled) {
                let [x, _] = field.at([tick.value, field.y.low]);
                drawing.line([x, field.top], [x, field.bottom], pen);
            }
            for tick in rows.iter().filter(|t| t.label.is_some() == labelled) {
                let [_, y] = field.at([field.x.low, tick.value]);
                drawing.line([field.left, y], [field.right, y], pen);
            }
        }
        for tick in columns {
            let [x, _] = field.at([tick.value, field.y.low]);
            let label = tick.label.as_deref().unwrap_or_default();
            if !label.is_empty() {
                drawing.label([x, field.bottom + 18.0], label, &text.align(Align::Centre));
            }
        }
        for tick in rows {
            let [_, y] = field.at([field.x.low, tick.value]);
            let label = tick.label.as_deref().unwrap_or_default();
            if !label.is_empty() {
                drawing.label(
                    [field.left - 8.0, y + 0.35 * TICK_SIZE],
                    label,
                    &text.align(Align::Right),
                );
            }
        }
        let corners = [
            [field.left, field.top],
            [field.left, field.bottom],
            [field.right, field.bottom],
        ];
        drawing.polyline(&corners, &Pen::line(FRAME, 1.2));
        let title = Label::default().size(TITLE_SIZE).align(Align::Centre);
        let (across, upwards) = (
            0.5 * (field.left + field.right),
            0.5 * (field.top + field.bottom),
        );
        drawing.label([across, field.bottom + 42.0], &self.x.heading(), &title);
        drawing.label([20.0, upwards], &self.y.heading(), &title.turn(90.0));
    }

    fn draw_legend(&self, drawing: &mut Drawing, field: &Field) -> Result<(), RenderError> {
        if !self.has_legend() {
            return Ok(());
        }
        let named: Vec<(usize, &Series)> = self
            .series
            .iter()
            .enumerate()
            .filter(|(_, series)| !series.name.is_empty())
            .collect();
        let (row, width) = (20.0, self.legend_width()?);
        let height = row * named.len() as f64;
        let (left, top) = match self.legend {
            Legend::UpperRight => (field.right - width - 14.0, field.top + 10.0),
            Legend::LowerLeft => (field.left + 14.0, field.bottom - height - 10.0),
            _ => (field.right + 18.0, field.top + 4.0),
        };
        if self.legend != Legend::Beside {
            let (right, bottom) = (left + width + 8.0, top + height + 4.0);
            let (left, top) = (left - 8.0, top - 4.0);
            let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
            drawing.polygon(&corners, &Pen::line(GRID, 1.0).fill([255; 3]));
        }
        for (line, (index, series)) in named.into_iter().enumerate() {
            let y = top + row * (line as f64 + 0.5);
            draw_stroke(drawing, &[[left, y], [left + 28.0, y]], series, index);
            if series.markers {
                draw_marker(drawing, [left + 14.0, y], index, colour_of(series, index));
            }
            let text = Label::default().size(TICK_SIZE);
            drawing.label([left + 36.0, y + 0.35 * TICK_SIZE], &series.name, &text);
        }
        Ok(())
    }
}

fn colour_of(series: &Series, index: usize) -> [u8; 3] {
    series.colour.unwrap_or(PALETTE[index % PALETTE.len()])
}

fn draw_stroke(drawing: &mut Drawing, points: &[[f64; 2]], series: &Series, index: usize) {
    if series.line {
        let pen = Pen::line(colour_of(series, index), 2.0);
        let pen = if series.dashed {
            pen.dashes(&[6.0, 5.0])
        } else {
            pen
        };
        drawing.polyline(points, &pen);
    }
}

/// Points outside of a range that was given are left out, and the line is broken there.
fn draw_series(drawing: &mut Drawing, field: &Field, series: &Series, index: usize) {
    let inside = |range: &Range, value: f64| value >= range.low && value <= range.high;
    let seen = |p: &&[f64; 2]| inside(&field.x, p[0]) && inside(&field.y, p[1]);
    for run in series.points.chunk_by(|a, b| seen(&a) == seen(&b)) {
        if run.first().is_some_and(|first| !seen(&first)) {
            continue;
        }
        let places: Vec<[f64; 2]> = run.iter().map(|&p| field.at(p)).collect();
        draw_stroke(drawing, &places, series, index);
    }
    if series.markers {
        for &point in series.points.iter().filter(seen) {
            draw_marker(drawing, field.at(point), index, colour_of(series, index));
        }
    }
}

/// Each series has its own shape, so that the plot reads without colour too.
fn draw_marker(drawing: &mut Drawing, [x, y]: [f64; 2], index: usize, colour: [u8; 3]) {
    let pen = Pen::line([255; 3], 1.0).fill(colour);
    let shape = |drawing: &mut Drawing, corners: &[[f64; 2]]| {
        let places: Vec<[f64; 2]> = corners.iter().map(|[dx, dy]| [x + dx, y + dy]).collect();
        drawing.polygon(&places, &pen);
    };
    match index % 4 {
        0 => drawing.circle([x, y], 4.0, &pen),
        1 => shape(
            drawing,
            &[[-3.7, -3.7], [3.7, -3.7], [3.7, 3.7], [-3.7, 3.7]],
        ),
        2 => shape(drawing, &[[0.0, -4.8], [4.5, 3.4], [-4.5, 3.4]]),
        _ => shape(drawing, &[[0.0, -5.0], [5.0, 0.0], [0.0, 5.0], [-5.0, 0.0]]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<[f64; 2]>) -> Plot {
        Plot::new(
            "Error",
            Axis::new("triangles"),
            Axis::new("distance").unit("%"),
        )
        .with(Series::new("limit normal", points))
    }

    /// The centres of the circles that mark the first series.
    fn circles(file: &str) -> Vec<[f64; 2]> {
        let value = |line: &str, name: &str| {
            let start = line.find(name).unwrap() + name.len();
            line[start..]
                .split('"')
                .next()
                .unwrap()
                .parse::<f64>()
                .unwrap()
        };
        let lines = file.lines().filter(|line| line.contains("<circle"));
        lines
            .map(|line| [value(line, "cx=\""), value(line, "cy=\"")])
            .collect()
    }

    #[test]
    fn equal_ratios_are_equally_long_on_logarithmic_axes() {
        let mut plot = plot(vec![[10.0, 8.0], [100.0, 4.0], [1000.0, 2.0]]);
        plot.x = plot.x.logarithmic();
        plot.y = plot.y.logarithmic();
        let centres = circles(&plot.to_svg().unwrap());
        assert_eq!(centres.len(), 4, "three points and the legend");
        let [first, second, third] = [centres[0], centres[1], centres[2]];
        for axis in 0..2 {
            let steps = [second[axis] - first[axis], third[axis] - second[axis]];
            assert!(
                (steps[0] - steps[1]).abs() < 0.01 && steps[0].abs() > 50.0,
                "{steps:?}"
            );
        }
        assert!(centres[0][1] < centres[2][1], "larger is higher");
    }

    #[test]
    fn points_beyond_a_given_range_are_left_out() {
        let mut plot =
            plot(vec![[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [9.0, 1.0]]).legend(Legend::None);
        plot.x = plot.x.range(0.5, 3.0);
        assert_eq!(circles(&plot.to_svg().unwrap()).len(), 2);
    }

    #[test]
    fn bad_input_is_refused() {
        assert_eq!(plot(vec![]).to_svg(), Err(RenderError::Empty));
        assert!(plot(vec![[0.0, f64::NAN]]).to_svg().is_err());
        assert!(plot(vec![[1.0, 1.0]]).size(10.0, 10.0).to_svg().is_err());
        let mut logarithmic = plot(vec![[0.0, 1.0]]);
        logarithmic.x = logarithmic.x.logarithmic();
        assert!(logarithmic.to_svg().is_err());
        let mut swapped = plot(vec![[0.0, 1.0]]);
        swapped.x = swapped.x.range(2.0, 1.0);
        assert!(swapped.to_svg().is_err());
        assert!(
            plot(vec![[1.0, 1.0]]).to_svg().is_ok(),
            "a single point has a plot"
        );
    }
}
