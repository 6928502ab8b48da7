//! Picture of Lyapunov exponents over a field: both of them, each with its standard error as a band.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel, Side};
use super::drawn::Drawn;
use super::figure::Point;
use super::role::Role;
use super::sweep::{MAX_PICTURE_CELLS, NoPicture};
use super::swept::{ascending, swept_axis};
use crate::scene::Scene;
use crate::study::{Grid, Table};

/// What the picture is drawn from.
#[derive(Debug, Clone, Copy)]
pub struct ExponentPicture<'a> {
    /// All rows.
    pub rows: &'a Table,
    /// Of which grid, of one field.
    pub grid: &'a Grid,
    /// Over which scene.
    pub scene: &'a Scene,
    /// The axes.
    pub ranges: Ranges,
}

/// Whether exponents over this grid can be shown.
pub fn can_show_exponents(grid: &Grid) -> Result<(), NoPicture> {
    match grid.axes().len() {
        1 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 => Ok(()),
        n => Err(NoPicture::Exponents(n)),
    }
}

/// Both exponents over the field of the grid.
pub fn exponents_chart(picture: &ExponentPicture) -> Result<Chart, NoPicture> {
    can_show_exponents(picture.grid)?;
    let ExponentPicture { rows, grid, ranges, .. } = *picture;
    let x = &grid.columns()[0];
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
        let points: Vec<Point> = order.iter().map(|&row| (places[row], values[row])).collect();
        panel.layer(role, if there { words } else { "" }, Marks::Path(points));
    }
    let without = |is: fn(&f64) -> bool| -> Vec<f64> {
        order.iter().filter(|row| is(&first[**row])).map(|row| places[*row]).collect()
    };
    let resting = without(|value| *value == f64::NEG_INFINITY);
    if !resting.is_empty() {
        let name = "both \u{2212}\u{221e} (rests on a stop)";
        panel.layer(Role::Motion, name, Marks::Ticks(resting, Side::Bottom));
    }
    let missing = without(|value| value.is_nan());
    if !missing.is_empty() {
        panel.layer(Role::Missing, "no value", Marks::Ticks(missing, Side::Bottom));
    }
    let names = ["exponent_1_per_s", "exponent_1_se", "exponent_2_per_s", "exponent_2_se"];
    let columns = names.map(numbers);
    let mut drawn = Drawn::new([x.as_str()].into_iter().chain(names), &[]);
    for (row, at) in places.iter().enumerate().filter(|place| panel.x.contains(*place.1)) {
        let [a, b, c, d] = columns.map(|column| column[row]);
        drawn.put("exponents", &[*at, a, b, c, d], &[]);
    }
    Ok(Chart::stack(vec![panel], about(picture), drawn.table()))
}

/// What is shown, in one line.
fn about(picture: &ExponentPicture) -> String {
    let swept = picture.grid.axes().iter().map(|axis| axis.values.len()).sum::<usize>();
    let is_swept = |field: &str| picture.grid.axes().iter().any(|axis| axis.field == field);
    let drive = picture.scene.harmonic().filter(|drive| !is_swept(drive.frequency_path()));
    let shaken = drive.map_or(String::new(), |drive| format!(", shaken at {}", drive.frequency_in_words()));
    format!("rates at which small changes of the settled motion grow, {swept} motions{shaken}")
}
