//! Traversal of a scene's fields.
//!
//! One list of the fields of each type, under their dotted paths (without variant names:
//! `stops.travel_limit_mm`), makes the walk that shows every field and the search for the one that is
//! set. Checking, `--set`, `--over`, the cells of a sweep and the lists in error messages all use them,
//! so that all know the same fields.

use std::fmt;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::data::*;
use super::field_table::{FieldInfo, row};
use super::mechanism::{FlexureGroup, Mechanism};
use super::scanner::Part;
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

/// A number that can be set; an optional number may be left out.
pub(super) enum Slot<'a> {
    Required(&'a mut f64),
    Optional(&'a mut Option<f64>),
    Whole(&'a mut u64),
}

impl Slot<'_> {
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

/// A field to be set.
pub(super) enum Field<'a> {
    Number(&'static FieldInfo, Slot<'a>),
    Text(&'a mut String),
    Value(&'a mut dyn Assign),
}

/// A field as it is read; a number that is left out is `None`.
pub(super) enum Seen<'a> {
    Number(&'static FieldInfo, Option<f64>),
    Text(&'a str),
    Value(&'a dyn Assign),
}

pub(super) trait Visitor<'a> {
    /// Visits a field; returns whether to visit the fields inside it. If so and `inner` is set, `leave` is
    /// called after them.
    fn field(&mut self, segment: Segment, inner: bool, field: Seen<'a>) -> bool;
    fn leave(&mut self);
}

pub(super) trait Fields {
    /// Visits every field, in the order in which a scene is written.
    fn show<'a>(&'a self, v: &mut dyn Visitor<'a>);

    /// The field at a path that begins with the name of a field of this value.
    fn at(&mut self, path: &[Part]) -> Option<Field<'_>>;
}

/// A number, an optional number or a list of numbers.
trait Number {
    fn show<'a>(&'a self, segment: Segment, info: &'static FieldInfo, v: &mut dyn Visitor<'a>);

    /// The number at a path below its own.
    fn at(&mut self, path: &[Part], info: &'static FieldInfo) -> Option<Field<'_>>;
}

macro_rules! numbers {
    ($($type:ty: $slot:ident, $number:ident => $value:expr;)*) => {
        $(impl Number for $type {
            fn show<'a>(&'a self, segment: Segment, info: &'static FieldInfo, v: &mut dyn Visitor<'a>) {
                let $number = *self;
                v.field(segment, false, Seen::Number(info, $value));
            }

            fn at(&mut self, path: &[Part], info: &'static FieldInfo) -> Option<Field<'_>> {
                path.is_empty().then_some(Field::Number(info, Slot::$slot(self)))
            }
        })*
    };
}

numbers! {
    f64: Required, number => Some(number);
    Option<f64>: Optional, number => number;
    u64: Whole, number => Some(number as f64);
}

impl Number for Vec<f64> {
    fn show<'a>(&'a self, segment: Segment, info: &'static FieldInfo, v: &mut dyn Visitor<'a>) {
        if v.field(segment, true, Seen::Value(self)) {
            for (i, value) in self.iter().enumerate() {
                value.show(Segment::Index(i), info, v);
            }
            v.leave();
        }
    }

    fn at(&mut self, path: &[Part], info: &'static FieldInfo) -> Option<Field<'_>> {
        match path {
            [] => Some(Field::Value(self)),
            [Part::Index(i), rest @ ..] => self.get_mut(*i)?.at(rest, info),
            _ => None,
        }
    }
}

/// How fields of each kind that is no number are visited.
mod show {
    use super::{Assign, Fields, Seen, Segment, Visitor};

    pub fn text<'a>(v: &mut dyn Visitor<'a>, segment: Segment, value: &'a str) {
        v.field(segment, false, Seen::Text(value));
    }

    pub fn leaf<'a>(v: &mut dyn Visitor<'a>, segment: Segment, value: &'a dyn Assign) {
        v.field(segment, false, Seen::Value(value));
    }

    /// A value and then the fields inside it.
    pub fn part<'a>(v: &mut dyn Visitor<'a>, segment: Segment, value: &'a (impl Fields + Assign)) {
        if v.field(segment, true, Seen::Value(value)) {
            value.show(v);
            v.leave();
        }
    }

    /// The fields inside a value whose own name is not part of their path.
    pub fn inside<'a>(v: &mut dyn Visitor<'a>, _: Segment, value: &'a impl Fields) {
        value.show(v);
    }

    /// Nothing: the field is not written in the text of a scene.
    pub fn hidden<T>(_: &mut dyn Visitor<'_>, _: Segment, _: &T) {}
}

/// Where a path leads in fields of each kind that is no number.
mod at {
    use super::{Assign, Field, Fields, Part, below};

    pub fn text<'a>(path: &[Part], name: &str, value: &'a mut String) -> Option<Field<'a>> {
        below(path, name)?.is_empty().then_some(Field::Text(value))
    }

    pub fn leaf<'a>(path: &[Part], name: &str, value: &'a mut dyn Assign) -> Option<Field<'a>> {
        below(path, name)?.is_empty().then_some(Field::Value(value))
    }

    pub fn part<'a>(path: &[Part], name: &str, value: &'a mut (impl Fields + Assign)) -> Option<Field<'a>> {
        match below(path, name)? {
            [] => Some(Field::Value(value)),
            rest => value.at(rest),
        }
    }

    pub fn inside<'a>(path: &[Part], _: &str, value: &'a mut impl Fields) -> Option<Field<'a>> {
        value.at(path)
    }

    pub fn hidden<'a, T>(_: &[Part], _: &str, _: &mut T) -> Option<Field<'a>> {
        None
    }
}

/// The rest of a path that begins with this name.
fn below<'p>(path: &'p [Part], name: &str) -> Option<&'p [Part]> {
    match path {
        [Part::Name(first), rest @ ..] if first == name => Some(rest),
        _ => None,
    }
}

/// Visits one field: by the function after `as`, or as a number, which needs a row in the table of fields
/// under the path `$root` and its name.
macro_rules! show {
    ($v:ident, $root:literal, $field:ident as $kind:ident) => {
        show::$kind($v, Segment::Name(stringify!($field)), $field)
    };
    ($v:ident, $root:literal, $field:ident) => {
        $field.show(Segment::Name(stringify!($field)), const { row(concat!($root, stringify!($field))) }, $v)
    };
}

/// The field at a path if it is this one or inside it.
macro_rules! at {
    ($path:ident, $root:literal, $field:ident as $kind:ident) => {
        at::$kind($path, stringify!($field), $field)
    };
    ($path:ident, $root:literal, $field:ident) => {
        match below($path, stringify!($field)) {
            Some(rest) => $field.at(rest, const { row(concat!($root, stringify!($field))) }),
            None => None,
        }
    };
}

/// Lists the fields of each struct and of each variant in their order, those without names in brackets.
macro_rules! fields {
    ($($type:ident in $root:literal {
        $($shape:path { $($field:ident $(as $kind:ident)?),* $(,)? })*
        $(; $tuple:path [ $value:ident $(as $value_kind:ident)? ])*
    })*) => {
        $(impl Fields for $type {
            fn show<'a>(&'a self, v: &mut dyn Visitor<'a>) {
                match self {
                    $($shape { $($field),* } => { $(show!(v, $root, $field $(as $kind)?);)* })*
                    $($tuple($value) => show!(v, $root, $value $(as $value_kind)?),)*
                }
            }

            fn at(&mut self, path: &[Part]) -> Option<Field<'_>> {
                match self {
                    $($shape { $($field),* } => {
                        $(if let Some(found) = at!(path, $root, $field $(as $kind)?) {
                            return Some(found);
                        })*
                        None
                    })*
                    $($tuple($value) => at!(path, $root, $value $(as $value_kind)?),)*
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
    fn show<'a>(&'a self, v: &mut dyn Visitor<'a>) {
        let Self { field, from, to, step, values } = self;
        show!(v, "sweep.", field as text);
        if values.is_empty() {
            show!(v, "sweep.", from);
            show!(v, "sweep.", to);
            show!(v, "sweep.", step);
        } else {
            show!(v, "sweep.", values);
        }
    }

    fn at(&mut self, path: &[Part]) -> Option<Field<'_>> {
        let Self { field, from, to, step, values } = self;
        if !values.is_empty() {
            return at!(path, "sweep.", field as text).or(at!(path, "sweep.", values));
        }
        at!(path, "sweep.", field as text)
            .or(at!(path, "sweep.", from))
            .or(at!(path, "sweep.", to))
            .or(at!(path, "sweep.", step))
    }
}

impl<T: Fields + Assign> Fields for Vec<T> {
    fn show<'a>(&'a self, v: &mut dyn Visitor<'a>) {
        for (i, value) in self.iter().enumerate() {
            show::part(v, Segment::Index(i), value);
        }
    }

    fn at(&mut self, path: &[Part]) -> Option<Field<'_>> {
        match path {
            [Part::Index(i)] => self.get_mut(*i).map(|value| Field::Value(value)),
            [Part::Index(i), rest @ ..] => self.get_mut(*i)?.at(rest),
            _ => None,
        }
    }
}

impl<T: Fields> Fields for Option<T> {
    fn show<'a>(&'a self, v: &mut dyn Visitor<'a>) {
        if let Some(value) = self {
            value.show(v);
        }
    }

    fn at(&mut self, path: &[Part]) -> Option<Field<'_>> {
        self.as_mut()?.at(path)
    }
}
