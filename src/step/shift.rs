//! Moving particles by their shift.

use crate::particles::{Column, Fluid, Shared, for_ranges, sum};
use crate::simd::Real;
use nalgebra::{Cholesky, SMatrix, SVector};
use std::ops::Range;

/// Added to the diagonal of the projection's matrix, over its trace: where all move alike, no rotation is seen and the
/// matrix is singular.
const RIDGE: f64 = 1e-12;
/// Solutions of the projection: each takes away what ridge and round-off left of the last.
const SOLUTIONS: usize = 3;

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
    // The fields that the projection adds: translations, and rotations of the relative velocity.
    let fields = |i: usize| -> [[f64; D]; K] {
        let v: [f64; D] = std::array::from_fn(|a| (velocity[a][i] - mean[a]) * inverse_scale);
        std::array::from_fn(|k| {
            if k < D {
                std::array::from_fn(|a| f64::from(u8::from(a == k)))
            } else if D == 2 {
                std::array::from_fn(|a| if a == 0 { -v[1] } else { v[0] })
            } else {
                let e = k - D;
                std::array::from_fn(|a| match (a + 3 - e) % 3 {
                    0 => 0.0,
                    1 => -v[(e + 2) % 3],
                    _ => v[(e + 1) % 3],
                })
            }
        })
    };
    let of = |i: usize| -> [f64; D] { std::array::from_fn(|a| shift[a][i].to_f64()) };
    let length = |s: &[f64; D]| s.iter().map(|s| s * s).sum::<f64>().sqrt();
    let moved = |i: usize, c: &SVector<f64, K>| -> [f64; D] {
        let s = of(i);
        let weight = length(&s);
        if weight == 0.0 {
            return s;
        }
        let fields = fields(i);
        std::array::from_fn(|a| s[a] + weight * (0..K).map(|k| c[k] * fields[k][a]).sum::<f64>())
    };
    let mut matrix = SMatrix::<f64, K, K>::zeros();
    for p in 0..K {
        let row: [f64; K] = sum(n, |i| {
            let fields = fields(i);
            let weight = mass[i].to_f64() * length(&of(i));
            std::array::from_fn(|q| {
                weight * (0..D).map(|a| fields[p][a] * fields[q][a]).sum::<f64>()
            })
        });
        for q in 0..K {
            matrix[(p, q)] = row[q];
        }
    }
    let ridge = RIDGE * matrix.trace();
    let factors = Cholesky::new(matrix + SMatrix::identity() * ridge);
    let mut coefficients = SVector::<f64, K>::zeros();
    if let Some(factors) = factors {
        for _ in 0..SOLUTIONS {
            let excess: [f64; K] = sum(n, |i| {
                let (s, fields, m) = (moved(i, &coefficients), fields(i), mass[i].to_f64());
                std::array::from_fn(|k| m * (0..D).map(|a| s[a] * fields[k][a]).sum::<f64>())
            });
            coefficients -= factors.solve(&SVector::from(excess));
        }
    }
    // Written into the columns of positions, which none of the above reads.
    let mut position: [Shared<f64>; D] =
        std::array::from_fn(|a| Shared::new(&mut fluid.position[a]));
    shifted(n, &mut position, |i| moved(i, &coefficients))
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
