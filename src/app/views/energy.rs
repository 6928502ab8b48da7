//! View of the energy: sources, sinks, and the present energy compared with the barrier.
//!
//! Every number is from the ledger of the live run, or a difference of two ledgers. Energy supplied is
//! positive, energy taken negative, so that a column adds up to the stored energy.

use eframe::egui::{self, Align, Align2, Color32, Layout, Rect, RichText, Sense, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::Style;
use crate::app::words::numbers::{UNKNOWN, with_minus};
use crate::dynamics::LiveLedger;
use crate::numeric::{self, elementary};
use interwell_studies::study::Watch;

use super::ViewContext;
use super::ghosts::dashed;
use super::ranges::{axis_end, bottom};

/// Width in points of the names.
const NAMES: f32 = 64.0;
/// Width in points of the numbers.
const NUMBERS: f32 = 68.0;
/// Width in points of a share of the work, and of a column from which on there is room for one.
const SHARE: (f32, f32) = (44.0, 190.0);

/// Gap in points between a number and the bars beside it.
const GAP: f32 = 10.0;

/// Distance in points between the lines of two pinned motions.
const GHOSTS: f32 = 2.5;

/// Smallest and largest height of a row in points.
const ROWS: (f32, f32) = (17.0, 30.0);

/// Number of rows of the view, including the headings and the bar of the present energy.
const COUNT: f32 = 10.0;

/// Height in points of the names below the bar of the present energy.
const LEGEND: f32 = 11.0;

/// Units of energy in J, with their names.
const UNITS: [(f64, &str); 5] = [(1.0, "J"), (1e-3, "mJ"), (1e-6, "µJ"), (1e-9, "nJ"), (1e-12, "pJ")];

/// A row of the ledger: name, explanation, signed value, colour.
type Row = (&'static str, &'static str, fn(&LiveLedger) -> f64, fn(&Style) -> Color32);

const STORED: &str = "stored";
const OF_WORK: &str = "The share of the work of the base that is taken so.";
const BY_HAND: &str = "Put in or taken out by you: a stop dragged over the mass, a mass put elsewhere, \
                       another potential under it.";
const IN_IMPACTS: &str = "Taken by impacts: (1 - e²) of the kinetic energy each.";
const IN_TRANSDUCER: &str = "Taken by the load and the coil of the transducer.";

/// The row that only a scene with a transducer has.
const TRANSDUCER: &str = "transducer";

const LEDGER: [Row; 6] = [
    ("work in", "Work of the base on the mass.", |ledger| ledger.work_j, Style::base),
    ("by hand", BY_HAND, |ledger| ledger.by_hand_j, Style::mass),
    ("damping", "Taken by damping.", |ledger| -ledger.damping_j, Style::faint),
    ("impacts", IN_IMPACTS, |ledger| -ledger.impact_j, Style::impact),
    (TRANSDUCER, IN_TRANSDUCER, |ledger| -(ledger.harvested_j + ledger.coil_j), Style::ink),
    (STORED, "What that leaves in the mass and its mechanism.", |ledger| ledger.stored_j, Style::ink),
];

/// The largest unit not above `energy`, which callers take from the speed scale so that the unit stays.
pub fn unit_of(energy: f64) -> (f64, &'static str) {
    UNITS.into_iter().find(|unit| energy >= unit.0).unwrap_or(UNITS[4])
}

/// Decimals of all numbers of a ledger: three, or one if any number has three digits before the point, or
/// where all are small as many as give the largest three digits, but no more than five.
pub fn decimals(ledger: &LiveLedger, unit: f64) -> usize {
    let largest = LEDGER.iter().map(|row| row.2(ledger).abs()).fold(0.0, f64::max) / unit;
    match largest {
        largest if largest >= 100.0 => 1,
        largest if largest > 0.0 => numeric::decimals(largest, 3).clamp(3, 5),
        _ => 3,
    }
}

/// What was taken as a share of the work of the base, in whole percent; `None` for what was put in, and where
/// there is no work or the value rounds to nothing.
fn share_of_work(joule: f64, ledger: &LiveLedger, is_nothing: bool) -> Option<String> {
    let share = -100.0 * joule / ledger.work_j;
    (ledger.work_j > 0.0 && joule < 0.0 && !is_nothing).then(|| format!("{share:.0} %"))
}

fn is_nothing(joule: f64, unit: f64, decimals: usize) -> bool {
    (joule / unit).abs() < 0.5 * elementary::powi(0.1, decimals as i32)
}

/// The share of the longest bar that a value is drawn as: 0 for what rounds to nothing.
fn share(joule: f64, unit: f64, decimals: usize, largest: f64) -> f64 {
    if is_nothing(joule, unit, decimals) { 0.0 } else { joule / largest }
}

/// A value of the ledger as text with its sign, in the given unit in J.
pub fn written(joule: f64, unit: f64, decimals: usize) -> String {
    let value = joule / unit;
    match is_nothing(joule, unit, decimals) {
        true => format!("{:.decimals$}", 0.0),
        false => with_minus(&format!("{value:+.decimals$}")),
    }
}

/// Percentage of the energy that the ledger accounts for, without decimals if it is 100.
fn accounted(residual: f64) -> String {
    let missing = 100.0 * residual.clamp(0.0, 1.0);
    if missing < 0.005 { "100".to_owned() } else { format!("{:.2}", 100.0 - missing) }
}

pub fn energy_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    let area = ui.available_rect_before_wrap().shrink2(vec2(10.0, 6.0));
    context.session.player.want_ledgers();
    let session = &context.session;
    let (model, watch, now) = (session.shown(), session.player.watch(), session.player.time());
    let (unit, name) = unit_of(model.mass() * model.scales().speed.powi(2));
    let ledgers = |watch: &Watch| [watch.ledger_at(now).map(|at| at.1), watch.last_period(now)];
    let pins: Vec<_> = session.pins.all().iter().map(|pin| (pin.place(), ledgers(&pin.watch))).collect();
    let count = COUNT + if model.has_transducer() { 1.0 } else { 0.0 };
    let row = (area.height() / count).clamp(ROWS.0, ROWS.1);
    let shaken = model.forcing_period().is_some();
    let column = (area.width() - NAMES) / if shaken { 2.0 } else { 1.0 };
    let [since_start, last_period] = ledgers(watch);
    let mut heads = [
        (since_start, "since the start", "From the start of the motion up to the time that is shown."),
        (last_period, "last period", "The last whole forcing period. Steady motion repeats it."),
    ];
    // both short where a long one would run into the other
    let width = |text: &str| {
        let font = egui::TextStyle::Body.resolve(ui.style());
        ui.painter().layout_no_wrap(text.to_owned(), font, style.faint()).size().x
    };
    if shaken && heads.iter().any(|head| width(head.1) > column - GAP) {
        (heads[0].1, heads[1].1) = ("total", "period");
    }
    let heads = &heads[..if shaken { 2 } else { 1 }];
    // the columns share a scale
    let ghosts = pins.iter().flat_map(|pin| &pin.1[..heads.len()]);
    let all = heads.iter().map(|head| &head.0).chain(ghosts).flatten();
    let largest = all.flat_map(|ledger| LEDGER.map(|row| row.2(ledger).abs())).fold(0.0, f64::max);
    let mut y = area.top();
    for (i, (_, head, hover)) in heads.iter().rev().enumerate() {
        let rect = cell(area.left() + NAMES + column * i as f32, y, column, row);
        put_ui(ui, rect, RichText::new(*head).color(style.faint()), Align::Max, hover);
    }
    let hover = "What came in counts up, what was taken counts down: a column adds up to what is stored.";
    let unit_name = RichText::new(format!("in {name}")).color(style.faint());
    put_ui(ui, cell(area.left(), y, NAMES, row), unit_name, Align::Min, hover);
    y += row;
    for entry in LEDGER.iter().filter(|entry| entry.0 != TRANSDUCER || model.has_transducer()) {
        let names = cell(area.left(), y, NAMES, row);
        put_ui(ui, names, RichText::new(entry.0).color(style.ink()), Align::Min, entry.1);
        for (i, (ledger, ..)) in heads.iter().rev().enumerate() {
            let rect = cell(area.left() + NAMES + column * i as f32, y, column, row);
            let Some(ledger) = ledger else {
                let hover = "Not kept: a whole period has to pass while this view is open.";
                let nothing = RichText::new(UNKNOWN).color(style.faint());
                put_ui(ui, rect.with_min_x(rect.right() - NUMBERS), nothing, Align::Max, hover);
                continue;
            };
            // the columns are drawn in reverse order of `heads`
            let column = heads.len() - 1 - i;
            let ghosts = pins.iter().filter_map(|pin| Some((pin.0, entry.2(pin.1[column].as_ref()?))));
            entry_ui(ui, &style, rect, entry, (ledger, unit, largest), &ghosts.collect::<Vec<_>>());
        }
        y += row;
    }
    if let Some((upto, whole)) = watch.ledger_at(now) {
        let residual = whole.energy_residual();
        let hover = format!(
            "Up to {upto:.3} s: work + by hand - damping - impacts - stored = {:.1e} J, which is \
             {residual:.0e} of what was moved. Every term is integrated on its own, so that this is a check \
             of the run, though not its error.",
            whole.residual_j()
        );
        let text = format!("{} % of the energy accounted for", accounted(residual));
        put_ui(ui, cell(area.left(), y, area.width(), row), RichText::new(text), Align::Min, &hover);
    }
    y += 1.3 * row;
    present_ui(ui, context, area.with_min_y(y), (unit, name));
}

/// Draws the bar of a row of a ledger with those of the pinned motions, its share of the work where that has
/// room, and its number in a unit in J. The bar of the `largest` value is longest.
fn entry_ui(
    ui: &mut Ui,
    style: &Style,
    rect: Rect,
    (name, hover, value, color): &Row,
    (ledger, unit, largest): (&LiveLedger, f64, f64),
    ghosts: &[(usize, f64)],
) {
    let (joule, decimals) = (value(ledger), decimals(ledger, unit));
    let numbers = rect.with_min_x(rect.right() - NUMBERS);
    let shares = if rect.width() >= SHARE.1 { SHARE.0 } else { 0.0 };
    let right = numbers.left() - shares;
    let bars = Rect::from_min_max(rect.min + vec2(GAP, 0.0), pos2(right - 4.0, rect.bottom()));
    let (middle, half) = (bars.center().x, 0.5 * bars.width() - 2.0);
    // to the right for energy supplied, to the left for energy taken
    let end = |joule: f64| middle + share(joule, unit, decimals, largest) as f32 * half;
    if half > 4.0 {
        let thick = (0.5 * bars.height()).min(12.0);
        let from = pos2(middle, bars.center().y - 0.5 * thick);
        if end(joule) != middle {
            let to = pos2(end(joule), bars.center().y + 0.5 * thick);
            ui.painter().rect_filled(Rect::from_two_pos(from, to), 0.0, color(style));
        }
        ui.painter().vline(middle, bars.y_range(), style.ghost_stroke());
        for (place, ghost) in ghosts.iter().filter(|ghost| end(ghost.1) != middle) {
            let y = bars.bottom() - 1.0 - GHOSTS * *place as f32;
            let ends = [pos2(middle, y), pos2(end(*ghost), y)];
            ui.painter().extend(dashed(&ends, *place, style.motion_stroke()));
        }
    }
    // what the mass has gained or lost is no share
    let taken = share_of_work(joule, ledger, is_nothing(joule, unit, decimals));
    if let Some(text) = taken.filter(|_| shares > 0.0 && *name != STORED) {
        let place = numbers.with_min_x(right).with_max_x(numbers.left());
        put_ui(ui, place, RichText::new(text).color(style.faint()), Align::Max, OF_WORK);
    }
    put_ui(ui, numbers, RichText::new(written(joule, unit, decimals)), Align::Max, hover);
}

fn cell(x: f32, y: f32, width: f32, height: f32) -> Rect {
    Rect::from_min_size(pos2(x, y), vec2(width, height))
}

fn put_ui(ui: &mut Ui, rect: Rect, text: RichText, align: Align, hover: &str) {
    let layout = match align {
        Align::Max => Layout::right_to_left(Align::Center),
        _ => Layout::left_to_right(Align::Center),
    };
    let builder = egui::UiBuilder::new().max_rect(rect).layout(layout);
    ui.scope_builder(builder, |ui| ui.add(egui::Label::new(text).extend()).on_hover_text(hover));
}

/// Draws the present potential and kinetic energy above the deeper well, and the height of the barrier.
fn present_ui(ui: &mut Ui, context: &mut ViewContext<'_>, rect: Rect, (unit, name): (f64, &str)) {
    let style = context.style;
    let kinetic_room = context.memory.ranges.follow(context.session).kinetic();
    let (session, state) = (&context.session, context.session.player.state());
    let model = session.shown();
    let (kinetic, potential) = model.energies(state.x, state.v);
    let mechanism = model.mechanism();
    // without a well, energy is counted from the lower stop
    let bottom = bottom(model);
    let potential = (potential - bottom).max(0.0);
    let barrier = mechanism.landscape.barrier.map(|barrier| mechanism.curve.potential(barrier.x) - bottom);
    let scale = axis_end(kinetic_room.max(1.3 * barrier.unwrap_or(0.0)).max(1e-300));
    if rect.height() < 34.0 {
        return;
    }
    let thick = (0.32 * rect.height()).clamp(10.0, 22.0);
    let track = Rect::from_min_size(pos2(rect.left(), rect.top() + 14.0), vec2(rect.width(), thick));
    let screen_from_energy = |energy: f64| track.left() + (energy / scale).min(1.0) as f32 * track.width();
    let response = ui.interact(rect, ui.scope_id().with("present"), Sense::hover());
    let painter = ui.painter().with_clip_rect(rect.expand(4.0));
    painter.rect_filled(track, 0.0, style.grid());
    let (first, second) = (screen_from_energy(potential), screen_from_energy(potential + kinetic));
    painter.rect_filled(Rect::from_x_y_ranges(track.left()..=first, track.y_range()), 0.0, style.ink());
    painter.rect_filled(Rect::from_x_y_ranges(first..=second, track.y_range()), 0.0, style.mass());
    let below = track.bottom() + 3.0;
    if below + LEGEND <= rect.bottom() + 4.0 {
        let at = pos2(track.left(), below);
        let legend = painter.text(at, Align2::LEFT_TOP, "potential", style.small(), style.ink());
        let at = pos2(legend.right() + 8.0, below);
        painter.text(at, Align2::LEFT_TOP, "+ kinetic now", style.small(), style.mass_ink());
        let end = format!("{} {name}", short(scale / unit));
        painter.text(pos2(track.right(), below), Align2::RIGHT_TOP, end, style.small(), style.faint());
    }
    if let Some(barrier) = barrier {
        let x = screen_from_energy(barrier);
        let heights = track.y_range().expand(3.0);
        painter.vline(x, heights, Stroke::new(style.tray_stroke().width + 2.0, style.ground()));
        painter.vline(x, heights, style.barrier_stroke());
        let at = pos2(x, track.top() - 2.0);
        painter.text(at, Align2::CENTER_BOTTOM, "barrier", style.small(), style.faint());
    }
    let (potential, kinetic) = (short(potential / unit), short(kinetic / unit));
    response.on_hover_text(format!(
        "Now: potential {potential} and kinetic energy {kinetic} {name}, counted from the bottom of the \
         deeper well, or without one from the lower stop. Without shaking the mass crosses only where their \
         sum passes the barrier."
    ));
}

/// A number with three digits.
fn short(value: f64) -> String {
    let decimals = (2.0 - elementary::log10(value.abs().max(1e-6)).floor()).clamp(0.0, 3.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_with_their_sign_and_unit() {
        assert_eq!(unit_of(6.9e-3), (1e-3, "mJ"));
        assert_eq!(unit_of(0.0), (1e-12, "pJ"));
        assert_eq!(written(1.2345e-3, 1e-3, 3), "+1.234");
        assert_eq!(written(-0.25, 1e-3, 1), "\u{2212}250.0");
        assert_eq!(written(-1e-9, 1e-3, 3), "0.000");
        assert_eq!(share(4e-7, 1e-3, 3, 1e-6), 0.0);
        assert_eq!((share(6e-7, 1e-3, 3, 1e-6), share(0.0, 1e-3, 3, 0.0)), (0.6, 0.0));
        // one large number sets the decimals of all
        let ledger = LiveLedger { work_j: 0.3, damping_j: 1e-3, ..LiveLedger::default() };
        assert_eq!((decimals(&ledger, 1e-3), decimals(&LiveLedger::default(), 1e-3)), (1, 3));
        let small = LiveLedger { work_j: 3.12e-6, impact_j: 2.91e-6, ..LiveLedger::default() };
        assert_eq!((decimals(&small, 1e-3), written(small.work_j, 1e-3, 5)), (5, "+0.00312".to_owned()));
        assert_eq!(share_of_work(-small.impact_j, &small, false).as_deref(), Some("93 %"));
        assert_eq!(share_of_work(small.work_j, &small, false), None);
        assert_eq!([0.0, 1e-9, 3e-4, 2.0].map(accounted), ["100", "100", "99.97", "0.00"]);
        assert_eq!((short(1.2), short(1000.0), short(0.0)), ("1.2".into(), "1000".into(), "0".into()));
    }
}
