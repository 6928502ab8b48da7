//! One problem in several systems of units.

use super::HardCase;
use crate::dynamics::{EventKind, Run};
use crate::scene::{Excitation, Mechanism};
use crate::study::accuracy::Stopped;
use crate::study::accuracy::measure::{Bench, Variant, off};
use crate::study::accuracy::scenes::{Setup, rigid};

pub(super) const UNITS: HardCase = HardCase {
    name: "units",
    problem: "A chattering second of the nominal cubic well (stops at 4 mm, e = 0.36, 1.5 g at 3 Hz) with \
              mass, stiffness, length and time in units of 1e-9 to 1e9.",
    answer: "The same dimensionless answer: times of the impacts, in periods, as of the scene in SI units by \
             the program in double-double arithmetic.",
    conditioning: "Sensitivity of each impact's time to all data, by the reference; a scaled datum is \
                   rounded once more.",
    find: units,
};

/// A unit of mass, length and time.
#[derive(Clone, Copy)]
struct Units {
    mass: f64,
    length: f64,
    time: f64,
}

fn scaled(Units { mass: m, length: l, time: t }: Units) -> Setup {
    let cubic = Mechanism::Cubic {
        linear_n_per_m: -40.0 * m / (t * t),
        cubic_n_per_m3: 40.0 / 49e-6 * m / (t * t * l * l),
    };
    let drive = Excitation::Sine { frequency_hz: 3.0 / t, amplitude_g: 1.5 * l / (t * t), phase_deg: 0.0 };
    let mut setup =
        Setup::new(cubic, (0.0, 0.0), t).stops(rigid(4.0 * l, 0.36)).drive(drive).damping(0.05 * m / t);
    setup.scene.mass_g = 15.2 * m;
    setup.scene.start = crate::scene::Start::Rest;
    setup
}

fn units(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let one = Units { mass: 1.0, length: 1.0, time: 1.0 };
    // 1 cm/s and faster in SI
    let hard = |run: &Run, units: Units| -> Vec<f64> {
        let least = 1e-2 * units.length / units.time;
        let hard =
            run.events.iter().filter(|event| event.kind == EventKind::Impact && event.v_in.abs() > least);
        hard.map(|event| 3.0 * event.t / units.time).collect()
    };
    let base = scaled(one);
    let model = base.model()?;
    let reference = bench.reference(&model, &[])?;
    let exact = hard(&reference, one);
    let sensitivity = bench.sensitivity(&base, &[], |run| hard(run, one))?;
    let mut variants = Vec::new();
    for (name, units) in [
        ("SI", one),
        ("mass 1e-9", Units { mass: 1e-9, ..one }),
        ("mass 1e9", Units { mass: 1e9, ..one }),
        ("stiffness 1e-9", Units { time: 1e9_f64.sqrt(), ..one }),
        ("stiffness 1e9", Units { time: 1e-9_f64.sqrt(), ..one }),
        ("length 1e-9", Units { length: 1e-9, ..one }),
        ("length 1e9", Units { length: 1e9, ..one }),
        ("time 1e-9", Units { time: 1e-9, ..one }),
        ("time 1e9", Units { time: 1e9, ..one }),
        ("all", Units { mass: 1e9, length: 1e-9, time: 1e-5 }),
    ] {
        let model = scaled(units).model()?;
        let run = bench.run(&model, &[])?;
        let found = hard(&run, units);
        let allowed = Bench::allowed(&model, run.summary.steps, &sensitivity);
        let pairs: Vec<_> = found
            .iter()
            .zip(&exact)
            .zip(&allowed)
            .map(|((value, exact), allowed)| (off(*value, *exact, *exact), 2.0 * allowed / exact))
            .collect();
        variants.push(
            Variant::of(name, &run)
                .worst("impact times", pairs)
                .fact("all impacts", found.len() == exact.len()),
        );
    }
    Ok(variants)
}
