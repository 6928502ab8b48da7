//! The menu bar: what is asked for. What is done about it is the window's business.

use std::sync::LazyLock;

use eframe::egui::{self, Button, Key, KeyboardShortcut, Modifiers, Ui};

use crate::scene::{Document, Layout, PRESETS};

use super::layouts::{Room, Tiling};
use super::map::Map;
use super::player::SPEEDS;
use super::session::Session;
use super::settings::Settings;
use super::views::View;

/// What can be asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// Open a built-in scene.
    OpenPreset(&'static str),
    /// Open a scene file that was open before.
    OpenRecent(String),
    /// Choose a scene file and open it.
    Open,
    /// Save the scene to its file.
    Save,
    /// Choose a file and save the scene to it.
    SaveAs,
    /// Write the motion that was seen as CSV.
    SaveMotion,
    /// Write the whole run of the scene as CSV.
    SaveRun,
    /// Write the events as CSV.
    SaveEvents,
    /// Write the force curve as CSV.
    SaveCurve,
    /// Write the window as a picture.
    SavePicture,
    /// The scene as text to the clipboard.
    CopyScene,
    /// The scene that the clipboard holds as text.
    PasteScene,
    /// The command line of what is shown to the clipboard.
    CopyCommand,
    /// Choose a file and write the map to it.
    SaveMap,
    /// Put the command line that makes the map on the clipboard.
    CopyMapCommand,
    /// Leave.
    Quit,
    /// A step back.
    Undo,
    /// A step forward again.
    Redo,
    /// Scene, view and time as they were opened.
    BackToStart,
    /// Play or pause.
    PlayPause,
    /// A single step.
    Step,
    /// To the event before.
    PreviousEvent,
    /// To the event after.
    NextEvent,
    /// To the next release from a stop, as fast as it can be computed.
    NextRelease,
    /// To the next crossing.
    NextCrossing,
    /// To the end of the run.
    RunToEnd,
    /// One of the speeds.
    Speed(usize),
    /// Arrange the views.
    Arrange(Layout),
    /// Arrange them as a person has done it.
    ArrangeOwn,
    /// Keep the present arrangement as a person's own.
    KeepOwn,
    /// Show or hide a view.
    Show(View, bool),
    /// The next of the views that share a place as tabs.
    NextTab,
    /// One view over the whole window, or no longer.
    Fill,
    /// Cover the results, or no longer.
    Cover,
    /// The whole screen, or no longer.
    FullScreen,
    /// Change the settings.
    Set(Settings),
    /// Take hold of the mass.
    Grab,
    /// What it would take to cross, or no longer.
    Ways,
    /// The notes of the scene.
    Notes,
    /// The list of keys.
    Shortcuts,
    /// About the program.
    About,
}

const fn command(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn plain(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const SAVE_AS: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
const COPY_COMMAND: KeyboardShortcut =
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::C);
const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);

const NEXT_TAB: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Tab);

/// The keys of the speeds, the slowest first.
const SPEED_KEYS: [Key; SPEEDS.len()] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7];

/// Draws the bar and says what was asked for.
pub fn menu_ui(
    ui: &mut Ui,
    session: &Session,
    tiling: &Tiling,
    settings: Settings,
    recent: &[String],
) -> Vec<Command> {
    let mut asked = Vec::new();
    egui::MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| {
            ui.menu_button("Open built-in scene", |ui| {
                scroll_ui(ui, |ui| {
                    for (preset, title) in PRESETS.iter().zip(TITLES.iter()) {
                        let hover = format!("{}: {}", preset.name, preset.summary);
                        if ui.button(title).on_hover_text(hover).clicked() {
                            asked.push(Command::OpenPreset(preset.name));
                            ui.close();
                        }
                    }
                });
            });
            item(ui, &mut asked, "Open...", Some(command(Key::O)), true, Command::Open);
            ui.add_enabled_ui(!recent.is_empty(), |ui| {
                ui.menu_button("Open recent", |ui| {
                    for path in recent {
                        let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
                        if ui.button(name).on_hover_text(path).clicked() {
                            asked.push(Command::OpenRecent(path.clone()));
                            ui.close();
                        }
                    }
                });
            });
            ui.separator();
            let save = session.editor.is_dirty() || session.editor.path().is_none();
            item(ui, &mut asked, "Save", Some(command(Key::S)), save, Command::Save);
            item(ui, &mut asked, "Save as...", Some(SAVE_AS), true, Command::SaveAs);
            ui.separator();
            item(ui, &mut asked, "Save the motion seen as CSV...", None, true, Command::SaveMotion);
            item(ui, &mut asked, "Save the whole run as CSV...", None, true, Command::SaveRun);
            item(ui, &mut asked, "Save the events as CSV...", None, true, Command::SaveEvents);
            item(ui, &mut asked, "Save the force curve as CSV...", None, true, Command::SaveCurve);
            item(ui, &mut asked, "Save a picture of the window...", None, true, Command::SavePicture);
            let map = session.map.map();
            let whole = map.is_some_and(Map::is_whole);
            item(ui, &mut asked, "Save the map as CSV...", None, whole, Command::SaveMap);
            let copy = "Copy the map's command line";
            item(ui, &mut asked, copy, None, map.is_some(), Command::CopyMapCommand);
            ui.separator();
            item(ui, &mut asked, "Quit", Some(command(Key::Q)), true, Command::Quit);
        });
        ui.menu_button("Edit", |ui| {
            let editor = &session.editor;
            item(ui, &mut asked, "Undo", Some(command(Key::Z)), editor.can_undo(), Command::Undo);
            item(ui, &mut asked, "Redo", Some(REDO), editor.can_redo(), Command::Redo);
            item(ui, &mut asked, "Back to start", Some(plain(Key::Home)), true, Command::BackToStart);
            ui.separator();
            item(ui, &mut asked, "Copy the scene as text", Some(command(Key::C)), true, Command::CopyScene);
            item(ui, &mut asked, "Paste a scene", Some(command(Key::V)), true, Command::PasteScene);
            item(ui, &mut asked, "Copy the command line", Some(COPY_COMMAND), true, Command::CopyCommand);
        });
        ui.menu_button("View", |ui| {
            scroll_ui(ui, |ui| view_menu_ui(ui, &mut asked, tiling, settings));
        });
        ui.menu_button("Motion", |ui| motion_menu_ui(ui, &mut asked, session));
        ui.menu_button("Help", |ui| {
            let notes = !session.scene().notes.trim().is_empty();
            item(ui, &mut asked, "About this scene", None, notes, Command::Notes);
            item(ui, &mut asked, "Keys", Some(plain(Key::F1)), true, Command::Shortcuts);
            item(ui, &mut asked, "About", None, true, Command::About);
        });
        ui.add_space(16.0);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let hover =
                "Scene and views as opened or last saved, from time 0 (Home). The scene comes back with undo.";
            if ui.button("Back to start").on_hover_text(hover).clicked() {
                asked.push(Command::BackToStart);
            }
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let dirty = if session.editor.is_dirty() { " *" } else { "" };
                let title = egui::RichText::new(format!("{}{dirty}", session.scene().title)).strong();
                let title = ui.add(Button::new(title).frame_when_inactive(false).truncate());
                if title.on_hover_text("What this scene is about").clicked() {
                    asked.push(Command::Notes);
                }
            });
        });
    });
    asked
}

fn item(
    ui: &mut Ui,
    asked: &mut Vec<Command>,
    text: &str,
    keys: Option<KeyboardShortcut>,
    enabled: bool,
    what: Command,
) {
    let mut button = Button::new(text);
    if let Some(keys) = keys {
        button = button.shortcut_text(ui.ctx().format_shortcut(&keys));
    }
    if ui.add_enabled(enabled, button).clicked() {
        asked.push(what);
        ui.close();
    }
}

fn motion_menu_ui(ui: &mut Ui, asked: &mut Vec<Command>, session: &Session) {
    let model = session.model();
    let stops = model.stop_positions() != (None, None);
    let barrier = model.mechanism().landscape.barrier.is_some();
    item(ui, asked, "Play, pause", Some(plain(Key::Space)), true, Command::PlayPause);
    item(ui, asked, "A single step", Some(plain(Key::Period)), true, Command::Step);
    item(ui, asked, "To the event before", Some(plain(Key::PageUp)), true, Command::PreviousEvent);
    item(ui, asked, "To the event after", Some(plain(Key::PageDown)), true, Command::NextEvent);
    ui.separator();
    item(ui, asked, "To the next release", Some(plain(Key::R)), stops, Command::NextRelease);
    item(ui, asked, "To the next crossing", Some(plain(Key::X)), barrier, Command::NextCrossing);
    item(ui, asked, "To the end of the run", Some(plain(Key::End)), true, Command::RunToEnd);
    ui.separator();
    for (i, ((_, name), key)) in SPEEDS.into_iter().zip(SPEED_KEYS).enumerate() {
        let text = match name {
            "real time" => name.to_owned(),
            _ if name.ends_with("times") => format!("{name} real time"),
            _ => format!("{name} of real time"),
        };
        item(ui, asked, &text, Some(plain(key)), true, Command::Speed(i));
    }
}

fn view_menu_ui(ui: &mut Ui, asked: &mut Vec<Command>, tiling: &Tiling, settings: Settings) {
    item(ui, asked, "Arrange as Look", Some(command(Key::Num1)), true, Command::Arrange(Layout::Look));
    item(ui, asked, "Arrange as Study", Some(command(Key::Num2)), true, Command::Arrange(Layout::Study));
    item(ui, asked, "Arrange as Map", Some(command(Key::Num3)), true, Command::Arrange(Layout::Map));
    item(ui, asked, "Your own arrangement", Some(command(Key::Num4)), true, Command::ArrangeOwn);
    let keep = tiling.room() != Room::Compact;
    item(ui, asked, "Keep this as your own", None, keep, Command::KeepOwn);
    ui.separator();
    let mut wanted = settings;
    ui.checkbox(&mut wanted.projector, "Projector").on_hover_text("Light, larger, thicker lines (P)");
    ui.checkbox(&mut wanted.dark, "Dark").on_hover_text("Light letters on a dark ground (D)");
    ui.checkbox(&mut wanted.reduce_motion, "Reduce motion").on_hover_text("No rings at impacts");
    if wanted != settings {
        asked.push(Command::Set(wanted));
    }
    ui.separator();
    for view in View::ALL {
        let mut shown = tiling.shows(view);
        if ui.checkbox(&mut shown, view.name()).clicked() {
            asked.push(Command::Show(view, shown));
        }
    }
    ui.separator();
    item(ui, asked, "The next tab", Some(NEXT_TAB), true, Command::NextTab);
    item(ui, asked, "One view over the window", Some(plain(Key::Z)), true, Command::Fill);
    item(ui, asked, "Cover the results", Some(plain(Key::C)), true, Command::Cover);
    item(ui, asked, "What it would take", Some(plain(Key::H)), true, Command::Ways);
    item(ui, asked, "Full screen", Some(plain(Key::F11)), true, Command::FullScreen);
}

/// What may be longer than the window is high.
fn scroll_ui(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let room = (ui.ctx().content_rect().bottom() - ui.cursor().top() - 16.0).max(120.0);
    // a menu takes no more than 400 points by itself
    ui.set_max_height(room);
    egui::ScrollArea::vertical().max_height(room).show(ui, contents);
}

/// The titles of the built-in scenes.
static TITLES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let title = |name: &str| Document::load(name).map_or_else(|_| name.to_owned(), |found| found.scene.title);
    PRESETS.iter().map(|preset| title(preset.name)).collect()
});

/// What the keyboard asks for; nothing while something is typed. To be called only where no dialog is open.
pub fn keys(ctx: &egui::Context, settings: Settings, filled: bool) -> Vec<Command> {
    if ctx.text_edit_focused() {
        return Vec::new();
    }
    let mut asked = Vec::new();
    let mut on = |keys: KeyboardShortcut, what: Command| {
        if ctx.input_mut(|input| input.consume_shortcut(&keys)) {
            asked.push(what);
        }
    };
    // the longer ones first
    on(SAVE_AS, Command::SaveAs);
    on(COPY_COMMAND, Command::CopyCommand);
    on(REDO, Command::Redo);
    on(command(Key::Y), Command::Redo);
    on(command(Key::Z), Command::Undo);
    on(command(Key::S), Command::Save);
    on(command(Key::O), Command::Open);
    on(command(Key::Q), Command::Quit);
    on(command(Key::Num1), Command::Arrange(Layout::Look));
    on(plain(Key::F1), Command::Shortcuts);
    on(command(Key::Num2), Command::Arrange(Layout::Study));
    on(command(Key::Num4), Command::ArrangeOwn);
    on(command(Key::Num3), Command::Arrange(Layout::Map));
    on(plain(Key::F11), Command::FullScreen);
    on(plain(Key::PageUp), Command::PreviousEvent);
    on(plain(Key::PageDown), Command::NextEvent);
    on(NEXT_TAB, Command::NextTab);
    on(plain(Key::Home), Command::BackToStart);
    on(plain(Key::End), Command::RunToEnd);
    on(plain(Key::R), Command::NextRelease);
    on(plain(Key::X), Command::NextCrossing);
    // what has the keyboard's focus is pressed by it
    let focused = ctx.memory(egui::Memory::focused).and_then(|id| ctx.read_response(id));
    if !focused.is_some_and(|response| response.sense.senses_click()) {
        on(plain(Key::Space), Command::PlayPause);
    }
    if filled && !egui::Popup::is_any_open(ctx) {
        on(plain(Key::Escape), Command::Fill);
    }
    on(plain(Key::Period), Command::Step);
    on(plain(Key::Z), Command::Fill);
    on(plain(Key::C), Command::Cover);
    on(plain(Key::G), Command::Grab);
    on(plain(Key::H), Command::Ways);
    on(plain(Key::P), Command::Set(Settings { projector: !settings.projector, ..settings }));
    on(plain(Key::D), Command::Set(Settings { dark: !settings.dark, ..settings }));
    for (i, key) in SPEED_KEYS.into_iter().enumerate() {
        on(plain(key), Command::Speed(i));
    }
    asked
}
