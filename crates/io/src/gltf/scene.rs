//! Where the meshes of a document stand: world matrices of the nodes that use them, their instances, and their skins.
//!
//! The length of a tolerance in the scene is divided by the greatest stretch of a mesh's matrices to hold for the mesh:
//! a point that is d from another there is at most that stretch times d from it in the scene. The vertices of a skin go
//! where a mixture of its joints' matrices puts them, and a mixture stretches no more than the worst of them.

use super::flaw::{GltfFlaw, Result};
use super::json::At;
use super::parts::MeshSoup;
use super::source::Source;
use crate::affine::{self, Affine, IDENTITY};

pub(super) const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// How a node puts a mesh into the scene.
#[derive(Clone, Debug)]
pub(super) enum Placement {
    /// By one matrix.
    Rigid(Affine),
    /// By a mixture of the matrices of a skin's joints.
    Skinned(Vec<Affine>),
}

/// Where all meshes stand.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    /// By mesh: how each node that uses it does, and whether that node is in the scene that is shown.
    pub(super) placements: Vec<Vec<(Placement, bool)>>,
}

impl Placement {
    /// How many times longer vectors become at most.
    fn stretch(&self) -> f64 {
        match self {
            Self::Rigid(m) => affine::greatest_stretch(m),
            Self::Skinned(joints) => joints
                .iter()
                .map(affine::greatest_stretch)
                .fold(0.0, f64::max),
        }
    }

    /// Where vertex `v` of a mesh goes.
    pub(super) fn apply(&self, mesh: &MeshSoup, v: usize) -> [f64; 3] {
        let point = mesh.soup.positions[v];
        match self {
            Self::Rigid(m) => affine::apply(m, point),
            Self::Skinned(joints) => {
                let influences = mesh.influences.get(v).map_or(&[][..], Vec::as_slice);
                let total: f64 = influences.iter().map(|&(_, weight)| weight).sum();
                let mut moved = [0.0; 3];
                for &(joint, weight) in influences {
                    let Some(m) = joints.get(joint as usize) else {
                        continue;
                    };
                    let share = affine::apply(m, point);
                    (0..3).for_each(|i| moved[i] += weight / total * share[i]);
                }
                if total > 0.0 { moved } else { point }
            }
        }
    }

    /// Which way a normal at vertex `v` of a mesh looks then, of any length.
    pub(super) fn apply_to_normal(&self, mesh: &MeshSoup, v: usize, normal: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Rigid(m) => affine::apply_to_normal(m, normal),
            Self::Skinned(joints) => {
                let mut mixture: Affine = [[0.0; 4]; 3];
                for &(joint, weight) in mesh.influences.get(v).into_iter().flatten() {
                    let Some(m) = joints.get(joint as usize) else {
                        continue;
                    };
                    let sum = mixture.as_flattened_mut().iter_mut().zip(m.as_flattened());
                    sum.for_each(|(sum, own)| *sum += weight * own);
                }
                let is_moved = mixture != [[0.0; 4]; 3];
                if is_moved {
                    affine::apply_to_normal(&mixture, normal)
                } else {
                    normal
                }
            }
        }
    }

    /// Whether surfaces turn inside out.
    pub(super) fn mirrors(&self) -> bool {
        match self {
            Self::Rigid(m) => affine::mirrors(m),
            Self::Skinned(joints) => joints.first().is_some_and(affine::mirrors),
        }
    }
}

impl Scene {
    /// What tolerances for a mesh are divided by; 1 if nothing shows it.
    pub(super) fn stretch(&self, mesh: usize) -> f64 {
        let all = self.placements.get(mesh).into_iter().flatten();
        let most = all
            .map(|(placement, _)| placement.stretch())
            .fold(0.0, f64::max);
        if most > 0.0 && most.is_finite() {
            most
        } else {
            1.0
        }
    }

    /// What the placement by which a mesh is largest does to vectors, by rows. A skin does what all its joints do, or else it makes all
    /// vectors as long as the worst of them.
    pub(super) fn largest(&self, mesh: usize) -> [[f64; 3]; 3] {
        let all = self
            .placements
            .get(mesh)
            .into_iter()
            .flatten()
            .map(|(placement, _)| placement);
        let largest = all.reduce(|most, own| {
            if own.stretch() > most.stretch() {
                own
            } else {
                most
            }
        });
        let evenly = |stretch: f64| {
            std::array::from_fn(|i| std::array::from_fn(|j| if i == j { stretch } else { 0.0 }))
        };
        match largest {
            None => evenly(1.0),
            Some(Placement::Rigid(m)) => affine::linear(m),
            Some(skin @ Placement::Skinned(joints)) => {
                let is_one = joints
                    .windows(2)
                    .all(|pair| affine::linear(&pair[0]) == affine::linear(&pair[1]));
                joints
                    .first()
                    .filter(|_| is_one)
                    .map_or_else(|| evenly(skin.stretch()), affine::linear)
            }
        }
    }

    /// How the scene that is shown has a mesh; once as it is if the document has no nodes.
    pub(super) fn shown(&self, mesh: usize) -> impl Iterator<Item = &Placement> {
        let all = self.placements.get(mesh).into_iter().flatten();
        all.filter(|(_, is_shown)| *is_shown)
            .map(|(placement, _)| placement)
    }
}

impl Source {
    /// Where all meshes stand.
    pub(super) fn scene(&self) -> Result<Scene> {
        let root = self.root();
        let meshes = root.list("meshes")?.len();
        let mut placements = vec![Vec::new(); meshes];
        let nodes = root.list("nodes")?;
        if nodes.is_empty() {
            placements
                .iter_mut()
                .for_each(|all| all.push((Placement::Rigid(IDENTITY), true)));
            return Ok(Scene { placements });
        }
        let tree = self.tree(&nodes)?;
        let shown = self.shown_roots(&tree)?;
        for (i, node) in nodes.iter().enumerate() {
            let Some(mesh) = node.get("mesh") else {
                continue;
            };
            let (mesh, _) = mesh.item_of(&root, "meshes")?;
            let is_shown = shown[tree.roots[i]];
            if let Some(skin) = node.get("skin") {
                placements[mesh].push((Placement::Skinned(self.joints(&skin, &tree)?), is_shown));
                continue;
            }
            let instances = match node.path(&["extensions", INSTANCING]) {
                Some(extension) => self.instances(&extension)?,
                None => vec![IDENTITY],
            };
            let world = &tree.world[i];
            let placed = instances
                .iter()
                .map(|own| (Placement::Rigid(affine::product(world, own)), is_shown));
            placements[mesh].extend(placed);
        }
        Ok(Scene { placements })
    }

    /// World matrices of all nodes.
    fn tree(&self, nodes: &[At<'_>]) -> Result<Tree> {
        let mut children = Vec::with_capacity(nodes.len());
        let mut has_parent = vec![false; nodes.len()];
        for node in nodes {
            let mut own = Vec::new();
            for child in node.list("children")? {
                let (index, _) = child.item_of(&self.root(), "nodes")?;
                if std::mem::replace(&mut has_parent[index], true) {
                    return Err(child.unexpected("a node that is no child of another"));
                }
                own.push(index);
            }
            children.push(own);
        }
        let mut tree = Tree {
            world: vec![IDENTITY; nodes.len()],
            roots: vec![usize::MAX; nodes.len()],
        };
        let mut waiting: Vec<(usize, usize, Affine)> = Vec::new();
        for start in (0..nodes.len()).filter(|&node| !has_parent[node]) {
            waiting.push((start, start, IDENTITY));
            while let Some((node, root, parent)) = waiting.pop() {
                let world = affine::product(&parent, &local(&nodes[node])?);
                tree.world[node] = world;
                tree.roots[node] = root;
                waiting.extend(children[node].iter().map(|&child| (child, root, world)));
            }
        }
        // Each node has one parent at most, so that what no root leads to runs in circles.
        match tree.roots.iter().position(|&root| root == usize::MAX) {
            None => Ok(tree),
            Some(node) => {
                let at = nodes[node].place();
                Err(GltfFlaw::saying(at, "the node is below itself"))
            }
        }
    }

    /// By node, whether the scene that is shown has it as a root.
    fn shown_roots(&self, tree: &Tree) -> Result<Vec<bool>> {
        let root = self.root();
        let scenes = root.list("scenes")?;
        let scene = match root.get("scene") {
            Some(scene) => Some(scene.item_of(&root, "scenes")?.1),
            None => scenes.into_iter().next(),
        };
        let Some(scene) = scene else {
            return Ok(vec![true; tree.roots.len()]);
        };
        let mut shown = vec![false; tree.roots.len()];
        for node in scene.list("nodes")? {
            let (node, _) = node.item_of(&root, "nodes")?;
            shown[tree.roots[node]] = true;
        }
        Ok(shown)
    }

    /// The matrices of a skin's joints, from the mesh to the scene.
    fn joints(&self, skin: &At<'_>, tree: &Tree) -> Result<Vec<Affine>> {
        let root = self.root();
        let (_, skin) = skin.item_of(&root, "skins")?;
        let joints = skin.list("joints")?;
        let inverse = match skin.get("inverseBindMatrices") {
            Some(accessor) => Some(self.numbers(&accessor, None)?),
            None => None,
        };
        let mut matrices = Vec::with_capacity(joints.len());
        for (i, joint) in joints.iter().enumerate() {
            let (node, _) = joint.item_of(&root, "nodes")?;
            let bind = match &inverse {
                None => IDENTITY,
                Some(numbers) => {
                    let columns = numbers
                        .values
                        .as_chunks::<16>()
                        .0
                        .get(i)
                        .filter(|_| numbers.components == 16);
                    affine::of_columns(columns.ok_or_else(|| {
                        let problem = format!("joint {i} has no inverse bind matrix");
                        GltfFlaw::saying(skin.place(), problem)
                    })?)
                }
            };
            matrices.push(affine::product(&tree.world[node], &bind));
        }
        Ok(matrices)
    }

    /// The matrices of a node's instances.
    fn instances(&self, extension: &At<'_>) -> Result<Vec<Affine>> {
        let attributes = extension.require("attributes")?;
        let mut count = None;
        let mut read = |name: &str, width: usize| -> Result<Option<Vec<f64>>> {
            let Some(accessor) = attributes.get(name) else {
                return Ok(None);
            };
            let numbers = self.numbers(&accessor, count)?;
            if numbers.components != width {
                let problem = format!("{name} needs {width} numbers an element");
                return Err(GltfFlaw::saying(accessor.place(), problem));
            }
            count = Some(numbers.len());
            Ok(Some(numbers.values))
        };
        let (moved, turned, scaled) = (
            read("TRANSLATION", 3)?,
            read("ROTATION", 4)?,
            read("SCALE", 3)?,
        );
        let matrix = |i: usize| {
            let three = |values: &Option<Vec<f64>>, otherwise: f64| {
                let own = values
                    .as_deref()
                    .and_then(|values| values.as_chunks::<3>().0.get(i).copied());
                own.unwrap_or([otherwise; 3])
            };
            let rotation = turned
                .as_deref()
                .and_then(|values| values.as_chunks::<4>().0.get(i).copied());
            affine::of_parts(
                three(&moved, 0.0),
                rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
                three(&scaled, 1.0),
            )
        };
        Ok((0..count.unwrap_or(0)).map(matrix).collect())
    }
}

/// World matrices of nodes, and the roots above them.
struct Tree {
    world: Vec<Affine>,
    roots: Vec<usize>,
}

/// A node's own matrix.
fn local(node: &At<'_>) -> Result<Affine> {
    if let Some(matrix) = node.get("matrix") {
        return Ok(affine::of_columns(&matrix.numbers::<16>()?));
    }
    let translation = node
        .get("translation")
        .map_or(Ok([0.0; 3]), |at| at.numbers())?;
    let rotation = node
        .get("rotation")
        .map_or(Ok([0.0, 0.0, 0.0, 1.0]), |at| at.numbers())?;
    let scale = node.get("scale").map_or(Ok([1.0; 3]), |at| at.numbers())?;
    Ok(affine::of_parts(translation, rotation, scale))
}
