//! Numbers and tables in words for people: thousands separated, counts with their noun, columns aligned.

pub(crate) use limitmesh_paper::format::{counted, thousands};

/// Six significant digits, without a tail of zeros: enough to compare, short enough to read.
pub(crate) fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e9).contains(&x.abs()) {
        return format!("{x:.5e}");
    }
    let decimals = (5 - x.abs().log10().floor() as i64).clamp(0, 9) as usize;
    without_zeros(&format!("{x:.decimals$}")).to_owned()
}

/// Digits without a tail of zeros after the point.
fn without_zeros(text: &str) -> &str {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

/// Digits of a bound, of which more would not be looked at.
const BOUND_DIGITS: i32 = 4;

/// An upper bound in four digits, rounded up: what is printed bounds as well.
pub(crate) fn upper_bound(x: f64) -> String {
    bound(x, f64::ceil)
}

/// A lower bound in four digits, rounded down.
pub(crate) fn lower_bound(x: f64) -> String {
    bound(x, f64::floor)
}

fn bound(x: f64, round: impl Fn(f64) -> f64) -> String {
    if !(x > 0.0 && x.is_finite()) {
        return number(x);
    }
    let exponent = x.log10().floor() as i32 - BOUND_DIGITS + 1;
    let power = 10f64.powi(exponent.abs());
    let digits = round(if exponent < 0 { x * power } else { x / power });
    // The digits and the power as text: no rounding by a multiplication.
    format!("{digits:.0}e{exponent}")
        .parse()
        .map_or_else(|_| number(x), short)
}

/// Digits of an interval's ends, at least and at most: a number has little more than fifteen.
const INTERVAL_DIGITS: [f64; 2] = [6.0, 15.0];

/// The ends of an interval, rounded outwards, in so many digits that it is hardly wider than it was.
pub(crate) fn interval(lower: f64, upper: f64) -> [String; 2] {
    let [fewest, most] = INTERVAL_DIGITS;
    let digits = |end: f64| {
        (100.0 * end / (upper - lower))
            .log10()
            .ceil()
            .max(fewest)
            .min(most) as usize
    };
    [
        outwards(lower, digits(lower), -1.0),
        outwards(upper, digits(upper), 1.0),
    ]
}

/// A number in so many digits, by the sign rounded up or down.
fn outwards(x: f64, digits: usize, sign: f64) -> String {
    if !(x > 0.0 && x.is_finite()) {
        return number(x);
    }
    let in_digits = |x: f64| format!("{x:.*e}", digits - 1).parse().unwrap_or(x);
    let (nearest, exponent): (f64, f64) = (in_digits(x), x.log10().floor());
    let unit = 10f64.powf(exponent + 1.0 - digits as f64);
    let rounded = if sign * nearest < sign * x {
        in_digits(nearest + sign * unit)
    } else {
        nearest
    };
    if !(1e-4..1e9).contains(&rounded) {
        return format!("{rounded:.*e}", digits - 1);
    }
    let decimals = (digits as f64 - 1.0 - exponent).max(0.0) as usize;
    without_zeros(&format!("{rounded:.decimals$}")).to_owned()
}

/// [`number`] without a tail of zeros before an exponent either.
fn short(x: f64) -> String {
    let text = number(x);
    match text.split_once('e') {
        Some((digits, exponent)) => format!("{}e{exponent}", without_zeros(digits)),
        None => text,
    }
}

/// Bytes with a unit that suits them, in powers of 1024.
pub(crate) fn bytes(n: usize) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
    let (mut value, mut unit) = (n as f64, 0);
    while value >= 1000.0 && unit + 1 < units.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 {
        format!("{n} bytes")
    } else {
        format!("{value:.*} {}", usize::from(value < 10.0), units[unit])
    }
}

/// `(x, y, z)`.
pub(crate) fn point(p: [f64; 3]) -> String {
    format!("({}, {}, {})", number(p[0]), number(p[1]), number(p[2]))
}

/// Seconds with a unit that suits them.
pub(crate) fn seconds(s: f64) -> String {
    if s < 0.001 {
        format!("{:.0} µs", s * 1e6)
    } else if s < 1.0 {
        format!("{:.1} ms", s * 1e3)
    } else {
        format!("{s:.2} s")
    }
}

/// Rows of cells as lines: the first column to the left, the others to the right, two spaces between.
pub(crate) fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter()
            .filter_map(|row| row.get(column))
            .map(|c| c.chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, &width)) in row.iter().zip(&widths).enumerate() {
            if column == 0 {
                line.push_str(&format!("{cell:<width$}"));
            } else {
                line.push_str(&format!("  {cell:>width$}"));
            }
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_six_digits_and_lose_zeros() {
        let pairs = [
            (0.0, "0"),
            (1.0, "1"),
            (-0.5, "-0.5"),
            (1234.5678, "1234.57"),
            (0.001_234_567, "0.00123457"),
            (120.0, "120"),
            (1e-9, "1.00000e-9"),
        ];
        for (x, text) in pairs {
            assert_eq!(number(x), text);
        }
    }

    #[test]
    fn bounds_are_rounded_outwards() {
        let pairs = [
            (0.099_999_9, "0.1", "0.09999"),
            (0.012_345_6, "0.01235", "0.01234"),
            (1234.5, "1235", "1234"),
            (98_765.4, "98770", "98760"),
            (0.5, "0.5", "0.5"),
            (0.0, "0", "0"),
            (1.234_56e-10, "1.235e-10", "1.234e-10"),
            (2e-8, "2e-8", "2e-8"),
        ];
        for (x, above, below) in pairs {
            assert_eq!(
                (upper_bound(x).as_str(), lower_bound(x).as_str()),
                (above, below),
                "{x}"
            );
        }
    }

    #[test]
    fn intervals_are_hardly_wider_than_they_were() {
        let texts = [
            ([4.999_999_999_8, 5.000_002_4], ["4.99999999", "5.0000024"]),
            ([0.25, 0.3], ["0.25", "0.3"]),
            ([0.0, 1e-7], ["0", "1.00000e-7"]),
            ([1_234.567_891_23, 1234.6], ["1234.567", "1234.6"]),
            ([0.1, 0.1], ["0.1", "0.1"]),
            ([0.0, 0.0], ["0", "0"]),
        ];
        for ([lower, upper], expected) in texts {
            assert_eq!(interval(lower, upper), expected, "{lower} {upper}");
        }
        for i in 1..2000 {
            let lower = 1.1f64.powi(i % 400 - 200) * (1.0 + f64::from(i) / 3000.0);
            let upper = lower * (1.0 + 0.3 * 0.5f64.powi(i % 41));
            let [from, to] =
                interval(lower, upper).map(|end| end.parse::<f64>().expect("a number"));
            assert!(
                from <= lower && upper <= to,
                "{i}: {from} {lower} {upper} {to}"
            );
            assert!(
                to - from <= 1.3 * (upper - lower) + 2e-14 * upper,
                "{i}: {from} {lower} {upper} {to}"
            );
        }
    }

    #[test]
    fn bytes_have_a_unit() {
        let pairs = [
            (0, "0 bytes"),
            (999, "999 bytes"),
            (1024, "1.0 KiB"),
            (5 << 30, "5.0 GiB"),
            (90 << 20, "90 MiB"),
        ];
        for (n, text) in pairs {
            assert_eq!(bytes(n), text);
        }
    }

    #[test]
    fn columns_line_up() {
        let rows = [
            vec!["a".to_owned(), "10".to_owned()],
            vec!["long".to_owned(), "7".to_owned()],
        ];
        assert_eq!(table(&rows), "a     10\nlong   7\n");
    }
}
