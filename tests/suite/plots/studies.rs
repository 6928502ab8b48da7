//! Pictures of spectra and thresholds.

use super::*;

#[test]
fn a_spectrum_shows_lines_and_the_forcing() {
    let folder = tempfile::tempdir().unwrap();
    let seen = texts(&plot("spectrum paper", folder.path(), "lines.svg"));
    for words in ["Prototype with travel limits", "frequency (Hz)", "amplitude of displacement (mm)"] {
        assert!(seen.iter().any(|text| text == words), "{words}: {seen:?}");
    }
    assert!(seen.iter().any(|text| text == "forcing frequency, 3 Hz"), "{seen:?}");
    let line = "spectrum random-shaking --of accel --quantity psd --rate-hz 100 --dark";
    let seen = texts(&plot(line, folder.path(), "noise.svg"));
    assert!(seen.join(" ").contains("power spectral density of base acceleration (m"), "{seen:?}");
    assert!(!seen.iter().any(|text| text.starts_with("forcing frequenc")), "{seen:?}");
    // at rest there is nothing to see, and nothing fails
    let rest = plot("spectrum paper --set excitation.amplitude_g=0", folder.path(), "rest.png");
    assert_eq!(pixels(&rest).0, 1600);
    let asked = plot("spectrum paper --plot-x 0:30 --plot-y 1e-5:1e-2", folder.path(), "asked.svg");
    assert!(texts(&asked).iter().any(|text| text == "30"));
}

#[test]
fn thresholds_are_lines_and_maps() {
    let folder = tempfile::tempdir().unwrap();
    let release = "threshold paper --of release --over stops.travel_limit_mm=1:6:0.5";
    let seen = texts(&plot(release, folder.path(), "line.svg"));
    for words in ["travel limit (mm)", "least amplitude (g)"] {
        assert!(seen.iter().any(|text| text == words), "{words}: {seen:?}");
    }
    let seen = texts(&plot(&format!("{release} --over mass_g=14,15"), folder.path(), "lines.svg"));
    assert!(
        seen.iter().any(|text| text == "mass 14 g") && seen.iter().any(|text| text == "15 g"),
        "{seen:?}"
    );
    let seen = texts(&plot(&format!("{release} --over mass_g=10:20:1"), folder.path(), "map.svg"));
    assert!(
        seen.iter().any(|text| text == "mass (g)") && seen.iter().any(|text| text == "least amplitude (g)")
    );
    let seen = texts(&plot(MELNIKOV, folder.path(), "melnikov.svg"));
    assert!(seen.iter().any(|text| text == "threshold"), "{seen:?}");
    let gone = "threshold paper --field excitation.amplitude_g=0:1 --of release --over \
                stops.travel_limit_mm=1:6:0.5";
    let seen = texts(&plot(gone, folder.path(), "gone.svg"));
    assert!(seen.iter().any(|text| text == "none in the range"), "{seen:?}");
    // so soon no value is known not to cross: a bar from the lower edge
    let open = "threshold paper-unconstrained --field excitation.amplitude_g=1.12:1.2:0.02 --until-settled \
                30 --over mass_g=15,15.2,15.4";
    assert_eq!(column(&stdout(&format!("{open} --quiet")), "low"), ["", "", ""]);
    let words = texts(&plot(open, folder.path(), "open.svg"));
    assert!(words.iter().any(|word| word == "undecided between"), "{words:?}");
}

#[test]
fn compared_scenes_have_whole_names_in_the_size_of_the_text() {
    let folder = tempfile::tempdir().unwrap();
    let name = "a-long-name-of-a-scene-about-a-prototype-of-a-study.ron";
    std::fs::copy("presets/paper.ron", folder.path().join(name)).unwrap();
    let path = folder.path().join("a.svg");
    let mut command =
        with_plot("compare paper --out /dev/null --quiet --plot-width-mm 85 --font-pt 8", &path);
    command.arg(folder.path().join(name)).assert().success();
    let svg = std::fs::read_to_string(&path).unwrap();
    let seen: Vec<String> = texts(&path);
    assert!(seen.concat().contains(name) && !seen.concat().contains('\u{2026}'), "{seen:?}");
    // 26 units of the canvas, which has 8 in each
    let of_name = svg.split("<text ").find(|text| text.contains(">a-long-")).unwrap();
    assert!(of_name.contains("font-size=\"208\""), "{of_name}");
}
