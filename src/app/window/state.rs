//! State of the window, and what can be read of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use egui_tiles::Tree;

use crate::app::panels::hint;
use crate::app::session::editor::Editor;
use crate::app::session::{CannotRun, Session};
use crate::app::task::{Latest, Wake};
use crate::app::ui::settings::Settings;
use crate::app::views::{Memory, View};
use crate::app::words::announce::Announcer;
use crate::scene::{Layout, PRESETS};
use crate::system::files;

use super::deferred::DeferredInput;
use super::figure::Figures;
use super::layouts::{Arrangement, Room, Tiling};
use super::leave::Next;
use super::lessons::CANNOT_OPEN_LESSON;
use super::lessons::{self, Lessons};
use super::measured_dialog::{MeasuredDialog, is_measured};
use super::messages::{CANNOT_OPEN, Messages, Written};
use super::path_dialog::PathDialog;
use super::size::WindowSize;
use super::wanted::Chosen;

/// How many of the scenes opened last are kept.
const MOST_RECENT: usize = 8;

pub struct Window {
    pub session: Session,
    /// What a person wants whatever the scene.
    pub settings: Settings,
    pub tiling: Tiling,
    pub(super) arrangement: Arrangement,
    /// A person's own arrangement, kept between two starts.
    pub own: Option<Tree<View>>,
    pub memory: Memory,
    pub(super) more: bool,
    pub(super) filled: Option<View>,
    pub(super) covered: bool,
    pub(super) messages: Messages,
    /// Scene files that were opened or saved, the latest first.
    pub recent: Vec<String>,
    /// What waits for an answer about unsaved changes.
    pub(super) asked: Option<Next>,
    /// What comes once the scene is saved.
    pub(super) after_save: Option<Next>,
    /// A file with comments that is about to be written over.
    pub(super) over_comments: Option<PathBuf>,
    /// The list of keys is shown, since this time in s.
    pub(super) shortcuts: Option<f64>,
    /// What it would take to cross is shown.
    pub(super) ways: bool,
    pub(super) announcer: Announcer,
    /// The changes may go: the window closes without another question.
    pub(super) leaving: bool,
    /// What became of what is written elsewhere than in this thread: what was written, or the error.
    pub(super) written: (Sender<Written>, Receiver<Written>),
    /// A whole run that is computed and written.
    pub(super) run: Latest<Written>,
    pub(super) place: WindowSize,
    pub(super) titled: String,
    pub(super) dialog: Latest<Chosen>,
    /// Whether files are asked for.
    pub(super) dialogs: bool,
    /// A path that is typed where there is no dialog.
    pub(super) typed: Option<PathDialog>,
    /// The figure that is asked for, and how figures are laid out.
    pub figures: Figures,
    /// Measured data whose columns are being chosen.
    pub columns: Option<MeasuredDialog>,
    /// Input that waits for the next frame.
    pub(super) deferred: DeferredInput,
    pub(super) hint: hint::Hint,
    /// The line of the first minute has been there.
    pub(super) hint_row: bool,
    pub(super) lessons: Lessons,
    pub(super) glossary: bool,
    pub(super) wake: Wake,
    /// What was applied last, to be applied again only where it changes.
    pub(super) applied: Option<Settings>,
}

impl Window {
    /// A window on a scene file or a built-in scene, on a lesson, or with measured data over the first
    /// preset; on that where nothing is given.
    pub fn open(spec: Option<&str>, settings: Settings, wake: Wake) -> Result<Self, CannotRun> {
        let first = PRESETS.first().map_or("paper", |preset| preset.name);
        if let Some(spec) = spec.filter(|spec| lessons::is_lesson(spec)) {
            let lesson = lessons::read(spec)?;
            let mut window = Self::on(Editor::open(first)?, settings, wake)?;
            window.begin_lesson(lesson)?;
            return Ok(window);
        }
        if let Some(path) = spec.map(Path::new).filter(|path| is_measured(path)) {
            let mut window = Self::on(Editor::open(first)?, settings, wake)?;
            window.open_measured(path);
            return Ok(window);
        }
        Self::on(Editor::open(spec.unwrap_or(first))?, settings, wake)
    }

    /// The same; where the scene cannot be opened, on the first preset, with a message that says why.
    pub fn start(spec: Option<&str>, settings: Settings, wake: Wake) -> Result<Self, CannotRun> {
        Self::open(spec, settings, Arc::clone(&wake)).or_else(|error| {
            let mut window = Self::open(None, settings, wake)?;
            let is_lesson = spec.is_some_and(lessons::is_lesson);
            let title = if is_lesson { CANNOT_OPEN_LESSON } else { CANNOT_OPEN };
            window.messages.say(title, error.to_string());
            Ok(window)
        })
    }

    /// A window on a scene that was read.
    pub(super) fn on(editor: Editor, settings: Settings, wake: Wake) -> Result<Self, CannotRun> {
        let session = Session::new(editor, Arc::clone(&wake))?;
        let layout = session.scene().app.as_ref().and_then(|app| app.layout).unwrap_or(Layout::Look);
        Ok(Self {
            hint: hint::Hint::for_scene(&session),
            session,
            settings,
            tiling: Tiling::new(layout, Room::Wide),
            arrangement: Arrangement::Layout(layout),
            own: None,
            memory: Memory::default(),
            more: false,
            filled: None,
            covered: false,
            messages: Messages::default(),
            recent: Vec::new(),
            asked: None,
            after_save: None,
            over_comments: None,
            leaving: false,
            shortcuts: None,
            ways: false,
            announcer: Announcer::default(),
            written: channel(),
            run: Latest::default(),
            place: WindowSize::default(),
            titled: String::new(),
            dialog: Latest::default(),
            dialogs: true,
            typed: None,
            figures: Figures::default(),
            columns: None,
            deferred: DeferredInput::default(),
            hint_row: false,
            lessons: Lessons::default(),
            glossary: false,
            wake,
            applied: None,
        })
    }

    /// Puts the scene's file first among the recent ones.
    pub fn remember_file(&mut self) {
        if let Some(path) = self.session.editor.path().map(PathBuf::from) {
            self.remember(&path);
        }
    }

    /// Puts a file first among the recent ones.
    pub(super) fn remember(&mut self, path: &Path) {
        let whole = files::canonical(path).unwrap_or_else(|| path.to_owned()).to_string_lossy().into_owned();
        self.recent.retain(|own| *own != whole);
        self.recent.insert(0, whole);
        self.recent.truncate(MOST_RECENT);
    }

    /// The message that waits to be read.
    pub fn message(&self) -> Option<&str> {
        self.messages.waiting()
    }

    /// The short message that was shown last, while it stands.
    pub fn told(&self) -> Option<&str> {
        self.messages.told()
    }

    /// Whether something over the window waits for an answer: no key acts behind it.
    pub(super) fn waits_for_answer(&self) -> bool {
        self.message().is_some()
            || self.asked.is_some()
            || self.over_comments.is_some()
            || self.typed.is_some()
            || self.figures.is_open()
            || self.columns.is_some()
            || self.shortcuts.is_some()
            || self.glossary
    }

    /// Puts the views where the arrangement has them.
    pub(super) fn arrange(&mut self, room: Room) {
        if let Some(lesson) = &self.lessons.open {
            let views: Vec<View> = lesson.lesson().views.iter().map(|view| View::from(*view)).collect();
            self.tiling = Tiling::of_lesson(&views, room);
            return;
        }
        self.tiling = match (self.arrangement, &self.own) {
            (Arrangement::Own, Some(own)) => Tiling::own(own, room),
            (Arrangement::Own, None) => Tiling::new(Layout::Look, room),
            (Arrangement::Layout(layout), _) => Tiling::new(layout, room),
        };
    }
}
