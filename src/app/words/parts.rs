//! Words for the parts of a drawn mechanism.

use crate::app::words::numbers::three;
use crate::mechanics::Mechanism;
use crate::numeric::short;
use crate::output::{Assembly, DrawnPart};
use crate::scene::{Moments, Transducer};

/// What a part of a drawing is and does.
pub fn part_words(part: DrawnPart, of: &Assembly) -> String {
    match part {
        DrawnPart::Spring => {
            let away = of.stiffness < 0.0;
            let effect = if away { "pushes the mass away from there" } else { "draws the mass there" };
            format!(
                "A spring of {} N/m between the frame and the mass. It has no force at x = 0 and {effect}, \
                 harder the further out the mass is.",
                short(of.stiffness)
            )
        }
        DrawnPart::Magnets => magnets_words(of),
        DrawnPart::Transducer => transducer_words(of.transducer),
        DrawnPart::Load => load_words(of.transducer),
    }
}

fn magnets_words(of: &Assembly) -> String {
    let Some(pair) = of.magnets else { return String::new() };
    let attract = pair.stiffness() > 0.0;
    let effect = if attract { "draw the mass to x = 0" } else { "push the mass away from x = 0" };
    let [mm, twice_mm] = [pair.gap, 2.0 * pair.gap].map(|metres| three(1e3 * metres));
    let more = match of.pairs {
        1 => String::new(),
        pairs => {
            format!(" Of {pairs} pairs of magnets this one is the stiffest there; the others are not drawn.")
        }
    };
    let strength = three((1e12 * pair.strength).abs());
    match pair.moments {
        Moments::Facing => format!(
            "Two magnets, {mm} mm apart where they face each other at x = 0, with a strength of {strength} \
             N mm⁴. They {effect} up to {twice_mm} mm from it, and further out the other way.{more}"
        ),
        Moments::Transverse => format!(
            "Two magnets, {mm} mm apart at x = 0 and magnetised across the drawing, with a strength of \
             {strength} N mm⁴. They {effect}.{more}"
        ),
    }
}

fn transducer_words(transducer: Transducer) -> String {
    let (words, coupling) = match transducer {
        Transducer::None => return String::new(),
        Transducer::Electromagnetic { coupling_v_s_per_m: coupling, .. } => {
            let volts = short(coupling.abs());
            let is = "A coil at the frame, cut through. The magnet at the mass induces";
            (format!("{is} {volts} V in it at 1 m/s."), coupling)
        }
        Transducer::Piezoelectric { coupling_n_per_v: coupling, .. } => {
            let newtons = short(coupling.abs());
            let is = "A piezoelectric layer, which the motion strains: 1 V on it is a force of";
            (format!("{is} {newtons} N on the mass."), coupling)
        }
    };
    let none = if coupling == 0.0 { " Its coupling is 0: it does nothing." } else { "" };
    words + none
}

fn load_words(transducer: Transducer) -> String {
    let (load, unit) = match transducer {
        Transducer::None => return String::new(),
        Transducer::Electromagnetic { load_ohm, .. } => (load_ohm, "ohm"),
        Transducer::Piezoelectric { load_kohm, .. } => (load_kohm, "kohm"),
    };
    match load {
        0.0 => "A short circuit: the load is 0 and takes no power.".to_owned(),
        f64::INFINITY => {
            "An open circuit: no current flows through the load, which takes no power.".to_owned()
        }
        load => format!("The load, {} {unit}, which takes the power.", short(load)),
    }
}

/// Caption of a drawing without flexures.
pub fn schematic_words(mechanism: &Mechanism, of: &Assembly) -> String {
    let is_beside = of.stiffness != 0.0 || of.magnets.is_some();
    let force = other_force(mechanism);
    match (of.spring, force) {
        (Some(_), _) if is_beside => "the other force as a spring, not to scale".to_owned(),
        (Some(_), _) => "a spring of this force, not to scale".to_owned(),
        (None, 0.0) if is_beside => "not to scale".to_owned(),
        (None, 0.0) => "a free mass".to_owned(),
        (None, force) => {
            let direction = if force > 0.0 { "left" } else { "right" };
            format!("a steady force of {} N to the {direction}", three(force.abs()))
        }
    }
}

/// The force of a mechanism without its springs and magnets at x = 0.
fn other_force(mechanism: &Mechanism) -> f64 {
    let force = |part: &Mechanism| {
        let (low, high) = part.curve.domain();
        part.curve.force(0.0_f64.clamp(low, high))
    };
    mechanism.parts_or_self().iter().filter(|part| part.element.is_none()).map(force).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Simulation;

    #[test]
    fn only_a_force_that_depends_on_the_place_has_a_spring() {
        let words = |preset: &str| {
            let simulation = Simulation::preset(preset).unwrap();
            let model = simulation.model();
            schematic_words(model.mechanism(), &Assembly::of(model, 0.0, None, (-0.01, 0.01)))
        };
        assert_eq!(words("bouncing-ball"), "a steady force of 9.81 N to the left");
        assert_eq!(words("elastic-box"), "a free mass");
        for preset in ["duffing", "monostable", "nominal-cubic", "paper-table"] {
            assert!(words(preset).starts_with("a spring"), "{preset}");
        }
    }
}
