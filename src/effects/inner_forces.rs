//! Forces of a liquid on itself, freed of what they would add to its momentum.

use crate::particles::{Column, Shared, for_each_range, sum};
use crate::simd::Real;
use crate::step::projection::{coefficients, freed, rigid_motions};

/// Takes from the accelerations `by` what they add to momentum and, if it `turns` freely, to angular momentum, by the least
/// change to them, `a_i + |a_i| (b + ω × (x_i - x̄))`, and adds them to `acceleration`.
pub(super) fn accelerate_freely<R: Real, const D: usize>(
    position: &[Column<f64>; D],
    mass: &Column<R>,
    by: &[Column<R>; D],
    turns: bool,
    acceleration: &mut [Column<R>; D],
) {
    const { assert!(D == 2 || D == 3) };
    match (turns, D) {
        (false, 2) => project::<R, D, 2>(position, mass, by, acceleration),
        (false, _) | (true, 2) => project::<R, D, 3>(position, mass, by, acceleration),
        (true, _) => project::<R, D, 6>(position, mass, by, acceleration),
    }
}

fn project<R: Real, const D: usize, const K: usize>(
    position: &[Column<f64>; D],
    mass: &Column<R>,
    by: &[Column<R>; D],
    acceleration: &mut [Column<R>; D],
) {
    let n = mass.len();
    let of = |i: usize| -> [f64; D] { std::array::from_fn(|a| by[a][i].to_f64()) };
    let strength = |i: usize| {
        let square: f64 = of(i).iter().map(|v| v * v).sum();
        mass[i].to_f64() * square.sqrt()
    };
    let totals: [f64; 4] = sum(n, |i| {
        let m = strength(i);
        std::array::from_fn(|k| match k {
            3 => m,
            a if a < D => m * position[a][i],
            _ => 0.0,
        })
    });
    if totals[3] == 0.0 {
        return;
    }
    // The mean place of the forces, and how far around it they are: numbers of order one for the projection.
    let mean: [f64; D] = std::array::from_fn(|a| totals[a] / totals[3]);
    let [spread] = sum(n, |i| {
        let square: f64 = (0..D).map(|a| (position[a][i] - mean[a]).powi(2)).sum();
        [square * strength(i)]
    });
    let scale = (spread / totals[3]).sqrt();
    let inverse_scale = if scale > 0.0 { 1.0 / scale } else { 0.0 };
    let fields = |i: usize| -> [[f64; D]; K] {
        let x: [f64; D] = std::array::from_fn(|a| (position[a][i] - mean[a]) * inverse_scale);
        rigid_motions(&x)
    };
    let coefficients = coefficients(n, |i| mass[i].to_f64(), of, fields);
    let to = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut acceleration[a]));
    for_each_range(n, |range| {
        // SAFETY: the ranges of a pass are disjoint.
        let to = to.map(|c| unsafe { c.range(&range) });
        for (k, i) in range.enumerate() {
            let force = freed(of(i), || fields(i), &coefficients);
            for a in 0..D {
                to[a][k] += R::from_f64(force[a]);
            }
        }
    });
}
