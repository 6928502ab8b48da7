//! Rare events under noise: rates with their intervals, Kramers' rate, thresholds in probability, and
//! Melnikov's threshold.

mod command;
mod estimates;
mod kramers;
mod melnikov;

use interwell::Simulation;
use interwell::dynamics::{EventKind, Request};
use interwell::scene::{Document, Files};

use crate::support::{Draw, of_kind};

/// A double well with natural frequency 5 Hz in its wells, the damping rate `damping` and the height `height`
/// of its barrier over the energy k_B T of its noise, both relative: to the natural frequency and to 1.
pub fn double_well(damping: f64, height: f64, lines: u64, seed: u64, rest: &str) -> Simulation {
    let (mass, well, natural) = (0.01, 1e-3_f64, 5.0 * std::f64::consts::TAU);
    let barrier = mass * natural * natural * well * well / 8.0;
    let c = damping * natural * mass;
    // k_B T = m^2 S / (2 c) with the one-sided density 2 S = rms^2 / (band of 60 Hz)
    let rms_g = (4.0 * c * barrier / height / (mass * mass) * 60.0).sqrt() / 9.806_65;
    let text = format!(
        "(title: \"test\", mass_g: 10, mechanism: DoubleWell(equilibrium_mm: 1, barrier_mj: {:?}), \
         damping: Coefficient(c_n_s_per_m: {c:?}), excitation: Noise(rms_g: {rms_g:?}, low_hz: 0, \
         high_hz: 60, seed: {seed}, lines: {lines}), run: (duration_s: 20, tolerance: 1e-6), {rest})",
        1e3 * barrier
    );
    let document = Document::from_text("test", &text, Files::default()).unwrap_or_else(|e| panic!("{e}"));
    Simulation::new(&document).unwrap()
}

#[test]
fn a_run_until_its_crossing_is_the_beginning_of_the_whole_run() {
    let mut draw = Draw(5);
    let mut crossed = 0;
    for name in ["paper", "nominal-cubic", "duffing-chaos", "paper-unconstrained"] {
        let amplitude = draw.between(0.3, 2.0);
        let drives = [
            format!("Sine(frequency_hz: 3, amplitude_g: {amplitude})"),
            format!("Noise(rms_g: {amplitude}, low_hz: 0.5, high_hz: 10, seed: 3, lines: 32)"),
        ];
        for drive in drives {
            let simulation = Simulation::preset(name).unwrap();
            let model = simulation.with("excitation", drive).unwrap().model().clone();
            let model = model.with_duration(10.0, 5.0);
            let whole = model.run(&Request { events: true, ..Request::default() });
            let first = of_kind(&whole, EventKind::Crossing).first().copied();
            for events in [true, false] {
                let request = Request { events, until_crossing: true, ..Request::default() };
                let alone = model.run(&request);
                let together =
                    interwell::dynamics::Model::run_together(std::slice::from_ref(&model), &request);
                for run in [&alone, &together[0]] {
                    let Some(first) = first else {
                        assert_eq!(run.summary.total_crossings, 0, "{name}");
                        continue;
                    };
                    // one step may hold several crossings
                    assert!((1..4).contains(&run.summary.total_crossings), "{name}");
                    assert!(run.summary.steps < whole.summary.steps, "{name}");
                    if events {
                        let found = of_kind(run, EventKind::Crossing);
                        assert_eq!(found[0], first, "{name}");
                        assert_eq!(run.events[..], whole.events[..run.events.len()], "{name}");
                    }
                    if let Some(firsts) = run.summary.firsts {
                        assert_eq!(firsts.crossing.unwrap().t, first.t, "{name}");
                    }
                    crossed += 1;
                }
            }
        }
    }
    assert!(crossed >= 8, "{crossed} runs crossed");
}
