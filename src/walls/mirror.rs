//! Mirrored particles at plane walls (Libersky et al. 1993; Morris, Fox & Zhu 1997; Colagrossi & Landrini 2003): behind a
//! plane the fluid goes on as its own image, whose pressure is carried across along gravity.
//!
//! No image is stored: what one does to a particle follows from the particle of which it is the image, and the pairs that
//! meet one are few. Images are hence in nobody's order, and cost scenes without them nothing.

use super::facet::{Facet, minus, plus};
use super::head;
use super::planes::Plane;
use super::surface::Surface;
use crate::effects::{PairTerm, Pressure};
use crate::kernel::KernelName;
use crate::neighbours::Grid;
use crate::particles::{Fluid, Shared};
use crate::simd::{Real, dot};
use crate::sweep::{SLOTS, Single, slot};
use rayon::prelude::*;

/// Most planes that a particle can be near: more would be features smaller than the support, which are refused.
const MOST: usize = 16;
/// How far behind a plane, in spacings, a particle still has an image: deeper ones are brought back.
const BEHIND: f64 = 0.2;
/// Cells per task.
const CELLS: usize = 4;

/// Planes, and how far their images reach.
pub struct Mirror<const D: usize> {
    /// Facets, found within the support.
    pub surface: Surface<D>,
    /// Velocity of each wall in its own plane in m/s, for friction.
    pub velocity: Vec<[f64; D]>,
    planes: Vec<Plane<D>>,
    /// Planes near each of the cells of the surface.
    near: Vec<u32>,
    offsets: Vec<u32>,
    support: f64,
    behind: f64,
}

/// What the images do to the motion of the fluid.
pub struct MirroredForces<'a, const D: usize, F> {
    /// Pairs of a particle and an image.
    pub single: &'a Single<D>,
    /// In kg/m³.
    pub reference_density: f64,
    /// In m/s².
    pub gravity: [f64; D],
    /// Whether a wall may pull.
    pub suction: bool,
    /// Friction where the fluid sticks, else `()`.
    pub friction: F,
}

impl<'a, const D: usize> MirroredForces<'a, D, ()> {
    /// The same with friction.
    pub fn with<F>(self, friction: F) -> MirroredForces<'a, D, F> {
        MirroredForces {
            single: self.single,
            reference_density: self.reference_density,
            gravity: self.gravity,
            suction: self.suction,
            friction,
        }
    }
}

/// A plane near a particle.
#[derive(Clone, Copy, Default)]
struct Near {
    plane: u32,
    /// Of the particle, in m.
    height: f64,
    /// Whether its foot is on the wall.
    covered: bool,
    /// Whether those of all its neighbours are, too.
    deep: bool,
}

/// An image of a neighbour.
struct Image<const D: usize> {
    /// From the image to the particle, in m.
    separation: [f64; D],
    /// The planes of its reflections, and the height of the neighbour above each, in m.
    planes: [(u32, f64); D],
    /// How many of them there are.
    count: usize,
}

impl<const D: usize> Mirror<D> {
    /// For the `facets` of walls, which [`super::check_planes`] has passed, a support radius and a spacing in m.
    pub fn new(
        facets: Vec<Facet<D>>,
        velocity: Vec<[f64; D]>,
        grid: &Grid<D>,
        support: f64,
        spacing: f64,
    ) -> Self {
        let mut planes = Plane::of(&facets, spacing, usize::MAX).unwrap_or_default();
        Plane::find_rims(&mut planes, &facets, spacing, support);
        let mut plane_of = vec![0; facets.len()];
        for (p, plane) in planes.iter().enumerate() {
            for &f in &plane.facets {
                plane_of[f as usize] = p as u32;
            }
        }
        // Particles leave their cells by the grid's skin before they are sorted again.
        let surface = Surface::new(facets, grid, 1.05 * support);
        let (mut near, mut offsets) = (Vec::new(), vec![0]);
        for k in 0..surface.cells().len() {
            let first = near.len();
            near.extend(surface.near(k).iter().map(|&f| plane_of[f as usize]));
            near[first..].sort_unstable();
            let mut end = first;
            for at in first..near.len() {
                if end == first || near[end - 1] != near[at] {
                    near[end] = near[at];
                    end += 1;
                }
            }
            near.truncate(end);
            offsets.push(end as u32);
        }
        Mirror {
            surface,
            velocity,
            planes,
            near,
            offsets,
            support,
            behind: BEHIND * spacing,
        }
    }

    /// Adds the images' part to the accelerations: `-Σ V_j (p_i + p_j') ∇W_ij'/ρ_i` with `p_j' = p_j + ρ_j g·(r_j' - r_j)`, and
    /// friction with the velocity `2 u_wall - u_j` of an image by one plane.
    pub fn add_forces<R: Real, F: PairTerm<f64, D>>(
        &self,
        fluid: &mut Fluid<R, D>,
        grid: &Grid<D>,
        by: &MirroredForces<D, F>,
    ) {
        let acceleration =
            std::array::from_fn::<_, D, _>(|a| Shared::new(&mut fluid.acceleration[a]));
        let fluid = &*fluid;
        let rho = by.reference_density;
        let terms = (Pressure, by.friction);
        self.for_each(fluid, grid, |i, images| {
            let own = fields(fluid, i);
            let mut force = [0.0; D];
            images(&mut |j, image| {
                let mut other = fields(fluid, j);
                let density = rho * (1.0 + other[slot::CONDENSATION]);
                let mut pressure = other[slot::PRESSURE];
                for &(p, height) in &image.planes[..image.count] {
                    let down = plus(&[0.0; D], -2.0 * height, &self.planes[p as usize].normal);
                    pressure += head(density, &by.gravity, &down);
                }
                other[slot::PRESSURE] = if by.suction {
                    pressure
                } else {
                    pressure.max(0.0)
                };
                if image.count % 2 == 1 {
                    let wall = self.planes[image.planes[0].0 as usize].body as usize;
                    for a in 0..D {
                        let u = &mut other[slot::VELOCITY + a];
                        *u = 2.0 * self.velocity[wall][a] - *u;
                    }
                }
                let push = by.single.vector(&terms, &image.separation, &own, &other);
                force = plus(&force, 1.0, &push);
            });
            let density = rho * (1.0 + own[slot::CONDENSATION]);
            for a in 0..D {
                // SAFETY: every particle is visited once.
                unsafe {
                    let own = acceleration[a].range(&(i..i + 1));
                    own[0] = R::from_f64(own[0].to_f64() + force[a] / density);
                }
            }
        });
    }

    /// Adds the images' part to the rates of density: `ρ_i Σ V_j (u_i - u_j')·∇W_ij'` with the mirrored velocity, and what density
    /// follows of their concentration at `crowding` (1/s), 0 for none.
    pub fn add_rates<R: Real>(
        &self,
        fluid: &mut Fluid<R, D>,
        grid: &Grid<D>,
        (kernel, h): (KernelName, f64),
        reference_density: f64,
        crowding: f64,
    ) {
        let rate = Shared::new(&mut fluid.density_rate);
        let fluid = &*fluid;
        self.for_each(fluid, grid, |i, images| {
            let u: [f64; D] = std::array::from_fn(|a| fluid.pair_velocity[a][i].to_f64());
            let (mut inflow, mut crowd) = (0.0, 0.0);
            images(&mut |j, image| {
                let mut v: [f64; D] = std::array::from_fn(|a| fluid.pair_velocity[a][j].to_f64());
                for &(p, _) in &image.planes[..image.count] {
                    let n = &self.planes[p as usize].normal;
                    v = plus(&v, -2.0 * dot(&v, n), n);
                }
                let squared = dot(&image.separation, &image.separation);
                let r = squared.sqrt().max(1e-9 * h);
                let weight = fluid.volume[j].to_f64() * kernel.gradient(D, r, h) / r;
                inflow += weight * dot(&minus(&u, &v), &image.separation);
                crowd -= weight * squared / D as f64;
            });
            let density = 1.0 + fluid.condensation[i].to_f64();
            let change = reference_density * (density * inflow + crowding * crowd);
            // SAFETY: every particle is visited once.
            unsafe {
                let own = rate.range(&(i..i + 1));
                own[0] = R::from_f64(own[0].to_f64() + change);
            }
        });
    }

    /// Visits every particle near a plane with the images in its reach.
    fn for_each<R: Real>(
        &self,
        fluid: &Fluid<R, D>,
        grid: &Grid<D>,
        work: impl Fn(usize, &dyn Fn(&mut dyn FnMut(usize, &Image<D>))) + Sync,
    ) {
        let surface = &self.surface;
        (0..surface.cells().len())
            .into_par_iter()
            .with_min_len(CELLS)
            .for_each(|k| {
                let cell = surface.cells()[k] as usize;
                let runs = grid.around(cell);
                let listed = &self.near[self.offsets[k] as usize..self.offsets[k + 1] as usize];
                for i in fluid.cells.particles(cell, cell + 1) {
                    let x = fluid.at(i);
                    let (mut near, mut count) = ([Near::default(); MOST], 0);
                    for &p in listed {
                        let height = self.planes[p as usize].height(&x);
                        if (-self.behind..self.support).contains(&height) && count < MOST {
                            let covered = self.covers(p, &x, grid);
                            let deep = covered && self.goes_on(p, &x, grid);
                            near[count] = Near {
                                plane: p,
                                height,
                                covered,
                                deep,
                            };
                            count += 1;
                        }
                    }
                    if count == 0 {
                        continue;
                    }
                    work(i, &|visit| {
                        for run in runs.iter() {
                            for j in fluid.cells.particles(run.first, run.end) {
                                let y = plus(&fluid.at(j), 1.0, &run.shift);
                                self.images(&x, &y, &near[..count], grid, &mut |image| {
                                    visit(j, image);
                                });
                            }
                        }
                    });
                }
            });
    }

    /// Visits the images of a neighbour at `y` within reach of a particle at `x`: by each plane through which it is seen, and
    /// where planes meet at an inner edge or corner by several.
    fn images(
        &self,
        x: &[f64; D],
        y: &[f64; D],
        near: &[Near],
        grid: &Grid<D>,
        visit: &mut dyn FnMut(&Image<D>),
    ) {
        let square = self.support * self.support;
        let image = Image {
            separation: minus(x, y),
            planes: [(0, 0.0); D],
            count: 0,
        };
        // Behind a plane the image is further than the neighbour itself.
        if dot(&image.separation, &image.separation) >= square {
            return;
        }
        for (k, a) in near.iter().enumerate() {
            let Some(one) = self.reflected(&image, a, y, square) else {
                continue;
            };
            let (height, sum) = (a.height, a.height + one.planes[0].1);
            let through = plus(x, -(height / sum).clamp(0.0, 1.0), &one.separation);
            if a.deep || self.covers(a.plane, &through, grid) {
                visit(&one);
            }
            if !a.covered {
                continue;
            }
            for (l, b) in near.iter().enumerate().skip(k + 1) {
                if !self.meets(a, b) || !b.covered {
                    continue;
                }
                let Some(two) = self.reflected(&one, b, y, square) else {
                    continue;
                };
                if !self.holds(a, y, grid) || !self.holds(b, y, grid) {
                    continue;
                }
                visit(&two);
                for c in near.iter().skip(l + 1) {
                    if D < 3 || !self.meets(a, c) || !self.meets(b, c) || !c.covered {
                        continue;
                    }
                    if let Some(three) = self.reflected(&two, c, y, square)
                        && self.holds(c, y, grid)
                    {
                        visit(&three);
                    }
                }
            }
        }
    }

    /// An image reflected once more, if it is within reach.
    fn reflected(
        &self,
        image: &Image<D>,
        by: &Near,
        y: &[f64; D],
        square: f64,
    ) -> Option<Image<D>> {
        let plane = &self.planes[by.plane as usize];
        let height = plane.height(y);
        if height < -self.behind || height + by.height <= 0.0 {
            return None;
        }
        let separation = plus(&image.separation, 2.0 * height, &plane.normal);
        if dot(&separation, &separation) >= square {
            return None;
        }
        let mut planes = image.planes;
        planes[image.count] = (by.plane, height);
        Some(Image {
            separation,
            planes,
            count: image.count + 1,
        })
    }

    /// Whether two planes are at right angles.
    fn meets(&self, a: &Near, b: &Near) -> bool {
        let normals = [a, b].map(|n| &self.planes[n.plane as usize].normal);
        dot(normals[0], normals[1]).abs() < 0.5
    }

    /// Whether the foot of a neighbour at `y` is on the wall.
    fn holds(&self, near: &Near, y: &[f64; D], grid: &Grid<D>) -> bool {
        near.deep || self.covers(near.plane, y, grid)
    }

    /// Whether the wall goes on around the foot of `x` for the support.
    fn goes_on(&self, plane: u32, x: &[f64; D], grid: &Grid<D>) -> bool {
        let mut at = *x;
        if grid.is_periodic() {
            grid.wrap(&mut at);
        }
        self.planes[plane as usize].goes_on(&at, self.support)
    }

    /// Whether the foot of `x` on a plane is on the wall.
    fn covers(&self, plane: u32, x: &[f64; D], grid: &Grid<D>) -> bool {
        let mut at = *x;
        if grid.is_periodic() {
            grid.wrap(&mut at);
        }
        self.planes[plane as usize].covers(&at, self.surface.facets())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let planes: usize = self.planes.iter().map(Plane::bytes).sum();
        self.surface.bytes() + planes + 4 * (self.near.capacity() + self.offsets.capacity())
    }
}

/// What pairs read of a fluid particle.
fn fields<R: Real, const D: usize>(fluid: &Fluid<R, D>, i: usize) -> [f64; SLOTS] {
    let mut fields = [0.0; SLOTS];
    fields[slot::VOLUME] = fluid.volume[i].to_f64();
    fields[slot::PRESSURE] = fluid.pressure[i].to_f64();
    fields[slot::CONDENSATION] = fluid.condensation[i].to_f64();
    for a in 0..D {
        fields[slot::VELOCITY + a] = fluid.pair_velocity[a][i].to_f64();
    }
    fields
}
