//! Links to scenes: what they hold, how short they are, and what a broken one says.

use interwell::scene::{Document, Files, PRESETS, is_link, linked_lesson};
use proptest::prelude::*;

/// The scene of a link, checked.
fn opened(link: &str) -> Document {
    let document = Document::load(link).unwrap();
    document.check().unwrap();
    document
}

#[test]
fn every_preset_has_a_link_of_its_name() {
    for preset in PRESETS {
        let document = Document::preset(preset.name).unwrap();
        let link = document.link().unwrap();
        assert_eq!(link, format!("?scene={}", preset.name));
        assert_eq!(opened(&link).scene, document.scene);
        assert_eq!(opened(&format!("https://example.org/interwell/{link}")).scene, document.scene);
    }
}

#[test]
fn ten_changed_fields_make_a_link_that_a_person_can_send() {
    let mut document = Document::preset("paper").unwrap();
    for change in [
        "mass_g=17.35",
        "mechanism.preload_mm=2.613",
        "mechanism.parallel.length_mm=27.5",
        "mechanism.buckling.width_mm=7.1",
        "damping.xi=0.0312",
        "stops.travel_limit_mm=2.345",
        "stops.restitution=0.417",
        "excitation.frequency_hz=3.75",
        "excitation.amplitude_g=1.125",
        "run.tolerance=1e-9",
    ] {
        document.set(change).unwrap();
    }
    let link = document.link().unwrap();
    assert!(link.len() < 300, "{} characters: {link}", link.len());
    assert_eq!(opened(&link).scene, document.scene);
}

#[test]
fn a_scene_of_a_file_goes_with_its_table() {
    let folder = tempfile::tempdir().unwrap();
    let table: String =
        (0..40).map(|i| (f64::from(i) - 19.5) * 4e-4).fold("x_m,force_n\n".into(), |text, x| {
            text + &format!("{x},{}\n", -40.0 * x + 816_326.5 * x.powi(3))
        });
    std::fs::write(folder.path().join("pull.csv"), &table).unwrap();
    let scene = "(title: \"Pulled\", mass_g: 15.2, mechanism: Table(path: \"pull.csv\", tolerance: 1e-3),
        excitation: Sine(frequency_hz: 3, amplitude_g: 0.5), run: (duration_s: 5))";
    let path = folder.path().join("mine.ron");
    std::fs::write(&path, scene).unwrap();
    let document = Document::from_file(&path).unwrap();
    let link = document.link().unwrap();
    drop(folder);
    let opened = opened(&link);
    assert_eq!(opened.scene, document.scene);
    assert_eq!(opened.files.read("pull.csv").unwrap(), table);
}

#[test]
fn a_large_table_and_a_missing_one_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "(mass_g: 1, mechanism: Table(path: \"pull.csv\"), run: (duration_s: 5))";
    let document = Document::from_text("a.ron", scene, Files::beside(&folder.path().join("a.ron"))).unwrap();
    assert!(document.link().unwrap_err().to_string().contains("no such file"));
    std::fs::write(folder.path().join("pull.csv"), "0,0\n".repeat(3000)).unwrap();
    let error = document.link().unwrap_err().to_string();
    assert!(error.contains("pull.csv has 12000 bytes") && error.contains("8192"), "{error}");
}

#[test]
fn a_broken_link_is_one_sentence() {
    let mut document = Document::preset("paper").unwrap();
    document.set("mass_g=17").unwrap();
    let link = document.link().unwrap();
    let said = |link: &str| Document::load(link).unwrap_err().to_string();
    assert!(said("?scene=").contains("it names no scene"));
    assert!(said("?scene=papre").contains("paper"));
    assert!(said(&link[..link.len() - 2]).contains("copy the whole link"));
    assert!(said("?lesson=1").contains("it opens no scene"));
    assert!(said(&format!("?scene=paper#{}", "A".repeat(1 << 17))).contains("longer than"));
    assert!(said(&"?scene=".repeat(9000)).lines().count() == 1);
    for link in ["paper", "mine.ron", "./a?b.ron", "what?", "a?scene"] {
        assert!(!is_link(link), "{link}");
    }
    assert_eq!(linked_lesson("https://example.org/?lesson=02-shake-it-over"), Some("02-shake-it-over"));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    /// A link with other characters opens a scene or is refused; it never panics.
    #[test]
    fn a_damaged_link_harms_nothing(
        at in 0_usize..200,
        put in "[ -~]{0,3}",
        payload in "[A-Za-z0-9_-]{0,90}",
    ) {
        let mut document = Document::preset("paper").unwrap();
        document.set("stops=Rigid(travel_limit_mm: 1.25, restitution: 0.5)").unwrap();
        let mut link = document.link().unwrap();
        let at = at.min(link.len());
        link.replace_range(at..(at + 1).min(link.len()), &put);
        for link in [link, format!("?scene=paper#{payload}")] {
            match Document::of_argument(&link) {
                Ok(document) => drop(document.check()),
                Err(error) => prop_assert!(!error.to_string().is_empty()),
            }
        }
    }
}
