//! Wavefront OBJ: `v` and `f` statements, and the `t crease` and `t corner` tags of OpenSubdiv.
//!
//! Indices of faces count from 1, negative ones back from the latest vertex; a face may stand before its
//! vertices. Indices of tags count from 0, as in OpenSubdiv's shapes. Texture coordinates, colours after the coordinates,
//! objects, groups, materials and smoothing groups become channels, and so do normals, which say where edges were meant to be sharp;
//! weights and all other statements are passed over, and
//! what there was of them is told.

mod attributes;

use super::left_out::{Kind, LeftOut};
use super::push_face;
use crate::error::Flaw;
use crate::names;
use crate::scan::{Scanner, Syntax, integer, number, quoted};
use attributes::{Attributes, LabelKind};
use limitmesh::mesh::{CornerTag, CreaseTag, PolygonFaces, PolygonSoup};

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup, Flaw> {
    let scanner = Scanner::new(
        bytes,
        Syntax {
            comments: true,
            continuations: true,
        },
    );
    let (vertices, faces) = count_statements(bytes);
    let soup = PolygonSoup {
        positions: Vec::with_capacity(vertices),
        faces: PolygonFaces::with_capacity(faces, 3 * faces),
        ..PolygonSoup::default()
    };
    Reader {
        scanner,
        soup,
        polygon: Vec::new(),
        attributes: Attributes::default(),
        highest_corner: Latest::default(),
        highest_tag: Latest::default(),
        left_out: LeftOut::default(),
    }
    .run()
}

/// How many lines begin with `v ` and `f `: what to make room for. Each of them takes bytes of the file, so
/// that the room is bounded by its size.
fn count_statements(bytes: &[u8]) -> (usize, usize) {
    let mut counts = (0, 0);
    let mut start = 0;
    while let Some(&[kind, blank]) = bytes.get(start..start + 2) {
        let separated = blank == b' ' || blank == b'\t';
        counts.0 += usize::from(separated && kind == b'v');
        counts.1 += usize::from(separated && kind == b'f');
        match memchr::memchr(b'\n', &bytes[start..]) {
            Some(length) => start += length + 1,
            None => break,
        }
    }
    counts
}

/// The greatest index met so far and its line; indices may name vertices that come later in the file.
#[derive(Default)]
struct Latest {
    count_needed: usize,
    line: usize,
}

impl Latest {
    fn note(&mut self, index: u32, line: usize) {
        let needed = index as usize + 1;
        if needed > self.count_needed {
            *self = Self {
                count_needed: needed,
                line,
            };
        }
    }
}

struct Reader<'a> {
    scanner: Scanner<'a>,
    soup: PolygonSoup,
    /// The corners of the face that is being read.
    polygon: Vec<u32>,
    attributes: Attributes,
    highest_corner: Latest,
    highest_tag: Latest,
    left_out: LeftOut,
}

impl Reader<'_> {
    fn run(mut self) -> Result<PolygonSoup, Flaw> {
        while let Some(keyword) = self.scanner.first_word() {
            match keyword {
                b"v" => self.vertex()?,
                b"f" | b"fo" => self.face()?,
                b"t" => self.tag()?,
                b"vt" => self.texture()?,
                b"vn" => self.normal(),
                b"usemtl" => self.label(LabelKind::Material),
                b"o" => self.label(LabelKind::Object),
                b"g" => self.label(LabelKind::Group),
                b"s" => self.label(LabelKind::SmoothingGroup),
                b"mtllib" => {
                    let library = self.rest();
                    self.soup.material_libraries.push(library);
                }
                other => self.pass_over(other),
            }
            self.scanner.next_line();
        }
        self.check_indices()?;
        self.soup.positions.shrink_to_fit();
        if self.attributes.has_wrong_textures() {
            self.left_out
                .other("texture coordinates: some corners name others than there are".to_owned());
        } else if self.attributes.has_unused_textures() {
            self.left_out.note(Kind::TextureCoordinates);
        }
        if !self.soup.material_libraries.is_empty()
            && !self.attributes.has_materials(self.soup.faces.len())
        {
            self.left_out.note(Kind::Materials);
        }
        let (vertices, faces) = (self.soup.positions.len(), &self.soup.faces);
        let bare = self
            .attributes
            .corners_without_textures(faces.corner_count());
        if bare > 0 {
            let corners = if bare == 1 {
                "corner has"
            } else {
                "corners have"
            };
            self.left_out.other(format!(
                "that {bare} {corners} no texture coordinates: 0 0 takes their place"
            ));
        }
        self.soup.channels = self
            .attributes
            .channels(vertices, faces.len(), faces.corner_count());
        self.soup.left_out = self.left_out.in_words();
        Ok(self.soup)
    }

    /// Notes a statement that has no place in a soup, unless it says nothing.
    fn pass_over(&mut self, keyword: &[u8]) {
        let kind = match keyword {
            b"vp" => Kind::Parameters,
            b"l" => Kind::Lines,
            b"p" => Kind::Points,
            other => return self.left_out.other(format!("statements {}", quoted(other))),
        };
        self.left_out.note(kind);
    }

    fn vertex(&mut self) -> Result<(), Flaw> {
        let index = self.soup.positions.len();
        super::check_count(index as u64 + 1, "vertices", self.scanner.place())?;
        let point = self
            .scanner
            .point()
            .map_err(|flaw| flaw.element("vertex", index))?;
        self.soup.positions.push(point);
        self.more_numbers(index);
        Ok(())
    }

    /// After x, y and z: a weight, or red, green and blue, as some programs write them, or both.
    #[inline]
    fn more_numbers(&mut self, vertex: usize) {
        let Some(first) = self.scanner.word() else {
            return;
        };
        let mut numbers = [number(first).unwrap_or(f64::NAN), 0.0, 0.0, 0.0];
        let mut count = 1;
        while let Some(word) = self.scanner.word() {
            if let Some(slot) = numbers.get_mut(count) {
                *slot = number(word).unwrap_or(f64::NAN);
            }
            count += 1;
        }
        let (weight, colour) = match count {
            1 => (numbers[0], None),
            3 => (1.0, Some([numbers[0], numbers[1], numbers[2]])),
            4 => (numbers[0], Some([numbers[1], numbers[2], numbers[3]])),
            _ => (1.0, Some([f64::NAN; 3])),
        };
        if weight != 1.0 {
            self.left_out.note(Kind::Weights);
        }
        match colour {
            Some(colour) if colour.iter().all(|x| x.is_finite()) => {
                self.attributes.colour(vertex, colour)
            }
            Some(_) => self.left_out.note(Kind::Colours),
            None => {}
        }
    }

    /// `vt U [V [W]]`.
    fn texture(&mut self) -> Result<(), Flaw> {
        let mut place = [0.0; 3];
        let mut count = 0;
        while let Some(word) = self.scanner.word().filter(|_| count < place.len()) {
            let found = number(word).filter(|x: &f64| x.is_finite());
            place[count] = found.ok_or_else(|| {
                let index = self.attributes.texture_count();
                self.scanner
                    .unexpected(Some(word), "a finite number")
                    .element("texture coordinate", index)
            })?;
            count += 1;
        }
        if count == 0 {
            return Err(self
                .scanner
                .unexpected(None, "one to three numbers after vt"));
        }
        super::check_count(
            self.attributes.texture_count() as u64 + 1,
            "texture coordinates",
            self.scanner.place(),
        )?;
        self.attributes.texture(place, count);
        Ok(())
    }

    /// `vn X Y Z`; one that is no direction says nothing.
    fn normal(&mut self) {
        self.left_out.note(Kind::Normals);
        let numbers = [(); 3].map(|()| {
            self.scanner
                .word()
                .and_then(number)
                .filter(|x: &f64| x.is_finite())
        });
        let normal = if let [Some(x), Some(y), Some(z)] = numbers {
            [x, y, z]
        } else {
            [0.0; 3]
        };
        self.attributes.normal(normal);
    }

    /// What faces from here on belong to.
    fn label(&mut self, kind: LabelKind) {
        let name = self.rest();
        self.attributes.label(kind, name, self.soup.faces.len());
    }

    /// The words that are left of a line, one blank between them.
    fn rest(&mut self) -> String {
        let mut words = Vec::new();
        while let Some(word) = self.scanner.word() {
            words.push(names::read(word));
        }
        words.join(" ")
    }

    fn face(&mut self) -> Result<(), Flaw> {
        self.polygon.clear();
        while let Some(word) = self.scanner.word() {
            let index = self.corner(word)?;
            let corner = self.soup.faces.corner_count() + self.polygon.len();
            if let Some(texture) = named(word, 1, self.attributes.texture_count()) {
                self.attributes.texture_of_corner(corner, texture);
            }
            if let Some(normal) = named(word, 2, self.attributes.normal_count()) {
                self.attributes.normal_of_corner(corner, normal);
            }
            if index as usize >= self.soup.positions.len() {
                self.highest_corner.note(index, self.scanner.line());
            }
            self.polygon.push(index);
        }
        push_face(&mut self.soup.faces, &self.polygon, || self.scanner.place())
    }

    /// The vertex, counted from 0, that a corner such as `7`, `-1`, `7/2`, `7//3` or `7/2/3` names.
    #[inline]
    fn corner(&self, word: &[u8]) -> Result<u32, Flaw> {
        let vertex = word.split(|&b| b == b'/').next().unwrap_or_default();
        let latest = self.soup.positions.len() as i64;
        let index = match integer(vertex) {
            Some(index) if index > 0 => Some(index - 1),
            Some(index) if index < 0 => Some(latest + index),
            _ => None,
        };
        // One less than u32::MAX, because that many vertices are the most there can be.
        index.and_then(|i| u32::try_from(i).ok()).filter(|&i| i < u32::MAX).ok_or_else(|| {
            let face = self.soup.faces.len();
            Flaw::new(
                self.scanner.place(),
                quoted(word),
                format!(
                    "a vertex index from 1, or one from -{latest} to -1, counting back from the latest vertex"
                ),
            )
            .element("face", face)
        })
    }

    /// `t NAME INTEGERS/FLOATS/STRINGS` and that many values. Names other than `crease` and `corner` are
    /// passed over.
    fn tag(&mut self) -> Result<(), Flaw> {
        let crease = match self.scanner.word() {
            Some(b"crease") => true,
            Some(b"corner") => false,
            Some(name) => {
                self.left_out.other(format!("tags {}", quoted(name)));
                return Ok(());
            }
            None => return Ok(()),
        };
        let (integers, floats) = self.tag_counts()?;
        let ends = if crease { 2 } else { 1 };
        let (vertices, sharpness) = (self.tag_vertices(integers)?, self.tag_sharpness(floats)?);
        let tags = vertices.len() / ends;
        if vertices.len() % ends != 0 || sharpness.len() != 1 && sharpness.len() != tags {
            let problem = format!(
                "the tag has {integers} vertices and {floats} sharpnesses; each tagged place needs {ends} of the former, and one of \
                 the latter for all or for each"
            );
            return Err(Flaw::saying(self.scanner.place(), problem));
        }
        for (i, place) in vertices.chunks_exact(ends).enumerate() {
            let sharpness = sharpness[if sharpness.len() == 1 { 0 } else { i }];
            match *place {
                [a, b] => self.soup.creases.push(CreaseTag {
                    vertices: [a, b],
                    sharpness,
                }),
                [vertex] => self.soup.corners.push(CornerTag { vertex, sharpness }),
                _ => {}
            }
        }
        Ok(())
    }

    fn tag_counts(&mut self) -> Result<(usize, usize), Flaw> {
        let word = self.scanner.word();
        let parse = |word: &[u8]| {
            let mut counts = word
                .split(|&b| b == b'/')
                .map(|w| integer(w).and_then(|n| usize::try_from(n).ok()));
            Some((counts.next()??, counts.next()??))
        };
        word.and_then(parse).ok_or_else(|| {
            self.scanner
                .unexpected(word, "the tag's counts, as in 2/1/0")
        })
    }

    fn tag_vertices(&mut self, count: usize) -> Result<Vec<u32>, Flaw> {
        let mut vertices = Vec::new();
        for _ in 0..count {
            let word = self.scanner.word();
            let index = word
                .and_then(integer)
                .and_then(|i| u32::try_from(i).ok())
                .filter(|&i| i < u32::MAX);
            let Some(index) = index else {
                return Err(self
                    .scanner
                    .unexpected(word, "a vertex index from 0 in a tag"));
            };
            self.highest_tag.note(index, self.scanner.line());
            vertices.push(index);
        }
        Ok(vertices)
    }

    fn tag_sharpness(&mut self, count: usize) -> Result<Vec<f64>, Flaw> {
        let mut values = Vec::new();
        for _ in 0..count {
            let word = self.scanner.word();
            match word.and_then(number) {
                Some(value) if value >= 0.0 => values.push(value),
                _ => return Err(self.scanner.unexpected(word, "a sharpness of at least 0")),
            }
        }
        Ok(values)
    }

    /// Whether all the vertices that faces and tags name have come.
    fn check_indices(&self) -> Result<(), Flaw> {
        let count = self.soup.positions.len();
        if count == 0 {
            return Err(self
                .scanner
                .unexpected(None, "at least one vertex (v X Y Z)"));
        }
        if self.highest_corner.count_needed > count {
            let named = self.highest_corner.count_needed;
            let problem = format!(
                "a face names vertex {named}, but the last vertex is {count} (faces count from 1)"
            );
            return Err(Flaw::saying(
                crate::Place::Line(self.highest_corner.line),
                problem,
            ));
        }
        if self.highest_tag.count_needed > count {
            let (named, last) = (self.highest_tag.count_needed - 1, count - 1);
            let problem = format!(
                "a tag names vertex {named}, but the last vertex is {last} (tags count from 0)"
            );
            return Err(Flaw::saying(
                crate::Place::Line(self.highest_tag.line),
                problem,
            ));
        }
        Ok(())
    }
}

/// What a corner such as `7/2/3` names in its part `place`, counted from 0, if it does; so many there are so far.
#[inline]
fn named(corner: &[u8], place: usize, count: usize) -> Option<u32> {
    let part = corner
        .split(|&b| b == b'/')
        .nth(place)
        .filter(|part| !part.is_empty())?;
    let index = match integer(part) {
        Some(index) if index > 0 => Some(index - 1),
        Some(index) if index < 0 => Some(count as i64 + index),
        _ => None,
    };
    // What names nothing is found with what names too much.
    Some(
        index
            .and_then(|i| u32::try_from(i).ok())
            .unwrap_or(u32::MAX - 1),
    )
}
