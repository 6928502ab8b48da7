//! Pictures over one field: the rate of escape, and Lyapunov exponents.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel, Side};
use super::drawn::of_rows;
use super::figure::Point;
use super::role::Role;
use super::sweep::{MAX_PICTURE_CELLS, NoPicture};
use super::swept::{ascending, spans, swept_axis};
use crate::numeric::{elementary, short};
use crate::questions::Escape;
use crate::scene::Scene;
use crate::study::{Grid, Table, Until};

/// Checks that `what` can be shown over the field of this grid.
#[doc(hidden)]
pub fn can_show_over_field(grid: &Grid, what: &'static str) -> Result<(), NoPicture> {
    match grid.axes().len() {
        1 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 => Ok(()),
        n => Err(NoPicture::OneField(what, n)),
    }
}

/// The rate of escape over the field of the grid with its interval, on a logarithmic axis in 1/s, beside
/// Kramers' rate; from all rows of the answer to `question` about `scene`.
///
/// # Errors
///
/// [`NoPicture::OneField`] unless the grid has one field.
pub fn escape_chart(
    rows: &Table,
    grid: &Grid,
    scene: &Scene,
    question: &Escape,
    ranges: Ranges,
) -> Result<Chart, NoPicture> {
    can_show_over_field(grid, "escapes")?;
    let x = grid.columns()[0].as_str();
    let names =
        ["escape_rate_per_s", "escape_rate_low_per_s", "escape_rate_high_per_s", "kramers_rate_per_s"];
    let [rate, low, high, kramers] = names.map(|name| rows.numbers(name).unwrap_or_default());
    let places = rows.numbers(x).unwrap_or_default();
    // of a rate without an escape only the upper end is above 0
    let drawn = rate.iter().chain(low).chain(high).copied();
    let up = PlotAxis::decades(drawn, "escape rate (1/s)").or_given(ranges.y.filter(|range| range.0 > 0.0));
    let mut panel = Panel::new(swept_axis(rows, x, ranges.x), up);
    let order = ascending(places, |row| rate[row] > 0.0);
    let log = |values: &[f64], row: usize| (places[row], elementary::log10(values[row]));
    let bars = order.iter().map(|&row| [places[row], log(low, row).1, log(high, row).1]).collect();
    panel.layer(Role::Interval, "95 % interval", Marks::Intervals(bars));
    let theory = ascending(places, |row| kramers[row] > 0.0);
    let line = theory.into_iter().map(|row| log(kramers, row)).collect();
    panel.layer_if_any(Role::Envelope, "Kramers' rate", Marks::Path(line));
    let points: Vec<Point> = order.iter().map(|&row| log(rate, row)).collect();
    panel.draw(Role::Motion, Marks::Path(points.clone()));
    panel.layer(Role::Motion, "of the runs", Marks::Points(points));
    let none = ascending(places, |row| rate[row] == 0.0);
    let bounds = none.into_iter().map(|row| log(high, row)).collect();
    panel.layer_if_any(Role::Missing, "no escape: rate below", Marks::Points(bounds));
    let missing = ascending(places, |row| rate[row].is_nan()).into_iter().map(|row| places[row]);
    panel.layer_if_any(Role::Missing, "no value", Marks::Ticks(missing.collect(), Side::Bottom));
    let data = of_rows("escape", rows, &[&[x][..], &names].concat(), |row| panel.x.contains(places[row]));
    let what = match question.until {
        Until::Crossing => "first crossings of the barrier",
        Until::Well => "first arrivals in the well behind the barrier",
    };
    let within = short(question.within.unwrap_or(scene.run.duration_s));
    let runs = question.runs;
    Ok(Chart::stack(vec![panel], format!("{what}, {runs} runs of {within} s at most each"), data))
}

/// Both Lyapunov exponents over the field of the grid, each with its standard error as a band; from all rows.
///
/// # Errors
///
/// [`NoPicture::OneField`] unless the grid has one field.
pub fn exponents_chart(rows: &Table, grid: &Grid, scene: &Scene, ranges: Ranges) -> Result<Chart, NoPicture> {
    can_show_over_field(grid, "exponents")?;
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
    Ok(Chart::stack(vec![panel], about, data))
}
