//! Walls in prescribed motion.

use super::{Column, Given, Shared, Wall, for_ranges, vector_columns};
use crate::neighbours::{Grid, Sorter};
use crate::prescribed::{Pose, RigidMotion};
use crate::simd::Real;
use std::ops::Range;

/// What walls need when some of them move; walls at rest have none of it.
///
/// Positions are made from those at the start, so that no error adds up however long the motion lasts.
pub struct Moving<R, const D: usize> {
    motions: Vec<(Range<u32>, RigidMotion)>,
    poses: Vec<Pose>,
    /// Which motion a particle has, by its id: 0 for none.
    motion_of: Vec<u16>,
    /// Positions at the start by id, in m.
    home: Vec<[f64; D]>,
    /// Acceleration of the wall itself in m/s².
    pub acceleration: [Column<R>; D],
    pub(super) sorter: Sorter,
    pub(super) scratch: Column<f64>,
    /// Upper bound of the way that any particle has gone since the last sort.
    pub(crate) travelled: f64,
}

impl<R: Real, const D: usize> Moving<R, D> {
    /// For walls of which those with the given ids move.
    pub fn new(given: &Given, motions: Vec<(Range<u32>, RigidMotion)>) -> Self {
        let n = given.mass.len();
        let mut motion_of = vec![0; n];
        for (k, (ids, _)) in motions.iter().enumerate() {
            motion_of[ids.start as usize..ids.end as usize].fill(k as u16 + 1);
        }
        Moving {
            poses: vec![Pose::rest(); motions.len()],
            motions,
            motion_of,
            home: given
                .position
                .chunks_exact(D)
                .map(|x| std::array::from_fn(|a| x[a]))
                .collect(),
            acceleration: vector_columns(n),
            sorter: Sorter::new(n),
            scratch: Column::new(n),
            travelled: 0.0,
        }
    }

    /// Where the particles with the ids `first..` are and how they move at `time`; `None` for a body at rest.
    pub fn pose(&self, first: u32, time: f64) -> Option<Pose> {
        let found = self.motions.iter().find(|(ids, _)| ids.contains(&first));
        found.map(|(_, motion)| motion.at(time))
    }

    /// Where the particle of an `id` is, as of the last move; `None` for a wall at rest.
    #[inline]
    pub fn pose_now(&self, id: u32) -> Option<&Pose> {
        let motion = self.motion_of[id as usize] as usize;
        motion.checked_sub(1).map(|k| &self.poses[k])
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.motion_of.capacity() * size_of::<u16>()
            + self.home.capacity() * size_of::<[f64; D]>()
            + D * self.acceleration[0].bytes()
            + self.sorter.bytes()
            + self.scratch.bytes()
    }
}

impl<R: Real, const D: usize> Wall<R, D> {
    /// Positions, velocities and accelerations at `time` (s); sorts the particles into `grid` again when one may have
    /// gone half of `skin` (m). Does nothing where no wall moves.
    pub fn move_to(&mut self, time: f64, grid: &Grid<D>, skin: f64) {
        let Some(mut moving) = self.moving.take() else {
            return;
        };
        for (pose, (_, motion)) in moving.poses.iter_mut().zip(&moving.motions) {
            *pose = motion.at(time);
        }
        let position = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut self.position[a]));
        let velocity = std::array::from_fn::<_, D, _>(|a| Shared::new(&mut self.pair_velocity[a]));
        let acceleration =
            std::array::from_fn::<_, D, _>(|a| Shared::new(&mut moving.acceleration[a]));
        let (id, motion_of) = (&self.id, &moving.motion_of);
        let (home, poses) = (&moving.home, &moving.poses);
        let longest = for_ranges(
            id.len(),
            || 0.0,
            f64::max,
            |range| {
                // SAFETY: the ranges of a pass are disjoint.
                let (x, v, dv) = unsafe {
                    (
                        position.map(|c| c.range(&range)),
                        velocity.map(|c| c.range(&range)),
                        acceleration.map(|c| c.range(&range)),
                    )
                };
                let mut longest = 0.0f64;
                for (i, id) in id[range].iter().enumerate() {
                    let motion = motion_of[*id as usize];
                    if motion == 0 {
                        continue;
                    }
                    let [to, speed, rate] = poses[motion as usize - 1].of(&home[*id as usize]);
                    // The image nearest to where it was: cells are those of the last sort.
                    let from = std::array::from_fn(|a| x[a][i]);
                    let step = grid.separation(&to, &from);
                    let mut square = 0.0;
                    for a in 0..D {
                        x[a][i] = if grid.is_periodic() {
                            from[a] + step[a]
                        } else {
                            to[a]
                        };
                        v[a][i] = R::from_f64(speed[a]);
                        dv[a][i] = R::from_f64(rate[a]);
                        square += step[a] * step[a];
                    }
                    longest = longest.max(square);
                }
                longest
            },
        );
        moving.travelled += longest.sqrt();
        let sort = 2.0 * moving.travelled > skin;
        self.moving = Some(moving);
        if sort {
            self.sort_again(grid);
        }
    }

    /// Puts walls that move to their places at the start, wherever they are; the next [`Self::move_to`] sorts them.
    pub fn bring_home(&mut self) {
        let Some(moving) = &mut self.moving else {
            return;
        };
        for (i, id) in self.id.iter().enumerate() {
            for a in 0..D {
                self.position[a][i] = moving.home[*id as usize][a];
                self.pair_velocity[a][i] = R::from_f64(0.0);
            }
        }
        moving.travelled = f64::INFINITY;
    }
}
