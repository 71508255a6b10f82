//! Charts of measured distances: a dot chart for Table 1 and small line charts for the drift, both on
//! logarithmic scales, since the distances span orders of magnitude.

use limitmesh_render::svg::{Drawing, Pen};
use limitmesh_render::{Align, RenderError};

use super::palette::{
    AMRESH, EXACT, GRID, PALE, PAPER, PLANARITY, SQRT3, UNIFORM, VERTEX_ERROR, dot, plain, small,
    thin,
};
use super::room::{Legend, Room, lines, paragraph, width_of};
use super::study::{DriftPoint, Measured, Row};

/// A logarithmic axis: from values to pixels, over whole decades or halves of them.
struct LogAxis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl LogAxis {
    /// An axis that shows all of `values` between the pixels `from` and `to`.
    fn new(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (low, high) = values
            .filter(|v| *v > 0.0)
            .fold((f64::MAX, f64::MIN), |(low, high), v| {
                (low.min(v.log10()), high.max(v.log10()))
            });
        if low > high {
            return Self {
                low: -1.0,
                high: 0.0,
                from,
                to,
            };
        }
        Self {
            low: low - 0.12,
            high: high + 0.12,
            from,
            to,
        }
    }

    fn at(&self, value: f64) -> f64 {
        let t = (value.max(f64::MIN_POSITIVE).log10() - self.low) / (self.high - self.low);
        self.from + t.clamp(0.0, 1.0) * (self.to - self.from)
    }

    /// The values 1, 2 and 5 times powers of ten within the axis.
    fn ticks(&self) -> Vec<f64> {
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        let all = decades.flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(d)));
        all.filter(|v| (self.low..=self.high).contains(&v.log10()))
            .collect()
    }
}

/// A tick's value, with as many digits as it needs.
fn tick_label(value: f64) -> String {
    let decimals = (-value.log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{value:.decimals$}")
}

/// What the horizontal axis of Table 1's chart and the vertical ones of the drift show.
const DISTANCE: &str =
    "symmetric Hausdorff distance, % of the control mesh's diagonal (logarithmic)";

/// Table 1 as a dot chart: a line for each setting, a dot for each method.
pub(super) fn table_1(rows: &[Row], room: Room) -> Result<String, RenderError> {
    let step = 19.0;
    let gap = 12.0;
    let (width, left) = room.pick((760.0, 150.0), (Room::NARROW, 56.0));
    let right = width - 20.0;
    // Beside the first of its lines a model's name has no room on a phone: it gets a line of its own.
    let name = room.pick(0.0, step);
    let entries = [
        (PAPER, "limit normal (paper)"),
        (AMRESH, "Amresh"),
        (UNIFORM, "uniform, limit vertices (nearest count)"),
        (PLANARITY, "planarity (Zorin)"),
        (VERTEX_ERROR, "vertex errors (Müller)"),
        (SQRT3, "√3 (Kobbelt), to its own limit"),
        (EXACT, "exact"),
    ];
    let legend = Legend::new(&entries, width - 20.0)?;
    let words = plain().size(12.0).align(Align::Centre);
    let caption = lines(&format!("{DISTANCE}; left is better"), width - 20.0, &words)?;
    let top = 26.0 + legend.height();
    let models = rows.chunk_by(|a, b| a.model == b.model).count() as f64;
    let bottom = top + rows.len() as f64 * step + models * (gap + name);
    let mut drawing = Drawing::new(width, bottom + 30.0 + 17.0 * caption.len() as f64)?;
    let values = rows
        .iter()
        .flat_map(dots_of)
        .map(|(measured, _)| measured.shd_percent);
    let axis = LogAxis::new(values, left, right);
    let mut free = 0.0;
    for tick in axis.ticks() {
        let (x, label) = (axis.at(tick), tick_label(tick));
        drawing.line([x, top - 8.0], [x, bottom], &thin(GRID));
        let half = 0.5 * width_of(&label, &small())?;
        if x - half > free && x + half < width {
            drawing.label([x, bottom + 16.0], &label, &small().align(Align::Centre));
            free = x + half + 3.0;
        }
    }
    paragraph(&mut drawing, [0.5 * width, bottom + 36.0], &caption, &words);
    legend.draw(&mut drawing, [10.0, 8.0]);
    let mut y = top;
    for model in rows.chunk_by(|a, b| a.model == b.model) {
        y += 0.5 * gap;
        if let Some(row) = model.first() {
            drawing.label([10.0, y + 0.5 * step + 4.5], row.model, &plain().bold(true));
        }
        y += name;
        for row in model {
            let middle = y + 0.5 * step;
            let label = format!("{}°", row.angle_degrees);
            drawing.label(
                [left - 14.0, middle + 4.5],
                &label,
                &plain().colour(PALE).align(Align::Right),
            );
            dots(&mut drawing, row, &axis, middle);
            y += step;
        }
        y += 0.5 * gap;
    }
    drawing.finish()
}

/// What is shown of a row, what matters most last.
fn dots_of(row: &Row) -> [(&Measured, [u8; 3]); 7] {
    [
        (&row.uniform_limit, UNIFORM),
        (&row.vertex_error, VERTEX_ERROR),
        (&row.planarity, PLANARITY),
        (&row.sqrt3, SQRT3),
        (&row.amresh, AMRESH),
        (&row.paper, PAPER),
        (&row.exact, EXACT),
    ]
}

fn dots(drawing: &mut Drawing, row: &Row, axis: &LogAxis, y: f64) {
    let all = dots_of(row).map(|(measured, colour)| (axis.at(measured.shd_percent), colour));
    let places = all.iter().map(|&(x, _)| x);
    let (low, high) = (
        places.clone().fold(f64::MAX, f64::min),
        places.fold(f64::MIN, f64::max),
    );
    drawing.line([low, y], [high, y], &thin(PALE).opacity(0.6));
    for (x, colour) in all {
        dot(drawing, [x, y], 5.0, colour);
    }
}

/// Distance against steps, a small chart for each model, all on the same scales.
pub(super) fn drift(
    points: &[DriftPoint],
    angle_degrees: f64,
    room: Room,
) -> Result<String, RenderError> {
    let models: Vec<&[DriftPoint]> = points.chunk_by(|a, b| a.model == b.model).collect();
    let columns = models.len().clamp(1, room.pick(3, 2));
    let (cell, height, left) = (room.pick(236.0, 167.0), 190.0, 46.0);
    let rows = models.len().div_ceil(columns);
    let width = left + columns as f64 * cell;
    let paper = format!("limit normal, {angle_degrees}° (paper)");
    let entries = [
        (PAPER, paper.as_str()),
        (UNIFORM, "uniform, limit vertices, as many levels"),
    ];
    let legend = Legend::new(&entries, width - 20.0)?;
    let words = plain().size(12.0).align(Align::Centre);
    let caption = lines(
        &format!("steps; vertically the {DISTANCE}"),
        width - 20.0,
        &words,
    )?;
    let top = 24.0 + legend.height();
    let bottom = top + rows as f64 * height;
    let mut drawing = Drawing::new(width, bottom + 12.0 + 17.0 * caption.len() as f64)?;
    legend.draw(&mut drawing, [10.0, 8.0]);
    for (i, model) in models.iter().enumerate() {
        let (column, row) = (i % columns, i / columns);
        let x = left + column as f64 * cell;
        let y = top + row as f64 * height;
        panel(
            &mut drawing,
            model,
            points,
            [x, y, cell - 18.0, height - 44.0],
            column == 0,
        );
    }
    paragraph(&mut drawing, [0.5 * width, bottom + 14.0], &caption, &words);
    drawing.finish()
}

fn panel(
    drawing: &mut Drawing,
    model: &[DriftPoint],
    all: &[DriftPoint],
    [x, y, width, height]: [f64; 4],
    labelled: bool,
) {
    let values = |p: &DriftPoint| {
        [
            Some(p.paper.shd_percent),
            p.uniform_limit.map(|m| m.shd_percent),
        ]
    };
    let axis = LogAxis::new(all.iter().flat_map(values).flatten(), y + height, y + 20.0);
    let most = all.iter().map(|p| p.steps).max().unwrap_or(1);
    let across = |steps: usize| {
        x + 14.0 + (width - 28.0) * (steps as f64 - 1.0) / (most as f64 - 1.0).max(1.0)
    };
    let name = model.first().map_or("", |p| p.model);
    drawing.label([x + 6.0, y + 11.0], name, &plain().bold(true));
    for tick in axis.ticks() {
        drawing.line([x, axis.at(tick)], [x + width, axis.at(tick)], &thin(GRID));
        if labelled {
            drawing.label(
                [x - 6.0, axis.at(tick) + 4.0],
                &tick_label(tick),
                &small().align(Align::Right),
            );
        }
    }
    drawing.line([x, y + height], [x + width, y + height], &thin(PALE));
    for steps in 1..=most {
        drawing.label(
            [across(steps), y + height + 15.0],
            &steps.to_string(),
            &small().align(Align::Centre),
        );
    }
    let uniform = model
        .iter()
        .filter_map(|p| Some((p.steps, p.uniform_limit?.shd_percent)));
    let paper = model.iter().map(|p| (p.steps, p.paper.shd_percent));
    curve(
        drawing,
        UNIFORM,
        uniform.map(|(s, v)| [across(s), axis.at(v)]).collect(),
    );
    curve(
        drawing,
        PAPER,
        paper.map(|(s, v)| [across(s), axis.at(v)]).collect(),
    );
}

fn curve(drawing: &mut Drawing, colour: [u8; 3], points: Vec<[f64; 2]>) {
    drawing.polyline(&points, &Pen::line(colour, 2.0));
    for point in points {
        dot(drawing, point, 4.0, colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_lie_on_the_axis_in_order() {
        let axis = LogAxis::new([0.03, 4.0].into_iter(), 100.0, 500.0);
        let ticks = axis.ticks();
        assert_eq!(ticks.len(), 7, "{ticks:?}");
        for (tick, expected) in ticks.iter().zip([0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0]) {
            assert!((tick - expected).abs() < 1e-12);
        }
        assert_eq!(
            ticks.iter().map(|&t| tick_label(t)).collect::<Vec<_>>(),
            ["0.05", "0.1", "0.2", "0.5", "1", "2", "5"]
        );
    }

    #[test]
    fn an_axis_without_values_still_maps() {
        assert!(LogAxis::new([].into_iter(), 0.0, 1.0).at(0.0).is_finite());
    }
}
