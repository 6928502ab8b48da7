//! Table of the columns of a summary: what each is called on the screen, and what it says, in groups.

use crate::app::words::numbers::power_unit;
use crate::output::{RMS, speed_unit, words_of};
use crate::study::{Column, Read, SummaryField, Values};

#[derive(Debug, PartialEq, Eq)]
pub struct ColumnInfo {
    /// Its name in a table.
    pub column: &'static str,
    /// What it is called.
    pub name: &'static str,
    /// What it says.
    pub about: &'static str,
}

const fn own(column: &'static str, name: &'static str, about: &'static str) -> ColumnInfo {
    ColumnInfo { column, name, about }
}

/// All of them in their groups.
#[rustfmt::skip]
pub static COLUMNS: [(&str, &[ColumnInfo]); 7] = [
    ("Motion", &[
        own(RMS, "RMS velocity", "Root of the mean square of the velocity over the settled window."),
        own("regime", "regime", "What kind of motion it is."),
        own("max_abs_x_m", "reach", "The largest distance from the middle in the settled window."),
        own("travel_m", "travel",
            "From the leftmost place to the rightmost one of the settled window."),
        own("min_x_m", "leftmost place", "The least displacement in the settled window."),
        own("max_x_m", "rightmost place", "The largest displacement in the settled window."),
        own("mean_x_m", "mean displacement", "The mean over the settled window."),
        own("side", "side", "On which side of the barrier the mass stays."),
        own("period", "period", "Forcing periods after which the motion repeats, up to 12."),
        own("settled", "settled", "Whether the motion repeats, or the mass rests."),
        own("steady", "averages steady",
            "Whether the averages over both halves of the settled window agree, though the motion may be \
             irregular."),
        own("settles_at_s", "settles at", "The time since when the motion repeats."),
    ]),
    ("Events", &[
        own("crossings", "crossings", "How often the mass crossed the barrier in the settled window."),
        own("impacts", "impacts", "How often it struck a stop in the settled window."),
        own("releases", "releases", "How often it left a stop on which it rested, in the settled window."),
        own("impact_speed_max_m_per_s", "fastest impact",
            "The largest speed of an impact in the settled window."),
        own("rested_share", "share of time at rest",
            "The share of the settled window that the mass rests on a stop."),
        own("crossing_periods", "periods with a crossing", "Forcing periods in which the mass crossed."),
        own("release_periods", "periods with a release", "Forcing periods in which it left a stop."),
        own("total_crossings", "crossings in all", "From the start of the run on."),
        own("total_impacts", "impacts in all", "From the start of the run on."),
        own("rests", "arrivals at rest", "How often the mass came to rest on a stop, from the start on."),
        own("chatter_sums", "summed chatters", "Endings of a chatter that were summed in closed form."),
    ]),
    ("First", &[
        own("first_release_s", "first release, time",
            "When the mass first left its stop, under shaking that changes."),
        own("first_release_g", "first release, shaking", "The amplitude of a ramp at that time."),
        own("first_crossing_s", "first crossing, time",
            "When it first crossed the barrier, under shaking that changes."),
        own("first_crossing_g", "first crossing, shaking", "The amplitude of a ramp at that time."),
        own("crosses_always_from_s", "crosses always from, time",
            "The time from which on it crossed in every forcing period."),
        own("crosses_always_from_g", "crosses always from, shaking", "The amplitude of a ramp at that time."),
    ]),
    ("Power", &[
        own("mean_load_power_w", "mean power into the load", "Of the transducer, over the settled window."),
        own("mean_coil_power_w", "mean power lost in the coil", "Of the transducer, as above."),
        own("voltage_rms_v", "RMS voltage", "Over the load of the transducer, in the settled window."),
    ]),
    ("Energy", &[
        own("work_j", "work of the base", "What the base did on the mass in the whole run."),
        own("damping_j", "lost to damping", "In the whole run."),
        own("impact_j", "lost in impacts", "In the whole run."),
        own("harvested_j", "into the load", "Of the transducer, in the whole run."),
        own("coil_j", "lost in the coil", "Of the transducer, in the whole run."),
        own("stored_j", "stored", "Energy at the end less that at the start."),
        own("impact_share", "share of the work lost in impacts", "In the settled window."),
        own("energy_residual", "energy residual", "What of the energy is not accounted for, as a share."),
    ]),
    ("Contact", &[
        own("peak_contact_force_n", "largest contact force", "Of a compliant stop on the mass."),
        own("peak_contact_pressure_pa", "largest contact pressure", "In the middle of the contact."),
    ]),
    ("Run", &[
        own("final_x_m", "displacement at the end", "Where the run ended."),
        own("final_v_m_per_s", "velocity at the end", "How fast the mass was where the run ended."),
        own("window_from_s", "window from", "The beginning of the settled window."),
        own("window_to_s", "window to", "Its end."),
        own("periods", "periods judged", "Forcing periods in the settled window."),
        own("outcome", "outcome", "How the run ended."),
        own("ended_at_s", "ended early at", "When a run ended that did not last to its end."),
        own("steps", "steps", "Steps of the integration."),
        own("evaluations", "evaluations", "Taylor expansions of the equation of motion."),
    ]),
];

/// What is known of the column called `name`.
pub fn column_info(name: &str) -> Option<&'static ColumnInfo> {
    COLUMNS.iter().flat_map(|group| group.1).find(|own| own.column == name)
}

impl ColumnInfo {
    pub fn field(&self) -> Option<&'static SummaryField> {
        SummaryField::find(self.column)
    }

    /// Its name at the head of something.
    pub fn title(&self) -> String {
        let mut letters = self.name.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }

    /// The words that it can have, in their order; none for one of numbers.
    pub fn words(&self) -> Option<&'static [&'static str]> {
        words_of(self.column)
    }

    /// The unit in which numbers up to those given are short, and how many of it the table's own unit is.
    pub fn unit(&self, values: impl Iterator<Item = f64>) -> (f64, &'static str) {
        let column = Column { name: self.column.to_owned(), values: Values::Words(Vec::new()) };
        match column.unit() {
            "m" => (1e3, "mm"),
            "m/s" => speed_unit(values),
            "J" => (1e3, "mJ"),
            "Pa" => (1e-6, "MPa"),
            "W" => power_unit(values.fold(0.0, |most, own| own.abs().max(most))),
            own => (1.0, own),
        }
    }

    /// Whether its numbers are whole.
    pub fn is_count(&self) -> bool {
        self.field().is_some_and(|field| matches!(field.read, Read::Count(_)))
    }
}

/// A word of a column of words as it is said.
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
            assert_eq!(all.iter().filter(|own| own.column == field.name).count(), 1, "{}", field.name);
            let words = matches!(field.read, Read::Word(_) | Read::Flag(_));
            assert_eq!(column_info(field.name).unwrap().words().is_some(), words, "{}", field.name);
        }
        assert_eq!(all.len(), SUMMARY_FIELDS.len());
        let mut names: Vec<&str> = all.iter().map(|own| own.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len());
        assert_eq!(column_info(RMS).unwrap().title(), "RMS velocity");
        assert_eq!(column_info("max_abs_x_m").unwrap().unit([0.02].into_iter()), (1e3, "mm"));
    }
}
