//! Traversal of a scene's fields.
//!
//! One traversal of the typed scene visits every field with its dotted path (without variant names:
//! `stops.travel_limit_mm`) and a mutable reference. Checking, `--set`, `--over`, the cells of a sweep and
//! the lists in error messages all use it, so that all of them know the same fields.

use std::fmt;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::data::*;
use super::mechanism::{FlexureGroup, Mechanism};
use super::ranges::{self, Spec};
use super::stops::Stops;
use super::text;
use super::transducer::Transducer;

/// One part of a path during the traversal.
#[derive(Debug, Clone, Copy)]
pub(super) enum Segment {
    Name(&'static str),
    Index(usize),
}

impl fmt::Display for Segment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name(name) => f.write_str(name),
            Self::Index(index) => write!(f, "{index}"),
        }
    }
}

/// Reference to a number; an optional number may be left out.
pub(super) enum Slot<'a> {
    Required(&'a mut f64),
    Optional(&'a mut Option<f64>),
    Whole(&'a mut u64),
}

impl Slot<'_> {
    pub(super) fn get(&self) -> Option<f64> {
        match self {
            Self::Required(number) => Some(**number),
            Self::Optional(number) => **number,
            Self::Whole(number) => Some(**number as f64),
        }
    }

    pub(super) fn set(self, value: f64) {
        match self {
            Self::Required(number) => *number = value,
            Self::Optional(number) => *number = Some(value),
            Self::Whole(number) => *number = value as u64, // the caller has checked that it is whole
        }
    }
}

/// A value that can be replaced from RON text.
pub(super) trait Assign {
    fn assign(&mut self, ron: &str) -> ron::error::SpannedResult<()>;

    /// The value as a word, for a choice its name; `None` for the choice `None`, an absent option and a list.
    fn word(&self) -> Option<String>;
}

impl<T: DeserializeOwned + Serialize> Assign for T {
    fn assign(&mut self, ron: &str) -> ron::error::SpannedResult<()> {
        *self = text::options().from_str(ron)?;
        Ok(())
    }

    fn word(&self) -> Option<String> {
        let text = text::options().to_string(self).ok()?;
        let name = text.trim_start_matches("r#");
        let length = name.find(|c: char| !c.is_alphanumeric()).unwrap_or(name.len());
        Some(name[..length].to_owned()).filter(|name| !name.is_empty() && name != "None")
    }
}

/// A field found by the traversal.
pub(super) enum Field<'a> {
    Number(&'static Spec, Slot<'a>),
    Text(&'a mut String),
    Value(&'a mut dyn Assign),
}

/// Receiver of the fields of a traversal.
pub(super) trait Visitor {
    /// Visits a field; returns whether to visit the fields inside it. If so and `inner` is set, `leave` is
    /// called after them.
    fn field(&mut self, segment: Segment, inner: bool, field: Field<'_>) -> bool;
    fn leave(&mut self);
}

fn number(v: &mut impl Visitor, spec: &'static Spec, value: &mut f64) {
    v.field(Segment::Name(spec.name), false, Field::Number(spec, Slot::Required(value)));
}

fn optional(v: &mut impl Visitor, spec: &'static Spec, value: &mut Option<f64>) {
    v.field(Segment::Name(spec.name), false, Field::Number(spec, Slot::Optional(value)));
}

fn whole(v: &mut impl Visitor, spec: &'static Spec, value: &mut u64) {
    v.field(Segment::Name(spec.name), false, Field::Number(spec, Slot::Whole(value)));
}

fn numbers(v: &mut impl Visitor, spec: &'static Spec, list: &mut Vec<f64>) {
    within(v, Segment::Name(spec.name), list, |list, v| {
        for (i, value) in list.iter_mut().enumerate() {
            v.field(Segment::Index(i), false, Field::Number(spec, Slot::Required(value)));
        }
    });
}

fn leaf(v: &mut impl Visitor, name: &'static str, value: &mut dyn Assign) {
    v.field(Segment::Name(name), false, Field::Value(value));
}

fn within<V: Visitor, T: Assign>(
    v: &mut V,
    segment: Segment,
    value: &mut T,
    inside: impl FnOnce(&mut T, &mut V),
) {
    if v.field(segment, true, Field::Value(value)) {
        inside(value, v);
        v.leave();
    }
}

/// Visits every field of a scene, in the order in which a scene is written.
pub(super) fn walk(scene: &mut Scene, v: &mut impl Visitor) {
    v.field(Segment::Name("title"), false, Field::Text(&mut scene.title));
    v.field(Segment::Name("notes"), false, Field::Text(&mut scene.notes));
    number(v, &ranges::MASS, &mut scene.mass_g);
    within(v, Segment::Name("mechanism"), &mut scene.mechanism, walk_mechanism);
    within(v, Segment::Name("damping"), &mut scene.damping, |damping, v| match damping {
        Damping::None => {}
        Damping::Ratio(xi) => number(v, &ranges::XI, xi),
        Damping::Coefficient { c_n_s_per_m } => number(v, &ranges::C, c_n_s_per_m),
    });
    within(v, Segment::Name("stops"), &mut scene.stops, walk_stops);
    within(v, Segment::Name("transducer"), &mut scene.transducer, walk_transducer);
    within(v, Segment::Name("excitation"), &mut scene.excitation, walk_excitation);
    within(v, Segment::Name("start"), &mut scene.start, |start, v| match start {
        Start::Rest => {}
        Start::At { x_mm, v_m_per_s, electrical } => {
            number(v, &ranges::X, x_mm);
            number(v, &ranges::V, v_m_per_s);
            number(v, &ranges::ELECTRICAL, electrical);
        }
    });
    within(v, Segment::Name("run"), &mut scene.run, |run, v| {
        number(v, &ranges::DURATION, &mut run.duration_s);
        optional(v, &ranges::SETTLE, &mut run.settle_s);
        number(v, &ranges::TOLERANCE, &mut run.tolerance);
        leaf(v, "recurrence", &mut run.recurrence);
    });
    within(v, Segment::Name("sweep"), &mut scene.sweep, |sweep, v| {
        for (i, axis) in sweep.iter_mut().enumerate() {
            within(v, Segment::Index(i), axis, |axis, v| {
                v.field(Segment::Name("field"), false, Field::Text(&mut axis.field));
                if axis.values.is_empty() {
                    number(v, &ranges::FROM, &mut axis.from);
                    number(v, &ranges::TO, &mut axis.to);
                    number(v, &ranges::STEP, &mut axis.step);
                } else {
                    numbers(v, &ranges::VALUES, &mut axis.values);
                }
            });
        }
    });
    within(v, Segment::Name("app"), &mut scene.app, |app, v| {
        let Some(app) = app else { return };
        leaf(v, "layout", &mut app.layout);
        optional(v, &ranges::SPEED, &mut app.speed);
        within(v, Segment::Name("stops_when_on"), &mut app.stops_when_on, |stops, v| {
            if let Some(stops) = stops {
                walk_stops(stops, v);
            }
        });
    });
}

fn walk_mechanism<V: Visitor>(mechanism: &mut Mechanism, v: &mut V) {
    match mechanism {
        Mechanism::Flexures {
            preload_mm,
            thickness_mm,
            young_gpa,
            parallel,
            buckling,
            poisson,
            plane_strain,
            initial_bow_mm,
            yield_gpa,
        } => {
            number(v, &ranges::PRELOAD, preload_mm);
            number(v, &ranges::THICKNESS, thickness_mm);
            number(v, &ranges::YOUNG, young_gpa);
            within(v, Segment::Name("parallel"), parallel, walk_group);
            within(v, Segment::Name("buckling"), buckling, walk_group);
            number(v, &ranges::POISSON, poisson);
            leaf(v, "plane_strain", plane_strain);
            number(v, &ranges::BOW, initial_bow_mm);
            number(v, &ranges::YIELD, yield_gpa);
        }
        Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 } => {
            number(v, &ranges::LINEAR, linear_n_per_m);
            number(v, &ranges::CUBIC, cubic_n_per_m3);
        }
        Mechanism::DoubleWell { equilibrium_mm, barrier_mj } => {
            number(v, &ranges::EQUILIBRIUM, equilibrium_mm);
            number(v, &ranges::BARRIER, barrier_mj);
        }
        Mechanism::Polynomial { coefficients_si } => {
            numbers(v, &ranges::COEFFICIENTS, coefficients_si);
        }
        Mechanism::Table { path, tolerance } => {
            v.field(Segment::Name("path"), false, Field::Text(path));
            number(v, &ranges::TABLE_TOLERANCE, tolerance);
        }
        Mechanism::Linear { n_per_m } => number(v, &ranges::STIFFNESS, n_per_m),
        Mechanism::Magnet { strength_n_mm4, gap_mm } => {
            number(v, &ranges::STRENGTH, strength_n_mm4);
            number(v, &ranges::GAP, gap_mm);
        }
        Mechanism::Sum(parts) => {
            for (i, part) in parts.iter_mut().enumerate() {
                within(v, Segment::Index(i), part, walk_mechanism);
            }
        }
    }
}

fn walk_group<V: Visitor>(group: &mut FlexureGroup, v: &mut V) {
    whole(v, &ranges::COUNT, &mut group.count);
    number(v, &ranges::FLEXURE_LENGTH, &mut group.length_mm);
    number(v, &ranges::WIDTH, &mut group.width_mm);
}

fn walk_stops(stops: &mut Stops, v: &mut impl Visitor) {
    match stops {
        Stops::None => {}
        Stops::Rigid { travel_limit_mm, restitution } => {
            number(v, &ranges::TRAVEL_LIMIT, travel_limit_mm);
            number(v, &ranges::RESTITUTION, restitution);
        }
        Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right } => {
            optional(v, &ranges::LEFT, left_mm);
            optional(v, &ranges::RIGHT, right_mm);
            optional(v, &ranges::RESTITUTION_LEFT, restitution_left);
            optional(v, &ranges::RESTITUTION_RIGHT, restitution_right);
        }
        Stops::Hertz {
            travel_limit_mm,
            stiffness_n_per_m1_5,
            loss_s_per_m,
            radius_mm,
            young_gpa,
            poisson,
            yield_gpa,
        } => {
            number(v, &ranges::TRAVEL_LIMIT, travel_limit_mm);
            optional(v, &ranges::CONTACT_STIFFNESS, stiffness_n_per_m1_5);
            number(v, &ranges::LOSS, loss_s_per_m);
            optional(v, &ranges::RADIUS, radius_mm);
            optional(v, &ranges::CONTACT_YOUNG, young_gpa);
            optional(v, &ranges::POISSON, poisson);
            optional(v, &ranges::CONTACT_YIELD, yield_gpa);
        }
    }
}

fn walk_transducer(transducer: &mut Transducer, v: &mut impl Visitor) {
    match transducer {
        Transducer::None => {}
        Transducer::Electromagnetic { coupling_v_s_per_m, coil_ohm, load_ohm, inductance_mh } => {
            number(v, &ranges::COUPLING_V, coupling_v_s_per_m);
            number(v, &ranges::COIL, coil_ohm);
            number(v, &ranges::LOAD_OHM, load_ohm);
            number(v, &ranges::INDUCTANCE, inductance_mh);
        }
        Transducer::Piezoelectric { coupling_n_per_v, capacitance_nf, load_kohm } => {
            number(v, &ranges::COUPLING_N, coupling_n_per_v);
            number(v, &ranges::CAPACITANCE, capacitance_nf);
            number(v, &ranges::LOAD_KOHM, load_kohm);
        }
    }
}

fn walk_excitation<V: Visitor>(excitation: &mut Excitation, v: &mut V) {
    match excitation {
        Excitation::None => {}
        Excitation::Constant { accel_g } => number(v, &ranges::ACCEL, accel_g),
        Excitation::Sine { frequency_hz, amplitude_g, phase_deg } => {
            number(v, &ranges::FREQUENCY, frequency_hz);
            number(v, &ranges::AMPLITUDE, amplitude_g);
            number(v, &ranges::PHASE, phase_deg);
        }
        Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s } => {
            number(v, &ranges::FREQUENCY, frequency_hz);
            number(v, &ranges::FROM_G, from_g);
            number(v, &ranges::TO_G, to_g);
            number(v, &ranges::OVER, over_s);
        }
        Excitation::Chirp { from_hz, to_hz, over_s, amplitude_g } => {
            number(v, &ranges::FROM_HZ, from_hz);
            number(v, &ranges::TO_HZ, to_hz);
            number(v, &ranges::OVER, over_s);
            number(v, &ranges::AMPLITUDE, amplitude_g);
        }
        Excitation::Noise { rms_g, low_hz, high_hz, seed, lines } => {
            number(v, &ranges::RMS, rms_g);
            number(v, &ranges::LOW_HZ, low_hz);
            number(v, &ranges::HIGH_HZ, high_hz);
            whole(v, &ranges::SEED, seed);
            whole(v, &ranges::LINES, lines);
        }
        Excitation::Recorded { path, .. } => {
            v.field(Segment::Name("path"), false, Field::Text(path));
        }
        Excitation::Sum(terms) => {
            for (i, term) in terms.iter_mut().enumerate() {
                within(v, Segment::Index(i), term, walk_excitation);
            }
        }
    }
}
