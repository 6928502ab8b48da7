//! Figures of views: what is saved, by the command that is copied the same bytes, what is refused.

use std::fs;
use std::path::Path;

use eframe::egui::{Key, Modifiers, accesskit::Role};
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::session::explore::WalkQuantity;
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::output::RunPanel;
use interwell::scene::Layout;
use interwell_studies::study::Signal;
use interwell_studies::study::SummaryField;

use crate::measured::{dropped, instrument};
use crate::shared::axis;
use crate::support::{
    PROJECTED, WIDE, choose_in_map, command, press, press_with_ctrl, sliced, wait_until, window,
};
use crate::written::{arguments, copied};

fn open(harness: &mut Harness<'static, Window>, view: View, path: &Path) {
    command(harness, Command::Figure(Some(view)));
    harness.state_mut().figures.path = path.display().to_string();
    harness.run_steps(2);
}

#[test]
fn a_figure_is_of_a_view_that_is_seen() {
    let mut harness = window("paper", WIDE);
    let place = harness.state().tiling.place_of(View::Displacement).unwrap();
    harness.hover_at(place.center());
    harness.run_steps(2);
    command(&mut harness, Command::Arrange(Layout::Map));
    harness.run_steps(2);
    command(&mut harness, Command::Figure(None));
    let path = &harness.state().figures.path;
    assert!(path.ends_with("paper-map.pdf") || path.ends_with("paper-well.pdf"), "{path}");
}

#[test]
fn a_figure_has_the_size_of_a_column_or_of_a_slide() {
    let mut harness = window("first-look", WIDE);
    let folder = tempfile::tempdir().unwrap();
    open(&mut harness, View::Well, &folder.path().join("well.png"));
    for (size, expected) in [("for a slide", ["240", "18"]), ("for a column", ["85", "8"])] {
        harness.get_by_label(size).click();
        harness.run_steps(2);
        let figures = &harness.state().figures;
        assert_eq!([&figures.width, &figures.font], expected);
        assert!(
            copy(&mut harness)
                .contains(&format!("--plot-width-mm {} --font-pt {}", expected[0], expected[1]))
        );
    }
    harness.get_by_label("for a slide").click();
    harness.run_steps(2);
    save(&mut harness);
}

fn press_button(harness: &mut Harness<'static, Window>, button: &str) {
    harness.get_by_role_and_label(Role::Button, button).click();
    harness.run_steps(2);
}

/// Presses Save and waits until the dialog is gone, as it is once the files are there.
fn save(harness: &mut Harness<'static, Window>) {
    press_button(harness, "Save");
    wait_until("the figure", || {
        harness.run_steps(1);
        assert_eq!(harness.state().figures.problem, None);
        harness.query_by_label("Save a figure").is_none()
    });
    assert!(harness.state().notice().is_some_and(|text| text.starts_with("Saved ")));
}

/// The command line that the open dialog copies.
fn copy(harness: &mut Harness<'static, Window>) -> String {
    harness.get_by_role_and_label(Role::Button, "Copy as command").click();
    harness.step();
    if copied(harness).is_none() {
        harness.step();
    }
    let line = copied(harness).unwrap();
    harness.run_steps(2);
    line
}

/// Saves the figure of a view with its numbers, runs the command that was copied, and compares the bytes; the
/// command.
fn same_bytes(harness: &mut Harness<'static, Window>, view: View, kind: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str, ending: &str| folder.path().join(format!("{name}.{ending}"));
    open(harness, view, &place("own", kind));
    harness.state_mut().figures.data = true;
    harness.run_steps(1);
    let line = copy(harness);
    save(harness);
    for ending in [kind, "csv"] {
        fs::rename(place("own", ending), place("window", ending)).unwrap();
    }
    let ran = assert_cmd::Command::cargo_bin("interwell").unwrap().args(arguments(&line)).output().unwrap();
    assert!(
        ran.status.success() && ran.stdout.is_empty(),
        "{line}: {}",
        String::from_utf8_lossy(&ran.stderr)
    );
    for ending in [kind, "csv"] {
        let [drawn, window] = ["own", "window"].map(|name| fs::read(place(name, ending)).unwrap());
        assert!(drawn.len() > 60, "{line}");
        assert!(drawn == window, "{line}: {} and {} bytes of {ending} differ", drawn.len(), window.len());
    }
    line
}

#[test]
fn of_a_run_and_of_the_force_curve_the_copied_command_makes_the_same_bytes() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.edit_once(|scene| {
        scene.mass_g = 16.0;
        (scene.run.duration_s, scene.run.settle_s) = (3.0, Some(1.0));
    });
    harness.run_steps(3);
    harness.state_mut().session.restart();
    for kind in ["pdf", "svg", "png"] {
        let line = same_bytes(&mut harness, View::ForceCurve, kind);
        assert!(line.contains("headless curve first-look") && line.contains("--set mass_g=16"), "{line}");
    }
    harness.state_mut().figures.titled = false;
    for (view, panel) in
        [(View::Displacement, "displacement"), (View::Power, "power"), (View::PhasePortrait, "portrait")]
    {
        let line = same_bytes(&mut harness, view, "svg");
        assert!(line.contains(&format!("--panels {panel}")), "{line}");
        assert!(line.contains("simulate first-look") && line.contains("--no-title"), "{line}");
        assert!(line.contains("--set run.duration_s=3"), "{line}");
    }
    let line = same_bytes(&mut harness, View::Section, "pdf");
    assert!(line.contains("section first-look"), "{line}");
}

#[test]
fn a_run_is_drawn_over_the_times_that_are_typed_and_is_as_long_as_they_ask() {
    let mut harness = window("first-look", WIDE);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.svg");
    open(&mut harness, View::Velocity, &path);
    let long = harness.state().session.scene().run.duration_s;
    harness.state_mut().figures.times = ["0.5".to_owned(), (long + 1.0).to_string()];
    harness.run_steps(1);
    let line = copy(&mut harness);
    let times = format!("--plot-x 0.5:{}", long + 1.0);
    assert!(line.contains(&times) && line.contains(&format!("run.duration_s={}", long + 1.0)), "{line}");
    assert!(line.contains("--panels velocity ") && line.matches("--panels").count() == 1, "{line}");
    // several views in one file; all of them have no need to be named
    harness.state_mut().figures.panels[0] = true;
    harness.run_steps(1);
    assert!(copy(&mut harness).contains("--panels displacement --panels velocity "));
    harness.state_mut().figures.panels = RunPanel::ALL.map(|panel| RunPanel::USUAL.contains(&panel));
    harness.run_steps(1);
    assert!(!copy(&mut harness).contains("--panels"));
    harness.state_mut().figures.panels = [false; RunPanel::ALL.len()];
    harness.run_steps(1);
    harness.get_by_label_contains("at least one is needed");
    harness.state_mut().figures.panels = [true; RunPanel::ALL.len()];
    harness.state_mut().figures.times = ["2".to_owned(), "1".to_owned()];
    harness.run_steps(1);
    harness.get_by_label_contains("give two in s, the first one below the second");
}

#[test]
fn of_every_view_of_a_survey_the_copied_command_makes_the_same_bytes() {
    let mut harness = window("paper", WIDE);
    let amplitude = axis("excitation.amplitude_g", (0.6, 1.0, 0.2));
    let limit = axis("stops.travel_limit_mm", (1.0, 2.0, 0.5));
    {
        let session = &mut harness.state_mut().session;
        session.edit_once(|scene| (scene.run.duration_s, scene.run.settle_s) = (6.0, Some(3.0)));
        session.map.choose(Some([limit, amplitude.clone()]));
        session.explore.walks.chosen = Some(amplitude);
        session.explore.spectra.signal = Signal::Velocity;
    }
    harness.run_steps(3);
    let line = same_bytes(&mut harness, View::Map, "svg");
    assert!(line.contains("--over stops.travel_limit_mm=1:2:0.5 --over excitation.amplitude_g=0.6:1:0.2"));
    assert!(line.contains("--quantity rms_velocity_m_per_s"), "{line}");
    command(&mut harness, Command::Arrange(Layout::Map));
    choose_in_map(&mut harness, "Surface");
    harness.run_steps(3);
    let column = SummaryField::find("impact_share").unwrap();
    harness.state_mut().session.map.show(column);
    let line = same_bytes(&mut harness, View::Map, "svg");
    assert!(line.contains("--quantity impact_share --surface"), "{line}");
    wait_until("the map", || {
        harness.run_steps(1);
        harness.state().session.map.map().is_some_and(|map| map.is_whole())
    });
    for label in ["Flat", "Cuts"] {
        choose_in_map(&mut harness, label);
        harness.run_steps(3);
    }
    let line = same_bytes(&mut harness, View::Map, "svg");
    assert!(line.contains("--cut amplitude_g=1 --cut travel_limit_mm=1.5"), "{line}");
    harness.state_mut().session.explore.walks.quantity = WalkQuantity::Strobes;
    let line = same_bytes(&mut harness, View::UpAndDown, "svg");
    assert!(line.contains("section paper") && line.contains("--carry both"), "{line}");
    harness.state_mut().session.explore.walks.quantity = WalkQuantity::RmsVelocity;
    let line = same_bytes(&mut harness, View::UpAndDown, "png");
    assert!(line.contains("sweep paper") && line.contains("--carry both"), "{line}");
    let line = same_bytes(&mut harness, View::Spectrum, "pdf");
    assert!(line.contains("--of v"), "{line}");
}

#[test]
fn of_the_mechanism_and_its_energy_the_copied_command_makes_the_same_bytes() {
    let mut harness = window("paper", WIDE);
    let line = same_bytes(&mut harness, View::Energy, "svg");
    assert!(line.contains("--panels energy --panels ledger"), "{line}");
    let line = same_bytes(&mut harness, View::Mechanism, "pdf");
    assert!(line.contains("curve paper --at-mm ") && line.contains(" --mechanism-plot "), "{line}");
    let line = same_bytes(&mut harness, View::Well, "svg");
    assert!(line.contains("--base-accel-g ") && line.contains(" --well-plot "), "{line}");
    // a force without flexures, and one with magnets, a coil and its load
    for scene in ["nominal-cubic", "magnet", "harvester"] {
        same_bytes(&mut window(scene, WIDE), View::Mechanism, "svg");
    }
}

/// The picture has times of the processor, so that its bytes differ from run to run.
#[test]
fn of_the_accuracy_the_copied_command_makes_a_picture_with_the_same_lines() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.edit_once(|scene| {
        (scene.run.duration_s, scene.run.settle_s) = (1.0, None);
    });
    harness.run_steps(3);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    open(&mut harness, View::Accuracy, &path);
    let line = copy(&mut harness);
    assert!(line.contains("accuracy paper --step-s 0.0166") && line.contains("--method rk4"), "{line}");
    save(&mut harness);
    let drawn = fs::read_to_string(&path).unwrap();
    let status =
        assert_cmd::Command::cargo_bin("interwell").unwrap().args(arguments(&line)).output().unwrap();
    assert!(status.status.success(), "{line}: {}", String::from_utf8_lossy(&status.stderr));
    let again = fs::read_to_string(&path).unwrap();
    for words in ["the tolerance of the scene", "RK4 in steps of 1/60 s", "processor time (s)", "1e-9"] {
        assert!(drawn.contains(words) && again.contains(words), "{words}: {drawn}");
    }
}

#[test]
fn of_a_record_the_copied_command_makes_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = dropped(|session| instrument(session, folder.path()), WIDE);
    harness.get_by_label("Lay it over").click();
    harness.run_steps(3);
    let over = harness.state_mut().session.measured.over.as_mut().unwrap();
    (over.shift, over.offset, over.time_scale) = (-0.25, 1.25e-4, 1.001);
    let line = same_bytes(&mut harness, View::Measured, "svg");
    let options = "--shift-s -0.25 --offset-mm 0.125 --time-scale 1.001 --time 'Time [ms]' --time-unit ms \
                   --column 'Laser A [mm]' --unit mm";
    assert!(line.contains("simulate paper --measured ") && line.contains(options), "{line}");
}

#[test]
fn of_several_scenes_the_copied_command_makes_the_same_bytes() {
    let mut harness = window("nominal-cubic", WIDE);
    harness.state_mut().session.edit_once(|scene| {
        (scene.run.duration_s, scene.run.settle_s, scene.run.tolerance) = (2.0, None, 1e-6);
    });
    harness.run_steps(3);
    harness.state_mut().session.pin().unwrap();
    harness.state_mut().session.player.tick(1.0);
    harness.state_mut().session.edit_once(|scene| scene.mass_g = 16.0);
    harness.run_steps(3);
    // --set would change the other scene too
    let line = same_bytes(&mut harness, View::Compare, "svg");
    assert!(line.contains("compare '?scene=nominal-cubic#") && !line.contains("--set"), "{line}");
}

#[test]
fn of_the_basins_the_copied_command_makes_the_same_bytes() {
    let mut harness = window("uneven-stops", WIDE);
    let folder = tempfile::tempdir().unwrap();
    open(&mut harness, View::Basins, &folder.path().join("a.svg"));
    harness.get_by_label_contains("Show this view first");
    press_button(&mut harness, "Cancel");
    harness.state_mut().session.want_basins((-1e-3, 1e-3), (-0.2, 0.2));
    let line = same_bytes(&mut harness, View::Basins, "svg");
    assert!(line.contains("--x-mm -1:1:81 --v -0.2:0.2:81"), "{line}");
}

#[test]
fn each_box_of_the_dialog_is_the_panel_that_it_names() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window("harvester", WIDE);
    open(&mut harness, View::Velocity, &folder.path().join("a.svg"));
    let boxes = [
        ("displacement", "displacement"),
        ("base acceleration", "acceleration"),
        ("power", "power"),
        ("energy", "energy"),
        ("ledger", "ledger"),
        ("phase portrait", "portrait"),
    ];
    for (name, panel) in boxes {
        harness.state_mut().figures.panels = [false; RunPanel::ALL.len()];
        harness.run_steps(1);
        harness.get_by_role_and_label(Role::CheckBox, name).click();
        harness.run_steps(2);
        let line = copy(&mut harness);
        assert!(line.contains(&format!("--panels {panel} ")), "{name}: {line}");
    }
}

#[test]
fn a_view_without_a_figure_says_so_and_the_keyboard_alone_saves_one() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window("first-look", WIDE);
    let no_other = "There is no other scene yet";
    for (view, words) in [(View::Compare, no_other), (View::Events, "There is no figure of")] {
        open(&mut harness, view, &folder.path().join("a.pdf"));
        harness.get_by_label_contains(words);
        press(&mut harness, Key::Escape);
    }
    press_with_ctrl(&mut harness, Key::E);
    harness.get_by_label("Save a figure");
    // the path has the keyboard: what is typed replaces it, and Enter saves
    let path = folder.path().join("typed.svg");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(eframe::egui::Event::Text(path.display().to_string()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait_until("the figure", || {
        harness.run_steps(1);
        path.exists()
    });
    harness.run_steps(2);
    assert!(harness.query_by_label("Save a figure").is_none());
}

#[test]
fn what_cannot_be_saved_is_said_and_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window("first-look", WIDE);
    let before = harness.state().session.scene().clone();
    open(&mut harness, View::ForceCurve, &folder.path().join("a.jpeg"));
    harness.get_by_label_contains("ends in .pdf, .svg or .png");
    open(&mut harness, View::ForceCurve, &folder.path().join("no/folder/a.pdf"));
    harness.get_by_label("There is no such folder.");
    open(&mut harness, View::ForceCurve, &folder.path().join("a.pdf"));
    for (width, font, words) in [
        ("0", "8", "Width 0: give a width in mm, 40 to 2000"),
        ("85", "90", "Text 90: give a size in points, 4 to 36"),
        ("85", "30", "room for text of at most"),
    ] {
        let figures = &mut harness.state_mut().figures;
        (figures.width, figures.font) = (width.to_owned(), font.to_owned());
        harness.run_steps(2);
        harness.get_by_label_contains(words);
    }
    harness.state_mut().figures.font = "8".to_owned();
    // the numbers have no place: then the figure has none either
    fs::create_dir(folder.path().join("a.csv")).unwrap();
    harness.state_mut().figures.data = true;
    harness.run_steps(2);
    press_button(&mut harness, "Save");
    wait_until("the refusal", || {
        harness.run_steps(1);
        harness.state().figures.problem.is_some()
    });
    harness.get_by_label_contains("it is a folder");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(harness.state_mut().figures.path.ends_with("a.pdf"));
    assert_eq!(*harness.state().session.scene(), before);
    harness.state_mut().figures.data = false;
    harness.run_steps(1);
    save(&mut harness);
    assert!(folder.path().join("a.pdf").exists());
}

#[test]
fn the_numbers_of_a_figure_do_not_replace_a_table_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window("paper-table", WIDE);
    let ctx = harness.ctx.clone();
    harness.state_mut().save_to(&ctx, &folder.path().join("own.ron"));
    harness.run_steps(2);
    let files = || fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
    let table = files().find(|path| path.extension().is_some_and(|ending| ending == "csv")).unwrap();
    open(&mut harness, View::ForceCurve, &table.with_extension("svg"));
    assert!(harness.query_by_label_contains("is read by this scene").is_none());
    harness.state_mut().figures.data = true;
    harness.run_steps(2);
    harness.get_by_label_contains("is read by this scene");
    harness.get_by_role_and_label(Role::Button, "Save").click();
    harness.run_steps(3);
    assert_eq!(files().count(), 2);
}

#[test]
fn a_pasted_scene_is_saved_first_and_a_changed_file_is_not_drawn_as_another() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("own.ron");
    let mut harness = window("first-look", WIDE);
    let text = harness.state().session.editor.text().unwrap();
    harness.event(eframe::egui::Event::Paste(text.clone()));
    harness.run_steps(3);
    open(&mut harness, View::ForceCurve, &folder.path().join("a.svg"));
    harness.get_by_label_contains("save it first");
    press_button(&mut harness, "Cancel");
    let ctx = harness.ctx.clone();
    harness.state_mut().save_to(&ctx, &path);
    harness.run_steps(2);
    same_bytes(&mut harness, View::ForceCurve, "svg");
    let mass = "mass_g: ";
    let at = text.find(mass).unwrap() + mass.len();
    let end = at + text[at..].find(',').unwrap();
    fs::write(&path, format!("{}77{}", &text[..at], &text[end..])).unwrap();
    open(&mut harness, View::ForceCurve, &folder.path().join("a.svg"));
    press_button(&mut harness, "Save");
    wait_until("the refusal", || {
        harness.run_steps(1);
        harness.state().figures.problem.is_some()
    });
    harness.get_by_label_contains("has changed since it was opened");
    assert!(!folder.path().join("a.svg").exists());
}

#[test]
fn the_dialog_stands_whole_on_a_projector_too() {
    for size in [WIDE, PROJECTED] {
        let mut harness = window("first-look", size);
        open(&mut harness, View::Displacement, Path::new("/a.pdf"));
        let screen = harness.ctx.content_rect();
        for name in ["Save", "Copy as command", "Cancel"] {
            assert!(screen.contains_rect(harness.get_by_role_and_label(Role::Button, name).rect()), "{name}");
        }
        let cut = sliced(&harness);
        assert!(!cut.iter().any(|text| text.contains("figure") || text.contains("title")), "{cut:?}");
    }
}
