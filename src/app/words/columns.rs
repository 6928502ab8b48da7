//! Table of the columns of a summary: name on the screen and explanation of each, in groups.

use crate::app::words::numbers::power_unit;
use crate::output::{RMS, speed_unit, words_of};
use crate::study::{Column, Read, SummaryField, Values};

#[derive(Debug, PartialEq, Eq)]
pub struct ColumnInfo {
    /// Its name in a file.
    pub column: &'static str,
    /// Its name on the screen.
    pub name: &'static str,
    /// Its explanation.
    pub about: &'static str,
}

const fn row(column: &'static str, name: &'static str, about: &'static str) -> ColumnInfo {
    ColumnInfo { column, name, about }
}

/// All columns, in groups.
#[rustfmt::skip]
pub static COLUMNS: [(&str, &[ColumnInfo]); 7] = [
    ("Motion", &[
        row(RMS, "RMS velocity", "Root of the mean square of the velocity over the settled window."),
        row("regime", "regime", "What kind of motion it is."),
        row("max_abs_x_m", "reach", "The largest distance from the middle in the settled window."),
        row("travel_m", "travel",
            "From the leftmost place to the rightmost one of the settled window."),
        row("min_x_m", "leftmost place", "The least displacement in the settled window."),
        row("max_x_m", "rightmost place", "The largest displacement in the settled window."),
        row("mean_x_m", "mean displacement", "The mean over the settled window."),
        row("side", "side", "On which side of the barrier the mass stays."),
        row("period", "period", "Forcing periods after which the motion repeats, up to 12."),
        row("settled", "settled", "Whether the motion repeats, or the mass rests."),
        row("steady", "averages steady",
            "Whether the averages over both halves of the settled window agree, though the motion may be \
             irregular."),
        row("settles_at_s", "settles at", "The time since when the motion repeats."),
    ]),
    ("Events", &[
        row("crossings", "crossings", "How often the mass crossed the barrier in the settled window."),
        row("impacts", "impacts", "How often it struck a stop in the settled window."),
        row("releases", "releases", "How often it left a stop on which it rested, in the settled window."),
        row("impact_speed_max_m_per_s", "fastest impact",
            "The largest speed of an impact in the settled window."),
        row("rested_share", "share of time at rest",
            "The share of the settled window that the mass rests on a stop."),
        row("crossing_periods", "periods with a crossing", "Forcing periods in which the mass crossed."),
        row("release_periods", "periods with a release", "Forcing periods in which it left a stop."),
        row("total_crossings", "crossings in all", "From the start of the run on."),
        row("total_impacts", "impacts in all", "From the start of the run on."),
        row("rests", "arrivals at rest", "How often the mass came to rest on a stop, from the start on."),
        row("chatter_sums", "summed chatters", "Endings of a chatter that were summed in closed form."),
    ]),
    ("First", &[
        row("first_release_s", "first release, time",
            "When the mass first left its stop, under shaking that changes."),
        row("first_release_g", "first release, shaking", "The amplitude of a ramp at that time."),
        row("first_crossing_s", "first crossing, time",
            "When it first crossed the barrier, under shaking that changes."),
        row("first_crossing_g", "first crossing, shaking", "The amplitude of a ramp at that time."),
        row("crosses_always_from_s", "crosses always from, time",
            "The time from which on it crossed in every forcing period."),
        row("crosses_always_from_g", "crosses always from, shaking", "The amplitude of a ramp at that time."),
    ]),
    ("Power", &[
        row("mean_load_power_w", "mean power into the load", "Of the transducer, over the settled window."),
        row("mean_coil_power_w", "mean power lost in the coil", "Of the transducer, as above."),
        row("voltage_rms_v", "RMS voltage", "Over the load of the transducer, in the settled window."),
    ]),
    ("Energy", &[
        row("work_j", "work of the base", "What the base did on the mass in the whole run."),
        row("damping_j", "lost to damping", "In the whole run."),
        row("impact_j", "lost in impacts", "In the whole run."),
        row("harvested_j", "into the load", "Of the transducer, in the whole run."),
        row("coil_j", "lost in the coil", "Of the transducer, in the whole run."),
        row("stored_j", "stored", "Energy at the end less that at the start."),
        row("impact_share", "share of the work lost in impacts", "In the settled window."),
        row("energy_residual", "energy residual", "What of the energy is not accounted for, as a share."),
    ]),
    ("Contact", &[
        row("peak_contact_force_n", "largest contact force", "Of a compliant stop on the mass."),
        row("peak_contact_pressure_pa", "largest contact pressure", "In the middle of the contact."),
    ]),
    ("Run", &[
        row("final_x_m", "displacement at the end", "Where the run ended."),
        row("final_v_m_per_s", "velocity at the end", "How fast the mass was where the run ended."),
        row("window_from_s", "window from", "The beginning of the settled window."),
        row("window_to_s", "window to", "Its end."),
        row("periods", "periods judged", "Forcing periods in the settled window."),
        row("outcome", "outcome", "How the run ended."),
        row("ended_at_s", "ended early at", "When a run ended that did not last to its end."),
        row("steps", "steps", "Steps of the integration."),
        row("evaluations", "evaluations", "Taylor expansions of the equation of motion."),
    ]),
];

/// The row of the column called `name` in files.
pub fn column_info(name: &str) -> Option<&'static ColumnInfo> {
    COLUMNS.iter().flat_map(|group| group.1).find(|info| info.column == name)
}

impl ColumnInfo {
    pub fn field(&self) -> Option<&'static SummaryField> {
        SummaryField::find(self.column)
    }

    /// Its name with an initial capital, for a heading.
    pub fn title(&self) -> String {
        let mut letters = self.name.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }

    /// The words that can be its values, in order; `None` for a numeric column.
    pub fn words(&self) -> Option<&'static [&'static str]> {
        words_of(self.column)
    }

    /// The factor from the unit in files to the unit that suits `values`, and the name of that unit.
    pub fn unit(&self, values: impl Iterator<Item = f64>) -> (f64, &'static str) {
        let column = Column { name: self.column.to_owned(), values: Values::Words(Vec::new()) };
        match column.unit() {
            "m" => (1e3, "mm"),
            "m/s" => speed_unit(values),
            "J" => (1e3, "mJ"),
            "Pa" => (1e-6, "MPa"),
            "W" => power_unit(values.fold(0.0, |largest, value| value.abs().max(largest))),
            unit => (1.0, unit),
        }
    }

    /// Whether its values are whole numbers.
    pub fn is_count(&self) -> bool {
        self.field().is_some_and(|field| matches!(field.read, Read::Count(_)))
    }
}

/// The text on the screen for a word of a column.
pub fn said(column: &str, word: &str) -> String {
    match (column, word) {
        ("settled", "true") => "settled".to_owned(),
        ("settled", _) => "not settled".to_owned(),
        ("steady", "true") => "averages steady".to_owned(),
        ("steady", _) => "averages drift".to_owned(),
        ("side", "both") => "both sides".to_owned(),
        ("side", side) => format!("{side}-hand side"),
        (_, "done") => "lasted to its end".to_owned(),
        _ => word.replace('_', " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::SUMMARY_FIELDS;

    #[test]
    fn every_field_of_a_summary_has_one_name() {
        let all: Vec<&ColumnInfo> = COLUMNS.iter().flat_map(|group| group.1).collect();
        for field in SUMMARY_FIELDS {
            assert_eq!(all.iter().filter(|info| info.column == field.name).count(), 1, "{}", field.name);
            let words = matches!(field.read, Read::Word(_) | Read::Flag(_));
            assert_eq!(column_info(field.name).unwrap().words().is_some(), words, "{}", field.name);
        }
        assert_eq!(all.len(), SUMMARY_FIELDS.len());
        let mut names: Vec<&str> = all.iter().map(|info| info.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len());
        assert_eq!(column_info(RMS).unwrap().title(), "RMS velocity");
        assert_eq!(column_info("max_abs_x_m").unwrap().unit([0.02].into_iter()), (1e3, "mm"));
    }
}
