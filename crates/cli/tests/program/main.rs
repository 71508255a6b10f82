//! The program as its users meet it: commands, files, exit codes, the JSON contract.

mod asset;
mod asset_choice;
mod asset_morphs;
mod asset_skins;
mod batch;
mod channels;
mod common;
mod compare;
mod concave;
mod exact;
mod examine;
mod glb;
mod hints;
mod interpolate;
mod limits;
mod measure;
mod package;
mod quantities;
mod refine;
mod render;
mod reproduce;
mod shading;
mod size;
mod streams;
mod usage;
mod writing;
