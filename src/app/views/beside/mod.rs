//! Drawing of the parts beside the flexures: a spring, magnets, a transducer with its load.
//!
//! The spring lies between the frame on the left and the mass. The magnets face each other across their gap
//! when the mass is at x = 0, one below the mass and one on a post; the gap is drawn to the scale of the
//! flexures if there is room for that. A coil at the frame lies around the magnet that hangs
//! below the mass, in section. Piezoelectric patches lie on the feet of the flexures. The load
//! is on the right, where the flexures do not reach.

use std::cell::RefCell;

use eframe::egui::layers::ShapeIdx;
use eframe::egui::{Align2, Painter, Pos2, Rect, Sense, Shape, Stroke, StrokeKind, Ui, Vec2, pos2, vec2};

use crate::app::ui::style::Style;
use crate::app::words::numbers::three;
use crate::dynamics::Model;
use crate::mechanics::Element;
use crate::numeric::short;
use crate::scene::{Moments, Transducer};

mod transducer;

use super::flexures::Sketch;
use super::labels::Taken;

/// Smallest size in points of a drawing whose parts are labelled.
pub(super) const MIN_LABELLED: Vec2 = vec2(280.0, 140.0);

/// Number of half turns of the spring.
const HALF_TURNS: usize = 30;
/// Half the width of the spring in points.
const SPRING: f32 = 6.0;
/// Length in points of a straight end of the spring.
const END: f32 = 16.0;
/// Distance of the spring below the middle of the mass, in half heights of the mass.
const SPRING_AT: f32 = 0.5;

/// Half the width of a magnet in points.
const MAGNET: f32 = 7.5;
/// Height in points of a magnet's pole where there is room.
const POLE: f32 = 12.0;
/// Height in points of a pole from which on its letter fits.
const LETTERED: f32 = 10.5;
/// Smallest height of a pole in points.
const MIN_POLE: f32 = 4.5;

/// Width in points on the left reserved for the text on the flexures.
const WORDS_ROOM: f32 = 120.0;

/// The springs, magnets and transducer of a mechanism.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Attachments {
    /// Total stiffness of the springs in N/m; 0 without a spring.
    stiffness: f64,
    /// The pair of magnets that is the stiffest at x = 0.
    magnets: Option<Pair>,
    /// Number of pairs of magnets.
    pairs: usize,
    transducer: Transducer,
}

/// A pair of magnets.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    /// In N m^4.
    strength: f64,
    /// In m.
    gap: f64,
    moments: Moments,
}

impl Pair {
    /// Stiffness in N/m at x = 0; above 0 the magnets attract each other there.
    fn stiffness(self) -> f64 {
        let factor = match self.moments {
            Moments::Facing => 12.0,
            Moments::Transverse => -3.0,
        };
        factor * self.strength / self.gap.powi(5)
    }
}

/// Places of the parts on the screen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Places {
    /// The whole drawing.
    pub rect: Rect,
    /// Inner edge of the lower clamp.
    pub bottom: f32,
    pub body: Rect,
    /// Position of x = 0.
    pub zero: f32,
    /// Points per m along the flexures, if there are any.
    pub along: Option<f32>,
    /// The lines of the feet of the flexures below the mass, next to the clamp.
    pub feet: Vec<Vec<Pos2>>,
}

impl Attachments {
    pub fn of(model: &Model) -> Self {
        let mut parts = Self { stiffness: 0.0, magnets: None, pairs: 0, transducer: model.transducer() };
        for element in model.mechanism().parts_or_self().iter().filter_map(|part| part.element) {
            match element {
                Element::Spring { stiffness } => parts.stiffness += stiffness,
                Element::Magnets { strength, gap, moments } if strength != 0.0 => {
                    parts.pairs += 1;
                    let pair = Pair { strength, gap, moments };
                    if pair.stiffness().abs() > parts.magnets.map_or(0.0, |pair| pair.stiffness().abs()) {
                        parts.magnets = Some(pair);
                    }
                }
                Element::Magnets { .. } => {}
            }
        }
        parts
    }

    /// Whether a part stands on a clamp below the mass.
    pub fn stands_below(&self) -> bool {
        self.magnets.is_some() || self.transducer != Transducer::None
    }

    /// Whether there is a spring or magnets.
    pub fn is_drawn(&self) -> bool {
        self.stiffness != 0.0 || self.magnets.is_some()
    }

    /// Height of the arrow of the push above the middle of the mass, in half heights: clear of the spring.
    pub fn lift(&self) -> f32 {
        if self.stiffness == 0.0 { 0.0 } else { 0.4 }
    }

    /// Draws the parts, most of them in the shape reserved `behind` the flexures.
    pub fn draw(&self, ui: &Ui, sketch: &mut Sketch, behind: ShapeIdx, places: &Places) {
        let mut shapes = Vec::new();
        let named = places.rect.width() >= MIN_LABELLED.x && places.rect.height() >= MIN_LABELLED.y;
        let Sketch { painter, style, taken, .. } = sketch;
        let pen = Pen { ui, painter, style, parts: self, places, named, taken: RefCell::new(taken) };
        pen.spring(&mut shapes);
        if let Some(pair) = self.magnets {
            pen.magnets(pair, &mut shapes);
        }
        pen.transducer(&mut shapes);
        painter.set(behind, Shape::Vec(shapes));
    }
}

/// Context of the drawing of each part.
struct Pen<'a> {
    ui: &'a Ui,
    painter: &'a Painter,
    style: &'a Style,
    parts: &'a Attachments,
    places: &'a Places,
    /// Whether the parts are labelled.
    named: bool,
    /// The lines and rectangles of which labels keep clear.
    taken: RefCell<&'a mut Taken>,
}

impl Pen<'_> {
    fn thin(&self) -> Stroke {
        Stroke::new(1.3, self.style.ink())
    }

    /// Writes the first of these names and places that is free, and fits between these ends.
    fn name(&self, names: &[(&str, Pos2, Align2)], (left, right): (f32, f32)) {
        if self.named && left < right {
            let room = self.places.rect.with_min_x(left).with_max_x(right);
            let look = (self.style.small(), self.style.faint());
            self.taken.borrow_mut().write(self.painter, room, look, names.iter().copied());
        }
    }

    fn explain(&self, place: Rect, part: &str, words: &str) {
        let id = self.ui.scope_id().with(("beside", part));
        self.ui.interact(place.expand(2.0), id, Sense::hover()).on_hover_text(words);
    }

    fn spring(&self, shapes: &mut Vec<Shape>) {
        let stiffness = self.parts.stiffness;
        let Places { rect, body, .. } = *self.places;
        let y = body.center().y + SPRING_AT * 0.5 * body.height();
        let wall = Rect::from_min_max(pos2(rect.left() + 2.0, y - 14.0), pos2(rect.left() + 10.0, y + 14.0));
        let (from, to) = (pos2(wall.right(), y), pos2(body.left(), y));
        if stiffness == 0.0 || to.x - from.x < 2.0 {
            return;
        }
        shapes.push(Shape::rect_filled(wall, 0.0, self.style.frame_colour()));
        let edge = [wall.right_top(), wall.right_bottom()];
        shapes.push(Shape::line_segment(edge, Stroke::new(1.5, self.style.faint())));
        let line = coil((from, to), HALF_TURNS, SPRING, (END / (to.x - from.x)).min(0.25));
        shapes.push(Shape::line(line.clone(), self.style.flexure_stroke()));
        self.taken.borrow_mut().lines.push(line);
        let n_per_m = short(stiffness);
        let text = format!("spring {n_per_m} N/m");
        // below the stops, or above them
        let below = (text.as_str(), pos2(from.x + 6.0, body.bottom() + 7.0), Align2::LEFT_TOP);
        let above = (text.as_str(), pos2(from.x + 6.0, body.top() - 7.0), Align2::LEFT_BOTTOM);
        self.name(&[below, above], (rect.left(), rect.right()));
        let effect = if stiffness > 0.0 { "draws the mass there" } else { "pushes the mass away from there" };
        let words = format!(
            "A spring of {n_per_m} N/m between the frame and the mass. It has no force at x = 0 and \
             {effect}, harder the further out the mass is."
        );
        let place = Rect::from_two_pos(from - vec2(0.0, SPRING), to + vec2(0.0, SPRING));
        self.explain(place, "spring", &words);
    }

    fn magnets(&self, pair: Pair, shapes: &mut Vec<Shape>) {
        let Pair { strength, gap, moments } = pair;
        let Places { rect, bottom, body, zero, along, .. } = *self.places;
        let room = bottom - body.bottom();
        let pole = POLE.min((room - 6.0) / 4.0);
        if pole < MIN_POLE {
            return;
        }
        // distance between the middles of the two magnets
        let (closest, farthest) = (2.0 * pole + 3.0, (room - 2.0 * pole - 3.0).max(2.0 * pole + 3.0));
        let wanted = along.map_or(0.5 * (closest + farthest), |along| along * gap as f32);
        let distance = wanted.clamp(closest, farthest);
        let attract = pair.stiffness() > 0.0;
        let hung = pos2(body.center().x, body.bottom() + pole);
        let stood = pos2(zero, body.bottom() + pole + distance);
        let post = Rect::from_min_max(pos2(zero - 3.0, stood.y + pole), pos2(zero + 3.0, bottom));
        shapes.push(Shape::rect_filled(post, 0.0, self.style.frame_colour()));
        match moments {
            Moments::Facing => [(hung, true), (stood, attract)].map(|(at, up)| self.magnet(at, pole, up)),
            // one pole faces the viewer
            Moments::Transverse => {
                let size = vec2(2.0 * MAGNET, 2.0 * pole);
                [(hung, true), (stood, strength > 0.0)]
                    .map(|(at, north)| self.pole(Rect::from_center_size(at, size), north))
            }
        };
        let name = if attract { "magnets attract" } else { "magnets repel" };
        let right = (name, pos2(zero + MAGNET + 6.0, stood.y), Align2::LEFT_CENTER);
        let left = (name, pos2(zero - MAGNET - 6.0, stood.y), Align2::RIGHT_CENTER);
        // the side away from the flexures first, unless the load is there
        let is_right = body.center().x < zero && self.parts.transducer == Transducer::None;
        let sides = if is_right { [right, left] } else { [left, right] };
        self.name(&sides, (rect.left() + WORDS_ROOM, rect.right()));
        let effect = if attract { "draw the mass to x = 0" } else { "push the mass away from x = 0" };
        let [mm, twice_mm] = [gap, 2.0 * gap].map(|metres| three(1e3 * metres));
        let stiffest = "pairs of magnets this one is the stiffest there; the others are not drawn.";
        let more = match self.parts.pairs {
            1 => String::new(),
            pairs => format!(" Of {pairs} {stiffest}"),
        };
        let strength = three((1e12 * strength).abs());
        let words = match moments {
            Moments::Facing => format!(
                "Two magnets, {mm} mm apart where they face each other at x = 0, with a strength of \
                 {strength} N mm⁴. They {effect} up to {twice_mm} mm from it, and further out the other \
                 way.{more}"
            ),
            Moments::Transverse => format!(
                "Two magnets, {mm} mm apart at x = 0 and magnetised across the drawing, with a strength of \
                 {strength} N mm⁴. They {effect}.{more}"
            ),
        };
        self.explain(Rect::from_center_size(stood, vec2(2.0 * MAGNET, 2.0 * pole)), "magnets", &words);
    }

    fn magnet(&self, middle: Pos2, pole: f32, north_above: bool) {
        let half = |above: bool| {
            let y = if above { middle.y - pole } else { middle.y };
            Rect::from_min_size(pos2(middle.x - MAGNET, y), vec2(2.0 * MAGNET, pole))
        };
        self.pole(half(true), north_above);
        self.pole(half(false), !north_above);
    }

    fn pole(&self, place: Rect, north: bool) {
        let (ink, ground) = (self.style.ink(), self.style.ground());
        let (fill, letter) = if north { (ink, ground) } else { (ground, ink) };
        let edge = Stroke::new(1.2, ink);
        self.painter.rect(place, 0.0, fill, edge, StrokeKind::Inside);
        self.taken.borrow_mut().places.push(place);
        if place.height() >= LETTERED {
            let text = if north { "N" } else { "S" };
            self.painter.text(place.center(), Align2::CENTER_CENTER, text, self.style.small(), letter);
        }
    }
}

/// Points of a coil spring of half width `half`, whose straight ends each take the share `end` of it.
pub(super) fn coil((from, to): (Pos2, Pos2), half_turns: usize, half: f32, end: f32) -> Vec<Pos2> {
    let along = to - from;
    let across = along.normalized().rot90() * half;
    let turn = |i: usize| {
        let share = end + (1.0 - 2.0 * end) * (i as f32 + 0.5) / half_turns as f32;
        from + along * share + if i.is_multiple_of(2) { across } else { -across }
    };
    let turns = (0..half_turns).map(turn);
    [from, from + along * end].into_iter().chain(turns).chain([from + along * (1.0 - end), to]).collect()
}
