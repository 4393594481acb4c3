//! The one place that chooses the vector unit.

use super::{Lanes, Real};
use std::sync::atomic::{AtomicU8, Ordering};

/// The vector units that kolk has code for, from the one every machine has to the widest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Level {
    /// 128 bits: SSE2 on x86-64, NEON on 64-bit Arm.
    Baseline = 1,
    /// 256 bits with fused multiply-add.
    Avx2 = 2,
    /// 512 bits.
    Avx512 = 3,
}

impl Level {
    /// Its usual name.
    pub fn name(self) -> &'static str {
        match self {
            Level::Baseline => "baseline",
            Level::Avx2 => "avx2",
            Level::Avx512 => "avx512",
        }
    }
}

/// Work that can be done with any lanes. Implementations must mark `run` `#[inline(always)]`, so that the whole
/// body is compiled for the vector unit chosen.
pub trait Task<R: Real> {
    /// What the work gives.
    type Output;
    /// Does the work.
    fn run<L: Lanes<Real = R>>(self) -> Self::Output;
}

static LEVEL: AtomicU8 = AtomicU8::new(0);

/// The levels that this machine can run, narrowest first.
pub fn available_levels() -> Vec<Level> {
    #[cfg_attr(not(target_arch = "x86_64"), allow(unused_mut))]
    let mut levels = vec![Level::Baseline];
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            levels.push(Level::Avx2);
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
            {
                levels.push(Level::Avx512);
            }
        }
    }
    levels
}

/// The level in use: the widest there is, unless `KOLK_SIMD` (baseline, avx2, avx512) or [`force_level`] says less.
pub fn level() -> Level {
    match LEVEL.load(Ordering::Relaxed) {
        1 => Level::Baseline,
        2 => Level::Avx2,
        3 => Level::Avx512,
        _ => {
            let wanted = std::env::var("KOLK_SIMD").ok();
            let levels = available_levels();
            let chosen = levels
                .iter()
                .rev()
                .find(|l| wanted.as_deref().is_none_or(|w| w == l.name()));
            let chosen = *chosen.unwrap_or(&levels[levels.len() - 1]);
            LEVEL.store(chosen as u8, Ordering::Relaxed);
            chosen
        }
    }
}

/// Uses `level`, or the widest available below it: for tests and benchmarks.
pub fn force_level(level: Level) {
    let best = available_levels()
        .into_iter()
        .rfind(|&l| l <= level)
        .unwrap_or(Level::Baseline);
    LEVEL.store(best as u8, Ordering::Relaxed);
}

/// Does `task` with the widest lanes of this machine.
#[cfg_attr(kolk_avx2_only, allow(clippy::needless_return))]
#[inline]
pub fn dispatch<R: Real, T: Task<R>>(task: T) -> T::Output {
    // A third of the code to compile, for whoever works on the engine (CONTRIBUTING.md): no build for users has it, nor what
    // panics here.
    #[cfg(kolk_avx2_only)]
    if level() >= Level::Avx2 {
        // SAFETY: as below.
        return unsafe { avx2(task) };
    } else {
        panic!("built with kolk_avx2_only for a machine with AVX2");
    }
    #[cfg(all(target_arch = "x86_64", not(kolk_avx2_only)))]
    match level() {
        // SAFETY: `level` only gives what the machine has.
        Level::Avx512 => return unsafe { avx512(task) },
        // SAFETY: as above.
        Level::Avx2 => return unsafe { avx2(task) },
        Level::Baseline => {}
    }
    #[cfg(not(kolk_avx2_only))]
    task.run::<R::Baseline>()
}

#[cfg(all(target_arch = "x86_64", not(kolk_avx2_only)))]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma,bmi1,bmi2,popcnt,lzcnt")]
unsafe fn avx512<R: Real, T: Task<R>>(task: T) -> T::Output {
    task.run::<R::Avx512>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt,lzcnt")]
unsafe fn avx2<R: Real, T: Task<R>>(task: T) -> T::Output {
    task.run::<R::Avx2>()
}
