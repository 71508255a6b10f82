//! What can go wrong when a picture is drawn.

/// Why a picture, plot or image could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The picture has no pixels, or more than a picture may have.
    #[error("a picture of {width} x {height} pixels: each side must be from 1 to {limit}")]
    Size {
        /// The width asked for, in pixels.
        width: u64,
        /// The height asked for, in pixels.
        height: u64,
        /// The longest side a picture may have.
        limit: u32,
    },
    /// There is nothing to draw.
    #[error("the surface has no triangles to draw")]
    Empty,
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex}, but there are {count} vertices")]
    VertexOutOfRange {
        /// The triangle at fault.
        triangle: usize,
        /// The index met.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
    /// A number that must be finite is NaN or infinite.
    #[error("{what} {index} holds {value}, which is no finite number")]
    NotFinite {
        /// What the number belongs to.
        what: &'static str,
        /// Which of them.
        index: usize,
        /// The value met.
        value: f64,
    },
    /// An array given for each vertex, triangle or corner has the wrong length.
    #[error("there are {met} {what}, but {expected} are needed: one for each")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        met: usize,
        /// How many there must be.
        expected: usize,
    },
    /// More triangles than `u32` indices can name.
    #[error("{count} triangles are too many to draw: at most {limit} are possible")]
    TooMany {
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A setting is out of range.
    #[error("{name} must be {expected}, but is {value}")]
    BadOption {
        /// The setting's name.
        name: &'static str,
        /// The value met.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A texture's file could not be read.
    #[error("the texture could not be read: {reason}; PNG and JPEG files can be")]
    Decode {
        /// The decoder's own words.
        reason: String,
    },
    /// It was cancelled by whoever was told of its progress.
    #[error("the picture was cancelled")]
    Cancelled,
    /// The PNG encoder failed.
    #[error("the picture could not be encoded as PNG: {reason}")]
    Encode {
        /// The encoder's own words.
        reason: String,
    },
}

impl RenderError {
    /// Refuses a setting outside of `low..=high`, NaN included.
    pub(crate) fn check_range(
        name: &'static str,
        value: f64,
        range: std::ops::RangeInclusive<f64>,
        expected: &'static str,
    ) -> Result<(), Self> {
        if range.contains(&value) {
            Ok(())
        } else {
            Err(Self::BadOption {
                name,
                value,
                expected,
            })
        }
    }
}
