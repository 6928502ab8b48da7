//! View of the power into the load of a transducer, or of the base on the mass without a transducer.

use eframe::egui::{Frame, Label, Margin, RichText, Ui};

use crate::app::session::Session;
use crate::app::words::numbers::{power, three};
use crate::dynamics::{Outcome, Summary};
use crate::output::suited_unit;
use crate::scene::Transducer;

use super::ViewContext;
use super::ranges::axis_end;
use super::trace::{TraceQuantity, trace_ui};

/// Greatest share of the height that the whole text takes, in place of its first line.
const WORDS: f32 = 0.3;

/// Text for a scene without a transducer.
const HINT: &str = "The work of the base. This scene has no transducer: add one to its file, such as \
                    transducer: Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: 60), or open \
                    the scene harvester.";

pub fn power_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    let has_transducer = context.session.shown().has_transducer();
    let words = if has_transducer { harvested(context.session) } else { vec![HINT.to_owned()] };
    let whole = words.join("\n");
    Frame::new().inner_margin(Margin::symmetric(10, 4)).show(ui, |ui| {
        let galley = ui.painter().layout(whole.clone(), style.body(), style.ink(), ui.available_width());
        let text = |words: &str| Label::new(RichText::new(words).font(style.body()));
        if galley.size().y > WORDS * ui.available_height() {
            ui.add(text(&words[0]).truncate()).on_hover_text(whole);
        } else {
            words.iter().for_each(|line| _ = ui.add(text(line).wrap()));
        }
    });
    let mut quantity = TraceQuantity::Power;
    if has_transducer {
        let end = axis_end(context.memory.ranges.follow(context.session).load_power());
        let (per_watt, unit) = suited_unit("W", std::iter::once(end));
        quantity = TraceQuantity::LoadPower { per_watt: per_watt as u32, unit };
    }
    trace_ui(ui, quantity, context);
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
