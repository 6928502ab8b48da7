//! Branch switching: at flips and breakings of the symmetry, against branches that begin at runs and closed
//! forms.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::mechanics::Mechanism;
use interwell::scene::Document;
use interwell_studies::study::{
    BranchAnswer, BranchEnd, BranchEvent, BranchOptions, Family, Task, branch, branches_table, switched,
};

use super::one_stop::OneStop;
use super::{AMPLITUDE, Ball, at, document, over_amplitude, two};
use crate::cli::stdout;
use crate::measured::Noise;
use crate::support::{changed, near, near_relative};

fn followed(document: &Document, range: (f64, f64), levels: u32) -> Vec<BranchAnswer> {
    let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
    let family = Family::new(&document.scene, &document.files, &mechanism, AMPLITUDE);
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let options = BranchOptions::new(0.0, Some(1));
    let first = branch(&family, AMPLITUDE, range, &options, &task).unwrap();
    switched(&family, first, range, levels, &options, &task).unwrap()
}

/// From the flip of the motion with one impact in a period of a linear oscillator begins that of two impacts
/// in two periods, which a run settles to; it doubles its period where the branch from such a run does.
#[test]
fn a_flip_leads_to_the_motions_of_twice_the_period() {
    let mut random = Noise::new(44);
    for _ in 0..6 {
        let (w, e) = (random.between(0.69, 0.72), random.between(0.7, 0.85));
        let oscillator = OneStop { w, e, damping: 0.2, mirrored: false };
        let (_, flip) = oscillator.critical(-1.0);
        let scene = changed(
            "impact-oscillator",
            &[
                &format!("excitation.frequency_hz={:?}", w / std::f64::consts::TAU),
                &format!("stops.restitution_right={e:?}"),
                &format!("excitation.amplitude_g={:?}", 1.01 * flip),
            ],
        );
        let all = followed(&scene, (1.01 * flip, 0.995 * flip), 1);
        assert_eq!(all.len(), 2, "{oscillator:?}");
        let doubled = &all[1];
        assert!(doubled.orbits.iter().all(|orbit| orbit.period == 2));
        // its multipliers have the product of two impacts in two periods
        let product = oscillator.determinant().powi(2);
        for orbit in doubled.orbits.iter().filter(|orbit| orbit.passage.impacts == 2) {
            near(orbit.determinant(), product, 1e-14);
        }
        // it begins at the flip, on the side where the motion of one period is unstable
        near_relative(doubled.values[0], flip, 1e-3);
        assert!(doubled.values[0] < flip && doubled.orbits[0].is_stable());
        let later = 0.9975 * flip;
        let scene = changed(
            "impact-oscillator",
            &[
                &format!("excitation.frequency_hz={:?}", w / std::f64::consts::TAU),
                &format!("stops.restitution_right={e:?}"),
                &format!("excitation.amplitude_g={later:?}"),
            ],
        );
        let known = over_amplitude(&scene, (later, 0.995 * flip), Some(2));
        let (here, there) = (at(doubled, BranchEvent::Flip), at(&known, BranchEvent::Flip));
        assert_eq!(here.is_empty(), there.is_empty());
        for (a, b) in here.iter().zip(&there) {
            near_relative(*a, *b, 1e-9);
        }
    }
}

/// Levels follow a cascade: each branch has twice the period of that it began on, and the flips come nearer
/// by Feigenbaum's ratio for a bouncing ball.
#[test]
fn levels_follow_a_cascade_of_doublings() {
    let ball = Ball { e: 0.5, frequency: 5.0 };
    let a = 0.5 * (ball.pace() + ball.flip());
    let all = followed(&ball.document(a), (a, 1.3 * ball.flip()), 3);
    let flips: Vec<f64> = (0..4)
        .filter_map(|level| {
            let of_period = all.iter().filter(|branch| branch.orbits[0].period == 1 << level);
            of_period
                .flat_map(|branch| at(branch, BranchEvent::Flip))
                .find(|value| *value > 0.9 * ball.flip())
        })
        .collect();
    near_relative(flips[0], ball.flip(), 1e-8);
    assert_eq!(flips.len(), 4, "{flips:?}");
    let ratios: Vec<f64> =
        flips.windows(3).map(|three| (three[1] - three[0]) / (three[2] - three[1])).collect();
    assert!(ratios.iter().all(|ratio| (3.5..6.0).contains(ratio)), "{ratios:?}");
    let table = branches_table(&all);
    assert_eq!(table.columns()[0].name, "branch");
    assert_eq!(table.rows(), all.iter().map(|branch| branch.values.len()).sum::<usize>());
}

/// In a wide range the doublings of a Duffing oscillator follow each other as in one that is cut to them.
#[test]
fn doublings_are_followed_whatever_the_range() {
    let of_each = [(0.034, 0.0368), (0.028, 0.05)].map(|range| {
        let all = followed(&Document::load("duffing-cascade").unwrap(), range, 3);
        let flips = |level: u32| {
            let of_period = all.iter().filter(move |branch| branch.orbits[0].period == 1 << level);
            of_period.flat_map(|branch| at(branch, BranchEvent::Flip)).reduce(f64::min)
        };
        (0..4).map(|level| flips(level).unwrap()).collect::<Vec<f64>>()
    });
    of_each[0].iter().zip(&of_each[1]).for_each(|(one, other)| near_relative(*one, *other, 1e-9));
    let last: Vec<f64> = of_each[0].windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!((last[1] / last[2] - 4.669_201_609).abs() < 0.1, "{of_each:?}");
}

/// Without a number it is one level, whatever option follows.
#[test]
fn a_switch_without_a_number_is_one_level() {
    let line = "orbit impact-oscillator --branch excitation.amplitude_g=0.056:0.0545 --switch";
    let one = stdout(&format!("{line} --quiet"));
    assert_eq!(one, stdout(&format!("{line} 1 --quiet")));
    assert!(one.starts_with("branch,amplitude_g,period,") && one.lines().any(|row| row.starts_with("2,")));
}

/// A Duffing oscillator breaks its symmetry: the motions that are not their own mirror images begin there,
/// agree with a run, and lead back to the symmetric ones from the other side.
#[test]
fn a_breaking_of_the_symmetry_leads_to_motions_without_it() {
    let scene = |amplitude: f64, x_mm: f64| {
        document(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1, 0, 1]), \
             damping: Coefficient(c_n_s_per_m: 0.1), start: At(x_mm: {x_mm:?}, v_m_per_s: 0), \
             excitation: Sine(frequency_hz: 0.1, amplitude_g: {amplitude:?}), \
             run: (duration_s: 3000, settle_s: 2800)"
        ))
    };
    let all = followed(&scene(0.5, 0.0), (0.5, 0.8), 1);
    let broken = at(&all[0], BranchEvent::Symmetry);
    assert!(!broken.is_empty());
    let asymmetric: Vec<&BranchAnswer> = all[1..].iter().collect();
    assert!(!asymmetric.is_empty());
    near_relative(asymmetric[0].values[0], broken[0], 1e-2);
    for branch in &asymmetric {
        let is_broken = |orbit: &interwell_studies::study::OrbitAnswer| {
            let [first, _] = two(orbit);
            orbit.period == 1 && first.re.is_finite()
        };
        assert!(branch.orbits.iter().all(is_broken));
    }
    // from a motion without symmetry, the switch at its event leads to both sides of the symmetric ones
    let middle = asymmetric[0].values[asymmetric[0].values.len() / 2];
    let place = asymmetric[0].values.len() / 2;
    let start = asymmetric[0].orbits[place].state;
    let mut there = scene(middle, 1e3 * start.x);
    there.assign("start.v_m_per_s", &start.v.to_string(), "start").unwrap();
    let back = followed(&there, (middle, 0.5), 1);
    if let Some(value) = at(&back[0], BranchEvent::Symmetry).first() {
        near_relative(*value, broken[0], 1e-8);
        assert!(back.len() >= 2);
    }
}

/// A branch of motions of two periods that comes back to those of one ends there, at the flip of these.
#[test]
fn a_doubled_branch_ends_where_it_joins() {
    let oscillator = OneStop { w: 0.7, e: 0.8, damping: 0.2, mirrored: false };
    let (_, flip) = oscillator.critical(-1.0);
    let scene = changed("impact-oscillator", &["excitation.amplitude_g=0.0549"]);
    let found = over_amplitude(&scene, (0.0549, 0.056), Some(2));
    assert_eq!(found.end, BranchEnd::Joined);
    assert_eq!(found.events.last(), Some(&Some(BranchEvent::Flip)));
    near_relative(found.values[found.values.len() - 1], flip, 1e-9);
    assert_eq!(found.orbits[found.orbits.len() - 1].period, 1);
}
