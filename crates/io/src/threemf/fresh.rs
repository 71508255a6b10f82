//! A package of one object, for triangles that come from no package.

use super::container::Fresh;
use super::model::LengthUnit;
use crate::error::WriteError;
use crate::write::Pieces;
use limitmesh::mesh::Triangles;
use std::io::{self, Write};

const TYPES: &[u8] = br#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;

const RELATIONSHIPS: &[u8] = br#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// Bytes at most that a vertex and a triangle take: three numbers of up to 24 digits each, and three of up to 10.
const VERTEX: usize = 128;
const TRIANGLE: usize = 64;

/// Triangles as a package whose numbers are measured in this.
pub(crate) fn write_fresh(surface: Triangles<'_>, unit: LengthUnit) -> Result<Vec<u8>, WriteError> {
    let Triangles {
        positions,
        triangles,
    } = surface;
    let of = |bytes: usize, count: usize| bytes.saturating_mul(count);
    let length = of(VERTEX, positions.len()).saturating_add(of(TRIANGLE, triangles.len()));
    let mut package = Fresh::new();
    let written = package
        .part("[Content_Types].xml", TYPES.len(), |out| {
            out.write_all(TYPES)
        })
        .and_then(|()| {
            package.part("_rels/.rels", RELATIONSHIPS.len(), |out| {
                out.write_all(RELATIONSHIPS)
            })
        })
        .and_then(|()| package.part("3D/3dmodel.model", length, |out| model(out, surface, unit)))
        .and_then(|()| package.finish());
    written.map_err(|why| WriteError::Writer {
        reason: std::io::Error::other(why),
    })
}

/// The text of the one model.
fn model(writer: &mut dyn Write, surface: Triangles<'_>, unit: LengthUnit) -> io::Result<()> {
    let Triangles {
        positions,
        triangles,
    } = surface;
    let mut out = Pieces::new(writer);
    let (unit, version) = (unit.name(), env!("CARGO_PKG_VERSION"));
    let head = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{unit}\" xml:lang=\"en-US\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n\
         <metadata name=\"Application\">limitmesh {version}</metadata>\n\
         <resources>\n<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n"
    );
    out.bytes(head.as_bytes())?;
    out.each(positions.len(), |out, vertex| {
        let [x, y, z] = positions[vertex];
        out.bytes(b"<vertex x=\"");
        out.bare_number(x);
        out.bytes(b"\" y=\"");
        out.bare_number(y);
        out.bytes(b"\" z=\"");
        out.bare_number(z);
        out.bytes(b"\"/>\n");
    })?;
    out.bytes(b"</vertices>\n<triangles>\n")?;
    out.each(triangles.len(), |out, triangle| {
        let [a, b, c] = triangles[triangle];
        out.bytes(b"<triangle v1=\"");
        out.bare_integer(a);
        out.bytes(b"\" v2=\"");
        out.bare_integer(b);
        out.bytes(b"\" v3=\"");
        out.bare_integer(c);
        out.bytes(b"\"/>\n");
    })?;
    out.bytes(
        b"</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n</build>\n</model>\n",
    )?;
    out.finish()
}
