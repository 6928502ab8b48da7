//! The x axis that the drawn mechanism and the well share.

use eframe::egui::Rect;

use crate::app::session::Session;

use super::ranges::axis_end;

/// Factor by which the axis exceeds the outermost well, stop or start.
const ROOM: f64 = 1.18;

/// Stops between these multiples of the displacement of the farther well widen the axis to the second one.
const STOP_STEP: (f64, f64) = (1.1, 1.35);

/// Factor by which the axis exceeds a displacement that was seen, before the next step.
const STEP_ROOM: f64 = 1.05;

/// Range of displacements in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    pub low: f64,
    pub high: f64,
}

impl Span {
    /// The range for a scene: its wells, or without two wells its stops and its start; and the displacements
    /// of the settled motion and those `seen`, in m. It depends on the shaking and on the stops as little as
    /// possible, and grows in coarse steps, so that it stands still while they are changed.
    pub fn of(session: &Session, seen: (f64, f64)) -> Self {
        let model = session.shown();
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut show = |x: f64| {
            if x.is_finite() {
                (low, high) = (low.min(x), high.max(x));
            }
        };
        let settled = session.settled().and_then(|settled| settled.range).unwrap_or((0.0, 0.0));
        let reach = [settled.0.min(seen.0), settled.1.max(seen.1)];
        if let Some(barrier) = &model.mechanism().landscape.barrier {
            show(barrier.left_well * ROOM);
            show(barrier.right_well * ROOM);
            let size = barrier.left_well.abs().max(barrier.right_well.abs());
            let (left, right) = model.stop_positions();
            for stop in [left, right].into_iter().flatten() {
                // stops slightly outside the wells widen the axis in one step
                if (STOP_STEP.0..STOP_STEP.1).contains(&(stop.abs() / size)) {
                    show(stop.signum() * size * STOP_STEP.1);
                }
            }
            for x in reach.into_iter().filter(|x| x.abs() > ROOM * size) {
                show(x.signum() * size * (x.abs() / size * 4.0 * 1.02).ceil() / 4.0);
            }
        } else {
            let (left, right) = model.stop_positions();
            let start = session.player.watch().samples().front().map_or(0.0, |sample| sample.x);
            show(0.0);
            show(start * ROOM);
            for (stop, x) in [left, right].into_iter().zip(reach) {
                // nothing moves beyond a stop
                let step = if x == 0.0 { 0.0 } else { x.signum() * axis_end(STEP_ROOM * x.abs()) };
                show(stop.map_or(step, |stop| stop * ROOM));
            }
        }
        if !(high - low > 0.0) {
            return Self { low: -0.01, high: 0.01 };
        }
        let margin = 0.03 * (high - low);
        Self { low: low - margin, high: high + margin }
    }

    /// The range that the mass can reach: beside wells up to its stops or, where it was beyond them before
    /// they were moved, up to there; without stops to the end of the range for the scene.
    pub fn within_stops(self, session: &Session, seen: (f64, f64)) -> Self {
        let model = session.shown();
        if model.mechanism().landscape.barrier.is_none() {
            return self;
        }
        let (left, right) = model.stop_positions();
        let reach = |stop: Option<f64>, seen: f64| stop.map(|stop| ROOM * stop.abs().max(seen.abs()));
        let mut ends = [reach(left, seen.0.min(0.0)), reach(right, seen.1.max(0.0))];
        // between equal stops the axis is symmetric
        if let ([Some(a), Some(b)], true) = (ends, left == right.map(|right| -right)) {
            ends = [Some(a.max(b)); 2];
        }
        let end =
            |reach: Option<f64>, end: f64| reach.map_or(end, |reach| reach.min(end.abs()) * end.signum());
        Self { low: end(ends[0], self.low), high: end(ends[1], self.high) }
    }

    /// The range over the whole of `rect` in which this one lies between these margins in points.
    pub fn beside(self, (left, right): (f32, f32), rect: Rect) -> Self {
        let scale = (self.high - self.low) / f64::from((rect.width() - left - right).max(1.0));
        Self { low: self.low - f64::from(left) * scale, high: self.high + f64::from(right) * scale }
    }

    /// Screen position of a displacement in m, over `rect`.
    pub fn screen_from_world(&self, x: f64, rect: Rect) -> f32 {
        let share = (x - self.low) / (self.high - self.low);
        rect.left() + (share * f64::from(rect.width())) as f32
    }

    /// Displacement in m of a screen position.
    pub fn world_from_screen(&self, x: f32, rect: Rect) -> f64 {
        self.low + f64::from((x - rect.left()) / rect.width()) * (self.high - self.low)
    }

    /// Points per m.
    pub fn scale(&self, rect: Rect) -> f64 {
        f64::from(rect.width()) / (self.high - self.low)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use eframe::egui::pos2;

    use super::*;
    use crate::app::session::editor::Editor;
    use crate::app::views::Memory;

    /// Checks that the axis holds the motion of the first `seconds`, and that it changes only a few times.
    fn holds_what_happens(preset: &str, seconds: f64) {
        let mut session = Session::new(Editor::open(preset).unwrap(), Arc::new(|| ())).unwrap();
        let mut memory = Memory::default();
        session.player.speed = 1.0;
        let (mut spans, mut last) = (0, Span { low: 0.0, high: 0.0 });
        while session.player.time() < seconds {
            session.player.tick(0.02);
            let span = memory.span(&session);
            spans += usize::from(span != last);
            last = span;
            let x = session.player.state().x;
            assert!(span.low < x && x < span.high, "{preset}: {x} {span:?}");
        }
        assert!(spans <= 12, "{preset}: {spans}");
        let seen = session.player.watch().samples();
        assert!(seen.iter().all(|sample| sample.x > last.low && sample.x < last.high), "{preset}");
    }

    #[test]
    fn what_happens_is_seen() {
        for (preset, seconds) in [("monostable", 2.0), ("bouncing-ball", 5.0), ("duffing", 40.0)] {
            holds_what_happens(preset, seconds);
        }
    }

    #[test]
    fn screen_and_world_are_inverse() {
        let span = Span { low: -8e-3, high: 8e-3 };
        let rect = Rect::from_min_max(pos2(100.0, 0.0), pos2(500.0, 10.0));
        assert_eq!(span.screen_from_world(0.0, rect), 300.0);
        assert!((span.world_from_screen(400.0, rect) - 4e-3).abs() < 1e-12);
    }

    #[test]
    fn an_axis_between_equal_stops_is_symmetric() {
        let session = |preset| Session::new(Editor::open(preset).unwrap(), Arc::new(|| ())).unwrap();
        let whole = Span { low: -9e-3, high: 9e-3 };
        let even = session("paper");
        // as a motion that was free before it got its stops
        let wide = whole.within_stops(&even, (-1.5e-3, 7.2e-3));
        assert!(wide.low == -wide.high && wide.high > 7.2e-3 && wide.high <= 9e-3, "{wide:?}");
        let kept = whole.within_stops(&even, (-1.5e-3, 1.5e-3));
        assert!(kept.low == -kept.high && kept.high < 3e-3, "{kept:?}");
        let uneven = whole.within_stops(&session("uneven-stops"), (-1e-4, 7.2e-3));
        assert!(uneven.low > -6e-3 && uneven.high > 7.2e-3, "{uneven:?}");
    }
}
