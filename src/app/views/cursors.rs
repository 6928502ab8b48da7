//! Two time cursors shared by all views over time, with a readout of the values at them.

use eframe::egui::{Align2, Frame, Key, Label, Margin, RichText, Shape, Ui, WidgetInfo, pos2, vec2};

use crate::app::session::Session;
use crate::app::ui::style::GRAB;
use crate::app::ui::widgets::{arrows, keep_arrows};
use crate::app::words::numbers::{below, decimals_for, three, with_minus};

use super::ViewContext;
use super::labels::plated;
use super::plot::Plotted;
use super::view::Axis;
use super::zoom::Ends;

/// Initial positions of the cursors, as shares of the time range shown.
const INITIAL: [f64; 2] = [0.5, 0.75];

/// Smallest number of arrow-key steps over the time range shown.
const STEPS: f64 = 500.0;

/// Decimals of a cursor's time beyond the three significant digits of the range shown.
const EXTRA_DECIMALS: usize = 2;

/// The two time cursors.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cursors {
    pub on: bool,
    /// Their times in s.
    pub at: [f64; 2],
    /// Whether the first cursor takes the keyboard focus in the next view that shows it.
    focus: bool,
}

impl Cursors {
    fn put(&mut self, which: usize, t: f64, session: &Session) {
        let (begin, end) = recorded_range(session);
        self.at[which] = t.clamp(begin, end);
    }
}

/// First and last time in s of the recorded motion.
fn recorded_range(session: &Session) -> Ends {
    let watch = session.player.watch();
    (watch.begin(), watch.time().max(watch.begin()))
}

/// Time of the next event after `t` in s for `Some(true)`, of the previous one for `Some(false)`, else
/// of the nearest.
fn event(session: &Session, t: f64, later: Option<bool>) -> Option<f64> {
    let events = session.player.watch().events();
    let before = events.partition_point(|event| event.t < t).checked_sub(1);
    let before = before.and_then(|i| events.get(i)).map(|event| event.t);
    let from = if later.is_some() { events.partition_point(|event| event.t <= t) } else { 0 };
    let after = events.range(from..).find(|event| event.t >= t).map(|event| event.t);
    match (later, before, after) {
        (Some(true), _, after) => after,
        (Some(false), before, _) => before,
        (None, Some(a), Some(b)) => Some(if t - a < b - t { a } else { b }),
        (None, a, b) => a.or(b),
    }
}

/// Writes time, phase and value `at_each` cursor, and the differences `between` the two, where times of this
/// `length` in s are shown.
pub(super) fn readout_ui(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    length: f64,
    at_each: impl Fn(f64) -> String,
    between: impl Fn(f64, f64) -> String,
) {
    if !context.memory.cursors.on {
        return;
    }
    let (session, at, style) = (&context.session, context.memory.cursors.at, context.style);
    let (begin, end) = recorded_range(session);
    let decimals = decimals_for(length) + EXTRA_DECIMALS;
    let model_at = |t: f64| session.player.watch().model_at(t);
    let is_known = |t: f64| (begin..=end).contains(&t);
    let each = |i: usize| {
        let phase = model_at(at[i]).drive_phase(at[i]);
        let phase = phase.map_or_else(String::new, |turns| format!(", {:.1}°", 360.0 * turns));
        let value = if is_known(at[i]) { at_each(at[i]) } else { "not remembered".to_owned() };
        format!("{}: {:.decimals$} s{phase}, {value}", i + 1, at[i])
    };
    let span = at[1] - at[0];
    let rate = if span == 0.0 { String::new() } else { format!(" = 1 / {} Hz", three(1.0 / span.abs())) };
    let mut last = format!("2 \u{2212} 1: {span:.decimals$} s{rate}");
    if let Some(period) = model_at(at[1]).forcing_period() {
        last += &format!(" = {} periods", three(span / period));
    }
    if at.into_iter().all(is_known) {
        last += &format!(", {}", between(at[0], at[1]));
    }
    Frame::new().inner_margin(Margin::symmetric(8, 0)).show(ui, |ui| {
        (ui.spacing_mut().item_spacing, ui.spacing_mut().interact_size.y) = (vec2(14.0, 0.0), 0.0);
        ui.horizontal_wrapped(|ui| {
            for part in [each(0), each(1), last] {
                let text = RichText::new(with_minus(&part)).font(style.small()).color(style.ink());
                ui.add(Label::new(text).extend());
            }
        });
    });
}

/// Draws the cursors over a plot of times of this `length` in s. A drag moves one, with Ctrl to the nearest
/// event; focused, it moves by the left and right keys, with up and down to events.
pub(super) fn cursors_ui(
    ui: &mut Ui,
    context: &mut ViewContext<'_>,
    plotted: &Plotted,
    length: f64,
    name: &str,
) {
    if !context.memory.cursors.on {
        return;
    }
    let (frame, session) = (plotted.frame(), &*context.session);
    let snaps = ui.input(|input| input.modifiers.command);
    let snapped = |t: f64| event(session, t, None).filter(|_| snaps).unwrap_or(t);
    let cursors = &mut context.memory.cursors;
    for which in 0..2 {
        let t = cursors.at[which];
        let grip = plotted.handle(ui, ("cursor", which), t);
        let spoken = format!("cursor {}, {name}", which + 1);
        grip.widget_info(|| WidgetInfo::slider(true, t, &spoken));
        if which == 0 && std::mem::take(&mut cursors.focus) {
            grip.request_focus();
        }
        if let Some(pointer) = grip.interact_pointer_pos().filter(|_| grip.dragged()) {
            cursors.put(which, snapped(plotted.values(pointer).0), session);
        } else if grip.has_focus() {
            let step = below(length / STEPS);
            let moved = arrows(ui, grip.id);
            keep_arrows(ui, grip.id, true);
            if moved != 0.0 {
                cursors.put(which, ((t / step).round() + moved) * step, session);
            }
            for (key, later) in [(Key::ArrowUp, true), (Key::ArrowDown, false)] {
                if ui.input(|input| input.key_pressed(key))
                    && let Some(t) = event(session, t, Some(later))
                {
                    cursors.put(which, t, session);
                }
            }
        }
        let x = plotted.place((cursors.at[which], 0.0)).x;
        let (seen, at) = (frame.x_range().contains(x), x.clamp(frame.left(), frame.right()));
        let (style, painter) = (context.style, ui.painter().with_clip_rect(frame));
        let stroke = if grip.has_focus() { style.focus_stroke() } else { style.cursor_stroke() };
        let line = [pos2(at, frame.top()), pos2(at, frame.bottom())];
        match (seen, which) {
            (false, _) => {}
            (true, 0) => _ = painter.line_segment(line, stroke),
            (true, _) => painter.extend(Shape::dashed_line(&line, stroke, 6.0, 4.0)),
        }
        // a cursor outside the range is marked at the edge that it lies beyond
        let number = ["1", "2"][which];
        let (align, text) = match (seen, x < frame.left()) {
            (true, _) => (Align2::LEFT_TOP, number.to_owned()),
            (false, true) => (Align2::LEFT_TOP, format!("< {number}")),
            (false, false) => (Align2::RIGHT_TOP, format!("{number} >")),
        };
        let down = if seen { 2.0 } else { 2.0 + 16.0 * which as f32 };
        let beside = if seen { 0.5 * GRAB + 3.0 } else { 4.0 };
        let beside = if align == Align2::LEFT_TOP { beside } else { -beside };
        let place = (pos2(at + beside, frame.top() + down), align);
        plated(&painter, &style, place, painter.layout_no_wrap(text, style.body(), style.ink()));
    }
}

impl super::Memory {
    /// Shows the cursors, or hides them. If one would lie outside the visible range, both are placed anew.
    pub fn switch_cursors(&mut self, session: &Session) {
        let cursors = &mut self.cursors;
        cursors.on = !cursors.on;
        cursors.focus = cursors.on;
        let (begin, end) = recorded_range(session);
        let seen = self.axes.shown(Axis::Time);
        let (from, to) = seen.map_or((begin, end), |(from, to)| (from.max(begin), to.min(end)));
        // equal times: not placed yet
        if cursors.at[0] == cursors.at[1] || cursors.at.iter().any(|t| *t < from || *t > to) {
            cursors.at = INITIAL.map(|share| from + share * (to - from));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::session::editor::Editor;

    #[test]
    fn events_are_found_on_both_sides() {
        let mut session = Session::new(Editor::open("paper").unwrap(), std::sync::Arc::new(|| ())).unwrap();
        session.player.speed = 100.0;
        session.player.tick(0.1);
        let times: Vec<f64> = session.player.watch().events().iter().map(|event| event.t).collect();
        let i = (1..times.len() - 1).find(|i| times[i - 1] < times[*i] && times[*i] < times[i + 1]).unwrap();
        let (before, at, after) = (times[i - 1], times[i], times[i + 1]);
        assert_eq!(event(&session, at, Some(true)), Some(after));
        assert_eq!(event(&session, at, Some(false)), Some(before));
        assert_eq!(event(&session, at, None), Some(at));
        assert_eq!(event(&session, 0.4 * at + 0.6 * after, None), Some(after));
        assert_eq!(event(&session, 1e9, Some(true)), None);
    }
}
