//! What a shift takes along: the fields that particles find where they are moved to.
//!
//! A particle that is moved by `δr` keeps its velocity and its density, although the fluid there has others. Left alone,
//! that error is of the order of the shift.

use crate::simd::{Lanes, Real, dot};
use crate::sweep::{Other, Output, Own, Pair, Pass, Splat, Sums};

/// How fields follow a shift. In both forms neighbours are fluid only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// `δu_i = Σ V_j (u_j - u_i) (δr_i + δr_j)/2·∇W_ij`, and the same of the density: the terms `∇·(u ⊗ δu) - u ∇·δu` and
    /// `∇·(ρ δu) - ρ ∇·δu` of the quasi-Lagrangian form of Sun, Colagrossi, Marrone, Antuono & Zhang 2019, over a step. In
    /// differences, they leave uniform fields alone whatever the particles' arrangement; separate sums of `∇·(ρ δu)` and
    /// `∇·δu` have different errors, whose difference takes density wherever particles are shifted.
    Differences,
    /// `δu_i = Σ V_j (ρ_i u_i ⊗ δr_i + ρ_j u_j ⊗ δr_j)/ρ_i·∇W_ij`: the stress `ρ u ⊗ (ũ - u)` of the transport-velocity
    /// formulation (Adami, Hu & Adams 2013). Conserves momentum pair by pair.
    Stress,
}

/// The pass that sums [`Transport`]: the change of the velocity, and in differences that of the condensation. `STRESS` chooses
/// the form.
#[derive(Clone, Copy, Debug)]
pub struct Carry<const STRESS: bool>;

impl<R: Real, const STRESS: bool, const D: usize> Pass<R, D> for Carry<STRESS> {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        // The shifts stand where other sweeps have a gradient.
        let one = L::constant(1.0);
        let weight = other.volume() * pair.slope;
        let ours = dot(&own.gradient(), &pair.separation) * weight;
        let theirs = dot(&other.gradient(), &pair.separation) * weight;
        let (u, v) = (own.velocity(), other.velocity());
        if STRESS {
            let ours = ours * (one + own.condensation());
            let theirs = theirs * (one + other.condensation());
            for a in 0..D {
                sums.vector[a] = ours.mul_add(u[a], theirs.mul_add(v[a], sums.vector[a]));
            }
        } else {
            let along = (ours + theirs) * L::constant(0.5);
            for a in 0..D {
                sums.vector[a] = along.mul_add(v[a] - u[a], sums.vector[a]);
            }
            let denser = other.condensation() - own.condensation();
            sums.scalar = along.mul_add(denser, sums.scalar);
        }
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        if STRESS {
            let density = R::from_f64(1.0) + own.values().condensation();
            for a in 0..D {
                out[a][i] = sums.vector[a].sum() / density;
            }
        } else {
            for a in 0..D {
                out[a][i] = sums.vector[a].sum();
            }
            out[D][i] = sums.scalar.sum();
        }
    }
}
