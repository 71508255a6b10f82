//! How numbers become colours.

use crate::RenderError;
use crate::colour_map::ColourMap;

/// How numbers become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The value at the map's lower end.
    pub low: f64,
    /// The value at its upper end; values outside get the nearest end's colour.
    pub high: f64,
    /// The colours.
    pub map: ColourMap,
    /// Equal ratios rather than equal differences get equal steps of the map; both ends are above 0 then.
    pub is_logarithmic: bool,
    /// The colour of values above the upper end, where they are marked (8-bit sRGB).
    pub above: Option<[u8; 3]>,
}

impl Scale {
    /// From `low` to `high` in the default colours.
    pub fn new(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            map: ColourMap::default(),
            is_logarithmic: false,
            above: None,
        }
    }

    /// From `low` to `high`, both above 0, by their ratio.
    pub fn logarithmic(low: f64, high: f64) -> Self {
        Self {
            is_logarithmic: true,
            ..Self::new(low, high)
        }
    }

    /// The same with a colour of its own for values above the upper end.
    pub fn marking_above(self, colour: [u8; 3]) -> Self {
        Self {
            above: Some(colour),
            ..self
        }
    }

    /// From the least to the greatest of the values that are finite (0 to 1 without any).
    pub fn of(values: &[f64]) -> Self {
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let ends = finite.fold((f64::MAX, f64::MIN), |(low, high), v| {
            (low.min(v), high.max(v))
        });
        if ends.0 <= ends.1 {
            Self::new(ends.0, ends.1)
        } else {
            Self::new(0.0, 1.0)
        }
    }

    /// The same range in other colours.
    pub fn with_map(self, map: ColourMap) -> Self {
        Self { map, ..self }
    }

    /// The colour of a value (8-bit sRGB): where both ends are one, that of the map's middle.
    pub fn colour(&self, value: f64) -> [u8; 3] {
        match self.above {
            Some(above) if value > self.high => above,
            _ => self.map.at(self.place(value)),
        }
    }

    /// Where a value stands between low (0) and high (1).
    pub(crate) fn place(&self, value: f64) -> f64 {
        if self.is_logarithmic {
            let span = (self.high / self.low).ln();
            // Values from 0 down have no logarithm: they stand below all.
            return if span > 0.0 {
                (value.max(f64::MIN_POSITIVE) / self.low).ln() / span
            } else {
                0.5
            };
        }
        let span = self.high - self.low;
        if span > 0.0 {
            (value - self.low) / span
        } else {
            0.5
        }
    }

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let half = f64::MAX / 2.0;
        if self.is_logarithmic {
            let range = f64::MIN_POSITIVE..=half;
            RenderError::check_range(
                "the logarithmic scale's lower end",
                self.low,
                range,
                "a number above 0",
            )?;
        }
        RenderError::check_range(
            "the scale's lower end",
            self.low,
            -half..=half,
            "a finite number",
        )?;
        RenderError::check_range(
            "the scale's upper end",
            self.high,
            self.low..=half,
            "at least the lower end",
        )
    }
}
