//! Options about what a mesh carries beside its shape.

use std::str::FromStr;

use clap::{Args, ValueEnum};
use limitmesh::mesh::{Channel, Domain, Interpolation, SeamRule, Semantic, Storage};

use super::tolerances::{AttributeTolerance, TextureTolerance};
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

    /// Divide until texture coordinates, linear on each triangle, are so near to where the surface has them
    ///
    /// In units of the chart, such as 0.001; or in texels of a texture so many texels wide: 0.5@2048. A goal beside the tolerance, for smooth
    /// coordinates; linear ones are exact on any triangles. Not with --triangles, --balance or --optimize.
    #[arg(long, value_name = "D|TEXELS@SIZE")]
    pub(crate) uv_tolerance: Option<TextureTolerance>,

    /// The same for any channel, in its own units; may be given several times
    ///
    /// Of several numbers, it is their Euclidean distance. Of several tolerances for one channel the last holds.
    #[arg(long, value_name = "NAME=E")]
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
            return Err(format!(
                "'{text}' has no =; give NAME=smooth, linear, nearest or drop"
            ));
        };
        let mode = match mode {
            "smooth" => Mode::Smooth,
            "linear" => Mode::Linear,
            "nearest" => Mode::Nearest,
            "drop" => Mode::Drop,
            _ => {
                return Err(format!(
                    "'{mode}' is none of smooth, linear, nearest and drop"
                ));
            }
        };
        Ok(Self {
            name: name.to_owned(),
            mode,
        })
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
    pub(crate) fn check<'a>(
        &self,
        input: &str,
        names: impl Iterator<Item = &'a str>,
    ) -> anyhow::Result<()> {
        let names: Vec<&str> = names.collect();
        let Some(unknown) = self
            .channel
            .iter()
            .find(|choice| !names.contains(&choice.name.as_str()))
        else {
            return Ok(());
        };
        let known = if names.is_empty() {
            "there is none".to_owned()
        } else {
            format!("there are: {}", names.join("; "))
        };
        usage(format!(
            "--channel: {input} has no channel '{}'; {known}",
            unknown.name
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
        let names: Vec<(&str, bool)> = names.filter(|(name, _)| !self.drops(name)).collect();
        if self.uv_tolerance.is_some() && !names.iter().any(|&(_, is_texture)| is_texture) {
            return usage(format!(
                "--uv-tolerance: {input} has no texture coordinates that come out"
            ));
        }
        let is_unknown =
            |own: &&AttributeTolerance| !names.iter().any(|&(name, _)| name == own.name);
        let Some(unknown) = self.attribute_tolerance.iter().find(is_unknown) else {
            return Ok(());
        };
        let known: Vec<&str> = names.into_iter().map(|(name, _)| name).collect();
        let known = if known.is_empty() {
            "none comes out".to_owned()
        } else {
            format!("those that come out are: {}", known.join("; "))
        };
        usage(format!(
            "--attribute-tolerance: {input} has no channel '{}'; {known}",
            unknown.name
        ))
    }

    /// Refuses tolerances for what is never blended.
    fn check_tolerance(&self, channel: &Channel) -> anyhow::Result<()> {
        let is_inherited =
            channel.interpolation == Interpolation::Nearest || channel.domain == Domain::Face;
        if is_inherited
            && self
                .attribute_tolerance
                .iter()
                .any(|own| own.name == channel.name)
        {
            return usage(format!(
                "--attribute-tolerance: '{}' is inherited, never blended: nothing is between its values",
                channel.name
            ));
        }
        Ok(())
    }

    /// How far the values of a channel may be off.
    pub(crate) fn tolerance(&self, channel: &Channel) -> Option<f64> {
        let own = self
            .attribute_tolerance
            .iter()
            .rev()
            .find(|own| own.name == channel.name);
        let is_texture = channel.semantic == Semantic::TextureCoordinates;
        let texture = self
            .uv_tolerance
            .filter(|_| is_texture)
            .map(|TextureTolerance(tolerance)| tolerance);
        own.map(|own| own.tolerance).or(texture)
    }

    /// The first option that is a tolerance.
    pub(crate) fn given_tolerance(&self) -> Option<&'static str> {
        let attribute = (!self.attribute_tolerance.is_empty()).then_some("--attribute-tolerance");
        self.uv_tolerance.map(|_| "--uv-tolerance").or(attribute)
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
        let is_blended = |choice: &&Choice| matches!(choice.mode, Mode::Smooth | Mode::Linear);
        match self.channel.iter().find(is_blended) {
            Some(Choice { name, .. }) => usage(format!(
                "--channel: '{name}' is inherited by triangles; it can be nearest or drop"
            )),
            None => Ok(()),
        }
    }

    /// The names of channels that are to be left out.
    pub(crate) fn dropped(&self) -> Vec<String> {
        let is_first = |i: usize| {
            !self.channel[..i]
                .iter()
                .any(|other| other.name == self.channel[i].name)
        };
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
        self.channel
            .iter()
            .rev()
            .find(|choice| choice.name == name)
            .map(|choice| choice.mode)
    }

    /// Channels of the input as they are to be interpolated.
    ///
    /// # Errors
    /// What is chosen would blend what has nothing between: names, or values of whole faces.
    pub(crate) fn apply(&self, channels: &mut [Channel]) -> anyhow::Result<()> {
        channels.iter_mut().try_for_each(|channel| {
            self.apply_to(channel)?;
            self.check_tolerance(channel)
        })
    }

    fn apply_to(&self, channel: &mut Channel) -> anyhow::Result<()> {
        let is_texture = channel.semantic == Semantic::TextureCoordinates;
        let usual = if is_texture {
            self.uv.rule()
        } else {
            Some(SeamRule::None)
        };
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
            return usage(format!(
                "--channel: '{name}' has one value a face; it can be nearest or drop"
            ));
        }
        if !channel.labels.is_empty() {
            return usage(format!(
                "--channel: '{name}' has names for values; it can be nearest or drop"
            ));
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
        let choice = |name: &str, mode| {
            Ok(Choice {
                name: name.to_owned(),
                mode,
            })
        };
        assert_eq!(read("s,t=linear"), choice("s,t", Mode::Linear));
        assert_eq!(read("a=b=drop"), choice("a=b", Mode::Drop));
        assert!(read("s,t").is_err_and(|what| what.contains("no =")));
        assert!(read("s,t=blend").is_err_and(|what| what.contains("none of smooth")));
    }
}
