//! Goals apart from the shape: values of channels, and surfaces that morph targets make.

use limitmesh::Mesh;
use limitmesh::carry::goal;
use limitmesh::refine::{AttributeGoal, Exact};

use super::super::channels::Channels;
use crate::arguments::ChannelArguments;
use crate::format::upper_bound;
use crate::report::AttributeReport;

/// All of them, in the order of the refinement's own.
#[derive(Clone, Default)]
pub(super) struct AttributeGoals {
    all: Vec<Wanted>,
}

#[derive(Clone)]
struct Wanted {
    name: String,
    tolerance: f64,
    /// `None` where any triangles meet it, as for what is linear on each face.
    goal: Option<AttributeGoal>,
    /// Whether it is a length of the scene rather than a channel's own unit.
    is_length: bool,
}

impl AttributeGoals {
    /// Adds those for the channels of a control mesh.
    ///
    /// # Errors
    /// A channel does not fit it.
    pub(super) fn add_channels(
        &mut self,
        channels: &Channels,
        control: &Mesh,
        arguments: &ChannelArguments,
    ) -> anyhow::Result<()> {
        for channel in channels.all() {
            if let Some(tolerance) = arguments.tolerance(channel) {
                let goal = goal(channel, control, tolerance)?;
                self.add(channel.name.clone(), tolerance, goal, false);
            }
        }
        Ok(())
    }

    /// Adds the surface that a morph target makes.
    pub(super) fn add_surface(&mut self, name: String, moved: Mesh, tolerance: f64) {
        let goal = AttributeGoal::surface(moved, tolerance);
        self.add(name, tolerance, Some(goal), true);
    }

    fn add(&mut self, name: String, tolerance: f64, goal: Option<AttributeGoal>, is_length: bool) {
        self.all.push(Wanted {
            name,
            tolerance,
            goal,
            is_length,
        });
    }

    /// The goals of the refinement.
    pub(super) fn options(&self) -> Vec<AttributeGoal> {
        let goals = self.all.iter().filter_map(|wanted| wanted.goal.clone());
        goals.collect()
    }

    /// The goals in words, if there are some.
    pub(super) fn in_words(&self) -> Option<&'static str> {
        let have = |is_length: bool| {
            let mut wanted = self.all.iter();
            wanted.any(|own| own.goal.is_some() && own.is_length == is_length)
        };
        match (have(true), have(false)) {
            (false, false) => None,
            (true, false) => Some("the morph targets' tolerance"),
            (false, true) => Some("the channels' tolerances"),
            (true, true) => Some("the tolerances of channels and morph targets"),
        }
    }

    /// The results.
    pub(super) fn reached(&self, found: &Exact) -> Vec<AttributeReport> {
        let mut bounds = found.attribute_bounds.iter();
        let of = |wanted: &Wanted| AttributeReport {
            name: wanted.name.clone(),
            tolerance: wanted.tolerance,
            upper: match &wanted.goal {
                Some(_) => bounds.next().copied().filter(|bound| bound.is_finite()),
                None => Some(0.0),
            },
        };
        self.all.iter().map(of).collect()
    }

    /// The results in lines: one for each channel, and one for all morph targets.
    pub(super) fn achieved(&self, reached: &[AttributeReport], unit: &str) -> Vec<String> {
        let mut lines = Vec::new();
        let mut morphs: Option<Option<f64>> = None;
        for (wanted, AttributeReport { name, upper, .. }) in self.all.iter().zip(reached) {
            if wanted.is_length {
                let both = |all: Option<f64>| Some(all?.max((*upper)?));
                morphs = Some(morphs.map_or(*upper, both));
                continue;
            }
            lines.push(match upper {
                Some(0.0) => format!("{name}: exact, being linear on each face"),
                Some(upper) => format!("{name}: within {} of the surface's", upper_bound(*upper)),
                None => format!("{name}: not bounded"),
            });
        }
        lines.extend(morphs.map(|upper| match upper {
            Some(upper) => {
                let upper = upper_bound(upper);
                format!("each morph target within {upper}{unit} of its limit surface")
            }
            None => "morph targets are not bounded".to_owned(),
        }));
        lines
    }
}
