//! View of the power into the load of a transducer, or of the base on the mass without a transducer.

use eframe::egui::{self, Label, RichText, Ui, UiBuilder, vec2};

use crate::app::session::Session;
use crate::app::words::numbers::{power, three};
use crate::dynamics::{Outcome, Summary};
use crate::output::suited_unit;
use crate::scene::Transducer;

use super::ViewContext;
use super::ranges::axis_end;
use super::trace::{TraceQuantity, trace_ui};

/// Smallest height in points of the trace below the whole text.
const TRACE: f32 = 110.0;
/// Smallest height in points of the trace below the first line of text; a lower view has no text.
const LOW_TRACE: f32 = 28.0;

/// Text for a scene without a transducer.
const HINT: &str = "The work of the base. This scene has no transducer: add one to its file, such as \
                    transducer: Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 60), or open \
                    the scene harvester.";

pub fn power_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (style, area) = (context.style, ui.max_rect());
    let has_transducer = context.session.shown().has_transducer();
    let words = if has_transducer { harvested(context.session) } else { vec![HINT.to_owned()] };
    let place = area.shrink2(vec2(10.0, 4.0));
    let wrapped = |text: &str| {
        let galley = ui.painter().layout(text.to_owned(), style.body(), style.ink(), place.width());
        galley.size().y + ui.spacing().item_spacing.y
    };
    let height = words.iter().map(|line| wrapped(line)).sum::<f32>() + 6.0;
    let first = ui.text_style_height(&egui::TextStyle::Body) + 8.0;
    let coloured = |i: usize, line: &str| {
        let colour = if i == 0 && has_transducer { style.ink() } else { style.faint() };
        RichText::new(line).font(style.body()).color(colour)
    };
    let card = |height: f32| UiBuilder::new().max_rect(place.with_max_y(area.top() + height));
    let mut top = area.top();
    if area.height() - height >= TRACE {
        top += height;
        ui.scope_builder(card(height), |ui| {
            for (i, line) in words.iter().enumerate() {
                ui.add(Label::new(coloured(i, line)).wrap());
            }
        });
    } else if area.height() - first >= LOW_TRACE {
        top += first;
        ui.scope_builder(card(first), |ui| {
            ui.add(Label::new(coloured(0, &words[0])).truncate()).on_hover_text(words.join("\n"));
        });
    }
    let mut quantity = TraceQuantity::Power;
    if has_transducer {
        let end = axis_end(context.memory.ranges.follow(context.session).load_power());
        let (per_watt, unit) = suited_unit("W", std::iter::once(end));
        quantity = TraceQuantity::LoadPower { per_watt: per_watt as u32, unit };
    }
    let below = UiBuilder::new().max_rect(area.with_min_y(top));
    ui.scope_builder(below, |ui| trace_ui(ui, quantity, context));
}

/// Sentences on the harvested power: means, and the window over which they were taken.
fn harvested(session: &Session) -> Vec<String> {
    let Some(summary) = session.settled_now() else {
        return vec!["Into the load: the mean is being computed.".to_owned(), String::new()];
    };
    let harvest = summary.harvest;
    let means = || Some((harvest?.mean_load_power?, harvest?.mean_coil_power?, harvest?.voltage_rms?));
    let Some((load, coil, voltage)) = means() else {
        return vec!["Into the load: the run ended before there was a mean.".to_owned(), String::new()];
    };
    // no share of work that flows back to the base
    let share = match harvest.and_then(|harvest| harvest.load_share).filter(|share| *share >= 0.0) {
        Some(share) => format!(", {} % of the work of the base", three(100.0 * share)),
        None => String::new(),
    };
    let coil = match session.model().transducer() {
        Transducer::Electromagnetic { .. } => format!("Coil: mean {}. ", power(coil)),
        _ => String::new(),
    };
    vec![
        format!("Into the load: mean {}{share}.", power(load)),
        format!("{coil}Voltage: {} V RMS. {}", three(voltage), window_text(summary)),
    ]
}

/// Sentence on the window of the means, and on whether they are steady.
fn window_text(summary: &Summary) -> String {
    let (from, to) = summary.window;
    let length = three(to - from);
    match (summary.outcome, summary.settled) {
        (Outcome::Done, Some(true)) => format!("Means over {length} s of settled motion."),
        (Outcome::Done, Some(false)) if summary.steady == Some(true) => {
            format!("Means over {length} s, which are steady, of a motion without a period.")
        }
        (Outcome::Done, Some(false)) => {
            format!("Not settled: means over the last {length} s, which may still change.")
        }
        (Outcome::Done, None) => format!("The shaking changes: means over {length} s of it."),
        _ => format!("The run ended early: means over the {length} s before."),
    }
}
