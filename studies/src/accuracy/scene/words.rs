//! Accuracy of a scene in sentences, the same for window and command line.

use super::{Course, Lateness, StepSize, TRUSTED_SHARE, Trust};
use crate::dynamics::Outcome;
use crate::numeric::{Ending, elementary, significant};

/// A number with two digits, written out.
fn two(value: f64) -> String {
    let value = if value.abs() < 1e-12 { 0.0 } else { value };
    significant(value, 2, Ending::Whole, 0.0..f64::INFINITY)
}

/// A short time in the unit that suits it.
pub fn duration(seconds: f64) -> String {
    let size = seconds.abs();
    let (unit, name) = match size {
        s if s >= 1.0 => (1.0, "s"),
        s if s >= 1e-4 => (1e-3, "ms"),
        s if s >= 1e-6 || s == 0.0 => (1e-6, "µs"),
        _ => (1e-9, "ns"),
    };
    format!("{} {name}", two(size / unit))
}

/// Name of a step: a fraction of a second such as 1/60 s, if it is the inverse of a whole number.
pub fn step_name(step: f64) -> String {
    let parts = (1.0 / step).round();
    let is_whole = (1e-3..0.5).contains(&step) && (parts * step - 1.0).abs() < 1e-9;
    // tenths and thousandths are written in ms
    if is_whole && (parts % 10.0 != 0.0 || parts % 30.0 == 0.0) {
        return format!("1/{parts:.0} s");
    }
    duration(step)
}

/// A point in time: in s with one decimal, none from 100 s on; below a second in the unit that suits it.
pub fn moment(seconds: f64) -> String {
    if seconds < 0.95 {
        return duration(seconds);
    }
    if seconds < 99.95 { format!("{seconds:.1} s") } else { format!("{seconds:.0} s") }
}

/// A length in m as an error is written: one digit, in mm. An error below the resolution of doubles of the
/// size of `travel` in m is stated as such.
pub fn small_length(m: f64, travel: f64) -> String {
    let least = 2.0 * f64::EPSILON * travel;
    if m < least || m == 0.0 {
        let least = if least > 0.0 { least } else { f64::EPSILON * 1e-3 };
        let power = elementary::log10(least * 1e3).ceil();
        return format!("below 1e{power:.0} mm");
    }
    format!("about {} mm", length_mm(m))
}

/// A length in m in mm with one digit.
pub fn length_mm(m: f64) -> String {
    let mm = m * 1e3;
    if mm < 9.5e-3 { format!("{mm:.0e}") } else { two(mm) }
}

impl Trust {
    /// The error, or the time up to which the path can be trusted, in a few words. Times are counted from
    /// `from` in s before the start of the compared runs. `None` if a run ended early, since then its end
    /// is reported.
    pub fn short(&self, from: f64) -> Option<String> {
        if self.outcome != Outcome::Done {
            return None;
        }
        Some(match self.course {
            Course::Kept => format!("Error {}", small_length(self.error, self.travel)),
            Course::Chaotic { until, .. } => {
                format!("Chaotic: trust it up to about {}", moment(from + until))
            }
            Course::Sensitive { until } | Course::Coarse { until } => {
                format!("Trust it up to about {}", moment(from + until))
            }
        })
    }

    /// The meaning of [`short`](Self::short) and how it was determined.
    pub fn long(&self, from: f64) -> String {
        let (loose, finer) = self.tolerances;
        let again =
            format!("Computed once more with the tolerance {finer:.0e} in place of {loose:.0e}, the path");
        let leaves = |until: f64| {
            let (share, until) = (TRUSTED_SHARE * 100.0, moment(from + until));
            format!("{again} is another one from {until} on (off by {share} % of the travel)")
        };
        match self.course {
            Course::Kept => {
                let change = match self.error {
                    0.0 => "is the same".to_owned(),
                    error => format!("changes by no more than {} mm", length_mm(error)),
                };
                let span = moment(self.span).replace(".0 s", " s");
                match from > 0.0 {
                    true => format!("{again} {change} over the {span} after {}.", moment(from)),
                    false => format!("{again} {change} over {span} from the start."),
                }
            }
            Course::Chaotic { until, decade } => format!(
                "{}: the difference grows tenfold every {}. A tighter tolerance buys little time; averages \
                 such as the RMS velocity stay.",
                leaves(until),
                duration(decade)
            ),
            Course::Sensitive { until } => format!(
                "{}: which of two ways it goes there hangs on next to nothing, as at the top of a hill.",
                leaves(until)
            ),
            Course::Coarse { until } => format!("{}: choose a smaller tolerance.", leaves(until)),
        }
    }
}

impl Lateness {
    /// How late impacts arrive, as a sentence.
    pub fn words(&self) -> String {
        let is_late = self.median >= 0.0;
        let is_whole = self.matched == self.of;
        let then = if is_whole { "" } else { "; then it takes another course" };
        let (late, early) = (self.matched - self.early, self.early);
        let fewer = if is_late { early } else { late };
        // if many are late and many early, a median would hide one group
        if fewer * 5 > self.matched {
            let of = match is_whole {
                true => format!("{} impacts", self.of),
                false => format!("the first {} impacts after a flight", self.matched),
            };
            let (latest, earliest) = (duration(self.latest), duration(-self.earliest));
            return format!(
                "Of {of} {late} arrive late, by up to {latest}, and {early} early, by up to {earliest}{then}."
            );
        }
        let who = match (is_whole, self.matched) {
            (true, 1) => "The one impact after a flight arrives".to_owned(),
            (true, _) => "Impacts arrive".to_owned(),
            (false, 1) => "The first impact arrives".to_owned(),
            (false, n) => format!("The first {n} impacts after a flight arrive"),
        };
        // the largest lateness of the majority, and of the minority with the other sign
        let (way, other_way) = if is_late { ("late", "early") } else { ("early", "late") };
        let (latest, earliest) = (self.latest, self.earliest);
        let (worst, other) = if is_late { (latest, earliest) } else { (earliest, latest) };
        let [median, worst, other] = [self.median, worst, other].map(|time| duration(time.abs()));
        let is_alone = self.matched == 1 || worst == median;
        let worst = if is_alone { String::new() } else { format!(" (worst {worst})") };
        let minority = match fewer {
            0 => String::new(),
            n => format!(", {n} of {} up to {other} {other_way}", self.matched),
        };
        format!("{who} {median} {way}{worst}{minority}{then}.")
    }
}

impl StepSize {
    /// The effects of the step, a sentence each: arrivals, impacts, RMS velocity, crossings, cost.
    pub fn sentences(&self) -> Vec<String> {
        let (exact, stepped) = (&self.exact, &self.stepped);
        if let Some(at) = stepped.ended_at {
            return vec![format!("It flew apart: the run broke off at {}.", duration(at))];
        }
        let mut all: Vec<String> = self.late.map(|late| late.words()).into_iter().collect();
        if exact.impacts != stepped.impacts {
            let (counted, exact) = (stepped.impacts, exact.impacts);
            all.push(format!("{counted} impacts counted where there are {exact}."));
        } else if exact.impacts > 0 {
            all.push(format!("{} impacts counted, which is right.", stepped.impacts));
        }
        if stepped.impacts > exact.impacts && self.hops > 0 {
            all.push(format!(
                "{} of them are hops of a mass that truly rests: pressed on a stop it bounces every step or \
                 two, so that shorter steps count more.",
                self.hops
            ));
        }
        if let Some(error) = self.rms_error() {
            let way = if error > 0.0 { "high" } else { "low" };
            all.push(match 100.0 * error.abs() {
                percent if percent < 1e-3 => "RMS velocity right to a thousandth of a per cent.".to_owned(),
                percent if percent < 200.0 => format!("RMS velocity {} % too {way}.", two(percent)),
                _ => format!("RMS velocity {} times what it should be.", two(1.0 + error)),
            });
        }
        if exact.crossings != stepped.crossings {
            all.push(format!("{} crossings where there are {}.", stepped.crossings, exact.crossings));
        }
        if let Some(t) = self.trusted {
            all.push(format!("It leaves the true path (by 1 % of the travel) at {}.", duration(t)));
        } else if self.error > 0.0 {
            all.push(format!("Displacement wrong by {} mm at most.", length_mm(self.error)));
        }
        let [exact, stepped] = [exact, stepped].map(|statistics| duration(statistics.cpu_s));
        all.push(format!("{stepped} of processor time; the true run takes {exact}."));
        all
    }
}
