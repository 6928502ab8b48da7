//! Picture of the mechanism between its stops, seen from the base: frame, flexures or a spring in their
//! place, mass, and what stands beside them.

use std::sync::atomic::AtomicBool;

use super::axis::PlotAxis;
use super::chart::{Chart, Marks, Panel, Side};
use super::figure::Point;
use super::names::DISPLACEMENT;
use super::role::Role;
use super::shapes::drawn;
use crate::dynamics::Model;
use crate::mechanics::flexure::{Geometry, State};
use crate::mechanics::{Element, Mechanism};
use crate::numeric::{extent, short};
use crate::scene::Transducer;
use crate::study::{StatesError, Task, states};

/// Half the width of the mass, and the width of a stop, as shares of the axis.
const MASS: f64 = 0.045;
const STOP: f64 = 0.03;
/// Half the height of the mass and of a stop as shares of the distance of the clamps, and the height of a
/// clamp.
const HEIGHTS: (f64, f64, f64) = (0.08, 0.13, 0.035);
/// Room beyond wells, stops and mass, as a share of their range.
const ROOM: f64 = 0.12;
/// Share of the width of the mass over which its flexures stand, and their largest number in a group.
const FLEXURES: (f64, usize) = (0.85, 4);
/// Half turns of a spring.
const TURNS: usize = 14;

/// Whether the force of a mechanism without its springs and magnets depends on the displacement between these
/// ends in m.
#[doc(hidden)]
pub fn depends_on_place(mechanism: &Mechanism, (low, high): (f64, f64)) -> bool {
    let depends = |part: &&Mechanism| {
        let forces = [0.0, 0.21, 0.5, 0.83, 1.0].map(|share| {
            let (first, last) = part.curve.domain();
            part.curve.force((low + share * (high - low)).clamp(first, last))
        });
        forces.iter().any(|force| (force - forces[0]).abs() > 1e-9 * forces[0].abs())
    };
    mechanism.parts_or_self().iter().filter(|part| part.element.is_none()).any(|part| depends(&part))
}

/// The picture of the mechanism of a model with the mass at `x` in m. Flexures have their true shape; mass,
/// stops and the parts beside them are not to scale.
///
/// # Errors
///
/// If the flexures have no solution at `x`.
pub fn mechanism_chart(model: &Model, x: f64) -> Result<Chart, StatesError> {
    let mechanism = model.mechanism();
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let bent = match &mechanism.flexures {
        Some(_) => states(mechanism, &[x], &task)?,
        None => Vec::new(),
    };
    let mm = |stop: Option<f64>| stop.map_or(f64::NAN, |x| x * 1e3);
    let (left, right) = model.stop_positions();
    let stops = [mm(left), mm(right)];
    let wells = mechanism.landscape.equilibria.iter().map(|equilibrium| equilibrium.x * 1e3);
    let bends = bent.iter().flat_map(|state| &state.lines).flat_map(|line| &line.points);
    let places = wells.chain(stops).chain([x * 1e3, 0.0]).chain(bends.map(|point| point[2] * 1e3));
    let across = PlotAxis::around(places, ROOM, DISPLACEMENT);
    let geometry = mechanism.flexures.as_ref().map(|flexures| flexures.geometry());
    let height = geometry.map_or(1.0, |of| 1e3 * (of.parallel.length + of.buckling.length - of.preload));
    let clamp = HEIGHTS.2 * height;
    let up = match geometry {
        Some(_) => PlotAxis::between(-clamp, height + clamp, "along the flexures (mm)"),
        None => PlotAxis::given(-clamp, height + clamp, Vec::new(), ""),
    };
    let mut sketch = Sketch { panel: Panel::new(across, up), height, x: x * 1e3, y: 0.5 * height };
    let ends = [sketch.panel.x.low, sketch.panel.x.high];
    let clamps = [-0.5 * clamp, height + 0.5 * clamp].map(|y| [y, ends[0], ends[1]]);
    sketch.panel.layer(Role::Frame, "frame", Marks::Bars(clamps.into(), clamp));
    match (bent.first(), geometry) {
        (Some(state), Some(geometry)) => sketch.flexures(state, geometry, model.transducer()),
        _ => sketch.spring_above(mechanism),
    }
    sketch.beside(mechanism, model.transducer(), geometry.is_some());
    sketch.mass_and_stops(stops);
    let at = short(x * 1e3).replace('-', "\u{2212}");
    let about = match bent.first().map(|state| state.bump.abs() * 1e3) {
        Some(bulge) => {
            format!("mass at {at} mm, bulge {} mm; sideways stretched, mass not to scale", short(bulge))
        }
        None => format!("mass at {at} mm; not to scale along the frame"),
    };
    let data = drawn(&bent, (left.unwrap_or(f64::NAN), right.unwrap_or(f64::NAN)), &[x]);
    Ok(Chart::stack(vec![sketch.panel], about, data))
}

/// The panel, the distance of the clamps, and the place of the middle of the mass, in its units.
struct Sketch {
    panel: Panel,
    height: f64,
    x: f64,
    y: f64,
}

impl Sketch {
    /// A length as a share of the horizontal axis.
    fn wide(&self, share: f64) -> f64 {
        share * (self.panel.x.high - self.panel.x.low)
    }

    fn flexures(&mut self, state: &State, geometry: &Geometry, transducer: Transducer) {
        if let Some([_, along, _]) = state.lines.first().and_then(|line| line.points.last()) {
            self.y = along * 1e3;
        }
        for (line, group) in state.lines.iter().zip([&geometry.parallel, &geometry.buckling]) {
            let points: Vec<Point> = line.points.iter().map(|[_, s, x]| (x * 1e3, s * 1e3)).collect();
            let count = group.count.clamp(1, FLEXURES.1);
            for i in 0..count {
                let share = if count == 1 { 0.0 } else { 2.0 * i as f64 / (count - 1) as f64 - 1.0 };
                let aside = FLEXURES.0 * share * self.wide(MASS);
                let line: Vec<Point> = points.iter().map(|(x, y)| (x + aside, *y)).collect();
                if matches!(transducer, Transducer::Piezoelectric { .. }) && group == &geometry.parallel {
                    let feet = line[..line.len().div_ceil(5)].to_vec();
                    self.panel.layer(Role::Transducer, load(transducer), Marks::Path(feet));
                }
                self.panel.layer(Role::Motion, "flexure", Marks::Path(line));
            }
        }
    }

    /// A spring from the frame above to the mass, unless the force is the same everywhere.
    fn spring_above(&mut self, mechanism: &Mechanism) {
        let (low, high) = (self.panel.x.low * 1e-3, self.panel.x.high * 1e-3);
        if depends_on_place(mechanism, (low, high)) {
            let foot = mechanism.landscape.barrier.map_or(0.0, |barrier| barrier.x * 1e3);
            let ends = [(foot, self.height), (self.x, self.y + HEIGHTS.0 * self.height)];
            let coil = coil(ends, (self.wide(0.02), 0.0));
            self.panel.layer(Role::Motion, "spring of this force", Marks::Path(coil));
        }
    }

    /// Springs, magnets and the transducer.
    fn beside(&mut self, mechanism: &Mechanism, transducer: Transducer, has_flexures: bool) {
        let (half, width) = (HEIGHTS.0 * self.height, self.wide(0.012));
        let elements = || mechanism.parts_or_self().iter().filter_map(|part| part.element);
        let springs = elements().filter_map(|element| match element {
            Element::Spring { stiffness } => Some(stiffness),
            Element::Magnets { .. } => None,
        });
        let stiffness: f64 = springs.sum();
        if stiffness != 0.0 {
            let y = self.y - 0.5 * half;
            let ends = [(self.panel.x.low, y), (self.x - self.wide(MASS), y)];
            let name = format!("spring {} N/m", short(stiffness));
            self.panel.layer(Role::Second, name, Marks::Path(coil(ends, (0.0, 0.3 * half))));
        }
        let below = self.y - half;
        let has_magnets = elements().any(|element| matches!(element, Element::Magnets { .. }));
        if has_magnets {
            // one at the mass, the other at the frame, beside each other at x = 0
            let magnet = |x: f64, y: f64| Marks::Bars(vec![[y, x - width, x + width]], 0.8 * half);
            let post = Marks::Path(vec![(0.0, 0.0), (0.0, 0.5 * below)]);
            self.panel.draw(Role::Motion, post);
            self.panel.layer(Role::Magnet, "magnet", magnet(self.x, below - 0.4 * half));
            self.panel.draw(Role::Magnet, magnet(0.0, 0.5 * below));
        }
        match transducer {
            Transducer::Electromagnetic { .. } => {
                let y = if has_magnets { 0.12 * self.height } else { below - 0.9 * half };
                let long = self.wide(0.1);
                let rows = [y - 0.5 * half, y + 0.5 * half].map(|y| [y, -long, long]);
                self.panel.layer(Role::Transducer, load(transducer), Marks::Bars(rows.into(), 0.35 * half));
                if !has_magnets {
                    let magnet = vec![[y, self.x - width, self.x + width]];
                    self.panel.layer(Role::Magnet, "magnet", Marks::Bars(magnet, 0.5 * half));
                }
            }
            Transducer::Piezoelectric { .. } if !has_flexures => {
                let layer = Marks::Bars(vec![[0.25 * half, -2.0 * width, 2.0 * width]], 0.5 * half);
                self.panel.layer(Role::Transducer, load(transducer), layer);
            }
            Transducer::Piezoelectric { .. } | Transducer::None => {}
        }
    }

    /// The mass, and the faces that it touches at the travel limits, half its width further out.
    fn mass_and_stops(&mut self, stops: [f64; 2]) {
        let (half, stop) = (self.wide(MASS), self.wide(STOP));
        let walls = stops.into_iter().zip([-1.0, 1.0]).filter(|(at, _)| at.is_finite());
        let walls: Vec<[f64; 3]> = walls
            .map(|(at, side)| {
                let (low, high) = extent([at + side * half, at + side * (half + stop)]);
                [self.y, low, high]
            })
            .collect();
        let high = 2.0 * HEIGHTS.1 * self.height;
        self.panel.layer_if_any(Role::Stop, "stop, touched at the travel limit", Marks::Bars(walls, high));
        let body = vec![[self.y, self.x - half, self.x + half]];
        self.panel.layer(Role::Mass, "mass", Marks::Bars(body, 2.0 * HEIGHTS.0 * self.height));
        self.panel.draw(Role::Motion, Marks::Ticks(vec![self.x], Side::Bottom));
        let limits = stops.into_iter().filter(|at| at.is_finite()).collect();
        self.panel.layer_if_any(Role::Limit, "travel limit", Marks::Ticks(limits, Side::Bottom));
    }
}

/// A transducer with its load in words.
fn load(transducer: Transducer) -> String {
    let words = |load: f64, unit: &str| match load {
        0.0 => "short circuit".to_owned(),
        f64::INFINITY => "open circuit".to_owned(),
        load => format!("load {} {unit}", short(load)),
    };
    match transducer {
        Transducer::None => String::new(),
        Transducer::Electromagnetic { load_ohm, .. } => format!("coil, {}", words(load_ohm, "ohm")),
        Transducer::Piezoelectric { load_kohm, .. } => {
            format!("piezoelectric layer, {}", words(load_kohm, "kohm"))
        }
    }
}

/// A coil spring between two places, of this half width each way, with straight ends.
fn coil([from, to]: [Point; 2], half: Point) -> Vec<Point> {
    let at = |share: f64, side: f64| {
        (from.0 + share * (to.0 - from.0) + side * half.0, from.1 + share * (to.1 - from.1) + side * half.1)
    };
    let turn = |i: usize| {
        let share = 0.12 + 0.76 * (i as f64 + 0.5) / TURNS as f64;
        at(share, if i.is_multiple_of(2) { 1.0 } else { -1.0 })
    };
    [from, at(0.12, 0.0)].into_iter().chain((0..TURNS).map(turn)).chain([at(0.88, 0.0), to]).collect()
}
