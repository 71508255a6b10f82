//! Tables in Markdown, and the numbers in them.

pub(crate) use limitmesh_paper::format::thousands as count;

/// Prints a table: heads, then rows.
pub(crate) fn print(heads: &[&str], rows: &[Vec<String>]) {
    begin(heads);
    rows.iter().for_each(|row| print_row(row));
}

/// Prints a table's heads; its rows follow as they are measured, so that a run of minutes that is cut short has said something.
pub(crate) fn begin(heads: &[&str]) {
    println!("\n| {} |", heads.join(" | "));
    println!("|{}", "---|".repeat(heads.len()));
}

/// Prints a row of a table.
pub(crate) fn print_row(row: &[String]) {
    println!("| {} |", row.join(" | "));
}

/// Three significant digits.
pub(crate) fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let before_the_point = value.abs().log10().floor() as i32 + 1;
    format!("{value:.*}", (3 - before_the_point).max(0) as usize)
}

/// The middle value, the mean of both where there are two; NaN of none.
pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n => 0.5 * (values[(n - 1) / 2] + values[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(digits(0.012345), "0.0123");
        assert_eq!(digits(1.23456), "1.23");
        assert_eq!(digits(1234.56), "1235");
        assert_eq!(median([3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median([4.0, 1.0, 2.0, 3.0]), 2.5);
    }
}
