//! Values after the position on a vertex's line: a normal of three numbers, a colour, a texture coordinate of two numbers.
//!
//! They stand in this order, whatever the order of the keyword's letters. Normals and texture coordinates are there only if the
//! keyword announces them; colours may be there without.

use super::colours::Colours;
use super::keyword::Keyword;
use crate::channels::{COLOUR, NORMALS, TEXTURE};
use crate::reading::{Kind, LeftOut, by_element};
use crate::scan::finite;
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

/// Values of the vertices of a file after their positions.
pub(super) struct VertexColumns {
    normals: Option<Column>,
    colours: Colours,
    textures: Option<Column>,
}

impl VertexColumns {
    /// Those that the keyword announces.
    pub(super) fn new(keyword: &Keyword<'_>) -> Self {
        let column = |arity| Column {
            arity,
            values: Vec::new(),
            is_wrong: false,
        };
        Self {
            normals: keyword.has_normals.then(|| column(NORMAL)),
            colours: Colours::default(),
            textures: keyword.has_textures.then(|| column(TEXTURE_COORDINATE)),
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
            let start = words.len().saturating_sub(TEXTURE_COORDINATE);
            let start = start.min(COLOUR_NUMBERS);
            let (colour, own) = words.split_at(start);
            textures.read(&own[..own.len().min(TEXTURE_COORDINATE)], vertex);
            words = colour;
        }
        self.colours.read(words, vertex);
    }

    /// All as channels of so many vertices. What cannot be read is noted as left out, and so are normals, which only say
    /// where edges were meant to be sharp.
    pub(super) fn channels(self, count: usize, left_out: &mut LeftOut) -> Vec<Channel> {
        if self
            .normals
            .as_ref()
            .is_some_and(|normals| !normals.values.is_empty())
        {
            left_out.note(Kind::Normals);
        }
        let channel = |column: Option<Column>, name, semantic| {
            column.map_or(Ok(None), |column| column.channel(name, semantic))
        };
        let kinds = [
            (
                channel(self.normals, NORMALS, Semantic::Other),
                Kind::Normals,
            ),
            (
                channel(self.textures, TEXTURE, Semantic::TextureCoordinates),
                Kind::TextureCoordinates,
            ),
            (
                self.colours.channel(COLOUR, Domain::Vertex, count),
                Kind::Colours,
            ),
        ];
        let mut channels = Vec::new();
        for (channel, kind) in kinds {
            match channel {
                Ok(channel) => channels.extend(channel),
                Err(()) => left_out.note(kind),
            }
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
        self.values
            .extend(words.iter().filter_map(|word| finite(word)));
        // One that begins after the first vertex lacks those before.
        self.is_wrong |= before != vertex * self.arity || self.values.len() != before + self.arity;
    }

    /// The channel of so many vertices, if there are any numbers.
    ///
    /// # Errors
    /// Some vertex lacks a number.
    fn channel(self, name: &str, semantic: Semantic) -> Result<Option<Channel>, ()> {
        if self.is_wrong {
            return Err(());
        }
        let is_there = !self.values.is_empty();
        let channel = || by_element(name, semantic, Domain::Vertex, self.arity, self.values);
        Ok(is_there.then(channel))
    }
}
