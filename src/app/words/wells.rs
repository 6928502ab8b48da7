//! Names of wells.

use crate::mechanics::Landscape;

/// The name of a well by its number from the left, from 0, among `count` wells: "right-hand well".
pub fn well_name(number: usize, count: usize) -> String {
    match (number, count) {
        (0, 2..=3) => "left-hand well".to_owned(),
        (1, 3) => "middle well".to_owned(),
        (_, 2..=3) => "right-hand well".to_owned(),
        _ => {
            let ordinal = number + 1;
            let ending = match (ordinal % 10, ordinal % 100) {
                (_, 11..=13) => "th",
                (1, _) => "st",
                (2, _) => "nd",
                (3, _) => "rd",
                _ => "th",
            };
            format!("{ordinal}{ending} of {count} wells")
        }
    }
}

/// The name of the well of a motion between `low` and `high`, or of the outermost two wells that it reaches.
pub fn wells_between(landscape: &Landscape, low: f64, high: f64) -> String {
    let wells = landscape.wells();
    let at = |x: f64| wells.iter().take_while(|well| well.right_top.is_some_and(|top| x >= top)).count();
    let name = |x: f64| well_name(at(x), wells.len());
    if at(low) == at(high) { name(low) } else { format!("{} and the {}", name(low), name(high)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_well_has_a_name_of_its_own() {
        for (count, last) in [(2, "right-hand well"), (3, "right-hand well"), (4, "4th of 4 wells")] {
            let names: std::collections::HashSet<String> = (0..count).map(|i| well_name(i, count)).collect();
            assert_eq!(names.len(), count);
            assert_eq!(well_name(count - 1, count), last);
        }
        for (number, name) in [(1, "1st"), (11, "11th"), (22, "22nd"), (103, "103rd"), (111, "111th")] {
            assert_eq!(well_name(number - 1, 200), format!("{name} of 200 wells"));
        }
    }
}
