//! The planes of walls, and which walls are made of planes that can mirror.

use super::facet::{Facet, minus, plus};
use crate::simd::dot;
use std::collections::BTreeMap;

/// How far directions of one plane may differ, and from a right angle.
const STRAIGHT: f64 = 1e-6;
/// How far points of one plane may be off it, in spacings.
const FLAT: f64 = 1e-6;
/// Corners that differ by less, in spacings, are one.
const ALIKE: f64 = 1e-4;
/// Most planes of plane walls: more are a curve.
const MOST: usize = 1024;

/// A plane and the parts of it that are walls.
#[derive(Clone, Debug)]
pub(super) struct Plane<const D: usize> {
    /// Into the fluid.
    pub(super) normal: [f64; D],
    /// `n·x` of its points, in m.
    offset: f64,
    /// The wall of its first facet.
    pub(super) body: u32,
    /// Its facets, by number.
    pub(super) facets: Vec<u32>,
    /// Where its walls end with nothing in front of the end: edges (corners in 2D) of one facet only, but for those at which
    /// another plane stands.
    rim: Vec<Edge<D>>,
    tolerance: f64,
}

/// From and to, in m; the same in 2D.
type Edge<const D: usize> = [[f64; D]; 2];

impl<const D: usize> Plane<D> {
    /// The planes of facets; `None` if there are more than `most`.
    pub(super) fn of(facets: &[Facet<D>], spacing: f64, most: usize) -> Option<Vec<Self>> {
        let mut planes: Vec<Self> = Vec::new();
        for (k, facet) in facets.iter().enumerate() {
            let offset = dot(&facet.normal, &facet.centre());
            let same = planes.iter_mut().find(|p| {
                let turn = minus(&p.normal, &facet.normal);
                dot(&turn, &turn) < STRAIGHT * STRAIGHT && (p.offset - offset).abs() < p.tolerance
            });
            if let Some(plane) = same {
                plane.facets.push(k as u32);
                continue;
            }
            if planes.len() == most {
                return None;
            }
            planes.push(Plane {
                normal: facet.normal,
                offset,
                body: facet.body,
                facets: vec![k as u32],
                rim: Vec::new(),
                tolerance: FLAT * spacing,
            });
        }
        Some(planes)
    }

    /// How far `x` is in front of it, in m.
    #[inline]
    pub(super) fn height(&self, x: &[f64; D]) -> f64 {
        dot(&self.normal, x) - self.offset
    }

    /// Finds the rims of all `planes`; images reach as far as `reach` (m).
    pub(super) fn find_rims(planes: &mut [Self], facets: &[Facet<D>], spacing: f64, reach: f64) {
        let rims: Vec<_> = planes
            .iter()
            .map(|p| p.ends(planes, facets, spacing, reach))
            .collect();
        for (plane, rim) in planes.iter_mut().zip(rims) {
            plane.rim = rim;
        }
    }

    fn ends(&self, planes: &[Self], facets: &[Facet<D>], spacing: f64, reach: f64) -> Vec<Edge<D>> {
        let key = |x: &[f64; D]| x.map(|x| (x / (ALIKE * spacing)).round() as i64);
        let mut edges = BTreeMap::new();
        for &f in &self.facets {
            let facet = &facets[f as usize];
            for k in 0..D {
                let from = facet.corners[k];
                let to = if D == 2 {
                    from
                } else {
                    facet.corners[(k + 1) % D]
                };
                let name = (key(&from).min(key(&to)), key(&from).max(key(&to)));
                let entry = edges.entry(name).or_insert(([from, to], facet.centre(), 0));
                entry.2 += 1;
            }
        }
        let on =
            |p: &Self, x: &[f64; D]| p.height(x).abs() < ALIKE * spacing && p.covers(x, facets);
        // A plane at its end, as high as images reach: no fluid is beyond.
        let stands = |p: &Self, edge: &Edge<D>, centre: &[f64; D]| {
            let middle = plus(&edge[0].map(|x| 0.5 * x), 0.5, &edge[1]);
            dot(&p.normal, &self.normal).abs() < 0.5
                && p.height(centre) > 0.0
                && [edge[0], edge[1], middle]
                    .iter()
                    .all(|x| on(p, x) && on(p, &plus(x, 0.999 * reach, &self.normal)))
        };
        edges
            .into_values()
            .filter(|(edge, centre, count)| {
                *count == 1 && !planes.iter().any(|p| stands(p, edge, centre))
            })
            .map(|(edge, ..)| edge)
            .collect()
    }

    /// Whether its walls go on for `reach` (m) around the foot of `x`, which is on them, as far as there is fluid.
    pub(super) fn goes_on(&self, x: &[f64; D], reach: f64) -> bool {
        let foot = plus(x, -self.height(x), &self.normal);
        self.rim.iter().all(|[from, to]| {
            let edge = minus(to, from);
            let length = dot(&edge, &edge);
            let way = minus(&foot, from);
            let t = if length > 0.0 {
                (dot(&way, &edge) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let d = plus(&way, -t, &edge);
            dot(&d, &d) >= reach * reach
        })
    }

    /// Whether the foot of `x` is on one of its facets.
    pub(super) fn covers(&self, x: &[f64; D], facets: &[Facet<D>]) -> bool {
        let foot = plus(x, -self.height(x), &self.normal);
        self.facets.iter().any(|&f| {
            let d = minus(&facets[f as usize].closest(&foot), &foot);
            dot(&d, &d) < self.tolerance * self.tolerance
        })
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>() + 4 * self.facets.capacity() + size_of::<Edge<D>>() * self.rim.capacity()
    }

    /// The least distance of boxes around its facets and those of another plane, in m.
    fn gap(&self, other: &Self, facets: &[Facet<D>]) -> f64 {
        let mut least = f64::INFINITY;
        for &f in &self.facets {
            let (low, high) = facets[f as usize].bounds();
            for &g in &other.facets {
                let (from, to) = facets[g as usize].bounds();
                let square: f64 = (0..D)
                    .map(|a| (from[a] - high[a]).max(low[a] - to[a]).max(0.0).powi(2))
                    .sum();
                least = least.min(square.sqrt());
            }
        }
        least
    }
}

/// Checks that images by the planes of `facets` fill what is behind them within `support` (m): gives the number of a wall where
/// they do not, and why.
pub fn check_planes<const D: usize>(
    facets: &[Facet<D>],
    support: f64,
    spacing: f64,
) -> Result<(), (u32, String)> {
    let Some(planes) = Plane::of(facets, spacing, MOST) else {
        let body = facets.last().map_or(0, |f| f.body);
        return Err((body, "is curved".to_owned()));
    };
    let near = support * (1.0 - 1e-6);
    for (k, a) in planes.iter().enumerate() {
        for b in &planes[k + 1..] {
            let along = dot(&a.normal, &b.normal);
            let parallel = along.abs() > 1.0 - STRAIGHT;
            // Right angles are fine, and planes that face the same way.
            if along.abs() < STRAIGHT || parallel && along > 0.0 || a.gap(b, facets) >= near {
                continue;
            }
            let why = if !parallel {
                "has planes that meet at no right angle, or is curved".to_owned()
            } else {
                let between = a.height(&facets[b.facets[0] as usize].centre());
                let (what, size) = if between < 0.0 {
                    ("is a plate, with fluid on both sides,", -between)
                } else {
                    ("leaves a gap", between)
                };
                format!("{what} of {size:.4} m, less than the support radius of {support:.4} m")
            };
            return Err((b.body, why));
        }
    }
    Ok(())
}
