//! What the recorded acceleration of the base alone makes of the displacement.

/// Displacement and velocity of a free mass relative to a base whose acceleration was sampled. SI.
pub struct Base {
    times: Vec<f64>,
    /// Displacement, velocity, acceleration and its derivative at each sample.
    states: Vec<[f64; 4]>,
}

impl Base {
    /// Between its samples the acceleration is the cubic with their values and, at each, the slope of the
    /// parabola through it and its neighbours: the error is of the fourth order in the step, that of straight
    /// lines of the second.
    pub fn new(times: &[f64], accelerations: &[f64]) -> Self {
        let last = times.len().saturating_sub(1);
        let secant = |k: usize| (accelerations[k] - accelerations[k + 1]) / (times[k + 1] - times[k]);
        let slope = |k: usize| match k {
            _ if last == 0 => 0.0,
            0 => secant(0),
            k if k == last => secant(k - 1),
            k => {
                let [before, after] = [times[k] - times[k - 1], times[k + 1] - times[k]];
                (after * secant(k - 1) + before * secant(k)) / (before + after)
            }
        };
        let mut base = Self { times: times.to_vec(), states: Vec::with_capacity(times.len()) };
        let (mut y, mut v) = (0.0, 0.0);
        for k in 0..times.len() {
            base.states.push([y, v, -accelerations[k], slope(k)]);
            if k > 0 {
                [y, v, _] = base.on_piece(k - 1, times[k] - times[k - 1]);
                base.states[k][..2].copy_from_slice(&[y, v]);
            }
        }
        base
    }

    /// Displacement, velocity and acceleration at a time.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let next = self.times.partition_point(|time| *time < t);
        let k = next.clamp(1, (self.times.len() - 1).max(1)) - 1;
        self.on_piece(k, t - self.times[k])
    }

    fn on_piece(&self, k: usize, s: f64) -> [f64; 3] {
        let [y, v, a, m] = self.states[k];
        let Some([_, _, b, n]) = self.states.get(k + 1) else { return [y, v, a] };
        let h = self.times[k + 1] - self.times[k];
        let secant = (b - a) / h;
        let (square, cube) = ((3.0 * secant - 2.0 * m - n) / h, (m + n - 2.0 * secant) / (h * h));
        [
            y + s * (v + s * (a / 2.0 + s * (m / 6.0 + s * (square / 12.0 + s * cube / 20.0)))),
            v + s * (a + s * (m / 2.0 + s * (square / 3.0 + s * cube / 4.0))),
            a + s * (m + s * (square + s * cube)),
        ]
    }
}
