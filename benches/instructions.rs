//! Instructions per particle and step, counted by callgrind on one thread with AVX2, and bytes that a simulation
//! allocates: figures that repeat to four digits on any machine, where times do not.
//!
//! `cargo bench --bench instructions` takes about two minutes. It runs itself under valgrind, for two numbers of steps:
//! the difference holds no set-up.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Scene, advance, tank_of};
use kolk::simulation::Precision;
use serde_json::json;
use std::alloc::{GlobalAlloc, Layout, System};
use std::process::{Command, ExitCode};
use std::sync::atomic::{AtomicUsize, Ordering};

const FEW: u64 = 4;
const MANY: u64 = 12;
const RUN: &str = "--run-kolk-steps";

/// Bytes asked for since the start.
static BYTES: AtomicUsize = AtomicUsize::new(0);

/// The system's allocator, counting.
struct Counting;

// SAFETY: hands everything to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        BYTES.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: promised by the caller.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: promised by the caller.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A fluid in a tank, out of order.
fn scene(dimension: &str, form: &str) -> Scene {
    let scene = match dimension {
        "2d" => tank_of::<2>(50, 40, 0.01, 0.3),
        _ => tank_of::<3>(14, 12, 0.01, 0.3),
    };
    scene.with(json!({"density_diffusion": {"form": form, "delta": 0.1}}))
}

/// What runs under valgrind; prints the bytes that the simulation asked for.
fn run(arguments: &[String]) {
    let precision = if arguments[1] == "f64" {
        Precision::F64
    } else {
        Precision::Mixed
    };
    let scene = scene(&arguments[0], &arguments[2]);
    let before = BYTES.load(Ordering::Relaxed);
    let mut simulation = scene.start(precision, 1);
    advance(
        &mut simulation,
        arguments[3].parse().expect("a number of steps"),
    );
    println!("{}", BYTES.load(Ordering::Relaxed) - before);
}

/// Instructions of a whole process that takes `steps` steps, and bytes that its simulation asks for.
fn count(case: [&str; 3], steps: u64) -> Result<(u64, u64), String> {
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .arg(RUN)
        .args(case)
        .arg(steps.to_string())
        .env("KOLK_SIMD", "avx2")
        .output()
        .map_err(|e| format!("valgrind does not start: {e}"))?;
    let messages = String::from_utf8_lossy(&output.stderr);
    let collected = messages
        .lines()
        .find_map(|line| line.split("Collected :").nth(1));
    let instructions = collected.and_then(|text| text.trim().parse().ok());
    let bytes = String::from_utf8_lossy(&output.stdout).trim().parse().ok();
    instructions
        .zip(bytes)
        .ok_or_else(|| format!("valgrind failed ({}):\n{messages}", output.status))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.first().is_some_and(|a| a == RUN) {
        run(&arguments[1..]);
        return ExitCode::SUCCESS;
    }
    println!("instructions per particle and step (callgrind, avx2, one thread), bytes in all");
    for dimension in ["2d", "3d"] {
        let particles = scene(dimension, "molteni").fluid().mass.len();
        for precision in ["mixed", "f64"] {
            for form in ["fourtakas", "antuono"] {
                let case = [dimension, precision, form];
                let counted = count(case, FEW).and_then(|few| Ok((few, count(case, MANY)?)));
                match counted {
                    Ok(((few, _), (many, bytes))) => {
                        let each = (many - few) as f64 / ((MANY - FEW) as usize * particles) as f64;
                        println!("{dimension} {precision:5} {form:9} {each:9.1} {bytes:9}");
                    }
                    Err(message) => {
                        // Not a failure: the times of the other benches need no valgrind.
                        println!("{message}");
                        return ExitCode::SUCCESS;
                    }
                }
            }
        }
    }
    ExitCode::SUCCESS
}
