//! Drawing of a transducer with its load.

use eframe::egui::{Align2, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2};

use crate::numeric::short;
use crate::scene::Transducer;

use super::{MIN_POLE, POLE, Pen, Places};

/// Half the length in points of a coil, and as a share of the width, which leaves room for the load.
const WINDING: (f32, f32) = (72.0, 0.1);
/// Thickness in points of the wires on each side of a coil.
const WOUND: f32 = 7.0;
/// Distance in points of a coil from the body, clear of the feet of the stops.
const CLEAR: f32 = 6.0;
/// Number of wires in a row of a coil.
const TURNS: usize = 18;
/// Width in points of a piezoelectric layer.
const LAYER: f32 = 28.0;

/// Distance in points from x = 0 to a piezoelectric layer, if there are no flexures.
const ASIDE: f32 = 38.0;

/// Heights in points of the two wires of a load above the clamp.
const WIRES: [f32; 2] = [13.0, 4.0];
/// Height in points of the top of a load above the clamp.
const LOAD_TOP: f32 = 19.0;
/// Distance in points to keep from the foot of a flexure.
const FOOT: f32 = 11.0;

/// Thickness in points of a flexure with patches on both of its faces.
const PATCHES: f32 = 7.0;

/// Width of a load in points.
const LOAD: f32 = 34.0;
/// Width in points on the right reserved for the scale bar and its name.
const SCALE_ROOM: f32 = 67.0;

impl Pen<'_> {
    pub(super) fn transducer(&self, shapes: &mut Vec<Shape>) {
        let Places { rect, bottom, body, zero, along, .. } = *self.places;
        let height = (bottom - body.bottom() - 12.0).clamp(8.0, 24.0);
        let (name, part, coupled, (load, unit), words) = match self.parts.transducer {
            Transducer::None => return,
            Transducer::Electromagnetic { coupling_v_s_per_m, load_ohm, .. } => {
                let part = self.coil(shapes);
                let words = format!(
                    "A coil at the frame, cut through. The magnet at the mass induces {} V in it at 1 m/s.",
                    short(coupling_v_s_per_m.abs())
                );
                ("coil", part, coupling_v_s_per_m, (load_ohm, "ohm"), words)
            }
            Transducer::Piezoelectric { coupling_n_per_v, load_kohm, .. } => {
                // patches lie where the flexures stand
                let aside = if along.is_some() { 0.0 } else { ASIDE };
                let corner = pos2(zero + aside - 0.5 * LAYER, bottom - 3.0 - height);
                let part = Rect::from_min_size(corner, vec2(LAYER, height));
                self.patches(part, shapes);
                let words = format!(
                    "A piezoelectric layer, which the motion strains: 1 V on it is a force of {} N on the \
                     mass.",
                    short(coupling_n_per_v.abs())
                );
                ("piezo", part, coupling_n_per_v, (load_kohm, "kohm"), words)
            }
        };
        let none = if coupled == 0.0 { " Its coupling is 0: it does nothing." } else { "" };
        self.explain(part, "transducer", &format!("{words}{none}"));
        let right = rect.right() - if along.is_some() { SCALE_ROOM } else { 8.0 };
        self.load(part, load, unit, name, right, shapes);
    }

    /// Distance from x = 0 that the flexures below the mass reach at a height above the clamp, with the mass
    /// at an end of the picture. Their shape is a cubic, upright at both ends. Without flexures: [`FOOT`].
    fn reach_at(&self, height: f32) -> f32 {
        let Places { rect, bottom, body, along, .. } = *self.places;
        let share = (height / (bottom - body.bottom()).max(1.0)).min(1.0);
        let bent = share * share * (3.0 - 2.0 * share);
        FOOT + if along.is_some() { 0.5 * rect.width() * bent } else { 0.0 }
    }

    /// Draws a coil around x = 0 in section, and in it the magnet of the mass, if there is room and no other
    /// magnet hangs there: then the coil lies on the clamp. Returns the right end of its lower row.
    fn coil(&self, shapes: &mut Vec<Shape>) -> Rect {
        let Places { bottom, body, zero, rect, .. } = *self.places;
        let length = 2.0 * WINDING.0.min(WINDING.1 * rect.width());
        let row = |top: f32| Rect::from_center_size(pos2(zero, top + 0.5 * WOUND), vec2(length, WOUND));
        let pole = POLE.min(0.5 * (bottom - body.bottom() - CLEAR - 2.0 * WOUND) - 2.5);
        let hangs = pole >= MIN_POLE && self.parts.magnets.is_none();
        let rows = match hangs {
            true => [body.bottom() + CLEAR, body.bottom() + CLEAR + WOUND + 2.0 * pole + 3.0],
            false => [bottom - 2.0 * WOUND - 1.0, bottom - WOUND - 1.0],
        };
        for half in rows.map(row) {
            shapes.push(Shape::rect_filled(half, 2.0, self.style.frame_colour()));
            let step = half.width() / TURNS as f32;
            shapes.extend((0..TURNS).map(|i| {
                let at = pos2(half.left() + step * (i as f32 + 0.5), half.center().y);
                Shape::circle_filled(at, 1.9, self.style.ink())
            }));
        }
        if hangs {
            let middle = pos2(body.center().x, body.bottom() + CLEAR + WOUND + pole + 1.5);
            let stem = [body.center_bottom(), middle - vec2(0.0, pole)];
            self.painter.line_segment(stem, Stroke::new(3.0, self.style.ink()));
            self.magnet(middle, pole, true);
        }
        let end = row(rows[1]);
        end.with_min_x(end.right() - WOUND)
    }

    /// Draws patches on the flexures, or without flexures a layer between two electrodes.
    fn patches(&self, part: Rect, shapes: &mut Vec<Shape>) {
        if self.places.along.is_some() {
            let stroke = Stroke::new(PATCHES, self.style.frame_colour());
            shapes.extend(self.places.feet.iter().map(|foot| Shape::line(foot.clone(), stroke)));
            return;
        }
        let layer = part.with_min_y(part.bottom() - 8.0);
        shapes.push(Shape::rect_filled(layer, 0.0, self.style.frame_colour()));
        for y in [layer.top(), layer.bottom()] {
            let ends = [pos2(layer.left(), y), pos2(layer.right(), y)];
            shapes.push(Shape::line_segment(ends, Stroke::new(2.2, self.style.ink())));
        }
    }

    /// Draws the load and its two wires: a resistor, a wire for a short circuit, a gap for an open circuit.
    fn load(&self, part: Rect, value: f64, unit: &str, name: &str, right: f32, shapes: &mut Vec<Shape>) {
        let y = WIRES.map(|height| self.places.bottom - height);
        let begin = (part.right() + 10.0).max(self.places.zero + self.reach_at(LOAD_TOP));
        let end = begin + LOAD + 9.0;
        if end > right {
            return;
        }
        let mut wire = |points: &[Pos2]| shapes.push(Shape::line(points.to_vec(), self.thin()));
        wire(&[pos2(part.right() - 3.0, part.top()), pos2(part.right() - 3.0, y[0]), pos2(begin, y[0])]);
        wire(&[pos2(part.right(), y[1]), pos2(end, y[1]), pos2(end, y[0]), pos2(begin + LOAD, y[0])]);
        let resistor = Rect::from_min_max(pos2(begin, y[0] - 5.0), pos2(begin + LOAD, y[0] + 5.0));
        let (text, words) = match value {
            0.0 => {
                wire(&[pos2(begin, y[0]), pos2(begin + LOAD, y[0])]);
                let words = "A short circuit: the load is 0 and takes no power.".to_owned();
                ("short circuit".to_owned(), words)
            }
            f64::INFINITY => {
                for x in [begin, begin + LOAD] {
                    shapes.push(Shape::circle_filled(pos2(x, y[0]), 2.5, self.style.ink()));
                }
                let words = "An open circuit: no current flows through the load, which takes no power.";
                ("open circuit".to_owned(), words.to_owned())
            }
            value => {
                shapes.push(Shape::rect_filled(resistor, 0.0, self.style.ground()));
                shapes.push(Shape::rect_stroke(resistor, 0.0, self.thin(), StrokeKind::Inside));
                let value = short(value);
                (format!("load {value} {unit}"), format!("The load, {value} {unit}, which takes the power."))
            }
        };
        let beside = (pos2(end + 6.0, y[1] + 2.0), Align2::LEFT_BOTTOM);
        let above = (pos2(resistor.center().x, resistor.top() - 3.0), Align2::CENTER_BOTTOM);
        let whole = format!("{name}, {text}");
        let names = [(&whole, beside), (&whole, above), (&text, beside), (&text, above)];
        self.name(&names.map(|(words, (at, align))| (words.as_str(), at, align)), (0.0, right));
        self.explain(resistor, "load", &words);
    }
}
