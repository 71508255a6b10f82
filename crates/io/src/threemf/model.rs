//! A model part: its objects, what is built, and where the text has the vertices and triangles that can be replaced.
//!
//! Elements are known by their place below the root and by having its prefix; whatever else the text has is passed over.

use super::flaw::{PackageFlaw, Result};
use super::xml::{Element, attribute};
use crate::affine::{Affine, IDENTITY};
use crate::error::expected_but_found;
use crate::scan::number;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::HashMap;
use std::ops::Range;

/// What the numbers of a package are measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum LengthUnit {
    /// Micrometres.
    Micron,
    /// Millimetres, where a package says nothing.
    #[default]
    Millimeter,
    /// Centimetres.
    Centimeter,
    /// Inches.
    Inch,
    /// Feet.
    Foot,
    /// Metres.
    Meter,
}

/// The names of units in files.
const UNITS: [(&str, LengthUnit); 6] = [
    ("micron", LengthUnit::Micron),
    ("millimeter", LengthUnit::Millimeter),
    ("centimeter", LengthUnit::Centimeter),
    ("inch", LengthUnit::Inch),
    ("foot", LengthUnit::Foot),
    ("meter", LengthUnit::Meter),
];

impl LengthUnit {
    /// How files name it.
    pub(super) fn name(self) -> &'static str {
        UNITS
            .iter()
            .find(|(_, unit)| *unit == self)
            .map_or("millimeter", |(name, _)| name)
    }

    /// Its length in metres.
    pub fn metres(self) -> f64 {
        match self {
            Self::Micron => 1e-6,
            Self::Millimeter => 1e-3,
            Self::Centimeter => 1e-2,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
            Self::Meter => 1.0,
        }
    }
}

/// A model part of a package.
pub(super) struct Model {
    pub(super) part: usize,
    pub(super) name: String,
    pub(super) text: String,
    /// Before the names of elements, with its colon.
    pub(super) prefix: String,
    pub(super) unit: LengthUnit,
    pub(super) objects: Vec<Object>,
    pub(super) of_id: HashMap<u32, usize>,
    /// What is built.
    pub(super) items: Vec<Use>,
}

/// An object of a model.
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
    /// What else the mesh has, by name.
    pub(super) others: Vec<String>,
}

/// Where an element is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Top,
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
        let mut parser = Parser {
            name,
            text: &text,
            places: vec![Place::Top],
            found: Found::default(),
        };
        parser.run()?;
        let Found {
            prefix,
            unit,
            objects,
            of_id,
            items,
            ..
        } = parser.found;
        Ok(Self {
            part,
            name: name.to_owned(),
            text,
            prefix,
            unit,
            objects,
            of_id,
            items,
        })
    }
}

#[derive(Default)]
struct Found {
    prefix: String,
    has_model: bool,
    unit: LengthUnit,
    objects: Vec<Object>,
    of_id: HashMap<u32, usize>,
    items: Vec<Use>,
}

struct Parser<'a> {
    name: &'a str,
    text: &'a str,
    places: Vec<Place>,
    found: Found,
}

impl<'a> Parser<'a> {
    fn run(&mut self) -> Result<()> {
        let start = self.text.len() - self.text.trim_start_matches('\u{feff}').len();
        let mut reader = Reader::from_str(&self.text[start..]);
        loop {
            let at = start + reader.buffer_position() as usize;
            let event = reader
                .read_event()
                .map_err(|why| self.within(PackageFlaw::not_xml(self.name, &why), at))?;
            let end = start + reader.buffer_position() as usize;
            match event {
                Event::Start(element) => {
                    let place = self.open(&Element::new(&element, self.text), at, end)?;
                    self.places.push(place);
                }
                Event::Empty(element) => {
                    self.open(&Element::new(&element, self.text), at, end)?;
                }
                Event::End(_) => {
                    let place = self.places.pop();
                    self.close(place, at);
                }
                Event::DocType(_) => return Err(self.flaw(at, "3MF allows no document type")),
                Event::Eof => break,
                _ => {}
            }
        }
        if self.places.len() > 1 {
            return Err(self.flaw(self.text.len(), "the text ends within an element"));
        }
        if !self.found.has_model {
            return Err(PackageFlaw::new(self.name, "it has no element model"));
        }
        Ok(())
    }

    fn flaw(&self, at: usize, problem: impl Into<String>) -> PackageFlaw {
        self.within(PackageFlaw::new(self.name, problem), at)
    }

    /// The flaw at a byte of the text, within the object there.
    fn within(&self, flaw: PackageFlaw, at: usize) -> PackageFlaw {
        let flaw = flaw.at(self.text, at);
        let is_within = self.places.contains(&Place::Object);
        match self.found.objects.last().filter(|_| is_within) {
            Some(object) => flaw.element(format!("object {}", object.id)),
            None => flaw,
        }
    }

    /// What an element is, by where it stands.
    fn open(&mut self, element: &Element<'a>, at: usize, end: usize) -> Result<Place> {
        let place = *self.places.last().unwrap_or(&Place::Top);
        if place == Place::Top {
            if element.local != "model" || self.found.has_model {
                let problem = expected_but_found(
                    "one element model",
                    &format!("the element {}", element.name),
                );
                return Err(self.flaw(at, problem));
            }
            self.found.has_model = true;
            self.found.prefix = element.prefix().to_owned();
            if let Some(unit) = attribute(element.attributes, "unit") {
                let own = UNITS.iter().find(|(name, _)| *name == unit);
                let names: Vec<&str> = UNITS.iter().map(|(name, _)| *name).collect();
                let flaw = || {
                    let problem = format!(
                        "the unit '{unit}' is unknown; known are {}",
                        names.join(", ")
                    );
                    self.flaw(at, problem)
                };
                self.found.unit = own.ok_or_else(flaw)?.1;
            }
            return Ok(Place::Model);
        }
        let is_core = element.prefix() == self.found.prefix;
        match (place, element.local) {
            (Place::Model, "resources") if is_core => Ok(Place::Resources),
            (Place::Model, "build") if is_core => Ok(Place::Build),
            (Place::Resources, "object") if is_core => self.object(element, at),
            (Place::Object, "mesh") if is_core => {
                if self
                    .object_mut()
                    .is_some_and(|object| object.mesh.is_some())
                {
                    return Err(self.flaw(at, "the object has a second mesh"));
                }
                if let Some(object) = self.object_mut() {
                    object.mesh = Some(MeshText::default());
                }
                Ok(Place::Mesh)
            }
            (Place::Object, "components") if is_core => Ok(Place::Components),
            (Place::Components, "component") if is_core => {
                let own = self.used(element, at)?;
                if let Some(object) = self.object_mut() {
                    object.components.push(own);
                }
                Ok(Place::Other)
            }
            (Place::Build, "item") if is_core => {
                let own = self.used(element, at)?;
                self.found.items.push(own);
                Ok(Place::Other)
            }
            (Place::Mesh, "vertices") if is_core => {
                self.once(|mesh| mesh.vertices_at.end == 0, element, at)?;
                if let Some(mesh) = self.mesh_mut() {
                    mesh.vertices_at = end..end;
                }
                Ok(Place::Vertices)
            }
            (Place::Mesh, "triangles") if is_core => {
                self.once(|mesh| mesh.triangles_at.end == 0, element, at)?;
                if let Some(mesh) = self.mesh_mut() {
                    mesh.triangles_at = end..end;
                }
                Ok(Place::Triangles)
            }
            (Place::Mesh, _) => {
                let name = element.name.to_owned();
                if let Some(mesh) = self.mesh_mut() {
                    mesh.others.push(name);
                }
                Ok(Place::Other)
            }
            (Place::Vertices, "vertex") if is_core => {
                let point = self.vertex(element, at)?;
                if let Some(mesh) = self.mesh_mut() {
                    mesh.positions.push(point);
                }
                Ok(Place::Other)
            }
            (Place::Triangles, "triangle") if is_core => {
                self.triangle(element, at)?;
                Ok(Place::Other)
            }
            _ => Ok(Place::Other),
        }
    }

    /// Refuses a list that a mesh has already.
    fn once(
        &mut self,
        is_first: impl Fn(&MeshText) -> bool,
        element: &Element<'a>,
        at: usize,
    ) -> Result<()> {
        if self.mesh_mut().is_some_and(|mesh| !is_first(mesh)) {
            return Err(self.flaw(
                at,
                format!("the mesh has a second list of {}", element.local),
            ));
        }
        Ok(())
    }

    fn close(&mut self, place: Option<Place>, at: usize) {
        let Some(mesh) = self.mesh_mut() else { return };
        match place {
            Some(Place::Vertices) => mesh.vertices_at.end = at,
            Some(Place::Triangles) => mesh.triangles_at.end = at,
            _ => {}
        }
    }

    fn object_mut(&mut self) -> Option<&mut Object> {
        self.found.objects.last_mut()
    }

    fn mesh_mut(&mut self) -> Option<&mut MeshText> {
        self.found.objects.last_mut()?.mesh.as_mut()
    }

    fn object(&mut self, element: &Element<'a>, at: usize) -> Result<Place> {
        let id = self.id(element, "id", at)?;
        let name = attribute(element.attributes, "name").map(super::xml::plain);
        if self
            .found
            .of_id
            .insert(id, self.found.objects.len())
            .is_some()
        {
            return Err(self.flaw(at, format!("there is a second object {id}")));
        }
        self.found.objects.push(Object {
            id,
            name,
            mesh: None,
            components: Vec::new(),
        });
        Ok(Place::Object)
    }

    fn id(&self, element: &Element<'a>, key: &str, at: usize) -> Result<u32> {
        let text = attribute(element.attributes, key);
        let id = text.and_then(|text| text.trim().parse::<u32>().ok());
        id.ok_or_else(|| self.flaw(at, of_attribute(key, text, "a whole number")))
    }

    fn used(&self, element: &Element<'a>, at: usize) -> Result<Use> {
        let transform = match attribute(element.attributes, "transform") {
            None => IDENTITY,
            Some(text) => transform(text).ok_or_else(|| {
                self.flaw(
                    at,
                    of_attribute("transform", Some(text), "twelve finite numbers"),
                )
            })?,
        };
        let part = element.local_attribute("path").map(str::to_owned);
        Ok(Use {
            object: self.id(element, "objectid", at)?,
            part,
            transform,
            at,
        })
    }

    fn vertex(&self, element: &Element<'a>, at: usize) -> Result<[f64; 3]> {
        let mut point = [0.0; 3];
        for (x, key) in point.iter_mut().zip(["x", "y", "z"]) {
            let text = attribute(element.attributes, key);
            let value = text
                .and_then(|text| number(text.trim().as_bytes()))
                .filter(|x| x.is_finite());
            *x = value.ok_or_else(|| self.flaw(at, of_attribute(key, text, "a finite number")))?;
        }
        Ok(point)
    }

    fn triangle(&mut self, element: &Element<'a>, at: usize) -> Result<()> {
        let vertices = self.mesh_mut().map_or(0, |mesh| mesh.positions.len());
        let mut corners = [0; 3];
        for (corner, key) in corners.iter_mut().zip(["v1", "v2", "v3"]) {
            let text = attribute(element.attributes, key);
            let index = text.and_then(|text| text.trim().parse::<u32>().ok());
            *corner = index
                .filter(|&index| (index as usize) < vertices)
                .ok_or_else(|| {
                    let expected = format!("a vertex below {vertices} (their number so far)");
                    self.flaw(at, of_attribute(key, text, &expected))
                })?;
        }
        let has_more = super::xml::attributes(element.attributes).count() > 3;
        let range = element.attributes_at(self.text);
        let Some(mesh) = self.mesh_mut() else {
            return Ok(());
        };
        if has_more && mesh.attributes.is_empty() {
            mesh.attributes.resize(mesh.triangles.len(), 0..0);
        }
        mesh.triangles.push(corners);
        if has_more || !mesh.attributes.is_empty() {
            mesh.attributes.push(if has_more { range } else { 0..0 });
        }
        Ok(())
    }
}

/// What is wrong with an attribute that is missing or not as expected.
fn of_attribute(key: &str, text: Option<&str>, expected: &str) -> String {
    match text {
        None => format!("{key} is missing: expected {expected}"),
        Some(text) => expected_but_found(
            expected,
            &format!("{key}={}", crate::scan::quoted(text.as_bytes())),
        ),
    }
}

/// Twelve numbers: where the axes go, and the origin; points are rows, (x, y, z, 1) times the matrix.
fn transform(text: &str) -> Option<Affine> {
    let mut m = [0.0; 12];
    let mut words = text.split_ascii_whitespace();
    for x in &mut m {
        *x = number(words.next()?.as_bytes()).filter(|x| x.is_finite())?;
    }
    words
        .next()
        .is_none()
        .then(|| std::array::from_fn(|row| std::array::from_fn(|column| m[3 * column + row])))
}
