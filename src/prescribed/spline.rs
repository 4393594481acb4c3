//! Interpolation of tables.

/// The cubic spline through the points of a table with continuous first and second derivative; at each end the first
/// two pieces are one cubic ("not a knot"; de Boor 1978), so that a table of a cubic is met exactly. With three points
/// a parabola, with two a straight line.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    time: Vec<f64>,
    value: Vec<f64>,
    /// Second derivatives at the points.
    curvature: Vec<f64>,
}

impl Spline {
    /// Through `value` at ascending `time`; at least two points of each.
    pub fn new(time: Vec<f64>, value: Vec<f64>) -> Self {
        let curvature = curvatures(&time, &value);
        Spline {
            time,
            value,
            curvature,
        }
    }

    /// Straight lines from point to point.
    pub fn straight(time: Vec<f64>, value: Vec<f64>) -> Self {
        let curvature = vec![0.0; time.len()];
        Spline {
            time,
            value,
            curvature,
        }
    }

    /// Value, first and second derivative at `t`; beyond the ends the value there, at rest.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let last = self.time.len() - 1;
        if t < self.time[0] {
            return [self.value[0], 0.0, 0.0];
        }
        if t > self.time[last] {
            return [self.value[last], 0.0, 0.0];
        }
        let k = self.time.partition_point(|&x| x <= t).clamp(1, last) - 1;
        let step = self.time[k + 1] - self.time[k];
        let (a, b) = ((self.time[k + 1] - t) / step, (t - self.time[k]) / step);
        let (m, n) = (self.curvature[k], self.curvature[k + 1]);
        let (y, z) = (self.value[k], self.value[k + 1]);
        let square = step * step / 6.0;
        [
            a * y + b * z + ((a * a * a - a) * m + (b * b * b - b) * n) * square,
            (z - y) / step + ((1.0 - 3.0 * a * a) * m + (3.0 * b * b - 1.0) * n) * (square / step),
            a * m + b * n,
        ]
    }
}

/// Second derivatives of the spline at its points.
fn curvatures(time: &[f64], value: &[f64]) -> Vec<f64> {
    let n = time.len();
    let h: Vec<f64> = time.windows(2).map(|t| t[1] - t[0]).collect();
    let slope: Vec<f64> = (0..n - 1)
        .map(|k| (value[k + 1] - value[k]) / h[k])
        .collect();
    if n == 2 {
        return vec![0.0; 2];
    }
    if n == 3 {
        return vec![2.0 * (slope[1] - slope[0]) / (h[0] + h[1]); 3];
    }
    // The equations of the inner points; the ends' curvatures, which continue those inside, are put in.
    let inner = n - 2;
    let (mut lower, mut middle, mut upper, mut right) = (
        vec![0.0; inner],
        vec![0.0; inner],
        vec![0.0; inner],
        vec![0.0; inner],
    );
    for k in 0..inner {
        lower[k] = h[k];
        middle[k] = 2.0 * (h[k] + h[k + 1]);
        upper[k] = h[k + 1];
        right[k] = 6.0 * (slope[k + 1] - slope[k]);
    }
    let first = h[0] / h[1];
    middle[0] += h[0] * (1.0 + first);
    upper[0] -= h[0] * first;
    let end = h[n - 2] / h[n - 3];
    middle[inner - 1] += h[n - 2] * (1.0 + end);
    lower[inner - 1] -= h[n - 2] * end;
    for k in 1..inner {
        let factor = lower[k] / middle[k - 1];
        middle[k] -= factor * upper[k - 1];
        right[k] -= factor * right[k - 1];
    }
    let mut curvature = vec![0.0; n];
    for k in (0..inner).rev() {
        let next = if k + 1 < inner {
            upper[k] * curvature[k + 2]
        } else {
            0.0
        };
        curvature[k + 1] = (right[k] - next) / middle[k];
    }
    curvature[0] = curvature[1] * (1.0 + first) - curvature[2] * first;
    curvature[n - 1] = curvature[n - 2] * (1.0 + end) - curvature[n - 3] * end;
    curvature
}
