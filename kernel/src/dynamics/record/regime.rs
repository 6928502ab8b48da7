//! Classification of a run: the period, whether the motion has settled, whether its averages are steady, and
//! the first crossing and release.

use super::repeats::{Crossings, Strobe, Strobes};
use crate::dynamics::model::excitation::Rhythm;
use crate::dynamics::result::{First, Firsts, Side};

/// Minimum number of forcing periods of a window for its halves to be compared.
const MIN_PERIODS_TO_COMPARE: u64 = 8;

/// Number of standard errors by which the means of two halves may differ.
const STANDARD_ERRORS: f64 = 3.0;

#[derive(Debug, Clone, Copy)]
enum Observation {
    Strobe(Strobe, Gain),
    Crossing { time: f64, side: Side, seconds: f64 },
    Release { time: f64, seconds: f64 },
}

/// Integral of the squared velocity, and number of crossings, over a time interval.
pub(crate) type Gain = (f64, u64);

/// One quantity over the forcing periods of half a window.
#[derive(Debug, Clone, Copy, Default)]
struct Half {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Half {
    fn add(&mut self, value: f64, times: u64) {
        let times = times as f64;
        self.count += times;
        self.sum += value * times;
        self.squares += value * value * times;
    }

    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn error_squared(&self) -> f64 {
        let mean = self.mean();
        (self.squares / self.count - mean * mean).max(0.0) / (self.count - 1.0)
    }

    fn agrees(&self, other: &Self) -> bool {
        let apart = self.mean() - other.mean();
        apart * apart <= STANDARD_ERRORS * STANDARD_ERRORS * (self.error_squared() + other.error_squared())
    }
}

/// Count of the forcing periods of a window with at least one event of a kind.
#[derive(Debug, Clone, Copy, Default)]
struct PeriodsWith {
    count: u64,
    last: Option<i64>,
}

impl PeriodsWith {
    fn add(&mut self, period: i64) {
        self.count += u64::from(self.last != Some(period));
        self.last = Some(period);
    }
}

/// Classifier of a run, with the data that it needs. Times are in forcing periods since the first
/// stroboscopic state, which is the first instant of the run at the window's phase, unless stated otherwise.
#[derive(Debug, Clone)]
pub(crate) struct Classifier {
    rhythm: Rhythm,
    periods: u64,
    /// Number of the forcing period at which the window begins.
    from: u64,
    pub strobes: Strobes,
    crossings: Crossings,
    crossing_periods: PeriodsWith,
    release_periods: PeriodsWith,
    /// Integral of the squared velocity over each period, for both halves of the window.
    speed: [Half; 2],
    /// Crossings in each period, for both halves of the window.
    crossed: [Half; 2],
    last: Gain,
    firsts: Firsts,
    /// Forcing period of the last crossing of the whole run.
    last_crossing: Option<i64>,
    observations: Option<Vec<Observation>>,
    /// The verdict on a window that repeats: the period of the orbit that attracts the motion, if one does.
    verdict: Option<Option<u32>>,
}

impl Classifier {
    /// For a settled window of `periods` forcing periods that begins with stroboscopic state number `from`.
    pub fn new(rhythm: Rhythm, scales: (f64, f64), periods: u64, from: u64) -> Self {
        Self {
            rhythm,
            periods,
            from,
            strobes: Strobes::new(scales, periods, from),
            crossings: Crossings::new(periods),
            crossing_periods: PeriodsWith::default(),
            release_periods: PeriodsWith::default(),
            speed: [Half::default(); 2],
            crossed: [Half::default(); 2],
            last: (0.0, 0),
            firsts: Firsts::default(),
            last_crossing: None,
            observations: None,
            verdict: None,
        }
    }

    /// Whether the instants of crossings outside the window are needed too: under a drive that changes, the
    /// first ones are reported.
    pub fn times_all_crossings(&self) -> bool {
        self.rhythm == Rhythm::Changing
    }

    fn keep(&mut self, observation: Observation) {
        if let Some(observations) = &mut self.observations {
            observations.push(observation);
        }
    }

    /// Adds a stroboscopic state, with the integral of the squared velocity and the number of crossings since
    /// the start of the window.
    pub fn strobe(&mut self, state: Strobe, total: Gain) {
        let gain = (total.0 - self.last.0, total.1 - self.last.1);
        self.last = total;
        self.keep(Observation::Strobe(state, gain));
        self.gain(self.strobes.seen, 1, 1, gain);
        self.strobes.add(state);
    }

    /// Adds the gain that precedes stroboscopic state `number`, for `times` states that are `lap` periods
    /// apart.
    fn gain(&mut self, number: u64, times: u64, lap: u64, gain: Gain) {
        let up_to = |end: u64| (end + 1).saturating_sub(number).div_ceil(lap).min(times);
        let ends = [self.from, self.from + self.periods / 2, self.from + self.periods].map(up_to);
        for half in [0, 1] {
            let inside = ends[half + 1] - ends[half];
            if inside > 0 {
                self.speed[half].add(gain.0, inside);
                self.crossed[half].add(gain.1 as f64, inside);
            }
        }
    }

    /// Adds a crossing into the well on `side`; `seconds` is the time since the start of the run.
    pub fn crossing(&mut self, time: f64, side: Side, seconds: f64) {
        self.keep(Observation::Crossing { time, side, seconds });
        if self.rhythm == Rhythm::Changing {
            let first = First { t: seconds, amplitude: None };
            self.firsts.crossing.get_or_insert(first);
            if time.is_finite() {
                let period = time.floor() as i64;
                if self.last_crossing.is_none_or(|last| period > last + 1) {
                    self.firsts.crossing_in_every_period = Some(first);
                }
                self.last_crossing = Some(period);
            }
        }
        if let Some(inside) = self.in_window(time) {
            if self.rhythm == Rhythm::Periodic {
                self.crossings.add(inside, side);
            }
            self.crossing_periods.add(inside.floor() as i64);
        }
    }

    pub fn release(&mut self, time: f64, seconds: f64) {
        self.keep(Observation::Release { time, seconds });
        if self.rhythm == Rhythm::Changing {
            self.firsts.release.get_or_insert(First { t: seconds, amplitude: None });
        }
        if let Some(inside) = self.in_window(time) {
            self.release_periods.add(inside.floor() as i64);
        }
    }

    /// The time since the start of the window, if it is inside the window.
    fn in_window(&self, time: f64) -> Option<f64> {
        let inside = time - self.from as f64;
        (inside >= 0.0 && inside < self.periods as f64).then_some(inside)
    }

    /// Begins to keep the observations for replay.
    pub fn begin_observations(&mut self) {
        self.observations = Some(Vec::with_capacity(64));
    }

    pub fn end_observations(&mut self) {
        self.observations = None;
    }

    pub fn observed(&self) -> usize {
        self.observations.as_ref().map_or(0, Vec::len)
    }

    /// Adds `laps` more laps like the one kept between these two indices, each of `periods` forcing periods
    /// and with the gain `total`.
    pub fn repeat(&mut self, (from, to): (usize, usize), laps: u64, periods: u64, total: Gain) {
        let Some(observations) = self.observations.take() else { return };
        let lap = observations.get(from..to).unwrap_or_default();
        let strobe = |entry: &Observation| match entry {
            Observation::Strobe(state, gain) => Some((*state, *gain)),
            _ => None,
        };
        let mut strobes: Vec<(Strobe, Gain)> = lap.iter().filter_map(strobe).collect();
        // the gain up to the first state begins in the lap before, which may have been different
        if let Some(((_, first), later_states)) = strobes.split_first_mut() {
            let rest =
                |rest: Gain, other: &(Strobe, Gain)| (rest.0 - other.1.0, rest.1.saturating_sub(other.1.1));
            *first = later_states.iter().fold(total, rest);
        }
        self.last = (self.last.0 + total.0 * laps as f64, self.last.1 + total.1.saturating_mul(laps));
        // Replay as many laps as any classification looks back, and another one to measure the gain of a lap.
        let replayed = laps.min(2 * self.strobes.longest as u64 / periods.max(1) + 4);
        let mut before = (0, 0);
        for number in 1..=replayed {
            before = (self.crossing_periods.count, self.release_periods.count);
            let (later, mut next) = ((number * periods) as f64, strobes.iter());
            for entry in lap {
                match *entry {
                    Observation::Strobe(..) => {
                        let Some((state, gain)) = next.next() else { continue };
                        self.gain(self.strobes.seen, 1, 1, *gain);
                        self.strobes.add(*state);
                    }
                    Observation::Crossing { time, side, seconds } => {
                        self.crossing(time + later, side, seconds)
                    }
                    Observation::Release { time, seconds } => self.release(time + later, seconds),
                }
            }
        }
        let left = laps - replayed;
        if left > 0 {
            let later = left * periods;
            let more = |count: &mut PeriodsWith, before: u64| {
                count.count += left * (count.count - before);
                count.last = count.last.map(|last| last + later as i64);
            };
            more(&mut self.crossing_periods, before.0);
            more(&mut self.release_periods, before.1);
            if strobes.len() as u64 == periods {
                for (number, (_, gain)) in (self.strobes.seen..).zip(&strobes) {
                    self.gain(number, left, periods, *gain);
                }
                self.strobes.skip(later, periods, |place| strobes[place as usize].0);
            }
            self.crossings.skip(later as f64);
            self.last_crossing = self.last_crossing.map(|last| last + later as i64);
        }
        self.observations = Some(observations);
    }

    /// Adds `more` stroboscopic states equal to `state`, the last one, up to the next border of the window.
    pub fn skip_still(&mut self, more: u64, state: Strobe) {
        self.gain(self.strobes.seen, more, 1, (0.0, 0));
        self.strobes.skip(more, 1, |_| state);
    }

    /// Whether the crossings of the window repeat, either alone or with the motion.
    pub fn crossings_repeat(&self) -> bool {
        self.repeats().is_some() || self.crossings.repeat()
    }

    /// The smallest number of forcing periods, at most 12, after which the motion repeats over the whole
    /// window, and the number of the state since which it does. The window must hold the period twice.
    fn repeats(&self) -> Option<(u32, u64)> {
        self.strobes.period().filter(|_| self.rhythm == Rhythm::Periodic)
    }

    /// The number of forcing periods after which the window repeats, if there is no verdict on it yet.
    pub fn without_verdict(&self) -> Option<u32> {
        self.repeats().map(|(period, _)| period).filter(|_| self.verdict.is_none())
    }

    /// Sets the verdict on a window that repeats: the period of the orbit that attracts the motion, if one
    /// does.
    pub fn decide(&mut self, verdict: Option<u32>) {
        self.verdict = Some(verdict);
    }

    /// The period of the motion: that of the orbit that attracts it, or, of a mass that rests, of its
    /// states.
    pub fn period(&self) -> Option<u32> {
        self.repeats().and_then(|(period, _)| self.verdict.unwrap_or(Some(period)))
    }

    /// Whether the motion has settled: it repeats, or `rests` during the whole window. `None` under a drive
    /// that changes, for which this is not defined.
    pub fn settled(&self, rests: bool) -> Option<bool> {
        match self.rhythm {
            Rhythm::Changing => None,
            Rhythm::Absent => Some(rests),
            Rhythm::Periodic => Some(self.period().is_some() || (rests && self.periods > 0)),
        }
    }

    /// Whether the averages of the window's halves agree, if that is known. They do once the motion has
    /// settled.
    pub fn steady(&self, rests: bool) -> Option<bool> {
        match self.settled(rests)? {
            true => Some(true),
            false if self.periods < MIN_PERIODS_TO_COMPARE => None,
            false => Some([self.speed, self.crossed].iter().all(|[first, second]| first.agrees(second))),
        }
    }

    /// Time in s since which the motion has repeated; `at` gives the time of a stroboscopic state.
    pub fn settles_at(&self, at: impl Fn(u64) -> f64) -> Option<f64> {
        self.period().and(self.repeats()).map(|(_, since)| at(since))
    }

    /// Forcing periods of the window with a crossing, and with a release.
    pub fn periods_with(&self) -> (u64, u64) {
        (self.crossing_periods.count, self.release_periods.count)
    }

    /// The first crossing and release under a drive that changes; `end` is that of the run in forcing
    /// periods.
    pub fn firsts(&self, end: f64, amplitude: impl Fn(f64) -> Option<f64>) -> Option<Firsts> {
        let mut firsts = self.firsts;
        let lasting = |last: i64| last >= end.floor() as i64 - 1;
        if !self.last_crossing.is_some_and(lasting) {
            firsts.crossing_in_every_period = None;
        }
        let all = [&mut firsts.release, &mut firsts.crossing, &mut firsts.crossing_in_every_period];
        all.into_iter().flatten().for_each(|first| first.amplitude = amplitude(first.t));
        (self.rhythm == Rhythm::Changing).then_some(firsts)
    }

    /// Begins another settled window at the present instant, the end of the last one.
    pub fn open_window(&mut self) {
        self.from += self.periods;
        self.strobes.open_window();
        self.verdict = None;
        self.crossings = Crossings::new(self.periods);
        (self.crossing_periods, self.release_periods) = Default::default();
        (self.speed, self.crossed, self.last) = Default::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn classifier(periods: u64) -> Classifier {
        Classifier::new(Rhythm::Periodic, (1.0, 1.0), periods, 0)
    }

    /// One lap of `period` periods with a crossing in each but the last, and a state at each.
    fn lap(classifier: &mut Classifier, first: u64, period: u64) {
        for place in 0..period {
            classifier.strobe(Strobe { x: place as f64, v: 0.0 }, total(first + place, period));
            if place + 1 < period {
                classifier.crossing((first + place) as f64 + 0.5, Side::Right, 0.0);
            }
        }
    }

    /// The gain up to a stroboscopic state if all laps are alike.
    fn total(number: u64, period: u64) -> Gain {
        let (laps, place) = (number / period, number % period);
        ((laps * 3 * period + place * place) as f64, laps * (period - 1) + place)
    }

    #[test]
    fn laps_that_are_not_replayed_are_counted() {
        for period in [1, 2, 5, 13] {
            let laps = 200;
            for more in [0, 1, 250] {
                let periods = laps * period + more;
                let (mut long, mut short) = (classifier(periods), classifier(periods));
                // the motion before the laps may be different
                let transient = |classifier: &mut Classifier| {
                    (1..=more).for_each(|i| {
                        classifier.strobe(Strobe { x: -((i * i) as f64), v: 0.0 }, (i as f64, 0))
                    });
                    classifier.last = (0.0, 0);
                };
                transient(&mut long);
                transient(&mut short);
                long.begin_observations();
                lap(&mut long, 0, period);
                let gained = total(period, period);
                long.repeat((0, long.observed()), laps - 1, period, gained);
                (0..laps).for_each(|number| lap(&mut short, number * period, period));
                for classifier in [&mut long, &mut short] {
                    classifier.strobe(Strobe { x: 0.0, v: 0.0 }, total(laps * period, period));
                }
                let case = format!("{period} {more}");
                assert_eq!(long.period(), short.period(), "{case}");
                let all = more == 0 && period <= 12;
                assert_eq!(long.period(), all.then_some(period as u32), "{case}");
                assert_eq!(long.periods_with(), short.periods_with());
                assert_eq!(long.crossings_repeat(), short.crossings_repeat());
                assert_eq!(long.strobes.seen, short.strobes.seen);
                assert_eq!(long.settles_at(|at| at as f64), short.settles_at(|at| at as f64));
                // whole numbers, whose sums are exact
                let halves =
                    |classifier: &Classifier| format!("{:?} {:?}", classifier.speed, classifier.crossed);
                assert_eq!(halves(&long), halves(&short), "{case}");
            }
        }
    }

    #[test]
    fn irregular_motion_never_settles_and_is_steady_where_its_halves_agree() {
        let noise = |i: u64| f64::from((i * 7919 % 1009) as u32) / 1009.0;
        let run = |periods: u64, drift: f64| {
            let (mut classifier, mut sum) = (classifier(periods), 0.0);
            for i in 0..=periods {
                classifier.strobe(Strobe { x: noise(i), v: 0.0 }, (sum, 0));
                sum += 1.0 + noise(i) + drift * i as f64;
            }
            assert_eq!((classifier.period(), classifier.settled(false)), (None, Some(false)));
            classifier.steady(false)
        };
        assert_eq!(run(300, 0.0), Some(true));
        assert_eq!(run(300, 0.01), Some(false));
        assert_eq!(run(100, 0.0), Some(true));
        assert_eq!(run(7, 0.0), None);
    }

    #[test]
    fn under_a_drive_that_changes_the_first_events_are_known() {
        let mut classifier = Classifier::new(Rhythm::Changing, (1.0, 1.0), 10, 0);
        classifier.release(2.2, 2.2);
        for time in [3.5, 6.5, 7.5, 8.5, 9.5] {
            classifier.crossing(time, Side::Left, time);
        }
        let firsts = classifier.firsts(10.0, |t| Some(0.1 * t)).unwrap();
        assert_eq!(firsts.release.unwrap().t, 2.2);
        assert_eq!(firsts.crossing.unwrap().t, 3.5);
        assert_eq!(firsts.crossing_in_every_period, Some(First { t: 6.5, amplitude: Some(0.1 * 6.5) }));
        assert_eq!(classifier.firsts(12.0, |_| None).unwrap().crossing_in_every_period, None);
        assert_eq!(
            (classifier.settled(false), classifier.steady(false), classifier.period()),
            (None, None, None)
        );
        assert!(super::tests::classifier(4).firsts(1.0, |_| None).is_none());
    }
}
