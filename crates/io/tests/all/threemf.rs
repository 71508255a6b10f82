//! 3MF packages: what is read of them, that nothing but triangles changes, and what is refused; witnesses are archives and texts put
//! together and taken apart here.

use super::support::{cases, output, read, refused, triangles, written};
use limitmesh_io::threemf::{LengthUnit, NewTriangles, Source};
use limitmesh_io::{Format, Package, read_bytes};
use std::io::{Cursor, Read, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

const RELATIONSHIPS: &str = r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Id="t" Target="/Metadata/thumbnail.png" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#;

/// An archive of these parts, the second time of another kind of compression.
fn archive(parts: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (i, (name, bytes)) in parts.iter().enumerate() {
        let method = [CompressionMethod::Deflated, CompressionMethod::Stored][i % 2];
        let options = SimpleFileOptions::default().compression_method(method);
        writer.start_file(*name, options).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// A package with a model, a picture, and other parts.
fn package(model: &str, more: &[(&str, &[u8])]) -> Vec<u8> {
    let mut parts: Vec<(&str, &[u8])> = vec![
        ("[Content_Types].xml", b"<Types/>"),
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        (
            "Metadata/thumbnail.png",
            b"\x89PNG\r\n\x1a\n\0\0no real picture",
        ),
        ("3D/3dmodel.model", model.as_bytes()),
    ];
    parts.extend(more);
    archive(&parts)
}

/// A triangle from all of a face.
fn whole(face: usize) -> Source {
    Source {
        face,
        corners: None,
    }
}

/// The raw bytes of all parts of an archive, compressed as they are.
fn raw(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
    let count = archive.len();
    let read = |i| {
        let mut file = archive.by_index_raw(i).unwrap();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        (file.name().unwrap().into_owned(), bytes)
    };
    (0..count).map(read).collect()
}

/// A part's text.
fn text(bytes: &[u8], name: &str) -> String {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut text = String::new();
    archive
        .by_name(name)
        .unwrap()
        .read_to_string(&mut text)
        .unwrap();
    text
}

/// The values of an attribute in all tags of a name, empty where a tag has none.
fn values(text: &str, tag: &str, key: &str) -> Vec<String> {
    let tags = text
        .split('<')
        .filter(|own| own.starts_with(&format!("{tag} ")));
    let rest = |own: &str| Some(own.split_once(&format!(" {key}=\""))?.1.to_owned());
    let value = |rest: String| rest.split('"').next().unwrap().to_owned();
    tags.map(|own| rest(own).map_or_else(String::new, value))
        .collect()
}

/// A tetrahedron's vertices and triangles, the first with `first` in its tag.
fn tetrahedron(prefix: &str, first: &str) -> String {
    let p = prefix;
    format!(
        "<{p}mesh>\n   <{p}vertices>\n    <{p}vertex x=\"0\" y=\"0\" z=\"0\"/>\n    <{p}vertex x=\"1e0\" y=\"0\" z=\"0\" />\
         <{p}vertex x=\"0\" y=\"+2\" z=\"0\"></{p}vertex><{p}vertex z=\"3\" y=\"0\" x=\"-0.5\"/>\n   </{p}vertices>\n   \
         <{p}triangles a:b='c'>\n    <{p}triangle v1=\"0\" v2=\"2\" v3=\"1\"{first}/>\n    <{p}triangle v1=\"0\" v2=\"1\" v3=\"3\"/>\
         <{p}triangle v1=\"1\" v2=\"2\" v3=\"3\"/><{p}triangle v1=\"2\" v2=\"0\" v3=\"3\"/>\n   </{p}triangles>\n  </{p}mesh>"
    )
}

fn model(resources: &str, build: &str) -> String {
    format!(
        "\u{feff}<?xml version=\"1.0\"?>\n<!-- kept --><model unit=\"inch\" xmlns=\"c\" xmlns:q='q'>\n <metadata name=\"Title\">a &amp; b</metadata>\n \
         <resources>{resources}</resources>\n <build>{build}</build>\n</model>\n"
    )
}

#[test]
fn what_is_built_is_read() {
    let resources = format!(
        "<object id=\"1\" name=\"a &lt; b\">{}</object><object id=\"2\"><components><component objectid=\"1\"/>\
         <component objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/></components></object>\
         <object id=\"3\">{}</object>",
        tetrahedron("", ""),
        tetrahedron("", "")
    );
    let build =
        "<item objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 3 0 0 100\"/><item objectid=\"1\"/>";
    let bytes = package(&model(&resources, build), &[]);
    let package = Package::from_bytes(bytes.clone()).unwrap();
    assert_eq!(
        (package.object_count(), package.unit()),
        (2, LengthUnit::Inch)
    );
    assert_eq!(package.object_name(0), "object 1 'a < b'");
    assert!((package.stretch(0) - 3.0).abs() < 1e-12 && package.stretch(1) == 1.0);
    let contents = package.contents();
    assert_eq!(
        (contents.objects[0].built, contents.objects[1].built),
        (3, 0)
    );
    assert_eq!((contents.items, contents.assemblies), (2, 1));
    let soup = read(&bytes, Format::ThreeMf);
    assert_eq!((soup.positions.len(), soup.faces.len()), (12, 12));
    // The last vertex, (-0.5, 0, 3): as it is scaled, then turned about z, moved and scaled, then as it is.
    assert_eq!(soup.positions[3], [-1.0, 0.0, 109.0]);
    assert_eq!(soup.positions[7], [20.0, -1.0, 109.0]);
    assert_eq!(soup.positions[11], [-0.5, 0.0, 3.0]);
    let [low, high] = package.bounding_box().unwrap().unwrap();
    assert_eq!((low, high), ([-1.0, -1.0, 0.0], [20.0, 4.0, 109.0]));
}

#[test]
fn only_triangles_change() {
    for prefix in ["", "q:"] {
        let tags = |text: &str| text.replace('@', prefix);
        let first = " pid=\"5\" p1=\"0\" q:x='&quot;'";
        let text_of = tags(&format!(
            "<?xml version=\"1.0\"?>\r\n<@model xmlns:q=\"c\" xmlns=\"c\"><@resources><other>é</other><@object id=\"7\" pid='1' pindex=\"0\">\
             {}</@object></@resources><@build><@item  objectid=\"7\"/></@build></@model><!-- end -->",
            tetrahedron(prefix, first)
        ));
        let bytes = package(&text_of, &[("Metadata/x.config", b"<config/>")]);
        let mut package = Package::from_bytes(bytes.clone()).unwrap();
        // Nothing replaced, nothing changed.
        assert_eq!(raw(&package.to_bytes().unwrap()), raw(&bytes));
        let own = package.object(0, true);
        assert_eq!((own.is_uniform, own.varies_within), (false, false));
        assert_eq!(own.attributes, ["p1", "pid", "q:x"]);
        // Each triangle in two, in another order.
        let positions: Vec<[f64; 3]> = (0..9).map(|i| [f64::from(i), 0.1, -1e-30]).collect();
        let triangles: Vec<[u32; 3]> = (0..8).map(|i| [i, i + 1, (i + 2) % 9]).collect();
        let source = |triangle: usize| whole((7 - triangle) / 2);
        let keeps = |_: &str| true;
        let new = NewTriangles {
            positions: &positions,
            triangles: &triangles,
            source: &source,
            keeps: &keeps,
        };
        package.replace(0, &new).unwrap();
        let written = package.to_bytes().unwrap();
        for ((name, new), (_, old)) in raw(&written).iter().zip(raw(&bytes)) {
            assert!(*new == old || name == "3D/3dmodel.model", "{name} changed");
        }
        let new = text(&written, "3D/3dmodel.model");
        let cut = |text: &str| -> Vec<String> {
            let at = |tag: &str| text.find(&tags(tag)).unwrap();
            let ranges = [
                0..at("<@vertices>") + tags("<@vertices>").len(),
                at("</@vertices>")..at("<@triangles a") + tags("<@triangles a:b='c'>").len(),
                at("</@triangles>")..text.len(),
            ];
            ranges.map(|range| text[range].to_owned()).to_vec()
        };
        assert_eq!(cut(&new), cut(&text_of));
        assert_eq!(values(&new, &tags("@vertex"), "x").len(), 9);
        assert_eq!(values(&new, &tags("@vertex"), "z")[4], "-1e-30");
        let properties = values(&new, &tags("@triangle"), "pid");
        assert_eq!(properties.iter().filter(|pid| *pid == "5").count(), 2);
        assert_eq!(new.matches("q:x='&quot;'").count(), 2);
        let again = Package::from_bytes(written).unwrap().scene_soup().unwrap();
        assert_eq!((again.positions, again.faces.len()), (positions, 8));
    }
}

#[test]
fn volumes_are_numbered_anew() {
    let object = |id: u32| format!("<object id=\"{id}\">{}</object>", tetrahedron("", ""));
    let model = model(
        &(object(1) + &object(2)),
        "<item objectid=\"1\"/><item objectid=\"2\"/>",
    );
    let config = "<config><object id=\"1\"><volume firstid=\"0\" lastid=\"0\"><m/></volume><volume firstid=\"1\" lastid=\"3\"/>\
                  </object><object id=\"2\"><volume firstid=\"0\" lastid=\"3\"/></object></config>";
    let bytes = package(
        &model,
        &[("Metadata/Slic3r_PE_model.config", config.as_bytes())],
    );
    let mut package = Package::from_bytes(bytes).unwrap();
    // The first triangle is a volume of its own: joined by position within volumes, and no farther.
    let own = package.object(0, true);
    assert!(own.is_joined && !own.is_uniform);
    assert_eq!((own.soup.positions.len(), own.soup.faces.len()), (7, 4));
    assert_eq!(package.object(1, true).soup.positions.len(), 4);
    let positions = vec![[0.0; 3]; 3];
    let triangles = vec![[0, 1, 2]; 10];
    // Six from the first, given in an order of their own.
    let source = |triangle: usize| Source {
        face: [0, 3, 0, 0, 1, 0, 2, 0, 0, 1][triangle],
        corners: None,
    };
    let new = NewTriangles {
        positions: &positions,
        triangles: &triangles,
        source: &source,
        keeps: &|_| true,
    };
    package.replace(0, &new).unwrap();
    let written = text(
        &package.to_bytes().unwrap(),
        "Metadata/Slic3r_PE_model.config",
    );
    let expected = config.replacen("lastid=\"0\"", "lastid=\"5\"", 1).replacen(
        "firstid=\"1\" lastid=\"3\"",
        "firstid=\"6\" lastid=\"9\"",
        1,
    );
    assert_eq!(written, expected);
    let nothing = |_: usize| whole(1);
    let new = NewTriangles {
        source: &nothing,
        ..new
    };
    let flaw = package.replace(0, &new).unwrap_err().to_string();
    assert!(
        flaw.contains("the volume from triangle 0 to 0 has no triangle left"),
        "{flaw}"
    );
}

#[test]
fn objects_of_other_parts_are_found() {
    let other = format!(
        "<model xmlns=\"c\"><resources><object id=\"4\">{}</object></resources><build/></model>",
        tetrahedron("", "")
    );
    let resources = "<object id=\"1\"><components><component p:path=\"/3D/Objects/part_1.model\" objectid=\"4\" \
                     transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components></object>";
    let bytes = package(
        &model(resources, "<item objectid=\"1\"/>"),
        &[("3D/Objects/part_1.model", other.as_bytes())],
    );
    let package = Package::from_bytes(bytes).unwrap();
    assert_eq!(
        package.object_name(0),
        "object 4 of 3D/Objects/part_1.model"
    );
    assert_eq!(package.scene_soup().unwrap().positions[3], [4.5, 0.0, 3.0]);
}

#[test]
fn triangles_become_packages() {
    let positions = [[0.1, 0.2, 0.3], [1e-300, -2.0, 1e21], [3.0, 4.0, 5.0]];
    let write = || written(Format::ThreeMf, &output(&positions, &[[0, 1, 2]]), false);
    let bytes = write();
    assert_eq!(bytes, write());
    let soup = read(&bytes, Format::ThreeMf);
    assert_eq!(
        (soup.positions.as_slice(), soup.faces.len()),
        (&positions[..], 1)
    );
    assert_eq!(
        values(&text(&bytes, "3D/3dmodel.model"), "vertex", "z")[1],
        "1e+21"
    );
}

#[test]
fn flaws_name_their_place() {
    let mesh = tetrahedron("", "");
    let object = |mesh: &str| {
        model(
            &format!("<object id=\"1\">{mesh}</object>"),
            "<item objectid=\"1\"/>",
        )
    };
    let whole = object(&mesh);
    // What is replaced by what, and what is said of it.
    let table = r#"
        v3="1"/> | v3="9"/> | line 10, column 5, object 1: expected a vertex below 4 (their number so far), found v3='9'
        v3="1"/> | /> | object 1: v3 is missing: expected a vertex below 4
        v3="1"/> | v3="-1"/> | found v3='-1'
        y="+2" | y="2m" | line 7, column 35, object 1: expected a finite number, found y='2m'
        y="+2" | y="1e999" | found y='1e999'
        y="+2" | y="NaN" | found y='NaN'
        </triangles> | </triangle> | not well-formed XML
        </model> |  | 3D/3dmodel.model
        "inch" | "furlong" | the unit 'furlong' is unknown; known are micron, millimeter
        </model> | </modell> | well-formed XML
        model | modell | expected one element model, found the element modell
        <!-- kept --> | <!DOCTYPE x [<!ENTITY y "z">]> | 3MF allows no document type
        objectid="1" | objectid="2" | there is no object 2
        objectid="1" | objectid="1" q:path="/x.model" | there is no object 1 of /x.model
        objectid="1" | objectid="one" | expected a whole number, found objectid='one'
        objectid="1" | objectid="1" transform="1 0 0" | expected twelve finite numbers
        objectid="1" | objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0 inf" | twelve finite numbers
        <object id="1" | <object | id is missing: expected a whole number
        </object> | </object><object id="1"/> | there is a second object 1
        </mesh> | </mesh><mesh></mesh> | the object has a second mesh
        </mesh> | <triangles/></mesh> | the mesh has a second list of triangles"#;
    let replaced = cases(table).into_iter();
    let replaced = replaced.map(|[from, to, words]| (whole.replace(&from, &to), words));
    let used = |id: usize| format!("<component objectid=\"{id}\"/>");
    let own = format!(
        "<object id=\"1\"><components>{}</components></object>",
        used(1)
    );
    let doubled = (2..40).fold("<object id=\"1\"/>".to_owned(), |all, id| {
        let own = used(id - 1).repeat(2);
        format!("{all}<object id=\"{id}\"><components>{own}</components></object>")
    });
    let others = [
        (String::new(), "it has no element model"),
        (
            model(&own, "<item objectid=\"1\"/>"),
            "more than 64 components are within each other",
        ),
        (
            model(&doubled, "<item objectid=\"39\"/>"),
            "with all components there are more than 1000000 objects",
        ),
    ];
    let others = others.map(|(model, words)| (model, words.to_owned()));
    for (model, words) in replaced.chain(others) {
        let said = refused(package(&model, &[]), Format::ThreeMf);
        let is_said = said.contains(&words) && said.contains("3MF 3D/3dmodel.model");
        assert!(is_said, "{said}\nwithout\n{words}");
    }
    let rels = |text: &str| archive(&[("_rels/.rels", text.as_bytes())]);
    let broken = package("\u{fffd}", &[]);
    let broken = broken
        .iter()
        .map(|&b| if b == 0xBF { 0xFF } else { b })
        .collect();
    for (bytes, words) in [
        (
            b"PK\x03\x04 and no more".to_vec(),
            "the package: it cannot be read as a ZIP archive",
        ),
        (
            archive(&[("a", b"b")]),
            "it has no part _rels/.rels, as 3MF packages have",
        ),
        (
            rels("<Relationships/>"),
            "_rels/.rels: it names no 3D model",
        ),
        (
            rels(RELATIONSHIPS),
            "the model '/3D/3dmodel.model', which is no part of the package",
        ),
        (rels("<a><b></a>"), "not well-formed XML"),
        (
            b"solid x\nendsolid".to_vec(),
            "named as 3MF, but the content looks like",
        ),
        (Vec::new(), "the file is empty"),
        (broken, "it cannot be unpacked"),
    ] {
        let said = refused(bytes, Format::ThreeMf);
        assert!(said.contains(words), "{said}\nwithout\n{words}");
    }
}

#[test]
fn packages_that_swell_are_refused() {
    // A gigabyte of blanks in one megabyte: a hundred times as much would be 100 MiB.
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let deflated = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    writer.start_file("_rels/.rels", deflated).unwrap();
    writer.write_all(RELATIONSHIPS.as_bytes()).unwrap();
    writer
        .start_file("3D/3dmodel.model", deflated.large_file(true))
        .unwrap();
    let blanks = vec![b' '; 1 << 24];
    (0..64).for_each(|_| writer.write_all(&blanks).unwrap());
    let bytes = writer.finish().unwrap().into_inner();
    let most = ((100 * bytes.len()) >> 20) + 32;
    let said = refused(bytes, Format::ThreeMf);
    let expected = format!("3D/3dmodel.model: with this part the models have more than {most} MiB");
    assert!(said.contains(&expected), "{said}");
}

#[test]
fn damaged_packages_are_errors_or_meshes() {
    let whole = model(
        &format!(
            "<object id=\"1\">{}</object><object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/>\
             </components></object>",
            tetrahedron("", " pid=\"1\" paint_color=\"80043\"")
        ),
        "<item objectid=\"2\"/>",
    );
    let config = b"<config><object id=\"1\"><volume firstid=\"0\" lastid=\"3\"/></object></config>";
    // A generator of numbers that are nothing special.
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    let mut random = move |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let marks = [
        "<",
        ">",
        "/",
        "\"",
        "=",
        "&",
        " ",
        "mesh",
        "<vertices>",
        "9999999999",
        "-",
    ];
    let marks = [&marks[..], &["\u{feff}", "<triangles/>"]].concat();
    let boundary = |text: &str, at: usize| {
        (0..=at)
            .rev()
            .find(|&at| text.is_char_boundary(at))
            .unwrap()
    };
    let mut read = 0;
    for _ in 0..4000 {
        let mut text = whole.clone();
        for _ in 0..1 + random(3) {
            let (at, length) = (random(text.len()), random(20));
            let at = boundary(&text, at);
            let end = boundary(&text, (at + length).min(text.len()));
            text.replace_range(at..end, marks[random(marks.len())]);
        }
        let bytes = package(&text, &[("Metadata/Slic3r_PE_model.config", config)]);
        let Ok(mut package) = Package::from_bytes(bytes) else {
            continue;
        };
        read += 1;
        let _ = (
            package.bounding_box(),
            package.contents(),
            package.scene_soup(),
        );
        for object in 0..package.object_count() {
            let own = package.object(object, true);
            let triangles = triangles(&own.soup);
            let centre = Some([[0.4, 0.3, 0.3], [0.3, 0.4, 0.3], [0.3, 0.3, 0.4]]);
            let source = |face: usize| Source {
                face,
                corners: centre,
            };
            let positions = &own.soup.positions;
            let new = NewTriangles {
                positions,
                triangles: &triangles,
                source: &source,
                keeps: &|_| true,
            };
            package.replace(object, &new).unwrap();
        }
        let again = Package::from_bytes(package.to_bytes().unwrap()).unwrap();
        assert_eq!(again.object_count(), package.object_count());
    }
    assert!(read > 100, "{read}");
    // And the archive itself.
    let bytes = package(&whole, &[]);
    for _ in 0..4000 {
        let mut bytes = bytes.clone();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            bytes[at] = random(256) as u8;
        }
        bytes.truncate(bytes.len() - random(3) * random(bytes.len()) / 3);
        let _ = read_bytes(&bytes, Format::ThreeMf);
    }
}
