//! What the measured numbers say, counted: the sentences on the page are made from these.

use super::numbers::Results;
use super::study::{DriftPoint, Row};

/// Ratios this near to 100 % are equal: sampling cannot tell them apart, and the page prints tenths.
const EQUAL_WITHIN: f64 = 0.05;

/// How a ratio compares with 100 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Against {
    Below,
    Equal,
    Above,
}

/// How a ratio in per cent compares with 100.
pub(super) fn against(ratio_percent: f64) -> Against {
    if (ratio_percent - 100.0).abs() < EQUAL_WITHIN {
        Against::Equal
    } else if ratio_percent < 100.0 {
        Against::Below
    } else {
        Against::Above
    }
}

/// Table 1 in counts.
pub(super) struct Table1Statistics<'a> {
    pub(super) rows: Vec<&'a Row>,
    pub(super) below: usize,
    pub(super) equal: usize,
    pub(super) above: Vec<&'a Row>,
    /// Least, median and greatest ratio.
    pub(super) ratios: [f64; 3],
    /// Rows in which uniform refinement with limit vertices is nearer to the limit surface.
    pub(super) uniform_nearer: usize,
    /// Of these, rows in which it also has no more faces.
    pub(super) uniform_nearer_and_smaller: usize,
    /// Least, median and greatest factor from its distance to the paper's method's.
    pub(super) uniform_factors: [f64; 3],
    /// Rows in which exact refinement is nearer to the limit surface than the paper's method, with no more faces.
    pub(super) exact_nearer: usize,
    /// Least, median and greatest factor from its distance to the paper's method's.
    pub(super) exact_factors: [f64; 3],
    /// Rows whose Amresh count is more than 1 % off, with the difference in per cent.
    pub(super) unmatched: Vec<(&'a Row, f64)>,
    /// Greatest difference of the counts, in per cent.
    pub(super) worst_match: f64,
}

impl<'a> Table1Statistics<'a> {
    pub(super) fn new(results: &'a Results) -> Self {
        let rows: Vec<&Row> = results.rows().collect();
        let count = |what: Against| {
            rows.iter()
                .filter(|r| against(r.ratio_percent) == what)
                .count()
        };
        let nearer = |r: &&&Row| r.uniform_limit.shd_percent < r.paper.shd_percent;
        let off = |r: &Row| 100.0 * (r.amresh.faces as f64 / r.paper.faces as f64 - 1.0);
        let factor =
            |r: &&Row| r.paper.shd_percent / r.uniform_limit.shd_percent.max(f64::MIN_POSITIVE);
        Self {
            below: count(Against::Below),
            equal: count(Against::Equal),
            above: rows
                .iter()
                .filter(|r| against(r.ratio_percent) == Against::Above)
                .copied()
                .collect(),
            ratios: spread(rows.iter().map(|r| r.ratio_percent)),
            uniform_nearer: rows.iter().filter(nearer).count(),
            uniform_nearer_and_smaller: rows
                .iter()
                .filter(nearer)
                .filter(|r| r.uniform_limit.faces <= r.paper.faces)
                .count(),
            uniform_factors: spread(rows.iter().map(factor)),
            exact_nearer: rows
                .iter()
                .filter(|r| {
                    r.exact.shd_percent < r.paper.shd_percent && r.exact.faces <= r.paper.faces
                })
                .count(),
            exact_factors: spread(
                rows.iter()
                    .map(|r| r.paper.shd_percent / r.exact.shd_percent.max(f64::MIN_POSITIVE)),
            ),
            unmatched: rows
                .iter()
                .map(|&r| (r, off(r)))
                .filter(|(_, off)| off.abs() > 1.0)
                .collect(),
            worst_match: rows.iter().map(|r| off(r).abs()).fold(0.0, f64::max),
            rows,
        }
    }
}

/// Least, median and greatest; the median of an even number is the mean of the two in the middle.
pub(super) fn spread(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else {
        return [0.0; 3];
    };
    let half = values.len() / 2;
    let median = if values.len() % 2 == 1 {
        values[half]
    } else {
        0.5 * (values[half - 1] + values[half])
    };
    [first, median, last]
}

/// How often a distance grows from one step to the next: (rises, steps compared).
pub(super) fn rises<'a>(
    points: impl Iterator<Item = &'a DriftPoint> + Clone,
    value: impl Fn(&DriftPoint) -> Option<f64>,
) -> (usize, usize) {
    let pairs = points
        .clone()
        .zip(points.skip(1))
        .filter(|(a, b)| a.model == b.model && a.steps + 1 == b.steps);
    let known = pairs.filter_map(|(a, b)| Some((value(a)?, value(b)?)));
    known.fold((0, 0), |(rises, all), (a, b)| {
        (rises + usize::from(b > a), all + 1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_stands_in_the_middle() {
        assert_eq!(spread([3.0, 1.0, 2.0].into_iter()), [1.0, 2.0, 3.0]);
        assert_eq!(spread([4.0, 1.0, 2.0, 3.0].into_iter()), [1.0, 2.5, 4.0]);
        assert_eq!(spread(std::iter::empty()), [0.0; 3]);
    }

    #[test]
    fn equal_is_what_prints_alike() {
        assert_eq!(against(100.04), Against::Equal);
        assert_eq!(against(99.9), Against::Below);
        assert_eq!(against(100.1), Against::Above);
    }
}
