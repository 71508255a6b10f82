//! The library from outside, in one program: linking one for each subject takes longer than running most of them.

#[macro_use]
extern crate limitmesh_testing;

mod opensubdiv;
mod support;

mod angles;
mod attribute_goals;
mod backs;
mod bounds;
mod carry;
mod carry_collapsed;
mod catmull_clark;
mod certificate;
mod creases;
mod exact;
mod exact_general;
mod facing;
mod flat;
mod front;
mod interpolation;
mod levels_of_detail;
mod limit_normals;
mod limit_surface;
mod measures;
mod parts;
mod pixels;
mod progress;
mod proximity;
mod rays;
mod refine;
mod replay;
mod simplified;
mod sqrt3;
mod strips;
mod within;
