//! View of the energy: sources, sinks, and the present energy compared with the barrier.
//!
//! Every number is from the ledger of the live run, or a difference of two ledgers. Energy supplied is
//! positive, energy taken negative, so that a column adds up to the stored energy.

use eframe::egui::{self, Align, Align2, Layout, Rect, RichText, Sense, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::Style;
use crate::app::words::numbers::UNKNOWN;
use crate::dynamics::LiveLedger;
use crate::output::{
    LedgerTerm, ledger_bars, ledger_decimals, ledger_number, share_of_work, suited_unit, three_digits,
};
use interwell_studies::study::Watch;

use super::ViewContext;
use super::pane::bare_panel;
use super::ranges::{axis_end, bottom};

/// Width in points of the names.
const NAMES: f32 = 64.0;
/// Width in points of the numbers.
const NUMBERS: f32 = 68.0;
/// Width in points of a share of the work, and of a column from which on there is room for one.
const SHARE: (f32, f32) = (44.0, 190.0);

/// Gap in points between a number and the bars beside it.
const GAP: f32 = 10.0;

/// Smallest and largest height of a row in points.
const ROWS: (f32, f32) = (17.0, 30.0);

/// Number of rows of the view, including the headings and the bar of the present energy.
const COUNT: f32 = 10.0;
/// The unit is a larger one from this number on.
const MANY: f64 = 1e4;

/// Height in points of the names below the bar of the present energy.
const LEGEND: f32 = 11.0;

const OF_WORK: &str = "The share of the work of the base that is taken so.";

/// What a row of the ledger means, in the order of [`LedgerTerm::ALL`].
const MEANINGS: [&str; LedgerTerm::ALL.len()] = [
    "Work of the base on the mass.",
    "Put in or taken out by you: a stop dragged over the mass, a mass put elsewhere, another potential under \
     it.",
    "Taken by damping.",
    "Taken by impacts: (1 - e²) of the kinetic energy each.",
    "Taken by the load and the coil of the transducer.",
    "The energy left in the mass and its mechanism.",
];

/// The unit in J that suits `energy`, which callers take from the speed scale so that the unit stays.
pub fn unit_of(energy: f64) -> (f64, &'static str) {
    let (per_joule, name) = suited_unit("J", std::iter::once(energy));
    (1.0 / per_joule, name)
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
    let compared = session.reference.apart().map(|apart| ledgers(&apart.watch));
    let count = COUNT + if model.has_transducer() { 1.0 } else { 0.0 };
    let row = (area.height() / count).clamp(ROWS.0, ROWS.1);
    let shaken = model.forcing_period().is_some();
    let column = (area.width() - NAMES) / if shaken { 2.0 } else { 1.0 };
    let [since_start, last_period] = ledgers(watch);
    let mut heads = [
        (since_start, "since the start", "From the start of the motion up to the time that is shown."),
        (last_period, "last period", "The last whole forcing period. Steady motion repeats it."),
    ];
    // both headings are short if a long one would overlap the other
    let width = |ui: &Ui, text: &str| {
        let font = egui::TextStyle::Body.resolve(ui.style());
        ui.painter().layout_no_wrap(text.to_owned(), font, style.faint()).size().x
    };
    if shaken && heads.iter().any(|head| width(ui, head.1) > column - GAP) {
        (heads[0].1, heads[1].1) = ("total", "period");
    }
    let heads = &heads[..if shaken { 2 } else { 1 }];
    let terms: Vec<(LedgerTerm, &str)> = LedgerTerm::ALL.into_iter().zip(MEANINGS).collect();
    let is_shown = |term: &LedgerTerm| term.name != LedgerTerm::TRANSDUCER.name || model.has_transducer();
    let terms: Vec<(LedgerTerm, &str)> = terms.into_iter().filter(|(term, _)| is_shown(term)).collect();
    // the columns share a scale
    let ghosts = compared.iter().flat_map(|ledgers| &ledgers[..heads.len()]);
    let all = heads.iter().map(|head| &head.0).chain(ghosts).flatten();
    let energies = all.flat_map(|ledger| LedgerTerm::ALL.map(|term| (term.energy)(ledger).abs()));
    let largest = energies.fold(0.0, f64::max);
    // the energies of a long motion need a larger unit
    let (unit, name) = if largest < MANY * unit { (unit, name) } else { unit_of(largest) };
    let mut y = area.top();
    for (i, (_, head, hover)) in heads.iter().rev().enumerate() {
        let rect = cell(area.left() + NAMES + column * i as f32, y, column, row);
        put_ui(ui, rect, RichText::new(*head).color(style.faint()), Align::Max, hover);
    }
    let hover = "Energy supplied is positive, energy taken negative: a column adds up to the stored energy.";
    let unit_name = RichText::new(format!("in {name}")).color(style.faint());
    put_ui(ui, cell(area.left(), y, NAMES, row), unit_name, Align::Min, hover);
    y += row;
    for (i, (term, about)) in terms.iter().enumerate() {
        let names = cell(area.left(), y + row * i as f32, NAMES, row);
        put_ui(ui, names, RichText::new(term.name).color(style.ink()), Align::Min, about);
    }
    let height = row * terms.len() as f32;
    for (i, (ledger, ..)) in heads.iter().enumerate() {
        let place = (heads.len() - 1 - i) as f32;
        let rect = cell(area.left() + NAMES + column * place, y, column, height);
        let Some(ledger) = ledger else {
            let hover = "Not kept yet: a whole period has to pass while this view is open.";
            for i in 0..terms.len() {
                let part = cell(rect.left(), y + row * i as f32, column, row);
                let text = RichText::new(UNKNOWN).color(style.faint());
                put_ui(ui, part.with_min_x(part.right() - NUMBERS), text, Align::Max, hover);
            }
            continue;
        };
        let other = compared.as_ref().and_then(|ledgers| ledgers[i].as_ref());
        ledger_ui(ui, &style, rect, &terms, (ledger, other), (unit, largest));
    }
    y += height;
    if let Some((upto, whole)) = watch.ledger_at(now) {
        let residual = whole.energy_residual();
        let hover = format!(
            "Up to {upto:.3} s: work + by changes - damping - impacts - stored = {:.1e} J, which is \
             {residual:.0e} of the energy moved. Every term is integrated separately, so that this is a \
             check of the run, though not its error.",
            whole.residual_j()
        );
        let text = format!("{} % of the energy accounted for", accounted(residual));
        let text = if width(ui, &text) > area.width() { text.replace("of the energy ", "") } else { text };
        put_ui(ui, cell(area.left(), y, area.width(), row), RichText::new(text), Align::Min, &hover);
    }
    y += 1.3 * row;
    present_ui(ui, context, area.with_min_y(y), (unit, name));
}

/// Draws the bars of a ledger with those of the reference, and beside them the numbers in a unit in J,
/// with the shares of the work where these have room. The bar of the `largest` value is longest.
fn ledger_ui(
    ui: &mut Ui,
    style: &Style,
    rect: Rect,
    terms: &[(LedgerTerm, &str)],
    (ledger, other): (&LiveLedger, Option<&LiveLedger>),
    (unit, largest): (f64, f64),
) {
    let decimals = ledger_decimals(ledger, unit);
    let left = rect.right() - NUMBERS;
    let right = left - if rect.width() >= SHARE.1 { SHARE.0 } else { 0.0 };
    let bars = Rect::from_min_max(rect.min + vec2(GAP, 0.0), pos2(right - 4.0, rect.bottom()));
    if bars.width() > 12.0 {
        let shown: Vec<LedgerTerm> = terms.iter().map(|(term, _)| *term).collect();
        bare_panel(ui.painter(), style, bars, &ledger_bars(&shown, ledger, other, (unit, largest)));
    }
    let row = rect.height() / terms.len() as f32;
    for (i, (term, about)) in terms.iter().enumerate() {
        let part = cell(rect.left(), rect.top() + row * i as f32, rect.width(), row);
        let joule = (term.energy)(ledger);
        // the stored energy has no share of the work
        let taken = share_of_work(joule, ledger, (unit, decimals));
        if let Some(text) = taken.filter(|_| right < left && term.name != LedgerTerm::STORED.name) {
            let place = part.with_min_x(right).with_max_x(left);
            put_ui(ui, place, RichText::new(text).color(style.faint()), Align::Max, OF_WORK);
        }
        let number = RichText::new(ledger_number(joule, unit, decimals));
        put_ui(ui, part.with_min_x(left), number, Align::Max, about);
    }
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
    let (bottom, _) = bottom(model);
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
        let end = format!("{} {name}", three_digits(scale / unit));
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
    let (potential, kinetic) = (three_digits(potential / unit), three_digits(kinetic / unit));
    response.on_hover_text(format!(
        "Now: potential {potential} and kinetic energy {kinetic} {name}, counted from the bottom of the \
         deeper well, or without one from the lower stop. Without shaking the mass crosses only where their \
         sum passes the barrier."
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_with_their_unit() {
        assert_eq!([6.9e-3, 2e-6, 1e-15].map(unit_of), [(1e-3, "mJ"), (1e-6, "µJ"), (1e-12, "pJ")]);
        assert_eq!([0.0, 1e-9, 3e-4, 2.0].map(accounted), ["100", "100", "99.97", "0.00"]);
    }
}
