//! `limitmesh info`: what is in a file, what would be repaired, what control mesh comes of it.

use std::collections::BTreeMap;

use limitmesh_io::gltf::AssetContents;

use crate::arguments::InfoArguments;
use crate::bulk::Bulk;
use crate::dihedral::Dihedrals;
use crate::failure::Outcome;
use crate::format::{counted, number, point, table, thousands};
use crate::input;
use crate::mesh_info;
use crate::output;
use crate::progress::Progress;
use crate::report::information::{PolygonCount, TagCounts};
use crate::report::{
    ChannelReport, InformationReport, InputReport, MeshInformation, PackageInformation, VERSION,
};

/// Examines a file and prints what it holds.
pub(crate) fn run(arguments: &InfoArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    let mut read = input::read(&arguments.input, &arguments.build, progress)?;
    let soup = &read.soup;
    let mut corners = BTreeMap::<usize, usize>::new();
    for face in soup.faces.iter() {
        *corners.entry(face.len()).or_default() += 1;
    }
    let polygons = corners.into_iter();
    let polygons = polygons
        .map(|(corners, count)| PolygonCount { corners, count })
        .collect();
    let tags = TagCounts {
        creases: soup.creases.len(),
        corners: soup.corners.len(),
    };
    let report = InputReport {
        path: read.name.clone(),
        format: read.format,
        vertices: soup.positions.len(),
        faces: soup.faces.len(),
        left_out: soup.left_out.clone(),
        channels: soup.channels.iter().map(Into::into).collect(),
    };
    let (asset, package) = (read.asset.take(), read.package.take());
    let input = input::connected(read, &arguments.build, progress)?;
    progress.stage("examining the mesh");
    let found = [input.diagnosis.preparations(), input.diagnosis.repairs()].concat();
    let report = InformationReport {
        version: VERSION,
        input: report,
        polygons,
        tags,
        asset: asset.map(|(_, contents)| contents),
        package: package
            .zip(input.unit)
            .map(|(contents, unit)| PackageInformation {
                unit: unit.name(),
                contents,
            }),
        diagnosis: (&input.diagnosis).into(),
        mesh: mesh_info::examine(&input.mesh, &input.trace.faces),
    };
    progress.clear();
    if arguments.json {
        output::print(&output::json(&report)?)?;
    } else {
        let mut text = describe_file(&report);
        text.push_str("\nfound\n");
        if found.is_empty() {
            text.push_str("  nothing to prepare or repair\n");
        }
        found
            .iter()
            .for_each(|line| text.push_str(&format!("  {line}\n")));
        text.push_str("\ncontrol mesh\n");
        text.push_str(&describe_mesh(&report.mesh));
        output::print(&text)?;
    }
    Ok(Outcome::Done)
}

fn describe_file(report: &InformationReport) -> String {
    let InputReport {
        path,
        format,
        vertices,
        faces,
        left_out,
        channels,
    } = &report.input;
    let is_asset = ["gltf", "glb"].contains(format);
    let format = if *format == "builtin" {
        "built-in model".to_owned()
    } else {
        format.to_uppercase()
    };
    let mut text = format!(
        "{path}: {format}, {}, {}",
        counted(*vertices, "vertex", "vertices"),
        counted(*faces, "face", "faces")
    );
    let sizes: Vec<String> = report
        .polygons
        .iter()
        .map(|p| format!("{} with {} corners", thousands(p.count), p.corners))
        .collect();
    if report.polygons.iter().any(|p| p.corners != 3) {
        text.push_str(&format!(" ({})", sizes.join(", ")));
    }
    text.push('\n');
    if !channels.is_empty() {
        let all: Vec<String> = channels.iter().map(ChannelReport::in_words).collect();
        text.push_str(&format!("carries: {}\n", all.join("; ")));
    }
    if !left_out.is_empty() {
        // Assets that are edited keep them.
        let are = if is_asset {
            "not looked at, kept from glTF to glTF"
        } else {
            "left out"
        };
        text.push_str(&format!("{are}: {}\n", left_out.join("; ")));
    }
    let TagCounts { creases, corners } = report.tags;
    if creases + corners > 0 {
        let (creases, corners) = (
            counted(creases, "crease", "creases"),
            counted(corners, "corner", "corners"),
        );
        text.push_str(&format!("tagged: {creases}, {corners}\n"));
    }
    report
        .asset
        .iter()
        .for_each(|asset| text.push_str(&describe_asset(asset)));
    report
        .package
        .iter()
        .for_each(|package| text.push_str(&describe_package(package)));
    text
}

/// The contents of a glTF document, a line for each mesh and primitive.
fn describe_asset(asset: &AssetContents) -> String {
    let mut text = String::from("\nasset\n");
    let counts: Vec<String> = asset
        .counts
        .iter()
        .map(|(name, count)| format!("{name}: {}", thousands(*count)))
        .collect();
    if !counts.is_empty() {
        text.push_str(&format!("  {}\n", counts.join(", ")));
    }
    if !asset.extensions.is_empty() {
        text.push_str(&format!("  extensions: {}\n", asset.extensions.join(", ")));
    }
    for (number, mesh) in asset.meshes.iter().enumerate() {
        let name = mesh
            .name
            .as_ref()
            .map_or(String::new(), |name| format!(" '{name}'"));
        let shown = match mesh.shown {
            1 => String::new(),
            0 => ", not in the scene".to_owned(),
            times => format!(", {} times in the scene", thousands(times)),
        };
        text.push_str(&format!("  mesh {number}{name}{shown}\n"));
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let vertices = counted(primitive.vertices, "vertex", "vertices");
            let indices = counted(primitive.indices, "index", "indices");
            let mut parts = vec![
                format!("{}, {vertices}, {indices}", primitive.mode),
                primitive.attributes.join(" "),
            ];
            if primitive.morph_targets > 0 {
                parts.push(counted(
                    primitive.morph_targets,
                    "morph target",
                    "morph targets",
                ));
            }
            parts.extend(
                primitive
                    .material
                    .iter()
                    .map(|name| format!("material '{name}'")),
            );
            if !primitive.extensions.is_empty() {
                parts.push(primitive.extensions.join(" "));
            }
            text.push_str(&format!("    primitive {number}: {}\n", parts.join("; ")));
        }
    }
    text
}

/// The contents of a 3MF package, a line for each object.
fn describe_package(
    PackageInformation {
        unit,
        contents: package,
    }: &PackageInformation,
) -> String {
    let items = counted(package.items, "item is", "items are");
    let mut text = format!("\npackage\n  in {unit}; {items} built");
    if package.assemblies > 0 {
        text.push_str(&format!(
            ", {} of others",
            counted(package.assemblies, "object", "objects")
        ));
    }
    text.push('\n');
    for object in &package.objects {
        let vertices = counted(object.vertices, "vertex", "vertices");
        let triangles = counted(object.triangles, "triangle", "triangles");
        let built = counted(object.built, "time", "times");
        let mut parts = vec![format!("{vertices}, {triangles}, built {built}")];
        if !object.attributes.is_empty() {
            parts.push(format!("triangles have {}", object.attributes.join(" ")));
        }
        if !object.others.is_empty() {
            parts.push(object.others.join(" "));
        }
        text.push_str(&format!("  {}: {}\n", object.name, parts.join("; ")));
    }
    text
}

fn describe_mesh(mesh: &MeshInformation) -> String {
    let closed = if mesh.watertight {
        "watertight"
    } else {
        "open"
    };
    let boundary = counted(mesh.boundary_loops, "boundary loop", "boundary loops");
    let irregular = 100.0 * mesh.irregular_vertices as f64 / mesh.vertices.max(1) as f64;
    let lines = [
        format!(
            "{}, {}, {}",
            counted(mesh.vertices, "vertex", "vertices"),
            counted(mesh.edges, "edge", "edges"),
            counted(mesh.triangles, "triangle", "triangles")
        ),
        format!(
            "{}, {closed}: {boundary} with {}, genus {}, Euler characteristic {}",
            counted(mesh.components, "component", "components"),
            counted(mesh.boundary_edges, "edge", "edges"),
            mesh.genus,
            mesh.euler_characteristic
        ),
        format!(
            "valence {} to {}; {} irregular ({irregular:.0} %)",
            mesh.min_valence,
            mesh.max_valence,
            counted(mesh.irregular_vertices, "vertex is", "vertices are")
        ),
        format!(
            "from {} to {}, diagonal {}",
            point(mesh.bounding_box.low),
            point(mesh.bounding_box.high),
            number(mesh.bounding_box.diagonal)
        ),
        bulk_in_words(&mesh.bulk),
        format!(
            "least angle {:.2}°, mean least angle {:.1}°",
            mesh.quality.min_angle_degrees, mesh.quality.mean_min_angle_degrees
        ),
    ];
    let text: String = lines.iter().map(|line| format!("  {line}\n")).collect();
    text + &dihedrals_in_words(&mesh.dihedrals)
}

fn bulk_in_words(bulk: &Bulk) -> String {
    let volume = bulk.volume.map_or_else(
        || "no volume, as it is open".to_owned(),
        |v| format!("volume {}", number(v)),
    );
    format!("area {}, {volume}", number(bulk.area))
}

/// The longest bar of a histogram.
const BAR: usize = 40;

/// How many edges there are by the angle between their faces, and which look sharp.
fn dihedrals_in_words(dihedrals: &Dihedrals) -> String {
    let most = dihedrals.histogram.iter().copied().max().unwrap_or(0);
    let rows = dihedrals
        .histogram
        .iter()
        .enumerate()
        .filter(|&(_, &count)| count > 0);
    let rows: Vec<Vec<String>> = rows
        .map(|(step, &count)| {
            let bar = "#".repeat((BAR * count).div_ceil(most.max(1)));
            vec![
                format!("  {}° to {}°", 10 * step, 10 * step + 10),
                thousands(count),
                bar,
            ]
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let look = match dihedrals.suggested_crease_angle_degrees {
        None => "none stand out as sharp".to_owned(),
        Some(angle) => {
            let edges = counted(dihedrals.sharp_edges, "edge looks", "edges look");
            let angle = number(angle);
            match dihedrals.look {
                "part" => format!(
                    "{edges} sharp, beyond {angle}°; it looks like a part, and `refine` keeps them so"
                ),
                _ => format!("{edges} sharp; --crease-angle {angle} keeps them so"),
            }
        }
    };
    format!(
        "\nedges by the angle between their faces: {look}\n{}",
        bars(&rows)
    )
}

/// A table whose last column is to the left.
fn bars(rows: &[Vec<String>]) -> String {
    let (heads, bars): (Vec<Vec<String>>, Vec<&String>) =
        rows.iter().map(|row| (row[..2].to_vec(), &row[2])).unzip();
    table(&heads)
        .lines()
        .zip(bars)
        .map(|(line, bar)| format!("{line}  {bar}\n"))
        .collect()
}
