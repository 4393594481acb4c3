//! No leak: a particle behind a wall is brought back and counted.

use super::facet::{minus, plus};
use super::surface::Surface;
use crate::neighbours::Grid;
use crate::particles::{Fluid, Shared, for_ranges};
use crate::prescribed::Pose;
use crate::simd::{Real, dot};
use rayon::prelude::*;

/// Depth behind a surface, in spacings, from which a particle has leaked: less is the give of a contact.
pub const DEPTH: f64 = 0.1;

/// Cells per task: most of them need a few products only.
const CELLS: usize = 64;

impl<const D: usize> Surface<D> {
    /// Reflects every particle that is deeper than `depth` (m) behind the surface, and takes from its velocity what
    /// leads into the wall. Gives how many there were, and the longest way that one was moved.
    pub fn bring_back<R: Real>(
        &self,
        fluid: &mut Fluid<R, D>,
        grid: &Grid<D>,
        depth: f64,
    ) -> (u64, f64) {
        let position = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut fluid.position[a]));
        let velocity = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut fluid.velocity[a]));
        let cells = &fluid.cells;
        (0..self.cells().len())
            .into_par_iter()
            .with_min_len(CELLS)
            .map(|k| {
                let cell = self.cells()[k] as usize;
                let range = cells.particles(cell, cell + 1);
                let facets = self.near(k);
                // SAFETY: every cell has particles of its own, and is listed once.
                let (x, v) = unsafe {
                    (
                        position.map(|c| c.range(&range)),
                        velocity.map(|c| c.range(&range)),
                    )
                };
                let (mut count, mut longest) = (0, 0.0f64);
                for i in 0..range.len() {
                    let mut at: [f64; D] = std::array::from_fn(|a| x[a][i]);
                    if grid.is_periodic() {
                        grid.wrap(&mut at);
                    }
                    let Some((way, normal)) = self.way_back(&at, facets, depth) else {
                        continue;
                    };
                    let u: [f64; D] = std::array::from_fn(|a| v[a][i]);
                    let inwards = dot(&u, &normal).min(0.0);
                    for a in 0..D {
                        x[a][i] += way[a];
                        v[a][i] -= inwards * normal[a];
                    }
                    count += 1;
                    longest = longest.max(dot(&way, &way).sqrt());
                }
                (count, longest)
            })
            .reduce(|| (0, 0.0), |a, b| (a.0 + b.0, a.1.max(b.1)))
    }

    /// The same for the surface of a wall that has moved to `pose`: particles are sought where the wall was at the start,
    /// for which facets are listed.
    pub fn bring_back_from<R: Real>(
        &self,
        pose: &Pose,
        fluid: &mut Fluid<R, D>,
        grid: &Grid<D>,
        depth: f64,
    ) -> (u64, f64) {
        let n = fluid.len();
        let position = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut fluid.position[a]));
        let velocity = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut fluid.velocity[a]));
        for_ranges(
            n,
            || (0, 0.0f64),
            |a, b| (a.0 + b.0, a.1.max(b.1)),
            |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let (x, v) = unsafe {
                    (
                        position.map(|c| c.range(&range)),
                        velocity.map(|c| c.range(&range)),
                    )
                };
                let (mut count, mut longest) = (0, 0.0f64);
                for i in 0..range.len() {
                    let home = pose.home_of(&std::array::from_fn(|a| x[a][i]));
                    let cell = grid.bin(&home) as usize / Grid::<D>::PARTS;
                    let near = self.near_cell(cell);
                    let Some((way, normal)) = self.way_back(&home, near, depth) else {
                        continue;
                    };
                    let [_, wall, _] = pose.of(&home);
                    let [way, normal] = [way, normal].map(|w| pose.turned(&w));
                    let u: [f64; D] = std::array::from_fn(|a| v[a][i] - wall[a]);
                    let inwards = dot(&u, &normal).min(0.0);
                    for a in 0..D {
                        x[a][i] += way[a];
                        v[a][i] -= inwards * normal[a];
                    }
                    count += 1;
                    longest = longest.max(dot(&way, &way).sqrt());
                }
                (count, longest)
            },
        )
    }

    /// The way to the mirror image in front of the surface, and the normal there, of a point that is deeper than `depth`
    /// behind it.
    #[inline]
    pub fn way_back(
        &self,
        x: &[f64; D],
        facets: &[u32],
        depth: f64,
    ) -> Option<([f64; D], [f64; D])> {
        let behind = facets.iter().any(|&k| {
            let facet = &self.facets()[k as usize];
            let height = dot(&minus(x, &facet.corners[0]), &facet.normal);
            height < -depth && height > -self.reach()
        });
        if !behind {
            return None;
        }
        let foot = self.foot(x, facets)?;
        if !foot.faces || foot.distance >= -depth {
            return None;
        }
        Some((plus(&[0.0; D], 2.0, &minus(&foot.point, x)), foot.normal))
    }
}
