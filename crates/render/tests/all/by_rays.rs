//! Pictures of the limit surface by rays, beside pictures of fine meshes of it.

#![allow(clippy::unwrap_used, missing_docs)]

use core::ops::ControlFlow;

use crate::support::pool;
use limitmesh::mesh::SplitSurface;
use limitmesh::refine::{ExactOptions, exact};
use limitmesh::scheme::Loop;
use limitmesh::{LimitSurface, Mesh, RayCaster};
use limitmesh_render::{
    Camera, Image, RenderError, Style, ViewDirection, render, render_exact, render_exact_observed,
};

const SIZE: (u32, u32) = (150, 120);

fn control(name: &str) -> Mesh {
    let soup = limitmesh_models::find(name).unwrap().soup();
    Mesh::from_soup(&soup, &Default::default()).unwrap().0
}

/// The limit surface by rays, and a mesh of it to 1/20 of a pixel with its limit normals.
fn pictures(control: &Mesh, camera: impl Fn(&SplitSurface) -> Camera) -> [Image; 2] {
    let tolerance = 0.0003 * control.diagonal();
    let options = ExactOptions::default().tolerance(tolerance);
    let fine = exact(control, &Loop, &options).unwrap().split_surface();
    let (camera, style) = (camera(&fine), Style::default());
    let surface = LimitSurface::new(control, &Loop).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    let by_rays = render_exact(&rays, &camera, &style, SIZE).unwrap();
    let (mesh, normals) = (fine.as_triangles(), Some(&fine.normals[..]));
    let of_mesh = render(mesh, normals, None, &camera, &style, SIZE.0, SIZE.1);
    [by_rays, of_mesh.unwrap()]
}

/// Pixels that differ by more than so much in a channel, and of them those with nothing but surface, or nothing but background, around
/// in the mesh's picture.
fn differing([a, b]: &[Image; 2], by: u8) -> (usize, usize) {
    let background = [255; 4];
    let (mut all, mut inside) = (0, 0);
    for y in 0..SIZE.1 {
        for x in 0..SIZE.0 {
            let (p, q) = (a.pixel(x, y).unwrap(), b.pixel(x, y).unwrap());
            if p.iter().zip(&q).all(|(p, q)| p.abs_diff(*q) <= by) {
                continue;
            }
            all += 1;
            let around = (0..9u32)
                .filter_map(|i| b.pixel((x + i % 3).checked_sub(1)?, (y + i / 3).checked_sub(1)?));
            let empty = around.clone().filter(|&pixel| pixel == background).count();
            inside += usize::from(empty == 0 || empty == around.count());
        }
    }
    (all, inside)
}

#[test]
fn pictures_are_those_of_fine_meshes_but_along_outlines() {
    let tight = |fine: &SplitSurface| {
        let view = ViewDirection::default();
        Camera::fit_tightly(fine.as_triangles(), view, SIZE.0, SIZE.1).unwrap()
    };
    let near = |fine: &SplitSurface| {
        let view = ViewDirection::front();
        Camera::fit_perspective(fine.as_triangles(), view, 40.0, SIZE.0, SIZE.1).unwrap()
    };
    let sphere = pictures(&control("sphere"), tight);
    let torus = pictures(&control("torus"), near);
    for (name, images) in [("sphere", sphere), ("torus", torus)] {
        let (all, inside) = differing(&images, 6);
        println!(
            "{name}: {all} pixels of {} differ by more than 6, {inside} of them not along the outline",
            SIZE.0 * SIZE.1
        );
        let covered = images[0]
            .rgba()
            .chunks(4)
            .filter(|pixel| *pixel != [255; 4])
            .count();
        assert!(covered > 2000, "{name}: {covered}");
        // The torus has an outline in front of itself, too.
        let most = if name == "sphere" { 0 } else { 40 };
        assert!(inside <= most && all < 200, "{name}: {all} {inside}");
    }
}

#[test]
fn pictures_are_the_same_bytes_on_any_number_of_threads() {
    let control = control("tetrahedron");
    let surface = LimitSurface::new(&control, &Loop).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    let camera = Camera::fit(control.as_triangles(), ViewDirection::side(), 60, 40).unwrap();
    let draw = || render_exact(&rays, &camera, &Style::default(), (60, 40)).unwrap();
    let with = |threads| pool(threads).install(draw);
    assert_eq!(with(1), with(3));
}

#[test]
fn it_tells_how_it_goes_on_and_is_cancelled() {
    let control = control("tetrahedron");
    let surface = LimitSurface::new(&control, &Loop).unwrap();
    let rays = RayCaster::new(&surface).unwrap();
    let camera = Camera::fit(control.as_triangles(), ViewDirection::side(), 60, 40).unwrap();
    let (mut last, mut total) = (0, 0);
    let mut watch = |at: &limitmesh::progress::Progress| {
        assert!(at.done >= last);
        (last, total) = (at.done, at.total.unwrap());
        ControlFlow::Continue(())
    };
    render_exact_observed(&rays, &camera, &Style::default(), (60, 40), &mut watch).unwrap();
    assert!(last == total && total > 60 * 40, "{last} {total}");
    let stopped = render_exact_observed(&rays, &camera, &Style::default(), (60, 40), &mut |_| {
        ControlFlow::Break(())
    });
    assert_eq!(stopped.unwrap_err(), RenderError::Cancelled);
    let none = render_exact(&rays, &camera, &Style::default(), (0, 40));
    assert!(matches!(none, Err(RenderError::Size { .. })));
}
