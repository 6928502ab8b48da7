//! Legend in a row above a picture.

use eframe::egui::{Color32, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::Style;
use crate::app::words::meanings::explained;

use super::ghosts::dashed;

/// Height in points of the row.
pub const LEGEND: f32 = 22.0;

/// Width in points of a symbol.
const SYMBOL: f32 = 18.0;
/// Gap in points between a symbol and its name.
const GAP: f32 = 6.0;
/// Gap in points between entries.
const ENTRY_GAP: f32 = 14.0;

/// Short names of long entries.
const SHORT: [(&str, &str); 6] = [
    ("potential with the push", "with the push"),
    ("the mechanism's own", "its own"),
    ("beyond the stops", "beyond"),
    ("holds the mass there", "holds it"),
    ("push of the base", "push"),
    ("at rest on a stop", "at rest"),
];

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Symbol {
    Line(Stroke),
    Dashed(Stroke),
    /// A line with the dashes of a pin.
    Dashes(Stroke, usize),
    Ring(Stroke),
    Shade(Color32),
    Dots(Color32),
    Ticks(Stroke),
}

impl Symbol {
    fn shapes(self, rect: Rect) -> Vec<Shape> {
        let ends = [rect.left_center(), rect.right_center()];
        match self {
            Self::Line(stroke) => vec![Shape::line_segment(ends, stroke)],
            Self::Dashed(stroke) => Shape::dashed_line(&ends, stroke, 4.0, 3.0),
            Self::Dashes(stroke, place) => dashed(&ends, place, stroke),
            Self::Ring(stroke) => vec![Shape::circle_stroke(rect.center(), 3.0, stroke)],
            Self::Dots(color) => [-6.0, 0.0, 6.0]
                .map(|x| Shape::circle_filled(rect.center() + vec2(x, 0.0), 2.2, color))
                .to_vec(),
            Self::Shade(color) => vec![Shape::rect_filled(rect, 0.0, color)],
            Self::Ticks(stroke) => [-4.0, 0.0, 4.0]
                .map(|x| {
                    let at = rect.center() + vec2(x, 0.0);
                    Shape::line_segment([at - vec2(0.0, 4.0), at + vec2(0.0, 4.0)], stroke)
                })
                .to_vec(),
        }
    }
}

/// Draws the entries in the upper row of `area`, with short names if the long ones do not all fit left of
/// `right`; entries that still do not fit are left out. Each is explained on hover.
pub fn legend(ui: &Ui, style: &Style, area: Rect, right: f32, entries: &[(Symbol, &str)]) {
    let painter = ui.painter().with_clip_rect(area);
    let written = |text: &str| painter.layout_no_wrap(text.to_owned(), style.small(), style.faint());
    let wide: f32 = entries.iter().map(|(_, text)| SYMBOL + GAP + written(text).size().x + ENTRY_GAP).sum();
    let is_wide = area.left() + 8.0 + wide - ENTRY_GAP <= right - 4.0;
    let (mut x, y) = (area.left() + 8.0, area.top() + 0.5 * LEGEND);
    for (sign, name) in entries {
        let short = SHORT.iter().find(|(long, _)| long == name).map_or(*name, |pair| pair.1);
        let galley = written(if is_wide { name } else { short });
        let (width, height) = (galley.size().x, galley.size().y);
        if x + SYMBOL + GAP + width > right - 4.0 {
            break;
        }
        let rect = Rect::from_min_max(pos2(x, y - 5.0), pos2(x + SYMBOL, y + 5.0));
        painter.extend(sign.shapes(rect));
        painter.galley(pos2(x + SYMBOL + GAP, y - 0.5 * height), galley, style.faint());
        let whole = Rect::from_min_max(rect.min, pos2(x + SYMBOL + GAP + width, rect.max.y));
        explained(ui.interact(whole, ui.scope_id().with(("legend", name)), Sense::hover()), name);
        x += SYMBOL + GAP + width + ENTRY_GAP;
    }
}
