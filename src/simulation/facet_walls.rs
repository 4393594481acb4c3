//! Walls without particles: what their facets do to the fluid, and the fluid to them.

use super::boundary::Boundary;
use super::config::ViscosityForm;
use super::solver::Solver;
use super::timers::Phase;
use crate::effects::{MonaghanGingold, Morris};
use crate::simd::Real;
use crate::sweep::Single;
use crate::walls::{
    Facet, Mirror, MirroredForces, Penalty, SemiAnalytical, Slip, Surface, WallFactor, WallMethod,
};
use rayon::prelude::*;
use std::ops::Range;

/// Radius of a particle in spacings: half a spacing in front of a wall it touches it.
const RADIUS: f64 = 0.5;
/// The same beside semi-analytical walls, whose pressure keeps particles away until they come near.
const CORE: f64 = 0.25;

/// A wall method that acts through facets.
pub(super) enum FacetWalls<const D: usize> {
    /// Contact alone, and facets found within the support.
    Penalty(Penalty<D>, Surface<D>),
    /// What the wall cuts off the support; contact for what comes too near.
    SemiAnalytical(SemiAnalytical<D>, Penalty<D>),
    /// Images of the fluid; contact for what comes too near.
    Mirror(Mirror<D>, Penalty<D>),
}

impl<const D: usize> FacetWalls<D> {
    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        match self {
            FacetWalls::Penalty(contact, far) => contact.surface.bytes() + far.bytes(),
            FacetWalls::SemiAnalytical(walls, contact) => {
                walls.surface.bytes() + contact.surface.bytes()
            }
            FacetWalls::Mirror(walls, contact) => walls.bytes() + contact.surface.bytes(),
        }
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// What the walls' method makes of their facets, if it acts through them.
    pub(super) fn facet_walls(&self, facets: &[Facet<D>]) -> Option<FacetWalls<D>> {
        let c = &self.config;
        let contact = |radius: f64| {
            let near = Surface::new(facets.to_vec(), &self.grid, c.spacing);
            Penalty::new(near, radius * c.spacing, c.spacing, c.sound_speed)
        };
        match c.wall?.method {
            WallMethod::Penalty => {
                let support = c.smoothing_length * self.kernel.support();
                let far = Surface::new(facets.to_vec(), &self.grid, support);
                Some(FacetWalls::Penalty(contact(RADIUS), far))
            }
            WallMethod::SemiAnalytical => {
                let factor = WallFactor::new(self.kernel, c.smoothing_length);
                let surface = Surface::new(facets.to_vec(), &self.grid, factor.support());
                let walls = SemiAnalytical {
                    surface,
                    factor,
                    velocity: self.wall_velocities(),
                };
                Some(FacetWalls::SemiAnalytical(walls, contact(CORE)))
            }
            WallMethod::Mirror => {
                let support = c.smoothing_length * self.kernel.support();
                let facets = facets.to_vec();
                let velocity = self.wall_velocities();
                let walls = Mirror::new(facets, velocity, &self.grid, support, c.spacing);
                Some(FacetWalls::Mirror(walls, contact(CORE)))
            }
            _ => None,
        }
    }

    /// The velocity of each wall, that of its first particle.
    fn wall_velocities(&self) -> Vec<[f64; D]> {
        let of = |id: u32| {
            let wall = self.wall.as_ref()?;
            let i = wall.id.iter().position(|&k| k == id)?;
            Some(std::array::from_fn(|a| wall.pair_velocity[a][i].to_f64()))
        };
        let walls = self.bodies.iter().filter(|b| !b.fluid);
        walls.map(|b| of(b.ids.start).unwrap_or([0.0; D])).collect()
    }

    /// Adds what facets do to the accelerations.
    pub(super) fn add_facet_forces(&mut self) {
        let Some(Boundary {
            walls: Some(walls), ..
        }) = &self.boundary
        else {
            return;
        };
        let c = &self.config;
        match walls {
            FacetWalls::Penalty(contact, _) => contact.add_forces(&mut self.fluid, &self.grid),
            FacetWalls::SemiAnalytical(walls, contact) => {
                let sticks = c.wall.is_some_and(|w| w.slip == Slip::No);
                let viscosity = c.laminar_viscosity.filter(|_| sticks);
                walls.add_forces(
                    &mut self.fluid,
                    &self.grid,
                    c.reference_density,
                    &self.motion.gravity,
                    viscosity.map_or(0.0, |v| v.kinematic),
                    c.spacing,
                );
                contact.add_forces(&mut self.fluid, &self.grid);
            }
            FacetWalls::Mirror(walls, contact) => {
                let (h, rho) = (c.smoothing_length, c.reference_density);
                let sticks = c.wall.is_some_and(|w| w.slip == Slip::No);
                let (fluid, grid, motion) = (&mut self.fluid, &self.grid, &self.motion);
                let suction = c.wall.and_then(|w| w.suction);
                let by = MirroredForces {
                    single: &Single::new(self.kernel, h),
                    reference_density: rho,
                    gravity: motion.gravity,
                    suction: suction.unwrap_or(grid.is_periodic()),
                    friction: (),
                };
                match c.laminar_viscosity.filter(|_| sticks) {
                    None => walls.add_forces(fluid, grid, &by),
                    // As in the sweep of forces: beside artificial viscosity there is one form.
                    Some(v)
                        if v.form == ViscosityForm::Morris && c.artificial_viscosity.is_none() =>
                    {
                        walls.add_forces(fluid, grid, &by.with(Morris::new(v.kinematic, h, rho)));
                    }
                    Some(v) => {
                        let friction = MonaghanGingold::new(v.kinematic, h, rho);
                        walls.add_forces(fluid, grid, &by.with(friction));
                    }
                }
                contact.add_forces(fluid, grid);
            }
        }
        self.timers.book(Phase::Walls);
    }

    /// Adds what facets do to the rates of density, and stops shifts beside them.
    pub(super) fn add_facet_rates(&mut self) {
        let Some(Boundary {
            walls: Some(walls), ..
        }) = &self.boundary
        else {
            return;
        };
        let c = &self.config;
        let following = self.shift_over(0.0).map_or(0.0, |s| s.following_inside());
        let (fluid, grid) = (&mut self.fluid, &self.grid);
        let far = match walls {
            FacetWalls::SemiAnalytical(walls, _) => {
                walls.add_rates(fluid, grid, c.reference_density);
                &walls.surface
            }
            FacetWalls::Mirror(walls, _) => {
                let kernel = (self.kernel, c.smoothing_length);
                walls.add_rates(fluid, grid, kernel, c.reference_density, following);
                &walls.surface
            }
            FacetWalls::Penalty(_, far) => far,
        };
        far.stop_shift(fluid, grid, far.reach());
        self.timers.book(Phase::Walls);
    }

    /// Force (3) and moment about the origin (3) of the pressure on the facets of a wall, `-∫ p n dS`, by the pressure at
    /// points a spacing apart.
    pub(super) fn force_on_facets(&self, ids: &Range<u32>) -> [f64; 6] {
        let Some(boundary) = &self.boundary else {
            return [0.0; 6];
        };
        let mut walls = self.bodies.iter().filter(|b| !b.fluid);
        let number = walls.position(|b| b.ids == *ids);
        let mut elements: Vec<Facet<D>> = Vec::new();
        for facet in boundary.surface.facets() {
            if Some(facet.body as usize) == number {
                facet.divide(self.config.spacing, &mut elements);
            }
        }
        let order = self.order();
        let parts: Vec<[f64; 6]> = elements
            .par_iter()
            .map(|facet| {
                let x = facet.centre();
                let p = self.sample_point(&x, order.as_ref()).pressure * facet.extent();
                let f = facet.normal.map(|n| -p * n);
                let mut part = [0.0; 6];
                part[..D].copy_from_slice(&f);
                if D == 3 {
                    part[3] = x[1] * f[D - 1] - x[D - 1] * f[1];
                    part[4] = x[D - 1] * f[0] - x[0] * f[D - 1];
                }
                part[5] = x[0] * f[1] - x[1] * f[0];
                part
            })
            .collect();
        parts.iter().fold([0.0; 6], |sum, part| {
            std::array::from_fn(|k| sum[k] + part[k])
        })
    }
}
