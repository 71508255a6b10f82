//! Wavefront OBJ: `v` and `f` statements, and the `t crease` and `t corner` tags of OpenSubdiv.
//!
//! Indices of faces count from 1, negative ones back from the latest vertex; a face may stand before its
//! vertices. Indices of tags count from 0, as in OpenSubdiv's shapes. Texture coordinates, colours after the coordinates,
//! objects, groups, materials and smoothing groups become channels, and so do normals, which say where edges were meant to be sharp;
//! weights and all other statements are passed over and reported.

use super::attributes::{Attributes, LABELS, number_of};
use crate::channels;
use crate::flaw::{Flaw, Place, Result, quoted};
use crate::reading::{Kind, LeftOut, check_count, push_face};
use crate::scan::{Scanner, finite, integer, number};
use limitmesh::mesh::{CornerTag, CreaseTag, PolygonFaces, PolygonSoup};

/// Whether the first statement is one of OBJ files.
pub(super) fn begins(bytes: &[u8]) -> bool {
    let mut scanner = Scanner::of_statements(bytes);
    match scanner.first_word() {
        Some(b"v" | b"vn" | b"vt") => scanner.word().and_then(number).is_some(),
        word => matches!(word, Some(b"mtllib" | b"usemtl" | b"o" | b"g")),
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<PolygonSoup> {
    let [vertices, faces] = count_statements(bytes);
    let soup = PolygonSoup {
        positions: Vec::with_capacity(vertices),
        faces: PolygonFaces::with_capacity(faces, 3 * faces),
        ..PolygonSoup::default()
    };
    let reader = Reader {
        scanner: Scanner::of_statements(bytes),
        soup,
        polygon: Vec::new(),
        attributes: Attributes::default(),
        highest_corner: Latest::default(),
        highest_tag: Latest::default(),
        left_out: LeftOut::default(),
    };
    reader.run()
}

/// How many lines begin with `v ` and `f `: what to make room for. Each of them takes bytes of the file, so
/// that the room is bounded by its size.
fn count_statements(bytes: &[u8]) -> [usize; 2] {
    let mut counts = [0; 2];
    let mut start = 0;
    while let Some(&[kind, blank]) = bytes.get(start..start + 2) {
        let separated = blank == b' ' || blank == b'\t';
        counts[0] += usize::from(separated && kind == b'v');
        counts[1] += usize::from(separated && kind == b'f');
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
        let count_needed = index as usize + 1;
        if count_needed > self.count_needed {
            *self = Self { count_needed, line };
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
    fn run(mut self) -> Result<PolygonSoup> {
        while let Some(keyword) = self.scanner.first_word() {
            match keyword {
                b"v" => self.vertex()?,
                b"f" | b"fo" => self.face()?,
                b"t" => self.tag()?,
                b"vt" => self.texture()?,
                b"vn" => self.normal(),
                b"mtllib" => self
                    .soup
                    .material_libraries
                    .push(self.scanner.rest_of_line()),
                b"vp" => self.left_out.note(Kind::Parameters),
                b"l" => self.left_out.note(Kind::Lines),
                b"p" => self.left_out.note(Kind::Points),
                other => self.label(other),
            }
            self.scanner.next_line();
        }
        self.check_indices()?;
        self.soup.positions.shrink_to_fit();
        self.report_textures_and_materials();
        let (vertices, faces) = (self.soup.positions.len(), &self.soup.faces);
        let channels = self
            .attributes
            .channels(vertices, faces.len(), faces.corner_count());
        self.soup.channels = channels;
        self.soup.left_out = self.left_out.in_words();
        Ok(self.soup)
    }

    /// Notes what texture coordinates and materials lack.
    fn report_textures_and_materials(&mut self) {
        let (textures, faces) = (&self.attributes.textures, &self.soup.faces);
        if textures.is_wrong() {
            let words = "texture coordinates: some corners name others than there are";
            self.left_out.other(words.to_owned());
        } else if textures.is_unused() {
            self.left_out.note(Kind::TextureCoordinates);
        }
        let is_material = |&at: &usize| LABELS[at].1 == channels::MATERIAL;
        let mut materials = (0..LABELS.len()).filter(is_material);
        if !self.soup.material_libraries.is_empty()
            && !materials.any(|at| self.attributes.labels[at].are_used(faces.len()))
        {
            self.left_out.note(Kind::Materials);
        }
        let bare = textures.bare_corners(faces.corner_count());
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
    }

    fn vertex(&mut self) -> Result<()> {
        let index = self.soup.positions.len();
        check_count(index as u64 + 1, "vertices", self.scanner.place())?;
        let found = self.scanner.point();
        let point = found.map_err(|flaw| flaw.element("vertex", index))?;
        self.soup.positions.push(point);
        self.more_numbers(index);
        Ok(())
    }

    /// After x, y and z: a weight, or red, green and blue, as some programs write them, or both.
    #[inline]
    fn more_numbers(&mut self, vertex: usize) {
        let mut numbers = [f64::NAN; 4];
        let mut count = 0;
        while let Some(word) = self.scanner.word() {
            if let Some(own) = numbers.get_mut(count) {
                *own = number(word).unwrap_or(f64::NAN);
            }
            count += 1;
        }
        let [a, b, c, d] = numbers;
        let (weight, colour) = match count {
            0 => return,
            1 => (a, None),
            3 => (1.0, Some([a, b, c])),
            4 => (a, Some([b, c, d])),
            _ => (1.0, Some([f64::NAN; 3])),
        };
        if weight != 1.0 {
            self.left_out.note(Kind::Weights);
        }
        match colour {
            Some(colour) if colour.iter().all(|x| x.is_finite()) => {
                self.attributes.colour(vertex, colour);
            }
            Some(_) => self.left_out.note(Kind::Colours),
            None => {}
        }
    }

    /// `vt U [V [W]]`.
    fn texture(&mut self) -> Result<()> {
        let (mut place, mut count) = ([0.0; 3], 0);
        let index = self.attributes.textures.values.len();
        while let Some(word) = self.scanner.word().filter(|_| count < place.len()) {
            place[count] = finite(word).ok_or_else(|| {
                let flaw = self.scanner.unexpected(Some(word), "a finite number");
                flaw.element("texture coordinate", index)
            })?;
            count += 1;
        }
        if count == 0 {
            return Err(self
                .scanner
                .unexpected(None, "one to three numbers after vt"));
        }
        check_count(
            index as u64 + 1,
            "texture coordinates",
            self.scanner.place(),
        )?;
        self.attributes.textures.values.push(place);
        self.attributes.texture_arity = self.attributes.texture_arity.max(count);
        Ok(())
    }

    /// `vn X Y Z`; one that is no direction says nothing.
    fn normal(&mut self) {
        self.left_out.note(Kind::Normals);
        let point = self.scanner.point();
        self.attributes
            .normals
            .values
            .push(point.unwrap_or([0.0; 3]));
    }

    /// The group of the faces from here on; other statements have no place in a soup.
    fn label(&mut self, keyword: &[u8]) {
        match LABELS.iter().position(|&(own, _)| own == keyword) {
            Some(kind) => {
                let name = self.scanner.rest_of_line();
                self.attributes.labels[kind].begin(name, self.soup.faces.len());
            }
            None => self
                .left_out
                .other(format!("statements {}", quoted(keyword))),
        }
    }

    fn face(&mut self) -> Result<()> {
        self.polygon.clear();
        while let Some(word) = self.scanner.word() {
            let mut parts = word.split(|&b| b == b'/');
            let index = self.corner(word, parts.next())?;
            let corner = self.soup.faces.corner_count() + self.polygon.len();
            self.attributes.textures.name(corner, parts.next());
            self.attributes.normals.name(corner, parts.next());
            if index as usize >= self.soup.positions.len() {
                self.highest_corner.note(index, self.scanner.line());
            }
            self.polygon.push(index);
        }
        push_face(&mut self.soup.faces, &self.polygon, || self.scanner.place())
    }

    /// The vertex, counted from 0, that the first part of a corner such as `7`, `-1`, `7/2`, `7//3` or `7/2/3` names.
    #[inline]
    fn corner(&self, word: &[u8], vertex: Option<&[u8]>) -> Result<u32> {
        let latest = self.soup.positions.len();
        let index = vertex.and_then(|vertex| number_of(vertex, latest));
        // One less than u32::MAX, because that many vertices are the most there can be.
        index.filter(|&index| index < u32::MAX).ok_or_else(|| {
            let expected = format!(
                "a vertex index from 1, or one from -{latest} to -1, counting back from the latest vertex"
            );
            let flaw = Flaw::new(self.scanner.place(), quoted(word), expected);
            flaw.element("face", self.soup.faces.len())
        })
    }

    /// `t NAME INTEGERS/FLOATS/STRINGS` and that many values. Names other than `crease` and `corner` are
    /// passed over.
    fn tag(&mut self) -> Result<()> {
        let ends = match self.scanner.word() {
            Some(b"crease") => 2,
            Some(b"corner") => 1,
            Some(name) => {
                self.left_out.other(format!("tags {}", quoted(name)));
                return Ok(());
            }
            None => return Ok(()),
        };
        let [integers, floats] = self.tag_counts()?;
        let (vertices, sharpness) = (self.tag_vertices(integers)?, self.tag_sharpness(floats)?);
        let tags = vertices.len() / ends;
        if vertices.len() % ends != 0 || sharpness.len() != 1 && sharpness.len() != tags {
            let problem = format!(
                "the tag has {integers} vertices and {floats} sharpnesses; each tagged place needs {ends} of the former, and one of \
                 the latter for all or for each"
            );
            return Err(Flaw::saying(self.scanner.place(), problem));
        }
        for (place, &sharpness) in vertices.chunks_exact(ends).zip(sharpness.iter().cycle()) {
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

    fn tag_counts(&mut self) -> Result<[usize; 2]> {
        let word = self.scanner.word();
        let parse = |word: &[u8]| {
            let mut counts = word.split(|&b| b == b'/').map(integer);
            let mut next = || usize::try_from(counts.next()??).ok();
            Some([next()?, next()?])
        };
        let counts = word.and_then(parse);
        counts.ok_or_else(|| {
            self.scanner
                .unexpected(word, "the tag's counts, as in 2/1/0")
        })
    }

    fn tag_vertices(&mut self, count: usize) -> Result<Vec<u32>> {
        let mut vertices = Vec::new();
        for _ in 0..count {
            let word = self.scanner.word();
            let index = word.and_then(integer).and_then(|i| u32::try_from(i).ok());
            let Some(index) = index.filter(|&i| i < u32::MAX) else {
                return Err(self
                    .scanner
                    .unexpected(word, "a vertex index from 0 in a tag"));
            };
            self.highest_tag.note(index, self.scanner.line());
            vertices.push(index);
        }
        Ok(vertices)
    }

    fn tag_sharpness(&mut self, count: usize) -> Result<Vec<f64>> {
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
    fn check_indices(&self) -> Result<()> {
        let count = self.soup.positions.len();
        if count == 0 {
            return Err(self
                .scanner
                .unexpected(None, "at least one vertex (v X Y Z)"));
        }
        let kinds = [
            (&self.highest_corner, "face", 1),
            (&self.highest_tag, "tag", 0),
        ];
        for (Latest { count_needed, line }, what, first) in kinds {
            if *count_needed > count {
                let [named, last] = [count_needed, &count].map(|count| count - 1 + first);
                let problem = format!(
                    "a {what} names vertex {named}, but the last vertex is {last} ({what}s count from {first})"
                );
                return Err(Flaw::saying(Place::Line(*line), problem));
            }
        }
        Ok(())
    }
}
