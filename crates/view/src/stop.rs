//! A stop of the page's slider: a mesh at one tolerance.

use std::borrow::Cow;

use serde_json::{Map, Value, json};

use crate::Report;

/// A mesh at one tolerance.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    /// The tolerance as a share of the diagonal.
    pub tolerance: f64,
    /// The mesh in numbers.
    pub report: Report,
    /// The mesh, as a GLB file.
    pub glb: Vec<u8>,
    /// By triangle, in the order of the file's primitives, how far the mesh is from the limit surface inside it, in the mesh's unit.
    pub distances: Option<Vec<f32>>,
    /// The mesh after uniform subdivision, as a GLB file.
    pub uniform: Option<Vec<u8>>,
    /// The same distances for it.
    pub uniform_distances: Option<Vec<f32>>,
}

impl Stop {
    /// Its parts by name: those that there are, and `None` for others.
    pub(crate) fn parts(&self) -> [(&'static str, Option<Cow<'_, [u8]>>); 4] {
        let numbers = |all: &Option<Vec<f32>>| all.as_ref().map(|all| Cow::from(bytes(all)));
        [
            ("glb", Some(Cow::from(&self.glb))),
            ("distances", numbers(&self.distances)),
            ("uniform", self.uniform.as_ref().map(Cow::from)),
            ("uniform_distances", numbers(&self.uniform_distances)),
        ]
    }

    /// A server's answer to the page's request: the length of a JSON text in four bytes, the text, and the parts that it says where to
    /// find.
    ///
    /// # Errors
    /// A number that JSON cannot hold.
    pub fn answer(&self) -> serde_json::Result<Vec<u8>> {
        let (mut places, mut all) = (Map::new(), Vec::<u8>::new());
        for (name, part) in self.parts() {
            let place = part.map(|part| {
                let place = json!([all.len(), part.len()]);
                all.extend_from_slice(&part);
                place
            });
            places.insert(name.to_owned(), place.unwrap_or(Value::Null));
        }
        let text = serde_json::to_vec(&json!({ "report": self.report, "parts": places }))?;
        let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
        let mut answer = length.to_le_bytes().to_vec();
        answer.extend(text);
        answer.extend(all);
        Ok(answer)
    }
}

/// Numbers as the page reads them.
pub(crate) fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}
