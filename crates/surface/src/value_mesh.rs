//! A corner channel as a mesh of its own: its vertices are the fans of faces around a vertex that share its value, its faces those of
//! the control mesh, and its boundary the seams and the control mesh's own boundary.
//!
//! So a scheme's masks, limits and sharp edges apply to values as they do to positions; where a [`SeamRule`] keeps a value, its
//! vertex is a corner, as if tagged.

use crate::geometry::DisjointSets;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{
    Channel, CornerTag, CreaseTag, Junctions, Mesh, MeshError, NONE, SeamRule, Sharpness, Tags,
    Topology, outgoing_half_edges,
};

/// The mesh of a channel, and the number of each of its vertices' values.
pub struct ValueMesh {
    /// Without values: all vertices are at zero.
    pub mesh: Mesh,
    /// By vertex, the channel's value.
    pub values: Vec<u32>,
}

impl ValueMesh {
    /// How many numbers of a value fit into a position.
    pub const TOGETHER: usize = 3;

    /// The mesh with numbers of the channel's values as positions: those from `first` on, and zeros where there are no more.
    ///
    /// # Errors
    /// A value is not finite.
    pub fn with_numbers(&self, channel: &Channel, first: usize) -> Result<Mesh, MeshError> {
        let last = channel.arity.min(first + Self::TOGETHER);
        let position = |&value: &u32| {
            let mut position = [0.0; Self::TOGETHER];
            let start = value as usize * channel.arity;
            let own = &channel.values[start + first..start + last];
            position[..own.len()].copy_from_slice(own);
            position
        };
        let positions = self.values.iter().map(position).collect();
        self.mesh.clone().with_positions(positions)
    }
}

/// A fan of faces at a control vertex.
struct Fan {
    value: u32,
    faces: usize,
    /// Whether a seam or the control mesh's boundary ends it.
    is_open: bool,
    /// The greatest sharpness of an edge inside.
    sharpest: f64,
}

/// The mesh of a channel of corners. Values are kept by `rule`, and wherever one value belongs to two fans. Several triangles may be one
/// face: `begins_face` says whether the edge is a face's first at a vertex.
///
/// # Errors
/// There are more fans than can be numbered.
pub fn value_mesh(
    control: &Mesh,
    channel: &Channel,
    rule: SeamRule,
    begins_face: impl Fn(HalfEdgeId) -> bool,
) -> Result<ValueMesh, MeshError> {
    let topology = control.topology();
    let continuous = |h: HalfEdgeId| {
        topology
            .twin(h)
            .filter(|&twin| channel.is_continuous(h, twin))
    };
    let mut sets = DisjointSets::new(topology.half_edge_count());
    for h in topology.half_edges() {
        if let Some(twin) = continuous(h).filter(|&twin| h < twin) {
            sets.unite(h.0, twin.next().0);
            sets.unite(h.next().0, twin.0);
        }
    }
    // Fans are numbered vertex by vertex.
    let mut of_corner = vec![u32::MAX; topology.half_edge_count()];
    let (mut fans, mut starts) = (Vec::new(), Vec::with_capacity(control.vertex_count() + 1));
    let sharpness = Sharpness::of(control);
    for vertex in topology.vertices() {
        starts.push(fans.len());
        for corner in topology.outgoing_ring(vertex) {
            let root = sets.root(corner.0) as usize;
            if of_corner[root] == u32::MAX {
                of_corner[root] = fans.len() as u32;
                let value = channel.indices[corner.index()];
                fans.push(Fan {
                    value,
                    faces: 0,
                    is_open: false,
                    sharpest: 0.0,
                });
            }
            let number = of_corner[root];
            of_corner[corner.index()] = number;
            let fan = &mut fans[number as usize];
            fan.faces += usize::from(begins_face(corner));
            match continuous(corner) {
                Some(_) => fan.sharpest = fan.sharpest.max(sharpness.edge(corner)),
                None => fan.is_open = true,
            }
            fan.is_open |= continuous(corner.previous()).is_none();
        }
    }
    starts.push(fans.len());
    let fan = |corner: HalfEdgeId| of_corner[corner.index()];
    let mut tags = Tags::default();
    for h in topology.half_edges() {
        let is_first = continuous(h).is_some_and(|twin| h < twin);
        if is_first && sharpness.edge(h) > 0.0 {
            tags.creases.push(CreaseTag {
                vertices: [fan(h), fan(h.next())],
                sharpness: sharpness.edge(h),
            });
        }
    }
    for (vertex, own) in starts.windows(2).enumerate() {
        let tagged = sharpness.vertex(VertexId(vertex as u32));
        for number in own[0]..own[1] {
            let is_rim = topology.is_boundary(VertexId(vertex as u32));
            let sharpness =
                tagged.max(kept((&fans[own[0]..own[1]], is_rim), number - own[0], rule));
            if sharpness > 0.0 {
                tags.corners.push(CornerTag {
                    vertex: number as u32,
                    sharpness,
                });
            }
        }
    }
    let triangles = of_corner.as_chunks::<3>().0.to_vec();
    // Edges are those of the control mesh: two of them may have the same ends.
    let twin = |h: HalfEdgeId| continuous(h).map_or(NONE, |twin| twin.0);
    let twins: Vec<u32> = topology.half_edges().map(twin).collect();
    let outgoing = outgoing_half_edges(&triangles, &twins, fans.len());
    let mut connected = Topology::from_parts(triangles, twins, outgoing);
    if topology.has_quads() {
        connected = connected.with_quads()?;
    }
    let positions = vec![[0.0; 3]; fans.len()];
    let mesh = Mesh::from_parts(connected, positions, Tags::default(), Junctions::default());
    let mesh = mesh.with_tags(tags)?;
    Ok(ValueMesh {
        mesh,
        values: fans.iter().map(|fan| fan.value).collect(),
    })
}

/// How long the value of a fan is kept, as the sharpness of a corner, given all fans of its vertex and whether that is on the control
/// mesh's boundary. At semi-sharp edges it is kept as long as these are sharp.
fn kept((fans, is_rim): (&[Fan], bool), own: usize, rule: SeamRule) -> f64 {
    let fan = &fans[own];
    if (0..fans.len()).any(|other| other != own && fans[other].value == fan.value) {
        return f64::INFINITY;
    }
    // No value has two fans but those that are kept anyway.
    let mut values: Vec<u32> = fans.iter().map(|fan| fan.value).collect();
    values.sort_unstable();
    values.dedup();
    let corners_only = fan.is_open && fan.faces == 1;
    let has_one_face = |&value: &u32| {
        let own = fans.iter().filter(|fan| fan.value == value);
        own.map(|fan| fan.faces).sum::<usize>() == 1
    };
    let beside_corner = values.len() == 2 && values.iter().any(has_one_face);
    let is_dart = fans.len() == 1 && fan.is_open && !is_rim;
    let is_kept = match rule {
        SeamRule::None => false,
        SeamRule::CornersOnly => corners_only,
        SeamRule::CornersPlus1 => corners_only || values.len() > 2,
        SeamRule::CornersPlus2 => corners_only || values.len() > 2 || beside_corner || is_dart,
        SeamRule::Boundaries => fan.is_open,
    };
    let sees_creases = matches!(rule, SeamRule::CornersPlus1 | SeamRule::CornersPlus2);
    match (is_kept, sees_creases && values.len() == 2) {
        (true, _) => f64::INFINITY,
        (false, true) => fans.iter().map(|fan| fan.sharpest).fold(0.0, f64::max),
        (false, false) => 0.0,
    }
}
