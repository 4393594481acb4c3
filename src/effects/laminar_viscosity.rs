//! Laminar viscosity, in two forms.

use super::{Declaration, PairTerm};
use crate::kernel::KernelName;
use crate::simd::{Lanes, Real, dot};
use crate::step::Limit;
use crate::sweep::{Other, Pair, Splat, Tally, Uses, relative_velocity};
use nalgebra::SMatrix;

/// What keeps `1/r²` finite for coincident particles, in `h²`. No larger: the customary 0.01 takes 1.3 % of the
/// viscosity.
const ETA2: f64 = 1e-6;

/// Viscosity of a Newtonian fluid in the form of Morris, Fox & Zhu 1997: the force density
/// `Σ V_j (μ_i + μ_j) (r_ij·∇W_ij) / (r² + η²) u_ij`. Conserves linear momentum exactly, angular momentum to the order
/// of the discretisation. For flow between walls; under a free surface it dissipates half of what it should
/// (Colagrossi, Antuono, Souto-Iglesias & Le Touzé 2011).
#[derive(Clone, Copy, Debug)]
pub struct Morris {
    viscosity: f64,
    eta2: f64,
}

/// The same in the form of Monaghan & Gingold 1983 (also Cleary 1998):
/// `2 (D+2) Σ V_j μ (u_ij·r_ij) / (r² + η²) ∇W_ij`. Conserves linear and angular momentum exactly, and dissipates what
/// it should under a free surface.
#[derive(Clone, Copy, Debug)]
pub struct MonaghanGingold {
    viscosity: f64,
    eta2: f64,
}

impl Morris {
    /// For kinematic viscosity `nu` in m²/s, smoothing length `h` in m, and the density at rest.
    pub fn new(nu: f64, h: f64, reference_density: f64) -> Self {
        Morris {
            viscosity: nu * reference_density,
            eta2: ETA2 * h * h,
        }
    }
}

impl MonaghanGingold {
    /// For kinematic viscosity `nu` in m²/s, smoothing length `h` in m, and the density at rest.
    pub fn new(nu: f64, h: f64, reference_density: f64) -> Self {
        MonaghanGingold {
            viscosity: nu * reference_density,
            eta2: ETA2 * h * h,
        }
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for Morris {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            vector: true,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        let densities = L::constant(2.0) + own.condensation() + other.condensation();
        let regularised = (pair.squared + L::constant(self.eta2)).recip();
        let drag =
            L::constant(self.viscosity) * densities * pair.slope * pair.squared * regularised;
        tally.drag(drag, &relative_velocity(own, other));
    }
}

impl<R: Real, const D: usize> PairTerm<R, D> for MonaghanGingold {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            vector: true,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        // With μ = ν ρ, its mean over the pair times 2 (D+2).
        let densities = L::constant(2.0) + own.condensation() + other.condensation();
        let viscosity = L::constant((D as f64 + 2.0) * self.viscosity) * densities;
        let regularised = (pair.squared + L::constant(self.eta2)).recip();
        let approach = dot(&relative_velocity(own, other), &pair.separation);
        tally.push(viscosity * approach * regularised * pair.slope);
    }
}

/// The fastest decay that viscosity 1 gives any wave on a lattice of `spacing`, in 1/s: what an explicit step must
/// resolve. From the sums themselves, for the customary `0.125 h²/ν` is unstable for some kernels and wasteful for
/// others.
pub fn fastest_decay<const D: usize>(
    kernel: KernelName,
    h: f64,
    spacing: f64,
    angular: bool,
) -> f64 {
    const WAVES: i32 = 8;
    let reach = (h * kernel.support() / spacing).ceil() as i32;
    let lattice = |side: i32, low: i32| {
        (0..side.pow(D as u32)).map(move |k| {
            std::array::from_fn::<f64, D, _>(|a| f64::from(low + k / side.pow(a as u32) % side))
        })
    };
    let mut neighbours = Vec::new();
    for x in lattice(2 * reach + 1, -reach) {
        let r2: f64 = x.iter().map(|x| x * x).sum();
        let r = r2.sqrt() * spacing;
        if r2 > 0.0 && r < h * kernel.support() {
            neighbours.push((
                x,
                -kernel.gradient(D, r, h) / r * spacing.powi(D as i32),
                r2,
            ));
        }
    }
    let mut fastest = 0.0f64;
    for k in lattice(WAVES + 1, 0) {
        let mut matrix = SMatrix::<f64, D, D>::zeros();
        for (x, weight, r2) in &neighbours {
            let phase: f64 =
                (0..D).map(|a| k[a] * x[a]).sum::<f64>() * std::f64::consts::PI / f64::from(WAVES);
            let rate = 2.0 * weight * (1.0 - phase.cos());
            for a in 0..D {
                for b in 0..D {
                    let direction = if angular {
                        (D as f64 + 2.0) * x[a] * x[b] / r2
                    } else {
                        f64::from(u8::from(a == b))
                    };
                    matrix[(a, b)] += rate * direction;
                }
            }
        }
        // The matrix is symmetric and positive: its largest eigenvalue is below its largest row sum.
        let bound = (0..D)
            .map(|a| (0..D).map(|b| matrix[(a, b)].abs()).sum())
            .fold(0.0, f64::max);
        fastest = fastest.max(bound);
    }
    fastest
}

/// What the effect is.
pub const LAMINAR_VISCOSITY: Declaration = Declaration {
    name: "laminar viscosity",
    columns: &[],
    sweeps: 0,
    limit: Some(Limit::Viscous),
    dissipates: "kinetic energy: 2 μ S:S per volume",
    source: "Morris, Fox & Zhu 1997; Monaghan & Gingold 1983",
};
