//! Points as weighted sums of others.

use crate::vector::DVec3;

/// Points and the weights by which they are summed.
pub(crate) type Row = Vec<(u32, f64)>;

/// A row that names each point once, ascending, those of weight zero left out.
pub(crate) fn summed(mut row: Row) -> Row {
    // Stable, so that weights are always added in the order in which they came.
    row.sort_by_key(|&(point, _)| point);
    row.dedup_by(|next, sum| {
        let same = next.0 == sum.0;
        if same {
            sum.1 += next.1;
        }
        same
    });
    row.retain(|&(_, weight)| weight != 0.0);
    row
}

/// The point that a row gives.
pub(crate) fn sum(row: &Row, points: &[DVec3]) -> DVec3 {
    row.iter().fold(DVec3::ZERO, |sum, &(point, weight)| {
        sum + weight * points[point as usize]
    })
}
