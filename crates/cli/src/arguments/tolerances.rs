//! Tolerances of what a mesh carries.

use std::str::FromStr;

use super::{Extent, values};

/// How far texture coordinates may be off, in units of the chart: given so, or in texels of a texture so many texels wide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TextureTolerance(pub(crate) f64);

impl FromStr for TextureTolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some((texels, size)) = text.split_once('@') else {
            return values::above_zero(text).map(Self);
        };
        Ok(Self(
            values::above_zero(texels)? / values::positive(size)? as f64,
        ))
    }
}

/// How far the values of a channel may be off.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AttributeTolerance {
    pub(crate) name: String,
    pub(crate) tolerance: f64,
}

impl FromStr for AttributeTolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Names may have an equals sign, numbers have none.
        let Some((name, tolerance)) = text.rsplit_once('=') else {
            return Err(format!("'{text}' has no =; give NAME=NUMBER"));
        };
        Ok(Self {
            name: name.to_owned(),
            tolerance: values::above_zero(tolerance)?,
        })
    }
}

/// How far moved surfaces may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum MorphTolerance {
    /// Whatever comes of it.
    None,
    /// As a length of the scene.
    Within(Extent),
}

impl FromStr for MorphTolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            Ok(Self::None)
        } else {
            values::tolerance(text).map(Self::Within)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_read() {
        assert_eq!("0.002".parse(), Ok(TextureTolerance(0.002)));
        assert_eq!("0.5@2k".parse(), Ok(TextureTolerance(0.00025)));
        for wrong in ["0", "-1", "nan", "inf", "1@0", "@", "1@2@3", "x"] {
            assert!(wrong.parse::<TextureTolerance>().is_err(), "{wrong}");
        }
        let expected = AttributeTolerance {
            name: "a=b".to_owned(),
            tolerance: 0.1,
        };
        assert_eq!("a=b=0.1".parse(), Ok(expected));
        assert!(
            "a".parse::<AttributeTolerance>()
                .is_err_and(|why| why.contains("no ="))
        );
        assert_eq!("none".parse(), Ok(MorphTolerance::None));
        assert_eq!(
            "1%".parse(),
            Ok(MorphTolerance::Within(Extent::Percent(1.0)))
        );
        assert!("-1".parse::<MorphTolerance>().is_err());
    }
}
