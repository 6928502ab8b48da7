//! Table of the commands, from which the menus, the keys and the list of keys are made.

use eframe::egui::{Key, KeyboardShortcut, Modifiers};

use crate::app::ui::settings::Setting;
use crate::app::views::View;
use crate::dynamics::EventKind;
use crate::scene::Layout;

use super::wanted::Wanted;

#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "the table says what each one does")]
pub enum Command {
    OpenPreset(&'static str),
    OpenRecent(String),
    Open,
    RemoveMeasured,
    Save,
    /// Choose a file to open or to save.
    Choose(Wanted),
    Figure(Option<View>),
    CopyScene,
    CopyLink,
    PasteScene,
    CopyCommand,
    CopyMapCommand,
    Quit,
    Undo,
    Redo,
    BackToStart,
    PlayPause,
    Step,
    /// Go to the next event (true) or to the previous one.
    SeekEvent(bool),
    /// Go to the next event of a kind.
    GoTo(EventKind),
    RunToEnd,
    Speed(usize),
    Arrange(Layout),
    ArrangeOwn,
    KeepOwn,
    Show(View, bool),
    NextTab,
    Fill,
    Cover,
    Cursors,
    HoldAxes,
    FreeAxes,
    /// Zoom the vertical or the horizontal axis of the active view, in or out.
    Zoom {
        upwards: bool,
        closer: bool,
    },
    FullScreen,
    /// Show everything larger (1), smaller (-1), or at its usual size (0).
    Magnify(i8),
    Toggle(Setting),
    Grab,
    Pin,
    Ways,
    BestStops,
    OpenLesson(&'static str),
    LeaveLesson,
    LessonAnew,
    CopyAnswers,
    LecturerNotes,
    Glossary,
    Notes,
    Shortcuts,
    About,
}

impl Command {
    /// Whether it changes or reveals the motion; it is then blocked while a prediction covers the motion.
    pub(super) fn reveals_motion(&self) -> bool {
        use Wanted::{Events, Map, Motion, Run};
        matches!(
            self,
            Self::Choose(Motion | Run | Events | Map)
                | Self::Figure(_)
                | Self::CopyCommand
                | Self::CopyMapCommand
                | Self::Undo
                | Self::Redo
                | Self::BackToStart
                | Self::PlayPause
                | Self::Step
                | Self::SeekEvent(_)
                | Self::GoTo(_)
                | Self::RunToEnd
                | Self::Grab
                | Self::Ways
                | Self::BestStops
        )
    }
}

pub(super) enum Part {
    /// A command: its name, its key, its entry in the list of keys.
    Item(&'static str, Option<KeyboardShortcut>, Command, Listed),
    /// A command that is in no menu: its key, its entry in the list of keys.
    Hidden(Option<KeyboardShortcut>, Command, Listed),
    /// A row that is only in the list of keys: its heading, the keys, and what they do.
    Row(&'static str, &'static str, &'static str),
    Menu(&'static str, &'static [Part]),
    Line,
    Presets,
    /// The scene files opened last.
    Recent,
    Settings,
    Views,
    /// The speeds, with the keys 1 to 7.
    Speeds,
    /// The built-in lessons, with a mark on those that are done.
    Lessons,
}

/// Entry of a command in the list of keys.
#[derive(Debug, Clone, Copy)]
pub(super) enum Listed {
    No,
    /// A separate row: its heading, and what the command does.
    As(&'static str, &'static str),
    /// In the row of the preceding command.
    Joined,
}

const fn plain(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::NONE, key))
}

const fn shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::SHIFT, key))
}

const fn control(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

const fn control_shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key))
}

pub const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);

/// Name of the command that returns to the scene as it was opened.
pub(super) const DISCARD: &str = "Discard changes";

use Command as C;
use Listed::{As, Joined, No};
use Part::{Hidden, Item, Line, Row};

#[rustfmt::skip]
pub(super) static MENUS: [(&str, &[Part]); 6] = [
    ("File", &[
        Part::Presets,
        Item("Open...", control(Key::O), C::Open, As("Scene", "open, save")),
        Part::Recent,
        Line,
        Item("Save", control(Key::S), C::Save, Joined),
        Item("Save as...", control_shift(Key::S), C::Choose(Wanted::Save), No),
        Line,
        Item("Open measured data...", control(Key::M), C::Choose(Wanted::Measured),
            As("Scene", "open measured data, drawn over the computed")),
        Item("Remove the measured data", None, C::RemoveMeasured, No),
        Line,
        Item("Save a figure of a view...", control(Key::E), C::Figure(None),
            As("Scene", "save a figure of the view under the pointer")),
        Item("Save the motion seen as CSV...", None, C::Choose(Wanted::Motion), No),
        Item("Save the whole run as CSV...", None, C::Choose(Wanted::Run), No),
        Item("Save the events as CSV...", None, C::Choose(Wanted::Events), No),
        Item("Save the force curve as CSV...", None, C::Choose(Wanted::Curve), No),
        Item("Save a picture of the window...", None, C::Choose(Wanted::Picture), No),
        Item("Save the map as CSV...", None, C::Choose(Wanted::Map), No),
        Item("Copy the map's command line", None, C::CopyMapCommand, No),
        #[cfg(not(target_arch = "wasm32"))]
        Line,
        #[cfg(not(target_arch = "wasm32"))]
        Item("Quit", control(Key::Q), C::Quit, As("Scene", "quit")),
    ]),
    ("Edit", &[
        Item("Undo", Some(UNDO), C::Undo, As("Scene", "undo, redo")),
        Item("Redo", control_shift(Key::Z), C::Redo, Joined),
        Hidden(control(Key::Y), C::Redo, No),
        Item(DISCARD, plain(Key::Home), C::BackToStart,
            As("Scene", "discard your changes: scene, view and time as opened")),
        Item("Find the best stops", plain(Key::B), C::BestStops,
            As("Scene", "search for the stops with which the mass moves fastest, or gives most power")),
        Line,
        Item("Copy the scene as text", control(Key::C), C::CopyScene,
            As("Scene", "copy, paste the scene as text")),
        Item("Paste a scene", control(Key::V), C::PasteScene, Joined),
        Item("Copy link", None, C::CopyLink, As("Scene", "copy a link that opens the scene as it is now")),
        Item("Copy the command line", control_shift(Key::C), C::CopyCommand,
            As("Scene", "copy the command line that runs it")),
    ]),
    ("View", &[
        Row("Views", "Ctrl+1 to 5", "arrange as Look, Study, Map, your own, Explore"),
        Part::Menu("Arrangement", &[
            Item("Look", control(Key::Num1), C::Arrange(Layout::Look), No),
            Item("Study", control(Key::Num2), C::Arrange(Layout::Study), No),
            Item("Map", control(Key::Num3), C::Arrange(Layout::Map), No),
            Item("Your own", control(Key::Num4), C::ArrangeOwn, No),
            Item("Explore", control(Key::Num5), C::Arrange(Layout::Explore), No),
            Item("Keep this as your own", None, C::KeepOwn, No),
        ]),
        Line,
        Part::Settings,
        Hidden(plain(Key::P), C::Toggle(Setting::Projector),
            As("Views", "projector: light, larger, thicker lines")),
        Hidden(plain(Key::D), C::Toggle(Setting::Dark), As("Views", "light letters on a dark ground")),
        Line,
        Part::Views,
        Item("The next tab", control(Key::Tab), C::NextTab,
            As("Views", "the next of the views that share a place")),
        Item("One view over the window", plain(Key::Z), C::Fill,
            As("Views", "the view under the pointer over the whole window")),
        Hidden(plain(Key::Escape), C::Fill, No),
        Row("Views", "Esc", "all views again"),
        Line,
        Item("Two cursors over time", plain(Key::T), C::Cursors,
            As("Views", "two cursors over time: by hand or arrows, up and down to events")),
        Item("Hold the axes", plain(Key::L), C::HoldAxes,
            As("Views", "hold the axes of the view under the pointer, or let go of them")),
        Item("Axes by themselves", plain(Key::Num0), C::FreeAxes,
            As("Views", "let its axes fit what they show again")),
        Hidden(plain(Key::I), C::Zoom { upwards: false, closer: true },
            As("Views", "zoom its horizontal axis in, out; with Shift the vertical one")),
        Hidden(plain(Key::O), C::Zoom { upwards: false, closer: false }, Joined),
        Hidden(shift(Key::I), C::Zoom { upwards: true, closer: true }, No),
        Hidden(shift(Key::O), C::Zoom { upwards: true, closer: false }, No),
        Row("Views", "wheel", "zoom; over an axis or with Shift one axis, over time the time"),
        Row("Views", "drag", "move the axes; with the right button, zoom into a box"),
        Line,
        Item("Cover the results", plain(Key::C), C::Cover,
            As("Views", "cover all results until C again: predict first")),
        Item("What it would take", plain(Key::H), C::Ways, As("Views", "what it would take to cross")),
        Line,
        Part::Menu("Zoom of the window", &[
            Item("Larger", control(Key::Plus), C::Magnify(1), No),
            Item("Smaller", control(Key::Minus), C::Magnify(-1), No),
            Item("Usual size", control(Key::Num0), C::Magnify(0), No),
        ]),
        Row("Views", "Ctrl and +, -, 0", "the whole window larger, smaller, at its usual size"),
        // a browser has a full screen mode itself
        #[cfg(not(target_arch = "wasm32"))]
        Item("Full screen", plain(Key::F11), C::FullScreen, As("Views", "full screen")),
    ]),
    ("Motion", &[
        Item("Play, pause", plain(Key::Space), C::PlayPause, As("Time", "play, pause")),
        Item("A single step", plain(Key::Period), C::Step, No),
        Row("Time", ".", "a single step"),
        Item("To the event before", plain(Key::PageUp), C::SeekEvent(false),
            As("Time", "to the event before, after")),
        Item("To the event after", plain(Key::PageDown), C::SeekEvent(true), Joined),
        Line,
        Item("To the next release", plain(Key::R), C::GoTo(EventKind::Release),
            As("Time", "to the next release, the next crossing")),
        Item("To the next crossing", plain(Key::X), C::GoTo(EventKind::Crossing), Joined),
        Item("To the end of the run", plain(Key::End), C::RunToEnd, As("Time", "to the end of the run")),
        Line,
        Item("Pin this motion", plain(Key::K), C::Pin,
            As("Time", "compare with this motion: it continues, dashed, beside the present one")),
        Line,
        Part::Speeds,
        Row("Time", "1 to 7", "speed, from 1/1000 of real time to 100 times"),
        Hidden(plain(Key::G), C::Grab, As("Hands", "take hold of the mass")),
        Row("Hands", "Left, Right", "move the control with the focus a step, the held mass 0.1\u{a0}mm"),
        Row("Hands", "Shift", "with Left, Right: ten steps at once"),
        Row("Hands", "Enter", "let go of the mass"),
        Row("Hands", "+, -", "enlarge the map around its cross-hair, and back"),
        Row("Hands", "Tab, Space", "to the next control, press it"),
    ]),
    ("Lessons", &[
        Part::Lessons,
        Item("Open a lesson...", None, C::Choose(Wanted::Lesson), No),
        Line,
        Item("Begin this lesson anew", None, C::LessonAnew, No),
        Item("Leave lesson", None, C::LeaveLesson, No),
        Row("Lesson", "PageUp, PageDown", "in a lesson: the step before, after"),
        Row("Lesson", "A, B, C or 1, 2, 3", "choose what you expect (C then does not cover)"),
        Row("Lesson", "H", "the hint of a task"),
        Row("Lesson", "Shift+A, B, C", "count a vote for it; after the first, A, B, C do so too"),
        Line,
        Item("Copy my answers", None, C::CopyAnswers, No),
        Item("Lecturer's notes", control(Key::L), C::LecturerNotes,
            As("Lesson", "notes for the lecturer, in a separate window")),
    ]),
    ("Help", &[
        Item("Keys", plain(Key::F1), C::Shortcuts, No),
        Item("Glossary", plain(Key::F2), C::Glossary, As("Lesson", "glossary")),
        Item("About this scene", None, C::Notes, No),
        Item("About", None, C::About, No),
    ]),
];

pub(super) fn parts() -> impl Iterator<Item = &'static Part> {
    MENUS.iter().flat_map(|menu| menu.1).flat_map(|part| match part {
        Part::Menu(_, parts) => parts.iter(),
        part => std::slice::from_ref(part).iter(),
    })
}
