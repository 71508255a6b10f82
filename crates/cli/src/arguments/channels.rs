//! Options about what a mesh carries beside its shape.

use std::str::FromStr;

use clap::{Args, ValueEnum};
use limitmesh::mesh::{Channel, Domain, Interpolation, SeamRule, Semantic, Storage};

use crate::failure::usage;

/// How what a mesh carries comes about between the elements of the input.
#[derive(Args, Debug, Clone)]
pub(crate) struct ChannelArguments {
    /// How texture coordinates follow the surface
    ///
    /// They are as smooth as positions, by the same scheme; the modes say which of them stay where they are along the seams of
    /// the texture. They are OpenSubdiv's, and the usual one is what Blender calls keeping boundaries.
    #[arg(long, value_enum, value_name = "MODE", default_value_t)]
    pub(crate) uv: TextureMode,

    /// How a channel is carried: smooth, linear, nearest or drop; may be given several times
    ///
    /// Channels are called as `info` lists them, such as 'red,green,blue', 'texture coordinates' or TEXCOORD_0. smooth: by the scheme,
    /// as positions are (texture coordinates by --uv along seams). linear: over each face of the input. nearest: the value of
    /// the nearest corner, never blended. drop: left out. Where nothing is said, texture coordinates are smooth, other
    /// numbers linear, whole numbers and names nearest. Of several for one channel the last holds.
    #[arg(long, value_name = "NAME=MODE")]
    pub(crate) channel: Vec<Choice>,
}

/// How one channel is to be carried.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Choice {
    name: String,
    mode: Mode,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Smooth,
    Linear,
    Nearest,
    Drop,
}

impl FromStr for Choice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Names may have an equals sign, modes have none.
        let Some((name, mode)) = text.rsplit_once('=') else {
            return Err(format!("'{text}' has no =; expected NAME=smooth, linear, nearest or drop"));
        };
        let mode = match mode {
            "smooth" => Mode::Smooth,
            "linear" => Mode::Linear,
            "nearest" => Mode::Nearest,
            "drop" => Mode::Drop,
            _ => return Err(format!("'{mode}' is none of smooth, linear, nearest and drop")),
        };
        Ok(Self { name: name.to_owned(), mode })
    }
}

/// How texture coordinates follow the surface.
#[derive(ValueEnum, Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum TextureMode {
    /// Seams are smooth, too
    None,
    /// Coordinates that one face alone has stay
    CornersOnly,
    /// So do those where more than two meet, or two and a sharp edge
    CornersPlus1,
    /// So do those where seams end
    CornersPlus2,
    /// All along seams and boundaries stay: seams are straight from vertex to vertex
    #[default]
    Boundaries,
    /// Linear over each face, as before refinement
    Linear,
}

impl TextureMode {
    /// What holds along seams; nothing where coordinates are linear.
    fn rule(self) -> Option<SeamRule> {
        match self {
            Self::None => Some(SeamRule::None),
            Self::CornersOnly => Some(SeamRule::CornersOnly),
            Self::CornersPlus1 => Some(SeamRule::CornersPlus1),
            Self::CornersPlus2 => Some(SeamRule::CornersPlus2),
            Self::Boundaries => Some(SeamRule::Boundaries),
            Self::Linear => None,
        }
    }
}

impl ChannelArguments {
    /// Refuses choices for channels that are none of those with these names.
    ///
    /// # Errors
    /// Lists those that there are.
    pub(crate) fn check<'a>(&self, input: &str, names: impl Iterator<Item = &'a str>) -> anyhow::Result<()> {
        let names: Vec<&str> = names.collect();
        let Some(unknown) = self.channel.iter().find(|choice| !names.contains(&choice.name.as_str())) else {
            return Ok(());
        };
        let known = if names.is_empty() {
            "there is none".to_owned()
        } else {
            format!("there are: {}", names.join("; "))
        };
        usage(format!("--channel: {input} has no channel '{}'; {known}", unknown.name))
    }

    /// Refuses to blend what triangles inherit.
    ///
    /// # Errors
    /// Something is to be smooth or linear.
    pub(crate) fn check_inherited(&self) -> anyhow::Result<()> {
        let is_blended = |choice: &&Choice| matches!(choice.mode, Mode::Smooth | Mode::Linear);
        match self.channel.iter().find(is_blended) {
            Some(Choice { name, .. }) => {
                usage(format!("--channel: '{name}' is inherited by triangles; it can be nearest or drop"))
            }
            None => Ok(()),
        }
    }

    /// The names of channels that are to be left out.
    pub(crate) fn dropped(&self) -> Vec<String> {
        let is_first = |i: usize| !self.channel[..i].iter().any(|other| other.name == self.channel[i].name);
        let all = self.channel.iter().enumerate();
        all.filter(|(i, own)| self.drops(&own.name) && is_first(*i))
            .map(|(_, own)| own.name.clone())
            .collect()
    }

    /// Whether a channel is to be left out.
    pub(crate) fn drops(&self, name: &str) -> bool {
        self.mode(name) == Some(Mode::Drop)
    }

    fn mode(&self, name: &str) -> Option<Mode> {
        self.channel.iter().rev().find(|choice| choice.name == name).map(|choice| choice.mode)
    }

    /// Channels of the input as they are to be interpolated.
    ///
    /// # Errors
    /// What is chosen would blend what has nothing between: names, or values of whole faces.
    pub(crate) fn apply(&self, channels: &mut [Channel]) -> anyhow::Result<()> {
        for channel in channels {
            self.apply_to(channel)?;
        }
        Ok(())
    }

    fn apply_to(&self, channel: &mut Channel) -> anyhow::Result<()> {
        let is_texture = channel.semantic == Semantic::TextureCoordinates;
        let usual = if is_texture { self.uv.rule() } else { Some(SeamRule::None) };
        channel.interpolation = match self.mode(&channel.name) {
            None if is_texture => usual.map_or(Interpolation::Linear, Interpolation::Smooth),
            None | Some(Mode::Drop) => return Ok(()),
            Some(Mode::Nearest) => Interpolation::Nearest,
            Some(Mode::Linear) => Interpolation::Linear,
            Some(Mode::Smooth) => Interpolation::Smooth(usual.unwrap_or_default()),
        };
        if channel.interpolation == Interpolation::Nearest {
            return Ok(());
        }
        let name = &channel.name;
        if channel.domain == Domain::Face {
            return usage(format!("--channel: '{name}' has one value a face; it can be nearest or drop"));
        }
        if !channel.labels.is_empty() {
            return usage(format!("--channel: '{name}' has names for values; it can be nearest or drop"));
        }
        if channel.semantic == Semantic::Label {
            // Numbers are blended, whatever type the file has for them.
            (channel.semantic, channel.storage) = (Semantic::Other, Storage::Double);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_read() {
        let read = |text: &str| text.parse::<Choice>();
        let choice = |name: &str, mode| Ok(Choice { name: name.to_owned(), mode });
        assert_eq!(read("s,t=linear"), choice("s,t", Mode::Linear));
        assert_eq!(read("a=b=drop"), choice("a=b", Mode::Drop));
        assert!(read("s,t").is_err_and(|what| what.contains("no =")));
        assert!(read("s,t=blend").is_err_and(|what| what.contains("none of smooth")));
    }
}
