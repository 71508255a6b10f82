//! Parts of one mesh by ranges of its triangles, as PrusaSlicer keeps them in a part of its own.
//!
//! It joins the volumes of an object into one mesh, and names each by its first and last triangle; so these numbers change with the
//! triangles.

use super::xml::{Number, elements};

/// The part that has them.
pub(super) const PART: &str = "Metadata/Slic3r_PE_model.config";

/// A volume.
pub(super) struct Volume {
    pub(super) object: u32,
    /// Its first triangle, and its last.
    pub(super) first: Number,
    pub(super) last: Number,
}

/// The volumes of a text; none where it is none of these.
pub(super) fn parse(text: &str) -> Vec<Volume> {
    let (mut all, mut object) = (Vec::new(), None);
    for element in elements(PART, text).map_while(Result::ok) {
        let read = |name: &str| Number::of(&element, name, text);
        match element.local {
            "object" => object = read("id").map(|id| id.value),
            "volume" => {
                if let (Some(object), Some(first), Some(last)) =
                    (object, read("firstid"), read("lastid"))
                {
                    all.push(Volume {
                        object,
                        first,
                        last,
                    });
                }
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
    new: impl Fn(&Volume) -> Option<[u32; 2]>,
) -> String {
    let changed = volumes.iter().filter_map(|own| Some((own, new(own)?)));
    let ends = changed.flat_map(|(own, [first, last])| [(&own.first, first), (&own.last, last)]);
    let mut changes: Vec<(&Number, u32)> = ends.collect();
    changes.sort_by_key(|(old, _)| old.at.start);
    let (mut out, mut at) = (String::with_capacity(text.len() + 64), 0);
    for (old, number) in changes {
        out.push_str(&text[at..old.at.start]);
        out.push_str(&number.to_string());
        at = old.at.end;
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
        let read = all
            .iter()
            .map(|own| [own.object, own.first.value, own.last.value]);
        assert_eq!(read.collect::<Vec<_>>(), [[3, 0, 11], [3, 12, 20]]);
        let new = edited(text, &all, |own| {
            (own.first.value > 0).then_some([100, 2000])
        });
        let expected = text.replace("'20'", "'2000'").replace("'12'", "'100'");
        assert_eq!(new, expected);
    }
}
