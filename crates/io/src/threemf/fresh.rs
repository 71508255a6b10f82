//! A package of one object, for triangles that come from no package.

use super::container;
use super::edit::Numbers;
use super::model::LengthUnit;
use crate::error::WriteError;
use limitmesh::mesh::Triangles;
use std::fmt::Write;

const TYPES: &[u8] = br#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;

const RELATIONSHIPS: &[u8] = br#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// Triangles as a package whose numbers are measured in this.
pub(crate) fn write_fresh(surface: Triangles<'_>, unit: LengthUnit) -> Result<Vec<u8>, WriteError> {
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{}\" xml:lang=\"en-US\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n",
        unit.name()
    );
    let _ =
        writeln!(text, "<metadata name=\"Application\">limitmesh {}</metadata>", env!("CARGO_PKG_VERSION"));
    text.push_str("<resources>\n<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n");
    let mut numbers = Numbers::default();
    for [x, y, z] in surface.positions {
        let _ = write!(text, "<vertex x=\"{}\"", numbers.text(*x));
        let _ = write!(text, " y=\"{}\"", numbers.text(*y));
        let _ = writeln!(text, " z=\"{}\"/>", numbers.text(*z));
    }
    text.push_str("</vertices>\n<triangles>\n");
    for [a, b, c] in surface.triangles {
        let _ = writeln!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>");
    }
    text.push_str("</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n</build>\n</model>\n");
    let parts: [(&str, &[u8]); 3] = [
        ("[Content_Types].xml", TYPES),
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/3dmodel.model", text.as_bytes()),
    ];
    container::fresh(&parts).map_err(|why| WriteError::Writer { reason: std::io::Error::other(why) })
}
