//! Progress of a long command on standard error: a bar on a terminal, otherwise a line every minute.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use interwell::questions::{self, Error};
use interwell::system::clock::WallClock;

use super::{Common, Failure, interrupt, say};

/// Time between two lines in s.
const INTERVAL: f64 = 60.0;

/// The progress of a command, shown as a bar or as lines.
pub struct Progress {
    bar: ProgressBar,
    lines: Option<Lines>,
}

struct Lines {
    parts: AtomicU64,
    unit: String,
    clock: WallClock,
    /// Time of the clock in ms at which the parts began to be counted.
    begun: AtomicU64,
    /// Parts done before that.
    before: u64,
    done: AtomicU64,
    /// Number of the interval in which the last line was printed.
    printed: AtomicU64,
}

/// The answer of a question that Ctrl-C cancels, that has the threads of `--jobs`, and whose parts, called
/// `unit`, are counted by a [`bar`], or by their number alone where that of all is not known.
pub fn ask<T>(
    unit: &str,
    common: &Common,
    question: impl FnOnce(&questions::Progress) -> Result<T, Error>,
) -> Result<T, Failure> {
    let bar = bar(0, 0, unit, common);
    let count = |done: u64, all: Option<u64>| match all {
        Some(all) => bar.count(done, all),
        None if done == 0 => bar.bar.set_style(style(&format!("{{human_pos}} {unit}"))),
        None => bar.bar.set_position(done),
    };
    Ok(question(&interrupt::progress().reporting_to(&count).threads(common.jobs()))?)
}

/// Progress over a number of parts, called `unit`, of which the first `before` are done already: a bar with
/// rate and time left on a terminal, unless the rows go there too; lines if standard error is no terminal.
pub fn bar(parts: u64, before: u64, unit: &str, common: &Common) -> Progress {
    let rows_on_terminal = common.out() == Path::new("-") && std::io::stdout().is_terminal();
    let on_terminal = std::io::stderr().is_terminal();
    let (clock, done, printed) = (WallClock::start(), AtomicU64::new(before), AtomicU64::new(0));
    let (parts_of_lines, begun) = (AtomicU64::new(parts), AtomicU64::new(0));
    let lines = Lines { parts: parts_of_lines, unit: unit.to_owned(), clock, begun, before, done, printed };
    let lines = Some(lines).filter(|_| !common.quiet && !on_terminal);
    let template = format!("{{wide_bar}} {{human_pos}}/{{human_len}} {unit}  {{rate}}  {{eta}} left");
    let bar = match on_terminal && !common.quiet && !rows_on_terminal {
        true => ProgressBar::new(parts).with_style(style(&template)),
        false => ProgressBar::hidden(),
    };
    bar.set_position(before);
    bar.reset_eta();
    Progress { bar, lines }
}

/// The style of a bar, in which `rate` is the parts done in a second.
fn style(template: &str) -> ProgressStyle {
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let rate = |state: &ProgressState, text: &mut dyn std::fmt::Write| {
        let _ = write!(text, "{:.0}/s", state.per_sec());
    };
    style.with_key("rate", rate)
}

impl Progress {
    /// Counts `parts` more as done. May be called from any thread.
    pub fn inc(&self, parts: u64) {
        match &self.lines {
            Some(lines) => lines.show(lines.done.fetch_add(parts, Ordering::Relaxed) + parts),
            None => self.bar.inc(parts),
        }
    }

    /// Shows how many of all parts are done, from 0 at the beginning of a phase. There may be more than all.
    fn count(&self, done: u64, all: u64) {
        if let Some(lines) = &self.lines {
            lines.parts.store(all, Ordering::Relaxed);
            if done == 0 {
                lines.begun.store((1e3 * lines.clock.seconds()) as u64, Ordering::Relaxed);
            }
            lines.show(done);
            return;
        }
        self.bar.set_length(all.max(done));
        self.bar.set_position(done);
        if done == 0 {
            self.bar.reset_eta();
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl Lines {
    fn show(&self, done: u64) {
        let (seconds, printed) = (self.clock.seconds(), self.printed.load(Ordering::Relaxed));
        let due = (seconds / INTERVAL) as u64;
        let free = || self.printed.compare_exchange(printed, due, Ordering::Relaxed, Ordering::Relaxed);
        if due > printed && free().is_ok() {
            say(&self.line(done, seconds - 1e-3 * self.begun.load(Ordering::Relaxed) as f64));
        }
    }

    fn line(&self, done: u64, seconds: f64) -> String {
        let rate = (done - self.before) as f64 / seconds;
        let parts = self.parts.load(Ordering::Relaxed);
        let left = parts.saturating_sub(done) as f64 / rate;
        let (done, parts) = (HumanCount(done), HumanCount(parts.max(done)));
        format!("{done} of {parts} {}, {rate:.1}/s, {} left", self.unit, duration(left))
    }
}

pub fn duration(seconds: f64) -> String {
    if seconds < 1.0 {
        return "less than a second".to_owned();
    }
    let time = std::time::Duration::try_from_secs_f64(seconds.round());
    time.map_or_else(|_| "a very long time".to_owned(), |time| HumanDuration(time).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_cells_rate_and_time_left() {
        let lines = Lines {
            parts: AtomicU64::new(10_000),
            unit: "cells".into(),
            clock: WallClock::start(),
            begun: AtomicU64::new(0),
            before: 1000,
            done: AtomicU64::new(1000),
            printed: AtomicU64::new(0),
        };
        assert_eq!(lines.line(4000, 60.0), "4,000 of 10,000 cells, 50.0/s, 2 minutes left");
        assert!(lines.line(1000, 60.0).ends_with("a very long time left"));
    }
}
