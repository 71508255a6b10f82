//! The keyword of an OFF file.

/// The meaning of the keyword.
#[derive(Default)]
pub(super) struct Keyword<'a> {
    /// Whether normals, colours and texture coordinates follow a vertex's position, in this order.
    pub(super) has_normals: bool,
    pub(super) has_colours: bool,
    pub(super) has_textures: bool,
    /// Whether a vertex has another number of coordinates than three.
    pub(super) has_other_dimension: bool,
    /// Digits that follow the keyword without a blank: the number of vertices, as in many files of ModelNet.
    pub(super) glued: &'a [u8],
}

/// Reads a word as the keyword of an OFF file, such as `STCNOFF`, `coff` or `OFF216`; `None` for any other word.
pub(super) fn keyword(word: &[u8]) -> Option<Keyword<'_>> {
    let mut at = word.windows(3);
    let at = at.position(|three| three.eq_ignore_ascii_case(b"OFF"))?;
    let (mut letters, off, glued) = (&word[..at], &word[at..at + 3], &word[at + 3..]);
    if !glued.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let mut keyword = Keyword {
        glued,
        ..Keyword::default()
    };
    // Geomview: "[ST][C][N][4][n]OFF". In small letters, n is taken for normals, which are far more common.
    for dimension in [b'n', b'4'] {
        if (dimension == b'4' || off == b"OFF") && letters.last() == Some(&dimension) {
            keyword.has_other_dimension = true;
            letters = &letters[..letters.len() - 1];
        }
    }
    // All orders of the other letters are met in files.
    while !letters.is_empty() {
        let (is_met, length) = match letters.to_ascii_uppercase().as_slice() {
            [b'S', b'T', ..] => (&mut keyword.has_textures, 2),
            [b'C', ..] => (&mut keyword.has_colours, 1),
            [b'N', ..] => (&mut keyword.has_normals, 1),
            _ => return None,
        };
        if std::mem::replace(is_met, true) {
            return None;
        }
        letters = &letters[length..];
    }
    Some(keyword)
}
