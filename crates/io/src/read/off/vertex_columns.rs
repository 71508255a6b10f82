//! What follows the position on a vertex's line: a normal of three numbers, a colour, a texture coordinate of two numbers.
//!
//! They stand in this order, whatever the order of the keyword's letters. Normals and texture coordinates are there only if the
//! keyword announces them; colours may be there without.

use super::colours::Colours;
use crate::channels::{COLOUR, NORMALS, TEXTURE};
use crate::format::OffKeyword;
use crate::read::left_out::{Kind, LeftOut};
use crate::scan::number;
use limitmesh::mesh::{Channel, Domain, Semantic};

const NORMAL: usize = 3;
const TEXTURE_COORDINATE: usize = 2;
/// Most numbers of a colour.
const COLOUR_NUMBERS: usize = 4;
/// Most words that a vertex has after its position.
pub(super) const MOST: usize = NORMAL + COLOUR_NUMBERS + TEXTURE_COORDINATE;

/// Numbers that each vertex has equally many of.
struct Column {
    arity: usize,
    values: Vec<f64>,
    /// Whether a number is missing, or none, for some vertex.
    is_wrong: bool,
}

/// What the vertices of a file have beside their positions.
pub(super) struct VertexColumns {
    normals: Option<Column>,
    colours: Colours,
    textures: Option<Column>,
}

impl VertexColumns {
    /// Those that the keyword announces.
    pub(super) fn new(keyword: &OffKeyword<'_>) -> Self {
        let column = |is_there: bool, arity| {
            is_there.then(|| Column {
                arity,
                values: Vec::new(),
                is_wrong: false,
            })
        };
        Self {
            normals: column(keyword.has_normals, NORMAL),
            colours: Colours::default(),
            textures: column(keyword.has_textures, TEXTURE_COORDINATE),
        }
    }

    /// Takes the words after a vertex's position.
    pub(super) fn read(&mut self, mut words: &[&[u8]], vertex: usize) {
        if let Some(normals) = &mut self.normals {
            let (own, rest) = words.split_at(words.len().min(NORMAL));
            normals.read(own, vertex);
            words = rest;
        }
        if let Some(textures) = &mut self.textures {
            let start = words
                .len()
                .saturating_sub(TEXTURE_COORDINATE)
                .min(COLOUR_NUMBERS);
            let end = words.len().min(start + TEXTURE_COORDINATE);
            textures.read(&words[start..end], vertex);
            words = &words[..start];
        }
        self.colours.read(words, vertex);
    }

    /// All as channels of so many vertices. What cannot be read is noted as left out, and so are normals, which only say
    /// where edges were meant to be sharp.
    pub(super) fn channels(self, count: usize, left_out: &mut LeftOut) -> Vec<Channel> {
        let mut channels = Vec::new();
        if self
            .normals
            .as_ref()
            .is_some_and(|normals| !normals.values.is_empty())
        {
            left_out.note(Kind::Normals);
        }
        let kinds = [
            (self.normals, NORMALS, Semantic::Other, Kind::Normals),
            (
                self.textures,
                TEXTURE,
                Semantic::TextureCoordinates,
                Kind::TextureCoordinates,
            ),
        ];
        for (column, name, semantic, kind) in kinds {
            match column.map_or(Ok(None), |column| column.channel(name, semantic, count)) {
                Ok(channel) => channels.extend(channel),
                Err(()) => left_out.note(kind),
            }
        }
        match self.colours.channel(COLOUR, Domain::Vertex, count) {
            Ok(channel) => channels.extend(channel),
            Err(()) => left_out.note(Kind::Colours),
        }
        channels
    }
}

impl Column {
    fn read(&mut self, words: &[&[u8]], vertex: usize) {
        if words.is_empty() && self.values.is_empty() {
            return;
        }
        let before = self.values.len();
        self.values.extend(
            words
                .iter()
                .filter_map(|word| number(word))
                .filter(|value| value.is_finite()),
        );
        // One that begins after the first vertex lacks those before.
        self.is_wrong |= before != vertex * self.arity || self.values.len() != before + self.arity;
    }

    /// The channel of so many vertices, if there are any numbers.
    ///
    /// # Errors
    /// Some vertex lacks a number.
    fn channel(self, name: &str, semantic: Semantic, count: usize) -> Result<Option<Channel>, ()> {
        match () {
            () if self.is_wrong => Err(()),
            () if self.values.is_empty() => Ok(None),
            () => Ok(Some(
                Channel::new(name, semantic, Domain::Vertex, self.arity)
                    .with(self.values, (0..count as u32).collect()),
            )),
        }
    }
}
