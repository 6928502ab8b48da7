//! Times of the two cursors.

use crate::app::session::Session;

use super::zoom::Ends;

/// Initial positions of the cursors, as shares of the time range shown.
const INITIAL: [f64; 2] = [0.5, 0.75];

/// The two time cursors.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cursors {
    pub on: bool,
    /// Their times in s.
    pub at: [f64; 2],
    /// Index of the cursor that a drag moves.
    pub(super) moved: usize,
    /// Their times before the last click, restored if a double click follows.
    pub(super) before: [f64; 2],
    /// Whether the first cursor takes the keyboard focus in the next view that shows it.
    pub(super) focus: bool,
}

impl Cursors {
    /// Shows or hides the cursors. If one would lie outside the visible range `seen`, both are placed anew.
    pub(super) fn switch(&mut self, session: &Session, seen: Option<Ends>) {
        self.on = !self.on;
        self.focus = self.on;
        let (begin, end) = recorded_range(session);
        let (from, to) = seen.map_or((begin, end), |(from, to)| (from.max(begin), to.min(end)));
        // equal times: not placed yet
        if self.at[0] == self.at[1] || self.at.iter().any(|t| *t < from || *t > to) {
            self.at = INITIAL.map(|share| from + share * (to - from));
        }
    }

    pub(super) fn put(&mut self, which: usize, t: f64, session: &Session) {
        let (begin, end) = recorded_range(session);
        self.at[which] = t.clamp(begin, end);
    }

    pub(super) fn nearer(&self, t: f64) -> usize {
        usize::from((self.at[1] - t).abs() < (self.at[0] - t).abs())
    }
}

/// First and last time in s of the recorded motion.
pub(super) fn recorded_range(session: &Session) -> Ends {
    let watch = session.player.watch();
    (watch.begin(), watch.time().max(watch.begin()))
}
