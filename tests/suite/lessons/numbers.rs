//! Numbers in the texts of the lessons, each measured anew on the lesson's own scene.
//!
//! A claim writes the words as they stand in the text with the measured number in them, with as many digits
//! as the text has. Numbers that depend on rounding are held within what the words allow.

mod more;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Model, Outcome, Regime, Request, STANDARD_GRAVITY, Summary};
use interwell::scene::lesson::{LESSONS, LessonDocument, Step};
use interwell::scene::{Document, FieldPath};
use interwell_studies::study::{Onset, Scan, Task, result_fields, threshold};

use super::super::support::*;

/// All that a lesson says, and the scene with which it begins.
struct Told {
    name: &'static str,
    words: String,
    scene: Document,
}

impl Told {
    fn new(number: usize) -> Self {
        let lesson = &LESSONS[number - 1];
        let read = LessonDocument::load(lesson.name, &result_fields()).unwrap();
        let more = |step: &Step| match step {
            Step::Do { hint: Some(hint), .. } => format!(" {hint}"),
            Step::Predict { options, .. } => {
                options.iter().flat_map(|option| &option.reply).map(|reply| format!(" {reply}")).collect()
            }
            _ => String::new(),
        };
        let steps = read.lesson.steps.iter().map(|step| format!("{}{} ", step.text(), more(step)));
        let words = steps.collect::<String>() + &read.lesson.lecturer;
        Self { name: lesson.name, words, scene: read.begin(0).clone() }
    }

    /// The lesson says this, and what it says has been measured.
    #[track_caller]
    fn says(&self, claim: &str) {
        assert!(self.words.contains(claim), "{} does not say: {claim}\n{}", self.name, self.words);
    }

    /// Its scene with fields changed.
    fn changed(&self, changes: &[&str]) -> Document {
        let mut document = self.scene.clone();
        changes.iter().for_each(|change| document.set(change).unwrap());
        document
    }

    fn model(&self, changes: &[&str]) -> Model {
        build(&self.changed(changes))
    }

    /// What its scene with fields changed comes to.
    fn run(&self, changes: &[&str]) -> Summary {
        let summary = self.model(changes).run(&Request { ledger: true, ..Request::default() }).summary;
        assert_eq!(summary.outcome, Outcome::Done, "{} {changes:?}", self.name);
        summary
    }

    /// The least shaking in g, from rest, with which this happens.
    fn least(&self, onset: Onset, changes: &[&str], range: Range<f64>) -> f64 {
        let document = self.changed(changes);
        let steps = ((range.end - range.start) / 0.01).round() as u32;
        let values = (0..=steps).map(|i| range.start + 0.01 * f64::from(i)).collect();
        let scan = Scan {
            field: "excitation.amplitude_g".to_owned(),
            values,
            resolution: 1e-4,
            until_settled: None,
        };
        let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
        let found = threshold(&document.scene, &mechanism(&document), &document.files, &scan, onset, &task);
        found.unwrap().value.unwrap()
    }

    /// The force that presses the mass on a stop, in N.
    fn press(&self, limit_mm: f64) -> f64 {
        -self.model(&[]).mechanism().curve.force(1e-3 * limit_mm)
    }

    /// The height of the hill in J.
    fn hill(&self, changes: &[&str]) -> f64 {
        self.model(changes).mechanism().landscape.barrier.unwrap().from_right_j
    }
}

fn shaken(amplitude: f64) -> String {
    format!("excitation.amplitude_g={amplitude}")
}

fn stopped(limit_mm: f64) -> String {
    format!("stops=Rigid(travel_limit_mm: {limit_mm}, restitution: 0.36)")
}

/// The RMS velocity in mm/s.
fn rms(summary: &Summary) -> f64 {
    1e3 * summary.rms_velocity.unwrap()
}

/// The travel from end to end in mm.
fn travel(summary: &Summary) -> f64 {
    let (low, high) = summary.range.unwrap();
    1e3 * (high - low)
}

fn hops(summary: &Summary) -> bool {
    summary.regime == Regime::Intrawell && summary.releases > 0 && summary.crossings == 0
}

fn crosses(summary: &Summary) -> bool {
    summary.regime == Regime::Interwell
}

const MASS: f64 = 0.0152;

#[test]
fn wells_and_hill() {
    let told = Told::new(1);
    told.says(&format!("The hill is {:.2} mJ high", 1e3 * told.hill(&[])));
    let free = (2.0 * told.hill(&[]) / MASS).sqrt();
    told.says(&format!("Without damping a flick of {free:.2} m/s would just reach the top"));
    let flick = |v: f64| told.run(&[&format!("start.v_m_per_s=-{v}")]);
    let ends = |v: f64| (flick(v).crossings, flick(v).final_x > 0.0);
    assert_eq!((ends(0.365), ends(0.37), ends(0.44)), ((0, true), (1, false), (2, true)));
    told.says("at 0.37 m/s. Follow it in **Displacement**: it gets over the hill once");
    told.says("so that one crossing takes 0.37 m/s");
    told.says("a harder flick in the same direction, 0.44 m/s");
    assert_eq!((ends(0.473).0, ends(0.474).0, ends(0.5).0, ends(0.53).0), (2, 3, 3, 3));
    assert_eq!(ends(0.54), (4, true));
    told.says("any flick from 0.474 to 0.53 m/s does it");
    told.says("at 0.54 m/s it crosses four times");
}

#[test]
fn shaking() {
    let told = Told::new(2);
    told.says(&format!("(1 g is {STANDARD_GRAVITY:.2} m/s²)"));
    assert!((0.9..1.2).contains(&travel(&told.run(&[]))));
    told.says("from the one end of the motion to the other, is about 1 mm");
    let hard = told.run(&[&shaken(1.3)]);
    assert!((15.5..16.0).contains(&travel(&hard)));
    told.says("Its travel is nearly 16 mm");
    let from = told.least(Onset::Crossing, &[], 1.0..1.3);
    assert!((1.15..1.16).contains(&from), "{from}");
    told.says("From rest it begins to cross between 1.15 and 1.16 g");
    let below: Vec<f64> = [0.8, 1.0, 1.1, 1.12, 1.14, 1.15].map(|g| travel(&told.run(&[&shaken(g)]))).into();
    assert!(below.is_sorted() && below[5] > 3.5 && below[5] < 4.5, "{below:?}");
    told.says("Below that the travel is about 4 mm at most");
    assert!((15.5..16.0).contains(&travel(&told.run(&[&shaken(1.16)]))));
    told.says("just above, it jumps to nearly 16 mm");
    let extrema = told.model(&[]).mechanism().landscape.extrema.clone();
    let hardest = extrema.iter().fold(0.0_f64, |most, extremum| most.max(extremum.force));
    told.says(&format!("would need {:.2} g to get past the steepest", hardest / MASS / STANDARD_GRAVITY));
    for tolerance in ["run.tolerance=1e-9", "run.tolerance=1e-12"] {
        let request = Request { until_settled: Some(600.0), ..Request::default() };
        let summary =
            told.model(&["excitation.amplitude_g=1.3", "run.settle_s=0", tolerance]).run(&request).summary;
        assert_eq!((summary.regime, summary.period), (Regime::Interwell, Some(1)), "{tolerance}");
        let since = summary.settles_at.unwrap();
        assert!((3.0..600.0).contains(&since), "{since}");
    }
    told.says("goes over and back once in every period: the steady motion");
}

#[test]
fn stops_that_help() {
    let told = Told::new(3);
    let (low, high) = told.run(&[]).range.unwrap();
    told.says(&format!("between {:.1} and {:.1} mm", 1e3 * low, 1e3 * high));
    let well = told.model(&[]).mechanism().landscape.right_stable().unwrap().x;
    told.says(&format!("The bottom of the well, at {:.1} mm", 1e3 * well));
    told.says(&format!("halfway up the hill, with {:.3} N", told.press(4.0)));
    let share = -told.model(&[]).mechanism().curve.potential(4e-3) / told.hill(&[]);
    near(share, 0.5, 0.03);
    told.says(&format!("Shaking at 1 g pushes with {:.3} N at most", MASS * STANDARD_GRAVITY));
    told.says(&format!("at 1.5 mm with {:.3} N", told.press(1.5)));
    let at = |limit: f64| told.run(&[&stopped(limit)]);
    assert!([0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 2.1, 2.19].iter().all(|limit| crosses(&at(*limit))));
    assert!(hops(&at(2.2)));
    told.says("Stops out to 2.19 mm let it cross at 1 g; at 2.2 mm it leaves its stop and falls back");
    let open = told.least(Onset::Crossing, &[], 1.0..1.3);
    let from = |limit: f64| told.least(Onset::Crossing, &[&stopped(limit)], 1.0..1.6);
    assert!(from(2.6) < open && [2.7, 3.0, 4.0, 5.0, 6.0, 7.0, 7.15].iter().all(|limit| from(*limit) > open));
    told.says("from about 2.7 mm out to the wells at 7.2 mm the mass needs more shaking");
    let outer = told.model(&[]).mechanism().landscape.kink_at_right_well().unwrap().outer;
    let damping = 2.0 * 0.023 * (outer * MASS).sqrt();
    let damping = format!("damping=Coefficient(c_n_s_per_m: {damping:?})");
    let [open, below, above] = ["stops=None", &stopped(3.4), &stopped(3.6)]
        .map(|stops| told.least(Onset::Crossing, &[&damping, stops], 1.2..1.6));
    // that without stops depends on rounding
    assert!((1.395..1.425).contains(&open), "{open}");
    assert!(below < 1.395 && above > below + 0.02 && above > open - 0.01, "{below} {open} {above}");
    told.says("read by the slope outside, that begins between 3.4 and 3.6 mm");
    told.says(&format!("{:.3} N and {:.3} N", told.press(4.0), told.press(1.5)));
}

#[test]
fn release() {
    let told = Told::new(4);
    let press = told.press(2.0);
    told.says(&format!("presses the mass on its stop there: {press:.3} N"));
    let frees = told.least(Onset::Release, &[], 0.5..1.5);
    told.says(&format!("the push of a shaking of {frees:.3} g"));
    told.says(&format!("{press:.3} N over 15.2 g is {:.2} m/s², or {frees:.3} g", press / MASS));
    near(press / MASS / STANDARD_GRAVITY, frees, 1e-9);
    assert_eq!(told.run(&[]).regime, Regime::Rest);
    told.says("At 0.8 g the shaking cannot lift it off: it rests");
    let hop = told.run(&[&shaken(0.92)]);
    told.says("We shake at 0.92 g");
    let shown = LessonDocument::load(told.name, &result_fields()).unwrap();
    assert_eq!(FieldPath::new("excitation.amplitude_g").get(&shown.end(2).scene), Some(0.92));
    assert!(hops(&hop));
    told.says(&format!("leaves its stop by {:.2} mm and falls back", travel(&hop)));
    let from = |hz: f64| told.least(Onset::Crossing, &[&format!("excitation.frequency_hz={hz}")], 0.8..1.4);
    told.says(&format!(
        "It crosses from {:.3} g on, {:.0} % above",
        from(3.0),
        100.0 * (from(3.0) / frees - 1.0)
    ));
    told.says(&format!("at 0.5 Hz it crosses from {:.3} g on", from(0.5)));
    told.says(&format!("at 10 Hz, it takes {:.2} g", from(10.0)));
    told.says(&format!("The release is at {frees:.3} g in all three"));
    told.says(&format!("0.92 g is more than the {frees:.3} g with which the flexures press"));
    for hz in ["0.5", "10"] {
        let frequency = format!("excitation.frequency_hz={hz}");
        near(told.least(Onset::Release, &[&frequency], 0.5..1.5), frees, 1e-9);
    }
}

#[test]
fn price() {
    let told = Told::new(5);
    let at = |limit: f64| told.run(&[&stopped(limit)]);
    assert!(crosses(&at(1.5)));
    told.says(&format!("is {:.0} mm/s. A generator", rms(&at(1.5))));
    told.says(&format!("It falls to {:.0} mm/s", rms(&at(1.0))));
    let around = [2.0, 2.01, 2.02, 2.03, 2.04].map(|limit| rms(&at(limit)));
    assert!(around[..3].is_sorted() && around[2..].iter().rev().is_sorted(), "{around:?}");
    told.says(&format!("The best is {:.1} mm/s, at 2.02 mm", around[2]));
    told.says(&format!("{:.1} mm/s at 2.18 mm", rms(&at(2.18))));
    assert!(hops(&at(2.2)) && at(2.5).regime == Regime::Rest);
    told.says(&format!(
        "At 2.2 mm it no longer crosses, and hops at {:.0} mm/s. At 2.5 mm it rests",
        rms(&at(2.2))
    ));
    let weaker = |limit: f64| told.run(&[&stopped(limit), &shaken(0.95)]);
    assert!(crosses(&weaker(2.0)) && hops(&weaker(2.1)));
    told.says("at 0.95 g stops at 2.0 mm still cross, stops at 2.1 mm do not");
    told.says(&format!("stops at 2.1 mm hop at {:.1} mm/s", rms(&weaker(2.1))));
    told.says(&format!("stops at 2.0 mm still cross at {:.0} mm/s", rms(&weaker(2.0))));
    let request = Request { until_settled: Some(600.0), ..Request::default() };
    for tolerance in ["run.tolerance=1e-9", "run.tolerance=1e-11"] {
        let free = told.model(&["sweep=[]", "stops=None", &shaken(1.2), tolerance]).run(&request).summary;
        assert!(crosses(&free) && rms(&free) > 250.0, "{}", rms(&free));
    }
    let stops = told.run(&[&stopped(2.0), &shaken(1.2)]);
    told.says(&format!("at more than 250 mm/s without stops, at {:.0} mm/s with stops at 2 mm", rms(&stops)));
}
