//! The grid of cells: a torus, so that it needs no domain.
//!
//! A cell coordinate is taken modulo the number of cells. Particles in reach of each other have cell coordinates that
//! differ by at most one, and the modulus keeps that so: whatever happens, the 3^D cells around a particle's cell hold
//! all its neighbours. A particle that leaves the box in which the grid was laid wraps around to some other cell,
//! where the distance test rejects it: it costs nothing and breaks nothing. On a periodic axis the same wrap, with the
//! period added, gives the images.

use std::mem::MaybeUninit;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Cells of a block of space, repeated over all of it.
#[derive(Clone, Debug)]
pub struct Grid<const D: usize> {
    low: [f64; D],
    edge: [f64; D],
    inverse_edge: [f64; D],
    cells: [usize; D],
    periodic: [bool; D],
}

/// A contiguous run of cells and the shift that brings its particles next to the cell that asked.
#[derive(Clone, Copy, Debug)]
pub struct Run<const D: usize> {
    /// First cell.
    pub first: usize,
    /// One past the last cell.
    pub end: usize,
    /// To be added to the positions, in m.
    pub shift: [f64; D],
}

/// The runs of cells around a cell.
pub struct Runs<const D: usize> {
    runs: [MaybeUninit<Run<D>>; 27],
    count: usize,
}

impl<const D: usize> Runs<D> {
    #[inline(always)]
    fn none() -> Self {
        Runs {
            runs: [const { MaybeUninit::uninit() }; 27],
            count: 0,
        }
    }

    #[inline(always)]
    fn add(&mut self, first: usize, end: usize, shift: [f64; D]) {
        self.runs[self.count].write(Run { first, end, shift });
        self.count += 1;
    }
}

impl<const D: usize> std::ops::Deref for Runs<D> {
    type Target = [Run<D>];
    #[inline(always)]
    fn deref(&self) -> &[Run<D>] {
        // SAFETY: the first `count` are written.
        unsafe { std::slice::from_raw_parts(self.runs.as_ptr().cast(), self.count) }
    }
}

impl<const D: usize> Grid<D> {
    /// Bins per cell: its 2^D parts, which order the particles inside.
    pub const PARTS: usize = 1 << D;

    /// Lays cells of at least `reach` over the box from `low` to `high`; an axis with a period in `periodic` is covered
    /// exactly. No more than `budget` cells: beyond, far parts of the box share cells.
    pub fn new(
        low: [f64; D],
        high: [f64; D],
        reach: f64,
        periodic: [Option<[f64; 2]>; D],
        budget: usize,
    ) -> Self {
        let mut grid = Grid {
            low,
            edge: [reach; D],
            inverse_edge: [1.0 / reach; D],
            cells: [3; D],
            periodic: [false; D],
        };
        for a in 0..D {
            if let Some([from, to]) = periodic[a] {
                grid.low[a] = from;
                grid.periodic[a] = true;
                grid.cells[a] = (((to - from) / reach).floor() as usize).clamp(1, 1 << 20);
                grid.edge[a] = (to - from) / grid.cells[a] as f64;
                grid.inverse_edge[a] = 1.0 / grid.edge[a];
            } else {
                // A cast saturates: particles may be farther apart than numbers of cells go.
                let whole = ((high[a] - low[a]) / reach).floor() as usize;
                grid.cells[a] = whole.saturating_add(1).clamp(3, 1 << 20);
            }
        }
        while grid.count() > budget.max(27) {
            let widest = (0..D)
                .filter(|&a| !grid.periodic[a])
                .max_by_key(|&a| grid.cells[a]);
            match widest {
                Some(a) if grid.cells[a] > 3 => grid.cells[a] = (grid.cells[a] / 2).max(3),
                _ => break,
            }
        }
        // A long period in a nearly empty domain: wider cells on that axis.
        while grid.count() > 4 * budget.max(27) {
            let Some(a) = (0..D)
                .filter(|&a| grid.cells[a] > 1)
                .max_by_key(|&a| grid.cells[a])
            else {
                break;
            };
            let period = grid.edge[a] * grid.cells[a] as f64;
            grid.cells[a] = (grid.cells[a] / 2).max(1);
            grid.edge[a] = period / grid.cells[a] as f64;
            grid.inverse_edge[a] = 1.0 / grid.edge[a];
        }
        grid
    }

    /// Number of cells.
    pub fn count(&self) -> usize {
        self.cells.iter().fold(1usize, |n, &c| n.saturating_mul(c))
    }

    /// Edge of a cell in m, the largest extent of a group of particles that shares one frame.
    pub fn edge(&self) -> [f64; D] {
        self.edge
    }

    /// The bin of a position: its cell, and its part of the cell.
    #[inline(always)]
    pub fn bin(&self, x: &[f64; D]) -> u32 {
        let mut cell = 0usize;
        let mut part = 0usize;
        for a in (0..D).rev() {
            let t = (x[a] - self.low[a]) * self.inverse_edge[a];
            let floor = t.floor();
            part = 2 * part + (t - floor >= 0.5) as usize;
            // A float to integer cast saturates and sends NaN to 0: no position can leave the table.
            let c = floor as i64;
            let n = self.cells[a] as i64;
            // A wrapped position may still round to an end of the period: it belongs to the cell at that end.
            let c = match c {
                c if c >= 0 && c < n => c,
                c if self.periodic[a] => c.clamp(0, n - 1),
                c => c.rem_euclid(n),
            };
            cell = cell * self.cells[a] + c as usize;
        }
        (cell * Self::PARTS + part) as u32
    }

    /// Brings a position back into the period.
    #[inline(always)]
    pub fn wrap(&self, x: &mut [f64; D]) {
        for a in 0..D {
            if self.periodic[a] {
                let period = self.edge[a] * self.cells[a] as f64;
                let turns = ((x[a] - self.low[a]) / period).floor();
                if turns != 0.0 {
                    x[a] -= turns * period;
                }
            }
        }
    }

    /// Whether any axis is periodic.
    pub fn is_periodic(&self) -> bool {
        self.periodic.contains(&true)
    }

    /// Shortest vector from `b` to `a` over periodic images.
    #[inline]
    pub fn separation(&self, a: &[f64; D], b: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|k| {
            let d = a[k] - b[k];
            if self.periodic[k] {
                let period = self.edge[k] * self.cells[k] as f64;
                d - (d / period).round() * period
            } else {
                d
            }
        })
    }

    /// The runs of cells that cover the 3^D cells around `cell`, in ascending order of offset.
    #[inline]
    pub fn around(&self, cell: usize) -> Runs<D> {
        let at = self.coordinates(cell);
        let mut runs = Runs::none();
        for row in 0..3usize.pow(D as u32 - 1) {
            self.add_row(&mut runs, &at, row, 0);
        }
        runs
    }

    /// The runs of cells that cover `cell`, first of all, and those of its neighbours that are ahead of it: of every
    /// two neighbouring cells, one is ahead of the other.
    #[inline]
    pub fn ahead(&self, cell: usize) -> Runs<D> {
        let at = self.coordinates(cell);
        let mut runs = Runs::none();
        let rows = 3usize.pow(D as u32 - 1);
        self.add_row(&mut runs, &at, rows / 2, 1);
        for row in rows / 2 + 1..rows {
            self.add_row(&mut runs, &at, row, 0);
        }
        runs
    }

    /// Number of cells along each axis.
    pub fn shape(&self) -> [usize; D] {
        self.cells
    }

    #[inline(always)]
    fn coordinates(&self, cell: usize) -> [usize; D] {
        let mut rest = cell;
        std::array::from_fn(|a| {
            let c = rest % self.cells[a];
            rest /= self.cells[a];
            c
        })
    }

    /// Adds the cells from step `from` (0, 1 or 2) on of the `row`-th of the 3^(D-1) rows around the cell at `at`.
    #[inline(always)]
    fn add_row(&self, runs: &mut Runs<D>, at: &[usize; D], row: usize, from: usize) {
        let mut shift = [0.0; D];
        let mut base = 0usize;
        let mut digits = row;
        let mut stride = self.cells[0];
        for a in 1..D {
            let (c, s) = self.neighbour(a, at[a], digits % 3);
            digits /= 3;
            base += c * stride;
            stride *= self.cells[a];
            shift[a] = s;
        }
        let (n, x) = (self.cells[0], at[0]);
        if x > 0 && x + 1 < n {
            runs.add(base + x + from - 1, base + x + 2, shift);
        } else {
            for step in from..3 {
                let (c, s) = self.neighbour(0, x, step);
                shift[0] = s;
                runs.add(base + c, base + c + 1, shift);
            }
        }
    }

    /// Visits the cells that overlap the box from `low` to `high`, each with the box that it covers there.
    pub fn for_each_within(
        &self,
        low: &[f64; D],
        high: &[f64; D],
        mut visit: impl FnMut(usize, &[f64; D], &[f64; D]),
    ) {
        let coordinate =
            |a: usize, x: f64| ((x - self.low[a]) * self.inverse_edge[a]).floor() as i64;
        let first: [i64; D] = std::array::from_fn(|a| coordinate(a, low[a]));
        let count: [usize; D] = std::array::from_fn(|a| {
            ((coordinate(a, high[a]) - first[a] + 1).max(0) as usize).min(self.cells[a])
        });
        for k in 0..count.iter().product() {
            let (mut rest, mut cell, mut stride) = (k, 0, 1);
            let (mut from, mut to) = ([0.0; D], [0.0; D]);
            for a in 0..D {
                let c = first[a] + (rest % count[a]) as i64;
                rest /= count[a];
                cell += stride * c.rem_euclid(self.cells[a] as i64) as usize;
                stride *= self.cells[a];
                from[a] = self.low[a] + c as f64 * self.edge[a];
                to[a] = from[a] + self.edge[a];
            }
            visit(cell, &from, &to);
        }
    }

    /// The cell at `at + step - 1` on axis `a`, and the shift of its particles.
    #[inline(always)]
    fn neighbour(&self, a: usize, at: usize, step: usize) -> (usize, f64) {
        let n = self.cells[a];
        let period = if self.periodic[a] {
            self.edge[a] * n as f64
        } else {
            0.0
        };
        match (at + step).checked_sub(1) {
            None => (n - 1, -period),
            Some(c) if c >= n => (0, period),
            Some(c) => (c, 0.0),
        }
    }
}

/// The last edition of any [`Cells`].
static EDITION: AtomicU64 = AtomicU64::new(0);

/// Where the particles of each bin are, once a set is sorted.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// Index of the first particle of each bin, and at the end the number of particles.
    pub(crate) offsets: Vec<u32>,
    parts: usize,
    edition: u64,
}

impl Cells {
    /// No particles in `cells` cells of `parts` bins.
    pub fn new(cells: usize, parts: usize) -> Self {
        Cells {
            offsets: vec![0; cells * parts + 1],
            parts,
            edition: 0,
        }
    }

    /// A number that changes when particles are sorted, and that no other cells with particles have: what follows from
    /// where particles are holds as long as it is the same.
    pub fn edition(&self) -> u64 {
        self.edition
    }

    /// To be called where the particles of bins have changed.
    pub(crate) fn renew(&mut self) {
        self.edition = EDITION.fetch_add(1, Ordering::Relaxed) + 1;
    }

    /// Number of cells.
    pub fn count(&self) -> usize {
        (self.offsets.len() - 1) / self.parts.max(1)
    }

    /// The particles of the cells `first..end`.
    #[inline(always)]
    pub fn particles(&self, first: usize, end: usize) -> Range<usize> {
        self.offsets[first * self.parts] as usize..self.offsets[end * self.parts] as usize
    }

    /// The particles of the parts `first..end` of a cell.
    #[inline(always)]
    pub fn bins(&self, cell: usize, first: usize, end: usize) -> Range<usize> {
        let base = cell * self.parts;
        self.offsets[base + first] as usize..self.offsets[base + end] as usize
    }

    /// The first cell that starts at or after particle `index`.
    pub fn cell_from(&self, index: usize) -> usize {
        let bin = self.offsets.partition_point(|&o| (o as usize) < index);
        bin.div_ceil(self.parts).min(self.count())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.offsets.capacity() * 4
    }
}
