//! A 3MF package: what it holds, its objects, and their replacement.

use super::container::{ARCHIVE, Container};
use super::edit::{self, NewTriangles, Replacement};
use super::model::{MeshText, Model, Object, Use};
use super::properties::{self, Inherited};
use super::scene::{self, Address};
use super::volumes::{self, Volume};
use super::xml;
use crate::affine::{self, Affine};
use crate::error::{ReadError, WriteError};
use crate::files::read_all;
use crate::flaw::{self, Flaw, shortened};
use crate::format::Format;
use crate::reading::MOST;
use crate::unit::LengthUnit;
use crate::whole::write_whole;
use limitmesh::PolygonSoup;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};

/// A 3MF package with everything that belongs to it.
pub struct Package {
    /// The file, if it was one.
    path: Option<PathBuf>,
    container: Container,
    /// The model parts, the one that is built first.
    models: Vec<Model>,
    /// The objects that have a mesh.
    objects: Vec<Address>,
    /// By these, the matrices by which the build has them.
    placements: Vec<Vec<Affine>>,
    /// The part that lists volumes, and its text.
    settings: Option<(usize, String)>,
    volumes: Vec<Volume>,
    replaced: BTreeMap<usize, Replacement>,
}

/// An object's triangles.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ObjectSoup {
    /// Positions in the object's own coordinates, and triangles.
    pub soup: PolygonSoup,
    /// Whether vertices at one position were made one, but for those of several volumes: these stay apart.
    pub is_joined: bool,
    /// The names of triangles' attributes, apart from their corners.
    pub attributes: Vec<String>,
    /// Whether all triangles have the same of these, and belong to one volume.
    pub is_uniform: bool,
    /// Whether attributes of a triangle depend on where in it something is: properties of corners, or paint in parts.
    pub varies_within: bool,
    /// The mesh's other elements, which name its vertices or triangles by number, such as `b:beamlattice`.
    pub others: Vec<String>,
}

/// The contents of a 3MF package, for people.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PackageContents {
    /// Items that are built.
    pub items: usize,
    /// Objects that are put together from others.
    pub assemblies: usize,
    /// Objects that have a mesh.
    pub objects: Vec<ObjectContents>,
}

/// An object of a 3MF package.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ObjectContents {
    /// As messages call it.
    pub name: String,
    /// Vertices of its mesh.
    pub vertices: usize,
    /// Triangles of its mesh.
    pub triangles: usize,
    /// How often the build has it.
    pub built: usize,
    /// Names of its triangles' properties, apart from corners.
    pub attributes: Vec<String>,
    /// Names of the mesh's other elements.
    pub others: Vec<String>,
}

impl Package {
    /// Opens a `.3mf` file.
    ///
    /// # Errors
    /// The file cannot be read, or the archive, the XML of a model, or what it names breaks the rules.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let package = Self::from_bytes(read_all(path)?).map_err(|error| error.in_file(path))?;
        Ok(Self {
            path: Some(path.to_owned()),
            ..package
        })
    }

    /// A package from the bytes of its file.
    ///
    /// # Errors
    /// As for [`Self::open`].
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, ReadError> {
        let format = Format::ThreeMf;
        if bytes.is_empty() {
            return Err(ReadError::Empty { path: None, format });
        }
        Self::parse(bytes).map_err(|flaw| flaw.read_as(format))
    }

    fn parse(bytes: Vec<u8>) -> flaw::Result<Self> {
        let container = Container::parse(bytes)?;
        let mut read = 0;
        let root = container.root(&mut read)?;
        let (mut models, mut parts) = (Vec::new(), vec![root]);
        let mut of_part: HashMap<usize, usize> = HashMap::new();
        while let Some(part) = parts.pop() {
            let model = Model::parse(part, container.name(part), container.text(part, &mut read)?)?;
            of_part.insert(part, models.len());
            let components = model.objects.iter().flat_map(|object| &object.components);
            for own in components.chain(&model.items) {
                let named = own.part.as_deref().and_then(|part| container.find(part));
                let is_new = |part: &usize| !of_part.contains_key(part) && !parts.contains(part);
                parts.extend(named.filter(is_new));
            }
            models.push(model);
        }
        let mut objects = Vec::new();
        for (model, own) in models.iter().enumerate() {
            let mesh = |object: &Object| object.mesh.as_ref().map(|mesh| mesh.triangles.len());
            let has_mesh = |&object: &usize| mesh(&own.objects[object]).unwrap_or(0) > 0;
            let numbers = (0..own.objects.len()).filter(has_mesh);
            objects.extend(numbers.map(|object| Address { model, object }));
        }
        let numbers = objects.iter().enumerate();
        let numbers = numbers.map(|(number, &address)| (address, number));
        let of_address: HashMap<Address, usize> = numbers.collect();
        let find = |model: usize, own: &Use| {
            let model = match &own.part {
                Some(part) => *of_part.get(&container.find(part)?)?,
                None => model,
            };
            let object = *models[model].of_id.get(&own.object)?;
            Some(Address { model, object })
        };
        let mut placements = vec![Vec::new(); objects.len()];
        scene::walk(&models, &find, &mut |address, matrix| {
            if let Some(&object) = of_address.get(&address) {
                placements[object].push(*matrix);
            }
        })?;
        let settings = match container.find(volumes::PART) {
            Some(part) => Some((part, container.text(part, &mut read)?)),
            None => None,
        };
        let all = settings.iter().flat_map(|(_, text)| volumes::parse(text));
        let volumes = all.collect();
        Ok(Self {
            path: None,
            container,
            models,
            objects,
            placements,
            settings,
            volumes,
            replaced: BTreeMap::new(),
        })
    }

    /// Number of objects that have a mesh.
    pub fn object_count(&self) -> usize {
        self.objects.len()
    }

    /// The unit of its numbers.
    pub fn unit(&self) -> LengthUnit {
        self.models[0].unit
    }

    /// An object as it is called in messages: `object 3 'Wheel'`, with its part where that is not the one that is built.
    pub fn object_name(&self, object: usize) -> String {
        let Some(&address) = self.objects.get(object) else {
            return format!("object {object}");
        };
        let model = &self.models[address.model];
        let found = &model.objects[address.object];
        let mut words = format!("object {}", found.id);
        if let Some(name) = found.name.as_ref().filter(|name| !name.is_empty()) {
            words += &format!(" '{}'", shortened(&name.escape_debug().to_string()));
        }
        if address.model != 0 {
            words += &format!(" of {}", model.name);
        }
        words
    }

    /// How many times longer the build has a vector of an object at most: the greatest singular value of the matrices by which items
    /// and components place it; 1 for objects that are not built.
    pub fn stretch(&self, object: usize) -> f64 {
        let all = self.placements.get(object).into_iter().flatten();
        affine::usable(all.map(affine::greatest_stretch).fold(0.0, f64::max))
    }

    /// The linear map of an object's vectors in the build, where it is largest, by rows: x' = row · x.
    pub fn largest(&self, object: usize) -> [[f64; 3]; 3] {
        let all = self.placements.get(object).into_iter().flatten();
        affine::linear(affine::largest(all))
    }

    fn mesh(&self, object: usize) -> Option<(&Model, &Object, &MeshText)> {
        let address = self.objects.get(object)?;
        let model = &self.models[address.model];
        let found = &model.objects[address.object];
        Some((model, found, found.mesh.as_ref()?))
    }

    /// The volumes of an object; none where it is one.
    fn volumes_of(&self, object: usize) -> Vec<&Volume> {
        let is_of_root = |_: &_| self.objects[object].model == 0;
        let Some((_, found, mesh)) = self.mesh(object).filter(is_of_root) else {
            return Vec::new();
        };
        let count = mesh.triangles.len() as u64;
        let is_own = |own: &&Volume| {
            let [first, last] = [own.first.value, own.last.value];
            own.object == found.id && first <= last && u64::from(last) < count
        };
        self.volumes.iter().filter(is_own).collect()
    }

    /// The triangles of an object; nothing if there is none of that number. With `join`, vertices at one position are one in objects
    /// of several volumes, within each of these.
    pub fn object(&self, object: usize, join: bool) -> ObjectSoup {
        let Some((model, _, mesh)) = self.mesh(object) else {
            return ObjectSoup::default();
        };
        let volumes = self.volumes_of(object);
        let mut found = ObjectSoup {
            others: mesh.others.clone(),
            ..ObjectSoup::default()
        };
        let (mut positions, mut triangles) = (mesh.positions.clone(), mesh.triangles.clone());
        if join && volumes.len() > 1 {
            (positions, triangles) = apart(mesh, &volumes);
            found.is_joined = true;
        }
        found.soup.positions = positions;
        for triangle in triangles.iter() {
            found.soup.faces.push(triangle);
        }
        let text = |at: &std::ops::Range<u32>| &model.text[at.start as usize..at.end as usize];
        let mut names = BTreeSet::new();
        found.is_uniform = volumes.len() < 2;
        for at in &mesh.attributes {
            let own = properties::beside_corners(text(at));
            found.is_uniform &= own.eq(properties::beside_corners(text(&mesh.attributes[0])));
            found.varies_within |= properties::varies_within(text(at));
            let own = xml::attributes(text(at)).map(|own| own.name);
            names.extend(own.filter(|name| !["v1", "v2", "v3"].contains(name)));
        }
        found.attributes = names.into_iter().map(str::to_owned).collect();
        found
    }

    /// The corners of the box around everything that is built; `None` if nothing is.
    ///
    /// # Errors
    /// There are more vertices than can be counted.
    pub fn bounding_box(&self) -> Result<Option<[[f64; 3]; 2]>, ReadError> {
        self.check_size()?;
        let placed = self
            .placements
            .iter()
            .enumerate()
            .flat_map(|(object, placements)| {
                let found = self.mesh(object);
                let positions = found.map_or(&[][..], |(_, _, mesh)| &mesh.positions);
                let of = |m| positions.iter().map(move |&p| affine::apply(m, p));
                placements.iter().flat_map(of)
            });
        Ok(affine::bounding_box(placed))
    }

    fn check_size(&self) -> Result<(), ReadError> {
        let size = |(object, placements): (usize, &Vec<Affine>)| {
            let mesh = self.mesh(object).map(|(_, _, mesh)| mesh);
            let most = mesh.map_or(0, |mesh| mesh.positions.len().max(mesh.triangles.len()));
            placements.len().saturating_mul(most)
        };
        let sizes = self.placements.iter().enumerate().map(size);
        if sizes.fold(0, usize::saturating_add) <= MOST {
            return Ok(());
        }
        let problem = format!("with all items there are more than {MOST} vertices or triangles");
        let flaw = Flaw::saying(ARCHIVE, problem);
        Err(ReadError::Flaw {
            path: self.path.clone(),
            format: Format::ThreeMf,
            flaw,
        })
    }

    /// Everything that is built as one soup, in its coordinates, and in words what else there is.
    ///
    /// # Errors
    /// There are more vertices than can be counted.
    pub fn scene_soup(&self) -> Result<PolygonSoup, ReadError> {
        self.check_size()?;
        let mut all = PolygonSoup::default();
        let mut names = BTreeSet::new();
        for (object, placements) in self.placements.iter().enumerate() {
            let Some((_, _, mesh)) = self.mesh(object) else {
                continue;
            };
            names.extend(self.object(object, false).attributes);
            for m in placements {
                let first = all.positions.len() as u32;
                all.positions
                    .extend(mesh.positions.iter().map(|&p| affine::apply(m, p)));
                for triangle in &mesh.triangles {
                    let mut corners = triangle.map(|v| v + first);
                    if affine::mirrors(m) {
                        corners.swap(1, 2);
                    }
                    all.faces.push(&corners);
                }
            }
        }
        if !names.is_empty() {
            let names: Vec<String> = names.into_iter().collect();
            all.left_out
                .push(format!("properties of triangles {}", names.join(", ")));
        }
        Ok(all)
    }

    /// The objects of the package, and how it puts them together.
    pub fn contents(&self) -> PackageContents {
        let object = |object: usize| {
            let mesh = self.mesh(object).map(|(_, _, mesh)| mesh);
            let ObjectSoup {
                attributes, others, ..
            } = self.object(object, false);
            ObjectContents {
                name: self.object_name(object),
                vertices: mesh.map_or(0, |mesh| mesh.positions.len()),
                triangles: mesh.map_or(0, |mesh| mesh.triangles.len()),
                built: self.placements[object].len(),
                attributes,
                others,
            }
        };
        let assemblies = self.models.iter().flat_map(|model| &model.objects);
        PackageContents {
            objects: (0..self.object_count()).map(object).collect(),
            assemblies: assemblies.filter(|own| !own.components.is_empty()).count(),
            items: self.models[0].items.len(),
        }
    }

    /// Replaces the triangles of an object; reports what attributes lost.
    ///
    /// # Errors
    /// There is no such object, the triangles do not fit together, or nothing is left of a volume.
    pub fn replace(&mut self, object: usize, new: &NewTriangles<'_>) -> Result<Inherited, Flaw> {
        let Some((model, _, mesh)) = self.mesh(object) else {
            let count = self.object_count();
            let problem = format!("object number {object} is named, but there are {count}");
            return Err(Flaw::saying(ARCHIVE, problem));
        };
        let mut losses = Inherited::default();
        let volumes = self.volumes_of(object);
        let replacement = Replacement::new(model, mesh, &volumes, new, &mut losses)?;
        self.replaced.insert(object, replacement);
        Ok(losses)
    }

    /// The package with what was replaced.
    ///
    /// # Errors
    /// The archive cannot be put together.
    pub fn to_bytes(&self) -> Result<Vec<u8>, WriteError> {
        let mut texts = BTreeMap::new();
        let replaced = || {
            let all = self.replaced.iter();
            all.map(|(&object, new)| (self.objects[object], new))
        };
        for (number, model) in self.models.iter().enumerate() {
            let own = replaced().filter(|(address, _)| address.model == number);
            let own: BTreeMap<usize, _> = own.map(|(own, new)| (own.object, new)).collect();
            if !own.is_empty() {
                texts.insert(model.part, edit::edited(model, &own));
            }
        }
        if let Some((part, text)) = &self.settings {
            let edited = volumes::edited(text, &self.volumes, |own| {
                let object = *self.models[0].of_id.get(&own.object)?;
                let address = Address { model: 0, object };
                let (_, new) = replaced().find(|(own, _)| *own == address)?;
                new.volumes.get(&[own.first.value, own.last.value]).copied()
            });
            if edited != *text {
                texts.insert(*part, edited);
            }
        }
        let bytes = self.container.with(&texts);
        bytes.map_err(|why| std::io::Error::other(why).into())
    }

    /// Writes the package with what was replaced, whole or not at all.
    ///
    /// # Errors
    /// The archive cannot be put together, or the system refuses.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        write_whole(path, &self.to_bytes().map_err(|error| error.in_file(path))?)
    }
}

/// Vertices and triangles where vertices at one position are one within a volume, and none belongs to several.
fn apart(mesh: &MeshText, volumes: &[&Volume]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut numbers: HashMap<(usize, [u64; 3]), u32> = HashMap::new();
    let mut positions = Vec::with_capacity(mesh.positions.len());
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for (face, triangle) in mesh.triangles.iter().enumerate() {
        let is_own = |own: &&Volume| (own.first.value..=own.last.value).contains(&(face as u32));
        // All that is in no volume is one more.
        let volume = volumes.iter().position(is_own).unwrap_or(volumes.len());
        triangles.push(triangle.map(|v| {
            let position = mesh.positions[v as usize];
            // Zero has two signs.
            let key = position.map(|x| (x + 0.0).to_bits());
            *numbers.entry((volume, key)).or_insert_with(|| {
                positions.push(position);
                positions.len() as u32 - 1
            })
        }));
    }
    (positions, triangles)
}
