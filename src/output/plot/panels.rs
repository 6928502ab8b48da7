//! Panels of the picture of a run: which are drawn, and where they stand.

use super::figure::{Area, Figure, Point};
use super::frame::stretched;
use super::style::{self, Theme};

pub(super) const LEFT: f64 = 150.0;
pub(super) const GUTTER: f64 = 102.0;
/// Upper and lower edges of the panels over time on the canvas for a screen.
const PANELS: [(f64, f64); 3] = [(175.0, 425.0), (447.0, 657.0), (679.0, 869.0)];

/// Room for the account beside the portrait.
const ACCOUNT: f64 = 370.0;

/// Room between two panels over time, and over a portrait that stands below them.
const BETWEEN: f64 = 22.0;
const ABOVE_PORTRAIT: f64 = 146.0;

/// Least height of a panel over time and of a portrait, where only some are drawn.
const LEAST: (f64, f64) = (210.0, 420.0);

/// A panel of the picture of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Panel {
    /// Displacement over time.
    Displacement,
    /// Velocity over time.
    Velocity,
    /// Acceleration of the base over time.
    Acceleration,
    /// Velocity over displacement.
    Portrait,
}

impl Panel {
    /// All of them, in the order in which they stand. All together have numbers beside them.
    pub const ALL: [Self; 4] = [Self::Displacement, Self::Velocity, Self::Acceleration, Self::Portrait];

    /// Its word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Portrait => "portrait",
        }
    }

    /// The panel that is called so.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|panel| panel.name() == name)
    }
}

/// Where the parts stand.
pub(super) struct Places {
    /// Displacement, velocity, acceleration over time.
    pub panels: [Option<Area>; 3],
    pub portrait: Option<Area>,
    /// Beginning of the first line of the account.
    pub account: Option<Point>,
}

impl Places {
    /// What a run needs between its captions: narrow, the portrait is under the panels.
    pub fn least(theme: &Theme, shown: &[Panel]) -> f64 {
        if is_whole(shown) {
            return if theme.is_narrow() { 1290.0 } else { 800.0 };
        }
        let (times, portrait) = parts(shown);
        let over_time = LEAST.0 * times.len() as f64;
        let room = if portrait && !times.is_empty() { ABOVE_PORTRAIT } else { 0.0 };
        175.0 + over_time + room + if portrait { LEAST.1 } else { 0.0 }
    }

    /// On the canvas of `figure`, `more` below their usual height.
    pub fn new(figure: &Figure, more: f64, shown: &[Panel]) -> Self {
        if !is_whole(shown) {
            return Self::of_some(figure, more, shown);
        }
        let (width, bottom, top) = (figure.canvas.right, figure.bottom() + 1.0, PANELS[0].0 + more);
        let panels = |left: f64, right: f64, bottom: f64| {
            stretched(PANELS, top, bottom).map(|(top, bottom)| Some(Area::new(left, top, right, bottom)))
        };
        if figure.is_narrow() {
            let (left, right) = (GUTTER + style::AXIS, figure.right());
            let height = 0.3 * (bottom - top);
            let beside = right.min(width - ACCOUNT);
            let portrait = Area::new(left, bottom - height, beside, bottom);
            let account = Some((beside + 20.0, portrait.top + 26.0));
            let panels = panels(left, right, portrait.top - ABOVE_PORTRAIT);
            return Self { panels, portrait: Some(portrait), account };
        }
        let high = 425.0 * (bottom - top) / (PANELS[2].1 - PANELS[0].0);
        let portrait = Area::new(width - 450.0, top, width - 35.0, top + high);
        let account = Some((portrait.left, portrait.bottom + 138.0));
        Self { panels: panels(LEFT, width - 615.0, bottom), portrait: Some(portrait), account }
    }

    /// Some of them, one under the other over the whole width.
    fn of_some(figure: &Figure, more: f64, shown: &[Panel]) -> Self {
        let (times, portrait) = parts(shown);
        let left = if figure.is_narrow() { GUTTER + style::AXIS } else { LEFT };
        let (right, top, end) = (figure.right(), PANELS[0].0 + more, figure.bottom() + 1.0);
        // a portrait alone has its words over it
        let above = if times.is_empty() { 44.0 } else { ABOVE_PORTRAIT };
        let height = match (portrait, times.is_empty()) {
            (false, _) => 0.0,
            (true, true) => end - top - above,
            (true, false) => (0.45 * (end - top - above)).max(LEAST.1.min(0.6 * (end - top))),
        };
        let bottom = if portrait { end - height - above } else { end };
        let heights: f64 = times.iter().map(|i| PANELS[*i].1 - PANELS[*i].0).sum();
        let room = bottom - top - BETWEEN * (times.len() as f64 - 1.0);
        let (mut panels, mut y) = ([None; 3], top);
        for i in times {
            let high = (PANELS[i].1 - PANELS[i].0) / heights * room;
            panels[i] = Some(Area::new(left, y, right, y + high));
            y += high + BETWEEN;
        }
        let portrait = portrait.then(|| Area::new(left, end - height, right, end));
        Self { panels, portrait, account: None }
    }

    /// The lowest of the panels over time, which has the numbers of the time.
    pub fn last(&self) -> Option<usize> {
        self.panels.iter().rposition(Option::is_some)
    }
}

fn is_whole(shown: &[Panel]) -> bool {
    Panel::ALL.iter().all(|panel| shown.contains(panel))
}

/// The places of the panels over time that are shown, and whether the portrait is.
fn parts(shown: &[Panel]) -> (Vec<usize>, bool) {
    let times = (0..3).filter(|i| shown.contains(&Panel::ALL[*i])).collect();
    (times, shown.contains(&Panel::Portrait))
}
