//! A human head of 142 triangles, open at the neck: half of it designed by hand, mirrored.
//!
//! The designed points lie on the limit surface; the control vertices are found from them.

use super::sculpt::{Surface, mirrored_with_limit_through};
use glam::DVec3;

/// The points of the half with x ≥ 0, each with the letter that names it in [`TRIANGLES`].
const POINTS: [(char, [f64; 3]); 46] = [
    // The profile, from the neck's front over face and crown to the neck's back.
    ('A', [0.0, -0.98, 0.06]),
    ('B', [0.0, -0.62, 0.14]),
    ('C', [0.0, -0.52, 0.5]),
    ('U', [0.0, -0.29, 0.575]),
    ('D', [0.0, -0.235, 0.545]),
    ('E', [0.0, -0.185, 0.585]),
    ('F', [0.0, -0.075, 0.57]),
    ('G', [0.0, 0.0, 0.69]),
    ('H', [0.0, 0.285, 0.54]),
    ('I', [0.0, 0.4, 0.55]),
    ('J', [0.0, 0.65, 0.5]),
    ('K', [0.0, 0.935, 0.2]),
    ('L', [0.0, 0.955, -0.2]),
    ('M', [0.0, 0.66, -0.6]),
    ('N', [0.0, 0.18, -0.68]),
    ('O', [0.0, -0.3, -0.46]),
    ('P', [0.0, -0.98, -0.46]),
    // The rim of the neck.
    ('Q', [0.29, -0.98, -0.04]),
    ('R', [0.34, -0.98, -0.27]),
    // Nose: wing and flank.
    ('a', [0.12, -0.05, 0.545]),
    ('b', [0.08, 0.12, 0.55]),
    // Eye: inner corner, ball, outer corner; brow: middle, end.
    ('c', [0.105, 0.225, 0.45]),
    ('d', [0.235, 0.215, 0.47]),
    ('e', [0.37, 0.21, 0.36]),
    ('f', [0.22, 0.365, 0.52]),
    ('g', [0.41, 0.33, 0.39]),
    // Cheekbone: below the eye, towards the ear; mouth corner, cheek, chin, jaw.
    ('h', [0.25, 0.05, 0.49]),
    ('i', [0.44, 0.06, 0.3]),
    ('j', [0.165, -0.235, 0.465]),
    ('k', [0.34, -0.2, 0.33]),
    ('l', [0.15, -0.5, 0.43]),
    ('m', [0.41, -0.28, 0.03]),
    ('n', [0.31, -0.42, 0.28]),
    ('o', [0.22, -0.62, 0.05]),
    // Forehead and temple.
    ('p', [0.27, 0.62, 0.41]),
    ('q', [0.47, 0.42, 0.16]),
    // Ear: root in front above and below, rim above and below, root behind.
    ('r', [0.5, 0.22, 0.0]),
    ('s', [0.47, -0.1, 0.0]),
    ('t', [0.62, 0.28, -0.16]),
    ('u', [0.57, 0.0, -0.14]),
    ('v', [0.49, 0.1, -0.16]),
    // Side and back of the skull, side of the neck.
    ('w', [0.4, 0.76, 0.02]),
    ('x', [0.51, 0.45, -0.28]),
    ('y', [0.36, 0.1, -0.5]),
    ('z', [0.34, 0.72, -0.36]),
    ('T', [0.34, -0.4, -0.18]),
];

/// The 71 triangles of the half by the letters of their corners.
const TRIANGLES: &str = "\
    FaG Gab bHG cHb hcb hba fIH fHc fcd gfd deg dhe dch ehi eig qgi aFE aEj \
    ajh ihk khj jED nkj jln lCB lon lBo ikm ims isr rqi mkn mno oTm QBA oBQ \
    oQR oRT smT sur utr tvr uvt svu sTv Tyv TOy yON yxv rvx rxq xwq IpJ fpI \
    gpf qpg pKJ wKp wpq wLK wzL zML xzw yzx yMz yNM TRO ORP jDU jUl lUC";

/// The head, looking to the front.
pub(super) fn head() -> Surface {
    let positions = POINTS.iter().map(|&(_, p)| DVec3::from_array(p)).collect();
    let index = |letter: char| {
        POINTS
            .iter()
            .position(|&(name, _)| name == letter)
            .map_or(0, |v| v as u32)
    };
    let triangles = TRIANGLES
        .split_whitespace()
        .map(|name| {
            let mut corners = name.chars().map(index);
            core::array::from_fn(|_| corners.next().unwrap_or(0))
        })
        .collect();
    mirrored_with_limit_through(
        &Surface {
            positions,
            triangles,
        },
        6,
    )
}
