//! Moving particles by their shift.

use crate::particles::{Column, Shared, for_ranges};
use crate::simd::Real;

/// Adds `shift` to `position`; gives the length of the longest one in m, not a number if one is not finite.
pub fn apply_shift<R: Real, const D: usize>(
    position: &mut [Column<f64>; D],
    shift: &[Column<R>; D],
) -> f64 {
    let n = position[0].len();
    let columns = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut position[a]));
    let (longest, zero) = for_ranges(
        n,
        || (0.0, 0.0),
        // The second of a pair is zero or not a number, which its sum keeps; the first alone would lose it.
        |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1 + b.1),
        |range| {
            // SAFETY: the ranges of a pass are disjoint.
            let x = columns.map(|c| unsafe { c.range(&range) });
            let (mut longest, mut zero) = (0.0f64, 0.0);
            for (i, k) in range.clone().enumerate() {
                let mut square = 0.0;
                for a in 0..D {
                    let s = shift[a][k].to_f64();
                    x[a][i] += s;
                    square += s * s;
                }
                longest = longest.max(square);
                zero += 0.0 * square;
            }
            (longest, zero)
        },
    );
    longest.sqrt() + zero
}
