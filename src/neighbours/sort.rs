//! Stable counting sort of particles into bins, in parallel and the same for any number of threads.
//!
//! Two passes: particles are dealt to some hundred buckets of consecutive bins (each chunk of particles counts, then
//! writes to places of its own), then each bucket is sorted by itself. Nothing is serial but a prefix sum over
//! buckets.

use super::grid::Cells;
use crate::particles::Shared;
use rayon::prelude::*;

const BUCKETS: usize = 512;
const CHUNKS: usize = 32;

/// Storage of the sort, kept between calls.
#[derive(Default)]
pub struct Sorter {
    keys: Vec<u32>,
    dealt: Vec<u32>,
    /// `order[k]` is the place, before the sort, of the particle that is now `k`-th.
    pub order: Vec<u32>,
    counts: Vec<[u32; BUCKETS]>,
}

impl Sorter {
    /// Room for `n` particles.
    pub fn new(n: usize) -> Self {
        Sorter {
            keys: vec![0; n],
            dealt: vec![0; n],
            order: vec![0; n],
            counts: vec![[0; BUCKETS]; CHUNKS],
        }
    }

    /// Finds the order that sorts particles by `bin(i)`, and fills `cells`.
    pub fn sort(&mut self, cells: &mut Cells, bin: impl Fn(usize) -> u32 + Sync) {
        let n = self.keys.len();
        let bins = cells.offsets.len() - 1;
        let width = bins.div_ceil(BUCKETS).max(1);
        let chunk = n.div_ceil(CHUNKS).max(1);

        self.counts
            .par_iter_mut()
            .zip(self.keys.par_chunks_mut(chunk))
            .enumerate()
            .for_each(|(c, (count, keys))| {
                count.fill(0);
                for (k, key) in keys.iter_mut().enumerate() {
                    *key = bin(c * chunk + k);
                    count[*key as usize / width] += 1;
                }
            });
        let used = n.div_ceil(chunk);
        let mut starts = [0u32; BUCKETS + 1];
        let mut next = 0;
        for b in 0..BUCKETS {
            starts[b] = next;
            for count in &mut self.counts[..used] {
                let here = count[b];
                count[b] = next;
                next += here;
            }
        }
        starts[BUCKETS] = next;

        let dealt = Shared::new(&mut self.dealt);
        self.counts[..used]
            .par_iter_mut()
            .zip(self.keys.par_chunks(chunk))
            .enumerate()
            .for_each(|(c, (count, keys))| {
                for (k, &key) in keys.iter().enumerate() {
                    let place = &mut count[key as usize / width];
                    // SAFETY: the prefix sum gives every particle a place of its own.
                    unsafe { dealt.write(*place as usize, (c * chunk + k) as u32) };
                    *place += 1;
                }
            });

        let (keys, dealt) = (&self.keys, &self.dealt);
        let order = Shared::new(&mut self.order);
        let offsets = Shared::new(&mut cells.offsets[..bins]);
        (0..BUCKETS).into_par_iter().for_each(|b| {
            let (low, high) = ((b * width).min(bins), ((b + 1) * width).min(bins));
            // SAFETY: buckets own disjoint bins, and disjoint places in the order.
            let offsets = unsafe { offsets.range(&(low..high)) };
            let members = &dealt[starts[b] as usize..starts[b + 1] as usize];
            if members.is_empty() {
                offsets.fill(starts[b]);
                return;
            }
            offsets.fill(0);
            for &i in members {
                offsets[keys[i as usize] as usize - low] += 1;
            }
            let mut next = starts[b];
            for o in offsets.iter_mut() {
                next += std::mem::replace(o, next);
            }
            for &i in members {
                let place = &mut offsets[keys[i as usize] as usize - low];
                // SAFETY: as above.
                unsafe { order.write(*place as usize, i) };
                *place += 1;
            }
            // Each offset has advanced to the start of the next bin: move them back by one.
            let mut start = starts[b];
            for o in offsets.iter_mut() {
                start = std::mem::replace(o, start);
            }
        });
        cells.offsets[bins] = n as u32;
        cells.renew();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.keys.capacity() + self.dealt.capacity() + self.order.capacity())
            + self.counts.capacity() * size_of::<[u32; BUCKETS]>()
    }
}
