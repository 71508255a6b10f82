//! Values on the command line and their ranges: what is wrong with one is said before any work begins.

use std::str::FromStr;
use std::time::Duration;

use limitmesh::measure::SamplingOptions;

use super::quantity::{self, Length, Unit, finite};

/// Levels of uniform refinement beyond this would need more than 4^12 (16 million) triangles for a single input triangle.
pub(crate) const MAX_STEPS: usize = 12;

/// Levels beyond this would divide an edge by more than ten million.
const MAX_LEVELS: usize = 24;

/// More threads than any machine we know of has processors.
const MAX_THREADS: usize = 4096;

/// Pixels on a side; a picture of this size takes about a gigabyte while it is drawn.
const MAX_SIDE: u32 = 8192;

/// An angle in degrees, above 0 and at most 180.
pub(super) fn angle(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value > 0.0 && value <= 180.0 {
        Ok(value)
    } else {
        Err(format!(
            "{value}° is out of range: an angle is above 0 and at most 180 degrees"
        ))
    }
}

/// A name and what is said of it. Names may have an equals sign, what is said has none.
pub(super) fn named<'a>(text: &'a str, what: &str) -> Result<(&'a str, &'a str), String> {
    text.rsplit_once('=')
        .ok_or_else(|| format!("'{text}' has no =; give NAME={what}"))
}

/// A factor of at least 0.
pub(super) fn factor(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value >= 0.0 {
        Ok(value)
    } else {
        Err(format!("{value} is out of range: it is at least 0"))
    }
}

/// A welding distance; `None` for the word `none`.
pub(super) fn weld(text: &str) -> Result<WeldDistance, String> {
    if text == "none" {
        return Ok(WeldDistance::None);
    }
    let distance =
        quantity::length(text).map_err(|what| format!("{what}; give a distance or 'none'"))?;
    if distance.value < 0.0 {
        return Err(format!("{text} is out of range: a distance is at least 0"));
    }
    Ok(WeldDistance::Within(distance))
}

/// Within which distance vertices are merged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum WeldDistance {
    /// No vertices, not even at equal positions.
    None,
    /// Those within this distance.
    Within(Length),
}

/// A length, absolute or relative to a diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Extent {
    /// As it is, perhaps with its unit.
    Length(Length),
    /// In per cent of the diagonal of a bounding box.
    Percent(f64),
}

impl Extent {
    /// The length in the mesh's unit, where the diagonal is this long.
    ///
    /// # Errors
    /// This has a unit, and the mesh's is not known.
    pub(crate) fn length(self, diagonal: f64, unit: Option<Unit>) -> anyhow::Result<f64> {
        match self {
            Self::Length(length) => length.in_unit_of(unit),
            Self::Percent(percent) => Ok(percent / 100.0 * diagonal),
        }
    }
}

/// A length, or per cent of a diagonal if `%` follows: at least 0.
pub(super) fn extent(text: &str) -> Result<Extent, String> {
    let extent = signed_extent(text)?;
    if is_below_zero(extent) {
        return Err(format!("{text} is out of range: a length is at least 0"));
    }
    Ok(extent)
}

fn signed_extent(text: &str) -> Result<Extent, String> {
    let text = text.trim();
    let parsed = match text.strip_suffix('%') {
        Some(number) => finite(number).map(Extent::Percent),
        None => quantity::length(text).map(Extent::Length),
    };
    parsed.map_err(|what| {
        format!("{what}; give a length such as 0.05 or 0.05mm, or per cent such as 0.01%")
    })
}

fn is_below_zero(extent: Extent) -> bool {
    matches!(extent, Extent::Length(Length { value, .. }) | Extent::Percent(value) if value < 0.0)
}

/// A length above 0, or per cent of a diagonal above 0 and at most 100.
pub(super) fn tolerance(text: &str) -> Result<Extent, String> {
    let extent = signed_extent(text)?;
    match extent {
        Extent::Length(Length { value, .. }) | Extent::Percent(value) if value <= 0.0 => {
            Err(format!("{text} is out of range: a tolerance is above 0"))
        }
        Extent::Percent(percent) if percent > 100.0 => Err(format!(
            "{text} is out of range: 100% is the size of the whole mesh"
        )),
        tolerance => Ok(tolerance),
    }
}

/// Three numbers with commas between them.
pub(super) fn point(text: &str) -> Result<[f64; 3], String> {
    let numbers = text.split(',').map(finite).collect::<Result<Vec<_>, _>>()?;
    <[f64; 3]>::try_from(numbers).map_err(|numbers| {
        format!(
            "it has {} numbers; give three with commas: X,Y,Z",
            numbers.len()
        )
    })
}

/// A direction: a point that is not the origin.
pub(super) fn direction(text: &str) -> Result<[f64; 3], String> {
    let direction = point(text)?;
    if direction == [0.0; 3] {
        return Err("0,0,0 is no direction: at least one number must differ from 0".to_owned());
    }
    Ok(direction)
}

/// A count from 0 to [`MAX_LEVELS`].
pub(super) fn levels(text: &str) -> Result<usize, String> {
    bounded(text, 0, MAX_LEVELS, "levels")
}

/// A count from 0 to [`MAX_STEPS`].
pub(super) fn steps(text: &str) -> Result<usize, String> {
    bounded(text, 0, MAX_STEPS, "levels")
}

/// A count from 1 to [`MAX_STEPS`].
pub(super) fn detail_levels(text: &str) -> Result<usize, String> {
    bounded(text, 1, MAX_STEPS, "levels")
}

/// A number above 0 and below 1.
pub(super) fn ratio(text: &str) -> Result<f64, String> {
    let value = above_zero(text)?;
    if value < 1.0 {
        Ok(value)
    } else {
        Err(format!(
            "{value} is out of range: it is above 0 and below 1"
        ))
    }
}

/// An angle of view in degrees, above 0 and below 180.
pub(super) fn field_of_view(text: &str) -> Result<f64, String> {
    let value = above_zero(text)?;
    if value < 180.0 {
        Ok(value)
    } else {
        Err(format!("{value}° is out of range: it is below 180 degrees"))
    }
}

/// A number above 0.
pub(super) fn above_zero(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value > 0.0 {
        Ok(value)
    } else {
        Err(format!("{value} is out of range: it is above 0"))
    }
}

/// A time above 0.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    Duration::try_from_secs_f64(above_zero(text)?)
        .map_err(|_| format!("{text} seconds are too many"))
}

/// A number of bytes, as [`quantity::bytes`] reads it.
pub(super) fn memory(text: &str) -> Result<usize, String> {
    let bytes = quantity::bytes(text)?;
    if bytes < 1.0 {
        return Err(format!("{text} is too little: memory is at least one byte"));
    }
    // Beyond what can be addressed, the conversion gives the most that can.
    Ok(bytes as usize)
}

/// A count of at least 1.
pub(super) fn positive(text: &str) -> Result<usize, String> {
    within(count(text)?, 1, usize::MAX, "a count")
}

/// Work of a search.
pub(super) fn work(text: &str) -> Result<u64, String> {
    quantity::count(text)
}

fn count(text: &str) -> Result<usize, String> {
    usize::try_from(quantity::count(text)?)
        .map_err(|_| format!("{text} is too many for this machine"))
}

/// A number of samples.
pub(super) fn samples(text: &str) -> Result<usize, String> {
    within(count(text)?, 1, SamplingOptions::MOST_SAMPLES, "samples")
}

/// A number of threads.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    bounded(text, 0, MAX_THREADS, "threads")
}

fn bounded(text: &str, low: usize, high: usize, what: &str) -> Result<usize, String> {
    let value = usize::from_str(text.trim())
        .map_err(|_| format!("'{text}' is not a whole number of at least {low}"))?;
    within(value, low, high, what)
}

fn within(value: usize, low: usize, high: usize, what: &str) -> Result<usize, String> {
    match value {
        v if v < low => Err(format!("{v} is too few: {what} must be at least {low}")),
        v if v > high => Err(format!("{v} is too many: {what} must be at most {high}")),
        v => Ok(v),
    }
}

/// Width and height in pixels, written `WxH`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is no size; give WxH in pixels, such as 1600x1200");
        let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(wrong)?;
        let side = |side: &str| u32::from_str(side.trim()).map_err(|_| wrong());
        let size = Self {
            width: side(width)?,
            height: side(height)?,
        };
        let fits = |side: u32| (1..=MAX_SIDE).contains(&side);
        if fits(size.width) && fits(size.height) {
            Ok(size)
        } else {
            Err(format!(
                "{text} is out of range: each side has 1 to {MAX_SIDE} pixels"
            ))
        }
    }
}

/// A part of many, counted from 0: written `I/N`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// Whether a line, counted from 1, belongs to it.
    pub(crate) fn has(self, line: usize) -> bool {
        (line - 1) % self.count == self.index
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is no shard; give I/N, such as 0/8 to 7/8");
        let (index, count) = text.split_once('/').ok_or_else(wrong)?;
        let number = |text: &str| usize::from_str(text.trim()).map_err(|_| wrong());
        let shard = Self {
            index: number(index)?,
            count: number(count)?,
        };
        match shard {
            Self { count: 0, .. } => {
                Err(format!("{text} is out of range: there is at least 1 shard"))
            }
            Self { index, count } if index >= count => Err(format!(
                "{text} is out of range: of {count} the last shard is {}",
                count - 1
            )),
            shard => Ok(shard),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_line_is_in_one_shard() {
        let shards = ["0/3", "1/3", "2/3"].map(|text| Shard::from_str(text).unwrap());
        for line in 1..10 {
            assert_eq!(shards.iter().filter(|shard| shard.has(line)).count(), 1);
        }
        assert!(shards[0].has(1) && shards[2].has(6));
        for bad in ["3/3", "0/0", "1", "-1/3", "1/x", "1/3/5", ""] {
            assert!(Shard::from_str(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn ranges_hold() {
        assert_eq!(angle("180"), Ok(180.0));
        for bad in ["0", "-1", "180.001", "NaN", "inf", "ten"] {
            assert!(angle(bad).is_err(), "{bad}");
        }
        assert_eq!(point("1,-2.5, 3e1"), Ok([1.0, -2.5, 30.0]));
        for bad in ["1,2", "1,2,3,4", "1,2,x", "", "1,2,inf"] {
            assert!(point(bad).is_err(), "{bad}");
        }
        assert!(direction("0,0,0").is_err());
        assert!(direction("0,0,-0").is_err());
        assert_eq!(
            weld("0.5"),
            Ok(WeldDistance::Within(Length {
                value: 0.5,
                unit: None
            }))
        );
        assert_eq!(weld("none"), Ok(WeldDistance::None));
        assert!(weld("-0.5").is_err());
    }

    #[test]
    fn extents_are_lengths_or_per_cent() {
        let plain = |value| Ok(Extent::Length(Length { value, unit: None }));
        assert_eq!(extent("0.5"), plain(0.5));
        assert_eq!(extent("0.01%"), Ok(Extent::Percent(0.01)));
        assert_eq!(extent(" 2 % "), Ok(Extent::Percent(2.0)));
        assert_eq!(
            extent("0.05mm"),
            Ok(Extent::Length(Length {
                value: 0.05,
                unit: Some(Unit::Mm)
            }))
        );
        for bad in ["", "%", "-1", "-1%", "-1mm", "1 parsec", "NaN", "inf%"] {
            assert!(extent(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn tolerances_are_above_0_and_at_most_the_whole() {
        assert_eq!(
            tolerance("1e-300"),
            Ok(Extent::Length(Length {
                value: 1e-300,
                unit: None
            }))
        );
        assert_eq!(tolerance("100%"), Ok(Extent::Percent(100.0)));
        for bad in ["0", "-0", "0%", "-1", "-0.1%", "-1mm"] {
            let what = tolerance(bad).unwrap_err();
            assert_eq!(
                what,
                format!("{bad} is out of range: a tolerance is above 0")
            );
        }
        for bad in ["NaN", "inf", "1e999", "1000%", "%", "", "0.1%%", "fine"] {
            assert!(tolerance(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn samples_are_as_many_as_memory_can_hold() {
        assert_eq!(samples("1"), Ok(1));
        for bad in ["0", "1000000000000", "18446744073709551615", "1.5"] {
            assert!(samples(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sizes_are_read() {
        assert_eq!(
            "640x480".parse(),
            Ok(Size {
                width: 640,
                height: 480
            })
        );
        for bad in ["640", "0x5", "640x", "99999x10", "-1x5"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
    }
}
