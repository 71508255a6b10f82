//! 3MF: a package is opened, the triangles of its objects are taken out and replaced, and everything else stays as it was.
//!
//! ```text
//! file ─▶ Container ─▶ Model ─▶ ObjectSoup ─▶ (refinement) ─▶ NewTriangles ─▶ Replacement ─▶ file
//!         ZIP parts    XML text                               sources         edited text
//! ```
//!
//! A package holds what a print needs beside its triangles: materials, build plates, slicers' settings, pictures. So it is *edited,
//! never written anew*: all parts but models are copied as they are, and of a model's text only what stands between the tags of
//! `<vertices>` and `<triangles>` changes. Triangles inherit the attributes of the one that they came from.
//!
//! What a package says of itself is not believed: parts are unpacked to a stated size at most, every index is checked, and a flaw
//! names the part, the line and the object.

mod container;
mod edit;
mod flaw;
mod fresh;
mod model;
mod paint;
mod properties;
mod scene;
mod volumes;
mod xml;

pub use edit::NewTriangles;
pub use flaw::PackageFlaw;
pub(crate) use fresh::write_fresh;
pub use model::LengthUnit;
pub use properties::{Inherited, Source};

use crate::affine::{self, Affine};
use crate::error::{ReadError, WriteError};
use crate::format::Format;
use crate::read::read_all;
use container::Container;
use edit::Replacement;
use flaw::Result as Flawed;
use limitmesh::PolygonSoup;
use model::{MeshText, Model, Use};
use scene::Place;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use volumes::Volume;

/// A 3MF package with everything that belongs to it.
pub struct Package {
    /// The file, if it was one.
    path: Option<PathBuf>,
    container: Container,
    /// The model parts, the one that is built first.
    models: Vec<Model>,
    /// The objects that have a mesh.
    objects: Vec<Place>,
    /// By these, the matrices by which the build has them.
    placements: Vec<Vec<Affine>>,
    /// The part that tells volumes from each other, and its text.
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
    /// The names of attributes that triangles have beside their corners.
    pub attributes: Vec<String>,
    /// Whether all triangles have the same of these, and belong to one volume.
    pub is_uniform: bool,
    /// Whether attributes of a triangle depend on where in it something is: properties of corners, or paint in parts.
    pub varies_within: bool,
    /// What else the mesh has, which names its vertices or triangles by number, such as `b:beamlattice`.
    pub others: Vec<String>,
}

/// What a package holds, for people.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PackageContents {
    /// All objects that have a mesh.
    pub objects: Vec<ObjectContents>,
    /// Objects that are put together from others.
    pub assemblies: usize,
    /// Items that are built.
    pub items: usize,
    /// What numbers are measured in.
    pub unit: LengthUnit,
}

/// What an object holds.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ObjectContents {
    /// As it is called in messages.
    pub name: String,
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// How often the build has it.
    pub built: usize,
    /// The names of what its triangles have beside corners.
    pub attributes: Vec<String>,
    /// What else its mesh has.
    pub others: Vec<String>,
}

/// Vertices or triangles at most of a soup.
const MOST: usize = u32::MAX as usize;

impl Package {
    /// Opens a `.3mf` file.
    ///
    /// # Errors
    /// The file cannot be read, or the archive, the XML of a model, or what it names breaks the rules.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let bytes = read_all(path).map_err(|reason| ReadError::Io {
            path: path.to_owned(),
            reason,
        })?;
        let package = Self::from_bytes(bytes).map_err(|error| error.in_file(path))?;
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
        if bytes.is_empty() {
            return Err(ReadError::Empty {
                path: None,
                format: Format::ThreeMf,
            });
        }
        Self::parse(bytes).map_err(|flaw| ReadError::Package {
            path: None,
            flaw: Box::new(flaw),
        })
    }

    fn parse(bytes: Vec<u8>) -> Flawed<Self> {
        let container = Container::parse(bytes)?;
        let mut read = 0;
        let root = container.root(&mut read)?;
        let (mut models, mut parts) = (Vec::new(), vec![root]);
        let mut of_part: HashMap<usize, usize> = HashMap::new();
        while let Some(part) = parts.pop() {
            let name = container.name(part).to_owned();
            let model = Model::parse(part, &name, container.text(part, &mut read)?)?;
            of_part.insert(part, models.len());
            let uses = model
                .objects
                .iter()
                .flat_map(|object| &object.components)
                .chain(&model.items);
            for named in uses.filter_map(|own| container.find(own.part.as_deref()?)) {
                if !of_part.contains_key(&named) && !parts.contains(&named) {
                    parts.push(named);
                }
            }
            models.push(model);
        }
        let mut objects = Vec::new();
        for (number, model) in models.iter().enumerate() {
            let has_mesh = |object: &model::Object| {
                object
                    .mesh
                    .as_ref()
                    .is_some_and(|own| !own.triangles.is_empty())
            };
            let own = model
                .objects
                .iter()
                .enumerate()
                .filter(|(_, object)| has_mesh(object));
            objects.extend(own.map(|(object, _)| (number, object)));
        }
        let of_place: HashMap<Place, usize> = objects
            .iter()
            .enumerate()
            .map(|(i, &place)| (place, i))
            .collect();
        let find = |model: usize, own: &Use| {
            let model = match &own.part {
                Some(part) => *of_part.get(&container.find(part)?)?,
                None => model,
            };
            Some((model, *models[model].of_id.get(&own.object)?))
        };
        let mut placements = vec![Vec::new(); objects.len()];
        scene::walk(&models, &find, &mut |place, matrix| {
            if let Some(&object) = of_place.get(&place) {
                placements[object].push(*matrix);
            }
        })?;
        let settings = match container.find(volumes::PART) {
            Some(part) => Some((part, container.text(part, &mut read)?)),
            None => None,
        };
        let volumes = settings
            .as_ref()
            .map_or_else(Vec::new, |(_, text)| volumes::parse(text));
        let replaced = BTreeMap::new();
        Ok(Self {
            path: None,
            container,
            models,
            objects,
            placements,
            settings,
            volumes,
            replaced,
        })
    }

    /// Number of objects that have a mesh.
    pub fn object_count(&self) -> usize {
        self.objects.len()
    }

    /// What its numbers are measured in.
    pub fn unit(&self) -> LengthUnit {
        self.models
            .first()
            .map_or_else(LengthUnit::default, |model| model.unit)
    }

    /// An object as it is called in messages: `object 3 'Wheel'`, with its part where that is not the one that is built.
    pub fn object_name(&self, object: usize) -> String {
        let Some(&(model, own)) = self.objects.get(object) else {
            return format!("object {object}");
        };
        let found = &self.models[model].objects[own];
        let name = found.name.as_ref().filter(|name| !name.is_empty());
        let name = name.map_or_else(String::new, |name| format!(" '{}'", shortened(name)));
        let part = if model == 0 {
            String::new()
        } else {
            format!(" of {}", self.models[model].name)
        };
        format!("object {}{name}{part}", found.id)
    }

    /// How many times longer the build has a vector of an object at most: the greatest singular value of the matrices by which items
    /// and components place it; 1 for objects that are not built.
    pub fn stretch(&self, object: usize) -> f64 {
        let all = self.placements.get(object).into_iter().flatten();
        let most = all.map(affine::greatest_stretch).fold(0.0, f64::max);
        if most > 0.0 && most.is_finite() {
            most
        } else {
            1.0
        }
    }

    /// What the build does to vectors of an object where it is largest, by rows: x' = row · x.
    pub fn largest(&self, object: usize) -> [[f64; 3]; 3] {
        affine::linear(affine::largest(
            self.placements.get(object).into_iter().flatten(),
        ))
    }

    fn mesh(&self, object: usize) -> Option<(&Model, &model::Object, &MeshText)> {
        let &(model, own) = self.objects.get(object)?;
        let found = &self.models[model].objects[own];
        Some((&self.models[model], found, found.mesh.as_ref()?))
    }

    /// The volumes of an object; none where it is one.
    fn volumes_of(&self, object: usize) -> Vec<&Volume> {
        let Some((_, found, mesh)) = self.mesh(object).filter(|_| self.objects[object].0 == 0)
        else {
            return Vec::new();
        };
        let is_own = |own: &&Volume| {
            own.object == found.id
                && own.first <= own.last
                && (own.last as usize) < mesh.triangles.len()
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
        triangles
            .iter()
            .for_each(|triangle| found.soup.faces.push(triangle));
        let text = |at: &std::ops::Range<u32>| &model.text[at.start as usize..at.end as usize];
        let mut names = BTreeSet::new();
        found.is_uniform = volumes.len() < 2;
        for at in &mesh.attributes {
            let own = properties::beside_corners(text(at));
            found.is_uniform &= own.eq(properties::beside_corners(text(&mesh.attributes[0])));
            found.varies_within |= properties::varies_within(text(at));
            names.extend(
                xml::attributes(text(at))
                    .map(|own| own.name)
                    .filter(|name| !["v1", "v2", "v3"].contains(name)),
            );
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
        let mut found: Option<[[f64; 3]; 2]> = None;
        for (object, placements) in self.placements.iter().enumerate() {
            let positions = self
                .mesh(object)
                .map_or(&[][..], |(_, _, mesh)| &mesh.positions);
            for point in placements
                .iter()
                .flat_map(|m| positions.iter().map(|&p| affine::apply(m, p)))
            {
                let [low, high] = found.get_or_insert([point, point]);
                (0..3).for_each(|i| {
                    (low[i], high[i]) = (low[i].min(point[i]), high[i].max(point[i]))
                });
            }
        }
        Ok(found)
    }

    fn check_size(&self) -> Result<(), ReadError> {
        let sizes = self
            .placements
            .iter()
            .enumerate()
            .map(|(object, placements)| {
                let most = self.mesh(object).map_or(0, |(_, _, mesh)| {
                    mesh.positions.len().max(mesh.triangles.len())
                });
                placements.len().saturating_mul(most)
            });
        if sizes.fold(0, usize::saturating_add) <= MOST {
            return Ok(());
        }
        let problem = format!("with all items there are more than {MOST} vertices or triangles");
        let flaw = Box::new(PackageFlaw::of_archive(problem));
        Err(ReadError::Package {
            path: self.path.clone(),
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
                for &[a, b, c] in &mesh.triangles {
                    let corners = if affine::mirrors(m) {
                        [a, c, b]
                    } else {
                        [a, b, c]
                    };
                    all.faces.push(&corners.map(|v| v + first));
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

    /// What the package holds.
    pub fn contents(&self) -> PackageContents {
        let object = |object: usize| {
            let (vertices, triangles) = self.mesh(object).map_or((0, 0), |(_, _, mesh)| {
                (mesh.positions.len(), mesh.triangles.len())
            });
            let ObjectSoup {
                attributes, others, ..
            } = self.object(object, false);
            let built = self.placements[object].len();
            ObjectContents {
                name: self.object_name(object),
                vertices,
                triangles,
                built,
                attributes,
                others,
            }
        };
        let assemblies = self.models.iter().flat_map(|model| &model.objects);
        PackageContents {
            objects: (0..self.object_count()).map(object).collect(),
            assemblies: assemblies.filter(|own| !own.components.is_empty()).count(),
            items: self.models.first().map_or(0, |model| model.items.len()),
            unit: self.unit(),
        }
    }

    /// Replaces the triangles of an object; tells what attributes lost.
    ///
    /// # Errors
    /// There is no such object, the triangles do not fit together, or nothing is left of a volume.
    pub fn replace(
        &mut self,
        object: usize,
        new: &NewTriangles<'_>,
    ) -> Result<Inherited, PackageFlaw> {
        let Some((model, _, mesh)) = self.mesh(object) else {
            let count = self.object_count();
            return Err(PackageFlaw::of_archive(format!(
                "object number {object} is named, but there are {count}"
            )));
        };
        let volumes = self.volumes_of(object);
        let (replacement, told) = Replacement::new(model, mesh, &volumes, new)?;
        self.replaced.insert(object, replacement);
        Ok(told)
    }

    /// The package with what was replaced.
    ///
    /// # Errors
    /// The archive cannot be put together.
    pub fn to_bytes(&self) -> Result<Vec<u8>, WriteError> {
        let mut texts = BTreeMap::new();
        for (number, model) in self.models.iter().enumerate() {
            let own = self
                .replaced
                .iter()
                .filter(|(object, _)| self.objects[**object].0 == number);
            let own: BTreeMap<usize, &Replacement> = own
                .map(|(&object, new)| (self.objects[object].1, new))
                .collect();
            if !own.is_empty() {
                texts.insert(model.part, edit::edited(model, &own));
            }
        }
        if let Some((part, text)) = &self.settings {
            let new = |own: &Volume| {
                let object = self.objects.iter().position(|&(model, object)| {
                    model == 0 && self.models[0].objects[object].id == own.object
                })?;
                self.replaced
                    .get(&object)?
                    .volumes
                    .get(&[own.first, own.last])
                    .copied()
            };
            let edited = volumes::edited(text, &self.volumes, &new);
            if edited != *text {
                texts.insert(*part, edited);
            }
        }
        self.container
            .with(&texts)
            .map_err(|why| WriteError::Writer {
                reason: std::io::Error::other(why),
            })
    }

    /// Writes the package with what was replaced, whole or not at all.
    ///
    /// # Errors
    /// The archive cannot be put together, or the system refuses.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        crate::write::write_whole(path, &self.to_bytes().map_err(|error| error.in_file(path))?)
    }
}

/// A name as it may stand in a message.
fn shortened(name: &str) -> String {
    const LONGEST: usize = 60;
    let mut text: String = name
        .chars()
        .take(LONGEST)
        .flat_map(char::escape_debug)
        .collect();
    if name.chars().nth(LONGEST).is_some() {
        text.push('…');
    }
    text
}

/// Vertices and triangles where vertices at one position are one within a volume, and none belongs to several.
fn apart(mesh: &MeshText, volumes: &[&Volume]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut numbers: HashMap<(usize, [u64; 3]), u32> = HashMap::new();
    let mut positions = Vec::with_capacity(mesh.positions.len());
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for (face, triangle) in mesh.triangles.iter().enumerate() {
        let is_own = |own: &&Volume| (own.first as usize..=own.last as usize).contains(&face);
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
