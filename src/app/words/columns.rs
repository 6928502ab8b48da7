//! The columns of a summary on the screen: their groups, titles, units and words.

use crate::app::words::capital;
use crate::output::RMS;
use interwell_studies::study::SummaryField;

/// The columns that are offered, in groups.
#[rustfmt::skip]
pub const COLUMNS: [(&str, &[&str]); 7] = [
    ("Motion", &[
        RMS, "regime", "max_abs_x_m", "travel_m", "min_x_m", "max_x_m", "mean_x_m", "side", "period",
        "settled", "steady", "settles_at_s",
    ]),
    ("Events", &[
        "crossings", "impacts", "releases", "impact_speed_max_m_per_s", "rested_share", "crossing_periods",
        "release_periods", "total_crossings", "total_impacts", "rests", "chatter_sums",
    ]),
    ("First", &[
        "first_release_s", "first_release_g", "first_crossing_s", "first_crossing_g", "crosses_always_from_s",
        "crosses_always_from_g",
    ]),
    ("Power", &["mean_load_power_w", "mean_coil_power_w", "voltage_rms_v"]),
    ("Energy", &[
        "work_j", "damping_j", "impact_j", "harvested_j", "coil_j", "stored_j", "impact_share",
        "energy_residual",
    ]),
    ("Contact", &["peak_contact_force_n", "peak_contact_pressure_pa"]),
    ("Run", &[
        "final_x_m", "final_v_m_per_s", "window_from_s", "window_to_s", "periods", "outcome", "ended_at_s",
        "steps", "evaluations",
    ]),
];

/// The label of a column with an initial capital, for a heading.
pub fn title(column: &SummaryField) -> String {
    capital(column.label)
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
    use crate::output::words_of;
    use interwell_studies::study::{Read, SUMMARY_FIELDS};

    #[test]
    fn every_field_of_a_summary_has_one_name() {
        let all: Vec<&str> = COLUMNS.iter().flat_map(|group| group.1).copied().collect();
        for field in SUMMARY_FIELDS {
            assert_eq!(all.iter().filter(|name| **name == field.name).count(), 1, "{}", field.name);
            let words = matches!(field.read, Read::Word(_) | Read::Flag(_));
            assert_eq!((!field.words.is_empty(), words_of(field.name).is_some()), (words, words));
        }
        assert_eq!(all.len(), SUMMARY_FIELDS.len());
        let mut names: Vec<&str> = SUMMARY_FIELDS.iter().map(|field| field.label).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len());
        assert_eq!(title(SummaryField::find(RMS).unwrap()), "RMS velocity");
    }
}
