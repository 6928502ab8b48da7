//! What does the mass do, in one sentence?
//!
//! name: what the mass does; number; what it would take. Every number comes from a run. g with two decimals, mm with one,
//! mm/s whole, below 10 with one; counts per forcing period, per second where there is none.

use crate::dynamics::{Model, Outcome, Regime, Sample, Side};
use crate::scene::Scene;
use crate::study::{Settled, Standing, Thresholds, standing};

use super::session::stop_distances;

/// What kind of motion a sentence is about: its colour and its shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// At rest, or pressed on a stop.
    Resting,
    /// Stays in a well.
    Intrawell,
    /// Crosses without rhythm.
    Irregular,
    /// Crosses and repeats.
    Interwell,
    /// Anything that has no such name.
    Other,
    /// The scene cannot be run, or the run has ended.
    Fault,
}

/// What the status line says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sentence {
    /// What kind of motion it is.
    pub kind: Kind,
    /// The sentence.
    pub text: String,
    /// What it would take, said once it has been searched for; a lesson may keep it to itself.
    pub remedy: String,
}

/// Whether what is told has been seen already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tense {
    /// It is so.
    Present,
    /// It will be so.
    Future,
}

impl Sentence {
    fn new(kind: Kind, text: impl Into<String>) -> Self {
        Self { kind, text: text.into(), remedy: String::new() }
    }

    /// A scene that cannot be run; the first of its faults.
    pub fn fault(error: &str) -> Self {
        let first = error.lines().next().unwrap_or(error);
        Self::new(Kind::Fault, format!("This scene cannot run: {first}"))
    }

    /// While the first answer is still to come.
    pub fn waiting() -> Self {
        Self::new(Kind::Other, "Working out what this settles to.")
    }

    /// The whole of it.
    pub fn whole(&self) -> String {
        if self.remedy.is_empty() { self.text.clone() } else { format!("{} {}", self.text, self.remedy) }
    }
}

/// Speed in mm/s: whole, below 10 with one decimal.
pub fn speed(m_per_s: f64) -> String {
    let mm = m_per_s * 1e3;
    if mm > 0.0 && mm < 0.05 {
        return "below 0.1".to_owned();
    }
    if mm < 9.95 { format!("{mm:.1}") } else { format!("{mm:.0}") }
}

/// Length in mm: one decimal, two below 1 mm.
pub fn mm(m: f64) -> String {
    // -0.0 is no place
    let tenths = (m * 1e4).round() / 10.0 + 0.0;
    if tenths == 0.0 || m.abs() >= 0.95e-3 { format!("{tenths:.1}") } else { format!("{:.2}", m * 1e3) }
}

/// A travel limit in mm as it was set: one decimal, or the two that a slider has.
fn limit_mm(mm: f64) -> String {
    let text = format!("{mm:.2}");
    match text.strip_suffix('0') {
        Some(short) => short.to_owned(),
        None => text,
    }
}

fn energy(j: f64) -> String {
    format!("{:.2} mJ", j.max(0.0) * 1e3)
}

fn hand(side: Side) -> &'static str {
    if side == Side::Left { "left-hand" } else { "right-hand" }
}

fn times(count: f64) -> String {
    if count < 0.1 {
        return "less than once in ten periods".to_owned();
    }
    let rare = (1.0 / count).round();
    match count {
        c if rare > 1.0 && (1.0 / c - rare).abs() < 0.05 * rare => format!("once in {rare:.0} periods"),
        c if (c - 1.0).abs() < 0.05 => "once a period".to_owned(),
        c if (c - 2.0).abs() < 0.05 => "twice a period".to_owned(),
        c if (c - c.round()).abs() < 0.05 => format!("{c:.0} times a period"),
        c => format!("{c:.1} times a period"),
    }
}

/// The mass held by hand.
pub fn held(model: &Model, state: &Sample) -> Sentence {
    let force = model.mechanism.curve.force(state.x);
    let middle = model.mechanism.landscape.barrier.map_or(0.0, |barrier| barrier.x);
    let outward = (state.x - middle) * force < 0.0;
    let (place, size) = (mm(state.x), force.abs());
    let text = if size < 5e-4 {
        format!("Held at {place} mm: nothing pulls.")
    } else {
        let way = if outward { "outwards" } else { "inwards" };
        format!("Held at {place} mm: it pulls back {way} with {size:.2} N.")
    };
    Sentence::new(Kind::Other, text)
}

/// A run that has ended by itself.
pub fn ended(model: &Model, outcome: Outcome) -> Sentence {
    let at = outcome.ended_at().unwrap_or(0.0);
    let domain = model.mechanism.curve.domain();
    let why = match outcome {
        Outcome::LeftTable { .. } => {
            let end = mm(domain.0.abs().min(domain.1));
            if model.mechanism.flexures.is_some() {
                return Sentence::new(
                    Kind::Fault,
                    format!(
                        "The run ended at {at:.2} s: the mass went beyond what was solved of the flexures, which ends at \
                         {end} mm. Set stops inside it, or shake less."
                    ),
                );
            }
            format!(
                "the mass left the force table, which ends at {end} mm. Set stops inside it or extend the table."
            )
        }
        Outcome::ImpactBudget { count, .. } => {
            format!("{count} impacts are more than it may make. Lower the restitution.")
        }
        Outcome::StepBudget { .. } => {
            "it took more work than it may take. Use a larger tolerance.".to_owned()
        }
        Outcome::NotFinite { .. } => {
            "the mass went beyond all bounds. Set stops, or a force that holds it.".to_owned()
        }
        Outcome::Inaccurate { .. } => {
            return Sentence::new(Kind::Fault, "The energy does not balance. Use a smaller tolerance.");
        }
        Outcome::Cancelled { .. } | Outcome::Done => "it was stopped.".to_owned(),
    };
    Sentence::new(Kind::Fault, format!("The run ended at {at:.2} s: {why}"))
}

/// Nothing shakes the base.
pub fn unshaken(model: &Model, state: &Sample) -> Sentence {
    let still = state.v.abs() < 1e-4 * model.scales.speed;
    let Some(Standing { side, pressed_n, energy_j, needed_j }) = standing(model, state) else {
        let text = if still {
            "At rest; nothing shakes it.".to_owned()
        } else {
            format!("Moving at {} mm/s; nothing shakes it.", speed(state.v.abs()))
        };
        return Sentence::new(if still { Kind::Resting } else { Kind::Other }, text);
    };
    let (hand, needed) = (hand(side), energy(needed_j));
    let lift = format!("nothing shakes it. {needed} would lift it over the barrier.");
    match pressed_n {
        Some(force) => {
            Sentence::new(Kind::Resting, format!("Pressed on the {hand} stop with {force:.2} N; {lift}"))
        }
        None if still && energy_j < 1e-3 * needed_j => {
            Sentence::new(Kind::Resting, format!("At rest in the {hand} well; {lift}"))
        }
        None if energy_j < needed_j => {
            let left = energy(energy_j);
            let text =
                format!("Ringing down in the {hand} well: {left} of energy left, {needed} needed to cross.");
            Sentence::new(Kind::Intrawell, text)
        }
        None => {
            let left = energy(energy_j);
            let text = format!(
                "Ringing down over both wells: {left} of energy left, below {needed} it stays in one."
            );
            Sentence::new(Kind::Other, text)
        }
    }
}

/// The words of a tense.
struct Words {
    stays: &'static str,
    leaves: &'static str,
    falls: &'static str,
    crosses: &'static str,
    swings: &'static str,
    hits: &'static str,
}

const NOW: Words = Words {
    stays: "stays",
    leaves: "leaves",
    falls: "falls",
    crosses: "crosses",
    swings: "swings",
    hits: "hits",
};
const SOON: Words = Words {
    stays: "will stay",
    leaves: "will leave",
    falls: "fall",
    crosses: "will cross",
    swings: "will swing",
    hits: "hit",
};

/// A shaken mass, by what its motion settles to.
pub fn driven(
    scene: &Scene,
    model: &Model,
    settled: &Settled,
    thresholds: Option<&Thresholds>,
    tense: Tense,
) -> Sentence {
    let summary = &settled.summary;
    if summary.outcome != Outcome::Done {
        return ended(model, summary.outcome);
    }
    let words = if tense == Tense::Future { &SOON } else { &NOW };
    let (Some(rms), Some(reach), Some(range)) = (summary.rms_velocity, summary.max_abs_x, settled.range)
    else {
        return Sentence::new(Kind::Other, "The run is too short to settle.");
    };
    let rms_text = format!("RMS velocity {} mm/s", speed(rms));
    let periods = settled.periods.filter(|periods| *periods >= 1.0);
    let per_period = |count: u64| periods.map_or(0.0, |periods| count as f64 / periods);
    let right = summary.final_x >= model.mechanism.landscape.barrier.map_or(0.0, |barrier| barrier.x);
    let side = hand(if right { Side::Right } else { Side::Left });
    let untouched = untouched(scene, model, settled);
    let push = amplitude(scene);
    let mut sentence = match (summary.regime, periods) {
        (Regime::OneWell, _) if model.mechanism.landscape.right_stable().is_none() => {
            let text = format!("No well: moves between {} and {} mm; {rms_text}.", mm(range.0), mm(range.1));
            Sentence::new(Kind::Other, text)
        }
        (Regime::OneWell, _) => {
            let symmetric = (range.0 + range.1).abs() < 0.02 * reach;
            let swing = if symmetric {
                format!("±{} mm", mm(reach))
            } else {
                format!("between {} and {} mm", mm(range.0), mm(range.1))
            };
            let text = format!(
                "One well: there is no barrier, so nothing to cross; {} {swing}, {rms_text}.",
                words.swings
            );
            Sentence::new(Kind::Other, text)
        }
        (Regime::Rest, _) => {
            let what = if scene.stops == crate::scene::Stops::None {
                format!("Resting: {} where it is.", words.stays)
            } else {
                let never =
                    push.map_or_else(|| "this never frees it".into(), |g| format!("{g:.2} g never frees it"));
                format!("Resting: pressed on the {side} stop all the time; {never}.")
            };
            Sentence::new(Kind::Resting, what)
        }
        (_, None) => {
            let text = if summary.crossings == 0 {
                format!(
                    "Intrawell: {} in the {side} well, between {} and {} mm; {rms_text}.",
                    words.stays,
                    mm(range.0),
                    mm(range.1)
                )
            } else {
                let (cross, count) =
                    (if tense == Tense::Future { "Will cross" } else { "Crossed" }, summary.crossings);
                format!("{cross} {count} times in {:.0} s; {rms_text}.", settled.window)
            };
            Sentence::new(if summary.crossings == 0 { Kind::Intrawell } else { Kind::Irregular }, text)
        }
        (Regime::Intrawell, Some(periods)) if summary.releases > 0 => {
            let every = if settled.release_periods as f64 >= periods {
                "every period".to_owned()
            } else {
                format!("in {} of {periods:.0} periods", settled.release_periods)
            };
            let impacts = per_period(summary.impacts);
            let text = format!(
                "Hopping: {} the {side} stop {every} and {} back, never crossing; {rms_text}, {impacts:.0} impacts a period.",
                words.leaves, words.falls
            );
            Sentence::new(Kind::Intrawell, text)
        }
        (Regime::Intrawell, _) if summary.impacts > 0 => {
            let text = format!(
                "Intrawell: {} in the {side} well and {} its stop {}; {rms_text}.",
                words.stays,
                words.hits,
                times(per_period(summary.impacts))
            );
            Sentence::new(Kind::Intrawell, text)
        }
        (Regime::Intrawell, _) => {
            let text = format!(
                "Intrawell: {} in the {side} well, between {} and {} mm; {rms_text}.",
                words.stays,
                mm(range.0),
                mm(range.1)
            );
            Sentence::new(Kind::Intrawell, text)
        }
        (Regime::Irregular, Some(periods)) if settled.crossing_periods as f64 >= periods => {
            let text =
                format!("Irregular: {} in every period, never twice alike; {rms_text}.", words.crosses);
            Sentence::new(Kind::Irregular, text)
        }
        (Regime::Irregular, Some(periods)) => {
            let text = format!(
                "Irregular: {} in {} of {periods:.0} periods, with no lasting rhythm; {rms_text}, reach {} mm.",
                words.crosses,
                settled.crossing_periods,
                mm(reach)
            );
            Sentence::new(Kind::Irregular, text)
        }
        (Regime::Interwell, Some(periods)) => {
            let rate = per_period(summary.crossings);
            let how = match summary.period {
                Some(n) if n > 1 && settled.crossing_periods as f64 >= periods => {
                    format!("{} every period and repeats after {n} periods", words.crosses)
                }
                Some(n) if n > 1 => {
                    let count = (rate * f64::from(n)).round();
                    format!("{} {count:.0} times in {n} periods and then repeats", words.crosses)
                }
                _ => format!("{} {}", words.crosses, times(rate)),
            };
            let (left, right) = model.stop_positions();
            let stopped = summary.impacts > 0;
            let equal = left.zip(right).filter(|(left, right)| *left == -*right);
            let text = match (stopped, equal, summary.impact_share) {
                (true, Some((_, limit)), Some(share)) => format!(
                    "Interwell: {how}, from stop to stop at ±{} mm; {rms_text}, impacts take {:.0} % of the work.",
                    limit_mm(limit * 1e3),
                    share * 100.0
                ),
                (true, _, Some(share)) => format!(
                    "Interwell: {how}, between {} and {} mm; {rms_text}, impacts take {:.0} % of the work.",
                    mm(range.0),
                    mm(range.1),
                    share * 100.0
                ),
                _ => format!("Interwell: {how}, reaching {} mm; {rms_text}.", mm(reach)),
            };
            Sentence::new(Kind::Interwell, text)
        }
    };
    if is_swept(scene) {
        // the shaking grows until then: what it settles to is its end
        let from = format!(" from {:.0} s on:", model.settle());
        sentence.text = sentence.text.replacen(':', &from, 1);
    }
    if let Some(untouched) = untouched {
        sentence.text = format!("{} {untouched}", sentence.text);
    }
    if let (Some(found), Some(g)) = (thresholds, push) {
        sentence.remedy = remedy(scene, summary.regime, summary.releases > 0, g, found);
    }
    sentence
}

/// What it would take, from rest at this frequency.
fn remedy(scene: &Scene, regime: Regime, hops: bool, g: f64, found: &Thresholds) -> String {
    let stopped = scene.stops != crate::scene::Stops::None;
    let short = |to: f64| {
        if stopped {
            format!("{:.2} g short of crossing.", to - g)
        } else {
            // there are windows above the first one: no sharp number
            format!("About {:.1} g short of crossing.", (to - g).max(0.1))
        }
    };
    match (regime, found) {
        (Regime::Rest, Thresholds { frees_at: Some(frees), crosses_at: Some(crosses), .. }) => {
            format!("Frees at {frees:.2} g, crosses at {crosses:.2} g.")
        }
        (Regime::Intrawell, Thresholds { crosses_at: Some(crosses), .. }) if hops || *crosses > g => {
            short(*crosses)
        }
        (Regime::Interwell, Thresholds { crosses_from: Some(from), .. }) if stopped && *from < g => {
            format!("{:.2} g to spare.", g - from)
        }
        (Regime::Interwell | Regime::Irregular, Thresholds { crosses_from: Some(from), .. })
            if !stopped && g - from > 0.05 =>
        {
            format!("About {:.1} g to spare.", g - from)
        }
        _ => String::new(),
    }
}

/// What it would take to cross, or to cross every period: more shaking or stops, where they were searched for.
///
/// `stops_mm` is the travel limit that [`study::stops_that_cross`](crate::study::stops_that_cross) found.
pub fn ways(scene: &Scene, settled: &Settled, thresholds: &Thresholds, stops_mm: Option<f64>) -> String {
    let Some(g) = amplitude(scene) else { return String::new() };
    let stopped = scene.stops != crate::scene::Stops::None;
    let stops = stops_mm.map(|limit| format!("with stops at ±{} mm", at_least_one_decimal(limit)));
    match settled.summary.regime {
        Regime::OneWell => "There is no barrier, so nothing to cross.".to_owned(),
        Regime::Interwell => "It crosses already, again and again in the same way.".to_owned(),
        Regime::Irregular => match stops {
            Some(stops) => format!("Crosses in the same way every time {stops}."),
            None => "It crosses already, if not regularly.".to_owned(),
        },
        Regime::Rest | Regime::Intrawell => {
            let more = thresholds.crosses_at.filter(|at| *at > g).map(|at| match stopped {
                true => format!("with {:.2} g more", at - g),
                false => format!("with about {:.1} g more", (at - g).max(0.1)),
            });
            match (more, stops) {
                (Some(more), Some(stops)) => format!("Crosses {more}, or {stops}."),
                (Some(more), None) => format!("Crosses {more}; no stops alone would do it."),
                (None, Some(stops)) => format!("Crosses {stops}."),
                (None, None) => "Neither 2 g more nor any stops would make it cross.".to_owned(),
            }
        }
    }
}

/// A decimal with one place, or as many as it has.
fn at_least_one_decimal(mm: f64) -> String {
    let text = format!("{mm}");
    if text.contains('.') { text } else { format!("{mm:.1}") }
}

/// Whether the shaking itself changes on the way.
pub fn is_swept(scene: &Scene) -> bool {
    use crate::scene::Excitation::{AmplitudeRamp, Chirp};
    matches!(scene.excitation, AmplitudeRamp { .. } | Chirp { .. })
}

/// How far into the settled window in s a motion is to be seen before its sentence speaks of the present: a shaking that
/// changes has to come to the window, one without a period to its end.
pub fn seen_after(scene: &Scene, settled: &Settled) -> f64 {
    if is_swept(scene) { 0.0 } else { settled.window }
}

fn amplitude(scene: &Scene) -> Option<f64> {
    match scene.excitation {
        crate::scene::Excitation::Sine { amplitude_g, .. } => Some(amplitude_g.abs()),
        _ => None,
    }
}

/// Stops that the motion never reaches.
fn untouched(scene: &Scene, model: &Model, settled: &Settled) -> Option<String> {
    let summary = &settled.summary;
    let touched = summary.impacts > 0 || summary.rested_share.is_none_or(|share| share > 0.0);
    let rests = summary.regime == Regime::Rest;
    if touched || rests || model.stop_positions() == (None, None) {
        return None;
    }
    match stop_distances(scene) {
        (Some(left), Some(right)) if left == -right => {
            Some(format!("Stops at ±{} mm are not touched.", limit_mm(right)))
        }
        _ => Some("The stops are not touched.".to_owned()),
    }
}
