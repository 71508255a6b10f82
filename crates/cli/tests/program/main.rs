//! The program as its users meet it: commands, files, exit codes, the JSON contract.

mod common;
mod compare;
mod concave;
mod exact;
mod examine;
mod interpolate;
mod measure;
mod refine;
mod render;
mod reproduce;
mod usage;
mod writing;
