//! A model part: its objects, what is built, and where the text has the vertices and triangles that can be replaced.
//!
//! Elements are known by their place below the root and by having its prefix; whatever else the text has is passed over.

use super::xml::{Element, attributes, not_xml, plain};
use crate::affine::{Affine, IDENTITY};
use crate::flaw::{Flaw, Result, quoted};
use crate::scan::finite;
use crate::unit::LengthUnit;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::HashMap;
use std::ops::Range;

/// A model part of a package.
#[derive(Default)]
pub(super) struct Model {
    pub(super) part: usize,
    pub(super) name: String,
    pub(super) text: String,
    /// Before the names of elements, with its colon.
    pub(super) prefix: String,
    pub(super) unit: LengthUnit,
    pub(super) objects: Vec<Object>,
    pub(super) of_id: HashMap<u32, usize>,
    /// The items that are built.
    pub(super) items: Vec<Use>,
}

/// An object of a model.
#[derive(Default)]
pub(super) struct Object {
    pub(super) id: u32,
    pub(super) name: Option<String>,
    pub(super) mesh: Option<MeshText>,
    pub(super) components: Vec<Use>,
}

/// An object that stands somewhere.
pub(super) struct Use {
    pub(super) object: u32,
    /// The model part that has it, where it is another.
    pub(super) part: Option<String>,
    pub(super) transform: Affine,
    /// Where the text says so.
    pub(super) at: usize,
}

/// A mesh, and where the text has it.
#[derive(Default)]
pub(super) struct MeshText {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// By triangle, the text of its attributes; empty where no triangle has more than its corners.
    pub(super) attributes: Vec<Range<u32>>,
    /// Between the tags of the lists.
    pub(super) vertices_at: Range<usize>,
    pub(super) triangles_at: Range<usize>,
    /// The mesh's other elements, by name.
    pub(super) others: Vec<String>,
}

/// Where an element is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Level {
    Model,
    Resources,
    Object,
    Mesh,
    Vertices,
    Triangles,
    Components,
    Build,
    Other,
}

impl Model {
    pub(super) fn parse(part: usize, name: &str, text: String) -> Result<Self> {
        let found = Self {
            part,
            name: name.to_owned(),
            ..Self::default()
        };
        let mut parser = Parser {
            text: &text,
            levels: Vec::new(),
            found,
            has_model: false,
            object: Object::default(),
            mesh: MeshText::default(),
        };
        parser.run()?;
        let found = parser.found;
        Ok(Self { text, ..found })
    }
}

struct Parser<'a> {
    text: &'a str,
    /// Of the elements that are open.
    levels: Vec<Level>,
    found: Model,
    has_model: bool,
    /// The object, and the mesh, that are read.
    object: Object,
    mesh: MeshText,
}

impl<'a> Parser<'a> {
    fn run(&mut self) -> Result<()> {
        let start = self.text.len() - self.text.trim_start_matches('\u{feff}').len();
        let mut reader = Reader::from_str(&self.text[start..]);
        loop {
            let at = start + reader.buffer_position() as usize;
            let event = reader.read_event();
            let end = start + reader.buffer_position() as usize;
            match event {
                Ok(Event::Start(tag)) => {
                    let element = Element::new(&tag, &self.found.name, self.text, at)?;
                    let level = self.open(&element, end)?;
                    self.levels.push(level);
                }
                Ok(Event::Empty(tag)) => {
                    let element = Element::new(&tag, &self.found.name, self.text, at)?;
                    let level = self.open(&element, end)?;
                    self.close(level, end);
                }
                Ok(Event::End(_)) => {
                    if let Some(level) = self.levels.pop() {
                        self.close(level, at);
                    }
                }
                Ok(Event::DocType(_)) => return Err(self.flaw(at, "3MF allows no document type")),
                Ok(Event::Eof) => break,
                Ok(_) => {}
                Err(why) => {
                    return Err(self.within(not_xml(&self.found.name, self.text, at, &why)));
                }
            }
        }
        if !self.levels.is_empty() {
            return Err(self.flaw(self.text.len(), "the text ends within an element"));
        }
        if !self.has_model {
            return Err(Flaw::saying(&*self.found.name, "it has no element model"));
        }
        Ok(())
    }

    /// A flaw at a byte of the text.
    fn flaw(&self, at: usize, problem: impl Into<String>) -> Flaw {
        self.within(Flaw::saying(&*self.found.name, problem).at(self.text, at))
    }

    /// Adds the object to a flaw within one.
    fn within(&self, flaw: Flaw) -> Flaw {
        match self.levels.contains(&Level::Object) {
            true => flaw.element("object", self.object.id as usize),
            false => flaw,
        }
    }

    /// The kind of an element, by its parents; its tag ends at a byte.
    fn open(&mut self, element: &Element<'a>, end: usize) -> Result<Level> {
        let Some(&level) = self.levels.last() else {
            return self.model(element);
        };
        let is_core = element.prefix() == self.found.prefix;
        match (level, element.local) {
            (Level::Mesh, "vertices") if is_core => {
                self.once(self.mesh.vertices_at.end == 0, element)?;
                self.mesh.vertices_at = end..end;
                return Ok(Level::Vertices);
            }
            (Level::Mesh, "triangles") if is_core => {
                self.once(self.mesh.triangles_at.end == 0, element)?;
                self.mesh.triangles_at = end..end;
                return Ok(Level::Triangles);
            }
            (Level::Mesh, _) => self.mesh.others.push(element.name.to_owned()),
            _ if !is_core => {}
            (Level::Model, "resources") => return Ok(Level::Resources),
            (Level::Model, "build") => return Ok(Level::Build),
            (Level::Resources, "object") => return self.object(element),
            (Level::Object, "mesh") if self.object.mesh.is_some() => {
                return Err(self.flaw(element.at, "the object has a second mesh"));
            }
            (Level::Object, "mesh") => return Ok(Level::Mesh),
            (Level::Object, "components") => return Ok(Level::Components),
            (Level::Components, "component") => self.object.components.push(self.used(element)?),
            (Level::Build, "item") => self.found.items.push(self.used(element)?),
            (Level::Vertices, "vertex") => self.mesh.positions.push(self.vertex(element)?),
            (Level::Triangles, "triangle") => self.triangle(element)?,
            _ => {}
        }
        Ok(Level::Other)
    }

    /// Takes in what ends at a byte.
    fn close(&mut self, level: Level, at: usize) {
        match level {
            Level::Vertices => self.mesh.vertices_at.end = at,
            Level::Triangles => self.mesh.triangles_at.end = at,
            Level::Mesh => self.object.mesh = Some(std::mem::take(&mut self.mesh)),
            Level::Object => self.found.objects.push(std::mem::take(&mut self.object)),
            _ => {}
        }
    }

    fn model(&mut self, element: &Element<'a>) -> Result<Level> {
        if element.local != "model" || self.has_model {
            let found = format!("the element {}", element.name);
            let flaw = Flaw::new(&*self.found.name, found, "one element model");
            return Err(flaw.at(self.text, element.at));
        }
        self.has_model = true;
        self.found.prefix = element.prefix().to_owned();
        if let Some(name) = element.attribute("unit") {
            let own = LengthUnit::ALL.into_iter().find(|unit| unit.name() == name);
            self.found.unit = own.ok_or_else(|| {
                let known = LengthUnit::ALL.map(LengthUnit::name).join(", ");
                self.flaw(
                    element.at,
                    format!("the unit '{name}' is unknown; known are {known}"),
                )
            })?;
        }
        Ok(Level::Model)
    }

    /// Refuses a list that a mesh has already.
    fn once(&self, is_first: bool, element: &Element<'a>) -> Result<()> {
        let problem = || format!("the mesh has a second list of {}", element.local);
        if is_first {
            Ok(())
        } else {
            Err(self.flaw(element.at, problem()))
        }
    }

    fn object(&mut self, element: &Element<'a>) -> Result<Level> {
        let id = self.id(element, "id")?;
        if self
            .found
            .of_id
            .insert(id, self.found.objects.len())
            .is_some()
        {
            return Err(self.flaw(element.at, format!("there is a second object {id}")));
        }
        let name = element.attribute("name").map(plain);
        self.object = Object {
            id,
            name,
            ..Object::default()
        };
        Ok(Level::Object)
    }

    /// The value of an attribute that `read` understands.
    fn value<T>(
        &self,
        element: &Element<'a>,
        key: &str,
        expected: impl Fn() -> String,
        read: impl Fn(&str) -> Option<T>,
    ) -> Result<T> {
        let text = element.attribute(key);
        text.and_then(read).ok_or_else(|| {
            let (name, expected) = (&*self.found.name, expected());
            let flaw = match text {
                None => Flaw::saying(name, format!("{key} is missing: expected {expected}")),
                Some(text) => {
                    Flaw::new(name, format!("{key}={}", quoted(text.as_bytes())), expected)
                }
            };
            self.within(flaw.at(self.text, element.at))
        })
    }

    fn id(&self, element: &Element<'a>, key: &str) -> Result<u32> {
        self.value(
            element,
            key,
            || "a whole number".to_owned(),
            |text| text.trim().parse().ok(),
        )
    }

    fn used(&self, element: &Element<'a>) -> Result<Use> {
        let expected = || "twelve finite numbers".to_owned();
        let transform = match element.attribute("transform") {
            None => IDENTITY,
            Some(_) => self.value(element, "transform", expected, transform)?,
        };
        let part = element.local_attribute("path").map(str::to_owned);
        Ok(Use {
            object: self.id(element, "objectid")?,
            part,
            transform,
            at: element.at,
        })
    }

    fn vertex(&self, element: &Element<'a>) -> Result<[f64; 3]> {
        let mut point = [0.0; 3];
        for (x, key) in point.iter_mut().zip(["x", "y", "z"]) {
            let expected = || "a finite number".to_owned();
            *x = self.value(element, key, expected, |text| {
                finite(text.trim().as_bytes())
            })?;
        }
        Ok(point)
    }

    fn triangle(&mut self, element: &Element<'a>) -> Result<()> {
        let vertices = self.mesh.positions.len();
        let mut corners = [0; 3];
        for (corner, key) in corners.iter_mut().zip(["v1", "v2", "v3"]) {
            let expected = || format!("a vertex below {vertices} (their number so far)");
            let is_there = |&index: &u32| (index as usize) < vertices;
            *corner = self.value(element, key, expected, |text| {
                text.trim().parse().ok().filter(is_there)
            })?;
        }
        let mesh = &mut self.mesh;
        let has_more = attributes(element.attributes).count() > 3;
        if has_more || !mesh.attributes.is_empty() {
            mesh.attributes.resize(mesh.triangles.len(), 0..0);
            let own = element.attributes_at(self.text);
            mesh.attributes.push(if has_more { own } else { 0..0 });
        }
        mesh.triangles.push(corners);
        Ok(())
    }
}

/// Twelve numbers: where the axes go, and the origin; points are rows, (x, y, z, 1) times the matrix.
fn transform(text: &str) -> Option<Affine> {
    let words = text.split_ascii_whitespace();
    let numbers: Option<Vec<f64>> = words.map(|word| finite(word.as_bytes())).collect();
    let m: [f64; 12] = numbers?.try_into().ok()?;
    Some(std::array::from_fn(|row| {
        std::array::from_fn(|column| m[3 * column + row])
    }))
}
