//! View of a walk over one field, up and down: states or means of the motion, and hysteresis.

use eframe::egui::{self, Align2, Rect, Response, RichText, Ui, UiBuilder, vec2};

use crate::app::session::explore::WalkQuantity;
use crate::app::session::map::label;
use crate::app::ui::widgets::{choices_ui, segment_ui, tell};
use crate::app::words::fields::name_and_unit;
use crate::app::words::numbers::{power, three};
use crate::numeric::short;
use crate::output::{Marks, NOT_SETTLED, Panel, PlotAxis, Role, Walk, WalkedRun, suited_unit};
use crate::scene::{FieldPath, SweepAxis, column_names};
use interwell_studies::study::{Direction, Visit};

use super::axes::{field_name, field_ui, range_row_ui};
use super::labels::haloed;
use super::plot::plot_ui;
use super::{Span, View, ViewContext};

/// Height in points of the row of choices.
const TOOLS: f32 = 30.0;

/// Size in points of the sign that runs are still to come.
const SPINNER: f32 = 14.0;

/// The runs of each direction by rising value, coarse ones where the fine ones are still to come.
type Branches<'a> = [Vec<&'a Visit>; 2];

/// The quantity that is drawn, and the number of units of its axis in a watt.
type Shown = (WalkQuantity, f64);

/// Width in points of a button for a quantity, and of what stands beside the buttons.
const CHOICE: f32 = 106.0;
const BESIDE_CHOICES: f32 = 250.0;

pub fn up_and_down_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let area = ui.max_rect();
    let wanted = context.session.want_walks();
    let Some(axis) = context.session.walk_axis() else {
        ui.label("This scene has no field to walk over.");
        return;
    };
    let tools = Rect::from_min_size(area.min, vec2(area.width(), TOOLS));
    ui.scope_builder(UiBuilder::new().max_rect(tools), |ui| tools_ui(ui, context, &axis));
    let below = area.with_min_y(tools.bottom());
    if let Err(problem) = wanted {
        let place = below.shrink2(vec2(0.15 * below.width(), 0.4 * below.height()));
        ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
            ui.vertical_centered(|ui| ui.label(RichText::new(problem).color(context.style.faint())));
        });
        return;
    }
    picture_ui(ui, context, &axis, below);
}

fn tools_ui(ui: &mut Ui, context: &mut ViewContext<'_>, axis: &SweepAxis) {
    let known = context.session.map_fields();
    ui.horizontal_centered(|ui| {
        ui.add_space(8.0);
        let has_load = context.session.model().has_transducer();
        let quantity = &mut context.session.explore.walks.quantity;
        let of_load = "Mean power into the load of the transducer, over the settled window.";
        let choices = [
            (WalkQuantity::Strobes, "Once a period", "Where the mass is once in every forcing period."),
            (WalkQuantity::RmsVelocity, "RMS velocity", "Root of the mean square of the velocity."),
            (WalkQuantity::LoadPower, "Power", of_load),
        ];
        let choices = &choices[..if has_load { 3 } else { 2 }];
        if ui.available_width() < CHOICE * choices.len() as f32 + BESIDE_CHOICES {
            let chosen = choices.iter().find(|choice| choice.0 == *quantity).map_or("", |choice| choice.1);
            let list = egui::ComboBox::from_id_salt("quantity of the walk").selected_text(chosen);
            list.show_ui(ui, |ui| {
                for (value, name, hover) in choices {
                    ui.selectable_value(quantity, *value, *name).on_hover_text(*hover);
                }
            });
        } else {
            for (value, name, hover) in choices {
                segment_ui(ui, quantity, *value, name).on_hover_text(*hover);
            }
        }
        // no step of a lesson explains these
        if !context.session.is_lesson {
            ui.label("over");
            if let Some(path) = field_ui(ui, axis, "over", &known) {
                context.session.explore.walks.chosen = Some(context.session.map_axis(&path));
            }
            let button = choices_ui(ui, "Range", |ui| {
                let mut wanted = axis.clone();
                egui::Grid::new("walk").num_columns(7).show(ui, |ui| range_row_ui(ui, &mut wanted, "over"));
                if wanted != *axis {
                    context.session.explore.walks.chosen = Some(wanted);
                }
            });
            button.on_hover_text("Ends and step of the walk.");
        }
        if context.session.explore.walks.found.is_running() && ui.available_width() > SPINNER {
            ui.add(egui::Spinner::new().size(SPINNER)).on_hover_text("Runs are still to come.");
        }
    });
}

/// The runs of both directions: fine ones as far as they are known, then coarse ones.
fn branches(parts: &[(usize, Visit)]) -> Branches<'_> {
    Direction::ALL.map(|direction| {
        let runs = || parts.iter().filter(|part| part.1.direction == direction);
        let fine: Vec<&Visit> = runs().filter(|part| part.0 == 1).map(|part| &part.1).collect();
        let reached = fine.last().map(|last| last.value);
        let is_ahead = |value: f64| match (direction, reached) {
            (_, None) => true,
            (Direction::Up, Some(reached)) => value > reached,
            (Direction::Down, Some(reached)) => value < reached,
        };
        let coarse = runs().filter(|part| part.0 > 1 && is_ahead(part.1.value)).map(|part| &part.1);
        let mut visits: Vec<&Visit> = fine.iter().copied().chain(coarse).collect();
        visits.sort_by(|a, b| a.value.total_cmp(&b.value));
        visits
    })
}

/// RMS velocity in mm/s; NaN if there is none.
fn rms(visit: &Visit) -> f64 {
    visit.summary.rms_velocity.map_or(f64::NAN, |rms| rms * 1e3)
}

/// The value of a run on the vertical axis, in the unit of the axis; NaN if there is none.
fn number(visit: &Visit, (quantity, per_watt): Shown) -> f64 {
    match quantity {
        WalkQuantity::LoadPower => load_power(visit) * per_watt,
        WalkQuantity::Strobes | WalkQuantity::RmsVelocity => rms(visit),
    }
}

/// Mean power into the load in W; NaN if there is none.
fn load_power(visit: &Visit) -> f64 {
    visit.summary.harvest.and_then(|harvest| harvest.mean_load_power).unwrap_or(f64::NAN)
}

/// Share of the vertical axis above the highest value, where the reading under the pointer stands.
const HEADROOM: f64 = 0.12;

/// The ends of the vertical axis, in the unit of the quantity.
fn vertical_ends(branches: &Branches<'_>, shown: Shown, span: &Span) -> (f64, f64) {
    let all = branches.iter().flatten();
    if shown.0 == WalkQuantity::Strobes {
        let wider = |(low, high): (f64, f64), x: &f64| (low.min(1.05e3 * x), high.max(1.05e3 * x));
        let (low, high) = all.flat_map(|visit| &visit.strobes).fold((span.low * 1e3, span.high * 1e3), wider);
        return (low, high + HEADROOM * (high - low));
    }
    let all = all.map(|visit| number(visit, shown));
    (0.0, all.filter(|value| value.is_finite()).fold(1e-3, f64::max) / (1.0 - HEADROOM))
}

/// The fine ones among the runs. Between coarse ones neither a line nor a difference is known.
fn fine<'a>(parts: &[(usize, Visit)], branches: &Branches<'a>) -> Branches<'a> {
    let is_fine = |visit: &&Visit| {
        let same =
            |part: &&(usize, Visit)| part.1.direction == visit.direction && part.1.value == visit.value;
        parts.iter().filter(|part| part.0 == 1).any(|part| same(&part))
    };
    [0, 1].map(|direction| branches[direction].iter().copied().filter(|visit| is_fine(visit)).collect())
}

/// The runs of both directions over the field: stroboscopic displacements as points, any other quantity as a
/// line between fine runs, and the intervals in which the two directions differ.
fn panel(
    (branches, walk): (&Branches<'_>, &Walk),
    shown: Shown,
    axes: (PlotAxis, PlotAxis),
    here: Option<f64>,
) -> Panel {
    let mut panel = Panel::new(axes.0, axes.1);
    panel.layer_if_any(Role::Hysteresis, "hysteresis", Marks::Spans(walk.differing.clone()));
    panel.draw(Role::Drive, Marks::Verticals(here.into_iter().collect()));
    // the dots of the way up lie in the rings of the way down
    for (i, role, name) in [(1, Role::Down, "turned down"), (0, Role::Motion, "turned up")] {
        let branch = &branches[i];
        let of_visit = |visit: &&Visit| (visit.value, number(visit, shown));
        let strobed = |visit: &&Visit| {
            let value = visit.value;
            strobes(visit).iter().map(move |x| (value, x * 1e3)).collect::<Vec<_>>()
        };
        let marks = match shown.0 {
            WalkQuantity::Strobes => Marks::Cloud(branch.iter().flat_map(strobed).collect()),
            _ => Marks::Path(walk.line(i)),
        };
        panel.layer(role, name, marks);
        if shown.0 != WalkQuantity::Strobes {
            panel.layer(role, name, Marks::Cloud(branch.iter().map(of_visit).collect()));
        }
    }
    if shown.0 != WalkQuantity::Strobes {
        let transients = branches.iter().flatten().filter(|visit| visit.summary.is_transient());
        let transients = transients.map(|visit| (visit.value, number(visit, shown))).collect();
        panel.layer_if_any(Role::Transient, NOT_SETTLED, Marks::Cloud(transients));
    }
    panel
}

fn picture_ui(ui: &mut Ui, context: &mut ViewContext<'_>, axis: &SweepAxis, area: Rect) {
    let style = context.style;
    let span = context.memory.reach(context.session);
    let session = &mut *context.session;
    let walks = &session.explore.walks;
    let quantity = match walks.quantity {
        WalkQuantity::LoadPower if !session.model().has_transducer() => WalkQuantity::RmsVelocity,
        quantity => quantity,
    };
    let is_whole = walks.found.is_whole();
    let (parts, current) = walks.found.parts();
    let of_field = walks.found.question().is_some_and(|question| question.axis.field == axis.field);
    let parts = if of_field { parts } else { &[] };
    let branches = branches(parts);
    let fine = fine(parts, &branches);
    let powers = branches.iter().flatten().map(|visit| load_power(visit));
    let (per_watt, unit) = suited_unit("W", powers);
    let shown = (quantity, per_watt);
    let run = |visit: &&Visit| WalkedRun::of(visit, number(visit, shown));
    let walk = Walk::new([0, 1].map(|way| fine[way].iter().map(run).collect()));
    let vertical = match quantity {
        WalkQuantity::Strobes => "displacement once a period (mm)".to_owned(),
        WalkQuantity::RmsVelocity => "RMS velocity (mm/s)".to_owned(),
        WalkQuantity::LoadPower => format!("mean power into the load ({unit})"),
    };
    let across = label(&column_names(&[axis.field.as_str()]).pop().unwrap_or_default());
    let (low, high) = vertical_ends(&branches, shown, &span);
    let axes =
        (PlotAxis::around([axis.from, axis.to], 0.01, &across), PlotAxis::between(low, high, &vertical));
    let here = FieldPath::new(&axis.field).get(session.scene());
    let state = session.player.state();
    let live = (quantity == WalkQuantity::Strobes).then_some(state.x * 1e3);
    let mut child = ui.new_child(UiBuilder::new().max_rect(area));
    if !current {
        child.set_opacity(0.4);
    }
    let panel = panel((&branches, &walk), shown, axes, here);
    let plotted = plot_ui(&mut child, context.memory, View::UpAndDown, &style, area, &panel);
    let ball = here.zip(live).map(|point| plotted.place(point));
    let frame = plotted.frame();
    if let Some(at) = ball.filter(|at| frame.contains(*at)) {
        child.painter().circle(at, 4.5, style.mass(), egui::Stroke::new(1.5, style.mass_edge()));
    }
    let name = format!("{vertical} over {}, turned up and down", field_name(&axis.field));
    tell(&plotted.response, egui::Role::Canvas, &name);
    let is_same = is_whole && current && !fine[0].is_empty() && walk.is_same;
    // at the run that is read
    let nearest = |value: f64| {
        let distance = |visit: &&&Visit| (visit.value - value).abs();
        let visit = branches[0].iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        visit.map_or(value.clamp(axis.from, axis.to), |visit| visit.value)
    };
    let pointed = plotted.pointed().map(|values| nearest(values.0));
    if let Some(value) = pointed {
        let x = plotted.place((value, low)).x;
        child.painter().vline(x, frame.y_range(), egui::Stroke::new(1.0, style.faint()));
    }
    let text = match pointed {
        Some(value) => Some(reading(&branches, value, quantity, name_and_unit(&axis.field).1)),
        None => is_same.then(|| "the same motion both ways".to_owned()),
    };
    if let Some(text) = text {
        plotted.write(ui, &style, &text);
    }
    if !is_whole && area.height() > 220.0 {
        let is_coarse = [0, 1].iter().any(|i| fine[*i].len() < branches[*i].len());
        let text = if is_coarse { "in coarse steps so far" } else { "not complete yet" };
        let at = (area.right_bottom() - vec2(8.0, 3.0), Align2::RIGHT_BOTTOM);
        haloed(ui.painter(), &style, at, text, (style.small(), style.faint()));
    }
    // to the value that is clicked, or to which the line at the scene is dragged
    let session = &mut *context.session;
    let handle = here.map(|value| plotted.handle(ui, "scene", value));
    let held = handle.as_ref().filter(|handle| handle.dragged()).and_then(Response::interact_pointer_pos);
    if let Some((value, _)) = held.map(|at| plotted.values(at)).or(plotted.clicked) {
        session.drag_along_walk(value);
    }
    if plotted.clicked.is_some() || handle.is_some_and(|handle| handle.drag_stopped()) {
        session.end_gesture();
    }
}

/// The stroboscopic displacements of a run that are drawn: those of one period if it repeats.
fn strobes(visit: &Visit) -> &[f64] {
    let count = visit.summary.period.map_or(visit.strobes.len(), |period| period as usize);
    &visit.strobes[visit.strobes.len().saturating_sub(count)..]
}

/// Text on the runs nearest to `value`, which has this unit.
fn reading([up, down]: &Branches<'_>, value: f64, quantity: WalkQuantity, unit: &str) -> String {
    let number = |visit: &Visit| match quantity {
        WalkQuantity::LoadPower => power(load_power(visit)),
        WalkQuantity::Strobes | WalkQuantity::RmsVelocity => format!("{} mm/s", three(rms(visit))),
    };
    let nearest = |branch: &[&'_ Visit], word: &str| {
        let by_distance =
            |a: &&&Visit, b: &&&Visit| (a.value - value).abs().total_cmp(&(b.value - value).abs());
        let visit = branch.iter().min_by(by_distance)?;
        Some((visit.value, format!("{word}: {}, {}", visit.summary.regime.name(), number(visit))))
    };
    match (nearest(up, "up"), nearest(down, "down")) {
        (Some(up), Some(down)) if up.0 == down.0 => {
            format!("{} {unit}   {}   {}", short(up.0), up.1, down.1)
        }
        _ => format!("{} {unit}", three(value)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Simulation;
    use crate::dynamics::Request;

    #[test]
    fn a_jump_is_a_gap_in_the_line() {
        let simulation = |amplitude: f64| {
            let mut document = crate::scene::Document::load("paper").unwrap();
            document.set(&format!("excitation.amplitude_g={amplitude}")).unwrap();
            let summary = Simulation::new(&document).unwrap().run(&Request::default()).summary;
            Visit { direction: Direction::Up, value: amplitude, summary, strobes: Vec::new() }
        };
        let visits = [0.5, 0.6, 0.9, 1.0].map(simulation);
        let branches: Branches<'_> = [visits.iter().collect(), Vec::new()];
        let axis = || PlotAxis::between(0.0, 1.0, "");
        let shown = (WalkQuantity::RmsVelocity, 1.0);
        let run = |visit: &Visit| WalkedRun::of(visit, number(visit, shown));
        let walk = Walk::new([visits.iter().map(run).collect(), Vec::new()]);
        let panel = panel((&branches, &walk), shown, (axis(), axis()), None);
        let paths = panel.layers.iter().filter_map(|layer| match &layer.marks {
            Marks::Path(points) if !points.is_empty() => Some(points.iter().map(|at| at.0).collect()),
            _ => None,
        });
        let [line]: [Vec<f64>; 1] = paths.collect::<Vec<_>>().try_into().unwrap();
        assert_eq!([&line[..2], &line[3..5]], [&[0.5, 0.6], &[0.9, 1.0]]);
        assert!(line[2].is_nan() && line[5].is_nan() && line.len() == 6);
    }
}
