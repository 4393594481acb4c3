//! The least change to the vectors of particles that frees their sum of some moments.

use crate::particles::sum;
use nalgebra::{Cholesky, SMatrix, SVector};

/// Added to the diagonal of the projection's matrix, over its trace: where all move alike, no rotation is seen and the
/// matrix is singular.
const RIDGE: f64 = 1e-12;
/// Solutions of the projection: each takes away what ridge and round-off left of the last.
const SOLUTIONS: usize = 3;

/// The coefficients `c` for which `v_i + |v_i| Σ c_k φ_k(i)` ([`freed`]) has no moment `Σ m v·φ_k`, with the `mass`, the vectors
/// `of` and the `fields` of `n` particles; zero where nothing moves.
pub(crate) fn coefficients<const D: usize, const K: usize>(
    n: usize,
    mass: impl Fn(usize) -> f64 + Sync + Send,
    of: impl Fn(usize) -> [f64; D] + Sync + Send,
    fields: impl Fn(usize) -> [[f64; D]; K] + Sync + Send,
) -> SVector<f64, K> {
    let mut matrix = SMatrix::<f64, K, K>::zeros();
    for p in 0..K {
        let row: [f64; K] = sum(n, |i| {
            let fields = fields(i);
            let weight = mass(i) * length(&of(i));
            std::array::from_fn(|q| {
                weight * (0..D).map(|a| fields[p][a] * fields[q][a]).sum::<f64>()
            })
        });
        for q in 0..K {
            matrix[(p, q)] = row[q];
        }
    }
    let ridge = RIDGE * matrix.trace();
    let mut coefficients = SVector::<f64, K>::zeros();
    if let Some(factors) = Cholesky::new(matrix + SMatrix::identity() * ridge) {
        for _ in 0..SOLUTIONS {
            let excess: [f64; K] = sum(n, |i| {
                let (fields, m) = (fields(i), mass(i));
                let v = freed(of(i), || fields, &coefficients);
                std::array::from_fn(|k| m * (0..D).map(|a| v[a] * fields[k][a]).sum::<f64>())
            });
            coefficients -= factors.solve(&SVector::from(excess));
        }
    }
    coefficients
}

/// The vector of a particle, freed of the moments.
pub(crate) fn freed<const D: usize, const K: usize>(
    vector: [f64; D],
    fields: impl FnOnce() -> [[f64; D]; K],
    coefficients: &SVector<f64, K>,
) -> [f64; D] {
    let weight = length(&vector);
    if weight == 0.0 {
        return vector;
    }
    let fields = fields();
    std::array::from_fn(|a| {
        vector[a] + weight * (0..K).map(|k| coefficients[k] * fields[k][a]).sum::<f64>()
    })
}

/// Translations along the axes, then, for `K > D`, the rotations of `x`: about the third axis in 2D, about each in 3D.
pub(crate) fn rigid_motions<const D: usize, const K: usize>(x: &[f64; D]) -> [[f64; D]; K] {
    std::array::from_fn(|k| {
        if k < D {
            std::array::from_fn(|a| f64::from(u8::from(a == k)))
        } else if D == 2 {
            std::array::from_fn(|a| if a == 0 { -x[1] } else { x[0] })
        } else {
            let e = k - D;
            std::array::from_fn(|a| match (a + 3 - e) % 3 {
                0 => 0.0,
                1 => -x[(e + 2) % 3],
                _ => x[(e + 1) % 3],
            })
        }
    })
}

fn length<const D: usize>(v: &[f64; D]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}
