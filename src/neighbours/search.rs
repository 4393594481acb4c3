//! Neighbour search of the array functions: any set of points, in particles' own order.
//!
//! Points are sorted into cells no smaller than the radius by a counting sort. Cell coordinates are counted from the
//! origin of space and taken modulo the number of cells of an axis, so there is no domain: cells in reach of each other
//! stay in reach, and a point far away only shares a cell with others, where the distance rejects it.

use rayon::prelude::*;
use std::ops::Range;

/// Lower and upper end of the periodic axes.
pub type Periods<const D: usize> = [Option<[f64; 2]>; D];

/// Neighbours of every point, in compressed rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Neighbours {
    /// Row `i` is `indices[offsets[i]..offsets[i + 1]]`; one more than there are points.
    pub offsets: Vec<i64>,
    /// Neighbours, ascending within a row.
    pub indices: Vec<u32>,
}

/// All pairs within `radius` [m] (its end included), in time and memory proportional to points and pairs.
///
/// A point is not its own neighbour; points in the same place are neighbours of each other. On a periodic axis the
/// nearest image counts, so the period should be at least two radii. A point that is not a number has no neighbours.
///
/// # Panics
/// With more than `u32::MAX` points.
pub fn neighbours<const D: usize>(
    position: &[[f64; D]],
    radius: f64,
    periodic: &Periods<D>,
) -> Neighbours {
    let grid = PointGrid::new(position, radius, periodic);
    Neighbours::by_row(position.len(), |i, row| {
        let begin = row.len();
        grid.for_each_near(&position[i], |j, _, _| {
            if j != i {
                row.push(j as u32);
            }
        });
        row[begin..].sort_unstable();
    })
}

impl Neighbours {
    /// The neighbours of point `i`.
    pub fn row(&self, i: usize) -> &[u32] {
        &self.indices[self.offsets[i] as usize..self.offsets[i + 1] as usize]
    }

    /// Rows that `find(i, row)` appends to, in parallel.
    pub(super) fn by_row(points: usize, find: impl Fn(usize, &mut Vec<u32>) + Sync) -> Self {
        const GRAIN: usize = 1024;
        let blocks: Vec<(Vec<usize>, Vec<u32>)> = (0..points.div_ceil(GRAIN))
            .into_par_iter()
            .map(|block| {
                let (mut ends, mut found) = (Vec::with_capacity(GRAIN), Vec::new());
                for i in block * GRAIN..points.min((block + 1) * GRAIN) {
                    find(i, &mut found);
                    ends.push(found.len());
                }
                (ends, found)
            })
            .collect();
        let mut offsets = Vec::with_capacity(points + 1);
        offsets.push(0);
        let mut total = 0;
        for (ends, found) in &blocks {
            offsets.extend(ends.iter().map(|end| (total + end) as i64));
            total += found.len();
        }
        let mut indices = vec![0; total];
        let mut rest = indices.as_mut_slice();
        let mut parts = Vec::with_capacity(blocks.len());
        for (_, found) in &blocks {
            let (part, after) = rest.split_at_mut(found.len());
            parts.push(part);
            rest = after;
        }
        let copies = parts.into_par_iter().zip(blocks);
        copies.for_each(|(part, (_, found))| part.copy_from_slice(&found));
        Neighbours { offsets, indices }
    }
}

/// Points sorted into cells, to be asked for those near any place.
#[derive(Clone, Debug)]
pub struct PointGrid<const D: usize> {
    radius_squared: f64,
    axes: [Axis; D],
    /// First place of each cell in `order` and `sorted`, and one end more.
    starts: Vec<u32>,
    /// Index of the point at each place.
    order: Vec<u32>,
    /// Its position.
    sorted: Vec<[f64; D]>,
}

impl<const D: usize> PointGrid<D> {
    /// Sorts `position` [m] into cells for searches within `radius` [m], positive.
    ///
    /// # Panics
    /// With more than `u32::MAX` points.
    pub fn new(position: &[[f64; D]], radius: f64, periodic: &Periods<D>) -> Self {
        assert!(
            u32::try_from(position.len()).is_ok(),
            "too many points: {}",
            position.len()
        );
        let axes = lay_axes(position, radius, periodic);
        let position: Vec<[f64; D]> = position.par_iter().map(|x| wrapped(&axes, x)).collect();
        let cells = axes
            .iter()
            .map(|axis| axis.count as usize)
            .product::<usize>();
        let cell_of = |x: &[f64; D]| {
            (0..D).fold(0, |cell, a| {
                cell * axes[a].count as usize + axes[a].cell(x[a])
            }) as u32
        };
        let cell: Vec<u32> = position.par_iter().map(cell_of).collect();
        let mut starts = vec![0; cells + 1];
        for &c in &cell {
            starts[c as usize + 1] += 1;
        }
        for c in 0..cells {
            starts[c + 1] += starts[c];
        }
        let mut next = starts.clone();
        let mut order = vec![0; position.len()];
        for (i, &c) in cell.iter().enumerate() {
            let place = &mut next[c as usize];
            order[*place as usize] = i as u32;
            *place += 1;
        }
        let sorted = order.par_iter().map(|&i| position[i as usize]).collect();
        Self {
            radius_squared: radius * radius,
            axes,
            starts,
            order,
            sorted,
        }
    }

    /// Calls `visit(j, x - x_j, distance²)` for every point `j` within the radius of `x`, always in the same order. On
    /// periodic axes the difference is to the nearest image.
    #[inline]
    pub fn for_each_near(&self, x: &[f64; D], mut visit: impl FnMut(usize, [f64; D], f64)) {
        let x = wrapped(&self.axes, x);
        self.for_each_run(&x, |places| {
            for place in places {
                let (d, squared) = separation(&self.axes, &x, &self.sorted[place]);
                if squared <= self.radius_squared {
                    visit(self.order[place] as usize, d, squared);
                }
            }
        });
    }

    /// The places of all cells that touch the cell of `x`, in runs as long as possible.
    #[inline]
    fn for_each_run(&self, x: &[f64; D], mut run: impl FnMut(Range<usize>)) {
        let near: [([usize; 3], usize); D] = std::array::from_fn(|a| self.axes[a].near(x[a]));
        let last = &near[D - 1].0[..near[D - 1].1];
        let mut pick = [0; D];
        loop {
            let row = (0..D - 1).fold(0, |cell, a| {
                cell * self.axes[a].count as usize + near[a].0[pick[a]]
            }) * self.axes[D - 1].count as usize;
            let mut k = 0;
            while k < last.len() {
                let first = last[k];
                let mut end = first;
                while k < last.len() && last[k] == end {
                    end += 1;
                    k += 1;
                }
                run(self.starts[row + first] as usize..self.starts[row + end] as usize);
            }
            // The next combination of the other axes, like an odometer.
            let mut a = D - 1;
            loop {
                if a == 0 {
                    return;
                }
                a -= 1;
                pick[a] += 1;
                if pick[a] < near[a].1 {
                    break;
                }
                pick[a] = 0;
            }
        }
    }
}

/// One axis of a [`PointGrid`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    origin: f64,
    inverse_edge: f64,
    count: i64,
    /// Zero where the axis is not periodic.
    period: f64,
    inverse_period: f64,
}

impl Axis {
    pub(super) fn new(radius: f64, periodic: Option<[f64; 2]>) -> Self {
        // Cells are a little larger than the radius, so that rounding of a cell coordinate, even at 1e12 radii from
        // the origin, never puts a pair in reach two cells apart.
        let inverse_edge = 1.0 / (1.001 * radius);
        match periodic {
            None => Self {
                origin: 0.0,
                inverse_edge,
                count: 1,
                period: 0.0,
                inverse_period: 0.0,
            },
            Some([low, high]) => {
                let mut axis = Self {
                    origin: low,
                    inverse_edge,
                    count: 1,
                    period: high - low,
                    inverse_period: 1.0 / (high - low),
                };
                axis.resize(((high - low) * inverse_edge).min(1e9) as i64);
                axis
            }
        }
    }

    /// Sets the number of cells; those of a periodic axis grow to cover it exactly.
    fn resize(&mut self, count: i64) {
        self.count = count.max(1);
        if self.period > 0.0 {
            self.inverse_edge = self.count as f64 * self.inverse_period;
        }
    }

    /// `x` in the period, by a remainder without error; as it is where it is in it already.
    #[inline]
    fn wrapped(&self, x: f64) -> f64 {
        let from = x - self.origin;
        if self.period == 0.0 || (0.0..=self.period).contains(&from) {
            return x;
        }
        self.origin + from.rem_euclid(self.period)
    }

    #[inline]
    fn cell(&self, x: f64) -> usize {
        let cell = ((x - self.origin) * self.inverse_edge).floor() as i64;
        cell.rem_euclid(self.count) as usize
    }

    /// The cell of `x` and its neighbours, ascending, each once; and how many these are.
    #[inline]
    fn near(&self, x: f64) -> ([usize; 3], usize) {
        let (n, c) = (self.count as usize, self.cell(x));
        match n {
            1 => ([0, 0, 0], 1),
            2 => ([0, 1, 0], 2),
            _ if c == 0 => ([0, 1, n - 1], 3),
            _ if c == n - 1 => ([0, n - 2, n - 1], 3),
            _ => ([c - 1, c, c + 1], 3),
        }
    }
}

/// Axes whose cells cover the points, but are not more than the points.
fn lay_axes<const D: usize>(
    position: &[[f64; D]],
    radius: f64,
    periodic: &Periods<D>,
) -> [Axis; D] {
    let mut axes: [Axis; D] = std::array::from_fn(|a| Axis::new(radius, periodic[a]));
    for a in 0..D {
        if axes[a].period == 0.0 {
            let (low, high) = position
                .par_iter()
                .map(|x| (x[a], x[a]))
                .reduce(|| (f64::MAX, f64::MIN), |p, q| (p.0.min(q.0), p.1.max(q.1)));
            axes[a].resize(((high - low) * axes[a].inverse_edge).clamp(0.0, 1e9) as i64 + 2);
        }
    }
    let budget = position.len().clamp(64, 1 << 30) as f64;
    while axes.iter().map(|axis| axis.count as f64).product::<f64>() > budget {
        let Some(widest) = axes.iter_mut().max_by_key(|axis| axis.count) else {
            break;
        };
        // An odd number of cells, lest a lattice of points folds onto few of them.
        let half = widest.count / 2;
        widest.resize(if widest.period == 0.0 && half > 2 {
            (half - 1) | 1
        } else {
            half
        });
    }
    axes
}

/// `x` in the periods. Far outside, cell and distance would each be rounded, and to different places.
#[inline]
pub(super) fn wrapped<const D: usize>(axes: &[Axis; D], x: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|a| axes[a].wrapped(x[a]))
}

/// `x - y` and its square, to the nearest image on periodic axes.
#[inline(always)]
pub(super) fn separation<const D: usize>(
    axes: &[Axis; D],
    x: &[f64; D],
    y: &[f64; D],
) -> ([f64; D], f64) {
    let mut d = [0.0; D];
    let mut squared = 0.0;
    for a in 0..D {
        d[a] = x[a] - y[a];
        if axes[a].period > 0.0 {
            d[a] -= axes[a].period * (d[a] * axes[a].inverse_period).round();
        }
        squared += d[a] * d[a];
    }
    (d, squared)
}
