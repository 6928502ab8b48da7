//! Dialog in which the columns and units of measured data are chosen.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{self, ComboBox, Grid, RichText, Ui};

use crate::app::session::measured::{MeasuredRecord, file_name, sentence};
use crate::app::task::{Background, Wake};
use crate::app::ui::widgets::{dialog_ui, focus_first, primary};
use crate::scene::{ChosenColumn, MeasuredText, Quantity, Unit};

/// Extensions of the files that are taken for measured data.
pub(super) const ENDINGS: [&str; 4] = ["csv", "txt", "tsv", "dat"];

/// Rows of the dialog, with the quantities of each: the abscissa, and the measured values.
const ROWS: [(&str, &[Quantity]); 2] = [
    ("across", &[Quantity::Time, Quantity::Displacement]),
    ("values", &[Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration, Quantity::Force]),
];

const WIDTH: f32 = 560.0;
/// Width in points of the choice of a column.
const COLUMN: f32 = 190.0;
/// Width in points of the choice of a unit.
const UNIT: f32 = 70.0;

/// Whether a file is taken for measured data.
pub(super) fn is_measured(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()))
}

/// A file of measured data whose columns are being chosen.
pub struct MeasuredDialog {
    path: PathBuf,
    text: Background<(), Result<Arc<MeasuredText>, String>>,
    chosen: Option<[ChosenColumn; 2]>,
    /// The record of two columns, each with its unit.
    record: Background<[(usize, Unit); 2], Result<MeasuredRecord, String>>,
    refused: Option<String>,
}

pub(super) enum MeasuredAnswer {
    Overlay(Box<MeasuredRecord>),
    Shake(PathBuf, Box<MeasuredRecord>),
    Cancelled,
}

impl MeasuredDialog {
    pub fn new(path: &Path, wake: &Wake) -> Self {
        let mut text = Background::default();
        let file = path.to_owned();
        text.ask_job((), wake, move |(), _, _| {
            let read = MeasuredText::read(&file).map(Arc::new);
            Some(read.map_err(|problem| sentence(&format!("the file {problem}"))))
        });
        let record = Background::default();
        Self { path: path.to_owned(), text, chosen: None, record, refused: None }
    }

    pub fn refuse(&mut self, why: String) {
        self.refused = Some(why);
    }

    /// Chooses the column and the unit of a row: 0 for the abscissa, 1 for the values.
    pub fn choose(&mut self, row: usize, chosen: ChosenColumn) {
        if let Some(present) = self.chosen.as_mut().and_then(|rows| rows.get_mut(row)) {
            *present = chosen;
            self.refused = None;
        }
    }

    /// The record once it is read, or a sentence that says what prevents that.
    pub fn known(&self) -> Option<Result<&MeasuredRecord, String>> {
        let names = match self.text.answer()? {
            Ok(text) => &text.names,
            Err(problem) => return Some(Err(problem.clone())),
        };
        let open = self.chosen?.into_iter().find(|column| column.1.is_none());
        if let Some((at, _)) = open {
            let name = names.get(at).map_or("", String::as_str);
            return Some(Err(format!("Choose the unit of `{name}`: its name does not end with one.")));
        }
        Some(self.record.answer()?.as_ref().map_err(Clone::clone))
    }

    /// Receives what was read, and has the chosen columns read.
    pub fn poll(&mut self, wake: &Wake) {
        self.text.poll();
        self.record.poll();
        let Some(Ok(text)) = self.text.answer() else { return };
        let [across, values] = *self.chosen.get_or_insert_with(|| text.guess());
        let Some(wanted) = across.1.zip(values.1).map(|pair| [(across.0, pair.0), (values.0, pair.1)]) else {
            return self.record.clear();
        };
        let (text, path) = (Arc::clone(text), self.path.clone());
        self.record.want_job(wanted, true, wake, move |wanted, _, _| {
            Some(MeasuredRecord::of(&path, &text, *wanted))
        });
    }

    pub(super) fn ui(&mut self, ui: &Ui, wake: &Wake) -> Option<MeasuredAnswer> {
        self.poll(wake);
        let heading = format!("Measured data: {}", file_name(&self.path));
        let (answer, is_closed) = dialog_ui(ui, ("measured", WIDTH), (heading, 4.0), |ui| {
            ui.set_min_width(ui.available_width());
            if let Some(Ok(text)) = self.text.answer().cloned() {
                self.columns_ui(ui, &text);
            }
            self.known_ui(ui);
            ui.add_space(8.0);
            self.buttons_ui(ui)
        });
        answer.or(is_closed.then_some(MeasuredAnswer::Cancelled))
    }

    fn columns_ui(&mut self, ui: &mut Ui, text: &MeasuredText) {
        let Some(chosen) = self.chosen else { return };
        let guess = text.guess();
        Grid::new("columns").num_columns(4).spacing([10.0, 6.0]).show(ui, |ui| {
            for (row, (name, quantities)) in ROWS.into_iter().enumerate() {
                let (at, unit) = chosen[row];
                let label = ui.label(name);
                let mut wanted = chosen[row];
                let title = |at: usize| text.names.get(at).map_or("", String::as_str);
                let column = ComboBox::from_id_salt((name, "column")).width(COLUMN).truncate();
                let shown = column.selected_text(title(at)).show_ui(ui, |ui| {
                    for (i, name) in text.names.iter().enumerate() {
                        if ui.selectable_label(i == at, name).clicked() {
                            let unit = Unit::of_name(name).filter(|unit| quantities.contains(&unit.quantity));
                            wanted = (i, unit);
                        }
                    }
                });
                shown.response.labelled_by(label.id).on_hover_text("The column of the file.");
                let words = unit.map_or("unit?", Unit::word);
                let units = ComboBox::from_id_salt((name, "unit")).width(UNIT).selected_text(words);
                let shown = units.show_ui(ui, |ui| {
                    for quantity in quantities {
                        for choice in Unit::all(*quantity) {
                            let words = format!("{} ({})", choice.word(), quantity_name(row, *quantity));
                            if ui.selectable_label(unit == Some(choice), words).clicked() {
                                wanted.1 = Some(choice);
                            }
                        }
                    }
                });
                let unit_name = format!("unit of {name}");
                shown.response.widget_info(|| {
                    let mut info = egui::WidgetInfo::labeled(egui::Role::ComboBox, true, &unit_name);
                    info.current_text_value = Some(words.to_owned());
                    info
                });
                shown.response.on_hover_text("The unit of its numbers.");
                let by_name = if chosen[row] == guess[row] { ", by its name" } else { "" };
                let quantity = unit.map(|unit| quantity_name(row, unit.quantity));
                let how = quantity.map_or_else(String::new, |quantity| format!("{quantity}{by_name}"));
                ui.label(RichText::new(how).small());
                ui.end_row();
                if wanted != chosen[row] {
                    self.choose(row, wanted);
                }
            }
        });
    }

    fn known_ui(&self, ui: &mut Ui) {
        ui.add_space(4.0);
        match self.known() {
            None => _ = ui.label("Reading the file."),
            Some(Err(problem)) => _ = ui.label(RichText::new(problem).heading()),
            Some(Ok(record)) => _ = ui.label(record.describe()),
        }
        if let Some(why) = &self.refused {
            ui.label(RichText::new(format!("The base is not shaken with it. {why}")).heading());
        }
    }

    fn buttons_ui(&self, ui: &mut Ui) -> Option<MeasuredAnswer> {
        let record = self.known().and_then(Result::ok);
        ui.horizontal(|ui| {
            let lay = ui.add_enabled(record.is_some(), primary(ui, "Lay it over"));
            if record.is_some() {
                focus_first(ui, &lay);
            }
            let accelerates = record.is_some_and(|record| record.values.quantity == Quantity::Acceleration);
            let hover = "The excitation of the scene becomes this record, linear between its samples, from \
                         its time 0 on. A step that can be undone.";
            let shaken = accelerates && ui.button("Shake the base with it").on_hover_text(hover).clicked();
            let cancelled = ui.button("Cancel").clicked();
            match record {
                Some(record) if lay.clicked() => Some(MeasuredAnswer::Overlay(Box::new(record.clone()))),
                Some(record) if shaken => {
                    Some(MeasuredAnswer::Shake(self.path.clone(), Box::new(record.clone())))
                }
                _ => cancelled.then_some(MeasuredAnswer::Cancelled),
            }
        })
        .inner
    }
}

/// Name of a quantity in a row; a displacement as abscissa is a position.
fn quantity_name(row: usize, quantity: Quantity) -> &'static str {
    match (row, quantity) {
        (0, Quantity::Displacement) => "position",
        (_, Quantity::Acceleration) => "acceleration of the base",
        (_, quantity) => quantity.name(),
    }
}
