//! What an OBJ file's vertices, corners and faces carry: texture coordinates, colours, and the names that faces stand under.

use std::collections::HashMap;

use limitmesh::mesh::{Channel, Domain, Semantic};

use crate::channels;

/// No value.
const NONE: u32 = u32::MAX;

/// Kinds of names under which faces stand.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum LabelKind {
    Object,
    Group,
    Material,
    SmoothingGroup,
}

/// The names of the channels, in the order of [`LabelKind`].
const LABELS: [&str; 4] = [
    channels::OBJECT,
    channels::GROUP,
    channels::MATERIAL,
    channels::SMOOTHING_GROUP,
];

/// What has been met so far.
#[derive(Default)]
pub(super) struct Attributes {
    textures: Vec<[f64; 3]>,
    /// The most numbers that one had.
    texture_arity: usize,
    /// By corner, its texture coordinate; corners beyond have none.
    texture_corners: Vec<u32>,
    normals: Vec<[f64; 3]>,
    /// By corner, its normal; corners beyond have none.
    normal_corners: Vec<u32>,
    /// By vertex, its colour; vertices beyond have none.
    colours: Vec<Option<[f64; 3]>>,
    labels: [Labels; LABELS.len()],
}

/// The names of a kind.
#[derive(Default)]
struct Labels {
    numbers: HashMap<String, u32>,
    names: Vec<String>,
    /// From which face on a name holds.
    changes: Vec<(usize, u32)>,
}

impl Attributes {
    pub(super) fn texture_count(&self) -> usize {
        self.textures.len()
    }

    /// A texture coordinate of so many numbers.
    pub(super) fn texture(&mut self, place: [f64; 3], arity: usize) {
        self.textures.push(place);
        self.texture_arity = self.texture_arity.max(arity);
    }

    /// A corner's texture coordinate.
    pub(super) fn texture_of_corner(&mut self, corner: usize, texture: u32) {
        self.texture_corners.resize(corner, NONE);
        self.texture_corners.push(texture);
    }

    pub(super) fn normal_count(&self) -> usize {
        self.normals.len()
    }

    pub(super) fn normal(&mut self, normal: [f64; 3]) {
        self.normals.push(normal);
    }

    /// A corner's normal.
    pub(super) fn normal_of_corner(&mut self, corner: usize, normal: u32) {
        self.normal_corners.resize(corner, NONE);
        self.normal_corners.push(normal);
    }

    /// The channel of normals, if there are any, and all that are named.
    fn normals(&mut self, corners: usize) -> Option<Channel> {
        let (normals, mut indices) = (
            std::mem::take(&mut self.normals),
            std::mem::take(&mut self.normal_corners),
        );
        let missing = normals.len() as u32;
        if indices.is_empty()
            || indices
                .iter()
                .any(|&index| index >= missing && index != NONE)
        {
            return None;
        }
        indices.resize(corners, NONE);
        // Corners without one have none that could differ.
        indices
            .iter_mut()
            .filter(|index| **index == NONE)
            .for_each(|index| *index = missing);
        let values = normals.into_iter().chain([[0.0; 3]]).flatten().collect();
        let channel = Channel::new(channels::NORMALS, Semantic::Other, Domain::Corner, 3);
        Some(channel.with(values, indices))
    }

    /// A vertex's colour.
    pub(super) fn colour(&mut self, vertex: usize, colour: [f64; 3]) {
        self.colours.resize(vertex, None);
        self.colours.push(Some(colour));
    }

    /// A name that holds from a face on.
    pub(super) fn label(&mut self, kind: LabelKind, name: String, face: usize) {
        let Labels {
            numbers,
            names,
            changes,
        } = &mut self.labels[kind as usize];
        let number = *numbers.entry(name).or_insert_with_key(|name| {
            names.push(name.clone());
            names.len() as u32 - 1
        });
        changes.push((face, number));
    }

    /// Whether there are texture coordinates that no corner names.
    pub(super) fn has_unused_textures(&self) -> bool {
        !self.textures.is_empty() && self.texture_corners.is_empty()
    }

    /// Whether a corner names a texture coordinate that there is not: which others are meant is anybody's guess then.
    pub(super) fn has_wrong_textures(&self) -> bool {
        let count = self.textures.len() as u32;
        self.texture_corners
            .iter()
            .any(|&index| index >= count && index != NONE)
    }

    /// How many of so many corners have no texture coordinates where others do.
    pub(super) fn corners_without_textures(&self, corners: usize) -> usize {
        if self.texture_corners.is_empty() || self.has_wrong_textures() {
            return 0;
        }
        corners
            - self
                .texture_corners
                .iter()
                .filter(|&&index| index != NONE)
                .count()
    }

    /// Whether one of so many faces has a material.
    pub(super) fn has_materials(&self, faces: usize) -> bool {
        self.labels[LabelKind::Material as usize].are_used(faces)
    }

    /// All as channels of a soup.
    pub(super) fn channels(
        mut self,
        vertices: usize,
        faces: usize,
        corners: usize,
    ) -> Vec<Channel> {
        let is_wrong = self.has_wrong_textures();
        let mut found: Vec<Channel> = self.normals(corners).into_iter().collect();
        let Self {
            textures,
            texture_arity,
            mut texture_corners,
            mut colours,
            labels,
            ..
        } = self;
        if !texture_corners.is_empty() && !is_wrong {
            texture_corners.resize(corners, NONE);
            let arity = texture_arity.max(2);
            let mut values: Vec<f64> = textures
                .iter()
                .flat_map(|place| &place[..arity])
                .copied()
                .collect();
            if texture_corners.contains(&NONE) {
                // Corners without one have the texture's origin.
                let missing = textures.len() as u32;
                values.extend(std::iter::repeat_n(0.0, arity));
                texture_corners
                    .iter_mut()
                    .filter(|index| **index == NONE)
                    .for_each(|index| *index = missing);
            }
            let channel = Channel::new(
                channels::TEXTURE,
                Semantic::TextureCoordinates,
                Domain::Corner,
                arity,
            );
            found.push(channel.with(values, texture_corners));
        }
        if !colours.is_empty() {
            colours.resize(vertices, None);
            // Programs show vertices without a colour white.
            let values = colours
                .iter()
                .flat_map(|colour| colour.unwrap_or([1.0; 3]))
                .collect();
            let channel = Channel::new(channels::COLOUR, Semantic::Colour, Domain::Vertex, 3);
            found.push(channel.with(values, (0..vertices as u32).collect()));
        }
        for (labels, name) in labels.into_iter().zip(LABELS) {
            found.extend(labels.channel(name, faces));
        }
        found
    }
}

impl Labels {
    /// Whether one of so many faces stands under a name.
    fn are_used(&self, faces: usize) -> bool {
        let is_used = |&(face, number): &(usize, u32)| {
            face < faces && !self.names[number as usize].is_empty()
        };
        self.changes.iter().any(is_used)
    }

    /// The names of all faces, if any stands under one: before the first, that of none.
    fn channel(self, name: &str, faces: usize) -> Option<Channel> {
        if !self.are_used(faces) {
            return None;
        }
        let Self {
            mut names, changes, ..
        } = self;
        let mut indices = Vec::with_capacity(faces);
        let first = changes.first().map_or(0, |&(face, _)| face);
        if first > 0 {
            indices.resize(first.min(faces), names.len() as u32);
            names.push(String::new());
        }
        for (at, &(_, number)) in changes.iter().enumerate() {
            let end = changes.get(at + 1).map_or(faces, |&(face, _)| face);
            indices.resize(end.max(indices.len()), number);
        }
        let values = (0..names.len()).map(|number| number as f64).collect();
        let mut channel =
            Channel::new(name, Semantic::Label, Domain::Face, 1).with(values, indices);
        channel.labels = names;
        Some(channel)
    }
}
