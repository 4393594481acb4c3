use super::*;
use crate::simd::{Real, Task, available_levels, dispatch, force_level};

const REFERENCE: f64 = 1000.0;

fn all() -> Vec<AnyEos> {
    let (sound_speed, background) = (34.0, 250.0);
    let tait = |gamma| {
        AnyEos::Tait(Tait {
            reference_density: REFERENCE,
            sound_speed,
            gamma,
            background,
        })
    };
    let linear = AnyEos::Linear(Linear {
        reference_density: REFERENCE,
        sound_speed,
        background,
    });
    vec![tait(7.0), tait(1.4), tait(1.0), tait(7.15), linear]
}

#[test]
fn density_inverts_pressure_to_round_off() {
    for eos in all() {
        for k in -100..=200 {
            let s = f64::from(k) * 1e-3;
            let back = eos.condensation(eos.pressure(s));
            assert!((back - s).abs() < 1e-15, "{eos:?}: {s} became {back}");
            let density = REFERENCE * (1.0 + s);
            let back = eos.density_at(eos.pressure_at(density));
            assert!(
                (back / density - 1.0).abs() < 5e-16,
                "{eos:?}: {density} became {back}"
            );
        }
    }
}

#[test]
fn the_sound_speed_is_the_slope_of_the_pressure() {
    for eos in all() {
        for density in [900.0, 1000.0, 1010.0, 1200.0] {
            let slope = (eos.pressure_at(density + 0.01) - eos.pressure_at(density - 0.01)) / 0.02;
            let found = eos.sound_speed(density).powi(2);
            assert!(
                (slope / found - 1.0).abs() < 1e-6,
                "{eos:?} at {density}: {slope} and {found}"
            );
        }
        assert_eq!(eos.sound_speed(REFERENCE), 34.0);
    }
}

#[test]
fn the_slope_of_the_energy_is_pressure_over_density_squared() {
    for eos in all() {
        assert_eq!(eos.energy(REFERENCE), 0.0);
        // 981 and 1019 lie inside the series for small condensations, 979 and 1021 outside.
        for density in [900.0, 979.0, 981.0, 999.0, 1001.0, 1019.0, 1021.0, 1200.0] {
            let slope = (eos.energy(density + 0.01) - eos.energy(density - 0.01)) / 0.02;
            let expected = eos.pressure_at(density) / (density * density);
            let scale = expected.abs().max(1e-4);
            assert!(
                (slope - expected).abs() < 1e-6 * scale,
                "{eos:?} at {density}: {slope}, {expected}"
            );
        }
    }
}

#[test]
fn the_energy_has_no_seam_where_its_series_ends_and_no_cancellation() {
    for gamma in [1.0, 1.4, 7.0] {
        for end in [-0.02, 0.02] {
            let (inside, outside) = (
                compression(gamma, end * (1.0 - 1e-12)),
                compression(gamma, end),
            );
            assert!(
                (inside / outside - 1.0).abs() < 1e-11,
                "gamma {gamma}: {inside}, {outside}"
            );
        }
        let s = 1e-7;
        assert!((compression(gamma, s) / (0.5 * gamma * s * s) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn small_condensations_keep_their_digits_in_single_precision() {
    for eos in all() {
        for s in [1e-6_f32, -3e-5, 4e-3] {
            let (single, double) = (eos.pressure(s), eos.pressure(f64::from(s)));
            assert!(
                (f64::from(single) / double - 1.0).abs() < 3e-7,
                "{eos:?} at {s}: {single}, {double}"
            );
        }
    }
}

struct Vectors;

impl Vectors {
    #[inline(always)]
    fn compare<L: Lanes>(eos: AnyEos) {
        let s: Vec<L::Real> = (0..L::N)
            .map(|k| L::Real::from_f64(2e-3 * k as f64 - 0.01))
            .collect();
        let mut found = s.clone();
        // SAFETY: both have `L::N` places.
        unsafe { eos.pressure(L::load(s.as_ptr())).store(found.as_mut_ptr()) };
        for (s, found) in s.into_iter().zip(found) {
            let expected = eos.pressure(s).to_f64();
            assert!(
                (found.to_f64() / expected - 1.0).abs() < 1e-6,
                "{eos:?}: {found:?}, {expected}"
            );
        }
    }
}

impl Task<f32> for Vectors {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<Real = f32>>(self) {
        all().into_iter().for_each(Self::compare::<L>);
    }
}

impl Task<f64> for Vectors {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<Real = f64>>(self) {
        all().into_iter().for_each(Self::compare::<L>);
    }
}

#[test]
fn vectors_give_what_single_numbers_give() {
    for level in available_levels() {
        force_level(level);
        dispatch::<f32, _>(Vectors);
        dispatch::<f64, _>(Vectors);
    }
}
