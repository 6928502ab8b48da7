//! A live motion with an electrical state: the run itself, and its ledger through changes.

use interwell::dynamics::{Live, LiveOutput, Model, Phase};

use crate::support::*;

const TRANSDUCERS: [&str; 2] = [
    "transducer=Electromagnetic(coupling_v_s_per_m: 2, coil_ohm: 10, load_ohm: 20, inductance_mh: 500)",
    "transducer=Piezoelectric(coupling_n_per_v: 1e-3, capacitance_nf: 40, load_kohm: 100)",
];

fn paper(transducer: &str) -> Model {
    preset("paper", &[transducer, "run.duration_s=2", "run.settle_s=1"])
}

#[test]
fn it_is_the_run_and_its_ledger_closes() {
    for transducer in TRANSDUCERS {
        let model = paper(transducer);
        let times = every(0.003_7, 500);
        let run = run_at(&model, &times);
        assert!(run.samples.iter().any(|sample| sample.phase != Phase::Free && sample.electrical != 0.0));
        let (mut live, mut into) = (Live::new(&model), LiveOutput::default());
        let mut next = 0;
        for i in 1..=113 {
            let to = 0.016_3 * f64::from(i);
            let upto = next + times[next..].partition_point(|t| *t <= to);
            assert!(live.advance(to, &times[next..upto], &mut into));
            next = upto;
            let ledger = live.ledger();
            assert!(ledger.energy_residual() < 1e-8, "{ledger:?}");
        }
        assert_eq!(into.samples, run.samples[..into.samples.len()]);
        assert!(into.samples.len() > 400);
        assert!(live.ledger().harvested_j > 0.0);
        // what is to become of it is the same motion
        let here = live.from_here().unwrap();
        assert_eq!(here.start_electrical(), live.state().electrical);
    }
}

#[test]
fn a_change_of_the_load_keeps_the_state_and_the_energy() {
    let more = [
        "transducer=Electromagnetic(coupling_v_s_per_m: 2, coil_ohm: 10, load_ohm: 50, inductance_mh: 100)",
        "transducer=Piezoelectric(coupling_n_per_v: 1e-3, capacitance_nf: 80, load_kohm: 10)",
    ];
    for (before, after) in TRANSDUCERS.iter().zip(more) {
        let (mut live, mut into) = (Live::new(&paper(before)), LiveOutput::default());
        live.advance(0.71, &[], &mut into);
        let electrical = live.state().electrical;
        assert!(electrical != 0.0);
        live.change(&paper(after), &mut into);
        near_relative(live.state().electrical, electrical, 1e-14);
        live.advance(1.3, &[], &mut into);
        // another kind of transducer begins without a state, and so does none
        let other = if before == &TRANSDUCERS[0] { TRANSDUCERS[1] } else { TRANSDUCERS[0] };
        live.change(&paper(other), &mut into);
        assert_eq!(live.state().electrical, 0.0);
        live.advance(1.9, &[], &mut into);
        live.change(&preset("paper", &[]), &mut into);
        live.advance(2.5, &[], &mut into);
        let ledger = live.ledger();
        assert!(ledger.by_hand_j != 0.0 && ledger.energy_residual() < 1e-8, "{ledger:?}");
    }
}
