//! The format that bytes plainly have, whatever their name says.

use crate::format::Format;
use crate::formats::codec;
use crate::formats::stl::is_binary;

/// Beginnings of files that are often met under a wrong name.
const SIGNATURES: [(&[u8], &str); 11] = [
    (b"glTF", "a binary glTF file"),
    (b"\x1f\x8b", "gzip data"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"Kaydara FBX", "an FBX file"),
    (b"\xff\xfe", "UTF-16 text"),
    (b"\xfe\xff", "UTF-16 text"),
    (
        b"version https://git-lfs",
        "a Git LFS pointer, not the file itself",
    ),
    (b"<", "XML or HTML"),
    (b"{", "JSON, as glTF is"),
];

/// The format that `bytes` plainly have, in words, if they cannot be of format `named`; `None` if they may be.
pub(crate) fn looks_like_other(bytes: &[u8], named: Format) -> Option<&'static str> {
    let begins = |format: &&Format| (codec(**format).begins)(bytes);
    let has_signature = named.is_gltf() || named == Format::ThreeMf;
    if has_signature && begins(&&named) {
        return None;
    }
    // A binary STL may begin with any 80 bytes at all, so that its length is asked first.
    if is_binary(bytes) {
        return (named != Format::Stl).then_some("a binary STL file");
    }
    if let Some((_, words)) = SIGNATURES
        .iter()
        .find(|(start, _)| bytes.starts_with(start))
    {
        return Some(words);
    }
    let seen = Format::ALL.iter().find(begins)?;
    (*seen != named).then(|| seen.article())
}
