//! Quantities as people write them: `20k` and `20,000` triangles, `500MB` of memory, `0.05mm` of length.

use std::str::FromStr;

use anyhow::Context;
use clap::ValueEnum;
use limitmesh_io::threemf::LengthUnit;

use crate::failure::usage;

/// The unit of a mesh's numbers. 3MF packages say it, glTF documents are in metres, other files do not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Unit {
    /// Micrometres
    Um,
    /// Millimetres
    Mm,
    /// Centimetres
    Cm,
    /// Metres
    M,
    /// Inches
    In,
    /// Feet
    Ft,
}

impl Unit {
    /// How it is written after a number.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Um => "um",
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::M => "m",
            Self::In => "in",
            Self::Ft => "ft",
        }
    }

    /// The unit that a 3MF package names.
    ///
    /// # Errors
    /// It is none of these.
    pub(crate) fn of_package(unit: LengthUnit) -> anyhow::Result<Self> {
        let mut all = Self::value_variants().iter().copied();
        all.find(|own| own.in_package() == unit)
            .with_context(|| format!("a package in {unit:?}, which is not known here"))
    }

    /// As a 3MF package has it.
    pub(crate) fn in_package(self) -> LengthUnit {
        match self {
            Self::Um => LengthUnit::Micron,
            Self::Mm => LengthUnit::Millimeter,
            Self::Cm => LengthUnit::Centimeter,
            Self::M => LengthUnit::Meter,
            Self::In => LengthUnit::Inch,
            Self::Ft => LengthUnit::Foot,
        }
    }

    /// How many of another unit it is.
    pub(crate) fn in_others(self, other: Self) -> f64 {
        self.micrometres() / other.micrometres()
    }

    fn micrometres(self) -> f64 {
        match self {
            Self::Um => 1.0,
            Self::Mm => 1e3,
            Self::Cm => 1e4,
            Self::M => 1e6,
            Self::In => 25_400.0,
            Self::Ft => 304_800.0,
        }
    }
}

/// A length in the mesh's unit, or in one of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Length {
    pub(crate) value: f64,
    pub(crate) unit: Option<Unit>,
}

impl Length {
    /// In the unit of a mesh.
    ///
    /// # Errors
    /// This has a unit, and the mesh's is not known.
    pub(crate) fn in_unit_of(self, mesh: Option<Unit>) -> anyhow::Result<f64> {
        match (self.unit, mesh) {
            (None, _) => Ok(self.value),
            (Some(own), Some(mesh)) if own == mesh => Ok(self.value),
            (Some(own), Some(mesh)) => Ok(self.value * own.micrometres() / mesh.micrometres()),
            (Some(own), None) => usage(format!(
                "{}{name}: the file does not say what its numbers are measured in; --unit does, such as --unit {name} if they are {name}",
                self.value,
                name = own.name()
            )),
        }
    }
}

/// A number that is finite.
pub(super) fn finite(text: &str) -> Result<f64, String> {
    let value = f64::from_str(text.trim()).map_err(|_| format!("'{text}' is not a number"))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("{value} is not a finite number"))
    }
}

/// A number, perhaps with a unit of length after it.
pub(super) fn length(text: &str) -> Result<Length, String> {
    let text = text.trim();
    let names = Unit::value_variants()
        .iter()
        .map(|&unit| (unit, unit.name()));
    let found = names
        .chain([(Unit::Um, "µm")])
        .filter_map(|(unit, name)| Some((unit, text.strip_suffix(name)?)))
        // The longest name: `mm` ends with `m`.
        .min_by_key(|(_, number)| number.len());
    let (unit, number) = found.map_or((None, text), |(unit, number)| (Some(unit), number));
    let value = finite(number)?;
    Ok(Length { value, unit })
}

/// A whole number, perhaps with k, M or G for thousands, millions and thousands of millions, with commas or underscores
/// between thousands, or with an exponent.
pub(super) fn count(text: &str) -> Result<u64, String> {
    let wrong = || format!("'{text}' is not a whole number, such as 20000, 20,000, 20k or 2e4");
    let text = text.trim();
    let (digits, factor) = match text.char_indices().next_back() {
        Some((i, 'k' | 'K')) => (&text[..i], 1e3),
        Some((i, 'm' | 'M')) => (&text[..i], 1e6),
        Some((i, 'g' | 'G')) => (&text[..i], 1e9),
        _ => (text, 1.0),
    };
    let digits = without_separators(digits.trim_end()).ok_or_else(wrong)?;
    if factor == 1.0
        && let Ok(value) = u64::from_str(&digits)
    {
        return Ok(value);
    }
    let value = finite(&digits).map_err(|_| wrong())? * factor;
    let whole = value.round();
    // 1.1 M is a whole number but for what rounding makes of it.
    if (value - whole).abs() > 1e-9 * whole.abs() || whole < 0.0 {
        return Err(wrong());
    }
    // 2⁶⁴: the next lower number is one that fits.
    if whole >= 18_446_744_073_709_551_616.0 {
        return Err(format!("{text} is too many for this machine"));
    }
    Ok(whole as u64)
}

/// Digits without the commas or underscores between groups of three; `None` where these stand elsewhere.
fn without_separators(text: &str) -> Option<String> {
    let Some(separator) = [',', '_'].into_iter().find(|&c| text.contains(c)) else {
        return Some(text.to_owned());
    };
    let groups: Vec<&str> = text.split(separator).collect();
    let is_digits = |group: &&str| !group.is_empty() && group.bytes().all(|b| b.is_ascii_digit());
    let fits = groups.iter().all(is_digits)
        && groups[0].len() <= 3
        && groups[1..].iter().all(|g| g.len() == 3);
    fits.then(|| groups.concat())
}

/// A number of bytes; K, M, G and T after it are powers of 1024, as do KiB to TiB, and KB to TB for powers of 1000.
pub(super) fn bytes(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let upper = text.to_ascii_uppercase();
    let (rest, base) = match (upper.strip_suffix("IB"), upper.strip_suffix('B')) {
        (Some(rest), _) => (rest, Some(1024f64)),
        (None, Some(rest)) => (rest, Some(1000.0)),
        (None, None) => (upper.as_str(), None),
    };
    let power = rest
        .char_indices()
        .next_back()
        .and_then(|(i, unit)| Some((i, "KMGT".find(unit)? as i32 + 1)));
    let wrong =
        || format!("'{text}' is no number of bytes, such as 500M, 500MB or 500MiB (K, M, G or T)");
    match power {
        Some((i, power)) => {
            Ok(finite(&rest[..i]).map_err(|_| wrong())? * base.unwrap_or(1024.0).powi(power))
        }
        // `500B` are bytes, `500iB` is nothing.
        None if base != Some(1024.0) => finite(rest).map_err(|_| wrong()),
        None => Err(wrong()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_read_as_people_write_them() {
        let pairs = [
            ("20000", 20_000),
            ("20k", 20_000),
            ("20 K", 20_000),
            ("1.5M", 1_500_000),
            ("1.1M", 1_100_000),
            ("2G", 2_000_000_000),
            ("1e5", 100_000),
            ("20,000", 20_000),
            ("1_000_000", 1_000_000),
            ("18446744073709551615", u64::MAX),
            ("0", 0),
        ];
        for (text, expected) in pairs {
            assert_eq!(count(text), Ok(expected), "{text}");
        }
        let wrong = [
            "", "k", "1.5", "-1", "1,5", "20,00", ",000", "1e-3", "NaN", "inf", "1e30", "20kk",
            "0x10", "many",
        ];
        for bad in wrong {
            assert!(count(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn bytes_are_read_with_their_unit() {
        let pairs = [
            ("1", 1.0),
            ("2000", 2000.0),
            ("7B", 7.0),
            ("1K", 1024.0),
            ("1.5m", 1_572_864.0),
            ("2G", 2_147_483_648.0),
            ("1 T", 1_099_511_627_776.0),
            ("500MB", 5e8),
            ("500 mb", 5e8),
            ("1GiB", 1_073_741_824.0),
            ("1kib", 1024.0),
        ];
        for (text, expected) in pairs {
            assert_eq!(bytes(text), Ok(expected), "{text}");
        }
        for bad in ["G", "GB", "B", "2X", "2iB", "NaN", "", "ten MB"] {
            assert!(bytes(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn lengths_are_brought_to_the_unit_of_the_mesh() {
        let of = |text: &str, mesh| length(text).unwrap().in_unit_of(mesh);
        assert_eq!(of("0.05", None).unwrap(), 0.05);
        assert_eq!(of("0.05mm", Some(Unit::Mm)).unwrap(), 0.05);
        assert_eq!(of("0.05 mm", Some(Unit::Cm)).unwrap(), 0.005);
        assert_eq!(of("1in", Some(Unit::Mm)).unwrap(), 25.4);
        assert_eq!(of("2m", Some(Unit::Mm)).unwrap(), 2000.0);
        assert_eq!(of("50µm", Some(Unit::Mm)).unwrap(), 0.05);
        assert!(
            of("1mm", None)
                .unwrap_err()
                .to_string()
                .contains("--unit mm")
        );
        for bad in ["mm", "1 furlong", "1 mm mm", "inf mm", ""] {
            assert!(length(bad).is_err(), "{bad}");
        }
    }
}
