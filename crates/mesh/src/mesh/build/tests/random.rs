//! Random soups in which everything collides: any input gives a valid mesh, and nothing is lost.

use proptest::prelude::*;

use super::*;

/// Positions on a small grid, so that many coincide and many faces have no area; any polygons over them.
fn soups() -> impl Strategy<Value = PolygonSoup> {
    let position = (0..4i8, 0..3i8, 0..2i8).prop_map(|(x, y, z)| [x, y, z].map(f64::from));
    let positions = prop::collection::vec(position, 3..14);
    let faces = prop::collection::vec(prop::collection::vec(any::<u32>(), 0..7), 1..40);
    let tags = prop::collection::vec((any::<u32>(), any::<u32>(), 0.0..12.0f64), 0..6);
    (positions, faces, tags).prop_map(|(positions, faces, tags)| {
        let n = positions.len() as u32;
        let mut soup = PolygonSoup {
            positions,
            ..PolygonSoup::default()
        };
        for mut face in faces {
            face.iter_mut().for_each(|v| *v %= n);
            soup.faces.push(&face);
        }
        for (a, b, sharpness) in tags {
            soup.creases.push(CreaseTag {
                vertices: [a % (n + 1), b % (n + 1)],
                sharpness,
            });
            soup.corners.push(CornerTag {
                vertex: b % (n + 1),
                sharpness,
            });
        }
        soup
    })
}

/// Triangles over few vertices: repetitions, edges with many faces, bow-ties, one-sided components.
fn triangle_soups() -> impl Strategy<Value = PolygonSoup> {
    // Vertices on the moment curve: no three on a line, none coincide.
    let positions: Vec<[f64; 3]> = (1..=9)
        .map(f64::from)
        .map(|t| [t, t * t, t * t * t])
        .collect();
    prop::collection::vec([0..9u32, 0..9u32, 0..9u32], 1..40).prop_map(move |faces| {
        let faces: Vec<&[u32]> = faces.iter().map(|f| f.as_slice()).collect();
        soup(&positions, &faces)
    })
}

fn welds() -> impl Strategy<Value = Weld> {
    prop_oneof![
        Just(Weld::Never),
        Just(Weld::Exact),
        Just(Weld::Within(0.0)),
        Just(Weld::Within(1.0))
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_soup_gives_a_valid_mesh_or_no_faces(soup in soups(), weld in welds()) {
        let options = BuildOptions::default().weld(weld);
        match Mesh::from_soup(&soup, &options) {
            Ok((mesh, diagnosis)) => {
                check_mesh(&mesh);
                let tags = soup.creases.len() + soup.corners.len();
                prop_assert!(diagnosis.dropped_tags.count <= tags);
                let again = Mesh::from_soup(&soup, &options).unwrap();
                prop_assert_eq!(again, (mesh, diagnosis.clone()));
                let strict = Mesh::from_soup(&soup, &options.strict(true));
                prop_assert_eq!(strict.is_ok(), diagnosis.is_clean());
            }
            Err(error) => prop_assert!(matches!(error, MeshError::NoFaces { .. }), "{}", error),
        }
    }

    #[test]
    fn any_soup_gives_fans_that_name_what_is_not_in_them(soup in soups(), weld in welds()) {
        let options = BuildOptions::default().weld(weld);
        match Mesh::fans_from_soup(&soup, &options) {
            Ok((fans, diagnosis)) => {
                check_mesh(&fans.mesh);
                let is_centre = |v: &u32| fans.centres.contains(v);
                for triangle in fans.mesh.triangles() {
                    prop_assert_eq!(triangle.iter().filter(|v| is_centre(v)).count(), 1);
                }
                let there: HashSet<u32> = fans.trace.faces.iter().copied().collect();
                let named = diagnosis.collapsed_faces.count + diagnosis.repeated_faces.count;
                prop_assert!(there.len() + named >= soup.faces.len());
                let strict = Mesh::fans_from_soup(&soup, &options.strict(true));
                prop_assert_eq!(strict.is_ok(), diagnosis.is_clean());
            }
            Err(error) => prop_assert!(matches!(error, MeshError::NoFaces { .. }), "{}", error),
        }
    }

    #[test]
    fn no_triangle_is_lost(soup in triangle_soups()) {
        let Ok((mesh, diagnosis)) = Mesh::from_soup(&soup, &BuildOptions::default()) else { return Ok(()) };
        check_mesh(&mesh);
        let distinct: HashSet<[u32; 3]> = soup.faces.iter().filter(|f| f[0] != f[1] && f[1] != f[2] && f[2] != f[0])
            .map(|f| { let mut f = [f[0], f[1], f[2]]; f.sort_unstable(); f }).collect();
        let dropped = diagnosis.collapsed_faces.count + diagnosis.repeated_faces.count;
        prop_assert_eq!(distinct.len() + dropped, soup.faces.len());
        // Splitting slits adds faces; without that the counts agree exactly, and so do the edges in space.
        let split = mesh.positions().iter().filter(|p| !soup.positions.contains(p)).count();
        prop_assert_eq!(mesh.face_count(), distinct.len() + split);
        if split == 0 {
            let faces: Vec<[u32; 3]> = distinct.into_iter().collect();
            prop_assert_eq!(
                edges_by_place(mesh.positions(), mesh.triangles()),
                edges_by_place(&soup.positions, &faces)
            );
        }
    }

    /// Every edge that has two or more faces in the input and is a boundary in the mesh is in an edge group,
    /// together with all half-edges at its place.
    #[test]
    fn every_cut_is_covered_by_a_junction(soup in triangle_soups()) {
        let Ok((mesh, diagnosis)) = Mesh::from_soup(&soup, &BuildOptions::default()) else { return Ok(()) };
        let place = |h: HalfEdgeId| {
            let mut ends = mesh.topology().ends(h).map(|v| mesh.positions()[v.index()].map(f64::to_bits));
            ends.sort_unstable();
            ends
        };
        let mut boundary: HashMap<_, Vec<u32>> = HashMap::new();
        for h in mesh.topology().half_edges().filter(|&h| mesh.topology().twin(h).is_none()) {
            boundary.entry(place(h)).or_default().push(h.0);
        }
        let mut grouped: HashMap<_, Vec<u32>> = HashMap::new();
        for group in mesh.junctions().edges.iter() {
            let mut members = group.to_vec();
            members.sort_unstable();
            prop_assert!(grouped.insert(place(HalfEdgeId(group[0])), members).is_none());
        }
        boundary.retain(|_, members| members.len() > 1);
        prop_assert_eq!(&boundary, &grouped);
        if grouped.is_empty() && diagnosis.bow_tie_vertices.is_empty() {
            prop_assert!(mesh.junctions().is_empty());
        }
        // For vertices too: all at one position are one group.
        let mut places: HashMap<_, Vec<u32>> = HashMap::new();
        for (v, p) in mesh.positions().iter().enumerate() {
            places.entry(p.map(f64::to_bits)).or_default().push(v as u32);
        }
        let mut several: Vec<Vec<u32>> = places.into_values().filter(|members| members.len() > 1).collect();
        several.sort_unstable();
        let mut groups: Vec<Vec<u32>> = mesh.junctions().vertices.iter().map(<[u32]>::to_vec).collect();
        groups.sort_unstable();
        prop_assert_eq!(several, groups);
    }
}

/// A closed surface some of whose edges were split on one side only, the slit filled by a face of zero area.
fn closed_soups_with_flat_faces() -> impl Strategy<Value = PolygonSoup> {
    prop::collection::vec(
        (any::<prop::sample::Index>(), 1..4u32, any::<bool>()),
        0..40,
    )
    .prop_map(|splits| {
        let mut positions = vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let mut faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        for (half_edge, quarters, twice) in splits {
            let h = half_edge.index(3 * faces.len());
            let (face, corner) = (h / 3, h % 3);
            let [a, b, c] = [0, 1, 2].map(|i| faces[face][(corner + i) % 3]);
            let t = f64::from(quarters) / 4.0;
            let [p, q]: [[f64; 3]; 2] = [a, b].map(|v: u32| positions[v as usize]);
            // Only exact divisions, so that the faces have no area by any measure.
            let middle = [0, 1, 2].map(|i| p[i] + t * (q[i] - p[i]));
            // Welding vertices of different sides would pinch the surface.
            if positions.contains(&middle) {
                continue;
            }
            let v = positions.len() as u32;
            positions.push(middle);
            faces[face] = [a, v, c];
            faces.push([v, b, c]);
            if twice {
                // Both sides of the edge are split: no flat face is needed.
                if let Some(other) = faces
                    .iter()
                    .position(|f| (0..3).any(|i| f[i] == b && f[(i + 1) % 3] == a))
                {
                    let i = (0..3).find(|&i| faces[other][i] == b).unwrap_or(0);
                    let d = faces[other][(i + 2) % 3];
                    faces[other] = [b, v, d];
                    faces.push([v, a, d]);
                    continue;
                }
            }
            faces.push([a, b, v]);
        }
        let faces: Vec<&[u32]> = faces.iter().map(|f| f.as_slice()).collect();
        soup(&positions, &faces)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn closed_surfaces_stay_closed(soup in closed_soups_with_flat_faces()) {
        let (mesh, diagnosis) = build_soup(&soup);
        prop_assert_eq!(mesh.topology().boundary_edge_count(), 0, "{}", diagnosis);
        prop_assert_eq!(mesh.topology().euler_characteristic(), 2);
        for (f, t) in mesh.triangles().iter().enumerate() {
            prop_assert!(!triangulate::is_flat(mesh.positions(), *t), "face {} has no area", f);
        }
    }
}
