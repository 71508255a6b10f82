//! Attributes of triangles apart from their corners: properties, paint, and unknown ones. Triangles that come from one
//! inherit it.

use super::paint;
use super::xml::{Attribute, attributes};
use std::fmt::Write;

/// Where a triangle came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// The triangle of the object.
    pub face: usize,
    /// The new triangle's corners in barycentric coordinates of that one's, in the order that it has them in the file; none where they
    /// are not known.
    pub corners: Option<[[f64; 3]; 3]>,
}

/// Names of the properties of corners.
const CORNERS: [&str; 3] = ["p1", "p2", "p3"];

/// Attributes that could not be kept, counted over all triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Inherited {
    /// New triangles that took paint at their centre from a triangle that is painted in parts.
    pub painted_at_centre: usize,
    /// New triangles that lost paint whose code cannot be read.
    pub unreadable_paint: usize,
    /// New triangles whose corners have the property of the nearest corner, where these differ.
    pub nearest_corner: usize,
}

/// Whether an attribute names a corner.
fn is_corner(own: &Attribute<'_>) -> bool {
    ["v1", "v2", "v3"].contains(&own.name)
}

/// Whether a triangle's properties depend on where in it something is.
pub(super) fn varies_within(text: &str) -> bool {
    let of_corners = attributes(text).filter(|own| CORNERS.contains(&own.name));
    let values: Vec<&str> = of_corners.map(|own| own.value).collect();
    let differ = values.iter().any(|value| *value != values[0]);
    differ || attributes(text).any(|own| is_divided_paint(&own))
}

fn is_divided_paint(own: &Attribute<'_>) -> bool {
    let found = own.name.rsplit_once(':');
    let local = found.map_or(own.name, |(_, local)| local);
    paint::is_paint(local) && paint::is_divided(own.value)
}

/// A triangle's attributes but for its corners, to be compared.
pub(super) fn beside_corners(text: &str) -> impl Iterator<Item = &str> {
    let all = attributes(text).filter(|own| !is_corner(own));
    all.map(|own| own.text)
}

/// Adds the attributes, each with a blank before it, that a triangle inherits from one with this text.
pub(super) fn inherit(
    out: &mut String,
    text: &str,
    source: &Source,
    keeps: &dyn Fn(&str) -> bool,
    losses: &mut Inherited,
) {
    let value = |own: Attribute<'_>| own.value.to_owned();
    let all = CORNERS.map(|name| attributes(text).find(|own| own.name == name).map(value));
    let mut differ = all.iter().flatten();
    let differ = differ.any(|value| Some(value) != all[0].as_ref());
    let is_whole = source.corners == Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    for own in attributes(text).filter(|own| !is_corner(own) && keeps(own.name)) {
        let varies = differ && CORNERS.contains(&own.name) || is_divided_paint(&own);
        if is_whole || !varies {
            let _ = write!(out, " {}", own.text);
            continue;
        }
        let Some(corners) = source.corners else {
            continue;
        };
        if let Some(k) = CORNERS.iter().position(|name| *name == own.name) {
            // Where a corner has none, it has the first's.
            let nearest = all[nearest(corners[k])].as_ref().or(all[0].as_ref());
            let value = nearest.map_or(own.value, String::as_str);
            let _ = write!(out, " {}=\"{value}\"", own.name);
            losses.nearest_corner += usize::from(k == 0);
            continue;
        }
        let centre = [0, 1, 2].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
        match paint::at(own.value, centre) {
            Some(code) => {
                losses.painted_at_centre += 1;
                if !code.is_empty() {
                    let _ = write!(out, " {}=\"{code}\"", own.name);
                }
            }
            None => losses.unreadable_paint += 1,
        }
    }
}

/// The corner that a point is nearest to, the first of those that are as near.
fn nearest(point: [f64; 3]) -> usize {
    (0..3).fold(0, |best, k| if point[k] > point[best] { k } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inherited(text: &str, corners: [[f64; 3]; 3]) -> (String, Inherited) {
        let (mut out, mut told) = (String::new(), Inherited::default());
        let source = Source {
            face: 0,
            corners: Some(corners),
        };
        inherit(&mut out, text, &source, &|name| name != "x:drop", &mut told);
        (out, told)
    }

    const MIDDLE: [[f64; 3]; 3] = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.4, 0.0, 0.6]];

    #[test]
    fn attributes_are_inherited() {
        let (out, told) = inherited(
            " v1=\"0\" v2='1' v3=\"2\" pid='4' x:y=\"&amp;\" x:drop='1' p1=\"7\"",
            MIDDLE,
        );
        assert_eq!(
            (out.as_str(), told),
            (" pid='4' x:y=\"&amp;\" p1=\"7\"", Inherited::default())
        );
        let text = " v1=\"0\" v2=\"1\" v3=\"2\" p1=\"7\" p2=\"8\" p3=\"9\"";
        assert!(varies_within(text));
        let (out, told) = inherited(text, MIDDLE);
        assert_eq!(
            (out.as_str(), told.nearest_corner),
            (" p1=\"7\" p2=\"8\" p3=\"9\"", 1)
        );
        let near = [[0.9, 0.1, 0.0], [0.8, 0.1, 0.1], [0.8, 0.0, 0.2]];
        assert_eq!(inherited(text, near).0, " p1=\"7\" p2=\"7\" p3=\"7\"");
    }

    #[test]
    fn paint_is_that_of_the_centre() {
        // Divided in four, the last child 4, the first 8.
        let text = " v1=\"0\" v2=\"1\" v3=\"2\" paint_color=\"80043\"";
        assert!(varies_within(text) && !varies_within(" v1=\"0\" paint_color=\"8\""));
        let (out, told) = inherited(text, MIDDLE);
        assert_eq!(
            (out.as_str(), told.painted_at_centre),
            (" paint_color=\"4\"", 1)
        );
        let near = [[1.0, 0.0, 0.0], [0.8, 0.1, 0.1], [0.8, 0.0, 0.2]];
        assert_eq!(inherited(text, near).0, " paint_color=\"8\"");
        let whole = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(inherited(text, whole).0, " paint_color=\"80043\"");
        let (out, told) = inherited(" paint_seam=\"3\"", MIDDLE);
        assert_eq!((out.as_str(), told.unreadable_paint), ("", 1));
    }
}
