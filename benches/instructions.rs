//! Instructions per particle and step, counted by callgrind on one thread with AVX2: figures that repeat to four digits
//! on any machine, where times do not.
//!
//! `cargo bench --bench instructions` takes about two minutes. It runs itself under valgrind, for two numbers of steps:
//! the difference holds no set-up.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Scene, advance, tank_of};
use kolk::simulation::Precision;
use serde_json::json;
use std::process::{Command, ExitCode};

const FEW: u64 = 4;
const MANY: u64 = 12;
const RUN: &str = "--run-kolk-steps";

/// A fluid in a tank, out of order.
fn scene(dimension: &str, form: &str) -> Scene {
    let scene = match dimension {
        "2d" => tank_of::<2>(50, 40, 0.01, 0.3),
        _ => tank_of::<3>(14, 12, 0.01, 0.3),
    };
    scene.with(json!({"density_diffusion": {"form": form, "delta": 0.1}}))
}

/// What runs under valgrind.
fn run(arguments: &[String]) {
    let precision = if arguments[1] == "f64" {
        Precision::F64
    } else {
        Precision::Mixed
    };
    let mut simulation = scene(&arguments[0], &arguments[2]).start(precision, 1);
    advance(
        &mut simulation,
        arguments[3].parse().expect("a number of steps"),
    );
}

/// Instructions of a whole process that takes `steps` steps.
fn instructions(case: [&str; 3], steps: u64) -> Result<u64, String> {
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
    let count = collected.and_then(|text| text.trim().parse().ok());
    count.ok_or_else(|| format!("valgrind failed ({}):\n{messages}", output.status))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.first().is_some_and(|a| a == RUN) {
        run(&arguments[1..]);
        return ExitCode::SUCCESS;
    }
    println!("instructions per particle and step (callgrind, avx2, one thread)");
    for dimension in ["2d", "3d"] {
        let particles = scene(dimension, "molteni").fluid().mass.len();
        for precision in ["mixed", "f64"] {
            for form in ["fourtakas", "antuono"] {
                let case = [dimension, precision, form];
                let counted =
                    instructions(case, FEW).and_then(|few| Ok((few, instructions(case, MANY)?)));
                match counted {
                    Ok((few, many)) => {
                        let each = (many - few) as f64 / ((MANY - FEW) as usize * particles) as f64;
                        println!("{dimension} {precision:5} {form:9} {each:9.1}");
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
