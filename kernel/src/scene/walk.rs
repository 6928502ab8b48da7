//! Traversal of a scene's fields.
//!
//! One traversal of the typed scene visits every field with its dotted path (without variant names:
//! `stops.travel_limit_mm`) and a mutable reference. Checking, `--set`, `--over`, the cells of a sweep and
//! the lists in error messages all use it, so that all of them know the same fields.

use std::fmt;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::data::*;
use super::field_table::{FieldInfo, row};
use super::mechanism::{FlexureGroup, Mechanism};
use super::stops::Stops;
use super::text::{self, ParseError};
use super::transducer::Transducer;

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
    fn assign(&mut self, ron: &str) -> Result<(), ParseError>;

    /// The value as a word, for a choice its name; `None` for the choice `None`, an absent option and a list.
    fn word(&self) -> Option<String>;
}

impl<T: DeserializeOwned + Serialize> Assign for T {
    fn assign(&mut self, ron: &str) -> Result<(), ParseError> {
        *self = text::value(ron)?;
        Ok(())
    }

    fn word(&self) -> Option<String> {
        let text = text::options().to_string(self).ok()?;
        let name = text.trim_start_matches("r#");
        let length = name.find(|c: char| !c.is_alphanumeric()).unwrap_or(name.len());
        Some(name[..length].to_owned()).filter(|name| !name.is_empty() && name != "None")
    }
}

pub(super) enum Field<'a> {
    Number(&'static FieldInfo, Slot<'a>),
    Text(&'a mut String),
    Value(&'a mut dyn Assign),
}

pub(super) trait Visitor {
    /// Visits a field; returns whether to visit the fields inside it. If so and `inner` is set, `leave` is
    /// called after them.
    fn field(&mut self, segment: Segment, inner: bool, field: Field<'_>) -> bool;
    fn leave(&mut self);
}

pub(super) trait Fields {
    /// Visits every field, in the order in which a scene is written.
    fn visit_fields<V: Visitor>(&mut self, v: &mut V);
}

fn leaf(v: &mut impl Visitor, segment: Segment, value: &mut dyn Assign) {
    v.field(segment, false, Field::Value(value));
}

fn text(v: &mut impl Visitor, segment: Segment, value: &mut String) {
    v.field(segment, false, Field::Text(value));
}

/// Visits a value and then the fields inside it.
fn part<V: Visitor>(v: &mut V, segment: Segment, value: &mut (impl Fields + Assign)) {
    if v.field(segment, true, Field::Value(value)) {
        value.visit_fields(v);
        v.leave();
    }
}

/// Visits the fields inside a value whose own name is not part of their path.
fn inside<V: Visitor>(v: &mut V, _: Segment, value: &mut impl Fields) {
    value.visit_fields(v);
}

/// Visits nothing: the field is not written in the text of a scene.
fn hidden<T>(_: &mut impl Visitor, _: Segment, _: &mut T) {}

/// A number, an optional number or a list of numbers.
trait Number {
    fn visit(&mut self, segment: Segment, info: &'static FieldInfo, v: &mut impl Visitor);
}

macro_rules! numbers {
    ($($type:ty: $slot:ident),*) => {
        $(impl Number for $type {
            fn visit(&mut self, segment: Segment, info: &'static FieldInfo, v: &mut impl Visitor) {
                v.field(segment, false, Field::Number(info, Slot::$slot(self)));
            }
        })*
    };
}

numbers!(f64: Required, Option<f64>: Optional, u64: Whole);

impl Number for Vec<f64> {
    fn visit(&mut self, segment: Segment, info: &'static FieldInfo, v: &mut impl Visitor) {
        if v.field(segment, true, Field::Value(self)) {
            for (i, value) in self.iter_mut().enumerate() {
                value.visit(Segment::Index(i), info, v);
            }
            v.leave();
        }
    }
}

/// Visits one field: by the function after `as`, or as a number, which needs a row in the table of fields
/// under the path `$root` and its name.
macro_rules! visit {
    ($v:ident, $root:literal, $field:ident as $kind:ident) => {
        $kind($v, Segment::Name(stringify!($field)), $field)
    };
    ($v:ident, $root:literal, $field:ident) => {
        $field.visit(Segment::Name(stringify!($field)), const { row(concat!($root, stringify!($field))) }, $v)
    };
}

/// Lists the fields of each struct and of each variant in their order, those without names in brackets.
macro_rules! fields {
    ($($type:ident in $root:literal {
        $($shape:path { $($field:ident $(as $kind:ident)?),* $(,)? })*
        $(; $tuple:path [ $value:ident $(as $value_kind:ident)? ])*
    })*) => {
        $(impl Fields for $type {
            fn visit_fields<V: Visitor>(&mut self, v: &mut V) {
                match self {
                    $($shape { $($field),* } => { $(visit!(v, $root, $field $(as $kind)?);)* })*
                    $($tuple($value) => visit!(v, $root, $value $(as $value_kind)?),)*
                }
            }
        })*
    };
}

fields! {
    Scene in "" {
        Self {
            title as text,
            notes as text,
            mass_g,
            mechanism as part,
            damping as part,
            stops as part,
            transducer as part,
            excitation as part,
            start as part,
            run as part,
            sweep as part,
            app as part,
        }
    }
    Mechanism in "mechanism." {
        Self::Flexures {
            preload_mm,
            thickness_mm,
            young_gpa,
            parallel as part,
            buckling as part,
            poisson,
            plane_strain as leaf,
            initial_bow_mm,
            yield_gpa,
        }
        Self::Cubic { linear_n_per_m, cubic_n_per_m3 }
        Self::DoubleWell { equilibrium_mm, barrier_mj }
        Self::Polynomial { coefficients_si }
        Self::Pieces { ends_m as leaf, pieces as leaf, error_n }
        Self::Table { path as text, tolerance }
        Self::Linear { n_per_m }
        Self::Magnet { strength_n_mm4, gap_mm, moments as leaf }
        ; Self::Sum [parts as inside]
    }
    // the buckling flexures have the same ranges
    FlexureGroup in "mechanism.parallel." {
        Self { count, length_mm, width_mm }
    }
    Damping in "damping." {
        Self::None {}
        Self::Coefficient { c_n_s_per_m }
        ; Self::Ratio [xi]
    }
    Stops in "stops." {
        Self::None {}
        Self::Rigid { travel_limit_mm, restitution }
        Self::Uneven { left_mm, right_mm, restitution_left, restitution_right }
        Self::Hertz {
            travel_limit_mm,
            stiffness_n_per_m1_5,
            loss_s_per_m,
            radius_mm,
            young_gpa,
            poisson,
            yield_gpa,
        }
    }
    Transducer in "transducer." {
        Self::None {}
        Self::Electromagnetic { coupling_v_s_per_m, coil_ohm, load_ohm, inductance_mh }
        Self::Piezoelectric { coupling_n_per_v, capacitance_nf, load_kohm }
    }
    Excitation in "excitation." {
        Self::None {}
        Self::Constant { accel_g }
        Self::Sine { frequency_hz, amplitude_g, phase_deg }
        Self::Cosine { amplitude_m_per_s2, frequency_rad_per_s, phase_deg }
        Self::Force { amplitude_n, frequency_rad_per_s, phase_deg }
        Self::AmplitudeRamp { frequency_hz, from_g, to_g, over_s }
        Self::Chirp { from_hz, to_hz, over_s, amplitude_g }
        Self::Noise { rms_g, low_hz, high_hz, seed, lines }
        Self::Recorded { path as text, record as hidden }
        ; Self::Sum [terms as inside]
    }
    Start in "start." {
        Self::Rest {}
        Self::At { x_mm, v_m_per_s, electrical }
    }
    RunSettings in "run." {
        Self { duration_s, settle_s, tolerance, recurrence as leaf }
    }
    AppHints in "app." {
        Self { layout as leaf, speed, stops_when_on as part }
    }
}

impl Fields for SweepAxis {
    fn visit_fields<V: Visitor>(&mut self, v: &mut V) {
        let Self { field, from, to, step, values } = self;
        visit!(v, "sweep.", field as text);
        if values.is_empty() {
            visit!(v, "sweep.", from);
            visit!(v, "sweep.", to);
            visit!(v, "sweep.", step);
        } else {
            visit!(v, "sweep.", values);
        }
    }
}

impl<T: Fields + Assign> Fields for Vec<T> {
    fn visit_fields<V: Visitor>(&mut self, v: &mut V) {
        for (i, value) in self.iter_mut().enumerate() {
            part(v, Segment::Index(i), value);
        }
    }
}

impl<T: Fields> Fields for Option<T> {
    fn visit_fields<V: Visitor>(&mut self, v: &mut V) {
        if let Some(value) = self {
            value.visit_fields(v);
        }
    }
}
