//! Surface tension of a liquid with a free surface: a force per volume along the gradient of the liquid's share of the
//! support (Brackbill, Kothe & Zemach 1992), in three sweeps: normals, curvature, force.

use super::inner_forces::accelerate_freely;
use super::stage::{Around, Stage, sweep, sweep_pairs};
use super::{Declaration, Quantity};
use crate::kernel::KernelName;
use crate::particles::{Column, Fluid, Shared, for_each_range};
use crate::simd::{Lanes, Real, dot};
use crate::step::Limit;
use crate::sweep::{
    Other, Output, Own, Pair, PairPass, Pass, Source, Splat, SumColumns, Sums, Tally, Uses, slot,
};
use std::f64::consts::PI;

/// Share of the offset at a plane surface from which a particle has a normal, and from which it counts wholly.
const NEAR: f64 = 0.2;
const AT: f64 = 0.4;
/// Share from which the force acts, and from which it acts wholly: at once beyond what disorder inside makes, for the
/// force balances the pressure of the liquid, particle by particle.
const OUTSIDE: [f64; 2] = [0.01, 0.03];
/// Points of the integrals over a kernel.
const POINTS: usize = 400;
/// Intervals of the table of depths.
const TABLE: usize = 64;

/// The acceleration `2 σ κ Σ V_j ∇W_ij / ρ_i`: a liquid of even pressure `σ κ` is at rest, whatever the order of its particles, for the
/// sweep of forces has `-2 p Σ V_j ∇W_ij` there.
///
/// Normals point along the offset `m_i = Σ V_j W_ij r_ij` of a particle from what is around it. Its length, which at a plane
/// surface is a function of the depth, gives the depth `s`; the curvature `∇·n` of the normals (Morris 2000; renormalised,
/// of particles near the surface) belongs to a surface parallel to the true one, and is taken to it, `1/κ = 1/∇·n + s`.
/// It is averaged over the particles around, with the square of the kernel. What the forces would add to momentum and angular
/// momentum is taken from them ([`accelerate_freely`]): they are the liquid's on itself. It does not wet walls, which take no part.
pub struct SurfaceTension<R, const D: usize> {
    normal: [Column<R>; D],
    /// Length of the offset over that at a plane surface.
    nearness: Column<R>,
    depth: Column<R>,
    curvature: Column<R>,
    outwards: Outwards,
    bend: Bend,
    pull: Pull,
    longest_step: f64,
}

impl<R: Real, const D: usize> SurfaceTension<R, D> {
    /// For `n` particles and a `tension` in N/m.
    pub fn new(
        tension: f64,
        n: usize,
        (kernel, h): (KernelName, f64),
        spacing: f64,
        reference_density: f64,
    ) -> Self {
        let (largest, depths) = depths::<D>(kernel, h);
        SurfaceTension {
            normal: std::array::from_fn(|_| Column::new(n)),
            nearness: Column::new(n),
            depth: Column::new(n),
            curvature: Column::new(n),
            outwards: Outwards { largest, depths },
            bend: Bend { sharpest: 1.0 / h },
            pull: Pull {
                twice_tension: 2.0 * tension / reference_density,
                inverse_weight: 1.0 / kernel.value(D, 0.0, h),
            },
            longest_step: longest_step(tension, reference_density, spacing),
        }
    }
}

/// The step in s that resolves the shortest capillary wave: `√(ρ Δp³ / (2π σ))` (Brackbill, Kothe & Zemach 1992).
fn longest_step(tension: f64, density: f64, spacing: f64) -> f64 {
    (density * spacing.powi(3) / (2.0 * PI * tension)).sqrt()
}

/// The offset at a plane surface in m, and the depths in m where it is `1 - (k/TABLE)²` of that: the offset at a depth
/// `z` is `∫_z s w(s) ds` with the kernel's integral `w(s)` over the plane at a distance `s`.
fn depths<const D: usize>(kernel: KernelName, h: f64) -> (f64, [f64; TABLE + 1]) {
    let reach = h * kernel.support();
    let step = reach / POINTS as f64;
    let at = |k: usize| (k as f64 + 0.5) * step;
    let over_plane = |s: f64| -> f64 {
        let ring = |y: f64| {
            let measure = if D == 2 { 2.0 } else { 2.0 * PI * y };
            measure * kernel.value(D, s.hypot(y), h) * step
        };
        (0..POINTS).map(|k| ring(at(k))).sum()
    };
    let mut offset = vec![0.0; POINTS + 1];
    for k in (0..POINTS).rev() {
        offset[k] = offset[k + 1] + at(k) * over_plane(at(k)) * step;
    }
    let largest = offset[0];
    let depth = |share: f64| {
        let wanted = share * largest;
        let k = offset.partition_point(|&o| o > wanted).clamp(1, POINTS);
        let slope = offset[k - 1] - offset[k];
        let part = if slope > 0.0 {
            (offset[k - 1] - wanted) / slope
        } else {
            0.0
        };
        ((k - 1) as f64 + part) * step
    };
    let table = std::array::from_fn(|k| depth(1.0 - (k as f64 / TABLE as f64).powi(2)));
    (largest, table)
}

impl<R: Real, const D: usize> Stage<R, D> for SurfaceTension<R, D> {
    fn declaration(&self) -> Declaration {
        SURFACE_TENSION
    }

    fn run(&mut self, around: Around<R, D>) {
        let with = (around.grid, around.sweeper, around.kernel);
        let Fluid {
            position,
            cells,
            volume,
            mass,
            condensation,
            acceleration,
            ..
        } = around.fluid;
        let liquid = Source::new(position, cells).with(slot::VOLUME, volume);
        let columns = SumColumns::default()
            .scalar(&mut self.nearness)
            .vector(self.normal.iter_mut().map(|c| &mut c[..]));
        sweep_pairs(with, &liquid, None, &self.outwards, &columns);
        self.outwards.measure(&self.nearness, &mut self.depth);
        let surface = liquid
            .with(slot::NEARNESS, &self.nearness)
            .with(slot::RATE, &self.depth)
            .with_vector(slot::GRADIENT, &self.normal);
        sweep(with, &surface, &surface, &self.bend, [&mut self.curvature]);
        let curved = liquid
            .with(slot::NEARNESS, &self.nearness)
            .with(slot::CONDENSATION, condensation)
            .with(slot::RATE, &self.curvature);
        // The normals have done their part: the accelerations stand in their place.
        sweep(with, &curved, &curved, &self.pull, self.normal.iter_mut());
        let turns = !around.grid.is_periodic();
        accelerate_freely(position, mass, &self.normal, turns, acceleration);
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn bytes(&self) -> usize {
        let vector: usize = self.normal.iter().map(Column::bytes).sum();
        vector + self.nearness.bytes() + self.depth.bytes() + self.curvature.bytes()
    }
}

/// How much a particle of some nearness counts for the curvature.
#[inline(always)]
fn share<L: Lanes>(nearness: L, [from, to]: [f64; 2]) -> L {
    let rise = (nearness - L::constant(from)) * L::constant(1.0 / (to - from));
    rise.max(L::zero()).min(L::constant(1.0))
}

/// Normals and nearness.
#[derive(Clone, Copy, Debug)]
struct Outwards {
    /// Offset at a plane surface in m.
    largest: f64,
    depths: [f64; TABLE + 1],
}

impl Outwards {
    /// Depths in m.
    fn measure<R: Real>(&self, nearness: &Column<R>, depth: &mut Column<R>) {
        let n = nearness.len();
        let to = Shared::new(depth);
        for_each_range(n, |range| {
            // SAFETY: the ranges of a pass are disjoint.
            let to = unsafe { to.range(&range) };
            for (s, q) in to.iter_mut().zip(&nearness[range]) {
                let place = (1.0 - q.to_f64()).clamp(0.0, 1.0).sqrt() * TABLE as f64;
                let k = (place as usize).min(TABLE - 1);
                let [near, far] = [self.depths[k], self.depths[k + 1]];
                *s = R::from_f64(near + (far - near) * (place - k as f64));
            }
        });
    }
}

impl<R: Real, const D: usize> PairPass<R, D> for Outwards {
    #[inline(always)]
    fn uses(&self) -> Uses {
        Uses {
            scalar: true,
            vector: true,
            ..Uses::NONE
        }
    }

    #[inline(always)]
    fn fluid<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        _: &Splat<L, D>,
        _: &Other<L, D>,
        tally: &mut Tally<L, D>,
    ) {
        tally.push(pair.weight());
    }

    #[inline(always)]
    fn wall<L: Lanes<Real = R>>(
        &self,
        _: &Pair<L, D>,
        _: &Splat<L, D>,
        _: &Other<L, D>,
        _: &mut Tally<L, D>,
    ) {
    }

    #[inline(always)]
    fn finish(&self, _: &Own<R, D>, sums: &mut Sums<R, D>) {
        let scale = R::from_f64(1.0 / self.largest);
        let offset = sums.vector.map(|v| v * scale);
        let length = dot(&offset, &offset).sqrt();
        sums.scalar = length;
        let small = R::from_f64(1e-12);
        sums.vector = offset.map(|m| m / Lanes::max(length, small));
    }
}

/// The curvature.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// Most that particles resolve, in 1/m.
    sharpest: f64,
}

impl<R: Real, const D: usize> Pass<R, D> for Bend {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        own: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let r = &pair.separation;
        let counts = share(other.nearness(), [NEAR, AT]);
        let weight = -(other.volume() * pair.slope) * counts;
        let (n, m) = (own.gradient(), other.gradient());
        for a in 0..D {
            let turn = weight * (n[a] - m[a]);
            for b in 0..D {
                sums.matrix[a][b] = turn.mul_add(r[b], sums.matrix[a][b]);
            }
        }
        sums.add_moment(weight, r);
        let middle = L::constant(0.5) * (own.rate() + other.rate());
        sums.scalar = (weight * pair.squared).mul_add(middle, sums.scalar);
    }

    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(
        &self,
        own: &Own<R, D>,
        sums: &Sums<L, D>,
        i: usize,
        out: &mut Output<R>,
    ) {
        let trace = sums.trace();
        if own.values().nearness() < R::from_f64(NEAR) || trace < R::from_f64(NEAR) {
            out[0][i] = R::default();
            return;
        }
        let mut divergence = R::default();
        for a in 0..D {
            let mut row = [R::default(); D];
            for b in 0..D {
                row[b] = sums.matrix[a][b].sum();
            }
            divergence += sums.renormalise(row)[a];
        }
        let depth = sums.scalar.sum() / trace;
        // Of each of the principal curvatures, taken to be alike.
        let one = divergence * R::from_f64(1.0 / (D as f64 - 1.0));
        let outer = Lanes::max(R::from_f64(1.0) + one * depth, R::from_f64(0.3));
        let sharpest = R::from_f64(self.sharpest);
        out[0][i] = Lanes::min(Lanes::max(divergence / outer, -sharpest), sharpest);
    }
}

/// The force.
#[derive(Clone, Copy, Debug)]
struct Pull {
    /// `2 σ/ρ0`.
    twice_tension: f64,
    /// `1/W(0)`.
    inverse_weight: f64,
}

impl<R: Real, const D: usize> Pass<R, D> for Pull {
    #[inline(always)]
    fn add<L: Lanes<Real = R>>(
        &self,
        pair: &Pair<L, D>,
        _: &Splat<L, D>,
        other: &Other<L, D>,
        sums: &mut Sums<L, D>,
    ) {
        let inwards = other.volume() * pair.slope;
        // Of itself, too: a sweep shows a particle to itself.
        let kernel = pair.weight();
        let near = kernel * (kernel * L::constant(self.inverse_weight));
        let weight = other.volume() * near * share(other.nearness(), [NEAR, AT]);
        for a in 0..D {
            sums.vector[a] = inwards.mul_add(pair.separation[a], sums.vector[a]);
        }
        sums.scalar = weight.mul_add(other.rate(), sums.scalar);
        sums.gradient[0] += weight;
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
        let (mut scale, acts) = (R::default(), share(own.nearness(), OUTSIDE));
        let weight = sums.gradient[0].sum();
        if acts > R::default() && weight > R::from_f64(1e-6) {
            let curvature = sums.scalar.sum() / weight;
            let density = R::from_f64(1.0) + own.condensation();
            scale = R::from_f64(self.twice_tension) * acts * curvature / density;
        }
        for a in 0..D {
            out[a][i] = sums.vector[a].sum() * scale;
        }
    }
}

/// What the effect is.
pub const SURFACE_TENSION: Declaration = Declaration {
    name: "surface tension",
    columns: &[
        Quantity::Vector("normal"),
        Quantity::Scalar("nearness"),
        Quantity::Scalar("depth"),
        Quantity::Scalar("curvature"),
    ],
    sweeps: 3,
    limit: Some(Limit::Capillary),
    dissipates: "",
    source: "Brackbill, Kothe & Zemach 1992; Morris 2000",
};
