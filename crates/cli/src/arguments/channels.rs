//! Options about what a mesh carries apart from its shape.

use std::str::FromStr;

use clap::Args;
use limitmesh::mesh::{Channel, Domain, Interpolation, SeamRule, Semantic, Storage};

use super::tolerances::AttributeTolerance;
use super::values::named;
use crate::failure::usage;

/// All texture coordinates, by whatever names the file has for them.
const TEXTURES: &str = "uv";

/// How what a mesh carries comes about between the elements of the input.
#[derive(Args, Debug, Clone)]
pub(crate) struct ChannelArguments {
    /// How a channel is carried: smooth, linear, nearest or drop; may be given several times
    ///
    /// Channels are called as `info` lists them, such as 'red,green,blue', 'texture coordinates' or TEXCOORD_0; uv is all texture
    /// coordinates. smooth: by the scheme, as positions are. linear: over each face of the input. nearest: the value of the nearest
    /// corner, never blended. drop: left out. Where nothing is said, texture coordinates are smooth, other numbers linear, whole numbers
    /// and names nearest. Of several for one channel the last holds. Smooth texture coordinates stay where they are all along the seams of
    /// the texture (boundaries), which are straight from vertex to vertex then, or as OpenSubdiv's other modes have it: none (seams are
    /// smooth, too), corners-only (coordinates that one face alone has stay), corners-plus1 (so do those where more than two meet, or two
    /// and a sharp edge), corners-plus2 (so do those where seams end).
    #[arg(long, value_name = "NAME=MODE")]
    pub(crate) channel: Vec<Choice>,

    /// Divide until a channel, linear on each triangle, is so near to where the surface has it; may be given several times
    ///
    /// In the channel's own units; of several numbers it is their Euclidean distance. For texture coordinates (uv for all) also in texels
    /// of a texture so many texels wide: uv=0.5@2048. A goal in addition to the tolerance, for smooth channels; linear ones are exact on any
    /// triangles. Of several for one channel the last holds. Not with --triangles, --balance or --optimize.
    #[arg(long, value_name = "NAME=E|NAME=TEXELS@SIZE")]
    pub(crate) attribute_tolerance: Vec<AttributeTolerance>,
}

/// How one channel is to be carried.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Choice {
    name: String,
    mode: Mode,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Smooth(SeamRule),
    Linear,
    Nearest,
    Drop,
}

/// The modes by their names.
const MODES: [(&str, Mode); 9] = [
    ("smooth", Mode::Smooth(SeamRule::Boundaries)),
    ("linear", Mode::Linear),
    ("nearest", Mode::Nearest),
    ("drop", Mode::Drop),
    ("boundaries", Mode::Smooth(SeamRule::Boundaries)),
    ("none", Mode::Smooth(SeamRule::None)),
    ("corners-only", Mode::Smooth(SeamRule::CornersOnly)),
    ("corners-plus1", Mode::Smooth(SeamRule::CornersPlus1)),
    ("corners-plus2", Mode::Smooth(SeamRule::CornersPlus2)),
];

impl FromStr for Choice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, mode) = named(text, "smooth, linear, nearest or drop")?;
        let Some((_, found)) = MODES.iter().find(|(own, _)| *own == mode) else {
            return Err(format!(
                "'{mode}' is none of smooth, linear, nearest and drop, nor a mode of seams"
            ));
        };
        Ok(Self {
            name: name.to_owned(),
            mode: *found,
        })
    }
}

/// Whether a name means a channel.
fn means(name: &str, own: &str, is_texture: bool) -> bool {
    name == own || is_texture && name == TEXTURES
}

fn is_texture(channel: &Channel) -> bool {
    channel.semantic == Semantic::TextureCoordinates
}

impl ChannelArguments {
    /// Refuses choices for channels that are none of those with these names.
    ///
    /// # Errors
    /// Lists those that there are.
    pub(crate) fn check<'a>(
        &self,
        input: &str,
        names: impl Iterator<Item = &'a str>,
    ) -> anyhow::Result<()> {
        let names: Vec<&str> = names.collect();
        let is_unknown = |own: &&Choice| own.name != TEXTURES && !names.contains(&&*own.name);
        let Some(unknown) = self.channel.iter().find(is_unknown) else {
            return Ok(());
        };
        let known = match names.is_empty() {
            true => "there is none".to_owned(),
            false => format!("there are: {}", names.join("; ")),
        };
        let unknown = &unknown.name;
        usage(format!(
            "--channel: {input} has no channel '{unknown}'; {known}"
        ))
    }

    /// Refuses tolerances for channels that are not there or are left out: those that come out have these names, and some are of texture
    /// coordinates.
    ///
    /// # Errors
    /// Says which, and what there is.
    pub(crate) fn check_tolerances<'a>(
        &self,
        input: &str,
        names: impl Iterator<Item = (&'a str, bool)>,
    ) -> anyhow::Result<()> {
        let is_kept = |(name, is_texture): &(&str, bool)| !self.drops(name, *is_texture);
        let names: Vec<(&str, bool)> = names.filter(is_kept).collect();
        let is_unknown = |own: &&AttributeTolerance| {
            !names
                .iter()
                .any(|&(name, is_texture)| means(&own.name, name, is_texture))
        };
        let Some(unknown) = self.attribute_tolerance.iter().find(is_unknown) else {
            return Ok(());
        };
        let known: Vec<&str> = names.into_iter().map(|(name, _)| name).collect();
        let known = match known.is_empty() {
            true => "none comes out".to_owned(),
            false => format!("those that come out are: {}", known.join("; ")),
        };
        let unknown = &unknown.name;
        usage(format!(
            "--attribute-tolerance: {input} has no channel '{unknown}'; {known}"
        ))
    }

    /// Refuses tolerances for what is never blended.
    fn check_tolerance(&self, channel: &Channel) -> anyhow::Result<()> {
        let is_inherited =
            channel.interpolation == Interpolation::Nearest || channel.domain == Domain::Face;
        match is_inherited && self.tolerance(channel).is_some() {
            true => usage(format!(
                "--attribute-tolerance: '{}' is inherited, never blended: nothing is between its values",
                channel.name
            )),
            false => Ok(()),
        }
    }

    /// How far the values of a channel may be off.
    pub(crate) fn tolerance(&self, channel: &Channel) -> Option<f64> {
        let mut all = self.attribute_tolerance.iter().rev();
        let own = all.find(|own| means(&own.name, &channel.name, is_texture(channel)));
        own.map(|own| own.tolerance)
    }

    /// The option, if a tolerance is given.
    pub(crate) fn given_tolerance(&self) -> Option<&'static str> {
        (!self.attribute_tolerance.is_empty()).then_some("--attribute-tolerance")
    }

    /// Refuses to blend what triangles inherit.
    ///
    /// # Errors
    /// Something is to be smooth or linear, or within a tolerance.
    pub(crate) fn check_inherited(&self) -> anyhow::Result<()> {
        if let Some(option) = self.given_tolerance() {
            return usage(format!(
                "{option} is for values that are blended; triangles inherit these"
            ));
        }
        let is_blended = |choice: &&Choice| matches!(choice.mode, Mode::Smooth(_) | Mode::Linear);
        match self.channel.iter().find(is_blended) {
            Some(Choice { name, .. }) => usage(format!(
                "--channel: '{name}' is inherited by triangles; it can be nearest or drop"
            )),
            None => Ok(()),
        }
    }

    /// The names of channels that are to be left out, each once.
    pub(crate) fn dropped(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for own in &self.channel {
            if self.drops(&own.name, false) && !names.contains(&own.name) {
                names.push(own.name.clone());
            }
        }
        names
    }

    /// Whether a channel of this name is to be left out, perhaps one of texture coordinates.
    pub(crate) fn drops(&self, name: &str, is_texture: bool) -> bool {
        self.mode(name, is_texture) == Some(Mode::Drop)
    }

    /// Whether a channel is to be left out.
    pub(crate) fn drops_channel(&self, channel: &Channel) -> bool {
        self.drops(&channel.name, is_texture(channel))
    }

    fn mode(&self, name: &str, is_texture: bool) -> Option<Mode> {
        let mut all = self.channel.iter().rev();
        let own = all.find(|choice| means(&choice.name, name, is_texture));
        own.map(|choice| choice.mode)
    }

    /// Channels of the input as they are to be interpolated.
    ///
    /// # Errors
    /// The choice would blend values that have nothing between: names, or values of whole faces.
    pub(crate) fn apply(&self, channels: &mut [Channel]) -> anyhow::Result<()> {
        channels.iter_mut().try_for_each(|channel| {
            self.apply_to(channel)?;
            self.check_tolerance(channel)
        })
    }

    fn apply_to(&self, channel: &mut Channel) -> anyhow::Result<()> {
        let usual = is_texture(channel).then_some(Mode::Smooth(SeamRule::Boundaries));
        let own = self.mode(&channel.name, is_texture(channel));
        channel.interpolation = match own.or(usual) {
            None | Some(Mode::Drop) => return Ok(()),
            Some(Mode::Nearest) => Interpolation::Nearest,
            Some(Mode::Linear) => Interpolation::Linear,
            Some(Mode::Smooth(rule)) if is_texture(channel) => Interpolation::Smooth(rule),
            Some(Mode::Smooth(_)) => Interpolation::Smooth(SeamRule::None),
        };
        let name = &channel.name;
        let what = match channel.interpolation {
            Interpolation::Nearest => return Ok(()),
            _ if channel.domain == Domain::Face => "one value a face",
            _ if !channel.labels.is_empty() => "names for values",
            _ => {
                if channel.semantic == Semantic::Label {
                    // Numbers are blended, whatever type the file has for them.
                    (channel.semantic, channel.storage) = (Semantic::Other, Storage::Double);
                }
                return Ok(());
            }
        };
        usage(format!(
            "--channel: '{name}' has {what}; it can be nearest or drop"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_read() {
        let choice = |name: &str, mode| {
            let name = name.to_owned();
            Ok(Choice { name, mode })
        };
        assert_eq!("s,t=linear".parse(), choice("s,t", Mode::Linear));
        assert_eq!("a=b=drop".parse(), choice("a=b", Mode::Drop));
        let seams = Mode::Smooth(SeamRule::CornersOnly);
        assert_eq!("uv=corners-only".parse(), choice("uv", seams));
        for (wrong, words) in [("s,t", "no ="), ("s,t=blend", "none of smooth")] {
            let why = wrong.parse::<Choice>().unwrap_err();
            assert!(why.contains(words), "{why}");
        }
    }
}
