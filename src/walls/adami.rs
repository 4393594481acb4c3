//! Dummy particles with extrapolated pressure (Adami, Hu & Adams 2012).

use crate::eos::{AnyEos, EquationOfState};
use crate::simd::{Lanes, Real};
use crate::sweep::{Other, Output, Own, Pair, Pass, Splat, Sums};

/// For every wall particle `w`, over the fluid `f`:
/// `p_w = [Σ V_f p_f W + (g - a_w)·Σ V_f ρ_f r_wf W] / Σ V_f W` with the wall's own acceleration `a_w`; its density
/// follows from the equation of state, and at a no-slip wall the velocity that viscosity sees is
/// `2 u_wall - Σ V_f u_f W / Σ V_f W`.
///
/// Writes pressure, condensation, volume, and with `no_slip` the components of that velocity.
pub struct Extrapolation<const D: usize> {
    /// Gravity in m/s².
    pub gravity: [f64; D],
    /// Equation of state of the fluid.
    pub eos: AnyEos,
    /// Condensation without pressure.
    pub at_rest: f64,
    /// Whether a wall may pull: without a free surface it may, with one it would hold the fluid back.
    pub suction: bool,
    /// Whether the fluid sticks.
    pub no_slip: bool,
    /// Whether walls have an acceleration (in the slot of the gradient).
    pub accelerated: bool,
}

impl<R: Real, const D: usize> Pass<R, D> for Extrapolation<D> {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        _own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let weight = other.volume() * pair.weight();
        sums.scalar += weight;
        sums.gradient[0] = weight.mul_add(other.pressure(), sums.gradient[0]);
        let heavy = weight * (L::constant(1.0) + other.condensation());
        for a in 0..D {
            sums.vector[a] = heavy.mul_add(pair.separation[a], sums.vector[a]);
        }
        if self.no_slip {
            let u = other.velocity();
            for a in 0..D {
                sums.moment[a] = weight.mul_add(u[a], sums.moment[a]);
            }
        }
    }

    /// Most of a tank's walls are dry, and stay so. Nobody is near who could see another velocity than theirs.
    #[inline(always)]
    fn is_settled(&self, i: usize, out: &Output<R>) -> bool {
        let zero = R::default();
        out[0][i] == zero && out[2][i] > zero
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        let own = own.values();
        // The target's "volume" is its mass.
        let at_rest = R::from_f64(own.volume().to_f64() / self.eos.reference_density());
        let weight = sums.scalar.sum().to_f64();
        let wall_velocity = own.velocity();
        let mut pressure = 0.0;
        if weight > 1e-12 {
            let mut head = 0.0;
            let mut gravity = self.gravity;
            if self.accelerated {
                let acceleration = own.gradient();
                for a in 0..D {
                    gravity[a] -= acceleration[a].to_f64();
                }
            }
            for a in 0..D {
                head += gravity[a] * sums.vector[a].sum().to_f64();
            }
            pressure =
                (sums.gradient[0].sum().to_f64() + self.eos.reference_density() * head) / weight;
            if !self.suction {
                pressure = pressure.max(0.0);
            }
            if self.no_slip {
                for a in 0..D {
                    let mean = sums.moment[a].sum().to_f64() / weight;
                    out[3 + a][i] = R::from_f64(2.0 * wall_velocity[a].to_f64() - mean);
                }
            }
        } else if self.no_slip {
            for a in 0..D {
                out[3 + a][i] = wall_velocity[a];
            }
        }
        // Most of a tank's walls are dry: they cost no power function.
        let condensation = if pressure == 0.0 {
            self.at_rest
        } else {
            self.eos.condensation(pressure)
        };
        out[0][i] = R::from_f64(pressure);
        out[1][i] = R::from_f64(condensation);
        out[2][i] = R::from_f64(at_rest.to_f64() / (1.0 + condensation));
    }
}
