//! Table of runs at several tolerances, with a plot of error over processor time where there is room.

use eframe::egui::{self, Grid, RichText, Ui};

use crate::app::ui::style::Style;
use crate::app::ui::widgets::tell;
use crate::numeric::elementary;
use crate::output::{Chart, Marks, Panel, PlotAxis, Role};
use interwell_studies::study::Table;
use interwell_studies::study::accuracy::scene::{
    AtTolerance, StepSize, Tolerances, duration, length_mm, moment, small_length, step_name,
};

use super::super::ViewContext;
use super::super::pane::fresh_pane_ui;
use super::waiting_ui;

/// Smallest height in points of the plot of error over processor time.
const PICTURE: f32 = 110.0;

pub fn digits_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    let (model, accuracy) = (context.session.model(), &context.session.accuracy);
    let Some((known, current)) = accuracy.tolerances(model) else {
        return waiting_ui(ui, context);
    };
    let (tolerance, known) = (model.tolerance(), known.clone());
    let stepped = accuracy.stepped(model).and_then(|(stepped, _)| stepped.as_ref().ok().cloned());
    ui.scope(|ui| {
        if !current {
            ui.set_opacity(0.5);
        }
        table_ui(ui, &style, &known, tolerance);
        let diverging = known.runs.iter().filter(|run| run.trusted.is_some()).count();
        if diverging > 0 {
            let text = "A path is trusted until it is off by 1 % of the travel.";
            ui.label(RichText::new(text).color(style.faint()));
        }
        // where all paths diverge, their largest errors say nothing
        if diverging == known.runs.len() {
            let text = "A thousand times the accuracy buys only a little more time: in chaos every small \
                        difference grows until it is all there is. Averages such as the RMS velocity stay.";
            ui.label(text);
            return;
        }
        let rest = ui.available_rect_before_wrap();
        if rest.height() > PICTURE && rest.width() > 200.0 {
            let pane = fresh_pane_ui(ui, &style, rest, chart(&known, tolerance, stepped.as_ref()));
            tell(&pane.response, egui::Role::Image, "error over processor time");
        }
    });
}

fn table_ui(ui: &mut Ui, style: &Style, known: &Tolerances, tolerance: f64) {
    let column = (ui.available_width() / 4.0 - 10.0).clamp(40.0, 130.0);
    Grid::new("digits").num_columns(4).min_col_width(column).spacing([8.0, 4.0]).show(ui, |ui| {
        let of_error = "How far the displacement is off at most, beside a run with a hundredth of the \
                        smallest tolerance.";
        let heads = [
            ("tolerance", "Error allowed in a step, in parts of the scene's length and speed."),
            ("error", of_error),
            ("time", "Processor time of the whole run."),
            ("steps", "Steps of the whole run."),
        ];
        for (head, hover) in heads {
            ui.label(RichText::new(head).color(style.faint())).on_hover_text(hover);
        }
        ui.end_row();
        for run in &known.runs {
            let is_of_scene = run.tolerance == tolerance;
            let text = |text: String| match is_of_scene {
                true => RichText::new(text).heading(),
                false => RichText::new(text),
            };
            let name = ui.label(text(format!("{:e}", run.tolerance)));
            if is_of_scene {
                name.on_hover_text("The tolerance of this scene: under More, Advanced.");
            }
            let (error, details) = error(run, known);
            ui.label(text(error)).on_hover_text(details);
            ui.label(text(duration(run.statistics.cpu_s)));
            ui.label(text(format!("{}", run.statistics.steps)));
            ui.end_row();
        }
    });
}

/// The time up to which the path is trusted if it diverges, else the largest error; and its details.
fn error(run: &AtTolerance, known: &Tolerances) -> (String, String) {
    let mm = length_mm(run.error);
    if let Some(t) = run.trusted.map(moment) {
        return (
            format!("trust to {t}"),
            format!("Off by 1 % of the travel at {t}, and by {mm} mm later on."),
        );
    }
    let error = match run.outcome.ended_at() {
        Some(_) => "ended early".to_owned(),
        None => small_length(run.error, known.travel).replace("about ", ""),
    };
    (error, format!("Off by {mm} mm at most, in {}.", duration(known.span)))
}

/// Share of the travel at which a zero error is drawn: the digits of a double.
const MIN_ERROR: f64 = 1e-16;

/// Error over processor time, of each run by its tolerance, and of one in fixed steps.
fn chart(known: &Tolerances, tolerance: f64, stepped: Option<&StepSize>) -> Chart {
    let smallest = MIN_ERROR * known.travel.max(f64::MIN_POSITIVE);
    let point = |time: f64, error: f64| (time.max(1e-9), 1e3 * error.max(smallest));
    let logs = |(x, y): (f64, f64)| (elementary::log10(x), elementary::log10(y));
    let runs: Vec<(f64, f64)> = known.runs.iter().map(|run| point(run.statistics.cpu_s, run.error)).collect();
    let ghost = stepped.filter(|run| run.stepped.ended_at.is_none());
    let ghost = ghost.map(|run| (point(run.stepped.cpu_s, run.error), run));
    let all = || runs.iter().copied().chain(ghost.map(|ghost| ghost.0));
    let across = PlotAxis::decades(all().map(|point| point.0), "processor time (s)");
    let mut panel = Panel::new(across, PlotAxis::decades(all().map(|point| point.1), "error (mm)"));
    let places: Vec<(f64, f64)> = runs.iter().map(|point| logs(*point)).collect();
    let names = known.runs.iter().map(|run| format!("{:e}", run.tolerance));
    let mut words: Vec<((f64, f64), String)> = places.iter().copied().zip(names).collect();
    panel.draw(Role::Motion, Marks::Path(places.clone()));
    panel.draw(Role::Interval, Marks::Points(places.clone()));
    let is_of_scene = |run: &(&AtTolerance, (f64, f64))| run.0.tolerance == tolerance;
    let of_scene: Vec<_> = known.runs.iter().zip(places).filter(is_of_scene).map(|run| run.1).collect();
    if !of_scene.is_empty() {
        panel.layer(Role::Unstable, "the tolerance of the scene", Marks::Points(of_scene));
    }
    if let Some((at, run)) = ghost {
        panel.layer(Role::Method(1), "fixed steps", Marks::Points(vec![logs(at)]));
        words.push((logs(at), format!("{} in steps of {}", run.scheme.name(), step_name(run.step))));
    }
    panel.draw(Role::Motion, Marks::Words(words));
    Chart::stack(vec![panel], "", Table::new())
}
