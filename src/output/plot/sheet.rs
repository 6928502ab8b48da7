//! Sheet of paper that a picture is laid out for: its width, and the size that its text has there.

use super::style::{SIZE, TICK};

/// Units of length: so many mm are a point of text.
const MM_A_POINT: f64 = 25.4 / 72.0;

/// A picture of a given width on paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    /// Width in mm.
    pub width_mm: f64,
    /// Height in mm; left out, the data stand on 5/8 of the width, or on what they need.
    pub height_mm: Option<f64>,
    /// Size in points of the numbers at ticks and of legends; labels of axes are a tenth larger.
    pub font_pt: f64,
    /// Pixels in an inch, for a kind of file that has pixels.
    pub dpi: f64,
    /// Whether title, subtitle and footer are shown.
    pub titled: bool,
}

impl Sheet {
    /// The font sizes in points that a sheet may have.
    pub const FONT_PT: (f64, f64) = (4.0, 36.0);

    /// The widths and heights in mm.
    pub const MM: (f64, f64) = (40.0, 2000.0);

    /// The resolutions in pixels an inch.
    pub const DPI: (f64, f64) = (30.0, 2400.0);

    /// The most pixels each way.
    pub const MOST_PIXELS: f64 = 6000.0;

    /// The least width, in times the size of the text, on which the pictures can be laid out.
    const LEAST_EMS: f64 = 24.0;

    /// The length in mm of a unit of the canvas.
    pub fn unit_mm(&self) -> f64 {
        self.font_pt * MM_A_POINT / TICK
    }

    /// The largest text in points that `width_mm` has room for.
    pub fn largest_font_pt(width_mm: f64) -> f64 {
        width_mm / (Self::LEAST_EMS * MM_A_POINT)
    }

    /// A length in mm in pixels.
    pub fn pixels(&self, mm: f64) -> u32 {
        (mm / 25.4 * self.dpi).round().clamp(1.0, 2.0 * Self::MOST_PIXELS) as u32
    }
}

/// The width of the canvas in units: that of the sheet, or that of the screen.
pub fn canvas_width(sheet: Option<&Sheet>) -> f64 {
    sheet.map_or(f64::from(SIZE.0), |own| own.width_mm / own.unit_mm())
}
