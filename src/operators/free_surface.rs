//! Which particles lie on a free surface, and where it faces (Marrone et al. 2010).

use super::correction::{moment, smallest_eigenvalue};
use super::{Cloud, gradient};

/// Below, a particle has so few neighbours that it is a surface or a splash.
const SPARSE: f64 = 0.20;
/// Above, it lies inside the fluid.
const DENSE: f64 = 0.75;

/// The free surface of a cloud of particles.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeSurface<const D: usize> {
    /// Smallest eigenvalue of the gradient's moment matrix: about one inside, a half on a flat surface, zero in spray.
    pub eigenvalue: Vec<f64>,
    /// Unit vector out of the fluid, `-∇λ/|∇λ|`; meaningful near the surface, zero where `λ` is uniform.
    pub normal: Vec<[f64; D]>,
    /// Whether the particle belongs to the surface.
    pub on: Vec<bool>,
}

/// Finds the particles of the free surface: few neighbours, or an empty cone along the normal.
pub fn free_surface<const D: usize>(cloud: &Cloud<D>) -> FreeSurface<D> {
    let eigenvalue = cloud.map(|i| smallest_eigenvalue(&moment(cloud, i)));
    let slopes = gradient(cloud, &eigenvalue, 1, true);
    let slopes = slopes.as_chunks::<D>().0;
    let normal = cloud.map(|i| {
        let length = norm(&slopes[i]);
        // Round-off of a uniform field has a direction too.
        if length * cloud.h < 1e-9 {
            [0.0; D]
        } else {
            slopes[i].map(|s| -s / length)
        }
    });
    let on = cloud.map(|i| match eigenvalue[i] {
        sparse if sparse < SPARSE => true,
        dense if dense > DENSE => false,
        _ => !cone_is_occupied(cloud, i, &normal[i]),
    });
    FreeSurface {
        eigenvalue,
        normal,
        on,
    }
}

/// Whether a neighbour lies in the umbrella above the particle: a cone of 45 degrees out to `√2 h`, capped by a ball
/// of radius `h` around the point `h` along the normal.
fn cone_is_occupied<const D: usize>(cloud: &Cloud<D>, i: usize, normal: &[f64; D]) -> bool {
    let h = cloud.h;
    let mut occupied = false;
    cloud.for_each_neighbour(i, |_, d, r, _| {
        // From the tip of the normal to the neighbour.
        let from_tip: [f64; D] = std::array::from_fn(|a| -d[a] - h * normal[a]);
        occupied |= if r >= std::f64::consts::SQRT_2 * h {
            norm(&from_tip) < h
        } else {
            let along: f64 = (0..D).map(|a| normal[a] * from_tip[a]).sum();
            let across: [f64; D] = std::array::from_fn(|a| from_tip[a] - along * normal[a]);
            along.abs() + norm(&across) < h
        };
    });
    occupied
}

pub(super) fn norm<const D: usize>(v: &[f64; D]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
