//! `kolk._core.peak_flops`: what the machine's vector units reach, for `kolk bench`.

use crate::simd;
use pyo3::prelude::*;
use std::time::Duration;

pyo3::import_exception!(kolk.errors, KolkError);

/// Floating-point operations per second of `threads` threads (0: one per core) in "f64" or "mixed" (f32) precision.
#[pyfunction]
#[pyo3(signature = (precision, threads=0, seconds=0.3))]
pub(super) fn peak_flops(
    py: Python<'_>,
    precision: &str,
    threads: usize,
    seconds: f64,
) -> PyResult<f64> {
    let patience = Duration::try_from_secs_f64(seconds).map_err(|_| {
        KolkError::new_err(format!(
            "seconds: found {seconds}, allowed is a finite number of at least 0"
        ))
    })?;
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        some => some,
    };
    match precision {
        "f64" => Ok(py.detach(|| simd::peak_flops::<f64>(threads, patience))),
        "mixed" => Ok(py.detach(|| simd::peak_flops::<f32>(threads, patience))),
        other => Err(KolkError::new_err(format!(
            "precision: found {other:?}, allowed are \"f64\" and \"mixed\""
        ))),
    }
}

/// The vector unit in use: "baseline", "avx2" or "avx512".
#[pyfunction]
pub(super) fn simd_level() -> &'static str {
    simd::level().name()
}
