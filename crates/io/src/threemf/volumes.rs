//! Parts of one mesh by ranges of its triangles, as PrusaSlicer keeps them beside the model.
//!
//! It joins the volumes of an object into one mesh, and names each by its first and last triangle; so these numbers change with the
//! triangles.

use super::xml::{Element, attribute};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::ops::Range;

/// The part that has them.
pub(super) const PART: &str = "Metadata/Slic3r_PE_model.config";

/// A volume.
pub(super) struct Volume {
    pub(super) object: u32,
    /// Its first triangle, and its last.
    pub(super) first: u32,
    pub(super) last: u32,
    /// Where the text has these numbers.
    first_at: Range<usize>,
    last_at: Range<usize>,
}

/// The volumes of a text; none where it is none of these.
pub(super) fn parse(text: &str) -> Vec<Volume> {
    let mut reader = Reader::from_str(text);
    let (mut all, mut object) = (Vec::new(), None);
    while let Ok(event) = reader.read_event() {
        let (Event::Start(tag) | Event::Empty(tag)) = event else {
            if event == Event::Eof {
                break;
            }
            continue;
        };
        let element = Element::new(&tag, text);
        let read = |key: &str| {
            let value = attribute(element.attributes, key)?;
            let start = (value.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize);
            Some((value.parse::<u32>().ok()?, start..start + value.len()))
        };
        match element.local {
            "object" => object = read("id").map(|(id, _)| id),
            "volume" => {
                let (Some(object), Some(first), Some(last)) =
                    (object, read("firstid"), read("lastid"))
                else {
                    continue;
                };
                let ((first, first_at), (last, last_at)) = (first, last);
                all.push(Volume {
                    object,
                    first,
                    last,
                    first_at,
                    last_at,
                });
            }
            _ => {}
        }
    }
    all
}

/// The text with other first and last triangles for some of its volumes.
pub(super) fn edited(
    text: &str,
    volumes: &[Volume],
    new: &dyn Fn(&Volume) -> Option<[u32; 2]>,
) -> String {
    let mut changes: Vec<(Range<usize>, u32)> = Vec::new();
    for volume in volumes {
        if let Some([first, last]) = new(volume) {
            changes.push((volume.first_at.clone(), first));
            changes.push((volume.last_at.clone(), last));
        }
    }
    changes.sort_by_key(|(range, _)| range.start);
    let (mut out, mut at) = (String::with_capacity(text.len() + 64), 0);
    for (range, number) in changes {
        out.push_str(&text[at..range.start]);
        out.push_str(&number.to_string());
        at = range.end;
    }
    out.push_str(&text[at..]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_changed_and_nothing_else() {
        let text = "<config>\n <object id=\"3\" x='1'><volume firstid=\"0\" lastid=\"11\"/>\n\
                    <volume lastid = '20' firstid='12'><m/></volume></object><volume/></config>";
        let all = parse(text);
        let read: Vec<_> = all
            .iter()
            .map(|own| (own.object, own.first, own.last))
            .collect();
        assert_eq!(read, [(3, 0, 11), (3, 12, 20)]);
        let new = edited(text, &all, &|own| (own.first > 0).then_some([100, 2000]));
        let expected = text.replace("'20'", "'2000'").replace("'12'", "'100'");
        assert_eq!(new, expected);
    }
}
