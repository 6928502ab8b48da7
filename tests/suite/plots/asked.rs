//! Options of a picture: quantity, ranges, times, size, title.

use super::{SMALL_MAP, pixels, plot, says, texts};

const SHORT: &str = "--set run.settle_s=None --set run.duration_s=1";

#[test]
fn the_footer_says_what_arguments_changed() {
    let texts = says(
        "simulate --set mass_g=14 --set stops.travel_limit_mm=2 --set mass_g=16 --tolerance 1e-6",
        &["built-in paper \u{b7} tolerance 1e-6 \u{b7} stops.travel_limit_mm=2 \u{b7} mass_g=16"],
    );
    assert!(!texts.iter().any(|text| text.contains("mass_g=14")), "{texts:?}");
    says("curve --set stops=None", &["\u{b7} stops=None"]);
}

#[test]
fn any_column_of_numbers_can_be_shown_and_the_regime() {
    says(
        &format!("{SMALL_MAP} --quantity max_abs_x_m"),
        &["reach (mm)", "travel limit (mm)", "first crossing"],
    );
    // a mass at rest is told from one with few impacts
    let impacts = says(&format!("{SMALL_MAP} --quantity impacts"), &["impacts", "at rest"]);
    assert!(!impacts.iter().any(|text| text.contains("RMS")), "{impacts:?}");
    let regimes = says(&format!("{SMALL_MAP} --quantity regime"), &["at rest", "interwell"]);
    assert!(!regimes.iter().any(|text| text == "regime" || text.contains("RMS")), "{regimes:?}");
    let line = format!("sweep {SHORT} --over excitation.amplitude_g=0,1,2");
    says(&format!("{line} --quantity crossings"), &["crossings", "amplitude (g)"]);
    says(&format!("{line} --quantity regime"), &["regime", "irregular"]);
    // whether or not it is written
    for (name, word) in [("outcome", "done"), ("side", "both"), ("settled", "not settled")] {
        says(&format!("{line} --quantity {name}"), &[name, word]);
    }
    says(&format!("{SMALL_MAP} --quantity side"), &["right", "both", "first crossing"]);
    says(&format!("{line} --quantity travel_m"), &["travel (mm)"]);
}

#[test]
fn a_field_of_few_values_is_drawn_as_lines() {
    let lines =
        format!("sweep {SHORT} --over stops.travel_limit_mm=1,2,3 --over excitation.amplitude_g=0:2:0.2");
    let along = says(
        &lines,
        &["travel limit 1 mm", "2 mm", "3 mm", "amplitude (g)", "RMS velocity (mm/s)", "at rest"],
    );
    assert!(!along.iter().any(|text| text == "travel limit (mm)"), "{along:?}");
    // Whichever stands first.
    says(
        &format!("sweep {SHORT} --over excitation.amplitude_g=0:2:0.2 --over stops.travel_limit_mm=2,1"),
        &["travel limit 1 mm", "2 mm", "amplitude (g)"],
    );
    says(SMALL_MAP, &["travel limit (mm)"]);
}

/// Lines of the colour in which a sweep over one field is drawn.
fn joined(line: &str) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let svg = std::fs::read_to_string(plot(line, folder.path(), "a.svg")).unwrap();
    let paths = svg.lines().filter(|line| line.contains("fill=\"none\" stroke=\"#5a5a5a\" "));
    paths.map(|path| path.matches('M').count()).sum()
}

#[test]
fn seeds_are_not_joined() {
    let line = "sweep random-shaking --set run.duration_s=2 --set run.settle_s=None --over";
    assert_eq!(joined(&format!("{line} excitation.seed=1,2,3")), 0);
    assert_eq!(joined(&format!("{line} excitation.rms_g=0.1,0.5,1")), 1);
}

#[test]
fn the_first_crossing_parts_a_map_of_frequencies() {
    let line = "sweep paper-unconstrained --set run.duration_s=6 --set run.settle_s=3 --tolerance 1e-6 \
                --over excitation.frequency_hz=1:13:2 --over excitation.amplitude_g=0.5:3:0.125";
    says(line, &["frequency (Hz)", "first crossing"]);
    // from one frequency to the next it moves by a few cells, and does not run up and down the whole map
    let csv = crate::cli::stdout(&format!("{line} --quiet"));
    let mut least = std::collections::BTreeMap::new();
    for row in csv.lines().skip(1).map(|row| row.split(',').collect::<Vec<_>>()) {
        if ["interwell", "irregular"].contains(&row[3]) {
            let (frequency, amplitude): (f64, f64) = (row[0].parse().unwrap(), row[1].parse().unwrap());
            let kept = least.entry(frequency as u32).or_insert(amplitude);
            *kept = kept.min(amplitude);
        }
    }
    let all: Vec<f64> = least.into_values().collect();
    assert!(all.len() == 7 && all.windows(2).all(|pair| (pair[0] - pair[1]).abs() <= 0.3), "{all:?}");
}

#[test]
fn a_picture_has_the_size_that_was_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for (size, wanted) in [
        ("--plot-size 800x500", (800, 500)),
        ("--plot-size 601X900 --no-title", (601, 900)),
        ("--no-title", (1600, 830)),
    ] {
        let line = format!("simulate {SHORT} {size}");
        let (width, height, _) = pixels(&plot(&line, folder.path(), "a.png"));
        assert_eq!((width, height), wanted);
        let svg = std::fs::read_to_string(plot(&line, folder.path(), "a.svg")).unwrap();
        assert!(svg.contains(&format!("width=\"{width}\" height=\"{height}\"")), "{}", &svg[..200]);
    }
    // Half the size is the same picture, point by point the mean.
    let whole = pixels(&plot("curve", folder.path(), "b.png")).2;
    let half = pixels(&plot("curve --plot-size 800x500", folder.path(), "c.png")).2;
    let dark = |pixels: &[u8]| pixels.iter().filter(|byte| **byte < 128).count() as f64 / pixels.len() as f64;
    assert!((dark(&half) / dark(&whole) - 1.0).abs() < 0.2, "{} {}", dark(&half), dark(&whole));
    let bare = texts(&plot("curve --no-title", folder.path(), "d.svg"));
    assert!(
        !bare.iter().any(|text| text.contains("Prototype")
            || text.contains("interwell")
            || text.contains("wells at"))
    );
    assert!(
        bare.iter().any(|text| text == "displacement (mm)") && bare.iter().any(|text| text == "stop"),
        "{bare:?}"
    );
}

#[test]
fn axes_have_the_ranges_that_were_asked_for() {
    let texts = says("curve --plot-x 0:4 --plot-y -1:1", &["0.5", "1.0", "4"]);
    assert!(!texts.iter().any(|text| text == "5" || text == "\u{2212}5"), "{texts:?}");
    let texts = says(&format!("{SMALL_MAP} --plot-x 2:3 --plot-y 0.5:1"), &["2.2", "3.0", "0.6", "1.0"]);
    assert!(!texts.iter().any(|text| text == "7" || text == "2.0 "), "{texts:?}");
}

#[test]
fn a_run_is_drawn_over_the_times_that_were_asked_for() {
    let line = "simulate --set run.settle_s=None --set run.duration_s=4";
    says(
        &format!("{line} --plot-time 1:2 --plot-y -4:4"),
        &["1.0", "1.2", "2.0", "phase portrait, 1 to 2 s", "\u{2212}4"],
    );
    let folder = tempfile::tempdir().unwrap();
    let bytes = |line: &str| pixels(&plot(line, folder.path(), "a.png")).2;
    let window = bytes(&format!("{line} --plot-time 1:2"));
    assert!(window != bytes(line));
    // The times that are listed span it; the steps of --dt are those of the rows.
    assert!(window == bytes(&format!("{line} --at 1.5,2,1")));
    assert!(window == bytes(&format!("{line} --plot-time 1:2 --dt 0.5")));
    // A run that ends before its window shows what there is.
    let early = "simulate --set stops=None --set start=At(x_mm:7,v_m_per_s:900) --plot-time 1:2";
    says(early, &["ended early"]);
}

#[test]
fn a_picture_of_a_run_has_the_numbers_of_the_times_that_it_shows() {
    let account = |line: &str, words: &[&str]| {
        let texts = says(line, words);
        let number = |text: &String| text.contains("RMS velocity") || text.ends_with("impacts");
        let settled = texts.iter().any(|text| text.starts_with("settled"));
        (settled, texts.iter().filter(|text| number(text)).count())
    };
    // a motion that repeats: its averages hold at any time from then on, its counts are those of the window
    let paper = "simulate paper";
    let all = ["settled, from 5 s on:", "RMS velocity 49.49 mm/s", "30 crossings, 390 impacts", "interwell"];
    assert_eq!(account(paper, &all), (true, 2));
    assert_eq!(account(&format!("{paper} --plot-time 4:10"), &all), (true, 2));
    let some = ["settled, from 5 s on:", "RMS velocity 49.49 mm/s", "interwell"];
    assert_eq!(account(&format!("{paper} --plot-time 6:7"), &some), (true, 1));
    assert_eq!(account(&format!("{paper} --plot-time 3:7"), &["from 3 to 7 s"]), (false, 0));
    // under an excitation that changes nothing settles
    assert_eq!(account("simulate paper-ramp", &["from 120 to 300 s:", "RMS velocity"]), (false, 2));
    assert_eq!(account("simulate paper-ramp --plot-time 106:109", &["from 106 to 109 s"]), (false, 0));
    assert_eq!(account("simulate paper-ramp --plot-time 200:300", &["from 200 to 300 s"]), (false, 0));
    // and what does not repeat has not settled
    let free = "simulate paper-unconstrained --set excitation.amplitude_g=1.5";
    assert_eq!(account(free, &["irregular: crosses without a period", " s:"]), (false, 2));
}

#[test]
fn the_push_of_a_well_has_the_direction_of_a_constant_drive() {
    let well = |set: &str, words: &str| {
        says(&format!("curve paper --set excitation={set} > --well-plot"), &[words]);
    };
    well("Constant(accel_g:-0.4)", "N to the right (as at a base acceleration of \u{2212}0.4 g)");
    well("Constant(accel_g:0.4)", "N to the left (as at a base acceleration of 0.4 g)");
    well("None", "no push");
    // the base rests, and the force on the mass is as large as this push
    let force = "Force(amplitude_n:0.1,frequency_rad_per_s:18.8)";
    well(force, "pushed by 0.1 N to the left (as at a base acceleration of");
}
