//! Parts of a mechanism as they are drawn, in the window and in pictures.

use super::figure::{Area, Figure, Point};
use super::frame::Frame;
use super::role::Role;
use super::sketch::{Pen, Sketch, heights};
use super::style::{self, Theme};
use crate::dynamics::Model;
use crate::mechanics::flexure::{Geometry, State};
use crate::mechanics::{Element, Mechanism};
use crate::scene::{Moments, Transducer};

/// Largest number of flexures drawn for a group.
const MAX_LINES: usize = 4;

/// A pair of magnets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MagnetPair {
    /// In N m^4.
    pub strength: f64,
    /// In m.
    pub gap: f64,
    /// Directions of the two moments.
    pub moments: Moments,
}

impl MagnetPair {
    /// Stiffness in N/m at x = 0; above 0 the magnets attract each other there.
    pub fn stiffness(self) -> f64 {
        let factor = match self.moments {
            Moments::Facing => 12.0,
            Moments::Transverse => -3.0,
        };
        factor * self.strength / self.gap.powi(5)
    }
}

/// Bent flexures, in m.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Flexures {
    /// The line of the flexures below the mass and of those above it, each from its clamp, as displacements
    /// and places along the flexures; and their numbers.
    pub groups: Vec<(Vec<Point>, usize)>,
    /// Distance of the clamps, for a mass of no height.
    pub clamps: f64,
    bulge: f64,
}

/// The parts of a mechanism, with the mass at a displacement, as they are drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// Displacement of the mass in m.
    pub x: f64,
    /// Total stiffness of its springs in N/m; 0 without a spring.
    pub stiffness: f64,
    /// The pair of magnets that is the stiffest at x = 0.
    pub magnets: Option<MagnetPair>,
    /// Number of pairs of magnets.
    pub pairs: usize,
    /// What turns motion into power.
    pub transducer: Transducer,
    /// Displacement in m of the fixed end of the spring that stands for a force without flexures; `None`
    /// where that force is the same everywhere.
    pub spring: Option<f64>,
    /// The push on the mass as a share of the largest, positive to the right; 0 for no arrow.
    pub push: f64,
    /// Travel limit in m of other stops, whose outlines are drawn over the picture.
    pub outlined: Option<f64>,
    /// Displacements of the stops in m.
    pub(super) stops: [Option<f64>; 2],
    pub(super) flexures: Option<Flexures>,
}

/// Whether the force of a mechanism without its springs and magnets depends on the displacement between these
/// ends in m.
fn depends_on_place(mechanism: &Mechanism, (low, high): (f64, f64)) -> bool {
    let depends = |part: &&Mechanism| {
        let forces = [0.0, 0.21, 0.5, 0.83, 1.0].map(|share| {
            let (first, last) = part.curve.domain();
            part.curve.force((low + share * (high - low)).clamp(first, last))
        });
        forces.iter().any(|force| (force - forces[0]).abs() > 1e-9 * forces[0].abs())
    };
    mechanism.parts_or_self().iter().filter(|part| part.element.is_none()).any(|part| depends(&part))
}

impl Assembly {
    /// The mechanism of a model with the mass at `x`, its flexures in this state, drawn between these ends
    /// in m.
    pub fn of(model: &Model, x: f64, bent: Option<&State>, ends: (f64, f64)) -> Self {
        let mechanism = model.mechanism();
        let flexures = mechanism.flexures.as_ref().zip(bent);
        let barrier = mechanism.landscape.barrier.map_or(0.0, |barrier| barrier.x);
        let mut parts = Self {
            x,
            stiffness: 0.0,
            magnets: None,
            pairs: 0,
            transducer: model.transducer(),
            spring: (flexures.is_none() && depends_on_place(mechanism, ends)).then_some(barrier),
            push: 0.0,
            outlined: None,
            stops: model.stop_positions().into(),
            flexures: flexures.map(|(flexures, state)| Flexures::of(flexures.geometry(), state)),
        };
        for element in mechanism.parts_or_self().iter().filter_map(|part| part.element) {
            match element {
                Element::Spring { stiffness } => parts.stiffness += stiffness,
                Element::Magnets { strength, gap, moments } if strength != 0.0 => {
                    parts.pairs += 1;
                    let pair = MagnetPair { strength, gap, moments };
                    if pair.stiffness().abs() > parts.magnets.map_or(0.0, |pair| pair.stiffness().abs()) {
                        parts.magnets = Some(pair);
                    }
                }
                Element::Magnets { .. } => {}
            }
        }
        parts
    }

    /// The push of a base with this acceleration in m/s^2 on the mass of a model.
    #[must_use]
    pub fn pushed(self, model: &Model, base_accel: f64) -> Self {
        let push = -base_accel / model.largest_base_acceleration().max(1e-9);
        Self { push: if model.is_shaken() { push } else { 0.0 }, ..self }
    }

    /// Whether a part stands on a clamp below the mass.
    pub(super) fn stands_below(&self) -> bool {
        self.magnets.is_some() || self.transducer != Transducer::None
    }

    /// The bulge of the flexures as text, if there are any.
    pub fn bulge(&self) -> Option<String> {
        let mm = self.flexures.as_ref()?.bulge * 1e3;
        Some(if mm < 0.005 { "taut: no bulge left".to_owned() } else { format!("bulge {mm:.1} mm") })
    }

    /// Lengths of the canvas to a m along the flexures in an area, if there are any.
    pub fn along(&self, area: Area) -> Option<f64> {
        let clamps = self.flexures.as_ref()?.clamps;
        let (top, bottom, half) = heights(area);
        Some((bottom - top - 2.0 * half).max(1.0) / clamps)
    }

    /// The drawing in a frame, whose horizontal axis is the displacement in mm, with these words at the mass
    /// and at the flexures.
    pub fn sketch(&self, frame: &Frame, theme: &Theme, mass: &str, flexures: Option<&str>) -> Sketch {
        Pen::new(self, frame, theme).draw(mass, flexures)
    }

    /// Draws it in a frame, with its mass and its stops.
    pub(super) fn draw(&self, figure: &mut Figure, frame: &Frame, theme: &Theme) {
        let sketch = self.sketch(frame, theme, "mass", self.bulge().as_deref());
        figure.shapes.extend(sketch.behind);
        let stops = sketch.stops.into_iter().flatten().map(|stop| (stop, Role::Stop));
        for (part, role) in stops.chain([(sketch.mass, Role::Mass)]) {
            let look = theme.look(role);
            if let Some(part) = part.common(frame.area) {
                figure.filled(part, look.ink, look.hatch);
                figure.outline(part, style::GRID, theme.ink);
            }
        }
        figure.shapes.extend(sketch.before);
    }
}

impl Flexures {
    fn of(geometry: &Geometry, state: &State) -> Self {
        let groups = state.lines.iter().zip([&geometry.parallel, &geometry.buckling]);
        let groups = groups.map(|(line, group)| {
            let points = line.points.iter().map(|[_, along, across]| (*across, *along)).collect();
            (points, group.count.clamp(1, MAX_LINES))
        });
        Self {
            groups: groups.collect(),
            clamps: geometry.parallel.length + geometry.buckling.length - geometry.preload,
            bulge: state.bump.abs(),
        }
    }
}
