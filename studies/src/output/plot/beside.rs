//! Geometry of what stands beside the flexures of a drawn mechanism: a spring, magnets, a transducer with its
//! load.
//!
//! The spring lies between the frame on the left and the mass. The magnets face each other across their gap
//! when the mass is at x = 0, one below the mass and one on a post; the gap is drawn to the scale of the
//! flexures if there is room for that. A coil at the frame lies around the magnet that hangs below the
//! mass, in section. Piezoelectric patches lie on the feet of the flexures. The load is on the right, where
//! the flexures do not reach.

use super::assembly::MagnetPair;
use super::figure::{Align, Area, Point, Text, distance};
use super::role::Role;
use super::sketch::{DrawnPart, Edge, Pen, towards};
use super::style;
use crate::numeric::short;
use crate::scene::{Moments, Transducer};

/// Half turns and half width of a spring beside the flexures, and the length of its straight ends.
const SPRING: (usize, f64, f64) = (30, 13.0, 35.0);
/// Distance of the spring below the middle of the mass, in half heights of the mass.
const SPRING_AT: f64 = 0.5;

/// Half the width of a magnet.
const HALF_MAGNET: f64 = 16.0;
/// Height of a magnet's pole where there is room, and the smallest.
const POLE: (f64, f64) = (26.0, 10.0);

/// Half the length of a coil, and as a share of the width, which leaves room for the load.
const WINDING: (f64, f64) = (156.0, 0.1);
/// Thickness of the wires on each side of a coil, and their number in a row.
const WOUND: (f64, usize) = (15.0, 18);
/// Distance of a coil from the mass, clear of the feet of the stops.
const CLEAR: f64 = 13.0;
/// Width of a piezoelectric layer, and its distance from x = 0 if there are no flexures.
const LAYER: (f64, f64) = (61.0, 82.0);
/// Thickness of a flexure with patches on both of its faces.
const PATCHES: f64 = 15.0;

/// Heights of the two wires of a load above the clamp, and of its top.
const WIRES: [f64; 2] = [28.0, 9.0];
const LOAD_TOP: f64 = 41.0;
/// Width of a load, and half its height.
const LOAD: (f64, f64) = (74.0, 11.0);
/// Width of a wire: not that of a grid, so that labels keep clear of it.
const WIRE: f64 = 2.2;
/// Distance to keep from the foot of a flexure.
const FOOT: f64 = 24.0;
/// Width on the right that the scale bar and its length have.
const SCALE_ROOM: f64 = 145.0;

/// A magnet: its poles, of which the north poles are marked, and the stem by which it hangs.
pub(super) struct Magnet {
    pub poles: Vec<(Area, bool)>,
    pub stem: Option<Area>,
}

/// A label at each of the places where it may stand.
type Label = Vec<Text>;

/// The middle of the magnet that hangs below the mass, and the height of its poles.
type Hung = (Point, f64);

impl Pen<'_> {
    /// Draws what lies behind the flexures. Returns the labels.
    pub fn beside(&mut self) -> Vec<Label> {
        let mut labels: Vec<Label> = self.spring_beside().into_iter().collect();
        labels.extend(self.magnets_label());
        labels.extend(self.transducer());
        labels
    }

    fn spring_beside(&mut self) -> Option<Label> {
        let (stiffness, area, mass) = (self.of.stiffness, self.area(), self.mass);
        let y = 0.5 * (mass.top + mass.bottom) + SPRING_AT * 0.5 * (mass.bottom - mass.top);
        let wall = Area::new(area.left + 4.0, y - 30.0, area.left + 22.0, y + 30.0);
        let (from, to) = ((wall.right, y), (mass.left, y));
        if stiffness == 0.0 || to.0 - from.0 < 4.0 {
            return None;
        }
        let look = self.theme.look(Role::Frame);
        self.figure.filled(wall, look.ink, look.hatch);
        let edge = [(wall.right, wall.top), (wall.right, wall.bottom)];
        self.figure.line(&edge, style::LINE, self.theme.soft, area);
        let (turns, half, end) = SPRING;
        let line = spring((from, to), (turns, half, (end / (to.0 - from.0)).min(0.25)));
        self.figure.line(&line, self.theme.look(Role::Motion).width, self.theme.ink, area);
        self.parts.push((DrawnPart::Spring, Area::new(from.0, y - half, to.0, y + half)));
        let words = format!("spring {} N/m", short(stiffness));
        // below the stops, or above them
        let places = [(mass.bottom + 15.0, Edge::Top), (mass.top - 15.0, Edge::Bottom)];
        let texts = places.map(|(y, edge)| self.text(&words, (from.0 + 13.0, y), Align::Left, edge));
        Some(texts.into())
    }

    /// Height of the poles of a pair of magnets, and the places of the middles of the two; `None` if there is
    /// no room.
    fn pair(&self, pair: MagnetPair) -> Option<(f64, [Point; 2])> {
        let (room, mass) = (self.bottom - self.mass.bottom, self.mass);
        let pole = POLE.0.min((room - 13.0) / 4.0);
        // distance between the middles of the two magnets
        let (closest, farthest) = (2.0 * pole + 6.0, (room - 2.0 * pole - 6.0).max(2.0 * pole + 6.0));
        let wanted = self.along.map_or(0.5 * (closest + farthest), |along| along * pair.gap);
        let hung = mass.bottom + pole;
        let stood = (self.zero, hung + wanted.clamp(closest, farthest));
        (pole >= POLE.1).then_some((pole, [(0.5 * (mass.left + mass.right), hung), stood]))
    }

    /// The post of a pair of magnets, and the label beside it.
    fn magnets_label(&mut self) -> Option<Label> {
        let pair = self.of.magnets?;
        let (pole, [_, stood]) = self.pair(pair)?;
        let look = self.theme.look(Role::Frame);
        let post = Area::new(stood.0 - 7.0, stood.1 + pole, stood.0 + 7.0, self.bottom);
        self.figure.filled(post, look.ink, look.hatch);
        let place = Area::new(stood.0 - HALF_MAGNET, stood.1 - pole, stood.0 + HALF_MAGNET, stood.1 + pole);
        self.parts.push((DrawnPart::Magnets, place));
        let words = if pair.stiffness() > 0.0 { "magnets attract" } else { "magnets repel" };
        let beside = |side: f64| {
            let x = stood.0 + side * (HALF_MAGNET + 13.0);
            [(stood.1, Edge::Middle), (stood.1 - pole, Edge::Bottom)]
                .map(|(y, edge)| self.text(words, (x, y), towards(side), edge))
        };
        // the side away from the flexures first, unless the load is there
        let is_right = self.mass.right < self.zero && self.of.transducer == Transducer::None;
        let sides = if is_right { [1.0, -1.0] } else { [-1.0, 1.0] };
        Some(sides.into_iter().flat_map(beside).collect())
    }

    /// The magnets: a pair, or the one that hangs in a coil.
    pub fn magnets(&self) -> Vec<Magnet> {
        let upright = |(x, y): Point, pole: f64, north_above: bool| {
            let half =
                |top: f64, is_north| (Area::new(x - HALF_MAGNET, top, x + HALF_MAGNET, top + pole), is_north);
            vec![half(y - pole, north_above), half(y, !north_above)]
        };
        let Some(pair) = self.of.magnets else {
            let hung = self.coil().and_then(|coil| coil.1).map(|(at, pole)| Magnet {
                poles: upright(at, pole, true),
                stem: Some(Area::new(at.0 - 3.0, self.mass.bottom, at.0 + 3.0, at.1 - pole)),
            });
            return hung.into_iter().collect();
        };
        let Some((pole, places)) = self.pair(pair) else { return Vec::new() };
        let second = match pair.moments {
            Moments::Facing => pair.stiffness() > 0.0,
            Moments::Transverse => pair.strength > 0.0,
        };
        let poles = places.into_iter().zip([true, second]).map(|(at @ (x, y), north)| match pair.moments {
            Moments::Facing => upright(at, pole, north),
            // one pole faces the viewer
            Moments::Transverse => {
                vec![(Area::new(x - HALF_MAGNET, y - pole, x + HALF_MAGNET, y + pole), north)]
            }
        });
        poles.map(|poles| Magnet { poles, stem: None }).collect()
    }

    fn transducer(&mut self) -> Option<Label> {
        let (name, part, load, unit) = match self.of.transducer {
            Transducer::None => return None,
            Transducer::Electromagnetic { load_ohm, .. } => ("coil", self.wind()?, load_ohm, "ohm"),
            Transducer::Piezoelectric { load_kohm, .. } => ("piezo", self.patches(), load_kohm, "kohm"),
        };
        self.parts.push((DrawnPart::Transducer, part));
        let words = match load {
            0.0 => "short circuit".to_owned(),
            f64::INFINITY => "open circuit".to_owned(),
            load => format!("load {} {unit}", short(load)),
        };
        let places = self.load(part, load);
        // without room for the load, the label is beside the transducer
        let y = part.bottom - 4.0;
        let mirrored = 2.0 * self.zero - part.right;
        let beside = [(part.right + 13.0, 1.0), (mirrored - 13.0, -1.0)];
        let beside = beside.map(|(x, side)| ((x, y), towards(side), Edge::Bottom));
        let whole = format!("{name}, {words}");
        let texts = [whole, words].into_iter().flat_map(|words| {
            let places = places.iter().copied().chain(beside);
            places.map(|(at, align, edge)| self.text(&words, at, align, edge)).collect::<Vec<_>>()
        });
        Some(texts.collect())
    }

    /// The two rows of a coil around x = 0 in section, and in it the middle and the height of the poles of
    /// the magnet of the mass, if there is room and no other magnet hangs there: then the coil lies on the
    /// clamp.
    fn coil(&self) -> Option<([Area; 2], Option<Hung>)> {
        let Transducer::Electromagnetic { .. } = self.of.transducer else { return None };
        let (area, mass) = (self.area(), self.mass);
        let half = WINDING.0.min(WINDING.1 * (area.right - area.left));
        let row = |top: f64| Area::new(self.zero - half, top, self.zero + half, top + WOUND.0);
        let pole = POLE.0.min(0.5 * (self.bottom - mass.bottom - CLEAR - 2.0 * WOUND.0) - 5.0);
        if pole < POLE.1 || self.of.magnets.is_some() {
            let rows = [self.bottom - 2.0 * WOUND.0 - 2.0, self.bottom - WOUND.0 - 2.0];
            return Some((rows.map(row), None));
        }
        let top = mass.bottom + CLEAR;
        let middle = (0.5 * (mass.left + mass.right), top + WOUND.0 + pole + 3.0);
        Some(([top, top + WOUND.0 + 2.0 * pole + 6.0].map(row), Some((middle, pole))))
    }

    /// Draws the coil. Returns the right end of its lower row.
    fn wind(&mut self) -> Option<Area> {
        let (rows, _) = self.coil()?;
        let look = self.theme.look(Role::Frame);
        for row in rows {
            self.figure.rect(row, look.ink);
            let step = (row.right - row.left) / WOUND.1 as f64;
            for i in 0..WOUND.1 {
                let at = (row.left + step * (i as f64 + 0.5), 0.5 * (row.top + row.bottom));
                self.figure.disc(at, 4.1, self.theme.ink);
            }
            self.kept.push(row);
        }
        Some(Area { left: rows[1].right - WOUND.0, ..rows[1] })
    }

    /// Draws patches on the feet of the flexures, or without flexures a layer between two electrodes. Returns
    /// the place from which the wires go.
    fn patches(&mut self) -> Area {
        let (area, ink) = (self.area(), self.theme.look(Role::Transducer).ink);
        let high = (self.bottom - self.mass.bottom - 26.0).clamp(17.0, 52.0);
        // patches lie where the flexures stand
        let middle = self.zero + if self.along.is_some() { 0.0 } else { LAYER.1 };
        let (left, right) = (middle - 0.5 * LAYER.0, middle + 0.5 * LAYER.0);
        let part = Area::new(left, self.bottom - 6.0 - high, right, self.bottom - 6.0);
        for foot in std::mem::take(&mut self.feet) {
            self.figure.line(&foot, PATCHES, ink, area);
        }
        if self.along.is_none() {
            let layer = Area { top: part.bottom - 17.0, ..part };
            self.figure.rect(layer, ink);
            for y in [layer.top, layer.bottom] {
                self.figure.line(&[(left, y), (right, y)], style::LINE, self.theme.ink, area);
            }
        }
        part
    }

    /// Distance from x = 0 that the flexures below the mass reach at a height above the clamp, with the mass
    /// at an end of the picture. Their shape is a cubic, upright at both ends. Without flexures: [`FOOT`].
    fn reach_at(&self, height: f64) -> f64 {
        let area = self.area();
        let share = (height / (self.bottom - self.mass.bottom).max(2.0)).min(1.0);
        let bent = share * share * (3.0 - 2.0 * share);
        FOOT + if self.along.is_some() { 0.5 * (area.right - area.left) * bent } else { 0.0 }
    }

    /// Draws the load and its two wires: a resistor, a wire for a short circuit, a gap for an open circuit.
    /// Returns the places of its label; none where it has no room.
    fn load(&mut self, part: Area, value: f64) -> Vec<(Point, Align, Edge)> {
        let area = self.area();
        let right = area.right - if self.along.is_some() { SCALE_ROOM } else { 17.0 };
        let y = WIRES.map(|height| self.bottom - height);
        let begin = (part.right + 22.0).max(self.zero + self.reach_at(LOAD_TOP));
        let (load_end, end) = (begin + LOAD.0, begin + LOAD.0 + 20.0);
        if end > right {
            return Vec::new();
        }
        let ink = self.theme.ink;
        let lead = part.right - 6.0;
        let upper = vec![(lead, part.top), (lead, y[0]), (begin, y[0])];
        let foot = (lead, part.bottom.min(y[1]));
        let lower = vec![foot, (lead, y[1]), (end, y[1]), (end, y[0]), (load_end, y[0])];
        let mut wires = vec![upper, lower];
        let resistor = Area::new(begin, y[0] - LOAD.1, load_end, y[0] + LOAD.1);
        match value {
            0.0 => wires.push(vec![(begin, y[0]), (load_end, y[0])]),
            f64::INFINITY => {
                self.figure.disc((begin, y[0]), 5.5, ink);
                self.figure.disc((load_end, y[0]), 5.5, ink);
            }
            _ => self.figure.outline(resistor, WIRE, ink),
        }
        wires.iter().for_each(|wire| self.figure.line(wire, WIRE, ink, area));
        self.kept.push(resistor);
        self.parts.push((DrawnPart::Load, resistor));
        let middle = 0.5 * (resistor.left + resistor.right);
        vec![
            ((end + 13.0, y[1] - 4.0), Align::Left, Edge::Bottom),
            ((middle, resistor.top - 9.0), Align::Centre, Edge::Bottom),
            ((begin, resistor.top - 9.0), Align::Left, Edge::Bottom),
        ]
    }
}

/// Points of a coil spring with so many half turns, this half width, and straight ends that each take this
/// share of it.
pub(super) fn spring((from, to): (Point, Point), (turns, half, end): (usize, f64, f64)) -> Vec<Point> {
    let long = distance(from, to).max(1e-9);
    let along = ((to.0 - from.0) / long, (to.1 - from.1) / long);
    let at = |share: f64, aside: f64| {
        let length = share * long;
        (from.0 + length * along.0 - aside * along.1, from.1 + length * along.1 + aside * along.0)
    };
    let turn = |i: usize| {
        let share = end + (1.0 - 2.0 * end) * (i as f64 + 0.5) / turns as f64;
        at(share, if i.is_multiple_of(2) { half } else { -half })
    };
    let turns = (0..turns).map(turn);
    [from, at(end, 0.0)].into_iter().chain(turns).chain([at(1.0 - end, 0.0), to]).collect()
}
