//! Legend in a row over a picture.

use eframe::egui::{Color32, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::Style;
use crate::app::words::meanings::explained;

use super::ghosts::dashed;

/// Height in points of the row.
pub const LEGEND: f32 = 22.0;

/// Width in points of a sign, room between it and its name, and between entries.
const SIGN: f32 = 18.0;
const GAP: f32 = 6.0;
const APART: f32 = 14.0;

/// What long entries are called where room is short.
const SHORT: [(&str, &str); 5] = [
    ("potential with the push", "with the push"),
    ("the mechanism's own", "its own"),
    ("holds the mass there", "holds it"),
    ("push of the base", "push"),
    ("at rest on a stop", "at rest"),
];

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sign {
    Line(Stroke),
    Dashed(Stroke),
    /// A line with the dashes of a pin.
    Dashes(Stroke, usize),
    Ring(Stroke),
    Shade(Color32),
    Dots(Color32),
    Pluses(Color32),
    Ticks(Stroke),
}

impl Sign {
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
            Self::Pluses(color) => [-6.0, 0.0, 6.0]
                .into_iter()
                .flat_map(|x| {
                    [vec2(2.4, 0.0), vec2(0.0, 2.4)].map(|arm| {
                        let middle = rect.center() + vec2(x, 0.0);
                        Shape::line_segment([middle - arm, middle + arm], Stroke::new(1.2, color))
                    })
                })
                .collect(),
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

/// The entries in the upper row of `area`, in their short words where there is no room before `right` for all
/// of the long ones; what has no room even so is left out. Each says under the pointer what it means.
pub fn legend(ui: &Ui, style: &Style, area: Rect, right: f32, entries: &[(Sign, &str)]) {
    let painter = ui.painter().with_clip_rect(area);
    let written = |text: &str| painter.layout_no_wrap(text.to_owned(), style.small(), style.faint());
    let wide: f32 = entries.iter().map(|(_, text)| SIGN + GAP + written(text).size().x + APART).sum();
    let is_wide = area.left() + 8.0 + wide - APART <= right - 4.0;
    let (mut x, y) = (area.left() + 8.0, area.top() + 0.5 * LEGEND);
    for (sign, name) in entries {
        let short = SHORT.iter().find(|(long, _)| long == name).map_or(*name, |own| own.1);
        let galley = written(if is_wide { name } else { short });
        let (width, height) = (galley.size().x, galley.size().y);
        if x + SIGN + GAP + width > right - 4.0 {
            break;
        }
        let rect = Rect::from_min_max(pos2(x, y - 5.0), pos2(x + SIGN, y + 5.0));
        painter.extend(sign.shapes(rect));
        painter.galley(pos2(x + SIGN + GAP, y - 0.5 * height), galley, style.faint());
        let whole = Rect::from_min_max(rect.min, pos2(x + SIGN + GAP + width, rect.max.y));
        explained(ui.interact(whole, ui.scope_id().with(("legend", name)), Sense::hover()), name);
        x += SIGN + GAP + width + APART;
    }
}
