//! The menu bar.

use std::sync::LazyLock;

use eframe::egui::{self, Button, KeyboardShortcut, Modifiers, Ui};

use crate::app::session::Session;
use crate::app::session::lesson::OpenLesson;
use crate::app::session::map::Map;
use crate::app::session::player::SPEEDS;
use crate::app::ui::settings::{Setting, Settings};
use crate::app::views::View;
use crate::app::words::lesson::numbered;
use crate::scene::lesson::{BuiltInLesson, LESSONS, LessonDocument};
use crate::scene::{Document, PRESETS};
use crate::study::result_fields;

use super::command::{Command, DISCARD, MENUS, Part};
use super::keys::SPEED_KEYS;
use super::layouts::{Room, Tiling};
use super::lessons::Lessons;
use super::wanted::Wanted;

/// Draws the bar. Returns the commands that were chosen.
pub fn menu_ui(
    ui: &mut Ui,
    session: &Session,
    tiling: &Tiling,
    settings: Settings,
    recent: &[String],
    lessons: &Lessons,
) -> Vec<Command> {
    let mut commands = Vec::new();
    egui::MenuBar::new().ui(ui, |ui| {
        let state = MenuState { session, tiling, settings, recent, lessons };
        for (name, parts) in &MENUS {
            ui.menu_button(*name, |ui| match *name {
                "View" | "Lessons" => scroll_ui(ui, |ui| parts_ui(ui, &mut commands, parts, &state)),
                _ => parts_ui(ui, &mut commands, parts, &state),
            });
        }
        ui.add_space(16.0);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let hover = "The scene as it was opened or last saved, its views, and time 0 (Home). Undo brings \
                         the changes back.";
            if ui.button(DISCARD).on_hover_text(hover).clicked() {
                commands.push(Command::BackToStart);
            }
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let dirty = if session.editor.is_dirty() { " *" } else { "" };
                let (text, hover) = match &lessons.open {
                    Some(open) => (format!("Lesson: {}", open.lesson().title), "What this lesson is about"),
                    None => (format!("{}{dirty}", session.scene().title), "What this scene is about"),
                };
                let title = egui::RichText::new(text).strong();
                let title = ui.add(Button::new(title).frame_when_inactive(false).truncate());
                if title.on_hover_text(hover).clicked() {
                    commands.push(Command::Notes);
                }
            });
        });
    });
    commands
}

/// What the menus show besides the commands.
struct MenuState<'a> {
    session: &'a Session,
    tiling: &'a Tiling,
    settings: Settings,
    recent: &'a [String],
    lessons: &'a Lessons,
}

fn parts_ui(ui: &mut Ui, commands: &mut Vec<Command>, parts: &[Part], state: &MenuState<'_>) {
    for part in parts {
        match part {
            Part::Item("", ..) | Part::Row(..) => {}
            Part::Item(name, key, command, _) => {
                let enabled = is_enabled(command, state);
                item_ui(ui, commands, name, *key, enabled, command);
            }
            Part::Menu(name, parts) => drop(ui.menu_button(*name, |ui| parts_ui(ui, commands, parts, state))),
            Part::Line => drop(ui.separator()),
            Part::Presets => presets_ui(ui, commands),
            Part::Recent => recent_ui(ui, commands, state.recent),
            Part::Settings => settings_ui(ui, commands, state.settings),
            Part::Views => views_ui(ui, commands, state.tiling),
            Part::Speeds => speeds_ui(ui, commands),
            Part::Lessons => lessons_ui(ui, commands, state.lessons),
        }
    }
}

/// Whether a command can be chosen in a menu.
fn is_enabled(command: &Command, state: &MenuState<'_>) -> bool {
    let MenuState { session, tiling, lessons, .. } = state;
    let model = session.model();
    if lessons.open.as_ref().is_some_and(OpenLesson::is_covering) && command.reveals_motion() {
        return false;
    }
    match command {
        Command::Save => session.editor.is_dirty() || session.editor.path().is_none(),
        Command::OpenMeasured => lessons.open.is_none(),
        Command::RemoveMeasured => session.measured.over.is_some(),
        Command::SaveAs(Wanted::Map) => session.map.map().is_some_and(Map::is_whole),
        Command::CopyMapCommand => session.map.map().is_some(),
        Command::Undo => session.editor.can_undo(),
        Command::Redo => session.editor.can_redo(),
        Command::KeepOwn => tiling.room() != Room::Compact && lessons.open.is_none(),
        Command::Arrange(_) | Command::ArrangeOwn => lessons.open.is_none(),
        Command::LeaveLesson | Command::LessonAnew | Command::LecturerNotes => lessons.open.is_some(),
        Command::NextRelease => model.stop_positions() != (None, None),
        Command::NextCrossing => model.mechanism().landscape.barrier.is_some(),
        Command::Notes if lessons.open.is_some() => true,
        Command::Notes => !session.scene().notes.trim().is_empty(),
        _ => true,
    }
}

fn item_ui(
    ui: &mut Ui,
    commands: &mut Vec<Command>,
    name: &str,
    key: Option<KeyboardShortcut>,
    enabled: bool,
    command: &Command,
) {
    let mut button = Button::new(name);
    if let Some(key) = key {
        button = button.shortcut_text(ui.ctx().format_shortcut(&key));
    }
    if ui.add_enabled(enabled, button).clicked() {
        commands.push(command.clone());
        ui.close();
    }
}

fn presets_ui(ui: &mut Ui, commands: &mut Vec<Command>) {
    ui.menu_button("Open built-in scene", |ui| {
        scroll_ui(ui, |ui| {
            for (preset, title) in PRESETS.iter().zip(TITLES.iter()) {
                let hover = format!("{}: {}", preset.name, preset.summary);
                if ui.button(title).on_hover_text(hover).clicked() {
                    commands.push(Command::OpenPreset(preset.name));
                    ui.close();
                }
            }
        });
    });
}

fn recent_ui(ui: &mut Ui, commands: &mut Vec<Command>, recent: &[String]) {
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            for path in recent {
                let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
                if ui.button(name).on_hover_text(path).clicked() {
                    commands.push(Command::OpenRecent(path.clone()));
                    ui.close();
                }
            }
        });
    });
}

fn settings_ui(ui: &mut Ui, commands: &mut Vec<Command>, mut settings: Settings) {
    for (setting, name, hover) in [
        (Setting::Projector, "Projector", "Light, larger, thicker lines (P)"),
        (Setting::Dark, "Dark", "Light letters on a dark ground (D)"),
        (Setting::ReduceMotion, "Reduce motion", "No rings at impacts"),
    ] {
        let is_enabled = setting != Setting::Dark || !settings.projector;
        let checkbox = egui::Checkbox::new(settings.of(setting), name);
        if ui.add_enabled(is_enabled, checkbox).on_hover_text(hover).clicked() {
            commands.push(Command::Toggle(setting));
        }
    }
}

fn views_ui(ui: &mut Ui, commands: &mut Vec<Command>, tiling: &Tiling) {
    ui.menu_button("Views", |ui| {
        scroll_ui(ui, |ui| {
            for view in View::ALL {
                let mut shown = tiling.shows(view);
                if ui.checkbox(&mut shown, view.name()).on_hover_text(view.about()).clicked() {
                    commands.push(Command::Show(view, shown));
                }
            }
        });
    });
}

fn speeds_ui(ui: &mut Ui, commands: &mut Vec<Command>) {
    for (i, ((_, name), key)) in SPEEDS.into_iter().zip(SPEED_KEYS).enumerate() {
        let text = match name {
            "real time" => name.to_owned(),
            _ if name.ends_with("times") => format!("{name} real time"),
            _ => format!("{name} of real time"),
        };
        let key = KeyboardShortcut::new(Modifiers::NONE, key);
        item_ui(ui, commands, &text, Some(key), true, &Command::Speed(i));
    }
}

/// The built-in lessons in order; those that are done have a mark, and the open one is selected.
fn lessons_ui(ui: &mut Ui, commands: &mut Vec<Command>, lessons: &Lessons) {
    let open = lessons.open.as_ref().map(OpenLesson::key);
    for (lesson, about) in LESSONS.iter().zip(ABOUT_LESSONS.iter()) {
        let is_open = open.as_deref() == Some(lesson.name);
        let done = match (is_open, &lessons.open) {
            (true, Some(open)) => open.progress().done,
            _ => lessons.records.get(lesson.name).is_some_and(|record| record.done),
        };
        let mark = if done { "done" } else { "" };
        let name = format!("{}  {} ({} min)", numbered(lesson.name), about.title, about.minutes);
        let button = Button::selectable(is_open, name).right_text(mark);
        if ui.add(button).on_hover_text(&about.goal).clicked() {
            commands.push(Command::OpenLesson(lesson.name));
            ui.close();
        }
    }
}

/// Contents that are scrolled if they are taller than the window.
fn scroll_ui(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let window = ui.ctx().content_rect();
    // a menu that opens low down is moved up
    let room = (window.bottom() - ui.cursor().top().min(0.3 * window.bottom()) - 16.0).max(120.0);
    // the height of a menu is limited to 400 points unless it is set
    ui.set_max_height(room);
    egui::ScrollArea::vertical().max_height(room).show(ui, contents);
}

/// The facts about a lesson that its menu item shows.
struct LessonFacts {
    title: String,
    minutes: u32,
    goal: String,
}

/// The facts about all built-in lessons.
static ABOUT_LESSONS: LazyLock<Vec<LessonFacts>> = LazyLock::new(|| {
    let facts = |built_in: &BuiltInLesson| match LessonDocument::load(built_in.name, &result_fields()) {
        Ok(LessonDocument { lesson, .. }) => {
            LessonFacts { title: lesson.title, minutes: lesson.minutes, goal: lesson.goal }
        }
        Err(error) => LessonFacts { title: built_in.name.to_owned(), minutes: 0, goal: error.to_string() },
    };
    LESSONS.iter().map(facts).collect()
});

static TITLES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let title = |name: &str| Document::load(name).map_or_else(|_| name.to_owned(), |found| found.scene.title);
    PRESETS.iter().map(|preset| title(preset.name)).collect()
});
