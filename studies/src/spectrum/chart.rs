//! Picture of a spectrum: amplitude or power spectral density, logarithmic, over frequency.

use super::{Signal, SpectrumAnswer};
use crate::numeric::{Taper, elementary, extent, short};
use crate::output::{
    BASE_ACCELERATION, Chart, Drawn, FREQUENCY, Marks, Panel, PlotAxis, Point, Ranges, Role, VELOCITY,
    suited_unit,
};

words! {
    /// The column that is shown.
    SpectrumQuantity {
        /// Amplitude of the sine at each frequency.
        Amplitude = "amplitude",
        /// Power spectral density.
        Density = "psd",
    }
}

/// Share of the power below the right edge of the default range.
const POWER: f64 = 0.9999;

/// Decades of amplitude below the largest line in the default range.
const DECADES: f64 = 7.0;

/// Largest number of forcing frequencies that are marked and named.
const MAX_MARKED: usize = 4;

/// The picture of the answer of a [`Spectrum`](crate::questions::Spectrum). `ranges` are those of the
/// frequency in Hz and of the quantity, in the unit of its axis: an amplitude below 2 m or 2 m/s is shown
/// in mm or mm/s.
pub fn spectrum_chart(spectrum: &SpectrumAnswer, quantity: SpectrumQuantity, ranges: Ranges) -> Chart {
    let column = |name: &str| spectrum.table.numbers(name).unwrap_or_default();
    let (frequencies, values) = (column("frequency_hz"), column(quantity.name()));
    let (scale, label) = scale_and_label(spectrum.signal, quantity, values);
    let decades = if quantity == SpectrumQuantity::Density { 2.0 * DECADES } else { DECADES };
    let across = PlotAxis::between(0.0, shown_to(spectrum, frequencies, column("psd")), FREQUENCY);
    let across = across.or_given(ranges.x);
    let seen = frequencies.iter().zip(values).filter(|line| across.contains(*line.0));
    let seen = seen.map(|pair| pair.1 * scale).filter(|value| *value > 0.0);
    let (least, greatest) = extent(seen);
    let lowest = least.max(greatest * elementary::powf(10.0, -decades));
    let up = PlotAxis::decades([lowest, greatest * 1.5], &label).or_given(ranges.y);
    let mut panel = Panel::new(across, up);
    let marked: Vec<f64> = spectrum.forcing_hz.iter().copied().take(MAX_MARKED).collect();
    let names: Vec<String> = marked.iter().map(|hz| short(*hz)).collect();
    let words = match (names.len(), spectrum.forcing_hz.len()) {
        (1, _) => format!("forcing frequency, {} Hz", names[0]),
        (some, all) if some < all => format!("forcing frequencies, {}, .. Hz", names.join(", ")),
        _ => format!("forcing frequencies, {} Hz", names.join(", ")),
    };
    panel.layer_if_any(Role::Drive, words, Marks::Verticals(marked.clone()));
    let floor = panel.y.low - 1.0;
    let height = |value: f64| if value > 0.0 { elementary::log10(value).max(floor) } else { floor };
    let points: Vec<Point> = frequencies
        .iter()
        .zip(values)
        .map(|(frequency, value)| (*frequency, height(value * scale)))
        .collect();
    let is_lines = spectrum.period.is_some() && spectrum.taper == Taper::None;
    panel.draw(Role::Motion, if is_lines { Marks::Sticks(points) } else { Marks::Trace(points) });
    let mut drawn = Drawn::new(["frequency_hz", quantity.name()], &[]);
    for (frequency, value) in frequencies.iter().zip(values).filter(|line| panel.x.contains(*line.0)) {
        drawn.put("line", &[*frequency, *value], &[]);
    }
    marked.iter().for_each(|frequency| drawn.put("forcing", &[*frequency], &[]));
    Chart::stack(vec![panel], spectrum.describe(), drawn.table())
}

/// The factor to the unit of the vertical axis, and the label of that axis.
fn scale_and_label(signal: Signal, quantity: SpectrumQuantity, values: &[f64]) -> (f64, String) {
    let (name, unit, squared) = match signal {
        Signal::Displacement => ("displacement", "m", "m\u{b2}"),
        Signal::Velocity => (VELOCITY, "m/s", "m\u{b2}/s\u{b2}"),
        Signal::BaseAcceleration => (BASE_ACCELERATION, "m/s\u{b2}", "m\u{b2}/s\u{2074}"),
    };
    match quantity {
        SpectrumQuantity::Amplitude => {
            let (scale, unit) = suited_unit(unit, values.iter().copied());
            (scale, format!("amplitude of {name} ({unit})"))
        }
        SpectrumQuantity::Density => (1.0, format!("power spectral density of {name} ({squared}/Hz)")),
    }
}

/// The frequency in Hz up to which nearly all of the power lies, and some forcing frequencies at least.
fn shown_to(spectrum: &SpectrumAnswer, frequencies: &[f64], density: &[f64]) -> f64 {
    let last = frequencies.last().copied().unwrap_or(1.0);
    let total: f64 = density.iter().skip(1).sum();
    let mut below = 0.0;
    let holds = |density: &f64| {
        below += density;
        below >= POWER * total
    };
    let place = density.iter().skip(1).position(holds).map_or(0, |place| place + 1);
    let forcing = spectrum.forcing_hz.iter().copied().fold(0.0, f64::max);
    let bulk = frequencies.get(place).copied().unwrap_or(last);
    (1.25 * bulk).max(8.5 * forcing).min(last)
}
