//! The work of one block of cells where every pair of the target set is computed once, for both of its particles.
//!
//! The candidates are those of the cell and of the cells ahead of it. Within the cell, clusters follow each other, and a
//! particle that is done is put out of reach. What a pair does to the other particle is summed beside the selected
//! particles, then beside the candidates, then added to the columns: at every level places are contiguous, so that
//! nothing is scattered. Pairs within a cluster are computed from both sides, and what they do to the other is dropped.

use super::colours::BlockOfCells;
use super::geometry::{Geometry, Visit};
use super::sums::{SUMS, Sums, Tally, Uses};
use super::workspace::{Reactions, Workspace};
use super::{Other, Own, Pair, Source, Splat, SumColumns};
use crate::kernel::KernelName;
use crate::neighbours::{Grid, Runs};
use crate::simd::{Lanes, Real, Task};

/// What is summed over pairs of one set of particles, and over their neighbours among the walls. Methods must be
/// `#[inline(always)]`.
pub trait PairPass<R: Real, const D: usize>: Sync {
    /// Which sums it uses.
    fn uses(&self) -> Uses;

    /// Adds a vector of neighbours in the same set.
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    );

    /// Adds a vector of wall neighbours; what the tally holds for the other is dropped.
    fn wall<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        tally: &mut Tally<L, D>,
    );

    /// Makes of a particle's sums what shall stand in their columns.
    fn finish(&self, own: &Own<R, D>, sums: &mut Sums<R, D>);

    /// Whether it makes totals over all pairs of what it sums for the one particle of each ([`Tally::account`]).
    const COLLECTS: bool = false;

    /// Adds to the totals what was summed for a particle.
    fn collect(&self, _own: &Own<R, D>, _sums: &Sums<R, D>, _totals: &mut Totals) {}
}

/// Totals over all pairs.
pub type Totals = [f64; 7];

/// One pass over pairs.
pub struct Pairs<'a, R, P, const D: usize> {
    /// The grid of both sets.
    pub grid: &'a Grid<D>,
    /// The set.
    pub fluid: &'a Source<'a, R, D>,
    /// The walls around it.
    pub wall: Option<&'a Source<'a, R, D>>,
    /// What is summed.
    pub pass: &'a P,
}

/// The work of one task.
pub(super) struct Block<'a, R, P, const D: usize> {
    pub(super) pairs: &'a Pairs<'a, R, P, D>,
    pub(super) h: f64,
    pub(super) cells: &'a BlockOfCells<D>,
    pub(super) workspace: &'a mut Workspace<R>,
    pub(super) columns: &'a SumColumns<R>,
    pub(super) kernel: KernelName,
    pub(super) parts_per_cluster: usize,
}

/// Adds a vector of pairs to a particle and to its neighbours.
struct Both<'a, L: Lanes, P, const D: usize> {
    pass: &'a P,
    uses: Uses,
    used: &'a [bool; SUMS],
    own: &'a Own<L::Real, D>,
    sums: &'a mut Sums<L, D>,
    reactions: &'a mut Reactions<L::Real>,
    /// Particles at the front that are of its own cluster, with whom it meets twice.
    cluster: usize,
    /// As many halves, then ones, as there are lanes.
    shares: &'a [L::Real; 2 * LANES],
}

/// Most lanes that there are.
const LANES: usize = 16;

impl<L: Lanes, P: PairPass<L::Real, D>, const D: usize> Visit<L, D> for Both<'_, L, P, D> {
    const RARE: bool = P::COLLECTS;

    #[inline(always)]
    fn vector(&mut self, pair: &Pair<L, D>, other: &Other<L, D>, k: usize) {
        let own = Splat(self.own);
        let one = L::constant(1.0);
        // SAFETY: the reactions are cleared for all of the buffer.
        let mut back = unsafe { self.reactions.load::<L, D>(self.used, k) };
        let mut tally = Tally::new(self.sums, &mut back, own.volume(), other.volume());
        if P::COLLECTS {
            let twice = self.cluster.saturating_sub(k).min(LANES);
            // SAFETY: a vector fits behind at most LANES numbers.
            tally.share(unsafe { L::load(self.shares.as_ptr().add(LANES - twice)) });
        }
        self.pass.fluid(pair, &own, other, &mut tally);
        tally.close(
            self.uses,
            pair,
            one + own.condensation(),
            one + other.condensation(),
        );
        // SAFETY: as above.
        unsafe { self.reactions.store(self.used, k, &mut back) };
    }
}

/// Adds a vector of wall neighbours to a particle.
struct Walls<'a, L: Lanes, P, const D: usize> {
    pass: &'a P,
    uses: Uses,
    own: &'a Own<L::Real, D>,
    sums: &'a mut Sums<L, D>,
}

impl<L: Lanes, P: PairPass<L::Real, D>, const D: usize> Visit<L, D> for Walls<'_, L, P, D> {
    const RARE: bool = true;

    #[inline(always)]
    fn vector(&mut self, pair: &Pair<L, D>, other: &Other<L, D>, _: usize) {
        let own = Splat(self.own);
        let one = L::constant(1.0);
        let mut dropped = Sums::zero();
        let mut tally = Tally::new(self.sums, &mut dropped, own.volume(), other.volume());
        self.pass.wall(pair, &own, other, &mut tally);
        tally.close(
            self.uses,
            pair,
            one + own.condensation(),
            one + other.condensation(),
        );
    }
}

impl<R: Real, P: PairPass<R, D>, const D: usize> Task<R> for Block<'_, R, P, D> {
    type Output = Totals;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(self) -> Totals {
        let Pairs {
            grid,
            fluid,
            wall,
            pass,
        } = self.pairs;
        let (uses, columns) = (pass.uses(), self.columns);
        let used = &uses.columns::<D>();
        let geometry = Geometry::<L, D>::new(self.kernel, self.h);
        let reach = R::from_f64(self.h * self.kernel.support() * (1.0 + 1e-5));
        let edge = grid.edge();
        let mut totals = Totals::default();
        let shares = std::array::from_fn(|k| R::from_f64(if k < LANES { 0.5 } else { 1.0 }));
        let Workspace {
            candidates: [around, walls],
            selected: [near, near_walls],
            hits: [hits, wall_hits],
            reactions: [around_sums, near_sums],
        } = self.workspace;
        for cell in (0..self.cells.rows()).flat_map(|k| self.cells.row(k)) {
            let all = fluid.cells.particles(cell, cell + 1);
            if all.is_empty() {
                continue;
            }
            let runs = grid.ahead(cell);
            let mut frame: Option<[f64; D]> = None;
            for part in (0..Grid::<D>::PARTS).step_by(self.parts_per_cluster) {
                let particles = fluid.cells.bins(cell, part, part + self.parts_per_cluster);
                let mut first = particles.start;
                while first < particles.end {
                    let beside = |frame: &[f64; D], i: usize| {
                        // Written so that a position that is not a number is near nothing.
                        (0..D).all(|a| (fluid.position[a][i] - frame[a]).abs() <= 2.0 * edge[a])
                    };
                    let origin = match frame {
                        Some(origin) if beside(&origin, first) => origin,
                        _ => std::array::from_fn(|a| fluid.position[a][first]),
                    };
                    if frame != Some(origin) {
                        if frame.is_some() {
                            hand_out::<L, R, D>(around_sums, used, fluid, &runs, columns);
                        }
                        around.gather::<L, D>(fluid, &runs, &origin);
                        around.banish(0..first - all.start);
                        around_sums.clear::<L>(used, around.len());
                        if let Some(wall) = wall {
                            walls.gather::<L, D>(wall, &grid.around(cell), &origin);
                        }
                        frame = Some(origin);
                    }
                    let mut end = first + 1;
                    while end < particles.end && beside(&origin, end) {
                        end += 1;
                    }
                    let (from, to) = (first - all.start, end - all.start);
                    let (low, high) = around.bounds::<D>(from..to);
                    let found = near.select::<L, D>(around, from, fluid, &low, &high, reach, hits);
                    near_sums.clear::<L>(used, near.len());
                    if let Some(wall) = wall {
                        near_walls.select::<L, D>(walls, 0, wall, &low, &high, reach, wall_hits);
                    }
                    for i in 0..to - from {
                        // The cluster itself comes first among the selected.
                        let (x, own) = near.particle::<D>(i);
                        let x = x.map(L::splat);
                        let mut sums = Sums::zero();
                        geometry.each(
                            &x,
                            near,
                            &mut Both {
                                pass: *pass,
                                uses,
                                used,
                                own: &own,
                                sums: &mut sums,
                                reactions: near_sums,
                                cluster: to - from,
                                shares: &shares,
                            },
                        );
                        if wall.is_some() {
                            geometry.each(
                                &x,
                                near_walls,
                                &mut Walls {
                                    pass: *pass,
                                    uses,
                                    own: &own,
                                    sums: &mut sums,
                                },
                            );
                        }
                        let mut total = sums.total();
                        pass.collect(&own, &total, &mut totals);
                        for c in 0..SUMS {
                            if used[c] {
                                // SAFETY: no other block of this colour adds to this particle.
                                unsafe { *columns.0[c].add(first + i) += *total.column_mut(c) };
                            }
                        }
                    }
                    around_sums.take_back::<L>(near_sums, used, &hits[..found], to - from);
                    around.banish(from..to);
                    first = end;
                }
            }
            hand_out::<L, R, D>(around_sums, used, fluid, &runs, columns);
        }
        totals
    }
}

/// Adds to the particles of `runs` what they got.
#[inline(always)]
fn hand_out<L: Lanes<Real = R>, R: Real, const D: usize>(
    sums: &mut Reactions<R>,
    used: &[bool; SUMS],
    fluid: &Source<R, D>,
    runs: &Runs<D>,
    columns: &SumColumns<R>,
) {
    let mut at = 0;
    for run in runs.iter() {
        let range = fluid.cells.particles(run.first, run.end);
        let len = range.len();
        // SAFETY: no other block of this colour adds to these particles.
        unsafe { sums.add_to::<L>(used, at, range, columns) };
        at += len;
    }
}
