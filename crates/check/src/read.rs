//! Readers of triangle meshes: OBJ, OFF and PLY. All but positions and triangles is passed over.

use std::str::{FromStr, SplitWhitespace};

use crate::mesh::Mesh;

/// Reads a file by the ending of its name.
pub fn mesh(name: &str, bytes: &[u8]) -> Result<Mesh, String> {
    let text = || std::str::from_utf8(bytes).map_err(|_| "not a text file".to_string());
    let mesh = match name
        .rsplit('.')
        .next()
        .unwrap_or_default()
        .to_ascii_lowercase()
        .as_str()
    {
        "obj" => obj(text()?),
        "off" => off(text()?),
        "ply" => ply(bytes),
        _ => Err("its name ends with none of .obj, .off and .ply".into()),
    }?;
    mesh.check()?;
    Ok(mesh)
}

fn number<T: FromStr>(word: Option<&str>) -> Result<T, String> {
    let word = word.ok_or("ends early")?;
    word.parse()
        .map_err(|_| format!("{word} is no number, or not one that may be here"))
}

fn position(words: &mut SplitWhitespace<'_>) -> Result<[f64; 3], String> {
    Ok([
        number(words.next())?,
        number(words.next())?,
        number(words.next())?,
    ])
}

fn triangle(corners: &[u32]) -> Result<[u32; 3], String> {
    corners
        .try_into()
        .map_err(|_| format!("a face has {} corners, not three", corners.len()))
}

fn obj(text: &str) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => mesh.positions.push(position(&mut words)?),
            Some("f") => {
                let vertex = |word: &str| {
                    let named: i64 = number(word.split('/').next())?;
                    let from_0 = if named < 0 {
                        mesh.positions.len() as i64 + named
                    } else {
                        named - 1
                    };
                    u32::try_from(from_0).map_err(|_| format!("there is no vertex {named}"))
                };
                mesh.triangles.push(triangle(
                    &words.map(vertex).collect::<Result<Vec<_>, _>>()?,
                )?);
            }
            _ => {}
        }
    }
    Ok(mesh)
}

fn off(text: &str) -> Result<Mesh, String> {
    let lines = text.lines().map(|line| {
        line.split('#')
            .next()
            .unwrap_or_default()
            .split_whitespace()
    });
    let mut lines = lines.filter(|line| line.clone().next().is_some());
    let mut line = || lines.next().ok_or("ends early".to_string());
    if !line()?.eq(["OFF"]) {
        return Err("does not begin with OFF".into());
    }
    let mut counts = line()?;
    let [vertices, faces]: [u32; 2] = [number(counts.next())?, number(counts.next())?];
    let mut mesh = Mesh::default();
    for _ in 0..vertices {
        mesh.positions.push(position(&mut line()?)?);
    }
    for _ in 0..faces {
        let mut words = line()?;
        let count: usize = number(words.next())?;
        let corners = words
            .take(count)
            .map(|word| number(Some(word)))
            .collect::<Result<Vec<_>, _>>()?;
        mesh.triangles.push(triangle(&corners)?);
    }
    Ok(mesh)
}

/// The numbers of a PLY file's body: words, or bytes with the lowest or the highest first.
enum Numbers<'a> {
    Words(SplitWhitespace<'a>),
    Bytes { rest: &'a [u8], is_big: bool },
}

impl Numbers<'_> {
    fn next(&mut self, kind: &str) -> Result<f64, String> {
        let (rest, is_big) = match self {
            Self::Words(words) => return number(words.next()),
            Self::Bytes { rest, is_big } => (rest, *is_big),
        };
        let size = match kind.trim_start_matches('u') {
            "char" | "int8" => 1,
            "short" | "int16" => 2,
            "int" | "int32" | "float" | "float32" => 4,
            "double" | "float64" => 8,
            _ => return Err(format!("there is no type {kind}")),
        };
        let (own, others) = rest.split_at_checked(size).ok_or("ends early")?;
        *rest = others;
        let mut bytes = [0; 8];
        (0..size).for_each(|i| bytes[i] = own[if is_big { size - 1 - i } else { i }]);
        let bits = u64::from_le_bytes(bytes);
        let shift = 64 - 8 * size;
        Ok(match kind {
            "double" | "float64" => f64::from_bits(bits),
            "float" | "float32" => f32::from_bits(bits as u32).into(),
            _ if kind.starts_with('u') => bits as f64,
            _ => ((bits << shift) as i64 >> shift) as f64,
        })
    }
}

fn ply(bytes: &[u8]) -> Result<Mesh, String> {
    let end = bytes
        .windows(11)
        .position(|w| w == b"end_header\n")
        .map(|at| at + 11);
    let end = end.or_else(|| Some(bytes.windows(12).position(|w| w == b"end_header\r\n")? + 12));
    let (header, body) = bytes.split_at(end.ok_or("has no header")?);
    let text = |bytes| std::str::from_utf8(bytes).map_err(|_| "is not text".to_string());
    let (mut numbers, mut elements) = (Numbers::Words("".split_whitespace()), Vec::new());
    for line in text(header)?.lines() {
        match line.split_whitespace().collect::<Vec<_>>()[..] {
            ["format", "ascii", _] => numbers = Numbers::Words(text(body)?.split_whitespace()),
            ["format", order, _] => {
                numbers = Numbers::Bytes {
                    rest: body,
                    is_big: order == "binary_big_endian",
                };
            }
            ["element", name, count] => {
                elements.push((name, number::<u32>(Some(count))?, Vec::new()))
            }
            ["property", ref kinds @ .., name] => {
                elements
                    .last_mut()
                    .ok_or("has a stray property")?
                    .2
                    .push((kinds.to_vec(), name));
            }
            _ => {}
        }
    }
    let mut mesh = Mesh::default();
    for (element, count, properties) in elements
        .into_iter()
        .filter(|(_, _, properties)| !properties.is_empty())
    {
        for _ in 0..count {
            let mut at = [f64::NAN; 3];
            for (kinds, name) in &properties {
                match kinds[..] {
                    ["list", length, kind] => {
                        let length = numbers.next(length)? as u32;
                        let list = (0..length)
                            .map(|_| numbers.next(kind))
                            .collect::<Result<Vec<_>, _>>()?;
                        if element == "face" && name.starts_with("vertex_ind") {
                            let vertex = |&value: &f64| match value as u32 {
                                vertex if f64::from(vertex) == value => Ok(vertex),
                                _ => Err(format!("{value} is no vertex")),
                            };
                            let list = list.iter().map(vertex).collect::<Result<Vec<_>, _>>()?;
                            mesh.triangles.push(triangle(&list)?);
                        }
                    }
                    [kind] => {
                        let value = numbers.next(kind)?;
                        if let Some(i) = ["x", "y", "z"].iter().position(|axis| axis == name) {
                            at[i] = value;
                        }
                    }
                    _ => return Err(format!("{name} is no property")),
                }
            }
            if element == "vertex" {
                mesh.positions.push(at);
            }
        }
    }
    Ok(mesh)
}
