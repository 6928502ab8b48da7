//! Description of a scene: what it models and omits, the accuracy of its force curve, its equilibria, its
//! release from a stop, and the speeds of its impacts.

use super::amplitudes::{can_cross, frees_at};
use super::contact::strikes_in_words;
use super::small_amplitude_frequency;
use crate::dynamics::Model;
use crate::mechanics::flexure::{Accuracy, Geometry, Group};
use crate::mechanics::{Equilibrium, ForceExtremum, Kink, Landscape, Mechanism};
use crate::numeric::short;
use crate::scene::{Damping, Excitation, Scene};

/// The description of a scene with its model in lines.
///
/// Numbers here are rounded to four digits for reading; `curve --landscape` has them all.
pub fn inspect(scene: &Scene, model: &Model) -> Vec<String> {
    let mechanism = model.mechanism();
    let mut lines = model.describe();
    if let (Excitation::Force { amplitude_n, .. }, Some(drive)) = (&scene.excitation, scene.harmonic()) {
        let (size, frequency) = (short(amplitude_n.abs()), drive.frequency_in_words());
        lines.push(format!(
            "force on the mass: {size} N at {frequency}; the base acceleration above is -force/mass"
        ));
    }
    if mechanism.parts.is_empty() {
        lines.extend(force(mechanism));
    } else {
        let (parts, pieces) = (mechanism.parts.len(), pieces_and_reach(mechanism));
        lines.push(format!(
            "force curve: {pieces}, the sum of {parts}, whose errors add; barrier and forces below are \
             those of the sum"
        ));
    }
    for (i, part) in (1..).zip(&mechanism.parts) {
        lines.extend(force(part).into_iter().map(|line| format!("part {i}: {line}")));
    }
    lines.extend(damping(scene, model));
    lines.extend(landscape(&mechanism.landscape, model.mass()));
    if mechanism.landscape.barrier.is_some() && !can_cross(scene, mechanism) {
        lines.push("the barrier does not lie between the stops, so that nothing crosses it".to_owned());
    }
    lines.extend(scene.harmonic().zip(frees_at(scene, mechanism)).map(|(drive, acceleration)| {
        let (amplitude, unit) = (short(drive.amplitude_of(acceleration)), drive.unit());
        format!("at rest on its right stop the mass is released from {amplitude} {unit} on")
    }));
    lines.extend(strikes_in_words(model, scene));
    lines
}

fn force(mechanism: &Mechanism) -> Vec<String> {
    let Some(solved) = &mechanism.flexures else { return vec![force_curve(mechanism)] };
    let [shape, theory] = flexures(solved.geometry());
    vec![shape, theory, accuracy(mechanism, solved.accuracy())]
}

fn flexures(geometry: &Geometry) -> [String; 2] {
    let mm = |metres: f64| short(metres * 1e3);
    let group = |kind: &str, Group { count, length, width }: &Group| {
        format!("{count} {kind}, {} mm long and {} mm wide", mm(*length), mm(*width))
    };
    let modulus = if geometry.plane_strain {
        "plane strain, E/(1 - poisson^2) in place of E"
    } else {
        "E as it stands"
    };
    let bow = match geometry.initial_bow {
        0.0 => "straight when free".to_owned(),
        bow => format!("with a stress-free bow of {} mm in the buckling ones", mm(bow)),
    };
    [
        format!(
            "flexures: {}; {}; all {} mm thick and {bow}; preload {} mm",
            group("parallel", &geometry.parallel),
            group("buckling", &geometry.buckling),
            mm(geometry.thickness),
            mm(geometry.preload)
        ),
        format!(
            "beam theory: planar, geometrically exact (Reissner), with stretching and shear, clamped at both \
             ends to frame and to a shuttle that does not turn; E = {} GPa, Poisson's ratio {}, {modulus}; \
             left out: the lateral strain of wide strips in bending, yielding, the mass of the flexures",
            short(geometry.young / 1e9),
            short(geometry.poisson)
        ),
    ]
}

/// A line on the accuracy of the force curve of flexures, without features that do not exist.
fn accuracy(mechanism: &Mechanism, accuracy: &Accuracy) -> String {
    let outer = if accuracy.force.is_finite() { "of the force further out" } else { "of the force" };
    let parts = [
        (accuracy.force, "of the largest inner force"),
        (accuracy.potential, "of the barrier"),
        (accuracy.stiffness, "of the stiffness at x = 0"),
        (accuracy.outer_force, outer),
    ];
    let parts = parts.into_iter().filter(|(error, _)| error.is_finite());
    let parts: Vec<String> = parts.map(|(error, of)| format!("{} {of}", short(error))).collect();
    let limit = match accuracy.is_at_limit() {
        true => ", which are all that there are: the flexures are too thin to be resolved where they bend",
        false => "",
    };
    let Accuracy { solves, modes, .. } = accuracy;
    let (pieces, parts) = (pieces_and_reach(mechanism), parts.join(", "));
    format!(
        "force curve: {pieces}, from {solves} solutions with {modes} modes a flexure{limit}; against fresh \
         solutions off by at most {parts}"
    )
}

fn pieces_and_reach(mechanism: &Mechanism) -> String {
    let curve = &mechanism.curve;
    let pieces = match curve.pieces().len() {
        1 => "one polynomial".to_owned(),
        n => format!("{n} polynomials"),
    };
    let (left, right) = curve.domain();
    if left.is_finite() || right.is_finite() {
        format!("{pieces}, from {} to {} mm", short(left * 1e3), short(right * 1e3))
    } else {
        pieces
    }
}

fn force_curve(mechanism: &Mechanism) -> String {
    let pieces = pieces_and_reach(mechanism);
    match mechanism.curve.fit() {
        None => format!("force curve: {pieces}, exact"),
        Some(fit) => {
            let [worst, share] = [fit.worst_n, fit.worst_n / fit.scale_n].map(short);
            let scale = short(fit.scale_n);
            let samples = fit.samples.map_or_else(String::new, |count| format!(" through {count} samples"));
            let at = fit.worst_at_m.map_or_else(String::new, |x| format!(" at x = {} mm", short(x * 1e3)));
            format!("force curve: {pieces}{samples}; off by at most {worst} N ({share} of {scale} N){at}")
        }
    }
}

/// Lines on stiffness and coefficient for a damping ratio and, at a kink, for other definitions of it.
fn damping(scene: &Scene, model: &Model) -> Vec<String> {
    let Damping::Ratio(xi) = scene.damping else { return Vec::new() };
    let landscape = &model.mechanism().landscape;
    let Some(used) = landscape.damping_stiffness() else { return Vec::new() };
    let beside = landscape.kink_at_right_well();
    let kink = beside.map(|kink| kink.x).or(landscape.damping_kink().map(|kink| kink.x));
    let place = kink.zip(landscape.right_stable()).map(|(kink, well)| {
        let [at, away] = [kink * 1e3, (well.x - kink).abs() * 1e6].map(short);
        format!(", the slope just inside the kink at {at} mm ({away} um from the equilibrium)")
    });
    let ([k, c], place) = ([used, model.damping()].map(short), place.unwrap_or_default());
    let mut lines =
        vec![format!("damping ratio {xi}: with k = {k} N/m{place}, c = 2 xi sqrt(k m) = {c} N s/m")];
    let Some(kink) = beside.filter(|kink| short(kink.inner) != short(kink.outer)) else { return lines };
    lines[0] += ", which is used";
    let coefficient = |stiffness: f64| 2.0 * xi * (stiffness * model.mass()).sqrt();
    let pluck =
        Equilibrium { x: kink.x, stable: true, stiffness_left: kink.inner, stiffness_right: kink.outer };
    let mixed = small_amplitude_frequency(model.mass(), &pluck).map(|frequency| {
        let stiffness = model.mass() * (std::f64::consts::TAU * frequency).powi(2);
        let [f, k, c] = [frequency, stiffness, coefficient(stiffness)].map(short);
        format!("; with the mixed period of a small pluck over it ({f} Hz, as of {k} N/m) c = {c} N s/m")
    });
    let ([k, c], mixed) = ([kink.outer, coefficient(kink.outer)].map(short), mixed.unwrap_or_default());
    lines.push(format!(
        "the same ratio with the slope just outside the kink, {k} N/m, would be c = {c} N s/m{mixed}; a \
         `Coefficient` leaves no choice"
    ));
    lines
}

fn landscape(landscape: &Landscape, mass: f64) -> Vec<String> {
    let mut lines: Vec<String> = landscape.equilibria.iter().map(|e| equilibrium(e, mass)).collect();
    if lines.is_empty() {
        lines.push("no equilibrium".to_owned());
    }
    if let Some(barrier) = landscape.barrier {
        let mj = |joules: f64| short(joules * 1e3);
        let (left, right) = (mj(barrier.from_left_j), mj(barrier.from_right_j));
        let height = match left == right {
            true => format!("{left} mJ above both wells"),
            false => format!("{left} mJ above the well left of it, {right} mJ above that right of it"),
        };
        lines.push(format!("barrier at {} mm, {height}", short(barrier.x * 1e3)));
        let wells = landscape.equilibria.iter().filter(|place| place.stable).count();
        if wells > 2 {
            lines.push(format!(
                "{wells} wells: of the barriers between them this is the nearest to x = 0; crossings, regime \
                 and side are about it alone, of two as near about the one on the side of the start"
            ));
        }
    }
    if !landscape.extrema.is_empty() {
        let words = |e: &ForceExtremum| format!("{} N at {} mm", short(e.force), short(e.x * 1e3));
        let extrema: Vec<String> = landscape.extrema.iter().map(words).collect();
        lines.push(format!("force extrema: {}", extrema.join(", ")));
    }
    if !landscape.kinks.is_empty() {
        let sides = |left: f64, right: f64| format!("{} | {} N/m", short(left), short(right));
        let words =
            |k: &Kink| format!("{} mm ({})", short(k.x * 1e3), sides(k.stiffness_left, k.stiffness_right));
        let kinks: Vec<String> = landscape.kinks.iter().map(words).collect();
        lines.push(format!("kinks, stiffness left | right: {}", kinks.join(", ")));
    }
    lines
}

fn equilibrium(equilibrium: &Equilibrium, mass: f64) -> String {
    let (left, right) = (short(equilibrium.stiffness_left), short(equilibrium.stiffness_right));
    let stiffness = if left == right { left } else { format!("{left} | {right}") };
    let kind = if equilibrium.stable { "stable" } else { "unstable" };
    let frequency = small_amplitude_frequency(mass, equilibrium);
    let frequency = frequency.map_or(String::new(), |f| format!(", {} Hz when plucked", short(f)));
    format!("{kind} equilibrium at {} mm, stiffness {stiffness} N/m{frequency}", short(equilibrium.x * 1e3))
}
