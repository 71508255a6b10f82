//! The commands, one file each: arguments in, files and text out.

pub(crate) mod batch;
pub(crate) mod batch_job;
mod certified;
mod channels;
pub(crate) mod compare;
mod covering;
pub(crate) mod evaluate;
mod heatmap;
pub(crate) mod info;
mod interpolation;
mod limit_control;
pub(crate) mod lod;
pub(crate) mod measure;
pub(crate) mod models;
mod named_files;
mod normals;
mod picture;
pub(crate) mod project;
pub(crate) mod refine;
pub(crate) mod render;
pub(crate) mod reproduce;
mod shading;
pub(crate) mod shipped;
pub(crate) mod view;
