//! Picture of Lyapunov exponents over a field: both of them, each with its standard error as a band.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel, Side};
use super::drawn::of_rows;
use super::role::Role;
use super::sweep::{NoPicture, can_show_over_field};
use super::swept::{ascending, swept_axis};
use crate::scene::Scene;
use crate::study::{Grid, Table};

/// Both exponents over the field of the grid, from all rows.
pub fn exponents_chart(rows: &Table, grid: &Grid, scene: &Scene, ranges: Ranges) -> Result<Chart, NoPicture> {
    can_show_over_field(grid, "exponents")?;
    let x = grid.columns()[0].as_str();
    let numbers = |name: &str| rows.numbers(name).unwrap_or_default();
    let (places, first) = (numbers(x), numbers("exponent_1_per_s"));
    let both = first.iter().chain(numbers("exponent_2_per_s"));
    let up = PlotAxis::around(both.copied().chain([0.0]), 0.06, "Lyapunov exponent (1/s)").or_given(ranges.y);
    let mut panel = Panel::new(swept_axis(rows, x, ranges.x), up);
    let order = ascending(places, |_| true);
    let lines = [
        ("first exponent", "exponent_1", Role::Method(0)),
        ("second exponent", "exponent_2", Role::Envelope),
    ];
    let there = first.iter().any(|value| value.is_finite());
    for (_, name, _) in &lines {
        let (values, errors) = (numbers(&format!("{name}_per_s")), numbers(&format!("{name}_se")));
        let error = |row: usize| if errors[row].is_finite() { errors[row] } else { 0.0 };
        let band = order.iter().map(|&row| [places[row], values[row] - error(row), values[row] + error(row)]);
        if there {
            panel.layer(Role::Around, "standard error", Marks::Band(band.collect()));
        }
    }
    panel.draw(Role::Reference, Marks::Horizontals(vec![0.0]));
    for (words, name, role) in lines {
        let values = numbers(&format!("{name}_per_s"));
        let points = order.iter().map(|&row| (places[row], values[row])).collect();
        panel.layer(role, if there { words } else { "" }, Marks::Path(points));
    }
    let without = |is: fn(&f64) -> bool| {
        let rows = order.iter().filter(|row| is(&first[**row]));
        Marks::Ticks(rows.map(|row| places[*row]).collect(), Side::Bottom)
    };
    let resting = without(|value| *value == f64::NEG_INFINITY);
    panel.layer_if_any(Role::Motion, "both \u{2212}\u{221e} (rests on a stop)", resting);
    panel.layer_if_any(Role::Missing, "no value", without(|value| value.is_nan()));
    let names = [x, "exponent_1_per_s", "exponent_1_se", "exponent_2_per_s", "exponent_2_se"];
    let data = of_rows("exponents", rows, &names, |row| panel.x.contains(places[row]));
    let motions = grid.cells();
    let drive = scene.harmonic().filter(|drive| grid.axes()[0].field != drive.frequency_path());
    let shaken = drive.map_or(String::new(), |drive| format!(", shaken at {}", drive.frequency_in_words()));
    let about = format!("rates at which small changes of the settled motion grow, {motions} motions{shaken}");
    Ok(Chart::stack(vec![panel], about, data))
}
