//! Time of the sort, of each sweep and of whole steps, in two and three dimensions, double and mixed precision, with a
//! settled, disordered fluid in a tank. At the end a table: nanoseconds per particle and per pair, and the share of
//! each phase.
//!
//! `cargo bench --bench step` takes about three minutes; `cargo bench --bench step -- 3d/mixed` a part of it.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Scene, advance, tank_of};
use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};
use kolk::neighbours::Grid;
use kolk::neighbours::search::PointGrid;
use kolk::particles::{Fluid, Given};
use kolk::simulation::{Entries, Precision, Simulation};
use serde_json::json;
use std::hint::black_box;
use std::time::{Duration, Instant};

const PRECISIONS: [(&str, Precision); 2] = [("mixed", Precision::Mixed), ("f64", Precision::F64)];
const FORMS: [&str; 2] = ["fourtakas", "antuono"];
/// Phases with a sweep, each timed on its own.
const SWEEPS: [&str; 3] = ["walls", "forces", "continuity"];
/// Steps after which the first lattice is forgotten.
const SETTLE: u64 = 150;

/// A fluid in a tank after some steps, to start simulations of any precision and effects from.
struct Settled {
    name: &'static str,
    scene: Scene,
    state: Entries,
    particles: usize,
    /// Neighbours of a particle, on average: fluid and wall.
    neighbours: f64,
    given: Given,
}

impl Settled {
    fn new<const D: usize>(name: &'static str, scene: Scene) -> Self {
        let mut simulation = scene.start(Precision::Mixed, 0);
        advance(&mut simulation, SETTLE);
        let (water, tank) = (
            simulation.body("water").unwrap(),
            simulation.body("tank").unwrap(),
        );
        let config = scene.configuration();
        let reach = config.smoothing_length * config.kernel.support();
        let fluid = water.position.as_chunks::<D>().0;
        let all = [fluid, tank.position.as_chunks::<D>().0].concat();
        let grid = PointGrid::new(&all, reach, &[None; D]);
        let mut pairs = 0usize;
        for x in fluid {
            grid.for_each_near(x, |_, _, _| pairs += 1);
        }
        let particles = water.mass.len();
        Settled {
            name,
            scene,
            state: simulation.save(),
            particles,
            neighbours: pairs as f64 / particles as f64 - 1.0,
            given: Given {
                position: water.position,
                velocity: water.velocity,
                density: water.density,
                mass: water.mass,
            },
        }
    }

    /// A simulation of this fluid with this diffusion of density, on all cores.
    fn start(&self, precision: Precision, form: &str) -> Simulation {
        let diffusion = json!({"density_diffusion": {"form": form, "delta": 0.1}});
        let mut simulation = self.scene.clone().with(diffusion).start(precision, 0);
        simulation
            .restore(&self.state)
            .expect("a state of this scene");
        advance(&mut simulation, 3);
        simulation
    }
}

/// Seconds and calls of a phase so far.
fn spent(simulation: &Simulation, phase: &str) -> (f64, u64) {
    let timings = simulation.timings();
    timings
        .iter()
        .find(|t| t.0 == phase)
        .map_or((0.0, 0), |t| (t.1, t.2))
}

/// Whole steps, and the sweeps among them.
fn steps(c: &mut Criterion, settled: &Settled) {
    let mut group = c.benchmark_group(settled.name);
    group
        .sample_size(10)
        .sampling_mode(SamplingMode::Flat)
        .throughput(Throughput::Elements(settled.particles as u64));
    group
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(3));
    for (name, precision) in PRECISIONS {
        for form in FORMS {
            let mut simulation = settled.start(precision, form);
            group.bench_function(BenchmarkId::new(name, format!("step {form}")), |b| {
                b.iter_custom(|count| {
                    let start = Instant::now();
                    advance(&mut simulation, count);
                    start.elapsed()
                });
            });
        }
        let mut simulation = settled.start(precision, FORMS[0]);
        for phase in SWEEPS {
            group.bench_function(BenchmarkId::new(name, phase), |b| {
                b.iter_custom(|count| {
                    let before = spent(&simulation, phase);
                    advance(&mut simulation, count);
                    let after = spent(&simulation, phase);
                    // A simulation at its start books a phase more often than it steps.
                    let calls = (after.1 - before.1).max(1) as f64;
                    Duration::from_secs_f64((after.0 - before.0) / calls * count as f64)
                });
            });
        }
    }
    group.finish();
}

/// The sort of a fluid that is nearly in order, as it is in a simulation.
fn sort<const D: usize>(c: &mut Criterion, settled: &Settled) {
    let config = settled.scene.configuration();
    let reach = 1.05 * config.smoothing_length * config.kernel.support();
    let extreme = |fold: fn(f64, f64) -> f64| {
        let points = settled.given.position.as_chunks::<D>().0;
        std::array::from_fn(|a| points.iter().map(|x| x[a]).reduce(fold).unwrap())
    };
    let grid = Grid::<D>::new(
        extreme(f64::min),
        extreme(f64::max),
        reach,
        [None; D],
        settled.particles,
    );
    let mut group = c.benchmark_group(settled.name);
    group
        .sample_size(10)
        .throughput(Throughput::Elements(settled.particles as u64));
    group
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2));
    let mut double = Fluid::<f64, D>::new(&settled.given, &grid, Default::default());
    group.bench_function(BenchmarkId::new("f64", "sort"), |b| {
        b.iter(|| black_box(&mut double).sort(&grid, false))
    });
    let mut mixed = Fluid::<f32, D>::new(&settled.given, &grid, Default::default());
    group.bench_function(BenchmarkId::new("mixed", "sort"), |b| {
        b.iter(|| black_box(&mut mixed).sort(&grid, false))
    });
    group.finish();
}

/// Prints what a step costs per particle and per pair, and which share each phase has.
fn table(settled: &Settled) {
    for (name, precision) in PRECISIONS {
        for form in FORMS {
            let mut simulation = settled.start(precision, form);
            let before = simulation.timings();
            let (start, mut count) = (Instant::now(), 0);
            while start.elapsed() < Duration::from_secs(2) {
                advance(&mut simulation, 10);
                count += 10;
            }
            let after = simulation.timings();
            let phases: Vec<(&str, f64)> = after
                .iter()
                .map(|&(phase, seconds, _)| {
                    (
                        phase,
                        seconds - before.iter().find(|b| b.0 == phase).map_or(0.0, |b| b.1),
                    )
                })
                .collect();
            let step = phases.iter().map(|p| p.1).sum::<f64>() / f64::from(count);
            let particle = 1e9 * step / settled.particles as f64;
            let bytes: usize = simulation.memory().iter().map(|m| m.1).sum();
            let shares: Vec<String> = phases
                .iter()
                .map(|(phase, seconds)| {
                    format!("{phase} {:.1} %", 100.0 * seconds / f64::from(count) / step)
                })
                .collect();
            println!(
                "{} {name:5} {form:9} {:.2} M particle-steps/s, {particle:.0} ns per particle, {:.2} ns per pair, {:.0} \
                 bytes per particle: {}",
                settled.name,
                1e3 / particle,
                particle / settled.neighbours,
                bytes as f64 / settled.particles as f64,
                shares.join(", "),
            );
        }
    }
}

fn main() {
    let mut c = Criterion::default().configure_from_args();
    let flat = Settled::new::<2>("2d", tank_of::<2>(320, 250, 0.001, 0.3));
    let solid = Settled::new::<3>("3d", tank_of::<3>(64, 48, 0.003, 0.3));
    for settled in [&flat, &solid] {
        steps(&mut c, settled);
    }
    sort::<2>(&mut c, &flat);
    sort::<3>(&mut c, &solid);
    c.final_summary();
    // Not where only one benchmark, or only a trial run, is asked for.
    if std::env::args()
        .skip(1)
        .all(|argument| argument == "--bench")
    {
        println!(
            "\n{} threads, {}",
            rayon::current_num_threads(),
            kolk::simd::level().name()
        );
        for settled in [&flat, &solid] {
            println!(
                "{}: {} fluid particles, {:.1} neighbours",
                settled.name, settled.particles, settled.neighbours
            );
            table(settled);
        }
    }
}
