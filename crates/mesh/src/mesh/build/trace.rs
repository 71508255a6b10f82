//! The corner of the soup for each corner of the mesh: the one of its face's polygon at that
//! vertex.

use super::retag::VertexMaps;
use crate::geometry::NONE;
use crate::index::VertexId;
use crate::mesh::PolygonSoup;

/// The soup's corners of the mesh's corners, three a face. Where faces were repaired a polygon may lack a vertex of its triangle; then
/// it is a corner of another polygon there.
pub(super) fn corners(
    soup: &PolygonSoup,
    triangles: &[[u32; 3]],
    inputs: &[u32],
    maps: &VertexMaps<'_>,
) -> Vec<u32> {
    let mut elsewhere: Option<Vec<u32>> = None;
    let mut corners = limitmesh_pages::with_capacity(3 * triangles.len());
    let mut places = Places::default();
    let mut listed = None;
    for (triangle, &input) in triangles.iter().zip(inputs) {
        // Those of a polygon follow each other.
        if listed != Some(input) {
            places.list(soup.faces.get(input as usize), maps);
            listed = Some(input);
        }
        let first = soup.faces.first_corner(input as usize);
        let vertices = triangle.map(|v| before_cutting(maps, v));
        for (corner, &vertex) in vertices.iter().enumerate() {
            let adjacent = [1, 2].map(|step| vertices[(corner + step) % 3]);
            let own = places
                .of(vertex, adjacent)
                .map(|place| first + place as u32);
            corners.push(own.unwrap_or_else(|| {
                let all = elsewhere.get_or_insert_with(|| first_corners(soup, maps));
                all.get(vertex as usize)
                    .copied()
                    .filter(|&corner| corner != NONE)
                    .unwrap_or(first)
            }));
        }
    }
    corners
}

/// The vertex before cutting; for one in the middle of an edge an end of that edge.
fn before_cutting(maps: &VertexMaps<'_>, v: u32) -> u32 {
    let vertex = maps.original(VertexId(v));
    let middle = || maps.middles.iter().find(|middle| middle.vertex == vertex);
    if (vertex as usize) < maps.vertex_count {
        vertex
    } else {
        middle().map_or(vertex, |found| found.ends[0])
    }
}

/// The corners of a polygon at each vertex.
#[derive(Default)]
struct Places {
    /// Its vertices, where they are still there.
    vertices: Vec<Option<u32>>,
    /// They and their places, by vertex.
    by_vertex: Vec<(u32, usize)>,
}

impl Places {
    fn list(&mut self, polygon: &[u32], maps: &VertexMaps<'_>) {
        self.vertices.clear();
        self.vertices
            .extend(polygon.iter().map(|&vertex| maps.vertex(vertex)));
        self.by_vertex.clear();
        let places = self.vertices.iter().enumerate();
        self.by_vertex
            .extend(places.filter_map(|(place, vertex)| Some(((*vertex)?, place))));
        self.by_vertex.sort_unstable();
    }

    /// The polygon's corner at a vertex; with several, the one between these two if it is unique.
    fn of(&self, vertex: u32, [next, previous]: [u32; 2]) -> Option<usize> {
        let start = self.by_vertex.partition_point(|&(other, _)| other < vertex);
        let places = self.by_vertex[start..]
            .iter()
            .take_while(|&&(other, _)| other == vertex);
        let mut places = places.map(|&(_, place)| place);
        let first = places.next()?;
        let count = self.vertices.len();
        let adjacent = |place: &usize| {
            let around = [1, count - 1].map(|step| self.vertices[(place + step) % count]);
            around.contains(&Some(next)) || around.contains(&Some(previous))
        };
        if adjacent(&first) {
            Some(first)
        } else {
            places.find(adjacent).or(Some(first))
        }
    }
}

/// By vertex before cutting, the first corner there.
fn first_corners(soup: &PolygonSoup, maps: &VertexMaps<'_>) -> Vec<u32> {
    let mut corners = vec![NONE; maps.vertex_count];
    for corner in 0..soup.faces.corner_count() {
        if let Some(vertex) = maps.vertex(soup.faces.corner(corner)) {
            let first = &mut corners[vertex as usize];
            *first = (*first).min(corner as u32);
        }
    }
    corners
}
