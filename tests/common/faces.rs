//! Surfaces of boxes as walls have them.

use kolk::simulation::SurfaceInput;
use kolk::walls::Facet;

/// The faces of a box: inwards for a tank, outwards for an obstacle; `open` faces (axis, end) are left out.
pub fn faces<const D: usize>(
    low: [f64; D],
    high: [f64; D],
    inwards: bool,
    open: &[(usize, usize)],
) -> Vec<[[f64; D]; D]> {
    let mut found = Vec::new();
    for (axis, end) in (0..D).flat_map(|a| [(a, 0), (a, 1)]) {
        if open.contains(&(axis, end)) {
            continue;
        }
        let others: Vec<usize> = (0..D).filter(|&a| a != axis).collect();
        let corner = |bits: usize| -> [f64; D] {
            let mut x = [0.0; D];
            x[axis] = [low, high][end][axis];
            for (k, &a) in others.iter().enumerate() {
                x[a] = [low, high][bits >> k & 1][a];
            }
            x
        };
        let pieces: &[[usize; 3]] = if D == 2 {
            &[[0, 1, 1]]
        } else {
            &[[0, 1, 2], [1, 3, 2]]
        };
        for piece in pieces {
            let mut corners: [[f64; D]; D] = std::array::from_fn(|k| corner(piece[k]));
            let outwards = Facet::new(corners, 0).unwrap().normal[axis] * (end as f64 - 0.5) > 0.0;
            if outwards == inwards {
                corners.swap(0, 1);
            }
            found.push(corners);
        }
    }
    found
}

/// As the engine has them.
pub fn facets<const D: usize>(corners: &[[[f64; D]; D]]) -> Vec<Facet<D>> {
    corners.iter().map(|&c| Facet::new(c, 0).unwrap()).collect()
}

/// As a surface of the wall `name`.
pub fn surface_of<const D: usize>(name: &str, corners: &[[[f64; D]; D]]) -> SurfaceInput {
    SurfaceInput {
        body: name.to_owned(),
        corners: corners.as_flattened().as_flattened().to_vec(),
    }
}
