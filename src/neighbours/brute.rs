//! The same pairs by comparing every point with every other: the reference of the neighbour search.

use super::search::{Axis, Neighbours, Periods, separation, wrapped};

/// All pairs within `radius` [m] (its end included), in time proportional to the square of the points.
///
/// Gives what [`neighbours`](super::search::neighbours) gives.
pub fn all_pairs<const D: usize>(
    position: &[[f64; D]],
    radius: f64,
    periodic: &Periods<D>,
) -> Neighbours {
    let axes: [Axis; D] = std::array::from_fn(|a| Axis::new(radius, periodic[a]));
    let radius_squared = radius * radius;
    let position: Vec<[f64; D]> = position.iter().map(|x| wrapped(&axes, x)).collect();
    Neighbours::by_row(position.len(), |i, row| {
        for (j, other) in position.iter().enumerate() {
            if j != i && separation(&axes, &position[i], other).1 <= radius_squared {
                row.push(j as u32);
            }
        }
    })
}
