//! The smoothing kernels against a table of values, their integrals and their own differences.

use kolk::kernel::{Kernel, KernelName, Scaled};
use std::f64::consts::PI;

/// Rows of `tests/data/kernels.csv`: name, dimension, support, q, W h^D, dW/dq h^D; ten digits.
fn table() -> Vec<(KernelName, usize, f64, f64, f64, f64)> {
    let mut rows = Vec::new();
    for line in include_str!("data/kernels.csv").lines().skip(2) {
        let column: Vec<&str> = line.split(',').collect();
        let name = match column[0] {
            "cubic" => KernelName::Cubic,
            "quintic" => KernelName::Quintic,
            "wendlandC2" | "wendlandC2_1D" => KernelName::WendlandC2,
            "wendlandC4" | "wendlandC4_1D" => KernelName::WendlandC4,
            "wendlandC6" | "wendlandC6_1D" => KernelName::WendlandC6,
            "quartic" => continue,
            other => panic!("unknown kernel {other}"),
        };
        let number = |k: usize| column[k].parse::<f64>().unwrap();
        rows.push((
            name,
            number(1) as usize,
            number(2),
            number(3),
            number(4),
            number(5),
        ));
    }
    rows
}

#[test]
fn values_and_slopes_agree_with_the_table() {
    let rows = table();
    assert!(rows.len() > 250);
    for (name, dimension, support, q, value, slope) in rows {
        assert_eq!(name.support(), support);
        let h = 0.7;
        let scale = f64::powi(h, dimension as i32);
        let found = name.value(dimension, q * h, h) * scale;
        assert!(
            (found - value).abs() < 1e-10,
            "{name} {dimension}D at {q}: {found}, not {value}"
        );
        let found = name.gradient(dimension, q * h, h) * scale * h;
        // The table's slopes are central differences, good to nine digits.
        assert!(
            (found - slope).abs() < 2e-9,
            "{name} {dimension}D at {q}: {found}, not {slope}"
        );
    }
}

/// Integral over `0..end` by Gauss's rule of five points on pieces that end where splines have their knots.
fn integral(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    let nodes = [0.0, 0.538_469_310_105_683_1, 0.906_179_845_938_664];
    let weights = [
        0.568_888_888_888_888_9,
        0.478_628_670_499_366_47,
        0.236_926_885_056_189_08,
    ];
    let pieces = 40 * end as usize;
    let half = 0.5 * end / pieces as f64;
    let mut sum = 0.0;
    for piece in 0..pieces {
        let middle = half * (2 * piece + 1) as f64;
        for (node, weight) in nodes.into_iter().zip(weights) {
            sum += weight * half * f(middle + half * node);
            if node > 0.0 {
                sum += weight * half * f(middle - half * node);
            }
        }
    }
    sum
}

#[test]
fn every_kernel_integrates_to_one() {
    for name in KernelName::ALL {
        let surfaces: [fn(f64) -> f64; 3] = [|_| 2.0, |r| 2.0 * PI * r, |r| 4.0 * PI * r * r];
        for (dimension, surface) in (1..).zip(surfaces) {
            let whole = integral(name.support(), |r| {
                surface(r) * name.value(dimension, r, 1.0)
            });
            assert!((whole - 1.0).abs() < 1e-10, "{name} {dimension}D: {whole}");
        }
    }
}

#[test]
fn gradients_are_the_slopes_of_the_values() {
    for name in KernelName::ALL {
        for dimension in 1..=3 {
            for step in 1..60 {
                // No knot of a spline lies between the points of the difference.
                let (r, h, d) = (0.05 * f64::from(step) - 0.02, 1.1, 1e-3);
                let difference =
                    |d: f64| name.value(dimension, r + d, h) - name.value(dimension, r - d, h);
                let slope = (8.0 * difference(d) - difference(2.0 * d)) / (12.0 * d);
                let found = name.gradient(dimension, r, h);
                assert!(
                    (found - slope).abs() < 1e-10,
                    "{name} {dimension}D at {r}: {found}, not {slope}"
                );
                assert!(found <= 0.0);
            }
        }
    }
}

#[test]
fn kernels_end_at_their_support_and_are_finite_at_zero() {
    for name in KernelName::ALL {
        for dimension in 1..=3 {
            let end = name.support() * 0.3;
            assert_eq!(name.value(dimension, end, 0.3), 0.0);
            assert_eq!(name.gradient(dimension, end * 1.5, 0.3), 0.0);
            assert_eq!(name.gradient(dimension, 0.0, 0.3), 0.0);
            assert!(name.value(dimension, 0.0, 0.3) > 0.0);
        }
    }
    assert!(
        Scaled::<2>::new(KernelName::WendlandC2, 1.0)
            .slope_over_r(0.0)
            .is_finite()
    );
}

#[test]
fn names_are_read_as_they_are_written() {
    for name in KernelName::ALL {
        assert_eq!(name.as_str().parse(), Ok(name));
        assert_eq!(serde_json::to_string(&name).unwrap(), format!("\"{name}\""));
        assert_eq!(kolk::with_kernel!(name, K => K::NAME), name);
    }
    let unknown = "gauss".parse::<KernelName>().unwrap_err();
    assert!(unknown.to_string().contains("wendland-c2"));
}

#[test]
fn single_precision_is_as_good_as_it_can_be() {
    for name in KernelName::ALL {
        kolk::with_kernel!(name, K => {
            for step in 0..=100 {
                let q = f64::from(step) * 0.01 * K::SUPPORT;
                let (value, slope) = (K::shape(q as f32), K::slope_over_q(q as f32));
                assert!((f64::from(value) - K::shape(q)).abs() < 3e-6 * K::shape(0.0));
                assert!((f64::from(slope) - K::slope_over_q(q)).abs() < -3e-6 * K::slope_over_q(0.0));
            }
        });
    }
}
