//! Channels that are carried through refinement: against another implementation's face-varying values, and exact shapes.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::{HashMap, HashSet};

use crate::support::*;
use limitmesh::carry::carried;
use limitmesh::criterion::LimitNormal;
use limitmesh::limit::LimitTable;
use limitmesh::measure::Bvh;
use limitmesh::mesh::{
    BuildOptions, Channel, CreaseTag, Domain, INFINITELY_SHARP, Interpolation, PolygonFaces,
    PolygonSoup, SeamRule, Semantic,
};
use limitmesh::refine::{
    Exact, Origin, StepwiseOptions, Traced, UniformOptions, exact, stepwise, uniform,
};
use limitmesh::scheme::Loop;
use limitmesh::{FaceId, HalfEdgeId, LimitSurface, Mesh};
use opensubdiv_rs::{far, sdc};

const RULES: [(SeamRule, sdc::FVarLinearInterpolation); 5] = [
    (SeamRule::None, sdc::FVarLinearInterpolation::None),
    (
        SeamRule::CornersOnly,
        sdc::FVarLinearInterpolation::CornersOnly,
    ),
    (
        SeamRule::CornersPlus1,
        sdc::FVarLinearInterpolation::CornersPlus1,
    ),
    (
        SeamRule::CornersPlus2,
        sdc::FVarLinearInterpolation::CornersPlus2,
    ),
    (
        SeamRule::Boundaries,
        sdc::FVarLinearInterpolation::Boundaries,
    ),
];

/// A channel with seams: around some vertices the faces are parted in two or three fans that have
/// values of their own, so that seams end in adjacent vertices or go on there.
fn with_seams(mesh: &Mesh, one_in: usize, seed: u64) -> Channel {
    let mut random = Random::new(seed);
    let mut number = || random.below(2000) as f64 * 1e-3 - 1.0;
    let (mut values, mut indices) = (Vec::new(), vec![0; 3 * mesh.face_count()]);
    let mut parting = Random::new(seed ^ 0xfa);
    for vertex in mesh.topology().vertices() {
        let parts = if parting.below(one_in) == 0 {
            2 + parting.below(2)
        } else {
            1
        };
        let ring: Vec<usize> = mesh
            .topology()
            .outgoing_ring(vertex)
            .map(|h| h.index())
            .collect();
        for (at, &corner) in ring.iter().enumerate() {
            if at * parts / ring.len() != at.wrapping_sub(1).wrapping_mul(parts) / ring.len()
                || at == 0
            {
                (0..3).for_each(|_| values.push(number()));
            }
            indices[corner] = values.len() as u32 / 3 - 1;
        }
    }
    Channel::new("values", Semantic::TextureCoordinates, Domain::Corner, 3).with(values, indices)
}

/// Limits of a channel by the port of OpenSubdiv after so many levels, by control face and barycentric coordinates in fourths.
fn other_implementation(
    mesh: &Mesh,
    channel: &Channel,
    rule: sdc::FVarLinearInterpolation,
) -> HashMap<(u32, [u32; 3]), [f64; 3]> {
    const LEVELS: usize = 2;
    let corners = vec![3usize; mesh.face_count()];
    let pairs: Vec<[u32; 2]> = mesh.tags().creases.iter().map(|tag| tag.vertices).collect();
    let weights: Vec<f32> = mesh
        .tags()
        .creases
        .iter()
        .map(|tag| tag.sharpness.min(10.0) as f32)
        .collect();
    let refined = |count: usize, indices: &[u32], values: &[[f64; 3]], rule, is_limit: bool| {
        let own = [far::FVarChannelDescriptor::new(count, indices)];
        let descriptor = far::TopologyDescriptor::new(
            mesh.vertex_count(),
            &corners,
            mesh.triangles().as_flattened(),
        )
        .with_creases(&pairs, &weights)
        .with_fvar_channels(&own);
        let options = sdc::Options::default()
            .with_vtx_boundary_interpolation(sdc::VtxBoundaryInterpolation::EdgeOnly)
            .with_fvar_linear_interpolation(rule);
        let mut refiner =
            far::TopologyRefinerFactory::create(descriptor, sdc::SchemeType::Loop, options)
                .unwrap();
        refiner.refine_uniform(far::UniformOptions::new(LEVELS));
        let primvars = far::PrimvarRefiner::new(&refiner);
        let mut last = primvars
            .interpolate_face_varying_all(0, values)
            .pop()
            .unwrap();
        if is_limit {
            let source = last.clone();
            primvars.limit_face_varying(0, &source, &mut last);
        }
        let level = refiner.level(LEVELS);
        let faces = mesh.face_count() << (2 * LEVELS);
        let by_corner = (0..faces).flat_map(|face| level.face_fvar_values(face, 0).to_vec());
        by_corner
            .map(|value| last[value as usize])
            .collect::<Vec<[f64; 3]>>()
    };
    // Where each refined corner is, by a linear channel that counts.
    let count = 3 * mesh.face_count();
    let units: Vec<[f64; 3]> = (0..count)
        .map(|corner| std::array::from_fn(|i| f64::from(u8::from(i == corner % 3))))
        .collect();
    let own: Vec<u32> = (0..count as u32).collect();
    let places = refined(
        count,
        &own,
        &units,
        sdc::FVarLinearInterpolation::All,
        false,
    );
    let values: Vec<[f64; 3]> = channel.values.as_chunks::<3>().0.to_vec();
    let limits = refined(values.len(), &channel.indices, &values, rule, true);
    let face = |corner: usize| (corner / 3 / (1 << (2 * LEVELS))) as u32;
    let quarters = |place: &[f64; 3]| place.map(|weight| (4.0 * weight).round() as u32);
    let all = places.iter().zip(limits).enumerate();
    all.map(|(corner, (place, limit))| ((face(corner), quarters(place)), limit))
        .collect()
}

/// Every face divided twice.
fn twice_divided(mesh: &Mesh) -> Exact {
    let options = within(1e-9).max_levels(2).flat_regions(false);
    exact(mesh, &Loop, &options).unwrap()
}

fn check_against_other(what: &str, mesh: &Mesh, channel: &Channel) {
    let fine = twice_divided(mesh);
    for (rule, their_rule) in RULES {
        let theirs = other_implementation(mesh, channel, their_rule);
        let channel = channel.clone().interpolated(Interpolation::Smooth(rule));
        let ours = carried(&[channel], mesh, &Loop, &fine).unwrap().remove(0);
        let mut checked = 0;
        for (face, &parent) in fine.parents.iter().enumerate() {
            for corner in 0..3 {
                let vertex = fine.mesh.triangles()[face][corner];
                let Origin {
                    face: own,
                    barycentric,
                    ..
                } = fine.origins[vertex as usize];
                if own != parent {
                    continue;
                }
                let Some(their) = theirs.get(&(own, barycentric.map(|w| (4.0 * w).round() as u32)))
                else {
                    continue;
                };
                // At darts it has the limits of smooth vertices.
                let at = barycentric.iter().position(|&weight| weight == 1.0);
                let at = at.map(|corner| mesh.triangles()[own as usize][corner]);
                let creases = mesh
                    .tags()
                    .creases
                    .iter()
                    .filter(|tag| at.is_some_and(|v| tag.vertices.contains(&v)));
                if creases.count() == 1 {
                    continue;
                }
                let our = ours.value(3 * face + corner);
                let off = (0..3)
                    .map(|i| (our[i] - their[i]).abs())
                    .fold(0.0, f64::max);
                assert!(
                    off < 2e-6,
                    "{what}, {rule:?}: {off} at {barycentric:?} of face {own}: {our:?} {their:?}"
                );
                checked += 1;
            }
        }
        assert!(checked > 6 * mesh.face_count(), "{what}: {checked}");
    }
}

#[test]
fn smooth_channels_are_the_other_implementation_s() {
    for (name, mesh) in samples() {
        for seed in 0..6 {
            let channel = with_seams(&mesh, 2 + seed as usize, seed);
            check_against_other(&format!("{name}, {seed}"), &mesh, &channel);
        }
    }
}

/// Sharp edges of the mesh are sharp for what it carries.
#[test]
fn smooth_channels_of_creased_meshes_are_the_other_implementation_s() {
    for (name, mesh) in samples() {
        for seed in 0..4 {
            let mut random = Random::new(seed);
            let topology = mesh.topology();
            let creases = topology
                .half_edges()
                .filter(|&h| topology.twin(h).is_some_and(|twin| h < twin));
            let creases = creases.filter(|_| random.below(5) == 0);
            let creases: Vec<_> = creases.map(|h| topology.ends(h).map(|v| v.0)).collect();
            // Those that fade are gone after the two levels whose limits are compared.
            for sharpness in [[INFINITELY_SHARP; 2], [0.6, 1.5]] {
                let tag = |(i, &ends): (usize, &[u32; 2])| crease(ends, sharpness[i % 2]);
                let creases: Vec<CreaseTag> = creases.iter().enumerate().map(tag).collect();
                let creased = mesh
                    .clone()
                    .with_tags(crate::support::creases(creases))
                    .unwrap();
                let whole = with_seams(&creased, usize::MAX, seed);
                let what = format!("{name}, {sharpness:?}, {seed}");
                check_against_other(&what, &creased, &whole);
            }
        }
    }
}

/// Beside a semi-sharp edge on the other side of a seam a value is kept for as long as the edge is sharp: by hand, the limit of a
/// boundary whose vertex is half a corner in the first step.
#[test]
fn semi_sharp_edges_keep_values_beside_seams_while_they_are_sharp() {
    let (_, mesh) = samples().swap_remove(0);
    let topology = mesh.topology();
    let ring: Vec<_> = topology.outgoing_ring(limitmesh::VertexId(0)).collect();
    let half = ring.len() / 2;
    let target = |h| topology.target(h).index();
    for (sharpness, corner) in [(0.5, 0.5), (INFINITELY_SHARP, 1.0)] {
        let tag = crease(topology.ends(ring[1]).map(|v| v.0), sharpness);
        let mesh = mesh
            .clone()
            .with_tags(crate::support::creases(vec![tag]))
            .unwrap();
        // A value for each vertex, and another for the corners of the first on the side that has not the edge.
        let mut values: Vec<f64> = (0..mesh.vertex_count()).map(|v| (v as f64).sin()).collect();
        let other = values.len() as u32;
        values.push(3.0);
        let mut indices = mesh.triangles().as_flattened().to_vec();
        ring[half..].iter().for_each(|h| indices[h.index()] = other);
        let [a, b] = [values[target(ring[half])], values[target(ring[0])]];
        let channel = Channel::new("x", Semantic::Other, Domain::Corner, 1)
            .with(values, indices)
            .interpolated(Interpolation::Smooth(SeamRule::CornersPlus1));
        let fine = twice_divided(&mesh);
        let found = carried(&[channel], &mesh, &Loop, &fine).unwrap().remove(0);
        let own = (0..fine.mesh.triangles().as_flattened().len()).find(|&corner| {
            fine.mesh.triangles().as_flattened()[corner] == 0
                && fine.parents[corner / 3] == ring[half].face().0
        });
        let smooth = (6.0 * 3.0 + a + b) / 8.0;
        let step = corner * 3.0 + (1.0 - corner) * smooth;
        let expected = match corner {
            1.0 => 3.0,
            _ => ((a + 3.0) / 2.0 + 4.0 * step + (b + 3.0) / 2.0) / 6.0,
        };
        let value = found.value(own.unwrap())[0];
        assert!(
            (value - expected).abs() < 1e-12,
            "{sharpness}: {value} {expected}"
        );
    }
}

/// A channel whose values are positions is where the vertices are.
#[test]
fn positions_as_a_channel_are_positions() {
    for (name, mesh) in samples() {
        let fine = exact(&mesh, &Loop, &within(1e-2).flat_regions(false)).unwrap();
        let values = mesh.positions().as_flattened().to_vec();
        let channel = Channel::new("positions", Semantic::Displacement, Domain::Vertex, 3)
            .with(values, (0..mesh.vertex_count() as u32).collect());
        let found = carried(&[channel], &mesh, &Loop, &fine).unwrap().remove(0);
        for (corner, &vertex) in fine.mesh.triangles().as_flattened().iter().enumerate() {
            let position = fine.mesh.positions()[vertex as usize];
            let off = distance(position, found.value(corner).try_into().unwrap());
            assert!(off < 1e-13, "{name}: {off}");
        }
        // One value a vertex: there are no seams.
        assert_eq!(found.value_count(), fine.mesh.vertex_count());
    }
}

/// Linear channels are linear over each control face, whatever is on the other side of a seam; seams stay where they are.
#[test]
fn linear_channels_are_exact() {
    for (name, mesh) in samples() {
        let fine = exact(&mesh, &Loop, &within(1e-2).flat_regions(false)).unwrap();
        let channel = with_seams(&mesh, 3, 7).interpolated(Interpolation::Linear);
        let found = carried(core::slice::from_ref(&channel), &mesh, &Loop, &fine)
            .unwrap()
            .remove(0);
        for (face, &parent) in fine.parents.iter().enumerate() {
            for corner in 0..3 {
                let vertex = fine.mesh.triangles()[face][corner];
                let origin = fine.origins[vertex as usize];
                // By hand: the weights belong to vertices, which the parent has, too.
                let from = mesh.triangles()[origin.face as usize];
                let to = mesh.triangles()[parent as usize];
                let weight = |v: u32| {
                    from.iter()
                        .position(|&w| w == v)
                        .map_or(0.0, |k| origin.barycentric[k])
                };
                let expected: [f64; 3] = std::array::from_fn(|i| {
                    (0..3)
                        .map(|k| weight(to[k]) * channel.value(3 * parent as usize + k)[i])
                        .sum()
                });
                let off = distance(expected, found.value(3 * face + corner).try_into().unwrap());
                assert!(off < 1e-14, "{name}: {off}");
            }
        }
        let seams = |mesh: &Mesh, channel: &Channel| {
            let topology = mesh.topology();
            let both = topology
                .half_edges()
                .filter_map(|h| Some((h, topology.twin(h)?)));
            let differ = both.filter(|&(h, twin)| {
                let at = |h: limitmesh::HalfEdgeId| channel.indices[h.index()];
                at(h) != at(twin.next()) || at(h.next()) != at(twin)
            });
            differ.map(|(h, _)| h).collect::<Vec<_>>()
        };
        // A seam of the refined mesh lies along one of the control mesh: both its triangles are of
        // the faces adjacent to that.
        let before: HashSet<[u32; 2]> = seams(&mesh, &channel)
            .into_iter()
            .map(|h| [h.face().0, mesh.topology().twin(h).unwrap().face().0])
            .collect();
        let after = seams(&fine.mesh, &found);
        assert!(after.len() >= before.len());
        for h in after {
            let faces =
                [h, fine.mesh.topology().twin(h).unwrap()].map(|h| fine.parents[h.face().index()]);
            assert!(before.contains(&faces), "{name}: {faces:?}");
        }
    }
}

/// On a flat disc, texture coordinates that are affine in the plane stay that.
#[test]
fn affine_coordinates_of_a_disc_stay_affine() {
    let mesh = sheet(4, 5, 3);
    let mesh = mapped(&mesh, |&[x, y, _]| [x, y, 0.0]);
    let affine = |[x, y, _]: [f64; 3]| [0.3 * x - 0.8 * y + 0.1, 1.7 * x + 0.4 * y - 2.0];
    let values = mesh.positions().iter().flat_map(|&p| affine(p)).collect();
    let channel = Channel::new("uv", Semantic::TextureCoordinates, Domain::Vertex, 2)
        .with(values, (0..mesh.vertex_count() as u32).collect())
        .interpolated(Interpolation::Smooth(SeamRule::None));
    let fine = exact(&mesh, &Loop, &within(1e-3).flat_regions(false)).unwrap();
    let found = carried(&[channel], &mesh, &Loop, &fine).unwrap().remove(0);
    for (corner, &vertex) in fine.mesh.triangles().as_flattened().iter().enumerate() {
        let expected = affine(fine.mesh.positions()[vertex as usize]);
        let value = found.value(corner);
        assert!((value[0] - expected[0]).abs() < 1e-12 && (value[1] - expected[1]).abs() < 1e-12);
    }
}

/// The surface at a place: against refinement by the masks and its vertices' limit stencils.
#[test]
fn the_surface_at_a_place_is_the_limit_of_its_vertex() {
    for (name, mesh) in samples() {
        let stepped = divided(&mesh, &Loop, 2);
        let limits = LimitTable::new(&Loop).positions(&stepped).unwrap();
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let mut met = vec![false; limits.len()];
        for face in 0..mesh.face_count() as u32 {
            for (i, j) in (0..=4u32).flat_map(|i| (0..=4 - i).map(move |j| (i, j))) {
                let place = [4 - i - j, i, j].map(|weight| f64::from(weight) / 4.0);
                let point = surface.at(FaceId(face), place).position;
                let off = |v: &usize| distance(limits[*v], point);
                let nearest = (0..limits.len())
                    .min_by(|a, b| off(a).total_cmp(&off(b)))
                    .unwrap();
                below!(off(&nearest), 1e-12, "{name}, {place:?} of face {face}");
                met[nearest] = true;
            }
        }
        assert!(met.iter().all(|&is_met| is_met), "{name}");
    }
}

/// Places that no refinement has a vertex at lie as near to a certified mesh as that is to the surface.
#[test]
fn the_surface_between_vertices_is_near_a_certified_mesh() {
    for (name, mesh) in samples() {
        let fine = exact(&mesh, &Loop, &within(1e-4)).unwrap();
        let tree = Bvh::new(fine.mesh.as_triangles()).unwrap();
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let mut random = Random::new(11);
        for face in 0..mesh.face_count() as u32 {
            for _ in 0..20 {
                let [a, b] = [0, 1].map(|_| 0.5 * (random.signed() + 1.0));
                let [u, v] = if a + b > 1.0 {
                    [1.0 - a, 1.0 - b]
                } else {
                    [a, b]
                };
                let point = surface.at(FaceId(face), [1.0 - u - v, u, v]);
                assert!(
                    tree.closest(point.position).distance <= fine.error.upper,
                    "{name}, {u} {v} of {face}"
                );
                let length = point.normal.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!((length - 1.0).abs() < 1e-12);
            }
        }
    }
}

/// Corners with distinct indices in a file and equal values are joined; faces that repairs turn or
/// cut keep their values.
#[test]
fn channels_of_a_soup_reach_the_mesh() {
    // A square of two triangles whose second is turned over, with a texture that each corner names for itself.
    let positions = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let faces: PolygonFaces = [&[0u32, 1, 2][..], &[0, 3, 2]].into_iter().collect();
    let texture = |v: u32| [positions[v as usize][0], positions[v as usize][1]];
    let values: Vec<f64> = faces.iter().flatten().flat_map(|&v| texture(v)).collect();
    let channel = Channel::new("uv", Semantic::TextureCoordinates, Domain::Corner, 2)
        .with(values, (0..6).collect());
    let soup = PolygonSoup {
        positions: positions.clone(),
        faces,
        ..PolygonSoup::default()
    };
    let (mesh, _, trace) = Mesh::from_soup_traced(&soup, &BuildOptions::default()).unwrap();
    let channel = channel.on_mesh(&soup, &mesh, &trace).unwrap();
    for (corner, &vertex) in mesh.triangles().as_flattened().iter().enumerate() {
        let position = mesh.positions()[vertex as usize];
        assert_eq!(channel.value(corner), &position[..2]);
    }
    assert_eq!(channel.value_count(), 4);
}

/// A mesh without faces has nothing to carry, and that is no error.
#[test]
fn an_empty_mesh_carries_nothing() {
    let mesh = Mesh::from_triangles(Vec::new(), Vec::new()).unwrap();
    let options = UniformOptions::default().levels(1).origins(true);
    let fine = uniform(&mesh, &Loop, &options).unwrap();
    for semantic in [
        Semantic::TextureCoordinates,
        Semantic::Displacement,
        Semantic::Label,
    ] {
        let channel = Channel::new("none", semantic, Domain::Corner, 1);
        let carried = carried(std::slice::from_ref(&channel), &mesh, &Loop, &fine).unwrap();
        assert_eq!(carried, [channel]);
    }
}

/// A smooth channel whose values are the positions has the limits that refinement step by step moves its vertices to.
#[test]
fn uniform_refinement_carries_channels() {
    for (name, mesh) in samples() {
        let indices = mesh.triangles().as_flattened().to_vec();
        let places = Channel::new("places", Semantic::Displacement, Domain::Corner, 3)
            .with(mesh.positions().as_flattened().to_vec(), indices);
        let options = UniformOptions::default()
            .levels(2)
            .limit(true)
            .origins(true);
        let fine = uniform(&mesh, &Loop, &options).unwrap();
        let carried = &carried(&[places], &mesh, &Loop, &fine).unwrap()[0];
        for (corner, &v) in fine.mesh.triangles().as_flattened().iter().enumerate() {
            let value = carried.value(corner).try_into().unwrap();
            let off = distance(value, fine.mesh.positions()[v as usize]);
            assert!(off < 1e-9 * mesh.diagonal(), "{name}: {off}");
        }
    }
}

/// The triangles of an adaptive refinement step by step cover each control face once.
#[test]
fn stepwise_refinement_knows_where_its_triangles_are() {
    for (name, mesh) in samples() {
        let options = StepwiseOptions::default().levels(3).origins(true);
        let criterion = LimitNormal::new(10f64.to_radians());
        let fine = stepwise(&mesh, &Loop, &criterion, &options).unwrap();
        let mut covered = vec![0.0; mesh.face_count()];
        for (face, &parent) in fine.parents.iter().enumerate() {
            let [a, b, c] = [0, 1, 2].map(|corner| {
                let h = HalfEdgeId::of(FaceId(face as u32), corner);
                fine.corner_origin(mesh.triangles(), h)
                    .filter(|origin| origin.face == parent)
                    .unwrap()
                    .barycentric
            });
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(area > 0.0, "{name}: triangle {face} is turned over");
            covered[parent as usize] += area;
        }
        assert!(covered.iter().all(|area| *area == 1.0), "{name}");
    }
}
