//! The menu bar.

use std::sync::LazyLock;

use eframe::egui::{
    self, Align2, Button, KeyboardShortcut, Modifiers, Response, Separator, TextStyle, Ui, pos2,
};

use crate::app::session::lesson::OpenLesson;
use crate::app::session::player::SPEEDS;
use crate::app::ui::settings::Setting;
use crate::app::views::View;
use crate::app::words::lesson::numbered;
use crate::scene::lesson::{LESSONS, Lesson, LessonDocument};
use crate::scene::{Document, PRESETS};
use interwell_studies::study::result_fields;

use super::Window;
use super::command::{Command, DISCARD, MENUS, Part};
use super::keys::SPEED_KEYS;
use super::layouts::Arrangement;

/// Name of the command that returns to the scene as it was opened, while nothing was changed.
const BACK: &str = "From the start again";

/// Height in points of an item.
const ROW: f32 = 20.0;

/// Height in points of a line between items.
const LINE: f32 = 2.0;

/// The menus of a window, and the commands that were chosen in this frame.
pub(super) struct Menus<'a> {
    pub window: &'a Window,
    pub chosen: Vec<Command>,
}

impl Menus<'_> {
    pub fn ui(mut self, ui: &mut Ui) -> Vec<Command> {
        egui::MenuBar::new().ui(ui, |ui| {
            for (name, parts) in &MENUS {
                let is_long = parts.iter().any(|part| matches!(part, Part::Views | Part::Lessons));
                ui.menu_button(*name, |ui| match is_long {
                    true => scroll_ui(ui, |ui| self.parts_ui(ui, parts)),
                    false => self.parts_ui(ui, parts),
                });
            }
            ui.add_space(16.0);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let hover = "The scene as it was opened or last saved, its views, and time 0 (Home). Undo \
                             brings the changes back.";
                if self.is_dirty() && ui.button(DISCARD).on_hover_text(hover).clicked() {
                    self.chosen.push(Command::BackToStart);
                }
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| self.title_ui(ui));
            });
        });
        self.chosen
    }

    fn is_dirty(&self) -> bool {
        self.window.session.editor.is_dirty()
    }

    /// The title of the lesson or scene, as a button that shows what it is about.
    fn title_ui(&mut self, ui: &mut Ui) {
        let dirty = if self.is_dirty() { " *" } else { "" };
        let (text, hover) = match self.window.lesson() {
            Some(open) => (format!("Lesson: {}", open.lesson().title), "What this lesson is about"),
            None => (format!("{}{dirty}", self.window.session.scene().title), "What this scene is about"),
        };
        let title = egui::RichText::new(text).strong();
        ui.separator();
        let title = ui.add(Button::new(title).frame_when_inactive(false).truncate());
        if title.on_hover_text(hover).clicked() {
            self.chosen.push(Command::Notes);
        }
    }

    fn parts_ui(&mut self, ui: &mut Ui, parts: &[Part]) {
        // less high than other controls, so that the longest menu fits into the smallest window
        (ui.spacing_mut().interact_size.y, ui.spacing_mut().button_padding.y) = (ROW, 1.0);
        for part in parts {
            match part {
                Part::Hidden(..) | Part::Row(..) => {}
                Part::Item(name, key, command, _) => {
                    let is_back = *command == Command::BackToStart && !self.is_dirty();
                    let mut button = Button::new(if is_back { BACK } else { *name });
                    let is_lesson = self.window.lesson().is_some();
                    let arranged = match command {
                        Command::Arrange(layout) => Some(Arrangement::Layout(*layout)),
                        Command::ArrangeOwn => Some(Arrangement::Custom),
                        _ => None,
                    };
                    button = button.selected(!is_lesson && arranged == Some(self.window.arrangement));
                    if let Some(key) = key {
                        button = button.shortcut_text(ui.ctx().format_shortcut(key));
                    }
                    let why = self.window.impossible(command);
                    let response = ui.add_enabled(why.is_none(), button);
                    let response = response.on_disabled_hover_text(why.unwrap_or_default());
                    self.choose(ui, &response, || command.clone());
                }
                Part::Menu(name, parts) => drop(ui.menu_button(*name, |ui| self.parts_ui(ui, parts))),
                Part::Line => drop(ui.add(Separator::default().spacing(LINE))),
                Part::Presets => self.presets_ui(ui),
                Part::Recent => self.recent_ui(ui),
                Part::Settings => self.settings_ui(ui),
                Part::Views => self.views_ui(ui),
                Part::Speeds => self.speeds_ui(ui),
                Part::Lessons => self.lessons_ui(ui),
            }
        }
    }

    /// Notes the command of an item if it was clicked, and closes the menu.
    fn choose(&mut self, ui: &Ui, item: &Response, command: impl FnOnce() -> Command) {
        if item.clicked() {
            self.chosen.push(command());
            ui.close();
        }
    }

    fn presets_ui(&mut self, ui: &mut Ui) {
        ui.menu_button("Open built-in scene", |ui| {
            scroll_ui(ui, |ui| {
                for (preset, title) in PRESETS.iter().zip(TITLES.iter()) {
                    let hover = format!("{}: {}", preset.name, preset.summary);
                    let item = ui.button(title).on_hover_text(hover);
                    self.choose(ui, &item, || Command::OpenPreset(preset.name));
                }
            });
        });
    }

    fn recent_ui(&mut self, ui: &mut Ui) {
        let recent = &self.window.recent;
        ui.add_enabled_ui(!recent.is_empty(), |ui| {
            let menu = ui.menu_button("Open recent", |ui| {
                for path in recent {
                    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
                    let item = ui.button(name).on_hover_text(path);
                    self.choose(ui, &item, || Command::OpenRecent(path.clone()));
                }
            });
            menu.response.on_disabled_hover_text("No file was opened or saved yet");
        });
    }

    fn settings_ui(&mut self, ui: &mut Ui) {
        for (setting, name, key, hover) in [
            (Setting::Projector, "Projector", "P", "Light, larger, thicker lines"),
            (Setting::Dark, "Dark", "D", "Light letters on a dark ground"),
            (Setting::ReduceMotion, "Reduce motion", "", "No rings at impacts"),
        ] {
            let command = Command::Toggle(setting);
            let why = self.window.impossible(&command);
            let mut settings = self.window.settings;
            let on = settings.of(setting);
            let response = ui.add_enabled_ui(why.is_none(), |ui| {
                let response = checkbox_ui(ui, on, name);
                // where the keys of other items stand
                let right = ui.max_rect().right() - ui.spacing().button_padding.x;
                let (at, font) =
                    (pos2(right, response.rect.center().y), TextStyle::Button.resolve(ui.style()));
                ui.painter().text(at, Align2::RIGHT_CENTER, key, font, ui.visuals().weak_text_color());
                response
            });
            let response = response.inner.on_hover_text(hover);
            if response.on_disabled_hover_text(why.unwrap_or_default()).clicked() {
                self.chosen.push(command);
            }
        }
    }

    fn views_ui(&mut self, ui: &mut Ui) {
        ui.menu_button("Views", |ui| {
            scroll_ui(ui, |ui| {
                for view in View::ALL {
                    let mut shown = self.window.tiling.shows(view);
                    if checkbox_ui(ui, &mut shown, view.name()).on_hover_text(view.about()).clicked() {
                        self.chosen.push(Command::Show(view, shown));
                    }
                }
            });
        });
    }

    fn speeds_ui(&mut self, ui: &mut Ui) {
        for (i, ((speed, name), key)) in SPEEDS.into_iter().zip(SPEED_KEYS).enumerate() {
            let key = ui.ctx().format_shortcut(&KeyboardShortcut::new(Modifiers::NONE, key));
            let text = match speed {
                1.0 => name.to_owned(),
                _ if speed > 1.0 => format!("{name} real time"),
                _ => format!("{name} of real time"),
            };
            let item = ui.add(Button::new(text).shortcut_text(key));
            self.choose(ui, &item, || Command::Speed(i));
        }
    }

    /// The built-in lessons in order; those that are done have a mark, and the open one is selected.
    fn lessons_ui(&mut self, ui: &mut Ui) {
        let open = self.window.lesson().map(OpenLesson::key);
        for (name, lesson) in BUILT_IN.iter() {
            let is_open = open.as_deref() == Some(*name);
            let done = match (is_open, self.window.lesson()) {
                (true, Some(open)) => open.progress().done,
                _ => self.window.lessons.records.get(*name).is_some_and(|record| record.done),
            };
            let mark = if done { "done" } else { "" };
            let text = format!("{}  {} ({} min)", numbered(name), lesson.title, lesson.minutes);
            let button = Button::selectable(is_open, text).right_text(mark);
            let item = ui.add(button).on_hover_text(&lesson.goal);
            self.choose(ui, &item, || Command::OpenLesson(name));
        }
    }
}

/// A check box with the border that it has outside of menus: their style leaves an empty box invisible.
fn checkbox_ui(ui: &mut Ui, on: &mut bool, name: &str) -> Response {
    let widgets = ui.ctx().global_style().visuals.widgets.clone();
    ui.scope(|ui| {
        ui.visuals_mut().widgets = widgets;
        ui.checkbox(on, name)
    })
    .inner
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

/// The built-in lessons, each with its name.
static BUILT_IN: LazyLock<Vec<(&str, Lesson)>> = LazyLock::new(|| {
    let load = |name| Some((name, LessonDocument::load(name, &result_fields()).ok()?.lesson));
    LESSONS.iter().filter_map(|lesson| load(lesson.name)).collect()
});

static TITLES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let title = |name: &str| Document::load(name).map_or_else(|_| name.to_owned(), |found| found.scene.title);
    PRESETS.iter().map(|preset| title(preset.name)).collect()
});
