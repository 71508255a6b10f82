//! From a polygon soup to a manifold, oriented triangle mesh.
//!
//! In this order: weld vertices, cut polygons into triangles, drop repeated faces and those of zero
//! area, connect and orient the faces, turn components that are inside out, cut where the surface
//! is not a manifold, carry the tags over. Each step counts its findings in the [`Diagnosis`]. All
//! of them take time proportional to the input, or n log n, except for polygons of tens of
//! thousands of corners, which may take n^1.5.

mod cut;
mod fans;
mod inside_out;
mod orient;
mod repeated;
mod retag;
#[cfg(test)]
mod tests;
mod trace;
mod triangulate;
mod weld;
mod zero_area;

use super::{Diagnosis, Mesh, MeshError, PolygonSoup, Trace, check_finite};
use crate::geometry::NONE;
use crate::options;
use crate::vector::vector;
use cut::Sheets;
pub use fans::Fans;
use retag::VertexMaps;
use triangulate::{Faces, Flatness};
pub use weld::weld_within;

/// The vertices that are merged before connecting the faces.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub enum Weld {
    /// None: the file's indices alone connect faces.
    Never,
    /// Vertices at exactly equal positions.
    #[default]
    Exact,
    /// Vertices within this distance of each other, in the mesh's units. A chain of vertices, each
    /// within the distance of the next, becomes one vertex however long the chain; it has the
    /// position of the first of them in the input's order.
    Within(f64),
}

options! {
    /// The options of building a mesh from a soup.
    #[derive(Clone, Copy, Debug)]
    pub struct BuildOptions {
        /// The vertices that are merged.
        pub weld: Weld = Weld::Exact,
        /// Whether to refuse instead of repairing.
        pub strict: bool = false,
        /// Whether to keep the orientation of all faces, for surfaces whose visible side depends on
        /// it: neighbours that disagree are cut apart instead of turned, and closed components
        /// whose normals point inwards stay so.
        pub keep_windings: bool = false,
    }
}

/// The mesh, the findings, and the faces and corners of the input for those of the mesh.
pub(super) fn build(
    soup: &PolygonSoup,
    options: &BuildOptions,
) -> Result<(Mesh, Diagnosis, Trace), MeshError> {
    let (mesh, diagnosis, trace, _) = built(soup, options, |kept, diagnosis| {
        Ok((repair_faces(soup, kept, diagnosis)?, Vec::new()))
    })?;
    Ok((mesh, diagnosis, trace))
}

/// [`build`] with a fan of triangles for each polygon.
pub(super) fn build_fans(
    soup: &PolygonSoup,
    options: &BuildOptions,
) -> Result<(Fans, Diagnosis), MeshError> {
    let mut count = 0;
    let (mesh, diagnosis, trace, vertices) = built(soup, options, |kept, diagnosis| {
        let (faces, centres) = fans::fans(soup, kept, diagnosis)?;
        count = centres.len();
        Ok((faces, centres))
    })?;
    let fans = Fans {
        mesh,
        // The input's vertices stand before them, copies of cut ones behind.
        centres: (vertices - count) as u32..vertices as u32,
        trace,
    };
    Ok((fans, diagnosis))
}

/// [`build`] of triangles that are made of the soup's polygons over welded vertices; they may have vertices of their own, at positions
/// that come with them and with numbers from the soup's on. Gives also the vertices before cutting.
fn built(
    soup: &PolygonSoup,
    options: &BuildOptions,
    triangles: impl FnOnce(&[u32], &mut Diagnosis) -> Result<(Faces, Vec<[f64; 3]>), MeshError>,
) -> Result<(Mesh, Diagnosis, Trace, usize), MeshError> {
    let mut diagnosis = Diagnosis {
        input_vertices: soup.positions.len(),
        input_faces: soup.faces.len(),
        ..Diagnosis::default()
    };
    let used = check(soup)?;
    let mut kept = weld(soup, &used, options.weld)?;
    for v in 0..used.len() {
        if !used[v] {
            diagnosis.isolated_vertices.add(v as u32);
        } else if kept[v] as usize != v {
            diagnosis.welded_vertices.add(v as u32);
        }
    }
    drop(used);
    let (faces, centres) = triangles(&kept, &mut diagnosis)?;
    if faces.triangles.is_empty() {
        return Err(no_faces(soup, &diagnosis));
    }
    kept.extend((kept.len() as u32..).take(centres.len()));
    let keeps = options.keep_windings;
    let (mesh, trace, count) = assemble(soup, &centres, faces, kept, keeps, &mut diagnosis);
    if options.strict && !diagnosis.is_clean() {
        return Err(MeshError::NeedsRepair {
            summary: diagnosis.defects(),
        });
    }
    debug_assert_eq!(mesh.validate(), Ok(()));
    Ok((mesh, diagnosis, trace, count))
}

/// Refuses invalid coordinates and indices; reports which vertices have a face.
fn check(soup: &PolygonSoup) -> Result<Vec<bool>, MeshError> {
    check_finite(&soup.positions)?;
    let count = soup.positions.len();
    if count >= NONE as usize {
        return Err(MeshError::TooMany {
            what: "vertices",
            count,
            limit: NONE as usize - 1,
        });
    }
    let mut used = vec![false; count];
    for (face, corners) in soup.faces.iter().enumerate() {
        for &v in corners {
            match used.get_mut(v as usize) {
                Some(used) => *used = true,
                None => {
                    return Err(MeshError::VertexOutOfRange {
                        face,
                        vertex: u64::from(v),
                        count,
                    });
                }
            }
        }
    }
    Ok(used)
}

/// For each vertex its representative: itself or an earlier one. Vertices without faces take no
/// part.
fn weld(soup: &PolygonSoup, used: &[bool], weld: Weld) -> Result<Vec<u32>, MeshError> {
    match weld {
        Weld::Never => Ok((0..soup.positions.len() as u32).collect()),
        Weld::Exact => Ok(weld::exact(&soup.positions, used)),
        Weld::Within(distance) => weld::within(&soup.positions, used, distance),
    }
}

/// Triangles without repetitions and without faces of zero area.
fn repair_faces(
    soup: &PolygonSoup,
    kept: &[u32],
    diagnosis: &mut Diagnosis,
) -> Result<Faces, MeshError> {
    let mut faces = triangulate::triangulate(soup, kept, diagnosis)?;
    let vertex_count = kept.len();
    let flatness = Flatness {
        positions: &soup.positions,
        opening: &soup.opening,
    };
    repeated::drop_repeated(&mut faces, flatness, diagnosis);
    let is_polygon = |input: u32| soup.faces.get(input as usize).len() > 3;
    zero_area::remove_zero_area(&mut faces, flatness, vertex_count, is_polygon, diagnosis);
    Ok(faces)
}

/// Why no face is left.
fn no_faces(soup: &PolygonSoup, diagnosis: &Diagnosis) -> MeshError {
    let reason = if soup.faces.is_empty() {
        "the input has none".to_owned()
    } else {
        format!(
            "of {} in the input none could be used: {}",
            soup.faces.len(),
            diagnosis.defects()
        )
    };
    MeshError::NoFaces { reason }
}

/// Connects the faces, turns and cuts them where they need it, and puts the mesh together; gives also from which
/// faces and corners of the input those of the mesh are, and the vertices before cutting.
fn assemble(
    soup: &PolygonSoup,
    centres: &[[f64; 3]],
    mut faces: Faces,
    mut kept: Vec<u32>,
    keeps_windings: bool,
    diagnosis: &mut Diagnosis,
) -> (Mesh, Trace, usize) {
    let names = renumber(&mut faces.triangles, &mut kept);
    let name = |v: u32| names[v as usize];
    let place = |input: u32| {
        let own = soup.positions.get(input as usize);
        own.unwrap_or_else(|| &centres[input as usize - soup.positions.len()])
    };
    let vertex_count = names.len();
    let mut neighbours = orient::connect(&faces.triangles, vertex_count, name, diagnosis);
    let first = (vertex_count - centres.len()) as u32;
    let components =
        (!keeps_windings).then(|| orient::orient(&mut faces, &mut neighbours, first, diagnosis));
    orient::cut_opposed(&faces, &mut neighbours, diagnosis);
    if let Some(components) = components {
        let position = |v: u32| *place(name(v));
        inside_out::turn_inside_out(
            &mut faces,
            &mut neighbours,
            &components,
            position,
            diagnosis,
        );
    }
    let Sheets {
        topology,
        inputs,
        copied,
        middles,
        junctions,
        corners,
    } = cut::cut(faces, neighbours, vertex_count, name, diagnosis);
    let mut positions = limitmesh_pages::with_capacity(vertex_count + copied.len());
    positions.extend(names.iter().map(|&v| place(v)));
    let mut middle = middles.iter();
    for &original in &copied {
        // Only the first copy of a vertex in the middle of an edge names a position that is not yet there.
        let position = positions.get(original as usize).copied().or_else(|| {
            let [a, b] = middle.next()?.ends.map(|v| vector(positions[v as usize]));
            Some((a * 0.5 + b * 0.5).to_array())
        });
        positions.extend(position);
    }
    let maps = VertexMaps {
        from_input: &kept,
        vertex_count,
        copied: &copied,
        middles: &middles,
    };
    let tags =
        retag::retag(soup, &topology, &maps, &corners, diagnosis).joined(&topology, &junctions);
    let corners = trace::corners(soup, topology.triangles(), &inputs, &maps);
    (
        Mesh::from_parts(topology, positions, tags, junctions),
        Trace {
            faces: inputs,
            corners,
            ..Trace::default()
        },
        vertex_count,
    )
}

/// Numbers the vertices that the triangles use from 0, in ascending order; `kept` then leads from the input's
/// vertices to the new ones, or to [`NONE`]. Gives the input vertex of each new one.
fn renumber(triangles: &mut [[u32; 3]], kept: &mut [u32]) -> Vec<u32> {
    let mut numbers = vec![NONE; kept.len()];
    for &v in triangles.as_flattened() {
        numbers[v as usize] = 0;
    }
    let mut names = Vec::with_capacity(triangles.len() / 2 + 2);
    for (v, number) in numbers
        .iter_mut()
        .enumerate()
        .filter(|(_, number)| **number == 0)
    {
        *number = names.len() as u32;
        names.push(v as u32);
    }
    for v in triangles.as_flattened_mut().iter_mut().chain(kept) {
        *v = numbers[*v as usize];
    }
    names
}
