//! Where buffers and images are: in data URIs, or in files below the document's folder and nowhere else.

use std::path::PathBuf;

/// The meaning of a URI.
#[derive(Debug, PartialEq)]
pub(crate) enum Uri<'a> {
    /// The payload of a data URI in base 64.
    Base64(&'a str),
    /// A file, by its path from the document's folder: no `..`, no root.
    File(PathBuf),
}

/// Understands a URI.
///
/// # Errors
/// The expected form.
pub(crate) fn parse(uri: &str) -> Result<Uri<'_>, &'static str> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, payload) = data.split_once(',').ok_or("a comma before the data")?;
        return match kind.ends_with(";base64") {
            true => Ok(Uri::Base64(payload)),
            false => Err("data in base 64"),
        };
    }
    let below = "a path below the document's folder";
    let path = percent_decoded(uri).ok_or("a URI of UTF-8 with whole percent escapes")?;
    // A colon is how schemes and drives begin, backslashes separate folders on some systems.
    if path.is_empty() || path.starts_with('/') || path.contains(['\\', ':', '\0']) {
        return Err(below);
    }
    let mut file = PathBuf::new();
    for part in path.split('/') {
        match part {
            ".." => return Err(below),
            "" | "." => {}
            part => file.push(part),
        }
    }
    if file.as_os_str().is_empty() {
        Err(below)
    } else {
        Ok(Uri::File(file))
    }
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        if first != b'%' {
            bytes.push(first);
            continue;
        }
        let (digits, after) = rest.split_at_checked(2)?;
        let digit = |byte: u8| char::from(byte).to_digit(16);
        bytes.push((16 * digit(digits[0])? + digit(digits[1])?) as u8);
        rest = after;
    }
    String::from_utf8(bytes).ok()
}

/// The first `most` bytes of what base 64 encodes; `None` where a letter is none of its.
pub(crate) fn from_base64(text: &str, most: usize) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(most.min(text.len() / 4 * 3 + 3));
    for four in text.chunks(4) {
        let mut word = 0u32;
        for &letter in four {
            let digit = match letter {
                b'A'..=b'Z' => letter - b'A',
                b'a'..=b'z' => letter - b'a' + 26,
                b'0'..=b'9' => letter - b'0' + 52,
                b'+' | b'-' => 62,
                b'/' | b'_' => 63,
                _ => return None,
            };
            word = word << 6 | u32::from(digit);
        }
        let [_, bytes_of @ ..] = (word << (6 * (4 - four.len()))).to_be_bytes();
        let count = four.len() * 6 / 8;
        bytes.extend(&bytes_of[..count]);
        if bytes.len() >= most {
            break;
        }
    }
    bytes.truncate(most);
    Some(bytes)
}

/// Base 64 of bytes.
pub(crate) fn to_base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let mut padded = [0; 4];
        padded[1..=three.len()].copy_from_slice(three);
        let word = u32::from_be_bytes(padded);
        for letter in 0..4 {
            let digit = (word >> (18 - 6 * letter)) as usize & 63;
            let is_there = letter <= three.len();
            text.push(if is_there {
                char::from(LETTERS[digit])
            } else {
                '='
            });
        }
    }
    text
}

/// A file name as it stands in a URI.
pub(crate) fn escaped(name: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.~/".contains(&byte);
    let letter = |b| {
        if plain(b) {
            char::from(b).to_string()
        } else {
            format!("%{b:02X}")
        }
    };
    name.bytes().map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_below_the_folder() {
        let file = |uri: &str| match parse(uri) {
            Ok(Uri::File(path)) => Some(path.to_string_lossy().into_owned()),
            _ => None,
        };
        assert_eq!(file("a%20b/./c.bin"), Some("a b/c.bin".to_owned()));
        let outside = [
            "",
            ".",
            "../a",
            "a/../b",
            "%2e%2e/a",
            "/etc/passwd",
            "%2Fetc",
            "C:/a",
            "c%3a/a",
        ];
        let odd = [
            "http://a/b",
            "file:///a",
            "a\\b",
            "a%5Cb",
            "a%00",
            "a%2",
            "a%zz",
            "%ff",
        ];
        for uri in outside.iter().chain(&odd) {
            assert_eq!(file(uri), None, "{uri}");
        }
    }

    #[test]
    fn base_64_of_rfc_4648() {
        let cases = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, coded) in cases {
            assert_eq!(to_base64(plain.as_bytes()), coded);
            assert_eq!(from_base64(coded, 99).as_deref(), Some(plain.as_bytes()));
        }
        assert_eq!(from_base64("Zm9vYmFy", 4).as_deref(), Some(&b"foob"[..]));
        assert_eq!(from_base64("Zm 9", 9), None);
    }
}
