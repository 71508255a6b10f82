//! What files of a format can hold, as each format says of itself, and whether an output fits into it.

use crate::channels::NORMALS;
use crate::error::WriteError;
use crate::format::Format;
use crate::output::{Output, Property, PropertyValues};
use limitmesh::mesh::{Channel, Triangles};

/// Whether something is held, and how exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Held {
    No,
    /// Rounded to `f32`.
    Single,
    Double,
}

/// What files of a format can hold beside positions and triangles.
#[derive(Clone, Copy)]
pub(crate) struct Capacity {
    /// How coordinates are held.
    pub(crate) coordinates: Held,
    /// How normals of vertices are held.
    pub(crate) normals: Held,
    /// Whether quality and named properties are held, and names of pictures.
    pub(crate) properties: bool,
    /// Whether names end with their lines, so that they can have no line break.
    pub(crate) names_on_lines: bool,
    /// Whether libraries of materials and pictures are named, and so copied to the file's folder.
    pub(crate) names_files: bool,
    /// Whether a channel, but for [`NORMALS`], is held.
    pub(crate) channel: fn(&Channel) -> bool,
}

impl Capacity {
    /// For positions at full precision, and some channels.
    pub(crate) fn of_channels(channel: fn(&Channel) -> bool) -> Self {
        Self {
            coordinates: Held::Double,
            normals: Held::No,
            properties: false,
            names_on_lines: false,
            names_files: false,
            channel,
        }
    }

    /// Whether files have a place for a channel.
    pub(crate) fn holds(&self, channel: &Channel) -> bool {
        channel.name != NORMALS && (self.channel)(channel)
    }

    /// The channels of an output that files have a place for.
    pub(crate) fn held<'a>(&self, output: &Output<'a>) -> Vec<&'a Channel> {
        output
            .channels
            .iter()
            .filter(|channel| self.holds(channel))
            .collect()
    }

    /// Checks that the parts of an output fit together and into files of this format.
    pub(crate) fn check(&self, output: &Output<'_>, format: Format) -> Result<(), WriteError> {
        let check = Check {
            capacity: self,
            output,
            format,
        };
        check.counts()?;
        check.indices()?;
        check.numbers()?;
        check.rounding()?;
        check.channels()?;
        check.names()?;
        if self.properties {
            let Triangles {
                positions,
                triangles,
            } = output.surface;
            let taken = [
                "x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "quality",
            ]
            .as_slice();
            check.properties(output.vertex_properties, taken, positions.len(), "vertex")?;
            let taken = &["vertex_indices"];
            check.properties(output.face_properties, taken, triangles.len(), "triangle")?;
        }
        Ok(())
    }
}

struct Check<'a> {
    capacity: &'a Capacity,
    output: &'a Output<'a>,
    format: Format,
}

impl Check<'_> {
    fn counts(&self) -> Result<(), WriteError> {
        let Triangles {
            positions,
            triangles,
        } = self.output.surface;
        let (vertices, normals) = (
            positions.len(),
            self.output.vertex_normals().map(<[_]>::len),
        );
        each_needs_one("normals", normals, vertices, "vertices")?;
        each_needs_one(
            "colours",
            self.output.colours.map(<[_]>::len),
            vertices,
            "vertices",
        )?;
        let quality = self.output.quality.map(<[_]>::len);
        each_needs_one("quality values", quality, vertices, "vertices")?;
        let corners = self.output.corner_normals.map(<[_]>::len);
        each_needs_one("corner normals", corners, triangles.len(), "triangles")?;
        let normals = self.output.normals.map_or(0, <[_]>::len);
        let counts = [
            ("vertices", vertices),
            ("triangles", triangles.len()),
            ("normals", normals),
        ];
        let (limit, format) = (u32::MAX, self.format);
        match counts
            .into_iter()
            .find(|&(_, count)| count > limit as usize)
        {
            Some((what, count)) => Err(WriteError::TooMany {
                what,
                count,
                limit,
                format,
            }),
            None => Ok(()),
        }
    }

    fn indices(&self) -> Result<(), WriteError> {
        let Output {
            creases, corners, ..
        } = self.output;
        let Triangles {
            positions,
            triangles,
        } = self.output.surface;
        let vertices = positions.len();
        all_exist("triangle", triangles, "vertex", vertices)?;
        let ends: Vec<[u32; 2]> = creases.iter().map(|tag| tag.vertices).collect();
        all_exist("crease tag", &ends, "vertex", vertices)?;
        let tagged: Vec<[u32; 1]> = corners.iter().map(|tag| [tag.vertex]).collect();
        all_exist("corner tag", &tagged, "vertex", vertices)?;
        let normals = self.output.normals.map_or(0, <[_]>::len);
        all_exist(
            "triangle",
            self.output.corner_normals.unwrap_or_default(),
            "normal",
            normals,
        )
    }

    /// Refuses what the readers of files refuse: NaN and infinity, also where they come of rounding to `f32`.
    fn numbers(&self) -> Result<(), WriteError> {
        let Capacity {
            coordinates,
            normals,
            properties,
            ..
        } = *self.capacity;
        let positions = self.output.surface.positions.as_flattened();
        self.finite("position", positions, 3, coordinates, "vertex")?;
        let own = self.output.normals.unwrap_or_default().as_flattened();
        self.finite("normal", own, 3, normals, "vertex")?;
        let held = if properties { Held::Double } else { Held::No };
        self.finite(
            "quality",
            self.output.quality.unwrap_or_default(),
            1,
            held,
            "vertex",
        )
    }

    fn finite(
        &self,
        what: &str,
        values: &[f64],
        width: usize,
        held: Held,
        of: &'static str,
    ) -> Result<(), WriteError> {
        let failing = match held {
            Held::No => None,
            Held::Single => first_failing(values, |&x| (x as f32).is_finite()),
            Held::Double => first_failing(values, |x| x.is_finite()),
        };
        let Some(at) = failing else { return Ok(()) };
        let (what, element, value, format) = (what.to_owned(), at / width, values[at], self.format);
        Err(WriteError::NotFinite {
            what,
            of,
            element,
            value,
            format,
        })
    }

    /// Refuses triangles of which none is left when coordinates are rounded.
    fn rounding(&self) -> Result<(), WriteError> {
        let Triangles {
            positions,
            triangles,
        } = self.output.surface;
        let is_left = |round: fn(f64) -> f64| {
            let at = |vertex: u32| positions[vertex as usize].map(round);
            let mut corners = triangles.iter().map(|triangle| triangle.map(at));
            corners.any(|[a, b, c]| a != b && b != c && c != a)
        };
        if self.capacity.coordinates == Held::Single
            && !triangles.is_empty()
            && !is_left(|x| f64::from(x as f32))
            && is_left(|x| x)
        {
            let (triangles, format) = (triangles.len(), self.format);
            return Err(WriteError::Rounded { triangles, format });
        }
        Ok(())
    }

    fn channels(&self) -> Result<(), WriteError> {
        let Triangles {
            positions,
            triangles,
        } = self.output.surface;
        for channel in self.capacity.held(self.output) {
            channel.check(positions.len(), 3 * triangles.len(), triangles.len())?;
            if channel.value_count() == 0 && !positions.is_empty() {
                let name = channel.name.clone();
                return Err(WriteError::NoValues { name });
            }
        }
        Ok(())
    }

    /// Refuses names that would be several lines.
    fn names(&self) -> Result<(), WriteError> {
        let Output {
            channels,
            material_libraries,
            texture_files,
            ..
        } = self.output;
        let labels = channels.iter().flat_map(|channel| &channel.labels);
        let names = labels
            .chain(*material_libraries)
            .filter(|_| self.capacity.names_on_lines);
        let pictures = texture_files.iter().filter(|_| self.capacity.properties);
        match names
            .chain(pictures)
            .find(|name| name.contains(['\n', '\r']))
        {
            Some(name) => {
                let (name, format) = (name.clone(), self.format);
                Err(WriteError::LineBreak { name, format })
            }
            None => Ok(()),
        }
    }

    fn properties(
        &self,
        properties: &[Property<'_>],
        taken: &[&str],
        elements: usize,
        of: &'static str,
    ) -> Result<(), WriteError> {
        for (i, property) in properties.iter().enumerate() {
            let name = property.name;
            let visible = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic());
            let is_known = properties[..i].iter().any(|other| other.name == name);
            if !visible || taken.contains(&name) || is_known {
                let name = name.to_owned();
                return Err(WriteError::PropertyName { name });
            }
            let what = format!("numbers of property '{name}'");
            let all = if of == "vertex" {
                "vertices"
            } else {
                "triangles"
            };
            each_needs_one(&what, Some(property.count()), elements, all)?;
            if let PropertyValues::Numbers(values) = property.values {
                self.finite(&format!("property '{name}'"), values, 1, Held::Double, of)?;
            }
        }
        Ok(())
    }
}

/// Refuses another count than the number of elements.
fn each_needs_one(
    what: &str,
    count: Option<usize>,
    elements: usize,
    of: &'static str,
) -> Result<(), WriteError> {
    let Some(count) = count.filter(|&count| count != elements) else {
        return Ok(());
    };
    let what = what.to_owned();
    Err(WriteError::Count {
        what,
        count,
        elements,
        of,
    })
}

/// Refuses groups of indices of which one is not below a count.
fn all_exist<const N: usize>(
    what: &'static str,
    groups: &[[u32; N]],
    of: &'static str,
    count: usize,
) -> Result<(), WriteError> {
    let exists = |&named: &u32| (named as usize) < count;
    let Some(index) = first_failing(groups, |group| group.iter().all(exists)) else {
        return Ok(());
    };
    match groups[index].iter().find(|named| !exists(named)) {
        Some(&named) => Err(WriteError::OutOfRange {
            what,
            index,
            of,
            named,
            count,
        }),
        None => Ok(()),
    }
}

/// Items that are checked together.
const CHECKED: usize = 1 << 12;

/// The number of the first item that fails.
fn first_failing<T: Sync>(items: &[T], passes: impl Fn(&T) -> bool + Sync + Send) -> Option<usize> {
    // No early end within some: then many are looked at in one step.
    let fails = |some: &[T]| !some.iter().fold(true, |all, item| all & passes(item));
    #[cfg(feature = "parallel")]
    let some = {
        use rayon::prelude::*;
        items.par_chunks(CHECKED).position_first(fails)
    };
    #[cfg(not(feature = "parallel"))]
    let some = items.chunks(CHECKED).position(fails);
    let start = CHECKED * some?;
    let at = items[start..].iter().position(|item| !passes(item))?;
    Some(start + at)
}
