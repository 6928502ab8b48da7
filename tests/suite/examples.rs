//! Output of the programs in `examples/`.

#[allow(dead_code)]
#[path = "../../examples/force.rs"]
mod force;
#[allow(dead_code)]
#[path = "../../examples/picture.rs"]
mod picture;
#[allow(dead_code)]
#[path = "../../examples/run.rs"]
mod run;
#[allow(dead_code)]
#[path = "../../examples/study.rs"]
mod study;
#[allow(dead_code)]
#[path = "../../examples/sweep.rs"]
mod sweep;
#[allow(dead_code)]
#[path = "../../examples/threshold.rs"]
mod threshold;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use interwell::dynamics::Request;
use interwell::scene::Damping;
use interwell::{Error, Progress, Simulation, output};

use crate::cli::stdout;
use crate::support::near;

#[test]
fn the_summary_of_a_run() {
    assert_eq!(run::run().unwrap(), "interwell, 420 impacts, RMS velocity 0.114698 m/s");
}

#[test]
fn the_picture_of_a_run_has_the_numbers_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let [plot, data] = ["run.svg", "run.csv"].map(|name| folder.path().join(name).display().to_string());
    let options = "--panels displacement,portrait --plot-time 9:10";
    stdout(&format!("simulate nominal-cubic {options} --plot {plot} --plot-data {data}"));
    let chart = picture::chart(&Simulation::preset("nominal-cubic").unwrap()).unwrap();
    assert_eq!(output::csv(&chart.data), std::fs::read_to_string(data).unwrap());
}

#[test]
fn the_map_is_that_of_the_command_line() {
    let last = AtomicU64::new(0);
    let shown = |done: u64, all: Option<u64>| {
        assert_eq!(all, Some(15));
        last.fetch_max(done, Ordering::Relaxed);
    };
    let text = sweep::map(&Progress::none().reporting_to(&shown)).unwrap();
    let over = "--over stops.travel_limit_mm=2:6:1 --over excitation.amplitude_g=0.5,1,1.5";
    assert_eq!(text, stdout(&format!("sweep nominal-cubic --tolerance 1e-6 {over}")));
    assert_eq!((last.into_inner(), text.lines().count()), (15, 16));
    let stop = AtomicBool::new(true);
    assert_eq!(sweep::map(&Progress::none().stopped_by(&stop)), Err(Error::Cancelled));
}

#[test]
fn a_force_of_its_own_moves_the_mass() {
    let (error, speed) = force::run().unwrap();
    assert!(error < 1e-9 * 0.12, "{error:e}");
    // the same potential as a polynomial, to within its remainder between the stops
    let terms = (0..8).map(|n: i32| {
        let factorial: f64 = (1..=2 * n + 1).map(f64::from).product();
        let wave = std::f64::consts::PI / 7e-3;
        -0.25e-3 * wave * (-1.0_f64).powi(n) * wave.powi(2 * n + 1) / factorial
    });
    let list: Vec<String> = terms.map(|c| format!("0, {c:?}")).collect();
    let text = format!("Polynomial(coefficients_si: [{}])", list.join(", "));
    // the stiffness of the wells, to which the damping ratio refers; the polynomial has further ones far out
    let simulation = Simulation::preset("nominal-cubic").unwrap();
    let Damping::Ratio(ratio) = simulation.scene().damping else { panic!("no ratio") };
    let stiffness = 0.25e-3 * (std::f64::consts::PI / 7e-3).powi(2);
    let damping = 2.0 * ratio * (stiffness * 1e-3 * simulation.scene().mass_g).sqrt();
    let damping = format!("Coefficient(c_n_s_per_m: {damping:?})");
    let simulation = simulation.with("mechanism", text).unwrap().with("damping", damping).unwrap();
    near(simulation.run(&Request::default()).summary.rms_velocity.unwrap(), speed, 1e-5);
}

#[test]
fn the_least_amplitude_is_that_of_the_closed_form() {
    let limits = [1.0, 2.5, 4.0, 6.0];
    for (limit_mm, found) in threshold::released(&limits).unwrap() {
        let force = -40.0 * limit_mm * 1e-3 + 816326.530612245 * (limit_mm * 1e-3_f64).powi(3);
        near(found, -force / 0.0152 / 9.80665, 1.1e-9);
    }
}

#[test]
fn a_study_of_its_own_counts_impacts() {
    let rows = study::impacts(&[0.25, 1.5]).unwrap();
    assert_eq!(rows[0].1, 0.0, "a weak sine leaves the mass on its stop");
    assert_eq!(rows[1].1, 28.0, "the mass chatters on both stops before it rests");
}
