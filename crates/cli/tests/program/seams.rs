//! Seams of texture coordinates in PLY files: they come out as they were read, which is what other programs read.

use crate::common::{counts, file, folder, run, soup};
use crate::hints::{CORNERS, SIDES};

/// A cube as Blender writes it: a vertex for each corner of each side, with its normal and its place on the picture, of which each side
/// has all.
pub(crate) fn cube() -> String {
    let mut text = "ply\nformat ascii 1.0\nelement vertex 24\n".to_owned();
    for name in ["x", "y", "z", "nx", "ny", "nz", "s", "t"] {
        text += &format!("property float {name}\n");
    }
    text += "element face 6\nproperty list uchar uint vertex_indices\nend_header\n";
    for (corners, [u, v, w]) in SIDES {
        for (corner, [s, t]) in corners.into_iter().zip([[0, 0], [1, 0], [1, 1], [0, 1]]) {
            let [x, y, z] = CORNERS[corner];
            text += &format!("{x} {y} {z} {u} {v} {w} {s} {t}\n");
        }
    }
    for side in 0..6 {
        text += &format!(
            "4 {} {} {} {}\n",
            4 * side,
            4 * side + 1,
            4 * side + 2,
            4 * side + 3
        );
    }
    text
}

#[test]
fn texture_coordinates_of_vertices_stay_so() {
    let folder = folder();
    let input = file(&folder, "in.ply", &cube());
    let output = folder.path().join("out.ply");
    for options in [
        "",
        "--crease-angle 30",
        "--creases-from normals",
        "--crease-angle 30 --provenance --ascii",
    ] {
        let command = format!("refine {{}} -o {{}} --tolerance 2% --report - {options}");
        let said = run(&command, &[&input, &output]).expect(0);
        let said = said.saying("seams of texture coordinates");
        assert!(
            !said.stderr.contains("--split-normals") && !said.stderr.contains("one of several"),
            "{}",
            said.stderr
        );
        let report = said.json();
        let bytes = std::fs::read(&output).expect("written");
        let header = String::from_utf8_lossy(&bytes);
        for line in ["property float nx", "property float s", "property float t"] {
            assert!(header.contains(&format!("{line}\n")), "{line}");
        }
        assert!(!header.contains("texcoord"));
        // Each side shows all of the picture, once; what is torn there holds together in space.
        let found = soup(&output);
        let own = found
            .channels
            .iter()
            .find(|own| own.name == "s,t")
            .expect("texture coordinates");
        let area: f64 = found
            .faces
            .iter()
            .map(|face| {
                let [a, b, c] = [face[0], face[1], face[2]].map(|v| own.value(v as usize));
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            })
            .sum();
        assert!((area - 6.0).abs() < 1e-5, "{area}");
        assert!(counts(&found).boundary_edges > 0);
        let mut places = found
            .positions
            .iter()
            .map(|p| p.map(f64::to_bits))
            .collect::<Vec<_>>();
        places.sort_unstable();
        places.dedup();
        assert_eq!(report["output"]["vertices"], places.len());
        // Normals are of the side that their vertex is on.
        if !options.is_empty() {
            let normals = found
                .channels
                .iter()
                .find(|own| own.name == "normals")
                .expect("normals");
            for (v, p) in found.positions.iter().enumerate() {
                let n = normals.value(v);
                let axis = (0..3).find(|&i| n[i].abs() > 0.999).expect("along an axis");
                assert!((p[axis] - n[axis].signum()).abs() < 1e-6, "{p:?} {n:?}");
            }
        }
    }
    // Without seams a vertex is one.
    let report = run(
        "refine {} -o {} --channel s,t=drop --report -",
        &[&input, &output],
    )
    .expect(0)
    .json();
    assert_eq!(report["output"]["vertices"], soup(&output).positions.len());
}
