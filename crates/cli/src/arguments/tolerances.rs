//! Tolerances of what a mesh carries.

use std::str::FromStr;

use super::values::{self, Extent, named};

/// How far the values of a channel may be off.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AttributeTolerance {
    pub(crate) name: String,
    pub(crate) tolerance: f64,
}

impl FromStr for AttributeTolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, tolerance) = named(text, "NUMBER or TEXELS@SIZE")?;
        let tolerance = match tolerance.split_once('@') {
            Some((texels, size)) => values::above_zero(texels)? / values::positive(size)? as f64,
            None => values::above_zero(tolerance)?,
        };
        Ok(Self {
            name: name.to_owned(),
            tolerance,
        })
    }
}

/// How far moved surfaces may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum MorphTolerance {
    /// Any distance does.
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
        let tolerance = |name: &str, tolerance| {
            let name = name.to_owned();
            Ok(AttributeTolerance { name, tolerance })
        };
        assert_eq!("a=b=0.1".parse(), tolerance("a=b", 0.1));
        assert_eq!("uv=0.5@2k".parse(), tolerance("uv", 0.00025));
        for wrong in [
            "a", "a=0", "a=-1", "a=nan", "a=inf", "a=1@0", "a=@", "a=1@2@3", "a=x",
        ] {
            assert!(wrong.parse::<AttributeTolerance>().is_err(), "{wrong}");
        }
        assert_eq!("none".parse(), Ok(MorphTolerance::None));
        let percent = MorphTolerance::Within(Extent::Percent(1.0));
        assert_eq!("1%".parse(), Ok(percent));
        assert!("-1".parse::<MorphTolerance>().is_err());
    }
}
