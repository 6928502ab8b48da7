//! Words and figures of a run about itself: settled or not, its place, its first events.

use interwell::dynamics::{Model, Place, Regime, Request, Summary};

use super::support::*;

/// The summary of a run that goes on until the motion repeats, or up to 300 s.
fn settled(model: &Model) -> Summary {
    model.run(&Request { until_settled: Some(300.0), ..Request::default() }).summary
}

fn unconstrained(amplitude: f64, more: &[&str]) -> Model {
    let amplitude = format!("excitation.amplitude_g={amplitude}");
    preset("paper-unconstrained", &[&[amplitude.as_str()], more].concat())
}

#[test]
fn a_transient_is_no_verdict() {
    // A window of 5 s after 5 s calls most of these irregular; each settles within five minutes, nearly all
    // of them in a rhythm. Which motion an irregular beginning leads to depends on rounding.
    let short = ["run.duration_s=10", "run.settle_s=5"];
    let (mut early, mut crossing) = (0, 0);
    for hundredths in 116..=135 {
        let summary = settled(&unconstrained(f64::from(hundredths) / 100.0, &[]));
        // at 1.24 g it may cross in every period and yet never repeat
        assert!(summary.settled == Some(true) || hundredths == 124, "{hundredths}");
        crossing += usize::from((summary.regime, summary.side) == (Regime::Interwell, Some(Place::Both)));
        let first = unconstrained(f64::from(hundredths) / 100.0, &short).run(&Request::default()).summary;
        early += usize::from(first.regime == Regime::Irregular);
        // what has no period yet is not called settled
        assert_eq!(first.settled, Some(first.period.is_some()), "{hundredths}");
    }
    assert!(early >= 10 && crossing >= 18, "{early} {crossing}");
}

#[test]
fn it_is_known_since_when_a_motion_repeats() {
    // a start from which the beginning is too short for rounding to matter
    let start = ["start=At(x_mm: 0, v_m_per_s: -0.3)"];
    let summary = settled(&unconstrained(1.2, &start));
    let since = summary.settles_at.unwrap();
    assert!(summary.period == Some(1) && since > 5.0 && since < summary.window.0, "{summary:?}");
    // the strobes before that are others, those after it the same
    let times: Vec<f64> = (-2..6).map(|i| since + f64::from(i) / 3.0).collect();
    let run = run_at(&unconstrained(1.2, &start), &times);
    let apart = |i: usize| (run.samples[i + 1].x - run.samples[i].x).abs();
    assert!(
        apart(1) > 5e-6 && (2..7).all(|i| apart(i) < 1e-5),
        "{:?}",
        (0..7).map(apart).collect::<Vec<_>>()
    );
}

#[test]
fn no_age_makes_an_irregular_motion_a_settled_one() {
    let model = unconstrained(1.5, &[]);
    let early = model.run(&Request::default()).summary;
    assert_eq!((early.regime, early.settled, early.settles_at), (Regime::Irregular, Some(false), None));
    // the halves of a window of ten seconds agree mostly, not always
    let mut steady = 0;
    for hundredths in 140..=150 {
        let late = settled(&unconstrained(f64::from(hundredths) / 100.0, &[]));
        assert_eq!((late.regime, late.period), (Regime::Irregular, None), "{hundredths}");
        assert_eq!((late.settled, late.settles_at), (Some(false), None), "{hundredths}");
        near(late.window.1, 300.0, 10.0);
        near(late.window.1 - late.window.0, 10.0, 1e-9);
        steady += usize::from(late.steady == Some(true));
    }
    assert!(steady >= 7, "{steady}");
}

#[test]
fn a_long_transient_in_one_well_is_not_settled() {
    // for minutes the mass moves in one well, without a period, and looks steady; then it crosses
    let seen = |amplitude: f64, until: f64| {
        let request = Request { until_settled: Some(until), ..Request::default() };
        unconstrained(amplitude, &[]).run(&request).summary
    };
    // which of them crosses, and when, depends on rounding
    let mut crossed = 0;
    for step in 0..=20 {
        let amplitude = 1.15 + 0.00025 * f64::from(step);
        let early = seen(amplitude, 113.0);
        if early.regime != Regime::Intrawell {
            continue;
        }
        assert_eq!((early.settled, early.steady), (Some(false), Some(true)), "{amplitude}");
        near(early.window.1, 110.0, 1e-9);
        let late = seen(amplitude, 1000.0);
        let crosses = late.regime == Regime::Interwell;
        assert_eq!(late.settled, Some(crosses), "{amplitude}");
        crossed += u32::from(crosses && late.settles_at.unwrap() > 110.0);
    }
    assert!(crossed >= 3, "{crossed}");
}

#[test]
fn a_motion_that_goes_on_is_the_same_motion() {
    let start = "start=At(x_mm: 0, v_m_per_s: -0.3)";
    let model = unconstrained(1.2, &[start]);
    let going = model.run(&Request { until_settled: Some(300.0), ledger: true, ..Request::default() });
    let (from, to) = going.summary.window;
    let spans = [format!("run.duration_s={to}"), format!("run.settle_s={from}")];
    let plain = unconstrained(1.2, &[start, spans[0].as_str(), spans[1].as_str()])
        .run(&Request { ledger: true, ..Request::default() });
    let (a, b) = (going.summary, plain.summary);
    assert!(to > 20.0 && a.period == b.period && a.crossings == b.crossings);
    near_relative(a.rms_velocity.unwrap(), b.rms_velocity.unwrap(), 1e-6);
    near(a.mean_x.unwrap(), b.mean_x.unwrap(), 1e-8);
    near(a.ledger.unwrap().energy_residual, 0.0, 1e-8);
    // where it repeats at once, and where it cannot be waited for, nothing changes
    let mut unchanged = 0;
    for name in ["paper", "duffing", "random-shaking", "paper-ramp", "elastic-box"] {
        let model = preset(name, &["run.duration_s=10", "run.settle_s=5"]);
        let plain = model.run(&Request::default());
        if plain.summary.settled != Some(false) || !model.can_settle() {
            same_bits(&model.run(&Request { until_settled: Some(1e3), ..Request::default() }), &plain);
            unchanged += 1;
        }
    }
    assert!(unchanged >= 4, "{unchanged}");
}

#[test]
fn runs_that_go_on_share_their_steps_too() {
    let models: Vec<Model> =
        (100..130).step_by(3).map(|g| unconstrained(f64::from(g) / 100.0, &[])).collect();
    let request = Request { until_settled: Some(60.0), ..Request::default() };
    for (model, run) in models.iter().zip(Model::run_together(&models, &request)) {
        same_bits(&model.run(&request), &run);
    }
}

#[test]
fn no_length_of_a_run_changes_its_regime() {
    // 65536 crossings in the window, and one period more
    for duration in ["run.duration_s=10927", "run.duration_s=10928"] {
        for recurrence in ["run.recurrence=true", "run.recurrence=false"] {
            let run = preset("paper", &[duration, "run.settle_s=5", recurrence]).run(&Request::default());
            let summary = run.summary;
            assert_eq!(
                (summary.regime, summary.period, summary.settled),
                (Regime::Interwell, Some(1), Some(true))
            );
            assert_eq!(
                (summary.crossing_periods, summary.release_periods),
                (summary.periods, summary.periods)
            );
            assert_eq!(summary.crossings, 2 * summary.periods);
        }
    }
}

#[test]
fn the_range_is_not_mirrored() {
    for duration in ["10", "10.17", "10.3"] {
        let duration = format!("run.duration_s={duration}");
        let summary = run(&preset("uneven-stops", &[&duration])).summary;
        assert_eq!(summary.range, Some((-1.5e-3, 1.7e-3)));
        assert_eq!(summary.max_abs_x, Some(1.7e-3));
    }
}

#[test]
fn mean_displacement_side_and_fastest_impact() {
    // x = a sin(w t) about a constant push: the mean is the push over the stiffness
    let linear =
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 4]), damping: Coefficient(c_n_s_per_m: 1)";
    let push = "excitation: Sum([Constant(accel_g: 0.01), Sine(frequency_hz: 1, amplitude_g: 0.1)])";
    let summary = run(&model(&format!("{linear}, {push}, run: (duration_s: 100, settle_s: 50)"))).summary;
    near_relative(summary.mean_x.unwrap(), -0.01 * 9.80665 / 4.0, 1e-9);
    assert_eq!((summary.side, summary.impact_speed_max), (None, None)); // one well, no stop
    // a ball that is dropped from 1 m hits with sqrt(2 g h)
    let ball = run(&preset("bouncing-ball", &["run.settle_s=0"])).summary;
    near_relative(ball.impact_speed_max.unwrap(), (2.0 * 9.81_f64).sqrt(), 1e-9);
    let late = run(&preset("bouncing-ball", &["run.settle_s=0.5"])).summary;
    assert!(late.impact_speed_max.unwrap() < ball.impact_speed_max.unwrap());
    // in the right-hand well, and by the mirrored start in the left-hand one
    let right = run(&preset("first-look", &[])).summary;
    let left = run(&preset("first-look", &["start=At(x_mm: -7, v_m_per_s: 0)"])).summary;
    assert_eq!((right.side, left.side), (Some(Place::Right), Some(Place::Left)));
    // pressed on a stop all the time, and in contact with one that gives way
    let rests = run(&preset("paper", &["excitation.amplitude_g=0.5"])).summary;
    near(rests.mean_x.unwrap(), 1.5e-3, 1e-15);
    let hertz = "stops=Hertz(travel_limit_mm: 1.5, stiffness_n_per_m1_5: 1e9, loss_s_per_m: 5)";
    let pressed = run(&preset("paper", &[hertz, "excitation.amplitude_g=0.5", "run.settle_s=9"])).summary;
    near(pressed.mean_x.unwrap(), pressed.range.unwrap().1, 2e-7);
}

#[test]
fn a_drive_that_changes_gets_no_word_of_periodicity() {
    let sums = "excitation=Sum([Sine(frequency_hz: 3, amplitude_g: 1), Sine(frequency_hz: 3.14159265, \
        amplitude_g: 1)])";
    let chirp = "excitation=Chirp(from_hz: 2, to_hz: 4, over_s: 10, amplitude_g: 1)";
    let noise = "excitation=Noise(rms_g: 1, low_hz: 1, high_hz: 5, seed: 1)";
    let ramp = "excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 2)";
    for drive in [sums, chirp, noise, ramp] {
        let summary = run(&preset("paper", &[drive])).summary;
        assert_eq!(
            (summary.regime.name(), summary.period, summary.settled),
            ("crossing", None, None),
            "{drive}"
        );
        let first = summary.firsts.unwrap();
        assert!(first.release.unwrap().t < first.crossing.unwrap().t, "{drive} {first:?}");
    }
    // nothing drives it: it crosses, and does not settle
    let free = run(&unit_well("start: At(x_mm: 0, v_m_per_s: 1), run: (duration_s: 50)")).summary;
    assert_eq!((free.regime, free.settled), (Regime::Crossing, Some(false)));
    let still = run(&preset("paper", &["excitation=None"])).summary;
    assert_eq!((still.regime, still.settled), (Regime::Rest, Some(true)));
    assert!(run(&preset("paper", &[])).summary.firsts.is_none());
}

#[test]
fn a_ramp_tells_when_it_frees_crosses_and_always_crosses() {
    let run = run(&preset("paper-ramp", &[]));
    let firsts = run.summary.firsts.unwrap();
    let (release, crossing) = (firsts.release.unwrap(), firsts.crossing.unwrap());
    let listed = |kind| of_kind(&run, kind).first().unwrap().t;
    assert_eq!(release.t, listed(interwell::dynamics::EventKind::Release));
    assert_eq!(crossing.t, listed(interwell::dynamics::EventKind::Crossing));
    let amplitude = |t: f64| 2.0 * 9.80665 * t / 300.0;
    near_relative(release.amplitude.unwrap(), amplitude(release.t), 1e-12);
    near_relative(crossing.amplitude.unwrap(), amplitude(crossing.t), 1e-12);
    // 0.688 g is what the stop at 1.5 mm holds; from the first crossing on it crosses in every period
    assert!(release.amplitude.unwrap() > 0.688 * 9.80665);
    assert_eq!(firsts.crossing_in_every_period, firsts.crossing);
    // a ramp that falls again: it does not cross to the end
    let down = "excitation=Sum([AmplitudeRamp(frequency_hz: 3, from_g: 2, to_g: 0, over_s: 20)])";
    let summary = super::support::run(&preset("paper", &[down, "run.duration_s=30"])).summary;
    let firsts = summary.firsts.unwrap();
    assert!(firsts.crossing.is_some() && firsts.crossing_in_every_period.is_none());
}

/// Runs of a scene that last so many seconds.
fn lasting(scene: &str, durations: [f64; 2]) -> [Summary; 2] {
    let run = |duration: f64| model(&scene.replace("DURATION", &format!("{duration:?}")));
    durations.map(|duration| run(duration).run(&Request::default()).summary)
}

/// Motions that pass the ghost of a fold, that a run follows for a while only, or that come back by a rest
/// that they reach at one tolerance alone have not settled; one that alternates has the period of its orbit.
#[test]
fn what_returns_for_a_while_has_not_settled() {
    let ghost = "mass_g: 8.442730795058747, \
         mechanism: Polynomial(coefficients_si: [0, -0.1368892546276172, 0, 10040.485174620013]), \
         damping: Coefficient(c_n_s_per_m: 0.012802257106270257), \
         excitation: Cosine(frequency_rad_per_s: 1.8040705859036295, \
         amplitude_m_per_s2: 0.027068106312964905), \
         run: (duration_s: DURATION, settle_s: 104.48347236977607, tolerance: 1e-9)";
    let [short, long] = lasting(ghost, [174.13912061629344, 870.0]);
    assert_eq!((short.settled, long.settled), (Some(false), Some(false)));
    assert_eq!(long.regime, Regime::Irregular);

    let beside = "mass_g: 992.3887077044848, \
         mechanism: Polynomial(coefficients_si: [0, -11.209961875324778, 0, 202276.14190115652]), \
         damping: Coefficient(c_n_s_per_m: 0.2217901220347959), \
         stops: Rigid(travel_limit_mm: 7.802151300845829, restitution: 0), \
         excitation: Force(frequency_rad_per_s: 3.864639395461653, amplitude_n: 0.04463628149405051, \
         phase_deg: -46.44358317638856), \
         run: (duration_s: DURATION, settle_s: 48.7744236724241, tolerance: 1e-9)";
    assert_eq!(lasting(beside, [81.29070612070683, 160.0]).map(|summary| summary.settled), [Some(false); 2]);

    let alternates = "mass_g: 4.1603630362863075, \
         mechanism: Polynomial(coefficients_si: [-0.002938492825169029, -0.3605986778799142, \
         -0.07470875824670765, 1.8335848377144341]), \
         damping: Coefficient(c_n_s_per_m: 0.0008517059223770924), \
         stops: Rigid(travel_limit_mm: 478.5071619607956, restitution: 0.4915293191493353), \
         excitation: Cosine(frequency_rad_per_s: 11.127363699757229, amplitude_m_per_s2: 106.2888299704516, \
         phase_deg: 92.7219932531774), start: At(x_mm: 321.5006904906504, v_m_per_s: -2.1912307819069055), \
         run: (duration_s: DURATION, settle_s: 8.46991094662881, tolerance: 1e-10)";
    let periods = lasting(alternates, [16.93982189325762, 20.0]).map(|summary| summary.period);
    assert_eq!(periods, [Some(3); 2]);

    let recurs = "mass_g: 249.0170652681843, mechanism: Polynomial(coefficients_si: [-0.0010542767946832728, \
         -9.69669739945166, -102.11632445762483, 187842.71887674186]), \
         damping: Coefficient(c_n_s_per_m: 0.34836664200647594), \
         stops: Rigid(travel_limit_mm: 3.981740574585584, restitution: 0.9437064001116442), \
         excitation: Cosine(frequency_rad_per_s: 4.70681235005476, amplitude_m_per_s2: 0.13197704843676722, \
         phase_deg: 146.57504874438484), \
         run: (duration_s: DURATION, settle_s: 1500, tolerance: 1e-9)";
    assert_eq!(lasting(recurs, [2000.0, 2200.0]).map(|summary| summary.settled), [Some(false); 2]);

    // in a band of some 4e-7 about an orbit that repels it
    let band = "mass_g: 1000, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), \
         damping: Coefficient(c_n_s_per_m: 0.09105517393294796), \
         stops: Rigid(travel_limit_mm: 773.5924409002645, restitution: 0.2828202732367634), \
         excitation: Cosine(frequency_rad_per_s: 0.7765410457931397, \
         amplitude_m_per_s2: 0.5758794632490406), \
         start: At(x_mm: -64.09231955051823, v_m_per_s: -0.403974149841585), \
         run: (duration_s: DURATION, settle_s: 0, tolerance: 1e-9)";
    assert_eq!(lasting(band, [428.83608417726873, 857.0]).map(|summary| summary.settled), [Some(false); 2]);
}
