//! Picture of a spectrum: amplitude or power spectral density, logarithmic, over frequency.

use super::axis::{PlotAxis, Ranges};
use super::drawn::Drawn;
use super::figure::{Figure, Point};
use super::frame::Frame;
use super::mark::{Caption, Sample, legend};
use super::style::{self, Theme};
use super::swept::{LEAST, TOP};
use crate::numeric::{Taper, short};
use crate::study::{Signal, Spectrum};

/// The column that is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpectrumQuantity {
    /// Amplitude of the sine at each frequency.
    Amplitude,
    /// Power spectral density.
    Density,
}

/// Where the frame begins on a wide canvas.
const LEFT: f64 = 190.0;

/// The share of the power up to the right edge, where no range was asked for.
const POWER: f64 = 0.9999;

/// Decades of amplitude below the greatest line, where no range was asked for.
const DECADES: f64 = 7.0;

/// The most forcing frequencies that are marked and named.
const MOST_MARKED: usize = 4;

/// The picture of a spectrum. `ranges` are those of the frequency in Hz and of the quantity.
pub fn spectrum_figure(
    spectrum: &Spectrum,
    quantity: SpectrumQuantity,
    ranges: Ranges,
    caption: &Caption,
    theme: &Theme,
) -> Figure {
    let mut figure = Figure::new(theme, caption, LEAST);
    let column = |name: &str| spectrum.table.numbers(name).unwrap_or_default();
    let (frequencies, density) = (column("frequency_hz"), column("psd"));
    let (values, label) = match quantity {
        SpectrumQuantity::Amplitude => (column("amplitude"), label(spectrum.signal).0),
        SpectrumQuantity::Density => (density, label(spectrum.signal).1),
    };

    let across = PlotAxis::between(0.0, shown_to(spectrum, frequencies, density), 8, "frequency, Hz");
    let across = across.or_given(ranges.x, 8, "frequency, Hz");
    let seen = frequencies
        .iter()
        .zip(values)
        .filter(|(frequency, _)| (across.low..=across.high).contains(*frequency));
    let seen = seen.map(|pair| *pair.1).filter(|value| *value > 0.0);
    let (least, greatest) =
        seen.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    let decades = if quantity == SpectrumQuantity::Density { 2.0 * DECADES } else { DECADES };
    let ends = ranges.y.unwrap_or((least.max(greatest * 10_f64.powf(-decades)), greatest * 1.5));
    let mut up = PlotAxis::decades([ends.0, ends.1], 8, label);
    if ranges.y.is_some() {
        (up.low, up.high) = (ends.0.log10(), ends.1.log10());
        up.ticks.retain(|tick| (up.low..=up.high).contains(&tick.0));
    }

    let mut entries = Vec::new();
    let marked: Vec<f64> = spectrum.forcing_hz.iter().copied().take(MOST_MARKED).collect();
    let names: Vec<String> = marked.iter().map(|hz| short(*hz)).collect();
    let words = match (names.len(), spectrum.forcing_hz.len()) {
        (1, _) => format!("forcing frequency, {} Hz", names[0]),
        (some, all) if some < all => format!("forcing frequencies, {}, .. Hz", names.join(", ")),
        _ => format!("forcing frequencies, {} Hz", names.join(", ")),
    };
    if !marked.is_empty() {
        entries.push((Sample::Line(theme.shaking, style::GUIDE, Some(style::DASH)), words.as_str()));
    }
    let ends = (LEFT, figure.right());
    let top = match entries.as_slice() {
        [] => 135.0,
        some => TOP.max(legend(&mut figure, theme, some, ends, 146.0) + 18.0),
    };
    let frame = Frame::whole(&figure, (LEFT, top), across, up);
    frame.grid(&mut figure, theme);
    for frequency in marked.iter().copied() {
        frame.vertical(&mut figure, frequency, style::GUIDE, theme.shaking, Some(style::DASH));
    }
    let floor = frame.y.low - 1.0;
    let height = |value: f64| if value > 0.0 { value.log10().max(floor) } else { floor };
    let points = frequencies.iter().zip(values).map(|(frequency, value)| (*frequency, height(*value)));
    if spectrum.period.is_some() && spectrum.taper == Taper::None {
        sticks(&mut figure, &frame, points, theme);
    } else {
        frame.dense_line(&mut figure, points, style::THIN, theme.ink);
    }
    frame.axes(&mut figure, theme);
    let name = if quantity == SpectrumQuantity::Density { "psd" } else { "amplitude" };
    let mut drawn = Drawn::new(["frequency_hz", name], &[]);
    for (frequency, value) in frequencies.iter().zip(values) {
        if (frame.x.low..=frame.x.high).contains(frequency) {
            drawn.put("line", &[*frequency, *value], &[]);
        }
    }
    marked.iter().for_each(|frequency| drawn.put("forcing", &[*frequency], &[]));
    figure.data = drawn.table();
    caption.draw(&mut figure, theme, &spectrum.describe(), LEFT);
    figure
}

/// What stands at the axis upward: of the amplitude and of the density.
fn label(signal: Signal) -> (&'static str, &'static str) {
    match signal {
        Signal::Displacement => {
            ("amplitude of displacement, m", "power spectral density of displacement, m\u{b2}/Hz")
        }
        Signal::Velocity => {
            ("amplitude of velocity, m/s", "power spectral density of velocity, (m/s)\u{b2}/Hz")
        }
        Signal::BaseAcceleration => (
            "amplitude of base acceleration, m/s\u{b2}",
            "power spectral density of base acceleration, (m/s\u{b2})\u{b2}/Hz",
        ),
    }
}

/// The frequency in Hz up to which nearly all of the power lies, and some forcing frequencies at least.
fn shown_to(spectrum: &Spectrum, frequencies: &[f64], density: &[f64]) -> f64 {
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

/// An upright line for each line of the spectrum that is seen; of those in one pixel the highest.
fn sticks(figure: &mut Figure, frame: &Frame, points: impl Iterator<Item = Point>, theme: &Theme) {
    let mut open: Option<Point> = None;
    let mut draw = |stick: Option<Point>| {
        if let Some((x, y)) = stick {
            figure.line(&[(x, frame.area.bottom), (x, y)], style::LINE, theme.ink, frame.area);
        }
    };
    for point in points.filter(|point| point.1 > frame.y.low) {
        let (x, y) = frame.place(point);
        open = match open {
            Some((last, top)) if x - last < 1.0 => Some((last, y.min(top))),
            other => {
                draw(other);
                Some((x, y))
            }
        };
    }
    draw(open);
}
