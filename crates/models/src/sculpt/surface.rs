//! The triangle surface that the sculpting steps hand on: positions, triangles, and who touches whom.

use glam::DVec3;
use limitmesh_mesh::PolygonSoup;
use limitmesh_mesh::mesh::PolygonFaces;

/// Triangles over positions, consistently oriented. Vertices with x = 0 exactly lie in the mirror plane.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surface {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// The surface together with its mirror image in the plane x = 0, sewn along the vertices in that plane.
    pub(crate) fn mirrored(&self) -> Self {
        let mut whole = self.clone();
        let images: Vec<u32> = self
            .positions
            .iter()
            .enumerate()
            .map(|(v, p)| {
                if p.x == 0.0 {
                    return v as u32;
                }
                whole.positions.push(DVec3::new(-p.x, p.y, p.z));
                whole.positions.len() as u32 - 1
            })
            .collect();
        whole.triangles.extend(
            self.triangles
                .iter()
                .map(|&[a, b, c]| [a, c, b].map(|v| images[v as usize])),
        );
        whole
    }

    /// The surface with every triangle split in four at the middles of its edges.
    pub(crate) fn split_in_four(&self) -> Self {
        let mut split = Self {
            positions: self.positions.clone(),
            triangles: Vec::new(),
        };
        let mut edges: Vec<(u32, u32)> = self
            .directed_edges()
            .iter()
            .map(|e| (e.0.min(e.1), e.0.max(e.1)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let ends = |v: u32| self.positions[v as usize];
        split
            .positions
            .extend(edges.iter().map(|&(a, b)| ends(a).midpoint(ends(b))));
        let first = self.positions.len();
        let middle = |a: u32, b: u32| {
            let edge = (a.min(b), a.max(b));
            (first + edges.partition_point(|&other| other < edge)) as u32
        };
        for &[a, b, c] in &self.triangles {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            split
                .triangles
                .extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        split
    }

    /// The faces at each vertex, in order.
    pub(super) fn faces_at_vertices(&self) -> Vec<Vec<u32>> {
        let mut faces = vec![Vec::new(); self.positions.len()];
        for (face, triangle) in self.triangles.iter().enumerate() {
            triangle
                .iter()
                .for_each(|&v| faces[v as usize].push(face as u32));
        }
        faces
    }

    /// The directed edges of all faces as (from, to, opposite vertex, face), sorted.
    pub(super) fn directed_edges(&self) -> Vec<(u32, u32, u32, u32)> {
        let mut edges: Vec<_> = self
            .triangles
            .iter()
            .enumerate()
            .flat_map(|(face, &t)| {
                (0..3).map(move |i| (t[i], t[(i + 1) % 3], t[(i + 2) % 3], face as u32))
            })
            .collect();
        edges.sort_unstable();
        edges
    }

    /// The neighbours of each vertex, ascending, and those of them that it reaches along a boundary (two or none).
    pub(super) fn neighbours(&self) -> Vec<(Vec<u32>, Vec<u32>)> {
        let mut lists = vec![(Vec::new(), Vec::new()); self.positions.len()];
        let edges = self.directed_edges();
        for &(from, to, ..) in &edges {
            let twin = edges.partition_point(|e| (e.0, e.1) < (to, from));
            let has_twin = edges.get(twin).is_some_and(|e| (e.0, e.1) == (to, from));
            lists[from as usize].0.push(to);
            if !has_twin {
                lists[to as usize].0.push(from);
                lists[from as usize].1.push(to);
                lists[to as usize].1.push(from);
            }
        }
        lists.iter_mut().for_each(|(all, _)| all.sort_unstable());
        lists
    }

    /// Drops vertices that no triangle names and renumbers the others in order.
    pub(super) fn drop_unused_vertices(&mut self) {
        let mut used = vec![false; self.positions.len()];
        self.triangles
            .as_flattened()
            .iter()
            .for_each(|&v| used[v as usize] = true);
        let mut kept = 0;
        let renumbered: Vec<u32> = used
            .iter()
            .map(|&used| {
                kept += u32::from(used);
                kept.wrapping_sub(1)
            })
            .collect();
        let mut keep = used.iter();
        self.positions
            .retain(|_| keep.next().copied().unwrap_or(false));
        self.triangles
            .iter_mut()
            .flatten()
            .for_each(|v| *v = renumbered[*v as usize]);
    }

    /// The surface as a soup of triangles.
    pub(crate) fn into_soup(self) -> PolygonSoup {
        let mut faces = PolygonFaces::with_capacity(self.triangles.len(), 3 * self.triangles.len());
        self.triangles
            .iter()
            .for_each(|triangle| faces.push(triangle));
        let positions = self.positions.iter().map(DVec3::to_array).collect();
        PolygonSoup {
            positions,
            faces,
            ..PolygonSoup::default()
        }
    }
}
