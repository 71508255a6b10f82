//! Parts of the readers of all formats: counts that indices can name, names of groups of faces, and words for statements that a soup has no place for.

use crate::flaw::{Flaw, Place, Result};
use limitmesh::mesh::{Channel, Domain, PolygonFaces, Semantic};
use std::collections::{BTreeSet, HashMap};

/// Most elements of a kind that `u32` indices can name.
pub(crate) const MOST: usize = u32::MAX as usize;

/// Refuses counts that `u32` indices cannot name.
pub(crate) fn check_count(count: u64, what: &str, place: Place) -> Result<usize> {
    let found = usize::try_from(count).ok().filter(|&count| count <= MOST);
    found.ok_or_else(|| Flaw::new(place, count, format!("at most {MOST} {what}")))
}

/// Adds a face, unless all faces together would have more corners than can be counted.
#[inline]
pub(crate) fn push_face(
    faces: &mut PolygonFaces,
    corners: &[u32],
    place: impl Fn() -> Place,
) -> Result<()> {
    if corners.len() > MOST - faces.corner_count() {
        let found = format!("more than {MOST}");
        return Err(Flaw::new(
            place(),
            found,
            format!("at most {MOST} face corners"),
        ));
    }
    faces.push(corners);
    Ok(())
}

/// A channel with a value for each element.
pub(crate) fn by_element(
    name: impl Into<String>,
    semantic: Semantic,
    domain: Domain,
    arity: usize,
    values: Vec<f64>,
) -> Channel {
    let count = (values.len() / arity) as u32;
    Channel::new(name, semantic, domain, arity).with(values, (0..count).collect())
}

/// A channel of names, which the faces have by these numbers.
pub(crate) fn named_faces(name: &str, labels: Vec<String>, indices: Vec<u32>) -> Channel {
    let values = (0..labels.len()).map(|number| number as f64).collect();
    let mut channel = Channel::new(name, Semantic::Label, Domain::Face, 1).with(values, indices);
    channel.labels = labels;
    channel
}

/// Names under which faces stand.
#[derive(Default)]
pub(crate) struct Labels {
    pub(crate) names: Vec<String>,
    numbers: HashMap<String, u32>,
    /// From which face on which name holds.
    starts: Vec<(usize, u32)>,
}

impl Labels {
    /// A name that holds from a face on.
    pub(crate) fn begin(&mut self, name: String, face: usize) {
        let number = *self.numbers.entry(name).or_insert_with_key(|name| {
            self.names.push(name.clone());
            self.names.len() as u32 - 1
        });
        self.starts.push((face, number));
    }

    /// Whether one of so many faces stands under a name.
    pub(crate) fn are_used(&self, faces: usize) -> bool {
        let mut starts = self.starts.iter();
        starts.any(|&(face, number)| face < faces && !self.names[number as usize].is_empty())
    }

    /// The names of so many faces, if any stands under one: faces before the first have the empty name.
    pub(crate) fn channel(mut self, name: &str, faces: usize) -> Option<Channel> {
        if !self.are_used(faces) {
            return None;
        }
        let mut indices = Vec::with_capacity(faces);
        let (mut number, none) = (self.names.len() as u32, self.names.len());
        for (start, next) in self.starts {
            indices.resize(start.min(faces).max(indices.len()), number);
            number = next;
        }
        indices.resize(faces, number);
        if indices[0] as usize == none {
            self.names.push(String::new());
        }
        Some(named_faces(name, self.names, indices))
    }
}

/// Kinds of content that are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    TextureCoordinates,
    Normals,
    Colours,
    Weights,
    Materials,
    Lines,
    Points,
    Parameters,
    FaceColours,
}

impl Kind {
    fn words(self) -> &'static str {
        match self {
            Self::TextureCoordinates => "texture coordinates",
            Self::Normals => "normals",
            Self::Colours => "colours",
            Self::Weights => "weights of vertices",
            Self::Materials => "materials",
            Self::Lines => "lines",
            Self::Points => "points",
            Self::Parameters => "points in parameter space",
            Self::FaceColours => "colours of faces",
        }
    }
}

/// Other things that are named at most: a file of another kind could have any number.
const MOST_OTHERS: usize = 8;

/// Statements of a file that a soup has no place for, in words for people.
#[derive(Default)]
pub(crate) struct LeftOut {
    kinds: BTreeSet<Kind>,
    others: Vec<String>,
}

impl LeftOut {
    /// Notes a kind.
    pub(crate) fn note(&mut self, kind: Kind) {
        self.kinds.insert(kind);
    }

    /// Notes something else by its own words.
    pub(crate) fn other(&mut self, words: String) {
        if self.others.len() < MOST_OTHERS && !self.others.contains(&words) {
            self.others.push(words);
        }
    }

    /// All that was met, each kind once.
    pub(crate) fn in_words(self) -> Vec<String> {
        let kinds = self.kinds.iter().map(|kind| kind.words().to_owned());
        kinds.chain(self.others).collect()
    }
}

/// `1 byte after the last facet`, or `None` where there is none.
pub(crate) fn trailing_bytes(count: usize, last: &str) -> Option<String> {
    let noun = if count == 1 { "byte" } else { "bytes" };
    (count > 0).then(|| format!("{count} {noun} after the last {last}"))
}
