//! Font of the pictures, and the width of a text.
//!
//! Inter (The Inter Project Authors, SIL Open Font License 1.1, text in `assets/fonts`), cut down to
//! Latin, Greek and the signs that a formula needs. It is part of the program: no font of the machine is
//! looked for, so a picture is the same everywhere.

use std::sync::Once;

use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};

/// The name under which the letters are registered, and that an SVG asks its reader for.
const FAMILY: &str = "Inter, Helvetica, Arial, sans-serif";

/// Ascent and descent of the font together, in ems: what plotters' bitmaps call the size of a text.
pub const LINE_HEIGHT: f64 = 2478.0 / 2048.0;

/// Height of a capital letter in ems.
pub const CAPITAL: f64 = 1490.0 / 2048.0;

/// The files of the font, regular and bold.
pub const FACES: [&[u8]; 2] = [
    include_bytes!("../../../assets/fonts/Inter-Regular.ttf"),
    include_bytes!("../../../assets/fonts/Inter-SemiBold.ttf"),
];

/// The font in a size given as plotters' bitmaps understand it.
pub fn font(plotters_size: f64, bold: bool) -> FontDesc<'static> {
    static REGISTER: Once = Once::new();
    REGISTER.call_once(|| {
        let [regular, bold] = FACES;
        // A font that were broken would show as an error of every drawing; a test draws.
        let _ = register_font(FAMILY, FontStyle::Normal, regular);
        let _ = register_font(FAMILY, FontStyle::Bold, bold);
    });
    let style = if bold { FontStyle::Bold } else { FontStyle::Normal };
    FontDesc::new(FontFamily::Name(FAMILY), plotters_size, style)
}

/// Width of `words` where an em is `size` high.
pub fn width(words: &str, size: f64, bold: bool) -> f64 {
    // Measured large, because the answer comes in whole pixels.
    const ENLARGED: f64 = 16.0;
    let measured = font(size * LINE_HEIGHT * ENLARGED, bold).box_size(words);
    measured.map_or(0.0, |(width, _)| f64::from(width) / ENLARGED)
}
