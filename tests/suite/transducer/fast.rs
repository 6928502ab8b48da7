//! Circuits far faster than the motion: what is said of them, and what is given in their place.

use interwell::dynamics::Outcome;
use interwell_studies::study::ended_remedy;

use crate::support::*;

fn with(transducer: &str) -> String {
    format!("transducer={transducer}")
}

#[test]
fn what_is_given_in_place_of_a_fast_circuit_is_the_same_to_the_share_that_is_said() {
    let short = ["run.duration_s=0.3", "run.settle_s=0"];
    for (fast, said, instead) in [
        (
            "Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 60, inductance_mh: 0.1)",
            "without inductance_mh the coil is a damping",
            "Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 60)",
        ),
        (
            "Piezoelectric(coupling_n_per_v: 0.01, capacitance_nf: 4, load_kohm: 2)",
            "transducer=Electromagnetic(coupling_v_s_per_m: 20, coil_ohm: 0, load_ohm: 2000) gives the same",
            "Electromagnetic(coupling_v_s_per_m: 20, coil_ohm: 0, load_ohm: 2000)",
        ),
    ] {
        let model = preset("nominal-cubic", &[&with(fast), short[0], short[1]]);
        let words = model.fast_circuit().unwrap();
        assert!(words.contains(said), "{words}");
        let share: f64 = words.rsplit(' ').next().unwrap().parse().unwrap();
        assert!(model.describe().contains(&words));
        let other = preset("nominal-cubic", &[&with(instead), short[0], short[1]]);
        assert_eq!((other.fast_circuit(), other.has_electrical_state()), (None, false));
        let (a, b) = (run(&model).summary, run(&other).summary);
        let (power, same) = (a.harvest.unwrap(), b.harvest.unwrap());
        assert!(a.impacts > 3 && power.mean_load_power > Some(0.0), "{a:?}");
        assert!(share < 1e-3, "{words}");
        near_relative(power.mean_load_power.unwrap(), same.mean_load_power.unwrap(), 20.0 * share);
        near_relative(power.voltage_rms.unwrap(), same.voltage_rms.unwrap(), 20.0 * share);
        near_relative(a.rms_velocity.unwrap(), b.rms_velocity.unwrap(), 20.0 * share);
    }
}

#[test]
fn a_strong_coupling_is_named_and_a_real_one_is_not() {
    let coil = |k: &str| {
        with(&format!("Electromagnetic(coupling_v_s_per_m: {k}, coil_ohm: 1, load_ohm: 1, inductance_mh: 3)"))
    };
    let words = preset("paper", &[&coil("1e4")]).fast_circuit().unwrap();
    assert!(words.starts_with("mass and circuit exchange their energy in 6.753e-7 s"), "{words}");
    assert!(words.contains("a larger inductance_mh or a weaker coupling"), "{words}");
    assert_eq!(preset("paper", &[&coil("5")]).fast_circuit(), None);
    assert_eq!(preset("harvester", &[]).fast_circuit(), None);
    assert_eq!(preset("paper", &[]).fast_circuit(), None);
}

/// A load of 1e30 ohm is an open circuit, and a run with it ends with that remedy.
#[test]
fn an_open_circuit_is_given_in_place_of_a_load_without_bounds() {
    let load = ["transducer.inductance_mh=10", "transducer.load_ohm=1e30"];
    let model = preset("harvester", &load);
    let words = model.fast_circuit().unwrap();
    assert!(words.contains("load_ohm: inf is the open circuit that this is"), "{words}");
    for outcome in [Outcome::NotFinite { at: 0.04 }, Outcome::StepBudget { at: 0.04, count: 1 }] {
        assert_eq!(ended_remedy(&model, outcome), Some(words.clone()));
    }
    let open = preset("harvester", &[load[0], "transducer.load_ohm=inf"]);
    assert_eq!((open.fast_circuit(), run(&open).summary.outcome), (None, Outcome::Done));
}

/// A mass that is held fast moves by less than the rounding of its place: that no power of it is right is
/// said.
#[test]
fn a_coupling_that_holds_the_mass_fast_gives_no_number_without_a_word() {
    let held = "Electromagnetic(coupling_v_s_per_m: 1e12, coil_ohm: 40, load_ohm: 60, inductance_mh: 3)";
    let summary = run(&preset("paper", &[&with(held), "run.duration_s=0.5", "run.settle_s=0"])).summary;
    let Outcome::Inaccurate { residual } = summary.outcome else { panic!("{:?}", summary.outcome) };
    assert!(residual > 0.1 && summary.max_abs_x == Some(1.5e-3), "{summary:?}");
}
