//! Drawing of a transducer with its load.

use eframe::egui::{Align2, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2};

use crate::numeric::short;
use crate::scene::Transducer;

use super::{MIN_POLE, POLE, Pen, Places};

/// Width in points of each half of a coil.
const WINDING: f32 = 28.0;
/// Height in points of each half of a coil.
const WOUND: f32 = 11.0;
/// Number of wires in a row of a coil.
const TURNS: usize = 5;

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
    pub(super) fn transducer(&self, transducer: &Transducer, shapes: &mut Vec<Shape>) {
        let Places { rect, bottom, body, zero, ref below } = *self.places;
        let height = (bottom - body.bottom() - 12.0).clamp(8.0, 24.0);
        let (name, part, coupled, (load, unit), words) = match *transducer {
            Transducer::None => return,
            Transducer::Electromagnetic { coupling_v_s_per_m, load_ohm, .. } => {
                let corner = pos2(zero + self.reach_at(WOUND), bottom - 1.0 - WOUND);
                let part = Rect::from_min_size(corner, vec2(WINDING, WOUND));
                self.coil(part, shapes);
                let words = format!(
                    "A coil at the frame, cut through. The magnet at the mass induces {} V in it at 1 m/s.",
                    short(coupling_v_s_per_m.abs())
                );
                ("coil", part, coupling_v_s_per_m, (load_ohm, "ohm"), words)
            }
            Transducer::Piezoelectric { coupling_n_per_v, load_kohm, .. } => {
                // patches lie where the flexures stand
                let aside = if below.is_some() { 0.0 } else { ASIDE };
                let corner = pos2(zero + aside - 0.5 * WINDING, bottom - 3.0 - height);
                let part = Rect::from_min_size(corner, vec2(WINDING, height));
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
        let right = rect.right() - if below.is_some() { SCALE_ROOM } else { 8.0 };
        self.load(part, load, unit, name, right, shapes);
    }

    /// Distance from x = 0 that the flexures below the mass reach at a height above the clamp, with the mass
    /// at an end of the picture. Their shape is a cubic, upright at both ends. Without flexures: [`FOOT`].
    fn reach_at(&self, height: f32) -> f32 {
        let Places { rect, bottom, body, ref below, .. } = *self.places;
        let share = (height / (bottom - body.bottom()).max(1.0)).min(1.0);
        let bent = share * share * (3.0 - 2.0 * share);
        FOOT + if below.is_some() { 0.5 * rect.width() * bent } else { 0.0 }
    }

    /// Draws a flat coil around x = 0 in section, of which `part` is the right half, and above it the magnet
    /// of the mass, if there is room and no other magnet hangs there.
    fn coil(&self, part: Rect, shapes: &mut Vec<Shape>) {
        let Places { bottom, body, zero, .. } = *self.places;
        let left = Rect::from_center_size(pos2(2.0 * zero - part.center().x, part.center().y), part.size());
        for half in [left, part] {
            shapes.push(Shape::rect_filled(half, 2.0, self.style.frame_colour()));
            let step = vec2(half.width() / TURNS as f32, 0.5 * half.height());
            for (i, j) in (0..TURNS).flat_map(|i| [(i, 0), (i, 1)]) {
                let at = half.min + step * vec2(i as f32 + 0.5, j as f32 + 0.5);
                shapes.push(Shape::circle_filled(at, 1.9, self.style.ink()));
            }
        }
        let pole = POLE.min(0.5 * (bottom - body.bottom() - WOUND) - 4.0);
        if pole >= MIN_POLE && !self.has_magnets {
            self.magnet(pos2(body.center().x, body.bottom() + pole), pole, true);
        }
    }

    /// Draws patches on the flexures, or without flexures a layer between two electrodes.
    fn patches(&self, part: Rect, shapes: &mut Vec<Shape>) {
        if let Some(below) = &self.places.below {
            let stroke = Stroke::new(PATCHES, self.style.frame_colour());
            shapes.extend(below.feet.iter().map(|foot| Shape::line(foot.clone(), stroke)));
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
                let words = "A short circuit: the load is 0 and takes no power.";
                ("short circuit".to_owned(), words.to_owned())
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
                let text = format!("load {} {unit}", short(value));
                let words = format!("The load, {} {unit}, which takes the power.", short(value));
                (text, words)
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
