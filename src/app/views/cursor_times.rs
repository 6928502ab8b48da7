//! Times of the two cursors.

use crate::app::session::Session;

use super::zoom::Ends;

/// Where in the stretch that is shown the cursors first stand.
const FIRST: [f64; 2] = [0.5, 0.75];

/// Two times.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cursors {
    pub on: bool,
    /// Their times in s.
    pub at: [f64; 2],
    /// The one that a drag moves.
    pub(super) moved: usize,
    /// Where they were before the last click: a double click means something else.
    pub(super) before: [f64; 2],
    /// The first of them takes the keyboard's focus in the next view that shows it.
    pub(super) focus: bool,
}

impl Cursors {
    /// Shows them, those that would not be seen within the stretch `seen`, or hides them.
    pub(super) fn switch(&mut self, session: &Session, seen: Option<Ends>) {
        self.on = !self.on;
        self.focus = self.on;
        let (begin, end) = remembered(session);
        let (from, to) = seen.map_or((begin, end), |(from, to)| (from.max(begin), to.min(end)));
        // as at first they are one
        if self.at[0] == self.at[1] || self.at.iter().any(|t| *t < from || *t > to) {
            self.at = FIRST.map(|share| from + share * (to - from));
        }
    }

    pub(super) fn put(&mut self, which: usize, t: f64, session: &Session) {
        let (begin, end) = remembered(session);
        self.at[which] = t.clamp(begin, end);
    }

    pub(super) fn nearer(&self, t: f64) -> usize {
        usize::from((self.at[1] - t).abs() < (self.at[0] - t).abs())
    }
}

/// The times in s that are remembered.
pub(super) fn remembered(session: &Session) -> Ends {
    let watch = session.player.watch();
    (watch.begin(), watch.time().max(watch.begin()))
}
