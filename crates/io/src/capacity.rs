//! The capacity of a format's files, as each format declares it, and whether an output fits into it.

use crate::channels::NORMALS;
use crate::error::WriteError;
use crate::format::Format;
use crate::output::{Output, Property, PropertyValues};
use crate::reading::MOST;
use limitmesh::HalfEdgeId;
use limitmesh::mesh::Channel;

/// Whether something is held, and how exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Held {
    No,
    /// Rounded to `f32`.
    Single,
    Double,
}

/// The capacity of a format's files, apart from positions and triangles.
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
        let all = output.channels.iter().filter(|channel| self.holds(channel));
        all.collect()
    }

    /// Checks that the parts of an output fit together and into files of this format.
    pub(crate) fn check(&self, output: &Output<'_>, format: Format) -> Result<(), WriteError> {
        let vertices = output.surface.positions.len();
        let triangles = output.surface.triangles.len();
        let capacity = self;
        let check = Check {
            capacity,
            output,
            format,
            vertices,
            triangles,
        };
        check.all().map_err(|problem| WriteError::Unfit { problem })
    }
}

/// Nothing, or a problem in words.
type Checked = Result<(), String>;

struct Check<'a> {
    capacity: &'a Capacity,
    output: &'a Output<'a>,
    format: Format,
    /// How many there are.
    vertices: usize,
    triangles: usize,
}

impl Check<'_> {
    fn all(&self) -> Checked {
        self.counts()?;
        self.indices()?;
        self.quads()?;
        self.numbers()?;
        self.rounding()?;
        self.channels()?;
        if self.capacity.properties {
            let names = ["x", "y", "z", "nx", "ny", "nz"];
            let names = [&names[..], &["red", "green", "blue", "quality"]].concat();
            let (vertices, triangles) = (self.vertices, self.triangles);
            self.properties(self.output.vertex_properties, &names, vertices, "vertices")?;
            let names = ["vertex_indices"];
            self.properties(self.output.face_properties, &names, triangles, "triangles")?;
        }
        Ok(())
    }

    fn counts(&self) -> Checked {
        let (output, vertices, triangles) = (self.output, self.vertices, self.triangles);
        each_needs_one("normals", output.vertex_normals(), vertices, "vertices")?;
        each_needs_one("colours", output.colours, vertices, "vertices")?;
        each_needs_one("quality values", output.quality, vertices, "vertices")?;
        each_needs_one(
            "corner normals",
            output.corner_normals,
            triangles,
            "triangles",
        )?;
        let normals = output.normals.map_or(0, <[_]>::len);
        let most = vertices.max(triangles).max(normals);
        match most > MOST {
            true => Err(format!(
                "{most} elements are too many: files count to {MOST}"
            )),
            false => Ok(()),
        }
    }

    fn indices(&self) -> Checked {
        let output = self.output;
        all_exist(
            "triangle",
            output.surface.triangles,
            "vertex",
            self.vertices,
        )?;
        let ends: Vec<_> = output.creases.iter().map(|tag| tag.vertices).collect();
        all_exist("crease tag", &ends, "vertex", self.vertices)?;
        let tagged: Vec<_> = output.corners.iter().map(|tag| [tag.vertex]).collect();
        all_exist("corner tag", &tagged, "vertex", self.vertices)?;
        let corners = output.corner_normals.unwrap_or_default();
        all_exist(
            "triangle",
            corners,
            "normal",
            output.normals.map_or(0, <[_]>::len),
        )
    }

    /// Refuses quads that are not two triangles on both sides of an edge.
    fn quads(&self) -> Checked {
        let triangles = self.output.surface.triangles;
        let mut is_taken = vec![
            false;
            if self.output.quads.is_empty() {
                0
            } else {
                triangles.len()
            }
        ];
        for (quad, &[h, twin]) in self.output.quads.iter().enumerate() {
            let vertex = |h: HalfEdgeId| Some(triangles.get(h.face().index())?[h.corner()]);
            let [from, to] = [h, twin].map(|h| [vertex(h), vertex(h.next())]);
            let is_edge = from[0].is_some() && from[0] == to[1] && from[1] == to[0];
            let mut is_new =
                |h: HalfEdgeId| !core::mem::replace(&mut is_taken[h.face().index()], true);
            if !is_edge || !is_new(h) || !is_new(twin) {
                return Err(format!(
                    "quad {quad} is not two triangles on both sides of an edge that no other quad has"
                ));
            }
        }
        Ok(())
    }

    /// Refuses what the readers of files refuse: NaN and infinity, also where they come of rounding to `f32`.
    fn numbers(&self) -> Checked {
        let (capacity, output) = (self.capacity, self.output);
        let positions = output.surface.positions.as_flattened();
        self.finite("position of vertex", positions, 3, capacity.coordinates)?;
        let normals = output.normals.unwrap_or_default().as_flattened();
        self.finite("normal of vertex", normals, 3, capacity.normals)?;
        let quality = output.quality.filter(|_| capacity.properties);
        self.finite(
            "quality of vertex",
            quality.unwrap_or_default(),
            1,
            Held::Double,
        )
    }

    fn finite(&self, what: &str, values: &[f64], width: usize, held: Held) -> Checked {
        let at = match held {
            Held::No => None,
            Held::Single => first_failing(values, |&x| (x as f32).is_finite()),
            Held::Double => first_failing(values, |x| x.is_finite()),
        };
        let Some(at) = at else { return Ok(()) };
        let (element, value, format) = (at / width, values[at], self.format);
        Err(format!(
            "{what} {element} is {value}: {format} files hold finite numbers only"
        ))
    }

    /// Refuses triangles of which none is left when coordinates are rounded.
    fn rounding(&self) -> Checked {
        let positions = self.output.surface.positions;
        let is_left = |round: fn(f64) -> f64| {
            let at = |vertex: u32| positions[vertex as usize].map(round);
            let mut triangles = self.output.surface.triangles.iter();
            triangles.any(|triangle| {
                let [a, b, c] = triangle.map(at);
                a != b && b != c && c != a
            })
        };
        let is_single = self.capacity.coordinates == Held::Single;
        if !is_single || is_left(|x| f64::from(x as f32)) || !is_left(|x| x) {
            return Ok(());
        }
        let (format, triangles) = (self.format, self.triangles);
        Err(format!(
            "{format} files round coordinates so much that none of {triangles} triangles keeps three different corners: coordinates must \
             differ by more than a ten millionth of the greatest, and by more than 1e-45; PLY, OBJ and OFF files hold them as they are"
        ))
    }

    /// Refuses channels that do not fit, and names that would be several lines.
    fn channels(&self) -> Checked {
        let (capacity, output) = (self.capacity, self.output);
        let (vertices, triangles) = (self.vertices, self.triangles);
        for channel in capacity.held(output) {
            let fits = channel.check(vertices, 3 * triangles, triangles);
            fits.map_err(|error| error.to_string())?;
            if channel.value_count() == 0 && vertices > 0 {
                return Err(format!("channel {} has no values", channel.name));
            }
        }
        let labels = output.channels.iter().flat_map(|channel| &channel.labels);
        let names = labels.chain(output.material_libraries);
        let names = names.filter(|_| capacity.names_on_lines);
        let pictures = output.texture_files.iter().filter(|_| capacity.properties);
        match names
            .chain(pictures)
            .find(|name| name.contains(['\n', '\r']))
        {
            Some(name) => {
                let format = self.format;
                Err(format!(
                    "the name {name:?} has a line break, which {format} files cannot hold"
                ))
            }
            None => Ok(()),
        }
    }

    fn properties(
        &self,
        all: &[Property<'_>],
        taken: &[&str],
        elements: usize,
        of: &str,
    ) -> Checked {
        for (i, property) in all.iter().enumerate() {
            let name = property.name;
            let is_visible = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic());
            let is_known = all[..i].iter().any(|other| other.name == name);
            if !is_visible || is_known || taken.contains(&name) {
                let need = "needs a name of visible ASCII characters that nothing else has";
                return Err(format!("property '{name}' {need}"));
            }
            let what = format!("numbers of property '{name}'");
            match property.values {
                PropertyValues::Integers(own) => each_needs_one(&what, Some(own), elements, of)?,
                PropertyValues::Numbers(own) => {
                    each_needs_one(&what, Some(own), elements, of)?;
                    self.finite(
                        &format!("property '{name}' of element"),
                        own,
                        1,
                        Held::Double,
                    )?;
                }
            }
        }
        Ok(())
    }
}

/// Refuses another count than the number of elements.
fn each_needs_one<T>(what: &str, all: Option<&[T]>, elements: usize, of: &str) -> Checked {
    match all.map_or(elements, <[_]>::len) {
        count if count == elements => Ok(()),
        count => Err(format!(
            "there are {count} {what} for {elements} {of}: each needs one"
        )),
    }
}

/// Refuses groups of indices of which one is not below a count.
fn all_exist<const N: usize>(what: &str, groups: &[[u32; N]], of: &str, count: usize) -> Checked {
    let exists = |&named: &u32| (named as usize) < count;
    let Some(index) = first_failing(groups, |group| group.iter().all(exists)) else {
        return Ok(());
    };
    let named = groups[index].iter().copied().fold(0, u32::max);
    Err(format!(
        "{what} {index} names {of} {named}, but there are {count}"
    ))
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
