//! Gradient, divergence and Laplacian at the particles, plain or corrected.

use super::Cloud;
use super::correction::{add_moment, moment, pseudo_inverse, times};
use rayon::prelude::*;

/// `Σ_j V_j (f_j - f_i) L_i ∇W_ij`, exact for linear fields; without the correction, `L_i = 1`.
///
/// `value` holds `columns` numbers per particle; the result holds `columns` vectors per particle: entry
/// `(i, c, a)` is `∂f_c/∂x_a`.
pub fn gradient<const D: usize>(
    cloud: &Cloud<D>,
    value: &[f64],
    columns: usize,
    corrected: bool,
) -> Vec<f64> {
    assert_eq!(value.len(), cloud.len() * columns);
    let mut result = vec![[0.0; D]; cloud.len() * columns];
    if columns > 0 {
        let rows = result.par_chunks_mut(columns).with_min_len(256).enumerate();
        rows.for_each(|(i, row)| gradient_at(cloud, value, corrected, i, row));
    }
    result.into_flattened()
}

fn gradient_at<const D: usize>(
    cloud: &Cloud<D>,
    value: &[f64],
    corrected: bool,
    i: usize,
    row: &mut [[f64; D]],
) {
    let columns = row.len();
    let mut matrix = [[0.0; D]; D];
    cloud.for_each_neighbour(i, |j, d, _, slope| {
        let weight = cloud.volume[j] * slope;
        add_moment(&mut matrix, -weight, &d);
        for (c, sum) in row.iter_mut().enumerate() {
            let difference = weight * (value[j * columns + c] - value[i * columns + c]);
            for a in 0..D {
                sum[a] += difference * d[a];
            }
        }
    });
    if corrected {
        let inverse = pseudo_inverse(&matrix);
        for sum in row {
            *sum = times(&inverse, sum);
        }
    }
}

/// `Σ_j V_j (u_j - u_i) · L_i ∇W_ij`, exact for linear fields; without the correction, `L_i = 1`.
pub fn divergence<const D: usize>(
    cloud: &Cloud<D>,
    vector: &[[f64; D]],
    corrected: bool,
) -> Vec<f64> {
    assert_eq!(vector.len(), cloud.len());
    let value = vector.as_flattened();
    cloud.map(|i| {
        let mut row = [[0.0; D]; D];
        gradient_at(cloud, value, corrected, i, &mut row);
        (0..D).map(|a| row[a][a]).sum()
    })
}

/// `2 Σ_j V_j (f_i - f_j) F_ij` (Brookshaw 1985; Morris, Fox & Zhu 1997).
///
/// Corrected, the linear part is taken out, `f_i - f_j - ⟨∇f⟩_i · r_ij` with the corrected gradient, and the sum is
/// divided by `tr M_i / D` with `M_i = -Σ_j V_j r_ij ⊗ ∇W_ij` (after Schwaiger 2008): zero for linear fields, and of the
/// right size where neighbours are missing.
///
/// `value` holds `columns` numbers per particle, and so does the result.
pub fn laplacian<const D: usize>(
    cloud: &Cloud<D>,
    value: &[f64],
    columns: usize,
    corrected: bool,
) -> Vec<f64> {
    assert_eq!(value.len(), cloud.len() * columns);
    let mut result = vec![0.0; cloud.len() * columns];
    if columns == 0 {
        return result;
    }
    let rows = result.par_chunks_mut(columns).with_min_len(256).enumerate();
    rows.for_each_init(
        || vec![[0.0; D]; columns],
        |slopes, (i, row)| {
            slopes.fill([0.0; D]);
            if corrected {
                gradient_at(cloud, value, true, i, slopes);
            }
            cloud.for_each_neighbour(i, |j, d, _, slope| {
                let weight = 2.0 * cloud.volume[j] * slope;
                for (c, sum) in row.iter_mut().enumerate() {
                    let linear: f64 = (0..D).map(|a| slopes[c][a] * d[a]).sum();
                    *sum += weight * (value[i * columns + c] - value[j * columns + c] - linear);
                }
            });
            if corrected {
                let matrix = moment(cloud, i);
                let trace: f64 = (0..D).map(|a| matrix[a][a]).sum();
                if trace > 0.0 {
                    row.iter_mut().for_each(|sum| *sum *= D as f64 / trace);
                }
            }
        },
    );
    result
}
