//! Measured data over the computed: opened, laid over, shifted, compared, taken as the drive.

use std::path::{Path, PathBuf};

use eframe::egui::Key;
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::session::Session;
use interwell::app::session::measured::Differences;
use interwell::app::ui::settings::Settings;
use interwell::app::views::View;
use interwell::app::window::{Command, Wanted, Window};
use interwell::scene::{Excitation, Quantity, Unit};
use interwell_studies::study::{Comparison, Keep, simulate};

use crate::support::{PROJECTED, WIDE, command, is_painted, press, sliced, wait_until, window};

/// A column of the run of the session's scene, at these times in s.
fn column(session: &Session, times: &[f64], name: &str) -> Vec<f64> {
    let keep = Keep { times: times.to_vec(), events: false, until_settled: None };
    simulate(session.model(), &keep, None).samples.numbers(name).unwrap().to_vec()
}

fn times(from: f64, step: f64, count: u32) -> Vec<f64> {
    (0..count).map(|i| from + step * f64::from(i)).collect()
}

/// A record of the displacement as an instrument writes it: in ms of a clock that began 0.25 s before the
/// run, in mm, with semicolons and decimal commas; the third of its columns is the base's acceleration in g.
pub fn instrument(session: &Session, folder: &Path) -> PathBuf {
    let times = times(0.1, 5e-4, 4000);
    let (x, base) = (column(session, &times, "x_m"), column(session, &times, "base_accel_m_per_s2"));
    let mut text = "# export\nTime [ms];Laser A [mm];Accel (g);Trigger\n".to_owned();
    for (i, t) in times.iter().enumerate() {
        let row = format!("{:.4};{:.6};{:.6};0\n", (t + 0.25) * 1e3, x[i] * 1e3, base[i] / 9.80665);
        text += &row.replace('.', ",");
    }
    let path = folder.join("laser.csv");
    std::fs::write(&path, text).unwrap();
    path
}

/// A window on the prototype, in which a file was dropped and is read.
pub fn dropped(path: impl Fn(&Session) -> PathBuf, size: [f32; 2]) -> Harness<'static, Window> {
    let mut harness = window("paper", size);
    command(&mut harness, Command::PlayPause);
    let path = path(&harness.state().session);
    let ctx = harness.ctx.clone();
    harness.state_mut().take_dropped(&ctx, &path);
    read(&mut harness);
    harness
}

fn read(harness: &mut Harness<'static, Window>) {
    wait_until("the file is read", || {
        harness.run_steps(1);
        harness.state_mut().columns.as_mut().is_none_or(|columns| columns.known().is_some())
    });
    harness.run_steps(3);
}

/// The answer of the comparison, once it is that of what is shown.
fn differences(harness: &mut Harness<'static, Window>) -> Differences {
    wait_until("the differences", || {
        harness.run_steps(2);
        harness.state().session.measured.found.is_whole()
    });
    harness.state().session.measured.found.parts().0.last().unwrap().clone().unwrap()
}

fn comparison(harness: &mut Harness<'static, Window>) -> Comparison {
    match differences(harness) {
        Differences::Motion(motion) => *motion,
        Differences::Force(_) => panic!("no motion"),
    }
}

#[test]
fn a_dropped_record_lies_over_the_displacement_and_the_shift_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = dropped(|session| instrument(session, folder.path()), WIDE);
    let known = harness.state_mut().columns.as_mut().unwrap().known().unwrap().unwrap().clone();
    assert_eq!((known.across.quantity, known.values.quantity), (Quantity::Time, Quantity::Displacement));
    assert_eq!((known.across.column.as_str(), known.values.column.as_str()), ("Time [ms]", "Laser A [mm]"));
    assert!(known.decimal_commas && known.across.values.len() == 4000);
    let how = known.describe();
    assert!(how.starts_with("4000 samples from 0.35 to ") && how.ends_with("no gaps, with decimal commas."));
    harness.get_by_label(&how);
    harness.get_by_label_contains("displacement, by its name");
    // the button has the keyboard
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert!(harness.state().columns.is_none());
    assert!(harness.state().tiling.shows(View::Measured) && is_painted(&harness, "measured"));
    let apart = comparison(&mut harness);
    assert!(apart.rms.1 > 20.0, "{:?}", apart.rms);
    harness.get_by_label_contains("Compared with the run of the scene from rest, 0 to");
    harness.get_by_label("Fit the shift").click();
    wait_until("the shift", || {
        harness.run_steps(2);
        !harness.state().session.measured.fit.is_running()
    });
    // the motion repeats, its begin does not
    let shift = harness.state().session.measured.over.as_ref().unwrap().shift;
    assert!((shift + 0.25).abs() < 1e-6, "{shift}");
    // typed to where it was recorded, the two are the same but for the digits of the file
    harness.state_mut().session.measured.shift_to(-0.25, true);
    let same = comparison(&mut harness);
    assert!(same.rms.0 < 1e-7 && same.times.len() == 4000, "{:?}", same.rms);
    harness.get_by_label("Remove").click();
    harness.run_steps(3);
    assert!(harness.state().session.measured.over.is_none() && !is_painted(&harness, "laser.csv"));
}

#[test]
fn the_numbers_follow_the_scene_and_say_when_the_motion_is_another() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = dropped(|session| instrument(session, folder.path()), WIDE);
    press(&mut harness, Key::Enter);
    harness.state_mut().session.measured.shift_to(-0.25, true);
    assert!(comparison(&mut harness).rms.0 < 1e-7);
    // the zero of the sensor
    for (offset, rms) in [(1e-3, 1e-3), (0.0, 0.0)] {
        harness.state_mut().session.measured.over.as_mut().unwrap().offset = offset;
        assert!((comparison(&mut harness).rms.0 - rms).abs() < 1e-7);
    }
    command(&mut harness, Command::PlayPause);
    wait_until("a quarter of a second", || {
        harness.run_steps(2);
        harness.state().session.player.time() > 0.05
    });
    let session = &mut harness.state_mut().session;
    session.set_number("stops.restitution", 0.8).unwrap();
    session.end_gesture();
    harness.run_steps(2);
    let other = comparison(&mut harness);
    assert!(other.rms.0 > 1e-6, "{:?}", other.rms);
    harness.get_by_label_contains("was changed while it ran");
    // undone, it is the old one
    command(&mut harness, Command::Undo);
    assert!(comparison(&mut harness).rms.0 < 1e-7);
    // another scene keeps the record
    harness.state_mut().open_another("nominal-cubic");
    harness.run_steps(3);
    assert!(harness.state().session.measured.over.is_some());
}

#[test]
fn a_fault_is_one_sentence_and_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pull.csv");
    std::fs::write(&path, "t_s;Weg;F [mN]\n0;1;5\n2;2;6\n1;3;7\n").unwrap();
    let mut harness = dropped(|_| path.clone(), WIDE);
    // no unit tells what is meant by the second column
    harness.get_by_label_contains("Choose the unit of `Weg`");
    let dialog = harness.state_mut().columns.as_mut().unwrap();
    dialog.choose(1, (1, Unit::of_word("mm", Quantity::Displacement)));
    read(&mut harness);
    harness.get_by_label_contains("Line 4: t_s = 1 does not come after 2");
    let dialog = harness.state_mut().columns.as_mut().unwrap();
    dialog.choose(1, (2, Unit::of_word("mN", Quantity::Force)));
    read(&mut harness);
    harness.get_by_label_contains("A force over time has nothing to be compared with");
    // over the position its times do not matter
    let dialog = harness.state_mut().columns.as_mut().unwrap();
    dialog.choose(0, (1, Unit::of_word("mm", Quantity::Displacement)));
    read(&mut harness);
    harness.get_by_label_contains("3 samples from 1 to 3 mm");
    press(&mut harness, Key::Escape);
    assert!(harness.state().columns.is_none());
    assert!(harness.state().session.measured.over.is_none());
    harness.state_mut().open_measured(&folder.path().join("not-there.csv"));
    read(&mut harness);
    harness.get_by_label_contains("The file is not there (no such file)");
}

#[test]
fn a_measured_acceleration_can_shake_the_base() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stage.csv");
    let text: String = (0..200).map(|i| format!("{},{}\n", 20 * i, f64::from(i % 7) / 10.0 - 0.3)).collect();
    std::fs::write(&path, format!("t (ms),stage (g)\n{text}")).unwrap();
    let mut harness = dropped(|_| path.clone(), WIDE);
    let before = harness.state().session.scene().clone();
    harness.get_by_label("Shake the base with it").click();
    harness.run_steps(4);
    let session = &harness.state().session;
    let Excitation::Recorded { path: file, record: Some(record) } = &session.scene().excitation else {
        panic!("{:?}", session.scene().excitation)
    };
    assert!(Path::new(file).is_absolute() && session.fault().is_none());
    assert_eq!(record.times[1], 0.02);
    let found = session.model().base_acceleration(0.08);
    assert!((found - 0.980665).abs() < 1e-12, "{found}");
    assert_eq!(session.player.watch().begin(), 0.0);
    assert!(harness.state().message().unwrap().starts_with("The record ends at 3.98 s, before the run"));
    harness.key_press(Key::Enter);
    command(&mut harness, Command::Undo);
    assert_eq!(*harness.state().session.scene(), before);
    // a scene could not find these columns again
    std::fs::write(&path, format!("t,stage\n{text}")).unwrap();
    harness.state_mut().open_measured(&path);
    read(&mut harness);
    let dialog = harness.state_mut().columns.as_mut().unwrap();
    dialog.choose(0, (0, Unit::of_word("ms", Quantity::Time)));
    dialog.choose(1, (1, Unit::of_word("g", Quantity::Acceleration)));
    read(&mut harness);
    harness.get_by_label("Shake the base with it").click();
    harness.run_steps(4);
    harness.get_by_label_contains("A scene names only the file of its record");
    assert_eq!(*harness.state().session.scene(), before);
    // over the acceleration of the base it lies all the same
    harness.get_by_label("Lay it over").click();
    harness.run_steps(4);
    assert!(harness.state().tiling.shows(View::BaseAcceleration));
    assert_eq!(comparison(&mut harness).times.len(), 200);
}

#[test]
fn a_pull_lies_over_the_force_curve() {
    let folder = tempfile::tempdir().unwrap();
    let pull = |session: &Session| {
        let curve = &session.model().mechanism().curve;
        let row = |i: i32| {
            let x = f64::from(i) * 1e-5;
            format!("{:?},{:?}\n", x * 1e3, (curve.force(x) + 1e-3) * 1e3)
        };
        let path = folder.path().join("pull.csv");
        let rows: String = (-600..600).map(row).collect();
        std::fs::write(&path, format!("Position (mm),Load (mN)\n{rows}")).unwrap();
        path
    };
    let mut harness = dropped(pull, WIDE);
    harness.get_by_label_contains("position, by its name");
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert!(harness.state().tiling.shows(View::ForceCurve) && is_painted(&harness, "measured"));
    let Differences::Force(found) = differences(&mut harness) else { panic!("a motion") };
    assert!((found.rms.0 - 1e-3).abs() < 1e-15 && found.positions.len() == 1200, "{:?}", found.rms);
    harness.get_by_label_contains("RMS difference");
    // a force has no time
    assert!(harness.query_by_label("Fit the shift").is_none());
}

#[test]
fn it_is_opened_by_key_argument_and_path() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    std::fs::write(&path, "t_s,x_mm\n0,1\n1,1.5\n2,-1\n").unwrap();
    let window = Window::open(path.to_str(), Settings::default(), std::sync::Arc::new(|| ())).unwrap();
    assert!(window.columns.is_some());
    let mut harness = crate::support::window("paper", PROJECTED);
    harness.state_mut().type_path(Wanted::Measured);
    harness.run_steps(2);
    harness.get_by_label("Open which measured data?");
    harness.event(eframe::egui::Event::Text(path.to_str().unwrap().into()));
    harness.run_steps(2);
    press(&mut harness, Key::Enter);
    read(&mut harness);
    harness.get_by_label_contains("3 samples from 0 to 2 s");
    assert_eq!(sliced(&harness), Vec::<String>::new());
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert!(harness.state().session.measured.over.is_some());
    // a scene is opened as before
    let ctx = harness.ctx.clone();
    let file = folder.path().join("own.ron");
    harness.state_mut().save_to(&ctx, &file);
    harness.state_mut().take_dropped(&ctx, &file);
    harness.run_steps(3);
    assert_eq!(harness.state().session.editor.path(), Some(file.as_path()));
    // in a lesson it waits
    command(&mut harness, Command::OpenLesson(interwell::scene::lesson::LESSONS[0].name));
    harness.state_mut().take_dropped(&ctx, &path);
    assert!(harness.state().columns.is_none());
    assert_eq!(harness.state().notice(), Some("Leave the lesson first"));
}
