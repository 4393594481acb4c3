//! The integrators by themselves, on ordinary equations: order, and what theory says of an oscillation.

use kolk::step::{Integrator, System, predictor_corrector, runge_kutta_2, runge_kutta_4};
use std::convert::Infallible;

/// A small system of equations `dy/dt = f(y, t)` by itself.
struct Equations<F> {
    f: F,
    y: [f64; 2],
    start: [f64; 2],
    rate: [f64; 2],
    sum: [f64; 2],
    time: f64,
}

impl<F: Fn([f64; 2], f64) -> [f64; 2]> Equations<F> {
    fn new(f: F, y: [f64; 2]) -> Self {
        let rate = f(y, 0.0);
        Equations {
            f,
            y,
            start: y,
            rate,
            sum: [0.0; 2],
            time: 0.0,
        }
    }

    fn step(&mut self, integrator: Integrator, dt: f64) {
        let Ok(()) = match integrator {
            Integrator::PredictorCorrector => predictor_corrector(self, dt),
            Integrator::RungeKutta2 => runge_kutta_2(self, dt),
            Integrator::RungeKutta4 => runge_kutta_4(self, dt),
            Integrator::Symplectic => unreachable!("not one of several stages"),
        };
        self.time += dt;
    }
}

impl<F: Fn([f64; 2], f64) -> [f64; 2]> System for Equations<F> {
    type Trouble = Infallible;
    fn begin(&mut self) -> Result<(), Infallible> {
        (self.start, self.sum) = (self.y, [0.0; 2]);
        Ok(())
    }
    fn stage(&mut self, ahead: f64, weight: f64) -> Result<(), Infallible> {
        for k in 0..2 {
            self.sum[k] += weight * self.rate[k];
            self.y[k] = self.start[k] + ahead * self.rate[k];
        }
        Ok(())
    }
    fn rates(&mut self, since: f64, _dt: f64) {
        self.rate = (self.f)(self.y, self.time + since);
    }
    fn middle(&mut self, dt: f64) {
        self.rates(0.5 * dt, dt);
    }
    fn arrive(&mut self, weight: f64, _dt: f64) {
        for k in 0..2 {
            self.y[k] = self.start[k] + self.sum[k] + weight * self.rate[k];
        }
    }
}

#[test]
fn of_an_equation_with_time_in_it_each_has_its_order() {
    // y' = -2 t y², y = 1 / (1 + t²).
    for (integrator, order) in [
        (Integrator::PredictorCorrector, 2.0),
        (Integrator::RungeKutta2, 2.0),
        (Integrator::RungeKutta4, 4.0),
    ] {
        let error = |steps: u32| {
            let mut equations = Equations::new(|y, t| [-2.0 * t * y[0] * y[0], 0.0], [1.0, 0.0]);
            for _ in 0..steps {
                equations.step(integrator, 2.0 / f64::from(steps));
            }
            (equations.y[0] - 0.2).abs()
        };
        let observed = (error(64) / error(128)).log2();
        assert!(
            (observed - order).abs() < 0.15,
            "{integrator:?}: {observed}"
        );
    }
}

/// Growth of an oscillation's amplitude per step of `angle = ω Δt`, over many steps.
fn growth(integrator: Integrator, angle: f64) -> f64 {
    const STEPS: i32 = 400;
    let mut oscillator = Equations::new(|y, _| [y[1], -y[0]], [1.0, 0.0]);
    let amplitude = |y: [f64; 2]| y[0].hypot(y[1]);
    for _ in 0..STEPS {
        oscillator.step(integrator, angle);
    }
    let before = amplitude(oscillator.y);
    for _ in 0..STEPS {
        oscillator.step(integrator, angle);
    }
    (amplitude(oscillator.y) / before).powf(1.0 / f64::from(STEPS))
}

#[test]
fn an_oscillation_grows_and_decays_as_theory_says() {
    // Runge-Kutta of order 2: 1 + θ⁴/8; of order 4: 1 - θ⁶/144, stable up to 2 √2.
    let angle = 0.3f64;
    let second = growth(Integrator::RungeKutta2, angle) - 1.0;
    assert!(
        (second / (angle.powi(4) / 8.0) - 1.0).abs() < 0.01,
        "{second:e}"
    );
    let fourth = growth(Integrator::RungeKutta4, angle) - 1.0;
    assert!(
        (fourth / (-angle.powi(6) / 144.0) - 1.0).abs() < 0.05,
        "{fourth:e}"
    );
    assert!(growth(Integrator::RungeKutta4, 2.82) < 1.0);
    assert!(growth(Integrator::RungeKutta4, 2.84) > 1.0);
    // The roots of μ² - (1 + z + ¾ z²) μ + ¼ z² leave the unit circle at z = 1.287 i.
    assert!(growth(Integrator::PredictorCorrector, 0.3) < 1.0);
    assert!(growth(Integrator::PredictorCorrector, 1.28) < 1.0);
    assert!(growth(Integrator::PredictorCorrector, 1.30) > 1.0);
}
