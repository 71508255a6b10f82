//! The program as its users meet it: commands, files, exit codes, the JSON contract.

#[macro_use]
extern crate limitmesh_testing;

#[macro_use]
mod common;

mod asset;
mod asset_cards;
mod asset_choice;
mod asset_morphs;
mod asset_polygons;
mod asset_skins;
mod asset_tangents;
mod batch;
mod catmull_clark;
mod channel_goals;
mod channels;
mod compare;
mod concave;
mod evaluate;
mod exact;
mod examine;
mod frames;
mod glb;
mod hints;
mod interpolate;
mod kept;
mod limits;
mod lod;
mod materials;
mod measure;
mod naming;
mod package;
mod pages;
mod parts;
mod project;
mod proof;
mod quantities;
mod refine;
mod render;
mod reproduce;
mod restricted;
mod shading;
mod shared_models;
mod shipped;
mod size;
mod sqrt3;
mod streams;
mod units;
mod usage;
mod view;
mod within;
mod writing;
