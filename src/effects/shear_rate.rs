//! The rate of shear of a flow.

use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Output, Own, Pair, Pass, Splat, Sums, relative_velocity};

/// `γ̇ = √(2 S:S)` with the strain rate `S = (∇u + ∇uᵀ)/2` of the renormalised gradient of the velocity,
/// `∇u_i = Σ V_j (u_j - u_i) ⊗ L_i ∇W_ij` with `L_i⁻¹ = -Σ V_j r_ij ⊗ ∇W_ij` (Randles & Libersky 1996): exact in a
/// linear flow, at a free surface too. Over the fluid only: what walls mirror is no part of its flow.
#[derive(Clone, Copy, Debug)]
pub struct ShearRate;

impl<R: Real, const D: usize> Pass<R, D> for ShearRate {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let r = &pair.separation;
        let weight = -(other.volume() * pair.slope);
        let u = relative_velocity(own, other);
        for a in 0..D {
            let weighted = weight * u[a];
            for b in 0..D {
                sums.matrix[a][b] = weighted.mul_add(r[b], sums.matrix[a][b]);
            }
        }
        sums.add_moment(weight, r);
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        _own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        let mut gradient = [[R::default(); D]; D];
        for a in 0..D {
            let mut row = [R::default(); D];
            for b in 0..D {
                row[b] = sums.matrix[a][b].sum();
            }
            gradient[a] = sums.renormalise(row);
        }
        let mut square = R::default();
        for a in 0..D {
            for b in 0..D {
                let twice = gradient[a][b] + gradient[b][a];
                square += twice * twice;
            }
        }
        out[0][i] = (square * R::from_f64(0.5)).sqrt();
    }
}
