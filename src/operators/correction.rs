//! The kernel-gradient correction (Randles & Libersky 1996; Bonet & Lok 1999): a matrix per particle that makes the SPH
//! gradient exact for linear fields, whatever the particles' arrangement.

use super::Cloud;
use nalgebra::{SMatrix, SymmetricEigen};

/// A symmetric matrix, by rows.
pub type Matrix<const D: usize> = [[f64; D]; D];

/// Eigenvalues below this share of the largest count as zero: the particle's neighbours then lie on a line or a plane,
/// and the gradient across it is unknown.
const SINGULAR: f64 = 1e-6;

/// `L_i = M_i⁻¹` with `M_i = -Σ_j V_j r_ij ⊗ ∇W_ij`, for every particle.
///
/// Where `M_i` is singular, `L_i` is its pseudo-inverse: the gradient is right along the directions in which there are
/// neighbours and zero across them.
pub fn corrections<const D: usize>(cloud: &Cloud<D>) -> Vec<Matrix<D>> {
    cloud.map(|i| pseudo_inverse(&moment(cloud, i)))
}

/// `M_i = -Σ_j V_j r_ij ⊗ ∇W_ij`: about the unit matrix inside a fluid, half of it across a free surface.
pub(super) fn moment<const D: usize>(cloud: &Cloud<D>, i: usize) -> Matrix<D> {
    let mut sum = [[0.0; D]; D];
    cloud.for_each_neighbour(i, |j, d, _, slope| {
        add_moment(&mut sum, -cloud.volume[j] * slope, &d)
    });
    sum
}

/// Adds `weight d ⊗ d`.
#[inline]
pub(super) fn add_moment<const D: usize>(sum: &mut Matrix<D>, weight: f64, d: &[f64; D]) {
    for a in 0..D {
        for b in 0..D {
            sum[a][b] += weight * d[a] * d[b];
        }
    }
}

/// `m v`.
#[inline]
pub(super) fn times<const D: usize>(m: &Matrix<D>, v: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|a| (0..D).map(|b| m[a][b] * v[b]).sum())
}

/// The smallest eigenvalue of `M_i`: near one inside, falling to zero as the particle loses its neighbours on one side
/// (Marrone et al. 2010).
pub fn smallest_eigenvalue<const D: usize>(m: &Matrix<D>) -> f64 {
    match D {
        1 => m[0][0],
        2 => smallest(SMatrix::<f64, 2, 2>::from_fn(|a, b| m[a][b]).symmetric_eigenvalues()),
        3 => smallest(SMatrix::<f64, 3, 3>::from_fn(|a, b| m[a][b]).symmetric_eigenvalues()),
        _ => unreachable!("space has 1, 2 or 3 dimensions"),
    }
}

fn smallest<const N: usize>(eigenvalues: SMatrix<f64, N, 1>) -> f64 {
    eigenvalues.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The inverse of a symmetric positive semi-definite matrix; its pseudo-inverse where it has none.
pub(super) fn pseudo_inverse<const D: usize>(m: &Matrix<D>) -> Matrix<D> {
    // The eigenvalues of nalgebra want a literal size.
    macro_rules! of_size {
        ($size:literal) => {{
            let matrix = SMatrix::<f64, $size, $size>::from_fn(|a, b| m[a][b]);
            let inverse = regular_inverse(&matrix).unwrap_or_else(|| {
                let eigen = SymmetricEigen::new(matrix);
                recompose(&eigen.eigenvectors, eigen.eigenvalues.as_slice())
            });
            std::array::from_fn(|a| std::array::from_fn(|b| inverse[(a, b)]))
        }};
    }
    match D {
        1 => [[if m[0][0] == 0.0 { 0.0 } else { 1.0 / m[0][0] }; D]; D],
        2 => of_size!(2),
        3 => of_size!(3),
        _ => unreachable!("space has 1, 2 or 3 dimensions"),
    }
}

/// By Cholesky's factors, where the matrix is far from singular: much cheaper than eigenvalues, and the usual case.
fn regular_inverse<const N: usize>(m: &SMatrix<f64, N, N>) -> Option<SMatrix<f64, N, N>> {
    let factors = m.cholesky()?;
    let diagonal = factors.l_dirty().diagonal();
    let (low, high) = (diagonal.min(), diagonal.max());
    // The squares of the factors' diagonal lie between the smallest and the largest eigenvalue.
    (low * low > 1e-2 * high * high).then(|| factors.inverse())
}

fn recompose<const N: usize>(vectors: &SMatrix<f64, N, N>, values: &[f64]) -> SMatrix<f64, N, N> {
    let largest = values.iter().copied().fold(0.0, f64::max);
    let mut sum = SMatrix::zeros();
    for (k, &value) in values.iter().enumerate() {
        if value > SINGULAR * largest {
            let vector = vectors.column(k);
            sum += vector * vector.transpose() / value;
        }
    }
    sum
}
