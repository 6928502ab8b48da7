//! Why a command can do nothing at present: the text for a grey menu item, and for a key without effect.

use crate::app::session::map::Map;
use crate::app::ui::settings::Setting;
use crate::dynamics::EventKind;

use super::Window;
use super::command::Command;
use super::layouts::Room;
use super::wanted::Wanted;

impl Window {
    /// Why a command can do nothing at present; `None` if it can.
    pub fn impossible(&self, command: &Command) -> Option<&'static str> {
        use Command as C;
        if self.lesson_covers() && command.reveals_motion() {
            return Some("First choose what you expect");
        }
        let (session, in_lesson) = (&self.session, self.lesson().is_some());
        let is_narrow = self.tiling.room() == Room::Narrow;
        let has_whole_map = session.map.map().is_some_and(Map::is_whole);
        let has_stops = session.model().stop_positions() != (None, None);
        let has_barrier = session.model().mechanism().landscape.barrier.is_some();
        let (is_so, why) = match command {
            C::Arrange(_) | C::ArrangeOwn | C::KeepOwn if in_lesson => {
                (true, "A lesson has its own views: leave the lesson first")
            }
            // a pinned motion may be the answer to a lesson's question, as the ways to cross may
            C::Pin => (in_lesson, "In a lesson no motion is pinned: leave the lesson first"),
            C::Ways => (in_lesson, "There is no hint here: a task has one, until it is done"),
            C::Choose(Wanted::Measured) => (in_lesson, "Leave the lesson first"),
            C::BestStops if in_lesson => (true, "The search for the best stops is off in a lesson"),
            C::BestStops => (!session.model().is_shaken(), "Nothing shakes the mass: shake it first."),
            C::LeaveLesson | C::LessonAnew | C::LecturerNotes => (!in_lesson, "No lesson is open"),
            C::ArrangeOwn => (
                is_narrow && self.custom.is_none(),
                "You have no arrangement yet: a wider window can keep one",
            ),
            C::KeepOwn => (is_narrow, "A window of this size shows its views as tabs: widen it first"),
            C::NextTab if self.filled.is_some() => (true, "One view fills the window: Z shows all of them"),
            C::NextTab => (!self.tiling.has_tabs(), "No two views share a place"),
            C::HoldAxes | C::FreeAxes | C::Zoom { .. } => {
                let has_none = self.memory.are_axes_held(self.active_view()).is_none();
                (has_none, "This view has no axes to hold or to zoom")
            }
            C::Save => {
                let is_saved = session.editor.path().is_some() && !session.editor.is_dirty();
                (is_saved, "Nothing was changed since the file was opened or saved")
            }
            C::RemoveMeasured => (session.measured.over.is_none(), "No measured data is shown"),
            C::Choose(Wanted::Map) => (!has_whole_map, "There is no whole map yet: show the Map first"),
            C::CopyMapCommand => (session.map.map().is_none(), "There is no map yet: show the Map first"),
            C::PasteScene => (cfg!(target_arch = "wasm32"), "A page cannot paste by itself: press Ctrl+V"),
            C::Undo => (!session.editor.can_undo(), "There is nothing to undo"),
            C::Redo => (!session.editor.can_redo(), "There is nothing to redo"),
            C::GoTo(EventKind::Release) => (!has_stops, "No release can come: there are no stops"),
            C::GoTo(EventKind::Crossing) => (!has_barrier, "No crossing can come: there is no barrier"),
            C::Notes => (!in_lesson && session.scene().notes.trim().is_empty(), "This scene has no notes"),
            C::Toggle(Setting::Dark) => (self.settings.projector, "The projector is light: P leaves it"),
            _ => return None,
        };
        is_so.then_some(why)
    }
}
