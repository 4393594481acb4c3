//! Neighbours and operators on any numbers: the two searches agree, and nothing panics.
#![no_main]

use arbitrary::Arbitrary;
use kolk::kernel::KernelName;
use kolk::neighbours::brute::all_pairs;
use kolk::neighbours::search::neighbours;
use kolk::operators::{Cloud, Diffusion, Shift};
use kolk::operators::{
    density_diffusion, divergence, gradient, interpolate, laplacian, particle_shift,
};
use libfuzzer_sys::fuzz_target;

#[derive(Arbitrary, Debug)]
struct Input {
    /// Position, mass, density and value of each particle.
    particles: Vec<([f64; 3], f64, f64, f64)>,
    kernel: u8,
    h: f64,
    period: Option<(f64, f64)>,
    corrected: bool,
    flat: bool,
}

fuzz_target!(|input: Input| {
    // What the Python side refuses before: a length that is none, more pairs than memory holds.
    if !(input.h.is_finite() && input.h > 1e-100 && input.h < 1e100) || input.particles.len() > 64 {
        return;
    }
    if input.flat {
        look::<2>(&input);
    } else {
        look::<3>(&input);
    }
});

fn look<const D: usize>(input: &Input) {
    let position: Vec<[f64; D]> = input
        .particles
        .iter()
        .map(|p| std::array::from_fn(|a| p.0[a]))
        .collect();
    let kernel = KernelName::ALL[input.kernel as usize % KernelName::ALL.len()];
    let radius = input.h * kernel.support();
    let mut periodic = [None; D];
    if let Some((low, length)) = input.period {
        let sane = low.is_finite() && length.is_finite() && length >= 2.0 * radius;
        if sane && (low + length).is_finite() && low + length > low {
            periodic[0] = Some([low, low + length]);
        }
    }
    let by_cells = neighbours(&position, radius, &periodic);
    let by_force = all_pairs(&position, radius, &periodic);
    assert_eq!(by_cells.offsets, by_force.offsets);
    assert_eq!(by_cells.indices, by_force.indices);

    let column = |f: fn(&([f64; 3], f64, f64, f64)) -> f64| input.particles.iter().map(f).collect();
    let (mass, density, value): (Vec<f64>, Vec<f64>, Vec<f64>) =
        (column(|p| p.1), column(|p| p.2), column(|p| p.3));
    let cloud = Cloud::new(&position, &mass, &density, kernel, input.h, &periodic);
    let n = position.len();
    assert_eq!(gradient(&cloud, &value, 1, input.corrected).len(), n * D);
    assert_eq!(divergence(&cloud, &position, input.corrected).len(), n);
    assert_eq!(laplacian(&cloud, &value, 1, input.corrected).len(), n);
    assert_eq!(
        interpolate(&cloud, &position, &value, 1, true, 0.0).len(),
        n
    );
    for form in [Diffusion::Molteni, Diffusion::Antuono] {
        assert_eq!(density_diffusion(&cloud, form, 0.1, 10.0).len(), n);
    }
    for form in [
        Shift::Lind,
        Shift::Sun {
            time_step: 1e-3,
            speed: 1.0,
        },
    ] {
        assert_eq!(particle_shift(&cloud, form, 0.5 * radius, true).len(), n);
    }
}
