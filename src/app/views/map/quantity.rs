//! Quantities that a map can show, and their colours.

use crate::app::session::map::Map;
use crate::app::words::kind::Kind;
use crate::dynamics::Regime;
use crate::output::{PlotAxis, speed_unit};
use crate::study::Cell;

/// What the colour of a map says.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum MapQuantity {
    /// RMS velocity.
    #[default]
    Speed,
    /// Kind of motion.
    Regime,
    /// Largest displacement.
    Reach,
    /// Impacts in the settled window.
    Impacts,
    /// Forcing periods after which it repeats.
    Period,
}

/// What one cell shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Look {
    /// Not run yet.
    Unknown,
    /// The run ended early, or there was no mechanism.
    Missing,
    /// At rest, which is not little motion.
    Rest,
    /// A value that there is no number for: motion that does not repeat.
    None,
    /// A kind of motion.
    Kind(Kind),
    /// A share of the scale, 0 to 1.
    Share(f32),
}

impl MapQuantity {
    /// All of them, in the order of the choice.
    pub const ALL: [Self; 5] = [Self::Speed, Self::Regime, Self::Reach, Self::Impacts, Self::Period];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "RMS velocity",
            Self::Regime => "Regime",
            Self::Reach => "Reach",
            Self::Impacts => "Impacts",
            Self::Period => "Period",
        }
    }

    /// The number in the unit of its scale; none for a regime.
    fn value(self, cell: &Cell, per_speed: f64) -> Option<f64> {
        let own = cell.settled()?;
        match self {
            Self::Speed => own.rms_velocity.map(|rms| rms * per_speed),
            Self::Reach => own.max_abs_x.map(|reach| reach * 1e3),
            Self::Impacts => Some(own.impacts as f64),
            Self::Period => own.period.map(f64::from),
            Self::Regime => None,
        }
    }
}

/// The colours of one map of one quantity.
pub struct ColourScale {
    quantity: MapQuantity,
    per_speed: f64,
    /// The bar beside the map; none for regimes.
    pub bar: Option<PlotAxis>,
    /// Whether equal ratios are equal steps of colour.
    log: bool,
}

impl ColourScale {
    /// From nothing to the largest value that the map has so far.
    pub fn of(quantity: MapQuantity, map: &Map) -> Self {
        let speeds = map.own_cells().filter_map(|cell| cell.summary()?.rms_velocity);
        let (per_speed, unit) = speed_unit(speeds);
        let values = map.own_cells().filter_map(|cell| quantity.value(cell, per_speed));
        let most = values.fold(0.0_f64, f64::max);
        let window = map.window_s();
        let bar = match quantity {
            MapQuantity::Regime => None,
            MapQuantity::Speed => Some(PlotAxis::between(0.0, most, 5, &format!("RMS velocity ({unit})"))),
            MapQuantity::Reach => Some(PlotAxis::between(0.0, most, 5, "reach (mm)")),
            MapQuantity::Impacts => Some(counts(most, &format!("impacts in {window} s"))),
            MapQuantity::Period => Some(PlotAxis {
                low: 0.5,
                high: 12.5,
                ticks: (1..=12).map(|n| (f64::from(n), n.to_string())).collect(),
                label: "repeats after forcing periods".to_owned(),
            }),
        };
        Self { quantity, per_speed, bar, log: quantity == MapQuantity::Impacts }
    }

    /// What a cell shows.
    pub fn look(&self, cell: &Cell) -> Look {
        let Some(summary) = cell.settled() else { return Look::Missing };
        match (summary.regime, self.quantity) {
            (Regime::Rest, _) => Look::Rest,
            (regime, MapQuantity::Regime) => Look::Kind(Kind::from(regime)),
            _ => match (self.quantity.value(cell, self.per_speed), &self.bar) {
                (Some(value), Some(bar)) => Look::Share(self.share(value, bar) as f32),
                _ => Look::None,
            },
        }
    }

    /// Where a value stands on the bar, 0 to 1.
    pub fn share(&self, value: f64, bar: &PlotAxis) -> f64 {
        if self.log { (1.0 + value).ln() / (1.0 + bar.high).ln() } else { bar.share(value) }
    }

    /// Whether each whole number has one colour of its own.
    pub fn steps(&self) -> Option<usize> {
        (self.quantity == MapQuantity::Period).then_some(12)
    }
}

/// A scale of counts, which go from two to a thousand: ticks at 1 and 3 times powers of ten.
fn counts(most: f64, label: &str) -> PlotAxis {
    let high = most.max(1.0);
    let powers = (0..9).flat_map(|power| [1, 3].map(|digit| digit * 10_u64.pow(power)));
    let ticks = std::iter::once(0).chain(powers).map(|n| (n as f64, n.to_string()));
    PlotAxis { low: 0.0, high, ticks: ticks.filter(|tick| tick.0 <= high).collect(), label: label.to_owned() }
}
