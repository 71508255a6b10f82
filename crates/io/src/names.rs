//! Names that need not be UTF-8: text in memory, and the same bytes again when written.
//!
//! A byte that is not part of a character becomes a character of its own, from U+10FF80 on, which nobody uses for anything else; where
//! a file has one of these itself, its bytes become such characters, too.

/// Before the first character that encodes a byte: those are 0x80 and above.
const FIRST: u32 = 0x10_FF00;

/// The byte that a character encodes.
fn byte_of(c: char) -> Option<u8> {
    u32::from(c)
        .checked_sub(FIRST)
        .and_then(|byte| u8::try_from(byte).ok())
        .filter(|&byte| byte >= 0x80)
}

/// A name as text.
pub(crate) fn read(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    let own = |byte: u8| char::from_u32(FIRST + u32::from(byte));
    for chunk in bytes.utf8_chunks() {
        for c in chunk.valid().chars() {
            match byte_of(c) {
                None => text.push(c),
                Some(_) => text.extend(c.encode_utf8(&mut [0; 4]).bytes().filter_map(own)),
            }
        }
        text.extend(chunk.invalid().iter().copied().filter_map(own));
    }
    text
}

/// The bytes of a name.
pub(crate) fn write(name: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(name.len());
    for c in name.chars() {
        match byte_of(c) {
            Some(byte) => bytes.push(byte),
            None => bytes.extend(c.encode_utf8(&mut [0; 4]).bytes()),
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_the_same_bytes_again() {
        let names: [&[u8]; 6] = [
            b"plain",
            "größe 木".as_bytes(),
            b"gr\xf6\xdfe",
            b"\xff\x80\xc3",
            "\u{10FF80}x".as_bytes(),
            b"\xe2\x82",
        ];
        for name in names {
            assert_eq!(write(&read(name)), name, "{name:x?}");
        }
        assert_eq!(read("größe".as_bytes()), "größe");
    }
}
