//! Controls for the field of an axis, its ends and its step.

use eframe::egui::{self, ComboBox, Ui};

use crate::app::ui::knob::Knob;
use crate::app::ui::widgets::tell;
use crate::app::words::fields::{Reach, name_and_unit};
use crate::scene::{SweepAxis, column_names};
use interwell_studies::study::label_and_unit;

/// Least width in points of a choice of a field.
const FIELD: f32 = 60.0;

/// The name of a field without its unit: that of its control, or else of its column.
pub fn field_name(path: &str) -> String {
    let (name, _) = name_and_unit(path);
    if name != path {
        return name.trim_end_matches(" ±").to_owned();
    }
    label_and_unit(&column_names(&[path]).pop().unwrap_or_default()).0
}

/// Offers the `known` fields for the axis named by its `role`. Returns the new field if it changed.
pub fn field_ui(ui: &mut Ui, axis: &SweepAxis, role: &str, known: &[String]) -> Option<String> {
    let name = field_name(&axis.field);
    let mut wanted = None;
    let inner = ComboBox::from_id_salt(("axis", role)).width(FIELD).selected_text(&name).show_ui(ui, |ui| {
        for path in known {
            if ui.selectable_label(*path == axis.field, field_name(path)).clicked() {
                wanted = Some(path.clone());
            }
        }
    });
    tell(&inner.response, egui::Role::ComboBox, &format!("{role}: {name}"));
    let range = format!("The axis {role}: from {} to {} in steps of {}.", axis.from, axis.to, axis.step);
    inner.response.on_hover_text(range);
    wanted.filter(|path| *path != axis.field)
}

/// Identifies the input of a part of an axis: `from`, `to` or `step`.
pub fn range_id(role: &str, part: &str) -> egui::Id {
    egui::Id::unique(("range", role, part))
}

/// Inputs for the ends and the step of an axis, as a row of a grid.
pub fn range_row_ui(ui: &mut Ui, axis: &mut SweepAxis, role: &str) {
    ui.label(field_name(&axis.field));
    let (_, unit) = name_and_unit(&axis.field);
    let reach = Reach::even(axis.from, axis.to, axis.step);
    for (part, value) in [("from", &mut axis.from), ("to", &mut axis.to), ("step", &mut axis.step)] {
        ui.label(part);
        let name = format!("{role}, {part}");
        let (id, typed) = (range_id(role, part), (-1e30, 1e30));
        let knob = Knob { id, name: &name, unit, reach, typed, hover: "", width: 0.0 };
        if let Some(typed) = knob.alone_ui(ui, *value) {
            *value = typed;
        }
    }
    ui.end_row();
}
