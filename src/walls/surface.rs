//! The surface of all walls: facets, found by cell.
//!
//! Facets are listed for the cells that they come near, and only those cells are ever visited: fluid away from walls
//! costs nothing, whatever the number of facets.

use super::facet::{Facet, minus, plus};
use crate::neighbours::Grid;
use crate::simd::dot;

/// Distances that differ by less than this share of the reach are equal.
const EQUAL: f64 = 1e-9;
/// Largest share of a direction that may lie outside the normals which make it up.
const ASKEW: f64 = 1e-3;

/// Facets by cell.
#[derive(Clone, Debug)]
pub struct Surface<const D: usize> {
    facets: Vec<Facet<D>>,
    reach: f64,
    /// The cells near which there are facets, ascending, and where their lists start.
    cells: Vec<u32>,
    offsets: Vec<u32>,
    members: Vec<u32>,
}

/// The point of the surface that is nearest to some point.
#[derive(Clone, Copy, Debug)]
pub struct Foot<const D: usize> {
    /// It, in m.
    pub point: [f64; D],
    /// Unit normal, into the fluid, of the facet there; where several meet, of the one that is seen least askew.
    pub normal: [f64; D],
    /// Distance in m, negative behind the surface.
    pub distance: f64,
    /// The wall, counted among walls.
    pub body: u32,
    /// Whether the way there is along a normal of the surface or, at an edge, between those of its facets. False beyond
    /// the rim of an open surface, where nothing is in front of it or behind.
    pub faces: bool,
}

impl<const D: usize> Surface<D> {
    /// Lists `facets` for the cells of `grid` within `reach` (m) of them.
    pub fn new(facets: Vec<Facet<D>>, grid: &Grid<D>, reach: f64) -> Self {
        let mut entries: Vec<(u32, u32)> = Vec::new();
        for (k, facet) in facets.iter().enumerate() {
            let (low, high) = facet.bounds();
            let wide = |x: [f64; D], s: f64| x.map(|x| x + s * reach);
            grid.for_each_within(&wide(low, -1.0), &wide(high, 1.0), |cell, from, to| {
                let centre: [f64; D] = std::array::from_fn(|a| 0.5 * (from[a] + to[a]));
                let half = 0.5 * dot(&minus(to, from), &minus(to, from)).sqrt();
                let d = minus(&facet.closest(&centre), &centre);
                if dot(&d, &d).sqrt() <= half + reach {
                    entries.push((cell as u32, k as u32));
                }
            });
        }
        entries.sort_unstable();
        entries.dedup();
        let mut surface = Surface {
            facets,
            reach,
            cells: Vec::new(),
            offsets: Vec::new(),
            members: entries.iter().map(|e| e.1).collect(),
        };
        for (at, (cell, _)) in entries.iter().enumerate() {
            if surface.cells.last() != Some(cell) {
                surface.cells.push(*cell);
                surface.offsets.push(at as u32);
            }
        }
        surface.offsets.push(entries.len() as u32);
        surface
    }

    /// All facets.
    pub fn facets(&self) -> &[Facet<D>] {
        &self.facets
    }

    /// How far from a facet it is found, in m.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The cells near which there are facets.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// The facets near the `k`-th of those cells.
    #[inline]
    pub fn near(&self, k: usize) -> &[u32] {
        &self.members[self.offsets[k] as usize..self.offsets[k + 1] as usize]
    }

    /// The facets near a cell.
    pub fn near_cell(&self, cell: usize) -> &[u32] {
        match self.cells.binary_search(&(cell as u32)) {
            Ok(k) => self.near(k),
            Err(_) => &[],
        }
    }

    /// The nearest point among `facets`, if one is in reach of `x`.
    pub fn foot(&self, x: &[f64; D], facets: &[u32]) -> Option<Foot<D>> {
        let mut least = self.reach * self.reach;
        let mut found = None;
        for &k in facets {
            let facet = &self.facets[k as usize];
            let height = dot(&minus(x, &facet.corners[0]), &facet.normal);
            if height * height <= least {
                let y = facet.closest(x);
                let d = minus(x, &y);
                let square = dot(&d, &d);
                if square < least {
                    (least, found) = (square, Some((y, d)));
                }
            }
        }
        let (point, offset) = found?;
        let distance = least.sqrt();
        let tie = EQUAL * self.reach;
        // What the normals of the facets that meet there do not explain of the way to it.
        let mut rest = offset;
        let mut basis: [[f64; D]; D] = [[0.0; D]; D];
        let mut known = 0;
        let (mut best, mut height, mut body) = ([0.0; D], 0.0, 0);
        for &k in facets {
            let facet = &self.facets[k as usize];
            let d = minus(&facet.closest(x), &point);
            if dot(&d, &d) > tie * tie {
                continue;
            }
            let n = facet.normal;
            let straight = dot(&n, &offset);
            if straight.abs() >= f64::abs(height) {
                (best, height, body) = (n, straight, facet.body);
            }
            if known < D {
                let mut v = n;
                for b in &basis[..known] {
                    v = plus(&v, -dot(&v, b), b);
                }
                let length = dot(&v, &v).sqrt();
                if length > ASKEW {
                    let b = v.map(|v| v / length);
                    rest = plus(&rest, -dot(&rest, &b), &b);
                    basis[known] = b;
                    known += 1;
                }
            }
        }
        Some(Foot {
            point,
            normal: best,
            distance: if height < 0.0 { -distance } else { distance },
            body,
            faces: dot(&rest, &rest).sqrt() <= ASKEW * distance + tie,
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.facets.capacity() * size_of::<Facet<D>>()
            + 4 * (self.cells.capacity() + self.offsets.capacity() + self.members.capacity())
    }
}
