//! Giving particles what they find where a shift has moved them.

use super::projection::{coefficients, freed, rigid_motions};
use crate::particles::{Column, Fluid, Shared, for_each_range, sum};
use crate::simd::Real;

/// Adds the changes of velocity (m/s) and of density over `reference_density` that a shift asks for, and leaves in their
/// columns what was added.
///
/// Particles keep their masses, so that the momentum `Σ m u` would change by what shifts push through gradients of the
/// velocity; the changes are first freed of that, by the least change to them, and where the fluid is `free` of walls and
/// periods of what they would add to the angular momentum. What conserves momentum by itself is `exact` and left as it is.
pub fn take_along<R: Real, const D: usize>(
    fluid: &mut Fluid<R, D>,
    velocity: &mut [Column<R>; D],
    condensation: Option<&Column<R>>,
    reference_density: f64,
    exact: bool,
    free: bool,
) {
    const { assert!(D == 2 || D == 3) };
    if !exact {
        match (D, free) {
            (2, false) => conserve::<R, D, 2>(fluid, velocity),
            (2, true) | (_, false) => conserve::<R, D, 3>(fluid, velocity),
            _ => conserve::<R, D, 6>(fluid, velocity),
        }
    }
    let n = fluid.len();
    let to = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut fluid.velocity[a]));
    let density = Shared::new(&mut fluid.density);
    let from = &*velocity;
    for_each_range(n, |range| {
        for a in 0..D {
            // SAFETY: the ranges of a pass are disjoint.
            let to = unsafe { to[a].range(&range) };
            for (v, change) in to.iter_mut().zip(&from[a][range.clone()]) {
                *v += change.to_f64();
            }
        }
        if let Some(change) = condensation {
            // SAFETY: as above.
            let to = unsafe { density.range(&range) };
            for (rho, change) in to.iter_mut().zip(&change[range]) {
                *rho += reference_density * change.to_f64();
            }
        }
    });
}

/// Frees changes of velocity of their momentum, and for `K > D` of their angular momentum.
fn conserve<R: Real, const D: usize, const K: usize>(
    fluid: &Fluid<R, D>,
    velocity: &mut [Column<R>; D],
) {
    let (n, mass, position) = (fluid.len(), &fluid.mass, &fluid.position);
    let totals: [f64; 4] = sum(n, |i| {
        let m = mass[i].to_f64();
        std::array::from_fn(|k| match k {
            3 => m,
            a if a < D => m * position[a][i],
            _ => 0.0,
        })
    });
    let centre: [f64; D] = std::array::from_fn(|a| totals[a] / totals[3]);
    let squares: [f64; 1] = sum(n, |i| {
        [(0..D)
            .map(|a| (position[a][i] - centre[a]).powi(2))
            .sum::<f64>()
            * mass[i].to_f64()]
    });
    let size = (squares[0] / totals[3]).sqrt();
    let inverse = if size > 0.0 { 1.0 / size } else { 0.0 };
    let fields = |i: usize| -> [[f64; D]; K] {
        rigid_motions(&std::array::from_fn(|a| {
            (position[a][i] - centre[a]) * inverse
        }))
    };
    let found = coefficients(
        n,
        |i| mass[i].to_f64(),
        |i| std::array::from_fn(|a| velocity[a][i].to_f64()),
        fields,
    );
    let columns = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut velocity[a]));
    for_each_range(n, |range| {
        // SAFETY: the ranges of a pass are disjoint.
        let parts = columns.map(|c| unsafe { c.range(&range) });
        for (k, i) in range.enumerate() {
            let change = std::array::from_fn(|a| parts[a][k].to_f64());
            let change = freed(change, || fields(i), &found);
            for a in 0..D {
                parts[a][k] = R::from_f64(change[a]);
            }
        }
    });
}
