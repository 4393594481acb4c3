//! One quantity of all particles of a set.

use std::ops::{Deref, DerefMut};

/// Numbers that may be read beyond the end of a column, so that vector loads need no tail.
pub const PAD: usize = 16;

/// A column of a particle set: a slice of one number per particle, with [`PAD`] readable numbers behind its end.
#[derive(Clone, Debug)]
pub struct Column<T> {
    data: Vec<T>,
}

impl<T: Copy + Default> Column<T> {
    /// `n` defaults (zeros).
    pub fn new(n: usize) -> Self {
        Column {
            data: vec![T::default(); n + PAD],
        }
    }

    /// From the numbers of all particles.
    pub fn from_values(values: impl IntoIterator<Item = T>) -> Self {
        let mut data: Vec<T> = values.into_iter().collect();
        data.resize(data.len() + PAD, T::default());
        Column { data }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.data.capacity() * size_of::<T>()
    }
}

impl<T> Deref for Column<T> {
    type Target = [T];
    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.data[..self.data.len() - PAD]
    }
}

impl<T> DerefMut for Column<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        let n = self.data.len() - PAD;
        &mut self.data[..n]
    }
}
