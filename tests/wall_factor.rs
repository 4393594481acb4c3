//! The wall factor of semi-analytical walls, and its gradient, against integrals made in other ways.

mod common;

use common::faces::{faces, facets};
use kolk::kernel::KernelName;
use kolk::walls::WallFactor;

/// `γ` in a corner of the plane by another way: over all directions the radial integral up to the wall, the circle cut
/// where the wall or the support has an edge.
fn factor_in_a_corner(kernel: KernelName, x: [f64; 2]) -> f64 {
    let support = kernel.support();
    let radial = |reach: f64| {
        // Kernels are polynomials between halves of h.
        let reach = reach.min(support);
        let mut sum = 0.0;
        let mut from = 0.0;
        while from < reach {
            let to = (((from * 2.0 + 1e-12).floor() + 1.0) / 2.0).min(reach);
            sum += gauss(from, to, |r| kernel.value(2, r, 1.0) * r);
            from = to;
        }
        sum
    };
    let mut cuts = vec![0.0, std::f64::consts::TAU];
    let corner = x[1].atan2(x[0]) + std::f64::consts::PI;
    cuts.push(corner);
    for k in 0..8 {
        cuts.push(f64::from(k) * std::f64::consts::FRAC_PI_4);
    }
    // Where a wall meets the ends of the kernel's pieces.
    // And, before a near wall, at angles between which the way to it grows a little.
    let doubled = x.map(|d| (0..140).map(move |k| d * (0.25 * f64::from(k)).exp2()));
    let ends = (1..=6)
        .map(|k| 0.5 * f64::from(k))
        .chain(doubled.into_iter().flatten())
        .filter(|&r| r <= support);
    for r in ends {
        for (d, normal) in [
            (x[0], std::f64::consts::PI),
            (x[1], 1.5 * std::f64::consts::PI),
        ] {
            if d < r {
                let half = (d / r).acos();
                cuts.extend([normal - half, normal + half]);
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    let direction = |a: f64| {
        let (s, c) = a.sin_cos();
        let to = |d: f64, v: f64| if v < 0.0 { -d / v } else { f64::INFINITY };
        radial(to(x[0], c).min(to(x[1], s)))
    };
    cuts.windows(2).map(|w| gauss(w[0], w[1], direction)).sum()
}

/// Gauss-Legendre quadrature with 5 points on 16 pieces.
fn gauss(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    const NODES: [(f64, f64); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let half = (to - from) / 32.0;
    (0..16)
        .map(|k| {
            let middle = from + (2 * k + 1) as f64 * half;
            NODES
                .iter()
                .map(|(x, w)| w * f(middle + x * half))
                .sum::<f64>()
                * half
        })
        .sum()
}

#[test]
fn the_wall_factor_is_exact_in_corners_of_the_plane() {
    let corner = facets(&faces([0.0; 2], [20.0; 2], true, &[]));
    for kernel in KernelName::ALL {
        let factor = WallFactor::<2>::new(kernel, 1.0);
        for x in [
            [1e-9, 2e-9],
            [1e-4, 0.3],
            [0.3, 0.2],
            [0.7, 1.1],
            [0.01, 1.9],
            [1.5, 1.5],
        ] {
            let (found, gradient) = factor.of(&corner, &x);
            let exact = factor_in_a_corner(kernel, x);
            assert!(
                (found - exact).abs() < 1e-8,
                "{kernel} {x:?}: {found} for {exact}"
            );
            for a in 0..2 {
                let step = 1e-5;
                if x[a] > step {
                    let moved = |s: f64| {
                        let mut y = x;
                        y[a] += s * step;
                        factor.of(&corner, &y).0
                    };
                    let slope = (moved(1.0) - moved(-1.0)) / (2.0 * step);
                    assert!(
                        (slope - gradient[a]).abs() < 2e-6,
                        "{kernel} {x:?}: {slope}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_wall_factor_is_exact_at_planes_edges_and_vertices_of_space() {
    let tiny = 1e-10;
    let room = facets(&faces([0.0; 3], [20.0; 3], true, &[]));
    for kernel in KernelName::ALL {
        let factor = WallFactor::<3>::new(kernel, 1.0);
        for (x, exact) in [
            ([10.0, 10.0, 10.0], 1.0),
            ([10.0, 10.0, tiny], 0.5),
            ([10.0, tiny, tiny], 0.25),
            ([tiny, tiny, tiny], 0.125),
        ] {
            let found = factor.of(&room, &x).0;
            assert!((found - exact).abs() < 1e-8, "{kernel} {x:?}: {found}");
        }
        // Before a plane: shells about the particle, less their caps behind it.
        for d in [1e-3f64, 0.3, 0.9, 1.7] {
            let mut cap = 0.0;
            let mut from = d;
            while from < kernel.support() {
                let to = (((from * 2.0 + 1e-12).floor() + 1.0) / 2.0).min(kernel.support());
                let shell = |r: f64| kernel.value(3, r, 1.0) * std::f64::consts::TAU * r * (r - d);
                cap += gauss(from, to, shell);
                from = to;
            }
            let (found, gradient) = factor.of(&room, &[9.0, 11.0, d]);
            assert!((found - 1.0 + cap).abs() < 1e-8, "{kernel} {d}: {found}");
            assert!(gradient[0].abs() < 1e-8 && gradient[1].abs() < 1e-8);
        }
        // In a corner the gradient is that of the factor.
        let x = [0.4, 0.7, 0.2];
        let gradient = factor.of(&room, &x).1;
        for a in 0..3 {
            let moved = |s: f64| {
                let mut y = x;
                y[a] += s;
                factor.of(&room, &y).0
            };
            let slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((slope - gradient[a]).abs() < 2e-6, "{kernel} {a}: {slope}");
        }
    }
}
