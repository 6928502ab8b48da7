//! The prototype with a coil and a load.

use super::*;

/// The mean power into the load in mW of a motion that has settled.
fn load(summary: &Summary) -> f64 {
    assert_eq!(summary.settled, Some(true));
    1e3 * summary.harvest.unwrap().mean_load_power.unwrap()
}

pub fn harvester(text: &mut Text) {
    let at = |changes: &[&str]| settled("harvester", changes);
    let summary = at(&[]);
    crosses(&summary);
    let harvest = summary.harvest.unwrap();
    let (coil, share) = (1e3 * harvest.mean_coil_power.unwrap(), 100.0 * harvest.load_share.unwrap());
    text.says(&format!("a load of 60 ohm takes {:.3} mW, {share:.1} % of the work", load(&summary)));
    text.says(&format!(
        "the coil takes {coil:.3} mW, and impacts take {:.0} %",
        100.0 * summary.impact_share.unwrap()
    ));
    // the same share from powers: the rest of the work goes into the coil, the impacts and the damping
    near(coil / load(&summary), 40.0 / 60.0, 1e-12);
    let with = |ohm: &str| at(&[&format!("transducer.load_ohm={ohm}")]);
    let powers: Vec<f64> = (40..=55).map(|ohm| load(&with(&ohm.to_string()))).collect();
    let most = powers.iter().copied().fold(0.0, f64::max);
    let best = 40 + powers.iter().position(|power| *power == most).unwrap();
    text.says(&format!("The load takes most, {most:.3} mW, at {best} ohm"));
    let [short, open] = ["0", "inf"].map(with);
    assert_eq!((load(&short), load(&open)), (0.0, 0.0));
    text.says(&format!(
        "the RMS velocity is {:.1} mm/s with the one and {:.1} mm/s with the other",
        rms(&short),
        rms(&open)
    ));
    let wider = at(&["stops.travel_limit_mm=1.95"]);
    crosses(&wider);
    text.says(&format!("Stops at 1.95 mm give {:.3} mW", load(&wider)));
    let free = at(&["stops=None"]);
    assert_eq!((free.regime, free.total_crossings), (Regime::Intrawell, 0));
    text.says(&format!("the load takes {:.3} mW", load(&free)));
}
