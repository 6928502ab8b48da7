//! Branches that end, turn or leap: none does unsaid.

use interwell::dynamics::{EventKind, MapState, Side};
use interwell_studies::study::{BranchEnd, BranchEvent, OrbitAnswer};

use super::{at, over_amplitude};
use crate::cli::stdout;
use crate::support::{changed, near};

/// The mass is released as ever, and from some amplitude down fails to pass the barrier: its state once a
/// period is the same, and what it does is not. Stops without restitution have no chatter, so that nothing
/// else happens before.
#[test]
fn a_mass_that_rests_leaps_where_it_just_fails_to_cross() {
    let strikes_left = |orbit: &OrbitAnswer| {
        let mut impacts = orbit.passage.events.iter().filter(|event| event.kind == EventKind::Impact);
        impacts.any(|event| event.side == Side::Left)
    };
    for limit in [1.3, 1.4, 1.5] {
        let limit = format!("stops.travel_limit_mm={limit:?}");
        let scene = changed("paper", &[&limit, "stops.restitution=0"]);
        let down = over_amplitude(&scene, (1.0, 0.6), Some(1));
        let up = over_amplitude(&scene, (0.6, 1.0), Some(1));
        // from above the last motions may strike the stop without resting on it
        assert!(
            up.end == BranchEnd::Leap && [BranchEnd::Leap, BranchEnd::Lost].contains(&down.end),
            "{limit}: {:?} {:?}",
            down.end,
            up.end
        );
        assert!(down.orbits.iter().all(strikes_left) && !up.orbits.iter().any(strikes_left), "{limit}");
        let (above, below) = (down.values.last().unwrap(), up.values.last().unwrap());
        assert!(above > below && above - below < 3e-6, "{limit}: {above} {below}");
    }
    // with restitution, from above, chatter no longer ends before the mass is released, some 1e-4 g sooner
    let scene = changed("paper", &[]);
    let down = over_amplitude(&scene, (1.0, 0.6), Some(1));
    let up = over_amplitude(&scene, (0.6, 1.0), Some(1));
    assert_eq!((down.end, up.end), (BranchEnd::Leap, BranchEnd::Leap));
    let (above, below) = (down.values.last().unwrap(), up.values.last().unwrap());
    assert!(above > below && above - below < 5e-4, "{above} {below}");
}

/// Between two kinks the branch turns back: it goes through all motions between, none of which is far from
/// the one before.
#[test]
fn consecutive_motions_are_near_each_other() {
    let document = changed("paper-unconstrained", &[]);
    let found = over_amplitude(&document, (1.05, 0.9), None);
    assert_eq!((found.end, found.values.last()), (BranchEnd::Range, Some(&1.05)));
    let place = found.events.iter().position(|event| *event == Some(BranchEvent::Fold)).unwrap();
    near(found.orbits[place].multipliers()[0].re, 1.0, 1e-6);
    for pair in found.orbits.windows(2) {
        let [x, before] = [pair[1].state.x, pair[0].state.x];
        assert!((x - before).abs() < 7.2e-5, "{x} {before}");
    }
}

/// A mass that rests is a function of the field, whose branch turns nowhere; at 7 mm it ends where chatter no
/// longer ends in rest. Of the others that touch there, no motion comes again but one that ends the branch.
#[test]
fn a_branch_does_not_go_back_along_itself() {
    let scene = changed("paper", &["stops.travel_limit_mm=7"]);
    let up = over_amplitude(&scene, (0.7, 1.4), Some(1));
    assert_ne!(up.end, BranchEnd::Range);
    assert!(up.values.windows(2).all(|pair| pair[1] >= pair[0]), "{:?}", up.values.last());
    for from in [1.5, 1.495] {
        let down = over_amplitude(&scene, (from, 0.7), Some(1));
        let row = |i: usize| (down.values[i], down.orbits[i].state);
        let within = |i: usize, j: usize, far: f64| {
            let ((value, MapState { x, v, .. }), (other, next)) = (row(i), row(j));
            let (y, w) = (next.x, next.v);
            (value - other).abs() < far && (x - y).abs() < 0.1 * far && (v - w).abs() < 10.0 * far
        };
        // to come again it must have gone away
        let comes_again = |i: usize, j: usize| within(i, j, 1e-9) && (i..j).any(|k| !within(i, k, 1e-4));
        let again = (0..down.values.len()).find(|j| (0..*j).any(|i| comes_again(i, *j)));
        let closes = again == Some(down.values.len() - 1) && down.end == BranchEnd::Closed;
        assert!(again.is_none() || closes, "{from}: {again:?} {:?}", down.end);
        assert_ne!(down.end, BranchEnd::Points);
        assert!(down.end != BranchEnd::Closed || down.events.last() == Some(&None), "an event is there once");
    }
}

/// Past a grazing just below the start of the range one way leads upward, out of it. Which way is taken, and
/// where among motions that chatter the branch ends, is up to rounding.
#[test]
fn a_branch_does_not_leave_its_range() {
    for tolerance in ["1e-9", "3e-10", "2e-10", "1.0001e-9"] {
        let scene = changed("paper", &["stops.travel_limit_mm=7", &format!("run.tolerance={tolerance}")]);
        let found = over_amplitude(&scene, (1.495, 0.7), Some(1));
        assert!(found.values.iter().all(|value| (0.7..=1.495).contains(value)), "{tolerance} {found:?}");
        let at_an_end = [0.7, 1.495].contains(found.values.last().unwrap());
        assert!(found.end != BranchEnd::Range || at_an_end && found.values.len() > 1, "{tolerance}");
    }
}

/// A fold that lies just beyond the end is not reached, and a branch that comes back to its start says so.
#[test]
fn a_fold_beyond_the_end_is_not_told_and_a_return_is() {
    let document = changed("paper-unconstrained", &["run.duration_s=200"]);
    let whole = over_amplitude(&document, (1.3, 1.1), None);
    let fold = at(&whole, BranchEvent::Fold)[0];
    for (beyond, folds) in [(1e-3, 0), (1e-5, 0), (1e-7, 0), (-1e-7, 1), (-1e-5, 1)] {
        let to = fold + beyond;
        let found = over_amplitude(&document, (1.3, to), None);
        assert!(found.values.iter().all(|value| (to..=1.3).contains(value)), "{beyond} {:?}", found.values);
        let end = if folds == 0 { to } else { 1.3 };
        assert_eq!((found.end, found.values.last()), (BranchEnd::Range, Some(&end)), "{beyond}");
        assert_eq!(at(&found, BranchEvent::Fold).len(), folds, "{beyond}");
    }
}

#[test]
fn a_branch_begins_at_its_own_value_of_the_field() {
    let of =
        |more: &str| stdout(&format!("orbit paper --branch excitation.amplitude_g=1:0.95 --quiet {more}"));
    assert_eq!(of("--set excitation.amplitude_g=0"), of(""));
}
