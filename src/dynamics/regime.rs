//! What kind of motion is it, and after how many forcing periods does it repeat?

use super::result::Side;

/// Most forcing periods after which a motion may repeat and still count as periodic.
const LONGEST: usize = 12;

/// Two crossings repeat where their times within the period agree to this share of a forcing period: well
/// above what is left of a transient after half a run, well below the scatter of irregular motion.
const CROSSING_MATCH: f64 = 1e-2;

/// Two stroboscopic states repeat where they agree to this share of the scene's scales: fine enough to see
/// a period doubling soon after its onset, coarse enough for a transient that has died to a thousandth.
const STATE_MATCH: f64 = 1e-3;

/// Most crossings and stroboscopic states that are kept to tell the regime; a window of more is judged by
/// its first ones.
pub(super) const KEPT: usize = 1 << 16;

/// The state at a whole number of forcing periods after the window's start. SI.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strobe {
    pub x: f64,
    pub v: f64,
}

/// What is kept of the settled window to tell regime and period.
#[derive(Debug, Clone, Default)]
pub(crate) struct CrossingLog {
    /// Forcing periods in the window.
    periods: u64,
    /// Time in forcing periods since the window's start, and the well entered.
    pub crossings: Vec<(f64, Side)>,
    pub strobes: Vec<Strobe>,
}

impl CrossingLog {
    pub fn new(periods: u64) -> Self {
        Self { periods, ..Self::default() }
    }

    /// Keeps a crossing, while there is room.
    pub fn keep_crossing(&mut self, time: f64, side: Side) {
        if self.crossings.len() < KEPT {
            self.crossings.push((time, side));
        }
    }

    /// Keeps a stroboscopic state; whether there is room for more.
    pub fn keep_strobe(&mut self, strobe: Strobe) -> bool {
        self.strobes.push(strobe);
        self.strobes.len() < KEPT
    }

    /// Whether the crossings repeat with a period of at most 12 forcing periods. A period is only
    /// accepted if the window holds it twice, so that every crossing has a partner to be compared with.
    pub fn crossings_repeat(&self) -> bool {
        let n = self.crossings.len();
        let end = self.periods as f64;
        (1..=LONGEST.min((self.periods / 2) as usize)).any(|q| {
            let q = q as f64;
            let inside = self.crossings.iter().filter(|c| c.0 < q).count();
            // a crossing near the edge of the window may fall on either side of it
            (inside.saturating_sub(1).max(1)..=inside + 1).any(|m| {
                m < n
                    && (0..n - m).all(|i| {
                        let (a, b) = (self.crossings[i], self.crossings[i + m]);
                        a.1 == b.1 && (b.0 - a.0 - q).abs() <= CROSSING_MATCH
                    })
                    && self.crossings[n - m].0 + q >= end - CROSSING_MATCH
                    && self.crossings[m - 1].0 - q <= CROSSING_MATCH
            })
        })
    }

    /// The smallest number of forcing periods, at most 12, after which all stroboscopic states repeat.
    pub fn period(&self, length: f64, speed: f64) -> Option<u32> {
        let s = &self.strobes;
        let longest = LONGEST.min((self.periods / 2) as usize);
        (1..=longest)
            .find(|q| {
                s.len() > *q
                    && (0..s.len() - q).all(|i| {
                        (s[i + q].x - s[i].x).abs() <= STATE_MATCH * length
                            && (s[i + q].v - s[i].v).abs() <= STATE_MATCH * speed
                    })
            })
            .map(|q| q as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(periods: u64, times: &[f64]) -> CrossingLog {
        let side = |i: usize| if i.is_multiple_of(2) { Side::Right } else { Side::Left };
        CrossingLog {
            periods,
            crossings: times.iter().enumerate().map(|(i, t)| (*t, side(i))).collect(),
            strobes: Vec::new(),
        }
    }

    #[test]
    fn twice_a_period_repeats() {
        let times: Vec<f64> = (0..30).map(|i| 0.25 + 0.5 * f64::from(i)).collect();
        assert!(log(15, &times).crossings_repeat());
        let edge: Vec<f64> =
            (0..30).map(|i| 0.5 * f64::from(i) + if i % 4 == 0 { 1e-4 } else { 0.0 }).collect();
        assert!(log(15, &edge).crossings_repeat());
    }

    #[test]
    fn a_lone_crossing_or_scatter_does_not() {
        assert!(!log(15, &[6.1]).crossings_repeat());
        assert!(!log(15, &[6.1, 7.3]).crossings_repeat());
        let scattered: Vec<f64> =
            (0..28).map(|i| 0.25 + 0.5 * f64::from(i) + 0.1 * f64::from(i * i % 7)).collect();
        assert!(!log(15, &scattered).crossings_repeat());
        // stops crossing half way
        let dying: Vec<f64> = (0..14).map(|i| 0.25 + 0.5 * f64::from(i)).collect();
        assert!(!log(15, &dying).crossings_repeat());
    }

    #[test]
    fn the_period_of_stroboscopic_states() {
        let mut log = log(40, &[]);
        log.strobes = (0..41).map(|i| Strobe { x: f64::from(i % 5), v: 0.0 }).collect();
        assert_eq!(log.period(1.0, 1.0), Some(5));
        log.strobes = (0..41).map(|i| Strobe { x: f64::from(i * i % 37), v: 0.0 }).collect();
        assert_eq!(log.period(1.0, 1.0), None);
    }
}
