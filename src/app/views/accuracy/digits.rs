//! Table of runs at several tolerances, with a plot of error over processor time where there is room.

use eframe::egui::{self, Grid, RichText, Ui};

use crate::app::ui::style::Style;
use crate::app::ui::widgets::tell;
use crate::output::{Marks, cost_panel};
use interwell_studies::study::accuracy::scene::{
    AtTolerance, Tolerances, duration, length_mm, moment, small_length,
};

use super::super::ViewContext;
use super::super::plot::{Part, part_ui};
use super::super::view::{Axis, View};
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
                        difference grows until only averages agree, such as the RMS velocity.";
            ui.label(text);
            return;
        }
        let rest = ui.available_rect_before_wrap();
        if rest.height() > PICTURE && rest.width() > 200.0 {
            let mut panel = cost_panel(&known, tolerance, stepped.as_slice());
            // these are read under the pointer
            panel.layers.retain(|layer| !matches!(layer.marks, Marks::Words(_)));
            let axes = [Some(Axis::CostAcross), Some(Axis::CostUp)];
            let part = Part { view: View::Accuracy, name: "cost", axes };
            let plotted = part_ui(ui, context.memory, part, &style, rest, (&panel, [None; 2]));
            plotted.read(ui, &style, &panel);
            tell(&plotted.response, egui::Role::Image, "error over processor time");
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
