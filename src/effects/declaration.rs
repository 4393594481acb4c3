//! What an effect says of itself.

use crate::step::Limit;

/// A quantity that particles carry for one effect only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// One number per particle.
    Scalar(&'static str),
    /// As many numbers as there are dimensions.
    Vector(&'static str),
}

impl Quantity {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Scalar(name) | Quantity::Vector(name) => name,
        }
    }

    /// Numbers per particle in `dimension` dimensions.
    pub fn numbers(self, dimension: usize) -> usize {
        match self {
            Quantity::Scalar(_) => 1,
            Quantity::Vector(_) => dimension,
        }
    }
}

/// What an effect needs and does; each effect's file has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Declaration {
    /// Its name.
    pub name: &'static str,
    /// Columns that only it needs.
    pub columns: &'static [Quantity],
    /// Sweeps over pairs of its own in each step; none for what shares a sweep with others.
    pub sweeps: usize,
    /// The time-step criterion that it brings.
    pub limit: Option<Limit>,
    /// What it turns into heat; empty for nothing.
    pub dissipates: &'static str,
    /// Where its formula comes from.
    pub source: &'static str,
}
