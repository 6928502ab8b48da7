//! Lyapunov exponents over a field.

use crate::output::{Chart, Marks, Panel, PlotAxis, Ranges, Role, ascending, of_rows, spans, swept_axis};
use crate::scene::Scene;
use crate::study::{Grid, Table};

/// Both Lyapunov exponents over the field of the grid, each with its standard error as a band; from all rows.
pub(super) fn chart(rows: &Table, grid: &Grid, scene: &Scene, ranges: Ranges) -> Chart {
    let x = grid.columns()[0].as_str();
    let numbers = |name: &str| rows.numbers(name).unwrap_or_default();
    let (places, first) = (numbers(x), numbers("exponent_1_per_s"));
    let both = first.iter().chain(numbers("exponent_2_per_s")).copied();
    let up = PlotAxis::from_zero(both, 0.06, "Lyapunov exponent (1/s)").or_given(ranges.y);
    let mut panel = Panel::new(swept_axis(rows, x, ranges.x), up);
    let order = ascending(places, |_| true);
    let lines =
        [("first exponent", "exponent_1", Role::Curve), ("second exponent", "exponent_2", Role::Envelope)];
    let there = first.iter().any(|value| value.is_finite());
    for (_, name, _) in &lines {
        let (values, errors) = (numbers(&format!("{name}_per_s")), numbers(&format!("{name}_se")));
        let error = |row: usize| if errors[row].is_finite() { errors[row] } else { 0.0 };
        let band = order.iter().map(|&row| [places[row], values[row] - error(row), values[row] + error(row)]);
        if there {
            panel.layer(Role::Around, "standard error", Marks::Band(band.collect()));
        }
    }
    if there {
        panel.draw(Role::Reference, Marks::Horizontals(vec![0.0]));
    }
    for (words, name, role) in lines {
        let values = numbers(&format!("{name}_per_s"));
        let points = order.iter().map(|&row| (places[row], values[row])).collect();
        panel.layer(role, if there { words } else { "" }, Marks::Path(points));
    }
    let without =
        |is: fn(&f64) -> bool| spans(places, order.iter().copied().filter(move |row| is(&first[*row])));
    let resting = without(|value| *value == f64::NEG_INFINITY);
    panel.layer_if_any(Role::Rest, "both \u{2212}\u{221e} (rests on a stop)", resting);
    panel.layer_if_any(Role::Missing, "no value", without(|value| value.is_nan()));
    let names = [x, "exponent_1_per_s", "exponent_1_se", "exponent_2_per_s", "exponent_2_se"];
    let data = of_rows("exponents", rows, &names, |row| panel.x.contains(places[row]));
    let motions = grid.cells();
    let drive = scene.harmonic().filter(|drive| grid.axes()[0].field != drive.frequency_path());
    let shaken = drive.map_or(String::new(), |drive| format!(", shaken at {}", drive.frequency_in_words()));
    let about = format!("rates at which small changes of the settled motion grow, {motions} motions{shaken}");
    Chart::stack(vec![panel], about, data)
}
