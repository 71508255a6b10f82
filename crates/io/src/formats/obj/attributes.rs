//! Values of the vertices, corners and faces of an OBJ file: texture coordinates, normals, colours, and the names that faces stand under.

use crate::channels;
use crate::reading::{Labels, by_element};
use crate::scan::integer;
use limitmesh::mesh::{Channel, Domain, Semantic};

/// No value.
const NONE: u32 = u32::MAX;

/// Statements that name what the faces after them belong to, with the channels that hold these names.
pub(super) const LABELS: [(&[u8], &str); 4] = [
    (b"o", channels::OBJECT),
    (b"g", channels::GROUP),
    (b"usemtl", channels::MATERIAL),
    (b"s", channels::SMOOTHING_GROUP),
];

/// The values that were read so far.
#[derive(Default)]
pub(super) struct Attributes {
    pub(super) textures: List,
    /// The most numbers that a texture coordinate had.
    pub(super) texture_arity: usize,
    pub(super) normals: List,
    /// By vertex, its colour; vertices beyond have none.
    colours: Vec<Option<[f64; 3]>>,
    /// In the order of [`LABELS`].
    pub(super) labels: [Labels; LABELS.len()],
}

/// Values that a file counts, and which of them corners name.
#[derive(Default)]
pub(super) struct List {
    pub(super) values: Vec<[f64; 3]>,
    /// By corner, its value; corners beyond have none.
    corners: Vec<u32>,
}

impl List {
    /// The value that a part of a corner such as `7/2/3` names, if it does.
    #[inline]
    pub(super) fn name(&mut self, corner: usize, part: Option<&[u8]>) {
        if let Some(part) = part.filter(|part| !part.is_empty()) {
            self.corners.resize(corner, NONE);
            // What names nothing is found with what names too much.
            let missing = NONE - 1;
            self.corners
                .push(number_of(part, self.values.len()).unwrap_or(missing));
        }
    }

    /// Whether there are values that no corner names.
    pub(super) fn is_unused(&self) -> bool {
        !self.values.is_empty() && self.corners.is_empty()
    }

    /// Whether a corner names a value that there is not: which others are meant is anybody's guess then.
    pub(super) fn is_wrong(&self) -> bool {
        let count = self.values.len() as u32;
        let mut all = self.corners.iter();
        all.any(|&index| index >= count && index != NONE)
    }

    /// Whether it becomes a channel.
    fn is_sound(&self) -> bool {
        !self.corners.is_empty() && !self.is_wrong()
    }

    /// How many of so many corners have no value where others do.
    pub(super) fn bare_corners(&self, corners: usize) -> usize {
        let named = self.corners.iter().filter(|&&index| index != NONE).count();
        if self.is_sound() { corners - named } else { 0 }
    }

    /// The channel of so many corners: those that name nothing have zeros.
    fn channel(
        self,
        name: &str,
        semantic: Semantic,
        arity: usize,
        corners: usize,
    ) -> Option<Channel> {
        if !self.is_sound() {
            return None;
        }
        let (is_bare, zero) = (self.bare_corners(corners) > 0, self.values.len() as u32);
        let mut indices = self.corners;
        indices.resize(corners, NONE);
        for index in indices.iter_mut().filter(|index| **index == NONE) {
            *index = zero;
        }
        let all = self.values.iter().flat_map(|value| &value[..arity]);
        let values = all.copied();
        let zeros = std::iter::repeat_n(0.0, if is_bare { arity } else { 0 });
        let channel = Channel::new(name, semantic, Domain::Corner, arity);
        Some(channel.with(values.chain(zeros).collect(), indices))
    }
}

/// The number from 0 of what a word names: it counts from 1, or from -1 back from the latest of `count`.
#[inline]
pub(super) fn number_of(word: &[u8], count: usize) -> Option<u32> {
    let index = match integer(word)? {
        0 => return None,
        index if index > 0 => index - 1,
        index => count as i64 + index,
    };
    u32::try_from(index).ok()
}

impl Attributes {
    /// A vertex's colour.
    pub(super) fn colour(&mut self, vertex: usize, colour: [f64; 3]) {
        self.colours.resize(vertex, None);
        self.colours.push(Some(colour));
    }

    /// All as channels of a soup.
    pub(super) fn channels(
        mut self,
        vertices: usize,
        faces: usize,
        corners: usize,
    ) -> Vec<Channel> {
        let normals = self
            .normals
            .channel(channels::NORMALS, Semantic::Other, 3, corners);
        let mut found: Vec<Channel> = normals.into_iter().collect();
        let (semantic, arity) = (Semantic::TextureCoordinates, self.texture_arity.max(2));
        found.extend(
            self.textures
                .channel(channels::TEXTURE, semantic, arity, corners),
        );
        if !self.colours.is_empty() {
            self.colours.resize(vertices, None);
            // Programs show vertices without a colour white.
            let values = self.colours.iter().flat_map(|own| own.unwrap_or([1.0; 3]));
            let values = values.collect();
            let (name, semantic) = (channels::COLOUR, Semantic::Colour);
            found.push(by_element(name, semantic, Domain::Vertex, 3, values));
        }
        let labels = self.labels.into_iter().zip(LABELS);
        found.extend(labels.filter_map(|(own, (_, name))| own.channel(name, faces)));
        found
    }
}
