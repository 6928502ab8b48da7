//! Geometry of a drawn mechanism: frame, flexures or a spring, mass, stops, the arrow of the push, and the
//! places of the labels.
//!
//! Displacements have the scale of the horizontal axis; across it, the flexures have a scale of their own,
//! and mass, stops and the other parts are not to scale. The face of a stop stands half the width of the
//! mass beyond the travel limit, so that the mass touches it there.

use super::assembly::Assembly;
use super::beside::spring;
use super::figure::{Align, Area, Figure, Point, Shape, Text};
use super::font;
use super::frame::Frame;
use super::labels::first_free;
use super::role::Role;
use super::style::{self, Theme};

/// Thickness of a clamp, and its distance from the edges of the drawing.
const CLAMP: (f64, f64) = (17.0, 13.0);
/// Half the width of the mass.
pub(super) const HALF_MASS: f64 = 29.0;
/// Half the height of the mass as a share of the distance of the clamps, and its limits.
const HALF_HEIGHT: (f64, f64, f64) = (0.19, 45.0, 97.0);
/// Width of a stop, and its height above and below the mass.
pub(super) const STOP: (f64, f64) = (22.0, 9.0);

/// Share of the width of the mass that the flexures of a group take.
const ASIDE: f64 = 0.9;
/// Half turns, half width and the share of a straight end of a spring in place of flexures.
const SPRING: (usize, f64, f64) = (12, 19.0, 0.15);

/// Distance of a letter from the edges of a pole together, and its smallest size.
const LETTER: (f64, f64) = (4.0, 18.0);

/// Smallest width and height of a drawing whose parts are labelled.
const LABELLED: (f64, f64) = (420.0, 180.0);

/// A part that a reader may ask about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawnPart {
    /// A spring beside the flexures.
    Spring,
    /// Magnets.
    Magnets,
    /// A coil or a piezoelectric layer.
    Transducer,
    /// The load of the transducer.
    Load,
}

/// A laid out drawing: its shapes and the places of its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Sketch {
    /// What lies behind the mass.
    pub behind: Vec<Shape>,
    /// The mass.
    pub mass: Area,
    /// The stops to the left and to the right.
    pub stops: [Option<Area>; 2],
    /// Upper and lower end of a stop.
    pub stop_ends: (f64, f64),
    /// What lies before the mass: the arrow and the labels.
    pub before: Vec<Shape>,
    /// The places of the parts.
    pub parts: Vec<(DrawnPart, Area)>,
}

/// Inner edges of the clamps, and half the height of the mass.
pub(super) fn heights(area: Area) -> (f64, f64, f64) {
    let (top, bottom) = (area.top + CLAMP.0, area.bottom - CLAMP.0);
    let (share, least, most) = HALF_HEIGHT;
    (top, bottom, (share * (bottom - top)).clamp(least, most))
}

/// The drawing while it is made.
pub(super) struct Pen<'a> {
    pub of: &'a Assembly,
    frame: &'a Frame,
    pub theme: &'a Theme,
    pub figure: Figure,
    /// What labels keep clear of besides lines and letters.
    pub kept: Vec<Area>,
    pub parts: Vec<(DrawnPart, Area)>,
    /// The lines of the feet of the flexures below the mass, next to the clamp.
    pub feet: Vec<Vec<Point>>,
    /// Inner edge of the upper clamp.
    pub top: f64,
    /// Inner edge of the lower clamp.
    pub bottom: f64,
    /// Place of x = 0.
    pub zero: f64,
    /// Lengths to a m along the flexures, if there are any.
    pub along: Option<f64>,
    pub mass: Area,
    pub stops: [Option<Area>; 2],
    pub outlined: [Option<Area>; 2],
}

/// Which side of a label is at its place: its upper one, its middle or its lower one.
#[derive(Debug, Clone, Copy)]
pub(super) enum Edge {
    Top,
    Middle,
    Bottom,
}

impl<'a> Pen<'a> {
    /// The pen of an assembly, with the places of the mass and of the stops.
    pub fn new(of: &'a Assembly, frame: &'a Frame, theme: &'a Theme) -> Self {
        let (top, bottom, half) = heights(frame.area);
        let (along, zero) = (of.along(frame.area), frame.across(0.0));
        let end = of.flexures.as_ref().and_then(|flexures| flexures.groups.first()?.0.last());
        let y = match end.zip(along) {
            Some(((_, end), along)) => bottom - end * along - half,
            None => 0.5 * (top + bottom),
        };
        let x = frame.across(1e3 * of.x);
        let mass = Area::new(x - HALF_MASS, y - half, x + HALF_MASS, y + half);
        let stop = |at: Option<f64>, side: f64| {
            let face = frame.across(1e3 * at?) + side * HALF_MASS;
            let back = face + side * STOP.0;
            Some(Area::new(face.min(back), mass.top - STOP.1, face.max(back), mass.bottom + STOP.1))
        };
        let both = |[left, right]: [Option<f64>; 2]| [stop(left, -1.0), stop(right, 1.0)];
        let (stops, outlined) = (both(of.stops), both([of.outlined.map(|limit| -limit), of.outlined]));
        let mut figure = Figure::new(theme, (frame.area.right, frame.area.bottom), (0.0, frame.area.bottom));
        figure.shapes.clear();
        let (kept, parts, feet) = Default::default();
        Self { of, frame, theme, figure, kept, parts, feet, top, bottom, zero, along, mass, stops, outlined }
    }

    /// Draws all of it, with these words at the mass and at the flexures.
    pub fn draw(mut self, mass: &str, flexures: Option<&str>) -> Sketch {
        let area = self.area();
        let lines = self.flexure_lines();
        let has_flexures = self.of.flexures.is_some();
        if has_flexures || self.of.spring.is_some() {
            self.clamp(area.top, true);
        }
        if has_flexures || self.of.stands_below() {
            self.clamp(self.bottom, false);
        }
        self.kept.push(self.mass);
        self.kept.extend(self.stops.into_iter().chain(self.outlined).flatten());
        let arrow = self.arrow_place(&lines);
        self.kept.extend(arrow);
        let labels = self.beside();
        let width = self.theme.look(Role::Motion).width;
        for line in lines {
            self.figure.line(&line, width, self.theme.ink, area);
        }
        if !has_flexures {
            self.rail_and_spring(width);
        }
        self.magnets_and_stem();
        let behind = self.figure.shapes.len();
        if let Some(place) = arrow {
            self.arrow(place);
        }
        self.scale_bar();
        if let Some(words) = flexures {
            let place = (area.left + 26.0, self.bottom - 11.0);
            let text = self.text(words, place, Align::Left, Edge::Bottom);
            self.write([Text { ink: self.theme.ink, ..text }]);
        }
        if area.right - area.left >= LABELLED.0 && area.bottom - area.top >= LABELLED.1 {
            for texts in labels.into_iter().chain(self.names(mass)) {
                self.write(texts);
            }
        }
        let before = self.figure.shapes.split_off(behind);
        let (behind, mass) = (self.figure.shapes, self.mass);
        let stop_ends = (mass.top - STOP.1, mass.bottom + STOP.1);
        Sketch { behind, mass, stops: self.stops, stop_ends, before, parts: self.parts }
    }

    /// The area of the drawing.
    pub fn area(&self) -> Area {
        self.frame.area
    }

    /// The lines of the flexures; those of the feet of the lower ones are kept.
    fn flexure_lines(&mut self) -> Vec<Vec<Point>> {
        let Some((flexures, along)) = self.of.flexures.as_ref().zip(self.along) else { return Vec::new() };
        let mut lines = Vec::new();
        for (i, (points, count)) in flexures.groups.iter().enumerate() {
            let place = |(across, at): &Point| {
                let y =
                    if i == 0 { self.bottom - at * along } else { self.top + (flexures.clamps - at) * along };
                (self.frame.across(1e3 * across), y)
            };
            let points: Vec<Point> = points.iter().map(place).collect();
            for k in 0..*count {
                let share = if *count == 1 { 0.0 } else { 2.0 * k as f64 / (count - 1) as f64 - 1.0 };
                let aside = ASIDE * share * HALF_MASS;
                lines.push(points.iter().map(|(x, y)| (x + aside, *y)).collect::<Vec<Point>>());
                if i == 0 {
                    self.feet.extend(lines.last().map(|line| line[..line.len().div_ceil(5)].to_vec()));
                }
            }
        }
        lines
    }

    /// A clamp with its upper edge at `top`: hatched, with a line towards the flexures.
    fn clamp(&mut self, top: f64, is_above: bool) {
        let Area { left, right, .. } = self.area();
        let bar = Area::new(left + CLAMP.1, top, right - CLAMP.1, top + CLAMP.0);
        let look = self.theme.look(Role::Frame);
        self.figure.filled(bar, look.ink, look.hatch);
        let edge = if is_above { bar.bottom } else { bar.top };
        let canvas = self.figure.canvas;
        self.figure.line(&[(bar.left, edge), (bar.right, edge)], style::LINE, self.theme.soft, canvas);
        self.kept.push(bar);
    }

    /// The rail on which a mass without flexures slides, and the spring from above to it.
    fn rail_and_spring(&mut self, width: f64) {
        let (area, rail) = (self.area(), self.mass.bottom + 7.0);
        let ends = [(area.left + CLAMP.1, rail), (area.right - CLAMP.1, rail)];
        self.figure.line(&ends, style::LINE, self.theme.soft, area);
        if let Some(foot) = self.of.spring {
            let foot = (self.frame.across(1e3 * foot), self.top);
            let to = (0.5 * (self.mass.left + self.mass.right), self.mass.top);
            self.figure.line(&spring((foot, to), SPRING), width, self.theme.ink, area);
        }
    }

    /// A bar of 10 mm along the flexures, with its length.
    fn scale_bar(&mut self) {
        let Some(length) = self.along.map(|along| 0.01 * along) else { return };
        if !(13.0..870.0).contains(&length) {
            return;
        }
        let (x, foot) = (self.area().right - 39.0, self.bottom - 17.0);
        let (ink, canvas) = (self.theme.soft, self.figure.canvas);
        self.figure.line(&[(x, foot), (x, foot - length)], style::THIN, ink, canvas);
        for y in [foot, foot - length] {
            self.figure.line(&[(x - 9.0, y), (x + 9.0, y)], style::THIN, ink, canvas);
        }
        self.figure.text(self.text(
            "10\u{a0}mm",
            (x - 17.0, foot - 0.5 * length),
            Align::Right,
            Edge::Middle,
        ));
    }

    /// The names of the kinds of parts, each with the places where it may stand: the flexure or the spring at
    /// its clamp, the mass at a corner, a stop at its foot.
    fn names(&self, mass: &str) -> Vec<Vec<Text>> {
        let mut all = Vec::new();
        let foot = match (&self.of.flexures, self.of.spring) {
            (Some(_), _) => Some(("flexure", self.zero)),
            (None, Some(x)) => Some(("spring", self.frame.across(1e3 * x))),
            (None, None) => None,
        };
        if let Some((name, x)) = foot {
            let aside = [35.0, 56.0, 87.0].into_iter().flat_map(|aside| [aside, -aside]);
            let y = self.top + 11.0;
            all.push(aside.map(|aside| self.text(name, (x + aside, y), towards(aside), Edge::Top)).collect());
        }
        let stop = self.stops.into_iter().flatten().next();
        let above = stop.map_or(self.mass.top, |stop| stop.top) - 9.0;
        let below = stop.map_or(self.mass.bottom, |stop| stop.bottom) + 9.0;
        let sides = [(self.mass.right + 4.0, 1.0), (self.mass.left - 4.0, -1.0)];
        let corners = [(above, Edge::Bottom), (below, Edge::Top)]
            .into_iter()
            .flat_map(|(y, edge)| sides.map(|(x, side)| self.text(mass, (x, y), towards(side), edge)));
        let y = 0.5 * (self.mass.top + self.mass.bottom);
        let beside = sides.map(|(x, side)| self.text(mass, (x + 9.0 * side, y), towards(side), Edge::Middle));
        all.push(corners.chain(beside).collect());
        let of_stop = self.stops.into_iter().flatten().flat_map(|stop| {
            let right = (stop.right + 11.0, 1.0);
            let left = (stop.left - 11.0, -1.0);
            let is_left = stop.right < self.zero;
            let sides = if is_left { [left, right] } else { [right, left] };
            sides.map(|(x, side)| self.text("stop", (x, stop.bottom - 13.0), towards(side), Edge::Bottom))
        });
        all.push(of_stop.collect());
        all
    }

    /// A label of the drawing, with a side of it at a place.
    pub fn text(&self, words: &str, (x, y): Point, align: Align, edge: Edge) -> Text {
        let high = style::TICK * font::CAPITAL;
        let down = match edge {
            Edge::Top => high,
            Edge::Middle => 0.5 * high,
            Edge::Bottom => 0.0,
        };
        Text::new(words, (x, y + down), style::TICK, self.theme.soft).aligned(align)
    }

    /// Writes the first of these texts that is free. Returns where.
    fn write(&mut self, texts: impl IntoIterator<Item = Text>) -> Option<Area> {
        let (text, place) = first_free(&self.figure, self.area(), &self.kept, texts)?;
        self.figure.text(text);
        Some(place)
    }

    /// The magnets, and the stem of one that hangs in a coil, before the flexures, so that their letters can
    /// be read.
    fn magnets_and_stem(&mut self) {
        for magnet in self.magnets() {
            if let Some(stem) = magnet.stem {
                self.figure.rect(stem, self.theme.ink);
            }
            for (pole, is_north) in magnet.poles {
                let (fill, ink) = match is_north {
                    true => (self.theme.ink, self.theme.paper),
                    false => (self.theme.paper, self.theme.ink),
                };
                self.figure.rect(pole, fill);
                self.figure.outline(pole, style::FRAME, self.theme.ink);
                self.kept.push(pole);
                let size = ((pole.bottom - pole.top - LETTER.0) / font::CAPITAL).min(style::TICK);
                if size >= LETTER.1 {
                    let y = 0.5 * (pole.top + pole.bottom + size * font::CAPITAL);
                    let letter = if is_north { "N" } else { "S" };
                    let text = Text::new(letter, (0.5 * (pole.left + pole.right), y), size, ink);
                    self.figure.text(text.aligned(Align::Centre));
                }
            }
        }
    }
}

/// The alignment of a text on this side of its place.
pub(super) fn towards(side: f64) -> Align {
    if side > 0.0 { Align::Left } else { Align::Right }
}

#[cfg(test)]
mod tests {
    use super::super::axis::PlotAxis;
    use super::*;
    use crate::questions::Simulation;

    /// Drawings of scenes over their travel, at sizes from that of a column on paper to that of a projector,
    /// with pushes to both sides.
    fn sketches(presets: &[&str], check: impl Fn(&str, &Sketch)) {
        for preset in presets {
            let simulation = Simulation::preset(preset).unwrap();
            let model = simulation.model();
            let well = model.mechanism().landscape.right_stable().unwrap().x;
            let reach = <[_; 2]>::from(model.stop_positions())[1].unwrap_or(well);
            for i in 0..=8 {
                let x = reach * (0.25 * f64::from(i) - 1.0);
                let bent = model.mechanism().flexures.as_ref().map(|flexures| flexures.state(x).unwrap());
                let end = 1.3 * well;
                let of = Assembly::of(model, x, bent.as_ref(), (-end, end));
                for (width, height) in [(640.0, 330.0), (1250.0, 400.0), (1800.0, 700.0), (2400.0, 500.0)] {
                    let axis = |end: f64| PlotAxis::given(-end, end, Vec::new(), "");
                    let area = Area::new(0.0, 40.0, width, 40.0 + height);
                    let frame = Frame { area, x: axis(1e3 * end), y: axis(1.0) };
                    for push in [-1.0, -0.3, 0.3, 1.0] {
                        let of = Assembly { push, ..of.clone() };
                        let about = format!("{preset} at {x} with {push} in {width} x {height}");
                        check(
                            &about,
                            &of.sketch(&frame, &Theme::LIGHT, "mass: drag me", of.bulge().as_deref()),
                        );
                    }
                }
            }
        }
    }

    fn lines(shapes: &[Shape]) -> impl Iterator<Item = (&Vec<Point>, f64, style::Ink)> {
        shapes.iter().filter_map(|shape| match shape {
            Shape::Line(points, width, ink) => Some((points, *width, *ink)),
            _ => None,
        })
    }

    fn is_crossed(place: Area, points: &[Point]) -> bool {
        points.windows(2).any(|pair| place.clip(pair[0], pair[1]).is_some())
    }

    #[test]
    fn the_arrow_of_the_push_crosses_nothing() {
        sketches(&["paper", "harvester", "magnet", "balanced", "paper-unconstrained"], |about, sketch| {
            let head = sketch.before.iter().find_map(|shape| match shape {
                Shape::Polygon(corners, _) => Some(corners),
                _ => None,
            });
            let head = head.unwrap_or_else(|| panic!("{about} has no arrow"));
            let look = Theme::LIGHT.look(Role::Push);
            let shaft =
                lines(&sketch.before).find(|line| line.1 == look.width).map_or(&head[..], |line| line.0);
            let along = head.iter().chain(shaft).map(|corner| corner.0);
            let up = head.iter().map(|corner| corner.1);
            let (left, right) = crate::numeric::extent(along);
            let (top, bottom) = crate::numeric::extent(up);
            let place = Area::new(left, top, right, bottom);
            for (points, ..) in lines(&sketch.behind).filter(|line| !style::is_fine(line.1)) {
                assert!(!is_crossed(place, points), "{about}: {place:?} {points:?}");
            }
            for part in sketch.stops.into_iter().flatten().chain([sketch.mass]) {
                assert!(part.common(place).is_none(), "{about}: {part:?} {place:?}");
            }
        });
    }

    #[test]
    fn labels_keep_clear_of_lines_and_letters_stand_before_the_flexures() {
        sketches(&["paper", "harvester", "magnet", "balanced"], |about, sketch| {
            let mut count = 0;
            for shape in &sketch.before {
                let Shape::Text(text) = shape else { continue };
                let left = text.at.0 - text.before();
                let right = left + font::width(&text.words, text.size, false);
                let place = Area::new(left, text.at.1 - text.size * font::CAPITAL, right, text.at.1);
                let all = || lines(&sketch.behind).chain(lines(&sketch.before));
                for (points, width, _) in all().filter(|line| !style::is_fine(line.1)) {
                    assert!(!is_crossed(place, points), "{about}: {} {width} {points:?}", text.words);
                }
                count += 1;
            }
            assert!(count > 2, "{about}: {count}");
            let letter = |shape: &Shape| matches!(shape, Shape::Text(text) if text.words.len() == 1);
            let first = sketch.behind.iter().position(letter).unwrap_or(sketch.behind.len());
            let width = Theme::LIGHT.look(Role::Motion).width;
            assert!(lines(&sketch.behind[first..]).all(|line| line.1 != width), "{about}");
        });
    }
}
