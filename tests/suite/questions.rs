//! Questions: cancellation of mechanisms and records, and which argument a fault names.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use interwell::mechanics::ForceCurve;
use interwell::questions::{
    Accuracy, Best, Branch, Curve, Error, Identify, Progress, Sampling, Simulation, Sweep, WhatToIdentify,
};
use interwell::scene::{Document, Excitation};

#[test]
fn a_mechanism_is_cancelled_and_solved_once() {
    let stop = AtomicBool::new(true);
    let stopped = Progress::none().stopped_by(&stop);
    let built = Simulation::build(Document::preset("paper").unwrap(), &stopped);
    assert_eq!(built.unwrap_err(), Error::Cancelled);
    let cubic = Simulation::preset("nominal-cubic").unwrap();
    let change = |field: &str, value: &str| cubic.with_changes(&[(field.into(), value.into())], &stopped);
    assert_eq!(change("mechanism.linear_n_per_m", "-41").unwrap_err(), Error::Cancelled);
    assert!(Arc::ptr_eq(change("mass_g", "16").unwrap().mechanism(), cubic.mechanism()));
    let sweep = Sweep::over("mass_g", 15.0..=16.0, 2).uncertain("mechanism.linear_n_per_m=-41+-1");
    assert_eq!(sweep.nominal(&cubic, &stopped).unwrap_err(), Error::Cancelled);
    let nominal = sweep.nominal(&cubic, &Progress::none()).unwrap();
    let again = sweep.nominal(&nominal, &Progress::none()).unwrap();
    assert!(Arc::ptr_eq(nominal.mechanism(), again.mechanism()));
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("times.csv");
    std::fs::write(&record, "t_s\n0\n1\n1.5\n1.75\n1.875\n").unwrap();
    let question = Identify { impact_times: true, ..Identify::of(WhatToIdentify::Restitution) };
    assert_eq!(question.run(&record, &stopped).unwrap_err(), Error::Cancelled);
    let curve = |cancel| ForceCurve::from_fn_cancellable(f64::sin, (-1.0, 1.0), 1e-6, &[], cancel);
    assert_eq!(curve(&stop).map_err(Error::from).unwrap_err(), Error::Cancelled);
    stop.store(false, Ordering::Relaxed);
    assert!(curve(&stop).is_ok() && question.run(&record, &stopped).is_ok());
}

#[test]
fn a_fit_is_cancelled_while_it_is_under_way() {
    // the function sets the flag by its last sample before the first fit
    let (stop, calls) = (AtomicBool::new(false), AtomicUsize::new(0));
    let force = |x: f64| {
        stop.store(calls.fetch_add(1, Ordering::Relaxed) == 64, Ordering::Relaxed);
        x.powi(3) - x
    };
    let found = ForceCurve::from_fn_cancellable(force, (-2.0, 2.0), 1e-8, &[], &stop);
    assert_eq!(found.map_err(Error::from).unwrap_err(), Error::Cancelled);
    assert_eq!(calls.into_inner(), 65);
}

/// Field and value of the fault of an argument.
fn fault<T>(found: Result<T, Error>) -> (String, String) {
    let faults = found.err().map(|error| error.faults()).unwrap_or_default();
    faults.into_iter().map(|fault| (fault.field, fault.value)).next().unwrap_or_default()
}

#[test]
fn a_fault_names_the_argument_and_its_value() {
    let scene = Simulation::preset("nominal-cubic").unwrap();
    let branch = |field: &str, from, to| Branch::over(field, from, to).run(&scene, &Progress::none());
    let curve = |range, tolerance, breaks: &[f64]| {
        ForceCurve::from_fn(|x| x, range, tolerance, breaks).map_err(Error::from)
    };
    let drive = |hz, tolerance| Excitation::from_fn(f64::sin, hz, tolerance).map_err(Error::from);
    let identify = |of, between| {
        let question = Identify { between, ..Identify::of(of) };
        question.run("no.csv".as_ref(), &Progress::none())
    };
    let uncertain = |law: &str| Sweep::over("mass_g", 15.0..=16.0, 2).uncertain(law);
    let unswept = Simulation::preset("elastic-box").unwrap();
    let step = ForceCurve::from_fn(|x| f64::from(x >= 0.3), (-1.0, 1.0), 1e-8, &[]);
    let (force, place) = fault(step.map_err(Error::from));
    assert!(force == "force" && place.starts_with("a function, near 0."), "{place}");
    // 1e4 places of one field are few, 1e8 of two are too many to keep
    let axes = ["mass_g=10:20:0.001", "stops.travel_limit_mm=1:6:0.0005"].map(str::to_owned);
    let (too_many, best) = (&*axes.join(", "), Best { over: axes.to_vec(), ..Best::default() });
    let soft = "Hertz(travel_limit_mm: 4, radius_mm: 5, young_gpa: 69, loss_s_per_m: 10.4)";
    let (soft, in_steps) = (scene.with("stops", soft).unwrap(), |scene: &Simulation, step| {
        Accuracy { step_s: vec![step], method: Vec::new() }.run(scene, &Progress::none())
    });
    let sampled = |sampling| scene.record(&sampling, None, &Progress::none());
    let beyond = Curve { positions: Some(vec![99.0]) }.run(&Simulation::preset("paper").unwrap());
    for (found, expected) in [
        (fault(branch("mass_g", 1.0, 1.0)), ("range", "1:1")),
        (fault(branch("mass", 1.0, 2.0)), ("field", "mass")),
        (fault(branch("run.tolerance", 1e-9, 1e-8)), ("field", "run.tolerance")),
        (fault(curve((1.0, -1.0), 1e-8, &[])), ("range", "1:-1")),
        (fault(curve((-1.0, 1.0), 2.0, &[])), ("tolerance", "2")),
        (fault(curve((-1.0, 1.0), 1e-8, &[3.0])), ("breaks", "3")),
        (fault(drive(0.0, 1e-6)), ("frequency_hz", "0")),
        (fault(drive(1.0, 2.0)), ("tolerance", "2")),
        (fault(identify(WhatToIdentify::Damping, [Some(5.0), Some(2.0)])), ("from", "5")),
        (fault(identify(WhatToIdentify::Force, [None, Some(2.0)])), ("to", "2")),
        (fault(sampled(Sampling::Every(0.0))), ("dt", "0")),
        (fault(sampled(Sampling::At(vec![99.0]))), ("at", "99")),
        (fault(beyond), ("positions", "99")),
        (fault(in_steps(&scene, 2.0)), ("step_s", "2")),
        (fault(in_steps(&soft, 0.01)), ("step_s", "0.01")),
        (fault(unswept.grid(&[])), ("over", "none")),
        (fault(best.run(&scene, &Progress::none())), ("over", too_many)),
    ] {
        assert_eq!((&*found.0, &*found.1), expected);
    }
    let error = uncertain("damping.xi=+-nan").run(&scene, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("NaN is not finite"), "{error}");
}
