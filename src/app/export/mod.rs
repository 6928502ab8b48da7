//! Results of the window as CSV, PNG, figures and command lines.

#[cfg(any(test, target_arch = "wasm32"))]
pub mod asked;
mod drawing;
pub mod figure;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use eframe::egui::ColorImage;
use serde::{Deserialize, Serialize};

use crate::app::session::Session;
use crate::app::session::editor::{Editor, keep_start_inside};
use crate::app::session::map::over;
use crate::app::session::measured::file_name;
use crate::app::session::player::Player;
use crate::app::session::prepared::SharedModel;
use crate::app::task::{Each, Question, progress, told};
use crate::output::{Argument, csv, write_file};
use crate::questions::{Curve, Error, Sampling};
use crate::scene::{FieldPath, Scene, arguments};
use interwell_studies::study::{continued_scene, events_table, samples_table, watched_events};

/// The remembered motion, in the columns of the command `simulate`.
pub fn motion_csv(player: &Player) -> String {
    let samples: Vec<_> = player.watch().samples().iter().copied().collect();
    csv(&samples_table(&samples, |sample| player.watch().model_at(sample.t).output(sample)))
}

/// The notice about a file that was written, or why it was not written.
pub type WriteResult = Result<String, String>;

/// The run of a scene from start to end, to be written to a file as `simulate` writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunQuestion {
    pub model: SharedModel,
    pub path: PathBuf,
}

impl Question for RunQuestion {
    const NAME: &'static str = "run";
    type Part = WriteResult;

    fn answer(&self, cancel: &AtomicBool, _: Each<WriteResult>) -> Option<WriteResult> {
        let recorded = self.model.simulation().record(&Sampling::Default, None, &progress(cancel));
        Some(told(recorded)?.and_then(|recorded| write_text(&self.path, &csv(&recorded.samples))))
    }
}

pub fn write_text(path: &Path, text: &str) -> WriteResult {
    write_file(path, text.as_bytes()).map(|()| format!("Saved {}", file_name(path)))
}

/// The remembered events, in the columns of `simulate --events`.
pub fn events_csv(player: &Player) -> String {
    let events: Vec<_> = player.watch().events().iter().copied().collect();
    csv(&events_table(&events))
}

/// The remembered events, with the phase of the drive and the kinetic energy lost in each.
pub fn events_seen_csv(player: &Player) -> String {
    csv(&watched_events(player.watch(), 0..usize::MAX))
}

/// Force, potential and stiffness of the mechanism, as the command `curve` writes them without options.
pub fn curve_csv(session: &Session) -> Result<String, Error> {
    Curve::default().run(&session.model.simulation()).map(|table| csv(&table))
}

pub fn png(image: &ColorImage) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let pixels: Vec<u8> = image.pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
    let side = |size: usize| u32::try_from(size).unwrap_or(0);
    let mut encoder = png::Encoder::new(&mut bytes, side(image.size[0]), side(image.size[1]));
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels));
    written.map_err(|error| format!("the picture cannot be written: {error}"))?;
    Ok(bytes)
}

/// The command that runs the motion on the screen without a window, and what it runs, in words. `None` for a
/// scene that is not built in and has not been saved to a file.
pub fn command_line(session: &Session) -> Option<(String, &'static str)> {
    let editor = &session.editor;
    let here = || continued_scene(editor.scene(), &session.player.watch().from_here()?);
    let is_continued = session.is_continued && session.fault().is_none();
    let from_start = match is_continued {
        true => "the scene from its start. This motion was changed on its way and is another",
        false => "this motion, from its start",
    };
    let (mut scene, runs) = match here().filter(|_| is_continued) {
        Some(scene) => (scene, "this motion, from its present state on"),
        None => (editor.scene().clone(), from_start),
    };
    keep_start_inside(&mut scene);
    Some((line("simulate", &scene_arguments(editor, editor.named(), &scene)?), runs))
}

/// The command that makes the map without a window. Returns `None` if there is no map, and for a scene that
/// is not built in and has not been saved to a file.
pub fn map_command_line(session: &Session) -> Option<String> {
    let (question, editor) = (&session.map.map()?.question, &session.editor);
    let mut from = editor.named().clone();
    // the fields of the axes need no `--set`
    for axis in &question.axes {
        let known = FieldPath::new(&axis.field).set(&mut from, axis.from);
        debug_assert!(known || editor.named().stops != question.scene.stops);
    }
    let mut all = scene_arguments(editor, &from, &question.scene)?;
    all.extend(question.axes.iter().map(|axis| Argument::of("over", over(axis))));
    all.extend(session.map.columns().map(|columns| Argument::of("columns", columns.join(","))));
    Some(line("sweep", &all))
}

/// The name of the open scene, and the `--set` options that change one scene into another.
fn scene_arguments(editor: &Editor, from: &Scene, to: &Scene) -> Option<Vec<Argument>> {
    let origin = Argument { option: None, value: Some(editor.origin()?) };
    let settings = arguments(from, to).into_iter().map(|setting| Argument::of("set", setting));
    Some(std::iter::once(origin).chain(settings).collect())
}

/// A command line of the program without a window.
fn line(command: &str, arguments: &[Argument]) -> String {
    let words: Vec<String> = arguments.iter().flat_map(Argument::words).map(|word| quoted(&word)).collect();
    format!("interwell --headless {command} {}", words.join(" "))
}

/// A word quoted for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/=+:,".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_a_shell_would_change_are_quoted() {
        let words = ["it's", "stops=Rigid(travel_limit_mm:1.5)", "", "excitation.amplitude_g=0:2:0.02"];
        let arguments = words.map(|word| Argument { option: None, value: Some(word.to_owned()) });
        let expected = r"'it'\''s' 'stops=Rigid(travel_limit_mm:1.5)' '' excitation.amplitude_g=0:2:0.02";
        assert_eq!(line("simulate", &arguments), format!("interwell --headless simulate {expected}"));
    }

    #[test]
    fn a_picture_is_a_png() {
        let image = ColorImage::filled([3, 2], eframe::egui::Color32::RED);
        assert!(png(&image).unwrap().starts_with(b"\x89PNG"));
        assert!(png(&ColorImage::filled([0, 0], eframe::egui::Color32::RED)).is_err());
    }
}
