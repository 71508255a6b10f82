//! `limitmesh project`: points, as of a scan, against the true limit surface.

use std::path::Path;
use std::time::Instant;

use anyhow::Context;
use limitmesh::{Closest, LimitSurface, Membership, Proximity, ProximityError, Triangles};
use limitmesh_io::{Format, Output, Property, WriteOptions};
use limitmesh_render::{ColourMap, Scale};

use super::heatmap;
use super::limit_control;
use crate::arguments::ProjectArguments;
use crate::failure::{Outcome, usage};
use crate::format::{counted, lower_bound, number, point, thousands};
use crate::input;
use crate::output;
use crate::points::{self, Points};
use crate::progress::Progress;
use crate::report::projection::{
    ControlReport, DistancesReport, FarthestReport, PointsReport, ProjectionReport,
};
use crate::report::{VERSION, percent};
use crate::vector::{dot, minus};

/// Projects points.
pub(crate) fn run(arguments: &ProjectArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    input::check_once([&arguments.points, &arguments.onto].into_iter())?;
    let kind = arguments.output.as_deref().map(Kind::of).transpose()?;
    if let Some(output) = &arguments.output {
        let inputs: [&Path; 2] = [&arguments.points, &arguments.onto];
        output::check_replaced(&[output], &inputs, Some(arguments.overwrite))?;
    }
    let start = Instant::now();
    let points = points::read(&arguments.points, &arguments.limit.build, progress)?;
    let (control, limit) = limit_control::load(&arguments.onto, &arguments.limit, progress)?;
    let points = points.in_unit(control.unit, progress);
    let (name, diagonal) = (control.name.clone(), control.mesh.diagonal());
    let scheme = limit.scheme();
    let prepared = limit_control::prepared(control, &limit, progress)?;
    let mesh = prepared.input.mesh;
    if kind == Some(Kind::Picture) && points.triangles.is_empty() {
        return usage(format!(
            "{} has no triangles to draw; -o writes .ply or .csv",
            points.name
        ));
    }
    let unit = prepared.limit.build.unit;
    let tolerance = arguments.tolerance.length(diagonal, unit)?;

    progress.stage(format!(
        "projecting {}",
        counted(points.positions.len(), "point", "points")
    ));
    let surface = LimitSurface::new(&mesh, scheme.scheme()).with_context(|| name.clone())?;
    let found = Found::of(&surface, &points.positions, tolerance, progress)
        .with_context(|| name.clone())?;
    let report = ProjectionReport {
        version: VERSION,
        points: PointsReport {
            path: points.name.clone(),
            count: points.positions.len(),
        },
        control: ControlReport {
            path: name,
            triangles: mesh.face_count(),
            diagonal,
            scheme,
        },
        tolerance,
        sign: found.sign,
        distance: found.statistics(&points.positions),
        seconds: start.elapsed().as_secs_f64(),
    };
    if let (Some(path), Some(kind)) = (&arguments.output, kind) {
        progress.stage(format!("writing {}", path.display()));
        match kind {
            Kind::Ply => found.write_ply(path, &points)?,
            Kind::Csv => output::write_file(path, found.csv(&points.positions).as_bytes())?,
            Kind::Picture => found.draw(path, &points)?,
        }
    }
    progress.clear();
    output::print(&if arguments.json {
        output::json(&report)?
    } else {
        in_words(&report)
    })?;
    Ok(Outcome::Done)
}

/// The files and bytes that are written.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Ply,
    Csv,
    Picture,
}

impl Kind {
    /// By the name of the file, before any work is done.
    fn of(path: &Path) -> anyhow::Result<Self> {
        let extension = path.extension().map(|own| own.to_ascii_lowercase());
        let kind = match extension.as_ref().and_then(|own| own.to_str()) {
            Some("ply") => Self::Ply,
            Some("csv") => Self::Csv,
            Some("png") => Self::Picture,
            _ => {
                return usage(format!(
                    "{}: -o writes .ply, .csv or .png files",
                    path.display()
                ));
            }
        };
        output::check_writable(path)?;
        Ok(kind)
    }
}

/// The results, by point.
struct Found {
    closest: Vec<Closest>,
    /// Distances, below 0 inside or behind.
    signed: Vec<f64>,
    sign: &'static str,
}

impl Found {
    fn of(
        surface: &LimitSurface<'_>,
        points: &[[f64; 3]],
        tolerance: f64,
        progress: &Progress,
    ) -> anyhow::Result<Self> {
        let proximity = Proximity::new_observed(surface, &mut progress.observer())?;
        let closest = proximity.closest_observed(points, tolerance, &mut progress.observer())?;
        let (is_negative, sign) =
            match proximity.memberships_observed(points, &mut progress.observer()) {
                Ok(found) => (
                    found.iter().map(|&at| at == Membership::Inside).collect(),
                    "inside",
                ),
                Err(ProximityError::Open { .. }) => (behind(surface, points, &closest), "normal"),
                Err(error) => return Err(error.into()),
            };
        let signed = closest.iter().zip::<Vec<bool>>(is_negative);
        let signed = signed
            .map(|(at, negative)| if negative { -at.distance } else { at.distance })
            .collect();
        Ok(Self {
            closest,
            signed,
            sign,
        })
    }

    fn statistics(&self, points: &[[f64; 3]]) -> Option<DistancesReport> {
        let mut sorted: Vec<f64> = self.closest.iter().map(|at| at.distance).collect();
        let farthest =
            (0..sorted.len()).max_by(|&a, &b| sorted[a].total_cmp(&sorted[b]).then(b.cmp(&a)))?;
        sorted.sort_unstable_by(f64::total_cmp);
        let count = sorted.len() as f64;
        // Nearest rank: the least value that so many do not exceed.
        let percentile =
            |share: f64| sorted[((share * count).ceil() as usize).clamp(1, sorted.len()) - 1];
        // Squares of what is scaled to at most 1 neither vanish nor overflow.
        let greatest = percentile(1.0);
        let scaled = |x: f64| if greatest > 0.0 { x / greatest } else { 0.0 };
        let squares: f64 = sorted.iter().map(|&x| scaled(x).powi(2)).sum();
        let ends = |from, f: fn(f64, f64) -> f64| self.signed.iter().copied().fold(from, f);
        let at = &self.closest[farthest];
        Some(DistancesReport {
            mean: greatest * (sorted.iter().map(|&x| scaled(x)).sum::<f64>() / count),
            root_mean_square: greatest * (squares / count).sqrt(),
            median: percentile(0.5),
            percentile_95: percentile(0.95),
            signed_mean: greatest * (self.signed.iter().map(|&x| scaled(x)).sum::<f64>() / count),
            least: ends(f64::INFINITY, f64::min),
            greatest: ends(f64::NEG_INFINITY, f64::max),
            negative: self
                .signed
                .iter()
                .filter(|&&distance| distance < 0.0)
                .count(),
            farthest: FarthestReport {
                index: farthest,
                point: points[farthest],
                distance: self.signed[farthest],
                lower: at.lower,
                closest: at.point,
                face: at.face.0,
                barycentric: at.barycentric,
            },
        })
    }

    /// Blue below 0, red above, alike on both sides.
    fn scale(&self) -> Scale {
        let most = self
            .closest
            .iter()
            .map(|at| at.distance)
            .fold(0.0, f64::max);
        Scale::new(-most, most).with_map(ColourMap::Diverging)
    }

    fn write_ply(&self, path: &Path, points: &Points) -> anyhow::Result<()> {
        let scale = self.scale();
        let colours: Vec<[u8; 3]> = self
            .signed
            .iter()
            .map(|&distance| scale.colour(distance))
            .collect();
        let by = |value: fn(&Closest) -> [f64; 3]| {
            let column = |axis: usize| self.closest.iter().map(|at| value(at)[axis]).collect();
            [0, 1, 2].map(column)
        };
        let [x, y, z]: [Vec<f64>; 3] = by(|at| at.point);
        let [w0, w1, w2]: [Vec<f64>; 3] = by(|at| at.barycentric);
        let faces: Vec<u32> = self.closest.iter().map(|at| at.face.0).collect();
        let properties = [
            Property::numbers("closest_x", &x),
            Property::numbers("closest_y", &y),
            Property::numbers("closest_z", &z),
            Property::integers("control_face", &faces),
            Property::numbers("w0", &w0),
            Property::numbers("w1", &w1),
            Property::numbers("w2", &w2),
        ];
        let surface = Triangles {
            positions: &points.positions,
            triangles: &points.triangles,
        };
        let output = Output {
            vertex_properties: &properties,
            ..Output::new(surface)
        };
        let output = output.quality(&self.signed).colours(&colours);
        output::write_mesh(path, Format::Ply, &output, &WriteOptions::default())
    }

    fn csv(&self, points: &[[f64; 3]]) -> String {
        let mut text =
            "x,y,z,distance,closest_x,closest_y,closest_z,control_face,w0,w1,w2\n".to_owned();
        for ((point, at), signed) in points.iter().zip(&self.closest).zip(&self.signed) {
            let joined = |values: [f64; 3]| values.map(|value| value.to_string()).join(",");
            let (point, closest, weights) =
                (joined(*point), joined(at.point), joined(at.barycentric));
            text.push_str(&format!(
                "{point},{signed},{closest},{},{weights}\n",
                at.face.0
            ));
        }
        text
    }

    fn draw(&self, path: &Path, points: &Points) -> anyhow::Result<()> {
        let surface = Triangles {
            positions: &points.positions,
            triangles: &points.triangles,
        };
        heatmap::draw_values(
            path,
            surface,
            &self.signed,
            self.scale(),
            "signed distance",
            "",
        )
    }
}

/// Which points are on the side of the closest point from which the control face runs clockwise.
fn behind(surface: &LimitSurface<'_>, points: &[[f64; 3]], closest: &[Closest]) -> Vec<bool> {
    let places: Vec<_> = closest.iter().map(|at| (at.face, at.barycentric)).collect();
    let normals = surface.at_all(&places);
    let pairs = closest.iter().zip(points.iter().zip(&normals));
    pairs
        .map(|(at, (&point, there))| dot(minus(point, at.point), there.normal) < 0.0)
        .collect()
}

fn in_words(report: &ProjectionReport) -> String {
    let ProjectionReport {
        points, control, ..
    } = report;
    let mut text = format!(
        "{} of {} onto the limit surface of {} ({})\n",
        counted(points.count, "point", "points"),
        points.path,
        control.path,
        counted(control.triangles, "triangle", "triangles"),
    );
    let Some(distance) = &report.distance else {
        return text;
    };
    let percent = |length: f64| {
        let percent = percent(length, control.diagonal);
        if percent.is_finite() {
            format!("  ({} %)", number(percent))
        } else {
            String::new()
        }
    };
    for (what, length) in [
        ("mean", distance.mean),
        ("RMS", distance.root_mean_square),
        ("95 %", distance.percentile_95),
        (
            "greatest",
            distance.greatest.abs().max(distance.least.abs()),
        ),
    ] {
        text.push_str(&format!(
            "  {what:<9} {}{}\n",
            number(length),
            percent(length)
        ));
    }
    let inside = if report.sign == "inside" {
        "inside"
    } else {
        "behind it, by its normals"
    };
    text.push_str(&format!(
        "signed from {} to {}, {} on the average; {} {inside}\n",
        number(distance.least),
        number(distance.greatest),
        number(distance.signed_mean),
        thousands(distance.negative),
    ));
    let farthest = &distance.farthest;
    text.push_str(&format!(
        "farthest is point {} at {}, certainly {} away or more; closest point {} on control face {}\n",
        farthest.index,
        point(farthest.point),
        lower_bound(farthest.lower),
        point(farthest.closest),
        farthest.face,
    ));
    text.push_str(&format!(
        "no distance is too great by more than {}; per cent are of the control mesh's diagonal {}\n",
        number(report.tolerance),
        number(control.diagonal)
    ));
    text
}
