//! Pictures as PNG, SVG or PDF.
//!
//! A plot writes a [`Figure`], a list of plain shapes; [`Format::bytes`] paints it. Light or dark, the data
//! and their places are the same, and the same data give the same bytes.

mod accuracy;
mod arguments;
mod axis;
mod basins;
mod branch;
mod comparison;
mod contact;
mod curve;
mod cut;
mod drawn;
mod exponents;
mod figure;
mod font;
mod frame;
mod map;
mod mark;
mod measured;
mod paint;
mod panels;
mod pdf;
mod projection;
mod quantity;
mod record;
mod run;
mod section;
mod sheet;
mod spectrum;
mod style;
mod surface;
mod sweep;
mod swept;
mod threshold;
mod walk;

use std::path::Path;

pub use accuracy::accuracy_figure;
pub use arguments::{Argument, picture_arguments};
pub use axis::{PlotAxis, Ranges};
pub use basins::{attractor_colour, basins_figure, can_show_starts};
pub use branch::branch_figure;
pub use comparison::{ComparisonPicture, comparison_figure};
pub use contact::contact_figure;
pub use curve::curve_figure;
pub use exponents::{ExponentPicture, can_show_exponents, exponents_figure};
pub use figure::Figure;
pub use mark::Caption;
pub use measured::measured_figure;
pub use paint::PaintError;
pub use panels::Panel;
pub use projection::{
    AXIS_EDGES, BACK_EDGES, BoxPlace, Face, Projection, SIDES, faces as surface_faces, wall_lines,
};
pub use quantity::{RMS, quantities, words_of};
pub use record::{identified_figure, measured_force_figure};
pub use run::{run_figure, speed_unit};
pub use section::{SectionPicture, section_figure};
pub use sheet::{Sheet, SheetError, SheetText};
pub use spectrum::{SpectrumQuantity, spectrum_figure};
pub use style::{BLACK, Ink, Theme, viridis};
pub use sweep::{MAX_PICTURE_CELLS, NoPicture, can_show, sweep_about, sweep_figure};
pub use swept::{Cut, Overlay, SweepPicture, View};
pub use threshold::{ThresholdPicture, can_show_thresholds, threshold_figure};

/// A kind of file that holds a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Pixels.
    Png,
    /// Shapes.
    Svg,
    /// Shapes on a page, with their font.
    Pdf,
}

/// A file name that tells no kind of picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a picture's name ends in .png, .svg or .pdf")]
pub struct UnknownFormat;

impl Format {
    /// The kind that the ending of a file's name asks for.
    pub fn of(path: &Path) -> Result<Self, UnknownFormat> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("svg") => Ok(Self::Svg),
            Some("pdf") => Ok(Self::Pdf),
            _ => Err(UnknownFormat),
        }
    }

    /// The picture as a file of this kind.
    pub fn bytes(self, figure: &Figure) -> Result<Vec<u8>, PaintError> {
        match self {
            Self::Png => paint::png(figure),
            Self::Svg => paint::svg(figure).map(String::into_bytes),
            Self::Pdf => pdf::pdf(figure),
        }
    }
}
