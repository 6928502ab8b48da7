//! Numbers in the text of every built-in scene, in its line of the list and in its notes, each measured
//! anew.
//!
//! A claim writes the words as they stand in the text with the measured number in them, with as many digits
//! as the text has. Numbers that depend on rounding, those of irregular motion, are held within what the
//! words allow.

mod alternatives;
mod harvester;
mod impact_oscillator;
mod prototype;
mod textbook;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Outcome, Regime, Request, Summary};
use interwell::scene::{PRESETS, Preset};
use interwell_studies::study::{Onset, Scan, Task, threshold};

use super::support::*;

/// A scene's text, and which parts of it have been measured.
struct Text {
    preset: &'static Preset,
    words: String,
    held: Vec<Range<usize>>,
}

impl Text {
    fn new(name: &str) -> Self {
        let preset = PRESETS.iter().find(|preset| preset.name == name).unwrap();
        let words = format!("{}. {}", preset.summary, changed(name, &[]).scene.notes);
        Self { preset, words, held: Vec::new() }
    }

    /// The text says this, and what it says has been measured.
    #[track_caller]
    fn says(&mut self, claim: &str) {
        let before = self.held.len();
        self.held.extend(self.words.match_indices(claim).map(|(at, _)| at..at + claim.len()));
        assert!(self.held.len() > before, "{} does not say: {claim}\n{}", self.preset.name, self.words);
    }

    /// The numbers that were not measured and are no number of the scene's own fields.
    fn unheld(&self) -> Vec<&str> {
        let fields = self.preset.text.split_once("mass_g").unwrap().1;
        let given: Vec<f64> = numbers(fields).map(|(_, number)| number.parse().unwrap()).collect();
        let held = |at: usize| self.held.iter().any(|range| range.contains(&at));
        let free = numbers(&self.words).filter(|(at, _)| !held(*at));
        free.map(|(_, number)| number).filter(|number| !given.contains(&number.parse().unwrap())).collect()
    }
}

/// The numbers of a text without their signs and exponents, and where each begins.
fn numbers(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let runs = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    let runs = runs.map(|run| (run.as_ptr() as usize - text.as_ptr() as usize, run.trim_end_matches('.')));
    runs.filter(|(_, run)| run.starts_with(|c: char| c.is_ascii_digit()))
}

macro_rules! texts {
    ($($name:literal: $module:ident::$scene:ident;)*) => {
        $(#[test]
        fn $scene() {
            let mut text = Text::new($name);
            $module::$scene(&mut text);
            assert_eq!(text.unheld(), [""; 0], "not measured: {}", text.words);
        })*

        #[test]
        fn every_text_is_measured() {
            assert_eq!(PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>(), [$($name),*]);
        }
    };
}

texts! {
    "first-look": prototype::first_look;
    "paper": prototype::paper;
    "paper-table": prototype::paper_table;
    "paper-unconstrained": prototype::paper_unconstrained;
    "paper-ramp": prototype::paper_ramp;
    "uneven-stops": prototype::uneven_stops;
    "walking": prototype::walking;
    "random-shaking": prototype::random_shaking;
    "balanced": alternatives::balanced;
    "magnet": alternatives::magnet;
    "harvester": harvester::harvester;
    "nominal-cubic": textbook::nominal_cubic;
    "monostable": textbook::monostable;
    "bouncing-ball": textbook::bouncing_ball;
    "elastic-box": textbook::elastic_box;
    "duffing": textbook::duffing;
    "duffing-chaos": textbook::duffing_chaos;
    "duffing-cascade": textbook::duffing_cascade;
    "period-adding": textbook::period_adding;
    "impact-oscillator": impact_oscillator::impact_oscillator;
}

#[test]
fn numbers_are_found() {
    let found: Vec<_> = numbers("At 1.3 g, -7.9 mm (start.x_mm=3). It is 41.").collect();
    assert_eq!(found, [(3, "1.3"), (11, "7.9"), (30, "3"), (40, "41")]);
}

/// The motion that a scene with fields changed settles to: it goes on until it repeats, or up to 600 s.
fn settled(name: &str, changes: &[&str]) -> Summary {
    let request = Request { until_settled: Some(600.0), ledger: true, ..Request::default() };
    let summary = preset(name, changes).run(&request).summary;
    assert_eq!(summary.outcome, Outcome::Done, "{name} {changes:?}");
    assert!(summary.ledger.unwrap().energy_residual < 1e-5, "{name} {changes:?}");
    summary
}

/// Asserts that a motion crosses over and back once in every period.
#[track_caller]
fn crosses(summary: &Summary) {
    assert_eq!((summary.regime, summary.period, summary.settled), (Regime::Interwell, Some(1), Some(true)));
    assert_eq!(summary.crossings, 2 * summary.periods);
}

/// The least amplitude of the base's acceleration in g, from rest, of a scene with fields changed; `range` is
/// searched in steps of 0.01 g.
fn least(onset: Onset, name: &str, changes: &[&str], range: Range<f64>) -> f64 {
    let document = changed(name, changes);
    let steps = ((range.end - range.start) / 0.01).round() as u32;
    let values = (0..=steps).map(|i| range.start + 0.01 * f64::from(i)).collect();
    let scan =
        Scan { field: "excitation.amplitude_g".to_owned(), values, resolution: 1e-4, until_settled: None };
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let found = threshold(&document.scene, &mechanism(&document), &document.files, &scan, onset, &task);
    found.unwrap().value.unwrap()
}

/// Asserts that a value lies in a range.
#[track_caller]
fn within(value: f64, range: Range<f64>) {
    assert!(range.contains(&value), "{value:?} is not in {range:?}");
}

/// The RMS velocity in mm/s.
fn rms(summary: &Summary) -> f64 {
    1e3 * summary.rms_velocity.unwrap()
}

/// The largest displacement from the middle in mm.
fn reach(summary: &Summary) -> f64 {
    1e3 * summary.max_abs_x.unwrap()
}
