//! Where meshes come from and go back to: a file of one mesh, a glTF asset, a 3MF package.

mod asset;
mod carried;
mod file;
mod item;
mod package;
mod put_back;
mod scene;
mod selection;
mod vertices;
mod weights;

pub(super) use asset::AssetSource;
pub(super) use file::{FileSource, by_faces, item_of};
pub(super) use item::{Item, Source};
pub(super) use package::PackageSource;
