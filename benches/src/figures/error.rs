//! One plot of distance against triangles for all methods.

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::refine::limit_reference;
use limitmesh::refine::{Finish, SeamRule};
use limitmesh::scheme::Loop;
use limitmesh_paper::methods;
use limitmesh_render::plot::{Axis, Plot, Series};

use crate::quality::{Judge, Reference, best, builtin, optimized};

const MODEL: &str = "cup";

/// Angles in degrees at which the methods with an angle are run.
const ANGLES: [f64; 9] = [40.0, 30.0, 20.0, 15.0, 10.0, 7.0, 5.0, 3.0, 2.0];

const LEVELS: usize = 4;

/// More triangles are not shown: the mesh that stands for the limit surface has some three millions.
const MOST_TRIANGLES: usize = 200_000;

/// The SVG file.
pub(super) fn plot() -> Result<String> {
    let control = builtin(MODEL)?;
    let reference = Reference::new(&control)?;
    let judge = Judge::new(&reference)?;
    let faces = control.face_count();
    // Twice as many from point to point, from a little more than the control mesh has.
    let counts: Vec<usize> = (0..)
        .map(|i| (faces * 3 / 2) << i)
        .take_while(|&n| n <= MOST_TRIANGLES)
        .collect();
    let counted = |refine: &dyn Fn(usize) -> Result<Mesh>| series(&judge, &counts, refine);
    let levels: Vec<usize> = (0..=LEVELS).collect();
    let uniform = |limit: bool| {
        series(&judge, &levels, &|level| {
            Ok(if limit {
                limit_reference(&control, &Loop, level)?
            } else {
                methods::uniform_plain(&control, level)?.mesh
            })
        })
    };
    let paper = |steps| {
        series(&judge, &ANGLES, &|angle| {
            Ok(methods::paper(&control, angle, steps, SeamRule::All)?.mesh)
        })
    };
    let title = format!("Distance to the limit surface, {MODEL}");
    let y = Axis::new("symmetric Hausdorff distance")
        .unit("% of the diagonal")
        .logarithmic();
    let plot = Plot::new(title, Axis::new("triangles").logarithmic(), y)
        .size(860.0, 520.0)
        .with(
            named(
                "Amresh, 4 steps",
                series(&judge, &ANGLES, &|angle| {
                    Ok(methods::amresh(&control, angle, 4)?.mesh)
                })?,
                [150, 150, 158],
            )
            .dashed(true),
        )
        .with(named("paper, 3 steps", paper(3)?, [214, 96, 28]))
        .with(named("paper, 5 steps", paper(5)?, [214, 96, 28]).dashed(true))
        .with(named("uniform", uniform(false)?, [204, 154, 24]))
        .with(named(
            "uniform, limit vertices",
            uniform(true)?,
            [84, 168, 214],
        ))
        .with(named(
            "exact",
            counted(&|n| best(&control, n, Finish::OnSurface))?,
            [20, 92, 158],
        ))
        .with(named(
            "exact, balanced",
            counted(&|n| best(&control, n, Finish::Balanced))?,
            [26, 138, 104],
        ))
        .with(named(
            "exact, optimised",
            counted(&|n| optimized(&control, n))?,
            [150, 62, 134],
        ));
    Ok(plot.to_svg()?)
}

fn named(name: &str, points: Vec<[f64; 2]>, colour: [u8; 3]) -> Series {
    Series::new(name, points).colour(colour)
}

/// Triangles and distance of each mesh that is not too fine; those with the same count only once.
fn series<T: Copy>(
    judge: &Judge<'_>,
    settings: &[T],
    refine: &dyn Fn(T) -> Result<Mesh>,
) -> Result<Vec<[f64; 2]>> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for &setting in settings {
        let mesh = refine(setting)?;
        let triangles = mesh.face_count() as f64;
        if mesh.face_count() > MOST_TRIANGLES
            || points.last().is_some_and(|last| last[0] == triangles)
        {
            continue;
        }
        points.push([triangles, judge.percent(judge.distance(&mesh)?)]);
    }
    Ok(points)
}
