//! Fields between the particles.

use super::Cloud;
use rayon::prelude::*;

/// `Σ_j V_j f_j W(x - x_j)` at every point, by default divided by `Σ_j V_j W(x - x_j)` (Shepard 1968), which is exact
/// for constant fields.
///
/// `value` holds `columns` numbers per particle, and so does the result per point. Points that no kernel reaches get
/// `outside`.
pub fn interpolate<const D: usize>(
    cloud: &Cloud<D>,
    points: &[[f64; D]],
    value: &[f64],
    columns: usize,
    normalise: bool,
    outside: f64,
) -> Vec<f64> {
    assert_eq!(value.len(), cloud.len() * columns);
    let mut result = vec![0.0; points.len() * columns];
    if columns == 0 {
        return result;
    }
    let rows = result.par_chunks_mut(columns).with_min_len(256).zip(points);
    rows.for_each(|(sum, x)| {
        let mut whole = 0.0;
        cloud.for_each_near(x, |j, _, r| {
            let weight = cloud.volume[j] * cloud.kernel.value(r);
            whole += weight;
            for (sum, f) in sum.iter_mut().zip(&value[j * columns..]) {
                *sum += weight * f;
            }
        });
        if whole == 0.0 {
            sum.fill(outside);
        } else if normalise {
            sum.iter_mut().for_each(|sum| *sum /= whole);
        }
    });
    result
}
