//! A piece of a wall's surface: a segment in 2D, a triangle in 3D.

use crate::simd::dot;

/// A flat piece of a surface with its unit normal, which points into the fluid.
#[derive(Clone, Copy, Debug)]
pub struct Facet<const D: usize> {
    /// Its corners in m: two in 2D, three in 3D.
    pub corners: [[f64; D]; D],
    /// The right of a segment from its first corner to its second; by the right-hand rule around a triangle.
    pub normal: [f64; D],
    /// The wall that it belongs to, counted among walls.
    pub body: u32,
}

/// `a - b`.
#[inline(always)]
pub(super) fn minus<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// `a + s b`.
#[inline(always)]
pub(super) fn plus<const D: usize>(a: &[f64; D], s: f64, b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|k| a[k] + s * b[k])
}

/// The cross product of the first three components.
#[inline(always)]
pub(super) fn cross<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    let mut c = [0.0; D];
    if D == 3 {
        c[0] = a[1] * b[2] - a[2] * b[1];
        c[1] = a[2] * b[0] - a[0] * b[2];
        c[2] = a[0] * b[1] - a[1] * b[0];
    }
    c
}

impl<const D: usize> Facet<D> {
    /// From its corners; `None` where they span no length or area.
    pub fn new(corners: [[f64; D]; D], body: u32) -> Option<Self> {
        let edge = minus(&corners[1], &corners[0]);
        let mut normal = if D == 2 {
            let mut n = [0.0; D];
            (n[0], n[1]) = (edge[1], -edge[0]);
            n
        } else {
            cross(&edge, &minus(&corners[D - 1], &corners[0]))
        };
        let length = dot(&normal, &normal).sqrt();
        if length.is_nan() || length <= 0.0 {
            return None;
        }
        normal = normal.map(|n| n / length);
        Some(Facet {
            corners,
            normal,
            body,
        })
    }

    /// Lowest and highest corner of the box around it.
    pub fn bounds(&self) -> ([f64; D], [f64; D]) {
        let of = |pick: fn(f64, f64) -> f64| {
            std::array::from_fn(|a| {
                self.corners
                    .iter()
                    .map(|c| c[a])
                    .fold(self.corners[0][a], pick)
            })
        };
        (of(f64::min), of(f64::max))
    }

    /// Its middle.
    pub fn centre(&self) -> [f64; D] {
        std::array::from_fn(|a| self.corners.iter().map(|c| c[a]).sum::<f64>() / D as f64)
    }

    /// Its length or area.
    pub fn extent(&self) -> f64 {
        let edge = minus(&self.corners[1], &self.corners[0]);
        if D == 2 {
            return dot(&edge, &edge).sqrt();
        }
        let c = cross(&edge, &minus(&self.corners[D - 1], &self.corners[0]));
        0.5 * dot(&c, &c).sqrt()
    }

    /// Adds pieces of it with edges of `size` at most to `into`.
    pub fn divide(&self, size: f64, into: &mut Vec<Self>) {
        let c = &self.corners;
        let edges = if D == 2 { 1 } else { D };
        let length = |k: usize| {
            let edge = minus(&c[(k + 1) % D], &c[k]);
            dot(&edge, &edge).sqrt()
        };
        let longest = (1..edges).fold(0, |l, k| if length(k) > length(l) { k } else { l });
        if length(longest) <= size {
            into.push(*self);
            return;
        }
        // In two across the longest edge.
        let (from, to) = (longest, (longest + 1) % D);
        let middle = plus(&c[from], 0.5, &minus(&c[to], &c[from]));
        for replaced in [to, from] {
            let mut half = *self;
            half.corners[replaced] = middle;
            half.divide(size, into);
        }
    }

    /// The point of the facet that is nearest to `x`.
    pub fn closest(&self, x: &[f64; D]) -> [f64; D] {
        let c = &self.corners;
        if D == 2 {
            return on_segment(&c[0], &c[1], x);
        }
        // Inside all edges: the foot of the perpendicular; else the nearest point of an edge.
        let height = dot(&minus(x, &c[0]), &self.normal);
        let foot = plus(x, -height, &self.normal);
        let mut inside = true;
        let mut best = ([0.0; D], f64::INFINITY);
        for k in 0..D {
            let (a, b) = (&c[k], &c[(k + 1) % D]);
            let inward = cross(&self.normal, &minus(b, a));
            if dot(&minus(&foot, a), &inward) < 0.0 {
                inside = false;
                let y = on_segment(a, b, x);
                let d = minus(x, &y);
                if dot(&d, &d) < best.1 {
                    best = (y, dot(&d, &d));
                }
            }
        }
        if inside { foot } else { best.0 }
    }
}

/// The point of the segment from `a` to `b` that is nearest to `x`.
fn on_segment<const D: usize>(a: &[f64; D], b: &[f64; D], x: &[f64; D]) -> [f64; D] {
    let edge = minus(b, a);
    let t = dot(&minus(x, a), &edge) / dot(&edge, &edge);
    plus(a, t.clamp(0.0, 1.0), &edge)
}
