//! Plot of the run in fixed steps over the true one, with the errors in words.

use eframe::egui::{self, ComboBox, TextStyle, Ui, UiBuilder};

use crate::app::session::accuracy::Accuracy;
use crate::numeric;
use crate::output::steps_panel;
use crate::scene::read_number;
use interwell_studies::study::accuracy::methods::Scheme;
use interwell_studies::study::accuracy::scene::{StepSize, duration, step_name};

use super::super::plot::plot_ui;
use super::super::{View, ViewContext};
use super::waiting_ui;

/// Ends of the slider in s.
const RANGE: (f64, f64) = (1e-5, 1.0 / 30.0);
/// Steps in s with their names and hover texts.
const NAMED: [(f64, &str, &str); 4] = [
    (1.0 / 30.0, "1/30 s", "A film of thirty pictures a second"),
    (1.0 / 60.0, "1/60 s", "One frame of a screen: a step as games and small applets take it"),
    (1e-3, "1 ms", "A thousand steps a second"),
    (1e-4, "0.1 ms", "Ten thousand steps a second"),
];

/// Width in points above which method and step stand in one row.
const ONE_ROW: f32 = 400.0;
/// Height in points below which the buttons of the named steps are left out.
const NAMES: f32 = 225.0;

/// Smallest height of the plot in points.
const PLOT: f32 = 70.0;

/// Height in points of a line of text below the plot.
const LINE_HEIGHT: f32 = 19.0;

pub fn steps_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    choice_ui(ui, context);
    let style = context.style;
    let (model, accuracy) = (context.session.model(), &context.session.accuracy);
    let Some((known, current)) = accuracy.stepped(model) else {
        return waiting_ui(ui, context);
    };
    let known = match known {
        Ok(known) => known.clone(),
        Err(unfit) => {
            ui.label(format!("Not for this scene: {unfit}."));
            return;
        }
    };
    let stops = <[_; 2]>::from(model.stop_positions()).map(|stop| stop.unwrap_or(f64::NAN));
    ui.scope(|ui| {
        if !current {
            ui.set_opacity(0.5);
        }
        let mut sentences = known.sentences();
        let whole = sentences.join(" ");
        let rest = ui.available_rect_before_wrap();
        // one sentence per line if the plot has enough room
        let is_high = rest.height() > LINE_HEIGHT * sentences.len() as f32 + 2.0 * PLOT;
        let font = TextStyle::Body.resolve(ui.style());
        let layout = |sentences: &[String]| {
            let text = sentences.join(if is_high { "\n" } else { " " });
            let galley = ui.painter().layout(text.clone(), font.clone(), style.ink(), rest.width());
            (text, galley.size().y)
        };
        let (mut text, mut height) = layout(&sentences);
        // sentences that do not fit are shown on hover
        while height > rest.height() && sentences.len() > 1 {
            sentences.pop();
            (text, height) = layout(&sentences);
        }
        let below = height + 6.0;
        let plot = rest.with_max_y((rest.bottom() - below).max(rest.top()));
        let mut top = rest.top();
        if plot.height() >= PLOT {
            let panel = steps_panel(&known, 1, stops.into());
            plot_ui(ui, context.memory, View::Accuracy, &style, plot, &panel).read(ui, &style, &panel);
            top = plot.bottom() + 4.0;
        }
        ui.scope_builder(UiBuilder::new().max_rect(rest.with_min_y(top)), |ui| {
            ui.label(text).on_hover_text(format!("{whole}\n\n{}", about(&known)));
        });
    });
}

/// Description of the run and of the comparison.
fn about(known: &StepSize) -> String {
    let (span, count, step) = (duration(known.span), known.stepped.steps, step_name(known.step));
    format!(
        "The first {span} of the scene from its start, {count} steps of {step}. A step that ends beyond a \
         stop is put onto it, and the mass bounces from there (clamp and bounce). The true run locates each \
         impact; it counts those down to a millionth of the scene's speed, and the rest of a chatter in one \
         sum."
    )
}

fn choice_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let accuracy = &mut context.session.accuracy;
    let is_one_row = ui.available_width() > ONE_ROW;
    ui.horizontal(|ui| {
        method_ui(ui, accuracy);
        if is_one_row {
            step_ui(ui, accuracy);
        }
    });
    if !is_one_row {
        ui.horizontal(|ui| step_ui(ui, accuracy));
    }
    if ui.available_height() < NAMES {
        return;
    }
    ui.horizontal(|ui| {
        for (step, name, hover) in NAMED {
            let is_chosen = (accuracy.step / step - 1.0).abs() < 1e-6;
            if ui.selectable_label(is_chosen, name).on_hover_text(hover).clicked() {
                accuracy.step = step;
            }
        }
    });
}

fn method_ui(ui: &mut Ui, accuracy: &mut Accuracy) {
    let name = ui.label("method");
    let combo = ComboBox::from_id_salt("method of fixed step").selected_text(accuracy.scheme.name());
    let combo = combo.show_ui(ui, |ui| {
        for scheme in Scheme::ALL {
            ui.selectable_value(&mut accuracy.scheme, scheme, scheme.name()).on_hover_text(hint(scheme));
        }
    });
    combo.response.labelled_by(name.id).on_hover_text(hint(accuracy.scheme));
}

fn step_ui(ui: &mut Ui, accuracy: &mut Accuracy) {
    let hover = "Increase: fewer and longer steps, which cost less and resolve less.";
    let name = ui.label("step").on_hover_text(hover);
    ui.spacing_mut().slider_width = (ui.available_width() - 84.0).clamp(70.0, 260.0);
    let slider = egui::Slider::new(&mut accuracy.step, RANGE.0..=RANGE.1)
        .logarithmic(true)
        .smart_aim(false)
        .custom_formatter(|step, _| step_name(step))
        .custom_parser(parsed);
    let response = ui.add(slider).labelled_by(name.id).on_hover_text(hover);
    if response.changed() {
        accuracy.step = rounded(accuracy.step);
    }
}

fn hint(scheme: Scheme) -> &'static str {
    match scheme {
        Scheme::SemiImplicitEuler => {
            "Velocity first, then displacement by the new velocity: the simplest that keeps a swing alive. \
             Half the step, half the error."
        }
        Scheme::VelocityVerlet => "Usual for molecules and games. Half the step, a quarter of the error.",
        Scheme::RungeKutta4 => {
            "The classical method of Runge and Kutta, four evaluations of the force a step. Half the step, a \
             sixteenth of the error, except at impacts."
        }
    }
}

/// A step rounded to two digits, or to the named step that it nearly equals.
fn rounded(step: f64) -> f64 {
    if let Some(named) = NAMED.iter().find(|named| (step / named.0 - 1.0).abs() < 0.02) {
        return named.0;
    }
    numeric::rounded(step, 2).clamp(RANGE.0, RANGE.1)
}

/// A typed step: a number or arithmetic, such as 1/1000, in s, ms or µs.
fn parsed(text: &str) -> Option<f64> {
    let text = text.trim();
    let units = [("ms", 1e-3), ("µs", 1e-6), ("us", 1e-6), ("s", 1.0), ("", 1.0)];
    let (number, unit) = units.iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, *unit)))?;
    Some(read_number(number).ok()? * unit).filter(|step| step.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_typed_in_any_unit() {
        assert_eq!(parsed("1/60 s"), Some(1.0 / 60.0));
        assert_eq!(parsed("1/60"), Some(1.0 / 60.0));
        assert_eq!(parsed(" 2 ms"), Some(2e-3));
        assert_eq!(parsed("0.004"), Some(4e-3));
        assert_eq!(parsed("fast"), None);
        assert_eq!(rounded(0.01668), 1.0 / 60.0);
        assert_eq!(rounded(0.0012345), 1.2e-3);
    }
}
