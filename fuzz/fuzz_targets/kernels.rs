//! Kernels at any distance: finite, not negative, falling.
#![no_main]

use kolk::kernel::KernelName;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: (f64, f64, u8, u8)| {
    let (r, h, kernel, dimension) = input;
    // Lengths whose powers are numbers.
    if !(h > 1e-60 && h < 1e60 && r >= 0.0 && r.is_finite()) {
        return;
    }
    let kernel = KernelName::ALL[kernel as usize % KernelName::ALL.len()];
    let dimension = 1 + dimension as usize % 3;
    let value = kernel.value(dimension, r, h);
    let gradient = kernel.gradient(dimension, r, h);
    assert!(
        value.is_finite() && value >= 0.0,
        "{kernel} {dimension}D, r = {r}, h = {h}: {value}"
    );
    assert!(
        gradient.is_finite() && gradient <= 0.0,
        "{kernel} {dimension}D, r = {r}, h = {h}: {gradient}"
    );
    // At the very end r/h may round to just inside.
    if r > (1.0 + 1e-12) * kernel.support() * h {
        assert!(value == 0.0 && gradient == 0.0);
    }
});
