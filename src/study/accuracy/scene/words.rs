//! Accuracy of a scene in sentences, the same for window and command line.

use super::{Course, Lateness, StepSize, TRUSTED_SHARE, Trust};
use crate::dynamics::Outcome;
use crate::numeric::decimals;

/// A number with two digits, written out.
fn two(value: f64) -> String {
    let size = value.abs();
    if size < 1e-12 {
        return "0".to_owned();
    }
    let places = decimals(size, 2);
    // what rounds up to another digit has one decimal less: 9.96 is 10
    let ten = format!("{size:.places$}").parse().is_ok_and(|shown: f64| shown >= 10.0);
    let places = if ten { 0 } else { places };
    format!("{value:.places$}")
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

/// A time in s in its shortest form.
fn stretch(seconds: f64) -> String {
    let text = moment(seconds);
    text.replace(".0 s", " s")
}

/// A length in m as an error is written: one digit, in mm. An error below the resolution of doubles of the
/// size of `travel` in m is stated as such.
pub fn small_length(m: f64, travel: f64) -> String {
    let least = 2.0 * f64::EPSILON * travel;
    if m < least || m == 0.0 {
        let least = if least > 0.0 { least } else { f64::EPSILON * 1e-3 };
        let power = (least * 1e3).log10().ceil();
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
        let share = TRUSTED_SHARE * 100.0;
        let span = stretch(self.span);
        let after = if from > 0.0 {
            format!("the {span} after {}", moment(from))
        } else {
            format!("{span} from the start")
        };
        let leaves = |until: f64| {
            format!(
                "Computed once more with the tolerance {finer:.0e} in place of {loose:.0e}, the path is \
                 another one from {} on (off by {share} % of the travel)",
                moment(from + until)
            )
        };
        match self.course {
            Course::Kept if self.error == 0.0 => {
                format!(
                    "Computed once more with the tolerance {finer:.0e} in place of {loose:.0e}, the path is \
                     the same over {after}."
                )
            }
            Course::Kept => format!(
                "Computed once more with the tolerance {finer:.0e} in place of {loose:.0e}, the path changes \
                 by no more than {} mm over {after}.",
                length_mm(self.error)
            ),
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
    fn words(&self) -> String {
        let way = |t: f64| if t >= 0.0 { "late" } else { "early" };
        let median = self.median;
        let all = self.matched == self.of;
        let who = match (all, self.matched) {
            (true, 1) => "The one impact after a flight arrives".to_owned(),
            (true, _) => "Impacts arrive".to_owned(),
            (false, 1) => "The first impact arrives".to_owned(),
            (false, n) => format!("The first {n} impacts after a flight arrive"),
        };
        let then = if all { "" } else { "; then it takes another course" };
        let (late, early) = (self.matched - self.early, self.early);
        let (fewer, other) = if median >= 0.0 { (early, self.earliest) } else { (late, self.latest) };
        // where many go each way, a median would hide the others
        if fewer * 5 > self.matched {
            let of = match all {
                true => format!("{} impacts", self.of),
                false => format!("the first {} impacts after a flight", self.matched),
            };
            return format!(
                "Of {of} {late} arrive late, by up to {}, and {early} early, by up to {}{then}.",
                duration(self.latest),
                duration(-self.earliest)
            );
        }
        let worst = if median >= 0.0 { self.latest } else { self.earliest }.abs();
        let worst = match self.matched {
            1 => String::new(),
            _ if duration(worst) == duration(median.abs()) => String::new(),
            _ => format!(" (worst {})", duration(worst)),
        };
        let minority = match fewer {
            0 => String::new(),
            n => format!(", {n} of {} up to {} {}", self.matched, duration(other.abs()), way(other)),
        };
        format!("{who} {} {}{worst}{minority}{then}.", duration(median.abs()), way(median))
    }
}

impl StepSize {
    /// The effects of the step, a sentence each: arrivals, impacts, RMS velocity, crossings, cost.
    pub fn sentences(&self) -> Vec<String> {
        let mut all = Vec::new();
        if let Some(at) = self.ended_at {
            all.push(format!("It flew apart: the run broke off at {}.", duration(at)));
            return all;
        }
        all.extend(self.late.map(|late| late.words()));
        let (exact, counted) = self.impacts;
        if exact != counted {
            all.push(format!("{counted} impacts counted where there are {exact}."));
        } else if exact > 0 {
            all.push(format!("{counted} impacts counted, which is right."));
        }
        if counted > exact && self.hops > 0 {
            all.push(format!(
                "{} of them are hops of a mass that truly rests: pressed on a stop it bounces every step or \
                 two, so that shorter steps count more.",
                self.hops
            ));
        }
        if let Some(error) = self.rms_error() {
            let percent = 100.0 * error.abs();
            let way = if error > 0.0 { "high" } else { "low" };
            all.push(match percent {
                p if p < 1e-3 => "RMS velocity right to a thousandth of a per cent.".to_owned(),
                p if p < 200.0 => format!("RMS velocity {} % too {way}.", two(percent)),
                _ => format!("RMS velocity {} times what it should be.", two(1.0 + error)),
            });
        }
        let (exact, counted) = self.crossings;
        if exact != counted {
            all.push(format!("{counted} crossings where there are {exact}."));
        }
        if let Some(t) = self.trusted {
            all.push(format!("It leaves the true path (by 1 % of the travel) at {}.", duration(t)));
        } else if self.error > 0.0 {
            all.push(format!("Displacement wrong by {} mm at most.", length_mm(self.error)));
        }
        let (exact, stepped) = self.cpu_s;
        all.push(format!("{} of processor time; the true run takes {}.", duration(stepped), duration(exact)));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_have_their_unit() {
        assert_eq!(
            [0.014, 5.5e-4, 3.2, 0.137, 9.96e-3, 4e-6, 0.0].map(duration),
            ["14 ms", "0.55 ms", "3.2 s", "137 ms", "10 ms", "4.0 µs", "0 µs"]
        );
        assert_eq!([2e-12, 3.4e-5, 0.0042].map(length_mm), ["2e-9", "0.034", "4.2"]);
        assert_eq!(small_length(0.0, 2e-3), "below 1e-15 mm");
        assert_eq!([0.12, 0.97, 4.21, 171.0].map(moment), ["120 ms", "1.0 s", "4.2 s", "171 s"]);
        assert_eq!(stretch(20.0), "20 s");
        let steps = [1.0 / 60.0, 1.0 / 600.0, 1.0 / 30.0, 1e-3, 0.01, 1e-5].map(step_name);
        assert_eq!(steps, ["1/60 s", "1/600 s", "1/30 s", "1.0 ms", "10 ms", "10 µs"]);
    }

    #[test]
    fn lateness_says_which_way() {
        let late = Lateness { median: 0.014, earliest: 0.013, latest: 0.017, matched: 60, early: 0, of: 60 };
        assert_eq!(late.words(), "Impacts arrive 14 ms late (worst 17 ms).");
        // both ways each is counted: a median would hide the other
        let mixed = Lateness { earliest: -0.02, matched: 3, early: 1, ..late };
        assert_eq!(
            mixed.words(),
            "Of the first 3 impacts after a flight 2 arrive late, by up to 17 ms, and 1 early, by up to 20 \
             ms; then it takes another course."
        );
        let early = Lateness { median: -0.01, earliest: -0.02, latest: -0.01, early: 60, ..late };
        assert_eq!(early.words(), "Impacts arrive 10 ms early (worst 20 ms).");
        let few = Lateness { earliest: -0.003, early: 1, ..late };
        assert_eq!(few.words(), "Impacts arrive 14 ms late (worst 17 ms), 1 of 60 up to 3.0 ms early.");
    }
}
