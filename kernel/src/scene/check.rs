//! Validation of a scene.
//!
//! This reports all faults that follow from the numbers of the scene alone, all at once. Faults that need the
//! mechanism (an equilibrium to rest at, a stiffness for a damping ratio) are reported when the model is
//! built. No later code checks again.

use super::axis::{Axis, MAX_AXES, repeated};
use super::data::*;
use super::error::Fault;
use super::field_table::{MAX_COEFFICIENTS, row};
use super::fields::{FieldPath, Seen, for_each, in_range};
use super::harmonic::Harmonic;
use super::mechanism::Mechanism;
use super::pieces;
use super::shape;
use super::stops::Stops;
use super::transducer::Transducer;
use super::unit::STANDARD_GRAVITY;
use crate::numeric::number_text;

/// Largest number of sines of an excitation, including the lines of noises: four noises with the largest
/// number of lines. Each sine adds to the cost of every step of a run.
const MAX_SINES: u64 = 16_384;

/// Largest number of parts of a sum of mechanisms, since flexures are solved one by one.
const MAX_PARTS: usize = 16;

/// Smallest room between two stops on one side of x = 0, relative to the distance of the farther one: in a
/// smaller room displacements have too few digits.
const ROOM_OVER_DISTANCE: f64 = 1e-6;

/// Result of [`check`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Checked {
    /// Faults, in the order of the scene's fields; empty if the scene can be run.
    pub faults: Vec<Fault>,
    /// Warnings about values that are valid but probably not intended, each a sentence that names its field.
    pub warnings: Vec<String>,
}

/// Checks ranges and the relations between fields. A fault that depends on the force curve, such as a start
/// beyond its end, is found by [`Model::build`](crate::dynamics::Model::build).
pub fn check(scene: &Scene) -> Checked {
    let mut checked = Checked::default();
    ranges(scene, &mut checked);
    mechanism("mechanism", &scene.mechanism, &mut checked);
    stops("stops", &scene.stops, &mut checked);
    if let Some(stops_when_on) = scene.app.as_ref().and_then(|app| app.stops_when_on.as_ref()) {
        stops("app.stops_when_on", stops_when_on, &mut checked);
    }
    transducer(scene, &mut checked);
    relations(scene, &mut checked);
    drive(&scene.excitation, "excitation", scene.mass_g, &mut checked);
    sines(&scene.excitation, &mut checked);
    hints(scene, &mut checked);
    sweep(scene, &mut checked);
    checked
}

/// Whether the numbers of a scene, except those of its mechanism, pass its check. It is faster than [`check`]
/// because it writes no messages; a sweep calls it for each cell.
pub(crate) fn is_sound(scene: &Scene) -> bool {
    let mut checked = Checked::default();
    stops("stops", &scene.stops, &mut checked);
    transducer(scene, &mut checked);
    drive(&scene.excitation, "excitation", scene.mass_g, &mut checked);
    checked.faults.is_empty() && in_range(scene)
}

impl Checked {
    pub(super) fn fault(
        &mut self,
        field: impl Into<String>,
        value: impl Into<String>,
        problem: impl Into<String>,
    ) {
        self.faults.push(Fault::new(field, value, problem));
    }
}

fn ranges(scene: &Scene, checked: &mut Checked) {
    for_each(scene, |path, field| {
        let Seen::Number(spec, number) = field else { return };
        if let Some(value) = number
            && !spec.range.contains(value)
        {
            checked.fault(path, number_text(value), format!("must be {}; {}", spec.range, spec.remedy));
        }
    });
}

fn mechanism(field: &str, described: &Mechanism, checked: &mut Checked) {
    match described {
        Mechanism::Polynomial { coefficients_si } => {
            let count = coefficients_si.len();
            if !(1..=MAX_COEFFICIENTS).contains(&count) {
                let problem = format!(
                    "must have 1 to {MAX_COEFFICIENTS} coefficients; [0] is a free mass, a `Table` follows \
                     any curve"
                );
                checked.fault(format!("{field}.coefficients_si"), format!("a list of {count}"), problem);
            }
        }
        Mechanism::Table { path, .. } if path.trim().is_empty() => {
            let problem = "name a CSV file with the columns x_m,force_n";
            checked.fault(format!("{field}.path"), "\"\"", problem);
        }
        Mechanism::Sum(_) if field != "mechanism" => {
            checked.fault(field, "Sum([..])", "a sum within a sum; give its parts to the outer one");
        }
        Mechanism::Sum(parts) if !(1..=MAX_PARTS).contains(&parts.len()) => {
            let problem =
                format!("must have 1 to {MAX_PARTS} parts; Polynomial(coefficients_si: [0]) is none");
            checked.fault(field, format!("a sum of {}", parts.len()), problem);
        }
        Mechanism::Sum(parts) => {
            for (i, part) in parts.iter().enumerate() {
                mechanism(&format!("{field}.{i}"), part, checked);
            }
        }
        Mechanism::Pieces { .. } => pieces::check(field, described, checked),
        _ => shape::check(field, described, checked),
    }
}

fn stops(field: &str, stops: &Stops, checked: &mut Checked) {
    let Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right } = stops else {
        return hertz(field, stops, checked);
    };
    if let (Some(left), Some(right)) = (*left_mm, *right_mm)
        && !(left + right >= ROOM_OVER_DISTANCE * left.abs().max(right.abs()) && left + right > 0.0)
        && !["left_mm", "right_mm"].iter().any(|name| has_fault(&format!("{field}.{name}"), checked))
    {
        let problem = format!(
            "the right stop, at {} mm, must stand right of the left one, at {} mm ({field}.left_mm = {}); \
             both count from x = 0, right_mm to the right and left_mm to the left; leave a room of at least \
             {ROOM_OVER_DISTANCE:e} of the farther distance",
            number_text(right),
            number_text(0.0 - left),
            number_text(left)
        );
        checked.fault(format!("{field}.right_mm"), number_text(right), problem);
    }
    if left_mm.is_none() && right_mm.is_none() {
        checked.fault(field, "Uneven()", "give left_mm, right_mm or both; `stops: None` is no stops");
    } else if restitution_left.is_none() && restitution_right.is_none() {
        checked.fault(
            field,
            "Uneven(..)",
            "give restitution_left or restitution_right, 0 to 1; one that is left out takes the other's \
             value",
        );
    } else if restitution_left.is_some() && restitution_right.is_some() {
        for (side, at) in [("left", left_mm), ("right", right_mm)] {
            if at.is_none() {
                checked.warnings.push(format!(
                    "{field}.restitution_{side} has no effect: {side}_mm is left out, so that side is open"
                ));
            }
        }
    }
}

/// Checks that a compliant stop has either a stiffness or cylinders that determine it.
fn hertz(field: &str, stops: &Stops, checked: &mut Checked) {
    let Stops::Hertz { stiffness_n_per_m1_5, radius_mm, young_gpa, poisson, yield_gpa, .. } = *stops else {
        return;
    };
    let cylinders =
        [("radius_mm", radius_mm), ("young_gpa", young_gpa), ("poisson", poisson), ("yield_gpa", yield_gpa)];
    match stiffness_n_per_m1_5 {
        Some(_) => {
            for (name, value) in cylinders {
                if let Some(value) = value {
                    let problem =
                        "belongs to cylinders, and stiffness_n_per_m1_5 is given; leave one of the two out";
                    checked.fault(format!("{field}.{name}"), number_text(value), problem);
                }
            }
        }
        None => {
            let missing: Vec<&str> =
                cylinders[..2].iter().filter(|(_, value)| value.is_none()).map(|(name, _)| *name).collect();
            if !missing.is_empty() {
                let problem = format!(
                    "needs {}; give radius_mm and young_gpa of the cylinders, or stiffness_n_per_m1_5 alone",
                    missing.join(" and ")
                );
                checked.fault(field, "Hertz(..)", problem);
            }
        }
    }
}

/// Checks that a resistance or an inductance limits the current, that an electrical state has no compliant
/// stops, and that only a transducer with a state has a start value.
fn transducer(scene: &Scene, checked: &mut Checked) {
    if let Transducer::Electromagnetic { coil_ohm: 0.0, load_ohm: 0.0, inductance_mh: 0.0, .. } =
        scene.transducer
    {
        let problem = "without coil_ohm or inductance_mh above 0 nothing limits the current of a short \
                       circuit; give the resistance of the coil or of the load";
        checked.fault("transducer.load_ohm", "0", problem);
    }
    let has_state = scene.transducer.has_state();
    if has_state && matches!(scene.stops, Stops::Hertz { .. }) {
        let (field, remedy) = match scene.transducer {
            Transducer::Piezoelectric { .. } => ("transducer", "take Rigid or Uneven stops"),
            _ => ("transducer.inductance_mh", "take Rigid or Uneven stops, or an inductance of 0"),
        };
        let value = FieldPath::new(field).word(scene).unwrap_or_default();
        let problem = format!(
            "makes a state of its own, which is not followed through contact with compliant stops (Hertz); \
             {remedy}"
        );
        checked.fault(field, value, problem);
    }
    if let Start::At { electrical, .. } = scene.start
        && electrical != 0.0
        && !has_state
        && !has_fault("start.electrical", checked)
    {
        checked.fault(
            "start.electrical",
            number_text(electrical),
            "needs a transducer with a current or voltage of its own: Electromagnetic with an inductance and \
             a load that is not open, or Piezoelectric with a load that is not short; else it is 0",
        );
    }
}

/// Whether a field already has a fault, in which case it gets no second one.
pub(super) fn has_fault(field: &str, checked: &Checked) -> bool {
    checked.faults.iter().any(|fault| fault.field == field)
}

/// Checks relations between two fields, unless one of them is already outside its range.
fn relations(scene: &Scene, checked: &mut Checked) {
    if let Start::At { x_mm, .. } = scene.start {
        let [left, right] = scene.stops.positions_mm();
        let (left, right) = (left.unwrap_or(f64::NEG_INFINITY), right.unwrap_or(f64::INFINITY));
        let bad_stop = checked.faults.iter().any(|fault| fault.field.starts_with("stops"));
        if (x_mm > right || x_mm < left) && !bad_stop && !has_fault("start.x_mm", checked) {
            let (side, at) = if x_mm > right { ("right", right) } else { ("left", left) };
            let field = match scene.stops {
                Stops::Uneven { .. } => format!("stops.{side}_mm"),
                _ => "stops.travel_limit_mm".to_owned(),
            };
            checked.fault(
                "start.x_mm",
                number_text(x_mm),
                format!(
                    "lies outside the {side} stop at {} mm ({field}); start between the stops or on one",
                    number_text(at)
                ),
            );
        }
    }
    let RunSettings { duration_s, settle_s, .. } = scene.run;
    if let Some(settle) = settle_s
        && settle > duration_s
        && !has_fault("run.settle_s", checked)
        && !has_fault("run.duration_s", checked)
    {
        checked.fault(
            "run.settle_s",
            number_text(settle),
            format!(
                "must not exceed run.duration_s = {}; left out, it is half of it",
                number_text(duration_s)
            ),
        );
    }
}

/// Checks the bands of noises, and the acceleration that a force gives the mass, also inside sums.
fn drive(excitation: &Excitation, path: &str, mass_g: f64, checked: &mut Checked) {
    let largest = row("excitation.amplitude_g").range;
    match excitation {
        Excitation::Force { amplitude_n, .. }
            if row("excitation.amplitude_n").range.contains(*amplitude_n)
                && row("mass_g").range.contains(mass_g)
                && !largest.contains(amplitude_n / (mass_g / 1e3) / STANDARD_GRAVITY) =>
        {
            checked.fault(
                format!("{path}.amplitude_n"),
                number_text(*amplitude_n),
                format!(
                    "must give the mass, mass_g = {}, an acceleration of at most {} g; take a smaller force",
                    number_text(mass_g),
                    number_text(largest.high)
                ),
            )
        }
        Excitation::Noise { low_hz, high_hz, .. }
            if low_hz >= high_hz
                && row("excitation.low_hz").range.contains(*low_hz)
                && row("excitation.high_hz").range.contains(*high_hz) =>
        {
            checked.fault(
                format!("{path}.high_hz"),
                number_text(*high_hz),
                format!("must be above {path}.low_hz = {}", number_text(*low_hz)),
            )
        }
        Excitation::Sum(terms) => {
            for (i, term) in terms.iter().enumerate() {
                drive(term, &format!("{path}.{i}"), mass_g, checked);
            }
        }
        _ => {}
    }
}

/// Checks the number of sines: a text of a few megabytes could have enough noises to exhaust the memory.
fn sines(excitation: &Excitation, checked: &mut Checked) {
    fn count(excitation: &Excitation) -> u64 {
        match excitation {
            Excitation::Sine { .. } | Excitation::Cosine { .. } | Excitation::Force { .. } => 1,
            Excitation::AmplitudeRamp { .. } | Excitation::Chirp { .. } => 1,
            Excitation::Noise { lines, .. } => *lines,
            Excitation::Sum(terms) => terms.iter().map(count).fold(0, u64::saturating_add),
            _ => 0,
        }
    }
    let count = count(excitation);
    if count > MAX_SINES && !checked.faults.iter().any(|fault| fault.field.starts_with("excitation")) {
        let problem =
            format!("must have at most {MAX_SINES}, the lines of noises included; take fewer terms or lines");
        checked.fault("excitation", format!("a sum of {count} sines"), problem);
    }
}

/// Warnings about valid values that look like an error of units or of a factor of ten.
fn hints(scene: &Scene, checked: &mut Checked) {
    if !checked.faults.is_empty() {
        return;
    }
    match &scene.mechanism {
        Mechanism::Sum(parts) => (0..).zip(parts).for_each(|(i, part)| {
            shape::hints(&format!("mechanism.{i}"), part, &mut checked.warnings);
        }),
        only => shape::hints("mechanism", only, &mut checked.warnings),
    }
    let RunSettings { duration_s, settle_s, .. } = scene.run;
    if let Damping::Ratio(xi) = scene.damping
        && xi > 1.0
    {
        checked.warnings.push(format!(
            "damping.xi = {}: above 1 the mass creeps back without swinging; 2.3 % is written 0.023",
            number_text(xi)
        ));
    }
    let window = duration_s - settle_s.unwrap_or(duration_s / 2.0);
    let warn = |term: &Excitation, warnings: &mut Vec<String>| match *term {
        Excitation::Sine { .. } | Excitation::Cosine { .. } | Excitation::Force { .. } => {
            let Some(Harmonic { frequency_hz, .. }) = term.harmonic(1.0) else { return };
            if window * frequency_hz < 1.0 - 1e-9 {
                warnings.push(format!(
                    "run: the settled window of {} s is shorter than a forcing period of {} s, so that RMS \
                     and regime say little; run longer or settle earlier",
                    number_text(window),
                    number_text(1.0 / frequency_hz)
                ));
            }
        }
        Excitation::AmplitudeRamp { over_s, .. } | Excitation::Chirp { over_s, .. }
            if over_s > duration_s =>
        {
            warnings.push(format!(
                "excitation: the ramp takes {} s and the run ends after {} s, before its end",
                number_text(over_s),
                number_text(duration_s)
            ))
        }
        _ => {}
    };
    let mut terms = vec![&scene.excitation];
    // A sum may have thousands of terms; the first few warnings are enough.
    while let Some(term) = terms.pop().filter(|_| checked.warnings.len() < 8) {
        match term {
            Excitation::Sum(inner) => terms.extend(inner.iter().rev()),
            term => warn(term, &mut checked.warnings),
        }
    }
    checked.warnings.dedup();
}

fn sweep(scene: &Scene, checked: &mut Checked) {
    if scene.sweep.len() > MAX_AXES {
        let value = format!("a list of {}", scene.sweep.len());
        checked.fault("sweep", value, format!("must have at most {MAX_AXES} axes"));
        return;
    }
    if let Some(field) = repeated(scene.sweep.iter().map(|axis| axis.field.as_str())) {
        checked.fault("sweep", field, "is swept twice; give each field one axis");
    }
    // Only `corners` checks relations between fields at the values of a sweep, so that `simulate` does not
    // fail because of a sweep that is not run. An axis that can never be used is a fault here.
    for (i, axis) in scene.sweep.iter().enumerate() {
        let path = format!("sweep.{i}.");
        if checked.faults.iter().any(|fault| fault.field.starts_with(&path)) {
            continue;
        }
        if let Err((part, problem)) = Axis::from_scene(axis, scene) {
            let value = match part {
                "field" => format!("{:?}", axis.field),
                "from" => number_text(axis.from),
                "to" => number_text(axis.to),
                "values" => format!("a list of {}", axis.values.len()),
                _ => number_text(axis.step),
            };
            checked.fault(path + part, value, problem);
        }
    }
}

/// Checks the scene at the corners of a sweep of at most [`MAX_AXES`] axes. The relations between fields are
/// linear, so that they hold in every cell if they hold at the corners.
#[doc(hidden)]
pub fn corners(scene: &Scene, axes: &[Axis]) -> Vec<Fault> {
    let ends: Vec<[usize; 2]> = axes.iter().map(extremes).collect();
    let corners = 1_usize << axes.len().min(MAX_AXES);
    let mut cell = Scene {
        title: String::new(),
        notes: String::new(),
        mechanism: scene.mechanism.clone(),
        excitation: scene.excitation.clone(),
        sweep: Vec::new(),
        app: scene.app.clone(),
        ..*scene
    };
    for corner in 0..corners {
        for (i, axis) in axes.iter().enumerate() {
            axis.apply(&mut cell, ends[i][(corner >> i.min(MAX_AXES)) & 1]);
        }
        let mut faults = check(&cell).faults;
        if !faults.is_empty() {
            let value =
                |axis: &Axis| FieldPath::new(&axis.field).get(&cell).map_or_else(String::new, number_text);
            let at: Vec<String> =
                axes.iter().map(|axis| format!("{} = {}", axis.field, value(axis))).collect();
            for fault in faults.iter_mut().filter(|_| !axes.is_empty()) {
                fault.problem += &format!(" (in the sweep, at {})", at.join(", "));
            }
            return faults;
        }
    }
    Vec::new()
}

/// The indices of an axis's smallest and largest value.
fn extremes(axis: &Axis) -> [usize; 2] {
    let by_value = |a: &usize, b: &usize| axis.values[*a].total_cmp(&axis.values[*b]);
    let indices = || 0..axis.values.len();
    [indices().min_by(by_value).unwrap_or(0), indices().max_by(by_value).unwrap_or(0)]
}
