//! Table of scenes and of what their motions settle to, a column each.

use std::cmp::Ordering;

use eframe::egui::{FontId, Grid, Label, RichText, Sense, TextStyle, Ui, Vec2};

use crate::app::session::Card;
use crate::app::ui::style::{SMALL, strong_family};
use crate::app::ui::widgets::kind_shapes;
use crate::app::words::fields::{mechanism_name, name_and_unit};
use crate::app::words::meanings::{explained, meaning};
use crate::app::words::numbers::{
    UNKNOWN, decimals_for, exact, length_unit, rounded, shown, three, unbroken, with_minus,
};
use crate::app::words::status::{Kind, mm_beside, seconds, speed, threshold};
use crate::dynamics::{Outcome, Summary};
use crate::output::suited_unit;
use crate::scene::{Damping, Excitation, FieldPath, Scene, Start, Transducer, numeric_fields};

use super::ViewContext;

/// Height of a row in points.
const ROW: f32 = 18.0;
/// Largest and smallest gap between two rows in points.
const ROW_GAP: (f32, f32) = (6.0, 1.0);
/// Gap in points between columns.
const COLUMN_GAP: f32 = 8.0;
/// Share of the width that the column of names has at least, and its limits in points.
const NAMES: (f32, f32, f32) = (0.36, 92.0, 150.0);
/// Width in points of a column of values beyond which the names have the room.
const ROOMY_COLUMN: f32 = 144.0;
/// Width in points of the column of names in small letters, if the others are at least as wide as the second
/// number, so that the name of a motion stands beside its symbol.
const SMALL_NAMES: (f32, f32) = (116.0, 78.0);
/// Smallest width in points of a column of values.
const MIN_COLUMN: f32 = 44.0;
/// Width in points from which on a column has text of full size beside the symbols.
const WIDE_COLUMN: f32 = 96.0;

const RMS: &str = "RMS velocity";
const CROSSES: &str = "crosses from";

#[derive(Debug, Clone, PartialEq)]
struct Row {
    name: String,
    unit: &'static str,
    /// The values of the columns, without the unit.
    texts: Vec<String>,
    /// Their differences from that of the first column, where known.
    apart: Vec<Option<String>>,
}

impl Row {
    fn new(name: &str, unit: &'static str, texts: Vec<String>) -> Self {
        Self { name: name.to_owned(), unit, apart: vec![None; texts.len()], texts }
    }

    fn known(&self) -> impl Iterator<Item = &String> {
        self.texts.iter().filter(|text| *text != UNKNOWN)
    }

    fn differs(&self) -> bool {
        self.known().any(|text| Some(text) != self.known().next())
    }
}

/// Draws the table. The last column is that of the present motion, whose numbers have their differences from
/// those of the first one in brackets; `heading` draws the heading of a column, or of the column of names.
pub(super) fn table_ui(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    columns: &[Card],
    heading: &mut dyn FnMut(&mut Ui, Option<usize>),
) {
    let style = context.style;
    let ((share, least, most), room) = (NAMES, ui.available_width());
    let width_beside = |names: f32| (room - names) / columns.len() as f32 - COLUMN_GAP;
    let names = room - columns.len() as f32 * (ROOMY_COLUMN + COLUMN_GAP);
    let names = names.max(share * room).clamp(least, most);
    let names = match width_beside(names) {
        width if width >= WIDE_COLUMN => names,
        _ if width_beside(SMALL_NAMES.0) >= SMALL_NAMES.1 => SMALL_NAMES.0,
        _ => least,
    };
    let width = width_beside(names).max(MIN_COLUMN);
    let small = width < WIDE_COLUMN;
    ui.spacing_mut().interact_size.y = ROW;
    if small {
        let styles = &mut ui.style_mut().text_styles;
        styles.insert(TextStyle::Body, style.small());
        styles.insert(TextStyle::Heading, FontId::new(SMALL, strong_family()));
        (ui.spacing_mut().button_padding.x, ui.spacing_mut().interact_size.y) = (2.0, 0.0);
    }
    let now = columns.len() - 1;
    let before = scene_rows(&columns.iter().map(|card| &*card.scene).collect::<Vec<_>>());
    let after = number_rows(columns, !context.session.keeps_remedy);
    // the headings and the row of the motion
    let count = (before.len() + after.len() + 2) as f32;
    // where not all rows fit, the last one that is seen is whole
    let room = ui.available_height();
    let seen = (room / (ROW + ROW_GAP.1)).floor().clamp(1.0, count);
    let gaps = if seen < count { seen } else { count - 1.0 };
    let gap = ((room - seen * ROW) / gaps).clamp(ROW_GAP.1, ROW_GAP.0);
    let settled = columns[now].settled.as_ref();
    let faint = |text: &str| RichText::new(text).color(style.faint());
    let row_ui = |ui: &mut Ui, row: &Row| {
        words_ui(ui, names, 4.0, |ui| {
            let name = ui.label(faint(&row.name));
            match settled.filter(|_| row.name == RMS) {
                Some(settled) => name.on_hover_text(rms_words(settled)),
                None => explained(name, &row.name),
            };
            if !row.unit.is_empty() {
                ui.label(faint(row.unit).font(style.small()));
            }
        });
        for (i, (text, apart)) in row.texts.iter().zip(&row.apart).enumerate() {
            let written = RichText::new(unbroken(text));
            let written = match *text == row.texts[now] {
                _ if i == now => written.heading(),
                true => written.color(style.faint()),
                false => written,
            };
            words_ui(ui, width, 6.0, |ui| {
                ui.add(Label::new(written).wrap());
                if let Some(apart) = apart {
                    ui.label(faint(&format!("({apart})")).font(style.small()));
                }
            });
        }
        ui.end_row();
    };
    Grid::new("table").num_columns(1 + columns.len()).spacing([COLUMN_GAP, gap]).show(ui, |ui| {
        cell_ui(ui, names, |ui| heading(ui, None));
        for i in 0..columns.len() {
            cell_ui(ui, width, |ui| heading(ui, Some(i)));
        }
        ui.end_row();
        before.iter().for_each(|row| row_ui(ui, row));
        words_ui(ui, names, 4.0, |ui| {
            ui.label(faint("motion"));
            let (when, about) = window_words(columns);
            ui.label(faint(&when).font(style.small())).on_hover_text(about);
        });
        for column in columns {
            cell_ui(ui, width, |ui| match column.ended {
                Some(at) => {
                    let text = format!("ended at {}, stays there", seconds(at));
                    ui.add(Label::new(RichText::new(text).font(style.small())).wrap());
                }
                None => match &column.settled {
                    None => _ = ui.label(faint("not yet known").font(style.small())),
                    Some(settled) => regime_ui(ui, context, settled, width),
                },
            });
        }
        ui.end_row();
        after.iter().for_each(|row| row_ui(ui, row));
    });
}

/// Note on the row of the motion and the rows below it: of which time they are, and what that means.
fn window_words(columns: &[Card]) -> (String, &'static str) {
    let known: Vec<&Summary> = columns.iter().filter_map(|card| card.settled.as_ref()).collect();
    let has_settled = |run: &&Summary| run.settled.is_some() && !run.is_transient();
    if known.iter().all(has_settled) {
        let about = "What the motion settles to, whether or not it has been played so far.";
        return ("once settled".to_owned(), about);
    }
    let about = "This motion is not known to settle: the numbers are those of this time after the start or \
                 the last change, whether or not it has been played so far.";
    let (from, to) = known[0].window;
    match known.iter().all(|run| run.window == (from, to)) {
        true => (format!("from {} to {}", seconds(from), seconds(to)), about),
        false => ("each over its own time".to_owned(), SEVERAL),
    }
}

/// Meaning of the numbers of motions of which one is not known to settle.
const SEVERAL: &str =
    "Of a motion that settles, what it settles to; of any other, numbers of a part of its run.";

fn cell_ui(ui: &mut Ui, width: f32, contents: impl FnOnce(&mut Ui)) {
    ui.vertical(|ui| {
        ui.set_width(width);
        contents(ui);
    });
}

/// A cell with texts side by side, so many points apart.
fn words_ui(ui: &mut Ui, width: f32, gap: f32, contents: impl FnOnce(&mut Ui)) {
    cell_ui(ui, width, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = gap;
            contents(ui);
        });
    });
}

/// Meaning of the RMS velocity, and the time over which it was taken.
fn rms_words(settled: &Summary) -> String {
    let (from, to) = settled.window;
    let time = format!("from {} to {} after the start or the last change", seconds(from), seconds(to));
    format!("{}\n\nHere it was taken {time}.", meaning(RMS).unwrap_or_default())
}

/// Rows of the scenes: shaking and stops, and whatever else differs between two of them.
fn scene_rows(scenes: &[&Scene]) -> Vec<Row> {
    let row = |name: &str, unit: &'static str, text: fn(&Scene) -> String| {
        let bare = |scene: &Scene| match unit {
            "" => text(scene),
            unit => text(scene).replace(&format!(" {unit}"), ""),
        };
        Row::new(name, unit, scenes.iter().map(|scene| bare(scene)).collect())
    };
    let mut rows = vec![row("shaking", "", |scene| shaking(scene).0), row("stops", "mm", stops)];
    // the value of the damping has another row
    let damping = |scene: &Scene| match scene.damping {
        Damping::None => "none".to_owned(),
        Damping::Ratio(_) => "by ratio".to_owned(),
        Damping::Coefficient { .. } => "by coefficient".to_owned(),
    };
    let others = [
        row("damping", "", damping),
        row("mechanism", "", |scene| mechanism_name(&scene.mechanism)),
        row("start", "", start),
    ];
    rows.extend(others.into_iter().filter(Row::differs));
    let differs = |name: &str| rows.iter().any(|row| row.name == name && row.differs());
    let [shaking_differs, stops_differ, start_differs] = ["shaking", "stops", "start"].map(differs);
    let mut paths: Vec<String> = Vec::new();
    for path in scenes.iter().flat_map(|scene| numeric_fields(scene)) {
        if !paths.contains(&path) {
            paths.push(path);
        }
    }
    for path in paths {
        let ((name, unit), field) = (name_and_unit(&path), FieldPath::new(&path));
        let values: Vec<Option<f64>> = scenes.iter().map(|scene| field.get(scene)).collect();
        let known = || values.iter().flatten();
        // numbers that a row above contains already
        let in_row_above = match path.split_once('.') {
            Some(("excitation", number)) => {
                let is_in = |scene: &&Scene| field.get(scene).is_none() || shaking(scene).1.contains(&number);
                shaking_differs && scenes.iter().all(is_in)
            }
            Some(("stops", number)) => stops_differ && number.ends_with("_mm") && number != "radius_mm",
            Some(("start", _)) => start_differs,
            Some(("app", _)) => true,
            _ => false,
        };
        if in_row_above || known().all(|value| Some(value) == known().next()) {
            continue;
        }
        // all digits if two rounded numbers are equal
        let hidden = known().any(|a| known().any(|b| a != b && shown(*a, 0) == shown(*b, 0)));
        let text = |value: &f64| if hidden { exact(*value, 0) } else { shown(*value, 0) };
        let texts = values.iter().map(|value| value.as_ref().map_or_else(|| UNKNOWN.to_owned(), text));
        rows.push(Row::new(&name, unit, texts.collect()));
    }
    rows
}

/// Rows of numbers of the settled motions.
fn number_rows(columns: &[Card], with_threshold: bool) -> Vec<Row> {
    let row = |name: &str,
               unit: &'static str,
               text: &dyn Fn(&Card, &Summary) -> Option<String>,
               value: &dyn Fn(&Summary) -> Option<f64>,
               decimals: &dyn Fn(f64) -> usize| {
        let written = |card: &Card| text(card, card.settled.as_ref()?);
        let texts = columns.iter().map(|card| written(card).unwrap_or_else(|| UNKNOWN.to_owned()));
        let number = |i: usize| columns[i].settled.as_ref().and_then(value);
        let apart = |i: usize| Some(difference(number(i)?, number(0).filter(|_| i > 0)?, decimals));
        Row { apart: (0..columns.len()).map(apart).collect(), ..Row::new(name, unit, texts.collect()) }
    };
    let tenths = |below: f64| move |size: f64| usize::from(size < below);
    let velocity = |run: &Summary| run.rms_velocity;
    let in_mm = |run: &Summary| velocity(run).map(|v| v * 1e3);
    let reaches = columns.iter().filter_map(|card| card.settled.as_ref()?.max_abs_x);
    let (per_metre, length) = length_unit(reaches.fold(0.0, f64::max));
    let reach_in = |run: &Summary| run.max_abs_x.map(|x| x * per_metre);
    let reach = |card: &Card, run: &Summary| match length {
        "m" => reach_in(run).map(three),
        // on its side of the stops
        _ => {
            let stops = card.scene.stops.positions_mm().map(|stop| stop.map(|mm| mm * 1e-3));
            run.max_abs_x.map(|reach| mm_beside(reach, stops.into()))
        }
    };
    let of_reach = |size: f64| match length {
        "m" => decimals_for(size),
        _ => 1 + usize::from(size < 0.95) - usize::from(size >= 99.95),
    };
    let share = |run: &Summary| run.impact_share.map(|share| share * 100.0);
    let whole = |run: &Summary| share(run).map(|share| format!("{share:.0}"));
    let mut rows = vec![
        row(RMS, "mm/s", &|_, run| velocity(run).map(speed), &in_mm, &tenths(9.95)),
        row("reach", length, &reach, &reach_in, &of_reach),
    ];
    rows.extend(Some(row("impacts take", "%", &|_, run| whole(run), &share, &|_| 0)).filter(Row::differs));
    if columns.iter().any(|card| card.scene.transducer != Transducer::None) {
        let watt = |run: &Summary| run.harvest?.mean_load_power;
        let all = columns.iter().filter_map(|card| watt(card.settled.as_ref()?));
        let (factor, unit) = suited_unit("W", all);
        let text = |_: &Card, run: &Summary| watt(run).map(|watt| three(watt * factor));
        rows.push(row("load power", unit, &text, &|run| Some(watt(run)? * factor), &decimals_for));
    }
    // other drives have no amplitude
    if with_threshold && columns.iter().any(|card| card.scene.harmonic().is_some()) {
        let found = |card: &Card| threshold(&card.scene, &card.thresholds?.crossing);
        let all: Vec<_> = columns.iter().map(found).collect();
        let unit = all.iter().flatten().next().map_or("g", |first| first.1);
        // an amplitude of another unit has it beside its number
        let text = |(number, its): &(String, &str)| match *its == unit {
            true => number.clone(),
            false => format!("{number} {its}"),
        };
        let texts = all.iter().map(|found| found.as_ref().map_or_else(|| UNKNOWN.to_owned(), text));
        let mut row = Row::new(CROSSES, unit, texts.collect());
        // where both are known in this unit, with the digits of the one that has fewer
        let numbers: Vec<&str> = row.texts.iter().map(|text| text.trim_start_matches("about ")).collect();
        let decimals = |text: &str| text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let apart = |i: usize| {
            let (now, first) = (numbers[i].parse().ok()?, numbers[0].parse().ok()?);
            let decimals = decimals(numbers[i]).min(decimals(numbers[0]));
            (i > 0).then(|| difference(now, first, &|_| decimals))
        };
        row.apart = (0..columns.len()).map(apart).collect();
        rows.push(row);
    }
    rows
}

fn difference(value: f64, first: f64, decimals: &dyn Fn(f64) -> usize) -> String {
    let decimals = decimals(value.abs().max(first.abs()));
    // of the numbers as they are written
    let written = |value: f64| format!("{value:.decimals$}").parse().unwrap_or(value);
    let text = with_minus(&format!("{:+.decimals$}", written(value) - written(first)));
    // a difference that rounds to zero has no sign
    let is_zero = text.trim_start_matches(['+', '\u{2212}', '0', '.']).is_empty();
    if is_zero { "same".to_owned() } else { text }
}

/// The shaking in words, and the fields whose numbers these contain.
fn shaking(scene: &Scene) -> (String, &'static [&'static str]) {
    // a difference that this rounding hides has another row, see `scene_rows`
    let g = |value: &f64| shown(rounded(*value, 4), 2);
    let hz = |value: &f64| shown(rounded(*value, 4), 1);
    match &scene.excitation {
        Excitation::None => ("none".to_owned(), &[]),
        Excitation::Constant { accel_g } => (format!("{} g, constant", g(accel_g)), &["accel_g"]),
        Excitation::Sine { amplitude_g, frequency_hz: f, .. } => {
            (format!("{} g, {} Hz", g(amplitude_g), hz(f)), &["amplitude_g", "frequency_hz"])
        }
        Excitation::Cosine { amplitude_m_per_s2: a, frequency_rad_per_s: f, .. } => {
            let words = format!("{} m/s\u{b2}, {} rad/s", g(a), g(f));
            (words, &["amplitude_m_per_s2", "frequency_rad_per_s"])
        }
        Excitation::Force { amplitude_n: a, frequency_rad_per_s: f, .. } => {
            (format!("{} N, {} rad/s", g(a), g(f)), &["amplitude_n", "frequency_rad_per_s"])
        }
        Excitation::AmplitudeRamp { from_g, to_g, .. } => {
            (format!("{} to {} g", g(from_g), g(to_g)), &["from_g", "to_g"])
        }
        Excitation::Chirp { from_hz, to_hz, amplitude_g, .. } => {
            let words = format!("{} g, {} to {} Hz", g(amplitude_g), hz(from_hz), hz(to_hz));
            (words, &["amplitude_g", "from_hz", "to_hz"])
        }
        Excitation::Noise { rms_g, .. } => (format!("noise, {} g", g(rms_g)), &["rms_g"]),
        Excitation::Recorded { .. } => ("recorded".to_owned(), &[]),
        Excitation::Sum(terms) => (format!("sum of {}", terms.len()), &[]),
    }
}

fn stops(scene: &Scene) -> String {
    let (stops, mm) = (&scene.stops, |value: f64| format!("{} mm", shown(value, decimals_for(value).min(2))));
    let side = |stop: Option<f64>| {
        stop.map_or("open".to_owned(), |at| match at.total_cmp(&0.0) {
            Ordering::Less => format!("\u{2212}{}", mm(-at)),
            Ordering::Equal => mm(at),
            Ordering::Greater => format!("+{}", mm(at)),
        })
    };
    match (stops.travel_limit_mm(), stops.positions_mm()) {
        (Some(limit), _) if stops.restitutions() == [None; 2] => format!("±{}, compliant", mm(limit)),
        (Some(limit), _) => format!("±{}", mm(limit)),
        (None, [None, None]) => "none".to_owned(),
        (None, [left, right]) => format!("{}, {}", side(left), side(right)),
    }
}

fn start(scene: &Scene) -> String {
    match scene.start {
        Start::Rest => "at rest".to_owned(),
        Start::At { x_mm, v_m_per_s, .. } => {
            with_minus(&format!("{} mm, {} m/s", shown(x_mm, 1), shown(v_m_per_s, 0)))
        }
    }
}

/// Symbol and name of the regime, one below the other in a narrow column.
fn regime_ui(ui: &mut Ui, context: &ViewContext<'_>, settled: &Summary, width: f32) {
    if settled.outcome != Outcome::Done {
        return drop(ui.add(Label::new("the run ended early").wrap()));
    }
    let kind = Kind::from(settled.regime);
    let name = match kind {
        Kind::Resting => "resting",
        Kind::Intrawell if settled.releases > 0 => "hopping",
        kind => kind.name(),
    };
    let contents = |ui: &mut Ui| {
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(16.0), Sense::hover());
        ui.painter().extend(kind_shapes(kind, rect.center(), 5.0, context.style.kind(kind)));
        explained(ui.add(Label::new(name).wrap()), name);
    };
    if width >= SMALL_NAMES.1 {
        ui.horizontal(contents)
    } else {
        ui.vertical(contents)
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Document, PRESETS};

    fn changes(scenes: [&Scene; 2]) -> Vec<Row> {
        scene_rows(&scenes).into_iter().filter(Row::differs).collect()
    }

    /// Every difference has one row, whose two sides differ.
    #[test]
    fn every_number_that_differs_has_a_row() {
        for preset in PRESETS {
            let before = Document::load(preset.name).unwrap().scene;
            for path in numeric_fields(&before).iter().filter(|path| !path.starts_with("app.")) {
                let (mut now, field) = (before.clone(), FieldPath::new(path));
                let Some(value) = field.get(&before) else { continue };
                let changed = if value == 0.0 { 1.0 } else { value * 1.000_000_01 };
                assert!(field.set(&mut now, changed));
                // an integer field ignores so small a change
                if now == before {
                    assert!(field.set(&mut now, value + 1.0));
                }
                let rows = changes([&before, &now]);
                assert!(rows.len() == 1, "{} {path}: {rows:?}", preset.name);
                assert!(rows.iter().all(|row| row.texts[0] != row.texts[1]), "{path}: {rows:?}");
            }
            assert!(changes([&before, &before]).is_empty());
        }
    }
}
