//! Which answers are sure: against closed forms, and against maps at other tolerances.

use super::*;

/// Random starts on lines across the stable manifold of the saddle, whose side of it is known.
#[test]
fn a_start_beside_a_border_is_sure_and_one_on_it_is_not() {
    let c = 0.1_f64;
    let document = well("damping: Coefficient(c_n_s_per_m: 0.1), run: (duration_s: 10, tolerance: 1e-9)");
    let decay = -0.5 * c - (0.25 * c * c + 1.0).sqrt();
    let border = |x: f64| decay * x - x * x * x / (4.0 * decay + c);
    let mut draw = Draw(11);
    let (mut wrong, mut marked) = (0, 0);
    for number in 0..120 {
        let x_mm = draw.between(0.5, 1.0) * [1.0, -1.0][number % 2];
        let share = 10.0_f64.powf(draw.between(-12.0, -1.0)) * [1.0, -1.0][number / 2 % 2];
        let v = border(x_mm / 1e3) * (1.0 + share);
        let (_, answer) = map(&document, (x_mm, x_mm, 1), (v, v, 1));
        let passes = (attractor(&answer, 0).states[0].0 > 0.0) != (x_mm > 0.0);
        let is_wrong = passes != (share > 0.0);
        if share.abs() > 1e-5 {
            assert!(!is_wrong && answer.sure[0], "{x_mm} {share:e}");
        }
        wrong += u32::from(is_wrong);
        marked += u32::from(is_wrong && !answer.sure[0]);
    }
    // Where the error alone decides, it decides alike at both tolerances every other time.
    assert!(wrong > 5 && 4 * marked >= wrong, "{marked} of {wrong}");
}

/// At 1.13 g without stops the basins of six attractors are finely mixed.
#[test]
fn starts_that_another_tolerance_sends_elsewhere_are_not_sure() {
    let at = |tolerance: &str| {
        let tolerance = format!("run.tolerance={tolerance}");
        let document = changed("paper-unconstrained", &["excitation.amplitude_g=1.13", &tolerance]);
        map(&document, (-8.0, 8.0, 25), (-0.8, 0.8, 17)).1
    };
    let answer = at("1e-9");
    let unsure = answer.unsure();
    assert!(unsure > 20 && unsure < 170, "{unsure} of 425");
    for other in [at("1e-8"), at("1e-10")] {
        let elsewhere = |row: &usize| {
            let [one, another] = [&answer, &other].map(|each| each.rows[*row].map(|_| attractor(each, *row)));
            let apart = |a: &Attractor, b: &Attractor| {
                a.period.is_some() && (a.states[0].0 - b.states[0].0).abs() > 2e-4
            };
            one.zip(another).is_none_or(|(a, b)| (a.regime, a.side) != (b.regime, b.side) || apart(a, b))
        };
        let moved: Vec<usize> = (0..answer.rows.len()).filter(elsewhere).collect();
        let marked = moved.iter().filter(|row| !answer.sure[**row]).count();
        assert!(moved.len() > 15 && 10 * marked >= 9 * moved.len(), "{marked} of {}", moved.len());
    }
}
