//! Application window: its panels around the views, and the work of each frame.
//!
//! [`Window::ui`] needs no graphics and no display: tests call it directly.

use std::sync::Arc;

use eframe::CreationContext;
use eframe::egui::{self, CentralPanel, Panel, RichText, Ui};

use crate::app::panels::hint::guide_ui;
use crate::app::panels::status_line::{self, covered_ui, status_ui};
use crate::app::panels::{controls, notes, transport};
use crate::app::session::lesson::OpenLesson;
use crate::app::session::lesson::Records;
use crate::app::ui::settings::Settings;
pub use crate::app::ui::style::install as prepare;
use crate::app::ui::style::{GAP, Style};
use crate::app::ui::widgets::bare;
use crate::app::views::ViewContext;
use crate::app::words::Guide;
use crate::app::words::lesson::numbered;
use crate::questions::Error;
use crate::scene::lesson::LESSONS;

use card::{Title, card_ui};
use layouts::{Arrangement, Room};

/// Height in points of the menu bar.
const MENU: f32 = 26.0;
/// Height in points of the bar with the time.
const TRANSPORT: f32 = 48.0;
/// Space in points above and below the bars with the time and the controls.
const AROUND_BAR: i8 = 2;
/// Space around the cards; the bars above and below them and the controls have margins themselves.
const MARGIN: egui::Margin = egui::Margin { left: GAP as i8, right: GAP as i8, top: 0, bottom: 0 };
/// Height in points of the guide line, for any text.
const GUIDE: f32 = 20.0;

mod card;
mod choice;
mod command;
mod figure;
mod files;
mod impossible;
mod kept;
mod keys;
pub mod layouts;
pub mod leave;
mod lecturer;
mod lesson_bars;
mod lessons;
mod measured_dialog;
mod menu;
mod messages;
mod pace;
mod perform;
mod state;
mod wanted;
mod writing;

pub use command::Command;
pub use figure::Figures;
pub use lecturer::Place;
pub use measured_dialog::MeasuredDialog;
pub use state::Window;
pub use wanted::Wanted;

impl Window {
    /// Updates the state before a frame is drawn: settings, input, results of the background, the motion.
    pub fn logic(&mut self, ctx: &egui::Context) {
        let Settings { dark, projector, .. } = self.settings;
        if self.applied != Some(self.settings) {
            ctx.set_theme(if dark && !projector { egui::Theme::Dark } else { egui::Theme::Light });
            self.applied = Some(self.settings);
        }
        let zoom = projector.then(|| self.window_size.projector_zoom(self.filled.is_some()));
        let is_close = |a: f32, b: f32| (a - b).abs() < 0.01 * b;
        if !zoom.zip(self.zoom).map_or(zoom == self.zoom, |(zoom, applied)| is_close(zoom, applied)) {
            self.zoom = zoom;
            self.deferred.scale = Some(ctx.zoom_factor() / zoom.unwrap_or(1.0));
            ctx.set_zoom_factor(zoom.unwrap_or(1.0));
        }
        self.window_size.follow(ctx);
        self.take_choice(ctx);
        self.take_input(ctx);
        // a view that is no longer shown cannot release the mass itself
        let free =
            ctx.memory(|memory| memory.focused().is_none()) && !ctx.input(|input| input.pointer.any_down());
        if free && self.session.player.is_held() {
            self.session.player.let_go();
            self.session.moved_by_hand();
        }
        self.session.poll();
        if let Some(left) = self.session.follow_presses(ctx.input(|input| input.time)) {
            ctx.request_repaint_after_secs(left as f32);
        }
        let reached = self.session.player.tick(self.pace.seconds(ctx));
        if let Some(reached) = reached.filter(|_| !self.motion_is_covered()) {
            self.messages.report_reached(reached, self.session.player.time());
        }
        self.session.follow_reference();
        let present = self.session.player.watch().time();
        if self.session.player.is_playing() || self.session.reference.is_behind(present) {
            self.pace.ask(ctx);
        }
    }

    pub fn ui(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.hide_hover_texts(ui);
        if !self.waits_for_answer() {
            self.keys(&ctx);
        }
        let style = Style::of(&ctx, self.settings.projector);
        let room = Room::of(ctx.content_rect().width());
        if room != self.tiling.room() {
            self.arrange(room);
        }
        let mut commands = self.bars_ui(ui, &style);
        self.follow_lesson(&ctx);
        if self.filled.is_some() {
            self.lesson_words_ui(ui, &style);
        } else if self.lessons.open.is_some() {
            self.lesson_column_ui(ui, &style);
        } else {
            if room == Room::Wide || self.column {
                commands.extend(self.controls_ui(ui));
            }
            self.session.follow_best();
            let panel = bare(Panel::top("guide"), 12, 0).exact_size(GUIDE);
            let line = panel.show(ui, |ui| self.guide_line_ui(ui, &style));
            commands.extend(line.inner);
        }
        let cards = egui::Frame::new().inner_margin(MARGIN);
        CentralPanel::no_frame().frame(cards).show(ui, |ui| self.views_ui(ui, style));
        self.pointing_ui(&ctx, &style);
        self.memory.grab = false;
        commands.extend(std::mem::take(&mut self.memory.pin).then_some(Command::Pin));
        commands.extend(self.memory.figure.take().map(|view| Command::Figure(Some(view))));
        commands.extend(
            std::mem::take(&mut self.memory.open_measured).then_some(Command::Choose(Wanted::Measured)),
        );
        self.session.end_frame();
        for command in commands {
            self.carry_out(&ctx, command);
        }
        self.dialogs_ui(ui, &ctx);
        focus_ui(&ctx, &style);
    }

    /// Closes hover texts once a dialog has opened, and from a press of a key until the pointer moves: one
    /// that is open would stay as long as the pointer does. A layer has one hover text at a time: an empty
    /// one takes the place of any other.
    fn hide_hover_texts(&mut self, ui: &Ui) {
        let (is_pressed, is_moved) = ui.input(|input| {
            let is_key = |event: &egui::Event| matches!(event, egui::Event::Key { pressed: true, .. });
            let is_move = |event: &egui::Event| matches!(event, egui::Event::PointerMoved(_));
            (input.events.iter().any(is_key), input.events.iter().any(is_move))
        });
        self.memory.hushed = (self.memory.hushed || is_pressed) && !is_moved;
        let waits = self.waits_for_answer();
        if waits && !self.waited || self.memory.hushed {
            let (ctx, id) = (ui.ctx().clone(), egui::Id::unique("no hover text"));
            let mut empty = egui::Tooltip::always_open(ctx, ui.layer_id(), id, egui::Pos2::ZERO);
            empty.popup = empty.popup.frame(egui::Frame::NONE);
            empty.show(|_| ());
        }
        self.waited = waits;
    }

    /// Menu bar, status line and transport bar; a view over the window leaves only the transport bar. Returns
    /// the commands that were chosen.
    fn bars_ui(&mut self, ui: &mut Ui, style: &Style) -> Vec<Command> {
        let covered = self.motion_is_covered();
        let mut chosen = Vec::new();
        if self.filled.is_none() {
            chosen = self.head_ui(ui, style);
        } else if !covered {
            self.announcer.say(ui, &self.session.sentence());
        }
        bare(Panel::bottom("transport"), 12, AROUND_BAR).exact_size(TRANSPORT).show(ui, |ui| {
            if self.lesson_covers() {
                ui.disable();
            }
            // the height does not depend on the texts
            ui.expand_to_include_rect(ui.max_rect());
            transport::transport_ui(ui, &mut self.session, style, covered);
        });
        chosen
    }

    /// Menu bar and status line. Returns the commands that were chosen.
    fn head_ui(&mut self, ui: &mut Ui, style: &Style) -> Vec<Command> {
        let bar = bare(Panel::top("menu"), 8, 1).exact_size(MENU);
        let bar = bar.show(ui, |ui| menu::Menus { window: self, chosen: Vec::new() }.ui(ui));
        let covered = self.motion_is_covered();
        let status = bare(Panel::top("status"), 12, 2).exact_size(status_line::height(ui));
        status.show(ui, |ui| {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if self.tiling.room() == Room::Narrow && self.lessons.open.is_none() {
                    ui.toggle_value(&mut self.column, "Controls");
                }
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| match covered {
                    true => {
                        let lesson = self.lessons.open.as_ref().filter(|_| !self.covered);
                        covered_ui(ui, lesson.map(OpenLesson::votes));
                    }
                    false => status_ui(ui, &mut self.session, &mut self.announcer, style),
                });
            });
        });
        bar.inner
    }

    /// The column of controls with the notes. Returns the chosen command.
    fn controls_ui(&mut self, ui: &mut Ui) -> Option<Command> {
        let width = if ui.ctx().content_rect().width() > 1600.0 { 300.0 } else { 250.0 };
        let column = bare(Panel::left("controls"), 12, 10).resizable(false).exact_size(width);
        let column = column.show(ui, |ui| {
            let bottom = ui.max_rect().bottom();
            let contents = egui::ScrollArea::vertical().show(ui, |ui| {
                controls::column_ui(ui, &mut self.session, &mut self.more);
                let (scene, editor) = (self.session.scene(), &self.session.editor);
                // a link may have changed the scene that the notes describe
                let is_changed = editor.is_dirty() || editor.saved() != editor.named();
                !self.covered && notes::notes_ui(ui, scene, is_changed, bottom)
            });
            contents.inner
        });
        column.inner.then_some(Command::Notes)
    }

    /// The guide line: the search for the best stops, the ways to cross, or the hint of the first minute.
    /// Returns the chosen command.
    fn guide_line_ui(&mut self, ui: &mut Ui, style: &Style) -> Option<Command> {
        let hinted = self.hint.is_shown(&self.session);
        if self.session.best.is_shown() && !self.ways && !self.covered {
            let guide = self.session.best.guide();
            guide_ui(ui, style, &guide, |ui| controls::best_stops_answer_ui(ui, &mut self.session));
            return None;
        }
        if self.ways && !self.covered {
            let back = if hinted { "H: back to what to try" } else { "H closes this" };
            let back = RichText::new(back).color(style.faint());
            guide_ui(ui, style, &Guide::new("", self.session.ways()), |ui| ui.label(back));
            return None;
        }
        let Some(next) = next_lesson(&self.lessons.records).filter(|_| hinted && !self.covered) else {
            let has_barrier = self.session.model().mechanism().landscape.barrier.is_some();
            let stays = has_barrier && !self.covered && self.session.crosses() == Some(false);
            guide_ui(ui, style, &Guide::keys(stays), |_| ());
            return None;
        };
        guide_ui(ui, style, &self.hint.guide(&self.session), |ui| {
            let hover = "Look, predict, try and explain, step by step. The scene waits as it is.";
            let lesson = ui.link(numbered(next)).on_hover_text(hover).clicked();
            if ui.link("Dismiss").clicked() {
                self.hint.dismiss();
            }
            lesson.then_some(Command::OpenLesson(next))
        })
    }

    fn dialogs_ui(&mut self, ui: &mut Ui, ctx: &egui::Context) {
        self.lecturer_ui(ctx);
        self.lesson_dialogs_ui(ui);
        self.questions_ui(ui, ctx);
        self.measured_ui(ui);
        self.take_figure();
        self.figure_ui(ui);
        self.glossary = self.glossary && notes::glossary_ui(ui);
        let (projector, in_lesson) = (self.settings.projector, self.lessons.open.is_some());
        self.shortcuts = self.shortcuts.filter(|opened| keys::list_ui(ui, *opened, projector, in_lesson));
        self.messages.alert_ui(ui);
        self.messages.notice_ui(ui);
    }

    fn views_ui(&mut self, ui: &mut Ui, style: Style) {
        // a key may have advanced the motion
        self.session.follow_reference();
        self.pose_question();
        let (span, cover) = (self.memory.span(&self.session), self.cover());
        let mut context = ViewContext {
            session: &mut self.session,
            style,
            span,
            memory: &mut self.memory,
            reduce_motion: self.settings.reduce_motion,
            cover,
            filled: self.filled.is_some(),
        };
        let Some(view) = self.filled else {
            self.tiling.ui(ui, &mut context, &mut self.filled);
            // changes to the custom arrangement are kept
            if self.arrangement == Arrangement::Custom
                && self.lessons.open.is_none()
                && let Some(tree) = self.tiling.tree_to_save()
                && self.custom.as_ref() != Some(tree)
            {
                self.custom = Some(tree.clone());
            }
            return;
        };
        let title = Title { view, id: egui::Id::unique("title of the window") };
        if card_ui(ui, &[title], view, &mut context).fills {
            self.filled = None;
        }
    }
}

/// The first lesson that is not done, or the first of all.
fn next_lesson(records: &Records) -> Option<&'static str> {
    let is_open = |name: &str| !records.get(name).is_some_and(|record| record.done);
    let mut names = LESSONS.iter().map(|lesson| lesson.name);
    names.clone().find(|name| is_open(name)).or_else(|| names.next())
}

/// A ring around the widget that has the keyboard focus, so that the focus can always be seen.
fn focus_ui(ctx: &egui::Context, style: &Style) {
    let focused = ctx.memory(egui::Memory::focused).and_then(|id| ctx.read_response(id));
    if let Some(response) = focused.filter(|_| !ctx.text_edit_focused()) {
        let painter = ctx.layer_painter(response.layer_id).with_clip_rect(ctx.content_rect());
        let rect = response.rect.expand(2.0);
        painter.rect_stroke(rect, 4.0, style.focus_stroke(), egui::StrokeKind::Inside);
    }
}

impl eframe::App for Window {
    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        Self::logic(self, ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        Self::ui(self, ui);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn raw_input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        self.deferred.rescale(ctx.input(|input| input.pointer.latest_pos()), input);
        if self.deferred.hold_back(input) {
            ctx.request_repaint();
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.save_state(storage);
    }

    fn persist_egui_memory(&self) -> bool {
        // what is open follows from the scene, not from the last start of the program
        false
    }
}

/// The window on a scene, with what was kept from the last time; the first time it is `dark` or light. If the
/// scene cannot be run, the window says why and opens on the first preset.
pub fn begin(creation: &CreationContext<'_>, spec: Option<&str>, dark: bool) -> Result<Window, Error> {
    prepare(&creation.egui_ctx);
    let kept = creation.storage.and_then(|storage| eframe::get_value(storage, eframe::APP_KEY));
    let settings = kept.unwrap_or(Settings { dark, ..Settings::default() });
    let ctx = creation.egui_ctx.clone();
    let mut window = Window::start(spec, settings, Arc::new(move || ctx.request_repaint()))?;
    if let Some(storage) = creation.storage {
        window.restore(storage);
    }
    window.remember_file();
    Ok(window)
}

/// Input that follows the release of a pointer button, deferred to the next frame.
///
/// All events between two frames arrive together in the next frame, and a slider takes the last position of
/// the pointer as the one at which it was released. If a frame takes long, a pointer that moves on after the
/// release would drag the slider along.
#[derive(Debug, Default)]
struct DeferredInput {
    events: Vec<egui::Event>,
    /// The zoom before over that of the next frame, if it changes.
    scale: Option<f32>,
}

impl DeferredInput {
    /// After a change of the zoom puts the pointer, which was at this place in points, where it is now: egui
    /// keeps its place until it is moved.
    fn rescale(&mut self, pointer: Option<egui::Pos2>, input: &mut egui::RawInput) {
        let scale = self.scale.take().filter(|scale| *scale != 1.0);
        if let Some((scale, at)) = scale.zip(pointer) {
            input.events.insert(0, egui::Event::PointerMoved((scale * at.to_vec2()).to_pos2()));
        }
    }

    /// Leaves in `input` the deferred and new events up to the first release. Returns whether more wait.
    fn hold_back(&mut self, input: &mut egui::RawInput) -> bool {
        let mut events = std::mem::take(&mut self.events);
        events.append(&mut input.events);
        let released =
            |event: &egui::Event| matches!(event, egui::Event::PointerButton { pressed: false, .. });
        if let Some(at) = events.iter().position(released) {
            self.events = events.split_off(at + 1);
        }
        input.events = events;
        !self.events.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Event, Modifiers, PointerButton, RawInput, pos2};

    use super::*;

    #[test]
    fn what_follows_a_release_comes_in_the_next_frame() {
        let button = |pressed| Event::PointerButton {
            pos: pos2(3.0, 0.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let moved = |x| Event::PointerMoved(pos2(x, 0.0));
        let all =
            [moved(1.0), button(true), moved(3.0), button(false), moved(9.0), button(true), button(false)];
        let mut deferred = DeferredInput::default();
        let mut input = RawInput { events: all.to_vec(), ..RawInput::default() };
        assert!(deferred.hold_back(&mut input));
        assert_eq!(input.events, all[..4]);
        let mut input = RawInput { events: vec![moved(10.0)], ..RawInput::default() };
        assert!(deferred.hold_back(&mut input));
        assert_eq!(input.events, all[4..]);
        let mut input = RawInput::default();
        assert!(!deferred.hold_back(&mut input));
        assert_eq!(input.events, [moved(10.0)]);
    }

    #[test]
    fn after_a_change_of_the_zoom_the_pointer_is_where_it_was_on_the_screen() {
        let mut deferred = DeferredInput { scale: Some(0.8), ..DeferredInput::default() };
        let mut input = RawInput::default();
        deferred.rescale(Some(pos2(100.0, 50.0)), &mut input);
        assert_eq!(input.events, [Event::PointerMoved(pos2(80.0, 40.0))]);
        // once
        let mut input = RawInput::default();
        deferred.rescale(Some(pos2(80.0, 40.0)), &mut input);
        assert!(input.events.is_empty());
    }
}
