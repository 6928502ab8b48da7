//! Pictures of spectra and thresholds.

use super::*;

#[test]
fn a_spectrum_shows_lines_and_the_forcing() {
    let folder = tempfile::tempdir().unwrap();
    let own = texts(&plot("spectrum paper", folder.path(), "lines.svg"));
    for words in ["Prototype with travel limits", "frequency (Hz)", "amplitude of displacement (m)"] {
        assert!(own.iter().any(|own| own == words), "{words}: {own:?}");
    }
    assert!(own.iter().any(|own| own == "forcing frequency, 3 Hz"), "{own:?}");
    let line = "spectrum random-shaking --of accel --quantity psd --rate-hz 100 --dark";
    let own = texts(&plot(line, folder.path(), "noise.svg"));
    assert!(own.join(" ").contains("power spectral density of base acceleration (m"), "{own:?}");
    assert!(!own.iter().any(|own| own.starts_with("forcing frequenc")), "{own:?}");
    // at rest there is nothing to see, and nothing fails
    let rest = plot("spectrum paper --set excitation.amplitude_g=0", folder.path(), "rest.png");
    assert_eq!(pixels(&rest).0, 1600);
    let asked = plot("spectrum paper --plot-x 0:30 --plot-y 1e-5:1e-2", folder.path(), "asked.svg");
    assert!(texts(&asked).iter().any(|own| own == "30"));
}

#[test]
fn thresholds_are_lines_and_maps() {
    let folder = tempfile::tempdir().unwrap();
    let release = "threshold paper --of release --over stops.travel_limit_mm=1:6:0.5";
    let own = texts(&plot(release, folder.path(), "line.svg"));
    for words in ["travel limit (mm)", "least amplitude (g)"] {
        assert!(own.iter().any(|own| own == words), "{words}: {own:?}");
    }
    let own = texts(&plot(&format!("{release} --over mass_g=14,15"), folder.path(), "lines.svg"));
    assert!(own.iter().any(|own| own == "mass 14 g") && own.iter().any(|own| own == "15 g"), "{own:?}");
    let own = texts(&plot(&format!("{release} --over mass_g=10:20:1"), folder.path(), "map.svg"));
    assert!(own.iter().any(|own| own == "mass (g)") && own.iter().any(|own| own == "least amplitude (g)"));
    let gone = "threshold paper --field excitation.amplitude_g=0:1 --of release --over \
                stops.travel_limit_mm=1:6:0.5";
    let own = texts(&plot(gone, folder.path(), "gone.svg"));
    assert!(own.iter().any(|own| own == "none in the range"), "{own:?}");
    // so soon no value is known not to cross: a bar from the lower edge
    let open = "threshold paper-unconstrained --field excitation.amplitude_g=1.12:1.2:0.02 --until-settled \
                30 --over mass_g=15,15.2,15.4";
    assert_eq!(column(&stdout(&format!("{open} --quiet")), "low"), ["", "", ""]);
    let words = texts(&plot(open, folder.path(), "open.svg"));
    assert!(words.iter().any(|word| word == "undecided between"), "{words:?}");
}
