//! Font of the pictures: its letters, their outlines, and the width of a text.
//!
//! Inter (The Inter Project Authors, SIL Open Font License 1.1, text in `assets/fonts`), cut down to Latin,
//! Greek and the signs that a formula needs. The font is embedded in the program and no system font is used,
//! so pictures are the same everywhere. There is no kerning.

use std::sync::LazyLock;

use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::{FontRef, GlyphId, MetadataProvider};

/// Units of the font in an em.
pub const UNITS: f64 = 2048.0;

/// Height of a capital letter in ems.
pub const CAPITAL: f64 = 1490.0 / UNITS;

/// One weight of the font.
pub struct FontFace {
    /// Its file.
    pub bytes: &'static [u8],
    /// The name that a PDF gives it.
    pub name: &'static str,
    letters: Charmap<'static>,
    metrics: GlyphMetrics<'static>,
    outlines: OutlineGlyphCollection<'static>,
}

/// A letter of a text.
#[derive(Debug, Clone, Copy)]
pub struct Letter {
    pub character: char,
    pub glyph: GlyphId,
    /// Distance from the beginning of the text to that of the letter, in ems.
    pub begin: f64,
    /// Its width in ems.
    pub width: f64,
}

/// The font files of pictures and of the window: the regular and the heavier weight.
#[doc(hidden)]
pub static INTER: [&[u8]; 2] = [
    include_bytes!("../../../assets/fonts/Inter-Regular.ttf"),
    include_bytes!("../../../assets/fonts/Inter-SemiBold.ttf"),
];

/// The font file of code in the window, and of letters that [`INTER`] lacks.
#[doc(hidden)]
pub static HACK: &[u8] = include_bytes!("../../../assets/fonts/Hack-Regular.ttf");

impl FontFace {
    /// The regular or the heavier weight.
    pub fn of(bold: bool) -> &'static Self {
        static FACES: LazyLock<[FontFace; 2]> = LazyLock::new(|| {
            [FontFace::new("Inter-Regular", INTER[0]), FontFace::new("Inter-SemiBold", INTER[1])]
        });
        &FACES[usize::from(bold)]
    }

    fn new(name: &'static str, bytes: &'static [u8]) -> Self {
        let font = FontRef::new(bytes).expect("the font is part of the program, and tests draw with it");
        Self {
            bytes,
            name,
            letters: font.charmap(),
            metrics: font.glyph_metrics(Size::unscaled(), LocationRef::default()),
            outlines: font.outline_glyphs(),
        }
    }

    /// The letters of a text; a missing letter is shown as the box of the font.
    pub fn letters(&self, words: &str) -> impl Iterator<Item = Letter> {
        words.chars().scan(0.0, |end, character| {
            let glyph = self.letters.map(character).unwrap_or_default();
            let begin = *end;
            let width = self.width(glyph);
            *end += width;
            Some(Letter { character, glyph, begin, width })
        })
    }

    /// Width of a glyph in ems.
    pub fn width(&self, glyph: GlyphId) -> f64 {
        f64::from(self.metrics.advance_width(glyph).unwrap_or_default()) / UNITS
    }

    /// Draws the outline of a glyph, in units of the font and upward, with `pen`.
    pub fn outline(&self, glyph: GlyphId, pen: &mut impl OutlinePen) {
        if let Some(outline) = self.outlines.get(glyph) {
            // fails only for a broken font
            let _ = outline.draw(DrawSettings::unhinted(Size::unscaled(), LocationRef::default()), pen);
        }
    }
}

/// Width of `words` where an em is `size` high.
pub fn width(words: &str, size: f64, bold: bool) -> f64 {
    size * FontFace::of(bold).letters(words).last().map_or(0.0, |letter| letter.begin + letter.width)
}
