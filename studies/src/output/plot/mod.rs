//! Pictures as PNG, SVG or PDF.
//!
//! A study's table becomes a [`Chart`]: panels, axes and layers, each with its [`Role`]. [`Chart::figure`]
//! lays it out as a list of simple shapes, and [`Format::bytes`] paints them. Positions do not depend on the
//! theme, and equal data give equal bytes.

mod assembly;
mod axis;
mod beside;
mod cells;
mod chart;
mod drawn;
mod figure;
mod font;
mod frame;
mod grid;
mod labels;
mod ledger;
mod mark;
mod mechanism;
mod names;
mod over_time;
mod page;
mod pdf;
mod png;
mod portrait;
mod projection;
mod push;
mod quantity;
mod role;
mod sheet;
mod sketch;
mod style;
mod subset;
mod surface;
mod svg;
mod thinned;
mod well;

use std::path::Path;

use crate::study::words;

pub use crate::study::{OutsideCurve, StatesError};

pub use crate::accuracy::{accuracy_chart, cost_panel, scene_accuracy_chart, steps_panel};
pub use crate::basins::basins_chart;
pub use crate::best::best_chart;
pub use crate::compare::{compared_name, comparison_chart, comparison_title, three_digits};
pub use crate::curve::{contact_chart, curve_chart, force_panel, shapes_chart, zero_of_energy};
pub use crate::distance::distance_chart;
pub use crate::identify::{identified_chart, measured_chart, measured_force_chart};
pub use crate::orbit::{branch_chart, loci_chart};
pub use crate::simulate::{RunPanel, RunPicture, run_chart};
pub use crate::spectrum::{SpectrumQuantity, spectrum_chart};
pub use crate::sweep::{
    Cut, MAX_PICTURE_CELLS, NOT_SETTLED, NoPicture, Overlay, SweepPicture, View, Walk, WalkedRun, can_show,
    shown_columns, sweep_chart,
};
pub(crate) use crate::sweep::{
    ascending, can_show_over_field, each_line, few_lines, label, map, spans, swept_axis,
};
pub use assembly::{Assembly, MagnetPair};
pub(crate) use axis::superscript;
pub use axis::{PlotAxis, Ranges};
pub use cells::{Colours, Shade, Shades};
pub use chart::{Chart, Layer, Marks, Note, Panel, PanelColumn, Side};
pub(crate) use drawn::{Drawn, as_numbers, of_rows};
pub(crate) use figure::Point;
pub use figure::{Area, Figure, Shape, Text};
pub use font::{HACK, INTER, width as text_width};
pub use frame::Frame;
pub(crate) use ledger::ledger_panel;
pub use ledger::{LedgerTerm, ledger_bars, ledger_decimals, ledger_number, share_of_work};
pub use mark::Caption;
pub(crate) use mark::REGIMES;
pub use mechanism::mechanism_chart;
pub use names::{BASE_ACCELERATION, DISPLACEMENT, FREQUENCY, HOLDING_FORCE, TIME, VELOCITY, axis_name};
pub use over_time::OverTime;
pub use png::PaintError;
pub use portrait::portrait_panel;
pub(crate) use quantity::Quantity;
pub use quantity::{RMS, quantities, suited_unit, words_of};
pub use role::{Look, Role};
pub use sheet::{Sheet, SheetError, SheetText};
pub use sketch::{DrawnPart, Sketch};
pub use style::{BLACK, Ink, TICK, Theme, is_fine};
pub(crate) use style::{COOL, KINDS, WARM};
pub use surface::{MAX_SURFACE_CELLS, SurfaceFrame};
pub use well::{TippedPotential, well_chart, well_panel};

words! {
    /// A kind of file that holds a picture.
    Format {
        /// Pixels.
        Png = "png",
        /// Shapes.
        Svg = "svg",
        /// Shapes on a page, with their font.
        Pdf = "pdf",
    }
}

/// The error of a file name without the ending of a picture format.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a picture's name ends in .png, .svg or .pdf")]
pub struct UnknownFormat;

impl Format {
    /// The format for the ending of a file name.
    ///
    /// # Errors
    ///
    /// [`UnknownFormat`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, UnknownFormat> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        ending.and_then(|ending| Self::named(&ending)).ok_or(UnknownFormat)
    }

    /// The picture as a file of this kind.
    ///
    /// # Errors
    ///
    /// [`PaintError`] for PNG, if its pixels do not fit into memory or a file.
    pub fn bytes(self, figure: &Figure) -> Result<Vec<u8>, PaintError> {
        match self {
            Self::Png => png::png(figure),
            Self::Svg => Ok(svg::svg(figure).into_bytes()),
            Self::Pdf => Ok(pdf::pdf(figure)),
        }
    }
}
