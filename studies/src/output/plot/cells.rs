//! Grid of cells, each with a value, and the colours of values.

use serde::{Deserialize, Serialize};

use super::axis::PlotAxis;
use super::figure::{Area, Figure, Text};
use super::font;
use super::role::Role;
use super::style::{self, Ink, Theme, viridis};
use crate::study::Edges;

/// A cell of a map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Shade {
    /// Nothing is drawn.
    Blank,
    /// No value.
    Missing,
    /// At rest.
    Rest,
    /// A value.
    Value(f64),
}

impl Shade {
    /// Its value, where it has one.
    pub fn value(self) -> Option<f64> {
        if let Self::Value(value) = self { Some(value) } else { None }
    }
}

/// How values are coloured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Colours {
    /// Along this axis.
    Scale(PlotAxis),
    /// Symmetric about 0, up to this magnitude.
    Signed(f64),
    /// By whole numbers that are indices of these roles and words.
    Categories(Vec<(Role, String)>),
}

impl Colours {
    /// The colour of a value.
    pub fn ink(&self, value: f64, theme: &Theme) -> Ink {
        match self {
            Self::Scale(axis) => viridis(axis.share(value)),
            Self::Signed(reach) => {
                let share = (value / reach).clamp(-1.0, 1.0);
                let ink = if share < 0.0 { theme.regimes[1] } else { theme.regimes[3] };
                ink.over(theme.rest, share.abs())
            }
            Self::Categories(kinds) => {
                kinds.get(value as usize).map_or(theme.soft, |kind| theme.look(kind.0).ink)
            }
        }
    }

    /// Draws a colour bar in `area` with the numbers of its axis. Each step reaches up to the top, under
    /// those above, so that the background does not show between them.
    pub fn bar(&self, figure: &mut Figure, area: Area, axis: &PlotAxis, theme: &Theme) {
        const STEPS: usize = 256;
        let Area { left, top, right, bottom } = area;
        let height = (bottom - top) / STEPS as f64;
        for i in 0..STEPS {
            let low = bottom - i as f64 * height;
            let share = (i as f64 + 0.5) / STEPS as f64;
            let ink = match self {
                Self::Scale(_) => viridis(share),
                Self::Signed(_) | Self::Categories(_) => {
                    self.ink(axis.low + share * (axis.high - axis.low), theme)
                }
            };
            figure.rect(Area::new(left, top, right, low), ink);
        }
        figure.outline(area, style::FRAME, theme.ink);
        for (value, words) in &axis.ticks {
            let at = bottom - axis.share(*value) * (bottom - top);
            let tick = [(right, at), (right + style::TICK_LENGTH, at)];
            figure.line(&tick, style::FRAME, theme.ink, figure.canvas);
            let place = (right + style::TICK_LENGTH + 7.0, at + 0.5 * style::TICK * font::CAPITAL);
            figure.text(Text::new(words, place, style::TICK, theme.ink));
        }
    }

    /// The hatching over a value that has one.
    pub fn hatch(&self, value: f64, theme: &Theme) -> Option<Ink> {
        match self {
            Self::Categories(kinds) => kinds.get(value as usize).and_then(|kind| theme.look(kind.0).hatch),
            _ => None,
        }
    }
}

/// A grid of cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shades {
    /// The values to the right.
    pub across: Edges,
    /// The values upward.
    pub up: Edges,
    /// The cells, column by column.
    pub cells: Vec<Shade>,
    /// Colours of their values.
    pub colours: Colours,
    /// Why a cell is missing, in the legend.
    pub missing: String,
}

impl Shades {
    /// The cell of a column and a row.
    pub fn at(&self, column: usize, row: usize) -> Shade {
        self.cells[column * self.up.values.len() + row]
    }

    /// The roles and words of the legend: existing categories, cells at rest and missing cells.
    pub fn entries(&self) -> Vec<(Role, String)> {
        let has = |cell: Shade| self.cells.contains(&cell);
        let mut entries = Vec::new();
        if let Colours::Categories(kinds) = &self.colours {
            let there = kinds.iter().enumerate().filter(|kind| has(Shade::Value(kind.0 as f64)));
            entries.extend(there.map(|(_, kind)| kind.clone()));
        }
        if has(Shade::Rest) {
            entries.push((Role::Rest, "at rest".to_owned()));
        }
        if has(Shade::Missing) {
            entries.push((Role::Missing, self.missing.clone()));
        }
        entries
    }
}
