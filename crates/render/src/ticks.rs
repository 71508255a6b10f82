//! Ticks at round numbers for axes and colour bars, and how numbers are written beside them.

/// A tick: where it is and what stands beside it; minor ticks have no label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: Option<String>,
}

/// About `count` ticks at multiples of 1, 2 or 5 times a power of ten within `low..=high`.
pub(crate) fn linear(low: f64, high: f64, count: usize) -> Vec<Tick> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) || count == 0 {
        let label = Some(number(low));
        return vec![Tick { value: low, label }];
    }
    let rough = span / count as f64;
    let mut exponent = rough.log10().floor() as i32;
    let mantissa = match rough / 10f64.powi(exponent) {
        m if m < 1.5 => 1.0,
        m if m < 3.5 => 2.0,
        m if m < 7.5 => 5.0,
        _ => {
            exponent += 1;
            1.0
        }
    };
    let step = mantissa * 10f64.powi(exponent);
    // Rounding may leave an end of the range a hair outside of its own tick.
    let slack = 1e-9;
    let (first, last) = ((low / step - slack).ceil(), (high / step + slack).floor());
    // Steps below the numbers' own resolution cannot be told apart.
    if !(last - first).is_finite() || first.abs().max(last.abs()) > 1e12 {
        let mut ends = [low, high]
            .map(|value| Tick {
                value,
                label: Some(number(value)),
            })
            .to_vec();
        ends.dedup_by(|b, a| a.label == b.label);
        return ends;
    }
    let largest = low.abs().max(high.abs());
    let ticks = (first as i64..=last as i64).map(|i| {
        let value = i as f64 * mantissa * 10f64.powi(exponent);
        Tick {
            value,
            label: Some(in_steps(i, mantissa, exponent, largest)),
        }
    });
    ticks.collect()
}

/// Writes i · mantissa · 10^exponent: with fixed decimals where that stays short, else as a product with a power
/// of ten that all ticks share.
fn in_steps(i: i64, mantissa: f64, exponent: i32, largest: f64) -> String {
    let magnitude = largest.log10().floor() as i32;
    let whole = i as f64 * mantissa;
    if (-3..6).contains(&magnitude) && exponent > -6 {
        let decimals = (-exponent).max(0) as usize;
        minus(format!("{:.decimals$}", whole * 10f64.powi(exponent)))
    } else if i == 0 {
        "0".into()
    } else {
        let decimals = (magnitude - exponent).max(0) as usize;
        let shown = whole * 10f64.powi(exponent - magnitude);
        format!(
            "{}×10{}",
            minus(format!("{shown:.decimals$}")),
            raised(magnitude)
        )
    }
}

/// Ticks of a logarithmic axis: labelled decades (thinned out to about `count`), their multiples unlabelled;
/// on less than two decades the multiples 2 and 5 are labelled too.
pub(crate) fn logarithmic(low: f64, high: f64, count: usize) -> Vec<Tick> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let decades = (high / low).log10();
    let every = ((decades / count.max(1) as f64).ceil() as i32).max(1);
    // One way of writing for the whole axis: plain numbers where all are short, else powers of ten.
    let plain = low >= 9.99e-4 && high <= 1.001e5;
    let mut ticks = Vec::new();
    for exponent in first..=last {
        for digit in 1..10 {
            let value = f64::from(digit) * 10f64.powi(exponent);
            if value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9) {
                continue;
            }
            let decade = digit == 1 && exponent.rem_euclid(every) == 0;
            let between = decades < 2.0 && (digit == 2 || digit == 5) || decades < 0.7;
            if decade || (between && every == 1) {
                ticks.push(Tick {
                    value,
                    label: Some(power_label(digit, exponent, plain)),
                });
            } else if every == 1 || digit == 1 {
                ticks.push(Tick { value, label: None });
            }
        }
    }
    ticks
}

fn power_label(digit: i32, exponent: i32, plain: bool) -> String {
    match digit {
        _ if plain => number(f64::from(digit) * 10f64.powi(exponent)),
        1 => format!("10{}", raised(exponent)),
        _ => format!("{digit}×10{}", raised(exponent)),
    }
}

/// A number with up to four significant digits and a real minus sign.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-3..6).contains(&magnitude) {
        let shown = trimmed(format!("{:.3}", value / 10f64.powi(magnitude)));
        return format!("{}×10{}", minus(shown), raised(magnitude));
    }
    minus(trimmed(format!(
        "{value:.*}",
        (3 - magnitude).max(0) as usize
    )))
}

fn trimmed(text: String) -> String {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').into()
    } else {
        text
    }
}

/// A hyphen becomes a minus sign, and "−0.0" loses it.
fn minus(text: String) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().any(|c| c.is_ascii_digit() && c != '0') => format!("−{rest}"),
        Some(rest) => rest.into(),
        None => text,
    }
}

/// An integer in raised characters.
fn raised(value: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let one = |c: char| c.to_digit(10).map_or('⁻', |digit| digits[digit as usize]);
    value.to_string().chars().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(ticks: &[Tick]) -> Vec<&str> {
        ticks.iter().filter_map(|t| t.label.as_deref()).collect()
    }

    #[test]
    fn round_numbers_on_a_linear_scale() {
        assert_eq!(
            labels(&linear(0.0, 1.0, 5)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(labels(&linear(-3.0, 7.0, 5)), ["−2", "0", "2", "4", "6"]);
        assert_eq!(labels(&linear(0.0, 0.0009, 4))[1], "2×10⁻⁴");
        assert_eq!(
            labels(&linear(0.0, 3e7, 3)),
            ["0", "1×10⁷", "2×10⁷", "3×10⁷"]
        );
        assert_eq!(labels(&linear(5.0, 5.0, 3)), ["5"]);
    }

    #[test]
    fn decades_on_a_logarithmic_scale() {
        assert_eq!(
            labels(&logarithmic(1e-4, 1e2, 8)),
            ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹", "10²"]
        );
        assert_eq!(
            labels(&logarithmic(1.0, 20.0, 8)),
            ["1", "2", "5", "10", "20"]
        );
        assert_eq!(
            labels(&logarithmic(0.01, 1e4, 8)),
            ["0.01", "0.1", "1", "10", "100", "1000", "10000"]
        );
        assert_eq!(logarithmic(1.0, 1000.0, 8).len(), 28);
    }

    #[test]
    fn numbers_as_people_write_them() {
        let cases = [
            (0.0, "0"),
            (-1.5, "−1.5"),
            (1234.5, "1234"),
            (0.012_345, "0.01235"),
            (1.5e-7, "1.5×10⁻⁷"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }

    proptest! {
        #[test]
        fn linear_ticks_are_within_the_range_evenly_spaced_and_few(
            low in -1e6f64..1e6, exponent in -6i32..6, count in 2usize..12
        ) {
            let high = low + 10f64.powi(exponent);
            let ticks = linear(low, high, count);
            prop_assert!(ticks.len() <= 2 * count + 2);
            let slack = 1e-8 * (high - low) + 1e-9 * low.abs();
            for tick in &ticks {
                prop_assert!(tick.value >= low - slack && tick.value <= high + slack);
            }
            for pair in ticks.windows(2) {
                prop_assert!(pair[0].label != pair[1].label);
            }
        }
    }
}
