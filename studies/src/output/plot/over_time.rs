//! Panel of a quantity over time, as in the picture of a run and in the window.

use super::axis::PlotAxis;
use super::chart::{Layer, Marks, Panel, Side};
use super::names::{BASE_ACCELERATION, VELOCITY, axis_name};
use super::role::Role;
use crate::simulate::RunPanel;

/// Events and positions that a panel over time shows in addition to the values. Unknown numbers are NaN.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq)]
pub struct OverTime {
    /// The axis of time in s.
    pub time: PlotAxis,
    /// Times in s at rest on a stop, with their name in the legend.
    pub rests: (Vec<(f64, f64)>, &'static str),
    /// Times in s of the impacts on the left and on the right stop.
    pub impacts: [Vec<f64>; 2],
    /// Positions of the stops in mm.
    pub stops: (f64, f64),
    /// Positions of the wells in mm.
    pub wells: Vec<f64>,
}

impl RunPanel {
    /// Label of the axis of this quantity in a unit. With a load, power is that into the load.
    #[doc(hidden)]
    pub fn label(self, unit: &str, has_load: bool) -> String {
        let name = match self {
            Self::Velocity => VELOCITY,
            Self::Acceleration => BASE_ACCELERATION,
            Self::Power if has_load => "power into the load",
            Self::Power => "power of the base",
            _ => self.name(),
        };
        axis_name(name, unit)
    }

    /// The role of its line.
    #[doc(hidden)]
    pub fn role(self, has_load: bool) -> Role {
        match self {
            Self::Velocity => Role::Second,
            Self::Power if has_load => Role::Second,
            Self::Acceleration | Self::Power => Role::Drive,
            _ => Role::Motion,
        }
    }

    /// Its panel with these lines over this axis. The stops, the wells and the impacts on the stops stand in
    /// the panel of the displacement alone.
    #[doc(hidden)]
    pub fn over_time(self, up: PlotAxis, lines: Vec<Layer>, beside: &OverTime) -> Panel {
        let mut panel = Panel::new(beside.time.clone(), up);
        panel.rests(beside);
        if self == Self::Displacement {
            panel.level_stops(beside.stops);
            let wells = beside.wells.iter().copied().filter(|mm| panel.y.contains(*mm)).collect();
            panel.layer_if_any(Role::Well, "well", Marks::Horizontals(wells));
        } else {
            panel.draw(Role::Reference, Marks::Horizontals(vec![0.0]));
        }
        panel.layers.extend(lines);
        let impacts = beside.impacts.iter().filter(|_| self == Self::Displacement);
        for (times, side) in impacts.zip([Side::Bottom, Side::Top]) {
            let at = times.iter().copied().filter(|t| beside.time.contains(*t)).collect();
            panel.layer_if_any(Role::Impact, "impact", Marks::Ticks(at, side));
        }
        panel
    }
}

impl Panel {
    /// Adds the times at rest.
    pub(crate) fn rests(&mut self, beside: &OverTime) {
        let (spans, name) = &beside.rests;
        self.layer_if_any(Role::Rest, *name, Marks::Spans(spans.clone()));
    }
}
