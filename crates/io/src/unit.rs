//! Units of length.

/// Units of the numbers of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum LengthUnit {
    /// Micrometres.
    Micron,
    /// Millimetres, where a 3MF package says nothing.
    #[default]
    Millimeter,
    /// Centimetres.
    Centimeter,
    /// Inches.
    Inch,
    /// Feet.
    Foot,
    /// Metres.
    Meter,
}

impl LengthUnit {
    /// All units.
    pub(crate) const ALL: [Self; 6] = [
        Self::Micron,
        Self::Millimeter,
        Self::Centimeter,
        Self::Inch,
        Self::Foot,
        Self::Meter,
    ];

    /// The name in 3MF packages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Micron => "micron",
            Self::Millimeter => "millimeter",
            Self::Centimeter => "centimeter",
            Self::Inch => "inch",
            Self::Foot => "foot",
            Self::Meter => "meter",
        }
    }

    /// Its length in metres.
    pub fn metres(self) -> f64 {
        match self {
            Self::Micron => 1e-6,
            Self::Millimeter => 1e-3,
            Self::Centimeter => 1e-2,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
            Self::Meter => 1.0,
        }
    }
}
