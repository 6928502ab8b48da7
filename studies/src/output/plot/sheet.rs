//! Sheet of paper that a picture is laid out for: its width, and the size that its text has there.

use serde::{Deserialize, Serialize};

use super::style::{SIZE, TICK};

/// Length of a typographic point in mm.
const MM_A_POINT: f64 = 25.4 / 72.0;

/// A picture of a given width on paper.
///
/// It is a part of a [`Theme`](super::Theme): [`Theme::of`](super::Theme::of) takes it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sheet {
    /// Width in mm.
    pub width_mm: f64,
    /// Height in mm; by default that of the panels is 5/8 of the width, or what they need.
    pub height_mm: Option<f64>,
    /// Size in points of the numbers at ticks and of legends; labels of axes are a tenth larger.
    pub font_pt: f64,
    /// Pixels in an inch, for a kind of file that has pixels.
    pub dpi: f64,
    /// Whether title, subtitle and footer are shown.
    pub titled: bool,
}

/// A sheet of paper as text, part by part.
#[derive(Debug, Clone, Copy)]
pub struct SheetText<'a> {
    /// Width in mm.
    pub width_mm: &'a str,
    /// Height in mm, where one is asked for.
    pub height_mm: Option<&'a str>,
    /// Size of the text in points.
    pub font_pt: &'a str,
    /// Pixels in an inch; by default 300.
    pub dpi: Option<&'a str>,
    /// Whether title, subtitle and footer are shown.
    pub titled: bool,
}

/// An invalid part of a sheet.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{argument} = {value}: {problem}")]
pub struct SheetError {
    /// The field of [`SheetText`] that gives it.
    pub argument: &'static str,
    /// The value that was given.
    pub value: String,
    /// What is wrong with the value.
    pub problem: String,
}

impl Sheet {
    /// Parses a sheet; `has_pixels` says whether the file format has pixels.
    ///
    /// # Errors
    ///
    /// [`SheetError`] with the part that is no number or out of its range, and the range.
    pub fn read(text: &SheetText<'_>, has_pixels: bool) -> Result<Self, SheetError> {
        let error =
            |argument, value: &str, problem| SheetError { argument, value: value.to_owned(), problem };
        let within = |argument, text: &str, (least, most): (f64, f64), what: &str, example: &str| {
            let number = text.trim().parse().ok().filter(|number: &f64| (least..=most).contains(number));
            let problem = format!("give {what}, {least} to {most}, such as {example}");
            number.ok_or_else(|| error(argument, text, problem))
        };
        let width_mm = within("width_mm", text.width_mm, Self::MM, "a width in mm", "85")?;
        let height = |text| within("height_mm", text, Self::MM, "a height in mm", "60");
        let height_mm = text.height_mm.map(height).transpose()?;
        let font_pt = within("font_pt", text.font_pt, Self::FONT_PT, "a size in points", "8")?;
        let dpi = text.dpi.map_or(Ok(300.0), |text| {
            within("dpi", text, Self::DPI, "a resolution in pixels an inch", "300")
        })?;
        let most = width_mm / (Self::MIN_EMS * MM_A_POINT);
        if font_pt > most {
            let most = (10.0 * most).floor() / 10.0;
            let problem = format!("a picture {width_mm} mm wide has room for text of at most {most} points");
            return Err(error("font_pt", text.font_pt, problem));
        }
        let sheet = Self { width_mm, height_mm, font_pt, dpi, titled: text.titled };
        let longest = width_mm.max(height_mm.unwrap_or(0.0));
        if has_pixels && f64::from(sheet.pixels(longest)) > Self::MOST_PIXELS {
            let problem = format!(
                "{longest} mm would be {} pixels; at most {} are drawn, which is {} an inch",
                (longest / 25.4 * dpi).round(),
                Self::MOST_PIXELS,
                (Self::MOST_PIXELS * 25.4 / longest).floor()
            );
            return Err(error("dpi", &dpi.to_string(), problem));
        }
        Ok(sheet)
    }

    /// The font sizes in points that a sheet may have.
    pub const FONT_PT: (f64, f64) = (4.0, 36.0);

    /// The widths and heights in mm.
    pub const MM: (f64, f64) = (40.0, 2000.0);

    /// The resolutions in pixels an inch.
    pub const DPI: (f64, f64) = (30.0, 2400.0);

    /// Largest number of pixels of width and height.
    pub const MOST_PIXELS: f64 = 6000.0;

    /// Smallest width for the layout of pictures, in multiples of the size of the text.
    const MIN_EMS: f64 = 24.0;

    /// The length in mm of a unit of the canvas.
    pub fn unit_mm(&self) -> f64 {
        self.font_pt * MM_A_POINT / TICK
    }

    /// A length in mm in pixels.
    pub fn pixels(&self, mm: f64) -> u32 {
        (mm / 25.4 * self.dpi).round().clamp(1.0, 2.0 * Self::MOST_PIXELS) as u32
    }
}

/// The width of the canvas in units: that of the sheet, or that of the screen.
pub fn canvas_width(sheet: Option<&Sheet>) -> f64 {
    sheet.map_or(f64::from(SIZE.0), |sheet| sheet.width_mm / sheet.unit_mm())
}
