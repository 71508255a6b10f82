//! A package of one object, for triangles that come from no package.

use super::container::Fresh;
use crate::error::WriteError;
use crate::pieces::Pieces;
use crate::unit::LengthUnit;
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
pub(super) fn write(surface: Triangles<'_>, unit: LengthUnit) -> Result<Vec<u8>, WriteError> {
    let vertices = VERTEX.saturating_mul(surface.positions.len());
    let length = vertices.saturating_add(TRIANGLE.saturating_mul(surface.triangles.len()));
    let write = || {
        let mut package = Fresh::new();
        package.part("[Content_Types].xml", TYPES.len(), |out| {
            out.write_all(TYPES)
        })?;
        let relationships = |out: &mut dyn Write| out.write_all(RELATIONSHIPS);
        package.part("_rels/.rels", RELATIONSHIPS.len(), relationships)?;
        package.part("3D/3dmodel.model", length, |out| model(out, surface, unit))?;
        package.finish()
    };
    write().map_err(|why| io::Error::other(why).into())
}

/// The text of the one model.
fn model(writer: &mut dyn Write, surface: Triangles<'_>, unit: LengthUnit) -> io::Result<()> {
    let (positions, triangles) = (surface.positions, surface.triangles);
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
        let names: [&[u8]; 3] = [b"<vertex x=\"", b"\" y=\"", b"\" z=\""];
        for (name, x) in names.iter().zip(positions[vertex]) {
            out.bytes(name);
            out.bare_number(x);
        }
        out.bytes(b"\"/>\n");
    })?;
    out.bytes(b"</vertices>\n<triangles>\n")?;
    out.each(triangles.len(), |out, triangle| {
        let names: [&[u8]; 3] = [b"<triangle v1=\"", b"\" v2=\"", b"\" v3=\""];
        for (name, v) in names.iter().zip(triangles[triangle]) {
            out.bytes(name);
            out.bare_integer(v);
        }
        out.bytes(b"\"/>\n");
    })?;
    out.bytes(
        b"</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n</build>\n</model>\n",
    )?;
    out.finish()
}
