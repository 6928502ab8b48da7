//! Models and runs of scenes, and comparisons that show their digits.

use interwell::dynamics::{Event, EventKind, Model, Request, Run};
use interwell::scene::{Document, Files};

pub use crate::shared::{build, changed, mechanism, preset};

/// The model of a scene's text, `title` left out.
pub fn model(text: &str) -> Model {
    let text = format!("(title: \"test\", {text})");
    build(&Document::from_text("test", &text, Files::default()).unwrap_or_else(|e| panic!("{e}\n{text}")))
}

/// The unit double well, m = 1, F = x^3 - x, with the other fields in `rest`.
pub fn unit_well(rest: &str) -> Model {
    model(&format!("mass_g: 1000, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), {rest}"))
}

/// The scene with this title in docs/scene.md.
#[track_caller]
pub fn documented(title: &str) -> Document {
    let blocks = include_str!("../../docs/scene.md").split("```ron\n").skip(1);
    let mut texts = blocks.map(|block| block.split("```").next().unwrap());
    let text = texts.find(|text| text.contains(&format!("title: \"{title}\""))).expect(title);
    Document::from_text(title, text, Files::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// A run with events and ledger.
pub fn run(model: &Model) -> Run {
    run_at(model, &[])
}

/// A run with events, ledger, and samples at `times`, ascending, all of which it must reach.
#[track_caller]
pub fn run_at(model: &Model, times: &[f64]) -> Run {
    let run = model.run(&Request { sample_times: times, events: true, ledger: true, ..Request::default() });
    assert_eq!(run.samples.len(), times.len(), "{:?}", run.summary.outcome);
    run
}

/// The events of one kind.
pub fn of_kind(run: &Run, kind: EventKind) -> Vec<Event> {
    run.events.iter().filter(|e| e.kind == kind).copied().collect()
}

/// `count` times, `step` apart, from `step` on.
pub fn every(step: f64, count: usize) -> Vec<f64> {
    (1..=count).map(|i| step * i as f64).collect()
}

/// Asserts |value - exact| <= bound.
#[track_caller]
pub fn near(value: f64, exact: f64, bound: f64) {
    let error = (value - exact).abs();
    assert!(error <= bound, "{value:?} is {error:.2e} from {exact:?}, allowed {bound:.1e}");
}

/// Asserts |value - exact| <= bound |exact|.
#[track_caller]
pub fn near_relative(value: f64, exact: f64, bound: f64) {
    let error = (value / exact - 1.0).abs();
    assert!(error <= bound, "{value:?} is {error:.2e} from {exact:?}, relatively; allowed {bound:.1e}");
}

/// Asserts that two runs are the same bit for bit in everything but the CPU time. Their texts tell 0 from -0.
#[track_caller]
pub fn same_bits(a: &Run, b: &Run) {
    let bare = |run: &Run| {
        let mut run = run.clone();
        run.summary.cpu_s = 0.0;
        run
    };
    let (a, b) = (bare(a), bare(b));
    assert_eq!(a, b);
    assert_eq!(format!("{a:?}"), format!("{b:?}"));
}

/// Numbers in [0, 1) that are the same everywhere (Steele and others 2014, splitmix64).
pub struct Draw(pub u64);

impl Draw {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}
