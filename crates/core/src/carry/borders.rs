//! The edges on whose two sides channels have different values.

use crate::mesh::{Channel, Domain, Mesh};

/// The edges of a mesh, by their ends, across which the values of a channel of its corners or faces
/// change: seams of textures, borders of materials. Boundaries are not among them, and constant
/// channels have no such edges. Faces differ by value, corners by index. Channels that do not fit
/// the mesh count as far as they do.
///
/// ```
/// use limitmesh::Mesh;
/// use limitmesh::carry::borders;
/// use limitmesh::mesh::{Channel, Domain, Semantic};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let square = Mesh::from_triangles(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]])?;
/// let material = Channel::new("materials", Semantic::Label, Domain::Face, 1).with(vec![0.0, 1.0], vec![0, 1]);
/// assert_eq!(borders(&[material], &square), [[0, 2]]);
/// # Ok::<(), limitmesh::mesh::MeshError>(())
/// ```
pub fn borders(channels: &[Channel], mesh: &Mesh) -> Vec<[u32; 2]> {
    let topology = mesh.topology();
    let differs =
        |channel: &Channel, a: usize, b: usize| channel.indices.get(a) != channel.indices.get(b);
    let has_other_value =
        |channel: &Channel, a: usize, b: usize| channel.value(a) != channel.value(b);
    let channels: Vec<&Channel> = channels
        .iter()
        .filter(|channel| !channel.is_constant())
        .collect();
    let mut found = Vec::new();
    for h in topology.half_edges() {
        let Some(twin) = topology.twin(h).filter(|twin| h.0 < twin.0) else {
            continue;
        };
        let is_border = channels.iter().any(|channel| match channel.domain {
            Domain::Vertex => false,
            Domain::Corner => {
                differs(channel, h.index(), twin.next().index())
                    || differs(channel, h.next().index(), twin.index())
            }
            Domain::Face => has_other_value(channel, h.face().index(), twin.face().index()),
        });
        if is_border {
            let [a, b] = topology.ends(h).map(|v| v.0);
            found.push([a.min(b), a.max(b)]);
        }
    }
    found.sort_unstable();
    found
}
