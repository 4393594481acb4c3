//! Walls as surfaces: what stands on the facets of a scene's walls, beside the passes over their particles.

use super::assembly::{Stage, force_source, outputs};
use super::facet_walls::FacetWalls;
use super::solver::Solver;
use crate::eos::EquationOfState;
use crate::prescribed::Pose;
use crate::simd::Real;
use crate::sweep::{Source, slot};
use crate::walls::{DEPTH, Facet, Ghosts, NodeValues, NodeWeights, Slip, Surface, WallMethod};

/// The surface of all walls, and what methods that need it keep.
pub(super) struct Boundary<R, const D: usize> {
    /// Facets of walls at rest, found within a spacing: for particles that are about to pass through.
    pub(super) surface: Surface<D>,
    /// Those of each wall that moves, where it was at the start, with the id of its first particle.
    pub(super) moving: Vec<(u32, Surface<D>)>,
    /// Walls that act through facets.
    pub(super) walls: Option<FacetWalls<D>>,
    /// Ghost nodes of modified dynamic walls.
    pub(super) ghosts: Option<Ghosts<R, D>>,
    /// Particles brought back so far.
    pub(super) leaks: u64,
}

impl<R: Real, const D: usize> Boundary<R, D> {
    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let moving: usize = self.moving.iter().map(|(_, s)| s.bytes()).sum();
        let ghosts = self.ghosts.as_ref().map_or(0, Ghosts::bytes);
        self.surface.bytes() + moving + ghosts + self.walls.as_ref().map_or(0, FacetWalls::bytes)
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Lays the surface of the walls: no particle passes it from now on.
    pub fn with_surface(mut self, facets: Vec<Facet<D>>) -> Self {
        if facets.is_empty() {
            return self;
        }
        let support = self.config.smoothing_length * self.kernel.support();
        let method = self.config.wall.map(|w| w.method);
        let ghosts = match &mut self.wall {
            Some(wall) if method == Some(WallMethod::ModifiedDynamic) => {
                let far = Surface::new(facets.clone(), &self.grid, support);
                Some(Ghosts::new(wall, &far, &self.grid, &self.motion.eos))
            }
            _ => None,
        };
        let walls: Vec<u32> = self
            .bodies
            .iter()
            .filter(|b| !b.fluid)
            .map(|b| b.ids.start)
            .collect();
        let list = |of: Vec<Facet<D>>| Surface::new(of, &self.grid, self.config.spacing);
        let mut moving = Vec::new();
        let mut at_rest = facets.clone();
        for (k, &first) in walls.iter().enumerate() {
            if self.pose(first, 0.0).is_some() {
                let (own, others) = at_rest.into_iter().partition(|f| f.body as usize == k);
                at_rest = others;
                moving.push((first, list(own)));
            }
        }
        let walls = self.facet_walls(&facets);
        self.boundary = Some(Boundary {
            walls,
            surface: list(at_rest),
            moving,
            ghosts,
            leaks: 0,
        });
        self
    }

    /// Where the wall that holds the particle `id` is at `time`; `None` for one at rest.
    fn pose(&self, id: u32, time: f64) -> Option<Pose> {
        self.wall.as_ref()?.moving.as_ref()?.pose(id, time)
    }

    /// Ghost nodes go where walls have gone.
    pub(super) fn move_ghosts(&mut self) {
        if let Some(wall) = &self.wall
            && let Some(moving) = &wall.moving
            && let Some(ghosts) = self.boundary.as_mut().and_then(|b| b.ghosts.as_mut())
        {
            ghosts.follow(wall, &self.grid, |id| moving.pose_now(id));
        }
    }

    /// Wall values from the ghost nodes.
    pub(super) fn extrapolate_from_ghosts(&mut self) {
        let Some(ghosts) = self.boundary.as_mut().and_then(|b| b.ghosts.as_mut()) else {
            return;
        };
        let (Some(wall), Some(config)) = (&mut self.wall, self.config.wall) else {
            return;
        };
        let fluid = &self.fluid;
        let source = force_source(
            &fluid.position,
            &fluid.cells,
            &fluid.volume,
            &fluid.pressure,
            &fluid.condensation,
            &fluid.pair_velocity,
        );
        let stage = |target| Stage {
            grid: &self.grid,
            sweeper: &self.sweeper,
            target,
            source: &source,
        };
        let weights = NodeWeights {
            gravity: self.motion.gravity,
            reference_density: self.config.reference_density,
            smoothing_length: self.config.smoothing_length,
        };
        let slope = ghosts.slope.iter_mut().enumerate();
        let out = outputs(
            slope
                .map(|(a, c)| (1 + a, c))
                .chain([(0, &mut ghosts.weight), (4, &mut ghosts.head)]),
        );
        let target = Source::new(&ghosts.position, &ghosts.cells)
            .with_vector(slot::GRADIENT, &ghosts.offset);
        stage(&target).run(self.kernel, &weights, out);
        let values = NodeValues {
            eos: self.motion.eos,
            at_rest: self.motion.eos.condensation(0.0),
            suction: config.suction.unwrap_or(self.grid.is_periodic()),
            no_slip: config.slip == Slip::No,
        };
        let slip = ghosts.slip_velocity.iter_mut().flatten().enumerate();
        let slip = slip.map(|(a, c)| (3 + a, c));
        let out = outputs(ghosts.values.iter_mut().enumerate().chain(slip));
        let target = Source::new(&ghosts.position, &ghosts.cells)
            .with(slot::VOLUME, &ghosts.mass)
            .with(slot::PRESSURE, &ghosts.weight)
            .with(slot::CONDENSATION, &ghosts.head)
            .with_vector(slot::GRADIENT, &ghosts.slope)
            .with_vector(slot::VELOCITY, &ghosts.velocity);
        stage(&target).run(self.kernel, &values, out);
        ghosts.hand_over(wall);
    }

    /// Brings back what has got behind a wall by `time`, and counts it.
    pub(super) fn keep_inside(&mut self, time: f64) {
        let Some(boundary) = &mut self.boundary else {
            return;
        };
        let depth = DEPTH * self.config.spacing;
        let mut found = boundary
            .surface
            .bring_back(&mut self.fluid, &self.grid, depth);
        for (first, surface) in &boundary.moving {
            let moving = self.wall.as_ref().and_then(|w| w.moving.as_ref());
            if let Some(pose) = moving.and_then(|m| m.pose(*first, time)) {
                let more = surface.bring_back_from(&pose, &mut self.fluid, &self.grid, depth);
                found = (found.0 + more.0, found.1.max(more.1));
            }
        }
        boundary.leaks += found.0;
        self.travelled += found.1;
    }
}
