//! State of the window, and the methods that read it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use egui_tiles::Tree;

use crate::app::export::{RunQuestion, WriteResult};
use crate::app::panels::hint;
use crate::app::panels::status_line::Announcer;
use crate::app::session::Session;
use crate::app::session::editor::Editor;
use crate::app::task::{Background, Wake};
use crate::app::ui::settings::Settings;
use crate::app::views::{Memory, View};
use crate::questions::Error;
use crate::scene::{Layout, PRESETS};
use crate::system::files;

use super::DeferredInput;
use super::figure::Figures;
use super::kept::WindowSize;
use super::layouts::{Arrangement, Room, Tiling};
use super::leave::Next;
use super::lessons::CANNOT_OPEN_LESSON;
use super::lessons::{self, Lessons};
use super::measured_dialog::{MeasuredDialog, is_measured};
use super::messages::{CANNOT_OPEN, Messages};
use super::pace::Pace;
use super::wanted::{Chosen, PathDialog};

const MAX_RECENT: usize = 8;

pub struct Window {
    pub session: Session,
    /// The user's settings, which hold for all scenes.
    pub settings: Settings,
    pub tiling: Tiling,
    pub(super) arrangement: Arrangement,
    /// The arrangement that the user has made, kept between two starts.
    pub custom: Option<Tree<View>>,
    pub memory: Memory,
    pub(super) more: bool,
    /// Whether a narrow window shows the column of controls.
    pub(super) column: bool,
    pub(super) filled: Option<View>,
    pub(super) covered: bool,
    pub(super) messages: Messages,
    /// Files that were opened or saved, the latest first.
    pub recent: Vec<String>,
    /// What to do once the question about unsaved changes is answered.
    pub(super) pending: Option<Next>,
    /// What to do once the scene is saved.
    pub(super) after_save: Option<Next>,
    /// A file with comments that is about to be overwritten.
    pub(super) over_comments: Option<PathBuf>,
    /// Time in s at which the list of keys was opened; `None` while it is closed.
    pub(super) shortcuts: Option<f64>,
    /// Whether the line says what it would take to cross.
    pub(super) ways: bool,
    pub(super) announcer: Announcer,
    /// Whether the window may close without a question about unsaved changes.
    pub(super) leaving: bool,
    /// Results of the files that other threads write.
    pub(super) written: (Sender<WriteResult>, Receiver<WriteResult>),
    /// A whole run that is computed and written in the background.
    pub(super) run: Background<RunQuestion, WriteResult>,
    pub(super) window_size: WindowSize,
    pub(super) shown_title: String,
    pub(super) file_dialog: Background<(), Chosen>,
    pub(super) opens_dialogs: bool,
    /// The dialog in which a path is typed, if the desktop has no file dialog.
    pub(super) path_dialog: Option<PathDialog>,
    /// The requested figure, and the layout of figures.
    pub figures: Figures,
    pub columns: Option<MeasuredDialog>,
    pub(super) deferred: DeferredInput,
    pub(super) hint: hint::Hint,
    pub(super) lessons: Lessons,
    pub(super) glossary: bool,
    /// Whether a dialog was open in the last frame.
    pub(super) waited: bool,
    pub(super) wake: Wake,
    /// The settings that were applied last; they are applied again only if they change.
    pub(super) applied: Option<Settings>,
    pub(super) pace: Pace,
    /// The zoom of the projector that was applied last; `None` without a projector.
    pub(super) zoom: Option<f32>,
}

impl Window {
    /// A window on a scene file, a built-in scene or a lesson file, or with a file of measured data over the
    /// first preset. Without `spec` it opens the first preset.
    pub fn open(spec: Option<&str>, settings: Settings, wake: Wake) -> Result<Self, Error> {
        let lesson = spec.filter(|spec| lessons::is_lesson(spec)).map(lessons::read).transpose()?;
        let measured = spec.map(Path::new).filter(|path| lesson.is_none() && is_measured(path));
        let first = PRESETS.first().map_or("paper", |preset| preset.name);
        let scene = spec.filter(|_| lesson.is_none() && measured.is_none()).unwrap_or(first);
        let mut window = Self::with_editor(Editor::open(scene)?, settings, wake)?;
        if let Some(lesson) = lesson {
            window.begin_lesson(lesson)?;
        }
        if let Some(path) = measured {
            window.open_measured(path);
        }
        Ok(window)
    }

    /// Like [`Self::open`]; if that fails, a window on the first preset with an alert that says why.
    pub fn start(spec: Option<&str>, settings: Settings, wake: Wake) -> Result<Self, Error> {
        Self::open(spec, settings, Arc::clone(&wake)).or_else(|error| {
            let mut window = Self::open(None, settings, wake)?;
            let is_lesson = spec.is_some_and(lessons::is_lesson);
            let title = if is_lesson { CANNOT_OPEN_LESSON } else { CANNOT_OPEN };
            window.messages.alert(title, error.to_string());
            Ok(window)
        })
    }

    pub(super) fn with_editor(editor: Editor, settings: Settings, wake: Wake) -> Result<Self, Error> {
        let session = Session::new(editor, Arc::clone(&wake))?;
        let layout = session.scene().app.as_ref().and_then(|app| app.layout).unwrap_or(Layout::Look);
        Ok(Self {
            hint: hint::Hint::for_scene(&session),
            session,
            settings,
            tiling: Tiling::new(layout, Room::Wide),
            arrangement: Arrangement::Layout(layout),
            custom: None,
            memory: Memory::default(),
            more: false,
            column: false,
            filled: None,
            covered: false,
            messages: Messages::default(),
            recent: Vec::new(),
            pending: None,
            after_save: None,
            over_comments: None,
            leaving: false,
            shortcuts: None,
            ways: false,
            announcer: Announcer::default(),
            written: channel(),
            run: Background::default(),
            window_size: WindowSize::default(),
            shown_title: String::new(),
            file_dialog: Background::default(),
            opens_dialogs: true,
            path_dialog: None,
            figures: Figures::new(),
            columns: None,
            deferred: DeferredInput::default(),
            lessons: Lessons::default(),
            glossary: false,
            waited: false,
            wake,
            applied: None,
            pace: Pace::default(),
            zoom: None,
        })
    }

    /// Puts the scene's file first among the recent ones.
    pub fn remember_file(&mut self) {
        if let Some(path) = self.session.editor.path().map(PathBuf::from) {
            self.remember(&path);
        }
    }

    pub(super) fn remember(&mut self, path: &Path) {
        let full = files::canonical(path).unwrap_or_else(|| path.to_owned()).to_string_lossy().into_owned();
        self.recent.retain(|recent| *recent != full);
        self.recent.insert(0, full);
        self.recent.truncate(MAX_RECENT);
    }

    pub fn title(&self) -> &str {
        &self.shown_title
    }

    /// The text about the whole window for a screen reader: a message, or the sentence of the status line.
    pub fn spoken(&self) -> &str {
        let sentence = || match self.motion_is_covered() {
            true => "Covered: what do you expect?",
            false => self.announcer.spoken().map_or("", |(_, sentence)| sentence),
        };
        self.message().or_else(|| self.notice()).unwrap_or_else(sentence)
    }

    pub fn message(&self) -> Option<&str> {
        self.messages.alert.as_ref().map(|(_, text)| text.as_str())
    }

    pub fn notice(&self) -> Option<&str> {
        self.messages.notice.as_ref().map(|notice| notice.text.as_str())
    }

    /// Whether a dialog is open, so that keys do not act on the window behind it.
    pub fn waits_for_answer(&self) -> bool {
        self.message().is_some()
            || self.pending.is_some()
            || self.over_comments.is_some()
            || self.path_dialog.is_some()
            || self.figures.is_open()
            || self.columns.is_some()
            || self.shortcuts.is_some()
            || self.glossary
            || self.lessons.ask()
    }

    /// Builds the tiles of the arrangement for a window of the size class `room`.
    pub(super) fn arrange(&mut self, room: Room) {
        if let Some(lesson) = &self.lessons.open {
            let views: Vec<View> = lesson.lesson().views.iter().map(|view| View::from(*view)).collect();
            self.tiling = Tiling::of_lesson(&views, room);
            self.tiling.cover_surveys(lesson.hides_surveys());
            self.show_named_views();
            return;
        }
        self.tiling = match (self.arrangement, &self.custom) {
            (Arrangement::Custom, Some(saved)) => Tiling::custom(saved, room),
            (Arrangement::Custom, None) => Tiling::new(Layout::Look, room),
            (Arrangement::Layout(layout), _) => Tiling::new(layout, room),
        };
    }
}
