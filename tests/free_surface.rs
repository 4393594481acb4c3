//! The free surface: found where it is, and kept by shifts.

mod common;

use common::{Noise, points, with_cloud};
use kolk::kernel::KernelName;
use kolk::operators::{Cloud, Shift, free_surface, particle_shift};
use std::f64::consts::TAU;

#[test]
fn the_free_surface_of_a_square_is_its_rim() {
    let side = 16;
    for jitter in [0.0, 0.1] {
        let position = points::<2>(side, jitter);
        with_cloud(
            &position,
            1.0 / side as f64,
            false,
            KernelName::WendlandC2,
            |cloud| {
                let surface = free_surface(cloud);
                for (k, &on) in surface.on.iter().enumerate() {
                    let (x, y) = (k % side, k / side);
                    let rim = x.min(y).min(side - 1 - x).min(side - 1 - y) == 0;
                    assert_eq!(
                        on, rim,
                        "particle ({x}, {y}), eigenvalue {}",
                        surface.eigenvalue[k]
                    );
                }
                let top = surface.normal[side * (side - 1) + side / 2];
                assert!(top[1] > 0.95, "{top:?}");
            },
        );
    }
}

/// Particles in rings or shells of radius (k + 1/2) spacings, `k` in `layers`, displaced by up to `jitter` spacings; with
/// the number `k` of each.
fn layers<const D: usize>(
    layers: std::ops::Range<usize>,
    jitter: f64,
) -> (Vec<[f64; D]>, Vec<usize>) {
    let mut noise = Noise(11);
    let (mut position, mut layer) = (Vec::new(), Vec::new());
    for k in layers {
        let radius = k as f64 + 0.5;
        let count = if D == 2 {
            (TAU * radius).round()
        } else {
            (2.0 * TAU * (radius * radius + 1.0 / 12.0)).round()
        };
        for m in 0..count as usize {
            // In 3D along a spiral of golden angles, at equal steps of the height.
            let (turn, height) = if D == 2 {
                (m as f64 / count + 0.37 * k as f64, 0.0)
            } else {
                let golden = 0.5 * (3.0 - 5.0_f64.sqrt());
                (m as f64 * golden, 1.0 - 2.0 * (m as f64 + 0.5) / count)
            };
            let flat = (1.0 - height * height).sqrt();
            let unit = [flat * (TAU * turn).cos(), flat * (TAU * turn).sin(), height];
            position.push(std::array::from_fn(|a| {
                radius * unit[a] + jitter * noise.number()
            }));
            layer.push(k);
        }
    }
    (position, layer)
}

/// The outermost layer of a disc or ball and the innermost around a hollow in it are its surface, and no other particle
/// is; normals lead away from it.
fn surface_of_layers<const D: usize>(range: std::ops::Range<usize>, h: f64, jitter: f64) {
    let (position, layer) = layers::<D>(range.clone(), jitter);
    let volume = vec![1.0; position.len()];
    let cloud = Cloud::new(
        &position,
        &volume,
        &volume,
        KernelName::WendlandC2,
        h,
        &[None; D],
    );
    let surface = free_surface(&cloud);
    let hollow = range.start > 0;
    for (i, &k) in layer.iter().enumerate() {
        let (outer, inner) = (k + 1 == range.end, hollow && k == range.start);
        let what = format!("{D}D, layer {k} of {range:?}, h = {h}, jitter {jitter}");
        assert_eq!(
            surface.on[i],
            outer || inner,
            "{what}: eigenvalue {}",
            surface.eigenvalue[i]
        );
        if outer || inner {
            let x = position[i];
            let radius = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            let along: f64 = (0..D).map(|a| surface.normal[i][a] * x[a] / radius).sum();
            let along = if outer { along } else { -along };
            assert!(along > 0.8, "{what}: the normal is {:?}", surface.normal[i]);
        }
    }
}

#[test]
fn the_free_surface_of_round_bodies_and_hollows_is_their_outermost_layer() {
    for jitter in [0.0, 0.1] {
        surface_of_layers::<2>(0..16, 2.0, jitter);
        surface_of_layers::<2>(4..16, 2.0, jitter);
        surface_of_layers::<3>(0..9, 1.7, jitter);
        surface_of_layers::<3>(4..11, 1.7, jitter);
    }
}

#[test]
fn the_free_surface_of_square_cavities_is_their_rim() {
    const SIDE: usize = 40;
    // Cavities of 8, 6 by 16 and 6 spacings.
    let cavities = [[8, 8, 16, 16], [22, 6, 28, 22], [27, 28, 33, 34]];
    let wet = |x: usize, y: usize| {
        (1..=SIDE).contains(&x)
            && (1..=SIDE).contains(&y)
            && !cavities
                .iter()
                .any(|[a, b, c, d]| (*a..*c).contains(&(x - 1)) && (*b..*d).contains(&(y - 1)))
    };
    // Beside a corner, disorder turns the normal of a wide support far enough to find the neighbours along the rim.
    for (jitter, h) in [(0.0, 2.0), (0.1, 1.5)] {
        let mut noise = Noise(5);
        let (mut position, mut rims) = (Vec::new(), Vec::new());
        for (x, y) in (0..SIDE * SIDE).map(|k| (k % SIDE + 1, k / SIDE + 1)) {
            if !wet(x, y) {
                continue;
            }
            position.push([x as f64, y as f64].map(|x| x + jitter * noise.number()));
            let open = |dx: [usize; 2]| !wet(x + dx[0] - 1, y + dx[1] - 1);
            let edge = [[0, 1], [2, 1], [1, 0], [1, 2]].into_iter().any(open);
            let corner = [[0, 0], [2, 0], [0, 2], [2, 2]].into_iter().any(open);
            // What has but the corner of a cavity before it may be called either.
            rims.push(if edge {
                Some(true)
            } else {
                (!corner).then_some(false)
            });
        }
        let volume = vec![1.0; position.len()];
        let cloud = Cloud::new(
            &position,
            &volume,
            &volume,
            KernelName::WendlandC2,
            h,
            &[None; 2],
        );
        let surface = free_surface(&cloud);
        for (i, rim) in rims.iter().enumerate() {
            let Some(rim) = *rim else { continue };
            assert_eq!(
                surface.on[i], rim,
                "{:?}, eigenvalue {}",
                position[i], surface.eigenvalue[i]
            );
        }
    }
}

#[test]
fn shifting_never_pushes_through_the_free_surface() {
    let side = 16;
    let position = points::<2>(side, 0.1);
    with_cloud(
        &position,
        1.0 / side as f64,
        false,
        KernelName::WendlandC2,
        |cloud| {
            let surface = free_surface(cloud);
            let free = particle_shift(cloud, Shift::Lind, 1.0 / side as f64, false);
            let kept = particle_shift(cloud, Shift::Lind, 1.0 / side as f64, true);
            let mut outward = 0.0_f64;
            for i in (0..position.len()).filter(|&i| surface.on[i]) {
                let along = |shift: &[f64; 2]| {
                    shift[0] * surface.normal[i][0] + shift[1] * surface.normal[i][1]
                };
                outward = outward.max(along(&free[i]));
                assert!(along(&kept[i]).abs() < 1e-15);
            }
            assert!(outward > 0.005, "{outward}");
            let middle = position.len() / 2 + side / 2;
            assert_eq!(free[middle], kept[middle]);
        },
    );
}
