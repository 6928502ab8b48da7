//! What is read between the ends of an impact of one step: samples, borders of the window, the ledger.

use interwell::dynamics::{Model, Request, Run};

use super::*;

/// A number of 0 to 1 for each index, spread evenly in `k` dimensions (Roberts 2018).
fn spread(index: usize, k: i32) -> f64 {
    ((index + 1) as f64 * 1.107_147_1_f64.powi(-k)).fract()
}

/// An impact at 1 mm on a stop of 10^`stiff` N/m^1.5, under a force of the mechanism that presses and has a
/// slope, damping and a drive.
struct Case {
    index: usize,
    stiff: f64,
    speed: f64,
    loss: f64,
}

impl Case {
    fn new(index: usize) -> Self {
        let part = |k: i32| spread(index, k);
        let speed = 10.0_f64.powf(2.5 * part(1) - 2.3);
        let loss = if index.is_multiple_of(4) { 0.0 } else { 2.2 * part(2) / speed };
        Self { index, stiff: 10.0_f64.powf(6.0 + 4.0 * part(3)), speed, loss }
    }

    /// For so long in s, the window beginning at `settle`.
    fn model(&self, (duration, settle): (f64, f64), tolerance: f64) -> Model {
        let part = |k: i32| spread(self.index, k);
        let (pressing, slope) = (0.5 * part(4) - 0.1, 4000.0 * (part(5) - 0.5) * part(8).powi(2));
        model(&format!(
            "mass_g: 15.2, mechanism: Polynomial(coefficients_si: [{}, {slope}, 3e3, 1e6]), \
             start: At(x_mm: 1, v_m_per_s: {}), damping: Coefficient(c_n_s_per_m: {}), \
             stops: Hertz(travel_limit_mm: 1, stiffness_n_per_m1_5: {}, loss_s_per_m: {}), \
             excitation: Sine(frequency_hz: {}, amplitude_g: 0.6, phase_deg: {}), \
             run: (duration_s: {duration}, settle_s: {settle}, tolerance: {tolerance})",
            -pressing - 1e-3 * slope,
            self.speed,
            0.5 * part(6),
            self.stiff,
            self.loss,
            3.0 + 60.0 * part(7),
            360.0 * part(9),
        ))
    }

    /// When the first impact is over, in s.
    fn end(&self) -> Option<f64> {
        let about = 2.94 / self.speed * (1.25 * 0.0152 * self.speed * self.speed / self.stiff).powf(0.4);
        let run = run(&self.model((4.0 * about, 0.0), 1e-13));
        of_kind(&run, EventKind::Separate).first().map(|event| event.t)
    }
}

/// Velocity, energies, mean and largest displacement, in units of an impact at a speed that takes a time.
fn figures(run: &Run, speed: f64, time: f64) -> [f64; 6] {
    let summary = &run.summary;
    let (ledger, energy) = (summary.ledger.unwrap(), 0.0152 * speed * speed);
    [
        summary.rms_velocity.unwrap() / speed,
        ledger.impact_j / energy,
        ledger.work_j / energy,
        ledger.damping_j / energy,
        summary.mean_x.unwrap() / 1e-3,
        summary.max_abs_x.unwrap() / (speed * time),
    ]
}

#[test]
fn it_is_as_exact_as_the_ends() {
    let (mut one_step, mut faults) = (0, Vec::new());
    for index in 0..80 {
        let case = Case::new(index);
        let Some(end) = case.end() else { continue };
        let times: Vec<f64> = [0.003, 0.02, 0.1, 0.2, 0.31, 0.4, 0.5, 0.6, 0.69, 0.8, 0.93, 0.99, 0.999]
            .map(|share| share * end)
            .into();
        let span = (1.01 * end, 0.3 * end);
        let request = Request { sample_times: &times, events: true, ledger: true, ..Request::default() };
        let exact = case.model(span, 1e-6).run_reference(&request, 1e-22);
        let leaves = |run: &Run| of_kind(run, EventKind::Separate)[0];
        let shown = figures(&exact, case.speed, end);
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
            let run = run_at(&case.model(span, tolerance), &times);
            if run.summary.steps > 3 {
                continue; // not in one step
            }
            one_step += 1;
            let mut check = |name: &str, off: f64| {
                if !(off.abs() < 2e-3 * tolerance + 1e-14) {
                    faults.push(format!("{name} of {index} at {tolerance}: {:.1e}", off / tolerance));
                }
            };
            let (a, b) = (leaves(&run), leaves(&exact));
            check("time", (a.t - b.t) / end);
            check("speed", (a.v_out - b.v_out) / case.speed);
            for (sample, exact) in run.samples.iter().zip(&exact.samples) {
                check("sample's speed", (sample.v - exact.v) / case.speed);
                check("sample's place", (sample.x - exact.x) / (case.speed * end));
            }
            figures(&run, case.speed, end)
                .into_iter()
                .zip(shown)
                .for_each(|(figure, exact)| check("figure", figure - exact));
            check("ledger", run.summary.ledger.unwrap().energy_residual);
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(one_step > 100, "{one_step}");
}
