//! Plot of the run in fixed steps over the true one, with the errors in words.

use eframe::egui::{self, ComboBox, Rect, TextStyle, Ui, UiBuilder, vec2};
use egui_plot::{HLine, Line, LineStyle, PlotBounds, PlotPoint, PlotPoints, Points};

use crate::app::session::accuracy::Accuracy;
use crate::app::ui::style::Style;
use crate::numeric::extent;
use crate::output::Area;
use crate::study::accuracy::methods::Scheme;
use crate::study::accuracy::scene::{StepSize, step_name};

use super::super::ViewContext;
use super::super::legend::{LEGEND, Symbol, legend};
use super::super::plot::{even, marks, plot_place, still_plot};
use super::waiting::waiting_ui;

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

/// Width in points of the numbers of the vertical axis.
const AXIS_WIDTH: f32 = 44.0;

/// Height in points below which the names of the axes are left out.
const LOW: f32 = 170.0;
/// Margin in points at the right end, for a number.
const MARGIN: f32 = 14.0;

/// Largest number of steps that are drawn as dots.
const MAX_DOTS: usize = 150;

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
    let (left, right) = model.stop_positions();
    let stops = [left, right].map(|stop| stop.map(|stop| stop * 1e3));
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
            plot_ui(ui, &style, plot, &known, stops);
            top = plot.bottom() + 4.0;
        }
        ui.scope_builder(UiBuilder::new().max_rect(rest.with_min_y(top)), |ui| {
            ui.label(text).on_hover_text(format!("{whole}\n\n{}", about(&known)));
        });
    });
}

/// Description of the run and of the comparison.
fn about(known: &StepSize) -> String {
    format!(
        "The first {} of the scene from its start, {} steps of {}. A step that ends beyond a stop is put \
         onto it, and the mass bounces from there (clamp and bounce). The true run locates each impact; it \
         counts those down to a millionth of the scene's speed, and the rest of a chatter in one sum.",
        crate::study::accuracy::scene::duration(known.span),
        known.stepped.steps,
        step_name(known.step)
    )
}

fn choice_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let accuracy = &mut context.session.accuracy;
    if ui.available_width() > ONE_ROW {
        ui.horizontal(|ui| {
            method_ui(ui, accuracy);
            step_ui(ui, accuracy);
        });
    } else {
        ui.horizontal(|ui| method_ui(ui, accuracy));
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
    let hover = "Increase: fewer and longer steps, which cost less and see less.";
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
        Scheme::VelocityVerlet => "What molecules and games move by. Half the step, a quarter of the error.",
        Scheme::RungeKutta4 => {
            "The classical method of Runge and Kutta, four looks at the force a step. Half the step, a \
             sixteenth of the error, except at impacts."
        }
    }
}

/// A step rounded to two digits, or to the named step that it nearly equals.
fn rounded(step: f64) -> f64 {
    if let Some(named) = NAMED.iter().find(|named| (step / named.0 - 1.0).abs() < 0.02) {
        return named.0;
    }
    format!("{step:.1e}").parse().unwrap_or(step).clamp(RANGE.0, RANGE.1)
}

/// A typed step: a fraction of a second, or a number of ms, µs or s.
fn parsed(text: &str) -> Option<f64> {
    let text = text.trim();
    let units = [("ms", 1e-3), ("µs", 1e-6), ("us", 1e-6), ("s", 1.0), ("", 1.0)];
    let (number, unit) = units.iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, *unit)))?;
    let value = match number.split_once('/') {
        Some((above, below)) => above.trim().parse::<f64>().ok()? / below.trim().parse::<f64>().ok()?,
        None => number.trim().parse().ok()?,
    };
    Some(value * unit).filter(|step| step.is_finite())
}

fn plot_ui(ui: &mut Ui, style: &Style, area: Rect, known: &StepSize, stops: [Option<f64>; 2]) {
    let path = |points: &[(f64, f64)]| -> Vec<PlotPoint> {
        points.iter().map(|(t, x)| PlotPoint::new(*t, x * 1e3)).collect()
    };
    let (truth, ghost) = (path(&known.truth), path(&known.ghost));
    // a diverging run leaves the picture
    let (low, high) = extent(truth.iter().map(|point| point.y));
    let room = (0.12 * (high - low)).max(1e-6);
    let (low, high) = (low - room, high + room);
    let entries = [
        (Symbol::Line(style.motion_stroke()), "true"),
        (Symbol::Dashed(style.impact_stroke()), known.scheme.name()),
    ];
    legend(ui, style, area, area.right(), &entries);
    let rows = f64::from((area.height() / 40.0).clamp(2.0, 6.0));
    let columns = f64::from((area.width() / 80.0).clamp(2.0, 8.0));
    let is_low = area.height() < LOW;
    let (time_label, axis) = if is_low { ("", "mm") } else { ("time (s)", "displacement (mm)") };
    let rect = Rect::from_min_max(area.min + vec2(0.0, LEGEND), area.max - vec2(MARGIN, 0.0));
    let mut ui = plot_place(ui, style, rect);
    let (end, edge) = (known.drawn, 0.02 * (high - low));
    still_plot(("step size", end.to_bits()))
        .allow_drag([true, false])
        .allow_zoom([true, false])
        .allow_double_click_reset(true)
        .default_x_bounds(0.0, end)
        .default_y_bounds(low, high)
        .x_axis_label(time_label)
        .y_axis_label(axis)
        .y_axis_min_width(AXIS_WIDTH)
        .x_grid_spacer(|input| marks(&even(input.bounds.0, input.bounds.1, columns)))
        .y_grid_spacer(|_| marks(&even(low + edge, high - edge, rows)))
        .show(&mut ui, |plot| {
            let seen = plot.plot_bounds();
            let bounds = PlotBounds::from_min_max([seen.min()[0], low], [seen.max()[0], high]);
            plot.set_plot_bounds(bounds);
            for (value, _) in even(low, high, rows).ticks {
                plot.hline(HLine::new("", value).stroke(style.grid_stroke()));
            }
            for stop in stops.into_iter().flatten() {
                plot.hline(HLine::new("", stop).stroke(style.stop_stroke()));
            }
            plot.line(Line::new("true", PlotPoints::Owned(truth)).stroke(style.motion_stroke()));
            // egui_plot computes the dashes of a whole path before it clips them: a diverging solution or a
            // strong zoom gives more than fit into memory
            let shown = Area::new(bounds.min()[0], bounds.min()[1], bounds.max()[0], bounds.max()[1]);
            for piece in shown.parts(&ghost.iter().map(|point| (point.x, point.y)).collect::<Vec<_>>()) {
                let piece = piece.into_iter().map(|(x, y)| PlotPoint::new(x, y)).collect();
                let line = Line::new("ghost", PlotPoints::Owned(piece)).stroke(style.impact_stroke());
                plot.line(line.style(LineStyle::dashed_dense()));
            }
            if ghost.len() <= MAX_DOTS {
                plot.points(Points::new("steps", PlotPoints::Owned(ghost)).radius(2.4).color(style.impact()));
            }
        });
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
