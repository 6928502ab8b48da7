//! Output of the programs in `examples/`.

#[allow(dead_code)]
#[path = "../../examples/least_amplitude.rs"]
mod least_amplitude;
#[allow(dead_code)]
#[path = "../../examples/run.rs"]
mod run;
#[allow(dead_code)]
#[path = "../../examples/sweep.rs"]
mod sweep;

use interwell::dynamics::STANDARD_GRAVITY;

use crate::cli::stdout;
use crate::support::near;

#[test]
fn the_summary_of_a_run() {
    let text = run::run().unwrap();
    // The release in closed form: 1.5 g sin(2 pi f t) = -F(D)/m, with F = -40 x + (40/49e-6) x^3.
    let press = (40.0 * 4e-3 - 40.0 / 49e-6 * 4e-3_f64.powi(3)) / 0.0152;
    let release = (press / (1.5 * STANDARD_GRAVITY)).asin() / (6.0 * std::f64::consts::PI);
    assert_eq!(format!("{release:.6}"), "0.026677");
    let expected = "barrier         0.490 mJ
first release   0.026677 s
regime          interwell, period 1
crossings       30 in 15 forcing periods
impacts         420
RMS velocity    0.114698 m/s
lost at stops   93.5 % of the work of the base
";
    assert_eq!(text, expected);
}

#[test]
fn the_map_is_that_of_the_command_line() {
    let (text, cells) = sweep::run().unwrap();
    let over = sweep::OVER.map(|over| format!("--over {over}")).join(" ");
    assert_eq!(text, stdout(&format!("sweep nominal-cubic --tolerance 1e-6 {over}")));
    assert_eq!((cells, text.lines().count()), (15, 16));
}

#[test]
fn the_least_amplitude_is_that_of_the_closed_form() {
    let limits = [1.0, 2.5, 4.0, 6.0];
    let rows = least_amplitude::run(&limits).unwrap();
    assert_eq!(rows.iter().map(|row| row.0).collect::<Vec<_>>(), limits);
    for (limit_mm, found, closed_form) in rows {
        let force = -40.0 * limit_mm * 1e-3 + 816326.530612245 * (limit_mm * 1e-3).powi(3);
        near(closed_form, -force / 0.0152 / 9.80665, 1e-14);
        near(found, closed_form, 1.1e-9);
    }
}
