//! Semi-analytical walls (Ferrand et al. 2013; Mayrhofer et al. 2015): no particles behind the surface; what a wall cuts
//! off the support of a particle is integrated over its facets.

use super::facet::{Facet, minus, plus};
use super::surface::Surface;
use super::wall_factor::{Share, WallFactor};
use crate::neighbours::Grid;
use crate::particles::{Fluid, Shared};
use crate::simd::{Real, dot};
use rayon::prelude::*;

/// Least wall factor: less is behind a surface.
const LEAST: f64 = 0.1;
/// Cells per task.
const CELLS: usize = 8;

/// The surface, and the integrals over its facets.
///
/// `du/dt = [a + (1/ρ_i) Σ_s (p_i + p_s) ∇γ_s]/γ` and `dρ/dt = [r - ρ_i Σ_s u_i·∇γ_s]/γ`, where `a` and `r` are the sums
/// over fluid neighbours, with the pressure form of [`crate::effects::Pressure`]. Ferrand et al. take the pressure `p_s` of a segment from a mean over the fluid;
/// here it is the particle's own, carried to each point of the facet along gravity, `p_s = p_i + ρ_i g·(r_s - r_i)`: exact
/// for fluid at rest, the condition of no flow through a flat wall, and integrated in closed form, without values on
/// facets and a sweep to make them.
pub struct SemiAnalytical<const D: usize> {
    /// Facets, found within the support.
    pub surface: Surface<D>,
    /// Integrals over them.
    pub factor: WallFactor<D>,
    /// Velocity of each wall in its own plane in m/s, for friction.
    pub velocity: Vec<[f64; D]>,
}

impl<const D: usize> SemiAnalytical<D> {
    /// Adds the walls' part to the accelerations of the sweep of forces. `gravity` in m/s²; `kinematic` viscosity in m²/s
    /// if the fluid sticks to walls; friction is that of a linear profile down to the wall, over `spacing / 2` at least.
    pub fn add_forces<R: Real>(
        &self,
        fluid: &mut Fluid<R, D>,
        grid: &Grid<D>,
        reference_density: f64,
        gravity: &[f64; D],
        kinematic: f64,
        spacing: f64,
    ) {
        let acceleration =
            std::array::from_fn::<_, D, _>(|a| Shared::new(&mut fluid.acceleration[a]));
        let fluid = &*fluid;
        self.for_each(fluid, grid, |i, factor, shares| {
            let p = fluid.pressure[i].to_f64();
            let density = reference_density * (1.0 + fluid.condensation[i].to_f64());
            let mut force = [0.0; D];
            let u: [f64; D] = std::array::from_fn(|a| fluid.pair_velocity[a][i].to_f64());
            for (facet, share) in shares {
                let n = &facet.normal;
                // ∫ W (r_s - r_i) dS.
                let arm = plus(&share.moment, -share.height * share.gradient, n);
                let push = 2.0 * p * share.gradient + density * dot(gravity, &arm);
                force = plus(&force, push / density, n);
                if kinematic > 0.0 {
                    let slip = minus(&u, &self.velocity[facet.body as usize]);
                    let along = plus(&slip, -dot(&slip, n), n);
                    let drag = 2.0 * kinematic * share.gradient / share.height.max(0.5 * spacing);
                    force = plus(&force, -drag, &along);
                }
            }
            for a in 0..D {
                // SAFETY: every particle is visited once.
                unsafe {
                    let own = acceleration[a].range(&(i..i + 1));
                    own[0] = R::from_f64((own[0].to_f64() + force[a]) / factor);
                }
            }
        });
    }

    /// Adds the walls' part to the rates of the sweep of continuity.
    pub fn add_rates<R: Real>(
        &self,
        fluid: &mut Fluid<R, D>,
        grid: &Grid<D>,
        reference_density: f64,
    ) {
        let rate = Shared::new(&mut fluid.density_rate);
        let fluid = &*fluid;
        self.for_each(fluid, grid, |i, factor, shares| {
            let density = reference_density * (1.0 + fluid.condensation[i].to_f64());
            let u: [f64; D] = std::array::from_fn(|a| fluid.pair_velocity[a][i].to_f64());
            let inflow: f64 = shares.map(|(f, s)| -s.gradient * dot(&u, &f.normal)).sum();
            // SAFETY: every particle is visited once.
            unsafe {
                let own = rate.range(&(i..i + 1));
                own[0] = R::from_f64((own[0].to_f64() + density * inflow) / factor);
            }
        });
    }

    /// Visits every particle near the surface with its wall factor and the facets' shares.
    fn for_each<R: Real>(
        &self,
        fluid: &Fluid<R, D>,
        grid: &Grid<D>,
        work: impl Fn(usize, f64, &mut dyn Iterator<Item = (&Facet<D>, Share<D>)>) + Sync,
    ) {
        let surface = &self.surface;
        (0..surface.cells().len())
            .into_par_iter()
            .with_min_len(CELLS)
            .for_each(|k| {
                let cell = surface.cells()[k] as usize;
                let facets = surface.near(k);
                for i in fluid.cells.particles(cell, cell + 1) {
                    let mut x = fluid.at(i);
                    if grid.is_periodic() {
                        grid.wrap(&mut x);
                    }
                    self.visit(&x, facets, |factor, shares| work(i, factor, shares));
                }
            });
    }

    fn visit(
        &self,
        x: &[f64; D],
        facets: &[u32],
        work: impl FnOnce(f64, &mut dyn Iterator<Item = (&Facet<D>, Share<D>)>),
    ) {
        let all = self.surface.facets();
        let near = || {
            facets.iter().filter_map(|&k| {
                let facet = &all[k as usize];
                let share = self.factor.share(facet, x)?;
                (share.gradient != 0.0 || share.cut != 0.0).then_some((facet, share))
            })
        };
        let factor = 1.0 - near().map(|(_, s)| s.cut).sum::<f64>();
        if factor < 1.0 {
            work(factor.max(LEAST), &mut near());
        }
    }
}
