//! View of the events of the motion as a table: time, kind, velocities and energy lost.

use eframe::egui::{self, Align2, Rect, RichText, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2};

use crate::app::export::events_seen_csv;
use crate::app::ui::style::Style;
use crate::app::words::numbers::{UNKNOWN, three_from, with_minus};
use interwell_studies::study::{Table, Values, watched_events};

use super::energy::unit_of;
use super::{ViewContext, empty_ui};

/// Height in points of a row.
const ROW: f32 = 18.0;
/// Width in points of a table below which its headings have no units.
const NARROW: f32 = 400.0;

/// A column: heading, name in the table, share of the width, explanation.
type Column = (&'static str, &'static str, f32, &'static str);

const COLUMNS: [Column; 7] = [
    ("time (s)", "t_s", 0.95, "Time."),
    ("phase (°)", "phase_deg", 1.0, "Phase of the shaking, where it repeats."),
    ("event", "kind", 1.0, "What happened."),
    ("side", "side", 0.7, "The stop, or the well that is entered."),
    ("v in", "v_in_m_per_s", 1.2, "Velocity before it in mm/s, to the right positive."),
    ("v out", "v_out_m_per_s", 1.3, "Velocity after it in mm/s, to the right positive."),
    ("lost", "lost_j", 0.95, "Kinetic energy that it took; on a compliant stop it goes bit by bit."),
];

pub fn events_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (style, watch) = (context.style, context.session.player.watch());
    let (count, forgotten) = (watch.events().len(), watch.forgotten_events());
    ui.spacing_mut().item_spacing.y = 0.0;
    ui.horizontal(|ui| {
        ui.add_space(8.0);
        let note = match forgotten {
            0 => String::new(),
            number => format!("; {number} earlier ones are no longer remembered"),
        };
        ui.label(RichText::new(format!("{count} events{note}")).font(style.small()).color(style.faint()));
        let hover = "The rows that are remembered, as the command line writes them, with two more columns.";
        let button = ui.add_enabled(count > 0, egui::Button::new("Copy as CSV").small());
        if button.on_hover_text(hover).clicked() {
            ui.copy_text(events_seen_csv(&context.session.player));
        }
    });
    if count == 0 {
        let below = ui.available_rect_before_wrap();
        let text = "Nothing has happened yet: an impact, a release or a crossing is a row here.";
        empty_ui(ui, &style, below, text);
        return;
    }
    let unit = unit_of(context.session.model().mass() * context.session.model().scales().speed.powi(2));
    let (heading, _) = ui.allocate_exact_size(egui::vec2(ui.available_width(), ROW), Sense::hover());
    for (place, (name, column, _, about)) in cells(heading).into_iter().zip(COLUMNS) {
        let name = match column {
            _ if heading.width() < NARROW => name.split(" (").next().unwrap_or(name).to_owned(),
            "v_in_m_per_s" | "v_out_m_per_s" => format!("{name} (mm/s)"),
            "lost_j" => format!("{name} ({})", smaller(unit).1),
            _ => name.to_owned(),
        };
        write(ui, &style, place, column, &name, false);
        let hover = format!("{about} In the CSV it is {column}.");
        ui.interact(place, ui.scope_id().with(column), Sense::hover()).on_hover_text(hover);
    }
    list_ui(ui, context, count, smaller(unit));
}

/// The unit a thousand times smaller: an impact takes little of the kinetic energy.
fn smaller((joule, _): (f64, &'static str)) -> (f64, &'static str) {
    unit_of(1.001e-3 * joule)
}

fn list_ui(ui: &mut Ui, context: &mut ViewContext<'_>, count: usize, unit: (f64, &str)) {
    let (style, now) = (context.style, context.session.player.time());
    let marked =
        context.session.player.watch().events().partition_point(|event| event.t <= now).checked_sub(1);
    let moved = context.memory.marked != marked && marked.is_some();
    let mut list = ScrollArea::vertical().auto_shrink(false).id_salt("events");
    let room = ui.available_rect_before_wrap();
    // whole rows
    let height = ROW * (room.height() / ROW).floor().max(1.0);
    let in_list = ui.rect_contains_pointer(room);
    list = list.max_height(height);
    // scrolls to the present event, unless the pointer is over the list during playback
    let follows = moved && !(in_list && context.session.player.is_playing());
    if let Some(row) = marked.filter(|_| follows) {
        list = list.vertical_scroll_offset(((row as f32 - (0.6 * height / ROW).round()) * ROW).max(0.0));
    }
    let mut clicked = None;
    list.show_rows(ui, ROW, count, |ui, rows| {
        let first = rows.start;
        // the list has its new length only in the next frame
        match follows && !marked.is_some_and(|row| rows.contains(&row)) {
            true => ui.ctx().request_repaint(),
            false => context.memory.marked = marked,
        }
        let table = watched_events(context.session.player.watch(), rows.clone());
        for row in rows {
            let (place, response) =
                ui.allocate_exact_size(egui::vec2(ui.available_width(), ROW), Sense::click());
            let texts = COLUMNS.map(|column| cell(&table, column.1, row - first, unit));
            let is_marked = marked == Some(row);
            let spoken = spoken(&texts, unit.1);
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_marked, spoken.as_str()));
            if is_marked {
                ui.painter().rect_filled(place, 0.0, style.rest_shade());
                let edge = place.with_max_x(place.left() + 3.0);
                ui.painter().rect_filled(edge, 0.0, style.mass());
            } else if response.hovered() {
                ui.painter().rect_filled(place, 0.0, style.panel());
            }
            for ((place, column), text) in cells(place).into_iter().zip(COLUMNS).zip(&texts) {
                write(ui, &style, place, column.1, text, true);
            }
            if response.clicked() {
                clicked = Some(row);
            }
        }
    });
    let player = &mut context.session.player;
    if let Some(event) = clicked.and_then(|row| player.watch().events().get(row)) {
        let t = event.t;
        player.set_playing(false);
        player.seek(t);
    }
}

fn cells(row: Rect) -> [Rect; COLUMNS.len()] {
    let all: f32 = COLUMNS.iter().map(|column| column.2).sum();
    let (mut x, width) = (row.left() + 6.0, row.width() - 16.0);
    COLUMNS.map(|column| {
        let from = x;
        x += width * column.2 / all;
        Rect::from_min_max(pos2(from, row.top()), pos2(x, row.bottom()))
    })
}

/// Writes a text into its cell: words to the left, numbers to the right.
fn write(ui: &Ui, style: &Style, place: Rect, column: &str, text: &str, strong: bool) {
    let color = if strong { style.ink() } else { style.faint() };
    let (at, align) = match column {
        "kind" | "side" => (place.left_center() + egui::vec2(8.0, 0.0), Align2::LEFT_CENTER),
        _ => (place.right_center(), Align2::RIGHT_CENTER),
    };
    let painter = ui.painter().with_clip_rect(place.intersect(ui.clip_rect()));
    painter.text(at, align, text, style.small(), color);
}

fn cell(table: &Table, column: &str, row: usize, unit: (f64, &str)) -> String {
    match table.column(column).map(|column| &column.values) {
        Some(Values::Words(words)) => words[row].to_owned(),
        Some(Values::Numbers(numbers)) if numbers[row].is_nan() => UNKNOWN.to_owned(),
        Some(Values::Numbers(numbers)) => match column {
            "t_s" => format!("{:.5}", numbers[row]),
            "phase_deg" => format!("{:.1}", numbers[row]),
            "lost_j" => with_minus(&three_from(numbers[row] / unit.0, 1e-4)),
            _ => with_minus(&three_from(numbers[row] * 1e3, 1e-4)),
        },
        _ => String::new(),
    }
}

/// A row as a sentence for screen readers.
fn spoken([t, phase, kind, side, before, after, lost]: &[String; COLUMNS.len()], unit: &str) -> String {
    let energy = if lost == "0" || lost == UNKNOWN { String::new() } else { format!(", {lost} {unit} lost") };
    format!("{kind}, {side}, at {t} s, phase {phase}°, {before} to {after} mm/s{energy}")
}
