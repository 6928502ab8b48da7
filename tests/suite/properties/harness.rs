//! Drawing of scenes, their number, and the report of one that fails.

use std::cell::Cell;

use interwell::scene::{Excitation, Scene, write};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};

use super::mechanisms::table_text;

/// How many times as many scenes are drawn.
const CASES: &str = "INTERWELL_PROPERTY_CASES";

/// The number that all scenes follow from: the same scenes every day, so that a test that was green does not
/// turn red without a change. Another number, or the word `new`, draws others.
const SEED: &str = "INTERWELL_PROPERTY_SEED";

/// What a check of one scene says.
pub type Verdict = Result<(), TestCaseError>;

/// As many cases times the number that the environment asks for.
pub fn multiplied(cases: u32) -> u32 {
    let by: f64 = std::env::var(CASES).map_or(1.0, |by| by.parse().expect(CASES));
    (f64::from(cases) * by).ceil() as u32
}

fn seed() -> u64 {
    match std::env::var(SEED) {
        Err(_) => 1,
        Ok(word) if word == "new" => {
            let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
            now.expect("a clock").as_nanos() as u64
        }
        Ok(number) => number.parse().expect(SEED),
    }
}

/// A generator of its own for each property, so that one more of them leaves the scenes of the others as they
/// are.
fn generator(property: &str, seed: u64) -> TestRng {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    for (i, letter) in property.bytes().enumerate() {
        let place = &mut bytes[8 + i % 24];
        *place = place.rotate_left(3) ^ letter;
    }
    TestRng::from_seed(RngAlgorithm::ChaCha, &bytes)
}

/// Draws `cases` values and holds each against `check`, which may pass over some, as it says by false:
/// `least_share` must count, or the property would be one of nothing. A value that fails is made as simple as
/// it stays failing and shown by `show`, with the seed that draws it again.
pub fn hold_for<S: Strategy>(
    property: &str,
    cases: u32,
    least_share: f64,
    values: S,
    show: impl Fn(&S::Value) -> String,
    check: impl Fn(&S::Value) -> Result<bool, TestCaseError>,
) {
    let seed = seed();
    let config = Config {
        cases: multiplied(cases),
        failure_persistence: None,
        max_shrink_iters: 4000,
        ..Config::default()
    };
    let (drawn, counted) = (Cell::new(0.0), Cell::new(0.0));
    let checked = |value: S::Value| {
        drawn.set(drawn.get() + 1.0);
        if check(&value)? {
            counted.set(counted.get() + 1.0);
        }
        Ok(())
    };
    let mut runner = TestRunner::new_with_rng(config, generator(property, seed));
    match runner.run(&values, checked) {
        Ok(()) => {}
        Err(TestError::Fail(reason, value)) => {
            panic!("{property}: {reason}\n\n{}\n\n{SEED}={seed} draws it again", show(&value))
        }
        Err(TestError::Abort(reason)) => panic!("{property}: {reason}; {SEED}={seed}"),
    }
    let share = counted.get() / drawn.get();
    println!("{property}: {} drawn, {} count", drawn.get(), counted.get());
    assert!(share >= least_share, "{property}: only {share:.2} of what was drawn counts; {SEED}={seed}");
}

/// The same of scenes.
pub fn hold(
    property: &str,
    cases: u32,
    least_share: f64,
    scenes: impl Strategy<Value = Scene>,
    check: impl Fn(&Scene) -> Result<bool, TestCaseError>,
) {
    hold_for(property, cases, least_share, scenes, text, check);
}

/// A scene as a file, and after it the files that it names: nothing else is needed to run it again.
pub fn text(scene: &Scene) -> String {
    fn records(excitation: &Excitation, text: &mut String) {
        match excitation {
            Excitation::Sum(parts) => parts.iter().for_each(|part| records(part, text)),
            Excitation::Recorded { path, record: Some(record) } => {
                *text += &format!("\n# {path}\nt_s,accel_m_per_s2\n");
                for (t, a) in record.times.iter().zip(&record.accelerations) {
                    *text += &format!("{t:?},{a:?}\n");
                }
            }
            _ => {}
        }
    }
    let mut text = write(scene).unwrap();
    records(&scene.excitation, &mut text);
    if let Some((path, table)) = table_text(&scene.mechanism) {
        text += &format!("\n# {path}\n{table}");
    }
    text
}
