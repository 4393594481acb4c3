//! The machine's peak: what its vector units reach when nothing but arithmetic is asked of them.

use super::{Lanes, Real, Task, dispatch};
use std::hint::black_box;
use std::marker::PhantomData;
use std::time::{Duration, Instant};

/// Independent chains of multiply-adds: enough to hide their latency (4 cycles, two a cycle), few enough to stay in
/// registers.
const CHAINS: usize = 12;
/// Multiply-adds of each chain between two looks at the clock: some 50 µs.
const ROUND: usize = 20_000;

/// One round of multiply-adds. Gives their number, counted per lane.
struct Round<R>(PhantomData<R>);

impl<R: Real> Task<R> for Round<R> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(self) -> usize {
        // A contraction: the chains stay finite whatever the number of rounds.
        let factor = L::constant(black_box(0.999));
        let addend = L::constant(black_box(0.001));
        let mut chains: [L; CHAINS] = std::array::from_fn(|k| L::constant(k as f64));
        for _ in 0..ROUND {
            for chain in &mut chains {
                *chain = chain.mul_add(factor, addend);
            }
        }
        let mut sum = L::zero();
        for chain in chains {
            sum += chain;
        }
        black_box(sum.sum());
        CHAINS * ROUND * L::N
    }
}

/// Floating-point operations per second of `threads` threads at once, a multiply-add counted as two, in the vector unit
/// that [`dispatch`] chooses: the best round of each thread within `patience`.
pub fn peak_flops<R: Real>(threads: usize, patience: Duration) -> f64 {
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.max(1))
            .map(|_| {
                scope.spawn(|| {
                    let (begun, mut best) = (Instant::now(), 0.0f64);
                    while begun.elapsed() < patience {
                        let start = Instant::now();
                        let done = dispatch::<R, _>(Round(PhantomData));
                        best = best.max(2.0 * done as f64 / start.elapsed().as_secs_f64());
                    }
                    best
                })
            })
            .collect();
        workers
            .into_iter()
            .map(|worker| worker.join().expect("arithmetic does not panic"))
            .sum()
    })
}
