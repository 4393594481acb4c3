//! What is summed over the neighbours of a particle, and how a pair adds to both of its particles.

use super::pair::{Other, Pair, Splat};
use crate::effects::PairTerm;
use crate::particles::Shared;
use crate::simd::{Lanes, Real};

/// Most numbers that a pass sums up for a particle: a scalar, two vectors and a symmetric matrix.
pub(super) const SUMS: usize = 13;

/// Running sums over the neighbours of one particle; those that a pass does not use cost nothing.
pub struct Sums<L, const D: usize> {
    /// A scalar.
    pub scalar: L,
    /// A vector.
    pub vector: [L; D],
    /// A second vector.
    pub gradient: [L; D],
    /// A symmetric matrix: xx, yy, xy, then zz, yz, xz.
    pub moment: [L; 6],
    /// Any matrix; no pass over pairs uses it.
    pub matrix: [[L; D]; D],
}

/// The number of the scalar for [`Tally::account`].
pub const ALONE: usize = 6;

/// Which of them a pass uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uses {
    /// [`Sums::scalar`].
    pub scalar: bool,
    /// [`Sums::vector`].
    pub vector: bool,
    /// [`Sums::gradient`].
    pub gradient: bool,
    /// [`Sums::moment`].
    pub moment: bool,
}

impl Uses {
    /// None.
    pub const NONE: Uses = Uses {
        scalar: false,
        vector: false,
        gradient: false,
        moment: false,
    };

    /// Those of either.
    #[inline(always)]
    pub const fn and(self, other: Uses) -> Uses {
        Uses {
            scalar: self.scalar || other.scalar,
            vector: self.vector || other.vector,
            gradient: self.gradient || other.gradient,
            moment: self.moment || other.moment,
        }
    }

    /// Which of the [`SUMS`] numbers are used: the scalar, three components of each vector, six of the matrix.
    #[inline(always)]
    pub fn columns<const D: usize>(self) -> [bool; SUMS] {
        std::array::from_fn(|c| match c {
            0 => self.scalar,
            1..4 => self.vector && c - 1 < D,
            4..7 => self.gradient && c - 4 < D,
            _ => self.moment && (D == 3 || c - 7 < 3),
        })
    }
}

impl<L: Lanes, const D: usize> Sums<L, D> {
    /// Nothing summed yet.
    #[inline(always)]
    pub fn zero() -> Self {
        Sums {
            scalar: L::zero(),
            vector: [L::zero(); D],
            gradient: [L::zero(); D],
            moment: [L::zero(); 6],
            matrix: [[L::zero(); D]; D],
        }
    }

    /// The number of column `c`.
    #[inline(always)]
    pub(super) fn column_mut(&mut self, c: usize) -> &mut L {
        match c {
            0 => &mut self.scalar,
            1..4 => &mut self.vector[(c - 1) % D],
            4..7 => &mut self.gradient[(c - 4) % D],
            _ => &mut self.moment[c - 7],
        }
    }

    /// Each sum over its lanes.
    #[inline(always)]
    pub(super) fn total(&self) -> Sums<L::Real, D> {
        Sums {
            scalar: self.scalar.sum(),
            vector: self.vector.map(L::sum),
            gradient: self.gradient.map(L::sum),
            moment: self.moment.map(L::sum),
            matrix: self.matrix.map(|row| row.map(L::sum)),
        }
    }
}

/// Sums of one particle and of a vector of its neighbours, to which the terms of a pair add. Each term is written once,
/// as what one particle gets from the other per volume of the other; the other gets the same, or the opposite, per
/// volume of the one.
pub struct Tally<'a, L, const D: usize> {
    own: &'a mut Sums<L, D>,
    other: &'a mut Sums<L, D>,
    own_volume: L,
    other_volume: L,
    push: L,
    compression: L,
    exchange: L,
    source: L,
    share: L,
}

impl<'a, L: Lanes, const D: usize> Tally<'a, L, D> {
    #[inline(always)]
    pub(super) fn new(
        own: &'a mut Sums<L, D>,
        other: &'a mut Sums<L, D>,
        own_volume: L,
        other_volume: L,
    ) -> Self {
        // Minus zero: the compiler may then drop the first addition.
        let none = L::constant(-0.0);
        Tally {
            own,
            other,
            own_volume,
            other_volume,
            push: none,
            compression: none,
            exchange: none,
            source: none,
            share: L::constant(1.0),
        }
    }

    /// Which part of a pair this visit stands for.
    #[inline(always)]
    pub(super) fn share(&mut self, share: L) {
        self.share = share;
    }

    /// `c` per volume of both, into component `k` of the matrix of the one alone, or behind these into the scalar: for
    /// totals over pairs.
    #[inline(always)]
    pub fn account(&mut self, k: usize, c: L) {
        let weight = self.share * self.other_volume;
        let total = self.own.column_mut((7 + k) % SUMS);
        *total = weight.mul_add(c, *total);
    }

    /// What `term` gives both particles of a pair, per volume of the other: the force density on the one, and the rates
    /// of density of the one and of the other.
    #[inline(always)]
    pub fn of<T: PairTerm<L::Real, D>>(
        term: &T,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
    ) -> ([L; D], L, L) {
        let one = L::constant(1.0);
        let (mut ours, mut theirs) = (Sums::zero(), Sums::zero());
        let mut tally = Tally::new(&mut ours, &mut theirs, one, one);
        term.add(pair, own, other, &mut tally);
        let densities = [one + own.condensation(), one + other.condensation()];
        tally.close(term.uses(), pair, densities[0], densities[1]);
        (ours.vector, ours.scalar, theirs.scalar)
    }

    /// A force density `c r_ij` on the one and its opposite on the other, into the vector.
    #[inline(always)]
    pub fn push(&mut self, c: L) {
        self.push += c;
    }

    /// A force density `c d` on the one and its opposite on the other, into the vector.
    #[inline(always)]
    pub fn drag(&mut self, c: L, d: &[L; D]) {
        let (ours, theirs) = (c * self.other_volume, c * self.own_volume);
        for a in 0..D {
            self.own.vector[a] = ours.mul_add(d[a], self.own.vector[a]);
            self.other.vector[a] = (-theirs).mul_add(d[a], self.other.vector[a]);
        }
    }

    /// A rate `c` that both get times their density, into the scalar.
    #[inline(always)]
    pub fn compress(&mut self, c: L) {
        self.compression += c;
    }

    /// A rate `c` that the one gets and the other loses, into the scalar.
    #[inline(always)]
    pub fn exchange(&mut self, c: L) {
        self.exchange += c;
    }

    /// A rate `c` that both get, into the scalar.
    #[inline(always)]
    pub fn source(&mut self, c: L) {
        self.source += c;
    }

    /// `c r_ij` of a gradient of differences, which is the same seen from either, into the second vector.
    #[inline(always)]
    pub fn gradient(&mut self, c: L, pair: &Pair<L, D>) {
        let (ours, theirs) = (c * self.other_volume, c * self.own_volume);
        for a in 0..D {
            let r = pair.separation[a];
            self.own.gradient[a] = ours.mul_add(r, self.own.gradient[a]);
            self.other.gradient[a] = theirs.mul_add(r, self.other.gradient[a]);
        }
    }

    /// `c r_ij`, opposite seen from the other, into the second vector.
    #[inline(always)]
    pub fn repel(&mut self, c: L, pair: &Pair<L, D>) {
        let (ours, theirs) = (c * self.other_volume, -(c * self.own_volume));
        for a in 0..D {
            let r = pair.separation[a];
            self.own.gradient[a] = ours.mul_add(r, self.own.gradient[a]);
            self.other.gradient[a] = theirs.mul_add(r, self.other.gradient[a]);
        }
    }

    /// `c r_ij ⊗ r_ij`, into the matrix.
    #[inline(always)]
    pub fn moment(&mut self, c: L, pair: &Pair<L, D>) {
        self.own.add_moment(c * self.other_volume, &pair.separation);
        self.other.add_moment(c * self.own_volume, &pair.separation);
    }

    /// Adds up what the terms have left; densities are in units of `ρ0`.
    #[inline(always)]
    pub(super) fn close(self, uses: Uses, pair: &Pair<L, D>, own_density: L, other_density: L) {
        if uses.vector {
            let (ours, theirs) = (
                self.push * self.other_volume,
                -(self.push * self.own_volume),
            );
            for a in 0..D {
                let r = pair.separation[a];
                self.own.vector[a] = ours.mul_add(r, self.own.vector[a]);
                self.other.vector[a] = theirs.mul_add(r, self.other.vector[a]);
            }
        }
        if uses.scalar {
            let ours = self.compression.mul_add(own_density, self.source) + self.exchange;
            let theirs = self.compression.mul_add(other_density, self.source) - self.exchange;
            self.own.scalar = ours.mul_add(self.other_volume, self.own.scalar);
            self.other.scalar = theirs.mul_add(self.own_volume, self.other.scalar);
        }
    }
}

/// The columns into which a pass sums, by the numbering of [`Uses::columns`]; null where it sums nothing.
pub struct SumColumns<R>(pub(super) [*mut R; SUMS]);

// SAFETY: blocks of one colour write to different particles, and colours follow each other.
unsafe impl<R: Real> Send for SumColumns<R> {}
// SAFETY: as above.
unsafe impl<R: Real> Sync for SumColumns<R> {}

impl<R: Real> Default for SumColumns<R> {
    fn default() -> Self {
        SumColumns([std::ptr::null_mut(); SUMS])
    }
}

impl<R: Real> SumColumns<R> {
    fn with<'a>(mut self, first: usize, columns: impl Iterator<Item = &'a mut [R]>) -> Self {
        for (k, column) in columns.enumerate() {
            self.0[first + k] = column.as_mut_ptr();
        }
        self
    }

    /// Column `c`.
    pub(super) fn of(&self, c: usize) -> Shared<R> {
        Shared::from_raw(self.0[c])
    }

    /// For the scalar.
    pub fn scalar(self, column: &mut [R]) -> Self {
        self.with(0, std::iter::once(column))
    }
    /// For the vector.
    pub fn vector<'a>(self, columns: impl Iterator<Item = &'a mut [R]>) -> Self {
        self.with(1, columns)
    }
    /// For the second vector.
    pub fn gradient<'a>(self, columns: impl Iterator<Item = &'a mut [R]>) -> Self {
        self.with(4, columns)
    }
    /// For the matrix.
    pub fn moment<'a>(self, columns: impl Iterator<Item = &'a mut [R]>) -> Self {
        self.with(7, columns)
    }
}
