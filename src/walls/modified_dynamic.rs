//! Modified dynamic boundaries (English et al. 2021): wall values from ghost nodes mirrored into the fluid.

use super::follow_pressure;
use super::surface::Surface;
use crate::eos::{AnyEos, EquationOfState};
use crate::neighbours::{Cells, Grid, Sorter};
use crate::particles::{Column, Shared, Wall, for_each_range, vector_columns};
use crate::prescribed::Pose;
use crate::simd::{Lanes, Real, dot};
use crate::sweep::{Other, Output, Own, Pair, Pass, Splat, Sums};

/// Below this determinant (1 inside a fluid) the neighbours of a node do not tell a gradient.
const SINGULAR: f64 = 1e-3;

/// The ghost nodes of wall particles: `r_g = r_w + 2 (r_s - r_w)`, where `r_s` is the nearest point of the surface.
/// In a corner that is the corner itself. Wall particles without a surface in reach of a kernel have none: the fluid
/// never meets them.
pub struct Ghosts<R, const D: usize> {
    /// The nodes at the start.
    nodes: Vec<Node<D>>,
    sorter: Sorter,
    /// Where the wall particle of each id is.
    place: Vec<u32>,
    /// Position in m.
    pub position: [Column<f64>; D],
    /// `r_w - r_g` in m.
    pub offset: [Column<R>; D],
    /// Mass of the wall particle.
    pub mass: Column<R>,
    /// Velocity of the wall particle.
    pub velocity: [Column<R>; D],
    /// Nodes by cell.
    pub cells: Cells,
    /// The wall particle of each node.
    owner: Column<u32>,
    /// What [`NodeWeights`] leaves: `c_0`, `c`, the difference of pressure along gravity.
    pub weight: Column<R>,
    /// See there.
    pub slope: [Column<R>; D],
    /// See there.
    pub head: Column<R>,
    /// Pressure, condensation and volume for the owner.
    pub values: [Column<R>; 3],
    /// The velocity that viscosity sees at a wall to which fluid sticks.
    pub slip_velocity: Option<[Column<R>; D]>,
}

/// A node at the start, with the id of its wall particle.
struct Node<const D: usize> {
    position: [f64; D],
    offset: [f64; D],
    id: u32,
}

impl<R: Real, const D: usize> Ghosts<R, D> {
    /// Mirrors the particles of `wall`, as they are at the start, at `surface`. Their values are those of a wall without
    /// fluid.
    pub fn new(wall: &mut Wall<R, D>, surface: &Surface<D>, grid: &Grid<D>, eos: &AnyEos) -> Self {
        let mut nodes = Vec::new();
        for i in 0..wall.len() {
            let x: [f64; D] = std::array::from_fn(|a| wall.position[a][i]);
            let cell = grid.bin(&x) as usize / Grid::<D>::PARTS;
            if let Some(foot) = surface.foot(&x, surface.near_cell(cell))
                && foot.distance < 0.0
            {
                let position = std::array::from_fn(|a| 2.0 * foot.point[a] - x[a]);
                nodes.push(Node {
                    position,
                    offset: std::array::from_fn(|a| x[a] - position[a]),
                    id: wall.id[i],
                });
            }
            let rest = follow_pressure(eos, eos.condensation(0.0), 0.0, wall.mass[i].to_f64());
            (wall.condensation[i], wall.volume[i]) = (R::from_f64(rest.0), R::from_f64(rest.1));
        }
        let n = nodes.len();
        let mut ghosts = Ghosts {
            nodes,
            sorter: Sorter::new(n),
            place: vec![0; wall.len()],
            position: vector_columns(n),
            offset: vector_columns(n),
            mass: Column::new(n),
            velocity: vector_columns(n),
            cells: Cells::new(grid.count(), Grid::<D>::PARTS),
            owner: Column::new(n),
            weight: Column::new(n),
            slope: vector_columns(n),
            head: Column::new(n),
            values: std::array::from_fn(|_| Column::new(n)),
            slip_velocity: wall.slip_velocity.is_some().then(|| vector_columns(n)),
        };
        ghosts.follow(wall, grid, |_| None);
        ghosts
    }

    /// Follows the particles of `wall`; `pose` tells where the wall of a particle's id is, if it moves.
    pub fn follow<'a>(
        &mut self,
        wall: &Wall<R, D>,
        grid: &Grid<D>,
        pose: impl Fn(u32) -> Option<&'a Pose> + Sync,
    ) {
        for (i, &id) in wall.id.iter().enumerate() {
            self.place[id as usize] = i as u32;
        }
        let nodes = &self.nodes;
        let at = |k: usize| {
            let node = &nodes[k];
            let pose = pose(node.id);
            let mut x = pose.map_or(node.position, |p| p.of(&node.position)[0]);
            grid.wrap(&mut x);
            (x, pose.map_or(node.offset, |p| p.turned(&node.offset)))
        };
        self.sorter.sort(&mut self.cells, |k| grid.bin(&at(k).0));
        for (k, &from) in self.sorter.order.iter().enumerate() {
            let (x, offset) = at(from as usize);
            let owner = self.place[nodes[from as usize].id as usize];
            self.owner[k] = owner;
            self.mass[k] = wall.mass[owner as usize];
            for a in 0..D {
                self.position[a][k] = x[a];
                self.offset[a][k] = R::from_f64(offset[a]);
                self.velocity[a][k] = wall.pair_velocity[a][owner as usize];
            }
        }
    }

    /// Gives every wall particle the values of its node.
    pub fn hand_over(&self, wall: &mut Wall<R, D>) {
        let values = [&mut wall.pressure, &mut wall.condensation, &mut wall.volume];
        let to = values.map(|c| Shared::new(c));
        let slip = wall
            .slip_velocity
            .as_mut()
            .map(|s| s.each_mut().map(|c| Shared::new(c)));
        for_each_range(self.owner.len(), |range| {
            for k in range {
                let i = self.owner[k] as usize;
                // SAFETY: every wall particle has one node at most.
                unsafe {
                    for (to, from) in to.iter().zip(&self.values) {
                        to.write(i, from[k]);
                    }
                    if let (Some(to), Some(from)) = (&slip, &self.slip_velocity) {
                        for a in 0..D {
                            to[a].write(i, from[a][k]);
                        }
                    }
                }
            }
        });
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        D * (self.position[0].bytes() + 3 * self.offset[0].bytes())
            + 6 * self.mass.bytes()
            + self.slip_velocity.as_ref().map_or(0, |s| D * s[0].bytes())
            + self.cells.bytes()
            + self.owner.bytes()
            + self.sorter.bytes()
            + 4 * self.place.capacity()
            + size_of::<Node<D>>() * self.nodes.capacity()
    }
}

/// Weights of the pressure and its gradient at a node `g`, consistent to first order (Liu & Liu 2006) and carried to the
/// wall particle: with `x = r_j - r_g` and `A = Σ V_j [W, ∇W]ᵀ [1, x]`, the solution of `A [p_g, ∇p_g] = Σ V_j p_j [W, ∇W]`
/// gives `p_w = p_g + (r_w - r_g)·∇p_g = Σ V_j p_j (c_0 W + c·∇W)`, where `Aᵀ [c_0, c] = [1, r_w - r_g]`.
///
/// English et al. extrapolate density: in pressure the same holds exactly for any equation of state. Where the matrix is
/// singular, `c_0 = 1/Σ V_j W` and the mean of the neighbours is carried along gravity, as at a dummy particle.
///
/// Writes `c_0`, `c` and that difference of pressure, for [`NodeValues`].
pub struct NodeWeights<const D: usize> {
    /// Gravity in m/s².
    pub gravity: [f64; D],
    /// Density at rest in kg/m³.
    pub reference_density: f64,
    /// Smoothing length in m.
    pub smoothing_length: f64,
}

impl<R: Real, const D: usize> Pass<R, D> for NodeWeights<D> {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        _own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let (volume, s) = (other.volume(), &pair.separation);
        let weight = volume * pair.weight();
        let slope = volume * pair.slope;
        sums.scalar += weight;
        for a in 0..D {
            sums.vector[a] = weight.mul_add(s[a], sums.vector[a]);
            sums.gradient[a] = slope.mul_add(s[a], sums.gradient[a]);
        }
        sums.add_moment(slope, s);
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        let offset = own.values().gradient().map(Real::to_f64);
        let weight = sums.scalar.sum().to_f64();
        let (mut c, mut head) = ([0.0; 4], 0.0);
        if weight > 1e-12 {
            // In units of the smoothing length, so that all entries are of the same size; x = -s, and ∇W = F s.
            let h = self.smoothing_length;
            let m = sums.moment.map(|m| m.sum().to_f64());
            let symmetric = [[m[0], m[2], m[5]], [m[2], m[1], m[4]], [m[5], m[4], m[3]]];
            let mut transposed = [[0.0; 5]; 4];
            transposed[0][0] = weight;
            transposed[0][4] = 1.0;
            for k in 0..D {
                transposed[1 + k][0] = -sums.vector[k].sum().to_f64() / h;
                transposed[0][1 + k] = sums.gradient[k].sum().to_f64() * h;
                transposed[1 + k][4] = offset[k] / h;
                for l in 0..D {
                    transposed[1 + k][1 + l] = -symmetric[k][l];
                }
            }
            if let Some(solution) = solve::<D>(transposed) {
                c = solution.map(|c| c * h);
                c[0] = solution[0];
            } else {
                c[0] = 1.0 / weight;
                let way =
                    std::array::from_fn(|a| offset[a] + sums.vector[a].sum().to_f64() / weight);
                head = super::head(self.reference_density, &self.gravity, &way);
            }
        }
        out[0][i] = R::from_f64(c[0]);
        for a in 0..D {
            out[1 + a][i] = R::from_f64(c[1 + a]);
        }
        out[4][i] = R::from_f64(head);
    }
}

/// Pressure, condensation and volume of the wall particles from the weights of their nodes; at a no-slip wall also the
/// velocity that viscosity sees, `2 u_wall - Σ V_j u_j W / Σ V_j W`.
pub struct NodeValues {
    /// Equation of state of the fluid.
    pub eos: AnyEos,
    /// Condensation without pressure.
    pub at_rest: f64,
    /// Whether a wall may pull.
    pub suction: bool,
    /// Whether the fluid sticks.
    pub no_slip: bool,
}

impl<R: Real, const D: usize> Pass<R, D> for NodeValues {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        // The node's "pressure" is c_0, its "gradient" c.
        let weight = other.volume() * pair.weight();
        let slope = other.volume() * pair.slope;
        let share = own.pressure() * weight + dot(&own.gradient(), &pair.separation) * slope;
        sums.scalar = share.mul_add(other.pressure(), sums.scalar);
        if self.no_slip {
            let u = other.velocity();
            sums.moment[0] += weight;
            for a in 0..D {
                sums.vector[a] = weight.mul_add(u[a], sums.vector[a]);
            }
        }
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        let own = own.values();
        // The node's "condensation" is the difference of pressure along gravity.
        let mut pressure = sums.scalar.sum().to_f64() + own.condensation().to_f64();
        if !self.suction {
            pressure = pressure.max(0.0);
        }
        // The node's "volume" is its mass.
        let mass = own.volume().to_f64();
        let (condensation, volume) = follow_pressure(&self.eos, self.at_rest, pressure, mass);
        out[0][i] = R::from_f64(pressure);
        out[1][i] = R::from_f64(condensation);
        out[2][i] = R::from_f64(volume);
        if self.no_slip {
            let (wall, weight) = (own.velocity(), sums.moment[0].sum().to_f64());
            for a in 0..D {
                out[3 + a][i] = if weight > 1e-12 {
                    let mean = sums.vector[a].sum().to_f64() / weight;
                    R::from_f64(2.0 * wall[a].to_f64() - mean)
                } else {
                    wall[a]
                };
            }
        }
    }
}

/// Solves the first `D + 1` equations with pivots; the right-hand side is the last column. `None` where the determinant
/// is small.
fn solve<const D: usize>(mut a: [[f64; 5]; 4]) -> Option<[f64; 4]> {
    let n = D + 1;
    let mut determinant = 1.0;
    for k in 0..n {
        let mut pivot = k;
        for r in k + 1..n {
            if a[r][k].abs() > a[pivot][k].abs() {
                pivot = r;
            }
        }
        a.swap(k, pivot);
        determinant *= a[k][k];
        if a[k][k] == 0.0 {
            return None;
        }
        for r in k + 1..n {
            let factor = a[r][k] / a[k][k];
            for c in k..5 {
                a[r][c] -= factor * a[k][c];
            }
        }
    }
    if determinant.is_nan() || determinant.abs() < SINGULAR {
        return None;
    }
    let mut x = [0.0; 4];
    for k in (0..n).rev() {
        let mut sum = a[k][4];
        for c in k + 1..n {
            sum -= a[k][c] * x[c];
        }
        x[k] = sum / a[k][k];
    }
    Some(x)
}
