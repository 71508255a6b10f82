//! Options about what a mesh carries beside its shape.

use clap::{Args, ValueEnum};
use limitmesh::mesh::{Channel, Interpolation, SeamRule, Semantic};

/// How texture coordinates between those of the input come about.
#[derive(Args, Debug, Clone, Copy)]
pub(crate) struct ChannelArguments {
    /// How texture coordinates follow the surface
    ///
    /// They are as smooth as positions, by the same scheme; the modes say which of them stay where they are along the seams of
    /// the texture. They are OpenSubdiv's, and the usual one is what Blender calls keeping boundaries.
    #[arg(long, value_enum, value_name = "MODE", default_value_t)]
    pub(crate) uv: TextureMode,
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

impl ChannelArguments {
    /// A channel of the input as it is to be interpolated.
    pub(crate) fn applied(self, channel: Channel) -> Channel {
        if channel.semantic != Semantic::TextureCoordinates {
            return channel;
        }
        let rule = match self.uv {
            TextureMode::None => Some(SeamRule::None),
            TextureMode::CornersOnly => Some(SeamRule::CornersOnly),
            TextureMode::CornersPlus1 => Some(SeamRule::CornersPlus1),
            TextureMode::CornersPlus2 => Some(SeamRule::CornersPlus2),
            TextureMode::Boundaries => Some(SeamRule::Boundaries),
            TextureMode::Linear => None,
        };
        let interpolation = rule.map_or(Interpolation::Linear, Interpolation::Smooth);
        channel.interpolated(interpolation)
    }
}
