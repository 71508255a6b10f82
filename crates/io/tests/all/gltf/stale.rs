//! Members of extensions that name vertices and triangles by number go with these, and nothing else does.

use super::support::{TRIANGLE, floats, glb, parts};
use limitmesh_io::{Asset, Format};
use serde_json::{Value, json};

/// The document after these primitives got another triangle, and the report on it.
fn edited(document: &Value, primitives: &[(usize, usize)]) -> (Value, Vec<String>) {
    let bytes = glb(
        &document.to_string(),
        &floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    );
    let mut asset = Asset::from_bytes(&bytes, None).unwrap();
    for &(mesh, primitive) in primitives {
        asset.replace(mesh, primitive, &TRIANGLE).unwrap();
    }
    let told = asset.left_out();
    (
        serde_json::from_str(&parts(&asset.to_bytes(Format::Glb).unwrap()).0).unwrap(),
        told,
    )
}

/// Two meshes of two primitives each, with these members of meshes and primitives.
fn document(mesh: [Value; 2], primitive: [Value; 2], used: &[&str]) -> Value {
    let of = |own: &Value, more: &[(&str, Value)]| {
        let mut own = own.clone();
        more.iter()
            .for_each(|(key, value)| own[*key] = value.clone());
        own
    };
    let primitives = primitive.map(|own| of(&own, &[("attributes", json!({"POSITION": 0}))]));
    let meshes = mesh.map(|own| of(&own, &[("primitives", json!(primitives))]));
    json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": used, "extensionsRequired": used,
        "buffers": [{"byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [
            {"componentType": 5126, "count": 3, "type": "VEC3", "bufferView": 0, "min": [0, 0, 0], "max": [1, 1, 0]},
            {"componentType": 5123, "count": 2, "type": "SCALAR"},
        ],
        "meshes": meshes,
        "nodes": [{"mesh": 0}, {"mesh": 1}],
        "scenes": [{"nodes": [0, 1], "extensions": {"FB_geometry_metadata": {"vertexCount": 9}}}],
        "scene": 0,
    })
}

#[test]
fn what_names_vertices_of_a_primitive_goes_with_them() {
    for name in [
        "CESIUM_primitive_outline",
        "EXT_mesh_primitive_edge_visibility",
    ] {
        let own = json!({"extensions": {(name): {"indices": 1}, "ODD_thing": {"indices": 1}}, "extras": 7});
        let document = document(
            [json!({}), json!({})],
            [own.clone(), own],
            &["ODD_thing", name],
        );
        let (new, told) = edited(&document, &[(0, 0), (1, 1)]);
        assert_eq!(told, [name, "FB_geometry_metadata"]);
        // Those of others stay, and with them the name in the document's lists.
        for (mesh, primitive, is_new) in [(0, 0, true), (0, 1, false), (1, 0, false), (1, 1, true)]
        {
            let own = &new["meshes"][mesh]["primitives"][primitive];
            assert_eq!(own["extensions"].get(name).is_none(), is_new, "{own}");
            assert_eq!(
                (&own["extensions"]["ODD_thing"], &own["extras"]),
                (&json!({"indices": 1}), &json!(7))
            );
        }
        assert_eq!(new["extensionsUsed"], document["extensionsUsed"]);
        assert!(new["scenes"][0].get("extensions").is_none(), "{new}");
        let (new, _) = edited(&document, &[(0, 0), (0, 1), (1, 0), (1, 1)]);
        for list in ["extensionsUsed", "extensionsRequired"] {
            assert_eq!(new[list], json!(["ODD_thing"]));
        }
        assert!(!new.to_string().contains(name), "{new}");
        // Where nothing is replaced, nothing goes.
        let (same, told) = edited(&document, &[]);
        assert!(same == document && told.is_empty(), "{same}");
    }
}

#[test]
fn what_names_vertices_of_a_mesh_goes_with_its_first_primitive() {
    let manifold = json!({"manifoldPrimitive": {"indices": 1, "mode": 4}, "mergeIndices": 1, "mergeValues": 1});
    let own = json!({"name": "solid", "extensions": {"EXT_mesh_manifold": manifold}});
    let document = document(
        [own.clone(), own],
        [json!({}), json!({})],
        &["EXT_mesh_manifold"],
    );
    let (new, told) = edited(&document, &[(1, 1)]);
    assert_eq!(told, ["EXT_mesh_manifold", "FB_geometry_metadata"]);
    assert_eq!(new["meshes"][0], document["meshes"][0]);
    assert_eq!(new["extensionsRequired"], json!(["EXT_mesh_manifold"]));
    assert!(
        new["meshes"][1].get("extensions").is_none() && new["meshes"][1]["name"] == "solid",
        "{new}"
    );
    let (new, _) = edited(&document, &[(0, 0), (1, 1)]);
    assert!(!new.to_string().contains("manifold"), "{new}");
    assert!(
        new.get("extensionsUsed").is_none() && new.get("extensionsRequired").is_none(),
        "{new}"
    );
}

#[test]
fn groups_of_primitives_and_links_of_meshes_stay_where_they_hold() {
    let group = json!({"primitiveGroups": [{"primitives": [1], "indices": 1}]});
    let link = json!({"mesh": 0, "correspondence": 1, "pose": 1});
    let meshes = [
        json!({"extensions": {"EXT_mesh_primitive_restart": group}}),
        json!({"extensions": {"MPEG_mesh_linking": link}}),
    ];
    let document = document(meshes, [json!({}), json!({})], &[]);
    let has = |new: &Value| [0, 1].map(|mesh| new["meshes"][mesh].get("extensions").is_some());
    // Neither the group nor the mesh that is linked, the group, and the mesh that has the link.
    for (primitives, expected) in [
        (vec![], [true, true]),
        (vec![(0, 0)], [true, false]),
        (vec![(0, 1)], [false, false]),
        (vec![(1, 0)], [true, false]),
    ] {
        let (new, told) = edited(&document, &primitives);
        assert_eq!(has(&new), expected, "{primitives:?}: {new}");
        assert_eq!(
            told.iter().any(|name| name == "EXT_mesh_primitive_restart"),
            !expected[0]
        );
        assert_eq!(
            told.iter().any(|name| name == "MPEG_mesh_linking"),
            !expected[1]
        );
    }
}

#[test]
fn features_by_vertex_number_go_and_others_stay() {
    let sets = [
        json!({"featureCount": 3}),
        json!({"featureCount": 2, "attribute": 0, "label": "a\u{e4}"}),
    ];
    let features = |sets: &[Value]| json!({"extensions": {"EXT_mesh_features": {"featureIds": sets, "extras": 1.5}}});
    let document = document(
        [json!({}), json!({})],
        [features(&sets), features(&sets[..1])],
        &["EXT_mesh_features"],
    );
    let (new, told) = edited(&document, &[(0, 0), (0, 1), (1, 1)]);
    assert_eq!(
        told,
        ["EXT_mesh_features by vertex number", "FB_geometry_metadata"]
    );
    let primitives = |mesh: usize| new["meshes"][mesh]["primitives"].as_array().unwrap();
    assert_eq!(
        primitives(0)[0]["extensions"],
        features(&sets[1..])["extensions"]
    );
    assert!(primitives(0)[1].get("extensions").is_none(), "{new}");
    assert_eq!(primitives(1)[0], document["meshes"][1]["primitives"][0]);
    assert_eq!(new["extensionsUsed"], json!(["EXT_mesh_features"]));
}
