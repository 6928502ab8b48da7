//! Sentence about a driven motion.

use std::collections::VecDeque;

use crate::dynamics::{
    Event, EventKind, First, Firsts, Model, Outcome, Place, Regime, STANDARD_GRAVITY, Summary,
};
use crate::scene::{Excitation, Scene, Stops};
use interwell_studies::study::Thresholds;

use super::super::numbers::{as_set, between, grams, length_beside, limit_mm, power, seconds, speed, times};
use super::super::wells::wells_between;
use super::remedy::{amplitude, in_unit, remedy};
use super::{Kind, Sentence, ended};

/// Forcing periods of a motion that have to be drawn before it is described in the present tense.
const SEEN_PERIODS: f64 = 3.0;

/// Forcing periods within which a motion seems to settle at once.
const AT_ONCE: f64 = 5.0;

/// Forcing periods after which another motion on the screen than the forecast is not taken for its beginning.
const REFUTED_PERIODS: f64 = 30.0;

/// The facts for the sentence about a driven motion.
#[derive(Debug, Clone, Copy)]
pub struct DrivenMotion<'a> {
    pub scene: &'a Scene,
    pub model: &'a Model,
    pub summary: &'a Summary,
    /// Its thresholds; `None` until they are known.
    pub thresholds: Option<&'a Thresholds>,
    /// Live time in s at which the run of the summary began.
    pub origin: f64,
    pub now: f64,
    /// The present displacement in m.
    pub x: f64,
    /// What has been on the screen.
    pub events: &'a VecDeque<Event>,
    /// Live time in s up to which the path is reliable; `None` while that is not known.
    pub trusted_to: Option<f64>,
}

impl DrivenMotion<'_> {
    /// Live time in s from which on the described motion has been on the screen.
    pub fn seen_from(&self) -> f64 {
        let summary = self.summary;
        let Some(period) = self.model.forcing_period().filter(|_| self.model.repeats()) else {
            return self.origin + summary.window.1;
        };
        let periods = match (summary.regime, summary.settles_at) {
            (Regime::Rest, Some(at)) => at / period,
            (_, settles_at) => settles_at.unwrap_or(0.0) / period + self.seen_periods(),
        };
        self.origin + periods * period
    }

    /// Forcing periods that have to be drawn to see the described motion.
    fn seen_periods(&self) -> f64 {
        SEEN_PERIODS.max(f64::from(self.summary.period.unwrap_or(1)))
    }

    fn is_seen(&self) -> bool {
        self.now >= self.seen_from() && self.is_as_drawn()
    }

    /// Whether the last periods on the screen have crossings as the described motion has, or none on its side
    /// of the barrier.
    fn is_as_drawn(&self) -> bool {
        let Some(period) = self.model.forcing_period().filter(|_| self.model.repeats()) else { return true };
        let settled = self.origin + self.summary.settles_at.unwrap_or(0.0);
        let since = settled.max(self.now - self.seen_periods() * period);
        let mut last = self.events.iter().rev().take_while(|event| event.t > since);
        let has_crossed = last.any(|event| event.kind == EventKind::Crossing);
        match self.summary.regime {
            Regime::Interwell => has_crossed,
            Regime::Rest | Regime::Intrawell => !has_crossed && self.is_on_its_side(),
            _ => true,
        }
    }

    fn is_on_its_side(&self) -> bool {
        let Some(barrier) = self.model.mechanism().landscape.barrier else { return true };
        match self.summary.side {
            Some(Place::Left) => self.x <= barrier.x,
            Some(Place::Right) => self.x >= barrier.x,
            _ => true,
        }
    }

    /// Whether the motion on the screen has become another one than the forecast, which no path that loses
    /// its accuracy on the way can exclude.
    pub fn is_refuted(&self) -> bool {
        let Summary { settles_at, window, .. } = self.summary;
        // a motion that does not settle is judged by its window, before which it may do anything
        let period = self.model.forcing_period().unwrap_or(0.0);
        let begin = if settles_at.is_some() { 0.0 } else { window.0.min(REFUTED_PERIODS * period) };
        self.now >= self.seen_from() + begin && !self.is_as_drawn()
    }

    /// The words of the present tense if the motion has been on the screen, otherwise those of the future.
    fn tense(&self, present: &'static str, future: &'static str) -> &'static str {
        if self.is_seen() { present } else { future }
    }

    /// The word before a forecast for the live time `t` in s, unless the path can be trusted up to then.
    fn about(&self, t: f64) -> &'static str {
        if t <= self.now || self.trusted_to.is_some_and(|trusted| t <= trusted) { "" } else { "about " }
    }

    /// From when on the motion is settled, in words; empty if it already is or settles at once.
    fn settling_time(&self) -> String {
        let period = self.model.forcing_period().unwrap_or(0.0);
        let late = |at: &f64| *at > AT_ONCE * period && self.now < self.origin + *at;
        let Some(at) = self.summary.settles_at.filter(late) else { return String::new() };
        let t = self.origin + at;
        match self.about(t) {
            "" => format!(" from {} on", seconds(t)),
            // the time differs from try to try
            _ => " in the end".to_owned(),
        }
    }

    /// What is known of a motion that has not settled; empty if it has.
    fn unsettled(&self) -> String {
        let Summary { settled, regime, steady, window, .. } = self.summary;
        let after = seconds(window.1);
        match (settled, regime, steady) {
            (Some(false), Regime::Irregular, Some(true)) => " Its averages are steady.".to_owned(),
            (Some(false), Regime::Irregular, Some(false)) => " Its averages drift.".to_owned(),
            // its averages are steady: the numbers say "about"
            (Some(false), _, Some(true)) => format!(" It does not repeat within {after}."),
            (Some(false), ..) => format!(" Not settled after {after}."),
            _ => String::new(),
        }
    }
}

pub fn driven(facts: &DrivenMotion) -> Sentence {
    let DrivenMotion { scene, model, summary, .. } = *facts;
    if summary.outcome != Outcome::Done {
        return ended(model, summary.outcome);
    }
    if let (Excitation::AmplitudeRamp { .. }, Some(firsts)) = (&scene.excitation, &summary.firsts) {
        return ramped(facts, firsts);
    }
    let (Some(rms), Some(reach), Some((low, high))) =
        (summary.rms_velocity, summary.max_abs_x, summary.range)
    else {
        return Sentence::new(Kind::Other, "The run is too short to settle.");
    };
    // the averages of a motion that does not repeat depend on the window
    let about = if summary.period.is_some() || summary.regime == Regime::Rest { "" } else { "about " };
    let rms = format!("RMS velocity {about}{} mm/s", speed(rms));
    let load = summary.harvest.and_then(|harvest| harvest.mean_load_power);
    let rms = match load.filter(|_| model.has_transducer()) {
        Some(load) => format!("{about}{} into the load, {rms}", power(load)),
        None => rms,
    };
    let stops = model.stop_positions();
    let range = between(low, high, stops);
    // the side of the touched stop; if both are touched or neither, the side of the barrier
    let side = match (stops.0 == Some(low), stops.1 == Some(high), summary.side) {
        (true, false, _) | (true, true, Some(Place::Left)) | (false, false, Some(Place::Left)) => "left-hand",
        _ => "right-hand",
    };
    let well = wells_between(&model.mechanism().landscape, low, high);
    let stays = facts.tense("stays", "will stay");
    let swings = facts.tense("swings", "will swing");
    let crosses = facts.tense("crosses", "will cross");
    // the mass may come from the other well
    let settles = if summary.is_transient() { swings } else { facts.tense("stays", "will settle") };
    let never = if summary.is_transient() { "without" } else { "never" };
    let periods = summary.periods as f64;
    let per_period = |count: u64| count as f64 / periods.max(1.0);
    let from = facts.settling_time();
    let text = match summary.regime {
        Regime::OneWell if model.mechanism().landscape.right_stable().is_none() => {
            format!("No barrier: {} {range}; {rms}.", facts.tense("moves", "will move"))
        }
        Regime::OneWell => {
            let symmetric = (low + high).abs() < 0.02 * reach;
            let swing = if symmetric { format!("±{}", length_beside(reach, stops)) } else { range };
            format!("No barrier: one well, so nothing to cross; {swings} {swing}, {rms}.")
        }
        Regime::Rest if scene.stops == Stops::None => format!("Resting: {stays} where it is{from}."),
        Regime::Rest => {
            let push = amplitude(scene).map_or_else(|| "this".to_owned(), |g| in_unit(scene, as_set, g));
            let frees = facts.tense("never frees it", "will never free it");
            format!("Resting: {stays} pressed on the {side} stop{from}; {push} {frees}.")
        }
        Regime::Crossing | Regime::Intrawell if !model.repeats() => {
            return unrepeated(facts, &rms, &range, &well);
        }
        Regime::Intrawell if summary.releases > 0 => {
            let every = match summary.release_periods {
                all if all >= summary.periods => "every period".to_owned(),
                some => format!("in {some} of {periods:.0} periods"),
            };
            let in_impacts = match (summary.impacts as f64 / summary.releases as f64).round() {
                1.0 => "in one impact".to_owned(),
                count => format!("in {count:.0} impacts"),
            };
            let (leaves, falls) = (facts.tense("leaves", "will leave"), facts.tense("falls", "fall"));
            format!(
                "Hopping: {leaves} the {side} stop {every}{from} and {falls} back {in_impacts}, {never} \
                 crossing; {rms}."
            )
        }
        Regime::Intrawell if summary.impacts > 0 => {
            let (hits, impacts) = (facts.tense("hits", "hit"), times(per_period(summary.impacts)));
            format!("Intrawell: {settles} in the {well}{from} and {hits} its stop {impacts}; {rms}.")
        }
        Regime::Intrawell => format!("Intrawell: {settles} in the {well}{from}, {range}; {rms}."),
        Regime::Irregular if summary.crossing_periods >= summary.periods => {
            format!("Irregular: {crosses} in every period, never twice alike; {rms}.")
        }
        Regime::Irregular => format!(
            "Irregular: {crosses} in {}{} of {periods:.0} periods, without a rhythm; {rms}, reach about {}.",
            facts.about(facts.origin + summary.window.1),
            summary.crossing_periods,
            length_beside(reach, stops)
        ),
        Regime::Interwell | Regime::Crossing => interwell(facts, crosses, &rms, &range),
    };
    let text = format!("{text}{}{}", facts.unsettled(), untouched(facts));
    let mut sentence = Sentence::new(Kind::from(summary.regime), text);
    if let Some(found) = facts.thresholds {
        sentence.remedy = remedy(scene, summary, found);
    }
    sentence
}

fn interwell(facts: &DrivenMotion, crosses: &str, rms: &str, range: &str) -> String {
    let DrivenMotion { model, summary, .. } = *facts;
    let rate = summary.crossings as f64 / summary.periods.max(1) as f64;
    let from = facts.settling_time();
    let how = match summary.period {
        Some(n) if n > 1 && summary.crossing_periods >= summary.periods => {
            let repeats = facts.tense("repeats", "repeat");
            format!("{crosses} every period{from} and {repeats} after {n} periods")
        }
        Some(n) if n > 1 => {
            let (count, repeats) = ((rate * f64::from(n)).round(), facts.tense("repeats", "repeat"));
            format!("{crosses} {count:.0} times in {n} periods{from} and then {repeats}")
        }
        Some(_) => format!("{crosses} {}{from}", times(rate)),
        None => format!("{crosses} {}{from}, each time a little differently", times(rate)),
    };
    let (left, right) = model.stop_positions();
    let equal = left.zip(right).filter(|(left, right)| *left == -*right);
    let share = summary.impact_share.filter(|_| summary.impacts > 0).map(|share| share * 100.0);
    let place = match (equal, share) {
        (Some((_, limit)), Some(_)) => format!("from stop to stop at ±{} mm", limit_mm(limit * 1e3)),
        (None, Some(_)) => range.to_owned(),
        (_, None) => {
            format!("reaching {}", length_beside(summary.max_abs_x.unwrap_or(0.0), (left, right)))
        }
    };
    let impacts = share.map_or_else(String::new, |share| format!(", impacts take {share:.0} % of the work"));
    format!("Interwell: {how}, {place}; {rms}{impacts}.")
}

/// The sentence about a motion under a drive without a period: what it does in the settled window.
fn unrepeated(facts: &DrivenMotion, rms: &str, range: &str, well: &str) -> Sentence {
    let summary = facts.summary;
    let (from, to) = (facts.origin + summary.window.0, facts.origin + summary.window.1);
    let (seen, when) = (facts.is_seen(), format!("from {} to {}", seconds(from), seconds(to)));
    let (kind, text) = if summary.crossings == 0 {
        let stays = if seen { "stayed" } else { "will stay" };
        (Kind::Intrawell, format!("Intrawell: {stays} in the {well} {when}, {range}; {rms}."))
    } else {
        let crosses = if seen { "passed the barrier" } else { "will pass the barrier" };
        let count = match summary.crossings {
            1 => "once".to_owned(),
            n => format!("{}{n} times", facts.about(to)),
        };
        (Kind::Crossing, format!("Crossing: {crosses} {count} {when}; {rms}."))
    };
    Sentence::new(kind, format!("{text}{}", untouched(facts)))
}

/// The sentence about an amplitude ramp: when the mass is released, first crosses, crosses in every period.
fn ramped(facts: &DrivenMotion, firsts: &Firsts) -> Sentence {
    let DrivenMotion { model, summary, origin, now, .. } = *facts;
    let end = origin + summary.window.1;
    let about = |first: &First| facts.about(origin + first.t);
    let place = |first: &First| {
        let amplitude = first.amplitude.map(|accel| accel / STANDARD_GRAVITY);
        amplitude.map_or(String::new(), |g| format!("{}{} g, ", about(first), grams(g)))
    };
    let time = |first: &First| format!("{}{}", about(first), seconds(origin + first.t));
    let at = |first: &First| match place(first) {
        place if place.is_empty() => format!("after {}", time(first)),
        place => format!("at {place}after {}", time(first)),
    };
    let passed = |first: &Option<First>| first.is_some_and(|first| now >= origin + first.t);
    let kind = match firsts {
        _ if passed(&firsts.crossing) => Kind::Crossing,
        _ if firsts.release.is_some() && !passed(&firsts.release) => Kind::Resting,
        _ if summary.regime == Regime::Rest => Kind::Resting,
        _ => Kind::Intrawell,
    };
    let mut parts = Vec::new();
    let stopped = summary.total_impacts > 0 || summary.rests > 0 || summary.regime == Regime::Rest;
    let is_over = now >= end;
    let tense = |is_past: bool, past: &'static str, future: &'static str| if is_past { past } else { future };
    if let Some(first) = &firsts.release {
        let released = tense(passed(&firsts.release), "was first released", "will first be released");
        parts.push(format!("{released} {}", at(first)));
    } else if stopped && model.stop_positions() != (None, None) && firsts.crossing.is_none() {
        parts.push(tense(is_over, "was never released", "will never be released").to_owned());
    }
    let always = &firsts.crossing_in_every_period;
    if let Some(first) = &firsts.crossing {
        let has_crossed = passed(&firsts.crossing);
        let crosses = tense(has_crossed, "first crossed", "will first cross");
        let (crosses, rest) = match always {
            Some(always) if first == always => {
                let crosses = tense(has_crossed, "crossed", "will cross");
                (crosses, ", and in every period from then on".to_owned())
            }
            Some(always) => (crosses, format!("; in every period from {}{} on", place(always), time(always))),
            None => (crosses, String::new()),
        };
        parts.push(format!("{crosses} {}{rest}", at(first)));
    } else {
        parts.push(tense(is_over, "never crossed", "will never cross").to_owned());
    }
    let until = if always.is_some() { String::new() } else { format!(" up to {}", seconds(end)) };
    Sentence::new(kind, format!("Growing shaking: {}{until}.", parts.join("; ")))
}

/// The sentence that the motion never touches the stops; empty if it does or there are none.
fn untouched(facts: &DrivenMotion) -> String {
    let summary = facts.summary;
    let touched = summary.impacts > 0 || summary.rested_share.is_none_or(|share| share > 0.0);
    let rests = summary.regime == Regime::Rest;
    if touched || rests || facts.model.stop_positions() == (None, None) {
        return String::new();
    }
    match facts.scene.stops.limits_mm() {
        [Some(left), Some(right)] if left == right => {
            format!(" Stops at ±{} mm are not touched.", limit_mm(right))
        }
        _ => " The stops are not touched.".to_owned(),
    }
}
