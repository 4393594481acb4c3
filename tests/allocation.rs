//! The step loop does not allocate.

mod common;

use common::{Scene, advance, free_drop, tank};
use kolk::simulation::Precision;
use serde_json::json;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

static COUNTING: AtomicBool = AtomicBool::new(false);
static CALLS: AtomicU64 = AtomicU64::new(0);
static BYTES: AtomicU64 = AtomicU64::new(0);
/// Stops at the first allocation that counts, for a debugger or a backtrace to show where it comes from.
static TRAP: AtomicBool = AtomicBool::new(false);

/// The system's allocator, counting.
struct Counting;

fn count(bytes: usize) {
    if COUNTING.load(Ordering::Relaxed) {
        CALLS.fetch_add(1, Ordering::Relaxed);
        BYTES.fetch_add(bytes as u64, Ordering::Relaxed);
        if TRAP.swap(false, Ordering::Relaxed) {
            COUNTING.store(false, Ordering::Relaxed);
            eprintln!(
                "{bytes} bytes at\n{}",
                std::backtrace::Backtrace::force_capture()
            );
            COUNTING.store(true, Ordering::Relaxed);
        }
    }
}

// SAFETY: hands everything to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: promised by the caller.
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: promised by the caller.
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        // SAFETY: promised by the caller.
        unsafe { System.realloc(at, layout, size) }
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: promised by the caller.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations, their bytes, and sorts in `steps` steps of one call, after `warm` calls of some steps.
fn allocations(
    scene: &Scene,
    precision: Precision,
    threads: usize,
    warm: u64,
    steps: u64,
) -> (u64, u64, u64) {
    let mut simulation = scene.start(precision, threads);
    // In many calls: a small sweep is one task, run by whichever thread takes the call, and every thread makes its
    // buffers when it first needs them.
    for _ in 0..warm {
        advance(&mut simulation, 3);
    }
    let sorts =
        |timings: Vec<(&str, f64, u64)>| timings.iter().find(|t| t.0 == "sort").map(|t| t.2);
    let before = sorts(simulation.timings()).unwrap_or(0);
    CALLS.store(0, Ordering::Relaxed);
    BYTES.store(0, Ordering::Relaxed);
    TRAP.store(
        std::env::var_os("KOLK_TRAP_ALLOCATION").is_some(),
        Ordering::Relaxed,
    );
    COUNTING.store(true, Ordering::Relaxed);
    let result = simulation.advance(1e9, steps, Duration::MAX);
    COUNTING.store(false, Ordering::Relaxed);
    assert_eq!(result.unwrap().0, steps);
    let sorted = sorts(simulation.timings()).unwrap_or(0) - before;
    (
        CALLS.load(Ordering::Relaxed),
        BYTES.load(Ordering::Relaxed),
        sorted,
    )
}

#[test]
fn steps_do_not_allocate() {
    // One test, for the count is of the whole process. Entering the pool may allocate: once a call, not once a step.
    const PER_CALL: u64 = 2;
    let effects = json!({
        "density_diffusion": {"form": "antuono", "delta": 0.1},
        "shifting": {"form": "sun", "free_surface": true},
    });
    let scenes = [
        ("tank 2D", tank::<2>(40, 30).with(effects.clone())),
        ("tank 3D", tank::<3>(10, 8).with(effects)),
        ("drop 3D", free_drop::<3>(14)),
        (
            "dynamic tank",
            tank::<2>(40, 30).with(json!({"wall": {"method": "dynamic", "slip": "free"}})),
        ),
        (
            "predictor-corrector",
            tank::<2>(40, 30).with(json!({
                "wall": {"method": "dynamic", "slip": "free"}, "integrator": "predictor-corrector",
            })),
        ),
        ("rk4", free_drop::<3>(14).with(json!({"integrator": "rk4"}))),
    ];
    let mut report = Vec::new();
    for (name, scene) in &scenes {
        for precision in [Precision::F64, Precision::Mixed] {
            for threads in [1, 2] {
                let (calls, bytes, sorts) = allocations(scene, precision, threads, 50, 150);
                assert!(sorts > 0, "{name}: no sort among the steps");
                if calls > PER_CALL {
                    report.push(format!("{name}, {precision:?}, {threads} threads: {calls} allocations, {bytes} bytes"));
                }
            }
        }
    }
    assert!(report.is_empty(), "{report:#?}");
}
