//! The paper's models and what plays their part: files of a folder whose names match, built-in models else.

use std::path::Path;

use anyhow::{Context, ensure};
use limitmesh::Mesh;
use limitmesh_render::ViewDirection;
use serde::Serialize;

use super::vector::{add_scaled, cross};
use crate::Host;

/// Extensions under which a model is looked for, in this order.
const EXTENSIONS: [&str; 4] = ["off", "obj", "ply", "stl"];

/// A control mesh with more faces would take gigabytes and minutes: four uniform levels of it have 256 times
/// as many.
const MOST_FACES: usize = 6000;

/// A model of the paper.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Its name on the page and in the tables; also that of the built-in model.
    pub(super) name: &'static str,
    /// Files that may play it, in this order.
    files: &'static [File],
}

/// A file, without extension, that may play a part.
#[derive(Clone, Copy, Debug)]
struct File {
    stem: &'static str,
    /// What it is, as seen from the paper.
    about: &'static str,
    /// Straight at its front.
    front: ViewDirection,
}

/// A file whose front looks along +z and whose y axis points up, as in the built-in models.
const fn file(stem: &'static str, about: &'static str) -> File {
    File {
        stem,
        about,
        front: FRONT,
    }
}

/// A file that lies or stands otherwise.
const fn turned(stem: &'static str, about: &'static str, sight: [f64; 3], up: [f64; 3]) -> File {
    File {
        stem,
        about,
        front: ViewDirection { sight, up },
    }
}

const ALONG_Y: [f64; 3] = [0.0, 1.0, 0.0];
const ALONG_Z: [f64; 3] = [0.0, 0.0, 1.0];

const FRONT: ViewDirection = ViewDirection {
    sight: [0.0, 0.0, -1.0],
    up: [0.0, 1.0, 0.0],
};

/// What the paper calls its models is all that is known of them; the stems are those of freely available
/// meshes of the same subjects, coarse enough to be control meshes.
pub(super) const TABLE_1: [Part; 6] = [
    Part {
        name: "bunny",
        files: &[
            file("bunny_1k", "Stanford bunny, simplified"),
            file("bunny", "bunny"),
        ],
    },
    Part {
        name: "teddy",
        files: &[file("teddy", "the classic teddy bear")],
    },
    Part {
        name: "shark",
        files: &[
            file("shark", "shark"),
            turned(
                "fish_cage",
                "a fish, in place of the shark",
                [-0.6, 0.0, -0.8],
                ALONG_Y,
            ),
        ],
    },
    Part {
        name: "cup",
        files: &[
            file("cup", "cup"),
            turned(
                "cup_standin",
                "a cup like the paper's",
                [0.0, -1.0, 0.0],
                ALONG_Z,
            ),
        ],
    },
    Part {
        name: "radish",
        files: &[
            file("radish", "radish"),
            turned(
                "radish_standin",
                "a radish like the paper's",
                ALONG_Y,
                ALONG_Z,
            ),
        ],
    },
    Part {
        name: "cusp",
        files: &[
            file("cusp", "cusp"),
            file("cusp_standin", "a cusp like the paper's"),
        ],
    },
];

/// Figure 7.
pub(super) const HEAD: Part = Part {
    name: "head",
    files: &[
        turned(
            "mannequin_142",
            "the mannequin head, simplified to 142 faces",
            [0.0, -1.0, 0.0],
            [0.0, 0.0, -1.0],
        ),
        file("head", "head"),
    ],
};

/// Beside Figure 7's head: its proportions without its features. No file plays it.
pub(super) const ELLIPSOID: Part = Part {
    name: "ellipsoid",
    files: &[],
};

/// Figure 8.
pub(super) const SHOE: Part = Part {
    name: "shoe",
    files: &[
        file("shoe", "shoe"),
        file("boot_684", "a boot of 684 faces"),
    ],
};

/// Figure 9.
pub(super) const SPHERE: Part = Part {
    name: "sphere",
    files: &[
        file("sphere_360", "sphere of 20 slices by 10 stacks"),
        file("sphere", "sphere"),
    ],
};

/// A control mesh that plays a part.
#[derive(Clone, Debug)]
pub(super) struct Player {
    /// The part's name.
    pub(super) name: &'static str,
    /// The mesh.
    pub(super) mesh: Mesh,
    /// Where it came from.
    pub(super) origin: Origin,
    /// Straight at its front.
    pub(super) front: ViewDirection,
}

impl Player {
    /// From the front, a little from the right and above, which shows most shapes well.
    pub(super) fn view(&self) -> ViewDirection {
        let ViewDirection { sight, up } = self.front;
        let right = cross(sight, up);
        ViewDirection {
            sight: add_scaled(add_scaled(sight, -0.4, right), -0.25, up),
            up,
        }
    }
}

/// Where a mesh came from.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Origin {
    /// File name, or `builtin:NAME`.
    pub(super) source: String,
    /// Whether it was read from a file.
    pub(super) file: bool,
    /// What it is.
    pub(super) about: String,
}

/// Finds players for parts.
pub(super) struct Casting<'a> {
    folder: Option<&'a Path>,
    host: &'a dyn Host,
}

impl<'a> Casting<'a> {
    /// # Errors
    /// `folder` is no folder.
    pub(super) fn new(folder: Option<&'a Path>, host: &'a dyn Host) -> anyhow::Result<Self> {
        if let Some(folder) = folder {
            ensure!(
                folder.is_dir(),
                "--models: {} is no folder",
                folder.display()
            );
        }
        Ok(Self { folder, host })
    }

    /// The first file of the folder whose name matches, the built-in model else.
    ///
    /// # Errors
    /// The file is there but gives no control mesh, or too large a one.
    pub(super) fn play(&self, part: &Part) -> anyhow::Result<Player> {
        let Some((path, file)) = self.folder.and_then(|folder| matching(folder, part)) else {
            return self.builtin(part);
        };
        let name = path
            .to_str()
            .with_context(|| format!("{} is no UTF-8 path", path.display()))?;
        let mesh = self.host.load(name)?;
        let faces = mesh.face_count();
        ensure!(
            faces <= MOST_FACES,
            "{name} has {faces} triangles; a control mesh of at most {MOST_FACES} is expected here"
        );
        let source = path
            .file_name()
            .map(|n| n.to_string_lossy().into_owned())
            .unwrap_or_default();
        let origin = Origin {
            source,
            file: true,
            about: file.about.to_owned(),
        };
        Ok(Player {
            name: part.name,
            mesh,
            origin,
            front: file.front,
        })
    }

    /// The built-in model of the part's name.
    ///
    /// # Errors
    /// There is none.
    pub(super) fn builtin(&self, part: &Part) -> anyhow::Result<Player> {
        let source = format!("builtin:{}", part.name);
        let mesh = self.host.load(&source)?;
        let about = limitmesh_models::find(part.name)
            .map_or(part.name, |model| model.about)
            .to_owned();
        let origin = Origin {
            source,
            file: false,
            about,
        };
        Ok(Player {
            name: part.name,
            mesh,
            origin,
            front: FRONT,
        })
    }
}

/// The first file in `folder` that may play `part`.
fn matching(folder: &Path, part: &Part) -> Option<(std::path::PathBuf, File)> {
    part.files.iter().find_map(|file| {
        let names = EXTENSIONS
            .iter()
            .map(|extension| folder.join(format!("{}.{extension}", file.stem)));
        names
            .into_iter()
            .find(|path| path.is_file())
            .map(|path| (path, *file))
    })
}

/// The stems that are looked for, for the page and the help text.
pub(super) fn stems(part: &Part) -> Vec<&'static str> {
    part.files.iter().map(|file| file.stem).collect()
}
