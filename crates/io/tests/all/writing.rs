//! An output reads back unchanged, files are written whole or not at all, and what does not fit
//! together is refused.

use super::support::{channel, output, read, skip, text, try_written, unwritten, values, written};
use limitmesh::HalfEdgeId;
use limitmesh::mesh::{Channel, CornerTag, CreaseTag, Domain, PolygonSoup, Semantic};
use limitmesh_io::{
    Format, Output, Property, WriteError, WriteOptions, check_writable, read_bytes, rounding,
    write, write_to, write_whole,
};
use proptest::prelude::*;
use std::fs;
use std::io;
use std::path::Path;

fn read_back(format: Format, output: &Output<'_>, ascii: bool) -> PolygonSoup {
    read(written(format, output, ascii), format)
}

/// Any finite number: all signs, exponents and digits, subnormal ones and negative zero too.
fn any_finite() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>()
            .prop_map(f64::from_bits)
            .prop_filter("finite", |x| x.is_finite()),
        -10.0..10.0,
        (-1000i32..1000).prop_map(f64::from),
    ]
}

fn any_f32() -> impl Strategy<Value = f64> {
    any::<u32>()
        .prop_map(f32::from_bits)
        .prop_filter("finite", |x| x.is_finite())
        .prop_map(f64::from)
}

proptest! {
    /// Positions are as far from those that are read back as is stated, at most.
    #[test]
    fn rounding_is_what_reading_back_shows(
        positions in proptest::collection::vec([-1e6..1e6, -10.0..10.0, -1e-40..1e-40], 3..12),
    ) {
        let triangles: Vec<[u32; 3]> = (2..positions.len() as u32).map(|i| [i - 2, i - 1, i]).collect();
        let output = output(&positions, &triangles);
        for (format, ascii) in [(Format::Stl, false), (Format::Stl, true), (Format::Ply, false), (Format::Obj, false)] {
            let stated = rounding(format, &WriteOptions::default().ascii(ascii), &positions);
            let soup = read_back(format, &output, ascii);
            let corners: Vec<u32> = soup.faces.iter().flatten().copied().collect();
            let mut most = 0.0f64;
            for (&vertex, &read) in triangles.as_flattened().iter().zip(&corners) {
                let (from, to) = (positions[vertex as usize], soup.positions[read as usize]);
                let squared: f64 = (0..3).map(|axis| (from[axis] - to[axis]).powi(2)).sum();
                most = most.max(squared.sqrt());
            }
            prop_assert!((stated - most).abs() <= 1e-9 * stated + 1e-60, "{stated} {most}");
            prop_assert!(stated == 0.0 || format == Format::Stl && !ascii);
        }
    }
}

/// Everything that can be known of a surface.
#[derive(Debug, Clone)]
struct Surface {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[f64; 3]>,
    colours: Vec<[u8; 3]>,
    quality: Vec<f64>,
    creases: Vec<CreaseTag>,
    corners: Vec<CornerTag>,
}

impl Surface {
    fn plain(&self) -> Output<'_> {
        output(&self.positions, &self.triangles)
    }

    /// With the attributes whose bits are set in `which`.
    fn output(&self, which: u8) -> Output<'_> {
        let mut output = self.plain().creases(&self.creases).corners(&self.corners);
        if which & 1 != 0 {
            output = output.normals(&self.normals);
        }
        if which & 2 != 0 {
            output = output.colours(&self.colours);
        }
        if which & 4 != 0 {
            output = output.quality(&self.quality);
        }
        output
    }
}

prop_compose! {
    fn any_surface()(vertices in 1usize..20)(
        positions in prop::collection::vec(prop::array::uniform3(any_finite()), vertices),
        triangles in prop::collection::vec(prop::array::uniform3(0..vertices as u32), 0..30),
        normals in prop::collection::vec(prop::array::uniform3(any_f32()), vertices),
        colours in prop::collection::vec(any::<[u8; 3]>(), vertices),
        quality in prop::collection::vec(any_finite(), vertices),
        creases in prop::collection::vec((prop::array::uniform2(0..vertices as u32), 0.0..11.0), 0..5),
        corners in prop::collection::vec((0..vertices as u32, 0.0..11.0), 0..5),
    ) -> Surface {
        Surface {
            positions, triangles, normals, colours, quality,
            creases: creases.into_iter().map(|(vertices, sharpness)| CreaseTag { vertices, sharpness }).collect(),
            corners: corners.into_iter().map(|(vertex, sharpness)| CornerTag { vertex, sharpness }).collect(),
        }
    }
}

fn bits(points: &[[f64; 3]]) -> Vec<u64> {
    points.as_flattened().iter().map(|x| x.to_bits()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Positions to the last bit (the sign of zero too), triangles, and in OBJ the tags.
    #[test]
    fn what_is_written_reads_back(surface in any_surface(), which in 0u8..8, ascii: bool) {
        for format in [Format::Obj, Format::Ply, Format::Off] {
            let soup = read_back(format, &surface.output(which), ascii);
            prop_assert_eq!(bits(&soup.positions), bits(&surface.positions), "{}", format);
            prop_assert!(soup.faces.iter().eq(surface.triangles.iter().map(|t| t.as_slice())), "{}", format);
            if format == Format::Obj {
                prop_assert_eq!(&soup.creases, &surface.creases);
                prop_assert_eq!(&soup.corners, &surface.corners);
            }
        }
    }

    /// STL: the corners of each triangle, in binary rounded to `f32`.
    #[test]
    fn stl_reads_back_as_corners(mut surface in any_surface(), ascii: bool) {
        if !ascii {
            for x in surface.positions.as_flattened_mut() {
                *x = f64::from((*x as f32).clamp(f32::MIN, f32::MAX));
            }
        }
        let soup = read_back(Format::Stl, &surface.plain(), ascii);
        let corners: Vec<_> = surface.triangles.as_flattened().iter().map(|&v| surface.positions[v as usize]).collect();
        prop_assert_eq!(bits(&soup.positions), bits(&corners));
        prop_assert_eq!(soup.faces.len(), surface.triangles.len());
    }

    /// No bytes at all make a reader do anything but read or refuse.
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400), which in 0usize..4) {
        let format = Format::ALL[which];
        let start: &[u8] = match format {
            Format::Ply => b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\n\
                property uchar y\nproperty char z\nelement face 9\nproperty list uchar uchar vertex_index\nend_header\n",
            Format::Stl => b"solid \n facet ",
            Format::Off => b"OFF ",
            _ => b"v 0 0 0\n",
        };
        let _ = read_bytes(&bytes, format);
        let _ = read_bytes(&[start, &bytes].concat(), format);
    }

    /// A file with a piece cut off its end or a byte changed: the indices that are read still exist.
    #[test]
    fn damaged_files_are_read_or_refused(
        surface in any_surface(), which in 0u8..8, ascii: bool,
        keep in 0.0..1.0, change in 0.0..1.0, value: u8,
    ) {
        for &format in Format::ALL {
            let mut surface = surface.clone();
            surface.positions.as_flattened_mut().iter_mut().for_each(|x| *x = x.clamp(-1e30, 1e30));
            let whole = written(format, &surface.output(which), ascii);
            let cut = &whole[..(whole.len() as f64 * keep) as usize];
            let mut changed = whole.clone();
            changed[(whole.len() as f64 * change) as usize] = value;
            for bytes in [cut, &changed] {
                if let Ok(soup) = read_bytes(bytes, format) {
                    prop_assert!(soup.faces.iter().flatten().all(|&v| (v as usize) < soup.positions.len()));
                    prop_assert!(soup.positions.as_flattened().iter().all(|x| x.is_finite()));
                }
            }
        }
    }
}

fn crease(vertices: [u32; 2], sharpness: f64) -> CreaseTag {
    CreaseTag {
        vertices,
        sharpness,
    }
}

fn corner(vertex: u32, sharpness: f64) -> CornerTag {
    CornerTag { vertex, sharpness }
}

const POSITIONS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 2.0, 1e-9]];
const TRIANGLES: [[u32; 3]; 1] = [[0, 1, 2]];

fn triangle() -> Output<'static> {
    output(&POSITIONS, &TRIANGLES)
}

const NORMALS: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [0.5, 0.0, 0.5], [0.0, -1.0, 0.0]];
const COLOURS: [[u8; 3]; 3] = [[255, 0, 128], [1, 2, 3], [0, 0, 0]];

/// The text of each format, which other programs must understand.
#[test]
fn text_is_as_the_formats_have_it() {
    let creases = [crease([0, 2], 10.0)];
    let corners = [corner(1, 2.5)];
    let own = triangle()
        .normals(&NORMALS)
        .colours(&COLOURS)
        .quality(&[1.0, 0.25, -3.0]);
    let own = own.creases(&creases).corners(&corners);
    let text = |format| text(format, &own);
    assert_eq!(
        text(Format::Obj),
        "v 0 0 0 1 0 0.502\nv 0.1 0 0 0.004 0.008 0.012\nv 0 2 1e-9 0 0 0\nvn 0 0 1\nvn 0.5 0 0.5\nvn 0 -1 0\n\
         f 1//1 2//2 3//3\nt crease 2/1/0 0 2 10\nt corner 1/1/0 1 2.5\n"
    );
    assert_eq!(
        text(Format::Ply),
        "ply\nformat ascii 1.0\ncomment written by limitmesh\nelement vertex 3\nproperty double x\nproperty double y\n\
         property double z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n\
         property uchar green\nproperty uchar blue\nproperty double quality\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n0 0 0 0 0 1 255 0 128 1\n\
         0.1 0 0 0.5 0 0.5 1 2 3 0.25\n0 2 1e-9 0 -1 0 0 0 0 -3\n3 0 1 2\n"
    );
    assert_eq!(
        text(Format::Off),
        "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 128 255\n0.1 0 0 0.5 0 0.5 1 2 3 255\n0 2 1e-9 0 -1 0 0 0 0 255\n3 0 1 2\n"
    );
    let positions = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 0.3, 0.0]];
    let flat = written(Format::Stl, &output(&positions, &TRIANGLES), true);
    assert_eq!(
        String::from_utf8(flat).unwrap(),
        "solid limitmesh\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 0.3 0\nendloop\n\
         endfacet\nendsolid limitmesh\n"
    );
}

#[test]
fn binary_is_as_the_formats_have_it() {
    let own = triangle()
        .normals(&NORMALS)
        .colours(&COLOURS)
        .quality(&[7.0; 3]);
    let ply = written(Format::Ply, &own, false);
    let body = ply.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    assert_eq!(ply.len() - body, 3 * (24 + 12 + 3 + 8) + 13);
    assert_eq!(ply[body + 47..][..8], 0.1f64.to_le_bytes());
    assert_eq!(ply[body + 47 + 24..][..4], 0.5f32.to_le_bytes());
    assert_eq!(ply[body + 47 + 36..][..3], [1, 2, 3]);
    assert_eq!(ply[body + 47 + 39..][..8], 7f64.to_le_bytes());
    assert_eq!(
        ply[ply.len() - 13..],
        [3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]
    );
    let stl = written(Format::Stl, &triangle(), false);
    assert_eq!(stl.len(), 84 + 50);
    assert!(!stl.starts_with(b"solid"));
    assert_eq!(stl[80..84], 1u32.to_le_bytes());
    assert_eq!(stl[84 + 24..][..4], 0.1f32.to_le_bytes());
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let plain = triangle();
    let beyond = output(&POSITIONS, &[[0, 1, 2], [2, 1, 3]]);
    let creases = [crease([1, 9], 1.0)];
    let corners = [corner(3, 1.0)];
    let unknown = plain.quality(&[f64::NAN; 3]);
    for (format, output, message) in [
        (
            Format::Ply,
            plain.normals(&NORMALS[..2]),
            "there are 2 normals for 3 vertices: each needs one",
        ),
        (
            Format::Stl,
            plain.colours(&[]),
            "there are 0 colours for 3 vertices: each needs one",
        ),
        (
            Format::Obj,
            plain.quality(&[0.0; 4]),
            "there are 4 quality values for 3 vertices: each needs one",
        ),
        (
            Format::Stl,
            beyond,
            "triangle 1 names vertex 3, but there are 3",
        ),
        (
            Format::Obj,
            plain.creases(&creases),
            "crease tag 0 names vertex 9, but there are 3",
        ),
        (
            Format::Obj,
            plain.corners(&corners),
            "corner tag 0 names vertex 3, but there are 3",
        ),
        (
            Format::Ply,
            unknown,
            "quality of vertex 0 is NaN: PLY files hold finite numbers only",
        ),
    ] {
        assert_eq!(unwritten(format, &output), message);
    }
    // An attribute that the format leaves out may be anything.
    written(Format::Off, &unknown, false);
    let positions = [POSITIONS[0], [0.0, f64::NAN, 0.0], POSITIONS[2]];
    for &format in Format::ALL {
        let message =
            format!("position of vertex 1 is NaN: {format} files hold finite numbers only");
        assert_eq!(unwritten(format, &output(&positions, &TRIANGLES)), message);
    }
    let positions = [POSITIONS[0], POSITIONS[1], [0.0, 0.0, -1e39]];
    let far = output(&positions, &TRIANGLES);
    assert!(unwritten(Format::Stl, &far).starts_with("position of vertex 2 is -1"));
    written(Format::Obj, &far, false);
    written(Format::Stl, &far, true);
}

/// A writer that takes so many bytes and then fails, as a full disk does.
struct Full(usize);

impl io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.0 == 0 {
            return Err(io::Error::from(io::ErrorKind::StorageFull));
        }
        let taken = bytes.len().min(self.0);
        self.0 -= taken;
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn properties_are_columns_of_ply_files_and_channels_when_read() {
    let small: Vec<u32> = (0..POSITIONS.len() as u32).collect();
    let large: Vec<u32> = small.iter().map(|v| v + i32::MAX as u32).collect();
    let numbers: Vec<f64> = small.iter().map(|&v| -0.1 * f64::from(v)).collect();
    let columns = [
        Property::integers("small", &small),
        Property::integers("large", &large),
        Property::numbers("number", &numbers),
    ];
    let of_faces = [Property::integers("origin", &[7])];
    let own = triangle()
        .vertex_properties(&columns)
        .face_properties(&of_faces);
    let file = text(Format::Ply, &own);
    let (header, body) = file.split_once("end_header\n").unwrap();
    for line in ["int small", "uint large", "double number", "int origin"] {
        assert!(
            header.contains(&format!("property {line}\n")),
            "{line} in\n{header}"
        );
    }
    for (v, line) in body.lines().take(POSITIONS.len()).enumerate() {
        let cells: Vec<&str> = line.split(' ').skip(3).collect();
        let expected = [
            small[v].to_string(),
            large[v].to_string(),
            numbers[v].to_string(),
        ];
        assert_eq!(cells, expected);
    }
    assert!(body.ends_with(" 7\n"), "{body}");
    for &format in Format::ALL {
        for ascii in [false, true] {
            let mut soup = read_back(format, &own, ascii);
            // Formats other than PLY have nothing of it.
            if format == Format::Ply {
                let whole = |all: &[u32]| all.iter().map(|&v| f64::from(v)).collect::<Vec<_>>();
                for (name, expected) in [
                    ("small", whole(&small)),
                    ("large", whole(&large)),
                    ("number", numbers.clone()),
                    ("origin", vec![7.0]),
                ] {
                    assert_eq!(values(channel(&soup, name)).concat(), expected, "{name}");
                }
                soup.channels.clear();
            }
            assert_eq!(soup, read_back(format, &triangle(), ascii));
        }
    }
}

#[test]
fn channels_that_do_not_fit_are_refused() {
    let refused = |triangles: &[[u32; 3]], channel: Channel, format| {
        unwritten(format, &output(&POSITIONS, triangles).channels(&[channel]))
    };
    let colours = |domain| Channel::new("c", Semantic::Colour, domain, 3);
    for format in [Format::Obj, Format::Ply] {
        assert!(refused(&[], colours(Domain::Corner), format).contains("no values"));
        let few = colours(Domain::Vertex).with(vec![0.5; 3], vec![0]);
        assert!(refused(&[], few, format).contains("needs one"));
    }
    let named = Channel::new("materials", Semantic::Label, Domain::Face, 1);
    let mut named = named.with(vec![0.0], vec![0; TRIANGLES.len()]);
    named.labels = vec!["red\nf 1 2 3".to_owned()];
    assert!(refused(&TRIANGLES, named, Format::Obj).contains("line break"));
}

#[test]
fn properties_that_do_not_fit_are_refused() {
    let zeros = [0.0; POSITIONS.len()];
    let refused =
        |columns: &[Property<'_>]| unwritten(Format::Ply, &triangle().vertex_properties(columns));
    for name in ["", "two words", "x", "quality", "größe", "line\n"] {
        assert!(
            refused(&[Property::numbers(name, &zeros)]).contains("name"),
            "{name}"
        );
    }
    assert!(refused(&[Property::numbers("again", &zeros); 2]).contains("again"));
    assert!(refused(&[Property::numbers("few", &zeros[1..])]).contains("needs one"));
    let far = Property::numbers("far", &[0.0, f64::INFINITY, 0.0]);
    assert!(refused(&[far]).contains("element 1 is inf"));
}

#[test]
fn a_failing_writer_is_reported_wherever_it_fails() {
    let triangles = vec![[0, 1, 2]; 3000];
    let output = output(&POSITIONS, &triangles);
    for &format in Format::ALL {
        for ascii in [false, true] {
            let length = written(format, &output, ascii).len();
            let options = WriteOptions::default().ascii(ascii);
            for room in [0, 1, length / 2, length - 1] {
                let error = write_to(&mut Full(room), format, &output, &options).unwrap_err();
                assert!(
                    matches!(error, WriteError::Writer { .. }),
                    "{format} {error}"
                );
            }
            write_to(&mut Full(length), format, &output, &options).unwrap();
        }
    }
}

fn names(folder: &Path) -> Vec<String> {
    let files = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name());
    let mut names: Vec<String> = files.map(|name| name.into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn files_are_replaced_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.OBJ");
    fs::write(
        &path,
        "earlier content, longer than what follows".repeat(99),
    )
    .unwrap();
    write(&path, &triangle(), &WriteOptions::default()).unwrap();
    assert_eq!(
        fs::read(&path).unwrap(),
        written(Format::Obj, &triangle(), false)
    );
    write_whole(&folder.path().join("report.json"), b"{}").unwrap();
    assert_eq!(names(folder.path()), ["mesh.OBJ", "report.json"]);
}

#[test]
fn a_refused_output_leaves_the_earlier_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.stl");
    fs::write(&path, "earlier").unwrap();
    let positions = [[0.0; 3], [1e300; 3], [1.0; 3]];
    let output = output(&positions, &TRIANGLES);
    let error = write(&path, &output, &WriteOptions::default()).unwrap_err();
    assert!(
        error.to_string().starts_with("position of vertex 1 is"),
        "{error}"
    );
    assert_eq!(fs::read(&path).unwrap(), b"earlier");
    assert_eq!(names(folder.path()), ["mesh.stl"]);
}

#[test]
fn places_that_cannot_be_written_to() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("no such folder").join("mesh.ply");
    let refused = [
        write(&missing, &triangle(), &WriteOptions::default()),
        write_whole(&missing, b"x"),
        check_writable(&missing),
    ];
    for message in refused.map(|result| result.unwrap_err().to_string()) {
        let start = format!("cannot write {}: ", missing.display());
        // The name of a temporary file is nobody's business.
        assert!(
            message.starts_with(&start) && !message.contains(".limitmesh-"),
            "{message}"
        );
    }
    let is_folder = folder.path().join("folder.ply");
    fs::create_dir(&is_folder).unwrap();
    let message = write_whole(&is_folder, b"").unwrap_err().to_string();
    assert!(message.contains("directory"), "{message}");
    let options = WriteOptions::default();
    let unknown = write(&folder.path().join("mesh.xyz"), &triangle(), &options);
    assert!(matches!(unknown, Err(WriteError::UnknownFormat(_))));
    assert_eq!(names(folder.path()), ["folder.ply"]);
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

    #[test]
    fn permissions_are_those_of_any_new_file_or_of_the_earlier_one() {
        let folder = tempfile::tempdir().unwrap();
        let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().mode() & 0o777;
        fs::File::create(folder.path().join("plain")).unwrap();
        let mesh = folder.path().join("mesh.ply");
        write(&mesh, &triangle(), &WriteOptions::default()).unwrap();
        assert_eq!(mode("mesh.ply"), mode("plain"));
        let permissions = fs::Permissions::from_mode(0o640);
        fs::set_permissions(folder.path().join("plain"), permissions).unwrap();
        write_whole(&folder.path().join("plain"), b"x").unwrap();
        assert_eq!(mode("plain"), 0o640);
    }

    #[test]
    fn links_stay_links() {
        let folder = tempfile::tempdir().unwrap();
        let [real, link] = ["real.off", "link.off"].map(|name| folder.path().join(name));
        fs::write(&real, "earlier").unwrap();
        symlink("real.off", &link).unwrap();
        write(&link, &triangle(), &WriteOptions::default()).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(
            fs::read(&real).unwrap(),
            written(Format::Off, &triangle(), false)
        );
    }

    #[test]
    fn devices_are_written_to_directly() {
        write_whole(Path::new("/dev/null"), b"x").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error() {
        let message = write_whole(Path::new("/dev/full"), b"x")
            .unwrap_err()
            .to_string();
        assert!(message.starts_with("cannot write /dev/full: "), "{message}");
    }

    /// (Nothing is forbidden to root.)
    #[test]
    fn a_file_that_may_not_be_written_to_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.obj");
        fs::write(&path, "earlier").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
        if fs::OpenOptions::new().write(true).open(&path).is_ok() {
            return skip("this user may write anywhere");
        }
        let result = write(&path, &triangle(), &WriteOptions::default());
        assert!(matches!(result, Err(WriteError::File { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"earlier");
    }

    /// A folder that may not be written to: the earlier file stays as it is. (Nothing is forbidden to root.)
    #[test]
    fn a_folder_without_permission_keeps_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.obj");
        fs::write(&path, "earlier").unwrap();
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
        let all_powerful = fs::write(folder.path().join("probe"), "").is_ok();
        let result = write(&path, &triangle(), &WriteOptions::default());
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
        if all_powerful {
            return skip("this user may write anywhere");
        }
        assert!(matches!(result, Err(WriteError::File { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"earlier");
        assert_eq!(names(folder.path()), ["mesh.obj"]);
    }
}

/// A file without a triangle would be refused by who reads it; a few that become none are as before.
#[test]
fn what_rounding_leaves_no_triangle_of_is_an_error() {
    let triangles = [[0, 1, 2], [0, 2, 3]];
    for (scale, offset) in [(1e-60, 0.0), (1.0, 1e9)] {
        let square: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mut positions = square.map(|p| p.map(|x| offset + scale * x));
        for (format, ascii, is_lost) in [
            (Format::Stl, false, true),
            (Format::Glb, false, true),
            (Format::Stl, true, false),
            (Format::Ply, false, false),
        ] {
            let written = try_written(format, &output(&positions, &triangles), ascii);
            let lost = "none of 2 triangles keeps three different corners";
            let said = written
                .err()
                .map_or_else(String::new, |error| error.to_string());
            assert_eq!(said.contains(lost), is_lost, "{format} {said}");
        }
        // One of two is left.
        positions[1] = positions[0].map(|x| x + 1000.0);
        positions[2] = positions[2].map(|x| x - 1000.0);
        written(Format::Stl, &output(&positions, &triangles), false);
    }
}

/// Lists of many pieces stand in their order, whoever wrote which.
#[test]
fn long_lists_are_the_same_for_any_number_of_threads() {
    let side = 120u32;
    let place = |i: u32, j: u32| [f64::from(i), f64::from(j), f64::from(i * j % 97) / 97.0];
    let positions: Vec<_> = (0..=side)
        .flat_map(|j| (0..=side).map(move |i| place(i, j)))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..side * side)
        .flat_map(|square| {
            let corner = square / side * (side + 1) + square % side;
            let [right, up] = [corner + 1, corner + side + 1];
            [[corner, right, up + 1], [corner, up + 1, up]]
        })
        .collect();
    let normals: Vec<[f64; 3]> = positions.iter().map(|p| [p[2], 0.25, 1.0 - p[2]]).collect();
    let output = output(&positions, &triangles).normals(&normals);
    let kinds = [
        (Format::Obj, false),
        (Format::Ply, false),
        (Format::Ply, true),
        (Format::Stl, false),
        (Format::Stl, true),
        (Format::Off, false),
        (Format::Glb, false),
        (Format::ThreeMf, false),
    ];
    for (format, ascii) in kinds {
        let by = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| written(format, &output, ascii))
        };
        let one = by(1);
        assert!(
            [2, 3, 8].into_iter().all(|threads| by(threads) == one),
            "{format}"
        );
        let soup = read(&one, format);
        assert_eq!(soup.faces.len(), triangles.len(), "{format}");
        let is_single = format == Format::Glb || format == Format::Stl && !ascii;
        for (face, triangle) in soup.faces.iter().zip(&triangles) {
            for (&read, &wrote) in face.iter().zip(triangle) {
                let wrote = positions[wrote as usize]
                    .map(|x| if is_single { f64::from(x as f32) } else { x });
                assert_eq!(soup.positions[read as usize], wrote, "{format}");
            }
        }
    }
}

/// Two triangles of an edge are written as a quad, with the values of its corners, and read back as one; others are left alone.
#[test]
fn quads_are_faces_of_files_that_hold_polygons() {
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, 0.0, 0.0],
    ];
    let triangles = [[1, 4, 2], [0, 1, 3], [2, 3, 1]];
    let quads = [[HalfEdgeId(4), HalfEdgeId(7)]];
    let places: Vec<f64> = (0..9).flat_map(|corner| [f64::from(corner), 0.5]).collect();
    // Both triangles have the same values at the ends of their edge.
    let numbers = vec![0, 1, 2, 3, 4, 5, 6, 5, 4];
    let textures = Channel::new(
        limitmesh_io::TEXTURE,
        Semantic::TextureCoordinates,
        Domain::Corner,
        2,
    );
    let channels = [textures.with(places, numbers)];
    let own = output(&positions, &triangles)
        .quads(&quads)
        .channels(&channels);
    let obj = text(Format::Obj, &own);
    let faces: Vec<&str> = obj.lines().filter(|line| line.starts_with('f')).collect();
    assert_eq!(faces, ["f 2/1 5/2 3/3", "f 2/5 3/7 4/6 1/4"]);
    for (format, ascii) in [
        (Format::Obj, false),
        (Format::Ply, false),
        (Format::Ply, true),
        (Format::Off, false),
    ] {
        let soup = read_back(format, &own, ascii);
        let faces: Vec<&[u32]> = soup.faces.iter().collect();
        assert_eq!(faces, [&[1, 4, 2][..], &[1, 2, 3, 0]], "{format}");
        if format != Format::Off {
            let found: Vec<f64> = (0..7)
                .map(|corner| soup.channels[0].value(corner)[0])
                .collect();
            assert_eq!(found, [0.0, 1.0, 2.0, 4.0, 6.0, 5.0, 3.0], "{format}");
        }
    }
    assert_eq!(read_back(Format::Stl, &own, false).faces.len(), 3);
    for wrong in [[4, 5], [4, 100], [4, 4]] {
        let quads = [wrong.map(HalfEdgeId)];
        assert!(try_written(Format::Off, &own.quads(&quads), false).is_err());
    }
    let twice = [quads[0], [HalfEdgeId(7), HalfEdgeId(4)]];
    assert!(try_written(Format::Off, &own.quads(&twice), false).is_err());
}
