//! Progress of a long command on standard error: a bar on a terminal, otherwise a line every minute.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use interwell::study::Task;
use interwell::system::clock::WallClock;

use super::{Common, interrupt, say};

/// Time between two lines in s.
const INTERVAL: f64 = 60.0;

/// The progress of a command, shown as a bar or as lines.
pub struct Progress {
    bar: ProgressBar,
    lines: Option<Lines>,
}

struct Lines {
    parts: u64,
    unit: String,
    clock: WallClock,
    /// Parts done before the clock was started.
    before: u64,
    done: AtomicU64,
    /// Number of the interval in which the last line was printed.
    printed: AtomicU64,
}

/// Runs `work` with a task that Ctrl-C ends and whose parts, called `unit`, are counted by a [`bar`].
pub fn with_bar<T>(parts: u64, unit: &str, common: &Common, work: impl FnOnce(&Task) -> T) -> T {
    let bar = bar(parts, 0, unit, common);
    work(&Task { tick: &|| bar.inc(1), cancel: interrupt::listen() })
}

/// Progress over a number of parts, called `unit`, of which the first `before` are done already: a bar with
/// rate and time left on a terminal, unless the rows go there too; lines if standard error is no terminal.
pub fn bar(parts: u64, before: u64, unit: &str, common: &Common) -> Progress {
    let rows_on_terminal = common.out() == Path::new("-") && std::io::stdout().is_terminal();
    let (clock, done, printed) = (WallClock::start(), AtomicU64::new(before), AtomicU64::new(0));
    let lines = Lines { parts, unit: unit.to_owned(), clock, before, done, printed };
    let lines = Some(lines).filter(|_| !common.quiet && !std::io::stderr().is_terminal());
    let template = format!("{{wide_bar}} {{human_pos}}/{{human_len}} {unit}  {{rate}}  {{eta}} left");
    let bar = bar_on_terminal(Some(parts), &template, common.quiet || rows_on_terminal);
    bar.set_position(before);
    bar.reset_eta();
    Progress { bar, lines }
}

/// A bar in the style of `template`, without a length if the number of `parts` is not known; hidden as well
/// where standard error is no terminal.
pub fn bar_on_terminal(parts: Option<u64>, template: &str, hidden: bool) -> ProgressBar {
    if hidden || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let rate = |state: &ProgressState, text: &mut dyn std::fmt::Write| {
        let _ = write!(text, "{:.0}/s", state.per_sec());
    };
    parts.map_or_else(ProgressBar::no_length, ProgressBar::new).with_style(style.with_key("rate", rate))
}

impl Progress {
    /// Counts `parts` more as done. May be called from any thread.
    pub fn inc(&self, parts: u64) {
        match &self.lines {
            Some(lines) => lines.inc(parts),
            None => self.bar.inc(parts),
        }
    }

    /// Counts one more part as done, and makes the bar longer if there are more parts than it was made for.
    pub fn inc_beyond(&self) {
        self.inc(1);
        if self.bar.length().is_some_and(|length| self.bar.position() >= length) {
            self.bar.inc_length(1);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl Lines {
    fn inc(&self, parts: u64) {
        let done = self.done.fetch_add(parts, Ordering::Relaxed) + parts;
        let (seconds, printed) = (self.clock.seconds(), self.printed.load(Ordering::Relaxed));
        let due = (seconds / INTERVAL) as u64;
        let free = || self.printed.compare_exchange(printed, due, Ordering::Relaxed, Ordering::Relaxed);
        if due > printed && free().is_ok() {
            say(&self.line(done, seconds));
        }
    }

    fn line(&self, done: u64, seconds: f64) -> String {
        let rate = (done - self.before) as f64 / seconds;
        let left = self.parts.saturating_sub(done) as f64 / rate;
        let (done, parts) = (HumanCount(done), HumanCount(self.parts.max(done)));
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
            parts: 10_000,
            unit: "cells".into(),
            clock: WallClock::start(),
            before: 1000,
            done: AtomicU64::new(1000),
            printed: AtomicU64::new(0),
        };
        assert_eq!(lines.line(4000, 60.0), "4,000 of 10,000 cells, 50.0/s, 2 minutes left");
        assert!(lines.line(1000, 60.0).ends_with("a very long time left"));
    }
}
