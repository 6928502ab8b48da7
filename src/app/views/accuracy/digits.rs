//! Table of runs at several tolerances, with a plot of error over processor time where there is room.

use eframe::egui::{Align2, Grid, Pos2, Rect, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use crate::app::ui::style::Style;
use crate::numeric::extent;
use crate::study::accuracy::scene::{
    AtTolerance, StepSize, Tolerances, duration, length_mm, moment, small_length, step_name,
};

use super::super::ViewContext;
use super::super::labels::haloed;
use super::waiting::waiting_ui;

/// Smallest height in points of the plot of error over processor time.
const PICTURE: f32 = 110.0;

/// Width and height in points reserved for the numbers of the axes.
const AXES: (f32, f32) = (52.0, 36.0);

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
            picture_ui(ui, &style, rest, &known, tolerance, stepped.as_ref());
        }
    });
}

fn table_ui(ui: &mut Ui, style: &Style, known: &Tolerances, tolerance: f64) {
    let column = (ui.available_width() / 4.0 - 10.0).clamp(40.0, 130.0);
    Grid::new("digits").num_columns(4).min_col_width(column).spacing([8.0, 4.0]).show(ui, |ui| {
        let heads = [
            ("tolerance", "Error allowed in a step, in parts of the scene's length and speed."),
            (
                "error",
                "How far the displacement is off at most, beside a run with a hundredth of the smallest \
                 tolerance.",
            ),
            ("time", "Processor time of the whole run."),
            ("steps", "Steps of the whole run."),
        ];
        for (head, hover) in heads {
            ui.label(RichText::new(head).color(style.faint())).on_hover_text(hover);
        }
        ui.end_row();
        for run in &known.runs {
            let is_of_scene = run.tolerance == tolerance;
            let text = |text: String| {
                let text = RichText::new(text);
                if is_of_scene { text.heading() } else { text }
            };
            let name = ui.label(text(format!("{:e}", run.tolerance)));
            if is_of_scene {
                name.on_hover_text("The tolerance of this scene: under More, Advanced.");
            }
            ui.label(text(error(run, known))).on_hover_text(error_details(run, known));
            ui.label(text(duration(run.statistics.cpu_s)));
            ui.label(text(format!("{}", run.statistics.steps)));
            ui.end_row();
        }
    });
}

/// Text on the error: the time up to which the path is trusted if it diverges, else the largest error.
fn error(run: &AtTolerance, known: &Tolerances) -> String {
    match run.trusted {
        Some(t) => format!("trust to {}", moment(t)),
        None if run.outcome.ended_at().is_some() => "ended early".to_owned(),
        None => small_length(run.error, known.travel).replace("about ", ""),
    }
}

/// Details of the error, for the hover text.
fn error_details(run: &AtTolerance, known: &Tolerances) -> String {
    match run.trusted {
        Some(t) => {
            format!("Off by 1 % of the travel at {}, and by {} mm later on.", moment(t), length_mm(run.error))
        }
        None => format!("Off by {} mm at most, in {}.", length_mm(run.error), duration(known.span)),
    }
}

/// Error over processor time, both by decades.
struct Axes {
    rect: Rect,
    /// Decimal logarithms of the ends: of times in s, of errors in m.
    times: (f64, f64),
    errors: (f64, f64),
}

/// Share of the travel at which a zero error is drawn: the digits of a double.
const MIN_ERROR: f64 = 1e-16;

impl Axes {
    fn new(rect: Rect, points: &[(f64, f64)]) -> Self {
        let ends = |of: fn(&(f64, f64)) -> f64| {
            let (low, high) = extent(points.iter().map(|point| of(point).log10()));
            ((low - 0.15).floor(), (high + 0.15).ceil())
        };
        Self { rect, times: ends(|point| point.0), errors: ends(|point| point.1) }
    }

    fn screen_from_world(&self, (time, error): (f64, f64)) -> Pos2 {
        let share = |value: f64, ends: (f64, f64)| ((value.log10() - ends.0) / (ends.1 - ends.0)) as f32;
        pos2(
            self.rect.left() + share(time, self.times) * self.rect.width(),
            self.rect.bottom() - share(error, self.errors) * self.rect.height(),
        )
    }
}

fn picture_ui(
    ui: &mut Ui,
    style: &Style,
    area: Rect,
    known: &Tolerances,
    tolerance: f64,
    stepped: Option<&StepSize>,
) {
    let smallest = MIN_ERROR * known.travel.max(f64::MIN_POSITIVE);
    let point = |time: f64, error: f64| (time.max(1e-9), error.max(smallest));
    let runs: Vec<(f64, f64)> = known.runs.iter().map(|run| point(run.statistics.cpu_s, run.error)).collect();
    let ghost = stepped.filter(|run| run.stepped.ended_at.is_none());
    let ghost = ghost.map(|run| point(run.stepped.cpu_s, run.error));
    let all: Vec<(f64, f64)> = runs.iter().copied().chain(ghost).collect();
    let rect = Rect::from_min_max(area.min + vec2(AXES.0, 24.0), area.max - vec2(22.0, AXES.1));
    let axes = Axes::new(rect, &all);
    let response = ui.interact(area, ui.scope_id().with("error over time"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "error over processor time"));
    let painter = ui.painter().with_clip_rect(area);
    let every = (((axes.errors.1 - axes.errors.0) as f32 * 18.0 / rect.height()).ceil() as i32).max(1);
    for power in axes.errors.0 as i32..=axes.errors.1 as i32 {
        let y = axes.screen_from_world((1.0, 10_f64.powi(power))).y;
        if power % every == 0 {
            painter.hline(rect.x_range(), y, style.grid_stroke());
            // in mm
            let text = match power + 3 {
                0 => "1".to_owned(),
                1 => "10".to_owned(),
                power => format!("1e{power}"),
            };
            let at = pos2(rect.left() - 6.0, y);
            painter.text(at, Align2::RIGHT_CENTER, text, style.small(), style.faint());
        }
    }
    for power in axes.times.0 as i32..=axes.times.1 as i32 {
        let x = axes.screen_from_world((10_f64.powi(power), 1.0)).x;
        painter.vline(x, rect.y_range(), style.grid_stroke());
        let text = duration(10_f64.powi(power)).replace(".0", "");
        painter.text(pos2(x, rect.bottom() + 3.0), Align2::CENTER_TOP, text, style.small(), style.faint());
    }
    let write = |at: Pos2, align: Align2, text: &str| {
        haloed(&painter, style, (at, align), text, (style.small(), style.faint()));
    };
    write(area.left_top() + vec2(2.0, 1.0), Align2::LEFT_TOP, "error (mm)");
    write(pos2(rect.center().x, area.bottom()), Align2::CENTER_BOTTOM, "processor time");
    let places: Vec<Pos2> = runs.iter().map(|point| axes.screen_from_world(*point)).collect();
    painter.line(places.clone(), style.motion_stroke());
    for (run, at) in known.runs.iter().zip(places) {
        painter.circle_filled(at, 4.0, style.motion());
        if run.tolerance == tolerance {
            painter.circle_stroke(at, 8.0, style.focus_stroke());
        }
        let text = format!("{:e}", run.tolerance);
        // on the side with more room
        let is_right = at.x > rect.center().x + 0.2 * rect.width();
        let (step, align) =
            if is_right { (-11.0, Align2::RIGHT_CENTER) } else { (11.0, Align2::LEFT_CENTER) };
        write(at + vec2(step, 0.0), align, &text);
    }
    if let (Some(run), Some(ghost)) = (stepped, ghost) {
        let at = axes.screen_from_world(ghost);
        painter.rect_filled(Rect::from_center_size(at, vec2(8.0, 8.0)), 0.0, style.impact());
        let text = format!("{} in steps of {}", run.scheme.name(), step_name(run.step));
        let is_right = at.x > rect.center().x;
        let (step, align) = if is_right { (-9.0, Align2::RIGHT_CENTER) } else { (9.0, Align2::LEFT_CENTER) };
        write(at + vec2(step, 0.0), align, &text);
    }
}
