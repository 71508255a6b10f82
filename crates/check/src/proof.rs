//! Proofs as files: what is claimed, of which meshes, and where the vertices of the result come from (docs/certificate.md, section 7).

use crate::mesh::Mesh;
use crate::pieces::Scheme;

/// Weights are multiples of one in so many.
pub const WHOLE: i64 = 1 << 30;

/// Sixths of d and d′ in the codes from [`FIRST_BESIDE`] on.
const BESIDE: [[i64; 2]; 6] = [[0, 6], [3, 3], [0, 12], [4, 4], [2, 2], [0, 3]];
const FIRST_BESIDE: usize = 153;

/// A proof, but for the meshes that it is about.
pub struct Proof {
    pub scheme: Scheme,
    /// The length that is claimed.
    pub within: f64,
    /// The digests of both meshes.
    control: String,
    pub result: String,
    /// The control mesh, if the proof holds it.
    pub held: Option<Mesh>,
    pub creases: Vec<([u32; 2], f64)>,
    pub corners: Vec<(u32, f64)>,
    /// What is left: parents and places.
    rest: Vec<u8>,
}

/// A point of the control mesh: a face and the weights of its second and third corner, in parts of [`WHOLE`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Place {
    pub face: u32,
    pub at: [i64; 2],
}

/// Where the triangles and vertices of a result come from.
pub struct Origins {
    /// By triangle, its parent.
    pub parents: Vec<u32>,
    /// By vertex.
    pub places: Vec<Place>,
}

struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (own, rest) = self.0.split_first_chunk().ok_or("ends early")?;
        self.0 = rest;
        Ok(*own)
    }

    fn double(&mut self) -> Result<f64, String> {
        Ok(f64::from_le_bytes(self.take()?))
    }

    fn varint(&mut self) -> Result<u32, String> {
        let mut value = 0u64;
        for shift in [0, 7, 14, 21, 28] {
            let [byte] = self.take()?;
            value |= u64::from(byte & 127) << shift;
            if byte < 128 {
                return u32::try_from(value).map_err(|_| "a number is too large".into());
            }
        }
        Err("a number is too long".into())
    }

    /// The control mesh; none where there are no vertices.
    fn mesh(&mut self) -> Result<Option<Mesh>, String> {
        let [vertices, triangles] = [self.varint()?, self.varint()?];
        let mut mesh = Mesh::default();
        for _ in 0..vertices {
            mesh.positions
                .push([self.double()?, self.double()?, self.double()?]);
        }
        for _ in 0..triangles {
            let mut vertex = || Ok::<u32, String>(u32::from_le_bytes(self.take()?));
            mesh.triangles.push([vertex()?, vertex()?, vertex()?]);
        }
        Ok(if vertices == 0 { None } else { Some(mesh) })
    }

    /// The parents of triangles, which stand in the order of the faces: runs of faces with as many triangles each.
    fn parents(&mut self, faces: usize, triangles: usize) -> Result<Vec<u32>, String> {
        let (mut parents, mut face) = (Vec::new(), 0);
        while parents.len() < triangles {
            let code = self.varint()?;
            let (count, run) = (
                code as usize / 2,
                if code % 2 == 1 {
                    self.varint()? as usize
                } else {
                    1
                },
            );
            if face + run > faces || parents.len() + run * count > triangles {
                return Err("has more triangles over its faces than there are".into());
            }
            parents.extend(
                (face..face + run).flat_map(|face| std::iter::repeat_n(face as u32, count)),
            );
            face += run;
        }
        Ok(parents)
    }

    /// The next place, those of the triangle's two next corners being known or not.
    fn place(&mut self, known: impl Fn() -> Option<[[i64; 2]; 2]>) -> Result<[i64; 2], String> {
        let [code] = self.take()?;
        let at = match code.into() {
            255 => {
                let [level] = self.take()?;
                let unit = WHOLE
                    .checked_shr(level.into())
                    .filter(|&unit| unit > 0)
                    .ok_or("a place is too deep")?;
                [self.varint()?, self.varint()?].map(|i| i64::from(i) * unit)
            }
            own if own < FIRST_BESIDE => {
                let (mut i, mut j) = (0, own as i64);
                while i + j > 16 {
                    (i, j) = (i + 1, i + j - 17);
                }
                [i, j].map(|x| x * (WHOLE / 16))
            }
            own => {
                let [p, q] = BESIDE
                    .get(own - FIRST_BESIDE)
                    .ok_or("a place has no such code")?;
                let [a, b] = known().ok_or("a place is beside some that are not known")?;
                let [i, j] = [b[0] - a[0], b[1] - a[1]];
                let [x, y] = [p * i - q * j, p * j + q * (i + j)];
                if x % 6 != 0 || y % 6 != 0 {
                    return Err("a place is none of the possible ones".into());
                }
                [a[0] + x / 6, a[1] + y / 6]
            }
        };
        let is_inside = Place::weights(at)
            .iter()
            .all(|weight| (0..=WHOLE).contains(weight));
        if is_inside {
            Ok(at)
        } else {
            Err("a place is beyond its face".into())
        }
    }
}

impl Proof {
    /// Reads a proof.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let end = bytes
            .windows(5)
            .position(|window| window == b"\nend\n")
            .ok_or("is no proof")?;
        let head = std::str::from_utf8(&bytes[..end]).map_err(|_| "is no proof")?;
        let mut lines = head.lines();
        let mut line = |key: &str| {
            let value = lines.next().and_then(|line| line.strip_prefix(key));
            value.map(str::trim).ok_or(format!(
                "lacks its line \"{}\", or is of another version",
                key.trim()
            ))
        };
        line("limitmesh proof 1")?;
        let name = line("scheme ")?;
        let scheme = [Scheme::Loop, Scheme::LoopWarren]
            .into_iter()
            .find(|scheme| scheme.name() == name);
        let scheme = scheme.ok_or(format!("there is no scheme {name}"))?;
        let within = line("within ")?.parse().map_err(|_| "claims no length")?;
        let [control, result] = [line("control ")?, line("result ")?].map(str::to_string);
        if lines.next().is_some() {
            return Err("has more lines than it may".into());
        }
        let mut rest = Bytes(&bytes[end + 5..]);
        let held = rest.mesh()?;
        let (mut creases, mut corners) = (Vec::new(), Vec::new());
        for _ in 0..rest.varint()? {
            creases.push(([rest.varint()?, rest.varint()?], rest.double()?));
        }
        for _ in 0..rest.varint()? {
            corners.push((rest.varint()?, rest.double()?));
        }
        Ok(Self {
            scheme,
            within,
            control,
            result,
            held,
            creases,
            corners,
            rest: rest.0.to_vec(),
        })
    }

    /// Where triangles and vertices come from. An error where the proof is about another control mesh, or has no places for the result.
    pub fn origins(&self, control: &Mesh, result: &Mesh) -> Result<Origins, String> {
        if control.digest() != self.control {
            return Err(
                "is about another control mesh than this one (the order is CONTROL RESULT PROOF)"
                    .into(),
            );
        }
        let mut rest = Bytes(&self.rest);
        let parents = rest.parents(control.triangles.len(), result.triangles.len())?;
        let mut places = vec![
            Place {
                face: u32::MAX,
                at: [0; 2]
            };
            result.positions.len()
        ];
        for (t, (triangle, &face)) in result.triangles.iter().zip(&parents).enumerate() {
            for corner in 0..3 {
                let [vertex, a, b] = [0, 1, 2].map(|i| triangle[(corner + i) % 3] as usize);
                if places[vertex].face == u32::MAX {
                    let known = |v: usize| places[v].within(&control.triangles, face);
                    let at = rest.place(|| Some([known(a)?, known(b)?]));
                    places[vertex] = Place {
                        face,
                        at: at.map_err(|what| format!("triangle {t}: {what}"))?,
                    };
                }
            }
        }
        if rest.0.is_empty() {
            Ok(Origins { parents, places })
        } else {
            Err("goes on behind its end".into())
        }
    }
}

impl Place {
    /// The weights of all three corners.
    pub fn weights([second, third]: [i64; 2]) -> [i64; 3] {
        [WHOLE - second - third, second, third]
    }

    /// The same point in another face of the control mesh, if it is there.
    pub fn within(&self, triangles: &[[u32; 3]], face: u32) -> Option<[i64; 2]> {
        if self.face == face {
            return Some(self.at);
        }
        let (from, to) = (
            triangles.get(self.face as usize)?,
            triangles.get(face as usize)?,
        );
        let (own, mut weights) = (Self::weights(self.at), [0; 3]);
        for i in (0..3).filter(|&i| own[i] > 0) {
            weights[to.iter().position(|&vertex| vertex == from[i])?] = own[i];
        }
        // A point inside of a face is in no other, not even in one with the same corners.
        own.contains(&0).then_some([weights[1], weights[2]])
    }
}
