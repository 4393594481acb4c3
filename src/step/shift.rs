//! Moving particles by their shift.

use super::projection::{coefficients, freed, rigid_motions};
use crate::particles::{Column, Fluid, Shared, for_ranges, sum};
use crate::simd::Real;
use std::ops::Range;

/// Adds `shift` to `position`; gives the length of the longest one in m, not a number if one is not finite.
pub fn apply_shift<R: Real, const D: usize>(
    position: &mut [Column<f64>; D],
    shift: &[Column<R>; D],
) -> f64 {
    move_by(position, |i| std::array::from_fn(|a| shift[a][i].to_f64()))
}

/// The same for a fluid that nothing holds: the shift is first freed of what it would add to the centre of mass and to
/// the angular momentum, by the least change to it,
/// `δr_i + |δr_i| (a + ω × (u_i - ū))` with `Σ m δr = 0` and `Σ m δr × (u - ū) = 0`.
///
/// A shift moves particles and leaves them their velocities, so that `Σ m r × u` would change by `Σ m δr × u`.
pub fn apply_shift_of_free_fluid<R: Real, const D: usize>(fluid: &mut Fluid<R, D>) -> f64 {
    const { assert!(D == 2 || D == 3) };
    if D == 2 {
        project::<R, D, 3>(fluid)
    } else {
        project::<R, D, 6>(fluid)
    }
}

fn project<R: Real, const D: usize, const K: usize>(fluid: &mut Fluid<R, D>) -> f64 {
    let Some(shift) = &fluid.shift else {
        return 0.0;
    };
    let (n, velocity, mass) = (fluid.id.len(), &fluid.velocity, &fluid.mass);
    let totals: [f64; 4] = sum(n, |i| {
        let m = mass[i].to_f64();
        std::array::from_fn(|k| match k {
            3 => m,
            a if a < D => m * velocity[a][i],
            _ => 0.0,
        })
    });
    let mean: [f64; D] = std::array::from_fn(|a| totals[a] / totals[3]);
    let speed2: [f64; 1] = sum(n, |i| {
        [(0..D)
            .map(|a| (velocity[a][i] - mean[a]).powi(2))
            .sum::<f64>()
            * mass[i].to_f64()]
    });
    let scale = (speed2[0] / totals[3]).sqrt();
    let inverse_scale = if scale > 0.0 { 1.0 / scale } else { 0.0 };
    // What the projection adds: translations, and rotations of the relative velocity.
    let fields = |i: usize| -> [[f64; D]; K] {
        let v: [f64; D] = std::array::from_fn(|a| (velocity[a][i] - mean[a]) * inverse_scale);
        rigid_motions(&v)
    };
    let of = |i: usize| -> [f64; D] { std::array::from_fn(|a| shift[a][i].to_f64()) };
    let coefficients = coefficients(n, |i| mass[i].to_f64(), of, fields);
    // Written into the columns of positions, which none of the above reads.
    let mut position: [Shared<f64>; D] =
        std::array::from_fn(|a| Shared::new(&mut fluid.position[a]));
    shifted(n, &mut position, |i| {
        freed(of(i), || fields(i), &coefficients)
    })
}

fn move_by<const D: usize>(
    position: &mut [Column<f64>; D],
    by: impl Fn(usize) -> [f64; D] + Sync + Send,
) -> f64 {
    let n = position[0].len();
    let mut columns = std::array::from_fn(|a| Shared::new(&mut position[a]));
    shifted(n, &mut columns, by)
}

/// Moves `n` particles, and gives the longest way.
fn shifted<const D: usize>(
    n: usize,
    columns: &mut [Shared<f64>; D],
    by: impl Fn(usize) -> [f64; D] + Sync + Send,
) -> f64 {
    let columns = *columns;
    let work = |range: Range<usize>| {
        // SAFETY: the ranges of a pass are disjoint, and the columns outlive it.
        let x = columns.map(|c| unsafe { c.range(&range) });
        let (mut longest, mut zero) = (0.0f64, 0.0);
        for (i, k) in range.clone().enumerate() {
            let s = by(k);
            let mut square = 0.0;
            for a in 0..D {
                x[a][i] += s[a];
                square += s[a] * s[a];
            }
            longest = longest.max(square);
            zero += 0.0 * square;
        }
        (longest, zero)
    };
    // The second is zero or not a number, which its sum keeps; the longest alone would lose it.
    let join = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1 + b.1);
    let (longest, zero) = for_ranges(n, || (0.0, 0.0), join, work);
    longest.sqrt() + zero
}
