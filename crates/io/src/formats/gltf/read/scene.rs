//! Where the meshes of a document stand: world matrices of the nodes that use them, their instances, and their skins.
//!
//! The length of a tolerance in the scene is divided by the greatest stretch of a mesh's matrices to hold for the mesh:
//! a point that is d from another there is at most that stretch times d from it in the scene. The vertices of a skin go
//! where a mixture of its joints' matrices puts them, and a mixture stretches no more than the worst of them.

use super::parts::MeshSoup;
use crate::affine::{self, Affine, IDENTITY};
use crate::flaw::{Flaw, Result};
use crate::formats::gltf::document::extensions::INSTANCING;
use crate::formats::gltf::document::json::At;
use crate::formats::gltf::document::source::Source;

/// How a node puts a mesh into the scene.
#[derive(Clone, Debug)]
pub(crate) enum Placement {
    /// By one matrix.
    Rigid(Affine),
    /// By a mixture of the matrices of a skin's joints.
    Skinned(Vec<Affine>),
}

/// Where all meshes stand.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    /// By mesh, how each node that uses it does.
    pub(crate) placements: Vec<Vec<Placed>>,
}

/// How a node puts a mesh into a scene.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    placement: Placement,
    /// Whether the node is in the scene that is shown.
    is_shown: bool,
}

impl Placement {
    /// How many times longer vectors become at most.
    fn stretch(&self) -> f64 {
        match self {
            Self::Rigid(m) => affine::greatest_stretch(m),
            Self::Skinned(all) => all.iter().map(affine::greatest_stretch).fold(0.0, f64::max),
        }
    }

    /// Where vertex `v` of a mesh goes.
    pub(crate) fn apply(&self, mesh: &MeshSoup, v: usize) -> [f64; 3] {
        let point = mesh.soup.positions[v];
        match self {
            Self::Rigid(m) => affine::apply(m, point),
            Self::Skinned(joints) => {
                let influences = || mesh.influences.get(v).into_iter().flatten();
                let total: f64 = influences().map(|&(_, weight)| weight).sum();
                let mut moved = [0.0; 3];
                for &(joint, weight) in influences() {
                    if let Some(m) = joints.get(joint as usize) {
                        let share = affine::apply(m, point);
                        (0..3).for_each(|i| moved[i] += weight / total * share[i]);
                    }
                }
                if total > 0.0 { moved } else { point }
            }
        }
    }

    /// Which way a normal at vertex `v` of a mesh looks then, of any length.
    pub(crate) fn apply_to_normal(&self, mesh: &MeshSoup, v: usize, normal: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Rigid(m) => affine::apply_to_normal(m, normal),
            Self::Skinned(joints) => {
                let mut mixture: Affine = [[0.0; 4]; 3];
                for &(joint, weight) in mesh.influences.get(v).into_iter().flatten() {
                    if let Some(m) = joints.get(joint as usize) {
                        let sum = mixture.as_flattened_mut().iter_mut().zip(m.as_flattened());
                        sum.for_each(|(sum, own)| *sum += weight * own);
                    }
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
    pub(crate) fn mirrors(&self) -> bool {
        match self {
            Self::Rigid(m) => affine::mirrors(m),
            Self::Skinned(joints) => joints.first().is_some_and(affine::mirrors),
        }
    }
}

impl Scene {
    fn of(&self, mesh: usize) -> impl Iterator<Item = &Placed> {
        self.placements.get(mesh).into_iter().flatten()
    }

    /// The divisor of tolerances for a mesh; 1 if nothing shows it.
    pub(crate) fn stretch(&self, mesh: usize) -> f64 {
        let stretches = self.of(mesh).map(|own| own.placement.stretch());
        affine::usable(stretches.fold(0.0, f64::max))
    }

    /// The linear map of the placement by which a mesh is largest, by rows. A skin does what all its joints do, or else it makes all
    /// vectors as long as the worst of them.
    pub(crate) fn largest(&self, mesh: usize) -> [[f64; 3]; 3] {
        let all = self.of(mesh).map(|own| &own.placement);
        let largest = all.reduce(|most, own| {
            if own.stretch() > most.stretch() {
                own
            } else {
                most
            }
        });
        let evenly =
            |stretch: f64| [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { stretch } else { 0.0 }));
        match largest {
            None => evenly(1.0),
            Some(Placement::Rigid(m)) => affine::linear(m),
            Some(skin @ Placement::Skinned(joints)) => {
                let matrices: Vec<_> = joints.iter().map(affine::linear).collect();
                let is_one = matrices.windows(2).all(|pair| pair[0] == pair[1]);
                let first = matrices.first().copied().filter(|_| is_one);
                first.unwrap_or_else(|| evenly(skin.stretch()))
            }
        }
    }

    /// How the scene that is shown has a mesh; once as it is if the document has no nodes.
    pub(crate) fn shown(&self, mesh: usize) -> impl Iterator<Item = &Placement> {
        let all = self.of(mesh).filter(|own| own.is_shown);
        all.map(|own| &own.placement)
    }
}

impl Source {
    /// Where all meshes stand.
    pub(crate) fn scene(&self) -> Result<Scene> {
        let root = self.root();
        let mut placements = vec![Vec::new(); root.list("meshes")?.len()];
        let nodes = root.list("nodes")?;
        if nodes.is_empty() {
            let placed = Placed {
                placement: Placement::Rigid(IDENTITY),
                is_shown: true,
            };
            for all in placements.iter_mut() {
                all.push(placed.clone());
            }
            return Ok(Scene { placements });
        }
        let tree = self.tree(&nodes)?;
        let shown = self.shown_roots(&tree)?;
        for (i, node) in nodes.iter().enumerate() {
            let Some(mesh) = node.get("mesh") else {
                continue;
            };
            let mesh = mesh.number_in(&root, "meshes")?;
            let is_shown = shown[tree.roots[i]];
            let mut place = |placement| {
                placements[mesh].push(Placed {
                    placement,
                    is_shown,
                })
            };
            if let Some(skin) = node.get("skin") {
                place(Placement::Skinned(self.joints(&skin, &tree)?));
                continue;
            }
            let instances = match node.path(&["extensions", INSTANCING]) {
                Some(extension) => self.instances(&extension)?,
                None => vec![IDENTITY],
            };
            let world = |own| Placement::Rigid(affine::product(&tree.world[i], own));
            instances.iter().map(world).for_each(&mut place);
        }
        Ok(Scene { placements })
    }

    /// World matrices of all nodes.
    fn tree(&self, nodes: &[At<'_>]) -> Result<Tree> {
        let root = self.root();
        let mut children = Vec::with_capacity(nodes.len());
        let mut has_parent = vec![false; nodes.len()];
        for node in nodes {
            let mut own = Vec::new();
            for child in node.list("children")? {
                let index = child.number_in(&root, "nodes")?;
                if std::mem::replace(&mut has_parent[index], true) {
                    return Err(child.unexpected("a node that is no child of another"));
                }
                own.push(index);
            }
            children.push(own);
        }
        let (world, roots) = (vec![IDENTITY; nodes.len()], vec![usize::MAX; nodes.len()]);
        let mut tree = Tree { world, roots };
        let mut waiting = Vec::new();
        for start in (0..nodes.len()).filter(|&node| !has_parent[node]) {
            tree.world[start] = local(&nodes[start])?;
            waiting.push(start);
            while let Some(node) = waiting.pop() {
                tree.roots[node] = start;
                for &child in &children[node] {
                    tree.world[child] = affine::product(&tree.world[node], &local(&nodes[child])?);
                    waiting.push(child);
                }
            }
        }
        // Each node has one parent at most, so that what no root leads to runs in circles.
        match tree.roots.iter().position(|&root| root == usize::MAX) {
            None => Ok(tree),
            Some(node) => Err(Flaw::saying(
                nodes[node].place(),
                "the node is below itself",
            )),
        }
    }

    /// By node, whether the scene that is shown has it as a root.
    fn shown_roots(&self, tree: &Tree) -> Result<Vec<bool>> {
        let root = self.root();
        let scene = match root.get("scene") {
            Some(scene) => Some(scene.item_of(&root, "scenes")?),
            None => root.list("scenes")?.into_iter().next(),
        };
        let Some(scene) = scene else {
            return Ok(vec![true; tree.roots.len()]);
        };
        let mut shown = vec![false; tree.roots.len()];
        for node in scene.list("nodes")? {
            shown[tree.roots[node.number_in(&root, "nodes")?]] = true;
        }
        Ok(shown)
    }

    /// The matrices of a skin's joints, from the mesh to the scene.
    fn joints(&self, skin: &At<'_>, tree: &Tree) -> Result<Vec<Affine>> {
        let root = self.root();
        let skin = skin.item_of(&root, "skins")?;
        let inverse = skin.get("inverseBindMatrices");
        let inverse = inverse.map(|own| self.numbers(&own, None));
        let inverse = inverse.transpose()?;
        let mut matrices = Vec::new();
        for (i, joint) in skin.list("joints")?.iter().enumerate() {
            let world = tree.world[joint.number_in(&root, "nodes")?];
            let Some(inverse) = &inverse else {
                matrices.push(world);
                continue;
            };
            let columns = inverse.values.as_chunks::<16>().0.get(i);
            let Some(columns) = columns.filter(|_| inverse.components == 16) else {
                let problem = format!("joint {i} has no inverse bind matrix");
                return Err(Flaw::saying(skin.place(), problem));
            };
            matrices.push(affine::product(&world, &affine::of_columns(columns)));
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
                return Err(Flaw::saying(accessor.place(), problem));
            }
            count = Some(numbers.len());
            Ok(Some(numbers.values))
        };
        let (moved, turned) = (read("TRANSLATION", 3)?, read("ROTATION", 4)?);
        let scaled = read("SCALE", 3)?;
        // What is missing for one instance is missing for all.
        let matrix = |i: usize| {
            affine::of_parts(
                element(&moved, i).unwrap_or([0.0; 3]),
                element(&turned, i).unwrap_or(NO_ROTATION),
                element(&scaled, i).unwrap_or([1.0; 3]),
            )
        };
        Ok((0..count.unwrap_or(0)).map(matrix).collect())
    }
}

const NO_ROTATION: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// An element of so many numbers, if there are any.
fn element<const N: usize>(values: &Option<Vec<f64>>, i: usize) -> Option<[f64; N]> {
    values.as_ref()?.as_chunks::<N>().0.get(i).copied()
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
    Ok(affine::of_parts(
        node.numbers_or("translation", [0.0; 3])?,
        node.numbers_or("rotation", NO_ROTATION)?,
        node.numbers_or("scale", [1.0; 3])?,
    ))
}
