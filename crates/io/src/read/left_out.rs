//! What a file held and a soup has no place for, in words for people: each kind once, in the order of [`KINDS`].

/// Kinds of content that are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
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

/// All kinds with their words.
const KINDS: [(Kind, &str); 9] = [
    (Kind::TextureCoordinates, "texture coordinates"),
    (Kind::Normals, "normals"),
    (Kind::Colours, "colours"),
    (Kind::Weights, "weights of vertices"),
    (Kind::Materials, "materials"),
    (Kind::Lines, "lines"),
    (Kind::Points, "points"),
    (Kind::Parameters, "points in parameter space"),
    (Kind::FaceColours, "colours of faces"),
];

/// Other things that are named at most: a file of another kind could have any number.
const MOST_OTHERS: usize = 8;

/// What has been met so far.
#[derive(Default)]
pub(super) struct LeftOut {
    is_met: [bool; KINDS.len()],
    others: Vec<String>,
}

impl LeftOut {
    /// Notes a kind.
    #[inline]
    pub(super) fn note(&mut self, kind: Kind) {
        self.is_met[kind as usize] = true;
    }

    /// Notes something else by its own words.
    pub(super) fn other(&mut self, words: String) {
        if self.others.len() < MOST_OTHERS && !self.others.contains(&words) {
            self.others.push(words);
        }
    }

    /// All that was met.
    pub(super) fn in_words(self) -> Vec<String> {
        let met = KINDS
            .iter()
            .filter(|&&(kind, _)| self.is_met[kind as usize]);
        met.map(|&(_, words)| words.to_owned())
            .chain(self.others)
            .collect()
    }
}

/// `1 byte after the last facet`, or `None` where there is none.
pub(super) fn trailing_bytes(count: usize, last: &str) -> Option<String> {
    let noun = if count == 1 { "byte" } else { "bytes" };
    (count > 0).then(|| format!("{count} {noun} after the last {last}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_found_by_their_place() {
        for (place, (kind, _)) in KINDS.into_iter().enumerate() {
            assert_eq!(kind as usize, place);
        }
    }
}
