//! Colours, widths and sizes of the pictures.
//!
//! Colours are those of Okabe and Ito (2008, "Color Universal Design"), with one meaning each. Elements that
//! differ in colour also differ in shape, hatching or dashes. Sizes are in units of a canvas of 1600 by 1000
//! on a screen, chosen so that the smallest text is legible at half that size. On paper the width of the
//! canvas in units follows from the size of the text.

use super::sheet::{Sheet, canvas_width};

/// A colour: red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ink(pub u8, pub u8, pub u8);

impl Ink {
    /// This colour at `share` of its strength over `paper`.
    pub fn over(self, paper: Ink, share: f64) -> Self {
        let mix = |over: u8, under: u8| {
            (f64::from(over) * share + f64::from(under) * (1.0 - share)).round().clamp(0.0, 255.0) as u8
        };
        Self(mix(self.0, paper.0), mix(self.1, paper.1), mix(self.2, paper.2))
    }
}

/// Width and height of the canvas for a screen.
pub const SIZE: (u32, u32) = (1600, 1000);

/// Width below which a canvas is narrow.
pub const NARROW: f64 = 1150.0;

pub const FOOTER_LINE: f64 = 26.0;

/// Text sizes: the height of an em.
pub const TITLE: f64 = 40.0;
/// Below the title.
pub const SUBTITLE: f64 = 28.0;
/// Labels of axes.
pub const AXIS: f64 = 29.0;
/// Numbers at ticks, and legends.
#[doc(hidden)]
pub const TICK: f64 = 26.0;
/// The footer.
pub const FOOTER: f64 = 20.0;

/// A data line.
pub const LINE: f64 = 3.5;
/// A data line among close lines.
pub const FINE_LINE: f64 = 2.4;
/// A reference line, such as the release over a map.
pub const GUIDE: f64 = 5.0;
/// A thin line: wells, zero.
pub const THIN: f64 = 1.8;
/// Frame and ticks.
pub const FRAME: f64 = 2.0;
pub const GRID: f64 = 1.2;
/// Half the size of a marker.
pub const MARKER: f64 = 9.0;
/// Strength of the colour of what is not sure.
pub const PALER: f64 = 0.45;
/// Distance between the lines of a hatching, and their width.
pub const HATCH: (f64, f64) = (11.0, 1.6);
pub const WALL: f64 = 30.0;
pub const TICK_LENGTH: f64 = 9.0;
/// Dash and gap of a dashed line.
pub const DASH: (f64, f64) = (18.0, 11.0);
/// Dash and gap of a short dashed line.
pub const SHORT_DASH: (f64, f64) = (9.0, 7.0);
/// Dash and gap of a dotted line.
pub const DOT: (f64, f64) = (3.0, 7.0);

/// Whether a line of this width belongs to a frame, a grid or a hatching.
#[doc(hidden)]
pub fn is_fine(width: f64) -> bool {
    width == FRAME || width < THIN
}

const ORANGE: Ink = Ink(0xe6, 0x9f, 0x00);
const SKY: Ink = Ink(0x56, 0xb4, 0xe9);
const GREEN: Ink = Ink(0x00, 0x9e, 0x73);
const BLUE: Ink = Ink(0x00, 0x72, 0xb2);
const VERMILION: Ink = Ink(0xd5, 0x5e, 0x00);
const PURPLE: Ink = Ink(0xcc, 0x79, 0xa7);
const APRICOT: Ink = Ink(0xe8, 0x9a, 0x5c);
const PURPLE_LINE: Ink = Ink(0xb0, 0x54, 0x88);

/// The theme of a picture: its sheet of paper, and its colours by their meaning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Theme {
    /// The sheet of paper; none for a screen.
    pub sheet: Option<Sheet>,
    /// Background.
    pub paper: Ink,
    /// Text, frames, motion and force.
    pub ink: Ink,
    /// Text of less weight.
    pub soft: Ink,
    /// Grid lines.
    pub grid: Ink,
    /// Velocity, and the way down of a walk.
    pub second: Ink,
    /// Acceleration of the base.
    pub shaking: Ink,
    /// Stops.
    pub wall: Ink,
    /// Wells, and the best of several.
    pub stable: Ink,
    /// Unstable motions, and thresholds with gaps above.
    pub unstable: Ink,
    /// Impacts.
    pub impact: Ink,
    /// Time spent at rest, cells at rest.
    pub rest: Ink,
    /// The hatching over cells at rest.
    pub rest_hatch: Ink,
    /// Potential and kinetic energy together.
    pub energy: Ink,
    /// The regimes `rest`, `intrawell`, `irregular`, `interwell`, `crossing`.
    pub regimes: [Ink; 5],
}

impl Theme {
    /// Dark on light, for paper and projectors.
    pub const LIGHT: Self = Self {
        sheet: None,
        paper: Ink(0xff, 0xff, 0xff),
        ink: Ink(0x1a, 0x1a, 0x1a),
        soft: Ink(0x5a, 0x5a, 0x5a),
        grid: Ink(0xe0, 0xe0, 0xe0),
        second: PURPLE_LINE,
        shaking: Ink(0x1e, 0x7d, 0xb4),
        wall: GREEN,
        stable: SKY,
        unstable: ORANGE,
        impact: VERMILION,
        rest: Ink(0xe4, 0xe4, 0xe4),
        rest_hatch: Ink(0x9a, 0x9a, 0x9a),
        energy: Ink(0x8c, 0x5c, 0x00),
        regimes: [Ink(0x80, 0x80, 0x80), BLUE, PURPLE, VERMILION, APRICOT],
    };

    /// Light on dark.
    pub const DARK: Self = Self {
        sheet: None,
        paper: Ink(0x14, 0x17, 0x1c),
        ink: Ink(0xf2, 0xf2, 0xf2),
        soft: Ink(0xb0, 0xb5, 0xbd),
        grid: Ink(0x33, 0x38, 0x40),
        second: PURPLE,
        shaking: SKY,
        wall: Ink(0x28, 0xbe, 0x91),
        stable: SKY,
        unstable: ORANGE,
        impact: Ink(0xf0, 0x78, 0x28),
        rest: Ink(0x3a, 0x3f, 0x47),
        rest_hatch: Ink(0x72, 0x78, 0x82),
        energy: Ink(0xff, 0xe0, 0x9a),
        regimes: [Ink(0x9a, 0x9a, 0x9a), Ink(0x2b, 0x95, 0xd6), PURPLE, Ink(0xf0, 0x73, 0x10), APRICOT],
    };

    /// The inside of a wall.
    pub fn wall_fill(&self) -> Ink {
        self.wall.over(self.paper, 0.22)
    }

    /// The colour of `share` from 0 to 1 for lines on the paper: a part of the map's scale that stands out
    /// from it.
    pub fn step(&self, share: f64) -> Ink {
        if self.ink.0 > self.paper.0 { viridis(0.3 + 0.7 * share) } else { viridis(0.85 * share) }
    }

    /// Light or dark, on a screen or on a sheet of paper.
    pub fn of(dark: bool, sheet: Option<Sheet>) -> Self {
        Self { sheet, ..if dark { Self::DARK } else { Self::LIGHT } }
    }

    /// Whether the canvas is so narrow that columns of panels are stacked.
    pub fn is_narrow(&self) -> bool {
        canvas_width(self.sheet.as_ref()) < NARROW
    }
}

/// Colours of kinds without a fixed colour, such as attractors. The first ones differ most in lightness, so
/// that they can be distinguished without colour.
pub const KINDS: [Ink; 8] = [
    Ink(0x1e, 0x52, 0x8c),
    Ink(0xf3, 0xb6, 0x40),
    Ink(0x2a, 0x9a, 0x7c),
    Ink(0xc4, 0xe2, 0xf5),
    Ink(0xb0, 0x3a, 0x14),
    Ink(0xde, 0x8c, 0xb4),
    Ink(0x48, 0x1e, 0x5a),
    Ink(0xa6, 0xa8, 0x9c),
];

/// The places of the cool [`KINDS`] in the order in which they are used: neighbours differ in lightness.
pub const COOL: [usize; 5] = [0, 3, 2, 6, 7];
/// Those of the warm ones.
pub const WARM: [usize; 3] = [4, 1, 5];

/// The hatching of a kind whose colour is used a second time.
pub fn kind_hatch(place: usize) -> Option<Ink> {
    let Ink(red, green, blue) = KINDS[place % KINDS.len()];
    let is_dark = 2 * u32::from(red) + 5 * u32::from(green) + u32::from(blue) < 8 * 128;
    (place >= KINDS.len()).then_some(if is_dark { WHITE } else { BLACK })
}

/// White, for lines over a map in both themes.
pub const WHITE: Ink = Ink(0xff, 0xff, 0xff);
/// Black, for outlines over a map.
#[doc(hidden)]
pub const BLACK: Ink = Ink(0, 0, 0);
/// Interwell motion over a map.
pub const OVER_MAP: Ink = VERMILION;

/// The colour of `share` from 0 to 1 on the map's scale: viridis (van der Walt and Smith 2015), whose
/// lightness increases evenly, so that it can be read with any colour blindness and in black and white.
pub(super) fn viridis(share: f64) -> Ink {
    const STOPS: [Ink; 16] = [
        Ink(0x44, 0x01, 0x54),
        Ink(0x48, 0x1a, 0x6c),
        Ink(0x47, 0x2f, 0x7d),
        Ink(0x41, 0x44, 0x87),
        Ink(0x39, 0x56, 0x8c),
        Ink(0x31, 0x68, 0x8e),
        Ink(0x2a, 0x78, 0x8e),
        Ink(0x23, 0x88, 0x8e),
        Ink(0x1f, 0x98, 0x8b),
        Ink(0x22, 0xa8, 0x84),
        Ink(0x35, 0xb7, 0x79),
        Ink(0x54, 0xc5, 0x68),
        Ink(0x7a, 0xd1, 0x51),
        Ink(0xa5, 0xdb, 0x36),
        Ink(0xd2, 0xe2, 0x1b),
        Ink(0xfd, 0xe7, 0x25),
    ];
    let place = if share.is_finite() { share.clamp(0.0, 1.0) * 15.0 } else { 0.0 };
    let below = (place as usize).min(14);
    STOPS[below + 1].over(STOPS[below], place - below as f64)
}
