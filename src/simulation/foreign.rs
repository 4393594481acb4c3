//! A state that was put in from outside, looked at before it is computed with.

use super::solver::Solver;
use crate::error::{Error, Instability, Result};
use crate::simd::Real;

/// The worst number found so far: how basic its quantity is, whose, and what.
struct Worst {
    rank: usize,
    id: u32,
    index: usize,
    quantity: &'static str,
    value: f64,
}

/// Keeps the number if it cannot be, and is more basic than what was found, or as basic and of a lower id.
fn look(
    worst: &mut Option<Worst>,
    rank: usize,
    quantity: &'static str,
    owner: (u32, usize),
    value: f64,
) {
    let (id, index) = owner;
    let must_be_positive = matches!(quantity, "mass" | "density");
    let fine = value.is_finite() && !(must_be_positive && value <= 0.0);
    if !fine && worst.as_ref().is_none_or(|w| (rank, id) < (w.rank, w.id)) {
        *worst = Some(Worst {
            rank,
            id,
            index,
            quantity,
            value,
        });
    }
}

impl<R: Real, const D: usize> Solver<R, D> {
    /// Ends the call if the state that was put in from outside cannot be computed; the good state kept beside it, if there
    /// is one, takes its place.
    pub(super) fn refuse_foreign(&mut self) -> Result<()> {
        match self.foreign.take() {
            None => Ok(()),
            Some(error) => {
                self.put_snapshot_back();
                if let Some(wall) = &mut self.wall {
                    wall.bring_home();
                }
                Err(error)
            }
        }
    }

    /// What is wrong with the numbers of a state that was put in from outside, looked for in every column.
    pub(super) fn inspect_foreign(&self) -> Option<Error> {
        if let Some(worst) = self.worst_of_fluid() {
            let position = self.fluid.at(worst.index).to_vec();
            return Some(self.foreign_number(&worst, position));
        }
        let wall = self.wall.as_ref()?;
        let worst = self.worst_of_walls()?;
        let position = (0..D).map(|a| wall.position[a][worst.index]).collect();
        Some(self.foreign_number(&worst, position))
    }

    fn worst_of_fluid(&self) -> Option<Worst> {
        let fluid = &self.fluid;
        let mut worst = None;
        let w = &mut worst;
        for i in 0..fluid.len() {
            let owner = (fluid.id[i], i);
            look(w, 0, "mass", owner, fluid.mass[i].to_f64());
            for a in 0..D {
                look(w, 1, "position", owner, fluid.position[a][i]);
                look(w, 2, "velocity", owner, fluid.velocity[a][i]);
                look(
                    w,
                    4,
                    "acceleration",
                    owner,
                    fluid.acceleration[a][i].to_f64(),
                );
            }
            look(w, 3, "density", owner, fluid.density[i]);
            look(
                w,
                5,
                "rate of density",
                owner,
                fluid.density_rate[i].to_f64(),
            );
            look(w, 6, "volume", owner, fluid.volume[i].to_f64());
            look(w, 7, "pressure", owner, fluid.pressure[i].to_f64());
            for column in fluid.shift.iter().flatten() {
                look(w, 8, "shift", owner, column[i].to_f64());
            }
        }
        worst
    }

    fn worst_of_walls(&self) -> Option<Worst> {
        let wall = self.wall.as_ref()?;
        let mut worst = None;
        let w = &mut worst;
        for i in 0..wall.len() {
            let owner = (wall.id[i], i);
            look(w, 0, "mass of the wall", owner, wall.mass[i].to_f64());
            for a in 0..D {
                look(w, 1, "position of the wall", owner, wall.position[a][i]);
                look(
                    w,
                    2,
                    "velocity of the wall",
                    owner,
                    wall.pair_velocity[a][i].to_f64(),
                );
                if let Some(slip) = &wall.slip_velocity {
                    look(w, 2, "velocity at the wall", owner, slip[a][i].to_f64());
                }
            }
            if let Some((density, rate)) = &wall.density {
                look(w, 3, "density of the wall", owner, density[i]);
                look(w, 4, "rate of density of the wall", owner, rate[i].to_f64());
            }
            look(w, 5, "volume of the wall", owner, wall.volume[i].to_f64());
            look(
                w,
                6,
                "pressure of the wall",
                owner,
                wall.pressure[i].to_f64(),
            );
            look(
                w,
                7,
                "condensation of the wall",
                owner,
                wall.condensation[i].to_f64(),
            );
        }
        worst
    }

    fn foreign_number(&self, worst: &Worst, position: Vec<f64>) -> Error {
        Error::Instability(Box::new(Instability {
            time: self.time,
            step: self.step,
            particle: worst.id,
            position,
            quantity: worst.quantity,
            value: worst.value,
            cause: "a number put in from outside that no state has".to_owned(),
            remedy: "check what was handed to restore, or go on from another checkpoint".to_owned(),
        }))
    }
}
